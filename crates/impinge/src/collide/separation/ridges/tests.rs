//! Asserts that separations agree with the general algorithm, which grows a polytope, and that no
//! sampled direction has less depth than the result.

use super::*;
use crate::collide::separation::hulls::tests::Random;
use crate::collide::separation::revolved::cylinder_cylinder::tests::compare;
use crate::math::{Matrix, Point};
use crate::shape::{Capsule, Cone, ConvexHull, Cuboid, Cylinder, Segment, Shape, Triangle};

pub(in super::super) type Solids<N> = [Box<dyn Shape<N, 3>>; 2];
/// Function that makes a solid of the given size.
pub(in super::super) type Make<N> = fn(Vector<N, 3>) -> Box<dyn Shape<N, 3>>;

pub(in super::super) fn segment<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    Box::new(Segment::new(Point::from(-size), Point::from(size * N::lit(0.7))))
}

pub(in super::super) fn capsule<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    Box::new(Capsule::<N, 3>::new(size.x, size.y * N::lit(0.2)))
}

pub(in super::super) fn triangle<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    let corner = |x: N, y: N, z: N| Point::<N, 3>::new(x, y, z);
    let one = corner(-size.x, size.z, N::ZERO);
    Box::new(Triangle::new(one, corner(size.y, -size.x, size.x), corner(size.z, size.y, -size.y)))
}

pub(in super::super) fn cuboid<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    Box::new(Cuboid::new(size))
}

/// Returns the hull of [`octahedron`] with a half thickness of 0.002.
pub(in super::super) fn blade<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    octahedron(Vector::<N, 3>::new(size.x + N::lit(0.1), N::lit(0.002), size.z + N::lit(0.1)))
}

pub(in super::super) fn hull<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    octahedron(size.map(|x| x + N::lit(0.1)))
}

/// Returns the hull of an octahedron's displaced corners and a seventh point.
fn octahedron<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    let point = |x: f64, y: f64, z: f64| {
        Point::<N, 3>::new(size.x * N::lit(x), size.y * N::lit(y), size.z * N::lit(z))
    };
    Box::new(ConvexHull::from_points(&[
        point(1.0, 0.1, 0.0),
        point(-1.0, 0.0, 0.2),
        point(0.1, 1.0, 0.1),
        point(0.0, -1.0, -0.1),
        point(0.2, 0.0, 1.0),
        point(0.0, 0.2, -1.0),
        point(0.6, 0.6, 0.6),
    ]))
}

pub(in super::super) fn cylinder<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    Box::new(Cylinder::new(size.x, size.y))
}

pub(in super::super) fn cone<N: Real>(size: Vector<N, 3>) -> Box<dyn Shape<N, 3>> {
    Box::new(Cone::new(size.x, size.y))
}

/// Asserts, for each listed pair of kinds, that the separation agrees with the general algorithm
/// within the accuracy, by `compare`.
macro_rules! compare_each {
    ($separation:path, ($seed:expr, $rounds:expr, $accuracy:expr), $($first:ident $second:ident),*) => {
        $({
            fn solids<N: Real>([size1, size2]: [Vector<N, 3>; 2]) -> Solids<N> {
                [$first(size1), $second(size2)]
            }
            compare::<N>($seed, $rounds, $accuracy, solids, $separation);
        })*
    };
}
pub(in super::super) use compare_each;

fn agree<N: Real>(seed: u64, rounds: usize, accuracy: f64) {
    compare_each!(
        separation, (seed, rounds, accuracy),
        segment cylinder, triangle cylinder, cuboid cylinder, hull cylinder,
        segment cone, triangle cone, cuboid cone, hull cone
    );
}

#[test]
fn answers_are_those_of_the_general_algorithm() {
    agree::<f64>(1, 400, 1e-12);
    agree::<f32>(2, 400, 3e-6);
}

/// Returns the depth along a direction from the first solid to the second.
pub(in super::super) fn depth<N: Real>(pair: &Pair<'_, N, 3>, normal: &Vector<N, 3>) -> N {
    let [first, second] = [pair.first, pair.second].map(|kind| {
        let map = Geometry(kind).as_support_map();
        map.expect("a convex solid")
    });
    let end = second.support_point(&-pair.pose12.inverse_vector(normal));
    normal.dot(&first.support_point(normal).coords) - normal.dot(&pair.pose12.point(&end).coords)
}

