//! Names of contacts that last while their features do.

use super::super::{RawManifold, RawPoint};
use super::frame::Candidate;
use crate::math::Real;

/// Gives candidates the numbers of the old points on the same pair of features: each number to one
/// candidate, the nearest if several share the features, as they do on curved surfaces.
pub(super) fn inherit<N: Real, const D: usize>(
    old: &[RawPoint<N, D>],
    candidates: &mut [Candidate<N, D>],
) {
    for point in old {
        let features = [point.feature1, point.feature2];
        let arm = |c: &Candidate<N, D>| (c.point1 - point.point1).norm_squared();
        // Each old number goes to one heir only, so no two points of a manifold share one.
        let heirs = candidates.iter_mut().filter(|c| c.kept_id.is_none() && c.features == features);
        let heir = heirs.reduce(|best, c| if arm(c) < arm(best) { c } else { best });
        if let Some(heir) = heir {
            heir.kept_id = Some(point.id);
        }
    }
}

/// Replaces the points of a manifold, in the order of their numbers; those without one get the next.
pub(super) fn settle<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    chosen: &[usize],
    out: &mut RawManifold<N, D>,
) {
    out.points.clear();
    for &index in chosen {
        let id = candidates[index].kept_id.unwrap_or_else(|| out.ids.next());
        out.points.push(candidates[index].named(id));
    }
    if !out.points.is_sorted_by_key(|point| point.id) {
        out.points.sort_by_key(|point| point.id);
    }
}

/// Makes a point the only one of a manifold. It has the number of the old point on its features.
pub(super) fn settle_alone<N: Real, const D: usize>(
    alone: &Candidate<N, D>,
    out: &mut RawManifold<N, D>,
) {
    let is_old = |old: &&RawPoint<N, D>| [old.feature1, old.feature2] == alone.features;
    let kept_id = out.points.iter().find(is_old).map(|old| old.id);
    let id = kept_id.unwrap_or_else(|| out.ids.next());
    out.points.clear();
    out.points.push(alone.named(id));
}
