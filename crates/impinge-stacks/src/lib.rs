//! A small solver, scenes of solids at rest, and how well contacts carry them.
//!
//! [`Solver`] is what an engine has around a collision library, in two hundred lines. [`stacks2`] and [`stacks3`]
//! are scenes as plain numbers, [`pairs2`] and [`pairs3`] pairs to be shaken; [`play`] and [`shake`] measure whether
//! the solids rest and whether contacts keep their ids and places. Contacts come from a [`ContactSource`]:
//! [`Impinge`] is the one of this library, another one has its own.

#![forbid(unsafe_code)]
#![expect(clippy::disallowed_types, reason = "maps are looked up by id here, and never walked")]

mod mass;
mod memory;
mod run;
mod scenes;
mod solver;
mod source;
mod stack;
mod stage;
mod turn;
mod watch;

pub use mass::Weighed;
pub use memory::{Memory, Place};
pub use run::{LAST, Outcome, play, shake};
pub use scenes::{pairs2, pairs3, stacks2, stacks3};
pub use solver::{Body, Contact, Impulse, Solver};
pub use source::{Choices, ContactSource, Impinge, PREDICTION};
pub use stack::{Item, Kind, Mass, Solid, Stack};
pub use stage::{Stage, bodies_of, shape_of};
pub use turn::Turn;
pub use watch::{Counts, JUMP};
