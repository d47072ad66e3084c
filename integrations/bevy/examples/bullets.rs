//! Bullets that do not tunnel: each casts its shape along its path, which is many times longer than the thickness of
//! the wall.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d3::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::{Fixed as FixedTime, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

#[derive(Component)]
struct Bullet {
    velocity: Vec3,
    owner: Entity,
}

#[derive(Component)]
struct Health(i32);

const BULLETS: u32 = 1 << 1;

fn fly(
    mut bullets: Query<(Entity, &Bullet, &Collider, &mut Transform)>,
    mut targets: Query<&mut Health>,
    collisions: Res<Collisions>,
    time: Res<Time<FixedTime>>,
    mut commands: Commands,
) {
    // Bullets interact with everything but bullets.
    let layers = CollisionLayers::new(BULLETS, CollisionLayers::ALL & !BULLETS);
    for (entity, bullet, collider, mut transform) in &mut bullets {
        let motion = bullet.velocity * time.delta_secs();
        let filter = SpatialFilter::new().layers(layers).exclude(bullet.owner).without_sensors();
        let at = Isometry3d::from_translation(transform.translation);
        let Some(hit) = collisions.cast_shape(collider, at, motion, &filter) else {
            transform.translation += motion;
            continue;
        };
        if let Ok(mut health) = targets.get_mut(hit.entity) {
            health.0 -= 1;
        }
        commands.entity(entity).despawn();
    }
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .add_systems(FixedUpdate, fly);
    let world = app.world_mut();
    let owner = world.spawn((Collider::sphere(1.0), Health(10))).id();
    let at = Transform::from_xyz(50.0, 0.0, 0.0);
    let pane = world.spawn((Collider::cuboid(0.01, 8.0, 8.0), FixedCollider, Health(10), at)).id();
    let behind = (Collider::sphere(4.0), Health(10), Transform::from_xyz(60.0, 0.0, 0.0));
    let behind = world.spawn(behind).id();
    app.update();
    for n in 0..8_u8 {
        let velocity = Vec3::new(900.0, 0.0, f32::from(n));
        let layers = CollisionLayers::new(BULLETS, CollisionLayers::ALL & !BULLETS);
        app.world_mut().spawn((Bullet { velocity, owner }, Collider::sphere(0.05), layers));
    }
    for _ in 0..16 {
        app.update();
    }

    let health = |entity| app.world().get::<Health>(entity).map(|health| health.0);
    println!("owner {:?}, pane {:?}, behind it {:?}", health(owner), health(pane), health(behind));
    assert_eq!(health(owner), Some(10), "nobody shoots themselves");
    assert_eq!(health(pane), Some(2), "14 lengths of way per step, and a pane of a hundredth");
    assert_eq!(health(behind), Some(10), "nothing came through");
    assert_eq!(app.world().resource::<Collisions>().len(), 3, "the bullets are gone");
}
