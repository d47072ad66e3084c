//! Surfaces in space: which normals a mesh has at a face, an edge or a vertex.

use super::super::bend::{Bend, Shape};
use super::super::seam::{Seam, is_across, leads_up_clearly, slack};
use super::super::segment::length_of;
use super::TriMesh;
use super::around::noise;
use crate::math::{Point, Real, Vector, cross, max, max_component, unit};
use crate::shape::FeatureId;

/// The unit normal on the side that sees the corners counter-clockwise; zero without area.
pub(in crate::shape) fn normal_of<N: Real>(corners: &[Point<N, 3>; 3]) -> Vector<N, 3> {
    let [a, b, c] = corners;
    let lengths = [b - a, c - b, a - c].map(|side| length_of(&side));
    let longer = |best: usize, at: usize| if lengths[at] > lengths[best] { at } else { best };
    let longest = longer(longer(0, 1), 2);
    // The two shorter sides lose least when multiplied.
    let tip = corners[(longest + 2) % 3];
    let sides = [corners[longest] - tip, corners[(longest + 1) % 3] - tip];
    let scale = lengths[longest].power_of_two_below();
    let [first, second] = sides.map(|side| side / scale);
    let found = unit(&cross(&first, &second));
    let height = |area: N| area * scale / (lengths[longest] / scale);
    let found = found.filter(|&(_, area)| height(area) > noise(corners, lengths[longest]));
    found.map_or_else(Vector::<N, 3>::zeros, |(normal, _)| normal)
}

impl<N: Real> TriMesh<N, 3> {
    pub(super) fn admits_in_space(
        &self,
        part: u32,
        feature: FeatureId,
        normal: &Vector<N, 3>,
    ) -> bool {
        if self.keeps_internal_edges {
            return !self.is_one_sided || self.cosine(part, normal) >= -slack::<N>();
        }
        self.is_own_normal(part, normal)
            || match feature {
                FeatureId::Face(_) => self.normal(part).is_none(),
                FeatureId::Edge(side) => self.edge_admits(part, side as usize, normal),
                FeatureId::Vertex(corner) => self.vertex_admits(part, corner as usize, normal),
            }
    }

    pub(super) fn snapped_in_space(
        &self,
        part: u32,
        normal: &Vector<N, 3>,
    ) -> Option<Vector<N, 3>> {
        let own = self.normal(part)?;
        let is_front = self.is_one_sided || own.dot(normal) >= N::ZERO;
        Some(if is_front { own } else { -own })
    }

    fn cosine(&self, triangle: u32, normal: &Vector<N, 3>) -> N {
        self.normals[triangle as usize].dot(normal)
    }

    /// The normal of the triangle, on a side that it has.
    fn is_own_normal(&self, part: u32, normal: &Vector<N, 3>) -> bool {
        self.snapped_in_space(part, normal)
            .is_some_and(|own| max_component(&(own - normal)) <= slack())
    }

    /// The edge is perpendicular to the normal, no face at it rises along the normal, and the faces
    /// are not flat there.
    fn edge_admits(&self, part: u32, side: usize, normal: &Vector<N, 3>) -> bool {
        let other = self.topology.single_across(part, side);
        let bend = other.and_then(|other| {
            let fronts = [part, other].map(|face| self.normals[face as usize]);
            let find = || Shape::new([&self.corners(part), &self.corners(other)], &fronts);
            Some(Bend::of(self.bends.at(part, side, find)?, fronts))
        });
        if let Some(answer) = bend.and_then(|bend| bend.admits(normal, self.is_one_sided)) {
            return answer;
        }
        let mut seam = Seam::of_faces(self.normals[part as usize], normal);
        let mut add = |triangle: u32, inward: Vector<N, 3>| {
            seam.add_face(inward.dot(normal), &self.normals[triangle as usize]);
        };
        if let Some(inward) = self.inward(part, side) {
            add(part, inward);
        }
        self.each_beyond(part, side, add);
        let corners = self.corners(part);
        let edge = corners[(side + 1) % 3] - corners[side];
        is_across(&edge, normal) && seam.admits(self.is_one_sided)
    }

    /// How much the steeper of the two sides of a triangle that leave a joint rises along a unit vector.
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

    /// No side that leaves the corner rises along the normal, and the faces are not flat there.
    fn vertex_admits(&self, part: u32, corner: usize, normal: &Vector<N, 3>) -> bool {
        let joint = self.joint_at(part, corner);
        // Most are refused by a side of the triangle that is asked.
        let rises = |triangle: u32, at: usize| {
            let corners = self.corners(triangle);
            corners.iter().any(|other| leads_up_clearly(&(other - corners[at]), normal))
        };
        let mut around = self.topology.joints.parts(joint).iter();
        if rises(part, corner) || around.any(|&other| rises(other, self.corner_at(other, joint))) {
            return false;
        }
        let mut seam = Seam::of_faces(self.normals[part as usize], normal);
        for &triangle in self.topology.joints.parts(joint) {
            let rise = self.rise_from(triangle, joint, normal);
            seam.add_face(rise, &self.normals[triangle as usize]);
        }
        self.each_beyond_joint(joint, |triangle, inward| {
            seam.add_face(inward.dot(normal), &self.normals[triangle as usize]);
        });
        seam.admits(self.is_one_sided)
    }
}
