//! Size of a pair of solids. The tolerances for contact points of the pair are proportional to it.
//!
//! The tolerances in `manifold/ids.rs` (`SHARE`, `REACH`) and in `manifold/mod.rs` (`SLACK`) are
//! fractions of this size; `batch` has versions that compute it for several pairs at a time.

use crate::math::{Point, Real, Vector, min};
use crate::shape::{Geometry, Kind, SupportMap};

/// Returns the smaller of the sizes of two solids. The size of a ball is its radius; of a capsule,
/// its radius plus half the length of its axis; of a half-space, infinity; of any other solid, half
/// the diagonal of its local box.
///
/// The box is used, not the bounding radius around the local origin, because a part's vertices may
/// lie far from its origin.
pub(crate) fn smaller_size<N: Real, const D: usize>(kinds: [Kind<'_, N, D>; 2]) -> N {
    min(half_diagonal(kinds[0]), half_diagonal(kinds[1]))
}

fn half_diagonal<N: Real, const D: usize>(kind: Kind<'_, N, D>) -> N {
    match kind {
        Kind::Ball(ball) => ball.radius(),
        Kind::Segment(segment) => between(segment.a(), segment.b()),
        Kind::Capsule(capsule) => {
            between(capsule.segment().a(), capsule.segment().b()) + capsule.radius()
        }
        Kind::Cuboid(cuboid) => cuboid.half_extents().norm(),
        Kind::Plane(_) => N::INFINITY,
        Kind::Composite(parts) => parts.search().bounds().half_extents().norm(),
        _ => Geometry(kind).as_support_map().map_or(N::INFINITY, of_map),
    }
}

fn between<N: Real, const D: usize>(a: &Point<N, D>, b: &Point<N, D>) -> N {
    (b - a).norm() * N::HALF
}

fn of_map<N: Real, const D: usize>(map: &dyn SupportMap<N, D>) -> N {
    let mut half = Vector::<N, D>::zeros();
    for axis in 0..D {
        let mut along = Vector::<N, D>::zeros();
        along[axis] = N::ONE;
        let [high, low] = [map.core_support(&along), map.core_support(&-along)];
        half[axis] = (high[axis] - low[axis]) * N::HALF + map.rounding();
    }
    half.norm()
}
