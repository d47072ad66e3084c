//! The features of polytopes, in any dimension.

use crate::math::{Point, Real, Vector, unit, unit_or};
use crate::shape::polytope::count32;
use crate::shape::tilt::Tilt;
use crate::shape::{
    ConvexPolyhedron, FaceRing, Feature, FeatureId, Polytope, SideOrVertex, SupportMap,
};

/// A supporting feature: the index of a face, a side or a vertex.
#[derive(Clone, Copy, Debug)]
enum HullPart {
    Face(u32),
    Side(u32),
    Vertex(usize),
}

/// The two ends of an edge, each with its id.
type EdgeEnds<N, const D: usize> = [(FeatureId, Point<N, D>); 2];

impl<N: Real, const D: usize> Polytope<N, D> {
    /// Applies the rule of [`SupportMap::core_feature`] with the limit `tilt`; returns the
    /// supporting feature.
    fn part_toward(&self, direction: &Vector<N, D>, tilt: Tilt<N>) -> HullPart {
        let vertex = self.support_vertex(direction);
        let Some((side, slope)) = self.flattest_side(vertex, direction) else {
            return HullPart::Vertex(vertex);
        };
        let face = self.most_aligned(self.side(side).faces.into_iter(), direction);
        if tilt.admits_face(&self.faces[face as usize].normal, direction) {
            HullPart::Face(face)
        } else if tilt.admits(slope * slope) {
            HullPart::Side(side)
        } else {
            HullPart::Vertex(vertex)
        }
    }

    /// Returns the id of the vertex, side or face on which a surface point lies, up to `tolerance`
    /// from a side and twice that from a vertex. Only the supporting feature for the unit vector
    /// `direction`, and its sides and vertices, are considered.
    pub(crate) fn part_at(
        &self,
        point: &Point<N, D>,
        direction: &Vector<N, D>,
        tolerance: N,
    ) -> FeatureId {
        match self.part_toward(direction, Tilt::default_limit()) {
            HullPart::Vertex(vertex) => FeatureId::Vertex(count32(vertex)),
            HullPart::Side(side) => self
                .end_at(&self.side(side).vertices, point, tolerance)
                .unwrap_or(Self::side_id(side)),
            HullPart::Face(index) => {
                let face = &self.faces[index as usize];
                let end = self.end_at(self.face_vertices(face), point, tolerance);
                let side = || {
                    let mut sides = self.face_sides(face).iter();
                    sides.find(|&&side| self.is_on_side(side, point, tolerance)).copied()
                };
                end.or_else(|| side().map(Self::side_id)).unwrap_or(FeatureId::Face(index))
            }
        }
    }

    /// Returns the id of the first of `vertices` within `2 · tolerance` of a point; `None` if there
    /// is none.
    fn end_at(&self, vertices: &[u32], point: &Point<N, D>, tolerance: N) -> Option<FeatureId> {
        let near = N::lit(4.0) * tolerance * tolerance;
        let is_near =
            |&&vertex: &&u32| (point - self.vertices[vertex as usize]).norm_squared() <= near;
        vertices.iter().find(is_near).map(|&vertex| FeatureId::Vertex(vertex))
    }

    /// Returns whether a point lies within `tolerance` of the line through a side.
    fn is_on_side(&self, side: u32, point: &Point<N, D>, tolerance: N) -> bool {
        let [a, b] = self.side(side).vertices.map(|end| self.vertices[end as usize]);
        let (along, arm) = (b - a, point - a);
        let aside = arm - along * (along.dot(&arm) / along.norm_squared());
        aside.norm_squared() <= tolerance * tolerance
    }

    /// Returns the side at a vertex with the smallest slope along the unit vector `direction`, and
    /// the sine of that slope. `None` if no side ends at the vertex.
    fn flattest_side(&self, vertex: usize, direction: &Vector<N, D>) -> Option<(u32, N)> {
        let mut best: Option<(u32, N)> = None;
        for (side, along) in self.fan_along(vertex) {
            let slope = along.map_or(N::ONE, |along| along.dot(direction).abs());
            if best.is_none_or(|(_, least)| slope < least) {
                best = Some((side, slope));
            }
        }
        best
    }

    /// Returns the face whose normal is most aligned with `direction`, the first if there are
    /// several; 0 if `faces` is empty.
    fn most_aligned(&self, faces: impl Iterator<Item = u32>, direction: &Vector<N, D>) -> u32 {
        let along = |face: u32| self.faces[face as usize].normal.dot(direction);
        faces.reduce(|best, face| if along(face) > along(best) { face } else { best }).unwrap_or(0)
    }

