//! Going around the sides and corners of a mesh.
//!
//! Triangles without area lie in meshes as fillers: where a corner touches the middle of a longer
//! side, a thin triangle joins the three. Seams are looked at through them, as if they were not there.

use smallvec::SmallVec;

use super::TriMesh;
use crate::math::{Point, Real, Vector, filled, max, max_component, unit, unit_or};
use crate::shape::solids::segment::length_of;

/// So many sides of triangles without area are crossed in search of what lies beyond.
const MAX_CROSSED: usize = 32;
/// A triangle with a squared height of more than this, of its longest side, is tall.
const TALL: f64 = 1.0 / 1024.0;

impl<N: Real, const D: usize> TriMesh<N, D> {
    /// Calls `visit` with each other triangle at a side, and the side it is to that one.
    fn each_across(&self, triangle: u32, side: usize, mut visit: impl FnMut(u32, usize)) {
        let ends = self.joint_ends(triangle, side);
        let mut found = |other: u32| {
            if let Some(side) = self.side_between(other, ends) {
                visit(other, side);
            }
        };
        if let Some(other) = self.topology.single_across(triangle, side) {
            found(other);
        } else if self.topology.has_several_across(triangle, side) {
            // All are at both ends: the end with fewer triangles is looked through.
            let [from, to] = ends.map(|joint| self.topology.joints.parts(joint));
            let fewer = if from.len() < to.len() { from } else { to };
            fewer.iter().filter(|&&other| other != triangle).for_each(|&other| found(other));
        }
    }

    /// Calls `visit` with each other triangle with an area at a side, and the direction from the
    /// side into it; through triangles without area. All sides of one without area are one side.
    pub(super) fn each_beyond(
        &self,
        triangle: u32,
        side: usize,
        mut visit: impl FnMut(u32, Vector<N, D>),
    ) {
        let is_thin = self.inward(triangle, side).is_none();
        let own = (0..3).filter(|&other| is_thin || other == side);
        let mut crossed: SmallVec<[_; 4]> = own.map(|side| (triangle, side)).collect();
        let mut at = 0;
        while let Some(&(from, side)) = crossed.get(at) {
            at += 1;
            self.each_across(from, side, |other, entered| match self.inward(other, entered) {
                Some(inward) if other != triangle => visit(other, inward),
                Some(_) => (),
                None => {
                    let exits = [1, 2].map(|turn| (other, (entered + turn) % 3));
                    let is_new = |exit: &(u32, usize)| !crossed_before(&crossed, exit);
                    let new: SmallVec<[_; 2]> = exits.into_iter().filter(is_new).collect();
                    crossed.extend(new);
                }
            });
        }
    }

    /// Calls `visit` with each triangle on whose side a joint lies though it is none of its
    /// corners, and the direction from the side into it: those beyond a triangle without area whose
    /// middle corner is at the joint.
    pub(super) fn each_beyond_joint(&self, joint: u32, mut visit: impl FnMut(u32, Vector<N, D>)) {
        for &triangle in self.topology.joints.parts(joint) {
            let at = self.corner_at(triangle, joint);
            let opposite = (at + 1) % 3;
            let has_area = self.is_plain(triangle) || self.inward(triangle, opposite).is_some();
            if has_area {
                continue;
            }
            let leaving = self.leaving(triangle, joint);
            let is_middle = leaving.len() == 2 && leaving[0].dot(&leaving[1]) < N::ZERO;
            if is_middle {
                self.each_beyond(triangle, opposite, &mut visit);
            }
        }
    }

    /// The triangle is so tall for its size that nobody doubts its area; not known of all.
    fn is_plain(&self, triangle: u32) -> bool {
        self.bends.is_plain(triangle, || is_tall(&self.corners(triangle)))
    }

    /// Unit, along the sides of a triangle that leave a joint.
    pub(super) fn leaving(&self, triangle: u32, joint: u32) -> SmallVec<[Vector<N, D>; 2]> {
        let (corners, at) = (self.corners(triangle), self.corner_at(triangle, joint));
        let side = |turn: usize| unit(&(corners[(at + turn) % 3] - corners[at]));
        [1, 2].into_iter().filter_map(side).map(|(along, _)| along).collect()
    }

    /// The first corner of a triangle that is at a joint.
    pub(super) fn corner_at(&self, triangle: u32, joint: u32) -> usize {
        (0..3).find(|&at| self.joint_at(triangle, at) == joint).unwrap_or(0)
    }

    /// Unit, in the triangle's plane, from a side towards the opposite corner; `None` without area.
    pub(super) fn inward(&self, triangle: u32, side: usize) -> Option<Vector<N, D>> {
        let corners = self.corners(triangle);
        inward_of(&filled(|turn| corners[(side + turn) % 3]))
    }
}

/// Unit, in the plane of a triangle, from the side between its first two corners towards the third;
/// `None` without area.
pub(in crate::shape) fn inward_of<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
) -> Option<Vector<N, D>> {
    let [a, b, c] = corners;
    let (along, length) = unit(&(b - a))?;
    let (from_a, from_b) = (length_of(&(c - a)), length_of(&(c - b)));
    let rest = if from_a < from_b { c - a } else { c - b };
    let without = |v: &Vector<N, D>| v - along * along.dot(v);
    let (inward, height) = unit(&without(&rest))?;
    // That of the longest side is the least, and says whether there is an area.
    let longest = max(length, max(from_a, from_b));
    let least = height * (length / longest);
    let has_area = least > noise(corners, longest);
    has_area.then(|| unit_or(&without(&inward), inward))
}

/// The height over the longest side is far more than what counts as an area, see [`inward_of`].
fn is_tall<N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> bool {
    let [a, b, c] = corners;
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let longest = max(ab.norm_squared(), max(ac.norm_squared(), bc.norm_squared()));
    // Four squared areas.
    let along = ab.dot(&ac);
    let area = ab.norm_squared() * ac.norm_squared() - along * along;
    let farthest = corners.iter().map(|corner| max_component(&corner.coords)).fold(N::ZERO, max);
    let unsure = N::lit(4096.0) * N::EPSILON * farthest;
    area > N::lit(TALL) * longest * longest
        && longest > unsure * unsure
        && area > N::MIN_POSITIVE / N::EPSILON
}

/// Whether a side is in the list, or the list is full.
fn crossed_before(crossed: &[(u32, usize)], side: &(u32, usize)) -> bool {
    crossed.len() >= MAX_CROSSED || crossed.contains(side)
}

/// Below this height over its longest side a triangle has no area: the difference of coordinates,
/// or the rounding of the coordinates themselves, may be all there is.
pub(super) fn noise<N: Real, const D: usize>(corners: &[Point<N, D>; 3], longest: N) -> N {
    let mut farthest = N::ZERO;
    for corner in corners {
        farthest = max(farthest, max_component(&corner.coords));
    }
    N::EPSILON * max(N::lit(16.0) * longest, N::TWO * farthest)
}
