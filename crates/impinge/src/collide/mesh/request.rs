//! The request for the contacts of parts, from that for the whole shapes.

use super::{PART_POINTS, size};
use crate::collide::ManifoldRequest;
use crate::collide::Pair;
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::aabb_of;
use crate::math::{Pose, Space, min};
use crate::shape::{Geometry, Kind};

/// Returns the request for each pair of parts, without a rotation: the shape rotates about its
/// nearest point, which may lie on another part. The prediction is larger by the distance by which
/// the rotation of `request` can bring points nearer. [`merge`] later drops the points that the
/// rotation does not bring within the prediction of `request`.
pub(super) fn of_parts<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    request: &ManifoldRequest<N>,
) -> ManifoldRequest<N> {
    let ManifoldRequest { prediction, sine, .. } = *request;
    let Pair { first, second, .. } = between.pair;
    let margin = (sine > N::ZERO).then(|| sine * min(diameter(first), diameter(second)));
    // The margin is unknown if both shapes are unbounded.
    let margin = margin.filter(|margin| margin.is_finite_number()).unwrap_or(N::ZERO);
    ManifoldRequest { prediction: prediction + margin, sine: N::ZERO, max_points: PART_POINTS }
}

/// Returns a length that no distance between two points of a shape exceeds; infinite for a
/// half-space.
fn diameter<N: Space<D>, const D: usize>(kind: Kind<'_, N, D>) -> N {
    match Geometry(kind).as_support_map() {
        Some(map) => N::TWO * size(map),
        None => N::TWO * aabb_of(kind, &Pose::identity()).half_extents().norm(),
    }
}
