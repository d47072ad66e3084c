//! Separation of any two bounded convex solids by the general algorithm (`convex`), with a
//! tolerance on the limit and the rule for shared corners, so that results agree with those of the
//! closed forms.

use super::eroded::Eroded;
use super::flat_core::FlatCore;
use super::{shared_corner, wrong_kinds};
use crate::collide::Pair;
use crate::convex::{self, Separation, Simplicial};
use crate::math::{Pose, Real, Vector, max};
use crate::shape::{Kind, SupportMap};

/// Returns the support maps of both solids; ellipsoids are eroded.
fn maps<'a, N: Real, const D: usize>(
    pair: &Pair<'a, N, D>,
) -> (Eroded<'a, N, D>, Eroded<'a, N, D>) {
    match (Eroded::of(pair.first), Eroded::of(pair.second)) {
        (Some(map1), Some(map2)) => (map1, map2),
        _ => wrong_kinds(pair),
    }
}

/// Returns `limit` raised so that rounding rejects no pair within it. The general algorithm may
/// stop at a bound that is wrong by rounding; the exact comparison is made with the final distance.
/// The result is at least zero, because for overlapping solids the bounds may be wrong by more than
/// the final depth.
pub(super) fn loosened<N: Real, const D: usize>(
    map1: &(impl SupportMap<N, D> + ?Sized),
    map2: &(impl SupportMap<N, D> + ?Sized),
    pose12: &Pose<N, D>,
    limit: N,
) -> N {
    let sizes = map1.reach() + map1.rounding() + map2.reach() + map2.rounding();
    // For curved solids the general algorithm stops when its bounds differ by 2⁻⁴⁰ of the size of
    // the pair in `f64`, by 2⁻²⁰ in `f32`.
    let relative = max(N::lit(64.0) * N::EPSILON, N::lit(4.0e-12));
    max(limit, N::ZERO) + relative * (sizes + pose12.translation.norm() + limit.abs())
}

/// Returns the separation of any two bounded convex solids; `None` above `limit`.
pub(super) fn separation<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (map1, map2) = maps(pair);
    let loosened = loosened(&map1, &map2, &pair.pose12, limit);
    let found = if are_smooth(pair) {
        convex::smooth_separation(&map1, &map2, &pair.pose12, loosened)
    } else {
        convex::separation(&map1, &map2, &pair.pose12, loosened)
    };
    let found = found.map(|found| shared_corner::with_shared_corner(pair, found));
    found.filter(|found| found.distance <= limit)
}

/// Returns whether the second solid is an ellipsoid and the first an ellipsoid, segment or capsule.
fn are_smooth<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> bool {
    use Kind::{Capsule, Ellipsoid, Segment};
    matches!((pair.first, pair.second), (Segment(_) | Capsule(_) | Ellipsoid(_), Ellipsoid(_)))
}

/// Returns the separation of two solids whose cores are hulls of points; `None` above `limit`. It
/// is compiled for the concrete type [`FlatCore`], so all calls can be inlined.
pub(super) fn of_flat_cores<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    from_start(pair, limit, None)
}

/// Computes [`of_flat_cores`] with a search that starts along `normal`, a unit vector from the
/// first solid to the second. The closer `normal` is to the normal of the result, the fewer steps
/// are usually needed.
pub(super) fn of_flat_cores_near<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
    normal: &Vector<N, D>,
) -> Option<Separation<N, D>> {
    from_start(pair, limit, Some(normal))
}

/// Computes [`of_flat_cores`] with a search that starts along the unit vector `start`; `None`
/// stands for the line of the centres.
fn from_start<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
    start: Option<&Vector<N, D>>,
) -> Option<Separation<N, D>> {
    let (Some(map1), Some(map2)) = (FlatCore::of(pair.first), FlatCore::of(pair.second)) else {
        wrong_kinds(pair)
    };
    let loosened = loosened(&map1, &map2, &pair.pose12, limit);
    let found = convex::flat_separation(&map1, &map2, &pair.pose12, loosened, start);
    let found = found.map(|found| shared_corner::with_shared_corner(pair, found));
    found.filter(|found| found.distance <= limit)
}

/// Returns the distance of [`separation`]; zero instead if the search finds that the cores
/// certainly overlap. `None` above `limit`.
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
            let loosened = loosened(&map1, &map2, &pair.pose12, limit);
            convex::distance(&map1, &map2, &pair.pose12, loosened)
        }
    };
    found.filter(|distance| *distance <= limit)
}
