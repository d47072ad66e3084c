//! The names of the library for 3D.
//!
//! Most types here are aliases of the generic type of the same name at the crate's root, with `D` =
//! 3: `dim3::world::CollisionWorld<N, T>` is `world::CollisionWorld<N, 3, T>`. The module
//! [`prelude`] re-exports the names that common programs need.
//!
//! ```
//! use impinge::dim3::math::{Isometry, Vector};
//! use impinge::dim3::shape::{Ball, Cuboid, ShapeHandle};
//! use impinge::dim3::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
//!
//! let mut world = CollisionWorld::new(0.02_f32);
//! let groups = CollisionGroups::new();
//! let contacts = GeometricQueryType::Contacts(0.0, 0.0);
//! let ball = ShapeHandle::new(Ball::new(0.5));
//! let floor = ShapeHandle::new(Cuboid::new(Vector::new(10.0, 1.0, 10.0)));
//! let floor = world.add(Isometry::identity(), floor, groups, contacts, "floor");
//! let ball = world.add(Isometry::translation(0.0, 4.0, 0.0), ball, groups, contacts, "ball");
//! world.update();
//! assert!(world.contact_events().is_empty(), "they are apart");
//!
//! world.set_position(ball, Isometry::translation(0.0, 1.5, 0.0));
//! world.update();
//! assert_eq!(world.contact_events().len(), 1, "they touch");
//! let (_, other, manifold) = world.contact_manifolds().next().expect("they touch");
//! assert_eq!(*other.data(), "ball");
//! let contact = manifold.deepest_contact().expect("a manifold has contacts").contact;
//! assert_eq!(contact.normal.y, 1.0, "from the floor, which was added first, to the ball");
//! # assert!(world.contains(floor));
//! ```

mod filter;
pub mod prelude;

/// Bounding volumes of shapes.
pub mod bounding_volume {
    pub use crate::bounding_volume::{AabbError, BoundingSphereError, BoundingVolume};
    pub use crate::shape::{aabb, bounding_sphere};

    /// An axis-aligned box in 3D.
    pub type Aabb<N> = crate::bounding_volume::Aabb<N, 3>;
    /// A ball that encloses a shape.
    pub type BoundingSphere<N> = crate::bounding_volume::BoundingSphere<N, 3>;
}

/// Drawing worlds, shapes and queries with a custom back end, which implements `DebugRender<N, 3>`.
#[cfg(feature = "debug_render")]
pub mod debug_render {
    pub use crate::debug_render::{Color, DebugOptions, DebugRender, Drawn, MeshOptions, Style};

    /// Draws worlds, shapes and queries in 3D.
    pub type DebugDrawing<N> = crate::debug_render::DebugDrawing<N, 3>;
    /// The lines and triangles that draw a shape.
    pub type ShapeMesh<N> = crate::debug_render::ShapeMesh<N, 3>;
    /// A shape that moves along a straight path.
    pub type SweptShape<'a, N> = crate::debug_render::SweptShape<'a, N, 3>;
}

/// Batches: one query runs for many placed shapes and writes each quantity to an output column.
pub mod batch {
    pub use crate::batch::{
        AsPose, BatchError, Control, MatrixError, NO_FEATURE, OnePose, PoseSource, TileCut,
        TileRows, boxes, pairs_in_tile, pairs_within, pairs_within_one, tiles,
    };

