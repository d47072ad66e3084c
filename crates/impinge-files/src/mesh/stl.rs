//! Reads STL, binary and ASCII.

use super::RawPart;
use super::raw::{FormatError, number, words};
use crate::text::without_mark;

/// The number of bytes before the triangles of a binary file.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;
/// The number of bytes of the normal, with which the record of a triangle begins.
const NORMAL: usize = 12;

/// Returns the solids of an STL file. O(n) in its bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<RawPart>, FormatError> {
    let count = count(bytes);
    let has_length =
        count.is_some_and(|count| HEADER as u64 + TRIANGLE as u64 * count == bytes.len() as u64);
    let text = without_mark(bytes);
    // The header of a binary file may also begin with `solid`, or with the bytes of a mark.
    if has_length || !text.trim_ascii_start().starts_with(b"solid") {
        return Ok(vec![binary(bytes, count.unwrap_or(u64::MAX))?]);
    }
    let text = core::str::from_utf8(text)
        .map_err(|_| FormatError::syntax(None, "neither a binary STL file nor text"))?;
    ascii(text)
}

/// Returns the number of triangles in the header of a binary file; `None` if the file is too short
/// for a header.
fn count(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(u64::from(u32::from_le_bytes(count)))
}

fn binary(bytes: &[u8], count: u64) -> Result<RawPart, FormatError> {
    let triangles = bytes.get(HEADER..).unwrap_or_default().chunks_exact(TRIANGLE);
    if (triangles.len() as u64) < count {
        return Err(FormatError::syntax(None, "the file ends before its last triangle"));
    }
    let mut part = RawPart::soup("");
    for triangle in triangles.take(usize::try_from(count).unwrap_or(usize::MAX)) {
        let mut numbers = triangle[NORMAL..].chunks_exact(4).map(float);
        let mut vertex = || [0; 3].map(|_| numbers.next().unwrap_or(f64::NAN));
        part.triangle([vertex(), vertex(), vertex()]);
    }
    Ok(part)
}

/// Reads a little-endian number of four bytes.
fn float(bytes: &[u8]) -> f64 {
    bytes.try_into().map_or(f64::NAN, |bytes| f64::from(f32::from_le_bytes(bytes)))
}

/// The state of the parser of a text file. Each facet goes through `Facet`, `Loop` and `Closed`;
/// its three vertices are read in `Loop`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Outside,
    Solid,
    Facet,
    Loop,
    Closed,
}

/// Returns the solids of a text file.
fn ascii(text: &str) -> Result<Vec<RawPart>, FormatError> {
    let (mut parts, mut part) = (Vec::new(), RawPart::default());
    let (mut place, mut corners, mut last) = (Place::Outside, Vec::new(), 0);
    for (line, text) in (1..).zip(text.lines()) {
        let (keyword, rest) = words(text);
        last = line;
        place = match (place, keyword) {
            (_, "") => place,
            (Place::Outside, "solid") => {
                part = RawPart::soup(rest.trim());
                Place::Solid
            }
            // Text between two solids is ignored.
            (Place::Outside, _) => place,
            (Place::Solid, "endsolid") => {
                parts.push(core::mem::take(&mut part));
                Place::Outside
            }
            (Place::Solid, "facet") => {
                part.lines.push(line);
                Place::Facet
            }
            (Place::Facet, "outer") => Place::Loop,
            (Place::Loop, "vertex") if corners.len() < 3 => {
                corners.push(vertex(rest, line)?);
                place
            }
            (Place::Loop, "endloop") if corners.len() == 3 => Place::Closed,
            (Place::Closed, "endfacet") => {
                part.triangle([corners[0], corners[1], corners[2]]);
                corners.clear();
                Place::Solid
            }
            _ => {
                let message = format!("{} is expected, not {keyword:?}", expected(place));
                return Err(FormatError::syntax(Some(line), message));
            }
        };
    }
    match place {
        Place::Outside => Ok(parts),
        _ => Err(FormatError::syntax(Some(last), "the file ends within a solid")),
    }
}

const fn expected(place: Place) -> &'static str {
    match place {
        Place::Outside => "solid",
        Place::Solid => "facet or endsolid",
        Place::Facet => "outer loop",
        Place::Loop => "three times vertex, then endloop,",
        Place::Closed => "endfacet",
    }
}

/// Parses three numbers, rounded to 32 bits as in binary files.
fn vertex(text: &str, line: usize) -> Result<[f64; 3], FormatError> {
    let mut words = text.split_whitespace();
    let mut position = [0.0; 3];
    for coordinate in &mut position {
        *coordinate = f64::from(number::<f32>(words.next(), line)?);
    }
    if words.next().is_some() {
        return Err(FormatError::syntax(Some(line), "a vertex has three coordinates"));
    }
    Ok(position)
}
