//! Solids in their own frame. This module does not depend on pairs or worlds.
//!
//! A convex solid is a *core* inflated by a *rounding* radius: a ball is an inflated point, a
//! capsule an inflated segment. Algorithms run on cores and subtract the radii from the distance at
//! the end, which is exact up to rounding and nearly free. A world stores solids by the trait
//! [`Shape`]; [`SupportMap`] is the trait by which queries accept a user's convex solid;
//! [`ConvexPolyhedron`] gives access to the features of solids with flat faces; [`CompositeShape`]
//! is a union of solids.

mod bounds;
mod compact;
pub(crate) mod composite;
mod debug;
mod error;
mod face_ring;
mod feature;
#[cfg(test)]
mod feature_tests;
mod geometry;
mod handle;
mod mass;
pub(crate) mod polytope;
mod revision;
#[cfg(feature = "serde")]
pub(crate) mod saved;
mod scale;
mod side_or_vertex;
pub(crate) mod solids;
mod support_map;
pub(crate) mod surface;
mod tilt;

pub use bounds::{aabb, bounding_sphere};
pub(crate) use compact::Compact;
pub use composite::body::EnclosedBody;
pub use composite::compound::Compound;
pub(crate) use composite::height_field::FieldEntries;
pub use composite::height_field::{Diagonal, Diagonals, HeightField};
pub use composite::mesh_error::MeshError;
pub use composite::polyline::Polyline;
pub use composite::tri_mesh::{EdgeNeighbor, TriMesh};
pub(crate) use composite::tri_mesh::{MeshByDimension, MeshEntries, box_of_corners};
pub use composite::{CompositeShape, Part, PartPath, PartSearch, PartSolid, Surface};
pub use error::ShapeError;
pub(crate) use face_ring::FaceRing;
pub use feature::{Feature, FeatureId};
pub(crate) use geometry::Kind;
pub use geometry::{Geometry, ShapeKind};
pub use handle::ShapeHandle;
pub use mass::{MassError, MassProperties};
pub(crate) use mass::{Moments, amount, finite};
pub(crate) use polytope::Planes;
pub use polytope::convex_hull::ConvexHull;
pub use polytope::convex_polygon::ConvexPolygon;
pub use polytope::{Polytope, PolytopeEdge, PolytopeFace};
pub(crate) use revision::Revision;
#[cfg(feature = "serde")]
pub use saved::SavedShape;
pub use scale::ScaleError;
pub(crate) use side_or_vertex::SideOrVertex;
pub use solids::ball::Ball;
pub use solids::capsule::Capsule;
pub use solids::cone::Cone;
pub use solids::cuboid::Cuboid;
pub(crate) use solids::cuboid::SupportPart;
pub use solids::cylinder::Cylinder;
pub use solids::ellipsoid::Ellipsoid;
pub use solids::plane::{HalfSpace, Plane};
pub(crate) use solids::round::RoundPart;
pub use solids::rounded::Rounded;
pub use solids::segment::Segment;
pub(crate) use solids::tapered_capsule::Taper;
pub use solids::tapered_capsule::TaperedCapsule;
pub use solids::tetrahedron::Tetrahedron;
pub use solids::triangle::Triangle;
/// Limits within which the fast test of a triangle's supporting feature is inconclusive.
pub(crate) use solids::triangle_feature::{CLEAR as CLEARLY_LARGER, THIN_SQUARED};
pub use support_map::{ConvexPolyhedron, CurvedSupport, SupportMap};
#[doc(hidden)]
pub(crate) use surface::face_seams::FaceSeams;
pub use surface::own_surface::SurfaceAccess;
pub(crate) use surface::sidedness::{KnownSegment, KnownSegments, Sidedness};
pub(crate) use tilt::FACING_SINE_SQUARED;

use core::any::Any;
use core::fmt::Debug;

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Pose, Real, Vector};

/// A solid in its own frame.
///
/// Implement this trait to put your own type into a world. The two required methods return the
/// shape's box, and the geometry on which queries dispatch ([`Shape::geometry`]).
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::{Ball, Polyline, Shape};
///
/// let line: Polyline<f32> = Polyline::open(vec![Point::new(-2.0, 0.0), Point::new(2.0, 1.0)]);
/// let shapes: [Box<dyn Shape<f32, 2>>; 2] = [Box::new(Ball::new(1.0)), Box::new(line)];
/// let widths = shapes.each_ref().map(|shape| 2.0 * shape.local_aabb().half_extents().x);
/// assert_eq!(widths, [2.0, 4.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a shape in {D} dimensions with the scalar `{N}`",
    label = "not a `Shape<{N}, {D}>`",
    note = "a world, its shapes and its poses have one dimension and one scalar: all from `dim2` or all from `dim3`",
    note = "of a `ShapeHandle` the shape is `&*handle`; a type of your own implements `Shape`, beside `SupportMap` \
            or `CompositeShape`"
)]
pub trait Shape<N: Real, const D: usize>: Any + Debug + Send + Sync {
    /// Returns the geometry on which queries dispatch: [`Geometry::support_map`] for a convex solid
    /// of your own, [`Geometry::composite`] for a union of solids, or the geometry of a built-in
    /// shape that represents the solid.
    fn geometry(&self) -> Geometry<'_, N, D>;

