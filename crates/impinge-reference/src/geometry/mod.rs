//! Convex solids in the plane and in space, and the questions one can ask about them.
//!
//! Sign: a signed distance is positive between disjoint solids, and minus the length of the
//! shortest translation that separates the interiors otherwise. Normals are unit, in the world
//! frame, and point from the first solid to the second.

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
