//! Interactive samples: scenes with controls, each about one subject of the library.
//!
//! [`entries`] returns the gallery. Each [`Entry`] contains the constructor of a [`Sample`].
//! [`Running`] runs a sample, and owns its controls and its world. The world is recorded, so a run
//! can be saved as a file. A back end of `debug_render` draws the world.
//!
//! Samples compute in `f32` and use no clock, no random numbers and no trigonometry of the
//! platform: the same calls give the same bits on every machine.
//!
//! ```
//! use impinge_samples::{Make, Running, entries};
//!
//! for entry in entries().iter().take(2) {
//!     match entry.make {
//!         Make::Plane(make) => Running::new(make())?.advance()?,
//!         Make::Space(make) => Running::new(make())?.advance()?,
//!     }
//! }
//! # Ok::<(), impinge_samples::SampleError>(())
//! ```
#![forbid(unsafe_code)]

mod bodies;
mod catalog;
mod control;
mod dimension;
mod error;
mod gallery;
mod place;
mod prelude;
mod running;
mod sample;
mod samples;
mod scene;

pub use control::{Control, ControlKind, ControlValue, Panel};
pub use error::SampleError;
pub use gallery::{Entry, Make, Shows, entries};
pub use running::Running;
pub use sample::{Canvas, Isometry, Readout, Sample, TIME_STEP, World};
