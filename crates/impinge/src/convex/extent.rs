//! Extreme points of a difference along given directions.

use super::candidate::SupportCandidate;
use super::difference::{Difference, Vertex};
use crate::math::{Real, Vector};

/// Returns the two extreme points of a difference along the coordinate axis of its largest extent.
///
/// The distance of the two points along this axis is at least the diameter of the difference over
/// the square root of `D`.
pub(super) fn widest_pair<N: Real, const D: usize>(
    difference: &dyn Difference<N, D>,
) -> [Vertex<N, D>; 2] {
    let (mut pair, mut width) = ([Vertex::zero(); 2], -N::ONE);
    for axis in 0..D {
        let mut direction = Vector::<N, D>::zeros();
        direction[axis] = N::ONE;
        let ends = [difference.lowest(&direction), difference.lowest(&-direction)];
        let found = ends[1].point[axis] - ends[0].point[axis];
        if found > width {
            (pair, width) = (ends, found);
        }
    }
    pair
}

/// Returns the point of a difference farthest along the unit vector `outward`, and its signed
/// distance beyond `base` in that direction.
pub(super) fn farthest<N: Real, const D: usize>(
    difference: &dyn Difference<N, D>,
    outward: &Vector<N, D>,
    base: &Vector<N, D>,
) -> (Vertex<N, D>, N) {
    let vertex = difference.lowest(&-outward);
    (vertex, outward.dot(&(vertex.point - base)))
}

/// Returns the candidate with the largest height among `normals` and their opposites.
pub(super) fn best_of<N: Real, const D: usize>(
    difference: &dyn Difference<N, D>,
    normals: &[Vector<N, D>],
) -> SupportCandidate<N, D> {
    let mut best = SupportCandidate::along(difference, normals[0]);
    best.improve(&SupportCandidate::along(difference, -normals[0]));
    for normal in &normals[1..] {
        best.improve(&SupportCandidate::along(difference, *normal));
        best.improve(&SupportCandidate::along(difference, -normal));
    }
    best
}
