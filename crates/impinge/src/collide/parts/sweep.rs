//! Where the parts of one shape go in the frame of the other.

use crate::bounding_volume::Aabb;
use crate::math::{Matrix, Point, Real, Vector, max, min};

/// Where the points of one shape go in a time, in the frame of the other: from a place `x` along the segment to
/// `x + turn · x + shift`, and nowhere farther from it than the spread.
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
    /// With what rounding makes of places; not negative.
    pub(crate) spread: N,
}

impl<N: Real, const D: usize> PartSweep<N, D> {
    /// All points go anywhere, so far at most.
    pub(crate) fn anywhere(spread: N) -> Self {
        Self { turn: Matrix::<N, D>::zeros(), shift: Vector::<N, D>::zeros(), spread }
    }

    /// The way of a point but for the spread.
    pub(crate) fn way(&self, place: &Vector<N, D>) -> Vector<N, D> {
        self.turn * place + self.shift
    }

    /// A box around where the points of a box go.
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
