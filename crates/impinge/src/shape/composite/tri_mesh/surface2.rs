//! The seam rule of filled triangles in 2D: the normals that their union admits at a side or a
//! vertex.

use super::TriMesh;
use crate::math::{Real, Vector, cross2, max_component};
use crate::shape::FeatureId;
use crate::shape::surface::seam::{is_flat, slack};

impl<N: Real> TriMesh<N, 2> {
    /// Implements [`Surface::admits`](crate::shape::Surface::admits) in 2D.
    pub(super) fn admits_2d(&self, part: u32, feature: FeatureId, normal: &Vector<N, 2>) -> bool {
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

    /// Returns the normal of the triangle's border side that is nearest to `normal`, if the angle
    /// between the two is less than a right angle. `None` if there is no such side, as for a
    /// triangle inside the shape.
    pub(super) fn snapped_2d(&self, part: u32, normal: &Vector<N, 2>) -> Option<Vector<N, 2>> {
        let open = (0..3).filter_map(|side| self.open_normal(part, side));
        let facing = open.filter(|own| own.dot(normal) > N::ZERO);
        facing.reduce(|best, own| if own.dot(normal) > best.dot(normal) { own } else { best })
    }

    /// Returns the outward unit normal of a side; `None` if a triangle lies beyond the side, or the
    /// triangle has no area.
    fn open_normal(&self, part: u32, side: usize) -> Option<Vector<N, 2>> {
        let outward = -self.inward(part, side)?;
        self.is_open_along(part, side, &outward).then_some(outward)
    }

    /// Returns whether, for each other triangle at a side, the direction from the side into the
    /// triangle has a component of at most zero along `direction`.
    fn is_open_along(&self, part: u32, side: usize, direction: &Vector<N, 2>) -> bool {
        let mut is_open = true;
        self.each_beyond(part, side, |_, inward| is_open &= inward.dot(direction) <= slack());
        is_open
    }

    /// Returns whether a side is on the border and has the outward normal `normal`. A zero-area
    /// triangle acts as a segment and may admit the normals on both of its sides.
    fn side_admits(&self, part: u32, side: usize, normal: &Vector<N, 2>) -> bool {
        match self.open_normal(part, side) {
            Some(own) => max_component(&(own - normal)) <= slack(),
            // A triangle without area is a segment; contacts arise on both its sides.
            None => {
                self.inward(part, side).is_none()
                    && (self.is_open_along(part, side, normal) || self.is_exposed(part, side))
            }
        }
    }

    /// Returns whether the corner admits `normal`: the directions of all sides away from the corner
    /// have components of at most zero along `normal`, and the two sides with the largest
    /// components, one to the left of `normal` and one to its right, do not form a straight border.
    fn corner_admits(&self, part: u32, corner: usize, normal: &Vector<N, 2>) -> bool {
        let joint = self.joint_ends(part, corner)[0];
        // To the left and to the right of `normal`: of the sides that leave the corner, the
        // direction with the largest component along `normal`; `-normal` until one is found.
        let (mut is_highest, mut highest) = (true, [-normal; 2]);
        for &triangle in self.topology.joints.parts(joint) {
            for along in self.leaving(triangle, joint) {
                is_highest &= along.dot(normal) <= slack();
                let best = &mut highest[usize::from(cross2(normal, &along) < N::ZERO)];
                *best = if along.dot(normal) > best.dot(normal) { along } else { *best };
            }
        }
        self.each_beyond_joint(joint, |_, inward| is_highest &= inward.dot(normal) <= slack());
        let [left, right] = highest;
        let is_straight = left.dot(&right) < N::ZERO && is_flat(cross2(&left, &right));
        is_highest && !is_straight
    }
}
