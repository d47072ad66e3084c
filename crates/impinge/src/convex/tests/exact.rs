//! Tests separations against results computed by hand, and the distances of boxes against the
//! largest height over all axes of the separating axis test.

use super::super::{Separation, Simplicial, separation};
use super::generator::{Generator, Sample};
use super::solids::{Own, height};
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::{Ball, Capsule, Cone, Cuboid, Cylinder, Segment, SupportMap, Triangle};

fn at<N: Real, const D: usize>(translation: [f64; D]) -> Pose<N, D> {
    Pose::from_translation(Vector::<N, D>::from(translation.map(N::lit)))
}

fn cuboid<N: Real, const D: usize>(half_extents: [f64; D]) -> Cuboid<N, D> {
    Cuboid::new(Vector::<N, D>::from(half_extents.map(N::lit)))
}

#[track_caller]
fn expect<N: Real, const D: usize>(
    found: Option<Separation<N, D>>,
    distance: f64,
    normal: [f64; D],
    points: Option<[[f64; D]; 2]>,
) {
    let found = found.expect("no limit");
    within(found, distance, normal, points, [100.0 * N::EPSILON.as_f64(); 2]);
}

/// Asserts that distance and normal are as expected; does not check the points. On curved surfaces
/// a normal is accurate only to the square root of the accuracy of the distance.
#[track_caller]
fn expect_curved<N: Real>(found: Option<Separation<N, 3>>, distance: f64, normal: [f64; 3]) {
    let tolerance = 64.0 * N::EPSILON.as_f64() + 1e-11;
    within(found.expect("no limit"), distance, normal, None, [tolerance, 2.0 * tolerance.sqrt()]);
}

#[track_caller]
fn within<N: Real, const D: usize>(
    found: Separation<N, D>,
    distance: f64,
    normal: [f64; D],
    points: Option<[[f64; D]; 2]>,
    [tolerance, angle]: [f64; 2],
) {
    let error = |v: &Vector<N, D>, expected: [f64; D]| {
        (v.map(Real::as_f64) - Vector::<f64, D>::from(expected)).norm()
    };
    assert!((found.distance.as_f64() - distance).abs() < tolerance, "{found:?}");
    assert!(error(&found.normal, normal) < angle, "{found:?}");
    if let Some([point1, point2]) = points {
        assert!(error(&found.point1.coords, point1) < angle, "{found:?}");
        assert!(error(&found.point2.coords, point2) < angle, "{found:?}");
    }
}

fn pairs_3d<N: Real>() {
    let free = N::INFINITY;
    let [half, one, two] = [0.5, 1.0, 2.0].map(N::lit);
    let (ball, boxed) = (Ball::new(half), cuboid::<N, 3>([1.0, 2.0, 3.0]));
    let found = separation(&ball, &ball, &at([0.0, 3.0, 4.0]), free);
    let points = [[0.0, 0.3, 0.4], [0.0, 2.7, 3.6]];
    expect(found, 4.0, [0.0, 0.6, 0.8], Some(points));
    let found = separation(&boxed, &ball, &at([4.0, 6.0, 0.0]), free);
    expect(found, 4.5, [0.6, 0.8, 0.0], Some([[1.0, 2.0, 0.0], [3.7, 5.6, 0.0]]));
    let found = separation(&boxed, &ball, &at([0.75, 0.5, 0.0]), free);
    expect(found, -0.75, [1.0, 0.0, 0.0], Some([[1.0, 0.5, 0.0], [0.25, 0.5, 0.0]]));
    let capsule = Capsule::<N, 3>::new(two, half);
    let found = separation(&capsule, &capsule, &at([3.0, 6.0, 0.0]), free);
    let root = 13.0_f64.sqrt();
    expect(found, root - 1.0, [3.0 / root, 2.0 / root, 0.0], None);
    let found = separation(&boxed, &boxed, &at([1.5, 0.25, 0.5]), free);
    expect(found, -0.5, [1.0, 0.0, 0.0], None);
    let cylinder = Cylinder::new(one, two);
    let found = separation(&cylinder, &cylinder, &at([0.5, 1.75, 0.0]), free);
    expect_curved(found, -0.25, [0.0, 1.0, 0.0]);
    let found = separation(&cylinder, &cylinder, &at([3.0, 0.25, 0.0]), free);
    expect_curved(found, -1.0, [1.0, 0.0, 0.0]);
    let cone = Cone::new(two, one);
    let found = separation(&cone, &ball, &at([0.0, 3.0, 0.0]), free);
    expect(found, 0.5, [0.0, 1.0, 0.0], Some([[0.0, 2.0, 0.0], [0.0, 2.5, 0.0]]));
    let corner = |x: f64, y: f64, z: f64| Point::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z));
    let triangle =
        Triangle::new(corner(-2.0, 0.0, -1.0), corner(2.0, 0.0, -1.0), corner(0.0, 0.0, 3.0));
    let found = separation(&triangle, &ball, &at([0.0, 0.25, 0.0]), free);
    expect(found, -0.25, [0.0, 1.0, 0.0], Some([[0.0; 3], [0.0, -0.25, 0.0]]));
    let segment = Segment::new(corner(-1.0, 0.0, 0.0), corner(1.0, 0.0, 0.0));
    let across = Segment::new(corner(0.0, 0.0, -1.0), corner(0.0, 0.0, 1.0));
    let found = separation(&segment, &across, &at([0.25, 0.125, 0.5]), free);
    expect(found, 0.125, [0.0, 1.0, 0.0], Some([[0.25, 0.0, 0.0], [0.25, 0.125, 0.0]]));
}

