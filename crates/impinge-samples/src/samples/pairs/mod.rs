//! Samples of two shapes.

pub(crate) mod grid;
pub(crate) mod own;
pub(crate) mod playground;
pub(crate) mod spinning;
pub(crate) mod through;
