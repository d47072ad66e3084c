//! A kinematic character walks against a slanted wall, slides along it, climbs a low step and stops at a high one.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d3::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec3};
use bevy_time::{Fixed as FixedTime, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

const SPEED: f32 = 4.0;
const STEP_HEIGHT: f32 = 0.4;

/// The direction in which the player wants to move, in the plane of the floor.
#[derive(Component)]
struct Character {
    wish: Vec3,
}

fn build(mut commands: Commands) {
    commands.spawn((Name::new("floor"), Collider::half_space(Vec3::Y), FixedCollider));
    let slanted = Transform::from_xyz(6.0, 1.0, 0.0).with_rotation(Quat::from_rotation_y(0.6));
    commands.spawn((Name::new("wall"), Collider::cuboid(0.5, 2.0, 12.0), FixedCollider, slanted));
    for (name, height, z) in [("step", 0.3, -8.0), ("ledge", 1.5, -12.0)] {
        let at = Transform::from_xyz(0.0, height / 2.0, z);
        commands.spawn((Name::new(name), Collider::cuboid(40.0, height, 4.0), FixedCollider, at));
    }
    let character = Character { wish: Vec3::X };
    commands.spawn((character, Collider::capsule(0.3, 1.2), Transform::from_xyz(0.0, 0.92, 0.0)));
}

/// Moves up by the step height, then horizontally, then down again. Vertical motions end at the
/// first obstacle, the horizontal motion slides along obstacles.
fn walk(
    mut characters: Query<(Entity, &Character, &Collider, &mut Transform)>,
    collisions: Res<Collisions>,
    time: Res<Time<FixedTime>>,
) {
    for (entity, character, collider, mut transform) in &mut characters {
        let filter = SpatialFilter::new().exclude(entity);
        let slide = SlideSettings::default();
        // Vertical motions end at the first hit, so feet do not slide off the edge of a step.
        let straight = SlideSettings { max_hits: 1, ..slide };
        let mut go = |motion: Vec3, settings: &SlideSettings| {
            let at = Isometry3d::from_translation(transform.translation);
            let slide = collisions.move_and_slide(collider, at, motion, settings, &filter);
            transform.translation += slide.motion;
            slide.motion
        };
        let risen = go(Vec3::Y * STEP_HEIGHT, &straight).y;
        go(character.wish * SPEED * time.delta_secs(), &slide);
        go(Vec3::NEG_Y * (risen + STEP_HEIGHT), &straight);
    }
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .add_systems(Startup, build)
        .add_systems(FixedUpdate, walk);
    let mut state = app.world_mut().query::<(&mut Character, &Transform)>();
    let mut walk_for = |app: &mut App, wish: Vec3, steps: u32| {
        for _ in 0..steps {
            if let Ok((mut character, _)) = state.single_mut(app.world_mut()) {
                character.wish = wish;
            }
            app.update();
        }
        let (_, transform) = state.single(app.world()).expect("there is one character");
        println!("{steps} steps with wish {wish}: at {:.2}", transform.translation);
        transform.translation
    };
    app.update();

    let at_wall = walk_for(&mut app, Vec3::X, 96);
    let slid = walk_for(&mut app, Vec3::X, 32);
    let way = slid - at_wall;
    assert!(way.z.abs() > 0.2 && way.x.abs() > 0.2, "along the wall: {way}");
    assert!((slid.y - at_wall.y).abs() < 1e-3, "on the floor");

    let back = walk_for(&mut app, Vec3::NEG_X, 128);
    let end = walk_for(&mut app, Vec3::NEG_Z, 512);
    assert!(back.x < slid.x, "away from the wall");
    assert!((end.y - 0.3 - at_wall.y).abs() < 0.02, "on the step: {end}");
    assert!((end.z + 9.7).abs() < 0.02, "stopped by the ledge: {end}");
}
