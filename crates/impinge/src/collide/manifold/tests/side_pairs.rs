//! Tests the contacts of flat-sided 2D solids: they are the ends of the overlap interval of the
//! supporting sides, lie on both surfaces, and the deepest has the distance of the separation.

use super::scene::{Random, Scene, describe, near_pose, off_surface, solids};
use crate::collide::separation::separation_2d;
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::math::{Isometry2, Point, Pose, Real, Space, Vector, max, min};
use crate::shape::{
    Capsule, ConvexPolygon, Cuboid, Kind, Rounded, Segment, Shape, ShapeKind, Triangle,
};
use crate::tables::ByDimension;

fn p<N: Real>(x: f64, y: f64) -> Point<N, 2> {
    Point::<N, 2>::new(N::lit(x), N::lit(y))
}

fn request<N: Real>(prediction: f64, sine: f64) -> ManifoldRequest<N> {
    ManifoldRequest { prediction: N::lit(prediction), sine: N::lit(sine), max_points: 4 }
}

fn contacts<N: Real>(pair: &Pair<'_, N, 2>, request: &ManifoldRequest<N>) -> RawManifold<N, 2> {
    let mut raw = RawManifold::default();
    <<N as Space<2>>::Algorithms>::contacts(pair, request, &mut raw);
    raw
}

/// A solid whose upper side is at height zero, and the world position of its origin.
type Bench<N> = (Box<dyn Shape<N, 2>>, [f64; 2]);

/// Returns flat-sided solids of six kinds whose upper side extends from `low` to `high`; the
/// capsule and the rounded box have the radius 1/8.
fn benches<N: Real>([low, high]: [f64; 2]) -> Vec<Bench<N>> {
    let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let box_of = |height: f64| Cuboid::new(Vector::<N, 2>::new(N::lit(half), N::lit(height)));
    let ends = [p(low, -0.125), p(high, -0.125)];
    let corners = [p(low, 0.0), p(low, -0.5), p(middle, -0.75), p(high, -0.5), p(high, 0.0)];
    let radius = N::lit(0.125);
    vec![
        (Box::new(Segment::new(p(low, 0.0), p(high, 0.0))), [0.0; 2]),
        (Box::new(Capsule::try_from_ends(ends[0], ends[1], radius).expect("finite")), [0.0; 2]),
        (Box::new(Triangle::new(p(low, 0.0), p(middle, -1.0), p(high, 0.0))), [0.0; 2]),
        (Box::new(box_of(0.5)), [middle, -0.5]),
        (Box::new(ConvexPolygon::new(&corners)), [0.0; 2]),
        (Box::new(Rounded::new(box_of(0.25), radius)), [middle, -0.375]),
    ]
}

/// Returns the pose of a solid at `[x, y]`, rotated by `angle` about the world's origin and then
/// translated by `by`.
fn placed<N: Real>([x, y]: [f64; 2], angle: f64, by: [f64; 2]) -> Pose<N, 2> {
    let own = Isometry2::new(Vector::<f64, 2>::new(x, y), 0.0);
    let rotated = Isometry2::new(Vector::<f64, 2>::new(by[0], by[1]), angle) * own;
    let exact = Pose::from_isometry(&rotated);
    Pose { rotation: exact.rotation.map(N::lit), translation: exact.translation.map(N::lit) }
}

/// Two solids with a side of one above a side of the other, in world coordinates.
struct Stack {
    /// The x coordinates of the ends of the lower side, then of the upper side.
    sides: [[f64; 2]; 2],
    /// Gap between the sides at the left end of their overlap, which has the smaller x.
    gap: f64,
    /// Angle, in radians, by which the upper solid is rotated about its point above that end.
    tilt: f64,
}

impl Stack {
    fn overlap(&self) -> [f64; 2] {
        let [[low1, high1], [low2, high2]] = self.sides;
        [low1.max(low2), high1.min(high2)]
    }

