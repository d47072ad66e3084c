//! The seam rule of meshes in 3D: the normals admitted at a face, an edge or a vertex.

use super::TriMesh;
use super::around::rounding_error;
use crate::math::{Point, Real, Vector, cross, max, max_component, unit};
use crate::shape::solids::segment::length_of;
use crate::shape::surface::bend::{Bend, BendShape};
use crate::shape::surface::seam::{CornerEdges, Seam, is_across, slack};
use crate::shape::{FaceSeams, FeatureId};

/// Returns the unit normal on the side from which the corners run counter-clockwise; zero for a
/// triangle without area.
pub(in crate::shape) fn normal_of<N: Real>(corners: &[Point<N, 3>; 3]) -> Vector<N, 3> {
    let [a, b, c] = corners;
    let lengths = [length_of(&(b - a)), length_of(&(c - b)), length_of(&(a - c))];
    let longer = |best: usize, at: usize| if lengths[at] > lengths[best] { at } else { best };
    let longest = longer(longer(0, 1), 2);
    // The cross product of the two shorter sides has the smallest rounding error.
    let tip = corners[(longest + 2) % 3];
    let sides = [corners[longest] - tip, corners[(longest + 1) % 3] - tip];
    let scale = lengths[longest].power_of_two_below();
    let found = unit(&cross(&(sides[0] / scale), &(sides[1] / scale)));
    let height = |area: N| area * scale / (lengths[longest] / scale);
    let found = found.filter(|&(_, area)| height(area) > rounding_error(corners, lengths[longest]));
    found.map_or_else(Vector::<N, 3>::zeros, |(normal, _)| normal)
}

impl<N: Real> TriMesh<N, 3> {
    /// Implements [`Surface::admits`](crate::shape::Surface::admits) in 3D.
    pub(super) fn admits_3d(&self, part: u32, feature: FeatureId, normal: &Vector<N, 3>) -> bool {
        if self.keeps_internal_edges {
            return !self.is_one_sided || self.cosine(part, normal) >= -slack::<N>();
        }
        self.is_own_normal(part, normal)
            || match feature {
                FeatureId::Face(_) => self.normal(part).is_none(),
                FeatureId::Edge(side) => self.edge_admits(part, side as usize, normal),
                FeatureId::Vertex(corner) => {
                    self.vertex_admits(part, (corner as usize, false), normal)
                }
            }
    }

