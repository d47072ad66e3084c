//! Tests that invalid input does not panic, loses no entity, and gives an error.

use bevy_app::App;
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::prelude::*;
use bevy_impinge::{Collider, ColliderError, ColliderFailed, ColliderProblem, Glam};
use bevy_math::Vec3;
use bevy_transform::prelude::*;

use crate::support::{app, at, ball, collisions, place, spawn, told};

fn problem<const D: usize>(app: &App, entity: Entity) -> Option<ColliderError> {
    app.world().get::<ColliderProblem<D>>(entity).map(|problem| problem.error)
}

fn failures<const D: usize>(app: &mut App) -> usize {
    app.world_mut().resource_mut::<Messages<ColliderFailed<D>>>().drain().count()
}

fn a_nan_keeps_the_last_pose<const D: usize>()
where
    f32: Glam<D>,
{
    let mut app = app::<D>();
    let (a, b) = (spawn::<D>(&mut app, 0.0), spawn::<D>(&mut app, 1.0));
    app.update();
    assert_eq!(told::<D>(&mut app), [(true, a, b)]);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        place(&mut app, b, at(bad));
        app.update();
        assert!(matches!(problem::<D>(&app, b), Some(ColliderError::Pose(_))), "{bad}");
        assert_eq!(failures::<D>(&mut app), 1, "told");
        assert_eq!(told::<D>(&mut app), [], "nothing is lost");
        assert!(collisions::<D>(&app).are_touching(a, b), "where it was");
        place(&mut app, b, at(bad));
        app.update();
        assert_eq!(failures::<D>(&mut app), 0, "but once");
        place(&mut app, b, at(1.5));
        app.update();
        assert_eq!(problem::<D>(&app, b), None, "good again");
    }
    place(&mut app, b, at(9.0));
    app.update();
    assert_eq!(told::<D>(&mut app), [(false, a, b)]);
    assert_eq!(collisions::<D>(&app).world().validate(), Ok(()));
}

#[test]
fn a_transform_that_becomes_nan_keeps_the_last_pose() {
    a_nan_keeps_the_last_pose::<2>();
    a_nan_keeps_the_last_pose::<3>();
}

#[test]
fn bad_rotations_and_scales_are_problems() {
    let mut app = app::<3>();
    let nan = bevy_math::Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0);
    let long = bevy_math::Quat::from_xyzw(0.0, 0.0, 0.0, 2.0);
    for rotation in [nan, long, bevy_math::Quat::from_xyzw(0.0, 0.0, 0.0, 0.0)] {
        let entity = app.world_mut().spawn((ball::<3>(), at(0.0).with_rotation(rotation))).id();
        app.update();
        assert!(matches!(problem::<3>(&app, entity), Some(ColliderError::Pose(_))), "{rotation}");
        assert!(!collisions::<3>(&app).contains(entity));
    }
    for factor in [0.0, f32::NAN, f32::INFINITY] {
        let scaled = at(0.0).with_scale(Vec3::new(factor, 1.0, 1.0));
        let cuboid = Collider::<3>::cuboid(1.0, 1.0, 1.0);
        let entity = app.world_mut().spawn((cuboid, scaled)).id();
        app.update();
        assert!(matches!(problem::<3>(&app, entity), Some(ColliderError::Scale(_))), "{factor}");
    }
}

#[test]
fn children_of_bad_parents_are_problems_in_both_dimensions() {
    let mut app = app::<3>();
    app.add_plugins(bevy_impinge::ImpingePlugin::<2>::default().in_schedule(bevy_app::Update));
    for bad in [
        at(f32::NAN),
        at(0.0).with_scale(Vec3::ZERO),
        at(0.0).with_scale(Vec3::splat(f32::NAN)),
        at(0.0).with_rotation(bevy_math::Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)),
    ] {
        let parent = app.world_mut().spawn(bad).id();
        let child =
            app.world_mut().spawn((ball::<2>(), ball::<3>(), at(1.0), ChildOf(parent))).id();
        app.update();
        assert!(
            problem::<2>(&app, child).is_some() && problem::<3>(&app, child).is_some(),
            "{bad:?}"
        );
        place(&mut app, parent, at(1.0));
        app.update();
        assert_eq!((problem::<2>(&app, child), problem::<3>(&app, child)), (None, None));
        assert!(collisions::<2>(&app).contains(child) && collisions::<3>(&app).contains(child));
    }
}

