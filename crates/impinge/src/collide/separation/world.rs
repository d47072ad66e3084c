//! Separation of two placed solids in the world frame, in the order of the arguments.

use crate::collide::far::Apart;
use crate::collide::pair::{Ordered, Placed, Placing};
use crate::collide::parts::{Between, Wanted, nearest_between};
use crate::convex::Separation;
use crate::math::{IsometryRef, Pose, Real, Space, Vector};
use crate::shape::{Geometry, Shape};
use crate::tables::ByDimension;

/// Returns the separation of two placed solids in the world frame; `None` beyond `limit`.
///
/// Also `None` if a pose is not finite. The separation is computed in canonical order, in the frame
/// of the first solid in that order, and then transformed to the world. So swapping the arguments
/// swaps the points and negates the normal, bit for bit. For overlapping composites it is the
/// separation of the deepest pair of parts, or of a piece of one shape that is inside a body of the
/// other shape.
pub(crate) fn in_world<N: Space<D>, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    of_ordered(&Ordered::new(placed1, placed2), limit)
}

/// Computes [`in_world`] for two solids whose canonical order is known.
#[inline]
pub(crate) fn of_ordered<N: Space<D>, const D: usize>(
    ordered: &Ordered<'_, '_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let found = in_first(ordered, limit, Wanted::Deepest)?;
    Some(placed(&found, ordered.first, ordered.swapped))
}

/// Computes [`in_world`], except that for composites that touch or overlap it may return the
/// separation of any pair of parts that touch or overlap.
pub(crate) fn touching_in_world<N: Space<D>, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    touching_of_ordered(&Ordered::new(placed1, placed2), limit)
}

/// Computes [`touching_in_world`] for two solids whose canonical order is known.
pub(crate) fn touching_of_ordered<N: Space<D>, const D: usize>(
    ordered: &Ordered<'_, '_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let found = in_first(ordered, limit, Wanted::Touching)?;
    Some(placed(&found, ordered.first, ordered.swapped))
}

/// Returns the distance of [`touching_in_world`]; `None` above `limit`, and if a pose is not
/// finite. If `limit` is zero or more, the result for two overlapping convex solids may be any
/// number that is not positive, so that the depth need not be computed.
pub(crate) fn distance_in_world<N: Space<D>, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
    limit: N,
) -> Option<N> {
    let ordered = Ordered::new(placed1, placed2);
    if ordered.has_composite() {
        return of_composites(&ordered, limit, Wanted::Touching).map(|found| found.distance);
    }
    let pair = ordered.pair();
    if !pair.pose12.is_finite() {
        return None;
    }
    <N::Algorithms>::distance(&pair, limit)
}

/// Computes the separation in the frame of the first solid in canonical order; `None` beyond
/// `limit`, and if a pose is not finite.
#[inline]
fn in_first<N: Space<D>, const D: usize>(
    ordered: &Ordered<'_, '_, N, D>,
    limit: N,
    wanted: Wanted,
) -> Option<Separation<N, D>> {
    if ordered.has_composite() {
        return of_composites(ordered, limit, wanted);
    }
    let pair = ordered.pair();
    if pair.pose12.is_finite() { super::separation(&pair, limit) } else { None }
}

/// Computes [`in_first`] if at least one solid is a composite.
fn of_composites<N: Space<D>, const D: usize>(
    ordered: &Ordered<'_, '_, N, D>,
    limit: N,
    wanted: Wanted,
) -> Option<Separation<N, D>> {
    let between = Between::of_ordered(ordered);
    if !between.pair.pose12.is_finite() {
        return None;
    }
    nearest_between(&between, limit, wanted, None).map(|found| found.separation)
}

/// Transforms a separation from the frame of `first` to the world frame, and exchanges its solids
/// if `swapped` is `true`.
#[inline]
pub(crate) fn placed<N: Real, const D: usize>(
    found: &Separation<N, D>,
    first: &Placed<'_, N, D>,
    swapped: bool,
) -> Separation<N, D> {
    let found = if first.shape.turns() {
        let Placed { pose, .. } = first;
        let (normal, point1) = (pose.vector(&found.normal), pose.point(&found.point1));
        Separation { normal, point1, point2: pose.point(&found.point2), ..*found }
    } else {
        let at = &first.pose.translation;
        Separation { point1: found.point1 + at, point2: found.point2 + at, ..*found }
    };
    if swapped {
        let Separation { normal, point1, point2, .. } = found;
        Separation { normal: -normal, point1: point2, point2: point1, ..found }
    } else {
        found
    }
}

impl<'a, N: Space<D>, const D: usize> Placed<'a, N, D> {
    /// Places a shape at the user's isometry; the rotation is dropped if it does not change the
    /// shape.
    #[inline]
    pub(crate) fn new(isometry: IsometryRef<'_, N, D>, shape: Geometry<'a, N, D>) -> Self {
        let pose = if shape.turns() { isometry.pose() } else { isometry.unturned() };
        Self { pose, shape }
    }

    /// Places a shape at an isometry of the type `N::Isometry`.
    #[inline]
    pub(crate) fn of_isometry(isometry: &N::Isometry, shape: Geometry<'a, N, D>) -> Self {
        Self { pose: shape.pose_at(isometry), shape }
    }

    /// Places a solid at a pose; the rotation is dropped if it does not change the solid.
    pub(crate) fn of_pose(pose: &Pose<N, D>, shape: Geometry<'a, N, D>) -> Self {
        Self { pose: if shape.turns() { *pose } else { pose.without_rotation() }, shape }
    }

    /// Places two shapes; `None` if they are certainly farther apart than `limit`.
    #[inline]
    pub(crate) fn within(
        one: &impl Placing<'a, N, D>,
        other: &impl Placing<'a, N, D>,
        limit: N,
    ) -> Option<[Self; 2]> {
        let shapes = [one.shape(), other.shape()];
        let between = other.translation() - one.translation();
        let is_beyond = (Apart { shapes, between }).is_certainly_beyond(limit);
        (!is_beyond).then(|| [one.placed(), other.placed()])
    }
}

/// A shape at the user's isometry, converted to a pose only when needed.
#[derive(Clone, Copy)]
pub(crate) struct AtIsometry<'i, 'a, N: Space<D>, const D: usize> {
    isometry: IsometryRef<'i, N, D>,
    shape: Geometry<'a, N, D>,
}

impl<'i, 'a, N: Space<D>, const D: usize> AtIsometry<'i, 'a, N, D> {
    #[inline]
    pub(crate) fn new(isometry: IsometryRef<'i, N, D>, shape: &'a dyn Shape<N, D>) -> Self {
        Self::of((isometry, shape.geometry()))
    }

    #[inline]
    pub(crate) fn of((isometry, shape): (IsometryRef<'i, N, D>, Geometry<'a, N, D>)) -> Self {
        Self { isometry, shape }
    }
}

impl<'a, N: Space<D>, const D: usize> Placing<'a, N, D> for AtIsometry<'_, 'a, N, D> {
    #[inline]
    fn shape(&self) -> Geometry<'a, N, D> {
        self.shape
    }

    #[inline]
    fn translation(&self) -> Vector<N, D> {
        self.isometry.translation()
    }

    #[inline]
    fn placed(&self) -> Placed<'a, N, D> {
        Placed::new(self.isometry, self.shape)
    }
}
