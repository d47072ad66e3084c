//! Queries on one or two shapes. The results depend on the arguments only, not on a world.

mod closest_points;
pub(crate) mod composite;
mod contact;
mod distance;
mod impact;
mod kinematic;
mod manifold;
mod manifold_view;
pub(crate) mod mass;
pub(crate) mod point;
mod proximity;
pub(crate) mod ray;
mod witness;

pub use crate::bounding_volume::Ray;
pub use crate::shape::{MassError, MassProperties};
pub(crate) use closest_points::closest_points_at;
pub use closest_points::{ClosestPoints, closest_points};
pub(crate) use contact::contact_at;
pub use contact::{Contact, contact};
pub use distance::distance;
pub(crate) use distance::{distance_at, distance_between, distance_within};
pub use impact::{
    ConstantVelocities, Impact, ImpactOptions, ImpactStatus, Moving, RigidMotion, impact,
    nonlinear_time_of_impact, time_of_impact,
};
pub(crate) use impact::{Flight, impact_of_flight, impact_of_pair, time_of_pair};
pub use kinematic::{ContactKinematic, ContactSide, NeighborhoodGeometry};
pub(crate) use manifold::Placement;
pub use manifold::{ContactId, ContactManifold, TrackedContact};
pub use manifold_view::{ContactPoint, ManifoldView};
pub(crate) use manifold_view::{PairRef, PlacedSolids};
pub use mass::{mass_properties, mass_properties_with};
pub(crate) use point::located_at;
pub use point::{Barycentric, PointLocation, PointProjection, PointQuery};
pub(crate) use proximity::proximity_at;
pub use proximity::{Proximity, proximity};
pub use ray::{RayBatch, RayCast, RayIntersection};
pub(crate) use ray::{cast_at, cast_many_on, cast_on, surely_misses};
pub(crate) use witness::in_world as witness_in_world;
pub use witness::{Witness, witness};
pub(crate) use witness::{witness_at, witness_between};
