//! The separation of a pair of solids, from which all other results for the pair are computed.

use crate::math::{Point, Pose, Real, Vector};

/// Signed distance, normal and points of two solids, in the frame of the first.
///
/// `distance` is positive for disjoint solids, zero if they only touch, and negative if they
/// overlap: minus the length of the shortest translation that separates them. It is minus infinity
/// only for half-spaces that overlap without bound.
///
/// Invariant: `point2 = point1 + normal · distance` up to rounding. `point1` is on the surface of
/// the first solid, `point2` on the surface of the second, and `normal` is the unit vector from the
/// first to the second. Moving the second solid by `-distance · normal` makes the solids touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Separation<N: Real, const D: usize> {
    pub(crate) distance: N,
    pub(crate) normal: Vector<N, D>,
    pub(crate) point1: Point<N, D>,
    pub(crate) point2: Point<N, D>,
}

impl<N: Real, const D: usize> Separation<N, D> {
    /// Returns the separation with the solids swapped, in the frame of the second solid, whose pose
    /// in the frame of the first is `pose12`.
    pub(crate) fn flipped(&self, pose12: &Pose<N, D>) -> Self {
        Self {
            distance: self.distance,
            normal: -pose12.inverse_vector(&self.normal),
            point1: pose12.inverse_point(&self.point2),
            point2: pose12.inverse_point(&self.point1),
        }
    }

    /// Returns the separation in other units of length: lengths are multiplied by `scale`.
    pub(crate) fn scaled(&self, scale: N) -> Self {
        Self {
            distance: self.distance * scale,
            normal: self.normal,
            point1: Point::from(self.point1.coords * scale),
            point2: Point::from(self.point2.coords * scale),
        }
    }

    /// Returns the separation of the cores inflated by these radii.
    pub(crate) fn rounded(&self, rounding1: N, rounding2: N) -> Self {
        Self {
            distance: self.distance - rounding1 - rounding2,
            normal: self.normal,
            point1: self.point1 + self.normal * rounding1,
            point2: self.point2 - self.normal * rounding2,
        }
    }
}
