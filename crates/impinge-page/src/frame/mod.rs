//! Frames: the drawing of a stage, as buffers of numbers that the page uploads unchanged.
//!
//! `picture` draws a frame by the back end in `gather`, with meshes by number (`mesh`), most of them of unit shapes
//! (`unit_shapes`), relative to the origin of the stage (`framing`), in the colours and layers of `color`; `queries` draws
//! the queries of recordings. `payload` has the layout in bytes.

pub(crate) mod color;
pub(crate) mod framing;
pub(crate) mod gather;
pub(crate) mod mesh;
pub(crate) mod payload;
pub(crate) mod picture;
pub(crate) mod queries;
pub(crate) mod unit_shapes;