    /// Calls `visit` with a pair for each two kinds of [`benches`], and with the world pose of the
    /// lower solid, the first of the pair.
    fn visit<N: Real>(&self, mut visit: impl FnMut(&Pair<'_, N, 2>, &Pose<N, 2>)) {
        let [[low, high], [left, right]] = self.sides;
        let pivot = self.overlap()[0];
        // The upper solid is turned upside down, so its side runs in the opposite direction.
        let (sine, cosine) = Real::sine_cosine(self.tilt);
        let by = [pivot - cosine * pivot, self.gap - sine * pivot];
        for (lower, at1) in benches::<N>([low, high]) {
            for (upper, at2) in benches::<N>([-right, -left]) {
                let pose1 = placed(at1, 0.0, [0.0; 2]);
                let pose2 = placed(at2, core::f64::consts::PI + self.tilt, by);
                let (first, second) = (lower.geometry().0, upper.geometry().0);
                let pose12 = Pose::relative(&pose1, &pose2);
                visit(&Pair { first, second, pose12 }, &pose1);
            }
        }
    }
}

/// Returns whether `flipped`, the manifold of the swapped pair, has the same points, up to `close`,
/// and the same features as `raw`.
fn is_flipped<N: Real>(
    pair: &Pair<'_, N, 2>,
    raw: &RawManifold<N, 2>,
    flipped: &RawManifold<N, 2>,
    close: N,
) -> bool {
    let are_as_many = raw.points.len() == flipped.points.len();
    are_as_many
        && raw.points.iter().all(|point| {
            let point2 = pair.pose12.inverse_point(&(point.point1 + raw.normal * point.distance));
            flipped.points.iter().any(|other| {
                (other.feature1, other.feature2) == (point.feature2, point.feature1)
                    && (other.point1 - point2).norm() <= close
            })
        })
}

fn sides_on_sides<N: Real>(close: f64) {
    let close = N::lit(close);
    for (side2, gap) in [([-0.5, 2.0], 0.05), ([-2.0, 0.25], 0.01), ([-0.5, 0.5], -0.02)] {
        let stack = Stack { sides: [[-1.0, 1.0], side2], gap, tilt: 0.0 };
        stack.visit::<N>(|pair, pose1| {
            let are_segments =
                matches!((pair.first, pair.second), (Kind::Segment(_), Kind::Segment(_)));
            if gap < 0.0 && are_segments {
                return;
            }
            let (raw, what) = (contacts(pair, &request(0.1, 0.0)), describe(pair));
            assert_eq!(raw.points.len(), 2, "{raw:?}: {what}");
            let world = raw.points.iter().map(|point| pose1.point(&point.point1));
            let xs: Vec<N> = world.clone().map(|point| point.x).collect();
            let (low, high) = (min(xs[0], xs[1]), max(xs[0], xs[1]));
            let [from, to] = stack.overlap().map(N::lit);
            assert!((low - from).abs() <= close && (high - to).abs() <= close, "{xs:?}: {what}");
            assert!(world.map(|point| point.y).all(|y| y.abs() <= close), "{raw:?}: {what}");
            for point in &raw.points {
                assert!((point.distance - N::lit(gap)).abs() <= close, "{raw:?}: {what}");
            }
            let pose12 = pair.pose12.inverse();
            let swapped = Pair { first: pair.second, second: pair.first, pose12 };
            let flipped = contacts(&swapped, &request(0.1, 0.0));
            assert!(is_flipped(pair, &raw, &flipped, close), "{raw:?}, {flipped:?}: {what}");
        });
    }
}

#[test]
fn two_sides_touch_at_the_ends_of_their_overlap() {
    sides_on_sides::<f32>(1e-5);
    sides_on_sides::<f64>(1e-14);
}

fn tilted_sides<N: Real>() {
    let stack = Stack { sides: [[-1.0, 1.0], [-0.5, 2.0]], gap: 0.01, tilt: 0.05 };
    stack.visit::<N>(|pair, pose1| {
        let what = describe(pair);
        let counts = [0.0, 0.09].map(|sine| contacts(pair, &request(0.015, sine)).points.len());
        assert_eq!(counts, [1, 2], "{what}");
        let raw = contacts(pair, &request(0.015, 0.09));
        let xs = [0, 1].map(|at: usize| pose1.point(&raw.points[at].point1).x);
        let (low, high) = (min(xs[0], xs[1]), max(xs[0], xs[1]));
        let [from, to] = stack.overlap().map(N::lit);
        let close = N::lit(0.02);
        assert!((low - from).abs() <= close && (high - to).abs() <= close, "{xs:?}: {what}");
    });
}

#[test]
fn an_angular_prediction_adds_the_end_that_is_farther_off() {
    tilted_sides::<f32>();
    tilted_sides::<f64>();
}

/// Returns flat-sided solids of random sizes; some of them are rounded.
fn flat_sided<N: Scene<2>>(random: &mut Random) -> Vec<Box<dyn Shape<N, 2>>> {
    let mut shapes = solids::<N, 2>(1.0, random);
    shapes.retain(|shape| !matches!(shape.geometry().kind(), ShapeKind::Ball | ShapeKind::Plane));
    let half = random.vector::<N, 2>(0.5).abs().map(|x| x + N::lit(0.1));
    shapes.push(Box::new(Rounded::new(Cuboid::new(half), N::lit(0.1))));
    shapes.push(Box::new(Cuboid::new(Vector::<N, 2>::new(N::ONE, N::HALF))));
    shapes.push(Box::new(Triangle::new(p(-1.0, 0.0), p(0.0, 1.0), p(1.0, 0.0))));
    shapes
}

/// Returns a random pose of the second solid, near touching, in even rounds. In odd rounds its
/// translation is on a grid and its angle is at most 1e-3, so that sides and corners coincide or
/// nearly do.
fn pose_of<N: Scene<2>>(
    kinds: [Kind<'_, N, 2>; 2],
    round: usize,
    random: &mut Random,
) -> Pose<N, 2> {
    if round.is_multiple_of(2) {
        return near_pose(kinds, (1.0, -0.3, 0.1), random);
    }
    let on_grid = random.vector::<N, 2>(1.5).map(|x| (x * N::lit(4.0)).round() * N::lit(0.25));
    let size = [0.0, 1e-7, 1e-3][round / 2 % 3];
    <N as Scene<2>>::pose(on_grid, [0.0, 0.0, random.between(-size, size)])
}

fn points_are_on_both<N: Scene<2> + Space<2>>(seed: u64, close: f64) {
    let (random, mut counts) = (&mut Random(seed), [0; 3]);
    for round in 0..60 {
        let shapes = [(); 2].map(|()| flat_sided::<N>(random));
        for (shape1, shape2) in
            shapes[0].iter().flat_map(|one| shapes[1].iter().map(move |two| (one, two)))
        {
            let kinds = [shape1.geometry().0, shape2.geometry().0];
            let pose12 = pose_of(kinds, round, random);
            if shape1.geometry().kind() > shape2.geometry().kind() {
                continue;
            }
            let pair = Pair { first: kinds[0], second: kinds[1], pose12 };
            let (wish, what) = (request::<N>(0.1, 0.0), describe(&pair));
            let raw = contacts(&pair, &wish);
            counts[raw.points.len()] += 1;
            let found = separation_2d(&pair, wish.prediction).map(|found| found.distance);
            let least = raw.points.get(raw.deepest()).map(|point| point.distance);
            assert_eq!(least, found, "the deepest point is the separation: {what}");
            for point in &raw.points {
                let point2 = point.point1 + raw.normal * point.distance;
                let off1 = off_surface(pair.first, &point.point1).abs();
                let off2 = off_surface(pair.second, &pair.pose12.inverse_point(&point2)).abs();
                assert!(max(off1, off2) <= N::lit(close), "{off1}, {off2} off: {what}, {raw:?}");
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
}

#[test]
fn points_lie_on_both_solids_and_the_deepest_is_the_separation() {
    points_are_on_both::<f32>(11, 1e-4);
    points_are_on_both::<f64>(12, 1e-10);
}
