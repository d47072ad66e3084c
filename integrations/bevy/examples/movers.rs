//! Ten thousand moving entities, half of them in a hierarchy. Checks that the number of pairs that
//! started and have not ended is the number of touching pairs of the world.

use std::collections::BTreeSet;

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d3::prelude::*;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

#[derive(Component)]
struct Velocity(Vec3);

#[derive(Resource, Default)]
struct Touching(BTreeSet<(Entity, Entity)>);

/// Moves within a cube; velocities reverse at its sides.
fn fly(mut movers: Query<(&mut Velocity, &mut Transform)>) {
    for (mut velocity, mut transform) in &mut movers {
        transform.translation += velocity.0;
        for axis in 0..3 {
            if transform.translation[axis].abs() > 24.0 {
                velocity.0[axis] = velocity.0[axis].abs() * -transform.translation[axis].signum();
            }
        }
    }
}

fn note(
    mut started: MessageReader<CollisionStarted>,
    mut ended: MessageReader<CollisionEnded>,
    mut touching: ResMut<Touching>,
) {
    for event in ended.read() {
        assert!(touching.0.remove(&(event.entity, event.other)), "it had started");
    }
    for event in started.read() {
        assert!(touching.0.insert((event.entity, event.other)), "it starts once");
    }
}

/// Returns a number from -1 to 1.
fn random(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (*state >> 8) as f32 / (1 << 23) as f32 - 1.0
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .init_resource::<Touching>()
        .add_systems(FixedUpdate, fly)
        .add_systems(FixedPostUpdate, note.after(ImpingeSystems::Report));
    let seed = &mut 1;
    let (sphere, cuboid) = (Collider::sphere(0.3), Collider::cuboid(0.5, 0.5, 0.5));
    for _ in 0..5_000 {
        let mut vector = |length: f32| Vec3::new(random(seed), random(seed), random(seed)) * length;
        let mover =
            (Velocity(vector(0.1)), sphere.clone(), Transform::from_translation(vector(24.0)));
        let child = (cuboid.clone(), Transform::from_xyz(0.8, 0.0, 0.0));
        app.world_mut().spawn(mover).with_child(child);
    }
    for _ in 0..20 {
        app.update();
    }
    let collisions = app.world().resource::<Collisions>();
    let (now, told) =
        (collisions.contact_pairs().count(), app.world().resource::<Touching>().0.len());
    println!("{} entities, {now} pairs touch, {told} by messages", collisions.len());
    assert_eq!(collisions.len(), 10_000);
    assert_eq!(now, told, "no event is lost");
    assert!(now > 200, "they do meet");
}
