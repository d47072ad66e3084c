//! The names that common programs need, for a glob import: the world and its events, the shapes,
//! vectors and poses, and the queries of two shapes, in 2D.
//!
//! A name that you define or import by itself takes precedence over a name from a glob import. All
//! other names are in the other modules of `dim2`. In one file, import the prelude of `dim2` or of
//! `dim3`, not both: they define the same names.
//!
//! ```
//! use impinge::dim2::prelude::*;
//!
//! let mut world = CollisionWorld::new(0.02_f32);
//! let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
//! let floor = ShapeHandle::new(Cuboid::new(Vector::new(10.0, 1.0)));
//! let ball = ShapeHandle::new(Ball::new(0.5));
//! world.add(Isometry::identity(), floor, groups, contacts, "floor");
//! world.add(Isometry::translation(0.0, 1.25), ball, groups, contacts, "ball");
//! world.update();
//! for (object1, object2, manifold) in world.contact_manifolds() {
//!     let contact = manifold.deepest_contact().expect("not empty").contact;
//!     assert_eq!((*object1.data(), *object2.data()), ("floor", "ball"));
//!     assert_eq!((contact.depth, *contact.normal), (0.25, Vector::y()));
//! }
//! # assert_eq!(world.contact_events().len(), 1);
//! ```

pub use super::bounding_volume::Aabb;
pub use super::events::{ContactEvent, Proximity, ProximityEvent};
pub use super::math::{Isometry, Point, Rotation, Unit, Vector};
pub use super::query::{
    ClosestPoints, Contact, ImpactOptions, Moving, PointQuery, Ray, RayCast, closest_points,
    contact, distance, impact, proximity, time_of_impact,
};
pub use super::shape::{
    Ball, Capsule, Compound, ConvexPolygon, Cuboid, Ellipse, HalfSpace, HeightField, Plane,
    Polyline, Rounded, Segment, Shape, ShapeHandle, TaperedCapsule, TriMesh, Triangle,
};
pub use super::world::{
    CollisionGroups, CollisionObject, CollisionObjectHandle, CollisionWorld, ContactQuery,
    GeometricQueryType, ProximityQuery, QueryFilter,
};
