//! Asserts that results proved by the separating axis test agree with the general algorithm up to
//! rounding, and that all instruction sets give the same bits.

use super::{SatResult, result, segment};
use crate::collide::Pair;
use crate::collide::separation::general;
use crate::convex::Separation;
use crate::math::na::{Quaternion, UnitQuaternion};
use crate::math::simd::Level;
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::{ConvexHull, Cuboid, Kind, Segment, Shape, Triangle};

/// Random numbers between −1 and 1, by splitmix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let bits = u32::try_from((z ^ (z >> 31)) >> 32).expect("32 bits");
        f64::from(bits) / f64::from(1_u32 << 31) - 1.0
    }

    pub(crate) fn vector<N: Real>(&mut self) -> Vector<N, 3> {
        Vector::from([0; 3].map(|_: i32| N::lit(self.next())))
    }

    fn direction<N: Real>(&mut self) -> Vector<N, 3> {
        self.vector::<N>().try_normalize(N::lit(0.1)).unwrap_or_else(Vector::<N, 3>::x)
    }

    /// Returns a pose without translation: with a random rotation, none, or a slight one.
    pub(crate) fn turn<N: Real>(&mut self) -> Pose<N, 3> {
        let size = [1.0, 1.0, 0.0, 1e-3, 1e-6][self.pick(5)];
        let [i, j, k] = [0; 3].map(|_: i32| self.next() * size);
        let q = UnitQuaternion::from_quaternion(Quaternion::new(
            if size == 1.0 { self.next() } else { 1.0 },
            i,
            j,
            k,
        ));
        let mut pose = Pose::<N, 3>::identity();
        pose.rotation = q.to_rotation_matrix().into_inner().map(N::lit);
        pose
    }

    pub(crate) fn pick(&mut self, count: usize) -> usize {
        let share = (self.next() + 1.0) / 2.0;
        (0..count).find(|&n| share * count_f64(count) < count_f64(n + 1)).unwrap_or(0)
    }

    /// Returns a solid selected by `kind`: a hull of points on a sphere, a hull of grid points
    /// (with parallel edges), a box, or a triangle. A box replaces a hull that cannot be built.
    fn solid<N: Real>(&mut self, kind: usize) -> Box<dyn Shape<N, 3>> {
        let points: Vec<Point<N, 3>> = match kind {
            0 => return Box::new(Cuboid::new(self.vector::<N>().abs())),
            5 => {
                let [a, b, c] = [0; 3].map(|_: i32| Point::from(self.vector::<N>()));
                return Box::new(Triangle::new(a, b, c));
            }
            1 => (0..12).map(|_| Point::from(self.direction())).collect(),
            2 => (0..26).map(|_| Point::from(self.direction())).collect(),
            3 => (0..14)
                .map(|_| Point::from(self.vector::<N>().map(|x| (x * N::lit(1.9)).round())))
                .collect(),
            _ => (0..6).map(|_| Point::from(self.direction())).collect(),
        };
        match ConvexHull::try_from_points(&points) {
            Ok(hull) => Box::new(hull),
            Err(_) => Box::new(Cuboid::new(Vector::<N, 3>::repeat(N::HALF))),
        }
    }
}

fn count_f64(count: usize) -> f64 {
    f64::from(u32::try_from(count).expect("a small number"))
}

/// Returns the largest of four errors of `found`:
///
/// - the distance from `point1 + normal * distance` to `point2`;
/// - the difference between `distance` and the gap of the solids along `normal`;
/// - the amount by which `distance` is less than the distance of `truth`;
/// - the distance of `point1` from the first solid's supporting plane with the normal `normal`.
pub(in super::super) fn error<N: Real>(
    pair: &Pair<'_, N, 3>,
    found: &Separation<N, 3>,
    truth: &Separation<N, 3>,
) -> f64 {
    let off = found.point2 - found.point1 - found.normal * found.distance;
    let (shape1, shape2) = (
        crate::shape::Geometry(pair.first).as_support_map().expect("convex"),
        crate::shape::Geometry(pair.second).as_support_map().expect("convex"),
    );
    let far1 = shape1.core_support(&found.normal);
    let far2 = pair.pose12.point(&shape2.core_support(&pair.pose12.inverse_vector(&-found.normal)));
    let proved = found.normal.dot(&(far2 - far1)) - found.distance;
    let missed = truth.distance - found.distance;
    let inside = found.normal.dot(&(found.point1 - far1));
    [off.norm(), proved.abs(), missed, inside.abs()]
        .into_iter()
        .fold(0.0, |most, x| x.as_f64().max(most))
}

