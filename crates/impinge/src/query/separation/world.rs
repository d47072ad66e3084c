//! The separation of two solids in the world, in the order in which they are given.

use crate::convex::Separation;
use crate::math::{AbstractRotation, Isometry, Pose, Space};
use crate::query::pair::{Placed, canonical};
use crate::shape::Shape;

/// The separation of two placed solids in the world frame, `None` beyond `limit`.
///
/// Also `None` if a pose is not finite. Computed in the canonical order and in the frame of that order's first solid, then taken to the
/// world: swapping the arguments swaps the points and turns the normal round, bit for bit.
pub(crate) fn in_world<N: Space<D>, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (pair, swapped) = canonical(&placed1.pose, placed1.shape, &placed2.pose, placed2.shape);
    if !pair.pose12.is_finite() {
        return None;
    }
    let first = if swapped { &placed2.pose } else { &placed1.pose };
    let found = super::separation(&pair, limit)?;
    let (normal, point1, point2) =
        (first.vector(&found.normal), first.point(&found.point1), first.point(&found.point2));
    let distance = found.distance;
    Some(if swapped {
        Separation { distance, normal: -normal, point1: point2, point2: point1 }
    } else {
        Separation { distance, normal, point1, point2 }
    })
}

impl<'a, N: Space<D>, const D: usize> Placed<'a, N, D> {
    /// A shape where the user's isometry puts it.
    pub(crate) fn new<R: AbstractRotation<N, D>>(
        isometry: &Isometry<N, R, D>,
        shape: &'a dyn Shape<N, D>,
    ) -> Self {
        Self { pose: Pose::from_isometry(isometry), shape: shape.geometry() }
    }
}
