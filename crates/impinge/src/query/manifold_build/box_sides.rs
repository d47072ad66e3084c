//! Two boxes in the plane, side to side or corner on side, in one go.
//!
//! The side that the separating axis test names is a stretch along
//! an axis of its own box, the most aligned side of the other box a slanted stretch above it, and the
//! contact points are the ends of what they share. Of a side that leans too far the lower end alone
//! counts, the corner that faces the other box. The general builder is the definition, and takes over
//! where this one declines.

use super::frame::{Candidate, ROUNDING_ERRORS};
use super::overlap::Candidates;
use super::{ManifoldRequest, Pair, RawManifold, choose_admitted};
use crate::math::{Point, Pose, Real, Vector, max, min};
use crate::query::separation::rectangle_axes::{Rectangles, SideAxis};
use crate::shape::{FACING_SINE_SQUARED, FeatureId, Kind};

/// Builds the manifold of two boxes; answers whether it did.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) -> bool {
    let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (&pair.first, &pair.second) else {
        return false;
    };
    let (half1, half2) = (*cuboid1.half_extents(), *cuboid2.half_extents());
    let boxes = Rectangles { half1, half2, pose12: pair.pose12 };
    let axis = boxes.best_axis();
    if axis.gap > request.prediction + N::lit(16.0) * boxes.noise() {
        out.points.clear();
        return true;
    }
    let is_ordinary = axis.gap <= request.prediction && request.sine <= N::ZERO;
    let sides = if is_ordinary { Sides::meeting(&boxes, &axis) } else { None };
    sides.is_some_and(|sides| sides.build(&axis, request, out))
}

/// A side of one box, and the side of the other above it, in the frame of the first of these.
struct Sides<'a, N: Real> {
    boxes: &'a Rectangles<N>,
    is_second: bool,
    below: Stretch<N>,
    above: Stretch<N>,
    /// The axis across the lower side, the side's place on it and which way is up.
    across: usize,
    level: N,
    up: N,
    /// Lengths below this are rounding errors, as for the general builder.
    tolerance: N,
}

/// A side seen along the normal: from the end with the smaller place to the other.
struct Stretch<N: Real> {
    id: FeatureId,
    ends: [End<N>; 2],
    /// The end that faces the other box if the side leans too far.
    alone: Option<usize>,
}

#[derive(Clone, Copy)]
struct End<N: Real> {
    id: FeatureId,
    place: N,
    height: N,
}

impl<'a, N: Real> Sides<'a, N> {
    /// The two sides, unless one has no length.
    fn meeting(boxes: &'a Rectangles<N>, axis: &SideAxis<N>) -> Option<Self> {
        let (half, other, pose) = if axis.is_second {
            (boxes.half2, boxes.half1, boxes.pose12.inverse())
        } else {
            (boxes.half1, boxes.half2, boxes.pose12)
        };
        let outward = if axis.is_second {
            -boxes.pose12.inverse_vector(&axis.normal)[axis.axis]
        } else {
            axis.normal[axis.axis]
        };
        let up = if outward < N::ZERO { -N::ONE } else { N::ONE };
        let size = boxes.half1.norm() + boxes.half2.norm() + boxes.pose12.translation.norm();
        let sides = Self {
            boxes,
            is_second: axis.is_second,
            below: lower(&half, axis.axis, up > N::ZERO),
            above: upper(&other, &pose, (axis.axis, up), up * half[axis.axis]),
            across: axis.axis,
            level: up * half[axis.axis],
            up,
            tolerance: N::lit(ROUNDING_ERRORS) * N::EPSILON * size,
        };
        let shortest = min(sides.below.length(), sides.above.length());
        (shortest > N::lit(8.0) * sides.tolerance).then_some(sides)
    }

    fn build(
        &self,
        axis: &SideAxis<N>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 2>,
    ) -> bool {
        let mut candidates = Candidates::new();
        for (index, end) in self.above.ends.into_iter().enumerate() {
            if self.above.alone.is_some_and(|alone| alone != index) {
                continue;
            }
            if let Some((id, _)) = self.below.beside(end.place, self.tolerance) {
                self.push(end.place, end.height, [id, end.id], &mut candidates);
            }
        }
        for end in self.below.ends {
            if self.above.alone.is_some() {
                break;
            }
            if let Some((id, height)) = self.above.beside(end.place, self.tolerance) {
                self.push(end.place, height, [end.id, id], &mut candidates);
            }
        }
        let limits = (request.prediction, request.max_points.min(2));
        let is_built = choose_admitted(candidates, (axis.gap, self.tolerance), limits, out);
        if is_built {
            out.normal = axis.normal;
        }
        is_built
    }

