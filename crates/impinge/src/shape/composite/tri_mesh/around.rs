//! Walks around the sides and corners of a mesh.
//!
//! Meshes contain triangles without area as fillers: where a corner touches the middle of a longer
//! side, a thin triangle joins the three. Seams are evaluated across them, as if they were not
//! there.

use core::cell::OnceCell;

use smallvec::SmallVec;

use super::TriMesh;
use crate::math::{Mapped, Point, Real, Vector, filled, max, max_component, min, unit, unit_or};
use crate::shape::solids::segment::length_of;

/// The maximum number of sides of triangles without area that a walk crosses.
const MAX_CROSSED: usize = 32;
/// A triangle is tall if its squared height over its longest side is above this fraction of that
/// side's square.
const TALL: f64 = 1.0 / 1024.0;

impl<N: Real, const D: usize> TriMesh<N, D> {
    /// Calls `visit` with each other triangle at a side, and the index of the side within that
    /// triangle.
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
            // All of them are at both ends: search the end with fewer triangles.
            let [from, to] = ends.map(|joint| self.topology.joints.parts(joint));
            let fewer = if from.len() < to.len() { from } else { to };
            fewer.iter().filter(|&&other| other != triangle).for_each(|&other| found(other));
        }
    }

    /// Calls `visit` with each other triangle with an area at a side, and the direction from the
    /// side into it. Passes through triangles without area, whose sides lie along each other.
    pub(super) fn each_beyond(
        &self,
        triangle: u32,
        side: usize,
        mut visit: impl FnMut(u32, Vector<N, D>),
    ) {
        self.each_along(triangle, side, |other, inward, _| visit(other, inward));
    }

    /// [`Self::each_beyond`] with the interval of the side along which each of the triangles lies,
    /// measured from the beginning of the side; `None` for all of it.
    fn each_along(
        &self,
        triangle: u32,
        side: usize,
        mut visit: impl FnMut(u32, Vector<N, D>, Option<[N; 2]>),
    ) {
        let mut crossed: SmallVec<[_; 4]> = SmallVec::new();
        crossed.push((triangle, side, None));
        let line = OnceCell::new();
        let stretch = |other: u32, exit: usize| {
            let line = line.get_or_init(|| SideLine::of(&self.corners(triangle), side));
            Some(line.span(&self.ends_of(other, exit))).filter(|span| line.overlaps(span))
        };
        if self.inward(triangle, side).is_none() {
            for other in [1, 2].map(|turn| (side + turn) % 3) {
                let span = stretch(triangle, other);
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
                        let span = stretch(other, exit).filter(|_| is_new);
                        crossed.extend(span.map(|span| (other, exit, Some(span))));
                    }
                }
            });
        }
    }

    /// Whether part of a side of a triangle without area has no triangle with an area beside it.
    pub(super) fn sticks_out(&self, triangle: u32, side: usize) -> bool {
        if self.inward(triangle, side).is_some() {
            return false;
        }
        let line = SideLine::of(&self.corners(triangle), side);
        let mut spans: SmallVec<[[N; 2]; 4]> = SmallVec::new();
        self.each_along(triangle, side, |_, _, span| {
            spans.push(span.unwrap_or([N::ZERO, line.length]));
        });
        let mut covered = N::ZERO;
        while covered < line.length - line.room {
            let reaching = spans.iter().filter(|span| span[0] <= covered + line.room);
            let next = reaching.fold(covered, |next, span| max(next, span[1]));
            if next <= covered {
                return true;
            }
            covered = next;
        }
        false
    }

    /// Calls `visit` with each triangle on whose side a joint lies without being one of its
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
                let corners = self.corners(triangle);
                let line = SideLine::of(&corners, opposite);
                let [place, _] = line.span(&[corners[at], corners[at]]);
                let is_within =
                    |[from, to]: [N; 2]| from + line.room < place && place < to - line.room;
                self.each_along(triangle, opposite, |other, inward, span| {
                    let found = Some(inward).filter(|_| span.is_none_or(is_within));
                    found.into_iter().for_each(|inward| visit(other, inward));
                });
            }
        }
    }

    /// Whether the triangle is tall enough that its area is beyond doubt; false leaves the area
    /// undecided.
    pub(super) fn is_plain(&self, triangle: u32) -> bool {
        self.bends.is_plain(triangle, || is_tall(&self.corners(triangle)))
    }

    /// The unit vectors along the sides of a triangle that leave a joint.
    pub(super) fn leaving(&self, triangle: u32, joint: u32) -> SmallVec<[Vector<N, D>; 2]> {
        let (corners, at) = (self.corners(triangle), self.corner_at(triangle, joint));
        let side = |turn: usize| unit(&(corners[(at + turn) % 3] - corners[at]));
        [1, 2].into_iter().filter_map(side).map(|(along, _)| along).collect()
    }

    /// The first corner of a triangle that is at a joint.
    pub(super) fn corner_at(&self, triangle: u32, joint: u32) -> usize {
        (0..3).find(|&at| self.joint_at(triangle, at) == joint).unwrap_or(0)
    }

    /// The ends of a side.
    fn ends_of(&self, triangle: u32, side: usize) -> [Point<N, D>; 2] {
        let corners = self.corners(triangle);
        [corners[side], corners[(side + 1) % 3]]
    }

    /// The unit vector in the triangle's plane from a side towards the opposite corner; `None`
    /// without area.
    pub(super) fn inward(&self, triangle: u32, side: usize) -> Option<Vector<N, D>> {
        let corners = self.corners(triangle);
        inward_of(&filled(|turn| corners[(side + turn) % 3]))
    }
}

