//! Tests that directions and rotations whose length is not 1 are refused, and that the error
//! reports the length.

use impinge::math::na::{
    Complex, Quaternion, Translation2, Translation3, UnitComplex, UnitQuaternion,
};
use impinge::math::{Isometry2, Isometry3, Real, Space, Unit, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Ball, Compound, HalfSpace, ShapeError, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld, WorldError};

fn along<N: Real, const D: usize>(axis: usize, length: f64) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|row, _| N::lit(if row == axis { length } else { 0.0 }))
}

fn half_spaces<N: Real, const D: usize>() {
    let zero = Unit::new_normalize(Vector::<N, D>::zeros());
    let refused = HalfSpace::<N, D>::try_new(zero).expect_err("no direction");
    let is_named =
        matches!(refused, ShapeError::NotFinite { what: "the normal", value } if value.is_nan());
    assert!(is_named, "{refused:?}");
    for length in [0.0, 0.5, 0.98, 1.02, 2.0, 1e10] {
        let normal = Unit::new_unchecked(along::<N, D>(D - 1, length));
        let refused = HalfSpace::<N, D>::try_new(normal).expect_err("not of length 1");
        let ShapeError::NotUnit { what: "the normal", length: named } = refused else {
            panic!("{refused:?}")
        };
        assert!((named - length).abs() <= 1e-6 * length, "{named}");
    }
    for digits in [1.0, 0.99999, 1.0005] {
        let normal = Unit::new_unchecked(along::<N, D>(0, digits));
        assert!(HalfSpace::<N, D>::try_new(normal).is_ok(), "{digits} is rounding that adds up");
    }
}

#[test]
fn half_spaces_without_a_direction_are_refused() {
    half_spaces::<f32, 2>();
    half_spaces::<f32, 3>();
    half_spaces::<f64, 2>();
    half_spaces::<f64, 3>();
}

#[test]
#[should_panic(expected = "the normal is NaN")]
fn half_spaces_without_a_direction_panic() {
    let _ = HalfSpace::<f32, 3>::new(Unit::new_normalize(Vector::<f32, 3>::zeros()));
}

/// Asserts that compounds and worlds refuse a position whose rotation does not have unit length,
/// and report that length.
fn positions<N: Space<D>, const D: usize>(good: N::Isometry, bad: N::Isometry, expected: f64) {
    let ball = || ShapeHandle::<N, D>::new(Ball::new(N::ONE));
    let refused = Compound::<N, D>::try_new(vec![(good, ball()), (bad, ball())]);
    match refused.expect_err("no rotation") {
        ShapeError::ChildRotation { index: 1, length } => {
            assert!((length - expected).abs() <= 1e-6 * expected, "{length}");
        }
        other => panic!("{other:?}"),
    }
    let is_named = |error: WorldError, is_new: bool| match error {
        WorldError::Rotation { handle, length } => {
            assert_eq!(handle.is_none(), is_new, "the object is named");
            assert!((length - expected).abs() <= 1e-6 * expected, "{length}");
        }
        other => panic!("{other:?}"),
    };
    let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.02));
    let (groups, query) = (CollisionGroups::new(), GeometricQueryType::Proximity(N::ZERO));
    is_named(world.try_add(bad, ball(), groups, query, ()).expect_err("no rotation"), true);
    let handle = world.try_add(good, ball(), groups, query, ()).expect("a position");
    is_named(world.try_set_position(handle, bad).expect_err("no rotation"), false);
    is_named(world.try_set_positions(&[(handle, bad)]).expect_err("no rotation"), false);
    for (at, next) in [(bad, good), (good, bad)] {
        let refused = world.try_set_position_with_prediction(handle, at, next);
        is_named(refused.expect_err("no rotation"), false);
    }
    assert!(world.try_set_position(handle, good).is_ok(), "a position");
}

fn positions2<N: Space<2, Isometry = Isometry2<N>>>() {
    let at = |re: f64, im: f64| {
        let turn = UnitComplex::new_unchecked(Complex::new(N::lit(re), N::lit(im)));
        Isometry2::from_parts(Translation2::new(N::ONE, N::ZERO), turn)
    };
    for (re, im) in [(0.0, 0.0), (2.0, 0.0), (0.6, 0.7), (0.0, -0.9)] {
        positions::<N, 2>(at(0.6, 0.8), at(re, im), f64::hypot(re, im));
    }
}

fn positions3<N: Space<3, Isometry = Isometry3<N>>>() {
    let at = |w: f64, i: f64, j: f64, k: f64| {
        let [w, i, j, k] = [w, i, j, k].map(N::lit);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation3::new(N::ONE, N::ZERO, N::ZERO), turn)
    };
    for [w, i, j, k] in [[0.0; 4], [2.0, 0.0, 0.0, 0.0], [1.0; 4], [0.7, 0.0, 0.7, 0.0]] {
        let length = [w, i, j, k].map(|x: f64| x * x).iter().sum::<f64>().sqrt();
        positions::<N, 3>(at(0.6, 0.0, 0.8, 0.0), at(w, i, j, k), length);
    }
}

#[test]
fn positions_without_a_rotation_are_refused() {
    positions2::<f32>();
    positions2::<f64>();
    positions3::<f32>();
    positions3::<f64>();
}
