//! Tests of transforms: hierarchies, scale, parents that change.

use std::f32::consts::{FRAC_PI_2, PI};

use bevy_ecs::prelude::*;
use bevy_impinge::{Collider, ColliderError, ColliderProblem};
use bevy_math::{Quat, Vec2, Vec3};
use bevy_transform::prelude::*;

use crate::support::{app, at, ball, collisions, place};

fn translation(app: &bevy_app::App, entity: Entity) -> Vec3 {
    collisions::<3>(app).pose(entity).expect("it is in the world").translation.into()
}

#[test]
fn children_follow_in_the_same_step() {
    let mut app = app::<3>();
    let parent = app.world_mut().spawn(at(10.0)).id();
    let middle = app.world_mut().spawn((at(1.0), ChildOf(parent))).id();
    let child = app.world_mut().spawn((ball::<3>(), at(2.0), ChildOf(middle))).id();
    app.update();
    assert_eq!(translation(&app, child), Vec3::new(13.0, 0.0, 0.0), "at once");
    place(&mut app, parent, at(-10.0).with_rotation(Quat::from_rotation_z(FRAC_PI_2)));
    app.update();
    let expected = Vec3::new(-10.0, 3.0, 0.0);
    assert!((translation(&app, child) - expected).length() < 1e-5, "a parent without a collider");
}

#[test]
fn parents_change() {
    let mut app = app::<3>();
    let (one, other) = (app.world_mut().spawn(at(10.0)).id(), app.world_mut().spawn(at(20.0)).id());
    let child = app.world_mut().spawn((ball::<3>(), at(1.0))).id();
    app.update();
    assert_eq!(translation(&app, child).x, 1.0);
    for (parent, x) in [(one, 11.0), (other, 21.0)] {
        app.world_mut().entity_mut(child).insert(ChildOf(parent));
        app.update();
        assert_eq!(translation(&app, child).x, x);
    }
    app.world_mut().entity_mut(child).remove::<ChildOf>();
    app.world_mut().clear_trackers();
    app.world_mut().clear_trackers();
    app.update();
    assert_eq!(translation(&app, child).x, 1.0, "an orphan");
}

#[test]
fn roots_keep_their_numbers() {
    let mut app = app::<3>();
    let rotation = Quat::from_xyzw(0.1, 0.2, 0.3, 0.4).normalize();
    let transform = Transform::from_xyz(0.1, 0.2, 0.3).with_rotation(rotation);
    let entity = app.world_mut().spawn((ball::<3>(), transform)).id();
    app.update();
    let pose = collisions::<3>(&app).pose(entity).expect("it is in the world");
    assert_eq!((Vec3::from(pose.translation), pose.rotation), (transform.translation, rotation));
}

/// Returns the height at which a vertical ray from above, at `x` and z = 0, first hits a collider.
fn top(app: &bevy_app::App, x: f32) -> f32 {
    let ray = bevy_math::Ray3d::new(Vec3::new(x, 100.0, 0.0), bevy_math::Dir3::NEG_Y);
    let hit = collisions::<3>(app).cast_ray(ray, 200.0, &bevy_impinge::SpatialFilter::new());
    hit.expect("it is below").point.y
}

#[test]
fn scale_is_applied_and_follows() {
    let mut app = app::<3>();
    let cuboid = Collider::<3>::cuboid(2.0, 2.0, 2.0);
    let scaled = at(0.0).with_scale(Vec3::new(1.0, 3.0, 1.0));
    let entity = app.world_mut().spawn((cuboid, scaled)).id();
    app.update();
    assert_eq!(top(&app, 0.0), 3.0);
    place(&mut app, entity, scaled.with_scale(Vec3::splat(0.5)));
    app.update();
    assert_eq!(top(&app, 0.0), 0.5);

    // The parent is scaled and the child is rotated by a right angle, so the scale causes no shear.
    let parent = app.world_mut().spawn(at(20.0).with_scale(Vec3::new(4.0, 1.0, 1.0))).id();
    let turned = Transform::from_rotation(Quat::from_rotation_z(FRAC_PI_2));
    let long = Collider::<3>::cuboid(2.0, 6.0, 2.0);
    app.world_mut().spawn((long, turned, ChildOf(parent)));
    app.update();
    assert!((top(&app, 20.0) - 1.0).abs() < 1e-5, "thin");
    assert!((top(&app, 31.5) - 1.0).abs() < 1e-5, "three times four long");
}

