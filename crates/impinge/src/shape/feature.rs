//! Vertices, edges and faces: the features of a solid's surface, with the ids that contacts refer
//! to.

use smallvec::SmallVec;

use crate::math::{Point, Real, Vector};

/// The id of a feature of a solid's surface.
///
/// In 2D a polygon has vertices and faces (its sides), no edges. Curved surfaces are faces too,
/// except on capsules and tapered capsules: there the round ends are vertices and the side is
/// `Edge(0)`, also in 2D. A rounded solid has the features of the solid inside. Each shape
/// documents its numbering.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::{Ray, RayCast};
/// use impinge::dim3::shape::{ConvexPolyhedron, Cuboid, FeatureId};
///
/// let cube = Cuboid::new(Vector::repeat(1.0_f32));
/// let ray = Ray::new(Point::new(-5.0, 0.5, 0.5), Vector::x());
/// let hit = cube.toi_and_normal_with_ray(&Isometry::identity(), &ray, true).expect("ahead");
/// assert!(matches!(hit.feature, FeatureId::Face(_)));
/// assert_eq!(cube.feature_normal(hit.feature), hit.normal);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FeatureId {
    /// A corner, by its index.
    Vertex(u32),
    /// An edge between two faces, by its index: a straight side or a circular rim.
    Edge(u32),
    /// A flat or curved face, by its index.
    Face(u32),
}

impl FeatureId {
    /// Returns the id of a flat feature with the dimension `dimension` of a solid in `D`
    /// dimensions. Dimension 0 is a vertex, dimension `D - 1` a face, any other an edge.
    pub(crate) const fn flat<const D: usize>(dimension: usize, index: u32) -> Self {
        if dimension == 0 {
            Self::Vertex(index)
        } else if dimension + 1 == D {
            Self::Face(index)
        } else {
            Self::Edge(index)
        }
    }

    /// Returns the kind of the id that [`Self::flat`] returns for `dimension`, as a word for
    /// messages.
    pub(super) const fn word<const D: usize>(dimension: usize) -> &'static str {
        match Self::flat::<D>(dimension, 0) {
            Self::Vertex(_) => "vertex",
            Self::Edge(_) => "edge",
            Self::Face(_) => "face",
        }
    }
}

/// The supporting feature, for some direction, of a solid's core (the solid without its radius): a
/// point, a segment or a flat convex polygon.
///
/// Coordinates are in the local frame of the solid.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::shape::{ConvexPolyhedron, Cuboid, Feature};
///
/// let (cube, mut top) = (Cuboid::new(Vector::repeat(1.0_f32)), Feature::default());
/// cube.support_face_toward(&Vector::y(), &mut top);
/// assert_eq!((top.vertices.len(), top.normal), (4, Some(Vector::y())));
/// assert!(top.vertices.iter().all(|corner| corner.y == 1.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Feature<N: Real, const D: usize> {
    /// The id of the feature.
    pub id: FeatureId,
    /// One point for a vertex, two for a segment, more for a polygon. In 3D a polygon runs
    /// counter-clockwise seen from outside; a side in 2D has the solid on its left.
    pub vertices: SmallVec<[Point<N, D>; 8]>,
    /// The id of each vertex.
    pub vertex_ids: SmallVec<[FeatureId; 8]>,
    /// The id of the side from each vertex to the next: one for a segment, none for a point.
    pub side_ids: SmallVec<[FeatureId; 8]>,
    /// The outward unit normal of a polygon in 3D or a side in 2D; `None` for other features.
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
    /// Clears the feature, keeping its allocations.
    pub fn clear(&mut self) {
        self.id = FeatureId::Face(0);
        self.vertices.clear();
        self.vertex_ids.clear();
        self.side_ids.clear();
        self.normal = None;
    }

    /// Makes the feature a single point.
    pub fn set_point(&mut self, id: FeatureId, point: Point<N, D>) {
        self.clear();
        self.id = id;
        self.vertices.push(point);
        self.vertex_ids.push(id);
    }

    /// Makes the feature a segment with the given ids for itself and its ends.
    pub fn set_segment(&mut self, id: FeatureId, ends: [(FeatureId, Point<N, D>); 2]) {
        self.clear();
        self.id = id;
        for (end_id, end) in ends {
            self.vertices.push(end);
            self.vertex_ids.push(end_id);
        }
        self.side_ids.push(id);
    }

    /// Appends a vertex and its id.
    #[inline]
    pub(super) fn push(&mut self, id: FeatureId, vertex: Point<N, D>) {
        self.vertices.push(vertex);
        self.vertex_ids.push(id);
    }

    /// Removes each vertex that equals the next one, and the side between them. A polygon without
    /// width becomes a segment, and a polygon without extent becomes a point. Both lose the normal
    /// and take the id of the remaining side or vertex.
    pub(super) fn drop_repeated(&mut self) {
        let mut at = self.vertices.len();
        while at > 0 && self.vertices.len() > 1 {
            at -= 1;
            let next = if at + 1 < self.vertices.len() { at + 1 } else { 0 };
            if self.vertices[at] == self.vertices[next] {
                self.drop_vertex(at);
            }
        }
    }

    /// Removes the vertex `at` and the side from it to the next vertex.
    fn drop_vertex(&mut self, at: usize) {
        self.vertices.remove(at);
        self.vertex_ids.remove(at);
        if at < self.side_ids.len() {
            self.side_ids.remove(at);
        }
        self.rename_collapsed();
    }

    /// Updates a feature that has lost vertices: with one or two vertices left, it takes the id of
    /// that point or segment and loses the normal.
    fn rename_collapsed(&mut self) {
        match self.vertices.len() {
            1 => {
                self.id = self.vertex_ids[0];
                self.side_ids.clear();
                self.normal = None;
            }
            2 => {
                self.id = self.side_ids[0];
                self.side_ids.truncate(1);
                self.normal = None;
            }
            _ => (),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_without_width_becomes_a_segment() {
        let mut feature = Feature::<f32, 2>::default();
        for (index, x) in [(0, 1.0), (1, 1.0), (2, -1.0), (3, -1.0)] {
            feature.push(FeatureId::Vertex(index), Point::<f32, 2>::new(x, 0.0));
            feature.side_ids.push(FeatureId::Edge(index));
        }
        feature.drop_repeated();
        assert_eq!(feature.vertices.len(), 2, "{feature:?}");
        assert_eq!(feature.vertices.len(), feature.vertex_ids.len(), "each has an id");
        assert_eq!(feature.side_ids.as_slice(), [feature.id], "one side, the segment itself");
        assert!(matches!(feature.id, FeatureId::Edge(1 | 3)), "a side with a length: {feature:?}");
    }

    #[test]
    fn a_polygon_without_extent_becomes_a_point() {
        let mut feature = Feature::<f32, 2>::default();
        for index in 0..4 {
            feature.push(FeatureId::Vertex(index), Point::<f32, 2>::new(2.0, 3.0));
            feature.side_ids.push(FeatureId::Edge(index));
        }
        feature.drop_repeated();
        assert_eq!((feature.vertices.len(), feature.side_ids.len()), (1, 0), "{feature:?}");
        assert_eq!(feature.id, feature.vertex_ids[0], "the id of its vertex");
    }
}
