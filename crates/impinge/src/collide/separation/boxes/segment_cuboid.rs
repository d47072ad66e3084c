//! Segments and capsules against boxes in 3D.
//!
//! The squared distance of a point from a box is a sum over the axes. Along a segment the slope of
//! this sum is piecewise linear, with breaks where the segment crosses the planes of faces, so the
//! nearest point is found between two breaks. If segment and box overlap, the separating axis test
//! over three faces and three pairs of edges is exact. If the distance of the points found differs
//! from the distance of the supporting planes perpendicular to their direction, the pair falls back
//! to the general algorithm. This closed form takes half the time of the separating axis test in
//! [`hulls`](crate::collide::separation::hulls).
//!
//! ```text
//!   slope of the squared distance along the segment, by share of its length
//!
//!            |           .--          zero between two breaks: the nearest point
//!      ------+------.---+------       breaks: crossings of the six face planes
//!            |  .--'
//!            |-'
//!            0                  1
//! ```

use crate::collide::Pair;
use crate::collide::separation::segments::nearest::{core, nearest_of_segments};
use crate::collide::separation::{general, shared_corner, wrong_kinds};
use crate::convex::Separation;
use crate::math::{Mapped, Point, Pose, Real, Vector, max, max_component, min};
use crate::shape::{Kind, SupportMap};

/// Returns the separation of a segment or capsule from a box; `None` above `limit`.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let Kind::Cuboid(cuboid) = pair.second else { wrong_kinds(pair) };
    let (ends, radius) = core(pair, &pair.first);
    let Some(segment) = LocalSegment::new([&ends[0], &ends[1]], &pair.pose12, cuboid.reach())
    else {
        return general::of_flat_cores(pair, limit);
    };
    let most = (limit + radius) * segment.shrink;
    let half = cuboid.half_extents() * segment.shrink;
    let most = most + N::lit(16.0) * rounding_error() * (N::ONE + most.abs());
    match (LocalBox { segment: &segment, half }).solve(most) {
        SegmentResult::Beyond => None,
        SegmentResult::Found(parting) => {
            let found = segment.restored(&parting).rounded(radius, N::ZERO);
            let found = shared_corner::with_shared_corner(pair, found);
            (found.distance <= limit).then_some(found)
        }
        SegmentResult::Unproved => general::of_flat_cores(pair, limit),
    }
}

/// A segment in the frame of a solid. Its lengths are scaled by a power of two, so that the largest
/// of the solid's bounding radius, the ends' coordinates and the translation between the frames is
/// at least 1 and less than 2.
struct LocalSegment<'a, N: Real> {
    ends: [Vector<N, 3>; 2],
    /// Vector from the first end to the second.
    along: Vector<N, 3>,
    /// Pose of the solid in the frame of the segment, in the caller's unit of length.
    pose12: &'a Pose<N, 3>,
    /// Length of one unit: a power of two.
    scale: N,
    /// 1 / `scale`, exactly.
    shrink: N,
}

/// A separation in the frame and the units of a [`LocalSegment`].
#[derive(Clone, Copy, Debug)]
struct Parting<N: Real> {
    /// Unit vector from the solid to the segment.
    outward: Vector<N, 3>,
    /// Point of the segment that faces `on_solid`.
    on_segment: Vector<N, 3>,
    /// Point of the solid that faces `on_segment`.
    on_solid: Vector<N, 3>,
    /// Signed distance of the segment, without a capsule's radius, from the solid.
    distance: N,
}

/// Result of the closed form.
enum SegmentResult<N: Real> {
    /// The core is farther from the solid than the limit.
    Beyond,
    Found(Parting<N>),
    /// No result is proved; the general algorithm has to decide.
    Unproved,
}

/// Returns the number that counts as rounding error in arithmetic on numbers up to 2.
fn rounding_error<N: Real>() -> N {
    N::lit(16.0) * N::EPSILON
}

