//! Outlines in one go against the separation and the stretch that two sides share.

use super::super::{build2, outlines};
use super::scene::{Random, Scene, describe, near_pose, solids};
use crate::math::{Point, Real, Space, Vector};
use crate::query::separation::separation;
use crate::query::{ManifoldRequest, Pair, RawManifold};
use crate::shape::{ConvexPolygon, Cuboid, Geometry, Rounded, Segment, Shape, Triangle};

/// The solids of the scene that have outlines, rounded ones, and such that often lie flush.
fn outlined<N: Scene<2>>(random: &mut Random) -> Vec<Box<dyn Shape<N, 2>>> {
    let mut shapes = solids::<N, 2>(1.0, random);
    shapes.pop();
    shapes.remove(0);
    let half = random.vector::<N, 2>(0.5).abs().map(|x| x + N::lit(0.1));
    shapes.push(Box::new(Rounded::new(Cuboid::new(half), N::lit(0.1))));
    let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x), N::lit(y));
    shapes.push(Box::new(Cuboid::new(Vector::<N, 2>::new(N::ONE, N::HALF))));
    shapes.push(Box::new(Triangle::new(p(-1.0, 0.0), p(0.0, 1.0), p(1.0, 0.0))));
    shapes.push(Box::new(Segment::new(p(1.0, 0.0), p(-1.0, 0.0))));
    let corners = [p(0.0, -1.0), p(0.5, -0.5), p(0.5, 0.5), p(0.0, 1.0), p(-0.25, 0.25)];
    shapes.push(Box::new(ConvexPolygon::new(&corners)));
    shapes
}

#[derive(Default, Debug)]
struct Count {
    pairs: usize,
    built: usize,
    points: [usize; 3],
    /// Of which normals are others though the depths are equal.
    tied: usize,
    /// In canonical order, with a depth that differs by rounding.
    off: usize,
}

fn of_pair<N: Space<2>>(pair: &Pair<'_, N, 2>, max_points: usize, count: &mut Count) {
    let request = ManifoldRequest::new(N::lit(0.1), N::ZERO, max_points);
    let (mut quick, mut slow) = (RawManifold::default(), RawManifold::default());
    count.pairs += 1;
    for _ in 0..2 {
        if !outlines::build(pair, &request, &mut quick) {
            return;
        }
        match separation(pair, request.prediction) {
            Some(found) => build2(pair, &found, &request, &mut slow),
            None => slow.points.clear(),
        }
        let what = describe(pair);
        if quick.points.is_empty() {
            assert!(slow.points.is_empty(), "{slow:?} not {quick:?}: {what}");
            count.built += 1;
            count.points[0] += 1;
            return;
        }
        let close = N::lit(512.0) * N::EPSILON;
        let depths = [&quick, &slow].map(|raw| raw.points[raw.deepest()].distance);
        assert!((depths[0] - depths[1]).abs() <= close, "{slow:?} not {quick:?}: {what}");
        let is_in_order = Geometry(pair.first).kind() <= Geometry(pair.second).kind();
        count.off += usize::from(is_in_order && depths[0] != depths[1]);
        if (quick.normal - slow.normal).norm() > N::lit(64.0) * N::EPSILON {
            count.tied += 1;
            return;
        }
        are_alike(&quick, &slow, &what);
    }
    count.built += 1;
    count.points[quick.points.len()] += 1;
}

fn are_alike<N: Real>(quick: &RawManifold<N, 2>, slow: &RawManifold<N, 2>, what: &str) {
    let close = N::lit(2048.0) * N::EPSILON;
    let message = || format!("{slow:#?} not {quick:#?}: {what}");
    assert_eq!(quick.points.len(), slow.points.len(), "{}", message());
    assert_eq!(quick.ids, slow.ids, "{}", message());
    for (quick, slow) in quick.points.iter().zip(&slow.points) {
        assert_eq!(
            (quick.feature1, quick.feature2, quick.id),
            (slow.feature1, slow.feature2, slow.id),
            "{}",
            message()
        );
        assert!((quick.distance - slow.distance).abs() <= close, "{}", message());
        assert!((quick.point1 - slow.point1).norm() <= close, "{}", message());
    }
}

fn compare<N: Scene<2> + Space<2>>(seed: u64) -> Count {
    let (random, mut count) = (&mut Random(seed), Count::default());
    for round in 0..150_usize {
        let shapes = [(); 2].map(|()| outlined::<N>(random));
        for shape1 in &shapes[0] {
            for shape2 in &shapes[1] {
                let kinds = [shape1.geometry().0, shape2.geometry().0];
                let pose12 = match round % 4 {
                    0 => near_pose(kinds, (1.0, -0.3, 0.1), random),
                    1 => {
                        let turn = [0.0, 0.0, random.between(-3.0, 3.0)];
                        <N as Scene<2>>::pose(random.vector::<N, 2>(1.5), turn)
                    }
                    _ => {
                        let place = random.vector::<N, 2>(1.5);
                        let on_grid = place.map(|x| (x * N::lit(4.0)).round() * N::lit(0.25));
                        let size = [0.0, 1e-7, 1e-3][round / 4 % 3];
                        <N as Scene<2>>::pose(on_grid, [0.0, 0.0, random.between(-size, size)])
                    }
                };
                of_pair(&Pair { first: kinds[0], second: kinds[1], pose12 }, 2, &mut count);
            }
        }
    }
    count
}

#[test]
fn outlines_in_one_go_are_what_sides_share() {
    for count in [compare::<f32>(11), compare::<f64>(12)] {
        let Count { pairs, built, points, tied, off } = count;
        assert!(off * 1000 < pairs, "{off} of {pairs} depths are not those of the separation");
        assert!(built * 10 > pairs * 7, "{built} of {pairs}");
        assert!(points.iter().all(|&points| points * 10 > pairs), "{points:?} of {pairs}");
        assert!(tied * 100 < pairs, "{tied} of {pairs} tied");
    }
}