/// Asserts for cores that overlap by more than 1e-4 that no sampled direction has less depth than
/// the result, and that [`OverlapPeaks`] finds a normal.
fn none_is_better<N: Real>(accuracy: f64) {
    let random = &mut Random(5);
    let mut deep = 0;
    let solids: [(Make<N>, Make<N>); 7] = [
        (segment, cylinder),
        (triangle, cone),
        (cuboid, cylinder),
        (cuboid, cone),
        (hull, cylinder),
        (capsule, cone),
        (blade, cylinder),
    ];
    for round in 0..560 {
        let (first, second) = solids[round % solids.len()];
        let [size1, size2] = [(); 2].map(|()| random.vector::<N>().abs().map(|x| x + N::lit(0.05)));
        let shapes: Solids<N> = [first(size1), second(size2)];
        let [first, second] = shapes.each_ref().map(|shape| shape.geometry().0);
        let mut pair = Pair { first, second, pose12: random.turn() };
        pair.pose12.translation = random.vector::<N>() * N::HALF;
        let found = separation(&pair, N::INFINITY).expect("no limit");
        let rounding = Geometry(first).as_support_map().expect("convex").rounding();
        if found.distance.as_f64() >= -1e-4 - rounding.as_f64() {
            continue;
        }
        deep += 1;
        let gap = N::lit(accuracy);
        let peak = OverlapPeaks { pair: &pair }.best(N::ONE, gap);
        assert!(peak.is_some(), "round {round}: {shapes:?} {:?}", pair.pose12);
        let error = (depth(&pair, &found.normal) + found.distance).abs();
        assert!(error < gap * N::TWO, "round {round}: its own depth, {error}");
        for _ in 0..300 {
            let Some((normal, _)) = unit(&random.vector::<N>()) else { continue };
            let other = depth(&pair, &normal);
            assert!(
                other > -found.distance - gap * N::TWO,
                "round {round}: {normal:?} has {other}"
            );
        }
    }
    assert!(deep > 150, "{deep} overlap");
}

#[test]
fn no_direction_is_better() {
    none_is_better::<f64>(1e-12);
    none_is_better::<f32>(1e-6);
}

fn pair_of<'a, N: Real>(shapes: &'a Solids<N>, pose12: Pose<N, 3>) -> Pair<'a, N, 3> {
    let [first, second] = shapes.each_ref().map(|shape| shape.geometry().0);
    Pair { first, second, pose12 }
}

/// Asserts that the depth of a thin cylinder in a box without thickness is at most the depth along
/// each axis, and equals the depth along the returned normal, at several offsets and rotations. The
/// direction of least depth may lie at the end of an arc of normals. The half of the split arc
/// without length must not contain the opposite normal.
fn a_thin_cylinder_in_a_flat_box<N: Real>() {
    let flat_box = Cuboid::new(Vector::<N, 3>::new(N::ZERO, N::lit(0.95), N::lit(0.5)));
    let cylinder = Cylinder::new(N::lit(0.125), N::lit(0.001));
    let shapes: Solids<N> = [Box::new(flat_box), Box::new(cylinder)];
    let (zero, one) = (N::ZERO, N::ONE);
    for across in [0.0, 0.0625, -0.0625, 0.25] {
        let translation = Vector::<N, 3>::new(zero, zero, N::lit(across));
        let turn = Matrix::<N, 3>::new(zero, one, zero, zero, zero, one, one, zero, zero);
        for rotation in [turn, turn.transpose(), Matrix::<N, 3>::identity()] {
            let pair = pair_of(&shapes, Pose { rotation, translation });
            let found = separation(&pair, N::INFINITY).expect("no limit");
            let least = [0, 1, 2]
                .map(|axis| depth(&pair, &Matrix::<N, 3>::identity().column(axis).into_owned()));
            let least = least.into_iter().fold(N::INFINITY, min);
            assert!(-found.distance <= least, "{found:?}, not {least}, {across} {rotation:?}");
            assert!(depth(&pair, &found.normal) + found.distance < N::EPSILON, "{found:?}");
        }
    }
}