impl<'a, N: Real> LocalSegment<'a, N> {
    /// Moves a segment into the frame of the solid at `pose12` and scales it. `reach` is the
    /// solid's bounding radius. `None` if the size of the pair is zero, or if the size, its
    /// reciprocal or the pose is not finite.
    fn new(ends: [&Point<N, 3>; 2], pose12: &'a Pose<N, 3>, reach: N) -> Option<Self> {
        let of_ends = max(max_component(&ends[0].coords), max_component(&ends[1].coords));
        let size = max(max(reach, max_component(&pose12.translation)), of_ends);
        let scale = size.power_of_two_below();
        let shrink = N::ONE / scale;
        let is_scalable = size > N::ZERO && size.is_finite_number() && shrink.is_finite_number();
        if !(is_scalable && pose12.is_finite()) {
            return None;
        }
        let local = |end: &Point<N, 3>| {
            pose12.rotation.tr_mul(&((end.coords - pose12.translation) * shrink))
        };
        // Computed from the ends before they are translated, so that the distance of the origins
        // adds no rounding error.
        let along = pose12.rotation.tr_mul(&((ends[1] - ends[0]) * shrink));
        Some(Self { ends: [local(ends[0]), local(ends[1])], along, pose12, scale, shrink })
    }

    /// Returns the point at parameter `share` from 0 to 1, computed from the nearer end.
    fn at(&self, share: N) -> Vector<N, 3> {
        if share <= N::HALF {
            self.ends[0] + self.along * share
        } else {
            self.ends[1] - self.along * (N::ONE - share)
        }
    }

    /// Returns the smaller coordinate of the two ends along a vector.
    fn low(&self, along: &Vector<N, 3>) -> N {
        min(along.dot(&self.ends[0]), along.dot(&self.ends[1]))
    }

    /// Returns the separation along the unit vector `outward`; `None` unless the vector between
    /// both points is `outward` times the distance of the supporting planes, up to rounding.
    /// `extent` is the extent of the solid along `outward`.
    fn proved(
        &self,
        outward: Vector<N, 3>,
        extent: N,
        [on_segment, on_solid]: [Vector<N, 3>; 2],
    ) -> Option<Parting<N>> {
        let distance = self.low(&outward) - extent;
        let aside = on_segment - on_solid - outward * distance;
        let is_proved = aside.norm_squared() <= rounding_error::<N>() * rounding_error();
        is_proved.then_some(Parting { outward, on_segment, on_solid, distance })
    }

    /// Returns the separation of the cores in the frame of the segment and in the caller's unit of
    /// length.
    fn restored(&self, found: &Parting<N>) -> Separation<N, 3> {
        let placed = |point: Vector<N, 3>| self.pose12.point(&Point::from(point * self.scale));
        Separation {
            distance: found.distance * self.scale,
            normal: -self.pose12.vector(&found.outward),
            point1: placed(found.on_segment),
            point2: placed(found.on_solid),
        }
    }
}

/// A box and the segment in its frame.
struct LocalBox<'a, N: Real> {
    segment: &'a LocalSegment<'a, N>,
    /// Half extents of the box, in units of the segment.
    half: Vector<N, 3>,
}