#[test]
fn a_collider_with_an_error_waits_for_a_better_one() {
    let mut app = app::<3>();
    let entity = app.world_mut().spawn((Collider::<3>::sphere(-1.0), at(0.0))).id();
    app.update();
    assert!(matches!(problem::<3>(&app, entity), Some(ColliderError::Shape(_))));
    assert_eq!(failures::<3>(&mut app), 1);
    for x in [1.0, 2.0] {
        place(&mut app, entity, at(x));
        app.update();
    }
    assert_eq!(failures::<3>(&mut app), 0, "told once");
    app.world_mut().entity_mut(entity).insert(Collider::<3>::sphere(1.0));
    app.update();
    assert_eq!(problem::<3>(&app, entity), None);
    assert_eq!(collisions::<3>(&app).pose(entity).map(|pose| pose.translation.x), Some(2.0));

    app.world_mut().entity_mut(entity).insert(Collider::<3>::sphere(f32::NAN));
    app.update();
    assert!(problem::<3>(&app, entity).is_some() && collisions::<3>(&app).contains(entity));
    app.world_mut().entity_mut(entity).remove::<Collider<3>>();
    app.update();
    assert_eq!(problem::<3>(&app, entity), None, "without a collider there is no problem");
}

#[test]
fn a_collider_that_is_mended_while_disabled_has_no_problem() {
    let mut app = app::<3>();
    let stretched = at(0.0).with_scale(Vec3::new(1.0, 2.0, 1.0));
    let capsule = Collider::<3>::capsule(0.5, 1.0);
    let entity = app.world_mut().spawn((capsule, stretched)).id();
    app.update();
    assert!(matches!(problem::<3>(&app, entity), Some(ColliderError::Scale(_))));
    app.world_mut().entity_mut(entity).insert(Disabled);
    assert_eq!(problem::<3>(&app, entity), None, "a disabled entity is not in the world");
    place(&mut app, entity, at(0.0));
    app.world_mut().entity_mut(entity).remove::<Disabled>();
    app.update();
    assert_eq!(problem::<3>(&app, entity), None);
    assert!(collisions::<3>(&app).contains(entity));
}

#[test]
fn a_collider_that_stays_broken_while_disabled_is_a_problem_again() {
    let mut app = app::<3>();
    let entity = app.world_mut().spawn((Collider::<3>::sphere(-1.0), at(0.0), Disabled)).id();
    app.update();
    assert_eq!(problem::<3>(&app, entity), None);
    for _ in 0..2 {
        app.world_mut().entity_mut(entity).remove::<Disabled>();
        app.update();
        assert!(matches!(problem::<3>(&app, entity), Some(ColliderError::Shape(_))));
        assert_eq!(failures::<3>(&mut app), 1, "told each time it is enabled");
        app.world_mut().entity_mut(entity).insert(Disabled);
        app.update();
    }
}

#[test]
fn huge_and_tiny_numbers_do_not_panic() {
    let mut app = app::<3>();
    for size in [1e-30, 1e-10, 1e10, 1e30, f32::MAX] {
        for x in [1e-30, 1.0, 1e30, f32::MAX] {
            let collider = Collider::<3>::cuboid(size, size, size);
            app.world_mut().spawn((collider, Transform::from_xyz(x, -x, x)));
        }
    }
    app.update();
    app.update();
    assert_eq!(collisions::<3>(&app).world().validate(), Ok(()));
}
