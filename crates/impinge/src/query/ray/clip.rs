//! The span of a line in an intersection of half-spaces, found by clipping the line with each
//! half-space.

use super::span::{Crossing, Span};
use crate::math::{Real, Vector, max};
use crate::shape::FeatureId;

/// A half-space in the local frame: the points where `normal · x ≤ offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace<N: Real, const D: usize> {
    /// The outward unit normal.
    pub(super) normal: Vector<N, D>,
    /// The depth of the line's origin below the boundary: `offset − normal · origin`.
    pub(super) below: N,
    /// The rate at which the line rises along the normal: `normal · dir`.
    pub(super) rise: N,
    pub(super) feature: FeatureId,
}

/// Clips `span` with all half-spaces (Cyrus and Beck 1978); `None` if nothing is left.
///
/// A line that only touches the intersection may be lost to the rounding of two divisions. So two
/// crossings in the wrong order by a few units in the last place are treated as touching (Ize,
/// "Robust BVH Ray Traversal", 2013, has the same bound).
pub(super) fn clipped<N: Real, const D: usize>(
    mut span: Span<N, D>,
    half_spaces: impl IntoIterator<Item = HalfSpace<N, D>>,
) -> Option<Span<N, D>> {
    for half_space in half_spaces {
        let HalfSpace { normal, below, rise, feature } = half_space;
        if rise == N::ZERO {
            if below < N::ZERO {
                return None;
            }
            // A line in the plane of a face stays on the boundary.
            span.thin |= below == N::ZERO;
            continue;
        }
        let crossing = Crossing::new(below / rise, normal, feature);
        if rise < N::ZERO && crossing.t > span.enter.t {
            span.enter = crossing;
        } else if rise > N::ZERO && crossing.t < span.leave.t {
            span.leave = crossing;
        }
    }
    in_order(&span).then_some(span)
}

/// Returns whether entering comes before leaving, up to rounding.
pub(super) fn in_order<N: Real, const D: usize>(span: &Span<N, D>) -> bool {
    let (enter, leave) = (span.enter.t, span.leave.t);
    enter <= leave || enter - leave <= N::lit(8.0) * N::EPSILON * max(enter.abs(), leave.abs())
}