impl<N: Real> LocalBox<'_, N> {
    /// Returns the result for the segment without a radius: `Beyond` if it is farther than `most`
    /// above a face's plane. A result found along another direction may be farther than `most`,
    /// too.
    fn solve(&self, most: N) -> SegmentResult<N> {
        let (axis, sign, gap) = self.best_face();
        if gap > most {
            return SegmentResult::Beyond;
        }
        let found = if gap > N::ZERO {
            self.nearest()
        } else {
            match self.best_edge(gap + N::TWO * rounding_error()) {
                None => self.at_face(axis, sign, gap),
                Some((_, _, gap)) if gap > N::ZERO => self.nearest(),
                Some((axis, outward, gap)) => self.at_edge(axis, &outward, gap),
            }
        };
        found.map_or(SegmentResult::Unproved, SegmentResult::Found)
    }

    /// Returns axis, sign and gap of the face that the segment is highest above; the first face
    /// wins a tie.
    fn best_face(&self) -> (usize, N, N) {
        let [a, b] = &self.segment.ends;
        let mut best = (0, N::ONE, -N::INFINITY);
        for axis in 0..3 {
            let above = min(a[axis], b[axis]) - self.half[axis];
            let below = -self.half[axis] - max(a[axis], b[axis]);
            if max(above, below) > best.2 {
                let sign = if above >= below { N::ONE } else { -N::ONE };
                best = (axis, sign, max(above, below));
            }
        }
        best
    }

    /// Returns the axis of those box edges whose common perpendicular with the segment has the
    /// largest gap, the unit vector along that perpendicular from the box to the segment, and the
    /// gap. `None` unless the gap exceeds `least`.
    fn best_edge(&self, least: N) -> Option<(usize, Vector<N, 3>, N)> {
        let (from, along) = (&self.segment.ends[0], &self.segment.along);
        let (mut best, mut bound) = (None, least);
        for (axis, one, other) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let (x, y) = (-along[other], along[one]);
            let height = x * from[one] + y * from[other];
            let extent = x.abs() * self.half[one] + y.abs() * self.half[other];
            let sine = (x * x + y * y).sqrt();
            // False for NaN and for segments parallel to the axis, which are skipped.
            let is_certain = sine > rounding_error() && (height.abs() - extent) > bound * sine;
            if is_certain {
                let signed_sine = if height < N::ZERO { -sine } else { sine };
                let mut outward = Vector::<N, 3>::zeros();
                (outward[one], outward[other]) = (x / signed_sine, y / signed_sine);
                bound = (height.abs() - extent) / sine;
                best = Some((axis, outward, bound));
            }
        }
        best
    }

    /// Returns the extent of the box along a vector.
    fn extent(&self, along: &Vector<N, 3>) -> N {
        along[0].abs() * self.half[0]
            + along[1].abs() * self.half[1]
            + along[2].abs() * self.half[2]
    }

    /// Returns the separation along the normal of a face; `None` unless the lowest point of the
    /// segment projects into the face. If the segment is parallel to the face, this point is the
    /// middle of the part that projects into it.
    fn at_face(&self, axis: usize, sign: N, gap: N) -> Option<Parting<N>> {
        let [a, b] = &self.segment.ends;
        let climb = (b[axis] - a[axis]) * sign;
        let on_segment = if climb.abs() <= rounding_error() {
            self.middle_over(axis)?
        } else if climb < N::ZERO {
            *b
        } else {
            *a
        };
        let tolerance = rounding_error::<N>();
        let is_over =
            (0..3).all(|at| at == axis || on_segment[at].abs() <= self.half[at] + tolerance);
        let mut on_solid = on_segment;
        on_solid[axis] = self.half[axis] * sign;
        let outward = Vector::<N, 3>::ith(axis, sign);
        is_over.then_some(Parting { outward, on_segment, on_solid, distance: gap })
    }

    /// Returns the middle of the part of the segment that projects into a face; `None` if no part
    /// does. An axis that the segment is perpendicular to is ignored; the caller checks the result
    /// along it.
    fn middle_over(&self, face: usize) -> Option<Vector<N, 3>> {
        let (from, along) = (&self.segment.ends[0], &self.segment.along);
        let (mut first, mut last) = (N::ZERO, N::ONE);
        for axis in (0..3).filter(|&axis| axis != face) {
            if along[axis].abs() <= rounding_error() {
                continue;
            }
            let [one, other] = [-self.half[axis], self.half[axis]]
                .mapped(|side| (side - from[axis]) / along[axis]);
            (first, last) = (max(first, min(one, other)), min(last, max(one, other)));
        }
        (first <= last).then(|| self.segment.at((first + last) * N::HALF))
    }

    /// Returns the separation along the common perpendicular of the segment and the box edges along
    /// `axis`; `None` unless the vector between the nearest points is `outward` times `gap`, up to
    /// rounding.
    fn at_edge(&self, axis: usize, outward: &Vector<N, 3>, gap: N) -> Option<Parting<N>> {
        let mut ends = [Point::origin(); 2];
        for at in 0..3 {
            let side = if outward[at] < N::ZERO { -self.half[at] } else { self.half[at] };
            (ends[0][at], ends[1][at]) = (if at == axis { -side } else { side }, side);
        }
        let core = self.segment.ends.mapped(Point::from);
        let (on_segment, on_solid) = nearest_of_segments(&core, &ends);
        let [on_segment, on_solid] = [on_segment.coords, on_solid.coords];
        let aside = on_segment - on_solid - outward * gap;
        let is_across =
            aside.norm_squared() <= N::lit(16.0) * rounding_error::<N>() * rounding_error();
        is_across.then_some(Parting { outward: *outward, on_segment, on_solid, distance: gap })
    }

    /// Returns the separation at the nearest points of segment and box, which are apart; `None`
    /// unless supporting planes prove it.
    fn nearest(&self) -> Option<Parting<N>> {
        let share = self.nearest_share();
        let on_segment = self.segment.at(share);
        let on_solid = on_segment.zip_map(&self.half, |x, half| min(max(x, -half), half));
        let away = on_segment - on_solid;
        let points = [on_segment, on_solid];
        let is_off = |axis: &usize| away[*axis].abs() > rounding_error();
        let (count, axis) =
            (0..3).filter(is_off).fold((0, 0), |(count, _), axis| (count + 1, axis));
        if count == 1 {
            let sign = if away[axis] < N::ZERO { -N::ONE } else { N::ONE };
            let outward = Vector::<N, 3>::ith(axis, sign);
            let found = self.segment.proved(outward, self.half[axis], points);
            if found.is_some() {
                return found;
            }
        }
        let is_between = share > N::ZERO && share < N::ONE;
        let across = if is_between { self.perpendicular(&away) } else { None };
        let outward = across.or_else(|| {
            let length = away.norm();
            (length > rounding_error()).then(|| away / length)
        })?;
        self.segment.proved(outward, self.extent(&outward), points)
    }

    /// Returns the separating direction when the nearest feature of the box is an edge:
    /// perpendicular to that edge and to the segment. It is accurate to rounding at any distance.
    /// `None` if the nearest feature is a vertex or a face, or if edge and segment are nearly
    /// parallel.
    fn perpendicular(&self, away: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let (axis, one, other) = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
            .into_iter()
            .find(|&(axis, ..)| away[axis] == N::ZERO)?;
        if away[one] == N::ZERO || away[other] == N::ZERO {
            return None;
        }
        let along = &self.segment.along;
        let (x, y) = (-along[other], along[one]);
        let sine = (x * x + y * y).sqrt();
        if sine <= N::lit(1.0 / 64.0) * along[axis].abs() || sine <= rounding_error() {
            return None;
        }
        let signed_sine = if x * away[one] + y * away[other] < N::ZERO { -sine } else { sine };
        let mut outward = Vector::<N, 3>::zeros();
        (outward[one], outward[other]) = (x / signed_sine, y / signed_sine);
        Some(outward)
    }

    /// Returns the parameter of the point of the segment nearest to the box.
    fn nearest_share(&self) -> N {
        let (from, along) = (&self.segment.ends[0], &self.segment.along);
        let slope = |share: N| {
            let at = self.segment.at(share);
            let part = |axis: usize| {
                let inside = min(max(at[axis], -self.half[axis]), self.half[axis]);
                along[axis] * (at[axis] - inside)
            };
            part(0) + part(1) + part(2)
        };
        let (mut low, mut high) = ((N::ZERO, slope(N::ZERO)), (N::ONE, slope(N::ONE)));
        if low.1 >= N::ZERO {
            return N::ZERO;
        }
        if high.1 <= N::ZERO {
            return N::ONE;
        }
        let sides =
            (0..3).flat_map(|axis| [-self.half[axis], self.half[axis]].mapped(|at| (axis, at)));
        for (axis, side) in sides {
            let share = (side - from[axis]) / along[axis];
            // NaN parameters are skipped.
            if share > low.0 && share < high.0 {
                let slope = slope(share);
                let end = if slope < N::ZERO { &mut low } else { &mut high };
                *end = (share, slope);
            }
        }
        low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1))
    }
}
