//! Filled triangles in the plane: which normals their union has at a side or a vertex.

use super::super::seam::{is_flat, slack};
use super::TriMesh;
use crate::math::{Real, Vector, cross2, max_component, unit};
use crate::shape::FeatureId;

impl<N: Real> TriMesh<N, 2> {
    pub(super) fn admits_in_plane(
        &self,
        part: u32,
        feature: FeatureId,
        normal: &Vector<N, 2>,
    ) -> bool {
        if self.keeps_internal_edges {
            return true;
        }
        match feature {
            FeatureId::Face(side) | FeatureId::Edge(side) => {
                self.side_admits(part, side as usize, normal)
            }
            FeatureId::Vertex(corner) => {
                let corner = corner as usize;
                self.side_admits(part, corner, normal)
                    || self.side_admits(part, (corner + 2) % 3, normal)
                    || self.corner_admits(part, corner, normal)
            }
        }
    }

    /// The normal on the side that the whole shape has as its border and that is nearest to the
    /// one given, if within a right angle; `None` inside.
    pub(super) fn snapped_in_plane(
        &self,
        part: u32,
        normal: &Vector<N, 2>,
    ) -> Option<Vector<N, 2>> {
        let open = (0..3).filter_map(|side| self.open_normal(part, side));
        let facing = open.filter(|own| own.dot(normal) > N::ZERO);
        facing.reduce(|best, own| if own.dot(normal) > best.dot(normal) { own } else { best })
    }

    /// The outward normal of a side, if no triangle lies on its other side.
    fn open_normal(&self, part: u32, side: usize) -> Option<Vector<N, 2>> {
        let outward = -self.inward(part, side)?;
        self.is_open_along(part, side, &outward).then_some(outward)
    }

    /// No other triangle at a side lies on the side of it that a direction points to.
    fn is_open_along(&self, part: u32, side: usize, direction: &Vector<N, 2>) -> bool {
        let mut is_open = true;
        self.each_across(part, side, |other, side| {
            let rises = |inward: Vector<N, 2>| inward.dot(direction) > slack();
            is_open &= !self.inward(other, side).is_some_and(rises);
        });
        is_open
    }

    fn side_admits(&self, part: u32, side: usize, normal: &Vector<N, 2>) -> bool {
        match self.open_normal(part, side) {
            Some(own) => max_component(&(own - normal)) <= slack(),
            // Without area it is a segment, which has both sides.
            None => self.inward(part, side).is_none() && self.is_open_along(part, side, normal),
        }
    }

    /// No side that leaves the corner rises along the normal, and they do not form a straight
    /// border.
    fn corner_admits(&self, part: u32, corner: usize, normal: &Vector<N, 2>) -> bool {
        let joint = self.joint_ends(part, corner)[0];
        let (mut is_highest, mut has_left, mut has_right) = (true, false, false);
        for &triangle in self.topology.joints.parts(joint) {
            for along in self.leaving(triangle, joint) {
                let rise = along.dot(normal);
                is_highest &= rise <= slack();
                let is_left = cross2(normal, &along) > N::ZERO;
                has_left |= is_flat(rise) && is_left;
                has_right |= is_flat(rise) && !is_left;
            }
        }
        is_highest && !(has_left && has_right)
    }

    /// Unit, along the sides of a triangle that leave a joint.
    fn leaving(&self, triangle: u32, joint: u32) -> impl Iterator<Item = Vector<N, 2>> + use<N> {
        let corners = self.corners(triangle);
        let at = (0..3).find(|&at| self.joint_ends(triangle, at)[0] == joint).unwrap_or(0);
        let side = move |turn: usize| unit(&(corners[(at + turn) % 3] - corners[at]));
        [1, 2].into_iter().filter_map(side).map(|(along, _)| along)
    }
}