    /// The shapes of one side of a batch.
    pub type Shapes<'a, N> = crate::batch::Shapes<'a, N, 3>;
    /// Shapes and their poses.
    pub type Side<'a, N> = crate::batch::Side<'a, N, 3>;
    /// Poses as homogeneous matrices in a flat array.
    pub type Matrices<'a, N> = crate::batch::Matrices<'a, N, 3>;
    /// A batch of pairs of placed shapes, element by element.
    pub type PairBatch<'a, N> = crate::batch::PairBatch<'a, N, 3>;
    /// A batch of points and placed shapes.
    pub type PointBatch<'a, N> = crate::batch::PointBatch<'a, N, 3>;
    /// A batch of rays and placed shapes.
    pub type RayColumns<'a, N> = crate::batch::RayColumns<'a, N, 3>;
    /// Output columns of nearest points.
    pub type ClosestColumns<'a, N> = crate::batch::ClosestColumns<'a, N, 3>;
    /// Output columns of witnesses.
    pub type WitnessColumns<'a, N> = crate::batch::WitnessColumns<'a, N, 3>;
    /// Output columns of contacts.
    pub type ContactColumns<'a, N> = crate::batch::ContactColumns<'a, N, 3>;
    /// Output columns of impacts.
    pub type ImpactColumns<'a, N> = crate::batch::ImpactColumns<'a, N, 3>;
    /// Output columns of projections of points.
    pub type ProjectionColumns<'a, N> = crate::batch::ProjectionColumns<'a, N, 3>;
    /// Output columns of ray hits.
    pub type HitColumns<'a, N> = crate::batch::HitColumns<'a, N, 3>;
    /// A division of space into tiles.
    pub type Tiles<N> = crate::batch::Tiles<N, 3>;
    /// The contact points of many pairs.
    pub type ManifoldRows<N> = crate::batch::ManifoldRows<N, 3>;
}

/// The configuration checker: tests which of many configurations of a robot are free of collisions.
pub mod checker {
    pub use crate::checker::{CheckerError, NO_PAIR, NearestColumns};

    /// A robot of bodies on moving frames, and obstacles.
    pub type Checker<N> = crate::checker::Checker<N, 3>;
    /// A tree of frames whose joints are driven by a configuration.
    pub type FrameTree<N> = crate::checker::FrameTree<N, 3>;
    /// A frame that a joint connects to its parent.
    pub type Frame<N> = crate::checker::Frame<N, 3>;
    /// The motion of a frame relative to its parent.
    pub type Joint<N> = crate::checker::Joint<N, 3>;
    /// A shape fixed to a frame.
    pub type Body<N> = crate::checker::Body<N, 3>;
    /// A shape fixed in the world.
    pub type Obstacle<N> = crate::checker::Obstacle<N, 3>;
}

/// The broad phase: pairs of objects whose bounding volumes overlap.
pub mod broad_phase {
    pub use super::filter::BroadPhasePairFilter;
    pub use crate::broad_phase::{
        BroadPhase, BroadPhaseError, DBVTBroadPhase, Proposal, ProxyHandle, TreeVolume,
        VisitProposals,
    };
}

/// The narrow phase: contacts and proximities of the pairs that the broad phase proposes.
///
/// The traits to implement have the dimension as a parameter: `ContactDispatcher<N, 3>`, `Shape<N,
/// 3>`, `NarrowPhase<N, 3, T>`.
pub mod narrow_phase {
    pub use crate::narrow_phase::{
        CollisionObjectHandle, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
        IdAllocator, Interaction, PairProximityDetector, ProximityDetector, ProximityDispatcher,
        ProximityPair, ReuseError,
    };
    pub use crate::world::{NarrowPhase, ProximityPairs};

