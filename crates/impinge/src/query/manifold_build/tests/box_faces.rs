//! The fused algorithm of boxes against the general builder, which defines it.

use super::super::{box_faces, box_sides, build2, build3};
use super::scene::Random;
use crate::convex::Separation;
use crate::math::{Isometry2, Isometry3, Pose, Real, Vector, min};
use crate::query::separation::{separation_in_plane, separation_in_space};
use crate::query::{ManifoldRequest, Pair, RawManifold, RawPoint};
use crate::shape::{Cuboid, FeatureId, Shape};

/// A box upon, beside or below another; on half of the draws turned by multiples of a quarter only
/// and shifted on a grid, so that sides and corners coincide.
fn draw(random: &mut Random) -> ([Vector<f64, 3>; 2], Isometry3<f64>) {
    let on_grid = random.between(0.0, 1.0) < 0.5;
    let snap = |x: f64| if on_grid { (x * 4.0).round() / 4.0 } else { x };
    let mut half = || Vector::<f64, 3>::from_fn(|_, _| snap(random.between(0.3, 1.2)).max(0.25));
    let halves = [half(), half()];
    let pick = random.between(0.0, 3.0);
    let axis = usize::from(pick > 1.0) + usize::from(pick > 2.0);
    let mut shift = Vector::<f64, 3>::from_fn(|_, _| snap(random.between(-1.0, 1.0)));
    let depth = snap(random.between(-0.05, 0.25));
    let side = if random.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    shift[axis] = side * (halves[0][axis] + halves[1][axis] - depth);
    let lean = if random.between(0.0, 1.0) < 0.5 { 0.01 } else { 0.3 };
    let most = |index: usize| if index == axis { 0.8 } else { lean };
    let turn = Vector::<f64, 3>::from_fn(|index, _| random.between(-most(index), most(index)));
    let turn = if on_grid { Vector::<f64, 3>::zeros() } else { turn };
    (halves, Isometry3::new(shift, turn))
}

fn sorted<N: Real, const D: usize>(raw: &RawManifold<N, D>) -> Vec<RawPoint<N, D>> {
    let mut points: Vec<_> = raw.points.to_vec();
    points.sort_by_key(|point| (point.feature1, point.feature2));
    points
}

/// The same normal and names, the same places within the tolerance, and the separation itself as the
/// deepest point.
fn compare<N: Real, const D: usize>(
    [fused, general]: [&RawManifold<N, D>; 2],
    separation: &Separation<N, D>,
    tolerance: f64,
    round: usize,
) {
    assert_eq!(fused.normal, separation.normal, "round {round}");
    let least = fused.points.iter().fold(N::INFINITY, |least, p| min(p.distance, least));
    assert_eq!(least, separation.distance, "round {round}: the deepest point is the separation");
    let (fused, general) = (sorted(fused), sorted(general));
    let names = |points: &[RawPoint<N, D>]| -> Vec<_> {
        points.iter().map(|p| (p.feature1, p.feature2)).collect()
    };
    assert_eq!(names(&fused), names(&general), "round {round}");
    for (one, other) in fused.iter().zip(&general) {
        let beside = (one.point1 - other.point1).norm().as_f64();
        let deeper = (one.distance - other.distance).as_f64().abs();
        assert!(beside < tolerance && deeper < tolerance, "round {round}: {one:?} {other:?}");
    }
}

/// What is asked in all rounds: all points that are nearly touching.
fn request<N: Real>() -> ManifoldRequest<N> {
    ManifoldRequest { prediction: N::lit(0.02), sine: N::ZERO, max_points: 16 }
}

/// A pose rounded to the scalar.
fn rounded<N: Real, const D: usize>(exact: &Pose<f64, D>) -> Pose<N, D> {
    Pose { rotation: exact.rotation.map(N::lit), translation: exact.translation.map(N::lit) }
}

fn check<N: Real>(tolerance: f64) {
    let mut random = Random(7);
    let (mut built, mut touching, mut crossings, mut between_edges) = (0, 0, 0, 0);
    for round in 0..4000 {
        let (halves, isometry) = draw(&mut random);
        let [cuboid1, cuboid2] = halves.map(|half| Cuboid::new(half.map(N::lit)));
        let pose12 = rounded(&Pose::from_isometry(&isometry));
        let pair = Pair { first: cuboid1.geometry().0, second: cuboid2.geometry().0, pose12 };
        let request = request();
        let (mut fused, mut general) = (RawManifold::default(), RawManifold::default());
        if !box_faces::build(&pair, &request, &mut fused) {
            continue;
        }
        built += 1;
        let Some(separation) = separation_in_space(&pair, request.prediction) else {
            assert!(fused.points.is_empty(), "round {round}: nothing is that near");
            continue;
        };
        touching += 1;
        build3(&pair, &separation, &request, &mut general);
        compare([&fused, &general], &separation, tolerance, round);
        crossings += usize::from(fused.points.len() > 4);
        let straight = |axis: Vector<N, 3>| axis.amax() > N::ONE - N::lit(1e-6);
        let normal = separation.normal;
        let is_face = straight(normal) || straight(pair.pose12.inverse_vector(&normal));
        between_edges += usize::from(!is_face);
    }
    assert!(touching * 2 > 4000 && built > touching, "{built} built, {touching} touching");
    assert!(
        crossings > 200 && between_edges > 50,
        "{crossings} with more than four corners, {between_edges} between edges"
    );
}

#[test]
fn fused_boxes_are_what_the_general_builder_makes() {
    check::<f64>(1e-12);
    // Where two sides cross at a small angle, rounding moves the crossing along them.
    check::<f32>(1e-4);
}

