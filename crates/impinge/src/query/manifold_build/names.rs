//! Names of contacts that last while their features do.

use smallvec::SmallVec;

use super::super::{PairIds, RawManifold, RawPoint};
use super::frame::Candidate;
use super::overlap::Candidates;
use crate::math::Real;

/// Gives candidates the numbers of the old points on the same pair of features: each number to one
/// candidate, the nearest if several share the features, as they do on curved surfaces.
pub(super) fn inherit<N: Real, const D: usize>(
    old: &[RawPoint<N, D>],
    candidates: &mut Candidates<N, D>,
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
    candidates: &Candidates<N, D>,
    chosen: &[usize],
    out: &mut RawManifold<N, D>,
) {
    let ids: &mut PairIds = &mut out.ids;
    let mut points: SmallVec<[RawPoint<N, D>; 4]> = SmallVec::new();
    for &index in chosen {
        let id = candidates[index].kept_id.unwrap_or_else(|| ids.next());
        points.push(candidates[index].named(id));
    }
    points.sort_by_key(|point| point.id);
    out.points = points;
}
