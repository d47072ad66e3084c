//! Convex solids in 2D and 3D, and geometric queries about them.
//!
//! Sign: a signed distance is positive if the solids are disjoint. Otherwise it is minus the length
//! of the shortest translation that separates the interiors. Normals are unit vectors in the world
//! frame, from the first solid to the second.

mod cast;
mod distance;
mod features;
mod point;
mod polytope;
mod pose;
mod solid;
pub(crate) mod sphere_search;
pub mod vector;

pub use cast::{Cast, linear_cast, ray_cast};
pub use distance::{Reference, separation_along, signed_distance};
pub use point::{PointMeter, contains_point, point_signed_distance};
pub use pose::Pose;
pub use solid::Solid;