#[test]
fn an_arc_without_length_has_no_other_side() {
    a_thin_cylinder_in_a_flat_box::<f64>();
    a_thin_cylinder_in_a_flat_box::<f32>();
}

/// Asserts that a cylinder on the ridge of a roof has at most the depth that it has along the
/// vertical, up to rounding. The slopes fall by √ε, and the cylinder is tilted along the ridge by
/// √ε / 6. The least depth is between the normals of the slopes, not at a face normal.
fn a_cylinder_on_a_ridge<N: Real>() {
    let (bend, tilt) = (N::EPSILON.sqrt(), N::EPSILON.sqrt() / N::lit(6.0));
    let (zero, one) = (N::ZERO, N::ONE);
    let corner = |x: N, y: N, z: N| Point::<N, 3>::new(x, y, z);
    let mut corners = vec![corner(one, zero, zero), corner(-one, zero, zero)];
    for (x, z) in [(one, one), (one, -one), (-one, one), (-one, -one)] {
        corners.extend([corner(x, -bend, z), corner(x, -one, z)]);
    }
    let column = Cylinder::new(N::HALF, N::lit(0.25));
    let shapes: Solids<N> = [Box::new(ConvexHull::from_points(&corners)), Box::new(column)];
    let rotation = Matrix::<N, 3>::new(one, -tilt, zero, tilt, one, zero, zero, zero, one);
    let translation = Vector::<N, 3>::new(zero, N::lit(0.4375), zero);
    let pair = pair_of(&shapes, Pose { rotation, translation });
    let found = separation(&pair, N::INFINITY).expect("no limit");
    let up = depth(&pair, &Vector::<N, 3>::y());
    assert!(-found.distance <= up + N::lit(4.0) * N::EPSILON, "{found:?}, not {up}");
    let gap = max(N::lit(8.0) * N::EPSILON, N::lit(1e-12));
    let peak = OverlapPeaks { pair: &pair }.best(N::ONE, gap).expect("it is found");
    let at_normal = depth(&pair, &peak.normal);
    assert!(at_normal <= up + gap * N::TWO, "{at_normal}, not {up}");
}

#[test]
fn a_roof_may_be_hardly_bent() {
    a_cylinder_on_a_ridge::<f64>();
    a_cylinder_on_a_ridge::<f32>();
}
/// Asserts that the normal of least depth is found for a thin triangle near the axis of a cone. All
/// normals of the cone's side have equal depths up to 10⁻⁹, so arcs across them are split too often
/// unless the best normal is known before.
#[test]
fn a_sliver_on_the_axis_of_a_cone() {
    let corner = |x: f64, y: f64, z: f64| Point::<f64, 3>::new(x, y, z);
    let first = corner(6.1072e-6, 9.4966e-9, 9.0783e-8);
    let second = corner(1.0678e-4, -0.058059, 2.0734e-4);
    let triangle = Triangle::new(first, second, corner(3.7959e-5, -0.056211, 4.3429e-3));
    let shapes: Solids<f64> = [Box::new(triangle), Box::new(Cone::new(0.85171, 0.56287))];
    let pair = pair_of(&shapes, Pose::identity());
    let peak = OverlapPeaks { pair: &pair }.best(1.0, 1e-12).expect("it is found");
    let found = separation(&pair, f64::INFINITY).expect("no limit");
    assert!((found.distance + depth(&pair, &peak.normal)).abs() < 2e-12, "{found:?}");
    let slope = Round::new(&pair.second, 1.0).expect("it has a size").slope();
    for step in 0..1000 {
        let (sine, cosine) = f64::sine_cosine(f64::from(step) * 0.00628);
        let normal = -Vector::<f64, 3>::new(cosine * slope.aside, slope.along, sine * slope.aside);
        assert!(depth(&pair, &normal) >= -found.distance - 2e-12, "{normal:?}");
    }
}
