//! The ids of contact points, which stay while their features do.

use super::super::{RawManifold, RawPoint};
use super::frame::Candidate;
use crate::math::Real;

/// Gives candidates the numbers of the old points on the same pair of features: each number to one
/// candidate, the nearest if several share the features, as they do on curved surfaces.
pub(in crate::collide) fn inherit<N: Real, const D: usize>(
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

/// Moves the points of a manifold to the candidates, the nearest of which takes the separation's `distance`, if
/// they have the same features in the same order, each pair of features once; answers whether it did.
pub(in crate::collide) fn renew<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    distance: N,
    out: &mut RawManifold<N, D>,
) -> bool {
    let old = out.points.as_mut_slice();
    let is_same = |(point, new): (&RawPoint<N, D>, &Candidate<N, D>)| {
        point.feature1 == new.features[0] && point.feature2 == new.features[1]
    };
    if old.len() != candidates.len() || !old.iter().zip(candidates).all(is_same) {
        return false;
    }
    let is_twin = |(at, new): (usize, &Candidate<N, D>)| {
        candidates[..at].iter().any(|other| other.features == new.features)
    };
    if candidates.iter().enumerate().any(is_twin) {
        return false;
    }
    let (mut deepest, mut least) = (0, N::INFINITY);
    for (at, (point, new)) in old.iter_mut().zip(candidates).enumerate() {
        (point.point1, point.distance, point.code) = (new.point1, new.distance, 0);
        if new.distance < least {
            (deepest, least) = (at, new.distance);
        }
    }
    if let Some(point) = old.get_mut(deepest) {
        point.distance = distance;
    }
    true
}

/// Replaces the points of a manifold, in the order of their numbers; those without one get the next.
pub(in crate::collide) fn settle<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    chosen: &[usize],
    out: &mut RawManifold<N, D>,
) {
    out.points.clear();
    for &index in chosen {
        let id = candidates[index].kept_id.unwrap_or_else(|| out.ids.next());
        out.points.push(candidates[index].named(id));
    }
    out.sort_points();
}

/// Makes a point the only one of a manifold. It has the number of the old point on its features.
pub(in crate::collide) fn settle_alone<N: Real, const D: usize>(
    alone: &Candidate<N, D>,
    out: &mut RawManifold<N, D>,
) {
    let is_old = |old: &&RawPoint<N, D>| [old.feature1, old.feature2] == alone.features;
    let kept_id = out.points.iter().find(is_old).map(|old| old.id);
    let id = kept_id.unwrap_or_else(|| out.ids.next());
    out.points.clear();
    out.points.push(alone.named(id));
}
