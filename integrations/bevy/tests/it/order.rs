//! Tests that the order of messages depends neither on archetypes nor on the run, in which schedule
//! the world steps, and that changes between steps are not lost.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d2::prelude::*;
use bevy_math::Vec2;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

#[derive(Component)]
struct Other;

/// Returns the messages of moving circles on a grid, a third of them sensors. With
/// `mixes_archetypes` every second entity has another archetype.
fn run(mixes_archetypes: bool) -> Vec<(u32, usize, usize)> {
    let mut app = crate::support::app::<2>();
    let mut entities = Vec::new();
    for n in 0..60_u16 {
        let at = Transform::from_xyz(f32::from(n % 8), f32::from(n / 8), 0.0);
        let mut entity = app.world_mut().spawn((Collider::circle(0.6), at));
        if n % 3 == 0 {
            entity.insert(Sensor);
        }
        if mixes_archetypes && n % 2 == 0 {
            entity.insert(Other);
        }
        entities.push(entity.id());
    }
    let index = |entity| entities.iter().position(|&e| e == entity).expect("one of them");
    let mut all = Vec::new();
    for step in 0..40_u16 {
        for (n, &entity) in entities.iter().enumerate() {
            let mut at = app.world_mut().get_mut::<Transform>(entity).expect("it is there");
            at.translation.x += ((n * 7 + usize::from(step)) % 5) as f32 * 0.1 - 0.2;
        }
        app.update();
        let told = crate::support::told::<2>(&mut app);
        all.extend(told.iter().map(|&(started, a, b)| (u32::from(started), index(a), index(b))));
    }
    all
}

#[test]
fn messages_come_in_one_order() {
    let told = run(false);
    assert!(told.len() > 200, "much happens: {}", told.len());
    assert_eq!(told, run(false), "in the next run");
    assert_eq!(told, run(true), "with other archetypes");
}

#[derive(Resource, Default)]
struct Positions(Vec<f32>);

#[test]
fn the_fixed_schedule_is_the_default() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .init_resource::<Positions>()
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(2));
    let entity = app.world_mut().spawn((Collider::circle(1.0), Transform::default())).id();
    let forward = |mut all: Query<&mut Transform>| {
        all.iter_mut().for_each(|mut at| at.translation.x += 1.0);
    };
    app.add_systems(FixedUpdate, forward);
    let note = move |collisions: Res<Collisions>, mut positions: ResMut<Positions>| {
        let pose = collisions.pose(entity).expect("it is in the world");
        positions.0.push(pose.translation.x);
    };
    app.add_systems(FixedPostUpdate, note.after(ImpingeSystems::Step));
    // The first frame has no elapsed time, so the world does not step.
    for _ in 0..3 {
        app.update();
    }
    assert_eq!(app.world().resource::<Positions>().0, [1.0, 2.0, 3.0, 4.0], "two steps a frame");
}

#[test]
fn changes_between_steps_are_not_lost() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    let parent = app.world_mut().spawn(Transform::default()).id();
    let child = (Collider::circle(1.0), Transform::default(), ChildOf(parent), Sensor);
    let child = app.world_mut().spawn(child).id();
    app.update();
    // Five frames without a step of the world. They must not lose the changes.
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(0));
    app.world_mut().entity_mut(child).remove::<Sensor>();
    app.world_mut().get_mut::<Transform>(parent).expect("it has one").translation.x = 7.0;
    for _ in 0..5 {
        app.update();
    }
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.world_mut().spawn((Collider::circle(1.0), Transform::from_xyz(8.0, 0.0, 0.0)));
    app.update();
    let collisions = app.world().resource::<Collisions>();
    assert_eq!(collisions.pose(child).map(|pose| pose.translation), Some(Vec2::new(7.0, 0.0)));
    assert_eq!(collisions.contact_pairs().count(), 1, "no sensor any more");
}
