//! Compares batches with single calls, bit for bit.

mod cancelled;
mod manifolds;
mod nearest;
mod pairs;
mod points;
mod poses;
mod rays;
mod refused;
pub(crate) mod scene;
mod tiles;
mod within;
