//! The text of a scene file, and the lines of its values.

use std::path::{Path, PathBuf};

use crate::error::Fault;
use crate::scan::{Scanner, Step};
use crate::{FileError, Problem, SceneFile};

/// So many characters of a value are given in errors.
const MAX_VALUE: usize = 60;

/// A document and the file that it is from.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) file: PathBuf,
    /// `None` for scenes that are made and not read: their errors have paths only.
    text: Option<String>,
}

impl Source {
    /// The document as it was read.
    pub(crate) const fn new(file: PathBuf, text: String) -> Self {
        Self { file, text: Some(text) }
    }

    /// A scene that no document describes.
    pub(crate) const fn without_text(file: PathBuf) -> Self {
        Self { file, text: None }
    }

    /// The folder that paths in the document are relative to.
    pub(crate) fn folder(&self) -> &Path {
        self.file.parent().unwrap_or_else(|| Path::new(""))
    }

    /// The members of the document.
    pub(crate) fn parse(&self) -> Result<SceneFile, FileError> {
        let text = self.text.as_deref().unwrap_or_default();
        let mut reader = serde_json::Deserializer::from_str(text);
        let scene = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
            let path = error.path().to_string();
            // A value that is no JSON has the path of the one around it: its own step is "?", and "." alone is the
            // whole document.
            let path = path.trim_end_matches('?').trim_end_matches('.').to_owned();
            self.syntax_error(path, error.inner())
        })?;
        reader.end().map_err(|error| self.syntax_error(String::new(), &error))?;
        Ok(scene)
    }

    fn syntax_error(&self, path: String, error: &serde_json::Error) -> FileError {
        let (line, column) = (error.line(), error.column());
        let message = error.to_string();
        // The place is given apart from the words.
        let place = format!(" at line {line} column {column}");
        let message = message.strip_suffix(&place).unwrap_or(&message).to_owned();
        let (line, column) = (line > 0).then_some((line, column.max(1))).unzip();
        FileError { line, column, path, ..FileError::whole(&self.file, Problem::syntax(message)) }
    }

    /// The error with its line, column and value. Of a path whose end the document does not have, since a member
    /// has its default, the part counts that it has.
    pub(crate) fn error(&self, fault: Fault) -> FileError {
        let Fault { path, problem, .. } = fault;
        let error = FileError::whole(&self.file, problem);
        let Some(text) = &self.text else { return FileError { path, ..error } };
        let Found { path, place: (line, column), value } = find(text, &path);
        // The whole document is no value to quote.
        let value = Some(value).filter(|_| !path.is_empty());
        FileError { line: Some(line), column: Some(column), path, value, ..error }
    }
}

/// The value at a path, or the one around it that the document has. The document was accepted by `parse`.
fn find(text: &str, path: &str) -> Found {
    let mut scanner = Scanner::new(text);
    let mut taken = String::new();
    for step in steps(path) {
        let Some(next) = scanner.entered(step) else { break };
        scanner = next;
        match step {
            Step::Index(index) => taken.push_str(&format!("[{index}]")),
            Step::Name(name) if taken.is_empty() => taken.push_str(name),
            Step::Name(name) => taken.push_str(&format!(".{name}")),
        }
    }
    let (start, value) = scanner.value();
    Found { path: taken, place: place(text, start), value: shortened(value) }
}

/// The line and the column of a byte, counted from 1.
fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = &text[..byte];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    (line, before[start..].chars().count() + 1)
}

/// The beginning of the text of a value, in one line.
fn shortened(text: &str) -> String {
    let mut line = String::new();
    let mut count = 0;
    for word in text.split_whitespace() {
        let separator = if line.is_empty() { "" } else { " " };
        for character in separator.chars().chain(word.chars()) {
            if count == MAX_VALUE {
                line.push_str("...");
                return line;
            }
            line.push(character);
            count += 1;
        }
    }
    line
}

/// A value of a document.
struct Found {
    /// The part of the path that the document has.
    path: String,
    /// Line and column.
    place: (usize, usize),
    value: String,
}

/// The steps of a path such as `objects[3].shape`. A name with a dot or bracket in it, of a shape, is not found:
/// then the error has the place of the value around it.
fn steps(path: &str) -> impl Iterator<Item = Step<'_>> {
    let parts = path.split(['.', '[']).filter(|part| !part.is_empty());
    parts.map(|part| {
        let index = part.strip_suffix(']').and_then(|index| index.parse().ok());
        index.map_or(Step::Name(part), Step::Index)
    })
}
