//! Tests separations of points, segments and flat solids, of solids that touch exactly, and of
//! solids with sizes near the limits of the scalar type, or with NaN.

use super::super::{Separation, Simplicial, separation};
use super::solids::Points;
use crate::math::{Point, Pose, Real, Vector, unit};
use crate::shape::{Ball, Cuboid, Cylinder, Segment, SupportMap, Triangle};

fn vector<N: Real, const D: usize>(values: [f64; D]) -> Vector<N, D> {
    Vector::<N, D>::from(values.map(N::lit))
}

fn segment<N: Real, const D: usize>(a: [f64; D], b: [f64; D]) -> Segment<N, D> {
    Segment::new(Point::from(vector(a)), Point::from(vector(b)))
}

fn solve<N: Simplicial<D>, const D: usize>(
    a: &dyn SupportMap<N, D>,
    b: &dyn SupportMap<N, D>,
    translation: [f64; D],
) -> Separation<N, D> {
    let pose = Pose::from_translation(vector(translation));
    let found = separation(a, b, &pose, N::INFINITY).expect("no limit");
    let all = found.point1.iter().chain(found.point2.iter()).chain(found.normal.iter());
    assert!(all.chain([&found.distance]).all(|x| x.is_finite_number()), "{found:?}");
    assert!((found.normal.norm() - N::ONE).abs() < N::lit(4.0) * N::EPSILON, "{found:?}");
    found
}

/// Asserts that the distance is zero and that both points coincide, up to 64 epsilons, and that the
/// normal is one of `normals` or its opposite. An empty list allows any normal.
#[track_caller]
fn touches<N: Simplicial<D>, const D: usize>(found: &Separation<N, D>, normals: &[[f64; D]]) {
    let tolerance = N::lit(64.0) * N::EPSILON;
    assert!(found.distance.abs() < tolerance, "{found:?}");
    let along = |normal: &[f64; D]| {
        let (normal, _) = unit(&vector::<N, D>(*normal)).expect("a direction");
        normal.dot(&found.normal).abs() > N::ONE - tolerance
    };
    assert!(normals.is_empty() || normals.iter().any(along), "{found:?}");
    assert!((found.point1 - found.point2).norm() < tolerance, "{found:?}");
}

fn coincident<N: Real>() {
    let (point, ball) = (Ball::new(N::ZERO), Ball::new(N::ONE));
    let found = solve::<N, 3>(&point, &point, [0.0; 3]);
    touches(&found, &[[1.0, 0.0, 0.0]]);
    assert_eq!(solve::<N, 3>(&ball, &ball, [0.0; 3]).distance, -N::TWO, "the radii");
    assert_eq!(solve::<N, 2>(&ball, &point, [0.0; 2]).distance, -N::ONE, "the radius");
    let cube = Cuboid::new(vector::<N, 3>([1.0, 2.0, 3.0]));
    let found = solve(&cube, &cube, [0.0; 3]);
    assert_eq!((found.distance, found.normal.x.abs()), (-N::TWO, N::ONE), "{found:?}");
    let square = Cuboid::new(vector::<N, 2>([1.0, 2.0]));
    assert_eq!(solve(&square, &square, [0.0; 2]).distance, -N::TWO, "the shortest exit");
    let cylinder = Cylinder::new(N::TWO, N::ONE);
    let error = (solve(&cylinder, &cylinder, [0.0; 3]).distance + N::TWO).abs();
    assert!(error < N::lit(1e-10) + N::lit(16.0) * N::EPSILON, "sideways: {error}");
}

