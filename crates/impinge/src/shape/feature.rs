//! Vertices, edges and faces: the parts of a solid's surface that contacts are named by.

use smallvec::SmallVec;

use crate::math::{Point, Real, Vector};

/// A part of a solid's surface.
///
/// In the plane a polygon has vertices and faces (its sides); edges occur in space only. The curved
/// parts of a surface are faces too, except that the core of a capsule is a segment: an edge in
/// space and a face in the plane. Each shape documents its numbering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FeatureId {
    /// A corner.
    Vertex(u32),
    /// A straight line between two faces.
    Edge(u32),
    /// A flat or curved piece.
    Face(u32),
}

/// The part of a core that faces some direction, as a point, a segment or a flat convex polygon.
///
/// All in the local frame of the solid, roundings left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature<N: Real, const D: usize> {
    /// Its name.
    pub id: FeatureId,
    /// One point, two for a segment, more for a polygon: in space counter-clockwise seen from
    /// outside; in the plane a side is given with the solid on its left.
    pub vertices: SmallVec<[Point<N, D>; 8]>,
    /// The name of each vertex.
    pub vertex_ids: SmallVec<[FeatureId; 8]>,
    /// The name of the side from each vertex to the next; for a segment one entry; for a point none.
    pub side_ids: SmallVec<[FeatureId; 8]>,
    /// The outward normal, where the feature has one: a polygon in space, a side in the plane.
    pub normal: Option<Vector<N, D>>,
}

impl<N: Real, const D: usize> Default for Feature<N, D> {
    fn default() -> Self {
        Self {
            id: FeatureId::Face(0),
            vertices: SmallVec::new(),
            vertex_ids: SmallVec::new(),
            side_ids: SmallVec::new(),
            normal: None,
        }
    }
}

impl<N: Real, const D: usize> Feature<N, D> {
    /// Empties the feature, keeping its memory.
    pub fn clear(&mut self) {
        self.id = FeatureId::Face(0);
        self.vertices.clear();
        self.vertex_ids.clear();
        self.side_ids.clear();
        self.normal = None;
    }

    /// Makes it a single point.
    pub fn set_point(&mut self, id: FeatureId, point: Point<N, D>) {
        self.clear();
        self.id = id;
        self.vertices.push(point);
        self.vertex_ids.push(id);
    }

    /// Makes it a segment with the given names for itself and its ends.
    pub fn set_segment(&mut self, id: FeatureId, ends: [(FeatureId, Point<N, D>); 2]) {
        self.clear();
        self.id = id;
        for (end_id, end) in ends {
            self.vertices.push(end);
            self.vertex_ids.push(end_id);
        }
        self.side_ids.push(id);
    }
}
