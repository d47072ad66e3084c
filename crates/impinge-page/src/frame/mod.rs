//! Frames: the drawing of a stage, as buffers of numbers that the page uploads unchanged.
//!
//! `picture` draws a frame with the back end in `gather`. Meshes have ids (`mesh`), and most of
//! them are those of unit shapes (`unit_shapes`). Positions are relative to the origin of the stage
//! (`framing`). `color` has the colours and layers, `queries` draws the queries of recordings, and
//! `payload` defines the layout in bytes.

pub(crate) mod color;
pub(crate) mod framing;
pub(crate) mod gather;
pub(crate) mod mesh;
pub(crate) mod payload;
pub(crate) mod picture;
pub(crate) mod queries;
pub(crate) mod unit_shapes;
