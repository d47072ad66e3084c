//! Iteration over the triangles at a side or a corner of a mesh.
//!
//! Some meshes contain triangles without area as fillers: where a corner touches the interior of a
//! longer side, a thin triangle joins that corner to the two ends of the side. Seams are evaluated
//! across such triangles as if they were absent.

use core::cell::OnceCell;

use smallvec::SmallVec;

use super::TriMesh;
use crate::math::{Mapped, Point, Real, Vector, filled, max, max_component, min, unit, unit_or};
use crate::shape::solids::segment::length_of;

/// The maximum number of sides, including the first, that a walk through zero-area triangles
/// crosses.
const MAX_CROSSED: usize = 32;
/// The squared height of a tall triangle over its longest side exceeds this fraction of that side's
/// squared length.
const TALL: f64 = 1.0 / 1024.0;

impl<N: Real, const D: usize> TriMesh<N, D> {
    /// Calls `visit` with each other triangle at a side, and the index of that side in the other
    /// triangle.
    pub(super) fn each_across(
        &self,
        triangle: u32,
        side: usize,
        mut visit: impl FnMut(u32, usize),
    ) {
        let ends = self.joint_ends(triangle, side);
        let mut found = |other: u32| {
            if let Some(side) = self.side_between(other, ends) {
                visit(other, side);
            }
        };
        if let Some(other) = self.topology.single_across(triangle, side) {
            found(other);
        } else if self.topology.has_several_across(triangle, side) {
            // Every triangle at the side is in the lists of both ends: search the shorter list.
            let [from, to] = ends.map(|joint| self.topology.joints.parts(joint));
            let fewer = if from.len() < to.len() { from } else { to };
            fewer.iter().filter(|&&other| other != triangle).for_each(|&other| found(other));
        }
    }

    /// Calls `visit` with each other triangle that lies at a side and has an area. Also passes the
    /// unit vector in the plane of that triangle, from the side into it. The walk passes through
    /// zero-area triangles, whose sides are collinear.
    pub(super) fn each_beyond(
        &self,
        triangle: u32,
        side: usize,
        mut visit: impl FnMut(u32, Vector<N, D>),
    ) {
        self.each_along(triangle, side, |other, inward, _| visit(other, inward));
    }

    /// Runs [`Self::each_beyond`], and also passes the interval of the side along which the other
    /// triangle lies, measured from the start of the side; `None` for the whole side.
    fn each_along(
        &self,
        triangle: u32,
        side: usize,
        mut visit: impl FnMut(u32, Vector<N, D>, Option<[N; 2]>),
    ) {
        let mut crossed: SmallVec<[_; 4]> = SmallVec::new();
        crossed.push((triangle, side, None));
        let line = OnceCell::new();
        let interval = |other: u32, exit: usize| {
            let line = line.get_or_init(|| SideLine::of(&self.corners(triangle), side));
            Some(line.span(&self.ends_of(other, exit))).filter(|span| line.overlaps(span))
        };
        if self.inward(triangle, side).is_none() {
            for other in [1, 2].map(|turn| (side + turn) % 3) {
                let span = interval(triangle, other);
                crossed.extend(span.map(|span| (triangle, other, Some(span))));
            }
        }
        let mut at = 0;
        while let Some(&(from, side, span)) = crossed.get(at) {
            at += 1;
            self.each_across(from, side, |other, entered| match self.inward(other, entered) {
                Some(inward) if other != triangle => visit(other, inward, span),
                Some(_) => (),
                None => {
                    for exit in [1, 2].map(|turn| (entered + turn) % 3) {
                        let is_new = !crossed_before(&crossed, other, exit);
                        let span = interval(other, exit).filter(|_| is_new);
                        crossed.extend(span.map(|span| (other, exit, Some(span))));
                    }
                }
            });
        }
    }

    /// Returns whether part of a side of a zero-area triangle has no triangle with an area beside
    /// it. False for a triangle with an area.
    pub(super) fn is_exposed(&self, triangle: u32, side: usize) -> bool {
        if self.inward(triangle, side).is_some() {
            return false;
        }
        let line = SideLine::of(&self.corners(triangle), side);
        let mut spans: SmallVec<[[N; 2]; 4]> = SmallVec::new();
        self.each_along(triangle, side, |_, _, span| {
            spans.push(span.unwrap_or([N::ZERO, line.length]));
        });
        let mut covered = N::ZERO;
        while covered < line.length - line.slack {
            let reaching = spans.iter().filter(|span| span[0] <= covered + line.slack);
            let next = reaching.fold(covered, |next, span| max(next, span[1]));
            if next <= covered {
                return true;
            }
            covered = next;
        }
        false
    }

    /// Calls `visit` with each triangle that has the joint on a side but not as a corner, and with
    /// the direction from that side into the triangle. Such triangles lie beyond a zero-area
    /// triangle whose middle corner is at the joint.
    pub(super) fn each_beyond_joint(&self, joint: u32, mut visit: impl FnMut(u32, Vector<N, D>)) {
        for &triangle in self.topology.joints.parts(joint) {
            let at = self.corner_at(triangle, joint);
            let opposite = (at + 1) % 3;
            let has_area =
                self.has_certain_area(triangle) || self.inward(triangle, opposite).is_some();
            if has_area {
                continue;
            }
            let leaving = self.leaving(triangle, joint);
            let is_middle = leaving.len() == 2 && leaving[0].dot(&leaving[1]) < N::ZERO;
            if is_middle {
                let corners = self.corners(triangle);
                let line = SideLine::of(&corners, opposite);
                let [position, _] = line.span(&[corners[at], corners[at]]);
                let is_within =
                    |[from, to]: [N; 2]| from + line.slack < position && position < to - line.slack;
                self.each_along(triangle, opposite, |other, inward, span| {
                    let found = Some(inward).filter(|_| span.is_none_or(is_within));
                    found.into_iter().for_each(|inward| visit(other, inward));
                });
            }
        }
    }

