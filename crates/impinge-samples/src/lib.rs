//! Samples: interactive scenes with controls, each about one subject of the library.
//!
//! [`entries`] is the gallery. Each [`Entry`] makes a [`Sample`], which [`Running`] runs: it owns the controls and the
//! world. The world is recorded, so that a run can be saved as a file. A back end of `debug_render` draws it.
//!
//! Samples compute in `f32` and use no clock, no random numbers and no trigonometry of the platform: the same calls
//! give the same bits on every machine.
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
