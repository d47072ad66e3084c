//! Finds better normals from a few support points, for cores that are apart.

use smallvec::SmallVec;

use super::candidate::SupportCandidate;
use super::difference::{Difference, Vertex, rounding_error};
use super::simplex::Simplicial;
use crate::math::{Vector, min, unit};

/// Support points near the nearest point.
pub(super) type Bundle<N, const D: usize> = SmallVec<[Vertex<N, D>; 16]>;

/// Cap on the number of support points computed.
const ROUNDS: usize = 40;
/// Largest number of points in the bundle; if there are more, the points that are highest along the
/// best normal are dropped.
const KEPT: usize = 8;

/// Raises the height of `best` to the maximum, or until [`ROUNDS`] support points are computed, for
/// a difference that does not contain the origin.
///
/// The height of a normal over a few support points is at least its height over the whole set. So
/// the normal with the largest height over the bundle is computed, among the normals of its points,
/// edges and facets. The support point of this normal is added to the bundle. The search ends if
/// the heights of the normal over the bundle and over the set agree. This is the cutting-plane
/// method of J. Kelley (1960) on the sphere of normals. The method finds the global maximum only if
/// the set does not contain the origin. All points found are added to `support_points`.
pub(super) fn refine<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    support_points: &mut Bundle<N, D>,
    best: &mut SupportCandidate<N, D>,
) {
    let mut bundle = support_points.clone();
    for _ in 0..ROUNDS {
        let (normal, promise) = most_promising(&bundle, &best.normal);
        let worth_it = promise > best.height + rounding_error::<N>() * N::HALF;
        if !worth_it {
            return;
        }
        let candidate = SupportCandidate::along(difference, normal);
        best.improve(&candidate);
        if bundle.iter().any(|vertex| vertex.point == candidate.vertex.point) {
            return;
        }
        support_points.push(candidate.vertex);
        bundle.push(candidate.vertex);
        drop_idle(&mut bundle, &best.normal);
    }
}

/// Returns the unit vector with the largest height over the bundle, and that height; `around` and
/// `-N::MAX` if no point, edge or facet of the bundle has a normal.
fn most_promising<N: Simplicial<D>, const D: usize>(
    bundle: &Bundle<N, D>,
    around: &Vector<N, D>,
) -> (Vector<N, D>, N) {
    let points: SmallVec<[Vector<N, D>; 10]> = bundle.iter().map(|vertex| vertex.point).collect();
    let (mut best, mut promise) = (*around, -N::MAX);
    let mut consider = |direction: &Vector<N, D>| {
        let Some((normal, _)) = unit(direction) else { return };
        let height = points.iter().fold(N::MAX, |low, point| min(normal.dot(point), low));
        if height > promise {
            (best, promise) = (normal, height);
        }
    };
    N::visit_facets(&points, &mut |facet| {
        consider(facet);
        consider(&-facet);
    });
    for (index, point) in points.iter().enumerate() {
        consider(point);
        for other in &points[index + 1..] {
            let edge = other - point;
            consider(&(point - edge * (point.dot(&edge) / edge.norm_squared())));
        }
    }
    (best, promise)
}

/// Drops the points highest along `normal` until [`KEPT`] are left.
fn drop_idle<N: Simplicial<D>, const D: usize>(bundle: &mut Bundle<N, D>, normal: &Vector<N, D>) {
    while bundle.len() > KEPT {
        let (mut idle, mut height) = (0, -N::MAX);
        for (index, vertex) in bundle.iter().enumerate() {
            let candidate = normal.dot(&vertex.point);
            if candidate > height {
                (idle, height) = (index, candidate);
            }
        }
        bundle.swap_remove(idle);
    }
}
