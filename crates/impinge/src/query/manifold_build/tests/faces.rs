//! Whole faces of boxes and hulls in one go against facets and their overlap, bit for bit.

use super::super::along::frame;
use super::super::{build, build3, faces};
use super::scene::Scene;
use crate::math::noise::Noise;
use crate::math::{Point, Space, Vector};
use crate::query::separation::separation_in_space;
use crate::query::{ManifoldRequest, Pair, RawManifold};
use crate::shape::{ConvexHull, Cuboid, Shape};

/// A box, a hull of points anywhere or of points of a grid, which has large faces and equal corners.
fn solid<N: Scene<3>>(noise: &mut Noise, kind: usize) -> Box<dyn Shape<N, 3>> {
    let half = noise.vector::<N>(0.5).map(|x| x.abs() + N::lit(0.25));
    let half = if kind == 3 { Vector::<N, 3>::repeat(N::HALF) } else { half };
    let point = |noise: &mut Noise| match kind {
        1 => noise.vector::<N>(1.0),
        _ => noise.vector::<N>(1.4).map(|x| x.round() * N::HALF),
    };
    if kind == 1 || kind == 2 {
        let points: Vec<_> = (0..14).map(|_| Point::from(point(noise))).collect();
        if let Ok(hull) = ConvexHull::try_from_points(&points) {
            return Box::new(hull);
        }
    }
    Box::new(Cuboid::new(half))
}

/// The manifolds of both ways over a few steps; answers how often there was one in one go.
fn compare<N: Scene<3> + Space<3>>(seed: u64) -> usize {
    let (noise, mut built) = (&mut Noise(seed), 0);
    for round in 0..400_usize {
        let (one, other) = (solid::<N>(noise, round % 4), solid::<N>(noise, round / 4 % 4));
        // Kinds in their order.
        let is_ordered = one.geometry().kind() <= other.geometry().kind();
        let (one, other) = if is_ordered { (one, other) } else { (other, one) };
        let turn = [noise.next(), noise.next(), noise.next()];
        let turn = turn.map(|x| x * [0.0, 0.3, 3.0, 1e-6][round / 16 % 4]);
        let at = noise.vector::<N>(0.5) + Vector::<N, 3>::new(N::ZERO, N::ONE, N::ZERO);
        let pose12 = <N as Scene<3>>::pose(at, turn);
        let mut pair = Pair { first: one.geometry().0, second: other.geometry().0, pose12 };
        let prediction = N::lit([0.02, 0.3][round % 2]);
        let sine = if round % 8 == 7 { 0.1 } else { 0.0 };
        let request = ManifoldRequest { prediction, sine: N::lit(sine), max_points: 4 };
        let (mut found, mut expected) = (RawManifold::default(), RawManifold::default());
        for step in 0..4 {
            if step > 0 {
                pair.pose12.translation += noise.vector::<N>(0.01);
            }
            let Some(separation) = separation_in_space(&pair, prediction) else { break };
            if step == 0 && round % 3 != 2 {
                pair.pose12.translation -= separation.normal * separation.distance;
                continue;
            }
            let frame = frame(&pair, &separation, &request);
            let limits = (&request, 4);
            build((&pair, [None; 2]), &frame, limits, &mut expected);
            if faces::build(&pair, &frame, limits, &mut found).is_ok() {
                built += 1;
                assert_eq!(format!("{found:?}"), format!("{expected:?}"), "round {round}");
            } else {
                // What is known to be shown by now is what facets find anew.
                let mut other = found.clone();
                build3(&pair, &separation, &request, &mut other);
                assert_eq!(format!("{other:?}"), format!("{expected:?}"), "round {round}");
                found = expected.clone();
            }
        }
    }
    built
}

#[test]
fn whole_faces_are_what_facets_say() {
    let built = [compare::<f32>(1), compare::<f64>(2)];
    assert!(built.iter().all(|&built| built > 200), "{built:?} in one go");
}
