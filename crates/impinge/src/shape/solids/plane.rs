//! Half-spaces (half-planes in 2D), called planes in ncollide's guide.

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Pose, Real, Unit, Vector};
use crate::shape::error::{or_panic, unit_vector};
use crate::shape::scale::Scale;
use crate::shape::{Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle};

/// The half-space behind a plane through the local origin: solid where `normal · x ≤ 0`.
///
/// Prefer the name [`HalfSpace`]: the solid is not the plane, but all points behind it. `Plane` is
/// the same type under ncollide's name.
///
/// Its only feature is `Face(0)`.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Unit, Vector};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::HalfSpace;
///
/// let floor = HalfSpace::new(Unit::new_normalize(Vector::new(0.0_f32, 1.0, 0.0)));
/// let above = Point::new(7.0, 2.0, -3.0);
/// assert_eq!(floor.distance_to_point(&Isometry::identity(), &above, true), 2.0);
/// assert!(floor.contains_point(&Isometry::identity(), &Point::new(0.0, -9.0, 0.0)));
/// ```
#[doc(alias = "HalfSpace")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane<N: Real, const D: usize> {
    normal: Unit<Vector<N, D>>,
}

/// The half-space behind a plane (in 2D a half-plane): the name to use for [`Plane`].
///
/// ```
/// use impinge::dim2::prelude::*;
///
/// let floor = HalfSpace::new(Unit::new_normalize(Vector::new(0.0_f64, 3.0)));
/// let (here, ball) = (Isometry::identity(), Ball::new(1.0));
/// assert_eq!(distance(&here, &floor, &Isometry::translation(7.0, 5.0), &ball), 4.0);
/// assert_eq!(distance(&here, &floor, &Isometry::translation(7.0, -5.0), &ball), 0.0, "inside");
/// ```
#[doc(alias = "Halfplane")]
pub type HalfSpace<N, const D: usize> = Plane<N, D>;

impl<N: Real, const D: usize> Plane<N, D> {
    /// Returns the half-space with the outward normal `normal`.
    ///
    /// # Panics
    /// If a coordinate of the normal is not finite (the result of normalizing a zero vector), or
    /// its length differs from 1 by more than 0.8 %; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(normal: Unit<Vector<N, D>>) -> Self {
        or_panic(Self::try_new(normal))
    }

    /// Returns the half-space with the outward normal `normal`.
    ///
    /// # Errors
    /// If a coordinate of the normal is not finite, or its length differs from 1 by more than 0.8 %.
    pub fn try_new(normal: Unit<Vector<N, D>>) -> Result<Self, ShapeError> {
        unit_vector("the normal", &normal)?;
        Ok(Self { normal })
    }

    /// Returns the outward unit normal.
    #[inline]
    #[must_use]
    pub const fn normal(&self) -> &Unit<Vector<N, D>> {
        &self.normal
    }
}

impl<N: Real, const D: usize> Plane<N, D> {
    /// Returns the box of the half-space with the outward normal `normal` and a boundary through
    /// `point`. The box is bounded on one side if the normal is exactly along an axis and `point`
    /// is not NaN; otherwise it is unbounded. The caller must not pass a normal that lies along an
    /// axis only by rounding.
    fn aabb_of(normal: &Vector<N, D>, point: &Vector<N, D>) -> Aabb<N, D> {
        let (mut mins, mut maxs) = (*Aabb::unbounded().mins(), *Aabb::unbounded().maxs());
        for axis in 0..D {
            let alone = (0..D).all(|other| other == axis || normal[other] == N::ZERO);
            if alone && normal[axis] > N::ZERO {
                maxs[axis] = point[axis];
            } else if alone && normal[axis] < N::ZERO {
                mins[axis] = point[axis];
            }
        }
        Aabb::try_new(mins, maxs).unwrap_or_else(|_| Aabb::unbounded())
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Plane<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Plane(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        Self::aabb_of(&self.normal, &Vector::<N, D>::zeros())
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        // A rotation matrix times an axis is a column of the matrix, without rounding.
        let is_axis = self.normal.iter().filter(|&&x| x != N::ZERO).count() == 1;
        if is_axis || pose.is_aligned() {
            Self::aabb_of(&pose.vector(&self.normal), &pose.translation)
        } else {
            Aabb::unbounded()
        }
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        BoundingSphere::unbounded()
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let normal = Scale::try_new(scale)?.normal(&self.normal)?;
        Ok(ShapeHandle::new(Self::new(Unit::new_unchecked(normal))))
    }
}
