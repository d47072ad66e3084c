//! Reads Wavefront OBJ. Groups and objects become parts. Materials, texture coordinates, normals,
//! lines and points are ignored.

use super::RawPart;
use super::raw::{FormatError, number, words};

/// Marks a vertex that does not belong to the current part yet.
const NONE: u32 = u32::MAX;

/// Returns the parts of an OBJ file. O(n) in its bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<RawPart>, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader::new(vertices(&text)?);
    for (line, text) in (1..).zip(text.lines()) {
        let (keyword, rest) = words(text);
        match keyword {
            "v" => reader.seen += 1,
            "o" | "g" => reader.begin(rest.trim()),
            "f" => reader.face(rest, line)?,
            _ => {}
        }
    }
    Ok(reader.finish())
}

/// Returns the vertices of the whole file, since faces may name vertices on later lines.
fn vertices(text: &str) -> Result<Vec<[f64; 3]>, FormatError> {
    let lines = (1..).zip(text.lines().map(words)).filter(|(_, (keyword, _))| *keyword == "v");
    lines.map(|(line, (_, rest))| vertex(rest, line)).collect()
}

/// Parses three coordinates. If exactly one number follows, it is a weight, by which the
/// coordinates are divided. If two or more numbers follow, such as a colour, they are ignored.
fn vertex(text: &str, line: usize) -> Result<[f64; 3], FormatError> {
    let mut words = text.split_whitespace();
    let mut position = [0.0; 3];
    for coordinate in &mut position {
        *coordinate = number(words.next(), line)?;
    }
    let (weight, rest) = (words.next(), words.next());
    if weight.is_none() || rest.is_some() {
        return Ok(position);
    }
    Ok(position.map({
        let weight: f64 = number(weight, line)?;
        move |coordinate| coordinate / weight
    }))
}

/// The parts that were read so far. Each part has a list of the vertices that its faces use, in the
/// order of their first use. Corners are indices in this list.
struct Reader {
    vertices: Vec<[f64; 3]>,
    /// For each vertex of the file, its index in the current part; [`NONE`] if the part does not
    /// use it.
    own: Vec<u32>,
    /// For each vertex of the current part, its index in the file.
    used: Vec<usize>,
    part: RawPart,
    parts: Vec<RawPart>,
    /// The number of vertices on the lines read so far.
    seen: usize,
    out_of_range: Vec<usize>,
}

impl Reader {
    fn new(vertices: Vec<[f64; 3]>) -> Self {
        Self {
            own: vec![NONE; vertices.len()],
            used: Vec::new(),
            part: RawPart::default(),
            parts: Vec::new(),
            seen: 0,
            out_of_range: Vec::new(),
            vertices,
        }
    }

    /// Begins a group or object, which becomes a part if it has faces.
    fn begin(&mut self, name: &str) {
        self.end();
        self.part.name = name.to_owned();
    }

    fn end(&mut self) {
        if self.part.lines.is_empty() {
            return;
        }
        self.part.vertices = self.used.iter().map(|vertex| self.vertices[*vertex]).collect();
        self.used.drain(..).for_each(|vertex| self.own[vertex] = NONE);
        self.parts.push(core::mem::take(&mut self.part));
    }

    /// Adds a face, or stores its line in `out_of_range` if it names a vertex that does not exist.
    /// A face with fewer than three corners is ignored.
    fn face(&mut self, text: &str, line: usize) -> Result<(), FormatError> {
        let mut corners = Vec::new();
        for word in text.split_whitespace() {
            let index: i64 = number(word.split('/').next(), line)?;
            let Some(vertex) = self.vertex(index) else {
                self.out_of_range.push(line);
                return Ok(());
            };
            corners.push(vertex);
        }
        if corners.len() >= 3 {
            let corners: Vec<u32> = corners.into_iter().map(|vertex| self.corner(vertex)).collect();
            self.part.face(corners);
            self.part.lines.push(line);
        }
        Ok(())
    }

    /// Converts a vertex index of the file to an index from 0. Indices of the file count from 1
    /// upwards, or from -1 downwards, where -1 is the last vertex before the line. `None` if the
    /// vertex does not exist.
    fn vertex(&self, index: i64) -> Option<usize> {
        let distance = usize::try_from(index.unsigned_abs()).ok()?;
        let vertex =
            if index < 0 { self.seen.checked_sub(distance) } else { distance.checked_sub(1) };
        vertex.filter(|vertex| *vertex < self.vertices.len())
    }

    /// Returns the index of a vertex in the current part. Adds the vertex to the part at its first
    /// use.
    fn corner(&mut self, vertex: usize) -> u32 {
        if self.own[vertex] == NONE {
            self.own[vertex] = u32::try_from(self.used.len()).unwrap_or(NONE);
            self.used.push(vertex);
        }
        self.own[vertex]
    }

    fn finish(mut self) -> Vec<RawPart> {
        self.end();
        if !self.out_of_range.is_empty() && self.parts.is_empty() {
            self.parts.push(RawPart::default());
        }
        if let Some(first) = self.parts.first_mut() {
            first.out_of_range = self.out_of_range;
        }
        self.parts
    }
}
