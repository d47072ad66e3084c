//! Slabs around one part of a shape. A part of the other shape is rejected if it lies outside one
//! of the slabs by more than a limit.
//!
//! ```text
//!                   r ── s
//!                    ╲  ╱
//!                     q         ┬
//!                               │ gap = lowest of q, r, s - highest
//!     ─────────c────────────────┴─── highest    slab across the side ab
//!             ╱ ╲                               of the triangle a, b, c
//!     ───────a───b────────────────── lowest
//! ```

use smallvec::{SmallVec, smallvec};

use super::between::Between;
use super::sweep::PartSweep;
use crate::math::{Mapped, Pose, Real, Space, Vector, max, max_component, min, unit};
use crate::shape::{CompositeShape, Part, PartSolid, Plane};

/// Rounding error of gaps, in units of epsilon times the largest length.
const ROUNDING: f64 = 128.0;

/// Slabs that contain a solid during its motion, in the frame of the composite that it is compared
/// with.
pub(crate) struct AxisSlabs<N: Real, const D: usize> {
    /// Point from which all heights of the slabs are measured.
    pub(super) origin: Vector<N, D>,
    /// Largest coordinate of the solid and its motion; rounding errors are proportional to it or to
    /// a larger coordinate of the other part.
    pub(super) size: N,
    /// For a triangle, one slab along the in-plane normal of each side and, in 3D, one along the
    /// normal of the plane. For a segment, one slab along the segment and one along a direction
    /// perpendicular to it. A half-space has a single slab, a part without corners none.
    pub(super) slabs: SmallVec<[Slab<N, D>; 5]>,
    /// Corners of the part relative to `origin`; `None` if the part moves or has no corners.
    pub(super) corners: Option<[Vector<N, D>; 3]>,
}

/// The points with `lowest <= along · x <= highest`, where `along` is a unit vector.
pub(super) struct Slab<N: Real, const D: usize> {
    pub(super) along: Vector<N, D>,
    pub(super) lowest: N,
    pub(super) highest: N,
}

impl<N: Space<D>, const D: usize> AxisSlabs<N, D> {
    /// Returns the slab around a half-space, which is the first shape; the slab is unbounded below.
    pub(crate) fn of_half_space(
        between: &Between<'_, N, D>,
        plane: &Plane<N, D>,
        sweep: Option<&PartSweep<N, D>>,
    ) -> Self {
        let Pose { translation: origin, .. } = between.pose21;
        let along = between.pose21.vector(plane.normal());
        // A half-space has an infinite bounding radius, so its sweep has no direction (see
        // [`PartSweep::anywhere`]) and only the spread counts.
        let highest = sweep.map_or(N::ZERO, |sweep| sweep.spread);
        let slab = Slab { along, lowest: -N::INFINITY, highest };
        Self { origin, size: highest, slabs: smallvec![slab], corners: None }
    }

    /// Returns the slabs around a part of the first shape (0) or the second (1), in the frame of
    /// the other shape. There are no slabs for a part without corners.
    pub(crate) fn of_part(
        between: &Between<'_, N, D>,
        which: usize,
        part: u32,
        sweep: Option<&PartSweep<N, D>>,
    ) -> Self {
        let (origin, none) = (Vector::<N, D>::zeros(), SmallVec::new());
        let mut slabs = Self { origin, size: N::ZERO, slabs: none, corners: None };
        let Some((part, pose)) = between.part_in_other(which, part) else { return slabs };
        let Some(corners) = corners(&part.solid, &pose) else { return slabs };
        let own = max_component(&part.pose.translation);
        let offset = max(own, max_component(&pose.translation));
        slabs.origin = corners[0];
        let ends = corners.mapped(|at| sweep.map_or(at, |sweep| at + sweep.displacement(&at)));
        let all = corners.iter().chain(&ends);
        slabs.size = all.fold(offset, |size, at| max(max_component(at), size));
        let spread = sweep.map_or(N::ZERO, |sweep| sweep.spread);
        let relative = corners.mapped(|at| at - corners[0]);
        slabs.surround(&relative, &ends.mapped(|at| at - corners[0]), spread);
        slabs.corners = sweep.is_none().then_some(relative);
        slabs
    }

    /// Adds slabs that contain both `corners` and their positions `ends` after the motion, widened
    /// by `spread` on both sides. Both are relative to the first corner before the motion.
    fn surround(&mut self, corners: &[Vector<N, D>; 3], ends: &[Vector<N, D>; 3], spread: N) {
        for along in across(corners) {
            let (start, end) = (range(corners, &along), range(ends, &along));
            let (lowest, highest) =
                (min(start[0], end[0]) - spread, max(start[1], end[1]) + spread);
            self.slabs.push(Slab { along, lowest, highest });
        }
    }

