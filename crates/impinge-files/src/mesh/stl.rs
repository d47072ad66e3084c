//! STL, binary and ASCII, by `stl_io`.

use core::cell::Cell;
use std::io::{self, Cursor, Read, Seek, SeekFrom};

use stl_io::create_stl_reader;

use super::RawPart;
use super::lines::LineReader;
use super::raw::FormatError;

/// The bytes before the triangles of a binary file, and those of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// The solids of an STL file.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<RawPart>, FormatError> {
    if is_binary(bytes) {
        return Ok(vec![binary(bytes)?]);
    }
    let text = core::str::from_utf8(bytes)
        .map_err(|_| FormatError::syntax(None, "neither a binary STL file nor text"))?;
    let mut parts = Vec::new();
    let mut skipped = 0;
    for solid in solids(text) {
        parts.push(ascii(solid, skipped)?);
        skipped += solid.lines().count();
    }
    Ok(parts)
}

/// The length is that of the triangles that the header counts, or the file does not begin as text does.
fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(80..HEADER).and_then(|count| count.try_into().ok());
    let count = count.map(u32::from_le_bytes);
    let length = count.map(|count| HEADER as u64 + u64::from(count) * TRIANGLE as u64);
    length == Some(bytes.len() as u64) || !bytes.trim_ascii_start().starts_with(b"solid")
}

fn binary(bytes: &[u8]) -> Result<RawPart, FormatError> {
    let mut bytes = bytes.to_vec();
    // A header may begin as text does.
    if let Some(first) = bytes.first_mut() {
        *first = b'-';
    }
    let mut part = RawPart::soup("");
    let mut reader = Cursor::new(bytes);
    let wrong = |error: io::Error| FormatError::syntax(None, error.to_string());
    for triangle in create_stl_reader(&mut reader).map_err(wrong)? {
        let triangle = triangle.map_err(wrong)?;
        part.triangle(triangle.vertices.map(|vertex| vertex.0.map(f64::from)));
    }
    Ok(part)
}

/// The text of each solid, from its `solid` to the next.
fn solids(text: &str) -> impl Iterator<Item = &str> {
    let begins = |line: &str| line.split_whitespace().next() == Some("solid");
    let mut rest = text;
    core::iter::from_fn(move || {
        let mut end = 0;
        for (index, line) in rest.split_inclusive('\n').enumerate() {
            if index > 0 && begins(line) {
                break;
            }
            end += line.len();
        }
        let (solid, after) = rest.split_at(end);
        rest = after;
        (!solid.is_empty()).then_some(solid)
    })
}

fn ascii(solid: &str, skipped: usize) -> Result<RawPart, FormatError> {
    let first = solid.lines().next().unwrap_or_default().trim();
    let name = first.strip_prefix("solid").unwrap_or_default().trim();
    let mut part = RawPart::soup(name);
    let begins = |line: &str| line.split_whitespace().next() == Some("facet");
    let facets = (skipped + 1..).zip(solid.lines()).filter(|(_, line)| begins(line));
    part.lines = facets.map(|(number, _)| number).collect();
    let line = Cell::new(skipped);
    // The parser wants a blank after `solid`, whatever follows.
    let text = format!("solid {name}\n{}", solid.split_once('\n').map_or("", |(_, rest)| rest));
    let wrong = |error: io::Error| FormatError::syntax(Some(line.get()), error.to_string());
    let mut reader = Rewound {
        text: text.as_bytes(),
        reader: LineReader::new(text.as_bytes(), &line),
        line: &line,
        start: skipped,
    };
    for triangle in create_stl_reader(&mut reader).map_err(wrong)? {
        let triangle = triangle.map_err(wrong)?;
        part.triangle(triangle.vertices.map(|vertex| vertex.0.map(f64::from)));
    }
    Ok(part)
}

/// A line reader that goes back to the start, as the parser does once it knows that the file is text.
struct Rewound<'a> {
    text: &'a [u8],
    reader: LineReader<'a>,
    line: &'a Cell<usize>,
    start: usize,
}

impl Read for Rewound<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.reader.read(buffer)
    }
}

impl Seek for Rewound<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        if to != SeekFrom::Start(0) {
            return Err(io::ErrorKind::Unsupported.into());
        }
        self.line.set(self.start);
        self.reader = LineReader::new(self.text, self.line);
        Ok(0)
    }
}
