//! Tests of the engine through messages and responses.

mod frames;
mod gallery;
mod hostile;
mod numbers;
mod replays;
mod support;
mod why;
