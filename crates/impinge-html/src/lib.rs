//! Recordings as pages: one HTML file that is opened from a disk, or a page of a running program.
//!
//! [`export`] makes a file of a recording. It contains the recording and impinge itself as WebAssembly, so its reader
//! can run new queries on the recorded world without a network. [`Live`] serves the same page on this machine while a
//! program records, and [`gallery`] writes the page of the samples.
//!
//! The page consists of [`Assets`]. With the feature `page` they are part of the program, and building this crate builds
//! the engine, for which the target `wasm32-unknown-unknown` must be installed.
#![forbid(unsafe_code)]

mod assets;
mod connection;
mod error;
mod live;
mod log;
mod page;
mod request;

pub use assets::Assets;
pub use error::HtmlError;
pub use live::Live;
pub use page::{export, gallery};
