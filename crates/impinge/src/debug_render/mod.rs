//! Drawing what the library sees: shapes, boxes, contacts, queries. Feature `debug_render`.
//!
//! A back end implements [`DebugRender`], of which one method is required: a line with a colour and
//! [what](Drawn) it belongs to. Everything else is drawn with lines until the back end does it better.
//!
//! A [`DebugDrawing`] calls the back end: [`DebugDrawing::world`] with all of a world, others with a shape,
//! contacts, or a query and what it found. [`DebugOptions`] says what is drawn and in which colours.
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
