//! A one-way platform: a jumping character passes it from below and lands on it. The character's
//! filter excludes all platforms whose top is not below the feet of the character.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d2::prelude::*;
use bevy_math::{Isometry2d, Vec2};
use bevy_time::{Fixed as FixedTime, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

/// A platform with collisions from above only.
#[derive(Component)]
struct OneWay;

#[derive(Component)]
struct Character {
    velocity: Vec2,
}

const GRAVITY: Vec2 = Vec2::new(0.0, -20.0);
/// The distance from the centre of the character to its feet.
const FEET: f32 = 0.9;

fn fall(
    mut characters: Query<(Entity, &mut Character, &Collider, &mut Transform), Without<OneWay>>,
    platforms: Query<&GlobalTransform, With<OneWay>>,
    collisions: Res<Collisions>,
    time: Res<Time<FixedTime>>,
) {
    for (entity, mut character, collider, mut transform) in &mut characters {
        character.velocity += GRAVITY * time.delta_secs();
        let at = transform.translation.truncate();
        let is_solid = |other: Entity| {
            // A platform is 0.2 high. The tolerance of half a skin absorbs rounding errors.
            let top = |at: &GlobalTransform| at.translation().y + 0.1;
            platforms.get(other).map_or(true, |platform| at.y - FEET >= top(platform) + 0.005)
        };
        let filter = SpatialFilter::new().exclude(entity).predicate(&is_solid);
        let (motion, settings) = (character.velocity * time.delta_secs(), SlideSettings::default());
        let pose = Isometry2d::from_translation(at);
        let slide = collisions.move_and_slide(collider, pose, motion, &settings, &filter);
        transform.translation += slide.motion.extend(0.0);
        if slide.hits.iter().any(|hit| hit.normal.y > 0.7) {
            character.velocity = Vec2::ZERO;
        }
    }
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .add_systems(FixedUpdate, fall);
    let world = app.world_mut();
    world.spawn((Collider::half_plane(Vec2::Y), FixedCollider));
    let platform = Transform::from_xyz(0.0, 3.0, 0.0);
    world.spawn((OneWay, Collider::rectangle(4.0, 0.2), FixedCollider, platform));
    let character = Character { velocity: Vec2::ZERO };
    let at = Transform::from_xyz(0.0, 1.0, 0.0);
    let character = world.spawn((character, Collider::capsule(0.4, 1.0), at)).id();

    let height = |app: &App| {
        app.world().get::<Transform>(character).map_or(f32::NAN, |at| at.translation.y - FEET)
    };
    for _ in 0..32 {
        app.update();
    }
    println!("on the floor: {:.2}", height(&app));
    assert!((height(&app) - 0.01).abs() < 2e-3, "a skin above the floor");

    if let Some(mut character) = app.world_mut().get_mut::<Character>(character) {
        character.velocity = Vec2::new(0.0, 13.0);
    }
    let mut highest = f32::NEG_INFINITY;
    for _ in 0..128 {
        app.update();
        highest = highest.max(height(&app));
    }
    println!("jumped to {highest:.2}, landed at {:.2}", height(&app));
    assert!(highest > 3.5, "through the platform");
    assert!((height(&app) - 3.11).abs() < 2e-3, "on the platform");
}