/// How many contacts there are of an edge above a face, of a corner, and of an edge across an edge.
#[derive(Debug, Default)]
struct Leaning {
    edges: usize,
    corners: usize,
    crossings: usize,
}

impl Leaning {
    fn count<N: Real>(&mut self, points: &[RawPoint<N, 3>]) {
        let is =
            |of: fn(FeatureId) -> bool| move |p: &RawPoint<N, 3>| of(p.feature1) || of(p.feature2);
        let has_face = points.iter().any(is(|id| matches!(id, FeatureId::Face(_))));
        let has_corner = points.iter().any(is(|id| matches!(id, FeatureId::Vertex(_))));
        self.edges += usize::from(points.len() == 2);
        self.corners += usize::from(points.len() == 1 && has_face && has_corner);
        self.crossings += usize::from(points.len() == 1 && !has_face && !has_corner);
    }
}

/// Boxes that reach into each other, both turned freely; some that do not.
fn check_turned<N: Real>(tolerance: f64) {
    let (mut random, mut counts, mut built) = (Random(11), Leaning::default(), 0);
    for round in 0..4000 {
        let mut draw = |most: f64| Vector::<f64, 3>::from_fn(|_, _| random.between(-most, most));
        let (shift, turn) = (draw(1.2), draw(2.0));
        let mut half = || draw(0.4).map(|x| N::lit(x + 0.7));
        let (cuboid1, cuboid2) = (Cuboid::new(half()), Cuboid::new(half()));
        let pose12 = rounded(&Pose::from_isometry(&Isometry3::new(shift, turn)));
        let pair = Pair { first: cuboid1.geometry().0, second: cuboid2.geometry().0, pose12 };
        let (mut fused, mut general) = (RawManifold::default(), RawManifold::default());
        let separation = separation_in_space(&pair, request::<N>().prediction);
        if let (Some(separation), true) =
            (separation, box_faces::build(&pair, &request(), &mut fused))
        {
            build3(&pair, &separation, &request(), &mut general);
            compare([&fused, &general], &separation, tolerance, round);
            counts.count(&fused.points);
            built += 1;
        }
    }
    let Leaning { edges, corners, crossings } = counts;
    assert!(built > 1500 && edges > 300, "{built}, {counts:?}");
    assert!(corners > 50 && crossings > 50, "{counts:?}");
}

#[test]
fn fused_boxes_that_lean_are_what_the_general_builder_makes() {
    check_turned::<f64>(1e-10);
    // Seen along the normal, edges cross at any angle.
    check_turned::<f32>(1e-3);
}

fn check_sides<N: Real>(tolerance: f64) {
    let mut random = Random(9);
    let (mut built, mut touching, mut pairs) = (0, 0, 0);
    for round in 0..4000 {
        let (halves, isometry) = draw(&mut random);
        let flat = |v: &Vector<f64, 3>| Vector::<f64, 2>::new(v.x, v.y);
        let [cuboid1, cuboid2] = halves.map(|half| Cuboid::new(flat(&half).map(N::lit)));
        let turn = isometry.rotation.scaled_axis().z;
        let exact = Isometry2::new(flat(&isometry.translation.vector), turn);
        let pose12 = rounded(&Pose::from_isometry(&exact));
        let pair = Pair { first: cuboid1.geometry().0, second: cuboid2.geometry().0, pose12 };
        let (mut fused, mut general) = (RawManifold::default(), RawManifold::default());
        if !box_sides::build(&pair, &request(), &mut fused) {
            continue;
        }
        built += 1;
        let Some(separation) = separation_in_plane(&pair, request::<N>().prediction) else {
            assert!(fused.points.is_empty(), "round {round}: nothing is that near");
            continue;
        };
        touching += 1;
        build2(&pair, &separation, &request(), &mut general);
        compare([&fused, &general], &separation, tolerance, round);
        pairs += usize::from(fused.points.len() == 2);
    }
    check_corners::<N>(tolerance);
    assert!(built > touching && touching > 1500, "{built} built, {touching} touching");
    assert!(pairs > 500, "{pairs} with two points");
}

/// Boxes turned freely, most of which meet with a corner.
fn check_corners<N: Real>(tolerance: f64) {
    let (mut random, mut corners) = (Random(13), 0);
    for round in 0..4000 {
        let mut draw = |most: f64| Vector::<f64, 2>::from_fn(|_, _| random.between(-most, most));
        let (shift, turn) = (draw(1.0), draw(3.0).x);
        let mut half = || draw(0.4).map(|x| N::lit(x + 0.7));
        let (cuboid1, cuboid2) = (Cuboid::new(half()), Cuboid::new(half()));
        let pose12 = rounded(&Pose::from_isometry(&Isometry2::new(shift, turn)));
        let pair = Pair { first: cuboid1.geometry().0, second: cuboid2.geometry().0, pose12 };
        let (mut fused, mut general) = (RawManifold::default(), RawManifold::default());
        let separation = separation_in_plane(&pair, request::<N>().prediction);
        if let (Some(separation), true) =
            (separation, box_sides::build(&pair, &request(), &mut fused))
        {
            build2(&pair, &separation, &request(), &mut general);
            compare([&fused, &general], &separation, tolerance, round);
            corners += usize::from(fused.points.len() == 1);
        }
    }
    assert!(corners > 500, "{corners} corners on sides");
}

#[test]
fn fused_sides_are_what_the_general_builder_makes() {
    check_sides::<f64>(1e-12);
    check_sides::<f32>(1e-4);
}