fn zero_sizes<N: Real>() {
    let unit_cube = Cuboid::new(vector::<N, 3>([1.0; 3]));
    let nothing = Cuboid::new(vector::<N, 3>([0.0; 3]));
    let plate = Cuboid::new(vector::<N, 3>([1.0, 0.0, 1.0]));
    let disk = Cylinder::new(N::ZERO, N::ONE);
    touches(&solve(&nothing, &nothing, [0.0; 3]), &[]);
    touches(&solve(&unit_cube, &nothing, [1.0, 0.5, 0.25]), &[[1.0, 0.0, 0.0]]);
    touches(&solve(&unit_cube, &nothing, [1.0, 1.0, 1.0]), &[]);
    touches(&solve(&plate, &nothing, [0.25, 0.0, 0.5]), &[[0.0, 1.0, 0.0]]);
    touches(&solve(&plate, &plate, [0.25, 0.0, 0.5]), &[[0.0, 1.0, 0.0]]);
    touches(&solve(&disk, &disk, [0.25, 0.0, 0.5]), &[[0.0, 1.0, 0.0]]);
    touches(&solve(&disk, &plate, [0.0; 3]), &[[0.0, 1.0, 0.0]]);
    assert_eq!(solve(&unit_cube, &nothing, [0.5, 0.0, 0.0]).distance, -N::HALF, "a point inside");
    assert_eq!(solve(&nothing, &nothing, [0.0, 3.0, 4.0]).distance, N::lit(5.0), "two points");
}

