//! The command `impinge`: collision checks, queries, pictures and recordings of scene files.
//!
//! A verb reads a file, computes in the scalar and dimension that the file names, and prints a
//! report as text or as JSON. The exit code is 1 if something touches, is hit or differs, 2 if the
//! input or the arguments are invalid, and 0 otherwise.
//!
//! `args` defines the command line. `verbs` has a file for each verb. The other modules are used by
//! several verbs.
#![forbid(unsafe_code)]

mod args;
mod convert;
mod error;
mod hits;
mod input;
mod itself;
mod log;
mod motion;
mod near;
mod number;
mod output;
mod page;
mod progress;
mod scene;
mod separation;
mod space;
mod state;
mod summary;
mod verbs;

use std::process::ExitCode;

use clap::Parser as _;

use crate::args::Cli;

fn main() -> ExitCode {
    match verbs::run(&Cli::parse().verb) {
        Ok(outcome) => outcome.into(),
        Err(error) => {
            output::complain(&error);
            ExitCode::from(2)
        }
    }
}