/// A function that draws two solids, and the test whose results for them are compared with the
/// general algorithm.
type Twin<N> =
    (fn(&mut Random) -> [Box<dyn Shape<N, 3>>; 2], fn(Level, &Pair<'_, N, 3>, N) -> SatResult<N>);

fn solids<N: Real>(random: &mut Random) -> [Box<dyn Shape<N, 3>>; 2] {
    let [kind1, kind2] = [random.pick(6), random.pick(6)];
    [random.solid(kind1), random.solid(kind2)]
}

/// Returns a segment and a hull or a triangle. The segment may be parallel to the x axis, very
/// short or a single point.
fn segment_and_solid<N: Real>(random: &mut Random) -> [Box<dyn Shape<N, 3>>; 2] {
    let from = Point::from(random.vector::<N>());
    let along = match random.pick(4) {
        0 => random.vector::<N>().component_mul(&Vector::<N, 3>::x()),
        1 => random.vector::<N>() * N::lit([0.0, 1e-6, 1e-3][random.pick(3)]),
        _ => random.vector::<N>(),
    };
    let kind = random.pick(6).max(1);
    let mut solid = random.solid(kind);
    if matches!(solid.geometry().0, Kind::Cuboid(_)) {
        solid = random.solid(5);
    }
    [Box::new(Segment::new(from, from + along)), solid]
}

fn compare<N: Real>(seed: u64, rounds: usize, (shapes, result): Twin<N>) {
    let random = &mut Random(seed);
    let (mut unproved, mut count) = (0, 0);
    for round in 0..rounds {
        let [shape1, shape2] = shapes(random);
        let mut pair =
            Pair { first: shape1.geometry().0, second: shape2.geometry().0, pose12: random.turn() };
        pair.pose12.translation = random.vector::<N>() * N::lit([4.0, 0.3][round % 2]);
        let truth = general::of_flat_cores(&pair, N::INFINITY).expect("no limit");
        let gap = [1.0, 0.1, 1e-3, 1e-6, 0.0, -1e-6, -1e-3, -0.1][random.pick(8)];
        if round % 4 != 1 {
            pair.pose12.translation += truth.normal * (N::lit(gap) - truth.distance);
        }
        let truth = general::of_flat_cores(&pair, N::INFINITY).expect("no limit");
        let found = Level::available().into_iter().map(|level| result(level, &pair, N::INFINITY));
        let found: Vec<_> = found.collect();
        assert!(found.iter().all(|one| *one == found[0]), "round {round}: {found:?}");
        count += 1;
        match found[0] {
            SatResult::Beyond => panic!("nothing is beyond infinity"),
            SatResult::Unproved => unproved += 1,
            SatResult::Found(found) => {
                let error = error(&pair, &found, &truth);
                let size = 4.0 + truth.distance.as_f64().abs();
                assert!(
                    error <= 32.0 * N::EPSILON.as_f64() * size,
                    "round {round}, gap {gap}: {found:?}, not {truth:?} of {shape1:?} and {shape2:?}"
                );
            }
        }
    }
    // One segment in twelve has no length, and so no edge to test.
    assert!(unproved * 10 < count, "{unproved} of {count} fall back to the general algorithm");
}

#[test]
fn answers_are_those_of_the_general_algorithm() {
    compare::<f64>(1, 4000, (solids, result));
    compare::<f32>(2, 4000, (solids, result));
}

#[test]
fn answers_for_segments_are_those_of_the_general_algorithm() {
    compare::<f64>(3, 8000, (segment_and_solid, segment::result));
    compare::<f32>(4, 8000, (segment_and_solid, segment::result));
}
