//! Separating axis test of two convex polyhedra with few features: triangles, boxes and hulls.
//! [`segment`] tests segments against triangles and hulls.
//!
//! The test follows D. Gregorius, "The Separating Axis Test between Convex Polyhedra" (GDC 2013),
//! with vertices, planes and edges in lanes of 8:
//!
//! 1. The faces of both solids are queried for the reference face: the face that the other solid
//!    lies farthest above, or least deep below ([`vertices`]).
//! 2. If a lowest point of the other solid lies over that face and above its plane, it
//!    determines the result ([`face`]).
//! 3. Otherwise edges are queried ([`edges`]), but only edges with an end near enough to the plane
//!    of the reference face. If the solids overlap, the query compares the pairs of edges that form
//!    a face of the Minkowski difference, found by their arcs on the Gauss map. If the solids are
//!    apart, it finds the nearest edges.
//!
//! ```text
//!            other solid
//!             \   /                      normal of the reference face
//!              \ /                        ^
//!      low  ----*----------------------   |   separation = low - offset
//!   offset  =========== reference face    |   queried: own edges with an end above
//!          |  own solid |                     low - max_distance, other edges with an end
//!                                             below offset + max_distance
//! ```
//!
//! A result is accepted only with a proof: its two points are as far apart as a pair of supporting
//! planes. Otherwise the pair falls back to the general algorithm. There is no iteration and no
//! state: the result depends on the pair alone.
//!
//! The capacities depend on each other: 32 vertices are the bits of a `u32` ([`vertices`]), 64
//! faces the bits of a `u64` ([`segment`]), and 90 edges have `u8` indices ([`edges`]). 32 vertices
//! have at most 3 · 32 - 6 = 90 edges and 2 · 32 - 4 = 60 faces. [`LANES`] is the block size of
//! [`Polytope`]'s vertices and planes and of the
//! [`PartPacket`](crate::collide::packet::PartPacket)s in `triangles`.
//!
//! [`Polytope`]: crate::shape::Polytope
//!
//! A triangle is a prism without height ([`polyhedral`]). Pairs with thin triangles, flat boxes or
//! large hulls fall back without the test.

mod edges;
mod face;
mod polyhedral;
pub(super) mod segment;
#[cfg(test)]
pub(crate) mod tests;
mod vertices;

use self::face::ReferenceFace;
pub(super) use self::polyhedral::{LocalFeatures, Polyhedral, THIN};
use self::vertices::Vertices;
use super::{Algorithm, general, shared_corner};
use crate::collide::Pair;
use crate::convex::{Separation, Units};
use crate::math::lanes::with_lanes;
use crate::math::simd::{Level, Simd};
use crate::math::{Pose, Real, Wide};

/// Number of vertices, faces or edges in one block.
const LANES: usize = 8;
/// Number of blocks for 32 vertices.
const BLOCKS: usize = 4;
/// Number of blocks for 64 planes of faces, the bits of a `u64` in `segment`.
pub(super) const PLANE_BLOCKS: usize = 8;

/// Returns the separation of two solids with flat faces: triangles, boxes and convex hulls. `None`
/// above `limit`.
///
/// In a tie, faces of the first solid come before faces of the second, each in the order of their
/// indices, and faces come before edges; of pairs of edges, the lower indices win. Cost, in blocks
/// of 8: the product of the numbers of vertices and faces, plus the number of pairs of edges near
/// the reference face. Thin triangles, flat boxes and larger hulls fall back to the general
/// algorithm.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    result(Level::new(), pair, limit).separation(pair, limit, general::of_flat_cores)
}

/// Runs the test; returns `Unproved` also for solids that do not fit the lanes or have no width.
fn result<N: Real>(level: Level, pair: &Pair<'_, N, 3>, limit: N) -> SatResult<N> {
    let features = [LocalFeatures::of(pair.first), LocalFeatures::of(pair.second)];
    let first = Polyhedral::of(pair.first, features[0].as_ref());
    let second = Polyhedral::of(pair.second, features[1].as_ref());
    match (&first, &second) {
        (Some(first), Some(second))
            if first.has_width(second.reach) && second.has_width(first.reach) =>
        {
            sat(level, [first, second], &pair.pose12, limit)
        }
        _ => SatResult::Unproved,
    }
}

