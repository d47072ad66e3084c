//! The text of a scene file, from which the lines of its values are found.

use std::path::{Path, PathBuf};

use crate::error::Fault;
use crate::scan::{Scanner, Step};
use crate::{FileError, Problem, SceneFile};

/// The maximum number of characters of a value in an error.
const MAX_VALUE: usize = 60;

/// A document and the file that contains it.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) file: PathBuf,
    /// The JSON text; `None` for scenes that are built in memory, whose errors contain paths only.
    text: Option<String>,
}

impl Source {
    /// Creates a source from the text of a file.
    pub(crate) const fn new(file: PathBuf, text: String) -> Self {
        Self { file, text: Some(text) }
    }

    /// Creates a source for a scene without a text.
    pub(crate) const fn without_text(file: PathBuf) -> Self {
        Self { file, text: None }
    }

    /// Returns the folder to which paths in the document are relative.
    pub(crate) fn folder(&self) -> &Path {
        self.file.parent().unwrap_or_else(|| Path::new(""))
    }

    /// Parses the document.
    pub(crate) fn parse(&self) -> Result<SceneFile, FileError> {
        let text = self.text.as_deref().unwrap_or_default();
        let mut reader = serde_json::Deserializer::from_str(text);
        let scene = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
            let path = error.path().to_string();
            // If a value is not valid JSON, its own step in the path is "?". This step is removed:
            // the path then ends at the enclosing value. The path "." is the whole document.
            let path = path.trim_end_matches('?').trim_end_matches('.').to_owned();
            self.syntax_error(path, error.inner())
        })?;
        reader.end().map_err(|error| self.syntax_error(String::new(), &error))?;
        Ok(scene)
    }

    fn syntax_error(&self, path: String, error: &serde_json::Error) -> FileError {
        let (line, column) = (error.line(), error.column());
        let message = error.to_string();
        // The error has fields for line and column, so the message need not contain them.
        let place = format!(" at line {line} column {column}");
        let message = message.strip_suffix(&place).unwrap_or(&message).to_owned();
        let (line, column) = (line > 0).then_some((line, column.max(1))).unzip();
        FileError { line, column, path, ..FileError::whole(&self.file, Problem::syntax(message)) }
    }

    /// Converts a fault to an error with the line, column and value. If the document does not
    /// contain the end of the path, because a member has its default, the longest existing part of
    /// the path is used.
    pub(crate) fn error(&self, fault: Fault) -> FileError {
        let Fault { path, problem, .. } = fault;
        let error = FileError::whole(&self.file, problem);
        let Some(text) = &self.text else { return FileError { path, ..error } };
        let Found { path, place: (line, column), value } = find(text, &path);
        // An error of the whole document quotes no value.
        let value = Some(value).filter(|_| !path.is_empty());
        FileError { line: Some(line), column: Some(column), path, value, ..error }
    }
}

/// Finds the value at a path, or the nearest enclosing value in the document. The text must be
/// valid JSON, which `parse` has checked.
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

/// Returns the line and the column of a byte offset, both counted from 1.
fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = &text[..byte];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    (line, before[start..].chars().count() + 1)
}

/// Returns the first [`MAX_VALUE`] characters of a value, with white space replaced by single
/// spaces, and `...` in place of omitted characters.
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

/// A value that was found in a document.
struct Found {
    /// The part of the path that exists in the document.
    path: String,
    /// The line and the column of the value, counted from 1.
    place: (usize, usize),
    value: String,
}

/// Returns the steps of a path such as `objects[3].shape`. A shape whose name contains a dot or a
/// bracket is not found; the error then has the position of the enclosing value.
fn steps(path: &str) -> impl Iterator<Item = Step<'_>> {
    let parts = path.split(['.', '[']).filter(|part| !part.is_empty());
    parts.map(|part| {
        let index = part.strip_suffix(']').and_then(|index| index.parse().ok());
        index.map_or(Step::Name(part), Step::Index)
    })
}
