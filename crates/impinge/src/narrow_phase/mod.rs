//! Contacts and proximities of the pairs that the broad phase proposes, kept from update to update.
//!
//! [`DefaultNarrowPhase`] keeps the pairs of a world. The traits [`ContactManifoldGenerator`] and
//! [`ProximityDetector`] stand for the algorithm of one pair, to use alone or to plug in through a
//! dispatcher. Nothing here has access to users' data: objects are rows of an [`ObjectTable`].
//!
//! ```text
//! pairs: PairTable       (first, second) by index, both handle indices
//! locations              index -> Location { lane, place }
//! lanes: PairLanes       contacts[kind pair]   one Group for each pair of shape kinds that occurs
//!                        composites            one Group for all pairs with a composite
//!                        proximity[kind pair], custom_contacts, custom_proximity
//! Group                  place -> keys | due | touching (bits) | states | views? | references?
//! ```

mod ahead;
mod composite_views;
mod convex_views;
mod default_narrow_phase;
mod detector;
mod due;
mod entry;
mod events;
mod generator;
mod group;
mod handle;
mod ids;
mod kind_groups;
mod lanes;
mod objects;
mod pair_batch;
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
mod view;

pub use default_narrow_phase::DefaultNarrowPhase;
pub use detector::{DefaultProximityDispatcher, PairProximityDetector};
pub(crate) use due::{DueContacts, update_lanes2, update_lanes3};
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
pub use stateless::contact_manifolds;
pub(crate) use stateless::{contact_manifolds_at, manifolds_of_placed};
pub use traits::{
    ContactAlgorithm, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
    ProximityAlgorithm, ProximityDetector, ProximityDispatcher,
};
pub(crate) use view::Views;
pub use view::{ContactPair, ProximityPair};
