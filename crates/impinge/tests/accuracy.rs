//! Curved solids against the reference that knows 25 digits: distances, depths and normals are right
//! to the rounding of the scalar, not only to the tolerance of an iteration.
//!
//! The full table, of all kinds and beside another library, is `bench/accuracy.md`.

use impinge::math::na::{Quaternion, Translation, UnitQuaternion};
use impinge::math::{Isometry3, Point, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::{
    Capsule, Cone, ConvexHull, Cuboid, Cylinder, Ellipsoid, ShapeHandle, TaperedCapsule,
};
use impinge_reference::geometry::vector::{add, scale};
use impinge_reference::precise::vector::rounded;
use impinge_reference::precise::{Pose, Solid, signed_distance};
use impinge_reference::random::Random;

const KINDS: usize = 7;

/// One solid for the library and for the reference; the first four are curved.
fn solid<N: Space<3>>(kind: usize, random: &mut Random) -> (ShapeHandle<N, 3>, Solid<3>) {
    let sizes: [f64; 3] = std::array::from_fn(|_| random.single(0.2, 1.5));
    let [x, y, z] = sizes;
    let vector = Vector::<N, 3>::from(sizes.map(N::lit));
    let [a, b, c] = sizes.map(N::lit);
    match kind {
        0 => (ShapeHandle::new(Cylinder::new(a, b)), Solid::cylinder(x, y)),
        1 => (ShapeHandle::new(Cone::new(a, b)), Solid::cone(x, y)),
        2 => (ShapeHandle::new(Ellipsoid::new(vector)), Solid::ellipsoid(sizes)),
        3 => {
            let tapered = Solid::tapered_capsule([0.0, -x, 0.0], y, [0.0, x, 0.0], z);
            (ShapeHandle::new(TaperedCapsule::new(a, b, c)), tapered)
        }
        4 => (ShapeHandle::new(Cuboid::new(vector)), Solid::round_cuboid(sizes, 0.0)),
        5 => {
            let capsule = Solid::capsule([0.0, -x, 0.0], [0.0, x, 0.0], y);
            (ShapeHandle::new(Capsule::new(a, b)), capsule)
        }
        _ => {
            let corners = [[x, y, z], [-x, y, 0.0], [0.0, -z, x], [y, -x, -z]];
            let points = corners.map(|corner| Point::<N, 3>::from(corner.map(N::lit)));
            (ShapeHandle::new(ConvexHull::from_points(&points)), Solid::polytope(corners.to_vec()))
        }
    }
}

/// A quaternion of the scalar whose length is 1 to a small part of its rounding.
fn quaternion<N: Real>(random: &mut Random) -> [f64; 4] {
    loop {
        let q = random.quaternion().map(|x| N::lit(x).as_f64());
        let excess: f64 = q.iter().map(|x| x * x).sum::<f64>() - 1.0;
        if excess.abs() <= N::EPSILON.as_f64() / 2.0 {
            return q;
        }
    }
}

/// The worst error of the signed distance and of what the normal separates, in parts of the size of
/// the scene, over pairs of which one is curved at least.
fn worst<N: Space<3>>(seed: u64, rounds: usize) -> (f64, String) {
    let (mut random, mut worst) = (Random::new(seed), (0.0, String::new()));
    for (kind1, kind2, round) in pairs(rounds) {
        let (shape1, solid1) = solid::<N>(kind1, &mut random);
        let (shape2, solid2) = solid::<N>(kind2, &mut random);
        let [q1, q2] = [(); 2].map(|()| quaternion::<N>(&mut random));
        let pose1 = Pose::from_quaternion([0.0; 3], q1);
        let mut at2 = scale(&random.unit_vector(), 8.0);
        // Moved along the normal: near, and shallow; or straight into the middle.
        let truth = signed_distance(&solid1, &pose1, &solid2, &Pose::from_quaternion(at2, q2));
        let gap = [random.magnitude(1e-3, 8), -random.magnitude(1e-3, 6)][round % 2];
        let way = gap - truth.distance.to_f64();
        at2 = add(&at2, &scale(&rounded(&truth.normal), way));
        if round % 3 == 2 {
            at2 = scale(&random.unit_vector(), 0.1);
        }
        let at2 = at2.map(|x| N::lit(x).as_f64());
        let pose2 = Pose::from_quaternion(at2, q2);
        let truth = signed_distance(&solid1, &pose1, &solid2, &pose2);
        let isometry = |at: [f64; 3], [i, j, k, w]: [f64; 4]| {
            let [i, j, k, w] = [i, j, k, w].map(N::lit);
            let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
            Isometry3::from_parts(Translation::from(at.map(N::lit)), turn)
        };
        let (m1, m2) = (isometry([0.0; 3], q1), isometry(at2, q2));
        let found = contact(&m1, &*shape1, &m2, &*shape2, N::lit(100.0)).expect("a contact");
        let error = (-found.depth.as_f64() - truth.distance.to_f64()).abs() / truth.size;
        if truth.is_settled(1e-17) && error > worst.0 {
            worst = (error, format!("kinds {kind1} and {kind2}: {found:?}, not {truth:?}"));
        }
    }
    worst
}

fn pairs(rounds: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    let pairs = (0..4).flat_map(|kind1| (kind1..KINDS).map(move |kind2| (kind1, kind2)));
    pairs.flat_map(move |(kind1, kind2)| (0..rounds).map(move |round| (kind1, kind2, round)))
}

#[test]
fn curved_solids_in_double_precision() {
    let (error, what) = worst::<f64>(1, 12);
    assert!(error <= 1e-13, "off by {error} of the size: {what}");
}

#[test]
fn curved_solids_in_single_precision() {
    let (error, what) = worst::<f32>(2, 12);
    assert!(error <= 1e-6, "off by {error} of the size: {what}");
}
