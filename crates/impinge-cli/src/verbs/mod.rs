//! The verbs of the command. Each verb except `schema` and `completions` has a file with its
//! function `run` and, if it prints one, its report.

mod bench;
mod cast;
mod check;
mod distance;
mod export;
mod inspect;
mod ray;
mod record;
mod render;
mod replay;
mod samples;
mod validate;
mod view;

use clap::CommandFactory as _;
use clap_complete::Shell;

use crate::args::{Cli, Verb};
use crate::error::CliError;
use crate::output::{self, Outcome};

/// Runs a verb.
pub(crate) fn run(verb: &Verb) -> Result<Outcome, CliError> {
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

/// Prints the JSON Schema of scene files.
fn schema() -> Result<Outcome, CliError> {
    output::print(&impinge_files::SceneFile::schema())?;
    Ok(Outcome::Clear)
}

/// Prints the completions for a shell.
fn completions(shell: Shell) -> Result<Outcome, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "impinge", &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(Outcome::Clear)
}