    /// Runs [`Self::admits_3d`] for two normals, for the second only if the first is rejected. At
    /// an edge, the edge angle is looked up once for both.
    pub(super) fn admits_in_turn_3d(
        &self,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, 3>; 2],
    ) -> [bool; 2] {
        let is_free = |normal: &Vector<N, 3>| self.is_own_normal(part, normal);
        match feature {
            FeatureId::Edge(side) if !(self.keeps_internal_edges || is_free(normals[0])) => {
                let bend = self.bend_at(part, side as usize);
                let admits = |normal: &Vector<N, 3>| {
                    self.bent_edge_admits(bend.as_ref(), part, side as usize, normal)
                };
                let is_first = admits(normals[0]);
                [is_first, !is_first && (is_free(normals[1]) || admits(normals[1]))]
            }
            _ => {
                let is_first = self.admits_3d(part, feature, normals[0]);
                [is_first, !is_first && self.admits_3d(part, feature, normals[1])]
            }
        }
    }

    /// Implements [`Surface::snapped`](crate::shape::Surface::snapped) in 3D; `None` for a triangle
    /// without area.
    pub(super) fn snapped_3d(&self, part: u32, normal: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let own = self.normal(part)?;
        let is_front = self.is_one_sided || own.dot(normal) >= N::ZERO;
        Some(if is_front { own } else { -own })
    }

    fn cosine(&self, triangle: u32, normal: &Vector<N, 3>) -> N {
        self.normals[triangle as usize].dot(normal)
    }

    /// Returns whether `normal` is the triangle's front normal or, on a mesh with two sides, its
    /// back normal.
    fn is_own_normal(&self, part: u32, normal: &Vector<N, 3>) -> bool {
        self.snapped_3d(part, normal).is_some_and(|own| max_component(&(own - normal)) <= slack())
    }

    fn edge_admits(&self, part: u32, side: usize, normal: &Vector<N, 3>) -> bool {
        self.bent_edge_admits(self.bend_at(part, side).as_ref(), part, side, normal)
    }

    /// Returns the edge angle of a side; `None` if it is uncertain, or if the side does not have
    /// exactly one neighbour whose front agrees.
    fn bend_at(&self, part: u32, side: usize) -> Option<Bend<N>> {
        let other = self.topology.single_across(part, side)?;
        let fronts = [part, other].map(|face| self.normals[face as usize]);
        let find = || {
            // If both triangles traverse the side in the same direction, their fronts disagree.
            // Then there is no edge angle, but the side may be a rim.
            let ends = self.joint_ends(part, side);
            let is_opposite = self
                .side_between(other, ends)
                .is_some_and(|entered| self.joint_ends(other, entered) != ends);
            let corners = [&self.corners(part), &self.corners(other)];
            BendShape::new(corners, &fronts).filter(|_| is_opposite)
        };
        Some(Bend::of(self.bends.at(part, side, find)?, fronts))
    }

    /// Returns whether the edge admits `normal`: `normal` is perpendicular to the edge, the
    /// directions from the edge into its faces have components of at most zero along `normal`, the
    /// faces do not continue each other flat, and on a one-sided mesh the face with the largest
    /// component has its front towards `normal`. An exposed side ([`Self::is_exposed`]) admits
    /// every perpendicular normal.
    fn bent_edge_admits(
        &self,
        bend: Option<&Bend<N>>,
        part: u32,
        side: usize,
        normal: &Vector<N, 3>,
    ) -> bool {
        if let Some(answer) = bend.and_then(|bend| bend.admits(normal, self.is_one_sided)) {
            return answer;
        }
        let corners = self.corners(part);
        let edge = corners[(side + 1) % 3] - corners[side];
        let mut seam = Seam::of_faces(self.normals[part as usize], normal).along(&edge);
        let mut add = |triangle: u32, inward: Vector<N, 3>| {
            seam.add_face(|direction| inward.dot(direction), &self.normals[triangle as usize]);
        };
        if let Some(inward) = self.inward(part, side) {
            add(part, inward);
        }
        self.each_beyond(part, side, add);
        is_across(&edge, normal) && (seam.admits(self.is_one_sided) || self.is_exposed(part, side))
    }

    /// Returns the larger of the components along `normal` of the unit vectors along the two sides
    /// of a triangle that leave a joint. `normal` has a length of at most 1. Returns −1, the least
    /// possible component, if neither side has a length.
    fn rise_from(&self, triangle: u32, joint: u32, normal: &Vector<N, 3>) -> N {
        let (corners, at) = (self.corners(triangle), self.corner_at(triangle, joint));
        let mut highest = -N::ONE;
        for turn in [1, 2] {
            if let Some((along, _)) = unit(&(corners[(at + turn) % 3] - corners[at])) {
                highest = max(highest, along.dot(normal));
            }
        }
        highest
    }

    /// Returns whether the surface admits `normal` at a corner; `normal` is not the normal of the
    /// triangle itself. `is_bent` is true if another triangle there is known not to be coplanar
    /// with this triangle.
    pub(super) fn vertex_admits(
        &self,
        part: u32,
        (corner, is_bent): (usize, bool),
        normal: &Vector<N, 3>,
    ) -> bool {
        let (joint, own) = (self.joint_at(part, corner), &self.normals[part as usize]);
        let around = self.topology.joints.parts(joint);
        match self.edges_around(part, corner, normal).admit((own, is_bent), self.is_one_sided) {
            Some(false) => return false,
            // The walk around the corner does not find triangles beyond a triangle without area. If
            // all triangles at the joint have an area, it has found all.
            Some(true) if around.iter().all(|&triangle| self.has_certain_area(triangle)) => {
                return true;
            }
            _ => {}
        }
        let mut seam = Seam::of_faces(*own, normal);
        for &triangle in around {
            let front = &self.normals[triangle as usize];
            seam.add_face(|direction| self.rise_from(triangle, joint, direction), front);
        }
        self.each_beyond_joint(joint, |triangle, inward| {
            seam.add_face(|direction| inward.dot(direction), &self.normals[triangle as usize]);
        });
        seam.admits(self.is_one_sided)
    }

    /// Collects the sides that leave a corner, the sides of `part` first; stops when they reject
    /// `normal`.
    fn edges_around<'n>(
        &self,
        part: u32,
        corner: usize,
        normal: &'n Vector<N, 3>,
    ) -> CornerEdges<'n, N, 3> {
        let (joint, mut edges) = (self.joint_at(part, corner), CornerEdges::new(normal));
        let mut look = |triangle: u32, at: usize| {
            let corners = self.corners(triangle);
            for turn in [1, 2] {
                edges.add(&(corners[(at + turn) % 3] - corners[at]));
            }
            edges.is_refused()
        };
        if !look(part, corner) {
            let mut around = self.topology.joints.parts(joint).iter();
            around.any(|&other| other != part && look(other, self.corner_at(other, joint)));
        }
        edges
    }

    /// Implements
    /// [`OwnSurface::face_seams`](crate::shape::surface::own_surface::OwnSurface::face_seams).
    pub(super) fn face_seams_3d(&self, part: u32) -> Option<FaceSeams<N>> {
        let front = self.normal(part).filter(|_| !self.keeps_internal_edges)?;
        let (bend, is_rim) =
            (|side| self.bend_at(part, side), |side| self.topology.is_border(part, side));
        Some(FaceSeams::new(front, self.is_one_sided, bend, is_rim))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::xorshift::Xorshift;
    use crate::shape::Surface;
    use crate::shape::surface::own_surface::OwnSurface;

    /// Returns a mesh of a grid with random heights.
    fn rough_mesh(random: &mut Xorshift) -> TriMesh<f64, 3> {
        let position = |at: u32| {
            let [x, z] = [at % 6, at / 6].map(f64::from);
            Point::<f64, 3>::new(x, 0.4 * random.next(), z)
        };
        let vertices = (0..36).map(position).collect();
        let cells = (0..30).filter(|at| at % 6 < 5);
        let triangles = cells.flat_map(|at| [[at, at + 6, at + 7], [at, at + 7, at + 1]]);
        TriMesh::new(vertices, triangles.collect())
    }

    #[test]
    fn two_normals_in_turn_are_as_each_alone() {
        let (mut random, mut counts) = (Xorshift(5), [0; 3]);
        let (rough, other) = (rough_mesh(&mut random), rough_mesh(&mut random).one_sided());
        let kept = rough_mesh(&mut random).one_sided().with_internal_edges_kept();
        for mesh in [rough, other, kept] {
            for (part, at) in (0..50_u32).flat_map(|part| (0..90_u32).map(move |at| (part, at))) {
                let front = mesh.normal(part).expect("an area");
                let aside: Vector<f64, 3> = random.vector(0.6);
                let share = [0.0, 1.0, 1.0][at as usize % 3];
                let far = (front + aside * share).normalize();
                let near = (front + aside * 0.03).normalize();
                let number = at / 3 % 3;
                let all = [FeatureId::Edge(number), FeatureId::Vertex(number), FeatureId::Face(0)];
                let feature = all[at as usize / 9 % 3];
                let [first, second] = [far, near].map(|n| mesh.admits(part, feature, &n));
                let both = mesh.admits_in_turn(part, feature, [&far, &near]);
                assert_eq!(both, [first, !first && second], "part {part}, {feature:?}");
                counts[if first { 0 } else { 1 + usize::from(second) }] += 1;
            }
        }
        assert!(counts.iter().all(|&count| count > 100), "all cases occur: {counts:?}");
    }
}
