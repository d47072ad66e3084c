//! The shared stretch of two sides of the plane against facets and their overlap, bit for bit.

use super::super::frame::Frame;
use super::super::{build, stretch, tangents2};
use super::scene::{Random, Scene, solids};
use crate::math::Space;
use crate::query::separation::separation;
use crate::query::{ManifoldRequest, Pair, RawManifold};
use crate::shape::{Ellipsoid, Rounded, Shape};

fn compare<N: Scene<2> + Space<2>>(seed: u64) {
    let random = &mut Random(seed);
    let (mut built, mut points) = (0, [0; 3]);
    for round in 0..200 {
        let shapes = [(); 2].map(|()| {
            let mut shapes = solids::<N, 2>(1.0, random);
            // The half-space is the last one.
            shapes.pop();
            let half = random.vector::<N, 2>(0.5).abs().map(|x| x + N::EPSILON);
            shapes.push(Box::new(Ellipsoid::new(half)) as Box<dyn Shape<N, 2>>);
            shapes.push(Box::new(Rounded::new(crate::shape::Cuboid::new(half), N::lit(0.1))));
            shapes
        });
        for (index, shape1) in shapes[0].iter().enumerate() {
            for shape2 in &shapes[1][index..] {
                let size = [1.0, 0.0, 1e-7, 0.1][round % 4];
                let turn = [0; 3].map(|_: i32| random.between(-3.0, 3.0) * size);
                let pose12 = <N as Scene<2>>::pose(random.vector::<N, 2>(1.2), turn);
                let (first, second) = (shape1.geometry().0, shape2.geometry().0);
                let pair = Pair { first, second, pose12 };
                if let Some(count) = of_pair(&pair, round) {
                    built += 1;
                    points[count] += 1;
                }
            }
        }
    }
    assert!(built > 1000 && points[1] > 300 && points[2] > 300, "{built} pairs, {points:?}");
}

/// Compares both ways, from nothing and from what they made; how many points there are.
fn of_pair<N: Space<2>>(pair: &Pair<'_, N, 2>, round: usize) -> Option<usize> {
    let witness = separation(pair, N::INFINITY)?;
    let angle = N::lit([0.0, 0.2][round % 2]);
    let request = ManifoldRequest::new(N::lit(0.3), angle, [2, 1][round % 5 / 4]);
    let frame = Frame::new(pair, &witness, &request, tangents2(&witness.normal));
    let limits = (&request, request.max_points.min(2));
    let (mut quick, mut slow) = (RawManifold::default(), RawManifold::default());
    for _ in 0..2 {
        if !stretch::build(pair, &frame, limits, &mut quick) {
            return None;
        }
        build(pair, &frame, limits, &mut slow);
        if slow.points.is_empty() {
            // The normal of none says nothing.
            quick.normal = slow.normal;
        }
        assert_eq!(quick, slow, "{:?} in round {round}", pair.pose12);
    }
    Some(slow.points.len())
}

#[test]
fn stretches_are_what_facets_share() {
    compare::<f32>(5);
    compare::<f64>(6);
}
