//! Defects of a mesh, and their positions in the file.

use core::fmt;

/// The maximum number of defects of each kind that a report lists. All defects are counted.
pub const MAX_DEFECTS: usize = 8;

/// The defects of the triangles of a part, and their repairs.
///
/// Vertices are welded first, so edges and triangles are compared by the positions of their
/// corners. Indices count from 0 in the order of the file, within the part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshReport {
    /// The number of vertices after the repairs.
    pub vertices: usize,
    /// The number of triangles after the repairs.
    pub triangles: usize,
    /// The number of faces with more than three corners that were triangulated.
    pub polygons: usize,
    /// Vertices with a coordinate that is NaN or infinite. Faces with such a vertex were dropped.
    pub non_finite_vertices: Defects,
    /// Dropped faces: they name a vertex that does not exist. In an OBJ file, the report of the
    /// first part has the faces of all parts, and their index is 0.
    pub out_of_range: Defects,
    /// Dropped faces with zero area or with fewer than three corners. A polygon counts if none of
    /// its triangles has positive area.
    pub degenerate: Defects,
    /// Vertices at the position of an earlier vertex, with which they were welded. Formats without
    /// indices count none, as each triangle has its own vertices.
    pub duplicate_vertices: Defects,
    /// Dropped triangles, which have the corners and the orientation of an earlier triangle.
    pub duplicate_triangles: Defects,
    /// Edges of one triangle only, at which the surface is open. The index of the defect is the
    /// index of the triangle's face.
    pub boundary_edges: Defects,
    /// Edges of more than two triangles. The index of the defect is the index of the first face.
    pub non_manifold_edges: Defects,
    /// Edges whose two triangles have their fronts on different sides. The index of the defect is
    /// the index of the first face.
    pub inconsistent_edges: Defects,
    /// The number of components of triangles that are connected by edges.
    pub components: usize,
    /// The volume enclosed by the surface, negative if its triangles point inwards. `None` unless
    /// [`MeshReport::is_solid`].
    pub volume: Option<f64>,
}

/// Defects of one kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Defects {
    /// The number of defects.
    pub count: usize,
    /// The first defects in the order in which they were found, at most [`MAX_DEFECTS`].
    pub first: Vec<Defect>,
}

/// A vertex or face of a file with a defect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Defect {
    /// The index of the vertex or face, in the order of the file.
    pub index: usize,
    /// The line of the face, counted from 1; `None` in binary formats, and for vertices.
    pub line: Option<usize>,
}

impl Defects {
    pub(super) fn add(&mut self, index: usize, line: Option<usize>) {
        self.count += 1;
        if self.first.len() < MAX_DEFECTS {
            self.first.push(Defect { index, line });
        }
    }
}

impl MeshReport {
    /// Returns `true` if the mesh has triangles, and each edge has two triangles or more.
    #[must_use]
    pub const fn is_closed(&self) -> bool {
        self.triangles > 0 && self.boundary_edges.count == 0
    }

    /// Returns `true` if the surface bounds a volume: it has triangles, and each edge has exactly
    /// two triangles, whose fronts are on the same side.
    #[must_use]
    pub const fn is_solid(&self) -> bool {
        self.is_closed() && self.non_manifold_edges.count == 0 && self.inconsistent_edges.count == 0
    }

    /// Returns `true` if the report has no defects other than boundary edges: no face was dropped,
    /// no vertex is duplicate or not finite, and no edge is non-manifold or inconsistent. The
    /// surface may be open or closed.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.defects().all(|(_, defects)| defects.count == 0)
    }

    /// Returns a line for each kind of defect that occurs, such as `2 degenerate faces, dropped: 1
    /// (line 9), 4 (line 12)`. An open boundary does not count.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let found = self.defects().filter(|(_, defects)| defects.count > 0);
        found.map(|(what, defects)| format!("{} {what}: {defects}", defects.count)).collect()
    }

    /// Returns the defects of each kind except boundary edges, with the name of the kind.
    fn defects(&self) -> impl Iterator<Item = (&'static str, &Defects)> {
        [
            ("vertices that are not finite", &self.non_finite_vertices),
            ("faces with vertices that do not exist, dropped", &self.out_of_range),
            ("degenerate faces, dropped", &self.degenerate),
            ("vertices at the position of another, welded", &self.duplicate_vertices),
            ("triangles that occur before, dropped", &self.duplicate_triangles),
            ("edges of more than two triangles", &self.non_manifold_edges),
            ("edges whose triangles disagree about the front", &self.inconsistent_edges),
        ]
        .into_iter()
    }
}

impl fmt::Display for MeshReport {
    /// Writes a line of counts, and a line for each kind of defect that occurs.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { vertices, triangles, components, .. } = self;
        write!(f, "{vertices} vertices, {triangles} triangles, {components} pieces, ")?;
        match (self.volume, self.is_closed()) {
            (Some(volume), _) if volume < 0.0 => {
                write!(f, "closed, inside out, volume {}", -volume)?;
            }
            (Some(volume), _) => write!(f, "closed, volume {volume}")?,
            (None, true) => write!(f, "closed, without a volume")?,
            (None, false) => write!(f, "open, {} boundary edges", self.boundary_edges.count)?,
        }
        self.problems().iter().try_for_each(|problem| write!(f, "\n{problem}"))
    }
}

impl fmt::Display for Defects {
    /// Writes the indices and lines of the listed defects, such as `4 (line 12), 9 (line 31), ...`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, Defect { index, line }) in self.first.iter().enumerate() {
            let separator = if position == 0 { "" } else { ", " };
            write!(f, "{separator}{index}")?;
            if let Some(line) = line {
                write!(f, " (line {line})")?;
            }
        }
        if self.count > self.first.len() { write!(f, ", ...") } else { Ok(()) }
    }
}
