//! The clipper of rings against facets and their overlap, which build what has more corners.

use super::super::along::frame;
use super::super::{build, clip};
use super::scene::{Random, Scene, describe, near_pose, solids};
use crate::math::{Real, Space, Vector, max};
use crate::query::separation::separation_in_space;
use crate::query::{ManifoldRequest, Pair, RawManifold, RawPoint};

/// The same features, and places that differ by rounding alone.
fn is_same<N: Real>(a: &RawPoint<N, 3>, b: &RawPoint<N, 3>, room: N) -> bool {
    let off = max((a.point1 - b.point1).norm(), (a.distance - b.distance).abs());
    [a.feature1, a.feature2] == [b.feature1, b.feature2] && off <= room
}

/// The manifolds of all pairs over a few steps; returns how many the clipper built, and their points.
fn compare<N: Scene<3> + Space<3>>(seed: u64, scale: f64) -> [usize; 2] {
    let (random, mut counts) = (&mut Random(seed), [0; 2]);
    for round in 0..60 {
        let (solids1, solids2) = (solids::<N, 3>(scale, random), solids::<N, 3>(scale, random));
        // But for balls, which have a builder of their own, and half-spaces.
        let count = solids1.len() - 1;
        for (index, first) in solids1[..count].iter().enumerate().skip(1) {
            for second in &solids2[index..count] {
                let kinds = [first.geometry().0, second.geometry().0];
                let mut pose12 = near_pose(kinds, (scale, -0.2, 0.02), random);
                if round % 3 == 0 {
                    pose12.rotation.fill_with_identity();
                }
                let mut pair = Pair { first: kinds[0], second: kinds[1], pose12 };
                let sine = if round % 4 == 3 { 0.1 } else { 0.0 };
                for _ in 0..3 {
                    let [built, points] = check(&pair, N::lit(sine), scale);
                    counts = [counts[0] + built, counts[1] + points];
                    pair.pose12.translation += random.vector::<N, 3>(0.02 * scale);
                }
            }
        }
    }
    counts
}

fn check<N: Space<3>>(pair: &Pair<'_, N, 3>, sine: N, scale: f64) -> [usize; 2] {
    let prediction = N::lit(0.05 * scale);
    let Some(separation) = separation_in_space(pair, prediction) else { return [0; 2] };
    let request = ManifoldRequest { prediction, sine, max_points: 64 };
    let frame = frame(pair, &separation, &request);
    let (mut found, mut expected) = (RawManifold::default(), RawManifold::default());
    if !clip::build(pair, &frame, 64, &mut found) {
        return [0; 2];
    }
    build(pair, &frame, (&request, 64), &mut expected);
    let what = format!("{}\n{separation:?}\n{found:?}\n{expected:?}", describe(pair));
    assert_eq!(found.points.len(), expected.points.len(), "{what}");
    let room = N::lit(256.0 * scale) * N::EPSILON;
    for point in &found.points {
        assert!(expected.points.iter().any(|other| is_same(point, other, room)), "{what}");
    }
    assert_eq!(found.points[found.deepest()].distance, separation.distance, "{what}");
    assert_eq!(found.normal, Vector::<N, 3>::from(separation.normal), "{what}");
    [1, found.points.len()]
}

#[test]
fn rings_are_clipped_as_facets_are() {
    for (seed, scale) in [(1, 1.0), (2, 2.0_f64.powi(20)), (3, 2.0_f64.powi(-30))] {
        for [built, points] in [compare::<f32>(seed, scale), compare::<f64>(seed + 10, scale)] {
            assert!(built > 1000 && points > 2000, "{built} manifolds, {points} points");
        }
    }
}