    /// Writes the feature `part` to `out`.
    fn fill(&self, part: HullPart, out: &mut Feature<N, D>) {
        match part {
            HullPart::Face(face) => self.fill_face(face, out),
            HullPart::Side(side) => out.set_segment(Self::side_id(side), self.ends(side)),
            HullPart::Vertex(vertex) => {
                out.set_point(FeatureId::Vertex(count32(vertex)), self.vertices[vertex]);
            }
        }
    }

    /// Returns the id of the feature `part`.
    fn id_of(part: HullPart) -> FeatureId {
        match part {
            HullPart::Face(face) => FeatureId::Face(face),
            HullPart::Side(side) => Self::side_id(side),
            HullPart::Vertex(vertex) => FeatureId::Vertex(count32(vertex)),
        }
    }

    /// Writes face `index` to `out`; in 2D as a segment with a normal.
    fn fill_face(&self, index: u32, out: &mut Feature<N, D>) {
        let face = &self.faces[index as usize];
        out.clear();
        out.id = FeatureId::Face(index);
        for &vertex in self.face_vertices(face) {
            out.push(FeatureId::Vertex(vertex), self.vertices[vertex as usize]);
        }
        let sides = self.face_sides(face);
        // In 2D a side is one segment, not a loop of two.
        let count = if sides.len() == 2 { 1 } else { sides.len() };
        for &side in &sides[..count] {
            out.side_ids.push(Self::side_id(side));
        }
        out.normal = Some(face.normal);
    }

    /// Returns the id and the ends of a feature with two vertices; `None` for any other feature.
    fn ends_of(&self, part: HullPart) -> Option<(FeatureId, EdgeEnds<N, D>)> {
        match part {
            HullPart::Side(side) => Some((Self::side_id(side), self.ends(side))),
            HullPart::Face(face) => {
                let [from, to] = *self.face_vertices(&self.faces[face as usize]) else {
                    return None;
                };
                let with_id =
                    |vertex: u32| (FeatureId::Vertex(vertex), self.vertices[vertex as usize]);
                Some((FeatureId::Face(face), [with_id(from), with_id(to)]))
            }
            HullPart::Vertex(_) => None,
        }
    }

    fn ends(&self, side: u32) -> EdgeEnds<N, D> {
        let ends = self.side(side).vertices;
        ends.map(|vertex| (FeatureId::Vertex(vertex), self.vertices[vertex as usize]))
    }

    /// Returns the unit vector along the sum of the normals of the given faces; the normal of face
    /// 0 if the sum is zero.
    fn mean_normal(&self, faces: impl Iterator<Item = u32>) -> Vector<N, D> {
        let normals = faces.map(|face| self.faces[face as usize].normal);
        let first = self.faces[0].normal;
        let sum = normals.fold(Vector::<N, D>::zeros(), |sum, normal| sum + normal);
        unit_or(&sum, first)
    }

    #[track_caller]
    fn index_of(id: FeatureId, dimension: usize, count: usize) -> u32 {
        let (FeatureId::Vertex(index) | FeatureId::Edge(index) | FeatureId::Face(index)) = id;
        let is_there = (index as usize) < count && id == FeatureId::flat::<D>(dimension, index);
        assert!(is_there, "the solid has no {} named {id:?}", FeatureId::word::<D>(dimension));
        index
    }

    #[track_caller]
    fn side_index(&self, id: FeatureId) -> u32 {
        let count = if self.edges.is_empty() { self.faces.len() } else { self.edges.len() };
        Self::index_of(id, 1, count)
    }
}

impl<N: Real> Polytope<N, 2> {
    /// Implements [`SideOrVertex::of`] for polygons.
    pub(in crate::shape) fn supporting(&self, direction: &Vector<N, 2>) -> SideOrVertex<N> {
        if let ([vertices], [planes]) = (self.blocks(), self.planes())
            && self.faces.len() == self.vertices.len()
        {
            return self.supporting_of_few(vertices, &planes.normals, direction);
        }
        let part = self.part_toward(direction, Tilt::default_limit());
        if let Some((id, ends)) = self.ends_of(part) {
            return SideOrVertex::side(id, ends);
        }
        let vertex = if let HullPart::Vertex(vertex) = part { vertex } else { 0 };
        SideOrVertex::vertex(FeatureId::Vertex(count32(vertex)), self.vertices[vertex])
    }

