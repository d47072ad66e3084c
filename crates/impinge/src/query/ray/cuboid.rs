//! Ray casts against a box: the span of time during which the ray's line is inside.

use super::clip::{HalfSpace, clipped};
use super::span::Span;
use crate::bounding_volume::Ray;
use crate::math::{Point, Real, Vector};
use crate::shape::FeatureId;

/// Returns the span by the slab test (Kay and Kajiya 1986), with the crossed faces; `None` if the
/// line misses the box. Corners may be infinite.
///
/// If the ray crosses several faces at the same time, returns the one with the lowest index.
pub(super) fn span<N: Real, const D: usize>(
    corners: [&Point<N, D>; 2],
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    clipped(Span::everything(), (0..2 * D).map(|number| face(corners, number, ray)))
}

/// Returns the half-space of face `number`: `2 · axis` on the positive side of an axis, `2 · axis +
/// 1` on the negative side.
fn face<N: Real, const D: usize>(
    corners: [&Point<N, D>; 2],
    number: usize,
    ray: &Ray<N, D>,
) -> HalfSpace<N, D> {
    let [mins, maxs] = corners;
    let (axis, positive) = (number / 2, number.is_multiple_of(2));
    let (origin, speed) = (ray.origin[axis], ray.dir[axis]);
    let (sign, below, rise) = if positive {
        (N::ONE, maxs[axis] - origin, speed)
    } else {
        (-N::ONE, origin - mins[axis], -speed)
    };
    let mut normal = Vector::<N, D>::zeros();
    normal[axis] = sign;
    let feature = FeatureId::Face(u32::try_from(number).expect("a box has few faces"));
    HalfSpace { normal, below, rise, feature }
}