    /// Returns whether a part of the composite is certainly farther from the solid than `limit`;
    /// the distance of an overlap is negative. False without slabs or corners, and if the lengths
    /// are too small to be precise.
    pub(crate) fn are_beyond(&self, part: &Part<'_, N, D>, limit: N) -> bool {
        if self.slabs.is_empty() {
            return false;
        }
        let Some(corners) = corners(&part.solid, &part.pose) else { return false };
        let corners = corners.mapped(|corner| corner - self.origin);
        let size = corners.iter().fold(self.size, |size, at| max(max_component(at), size));
        let gap = self.slabs.iter().fold(-N::INFINITY, |gap, slab| {
            let [lowest, highest] = range(&corners, &slab.along);
            max(max(lowest - slab.highest, slab.lowest - highest), gap)
        });
        // Subnormal lengths have a large relative rounding error.
        let is_precise = size > N::MIN_POSITIVE / N::EPSILON;
        is_precise && gap - size * rounding_unit() > limit
    }
}

/// Returns the rounding error of gaps in units of the largest length.
pub(super) fn rounding_unit<N: Real>() -> N {
    N::lit(ROUNDING) * N::EPSILON
}

/// Returns the in-plane unit normals of the sides of a triangle whose first corner is the origin
/// and, in 3D, the unit normal of its plane. For a triangle that is a segment, returns the
/// direction of the segment and a unit vector perpendicular to it. Vectors of zero length are
/// omitted.
pub(crate) fn across<N: Real, const D: usize>(
    [_, one, other]: &[Vector<N, D>; 3],
) -> impl Iterator<Item = Vector<N, D>> {
    let sides = [without(other, one), without(one, other), without(one, &(other - one))];
    let all = sides.into_iter().chain([normal_to(one, other)]);
    all.filter_map(|direction| Some(unit(&direction)?.0))
}

/// Returns the corners of a part in the frame of its composite; `None` for a part without corners.
/// For a mesh, the corners are read without making a [`Part`].
pub(crate) fn corners_of<N: Real, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    part: u32,
) -> Option<[Vector<N, D>; 3]> {
    if let Some(mesh) = parts.as_mesh() {
        return Some(mesh.corners(part).mapped(|corner| corner.coords));
    }
    let part = parts.part(part);
    corners(&part.solid, &part.pose)
}

/// Returns the corners of a triangle or segment, transformed by `pose`. The first end of a segment
/// occurs twice. `None` for other parts.
pub(crate) fn corners<N: Real, const D: usize>(
    solid: &PartSolid<'_, N, D>,
    pose: &Pose<N, D>,
) -> Option<[Vector<N, D>; 3]> {
    let corners = match solid {
        PartSolid::Triangle(triangle) => *triangle.corners(),
        PartSolid::Segment(segment) => [*segment.a(), *segment.b(), *segment.a()],
        PartSolid::Shape(_) => return None,
    };
    Some(corners.mapped(|corner| pose.point(&corner).coords))
}

/// Returns the smallest and the largest coordinate of the corners along a direction.
pub(crate) fn range<N: Real, const D: usize>(
    corners: &[Vector<N, D>; 3],
    along: &Vector<N, D>,
) -> [N; 2] {
    let [a, b, c] = [0, 1, 2].mapped(|index| corners[index].dot(along));
    [min(min(a, b), c), max(max(a, b), c)]
}

/// Returns `v` minus its component along `other`; returns `v` if `other` has no direction.
fn without<N: Real, const D: usize>(v: &Vector<N, D>, other: &Vector<N, D>) -> Vector<N, D> {
    unit(other).map_or(*v, |(along, _)| v - along * v.dot(&along))
}

/// Removes the components in the span of `one` and `other` from each coordinate axis, and returns
/// the longest remainder. Zero if no remainder is longer than 1/4, as is the case if the two
/// vectors span all directions.
fn normal_to<N: Real, const D: usize>(one: &Vector<N, D>, other: &Vector<N, D>) -> Vector<N, D> {
    let along = |v: &Vector<N, D>| unit(v).map_or_else(Vector::<N, D>::zeros, |(along, _)| along);
    let spans = [along(one), along(&without(other, one))];
    let (mut most, mut squared) = (Vector::<N, D>::zeros(), N::lit(0.0625));
    for index in 0..D {
        let [a, b] = spans.each_ref().mapped(|span| span[index]);
        let left = N::ONE - a * a - b * b;
        if left > squared {
            let mut axis = Vector::<N, D>::zeros();
            axis[index] = N::ONE;
            (most, squared) = (axis - spans[0] * a - spans[1] * b, left);
        }
    }
    most
}
