//! A contact: two points and a normal.

use crate::math::{Point, Real, Unit, Vector};

/// Where two solids touch, overlap or come close, in the world frame.
///
/// `world2 = world1 − depth · normal` up to rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<N: Real, const D: usize> {
    /// The point on the surface of the first solid.
    pub world1: Point<N, D>,
    /// The point on the surface of the second solid.
    pub world2: Point<N, D>,
    /// The unit vector from the first solid to the second.
    pub normal: Unit<Vector<N, D>>,
    /// How deep the solids overlap along the normal: positive when penetrating, zero when touching,
    /// minus the distance when apart.
    pub depth: N,
}

impl<N: Real, const D: usize> Contact<N, D> {
    /// The same contact with the solids swapped.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self { world1: self.world2, world2: self.world1, normal: -self.normal, depth: self.depth }
    }
}
