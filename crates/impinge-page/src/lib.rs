//! The engine of a web page that shows worlds and runs queries on them.
//!
//! An [`Engine`] takes messages as bytes and returns responses as bytes; `PROTOCOL.md` describes
//! both. The engine holds one *stage*: a recording, a growing recording, or a running sample. The
//! page draws and sends requests. The engine computes all geometry, by public functions of the
//! library.
//!
//! Compiled to a WebAssembly module, this crate exports three functions with numeric arguments and
//! results. Native programs call the engine directly: tests, and programs whose recordings use
//! their own shape types and pair filters.

pub mod answer;
mod ask;
mod describe;
mod engine;
mod error;
mod explain;
#[cfg(target_family = "wasm")]
mod exports;
mod frame;
mod groups;
mod message;
mod recorded;
pub mod request;
mod sampled;
mod shape_text;
mod space;
mod stage;
mod stand_in;
mod time_line;

pub use engine::Engine;
pub use error::EngineError;
pub use message::{message, parts};
pub use recorded::Recorded;
pub use sampled::Sampled;
pub use space::Viewed;
pub use stage::{Shown, Source, Stage};
