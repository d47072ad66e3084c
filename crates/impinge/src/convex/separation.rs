//! The separation of a pair, from which all other results about it follow.

use crate::math::{Point, Pose, Real, Vector};

/// How far two solids are apart, or how deep they overlap, and where: in the frame of the first.
///
/// `distance` is signed: positive between disjoint solids; minus the length of the shortest
/// translation that parts them where they overlap; zero where they only touch. It is minus infinity
/// for half-spaces that overlap without bound, and only then.
///
/// Invariant: `point2 = point1 + normal · distance` up to rounding, `point1` on the surface of the
/// first solid and `point2` on that of the second, `normal` unit from the first to the second.
/// Moving the second by `-distance · normal` makes them touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Separation<N: Real, const D: usize> {
    pub(crate) distance: N,
    pub(crate) normal: Vector<N, D>,
    pub(crate) point1: Point<N, D>,
    pub(crate) point2: Point<N, D>,
}

impl<N: Real, const D: usize> Separation<N, D> {
    /// The same fact with the solids swapped, in the frame of the second; `pose12` is its pose.
    pub(crate) fn flipped(&self, pose12: &Pose<N, D>) -> Self {
        Self {
            distance: self.distance,
            normal: -pose12.inverse_vector(&self.normal),
            point1: pose12.inverse_point(&self.point2),
            point2: pose12.inverse_point(&self.point1),
        }
    }

    /// The same fact in other units of length.
    pub(crate) fn scaled(&self, scale: N) -> Self {
        Self {
            distance: self.distance * scale,
            normal: self.normal,
            point1: Point::from(self.point1.coords * scale),
            point2: Point::from(self.point2.coords * scale),
        }
    }

    /// The cores inflated by their rounding radii.
    pub(crate) fn rounded(&self, rounding1: N, rounding2: N) -> Self {
        Self {
            distance: self.distance - rounding1 - rounding2,
            normal: self.normal,
            point1: self.point1 + self.normal * rounding1,
            point2: self.point2 - self.normal * rounding2,
        }
    }
}
