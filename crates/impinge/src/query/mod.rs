//! Questions about one solid or two, answered from nothing but the arguments.

mod closest_points;
mod composite;
mod contact;
mod distance;
mod kinematic;
mod manifold;
mod manifold_build;
pub(crate) mod pair;
pub(crate) mod point;
mod proximity;
mod raw_manifold;
pub(crate) mod ray;
pub(crate) mod separation;
mod time_of_impact;

pub use crate::bounding_volume::Ray;
pub use closest_points::{ClosestPoints, closest_points};
pub(crate) use composite::{CompositeContacts, contact_in_world, distance_within};
pub use contact::{Contact, contact};
pub use distance::distance;
pub use kinematic::{ContactKinematic, ContactSide, NeighborhoodGeometry};
pub use manifold::{ContactId, ContactManifold, TrackedContact};
pub(crate) use manifold::{Placement, materialise};
pub(crate) use manifold_build::{contacts2, contacts3, tangents2, tangents3};
pub(crate) use pair::{Pair, Placed, canonical};
pub use point::{PointProjection, PointQuery};
pub use proximity::{Proximity, proximity};
pub(crate) use raw_manifold::{ManifoldRequest, PairIds, RawManifold, RawPoint};
pub use ray::{RayCast, RayIntersection};
pub use time_of_impact::time_of_impact;
pub(crate) use time_of_impact::{Moving, advance};