#[test]
fn a_capsule_below_turning_parents_remains_one() {
    let mut app = app::<3>();
    let parent = app.world_mut().spawn(at(0.0).with_scale(Vec3::splat(0.3))).id();
    let child =
        app.world_mut().spawn((Collider::<3>::capsule(1.0, 2.0), at(2.0), ChildOf(parent))).id();
    for step in 0..200_u8 {
        let angle = f32::from(step) * 0.37;
        let rotation = Quat::from_euler(bevy_math::EulerRot::XYZ, angle, 2.0 * angle, 0.5 * angle);
        place(&mut app, parent, at(0.0).with_rotation(rotation).with_scale(Vec3::splat(0.3)));
        app.update();
        let problem = app.world().get::<ColliderProblem<3>>(child);
        assert_eq!(problem, None, "at step {step}");
    }
    let object = collisions::<3>(&app).world().collision_objects().next().expect("one");
    let aabb = object.shape().local_aabb();
    assert!((aabb.maxs().x - 0.3).abs() < 1e-5, "scaled by the parent: {aabb:?}");
}

#[test]
fn mirrors_turn_shapes_over() {
    let mut app = app::<3>();
    let wedge = [Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 2.0, Vec3::Z];
    let mirrored = at(0.0).with_scale(Vec3::new(-1.0, 1.0, 1.0));
    app.world_mut().spawn((Collider::<3>::convex_hull(wedge), mirrored));
    app.update();
    let holds = |x: f32| {
        let at = Vec3::new(x, 0.1, 0.1);
        !collisions::<3>(&app).entities_at(at, &bevy_impinge::SpatialFilter::new()).is_empty()
    };
    assert!(holds(-2.0) && !holds(2.0));
}

#[test]
fn a_scale_that_a_shape_does_not_have_is_a_problem_and_ends() {
    let mut app = app::<3>();
    let entity = app.world_mut().spawn((Collider::<3>::capsule(1.0, 2.0), at(5.0))).id();
    app.update();
    place(&mut app, entity, at(5.0).with_scale(Vec3::new(1.0, 2.0, 1.0)));
    app.update();
    let problem = app.world().get::<ColliderProblem<3>>(entity).expect("an oval capsule");
    assert!(matches!(problem.error, ColliderError::Scale(_)), "{}", problem.error);
    assert!(collisions::<3>(&app).contains(entity), "as it was");
    place(&mut app, entity, at(6.0).with_scale(Vec3::splat(2.0)));
    app.update();
    assert!(app.world().get::<ColliderProblem<3>>(entity).is_none(), "round again");
    assert_eq!((top(&app, 6.0), translation(&app, entity).x), (4.0, 6.0));
}

#[test]
fn a_shearing_parent_is_a_problem() {
    let mut app = app::<3>();
    let parent = app.world_mut().spawn(at(0.0).with_scale(Vec3::new(4.0, 1.0, 1.0))).id();
    let turned = Transform::from_rotation(Quat::from_rotation_z(0.5));
    let child = (Collider::<3>::cuboid(1.0, 1.0, 1.0), turned, ChildOf(parent));
    let child = app.world_mut().spawn(child).id();
    app.update();
    let problem = app.world().get::<ColliderProblem<3>>(child).map(|problem| problem.error);
    assert_eq!(problem, Some(ColliderError::Sheared));
}

#[test]
fn the_plane_takes_turns_about_z_and_half_turns() {
    let mut app = app::<2>();
    let wedge = [Vec2::ZERO, Vec2::X * 4.0, Vec2::Y * 2.0];
    let spawn = |app: &mut bevy_app::App, transform| {
        app.world_mut().spawn((Collider::<2>::convex_hull(wedge), transform)).id()
    };
    let holds = |app: &bevy_app::App, x: f32, y: f32| {
        let filter = bevy_impinge::SpatialFilter::new();
        !collisions::<2>(app).entities_at(Vec2::new(x, y), &filter).is_empty()
    };
    let turned = spawn(&mut app, Transform::from_rotation(Quat::from_rotation_z(FRAC_PI_2)));
    app.update();
    assert!(holds(&app, -0.1, 2.0) && !holds(&app, 2.0, 0.1), "a quarter turn");
    app.world_mut().despawn(turned);
    let flipped = spawn(&mut app, Transform::from_rotation(Quat::from_rotation_y(PI)));
    app.update();
    assert!(holds(&app, -2.0, 0.1) && !holds(&app, 2.0, 0.1), "a mirror, as sprites are flipped");
    app.world_mut().despawn(flipped);
    let tilted = spawn(&mut app, Transform::from_rotation(Quat::from_rotation_y(0.5)));
    app.update();
    let problem = app.world().get::<ColliderProblem<2>>(tilted).map(|problem| problem.error);
    assert_eq!(problem, Some(ColliderError::OutOfPlane));
    let deep = Transform::from_xyz(9.0, 0.0, 700.0);
    spawn(&mut app, deep);
    app.update();
    assert!(holds(&app, 10.0, 0.1), "z does not matter");
}