/// The result of a separating axis test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SatResult<N: Real> {
    /// The solids are farther apart than the limit.
    Beyond,
    /// The proved separation of the solids, or of their cores.
    Found(Separation<N, 3>),
    /// No result is proved; the caller has to fall back.
    Unproved,
}

impl<N: Real> SatResult<N> {
    /// Returns the separation of the pair, by `fallback` if no result is proved; `None` above
    /// `limit`.
    pub(super) fn separation(
        self,
        pair: &Pair<'_, N, 3>,
        limit: N,
        fallback: Algorithm<N, 3>,
    ) -> Option<Separation<N, 3>> {
        match self {
            Self::Beyond => None,
            Self::Found(found) => Some(shared_corner::with_shared_corner(pair, found))
                .filter(|found| found.distance <= limit),
            Self::Unproved => fallback(pair, limit),
        }
    }
}

/// Returns the length that counts as rounding error, in units of the pair: 8 epsilons.
pub(super) fn rounding_error<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// Returns the value above which a lower bound is beyond the caller's `limit`: the limit plus
/// rounding, in units of the pair.
pub(super) fn beyond_limit<N: Real>(units: &Units<N>, limit: N) -> N {
    let limit = limit * units.shrink;
    limit + N::lit(16.0) * rounding_error::<N>() * (N::ONE + limit.abs())
}

/// Runs the test with the instruction set `level`, on which the result does not depend. Returns
/// `Beyond` if the pose is not finite.
fn sat<N: Real>(
    level: Level,
    solids: [&Polyhedral<'_, N>; 2],
    pose12: &Pose<N, 3>,
    limit: N,
) -> SatResult<N> {
    if !pose12.is_finite() {
        return SatResult::Beyond;
    }
    with_lanes!(level, simd => sat_in_lanes::<_, N, N::Lanes<_>>(simd, solids, pose12, limit))
}

/// Queries the faces of both solids, then computes the separation from the face with the larger
/// height; the first solid's face wins a tie up to rounding.
#[inline(always)]
fn sat_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [first, second]: [&Polyhedral<'_, N>; 2],
    pose12: &Pose<N, 3>,
    limit: N,
) -> SatResult<N> {
    let units = Units::of(first.reach, second.reach, &pose12.translation);
    let (shrink, beyond) = (units.shrink, beyond_limit(&units, limit));
    let in_first = Pose { rotation: pose12.rotation, translation: pose12.translation * shrink };
    let in_second = in_first.inverse();
    let own1 = Vertices::in_own_frame::<S, V>(simd, first, shrink);
    let own2 = Vertices::in_own_frame::<S, V>(simd, second, shrink);
    let placed2 = own2.placed::<S, V>(simd, &in_first);
    let face1 = placed2.query_faces::<S, V>(simd, first.planes, shrink);
    if face1.separation > beyond {
        return SatResult::Beyond;
    }
    let placed1 = own1.placed::<S, V>(simd, &in_second);
    let face2 = placed1.query_faces::<S, V>(simd, second.planes, shrink);
    if face2.separation > beyond {
        return SatResult::Beyond;
    }
    // The other solid is placed in the frame of the solid with the reference face.
    let is_second = face2.separation > face1.separation + rounding_error();
    let (index, solids, pose) = if is_second {
        (face2.index, [(second, &own2), (first, &placed1)], in_second)
    } else {
        (face1.index, [(first, &own1), (second, &placed2)], in_first)
    };
    let reference = ReferenceFace::new::<S, V>(simd, index, solids, pose, shrink);
    let Some(found) = reference.resolve::<S, V>(simd) else { return SatResult::Unproved };
    let found = found.scaled(units.scale);
    SatResult::Found(if is_second { in_first_frame(&found, pose12) } else { found })
}

/// Converts a separation in the frame of the second solid, whose `point1` belongs to the second
/// solid, into a separation in the frame of the first solid. `pose12` is the pose of the second
/// solid in the frame of the first.
pub(super) fn in_first_frame<N: Real>(
    found: &Separation<N, 3>,
    pose12: &Pose<N, 3>,
) -> Separation<N, 3> {
    Separation {
        distance: found.distance,
        normal: -pose12.vector(&found.normal),
        point1: pose12.point(&found.point2),
        point2: pose12.point(&found.point1),
    }
}
