//! Tests that run the command as a user does, in a folder with the scenes of `scenes`.

mod bad_input;
mod docs;
mod hostile;
mod large;
mod pages;
mod pairs;
mod pictures;
mod queries;
mod recordings;
mod reports;
mod support;
