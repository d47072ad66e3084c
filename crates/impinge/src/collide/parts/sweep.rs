//! Motion of the parts of one shape in the frame of the other shape.

use crate::bounding_volume::Aabb;
use crate::math::{Matrix, Point, Real, Vector, max, min};

/// Motion of the points of one shape during a time interval, in the frame of the other shape. A
/// point `x` stays within `spread` of the segment from `x` to `x + turn · x + shift`.
///
/// ```text
///    ,--------------------.
///   ( x ---------------> o )    spread: largest deviation of the path from the segment
///    `--------------------'
/// ```
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartSweep<N: Real, const D: usize> {
    pub(crate) turn: Matrix<N, D>,
    pub(crate) shift: Vector<N, D>,
    /// Largest deviation of a path from its segment, including the rounding error of positions; not
    /// negative.
    pub(crate) spread: N,
}

impl<N: Real, const D: usize> PartSweep<N, D> {
    /// Returns a motion with no known direction: each point stays within `spread` of its initial
    /// position.
    pub(crate) fn anywhere(spread: N) -> Self {
        Self { turn: Matrix::<N, D>::zeros(), shift: Vector::<N, D>::zeros(), spread }
    }

    /// Returns the displacement of a point along its segment, without the spread.
    pub(crate) fn displacement(&self, point: &Vector<N, D>) -> Vector<N, D> {
        self.turn * point + self.shift
    }

    /// Returns a box that contains all points of `aabb` during the motion; unbounded if `aabb` is
    /// unbounded or a coordinate overflows.
    pub(crate) fn of_box(&self, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        if !aabb.is_bounded() {
            return Aabb::unbounded();
        }
        let displacement = self.displacement(&aabb.center().coords);
        let swing = self.turn.abs() * aabb.half_extents();
        let (low, high) = (displacement - swing, displacement + swing);
        let lowest = Vector::<N, D>::from_fn(|axis, _| min(low[axis], N::ZERO) - self.spread);
        let highest = Vector::<N, D>::from_fn(|axis, _| max(high[axis], N::ZERO) + self.spread);
        let (mins, maxs) = (aabb.mins().coords + lowest, aabb.maxs().coords + highest);
        Aabb::try_new(Point::from(mins), Point::from(maxs)).unwrap_or_else(|_| Aabb::unbounded())
    }
}
