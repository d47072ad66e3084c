//! Facets clipped eight lines at a time against one by one, bit for bit.

use super::super::along::{facets, frame};
use super::super::frame::Candidate;
use super::super::overlap::{Candidates, Overlap};
use super::scene::{Random, Scene, solids};
use crate::math::Space;
use crate::query::separation::separation;
use crate::query::{ManifoldRequest, Pair};

/// All that a candidate says.
fn facts<N: Space<D>, const D: usize>(candidates: &Candidates<N, D>) -> Vec<String> {
    let facts = |c: &Candidate<N, D>| format!("{:?} {:?} {:?}", c.point1, c.distance, c.features);
    candidates.iter().map(facts).collect()
}

fn compare<N: Scene<D> + Space<D>, const D: usize>(seed: u64) {
    let random = &mut Random(seed);
    let mut found = 0;
    for round in 0..60 {
        let (solids1, solids2) = (solids::<N, D>(1.0, random), solids::<N, D>(1.0, random));
        // But for the half-space, which has no corners.
        let count = solids1.len() - 1;
        for (index, shape1) in solids1[..count].iter().enumerate() {
            for shape2 in &solids2[index..count] {
                // Turned by anything, by nothing, or hardly.
                let size = [1.0, 0.0, 1e-7][round % 3];
                let turn = [0; 3].map(|_: i32| random.between(-3.0, 3.0) * size);
                let at = random.vector::<N, D>(0.9);
                let pose12 = <N as Scene<D>>::pose(at, turn);
                let (first, second) = (shape1.geometry().0, shape2.geometry().0);
                found += of_pair(&Pair { first, second, pose12 });
            }
        }
    }
    assert!(found > 100, "only {found} pairs have facets with a common area");
}

/// Compares both ways; counts pairs with a common area.
fn of_pair<N: Space<D>, const D: usize>(pair: &Pair<'_, N, D>) -> usize {
    let Some(witness) = separation(pair, N::INFINITY) else { return 0 };
    let is_flat = witness.normal.norm() > N::ZERO && witness.distance.is_finite_number();
    if !is_flat {
        return 0;
    }
    let request = ManifoldRequest::new(N::TWO, N::ZERO, 4);
    let frame = frame(pair, &witness, &request);
    let (first, second) = facets(pair, &frame);
    if first.is_point() || second.is_point() {
        return 0;
    }
    let overlap = Overlap { frame: &frame, first: &first, second: &second };
    let (mut in_lanes, mut one_by_one) = (Candidates::new(), Candidates::new());
    overlap.candidates_in_lanes(&mut in_lanes);
    overlap.candidates_one_by_one(&mut one_by_one);
    assert_eq!(facts(&in_lanes), facts(&one_by_one), "{:?}", pair.pose12);
    usize::from(!in_lanes.is_empty())
}

#[test]
fn eight_lines_at_a_time_are_the_same() {
    compare::<f32, 2>(1);
    compare::<f64, 2>(2);
    compare::<f32, 3>(3);
    compare::<f64, 3>(4);
}
