//! The closed set of shape kinds on which queries dispatch.

use core::fmt;

use crate::math::{Point, Pose, Real, Space, max};
use crate::shape::{
    Ball, Capsule, CompositeShape, Cone, Cuboid, Cylinder, Ellipsoid, Plane, Polytope, Rounded,
    Segment, SupportMap, TaperedCapsule, Triangle,
};

/// The kinds of shape that the pair tables distinguish, in the canonical order of a pair.
///
/// ```
/// use impinge::dim3::shape::{Ball, Capsule, Shape, ShapeKind};
///
/// let kind = |shape: &dyn Shape<f32, 3>| shape.geometry().kind();
/// assert_eq!(kind(&Ball::new(1.0)), ShapeKind::Ball);
/// assert_eq!(kind(&Capsule::new(1.0, 0.5)), ShapeKind::Capsule);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ShapeKind {
    /// [`Ball`].
    Ball,
    /// [`Segment`].
    Segment,
    /// [`Capsule`].
    Capsule,
    /// [`Triangle`].
    Triangle,
    /// [`Cuboid`].
    Cuboid,
    /// A convex polygon in 2D, a convex hull in 3D: [`Polytope`].
    Polytope,
    /// [`Cylinder`].
    Cylinder,
    /// [`Cone`].
    Cone,
    /// [`Ellipsoid`]: an ellipse in 2D.
    Ellipsoid,
    /// [`TaperedCapsule`].
    TaperedCapsule,
    /// A convex solid inflated by a radius: [`Rounded`](super::Rounded).
    Rounded,
    /// A user's convex solid, known by its support points only.
    SupportMap,
    /// [`Plane`]: the half-space.
    Plane,
    /// A union of solids: [`CompositeShape`].
    Composite,
}

/// A reference to a shape, with the kind on which queries dispatch. Users obtain one from a
/// built-in shape, from [`Self::support_map`] or from [`Self::composite`].
///
/// ```
/// use impinge::dim2::math::Vector;
/// use impinge::dim2::shape::{Cuboid, Shape, SupportMap};
///
/// let square = Cuboid::new(Vector::new(1.0_f32, 1.0));
/// let geometry = square.geometry();
/// let map = geometry.as_support_map().expect("it is bounded and convex");
/// assert_eq!(map.core_support(&Vector::new(1.0, 2.0)).coords, Vector::new(1.0, 1.0));
/// assert!(geometry.as_composite().is_none());
/// ```
#[derive(Clone, Copy)]
pub struct Geometry<'a, N: Real, const D: usize>(pub(crate) Kind<'a, N, D>);

