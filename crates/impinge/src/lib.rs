//! Collision detection in 2D and 3D: who touches whom, where, and since when.
//!
//! Your program moves the objects; the library computes no forces. At each update a world computes
//! the pairs that began or ceased to touch, and their contact points with depths and normals. It
//! also answers queries with rays, points, boxes, shapes and moving shapes; [`query`] has the
//! queries between two single shapes.
//!
//! ```
//! use impinge::dim3::prelude::*;
//!
//! let mut world = CollisionWorld::new(0.02_f32);
//! let (everybody, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
//! let floor = ShapeHandle::new(Cuboid::new(Vector::new(10.0, 1.0, 10.0)));
//! let ball = ShapeHandle::new(Ball::new(0.5));
//! world.add(Isometry::identity(), floor, everybody, contacts, "floor");
//! world.add(Isometry::translation(0.0, 1.25, 0.0), ball, everybody, contacts, "ball");
//! world.update();
//! for (object1, object2, manifold) in world.contact_manifolds() {
//!     let contact = manifold.deepest_contact().expect("not empty").contact;
//!     assert_eq!((*object1.data(), *object2.data()), ("floor", "ball"));
//!     assert_eq!((contact.depth, *contact.normal), (0.25, Vector::y()));
//! }
//! ```
//!
//! # Where to begin
//!
//! * The guide explains the library chapter by chapter, with programs; it has tables of names for
//!   users of ncollide, parry, rapier and Box2D. It is the module [`guide`] of this documentation.
//! * [`dim2`] and [`dim3`] have the names for programs in 2D or in 3D: every type with `D` filled
//!   in, and a `prelude`. The other modules at the root are generic over the dimension `D`, for
//!   code that supports 2D and 3D.
//! * [`world::CollisionWorld`] is all that most programs need. Its parts can be used alone:
//!   [`broad_phase`] on boxes, [`narrow_phase`] on one pair, [`query`] on two placed shapes.
//! * [`batch`] evaluates one query for many placed shapes in one call, with the results in arrays.
//! * [`checker`] tests many configurations of a robot at once for collisions.
//! * [`shape`] has the convex solids, and the composites: meshes, height fields and compounds.
//!   Positions are isometries. `dim2::math` and `dim3::math` define isometries, vectors and points
//!   under the same names; they are types of nalgebra, which [`math::na`] re-exports.
//!
//! # Guarantees
//!
//! * Intersecting, a distance of zero, and a contact with a depth of zero or more are equivalent.
//!   (Exceptions: half-spaces that overlap without bound and one-sided surfaces with solids behind
//!   them have no contact; for composites that just touch, the contact may differ by a rounding
//!   error.) Touching counts as intersecting, and a distance equal to a prediction or margin is
//!   within it.
//! * A depth is positive inside. Normals are unit vectors from the first solid to the second.
//!   Angles are in radians. Lengths and times have the units of your input.
//! * No tolerance is absolute: scaling all lengths of the input by a power of two scales all
//!   resulting lengths exactly (masses and moments by the matching power), and changes nothing
//!   else.
//! * Equal calls return bitwise equal results, on every run, on every machine and for any number of
//!   threads. Pairs, events and results are ordered by handles, unless a method describes another
//!   order.
//! * Constructors and methods of worlds that panic on misuse have a variant with the prefix `try_`
//!   that returns the error; in both cases the world is unchanged. An index of a part, corner or
//!   height that is out of range panics as for a slice.
//!
//! # Features
//!
//! * `dim2` and `dim3` (both default): 2D and 3D. To compile only one of them, write
//!   `default-features = false, features = ["dim3"]`; a disabled dimension is not compiled.
//! * `batch` (default): compiles batches and checkers in the library; without it they are compiled
//!   in the crates that call them.
//! * `f64`: the scalar `f64` in addition to `f32`.
//! * `parallel`: updates and batches on several threads, with bitwise equal results.
//! * `debug_render`: debug drawing of worlds, shapes and queries with your own back end.
//! * `serde`: `Serialize` and `Deserialize` for plain values and whole worlds.
//! * `mint`: conversions to and from the types of the crate mint, through nalgebra.
//! * `glam`: conversions to and from glam 0.33 for points, vectors, rotations and isometries, by
//!   `into`.
#![forbid(unsafe_code)]

pub mod batch;
pub mod bounding_volume;
pub mod broad_phase;
mod bvh;
pub mod checker;
pub(crate) mod chunks;
mod collide;
pub(crate) mod convex;
#[cfg(feature = "debug_render")]
pub mod debug_render;
#[cfg(feature = "dim2")]
pub mod dim2;
#[cfg(feature = "dim3")]
pub mod dim3;
pub(crate) mod generation;
#[cfg(doc)]
pub mod guide;
pub(crate) mod journal;
pub mod math;
pub(crate) mod memory;
pub mod narrow_phase;
mod pairs;
pub mod partitioning;
pub mod procedural;
pub mod query;
#[cfg(test)]
#[path = "../tests/it/support/samples.rs"]
mod samples;
pub mod shape;
mod tables;
pub mod transformation;
pub mod world;
