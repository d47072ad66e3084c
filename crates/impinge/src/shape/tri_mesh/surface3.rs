//! Surfaces in space: which normals a mesh has at a face, an edge or a vertex.

use super::super::seam::{Seam, is_level, slack};
use super::TriMesh;
use crate::math::{Point, Real, Vector, cross, max, max_component, unit, unit_or};
use crate::shape::FeatureId;

/// The unit normal on the side that sees the corners counter-clockwise; zero if they lie on a line.
pub(in crate::shape) fn normal_of<N: Real>(corners: &[Point<N, 3>; 3]) -> Vector<N, 3> {
    let squared = |at: usize| (corners[(at + 1) % 3] - corners[at]).norm_squared();
    let longer = |best: usize, at: usize| if squared(at) > squared(best) { at } else { best };
    let longest = longer(longer(0, 1), 2);
    // The two shorter sides lose least when multiplied.
    let tip = corners[(longest + 2) % 3];
    let sides = [corners[longest] - tip, corners[(longest + 1) % 3] - tip];
    let scale = max(max_component(&sides[0]), max_component(&sides[1])).power_of_two_below();
    let [first, second] = sides.map(|side| side / scale);
    let (Some((normal, area)), Some((_, length))) =
        (unit(&cross(&first, &second)), unit(&(second - first)))
    else {
        return Vector::<N, 3>::zeros();
    };
    // Below this height the difference of coordinates may be all rounding.
    let noise = N::lit(16.0) * N::EPSILON * length;
    let is_flat = area <= noise * length;
    if is_flat { Vector::<N, 3>::zeros() } else { normal }
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

    fn edge_admits(&self, part: u32, side: usize, normal: &Vector<N, 3>) -> bool {
        let mut seam = Seam::new();
        let mut add = |triangle: u32, side: usize| {
            if let Some(inward) = self.inward(triangle, side) {
                let cosine = self.cosine(triangle, normal);
                seam.add(inward.dot(normal), cosine, is_level(cosine));
            }
        };
        add(part, side);
        self.each_across(part, side, add);
        seam.admits(self.is_one_sided)
    }

    fn vertex_admits(&self, part: u32, corner: usize, normal: &Vector<N, 3>) -> bool {
        let joint = self.joint_ends(part, corner)[0];
        let mut seam = Seam::new();
        for &triangle in self.topology.joints.parts(joint) {
            let rise = self.rise_from(triangle, joint, normal);
            match self.normal(triangle) {
                Some(own) => seam.add(rise, own.dot(normal), is_level(own.dot(normal))),
                None => seam.add_rise(rise),
            }
        }
        seam.admits(self.is_one_sided)
    }

    /// How much the steeper of the two sides of a triangle that leave a joint rises along a unit
    /// vector.
    fn rise_from(&self, triangle: u32, joint: u32, normal: &Vector<N, 3>) -> N {
        let corners = self.corners(triangle);
        let at = (0..3).find(|&at| self.joint_ends(triangle, at)[0] == joint).unwrap_or(0);
        let rise = |turn: usize| {
            let side = corners[(at + turn) % 3] - corners[at];
            unit_or(&side, -normal).dot(normal)
        };
        max(rise(1), rise(2))
    }
}
