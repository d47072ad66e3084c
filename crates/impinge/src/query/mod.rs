//! Questions about one solid or two, answered from nothing but the arguments.

mod closest_points;
pub(crate) mod composite;
mod contact;
mod distance;
pub(crate) mod far;
mod impact;
mod kinematic;
mod manifold;
mod manifold_build;
mod manifold_view;
pub(crate) mod pair;
pub(crate) mod point;
mod proximity;
mod raw_manifold;
pub(crate) mod ray;
pub(crate) mod separation;
pub(crate) mod tiles;
mod witness;

pub use crate::bounding_volume::Ray;
pub use closest_points::{ClosestPoints, closest_points};
pub(crate) use composite::{CompositeContacts, contact_in_world, own_distance};
pub use contact::{Contact, contact};
pub use distance::distance;
pub use impact::{
    ConstantVelocities, Impact, ImpactOptions, ImpactStatus, Moving, RigidMotion, impact,
    nonlinear_time_of_impact, time_of_impact,
};
pub(crate) use impact::{Flight, impact_of_flight, impact_of_pair, time_of_pair};
pub use kinematic::{ContactKinematic, ContactSide, NeighborhoodGeometry};
pub use manifold::{ContactId, ContactManifold, TrackedContact};
pub(crate) use manifold::{Placement, materialise};
pub(crate) use manifold_build::{
    KeptPairs, OnFace, PairQuestion, Solid, between2, build3, contacts2, contacts3, on_face2,
    on_face3, tangents2, tangents3, update_pairs2, update_pairs3, witness_feature2,
    witness_feature3, witness_features2, witness_features3,
};
pub use manifold_view::{ContactPoint, ManifoldView};
pub(crate) use pair::{Pair, Placed, canonical};
pub use point::{Barycentric, PointLocation, PointProjection, PointQuery};
pub use proximity::{Proximity, proximity};
pub(crate) use raw_manifold::{ManifoldRequest, PairIds, RawManifold, RawPoint};
pub use ray::{RayBatch, RayCast, RayIntersection};
pub(crate) use ray::{cast_on, surely_misses};
pub(crate) use witness::in_world as witness_in_world;
pub use witness::{Witness, witness};
