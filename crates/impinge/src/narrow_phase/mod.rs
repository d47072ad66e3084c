//! Exact answers for the pairs that the broad phase proposes, kept from update to update.

mod events;
mod handle;
mod objects;
mod query_type;

pub use events::{ContactEvent, Events, ProximityEvent};
pub use handle::CollisionObjectHandle;
pub(crate) use objects::ObjectRow;
pub use objects::ObjectTable;
pub use query_type::GeometricQueryType;
pub(crate) use query_type::PairQuery;
