//! Recordings as web pages: a single HTML file, or a page that shows a running program.
//!
//! [`export`] converts a recording to an HTML file. The file contains the recording and impinge
//! itself as WebAssembly, so its reader can run new queries on the recorded world without a
//! network. [`Live`] serves the same page on this machine while a program records, and [`gallery`]
//! writes the page of the samples.
//!
//! The page is built from [`Assets`]. With the feature `page` they are embedded in the program;
//! building this crate then also builds the engine, for which the target `wasm32-unknown-unknown`
//! must be installed.
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
