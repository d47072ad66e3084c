//! Debug drawing of shapes, boxes, contacts and queries. Feature `debug_render`.
//!
//! A back end implements [`DebugRender`]. Its only required method draws a line with a colour and
//! the [kind](Drawn) of object that the line belongs to. By default everything except text is drawn
//! with lines.
//!
//! A [`DebugDrawing`] calls the back end: [`DebugDrawing::world`] draws a whole world, other
//! methods draw a shape, contacts, or a query and its result. [`DebugOptions`] selects the kinds of
//! objects to draw, and their colours.
//!
//! ```
//! use impinge::debug_render::{Color, DebugDrawing, DebugRender, Drawn};
//! use impinge::dim3::prelude::*;
//!
//! #[derive(Default)]
//! struct Lines(Vec<[Point<f32>; 2]>);
//!
//! impl DebugRender<f32, 3> for Lines {
//!     fn line(&mut self, ends: [Point<f32>; 2], _: Color, _: Drawn) {
//!         self.0.push(ends);
//!     }
//! }
//!
//! let mut world = CollisionWorld::new(0.02_f32);
//! let brick = ShapeHandle::new(Cuboid::new(Vector::new(2.0, 1.0, 0.5)));
//! world.add(Isometry::identity(), brick, CollisionGroups::new(), ContactQuery::default(), ());
//! world.update();
//!
//! let (mut drawing, mut lines) = (DebugDrawing::default(), Lines::default());
//! drawing.world(&world, &mut lines);
//! assert_eq!(lines.0.len(), 12, "the edges");
//! ```

mod color;
mod drawing;
mod mesh;
mod options;
mod query;
mod render;
mod rounded3;
mod sketch;
mod sketch2;
mod sketch3;
mod world;

pub use color::Color;
pub use drawing::DebugDrawing;
pub use mesh::{MeshOptions, ShapeMesh};
pub use options::{DebugOptions, Style};
pub use query::SweptShape;
pub use render::{DebugRender, Drawn};
pub(crate) use sketch::Sketch;
pub(crate) use sketch2::sketch2;
pub(crate) use sketch3::sketch3;
