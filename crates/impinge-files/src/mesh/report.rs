//! Defects of a mesh, and their positions in the file.

use core::fmt;

/// The largest number of listed defects of each kind; all are counted.
pub const MAX_DEFECTS: usize = 8;

/// Defects of the triangles of a part, and their repairs.
///
/// Vertices are welded first: edges and triangles are compared by the positions of their corners. Indices count
/// from 0 in the order of the file, within the part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshReport {
    /// The number of vertices, as loaded.
    pub vertices: usize,
    /// The number of triangles, as loaded.
    pub triangles: usize,
    /// The number of faces with more than three corners, which were triangulated.
    pub polygons: usize,
    /// Vertices with a coordinate that is NaN or infinite; the faces at them were dropped.
    pub non_finite_vertices: Defects,
    /// Faces that name a vertex that does not exist; they were dropped.
    pub out_of_range: Defects,
    /// Faces with zero area, or with fewer than three corners; they were dropped. A polygon counts
    /// if none of its triangles has positive area.
    pub degenerate: Defects,
    /// Vertices at the position of an earlier one; they were welded. In formats without indices none are counted, as
    /// each triangle has its own vertices.
    pub duplicate_vertices: Defects,
    /// Triangles with the corners of an earlier one in the same orientation; they were dropped.
    pub duplicate_triangles: Defects,
    /// Edges that belong to one triangle only: the surface is open there. The defect has the index
    /// of the triangle's face.
    pub boundary_edges: Defects,
    /// Edges that belong to more than two triangles. The defect has the index of the first face.
    pub non_manifold_edges: Defects,
    /// Edges at which the fronts of the two triangles disagree. The defect has the index of the
    /// first face.
    pub inconsistent_edges: Defects,
    /// The number of components that are connected by edges.
    pub components: usize,
    /// The volume enclosed by a surface that is closed and consistent; negative if it is inside out.
    pub volume: Option<f64>,
}

/// Defects of one kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Defects {
    /// The number of defects.
    pub count: usize,
    /// The first defects, at most [`MAX_DEFECTS`].
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
    /// Whether each edge has two triangles or more, so that there is no boundary.
    #[must_use]
    pub const fn is_closed(&self) -> bool {
        self.triangles > 0 && self.boundary_edges.count == 0
    }

    /// Whether the surface bounds a volume: each edge has two triangles, which agree about the front.
    #[must_use]
    pub const fn is_solid(&self) -> bool {
        self.is_closed() && self.non_manifold_edges.count == 0 && self.inconsistent_edges.count == 0
    }

    /// Whether all faces of the file were kept unchanged, and no edge is non-manifold or
    /// inconsistent. The surface may be open or closed.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.defects().all(|(_, defects)| defects.count == 0)
    }

    /// Returns a line for each kind of defect, such as `2 degenerate faces, dropped: 1 (line 9), 4 (line 12)`. An open
    /// boundary does not count.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let found = self.defects().filter(|(_, defects)| defects.count > 0);
        found.map(|(what, defects)| format!("{} {what}: {defects}", defects.count)).collect()
    }

    /// Returns the defects of each kind, with its name.
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
    /// Writes one line of counts, and one for each kind of defect.
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
    /// Writes indices and lines, such as `4 (line 12), 9 (line 31), ...`.
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