    /// An iterator over the pairs of a narrow phase with their contacts.
    pub type ContactPairs<'a, N> = crate::world::ContactPairs<'a, N, 3>;
    /// The narrow phase of a new world: contacts and proximities.
    pub type DefaultNarrowPhase<N> = crate::narrow_phase::DefaultNarrowPhase<N, 3>;
    /// The dispatcher that selects the library's contact algorithm for every pair of shapes.
    pub type DefaultContactDispatcher = crate::narrow_phase::DefaultContactDispatcher<3>;
    /// The dispatcher that selects the library's proximity algorithm for every pair of shapes.
    pub type DefaultProximityDispatcher = crate::narrow_phase::DefaultProximityDispatcher<3>;
    /// The contact algorithm of the library, for a single pair of any shapes.
    pub type PairManifoldGenerator<N> = crate::narrow_phase::PairManifoldGenerator<N, 3>;
    /// A boxed contact algorithm.
    pub type ContactAlgorithm<N> = crate::narrow_phase::ContactAlgorithm<N, 3>;
    /// A boxed proximity algorithm.
    pub type ProximityAlgorithm<N> = crate::narrow_phase::ProximityAlgorithm<N, 3>;
    /// The contacts of a pair of objects.
    pub type ContactPair<'a, N> = crate::narrow_phase::ContactPair<'a, N, 3>;
    /// All contacts of an update in dense lists.
    pub type ContactStream<N> = crate::narrow_phase::ContactStream<N, 3>;
    /// A manifold in a stream.
    pub type StreamManifold<N> = crate::narrow_phase::StreamManifold<N, 3>;
    /// A contact point in a stream.
    pub type StreamPoint<N> = crate::narrow_phase::StreamPoint<N, 3>;
    /// The poses, shapes and query types that a narrow phase reads.
    pub type ObjectTable<N> = crate::narrow_phase::ObjectTable<N, 3>;
}

/// Events: the contacts that began or ended in an update, and the proximities that changed.
pub mod events {
    pub use crate::narrow_phase::{ContactEvent, Events, ProximityEvent};
    pub use crate::query::Proximity;
}

/// Worlds of objects, and the pairs that touch as of the last update.
pub mod world {
    pub use super::filter::BroadPhasePairFilter;
    pub use crate::narrow_phase::{
        CollisionObjectHandle, ContactQuery, GeometricQueryType, ProximityQuery,
    };
    pub use crate::world::{CollisionGroups, GroupError, NarrowPhase, WorldError, WorldMark};
    #[cfg(feature = "serde")]
    pub use crate::world::{RestoreError, SaveError};

    /// A world in 3D.
    pub type CollisionWorld<N, T> = crate::world::CollisionWorld<N, 3, T>;
    /// An object of a world.
    pub type CollisionObject<N, T> = crate::world::CollisionObject<N, 3, T>;
    /// The objects of a world.
    pub type CollisionObjects<N, T> = crate::world::CollisionObjects<N, 3, T>;
    /// A filter that selects the objects that a query considers.
    pub type QueryFilter<'a, N, T> = crate::world::QueryFilter<'a, N, 3, T>;
    /// An object near the point or shape of a query, with the distance.
    pub type NearObject<'a, N, T> = crate::world::NearObject<'a, N, 3, T>;
    /// The custom shapes and filters to which saved worlds refer by name.
    #[cfg(feature = "serde")]
    pub type Registry<N, T> = crate::world::Registry<N, 3, T>;
    /// A world as serializable data.
    #[cfg(feature = "serde")]
    pub type SavedWorld<N, T> = crate::world::SavedWorld<N, 3, T>;
}

/// Queries of one shape or of two shapes.
pub mod query {
    pub use crate::narrow_phase::{ContactPrediction, contact_manifolds, each_contact_manifold};
    pub use crate::query::{
        Barycentric, ContactId, ImpactOptions, ImpactStatus, MassError, PointLocation, PointQuery,
        Proximity, RayCast, RigidMotion, closest_points, contact, distance, impact,
        mass_properties, mass_properties_with, nonlinear_time_of_impact, proximity, time_of_impact,
        witness,
    };

