//! Contacts and proximities of the pairs that the broad phase proposes, kept from update to update.
//!
//! [`DefaultNarrowPhase`] keeps the pairs of a world. The traits [`ContactManifoldGenerator`] and
//! [`ProximityDetector`] define the algorithm of one pair. Such an algorithm can be used alone, or
//! plugged in through a dispatcher. No type of this module has access to users' data: objects are
//! rows of an [`ObjectTable`].
//!
//! ```text
//! pairs: PairTable       index -> (first, second), two handle indices
//! locations              index -> Location { group, row }
//! groups: PairGroups     contacts[kind pair]   one Group for each pair of shape kinds that occurs
//!                        composites            one Group for all pairs with a composite
//!                        proximity[kind pair], custom_contacts, custom_proximity
//! Group                  row -> keys | dirty | touching (bits) | states | views? | references?
//! ```

mod default_narrow_phase;
mod detector;
mod dirty_contacts;
mod entry;
mod events;
mod generator;
mod group;
mod handle;
mod ids;
mod kind_groups;
mod objects;
mod pair_batch;
mod pair_groups;
mod prefetch;
mod query_type;
mod reuse;
mod rewind;
#[cfg(feature = "serde")]
pub(crate) mod saved;
mod state;
mod stateless;
mod substep;
mod traits;
mod update;
mod views;

pub use default_narrow_phase::DefaultNarrowPhase;
pub use detector::{DefaultProximityDispatcher, PairProximityDetector};
pub(crate) use dirty_contacts::{DirtyContacts, update_lanes2, update_lanes3};
pub use events::{ContactEvent, Events, ProximityEvent};
pub use generator::{DefaultContactDispatcher, PairManifoldGenerator};
pub(crate) use generator::{Revolved, conforming_points};
pub use handle::{CollisionObjectHandle, Interaction};
pub use ids::IdAllocator;
pub(crate) use objects::ObjectRow;
pub use objects::ObjectTable;
pub use query_type::{ContactQuery, GeometricQueryType, ProximityQuery};
pub(crate) use query_type::{PackedQuery, PairQuery};
pub use reuse::ReuseError;
pub(crate) use state::{CompositeState, ContactState, KeptContacts};
pub(crate) use stateless::each_manifold_at;
pub use stateless::{contact_manifolds, each_contact_manifold};
pub use traits::{
    ContactAlgorithm, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
    ProximityAlgorithm, ProximityDetector, ProximityDispatcher,
};
pub(crate) use views::Views;
pub use views::{ContactPair, ContactStream, ProximityPair, StreamManifold, StreamPoint};
