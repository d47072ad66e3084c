//! Ellipsoids, and ellipses in 2D.

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Matrix, Point, Pose, Real, Vector, max_component, unit, unit_or};
use crate::shape::error::{finite, or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::solids::segment::length_of;
use crate::shape::{
    CurvedSupport, Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle, SupportMap,
};

/// The points whose coordinates, divided by the half axes, lie in the unit ball; an ellipse in 2D.
///
/// The centre is the local origin, and the axes are the coordinate axes. Half axes may be zero: the
/// solid is then a flat disk, a segment or a point. The whole surface is `Face(0)`, whose
/// supporting feature is always a point.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::Ellipsoid;
///
/// let pebble = Ellipsoid::new(Vector::new(2.0_f64, 1.0, 3.0));
/// let above = Point::new(0.0, 5.0, 0.0);
/// assert_eq!(pebble.distance_to_point(&Isometry::identity(), &above, true), 4.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<N: Real, const D: usize> {
    half_axes: Vector<N, D>,
}

impl<N: Real, const D: usize> Ellipsoid<N, D> {
    /// Returns the ellipsoid with the given half axes, each zero or more.
    ///
    /// # Panics
    /// If a half axis is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(half_axes: Vector<N, D>) -> Self {
        or_panic(Self::try_new(half_axes))
    }

    /// Returns the ellipsoid with the given half axes, each zero or more.
    ///
    /// # Errors
    /// If a half axis is negative or not finite.
    pub fn try_new(half_axes: Vector<N, D>) -> Result<Self, ShapeError> {
        finite("a half axis", &half_axes)?;
        half_axes.iter().try_for_each(|&half_axis| size("a half axis", half_axis).map(drop))?;
        Ok(Self { half_axes })
    }

    /// Returns the half axes: the extent from the centre to each side, by axis.
    #[inline]
    #[must_use]
    pub const fn half_axes(&self) -> &Vector<N, D> {
        &self.half_axes
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Ellipsoid<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let stretched = direction.component_mul(&self.half_axes);
        let squared = stretched.norm_squared();
        let is_in_range = squared > N::MIN_POSITIVE.sqrt() && squared < N::MAX.sqrt();
        let on_sphere = if is_in_range {
            stretched / squared.sqrt()
        } else {
            // Both factors are scaled to about 1, so that no product overflows or underflows.
            let near_one = |v: &Vector<N, D>| v / max_component(v).power_of_two_below();
            let stretched = near_one(direction).component_mul(&near_one(&self.half_axes));
            unit_or(&stretched, Vector::<N, D>::zeros())
        };
        Point::from(on_sphere.component_mul(&self.half_axes))
    }

    fn curved_support(
        &self,
        _point: &Point<N, D>,
        direction: &Vector<N, D>,
    ) -> Option<CurvedSupport<N, D>> {
        let (on_sphere, length) = unit(&direction.component_mul(&self.half_axes))?;
        let point = on_sphere.component_mul(&self.half_axes);
        let bend = Matrix::<N, D>::from_fn(|i, j| {
            let square = if i == j { self.half_axes[i] * self.half_axes[i] } else { N::ZERO };
            (square - point[i] * point[j]) / length
        });
        Some(CurvedSupport { point: Point::from(point), bend })
    }

    fn reach(&self) -> N {
        max_component(&self.half_axes)
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Ellipsoid<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Ellipsoid(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        Aabb::around(Point::origin(), self.half_axes)
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        let extents = Vector::<N, D>::from_fn(|axis, _| {
            length_of(&pose.rotation.row(axis).transpose().component_mul(&self.half_axes))
        });
        Aabb::around_rotated(pose, extents)
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        BoundingSphere::new(Point::origin(), self.reach())
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let half_axes = self.half_axes.component_mul(&Scale::try_new(scale)?.magnitudes());
        Ok(ShapeHandle::new(Self::try_new(half_axes)?))
    }
}