#[test]
fn by_hand_3d() {
    pairs_3d::<f32>();
    pairs_3d::<f64>();
}

fn pairs_2d<N: Real>() {
    let free = N::INFINITY;
    let (small, wide) = (cuboid::<N, 2>([1.0, 1.0]), cuboid::<N, 2>([4.0, 0.5]));
    let found = separation(&small, &wide, &at([4.0, 5.5]), free);
    expect(found, 4.0, [0.0, 1.0], None);
    let found = separation(&small, &wide, &at([8.0, 5.5]), free);
    expect(found, 5.0, [0.6, 0.8], Some([[1.0, 1.0], [4.0, 5.0]]));
    let found = separation(&small, &wide, &at([0.25, -1.25]), free);
    expect(found, -0.25, [0.0, -1.0], None);
    let ball = Ball::new(N::HALF);
    let found = separation(&ball, &small, &at([0.0, -0.75]), free);
    expect(found, -0.75, [0.0, -1.0], Some([[0.0, -0.5], [0.0, 0.25]]));
}

#[test]
fn by_hand_2d() {
    pairs_2d::<f32>();
    pairs_2d::<f64>();
}

/// Returns all directions along which the shortest translation that separates two overlapping boxes
/// may lie: `crosses` and the axes of both boxes, and their opposites.
fn axes<const D: usize>(pose12: &Pose<f64, D>, crosses: &[Vector<f64, D>]) -> Vec<Vector<f64, D>> {
    let mut axes = crosses.to_vec();
    for axis in 0..D {
        axes.push(Vector::<f64, D>::from_fn(|row, _| f64::from(u8::from(row == axis))));
        axes.push(pose12.rotation.column(axis).into_owned());
    }
    let opposite: Vec<_> = axes.iter().map(|axis| -axis).collect();
    axes.extend(opposite);
    axes
}

/// Asserts, for random pairs of boxes, that the distance of an overlap equals the largest height
/// over all axes, and that the distance of disjoint boxes is not less than this height. `tolerance`
/// is relative to the scale of the sample.
fn against_all_axes<N, const D: usize>(
    crosses: impl Fn(&Pose<f64, D>) -> Vec<Vector<f64, D>>,
    tolerance: f64,
) where
    N: Simplicial<D> + Own<D>,
    f64: Simplicial<D> + Own<D>,
{
    let mut generator = Generator(3);
    let mut overlaps = 0;
    for round in 0..600 {
        let (size, thin) = [(1.0, false), (1e-3, false), (1e3, true)][round % 3];
        let target = [0.3, 1e-6, -1e-6, -1e-3, -0.3, -1.0][round / 3 % 6];
        let shapes = [0; 2].map(|_| generator.shape::<D>("cuboid", size, thin));
        let sample = Sample::new(shapes, target * size, &mut generator).representable::<N>();
        let ([a, b], [c, d]) = (sample.solids::<N>(), sample.solids::<f64>());
        let found = separation(&*a, &*b, &sample.pose::<N>(), N::INFINITY).expect("no limit");
        let pair: [&dyn SupportMap<f64, D>; 2] = [&*c, &*d];
        let best = axes(&sample.pose12, &crosses(&sample.pose12))
            .iter()
            .map(|axis| height(pair, &sample.pose12, axis))
            .fold(f64::NEG_INFINITY, f64::max);
        let error = found.distance.as_f64() - best;
        let allowed = tolerance * sample.scale;
        overlaps += usize::from(best < 0.0);
        assert!(error > -allowed && (best > 0.0 || error < allowed), "{error} at {best}");
    }
    assert!((200..420).contains(&overlaps), "{overlaps} of 600 overlap");
}

fn edge_pairs(pose12: &Pose<f64, 3>) -> Vec<Vector<f64, 3>> {
    let mut crosses = Vec::new();
    for i in 0..3 {
        for j in 0..3 {
            let e = Vector::<f64, 3>::from_fn(|row, _| f64::from(u8::from(row == i)));
            crosses.push(e.cross(&pose12.rotation.column(j).into_owned()));
        }
    }
    crosses.retain(|axis| axis.norm() > 1e-3);
    crosses
}

#[test]
fn boxes_against_all_axes() {
    against_all_axes::<f32, 2>(|_| Vec::new(), 2e-6);
    against_all_axes::<f64, 2>(|_| Vec::new(), 1e-14);
    against_all_axes::<f32, 3>(edge_pairs, 2e-6);
    against_all_axes::<f64, 3>(edge_pairs, 1e-14);
}
