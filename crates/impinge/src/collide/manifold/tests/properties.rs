//! Tests properties of the manifolds of all pairs of kinds, at random poses near touching: the
//! number and positions of points, their distances and ids, and the effect of swaps and scaling.

use super::scene::{Scene, describe, fact, for_all_pairs, manifold, off_surface, request};
use crate::collide::{ManifoldRequest, Pair, RawManifold, RawPoint};
use crate::math::{Point, Real, max};
use crate::shape::{FeatureId, Geometry, ShapeKind};

fn lever<N: Real, const D: usize>(raw: &RawManifold<N, D>, arm: Point<N, D>, to: Point<N, D>) -> N {
    let arm = to - arm;
    (arm - raw.normal * raw.normal.dot(&arm)).norm()
}

fn points_are_as_asked<N: Scene<D>, const D: usize>() {
    let tolerance = N::lit(400.0) * N::EPSILON;
    let (mut full, mut total) = (0, 0);
    for wish in [request::<N>(0.0, 0.0), request(0.05, 0.0), request(0.02, 0.09)] {
        for_all_pairs::<N, D>(40, 1.0, |pair| {
            let (separation, raw) = manifold(pair, &wish);
            let what = describe(pair);
            total += 1;
            full += usize::from(!raw.points.is_empty());
            assert_eq!(raw.points.is_empty(), separation.distance > wish.prediction, "{what}");
            let Some(deepest) = raw.points.get(raw.deepest()) else { return };
            assert_eq!(deepest.distance, separation.distance, "the witness is in it: {what}");
            assert!(raw.points.len() <= [2, 4][D - 2], "{} points: {what}", raw.points.len());
            for point in &raw.points {
                let allowance = wish.sine * lever(&raw, separation.point1, point.point1);
                let excess = point.distance - wish.prediction - allowance;
                assert!(excess <= tolerance, "{excess} beyond the prediction: {what}");
            }
        });
    }
    assert!(full * 10 > total * 3 && full * 10 < total * 8, "{full} of {total} touch");
}

#[test]
fn points_are_as_asked_everywhere() {
    points_are_as_asked::<f32, 2>();
    points_are_as_asked::<f64, 2>();
    points_are_as_asked::<f32, 3>();
    points_are_as_asked::<f64, 3>();
}

fn points_lie_on_both<N: Scene<D>, const D: usize>(accuracy: f64) {
    let wish = request::<N>(0.1, 0.0);
    let mut checked = 0;
    for_all_pairs::<N, D>(120, 1.0, |pair| {
        let (_, raw) = manifold(pair, &wish);
        for point in &raw.points {
            let point2 = point.point1 + raw.normal * point.distance;
            let off1 = off_surface(pair.first, &point.point1).abs();
            let off2 = off_surface(pair.second, &pair.pose12.inverse_point(&point2)).abs();
            let worst = max(off1, off2);
            assert!(worst <= N::lit(accuracy), "{off1}, {off2} off: {}, {point:?}", describe(pair));
            checked += 1;
        }
    });
    assert!(checked > 300, "{checked} points");
}

#[test]
fn points_lie_on_both_surfaces() {
    points_lie_on_both::<f32, 2>(3e-5);
    points_lie_on_both::<f64, 2>(1e-12);
    points_lie_on_both::<f32, 3>(2e-4);
    points_lie_on_both::<f64, 3>(1e-9);
}

fn ids_stay<N: Scene<D>, const D: usize>() {
    let wish = request::<N>(0.05, 0.05);
    for_all_pairs::<N, D>(30, 1.0, |pair| {
        let (separation, mut raw) = manifold(pair, &wish);
        let before = raw.clone();
        N::build(pair, &separation, &wish, &mut raw);
        assert_eq!(raw, before, "the same again: {}", describe(pair));
        assert!(raw.points.is_sorted_by(|a, b| a.id < b.id), "unique ids: {}", describe(pair));
    });
}

#[test]
fn the_same_question_gives_the_same_ids() {
    ids_stay::<f32, 2>();
    ids_stay::<f64, 3>();
}

