//! A rover on a height field: rays find the ground below it, and contacts report when a falling
//! stone has landed.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d3::prelude::*;
use bevy_math::{Dir3, Ray3d, Vec3};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

#[derive(Component)]
struct Rover;

#[derive(Component)]
struct Stone;

/// Returns rows of heights at distances of 1: hills with a wavelength of 8.
fn heights(count: u16) -> Vec<f32> {
    let hill = |n: u16| (f32::from(n) * std::f32::consts::TAU / 8.0).sin();
    (0..count)
        .flat_map(|row| (0..count).map(move |column| hill(row) + 0.5 * hill(column)))
        .collect()
}

/// Drives along x, half a unit above the ground.
fn drive(mut rovers: Query<(Entity, &mut Transform), With<Rover>>, collisions: Res<Collisions>) {
    for (entity, mut transform) in &mut rovers {
        transform.translation.x += 0.125;
        let above = transform.translation.with_y(10.0);
        let down = Ray3d::new(above, Dir3::NEG_Y);
        let filter = SpatialFilter::new().exclude(entity);
        if let Some(ground) = collisions.cast_ray(down, 20.0, &filter) {
            transform.translation.y = ground.point.y + 0.5;
        }
    }
}

fn fall(mut stones: Query<(Entity, &mut Transform), With<Stone>>, collisions: Res<Collisions>) {
    for (entity, mut transform) in &mut stones {
        if collisions.contacts_with(entity).next().is_none() {
            transform.translation.y -= 0.0625;
        }
    }
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .add_systems(FixedUpdate, (drive, fall));
    let world = app.world_mut();
    let ground = Collider::heightfield(33, 33, heights(33), Vec3::new(32.0, 1.0, 32.0));
    world.spawn((ground, FixedCollider));
    let rover = (Rover, Collider::cuboid(0.8, 0.4, 0.4), Transform::from_xyz(-12.0, 5.0, 0.0));
    let rover = world.spawn(rover).id();
    let stone = (Stone, Collider::sphere(0.25), Transform::from_xyz(6.0, 4.0, 2.0));
    let stone = world.spawn(stone).id();

    // The first frame has no elapsed time, so the world does not step. After its first step, in the
    // second frame, the world has the ground.
    for _ in 0..2 {
        app.update();
    }
    let mut profile = String::new();
    for _ in 0..128 {
        app.update();
        let at = app.world().get::<Transform>(rover).map_or(Vec3::NAN, |at| at.translation);
        profile.push(['_', '.', '-', '^'][((at.y + 0.5).clamp(0.0, 1.99) * 2.0) as usize]);
        assert!((-0.01..=1.01).contains(&at.y), "half a unit above hills of half a unit: {at}");
    }
    println!("{profile}");
    let collisions = app.world().resource::<Collisions>();
    let contact = collisions.contacts_with(stone).next().expect("the stone lies on the ground");
    println!(
        "the stone lies {:.3} deep, the ground is towards {:.2}",
        contact.depth(),
        contact.normal
    );
    assert!(contact.normal.y < -0.5, "below it");
    assert!((0.0..=0.0625).contains(&contact.depth()), "by one step at most");
}