fn segments<N: Real>() {
    let along = segment::<N, 3>([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    let across = segment([0.0, -1.0, 0.5], [0.0, 1.0, -0.5]);
    touches(&solve(&along, &across, [0.25, 0.0, 0.0]), &[[0.0, 0.5, 1.0]]);
    let parallel = segment([-2.0, 0.0, 0.0], [0.5, 0.0, 0.0]);
    touches(&solve(&along, &parallel, [0.0; 3]), &[]);
    touches(&solve(&along, &along, [2.0, 0.0, 0.0]), &[]);
    assert_eq!(solve(&along, &parallel, [0.0, 3.0, 4.0]).distance, N::lit(5.0), "side by side");
    let flat = segment::<N, 2>([-1.0, 0.0], [1.0, 0.0]);
    let upright = segment([0.0, -1.0], [0.0, 1.0]);
    assert_eq!(solve(&flat, &upright, [0.25, 0.5]).distance, -N::HALF, "the least shift is up");
    touches(&solve(&flat, &flat, [0.5, 0.0]), &[[0.0, 1.0]]);
    touches(&solve(&flat, &upright, [1.0, 0.5]), &[[1.0, 0.0]]);
}

fn kissing<N: Real>() {
    let cube = Cuboid::new(vector::<N, 3>([1.0; 3]));
    touches(&solve(&cube, &cube, [2.0, 0.5, 0.25]), &[[1.0, 0.0, 0.0]]);
    touches(&solve(&cube, &cube, [2.0, 2.0, 0.25]), &[]);
    touches(&solve(&cube, &cube, [2.0, 2.0, 2.0]), &[]);
    let square = Cuboid::new(vector::<N, 2>([1.0; 2]));
    touches(&solve(&square, &square, [0.5, -2.0]), &[[0.0, 1.0]]);
    touches(&solve(&square, &square, [2.0, 2.0]), &[]);
    let corner = |x: f64, z: f64| Point::from(vector::<N, 3>([x, 0.0, z]));
    let triangle = Triangle::new(corner(-1.0, -1.0), corner(2.0, -1.0), corner(0.0, 2.0));
    touches(&solve(&triangle, &triangle, [0.5, 0.0, 0.25]), &[[0.0, 1.0, 0.0]]);
    touches(&solve(&triangle, &cube, [0.0, 1.0, 0.0]), &[[0.0, 1.0, 0.0]]);
    let sliver = Triangle::new(corner(-1.0, 0.0), corner(0.0, 0.0), corner(1.0, 0.0));
    touches(&solve(&sliver, &triangle, [0.0; 3]), &[[0.0, 1.0, 0.0]]);
}

#[test]
fn degenerate_solids() {
    coincident::<f32>();
    coincident::<f64>();
    zero_sizes::<f32>();
    zero_sizes::<f64>();
    segments::<f32>();
    segments::<f64>();
    kissing::<f32>();
    kissing::<f64>();
}

#[test]
fn extreme_sizes() {
    for size in [1e-36, 1e-30, 1e-23, 1e20, 1e30, 1e37] {
        let cube = Cuboid::new(vector::<f32, 3>([size; 3]));
        for (offset, expected) in [(3.0, 1.0), (1.5, -0.5), (0.0, -2.0)] {
            let found = solve(&cube, &cube, [offset * size, 0.25 * size, 0.0]);
            let error = (found.distance.as_f64() / size - expected).abs();
            let allowed = if offset > 0.0 { 1e-6 } else { 0.2500001 };
            assert!(error < allowed, "{found:?} at {size}");
        }
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let points = corners.map(|c| Point::from(vector::<f32, 3>(c.map(|x| x * size)))).to_vec();
        let tetrahedron = Points { points, rounding: 0.0 };
        let found = solve(&tetrahedron, &tetrahedron, [2.0 * size, 0.0, 0.0]);
        assert!((found.distance.as_f64() / size - 1.0).abs() < 1e-6, "{found:?} at {size}");
    }
}

/// Asserts that, along a straight motion from overlap to separation, the signed distance increases
/// by at most the step and does not decrease, up to rounding.
#[test]
fn continuous_through_touching() {
    let cube = Cuboid::new(vector::<f32, 3>([1.0, 0.5, 0.75]));
    let cylinder = Cylinder::new(1.0_f32, 0.5);
    let mut pose = Pose::<f32, 3>::identity();
    // A rotation about z with the sine 0.6 and the cosine 0.8.
    pose.rotation.set_column(0, &vector([0.8, 0.6, 0.0]));
    pose.rotation.set_column(1, &vector([-0.6, 0.8, 0.0]));
    let solids: [&dyn SupportMap<f32, 3>; 2] = [&cube, &cylinder];
    for second in solids {
        let mut last = None;
        let mut signs = [0, 0];
        for step in 0..4000_u16 {
            let x = 1.2 + f32::from(step) * 0.000_3;
            pose.translation = vector([f64::from(x), 0.5, 0.25]);
            let found = separation(&cube, second, &pose, f32::INFINITY).expect("no limit");
            if let Some(last) = last {
                let jump: f32 = found.distance - last;
                assert!((-1e-5..0.000_31).contains(&jump), "{jump} at {x}");
            }
            last = Some(found.distance);
            signs[usize::from(found.distance > 0.0)] += 1;
        }
        assert!(signs[0] > 400 && signs[1] > 400, "passes through touching: {signs:?}");
    }
}

/// Asserts that a pose with NaN or infinity gives `None`, and that searches of solids with NaN
/// terminate.
#[test]
fn not_a_number() {
    let cube = Cuboid::new(vector::<f32, 3>([1.0; 3]));
    let mut pose = Pose::<f32, 3>::identity();
    pose.translation.y = f32::NAN;
    assert!(separation(&cube, &cube, &pose, 1.0).is_none(), "NaN in the pose");
    pose.translation.y = f32::INFINITY;
    assert!(separation(&cube, &cube, &pose, 1.0).is_none(), "infinity in the pose");
    let points = vec![Point::<f32, 3>::new(f32::NAN, 0.0, 0.0), Point::origin()];
    let broken = Points { points, rounding: 0.0 };
    let _ends = separation(&broken, &cube, &Pose::identity(), f32::NAN);
    let points = vec![Point::<f32, 2>::new(f32::NAN, f32::INFINITY); 3];
    let broken = Points { points, rounding: f32::NAN };
    let square = Cuboid::new(vector::<f32, 2>([1.0; 2]));
    let _ends = separation(&square, &broken, &Pose::identity(), 1.0);
}
