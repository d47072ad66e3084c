//! Wavefront OBJ, by `tobj`: groups and objects become parts.
//!
//! `tobj` gives no lines and trusts indices, so the text is prepared first: of faces the vertex indices are left, and
//! faces with indices out of range are taken out and noted.

use core::cell::Cell;
use std::io::BufReader;

use tobj::{LoadError, LoadOptions, Mesh, load_obj_buf};

use super::RawPart;
use super::lines::LineReader;
use super::raw::FormatError;

/// The text for the parser.
#[derive(Default)]
struct Prepared {
    text: String,
    /// The lines of faces, in order.
    faces: Vec<usize>,
    out_of_range: Vec<usize>,
}

/// The parts of an OBJ file.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<RawPart>, FormatError> {
    let prepared = prepare(&String::from_utf8_lossy(bytes));
    let line = Cell::new(0);
    let mut reader = BufReader::new(LineReader::new(prepared.text.as_bytes(), &line));
    let options = LoadOptions { ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    // Materials mean nothing to collisions; the prepared text names none.
    let loaded = load_obj_buf(&mut reader, &options, |_| Err(LoadError::GenericFailure));
    let (models, _) =
        loaded.map_err(|error| FormatError::syntax(Some(line.get()), error.to_string()))?;
    let mut lines = prepared.faces.into_iter();
    let mut parts: Vec<RawPart> =
        models.into_iter().map(|model| part(model.name, &model.mesh, &mut lines)).collect();
    if !prepared.out_of_range.is_empty() && parts.is_empty() {
        parts.push(RawPart::new(""));
    }
    if let Some(first) = parts.first_mut() {
        first.out_of_range = prepared.out_of_range;
    }
    Ok(parts)
}

/// The statements about vertices, faces and groups, each on its line.
fn prepare(text: &str) -> Prepared {
    let is_vertex = |line: &&str| line.split_whitespace().next() == Some("v");
    let vertices = text.lines().filter(is_vertex).count();
    let mut prepared = Prepared::default();
    let mut seen = 0;
    for (number, line) in (1..).zip(text.lines()) {
        match line.split_whitespace().next() {
            Some("v") => {
                seen += 1;
                prepared.text.push_str(line);
            }
            Some("o" | "g") => prepared.text.push_str(line.trim_start()),
            Some("f") => prepared.face(line, number, Count { vertices, seen }),
            _ => {}
        }
        prepared.text.push('\n');
    }
    prepared
}

/// How many vertices there are in the file, and before a line.
#[derive(Clone, Copy)]
struct Count {
    vertices: usize,
    seen: usize,
}

impl Prepared {
    /// Takes over a face, or notes its line. What is no number is left for the parser to refuse.
    fn face(&mut self, line: &str, number: usize, count: Count) {
        let indices = line.split_whitespace().skip(1);
        let indices = indices.map(|word| word.split('/').next().unwrap_or_default());
        let indices: Vec<&str> = indices.collect();
        let numbers = indices.iter().filter_map(|index| index.parse::<i64>().ok());
        if numbers.clone().any(|index| !count.has(index)) {
            self.out_of_range.push(number);
        } else if indices.len() >= 3 {
            self.text.push_str("f ");
            self.text.push_str(&indices.join(" "));
            self.faces.push(number);
        }
    }
}

impl Count {
    /// A vertex has this index: from 1 upwards, or from -1 downwards before the line.
    fn has(self, index: i64) -> bool {
        let limit = if index < 0 { self.seen } else { self.vertices };
        index != 0 && index.unsigned_abs() <= limit as u64
    }
}

/// The part of a group; its faces take their lines.
fn part(name: String, mesh: &Mesh, lines: &mut impl Iterator<Item = usize>) -> RawPart {
    let mut part = RawPart::new(if name == "unnamed_object" { String::new() } else { name });
    part.vertices = mesh.positions.chunks_exact(3).map(|xyz| [xyz[0], xyz[1], xyz[2]]).collect();
    let mut rest = mesh.indices.as_slice();
    // Without arities all faces are triangles.
    let triangles = mesh.indices.len() / 3;
    let arities = mesh.face_arities.iter().copied();
    let arities = arities
        .chain(core::iter::repeat_n(3, triangles * usize::from(mesh.face_arities.is_empty())));
    for arity in arities {
        let (face, after) = rest.split_at((arity as usize).min(rest.len()));
        part.face(face.iter().copied());
        rest = after;
    }
    part.lines = lines.take(part.faces().count()).collect();
    part
}