    /// A ray: a half-line with a start and a velocity.
    pub type Ray<N> = crate::query::Ray<N, 3>;
    /// The hit of a ray: the time, the normal, the part and the feature.
    pub type RayIntersection<N> = crate::query::RayIntersection<N, 3>;
    /// Rays that are cast together; see [`crate::query::RayBatch`].
    pub type RayBatch<'a, N> = crate::query::RayBatch<'a, N, 3>;
    /// The projection of a point onto a shape: the nearest point of the shape.
    pub type PointProjection<N> = crate::query::PointProjection<N, 3>;
    /// The points of two solids that are nearest to each other.
    pub type ClosestPoints<N> = crate::query::ClosestPoints<N, 3>;
    /// The nearest points of two shapes with their parts and features.
    pub type Witness<N> = crate::query::Witness<N, 3>;
    /// A point at which two solids touch, or are within the prediction of a query.
    pub type Contact<N> = crate::query::Contact<N, 3>;
    /// A solid that moves along a straight line.
    pub type Moving<'a, N> = crate::query::Moving<'a, N, 3>;
    /// A body that translates and rotates with constant velocities.
    pub type ConstantVelocities<N> = crate::query::ConstantVelocities<N, 3>;
    /// The time and place at which two moving solids first touch.
    pub type Impact<N> = crate::query::Impact<N, 3>;
    /// The mass, centre of mass and inertia of a body.
    pub type MassProperties<N> = crate::query::MassProperties<N, 3>;
    /// The motion of a contact relative to its solids.
    pub type ContactKinematic<N> = crate::query::ContactKinematic<N, 3>;
    /// The data of one solid in a contact, for custom algorithms.
    pub type ContactSide<N> = crate::query::ContactSide<N, 3>;
    /// The local geometry of a solid near a contact.
    pub type NeighborhoodGeometry<N> = crate::query::NeighborhoodGeometry<N, 3>;
    /// A contact with its kinematic and its id.
    pub type TrackedContact<N> = crate::query::TrackedContact<N, 3>;
    /// A contact with its parts, its features and its id, but without its kinematic.
    pub type ContactPoint<N> = crate::query::ContactPoint<N, 3>;
    /// A manifold read in place: contacts, ids, features, parts and kinematics.
    pub type ManifoldView<'a, N> = crate::query::ManifoldView<'a, N, 3>;
    /// A manifold with its own storage.
    pub type ContactManifold<N> = crate::query::ContactManifold<N, 3>;
}

/// The shapes: convex solids, half-spaces and composites.
pub mod shape {
    #[cfg(feature = "serde")]
    pub use crate::shape::SavedShape;
    pub use crate::shape::{
        Ball, CompositeShape, Cone, ConvexHull, ConvexPolyhedron, Cylinder, Diagonal, Diagonals,
        EdgeNeighbor, FeatureId, MAX_NESTING, MeshError, PartPath, PartSearch, ScaleError, Shape,
        ShapeError, ShapeKind, SupportMap, Surface, Tetrahedron,
    };

    /// A support point on a curved feature, and its derivative with respect to the direction.
    pub type CurvedSupport<N> = crate::shape::CurvedSupport<N, 3>;
    /// A box.
    pub type Cuboid<N> = crate::shape::Cuboid<N, 3>;
    /// The points within a radius of a segment.
    pub type Capsule<N> = crate::shape::Capsule<N, 3>;
    /// A half-space: all points behind a plane.
    pub type HalfSpace<N> = crate::shape::Plane<N, 3>;
    /// An alias of [`HalfSpace`], which is the preferred name.
    pub type Plane<N> = crate::shape::Plane<N, 3>;
    /// A straight line segment between two points.
    pub type Segment<N> = crate::shape::Segment<N, 3>;
    /// A filled triangle.
    pub type Triangle<N> = crate::shape::Triangle<N, 3>;
    /// The points within a radius of a convex shape.
    pub type Rounded<N> = crate::shape::Rounded<N, 3>;
    /// The convex hull of two balls.
    pub type TaperedCapsule<N> = crate::shape::TaperedCapsule<N, 3>;
    /// A ball scaled along the axes.
    pub type Ellipsoid<N> = crate::shape::Ellipsoid<N, 3>;
    /// A surface of triangles.
    pub type TriMesh<N> = crate::shape::TriMesh<N, 3>;
    /// A chain of segments, open or closed.
    pub type Polyline<N> = crate::shape::Polyline<N, 3>;
    /// A vertex, an edge or a face, with its points.
    pub type Feature<N> = crate::shape::Feature<N, 3>;
    /// The geometry of a shape, as queries read it.
    pub type Geometry<'a, N> = crate::shape::Geometry<'a, N, 3>;
    /// A part of a composite: a solid and its pose.
    pub type Part<'a, N> = crate::shape::Part<'a, N, 3>;
    /// The solid of a part.
    pub type PartSolid<'a, N> = crate::shape::PartSolid<'a, N, 3>;
    /// A union of placed shapes.
    pub type Compound<N> = crate::shape::Compound<N, 3>;
    /// A surface given by heights over a grid.
    pub type HeightField<N> = crate::shape::HeightField<N, 3>;
    /// A shape shared by many objects.
    pub type ShapeHandle<N> = crate::shape::ShapeHandle<N, 3>;
}