    /// Implements [`Self::supporting`] for up to 8 vertices. Applies the rule of
    /// [`Self::part_toward`] to rows of coordinates and normals, without the lists of sides.
    fn supporting_of_few(
        &self,
        [xs, ys]: &[[N; 8]; 2],
        normals: &[[N; 8]; 2],
        direction: &Vector<N, 2>,
    ) -> SideOrVertex<N> {
        let count = self.vertices.len().min(8);
        let at = |vertex: usize| Point::<N, 2>::new(xs[vertex], ys[vertex]);
        let height = |vertex: usize| xs[vertex] * direction.x + ys[vertex] * direction.y;
        let (mut vertex, mut highest) = (0, height(0));
        for next in 1..count {
            let candidate = height(next);
            if candidate > highest {
                (vertex, highest) = (next, candidate);
            }
        }
        let before = if vertex > 0 { vertex - 1 } else { count - 1 };
        let after = if vertex + 1 < count { vertex + 1 } else { 0 };
        let slope = |from: usize, to: usize| {
            let along = unit(&(at(to) - at(from)));
            along.map_or(N::ONE, |(along, _)| along.dot(direction).abs())
        };
        let (slope_before, slope_after) = (slope(before, vertex), slope(vertex, after));
        // If both slopes are equal, the side with the lower index is chosen.
        let is_after =
            if vertex > 0 { slope_after < slope_before } else { slope_after <= slope_before };
        let (side, to) = if is_after { (vertex, after) } else { (before, vertex) };
        let slope = if is_after { slope_after } else { slope_before };
        let normal = Vector::<N, 2>::new(normals[0][side], normals[1][side]);
        let (tilt, with_id) =
            (Tilt::default_limit(), |end: usize| (FeatureId::Vertex(count32(end)), at(end)));
        if tilt.admits_face(&normal, direction) || tilt.admits(slope * slope) {
            SideOrVertex::side(FeatureId::Face(count32(side)), [with_id(side), with_id(to)])
        } else {
            SideOrVertex::vertex(FeatureId::Vertex(count32(vertex)), at(vertex))
        }
    }
}

impl<N: Real> Polytope<N, 3> {
    /// Returns the id of the feature that [`SupportMap::core_feature`] writes.
    #[inline]
    pub(crate) fn supporting_part(&self, direction: &Vector<N, 3>) -> FeatureId {
        Self::id_of(self.part_toward(direction, Tilt::default_limit()))
    }

    /// Fills a blank ring with face `index`. Returns false if the face has fewer than 3 corners or
    /// more than a ring holds.
    pub(crate) fn fill_ring(&self, index: u32, ring: &mut FaceRing<N>) -> bool {
        let face = &self.faces[index as usize];
        let (vertices, sides) = (self.face_vertices(face), self.face_sides(face));
        if !(3..=FaceRing::<N>::MAX).contains(&vertices.len()) {
            return false;
        }
        (ring.id, ring.normal) = (FeatureId::Face(index), face.normal);
        for (&vertex, &side) in vertices.iter().zip(sides) {
            let ids = [FeatureId::Vertex(vertex), Self::side_id(side)];
            ring.push(&self.vertices[vertex as usize], ids);
        }
        true
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Polytope<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        self.vertices[self.support_vertex(direction)]
    }

    fn center(&self) -> Point<N, D> {
        self.center
    }

    fn reach(&self) -> N {
        self.reach
    }

    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        self.fill(self.part_toward(direction, Tilt::default_limit()), out);
    }
}

impl<N: Real, const D: usize> ConvexPolyhedron<N, D> for Polytope<N, D> {
    fn vertex(&self, id: FeatureId) -> Point<N, D> {
        self.vertices[Self::index_of(id, 0, self.vertices.len()) as usize]
    }

    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, D>); 2] {
        self.ends(self.side_index(id))
    }

    fn face(&self, id: FeatureId, out: &mut Feature<N, D>) {
        self.fill_face(Self::index_of(id, D - 1, self.faces.len()), out);
    }

    fn feature_normal(&self, id: FeatureId) -> Vector<N, D> {
        match id {
            FeatureId::Face(_) => {
                self.faces[Self::index_of(id, D - 1, self.faces.len()) as usize].normal
            }
            FeatureId::Edge(_) => {
                self.mean_normal(self.side(self.side_index(id)).faces.into_iter())
            }
            FeatureId::Vertex(_) => {
                // Each face at a vertex has two sides there, so each normal is summed twice.
                let fan = self.fan(Self::index_of(id, 0, self.vertices.len()) as usize);
                self.mean_normal(fan.iter().flat_map(|&side| self.side(side).faces))
            }
        }
    }

    fn support_face_toward(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        let all = (0_u32..).take(self.faces.len());
        self.fill_face(self.most_aligned(all, direction), out);
    }

    fn support_feature_toward(&self, direction: &Vector<N, D>, angle: N, out: &mut Feature<N, D>) {
        self.fill(self.part_toward(direction, Tilt::of_angle(angle)), out);
    }

    fn support_feature_id_toward(&self, direction: &Vector<N, D>) -> FeatureId {
        Self::id_of(self.part_toward(direction, Tilt::least()))
    }
}
