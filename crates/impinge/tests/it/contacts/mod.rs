//! Tests of contacts and manifolds: the numeric contract, contact ids, batches.

mod accuracy;
mod contact_ids;
pub(crate) mod contact_points;
mod contact_reuse;
mod contract;
mod crossings;
mod curved_depths;
mod pair_batches;
mod smooth_solids;
mod stateless;
mod ties;
