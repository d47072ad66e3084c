//! What is printed: text or JSON, at once, on standard output.

use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::Path;
use std::process::ExitCode;

use anstyle::{AnsiColor, Style};
use serde::Serialize;

use crate::args::{Format, is_stdin};
use crate::error::CliError;

/// What touches, is hit or differs.
pub(crate) const TOUCHES: Style = AnsiColor::Red.on_default().bold();
/// What is near.
pub(crate) const NEAR: Style = AnsiColor::Yellow.on_default();
/// What is as it should be.
pub(crate) const CLEAR: Style = AnsiColor::Green.on_default();
/// What matters less.
pub(crate) const FAINT: Style = Style::new().dimmed();
/// Names of objects and files.
pub(crate) const NAME: Style = Style::new().bold();

/// Whether something touches, is hit or differs: the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Nothing, or there is no such answer: 0.
    Clear,
    /// Something: 1.
    Found,
}

impl From<bool> for Outcome {
    fn from(is_found: bool) -> Self {
        if is_found { Self::Found } else { Self::Clear }
    }
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Clear => Self::SUCCESS,
            Outcome::Found => Self::from(1),
        }
    }
}

/// An answer of the command. Its fields in JSON are those that `--help` documents.
pub(crate) trait Report: Serialize {
    /// The answer as text, with escape codes for colours.
    fn text(&self) -> String;

    /// The exit code.
    fn outcome(&self) -> Outcome;
}

/// Prints a report, and says whether it found something.
pub(crate) fn finish<R: Report>(report: &R, format: Format) -> Result<Outcome, CliError> {
    let text = if format.json { json(report)? } else { report.text() };
    print(&text)?;
    Ok(report.outcome())
}

fn json<R: Report>(report: &R) -> Result<String, CliError> {
    let mut text = serde_json::to_string_pretty(report).map_err(io::Error::other)?;
    text.push('\n');
    Ok(text)
}

/// Writes a text to standard output, with colours where these are seen.
///
/// A reader that is gone, as of `impinge … | head`, is no error.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    let mut out = anstream::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => Ok(written?),
    }
}

/// The bytes of a file, or of standard input for `-`.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, CliError> {
    let failed = |error| CliError::Read { path: path.to_owned(), error };
    if !is_stdin(path) {
        return fs::read(path).map_err(failed);
    }
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// Writes a file.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    let failed = |error| CliError::Write { path: path.to_owned(), error };
    fs::write(path, bytes).map_err(failed)
}
