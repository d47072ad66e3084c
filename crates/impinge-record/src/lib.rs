//! Recordings of collision worlds as logs of calls: written, replayed forwards and backwards, and
//! validated.
//!
//! A [`Recorder`] wraps a world. It records each call that changes the world, each query made
//! through the recorder, and after each update hashes of the state of the world. Since a recording
//! consists of calls, it does not depend on the memory layout of the library. [`Replay`] returns
//! the world at any step. [`validate`] replays all steps and returns the first step and object in
//! which the replay differs from the recording, on this machine or with this version.
//!
//! A recording can be read while it grows ([`Replay::growing`]), and without its end
//! ([`Replay::salvage`]). It has a time line ([`Replay::marks`]) and the recorded queries
//! ([`Replay::queries`]). [`pack`] compresses it for transfer.
//!
//! User-defined shapes and pair filters are code. A recording contains only their names, and a
//! [`Registry`] maps these names to the shapes and filters. `FORMAT.md` describes the bytes.
//!
//! Recordings are treated as untrusted input: errors have an offset, lengths are compared with the
//! remaining bytes before memory is allocated, and shapes are created by the constructors of the
//! library. Reading takes memory in proportion to the number of bytes. Unpacking takes at most
//! [`MAX_UNPACKED`] bytes for the recording and twice as many for the streams. A recording may
//! still describe a world that is expensive to update: if n objects all overlap, there are n (n -
//! 1) / 2 pairs, each of shapes with up to [`MAX_PARTS`] parts.
#![forbid(unsafe_code)]

mod asking;
mod bytes;
mod call;
mod data;
mod digest;
mod divergence;
mod engine;
mod error;
mod log;
mod marks;
mod pack;
mod player;
mod query;
mod question_data;
mod recorder;
mod registry;
mod replay;
mod shape_data;
mod shapes;
mod space;
mod state;

pub use data::RecordData;
pub use divergence::{Difference, Divergence, ObjectField};
pub use error::{LibraryError, Problem, ReadError, RecordError};
pub use log::{FORMAT_VERSION, Header, reseal};
pub use marks::{EventCounts, Mark};
pub use pack::{MAX_UNPACKED, is_packed, pack, unpack};
pub use query::{Asked, CastQuestion, Detail, Found, PlacedShape, Query, Question, RayQuestion};
pub use recorder::{Recorder, Recording, Refused};
pub use registry::Registry;
pub use replay::{Loss, Replay, validate};
pub use shape_data::{Field, Mesh, ShapeData};
pub use shapes::{MAX_DEPTH, MAX_PARTS};
pub use space::{Recordable, Scalar};
