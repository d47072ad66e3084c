//! Tests of queries, in both dimensions.

use bevy_ecs::prelude::*;
use bevy_impinge::{Collider, CollisionLayers, Sensor, SpatialFilter, d2, d3};
use bevy_math::{Dir2, Dir3, Isometry2d, Isometry3d, Ray2d, Ray3d, Vec2, Vec3};

use crate::support::{app, at, ball, collisions, spawn};

#[test]
fn rays_shapes_and_points_in_3d() {
    let mut app = app::<3>();
    let (near, far) = (spawn::<3>(&mut app, 4.0), spawn::<3>(&mut app, 10.0));
    app.update();
    let (all, world) = (SpatialFilter::new(), collisions::<3>(&app));
    let ray = Ray3d::new(Vec3::ZERO, Dir3::X);
    let hit = world.cast_ray(ray, 100.0, &all).expect("in the way");
    assert_eq!(
        (hit.entity, hit.distance, hit.point, hit.normal),
        (near, 3.0, Vec3::X * 3.0, Vec3::NEG_X)
    );
    assert!(world.cast_ray(ray, 2.5, &all).is_none(), "too short");
    let hits: Vec<_> = world.cast_ray_all(ray, 100.0, &all).iter().map(|hit| hit.entity).collect();
    assert_eq!(hits, [near, far]);
    let not_near = SpatialFilter::new().exclude(near);
    assert_eq!(world.cast_ray(ray, 100.0, &not_near).map(|hit| hit.entity), Some(far));

    let (cube, here) = (d3::Collider::cuboid(2.0, 2.0, 2.0), Isometry3d::IDENTITY);
    let hit = world.cast_shape(&cube, here, Vec3::X * 8.0, &all).expect("in the way");
    assert_eq!((hit.entity, hit.fraction, hit.normal), (near, 0.25, Vec3::NEG_X));
    assert_eq!(hit.point, Vec3::X * 3.0, "on the entity");
    assert_eq!(world.cast_shape_all(&cube, here, Vec3::X * 20.0, &all).len(), 2);
    assert!(!world.overlaps_any(&cube, here, &all));
    let there = Isometry3d::from_translation(Vec3::X * 2.5);
    assert_eq!(world.overlapping(&cube, there, &all), [near]);

    assert_eq!(world.entities_at(Vec3::X * 4.5, &all), [near]);
    let point = world.nearest_point(Vec3::new(4.0, 3.0, 0.0), 10.0, &all).expect("near");
    assert_eq!((point.entity, point.point, point.distance), (near, Vec3::new(4.0, 1.0, 0.0), 2.0));
    let found = world.nearest_entities(&cube, here, (2, 100.0), &all);
    assert_eq!(found.iter().map(|near| near.distance).collect::<Vec<_>>(), [2.0, 8.0]);
    assert_eq!(found[0].points, Some([Vec3::X, Vec3::X * 3.0]));
}

#[test]
fn rays_shapes_and_points_in_2d() {
    let mut app = app::<2>();
    let (near, far) = (spawn::<2>(&mut app, 4.0), spawn::<2>(&mut app, 10.0));
    app.update();
    let (all, world) = (SpatialFilter::new(), collisions::<2>(&app));
    let ray = Ray2d::new(Vec2::ZERO, Dir2::X);
    let hit = world.cast_ray(ray, 100.0, &all).expect("in the way");
    assert_eq!((hit.entity, hit.distance, hit.normal), (near, 3.0, Vec2::NEG_X));
    let (square, here) = (d2::Collider::rectangle(2.0, 2.0), Isometry2d::IDENTITY);
    let hit = world.cast_shape(&square, here, Vec2::X * 8.0, &all).expect("in the way");
    assert_eq!((hit.entity, hit.fraction), (near, 0.25));
    let is_far = |entity: Entity| entity == far;
    let only_far = SpatialFilter::new().predicate(&is_far);
    let point = world.nearest_point(Vec2::new(10.0, 1.5), 10.0, &only_far).expect("near");
    assert_eq!((point.entity, point.distance), (far, 0.5));
    assert_eq!(world.overlapping(&square, Isometry2d::from_xy(7.0, 0.0), &all), []);
    assert_eq!(world.nearest_entities(&square, here, (9, 4.0), &all).len(), 1);
}

#[test]
fn filters_ask_layers_and_sensors() {
    let mut app = app::<3>();
    let sensor = app.world_mut().spawn((ball::<3>(), Sensor, at(0.0))).id();
    let wall = CollisionLayers::new(1 << 4, CollisionLayers::ALL);
    let wall = app.world_mut().spawn((ball::<3>(), wall, at(0.0))).id();
    app.update();
    let world = collisions::<3>(&app);
    let at_origin = |filter: SpatialFilter<'_>| world.entities_at(Vec3::ZERO, &filter);
    assert_eq!(at_origin(SpatialFilter::new()), [sensor, wall]);
    assert_eq!(at_origin(SpatialFilter::new().without_sensors()), [wall]);
    let but_walls = CollisionLayers::new(1, CollisionLayers::ALL & !(1 << 4));
    assert_eq!(at_origin(SpatialFilter::new().layers(but_walls)), [sensor]);
}

#[test]
fn contacts_are_seen_from_either_side() {
    let mut app = app::<3>();
    let floor = app.world_mut().spawn(d3::Collider::cuboid(20.0, 2.0, 20.0)).id();
    let cube = bevy_transform::prelude::Transform::from_xyz(0.0, 1.75, 0.0);
    let cube = app.world_mut().spawn((d3::Collider::cuboid(2.0, 2.0, 2.0), cube)).id();
    app.update();
    let world = collisions::<3>(&app);
    let from_cube: Vec<_> = world.contacts_with(cube).collect();
    assert_eq!(from_cube.len(), 1);
    let pair = &from_cube[0];
    assert_eq!((pair.entity, pair.other, pair.normal), (cube, floor, Vec3::NEG_Y));
    assert_eq!((pair.points.len(), pair.depth()), (4, 0.25));
    assert!(pair.points.iter().all(|point| point.point.y == 0.75 && point.other_point.y == 1.0));
    let from_floor: Vec<_> = world.contacts_with(floor).collect();
    assert_eq!(from_floor[0].normal, Vec3::Y);
    assert!(world.contact_pairs().eq(from_floor), "the floor was added first");
    assert_eq!((world.touching(cube), world.touching(floor)), (vec![floor], vec![cube]));
}

#[test]
fn bad_questions_find_nothing() {
    let mut app = app::<3>();
    let entity = spawn::<3>(&mut app, 0.0);
    app.update();
    let (all, world) = (SpatialFilter::new(), collisions::<3>(&app));
    let (bad, here) = (Collider::<3>::sphere(-1.0), Isometry3d::IDENTITY);
    assert!(world.cast_shape(&bad, here, Vec3::X, &all).is_none());
    assert!(
        world.overlapping(&bad, here, &all).is_empty() && !world.overlaps_any(&bad, here, &all)
    );
    let nowhere = Isometry3d::from_translation(Vec3::NAN);
    assert!(!world.overlaps_any(&ball::<3>(), nowhere, &all));
    assert!(world.nearest_point(Vec3::NAN, 1.0, &all).is_none());
    assert!(world.entities_at(Vec3::INFINITY, &all).is_empty());
    let stranger = Entity::PLACEHOLDER;
    assert!(world.touching(stranger).is_empty() && !world.are_touching(entity, stranger));
    assert!(world.contacts_with(stranger).next().is_none() && world.pose(stranger).is_none());
}