    /// Returns whether the triangle is tall enough to certainly have an area. If false, the
    /// triangle may still have an area.
    pub(super) fn has_certain_area(&self, triangle: u32) -> bool {
        self.bends.has_certain_area(triangle, || is_tall(&self.corners(triangle)))
    }

    /// Returns the unit vectors along the two sides of a triangle that leave a joint, except sides
    /// without length.
    pub(super) fn leaving(&self, triangle: u32, joint: u32) -> SmallVec<[Vector<N, D>; 2]> {
        let (corners, at) = (self.corners(triangle), self.corner_at(triangle, joint));
        let side = |turn: usize| unit(&(corners[(at + turn) % 3] - corners[at]));
        [1, 2].into_iter().filter_map(side).map(|(along, _)| along).collect()
    }

    /// Returns the index (0 to 2) of the first corner of a triangle that is at a joint; 0 if there
    /// is none.
    pub(super) fn corner_at(&self, triangle: u32, joint: u32) -> usize {
        (0..3).find(|&at| self.joint_at(triangle, at) == joint).unwrap_or(0)
    }

    /// Returns the two ends of a side.
    fn ends_of(&self, triangle: u32, side: usize) -> [Point<N, D>; 2] {
        let corners = self.corners(triangle);
        [corners[side], corners[(side + 1) % 3]]
    }

    /// Returns the unit vector in the triangle's plane, perpendicular to a side, towards the
    /// opposite corner. `None` for a triangle without area.
    pub(super) fn inward(&self, triangle: u32, side: usize) -> Option<Vector<N, D>> {
        let corners = self.corners(triangle);
        inward_of(&filled(|turn| corners[(side + turn) % 3]))
    }
}

/// Returns the unit vector in the plane of a triangle, perpendicular to the side between its first
/// two corners, towards the third corner. `None` for a triangle without area.
pub(in crate::shape) fn inward_of<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
) -> Option<Vector<N, D>> {
    let [a, b, c] = corners;
    let (along, length) = unit(&(b - a))?;
    let (from_a, from_b) = (length_of(&(c - a)), length_of(&(c - b)));
    let rest = if from_a < from_b { c - a } else { c - b };
    let without = |v: &Vector<N, D>| v - along * along.dot(v);
    let (inward, height) = unit(&without(&rest))?;
    // The height over the longest side is the smallest of the three, and decides whether there is
    // an area.
    let longest = max(length, max(from_a, from_b));
    let least = height * (length / longest);
    let has_area = least > rounding_error(corners, longest);
    has_area.then(|| unit_or(&without(&inward), inward))
}

/// Returns whether the height over the longest side is far above the rounding error that
/// [`inward_of`] uses as the limit of an area.
fn is_tall<N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> bool {
    let [a, b, c] = corners;
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let longest = max(ab.norm_squared(), max(ac.norm_squared(), bc.norm_squared()));
    // The variable `area` is four times the squared area.
    let along = ab.dot(&ac);
    let area = ab.norm_squared() * ac.norm_squared() - along * along;
    let farthest = corners.iter().map(|corner| max_component(&corner.coords)).fold(N::ZERO, max);
    let unsure = N::lit(4096.0) * N::EPSILON * farthest;
    area > N::lit(TALL) * longest * longest
        && longest > unsure * unsure
        && area > N::MIN_POSITIVE / N::EPSILON
}

/// The line through a side. Collinear sides of zero-area triangles are measured along it.
struct SideLine<N: Real, const D: usize> {
    from: Point<N, D>,
    /// The unit direction; zero if the side has no length.
    along: Vector<N, D>,
    length: N,
    /// Intervals of at most this length are treated as empty.
    slack: N,
}

impl<N: Real, const D: usize> SideLine<N, D> {
    fn of(corners: &[Point<N, D>; 3], side: usize) -> Self {
        let from = corners[side];
        let edge = corners[(side + 1) % 3] - from;
        let (along, length) = unit(&edge).unwrap_or((Vector::<N, D>::zeros(), N::ZERO));
        Self { from, along, length, slack: rounding_error(corners, length) }
    }

    /// Returns the interval that a segment covers on the line, measured from the start of the side.
    fn span(&self, ends: &[Point<N, D>; 2]) -> [N; 2] {
        let [one, other] = ends.each_ref().mapped(|end| self.along.dot(&(end - self.from)));
        [min(one, other), max(one, other)]
    }

    /// Returns whether an interval of the line overlaps the side by more than `slack`; true for a
    /// side without length.
    fn overlaps(&self, span: &[N; 2]) -> bool {
        self.length == N::ZERO || min(span[1], self.length) - max(span[0], N::ZERO) > self.slack
    }
}

/// Returns whether a walk must not cross a side: `crossed` contains the side, or is full.
fn crossed_before<S>(crossed: &[(u32, usize, S)], triangle: u32, side: usize) -> bool {
    let is_same = |crossed: &(u32, usize, S)| (crossed.0, crossed.1) == (triangle, side);
    crossed.len() >= MAX_CROSSED || crossed.iter().any(is_same)
}

/// Returns the maximum height over the longest side at which a triangle counts as having no area.
/// It covers the rounding error of coordinate differences and of the coordinates themselves.
pub(super) fn rounding_error<N: Real, const D: usize>(corners: &[Point<N, D>; 3], longest: N) -> N {
    let mut farthest = N::ZERO;
    for corner in corners {
        farthest = max(farthest, max_component(&corner.coords));
    }
    N::EPSILON * max(N::lit(16.0) * longest, N::TWO * farthest)
}