/// The unit vector in the plane of a triangle from the side between its first two corners towards
/// the third; `None` without area.
pub(in crate::shape) fn inward_of<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
) -> Option<Vector<N, D>> {
    let [a, b, c] = corners;
    let (along, length) = unit(&(b - a))?;
    let (from_a, from_b) = (length_of(&(c - a)), length_of(&(c - b)));
    let rest = if from_a < from_b { c - a } else { c - b };
    let without = |v: &Vector<N, D>| v - along * along.dot(v);
    let (inward, height) = unit(&without(&rest))?;
    // The height over the longest side is the smallest and decides whether there is an area.
    let longest = max(length, max(from_a, from_b));
    let least = height * (length / longest);
    let has_area = least > noise(corners, longest);
    has_area.then(|| unit_or(&without(&inward), inward))
}

/// Whether the height over the longest side is far above the limit of an area; see [`inward_of`].
fn is_tall<N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> bool {
    let [a, b, c] = corners;
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let longest = max(ab.norm_squared(), max(ac.norm_squared(), bc.norm_squared()));
    // Four times the squared area.
    let along = ab.dot(&ac);
    let area = ab.norm_squared() * ac.norm_squared() - along * along;
    let farthest = corners.iter().map(|corner| max_component(&corner.coords)).fold(N::ZERO, max);
    let unsure = N::lit(4096.0) * N::EPSILON * farthest;
    area > N::lit(TALL) * longest * longest
        && longest > unsure * unsure
        && area > N::MIN_POSITIVE / N::EPSILON
}

/// The line through a side, along which other sides of triangles without area are measured.
struct SideLine<N: Real, const D: usize> {
    from: Point<N, D>,
    /// Unit; zero if the side has no length.
    along: Vector<N, D>,
    length: N,
    /// Lengths up to this are rounding errors.
    room: N,
}

impl<N: Real, const D: usize> SideLine<N, D> {
    fn of(corners: &[Point<N, D>; 3], side: usize) -> Self {
        let from = corners[side];
        let way = corners[(side + 1) % 3] - from;
        let (along, length) = unit(&way).unwrap_or((Vector::<N, D>::zeros(), N::ZERO));
        Self { from, along, length, room: noise(corners, length) }
    }

    /// The interval of a segment along the line, from the beginning of the side.
    fn span(&self, ends: &[Point<N, D>; 2]) -> [N; 2] {
        let [one, other] = ends.each_ref().mapped(|end| self.along.dot(&(end - self.from)));
        [min(one, other), max(one, other)]
    }

    /// Whether an interval of the line has more than a point in common with the side; true for a
    /// side without length.
    fn overlaps(&self, span: &[N; 2]) -> bool {
        self.length == N::ZERO || min(span[1], self.length) - max(span[0], N::ZERO) > self.room
    }
}

/// Whether a side is in the list, or the list is full.
fn crossed_before<S>(crossed: &[(u32, usize, S)], triangle: u32, side: usize) -> bool {
    let is_same = |crossed: &(u32, usize, S)| (crossed.0, crossed.1) == (triangle, side);
    crossed.len() >= MAX_CROSSED || crossed.iter().any(is_same)
}

/// The height over its longest side up to which a triangle has no area: the rounding error of the
/// difference of coordinates, and of the coordinates themselves.
pub(super) fn noise<N: Real, const D: usize>(corners: &[Point<N, D>; 3], longest: N) -> N {
    let mut farthest = N::ZERO;
    for corner in corners {
        farthest = max(farthest, max_component(&corner.coords));
    }
    N::EPSILON * max(N::lit(16.0) * longest, N::TWO * farthest)
}