    /// Adds a place of the common stretch, once for each pair of names.
    fn push(
        &self,
        place: N,
        height: N,
        [below, above]: [FeatureId; 2],
        out: &mut Candidates<N, 2>,
    ) {
        let features = if self.is_second { [above, below] } else { [below, above] };
        if out.iter().any(|old| old.features == features) {
            return;
        }
        let rise = if self.is_second { height * self.up } else { N::ZERO };
        let mut point = Point::<N, 2>::origin();
        (point[1 - self.across], point[self.across]) = (place, self.level + rise);
        let point1 = if self.is_second { self.boxes.pose12.point(&point) } else { point };
        let flat = Vector::<N, 2>::new(place, N::ZERO);
        out.push(Candidate { point1, distance: height, flat, features, kept_id: None });
    }
}

/// The number of the vertex with these positive coordinates.
pub(super) const fn vertex(axis: usize, is_positive: bool, other_is_positive: bool) -> FeatureId {
    FeatureId::Vertex((is_positive as u32) << axis | (other_is_positive as u32) << (1 - axis))
}

/// The number of the side that is perpendicular to an axis.
pub(super) const fn side(axis: usize, is_positive: bool) -> FeatureId {
    FeatureId::Face(2 * (axis == 1) as u32 + !is_positive as u32)
}

/// The side of the box whose frame it is.
fn lower<N: Real>(half: &Vector<N, 2>, axis: usize, is_positive: bool) -> Stretch<N> {
    let end = |far: bool| {
        let place = if far { half[1 - axis] } else { -half[1 - axis] };
        End { id: vertex(axis, is_positive, far), place, height: N::ZERO }
    };
    Stretch { id: side(axis, is_positive), ends: [end(false), end(true)], alone: None }
}

/// The side of the other box, at `pose`, that is most aligned with the lower one, which lies at
/// `level` on the axis `across` and faces `up`.
fn upper<N: Real>(
    half: &Vector<N, 2>,
    pose: &Pose<N, 2>,
    (across, up): (usize, N),
    level: N,
) -> Stretch<N> {
    let facing = [0, 1].map(|axis| -up * pose.rotation[(across, axis)]);
    let m = usize::from(facing[1].abs() > facing[0].abs());
    let lean = facing[1 - m];
    let is_positive = facing[m] > N::ZERO;
    let end = |far: bool| {
        let mut corner = *half;
        corner[m] = if is_positive { half[m] } else { -half[m] };
        corner[1 - m] = if far { half[1 - m] } else { -half[1 - m] };
        let point = pose.point(&Point::from(corner));
        let height = up * (point[across] - level);
        End { id: vertex(m, is_positive, far), place: point[1 - across], height }
    };
    let (near, far) = (end(false), end(true));
    let is_turned = far.place < near.place;
    let ends = if is_turned { [far, near] } else { [near, far] };
    let faces_near = lean < N::ZERO;
    let is_aligned = lean * lean <= N::lit(FACING_SINE_SQUARED);
    let alone = if is_aligned { None } else { Some(usize::from(faces_near == is_turned)) };
    Stretch { id: side(m, is_positive), ends, alone }
}

impl<N: Real> Stretch<N> {
    fn length(&self) -> N {
        self.ends[1].place - self.ends[0].place
    }

    /// The part beside a place and its height there; `None` beyond the ends.
    fn beside(&self, place: N, tolerance: N) -> Option<(FeatureId, N)> {
        let (length, along) = (self.length(), place - self.ends[0].place);
        let slack = N::TWO * tolerance;
        if along < -slack || along > length + slack {
            return None;
        }
        let share = min(max(along / length, N::ZERO), N::ONE);
        let height = self.ends[0].height + (self.ends[1].height - self.ends[0].height) * share;
        let at_end = if along >= length - tolerance { Some(1) } else { None };
        let at_end = if along <= tolerance { at_end.or(Some(0)) } else { at_end };
        Some((at_end.map_or(self.id, |end: usize| self.ends[end].id), height))
    }
}
