//! Pictures of worlds, shapes and query results of impinge, without a GPU.
//!
//! Two back ends of [`impinge::debug_render::DebugRender`], each for 2D and 3D, `f32` and `f64`:
//!
//! * [`SvgPicture`] draws lines: 2D scenes to scale, 3D scenes with hidden lines fainter. It has
//!   layers, a legend, and a title and description for screen readers, and is legible on light and
//!   on dark pages.
//! * [`PngPicture`] draws surfaces with a depth buffer, soft light from the upper left, darker
//!   edges and transparency, texts, and optionally a legend.
//!
//! A picture collects the drawing and computes nothing until its bytes are requested. Its
//! [`Camera`] frames all content, with a margin. Elements with NaN, infinite or huge coordinates
//! are omitted and [counted](Picture::left_out). The same drawing gives the same bytes on every run
//! and machine: pictures are computed only by `+ - * /`, square roots and the library's own sine.
//!
//! ```
//! use impinge::debug_render::{Color, DebugRender, Drawn};
//! use impinge::dim3::math::{Point, Vector};
//! use impinge_view::{Camera, PngPicture};
//!
//! let camera = Camera::look_along(&Vector::new(-1.0, -1.0, -1.0), &Vector::y());
//! let mut picture = PngPicture::new(camera, [64, 48]);
//! let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from);
//! picture.triangle(corners, Color::rgb(96, 125, 160), Drawn::Object);
//! let image = picture.to_image();
//! assert_eq!(image.size(), [64, 48]);
//! let is_colored = |pixel: &[u8; 4]| *pixel != image.pixel(0, 0);
//! assert!(image.pixels().iter().filter(|pixel| is_colored(pixel)).count() > 200);
//! assert!(image.to_png().starts_with(b"\x89PNG"));
//! ```
//!
//! [`world_drawing`] draws a world in sizes that suit its objects.
//!
//! [`Golden`] compares an [`Image`] with a file, for tests that detect changes of a picture.
#![forbid(unsafe_code)]

mod camera;
mod compare;
mod flatten;
mod golden;
mod hidden;
mod image;
mod kept_mesh;
mod labels;
mod layer;
mod legend;
mod lens;
mod letters;
mod palette;
mod picture;
mod pieces;
mod png_picture;
mod raster;
mod recording;
mod shade;
mod svg_picture;
mod svg_write;
mod world_drawing;

pub use camera::Camera;
pub use compare::{Difference, compare};
pub use golden::{Golden, GoldenError};
pub use image::{Image, ImageError};
pub use picture::Picture;
pub use png_picture::{Png, PngPicture};
pub use svg_picture::{Svg, SvgPicture};
pub use world_drawing::world_drawing;