/// Convex hulls of points, and shapes made from them.
pub mod transformation {
    pub use crate::transformation::{
        IndexedHull, convex_hull3 as convex_hull, convex_shape3 as convex_shape,
    };
}

/// The surfaces of the shapes, as triangles.
///
/// ```
/// use impinge::dim3::procedural;
/// use impinge::dim3::shape::Cylinder;
///
/// let surface = procedural::cylinder(&Cylinder::new(1.0_f32, 0.5), 24);
/// assert_eq!((surface.vertices.len(), surface.triangles.len()), (50, 96));
/// ```
pub mod procedural {
    pub use crate::procedural::space::{
        ball, capsule, cone, convex_hull, cuboid, cylinder, ellipsoid, tapered_capsule,
        tetrahedron, triangle,
    };
    pub use crate::procedural::{MAX_SUBDIVISIONS, MIN_SUBDIVISIONS, TriangleSurface};
}

/// Search trees over boxes of the user.
///
/// ```
/// use impinge::dim3::bounding_volume::Aabb;
/// use impinge::dim3::math::Point;
/// use impinge::dim3::partitioning::BoxTree;
///
/// let boxes = [0.0_f32, 2.0, 4.0].map(|x| Aabb::new(Point::new(x, 0.0, 0.0), Point::new(x + 1.0, 1.0, 1.0)));
/// let tree = BoxTree::from_boxes(&boxes);
/// assert_eq!(tree.containing(&Point::new(2.9, 0.5, 0.5)), [1]);
/// ```
pub mod partitioning {
    pub use crate::partitioning::BoxTreeError;

    /// A tree over boxes that are static, or that all move at once.
    pub type BoxTree<N> = crate::partitioning::BoxTree<N, 3>;
}

/// Scalars, vectors and poses, under the same names in `dim2` and `dim3`.
///
/// The vectors and isometries are types of nalgebra, which [`na`] re-exports.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Rotation, Vector};
///
/// let quarter = Rotation::new(Vector::z() * core::f64::consts::FRAC_PI_2);
/// let pose = Isometry::from_parts(Vector::new(3.0, 0.0, 0.0).into(), quarter);
/// let moved = pose * Point::new(1.0, 0.0, 0.0);
/// assert!((moved - Point::new(3.0, 1.0, 0.0)).norm() < 1e-15);
/// ```
pub mod math {
    use crate::math::na;
    pub use crate::math::{Pose, Real, Unit};

    /// The number of dimensions.
    pub const DIM: usize = 3;
    /// A point.
    pub type Point<N> = na::Point3<N>;
    /// A vector.
    pub type Vector<N> = na::Vector3<N>;
    /// The position of a solid: a rotation, then a translation.
    pub type Isometry<N> = na::Isometry3<N>;
    /// A translation.
    pub type Translation<N> = na::Translation3<N>;
    /// A rotation.
    pub type Rotation<N> = na::UnitQuaternion<N>;
    /// A rotation as its axis times its angle in radians.
    pub type Orientation<N> = na::Vector3<N>;
    /// A square matrix.
    pub type Matrix<N> = na::Matrix3<N>;
}

/// Nalgebra, in the version that the library uses. Its vectors and isometries for this dimension
/// have short names in [`math`].
pub use crate::math::na;
