//! Questions about one solid or two, answered from nothing but the arguments.

mod contact;
mod kinematic;
mod manifold;
mod manifold_build;
mod pair;
mod proximity;
mod raw_manifold;

pub use crate::bounding_volume::Ray;
pub use contact::Contact;
pub use kinematic::{ContactKinematic, NeighborhoodGeometry};
pub use manifold::{ContactId, ContactManifold, TrackedContact};
pub(crate) use manifold::{Placement, materialise};
pub(crate) use manifold_build::{build2, build3};
pub(crate) use pair::Pair;
pub use proximity::Proximity;
pub(crate) use raw_manifold::{ManifoldRequest, PairIds, RawManifold, RawPoint};