fn is_same<N: Real, const D: usize>(
    (a, features): (&Point<N, D>, [FeatureId; 2]),
    b: &RawPoint<N, D>,
) -> bool {
    (a - b.point1).norm() <= N::lit(3e-3) && features == [b.feature1, b.feature2]
}

/// Swaps the solids of all pairs without a half-space. Returns the number of pairs for which the
/// manifold of the swapped pair lacks one of the points, with its features, or has another number
/// of points; and the number of all pairs. Rounding may decide between equally good reductions.
fn swap_losses<N: Scene<D>, const D: usize>(wish: &ManifoldRequest<N>) -> (usize, usize) {
    let (mut lost, mut total) = (0, 0);
    for_all_pairs::<N, D>(60, 1.0, |pair| {
        if Geometry(pair.second).kind() == ShapeKind::Plane {
            return;
        }
        let (separation, raw) = manifold(pair, wish);
        let (pose21, mut flipped) = (pair.pose12.inverse(), RawManifold::default());
        let swapped = Pair { first: pair.second, second: pair.first, pose12: pose21 };
        N::build(&swapped, &separation.flipped(&pair.pose12), wish, &mut flipped);
        let all = raw.points.iter().all(|point| {
            let point2 = pair.pose12.inverse_point(&(point.point1 + raw.normal * point.distance));
            let features = [point.feature2, point.feature1];
            flipped.points.iter().any(|other| is_same((&point2, features), other))
        });
        total += 1;
        lost += usize::from(!all || raw.points.len() != flipped.points.len());
    });
    (lost, total)
}

#[test]
fn swapped_solids_give_flipped_points() {
    assert_eq!(swap_losses::<f64, 2>(&request(0.05, 0.05)).0, 0, "plane, f64");
    assert_eq!(swap_losses::<f64, 3>(&request(0.05, 0.05)).0, 0, "space, f64");
    let (lost, total) = swap_losses::<f32, 3>(&request(0.05, 0.05));
    assert!(lost * 200 <= total, "space, f32: {lost} of {total}");
}

fn scales_exactly<N: Scene<D>, const D: usize>() {
    let scale = 1024.0;
    let (mut small, mut large) = (Vec::new(), Vec::new());
    let mut wish = request::<N>(0.05, 0.05);
    for_all_pairs::<N, D>(20, 1.0, |pair| small.push(manifold(pair, &wish).1));
    wish.prediction *= N::lit(scale);
    for_all_pairs::<N, D>(20, scale, |pair| large.push(manifold(pair, &wish).1));
    for (small, large) in small.iter_mut().zip(&large) {
        for point in &mut small.points {
            point.point1 *= N::lit(scale);
            point.distance *= N::lit(scale);
        }
        if let Some(pose12) = &mut small.pose12 {
            pose12.translation *= N::lit(scale);
        }
        assert_eq!(small, large, "bit for bit");
    }
}

#[test]
fn scaling_by_a_power_of_two_scales_exactly() {
    scales_exactly::<f32, 2>();
    scales_exactly::<f32, 3>();
    scales_exactly::<f64, 2>();
    scales_exactly::<f64, 3>();
}

fn bad_numbers<N: Scene<D>, const D: usize>() {
    let wish = request::<N>(0.05, 0.05);
    for_all_pairs::<N, D>(2, 1.0, |pair| {
        let (good, mut raw) = (fact(pair), RawManifold::default());
        for bad in [N::INFINITY, -N::INFINITY, N::lit(f64::NAN)] {
            let mut separation = good;
            separation.distance = bad;
            N::build(pair, &separation, &wish, &mut raw);
            assert!(raw.points.is_empty(), "{bad}: nothing to hold");
            let mut broken = *pair;
            broken.pose12.translation[0] = bad;
            separation.distance = N::ZERO;
            N::build(&broken, &separation, &wish, &mut raw);
            assert!(!raw.points.is_empty() && raw.points.len() <= 4, "the witness at least");
        }
    });
}

#[test]
fn numbers_that_are_none_do_no_harm() {
    bad_numbers::<f32, 2>();
    bad_numbers::<f64, 3>();
}
