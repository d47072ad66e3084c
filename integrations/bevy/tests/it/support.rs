//! Helpers that make apps for tests in either dimension.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::{Collider, CollisionEnded, CollisionStarted, Collisions, Glam, ImpingePlugin};
use bevy_transform::prelude::*;

/// Returns an app whose world steps once per update.
pub(crate) fn app<const D: usize>() -> App
where
    f32: Glam<D>,
{
    let mut app = App::new();
    app.add_plugins((TransformPlugin, ImpingePlugin::<D>::default().in_schedule(Update)));
    app
}

pub(crate) fn collisions<const D: usize>(app: &App) -> &Collisions<D>
where
    f32: Glam<D>,
{
    app.world().resource::<Collisions<D>>()
}

/// Returns a ball of radius 1; in 2D a disk.
pub(crate) fn ball<const D: usize>() -> Collider<D>
where
    f32: Glam<D>,
{
    Collider::<D>::new(impinge_ball(1.0))
}

pub(crate) fn impinge_ball(radius: f32) -> impinge::shape::Ball<f32> {
    impinge::shape::Ball::new(radius)
}

pub(crate) fn at(x: f32) -> Transform {
    Transform::from_xyz(x, 0.0, 0.0)
}

pub(crate) fn spawn<const D: usize>(app: &mut App, x: f32) -> Entity
where
    f32: Glam<D>,
{
    app.world_mut().spawn((ball::<D>(), at(x))).id()
}

pub(crate) fn place(app: &mut App, entity: Entity, transform: Transform) {
    *app.world_mut().get_mut::<Transform>(entity).expect("it has one") = transform;
}

/// Returns the messages since the last call, in order: whether the pair started, and its entities.
pub(crate) fn told<const D: usize>(app: &mut App) -> Vec<(bool, Entity, Entity)>
where
    f32: Glam<D>,
{
    let world = app.world_mut();
    let mut ended = world.resource_mut::<Messages<CollisionEnded<D>>>();
    let mut told: Vec<_> = ended.drain().map(|event| (false, event.entity, event.other)).collect();
    let mut started = world.resource_mut::<Messages<CollisionStarted<D>>>();
    told.extend(started.drain().map(|event| (true, event.entity, event.other)));
    told
}
