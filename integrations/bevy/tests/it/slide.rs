//! Tests of characters that move and slide.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_impinge::d3::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec2, Vec3};
use bevy_transform::prelude::*;

use crate::support::app;

const SKIN: f32 = 0.01;

fn slide(app: &App, from: Vec3, motion: Vec3) -> bevy_impinge::Slide<3> {
    let collisions = app.world().resource::<Collisions>();
    let (ball, at) = (Collider::sphere(0.5), Isometry3d::from_translation(from));
    let (settings, filter) = (SlideSettings::with_skin(SKIN), SpatialFilter::new());
    collisions.move_and_slide(&ball, at, motion, &settings, &filter)
}

fn near(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-4
}

fn with_walls(walls: &[(Vec3, Vec3)]) -> App {
    let mut app = app::<3>();
    for &(normal, at) in walls {
        app.world_mut()
            .spawn((Collider::half_space(normal.normalize()), Transform::from_translation(at)));
    }
    app.update();
    app
}

#[test]
fn free_motions_are_not_changed() {
    let app = with_walls(&[]);
    let motion = Vec3::new(0.1, 0.2, 0.3);
    let free = slide(&app, Vec3::ONE, motion);
    assert_eq!((free.motion, free.rest, free.hits.len()), (motion, Vec3::ZERO, 0));
}

#[test]
fn a_floor_stops_the_fall_alone_step_after_step() {
    let app = with_walls(&[(Vec3::Y, Vec3::ZERO)]);
    let mut at = Vec3::new(0.0, 3.0, 0.0);
    for _ in 0..200 {
        at += slide(&app, at, Vec3::new(0.25, -0.1, 0.0)).motion;
        assert!(at.y >= 0.5 + SKIN - 1e-5, "never nearer: {at}");
    }
    assert!((at.x - 50.0).abs() < 1e-2 && (at.y - 0.5 - SKIN).abs() < 1e-4, "{at}");
}

#[test]
fn a_wall_beside_the_way_stops_nothing() {
    let app = with_walls(&[(Vec3::new(-0.8, 0.0, 0.6), Vec3::ZERO)]);
    let collisions = app.world().resource::<Collisions>();
    let straight = SlideSettings { max_hits: 1, ..SlideSettings::with_skin(SKIN) };
    let (ball, filter) = (Collider::sphere(0.5), SpatialFilter::new());
    let mut at = Vec3::new(-3.0, 0.0, 1.7);
    for step in 0..100 {
        at += slide(&app, at, Vec3::new(0.3, 0.0, 0.07)).motion;
        let down = Vec3::new(0.0, -0.7, 0.0);
        let pose = Isometry3d::from_translation(at);
        let fall = collisions.move_and_slide(&ball, pose, down, &straight, &filter);
        assert!(near(fall.motion, down), "step {step}: {fall:?}");
        at += fall.motion;
    }
    assert!(at.x > 5.0, "along the wall: {at}");
}

#[test]
fn two_walls_leave_their_edge_and_three_nothing() {
    let two = [(Vec3::NEG_X, Vec3::X * 2.0), (Vec3::NEG_Z, Vec3::Z * 2.0)];
    let app = with_walls(&two);
    let found = slide(&app, Vec3::ZERO, Vec3::new(4.0, 3.0, 4.0));
    let end = 1.5 - SKIN;
    assert!(near(found.motion, Vec3::new(end, 3.0, end)), "{found:?}");
    let three = [two[0], two[1], (Vec3::NEG_Y, Vec3::Y * 2.0)];
    let found = slide(&with_walls(&three), Vec3::ZERO, Vec3::new(4.0, 3.5, 4.5));
    assert!(near(found.motion, Vec3::splat(end)) && found.rest == Vec3::ZERO, "{found:?}");
}

#[test]
fn a_wedge_of_walls_stops_it() {
    // Walls at 60° to each other: a motion along either leads into the other.
    let walls =
        [(Vec3::new(-0.5, 0.0, 0.866), Vec3::ZERO), (Vec3::new(-0.5, 0.0, -0.866), Vec3::ZERO)];
    let app = with_walls(&walls);
    let found = slide(&app, Vec3::new(-5.0, 0.0, 0.1), Vec3::X * 50.0);
    // The centre stays 0.51 from both planes.
    let end = Vec3::new(-5.0, 0.0, 0.1) + found.motion;
    assert!((end.x + 0.51 / 0.5).abs() < 1e-2 && end.z.abs() < 1e-2, "{end}");
    let up = slide(&app, Vec3::new(-5.0, 0.0, 0.1), Vec3::new(50.0, 1.0, 0.0));
    assert!(up.motion.y > 0.9, "but upwards is free: {up:?}");
}

#[test]
fn sensors_stop_nothing_and_meshes_have_no_inner_edges() {
    let mut app = app::<3>();
    app.world_mut().spawn((
        Collider::cuboid(1.0, 9.0, 9.0),
        Sensor,
        Transform::from_xyz(2.0, 0.0, 0.0),
    ));
    let floor = Collider::heightfield(9, 9, vec![0.0; 81], Vec3::new(40.0, 1.0, 40.0));
    app.world_mut().spawn((floor, FixedCollider));
    app.update();
    let mut at = Vec3::new(-9.0, 0.5 + SKIN, 0.3);
    for _ in 0..100 {
        at += slide(&app, at, Vec3::new(0.15, -0.05, 0.02)).motion;
    }
    assert!((at.x - 6.0).abs() < 1e-2 && (at.y - 0.5 - SKIN).abs() < 1e-3, "{at}");
}

#[test]
fn bad_input_goes_nowhere() {
    let app = with_walls(&[(Vec3::Y, Vec3::ZERO)]);
    let collisions = app.world().resource::<Collisions>();
    let (settings, filter) = (SlideSettings::default(), SpatialFilter::new());
    let bad = Collider::sphere(f32::NAN);
    let found = collisions.move_and_slide(&bad, Isometry3d::IDENTITY, Vec3::X, &settings, &filter);
    assert_eq!((found.motion, found.rest), (Vec3::ZERO, Vec3::X), "a shape with an error");
}

#[test]
fn the_plane_slides_too() {
    use bevy_impinge::d2;

    let mut app = app::<2>();
    let slope = Transform::from_rotation(Quat::from_rotation_z(0.5));
    app.world_mut().spawn((d2::Collider::half_plane(Vec2::Y), slope));
    app.update();
    let collisions = app.world().resource::<d2::Collisions>();
    let (ball, at) = (d2::Collider::circle(0.5), bevy_math::Isometry2d::from_xy(0.0, 2.0));
    let (settings, filter) = (SlideSettings::default(), SpatialFilter::new());
    let found = collisions.move_and_slide(&ball, at, Vec2::new(0.0, -10.0), &settings, &filter);
    let along = Vec2::from_angle(0.5);
    assert!(found.motion.dot(along) < -2.0, "down the slope: {found:?}");
    assert_eq!(found.hits.len(), 1);
    let entity = found.hits[0].entity;
    assert!(collisions.contains(entity) && entity != Entity::PLACEHOLDER);
}
