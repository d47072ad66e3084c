//! The command `impinge`: collision checks, queries, pictures and recordings of scene files.
//!
//! A verb reads a file, computes in the scalar and dimension that the file names, and prints a report as text or
//! as JSON. Its exit code is 0 if nothing touches, 1 if something does, 2 if the input is wrong.
#![forbid(unsafe_code)]

mod args;
mod bench;
mod between;
mod cast;
mod check;
mod convert;
mod distance;
mod error;
mod export;
mod extent;
mod hits;
mod input;
mod inspect;
mod number;
mod output;
mod page;
mod progress;
mod ray;
mod record;
mod recording;
mod render;
mod replay;
mod samples;
mod scene;
mod space;
mod summary;
mod validate;
mod view;

use std::io::Write as _;
use std::process::ExitCode;

use anstyle::{AnsiColor, Style};
use clap::{CommandFactory as _, Parser as _};
use clap_complete::Shell;

use crate::args::{Cli, Verb};
use crate::error::CliError;
use crate::output::Outcome;

fn main() -> ExitCode {
    match run(&Cli::parse().verb) {
        Ok(outcome) => outcome.into(),
        Err(error) => {
            let style: Style = AnsiColor::Red.on_default().bold();
            // Nobody is left to hear that standard error is closed.
            let _ = writeln!(anstream::stderr(), "{style}error{style:#}: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(verb: &Verb) -> Result<Outcome, CliError> {
    match verb {
        Verb::Check(args) => check::run(args),
        Verb::Distance(args) => distance::run(args),
        Verb::Cast(args) => cast::run(args),
        Verb::Ray(args) => ray::run(args),
        Verb::Render(args) => render::run(args),
        Verb::Record(args) => record::run(args),
        Verb::Replay(args) => replay::run(args),
        Verb::Validate(args) => validate::run(args),
        Verb::Export(args) => export::run(args),
        Verb::View(args) => view::run(args),
        Verb::Samples(args) => samples::run(args),
        Verb::Inspect(args) => inspect::run(args),
        Verb::Bench(args) => bench::run(args),
        Verb::Schema => schema(),
        Verb::Completions { shell } => completions(*shell),
    }
}

/// The JSON Schema of scene files.
fn schema() -> Result<Outcome, CliError> {
    output::print(&impinge_files::SceneFile::schema())?;
    Ok(Outcome::Clear)
}

/// The completions for a shell.
fn completions(shell: Shell) -> Result<Outcome, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "impinge", &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(Outcome::Clear)
}
