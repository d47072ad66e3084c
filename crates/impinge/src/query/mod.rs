//! Questions about one solid or two, answered from nothing but the arguments.

mod contact;
mod kinematic;
mod manifold;
mod pair;
pub(crate) mod point;
mod proximity;
mod raw_manifold;
pub(crate) mod ray;

pub use crate::bounding_volume::Ray;
pub use contact::Contact;
pub use kinematic::{ContactKinematic, NeighborhoodGeometry};
pub use manifold::{ContactId, ContactManifold, TrackedContact};
pub(crate) use pair::Pair;
pub use point::{PointProjection, PointQuery};
pub use proximity::Proximity;
pub(crate) use raw_manifold::{ManifoldRequest, RawManifold, RawPoint};
pub use ray::{RayCast, RayIntersection};
