//! Collision detection in 2D and 3D: who touches whom, where, and since when.
//!
//! You move your objects by your own rules; there are no forces here. A world says, at each
//! update, which pairs came to touch or parted, where their contact points are, how deep and along
//! which direction. It also answers rays, points, boxes, shapes and moving shapes, and [`query`] any
//! question about two shapes on their own.
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
//! * The guide explains it all, chapter by chapter, with programs; users of ncollide, parry and rapier
//!   find there what is called what. It is the module [`guide`] of this documentation.
//! * [`dim2`] and [`dim3`] hold the names to type: everything with the dimension filled in, and a
//!   `prelude` with what the usual program needs. The modules beside them hold the same things for every
//!   dimension `D`; write code against those only where it shall serve both.
//! * [`world::CollisionWorld`] is all that most programs use. Its parts work alone too:
//!   [`broad_phase`] on boxes, [`narrow_phase`] on one pair, [`query`] on two placed shapes.
//! * [`batch`] asks one question about very many placed shapes in one call, with the answers in arrays.
//! * [`checker`] answers for many configurations of a robot at once whether they are free.
//! * [`shape`] has the solids, and the meshes, height fields and compounds made of them. Positions are
//!   isometries; `dim2::math` and `dim3::math` have them, vectors and points under one name in both, and
//!   `na` is all of nalgebra, whose types they are.
//!
//! # What holds everywhere
//!
//! * Intersecting, a distance of zero, and a contact with a depth of zero or more are one fact. (No
//!   contact have half-spaces that overlap without bound, and surfaces with one side with what is
//!   behind them; of composites that just touch the contact may be a rounding error away.) Touching
//!   counts, and so does a distance equal to a prediction or margin.
//! * A depth is positive inside. Normals are unit vectors from the first solid to the second. Angles
//!   are in radians. Lengths and times have the units that you give them.
//! * No tolerance is absolute: scaling all input by a power of two scales all results exactly.
//! * The same calls give the same bits, on every run, machine and number of threads. Pairs, events
//!   and answers come in order of the handles.
//! * Constructors and methods of worlds that panic on misuse have a `try_` twin that returns the error;
//!   either way nothing was changed. To ask for a part, corner or height that does not exist panics as
//!   it does for a slice.
//!
//! # Features
//!
//! * `dim2` and `dim3` (both default): the plane and space. Who needs one of them writes
//!   `default-features = false, features = ["dim3"]`; what is off is not compiled.
//! * `batch` (default): batches and checkers compiled in the library; without it they are compiled in
//!   your crate, where it uses them.
//! * `f64`: `f64` as a scalar beside `f32`.
//! * `parallel`: updates and batches on several threads, with the same bits.
//! * `debug_render`: drawing worlds, shapes and queries with a back end of yours.
//! * `serde`: `Serialize` and `Deserialize` for plain values.
//! * `mint`: conversions to and from other vector libraries, through nalgebra.
//! * `glam`: the same to and from glam 0.33: points, vectors, rotations and isometries by `into`.
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
pub mod shape;
mod tables;
pub mod transformation;
pub mod world;
