//! Reads PLY, ASCII and binary, with the crate `ply-rs-bw`.

use std::io::Cursor;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Encoding, Header, Property, PropertyAccess, PropertyAccessResult};

use super::RawPart;
use super::raw::FormatError;
use crate::Problem;

/// An element of any kind: a vertex, a face, or a kind that is ignored.
#[derive(Debug, Default)]
struct Element {
    position: [f64; 3],
    corners: Vec<u32>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
        if let Some(axis) = axis {
            let number = number_of(&value);
            self.position[axis] = number.unwrap_or(f64::NAN);
            return PropertyAccessResult::Set;
        }
        if name == "vertex_indices" || name == "vertex_index" {
            // A negative index becomes an index out of range, so the face is dropped.
            self.corners = value.to_u32_list().unwrap_or_else(|| vec![u32::MAX]);
            return PropertyAccessResult::Set;
        }
        PropertyAccessResult::Ignored
    }
}

/// Converts a scalar of any type to `f64`; `None` for a list.
fn number_of(value: &Property) -> Option<f64> {
    Some(match value {
        Property::Char(x) => f64::from(*x),
        Property::UChar(x) => f64::from(*x),
        Property::Short(x) => f64::from(*x),
        Property::UShort(x) => f64::from(*x),
        Property::Int(x) => f64::from(*x),
        Property::UInt(x) => f64::from(*x),
        Property::Float(x) => f64::from(*x),
        Property::Double(x) => *x,
        _ => return None,
    })
}

/// Returns the single part of a PLY file.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<RawPart>, FormatError> {
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(Cursor::new(bytes));
    let wrong = |error: ParseError| FormatError::syntax(error.line(), error);
    let header = parser.read_header(&mut reader).map_err(wrong)?;
    check_counts(&header, bytes.len())?;
    let first_line = reader.line() + 1;
    let mut part = RawPart::default();
    let mut line = first_line;
    for (name, element) in &header.elements {
        if element.properties.is_empty() && header.encoding != Encoding::Ascii {
            continue;
        }
        let elements = parser.read_payload_for_element(&mut reader, element, &header);
        let elements = elements.map_err(wrong)?;
        let count = elements.len();
        match name.as_str() {
            "vertex" => {
                part.vertices = elements.into_iter().map(|vertex| vertex.position).collect();
            }
            "face" => {
                elements.into_iter().for_each(|face| part.face(face.corners));
                if header.encoding == Encoding::Ascii {
                    part.lines = (line..).take(count).collect();
                }
            }
            _ => {}
        }
        line += count;
    }
    Ok(vec![part])
}

/// Checks that the elements of all kinds in the header fit into the bytes of the file. Otherwise a
/// small file could request much time and memory.
fn check_counts(header: &Header, bytes: usize) -> Result<(), FormatError> {
    let mut needed: usize = 0;
    for (_, element) in &header.elements {
        // Each property takes at least one byte. An element without properties still takes the end
        // of a line.
        let least = element.properties.len().max(1);
        needed = needed.saturating_add(element.count.saturating_mul(least));
        if needed > bytes {
            let what = "values that the header announces";
            return Err(Problem::TooMany { what, given: needed, limit: bytes }.into());
        }
    }
    Ok(())
}
