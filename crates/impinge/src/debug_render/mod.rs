//! Drawing what the library sees: shapes, boxes, contacts, queries. Feature `debug_render`.
//!
//! A back end implements [`DebugRender`], of which one method is required: a line with a colour and
//! [what](Drawn) it belongs to. Everything else is drawn with lines until the back end does it better.

mod color;
mod mesh;
mod render;

pub use color::Color;
pub use mesh::ShapeMesh;
pub use render::{DebugRender, Drawn};
