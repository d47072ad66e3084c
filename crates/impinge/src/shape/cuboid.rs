//! Boxes (rectangles in the plane).

use super::error::{finite, or_panic, size};
use super::{Geometry, Kind, Shape, ShapeError, SupportMap};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Real, Vector};

/// The points whose coordinate on each axis is within the half extent of zero.
///
/// Half extents may be zero: the box is then flat, a segment or a point.
///
/// Vertices: bit `i` of the number says that coordinate `i` is positive. Faces: `2 · axis` on the
/// positive side of an axis, one more on the negative side. Edges (in space): `4 · axis` of the
/// direction plus two bits, the signs on the next axis and the one after (x → y → z → x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<N: Real, const D: usize> {
    half_extents: Vector<N, D>,
}

impl<N: Real, const D: usize> Cuboid<N, D> {
    /// The box of given half extents, each zero or more.
    ///
    /// # Panics
    /// If a half extent is negative or not finite; [`Self::try_new`] returns these.
    #[must_use]
    #[track_caller]
    pub fn new(half_extents: Vector<N, D>) -> Self {
        or_panic(Self::try_new(half_extents))
    }

    /// The box of given half extents, each zero or more.
    ///
    /// # Errors
    /// If a half extent is negative or not finite.
    pub fn try_new(half_extents: Vector<N, D>) -> Result<Self, ShapeError> {
        finite("a half extent", &half_extents)?;
        for &half_extent in half_extents.iter() {
            size("a half extent", half_extent)?;
        }
        Ok(Self { half_extents })
    }

    /// Half the size along each axis.
    #[inline]
    #[must_use]
    pub const fn half_extents(&self) -> &Vector<N, D> {
        &self.half_extents
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Cuboid<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let toward = |h: N, d: N| if d < N::ZERO { -h } else { h };
        Point::from(self.half_extents.zip_map(direction, toward))
    }

    fn reach(&self) -> N {
        self.half_extents.norm()
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Cuboid<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Cuboid(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        Aabb::around(Point::origin(), self.half_extents)
    }
}