/// The closed set of kinds with references to the shapes. A shape that exists in one dimension only
/// (cylinder, cone) is accompanied by a support map in `D` dimensions, so that this type needs no
/// trait bound. Such a variant is constructed in that dimension only.
#[derive(Clone, Copy)]
pub(crate) enum Kind<'a, N: Real, const D: usize> {
    Ball(&'a Ball<N>),
    Segment(&'a Segment<N, D>),
    Capsule(&'a Capsule<N, D>),
    Triangle(&'a Triangle<N, D>),
    Cuboid(&'a Cuboid<N, D>),
    Polytope(&'a Polytope<N, D>),
    Cylinder(&'a Cylinder<N>, &'a dyn SupportMap<N, D>),
    Cone(&'a Cone<N>, &'a dyn SupportMap<N, D>),
    Ellipsoid(&'a Ellipsoid<N, D>),
    TaperedCapsule(&'a TaperedCapsule<N, D>),
    Rounded(&'a Rounded<N, D>),
    SupportMap(&'a dyn SupportMap<N, D>),
    Plane(&'a Plane<N, D>),
    Composite(&'a dyn CompositeShape<N, D>),
}

impl<'a, N: Real, const D: usize> Geometry<'a, N, D> {
    /// Returns the geometry of a user's convex solid.
    pub fn support_map(map: &'a dyn SupportMap<N, D>) -> Self {
        Self(Kind::SupportMap(map))
    }

    /// Returns the geometry of a user's composite.
    pub fn composite(composite: &'a dyn CompositeShape<N, D>) -> Self {
        Self(Kind::Composite(composite))
    }

    /// Returns the kind of the shape.
    #[inline]
    #[must_use]
    pub fn kind(&self) -> ShapeKind {
        match self.0 {
            Kind::Ball(_) => ShapeKind::Ball,
            Kind::Segment(_) => ShapeKind::Segment,
            Kind::Capsule(_) => ShapeKind::Capsule,
            Kind::Triangle(_) => ShapeKind::Triangle,
            Kind::Cuboid(_) => ShapeKind::Cuboid,
            Kind::Polytope(_) => ShapeKind::Polytope,
            Kind::Cylinder(..) => ShapeKind::Cylinder,
            Kind::Cone(..) => ShapeKind::Cone,
            Kind::Ellipsoid(_) => ShapeKind::Ellipsoid,
            Kind::TaperedCapsule(_) => ShapeKind::TaperedCapsule,
            Kind::Rounded(_) => ShapeKind::Rounded,
            Kind::SupportMap(_) => ShapeKind::SupportMap,
            Kind::Plane(_) => ShapeKind::Plane,
            Kind::Composite(_) => ShapeKind::Composite,
        }
    }

    /// Returns whether a rotation about the origin may change the solid: false only for a ball,
    /// whose pose needs no rotation.
    #[inline]
    pub(crate) fn turns(&self) -> bool {
        !matches!(self.0, Kind::Ball(_))
    }

    /// Converts a user's isometry to a pose; omits the rotation if [`Self::turns`] is false.
    #[inline]
    pub(crate) fn pose_at(&self, isometry: &N::Isometry) -> Pose<N, D>
    where
        N: Space<D>,
    {
        if self.turns() { N::pose(isometry) } else { N::unturned(isometry) }
    }

    /// Returns the solid as a support map; `None` for a [`Plane`], which is unbounded, and for a
    /// composite, which is not convex.
    #[must_use]
    pub fn as_support_map(&self) -> Option<&'a dyn SupportMap<N, D>> {
        Some(match self.0 {
            Kind::Ball(ball) => ball,
            Kind::Segment(segment) => segment,
            Kind::Capsule(capsule) => capsule,
            Kind::Triangle(triangle) => triangle,
            Kind::Cuboid(cuboid) => cuboid,
            Kind::Polytope(polytope) => polytope,
            Kind::Ellipsoid(ellipsoid) => ellipsoid,
            Kind::TaperedCapsule(capsule) => capsule,
            Kind::Rounded(solid) => solid,
            Kind::Cylinder(_, map) | Kind::Cone(_, map) | Kind::SupportMap(map) => map,
            Kind::Plane(_) | Kind::Composite(_) => return None,
        })
    }

    /// Returns an upper bound, up to rounding, of the distance of the solid's points from the local
    /// origin. Infinite for a half-space, a composite and a user's support map.
    #[inline]
    pub(crate) fn extent(&self) -> N {
        let squared = |point: &Point<N, D>| point.coords.norm_squared();
        let of = |segment: &Segment<N, D>| max(squared(segment.a()), squared(segment.b())).sqrt();
        let of_round = |height: N, radius: N| (height * height + radius * radius).sqrt();
        match self.0 {
            Kind::Ball(ball) => ball.radius(),
            Kind::Segment(segment) => of(segment),
            Kind::Capsule(capsule) => of(capsule.segment()) + capsule.radius(),
            Kind::Triangle(triangle) => {
                let [a, b, c] = triangle.corners();
                max(max(squared(a), squared(b)), squared(c)).sqrt()
            }
            Kind::Cuboid(cuboid) => cuboid.half_extents().norm(),
            Kind::Polytope(polytope) => polytope.reach(),
            Kind::Cylinder(cylinder, _) => of_round(cylinder.half_height(), cylinder.radius()),
            Kind::Cone(cone, _) => of_round(cone.half_height(), cone.radius()),
            Kind::Ellipsoid(ellipsoid) => ellipsoid.reach(),
            Kind::TaperedCapsule(capsule) => capsule.reach() + capsule.rounding(),
            Kind::Rounded(solid) => solid.inner().extent() + solid.radius(),
            Kind::SupportMap(_) | Kind::Plane(_) | Kind::Composite(_) => N::INFINITY,
        }
    }

    /// Returns the shape as a composite; `None` for a single solid.
    #[inline]
    #[must_use]
    pub fn as_composite(&self) -> Option<&'a dyn CompositeShape<N, D>> {
        match self.0 {
            Kind::Composite(composite) => Some(composite),
            _ => None,
        }
    }
}

impl ShapeKind {
    /// The number of kinds.
    pub(crate) const COUNT: usize = Self::Composite as usize + 1;
}

impl<N: Real, const D: usize> fmt::Debug for Geometry<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Geometry").field(&self.kind()).finish()
    }
}