    /// Returns an axis-aligned box that contains the solid, in the frame of the solid. The box is
    /// as small as is cheap to compute.
    fn local_aabb(&self) -> Aabb<N, D>;

    /// Returns an axis-aligned box that contains the solid placed at `pose`. The box is as small as
    /// is cheap to compute.
    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        self.local_aabb().transformed_by(pose)
    }

    /// Returns the solid scaled along the axes of its frame, about its origin; factors may be
    /// negative.
    ///
    /// The result is exact up to rounding, and of the same type, except that a ball may become an
    /// [`Ellipsoid`]. Other round shapes need factors of equal magnitude; cylinders and cones need
    /// this only for the two factors across their axis. The axis of a cone cannot be reversed, and
    /// a compound cannot be sheared.
    ///
    /// Parts and features keep their indices if all factors are positive. A negative factor
    /// exchanges the features on opposite sides of a box or a cylinder. If an odd number of factors
    /// is negative, a polygon indexes its vertices in the opposite order, a hull renumbers its
    /// edges, and triangles of meshes and segments of polylines are reversed.
    ///
    /// # Errors
    /// If a factor is zero or not finite, no shape of the library can represent the scaled solid,
    /// or scaled coordinates are out of range. The default returns [`ScaleError::Unsupported`].
    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let _ = scale;
        Err(ScaleError::Unsupported)
    }

    /// Returns the mass properties of the solid at density 1, if the shape has a better method than
    /// [`mass_properties`](crate::query::mass_properties). `None` is the default: then
    /// `mass_properties` integrates a user's convex solid by its support points, and rejects a
    /// user's surface.
    fn unit_mass_properties(&self) -> Option<MassProperties<N, D>> {
        None
    }

    /// Returns the name of the type and the data of the shape for a saved world; see [`SavedShape`]
    /// for an example. Not called for shapes of the library. `None` (the default) for a shape that
    /// cannot be saved.
    #[cfg(feature = "serde")]
    fn saved(&self) -> Option<SavedShape> {
        None
    }

    /// Returns a sphere that contains the solid, in the frame of the solid.
    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        BoundingSphere::around_box(&self.local_aabb())
    }

    /// Returns the nesting depth of the shape, at most [`MAX_NESTING`]; zero (the default) for a
    /// shape that holds no other shape. A user's shape that holds others also returns zero, and
    /// must itself limit the depth of recursion.
    #[doc(hidden)]
    fn nesting(&self) -> u32 {
        0
    }
}

/// The maximum nesting depth of shapes: a [`Compound`] or [`Rounded`] is one deeper than the
/// deepest shape that it holds. Constructors reject deeper shapes.
///
/// Dropping a shape recurses once per level, and so does every query. The limit bounds this
/// recursion, for both shapes of a pair, to a small part of a thread's 2 MB stack.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, Compound, MAX_NESTING, ShapeError, ShapeHandle};
///
/// let mut shape: ShapeHandle<f32> = ShapeHandle::new(Ball::new(1.0));
/// for _ in 0..MAX_NESTING {
///     shape = ShapeHandle::new(Compound::new(vec![(Isometry::translation(1.0, 0.0), shape)]));
/// }
/// let refused = Compound::try_new(vec![(Isometry::identity(), shape)]).expect_err("too deep");
/// assert_eq!(refused, ShapeError::TooDeep { depth: MAX_NESTING + 1 });
/// ```
pub const MAX_NESTING: u32 = 64;

/// Paths to parts, and downcasts for custom dispatchers that handle a type of their own.
///
/// ```
/// use impinge::dim2::shape::{Ball, Cuboid, ShapeHandle};
///
/// let handle = ShapeHandle::new(Ball::new(2.0_f32));
/// assert_eq!(handle.as_shape::<Ball<f32>>().map(Ball::radius), Some(2.0));
/// assert!(!handle.is_shape::<Cuboid<f32>>());
/// ```
impl<N: Real, const D: usize> dyn Shape<N, D> {
    /// Returns the path to part `part` of a composite, for the part index that queries report. The
    /// path is empty for a convex solid, whose only part is 0.
    #[must_use]
    pub fn path_to_part(&self, part: u32) -> PartPath {
        let mut path = PartPath::new();
        if let Some(composite) = self.geometry().as_composite() {
            composite.extend_path(part, &mut path);
        }
        path
    }

    /// Returns whether the shape is of the type `S`.
    #[must_use]
    pub fn is_shape<S: Shape<N, D>>(&self) -> bool {
        self.as_shape::<S>().is_some()
    }

    /// Returns the shape as an `S`; `None` if it has another type.
    #[must_use]
    pub fn as_shape<S: Shape<N, D>>(&self) -> Option<&S> {
        (self as &dyn Any).downcast_ref()
    }
}
