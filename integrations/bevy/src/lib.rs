//! Collision detection for Bevy in 2D and 3D, without dynamics: the plugin of [`impinge`].
//!
//! Entities with a [`Collider`] are objects of a collision world. The plugin follows their transforms, changes and
//! removal, updates the world once per step, and reports which pairs of entities started and stopped touching: as
//! messages, to observers, and in [`CollidingEntities`]. The resource [`Collisions`] has rays, shape casts, overlaps,
//! nearest points and contacts, and moves characters. There are no forces: you move your entities.
//!
//! [`d2`] and [`d3`] have all names with the dimension filled in; both can be used in one app.
//!
//! ```
//! use bevy_app::prelude::*;
//! use bevy_ecs::prelude::*;
//! use bevy_impinge::d3::prelude::*;
//! use bevy_transform::prelude::*;
//!
//! fn greet(mut started: MessageReader<CollisionStarted>, mut count: ResMut<Count>) {
//!     count.0 += started.read().count();
//! }
//!
//! #[derive(Resource, Default)]
//! struct Count(usize);
//!
//! let mut app = App::new();
//! app.add_plugins(ImpingePlugin::default().in_schedule(Update)).init_resource::<Count>();
//! app.add_systems(Update, greet.after(ImpingeSystems::Report));
//! app.world_mut().spawn((Collider::cuboid(20.0, 2.0, 20.0), FixedCollider));
//! app.world_mut().spawn((Collider::sphere(0.5), Transform::from_xyz(0.0, 1.25, 0.0)));
//! app.update();
//! assert_eq!(app.world().resource::<Count>().0, 1);
//! ```
//!
//! # Frames and units
//!
//! Poses and results are in Bevy's global frame, lengths in its units, `f32`. Constructors of colliders take full
//! lengths, as those of Bevy's primitives do. In 2D the frame is the global x-y plane; the z coordinate of a
//! translation has no effect. Normals are unit vectors; each method documents their direction.
//!
//! # Errors
//!
//! Invalid data of components do not panic. For a collider with invalid sizes, a scale that its shape does not support
//! exactly, or a transform that is NaN or leaves the plane, the entity gets a [`ColliderProblem`] component with the
//! typed error, a [`ColliderFailed`] message and a line in the log, once. An object that was in the world stays there
//! with its last shape and pose; the component is removed when the entity is valid again.
#![forbid(unsafe_code)]
#![warn(missing_docs, missing_debug_implementations)]

mod body;
mod collider;
mod collisions;
mod contacts;
mod error;
mod events;
mod follow;
#[cfg(feature = "gizmos")]
mod gizmos;
mod glam;
mod layers;
#[cfg(all(feature = "mesh", feature = "3d"))]
mod mesh;
mod plugin;
mod queries;
mod report;
mod slide;

#[cfg(feature = "2d")]
pub mod d2;
#[cfg(feature = "3d")]
pub mod d3;

pub use collider::{Collider, DefaultWorld, WorldKey};
pub use collisions::Collisions;
pub use contacts::{ContactPair, ContactPoint};
pub use error::{ColliderError, ColliderFailed, ColliderProblem};
pub use events::{CollidingEntities, CollisionEnded, CollisionStarted};
#[cfg(feature = "gizmos")]
pub use gizmos::{DebugGizmos, DebugGizmosPlugin, GizmoLines};
pub use glam::Glam;
pub use layers::{CollisionLayers, FixedCollider, Sensor};
pub use plugin::{ImpingePlugin, ImpingeSystems, PairFilter};
pub use queries::{NearestEntity, PointHit, RayHit, ShapeHit, SpatialFilter};
pub use slide::{Slide, SlideSettings};

/// The collision library itself: shapes, worlds, queries.
pub use impinge;

/// The page of the crate and the chapter of the guide, whose programs are run as tests.
#[cfg(all(doctest, feature = "2d", feature = "3d"))]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../../../guide/bevy.md")]
mod pages {}
