//! The motion of the parts of one shape in the frame of the other.

use crate::bounding_volume::Aabb;
use crate::math::{Matrix, Point, Real, Vector, max, min};

/// The motion of the points of one shape during some time, in the frame of the other. A point `x`
/// stays within `spread` of the segment from `x` to `x + turn · x + shift`.
///
/// ```text
///    ,--------------------.
///   ( x ---------------> o )    spread: what the path bends
///    `--------------------'
/// ```
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartSweep<N: Real, const D: usize> {
    pub(crate) turn: Matrix<N, D>,
    pub(crate) shift: Vector<N, D>,
    /// The deviation of the path from the segment, with the rounding error of positions; not
    /// negative.
    pub(crate) spread: N,
}

impl<N: Real, const D: usize> PartSweep<N, D> {
    /// A motion of which only a bound is known: each point stays within `spread`.
    pub(crate) fn anywhere(spread: N) -> Self {
        Self { turn: Matrix::<N, D>::zeros(), shift: Vector::<N, D>::zeros(), spread }
    }

    /// The displacement of a point, without the spread.
    pub(crate) fn way(&self, place: &Vector<N, D>) -> Vector<N, D> {
        self.turn * place + self.shift
    }

    /// Returns a box around the swept points of a box.
    pub(crate) fn of_box(&self, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        if !aabb.is_bounded() {
            return Aabb::unbounded();
        }
        let way = self.way(&aabb.center().coords);
        let swing = self.turn.abs() * aabb.half_extents();
        let (low, high) = (way - swing, way + swing);
        let lowest = Vector::<N, D>::from_fn(|axis, _| min(low[axis], N::ZERO) - self.spread);
        let highest = Vector::<N, D>::from_fn(|axis, _| max(high[axis], N::ZERO) + self.spread);
        let (mins, maxs) = (aabb.mins().coords + lowest, aabb.maxs().coords + highest);
        Aabb::try_new(Point::from(mins), Point::from(maxs)).unwrap_or_else(|_| Aabb::unbounded())
    }
}
