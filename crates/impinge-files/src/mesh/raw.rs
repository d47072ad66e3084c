//! The faces of a mesh file as the file contains them, before any check.

use core::fmt;
use core::str::FromStr;

use crate::{Limit, Problem};

/// An error of parsing a mesh file, without the path of the file.
#[derive(Debug)]
pub(super) struct FormatError {
    pub(super) line: Option<usize>,
    pub(super) problem: Problem,
}

impl FormatError {
    /// Returns an error with the message of a parser.
    pub(super) fn syntax(line: Option<usize>, message: impl fmt::Display) -> Self {
        Self { line, problem: Problem::syntax(message) }
    }
}

impl From<Problem> for FormatError {
    fn from(problem: Problem) -> Self {
        Self { line: None, problem }
    }
}

/// Splits a line into its first word and the rest.
pub(super) fn words(line: &str) -> (&str, &str) {
    let line = line.trim_start();
    line.split_at(line.find(char::is_whitespace).unwrap_or(line.len()))
}

/// Parses a word as a number.
pub(super) fn number<T: FromStr>(word: Option<&str>, line: usize) -> Result<T, FormatError> {
    let word = word.ok_or_else(|| FormatError::syntax(Some(line), "a number is missing"))?;
    word.parse().map_err(|_| FormatError::syntax(Some(line), format!("{word:?} is no number")))
}

/// A part of a file as read: polygons, whose corners may be out of range.
#[derive(Debug, Default)]
pub(super) struct RawPart {
    pub(super) name: String,
    pub(super) vertices: Vec<[f64; 3]>,
    /// The vertex indices of all faces, face by face.
    pub(super) corners: Vec<u32>,
    /// For each face, the end of its range in `corners`.
    ends: Vec<usize>,
    /// The line of each face; empty for binary formats.
    pub(super) lines: Vec<usize>,
    /// The lines of faces that the parser dropped because they name a vertex that does not exist.
    /// Only the first part of an OBJ file has them, for all parts.
    pub(super) out_of_range: Vec<usize>,
    /// `true` if the format has no indices. Each triangle then has its own vertices.
    pub(super) is_soup: bool,
}

impl RawPart {
    /// Creates a part without faces.
    pub(super) fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Creates a part of a format without indices.
    pub(super) fn soup(name: impl Into<String>) -> Self {
        Self { is_soup: true, ..Self::new(name) }
    }

    /// Adds a face with these vertex indices.
    pub(super) fn face(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
    }

    /// Adds a triangle with its own vertices.
    pub(super) fn triangle(&mut self, vertices: [[f64; 3]; 3]) {
        let first = u32::try_from(self.vertices.len()).unwrap_or(u32::MAX);
        self.vertices.extend(vertices);
        self.face((0..3).map(|corner| first.saturating_add(corner)));
    }

    /// Returns the vertex indices of each face.
    pub(super) fn faces(&self) -> impl Iterator<Item = &[u32]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, end)| &self.corners[start..*end])
    }

    /// Checks that no face has more corners than `allowed`.
    pub(super) fn check_corners(&self, allowed: usize) -> Result<(), FormatError> {
        match self.faces().position(|face| face.len() > allowed) {
            None => Ok(()),
            Some(face) => {
                let problem = Problem::Limit { limit: Limit::Corners, allowed };
                Err(FormatError { line: self.line(face), problem })
            }
        }
    }

    /// Returns the line of a face; `None` for binary formats.
    pub(super) fn line(&self, face: usize) -> Option<usize> {
        self.lines.get(face).copied()
    }
}
