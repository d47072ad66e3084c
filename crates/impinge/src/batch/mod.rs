//! Batches: one query for many placed shapes, with results in columns that belong to the caller.
//!
//! ```text
//!   Shapes: one, one each, or picked     Side ─┐
//!   PoseSource: one, or one each         ──────┤  PairBatch: element i of one side with element i of the other
//!                                        Side ─┘
//!   element       0     1     2     3    …        a list of length 1 applies to all elements
//!   distance   [ d0 ][ d1 ][ d2 ][ d3 ]  …        one slot for each element, in this order
//!   point1     [ p0 ][ p1 ][ p2 ][ p3 ]  …        an empty column is not written
//! ```
//!
//! Every result has the bits of the single call in [`query`](crate::query) for the same shapes and
//! poses. Results do not depend on the number of threads: with the feature `parallel` the elements
//! are divided into chunks of 64, which the threads of rayon's current pool share.
//!
//! | single query | batch |
//! |---|---|
//! | [`distance`](crate::query::distance()) | [`PairBatch::distances`], [`PairBatch::nearest`] |
//! | [`closest_points`](crate::query::closest_points()) | [`PairBatch::closest_points`] |
//! | [`witness`](crate::query::witness()) | [`PairBatch::witnesses`] |
//! | [`proximity`](crate::query::proximity()) | [`PairBatch::proximities`], [`pairs_within`], [`pairs_within_one`], [`pairs_in_tile`] |
//! | [`contact`](crate::query::contact()) | [`PairBatch::contacts`] |
//! | [`impact`](crate::query::impact()) | [`PairBatch::impacts`] |
//! | [`PairManifoldGenerator`](crate::narrow_phase::PairManifoldGenerator), new | [`PairBatch::manifolds`] |
//! | [`PointQuery`](crate::query::PointQuery) | [`PointBatch`] |
//! | [`RayCast`](crate::query::RayCast) | [`RayColumns`] |
//!
//! # No result
//!
//! An element has no result if nothing lies within the limit of the query, or if a pose, point, ray
//! or velocity of the element is not finite. Its distance and time are then `INFINITY`, its depth
//! `-INFINITY`, its points and normals `NaN`, its part `u32::MAX`, and its feature [`NO_FEATURE`].
//!
//! # Errors
//!
//! Each method checks all lengths before it computes anything. An error other than
//! [`BatchError::Cancelled`] leaves all columns unchanged. After a cancellation, some slots have
//! been written and the others are unchanged.

mod columns;
mod control;
mod entries;
mod error;
mod manifolds;
mod matrices;
mod pairs;
mod placed;
mod points;
mod poses;
mod rays;
mod rows;
mod side;
mod tiles;
mod within;

pub use columns::{
    ClosestColumns, ContactColumns, HitColumns, ImpactColumns, NO_FEATURE, ProjectionColumns,
    WitnessColumns,
};
pub use control::Control;
pub(crate) use control::Progress;
pub(crate) use entries::BatchEntries;
pub use error::{BatchError, MatrixError};
pub(crate) use manifolds::{SolidGroup, update_group2, update_group3};
pub use matrices::Matrices;
pub use pairs::PairBatch;
pub use points::PointBatch;
pub use poses::{AsPose, OnePose, PoseSource};
pub use rays::RayColumns;
pub use rows::ManifoldRows;
pub use side::{Shapes, Side};
pub use tiles::{TileCut, TileRows, Tiles, pairs_in_tile, tiles};
pub use within::{boxes, pairs_within, pairs_within_one};
