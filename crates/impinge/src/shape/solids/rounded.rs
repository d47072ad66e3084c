//! Any convex solid, inflated by a radius.

use core::iter;

use crate::bounding_volume::{Aabb, BoundingSphere, BoundingVolume};
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::error::{nesting, or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::{
    CurvedSupport, Feature, Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle, SupportMap,
};

/// The points within `radius` of a convex shape, such as a box with rounded edges.
///
/// The solid is *larger* than the shape by the radius on all sides. The radius may be zero. The
/// features have the ids of the shape's features: a surface point nearest to `Edge(3)` of a box is
/// on `Edge(3)` of the rounded box, which is a piece of a cylinder there. Every signed distance to
/// the solid is the signed distance to the shape minus the radius, and as accurate.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::{Cuboid, FeatureId, Rounded};
///
/// let die = Rounded::new(Cuboid::new(Vector::new(1.0_f64, 1.0, 1.0)), 0.5);
/// let (beyond_edge, beyond_face) = (Point::new(4.0, 5.0, 0.0), Point::new(0.0, 2.0, 0.0));
/// assert_eq!(die.distance_to_point(&Isometry::identity(), &beyond_edge, true), 4.5);
/// assert_eq!(die.project_local_point(&beyond_face).0.point.y, 1.5);
/// assert!(matches!(die.project_local_point(&beyond_edge).1, FeatureId::Edge(_)));
/// ```
#[derive(Clone, Debug)]
pub struct Rounded<N: Real, const D: usize> {
    shape: ShapeHandle<N, D>,
    radius: N,
    /// The nesting depth: one more than the depth of the inner shape.
    depth: u32,
}

impl<N: Real, const D: usize> Rounded<N, D> {
    /// Returns the solid of all points within `radius` of a convex shape.
    ///
    /// # Panics
    /// If the radius is negative or not finite, the shape is not a bounded convex solid, or the
    /// shape already has the nesting depth [`MAX_NESTING`](crate::shape::MAX_NESTING);
    /// [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new<S: Shape<N, D>>(shape: S, radius: N) -> Self {
        or_panic(Self::try_new(shape, radius))
    }

    /// Returns the solid of all points within `radius` of a convex shape.
    ///
    /// # Errors
    /// If the radius is negative or not finite, the shape is a half-space or a composite, or the
    /// shape already has the nesting depth [`MAX_NESTING`](crate::shape::MAX_NESTING).
    pub fn try_new<S: Shape<N, D>>(shape: S, radius: N) -> Result<Self, ShapeError> {
        Self::try_from_handle(ShapeHandle::new(shape), radius)
    }

    /// Returns the solid of all points within `radius` of a shared convex shape.
    ///
    /// # Errors
    /// If the radius is negative or not finite, the shape is a half-space or a composite, or the
    /// shape already has the nesting depth [`MAX_NESTING`](crate::shape::MAX_NESTING).
    pub fn try_from_handle(shape: ShapeHandle<N, D>, radius: N) -> Result<Self, ShapeError> {
        let radius = size("the radius", radius)?;
        let kind = shape.geometry().kind();
        if shape.geometry().as_support_map().is_none() {
            return Err(ShapeError::NotRoundable { kind });
        }
        let depth = nesting(iter::once(shape.nesting()))?;
        Ok(Self { shape, radius, depth })
    }

    /// Returns the inner shape.
    #[inline]
    #[must_use]
    pub const fn shape(&self) -> &ShapeHandle<N, D> {
        &self.shape
    }

    /// Returns the distance by which the solid extends beyond the inner shape on all sides.
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> N {
        self.radius
    }

    /// Returns whether both solids share one inner shape and have equal radii.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.shape.is_same(&other.shape) && self.radius == other.radius
    }

    /// Returns the kind of the inner shape on which queries dispatch, with a reference to the
    /// shape.
    pub(crate) fn inner(&self) -> Geometry<'_, N, D> {
        self.shape.geometry()
    }

    fn map(&self) -> &dyn SupportMap<N, D> {
        self.inner().as_support_map().expect("the constructor has checked it")
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Rounded<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        self.map().core_support(direction)
    }

    fn curved_support(
        &self,
        point: &Point<N, D>,
        direction: &Vector<N, D>,
    ) -> Option<CurvedSupport<N, D>> {
        self.map().curved_support(point, direction)
    }

    fn round_face(&self, direction: &Vector<N, D>) -> Option<Vector<N, D>> {
        self.map().round_face(direction)
    }

    fn round_side(&self) -> Option<(Vector<N, D>, N)> {
        self.map().round_side()
    }

    fn rounding(&self) -> N {
        self.map().rounding() + self.radius
    }

    fn center(&self) -> Point<N, D> {
        self.map().center()
    }

    fn reach(&self) -> N {
        self.map().reach()
    }

    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        self.map().core_feature(direction, out);
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Rounded<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Rounded(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.shape.local_aabb().loosened(self.radius)
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        self.shape.aabb(pose).loosened(self.radius)
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        self.shape.local_bounding_sphere().loosened(self.radius)
    }

    fn nesting(&self) -> u32 {
        self.depth
    }

    /// Requires factors of equal magnitude; otherwise returns an error.
    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let radius = self.radius * Scale::try_new(scale)?.uniform()?;
        Ok(ShapeHandle::new(Self::try_from_handle(self.shape.scaled(scale)?, radius)?))
    }
}
