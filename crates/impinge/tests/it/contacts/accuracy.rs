//! Compares curved solids with a reference of 25 digits. Distances, depths and normals must be
//! accurate to the rounding of the scalar, not only to the tolerance of an iteration. The hardest
//! pairs are cylinders and cones whose axes almost coincide; their parameters are changed in small
//! steps toward larger errors.
//!
//! `bench/accuracy.md` has a table of the errors for all kinds of solids, also for another library.

use crate::support::samples::samples;
use impinge::math::na::{Quaternion, Translation, UnitQuaternion};
use impinge::math::{Isometry3, Point, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::{
    Capsule, Cone, ConvexHull, Cuboid, Cylinder, Ellipsoid, ShapeHandle, TaperedCapsule,
};
use impinge_reference::geometry::vector::{add, scale};
use impinge_reference::precise::vector::rounded;
use impinge_reference::precise::{Pose, Quad, Solid, separation_along, signed_distance};
use impinge_reference::random::Random;

const KINDS: usize = 7;

/// Returns a solid for the library and for the reference; kinds 0 to 3 are curved.
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

/// Returns a random quaternion of the scalar whose squared length is 1 up to half a rounding error.
fn quaternion<N: Real>(random: &mut Random) -> [f64; 4] {
    loop {
        let q = random.quaternion().map(|x| N::lit(x).as_f64());
        let excess: f64 = q.iter().map(|x| x * x).sum::<f64>() - 1.0;
        if excess.abs() <= N::EPSILON.as_f64() / 2.0 {
            return q;
        }
    }
}

/// Returns the worst error of the signed distance, relative to the size of the scene, over pairs
/// with at least one curved solid, and a description of the pair with that error.
fn worst<N: Space<3>>(seed: u64, rounds: usize) -> (f64, String) {
    let (mut random, mut worst) = (Random::new(seed), (0.0, String::new()));
    for (kind1, kind2, round) in pairs(rounds) {
        let (shape1, solid1) = solid::<N>(kind1, &mut random);
        let (shape2, solid2) = solid::<N>(kind2, &mut random);
        let [q1, q2] = [(); 2].map(|()| quaternion::<N>(&mut random));
        let pose1 = Pose::from_quaternion([0.0; 3], q1);
        let mut at2 = scale(&random.unit_vector(), 8.0);
        // Moves the second solid along the normal to a small gap or a shallow overlap. In every
        // third pair the centres almost coincide.
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
        let (m1, m2) = (isometry::<N>([0.0; 3], q1), isometry::<N>(at2, q2));
        let found = contact(&m1, &*shape1, &m2, &*shape2, N::lit(100.0)).expect("a contact");
        let error = (-found.depth.as_f64() - truth.distance.to_f64()).abs() / truth.size;
        if truth.is_settled(1e-17) && error > worst.0 {
            worst = (error, format!("kinds {kind1} and {kind2}: {found:?}, not {truth:?}"));
        }
    }
    worst
}

fn isometry<N: Space<3>>(at: [f64; 3], [i, j, k, w]: [f64; 4]) -> Isometry3<N> {
    let [i, j, k, w] = [i, j, k, w].map(N::lit);
    let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
    Isometry3::from_parts(Translation::from(at.map(N::lit)), turn)
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

/// Two cylinders or cones with almost the same axis.
#[derive(Clone, Debug)]
struct Coaxial {
    are_cones: [bool; 2],
    /// Half height and radius of each.
    sizes: [[f64; 2]; 2],
    turns: [[f64; 4]; 2],
    at: [f64; 3],
}

/// Returns the number rounded to the scalar.
fn single<N: Real>(x: f64) -> f64 {
    N::lit(x).as_f64()
}

/// Returns a quaternion of the scalar near `q`, whose length is 1 as precisely as that of
/// [`quaternion`].
fn turn<N: Real>(q: [f64; 4], random: &mut Random) -> [f64; 4] {
    for wobble in 0..100 {
        let wobble = N::EPSILON.as_f64() * f64::from(wobble.min(2));
        let moved = q.map(|x| x + wobble * random.range(-1.0, 1.0));
        let length = moved.iter().map(|x| x * x).sum::<f64>().sqrt();
        let unit = moved.map(|x| single::<N>(x / length));
        let excess: f64 = unit.iter().map(|x| x * x).sum::<f64>() - 1.0;
        if excess.abs() <= N::EPSILON.as_f64() / 2.0 {
            return unit;
        }
    }
    [0.0, 0.0, 0.0, 1.0]
}

impl Coaxial {
    fn new<N: Real>(random: &mut Random) -> Self {
        let ratio = [1.0, random.magnitude(1e-4, 20)][random.below(2)];
        let size = |random: &mut Random| random.magnitude(0.125, 5);
        let sizes = [1.0, ratio].map(|scale| [(); 2].map(|()| single::<N>(scale * size(random))));
        let lean = [random.magnitude(1e-9, 28), 10.0][usize::from(random.chance(0.25))];
        let turns = [(); 2].map(|()| {
            let straight = *random.pick(&[[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]]);
            let any = random.quaternion();
            turn::<N>(std::array::from_fn(|i| straight[i] + lean * any[i]), random)
        });
        let offset = ratio.min(1.0) * random.magnitude(1e-9, 28);
        let at = random.vector::<3>(1.0).map(|x| single::<N>(offset * x));
        Self { are_cones: [(); 2].map(|()| random.chance(0.5)), sizes, turns, at }
    }

    /// Returns a copy with slightly different sizes, position and rotations.
    fn changed<N: Real>(&self, random: &mut Random) -> Self {
        let strength = random.magnitude(1e-6, 18);
        let mut change = |x: f64, by: f64| single::<N>(x + by * strength * random.range(-1.0, 1.0));
        let mut next = self.clone();
        let length = self.at.iter().map(|x| x.abs()).fold(0.0, f64::max);
        next.sizes = next.sizes.map(|size| size.map(|x| change(x, x)));
        next.at = next.at.map(|x| change(x, length));
        let turns = next.turns.map(|q| q.map(|x| change(x, 1.0)));
        next.turns = turns.map(|q| turn::<N>(q, random));
        next
    }

    fn solid<N: Space<3>>(&self, index: usize) -> (ShapeHandle<N, 3>, Solid<3>) {
        let [half, radius] = self.sizes[index];
        let [a, b] = self.sizes[index].map(N::lit);
        if self.are_cones[index] {
            (ShapeHandle::new(Cone::new(a, b)), Solid::cone(half, radius))
        } else {
            (ShapeHandle::new(Cylinder::new(a, b)), Solid::cylinder(half, radius))
        }
    }

    /// Returns the error in units of `EPSILON` times the size of the pair. It is the largest of
    /// three: the error of the normal, by which the separation of the reference exceeds that along
    /// the contact's normal; the excess of the reference over the distance of the contact; and the
    /// difference between that distance and the separation along the contact's normal.
    fn units<N: Space<3>>(&self) -> f64 {
        let ((shape1, solid1), (shape2, solid2)) = (self.solid::<N>(0), self.solid::<N>(1));
        let pose1 = Pose::from_quaternion([0.0; 3], self.turns[0]);
        let pose2 = Pose::from_quaternion(self.at, self.turns[1]);
        let truth = signed_distance(&solid1, &pose1, &solid2, &pose2);
        let (m1, m2) = (isometry::<N>([0.0; 3], self.turns[0]), isometry(self.at, self.turns[1]));
        let found = contact(&m1, &*shape1, &m2, &*shape2, N::INFINITY).expect("a contact");
        let normal = found.normal.into_inner().map(Real::as_f64).into();
        let own = separation_along(&solid1, &pose1, &solid2, &pose2, &normal).expect("bounded");
        let distance = -Quad::new(found.depth.as_f64());
        let error = (truth.distance.max(own) - distance).max(distance - own);
        error.max(truth.distance - own).to_f64() / (truth.size * N::EPSILON.as_f64())
    }
}

/// Changes the parameters of a few bad cases at random and keeps the worse ones. Returns the worst
/// error and its case.
fn worst_coaxial<N: Space<3>>(seed: u64) -> (f64, String) {
    const KEPT: usize = 3;
    let (tries, changes) = (samples(15), samples(15));
    let mut random = Random::new(seed);
    let mut kept: Vec<(f64, Coaxial)> = Vec::new();
    for index in 0..tries + changes {
        let old = (index >= tries).then_some(index % KEPT);
        let setting = match old {
            Some(old) => kept[old].1.changed::<N>(&mut random),
            None => Coaxial::new::<N>(&mut random),
        };
        let units = setting.units::<N>();
        match old {
            Some(old) if units > kept[old].0 => kept[old] = (units, setting),
            Some(_) => {}
            None => {
                kept.push((units, setting));
                kept.sort_by(|a, b| b.0.total_cmp(&a.0));
                kept.truncate(KEPT);
            }
        }
    }
    let worst = kept.iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("some are kept");
    (worst.0, format!("{:?}", worst.1))
}

#[test]
fn worst_depths_of_coaxial_solids_in_double_precision() {
    let (units, what) = worst_coaxial::<f64>(3);
    assert!(units <= 16.0, "off by {units} units: {what}");
}

#[test]
fn worst_depths_of_coaxial_solids_in_single_precision() {
    let (units, what) = worst_coaxial::<f32>(4);
    assert!(units <= 16.0, "off by {units} units: {what}");
}
