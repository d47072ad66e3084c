//! The library's algorithms used alone, without a world, and the helpers that all tests of this
//! folder share.

use super::dim::math::{DIM, Isometry, Real, Rotation, Translation, Vector};
use super::dim::narrow_phase::{
    ContactDispatcher, ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher,
    DefaultProximityDispatcher, IdAllocator, PairManifoldGenerator, PairProximityDetector,
    ProximityDetector, ProximityDispatcher,
};
use super::dim::query::Proximity;
use super::dim::shape::{Ball, Cuboid};

/// Returns the vector with these first two coordinates; the others are zero.
pub(super) fn vector<N: Real>(x: f64, y: f64) -> Vector<N> {
    let mut vector = Vector::<N>::zeros();
    (vector[0], vector[1]) = (N::lit(x), N::lit(y));
    vector
}

/// Returns the pose at `(x, y)`, without rotation.
pub(super) fn at<N: Real>(x: f64, y: f64) -> Isometry<N> {
    Isometry::from_parts(Translation::from(vector::<N>(x, y)), Rotation::identity())
}

pub(super) fn cube<N: Real>(half: f64) -> Cuboid<N> {
    Cuboid::new(Vector::repeat(N::lit(half)))
}

/// Tests a cube that slides 1/16 above a floor. Asserts that depth and normal have the values
/// computed by hand, that the contact ids persist, and that the boxed algorithm gives the same
/// manifolds as the generator.
fn contacts_alone<N: Real>() {
    let dispatcher = DefaultContactDispatcher::new();
    let (floor, cube) = (cube::<N>(2.0), cube::<N>(0.5));
    let mut boxed = dispatcher.get_contact_algorithm(&floor, &cube).expect("an algorithm");
    let mut plain = PairManifoldGenerator::<N>::default();
    let (mut ids, mut other_ids) = (IdAllocator::new(), IdAllocator::new());
    let prediction = ContactPrediction::new(N::lit(0.125), N::ZERO, N::ZERO);
    let mut names = Vec::new();
    for step in 0..20 {
        let place = at::<N>(0.05 * f64::from(step), 2.5625);
        let here = at::<N>(0.0, 0.0);
        let done = boxed.update(&dispatcher, &here, &floor, &place, &cube, &prediction, &mut ids);
        assert!(done, "any two solids");
        let done = ContactManifoldGenerator::update(
            &mut plain,
            &dispatcher,
            &here,
            &floor,
            &place,
            &cube,
            &prediction,
            &mut other_ids,
        );
        assert!(done, "any two solids");
        let (mut manifolds, mut others) = (Vec::new(), Vec::new());
        boxed.contacts(&mut manifolds);
        plain.contacts(&mut others);
        assert_eq!(manifolds, others, "the one in the box is the same");
        let [manifold] = manifolds[..] else { panic!("one manifold") };
        assert_eq!(manifold.len(), 1 << (DIM - 1), "a face of the cube");
        assert_eq!(boxed.num_contacts(), manifold.len(), "as many");
        for tracked in manifold.contacts() {
            assert_eq!(tracked.contact.depth, N::lit(-0.0625), "above the floor");
            assert_eq!(tracked.contact.normal.into_inner(), vector(0.0, 1.0), "up");
        }
        let ids: Vec<_> = manifold.contacts().iter().map(|tracked| tracked.id).collect();
        if step == 0 {
            names.clone_from(&ids);
        }
        assert_eq!(names, ids, "the names stay, step {step}");
    }
    let far = at::<N>(0.0, 3.0);
    let here = at::<N>(0.0, 0.0);
    boxed.update(&dispatcher, &here, &floor, &far, &cube, &prediction, &mut ids);
    assert_eq!(boxed.num_contacts(), 0, "far away");
}

fn proximity_alone<N: Real>() {
    let dispatcher = DefaultProximityDispatcher::new();
    let (ball, cube) = (Ball::new(N::ONE), cube::<N>(1.0));
    let mut boxed = dispatcher.get_proximity_algorithm(&ball, &cube).expect("an algorithm");
    let mut plain = PairProximityDetector::new();
    let first = ProximityDetector::<N, DIM>::proximity(&plain);
    assert_eq!((boxed.proximity(), first), (Proximity::Disjoint, Proximity::Disjoint), "at first");
    for (x, expected) in [
        (1.5, Proximity::Intersecting),
        (2.0, Proximity::Intersecting),
        (2.25, Proximity::WithinMargin),
        (2.5, Proximity::WithinMargin),
        (2.75, Proximity::Disjoint),
    ] {
        let (here, there, margin) = (at::<N>(0.0, 0.0), at::<N>(x, 0.0), N::HALF);
        assert!(boxed.update(&dispatcher, &here, &ball, &there, &cube, margin), "any two");
        assert!(plain.update(&dispatcher, &here, &ball, &there, &cube, margin), "any two");
        assert_eq!(boxed.proximity(), expected, "{x} apart");
        let plain = ProximityDetector::<N, DIM>::proximity(&plain);
        assert_eq!(plain, expected, "{x} apart");
    }
}

#[test]
fn algorithms_alone() {
    contacts_alone::<f32>();
    contacts_alone::<f64>();
    proximity_alone::<f32>();
    proximity_alone::<f64>();
}
