//! [impinge] as the collision back end of [Avian](https://docs.rs/avian3d/0.7), the physics engine
//! for Bevy: Avian moves the bodies, impinge provides shapes and contacts.
//!
//! [`d2`] is for `avian2d`, [`d3`] for `avian3d`. An app adds one plugin after Avian's plugins, and
//! uses the `Collider` of this crate. The constructors have the names and arguments of those of
//! Avian's `Collider`.
//!
//! ```
//! use avian3d::prelude::*;
//! use avian_impinge::d3::{Collider, ImpingeColliderPlugin};
//! use bevy_app::prelude::*;
//! use bevy_math::Vec3;
//! use bevy_time::{TimePlugin, TimeUpdateStrategy};
//! use bevy_transform::prelude::*;
//!
//! // `DefaultPlugins` in a program with a window.
//! let mut app = App::new();
//! app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, TimePlugin));
//! app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
//! # #[cfg(not(feature = "parry"))] {
//! app.add_plugins((PhysicsPlugins::default(), ImpingeColliderPlugin::default()));
//! app.finish();
//!
//! app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vec3::Y)));
//! let ball = (RigidBody::Dynamic, Collider::sphere(0.5), Transform::from_xyz(0.0, 2.0, 0.0));
//! let ball = app.world_mut().spawn(ball).id();
//! (0..128).for_each(|_| app.update());
//! let place = app.world().get::<Position>(ball).expect("it is a body");
//! assert!((place.y - 0.5).abs() < 0.01, "it lies on the ground");
//! # }
//! ```
//!
//! # Contacts
//!
//! The contacts of a pair of convex shapes are recomputed in each step. They are a function of the
//! poses, and their feature ids stand for vertices, edges and faces. Avian's solver matches points
//! by these ids, and starts from the impulses of the last step.
//!
//! A pair with a mesh, a polyline, a height field or a compound has state in the resource
//! [`PairContacts`]. The two feature ids of a point then encode a contact id, which the point keeps
//! while it moves from part to part; they do not identify features. Each pair is computed
//! independently of all others.
//!
//! # Errors
//!
//! Invalid sizes do not panic. A collider with invalid arguments has an [error](Collider::error),
//! no contacts and no mass. If a shape cannot be scaled exactly, a convex hull approximates it, as
//! Avian's trait requires. A scale of zero, infinity or NaN is rejected with an error in the log,
//! and the collider keeps its last scale.
#![forbid(unsafe_code)]
#![warn(missing_docs, missing_debug_implementations)]

mod collider;
mod manifolds;
mod pairs;
mod queries;
mod scaling;

#[cfg(feature = "2d")]
pub mod d2;
#[cfg(feature = "3d")]
pub mod d3;

pub use bevy_impinge::ColliderError;
pub use collider::Collider;
pub use pairs::PairContacts;
pub use scaling::Dimension;

/// The collision library itself: shapes and queries.
pub use impinge;

/// The README and the guide's chapter, run as tests; their apps have no parry.
#[cfg(all(doctest, feature = "2d", feature = "3d", not(feature = "parry")))]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../../../guide/avian.md")]
mod pages {}
