//! Writes the output of the command: reports as text or JSON, notes, errors and files.

use core::fmt;
use std::fs;
use std::io::{self, Write as _};
use std::path::Path;
use std::process::ExitCode;

use anstyle::{AnsiColor, Style};
use impinge_files::Printable;
use serde::Serialize;

use crate::args::Format;
use crate::error::CliError;
use crate::space::Kind;

/// The style of contacts, hits, differences and errors.
pub(crate) const TOUCHES: Style = AnsiColor::Red.on_default().bold();
/// The style of near pairs and notes.
pub(crate) const NEAR: Style = AnsiColor::Yellow.on_default();
/// The style of reports that nothing was found.
pub(crate) const CLEAR: Style = AnsiColor::Green.on_default();
/// The style of secondary text.
pub(crate) const FAINT: Style = Style::new().dimmed();
/// The style of names of objects and files.
pub(crate) const NAME: Style = Style::new().bold();

/// The maximum number of words of a message. Further words are omitted.
const MAX_WORDS: usize = 400;

/// The outcome of a command, which determines its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Nothing was found, or the verb does not search for anything: exit code 0.
    Clear,
    /// Something touches, is hit or differs: exit code 1.
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

/// The result of a verb. `Display` writes it as text with escape codes for colours, `Serialize` as
/// JSON with the fields that `--help` documents.
pub(crate) trait Report: Serialize + fmt::Display {
    /// Returns the outcome, which determines the exit code.
    fn outcome(&self) -> Outcome {
        Outcome::Clear
    }
}

/// The first fields of a report: its file, and the dimension and scalar of the computation.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Subject {
    pub(crate) file: String,
    #[serde(flatten)]
    pub(crate) kind: Kind,
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (file, kind) = (Printable(&self.file), self.kind);
        write!(f, "{NAME}{file}{NAME:#} {FAINT}({kind}){FAINT:#}")
    }
}

/// Prints a report as text or as JSON, and returns its outcome.
pub(crate) fn finish<R: Report>(report: &R, format: Format) -> Result<Outcome, CliError> {
    written(|out| {
        if !format.json {
            return write!(out, "{report}");
        }
        serde_json::to_writer_pretty(&mut *out, report)?;
        writeln!(out)
    })?;
    Ok(report.outcome())
}

/// Writes a text to standard output, with colours if standard output is a terminal.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    written(|out| out.write_all(text.as_bytes()))
}

/// Writes to standard output through a buffer: a long report is never in memory as a whole.
///
/// It is no error if the reader closes the pipe, as in `impinge … | head`.
fn written(write: impl FnOnce(&mut dyn io::Write) -> io::Result<()>) -> Result<(), CliError> {
    let mut out = io::BufWriter::new(anstream::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => Ok(written?),
    }
}

/// Writes a note to standard error, for a result that is valid but incomplete.
pub(crate) fn note(text: impl fmt::Display) {
    message(NEAR, "note", &text);
}

/// Writes an error to standard error.
pub(crate) fn complain(error: &CliError) {
    message(TOUCHES, "error", error);
}

/// Writes a message of one line. Control characters are escaped here, whatever the source of the
/// text. The text is cut after [`MAX_WORDS`] words, and [`Printable`] shortens long words.
fn message(style: Style, kind: &str, text: &dyn fmt::Display) {
    let text = text.to_string();
    let words = text.split_inclusive(' ').take(MAX_WORDS);
    let text: String = words.map(|word| Printable(word).to_string()).collect();
    // Standard error may be closed: the error of writing to it is ignored.
    let _ = writeln!(anstream::stderr(), "{style}{kind}{style:#}: {text}");
}

/// Writes a file, and replaces an existing one.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    fs::write(path, bytes).map_err(|error| CliError::Write { path: path.to_owned(), error })
}

/// A file that is written in pieces. The file is created when the first piece is written, so that
/// an earlier error does not destroy an existing file.
#[derive(Debug)]
pub(crate) struct Growing<'a> {
    path: &'a Path,
    file: Option<io::BufWriter<fs::File>>,
}

impl<'a> Growing<'a> {
    pub(crate) const fn new(path: &'a Path) -> Self {
        Self { path, file: None }
    }

    pub(crate) fn append(&mut self, bytes: &[u8]) -> Result<(), CliError> {
        let wrong = |error| CliError::Write { path: self.path.to_owned(), error };
        if self.file.is_none() {
            let file = fs::File::create(self.path).map_err(wrong)?;
            self.file = Some(io::BufWriter::new(file));
        }
        let file = self.file.as_mut();
        file.map_or(Ok(()), |file| file.write_all(bytes)).map_err(wrong)
    }

    /// Writes the buffered bytes after the last piece.
    pub(crate) fn finish(mut self) -> Result<(), CliError> {
        let flushed = self.file.as_mut().map_or(Ok(()), io::Write::flush);
        flushed.map_err(|error| CliError::Write { path: self.path.to_owned(), error })
    }
}
