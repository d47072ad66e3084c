//! Any two convex solids: the general algorithm, and what it takes to agree with the others.

use super::flat_core::FlatCore;
use super::wrong_kinds;
use crate::collide::Pair;
use crate::convex::{self, Separation, Simplicial};
use crate::math::{Pose, Real, max};
use crate::shape::{Geometry, SupportMap};

/// The two solids of a pair as support maps.
fn maps<'a, N: Real, const D: usize>(
    pair: &Pair<'a, N, D>,
) -> (&'a dyn SupportMap<N, D>, &'a dyn SupportMap<N, D>) {
    let (first, second) = (Geometry(pair.first), Geometry(pair.second));
    match (first.as_support_map(), second.as_support_map()) {
        (Some(map1), Some(map2)) => (map1, map2),
        _ => wrong_kinds(pair),
    }
}

/// A limit that nothing within `limit` exceeds by rounding: the general algorithm may give up on a
/// bound that is off by rounding, and the exact comparison is made with the final distance. Zero or
/// more: of solids that overlap, bounds may be off by more than the depth found in the end.
pub(super) fn loosened<N: Real, const D: usize>(
    map1: &(impl SupportMap<N, D> + ?Sized),
    map2: &(impl SupportMap<N, D> + ?Sized),
    pose12: &Pose<N, D>,
    limit: N,
) -> N {
    let sizes = map1.reach() + map1.rounding() + map2.reach() + map2.rounding();
    // Of curved solids the general algorithm is content with 2⁻⁴⁰ of the size.
    let relative = max(N::lit(64.0) * N::EPSILON, N::lit(4.0e-12));
    max(limit, N::ZERO) + relative * (sizes + pose12.translation.norm() + limit.abs())
}

/// The separation of any two convex solids.
pub(super) fn separation<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (map1, map2) = maps(pair);
    let loosened = loosened(map1, map2, &pair.pose12, limit);
    let found = convex::separation(map1, map2, &pair.pose12, loosened);
    found.filter(|found| found.distance <= limit)
}

/// The separation of two solids whose cores are hulls of points: the same, with all in one place for
/// the compiler.
pub(super) fn of_flat_cores<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Some(map1), Some(map2)) = (FlatCore::of(pair.first), FlatCore::of(pair.second)) else {
        wrong_kinds(pair)
    };
    let loosened = loosened(&map1, &map2, &pair.pose12, limit);
    let found = convex::flat_separation(&map1, &map2, &pair.pose12, loosened);
    found.filter(|found| found.distance <= limit)
}

/// The distance in [`separation`], or zero if the solids certainly overlap.
pub(super) fn distance<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<N> {
    let found = match (FlatCore::of(pair.first), FlatCore::of(pair.second)) {
        (Some(map1), Some(map2)) => {
            let loosened = loosened(&map1, &map2, &pair.pose12, limit);
            convex::flat_distance(&map1, &map2, &pair.pose12, loosened)
        }
        _ => {
            let (map1, map2) = maps(pair);
            let loosened = loosened(map1, map2, &pair.pose12, limit);
            convex::distance(map1, map2, &pair.pose12, loosened)
        }
    };
    found.filter(|distance| *distance <= limit)
}
