//! Contacts of segments and capsules in 2D, for several pairs at a time: the ends of the interval
//! along the tangent in which both cores overlap. `interval.rs` computes the contacts of one pair
//! of any solids with flat sides.
//!
//! ```text
//!      normal
//!         ^        a-----*=======*        second: ends ordered along the tangent
//!         |              :       :
//!    ---- o ------------ from -- to --->  tangent; origin: `point1`, nearest point of the first
//!                        :       :
//!               *========*-------b        first
//! ```
//!
//! `from` is the larger of the lower coordinates of both cores, `to` the smaller of the upper
//! coordinates. Each gives a contact if the request admits it. Reads these fields of [`Inputs`]:
//! both poses, both `radii`, the ends of both cores, `prediction` and `sine`. Lanes whose contacts
//! depend on rounding, and requests for a single point, fall back.

use super::PairQuestion;
use super::closed_form::{Form, LaneContacts};
use super::gather::Inputs;
use super::nearest::{END_OR_SIDE, farther, half_length};
use super::vectors::{bits, dot, either, either_mask, lit, minus, norm, plus, rounding_of, times};
use crate::collide::separation::SegmentGap;
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};
use crate::shape::FeatureId;

/// Kernel for two segments or capsules. The pair falls back to the builder for one pair if the
/// cores cross or touch, if a core is parallel to the normal, or if the contacts depend on
/// rounding.
pub(super) struct Segments2;

impl<N: Real> Form<N, 2> for Segments2 {
    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, 2, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, 2>,
    ) -> bool {
        inputs.put_cores(lane, pair) && pair.request.max_points > 1
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, 2, L>,
        found: &mut LaneContacts<N, 2, L>,
    ) {
        let pose12 = inputs.pose12::<S, V>(simd);
        let ends1 = [inputs.end::<S, V>(simd, 0, 0), inputs.end::<S, V>(simd, 0, 1)];
        let local2 = [inputs.end::<S, V>(simd, 1, 0), inputs.end::<S, V>(simd, 1, 1)];
        let ends2 = [pose12.point(&local2[0]), pose12.point(&local2[1])];
        let radii = [inputs.radius::<S, V>(simd, 0), inputs.radius::<S, V>(simd, 1)];
        let apart = SegmentGap::of(simd, [&ends1, &ends2]);
        let ((reach1, is_in_range1), (reach2, is_in_range2)) =
            (farther(simd, &ends1), farther(simd, &local2));
        let size = (reach1 + radii[0]) + (reach2 + radii[1]) + pose12.apart();
        let sizes = [half_length(simd, &ends1) + radii[0], half_length(simd, &local2) + radii[1]];
        sizes[0].smaller(sizes[1]).store(&mut found.size);
        let normal = apart.normal;
        let line = ContactLine {
            normal,
            tangent: [normal[1], -normal[0]],
            point1: plus(&apart.points[0], &times(&normal, radii[0])),
            distance: apart.gap - radii[0] - radii[1],
            tolerance: rounding_of::<S, N, V>(simd, size),
            prediction: inputs.prediction(simd),
            sine: inputs.sine(simd),
        };
        let sides = [
            LaneSide::of(simd, &line, &ends1, radii[0], true),
            LaneSide::of(simd, &line, &ends2, radii[1], false),
        ];
        let contacts = SegmentContacts::of(simd, &line, &sides);
        contacts.store(found);
        line.tolerance.store(&mut found.tolerance);
        let is_apart = apart.is_known & line.distance.simd_gt(line.prediction);
        let is_fit = apart.is_known & is_in_range1 & is_in_range2 & contacts.is_known;
        found.put(
            simd,
            inputs,
            (line.distance, is_fit | is_apart),
            [&normal, &contacts.first.point1],
        );
    }

    #[inline(always)]
    fn features(parts: u8) -> [FeatureId; 2] {
        [END_OR_SIDE[usize::from(parts & 3)], END_OR_SIDE[usize::from(parts >> 2 & 3)]]
    }
}

/// A point or vector in 2D, in each lane.
type PlaneLanes<V> = [V; 2];

/// The tangent line through the nearest point of the first solid, and the limits of the request.
struct ContactLine<V> {
    /// Unit vector from the first core to the second, in the frame of the first solid.
    normal: PlaneLanes<V>,
    /// `normal` rotated clockwise by a right angle.
    tangent: PlaneLanes<V>,
    /// Nearest point of the first solid, on its rounded surface: the origin of the tangent.
    point1: PlaneLanes<V>,
    /// Signed distance of the solids along the normal; negative for an overlap.
    distance: V,
    /// Largest length that counts as a rounding error.
    tolerance: V,
    prediction: V,
    sine: V,
}

impl<V> ContactLine<V> {
    /// Returns the coordinate of a point along the tangent.
    #[inline(always)]
    fn flat<S: Simd>(&self, point: &PlaneLanes<V>) -> V
    where
        V: Wide<S>,
    {
        dot(&self.tangent, &minus(point, &self.point1))
    }

    /// Returns the distance to store for two points at the coordinate `flat`. It is at least the
    /// distance of the solids; if it exceeds the prediction by at most the tolerance, it is lowered
    /// to the prediction. The mask has the lanes where the request admits the points: the distance
    /// is within the prediction, up to the tolerance, or a rotation about the nearest point brings
    /// it within.
    #[inline(always)]
    fn admit<S: Simd>(&self, distance: V, flat: V) -> (V, V::Mask)
    where
        V: Wide<S>,
    {
        let distance = distance.larger(self.distance);
        let is_near = distance.simd_le(self.prediction);
        let is_at = distance.simd_le(self.prediction + self.tolerance);
        let is_by_rotation = distance.simd_le(self.prediction + self.sine * flat.abs());
        let beyond = is_at.select(self.prediction, distance);
        (is_near.select(distance, beyond), is_near | is_at | is_by_rotation)
    }
}

/// A segment or capsule, projected onto the tangent.
struct LaneSide<V, M> {
    /// Whether this is the first solid of the pair, the lower one along the normal.
    is_first: bool,
    /// Ends in the order of their coordinates along the tangent.
    ends: [PlaneLanes<V>; 2],
    /// Coordinates of `ends` along the tangent.
    coordinates: [V; 2],
    /// Lanes where the order of `ends` is the reverse of their order in the segment.
    is_reversed: M,
    /// Radius around the segment.
    radius: V,
    /// Cosine of the angle between the segment and the tangent.
    cosine: V,
    /// For the core's end nearest to the other solid: its depth below the solid's nearest point,
    /// along the normal, then its coordinate along the tangent.
    top: (V, V),
    /// Lanes where the segment is tilted against the tangent by more than 60°. There only its end
    /// nearest to the other solid is used.
    is_point: M,
    /// Lanes where the coordinates of both ends differ by more than rounding.
    is_wide: M,
    /// Lanes where the nearest point lies at the segment's first end, and at its last.
    at_witness: [M; 2],
}

impl<V, M> LaneSide<V, M> {
    /// Projects a segment onto the tangent; `is_first` if it belongs to the first solid.
    #[inline(always)]
    fn of<S: Simd, N: Real>(
        simd: S,
        line: &ContactLine<V>,
        ends: &[PlaneLanes<V>; 2],
        radius: V,
        is_first: bool,
    ) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let [first, last] = ends;
        let flats = [line.flat(first), line.flat(last)];
        let is_reversed = flats[1].simd_lt(flats[0]);
        let coordinates = [flats[0].smaller(flats[1]), flats[0].larger(flats[1])];
        let length = coordinates[1] - coordinates[0];
        let cosine = length / norm(&minus(last, first));
        let is_point = cosine.simd_lt(lit::<S, N, V>(simd, 0.5));
        let heights = [dot(&line.normal, first), dot(&line.normal, last)];
        let is_higher = heights[1].simd_gt(heights[0]);
        let is_last_near = if is_first { is_higher } else { heights[1].simd_lt(heights[0]) };
        // An end is at the nearest point if its coordinate differs from zero by at most twice the
        // tolerance; if both ends are, only the first counts.
        let near = lit::<S, N, V>(simd, 2.0) * line.tolerance;
        let is_at = [flats[0].abs().simd_le(near), flats[1].abs().simd_le(near)];
        let mut side = Self {
            is_first,
            ends: [either(is_reversed, last, first), either(is_reversed, first, last)],
            coordinates,
            is_reversed,
            radius,
            cosine,
            top: (radius, is_last_near.select(flats[1], flats[0])),
            is_point,
            is_wide: length.simd_gt(line.tolerance),
            at_witness: [
                either_mask(is_point, !is_last_near, is_at[0]),
                either_mask(is_point, is_last_near, is_at[1] & !is_at[0]),
            ],
        };
        side.top.0 = side.below_witness(&either(is_last_near, last, first), line);
        side
    }

    /// Returns the depth of a point of the core below the solid's nearest point, along the normal.
    #[inline(always)]
    fn below_witness<S: Simd>(&self, point: &PlaneLanes<V>, line: &ContactLine<V>) -> V
    where
        V: Wide<S>,
    {
        let height = dot(&line.normal, &minus(point, &line.point1));
        if self.is_first { -height } else { height - line.distance }
    }

    /// Returns the point of the core at `coordinate` along the tangent, clamped to the core's ends.
    #[inline(always)]
    fn under<S: Simd, N: Real>(&self, simd: S, coordinate: V) -> PlaneLanes<V>
    where
        V: Wide<S, Scalar = N>,
    {
        let share =
            (coordinate - self.coordinates[0]) / (self.coordinates[1] - self.coordinates[0]);
        let share = share.larger(V::all(simd, N::ZERO)).smaller(V::all(simd, N::ONE));
        plus(&self.ends[0], &times(&minus(&self.ends[1], &self.ends[0]), share))
    }

    /// Returns the height of the rounded surface above a point of the core, along the normal: at
    /// least zero, and at most the point's depth below the solid's nearest point.
    #[inline(always)]
    fn lift<S: Simd, N: Real>(&self, simd: S, core: &PlaneLanes<V>, line: &ContactLine<V>) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let depth = self.below_witness(core, line);
        let away = line.flat(core) - self.top.1;
        let (away_squared, radius) = (away * away, self.radius);
        // Up to this squared distance along the tangent, the surface is the ball around the core's
        // end nearest to the other solid. Farther away it is parallel to the core, at the height
        // `radius / cosine` along the normal.
        let turns_squared = radius * radius * (one - self.cosine * self.cosine);
        let round = depth - self.top.0 + (radius * radius - away_squared).sqrt();
        let is_round = away_squared.simd_lt(turns_squared);
        let lift = is_round.select(round, radius / self.cosine);
        let lift = lift.smaller(depth).larger(zero);
        radius.simd_le(zero).select(zero, lift)
    }

    /// Returns the lanes where `ends[end]` is the segment's first end, and the lanes where it is
    /// the segment's last end.
    #[inline(always)]
    fn end_masks<S: Simd>(&self, end: usize) -> [M; 2]
    where
        M: SimdMask<S>,
    {
        let (reversed, straight) = (self.is_reversed, !self.is_reversed);
        if end == 0 { [straight, reversed] } else { [reversed, straight] }
    }
}

/// A contact: two points that face each other along the normal.
struct LaneContact<V, M> {
    /// Point on the surface of the first solid.
    point1: PlaneLanes<V>,
    /// Signed distance along the normal, at least the distance of the pair.
    distance: V,
    /// Lanes where the request admits the contact.
    is_admitted: M,
    /// Lanes where the point is at the first and the last end of the first segment, then of the
    /// second.
    parts: [M; 4],
}

impl<V, M> LaneContact<V, M> {
    /// Computes the contact at one end of the overlap interval; `end` is 0 for the lower end, 1 for
    /// the upper.
    #[inline(always)]
    fn of<S: Simd, N: Real>(
        simd: S,
        line: &ContactLine<V>,
        sides: &[LaneSide<V, M>; 2],
        end: usize,
        coordinate: V,
    ) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let [first, second] = sides;
        let is_at = [first, second].map(|side| {
            // Lanes where this segment ends at the contact, up to the tolerance.
            (side.coordinates[end] - coordinate).abs().simd_le(line.tolerance)
        });
        let cores = [first.under(simd, coordinate), second.under(simd, coordinate)];
        // Both points move by half their offset along the tangent, so that they face each other
        // along the normal.
        let gap = minus(&cores[1], &cores[0]);
        let across = minus(&gap, &times(&line.normal, dot(&line.normal, &gap)));
        let half = times(&across, V::all(simd, N::HALF));
        let cores = [plus(&cores[0], &half), minus(&cores[1], &half)];
        let lifts = [first.lift(simd, &cores[0], line), second.lift(simd, &cores[1], line)];
        let distance = dot(&line.normal, &minus(&cores[1], &cores[0])) - lifts[0] - lifts[1];
        let point1 = plus(&cores[0], &times(&line.normal, lifts[0]));
        let (distance, is_admitted) = line.admit(distance, line.flat(&point1));
        let (end_masks1, end_masks2) = (first.end_masks(end), second.end_masks(end));
        let parts = [
            is_at[0] & end_masks1[0],
            is_at[0] & end_masks1[1],
            is_at[1] & end_masks2[0],
            is_at[1] & end_masks2[1],
        ];
        Self { point1, distance, is_admitted, parts }
    }

    /// Selects `other` in the lanes of `is_other`, else `self`.
    #[inline(always)]
    fn or<S: Simd>(&self, other: &Self, is_other: M) -> Self
    where
        V: Wide<S, Mask = M>,
        M: SimdMask<S>,
    {
        let (own, others) = (&self.parts, &other.parts);
        Self {
            point1: either(is_other, &other.point1, &self.point1),
            distance: is_other.select(other.distance, self.distance),
            is_admitted: either_mask(is_other, other.is_admitted, self.is_admitted),
            parts: filled(
                #[inline(always)]
                |part| either_mask(is_other, others[part], own[part]),
            ),
        }
    }
}

/// One or two contacts of each pair.
struct SegmentContacts<V, M> {
    first: LaneContact<V, M>,
    second: LaneContact<V, M>,
    /// Lanes with a second contact; elsewhere `second` is unused.
    is_two: M,
    /// Lanes where these contacts are complete; the other lanes fall back.
    is_known: M,
}

impl<V, M> SegmentContacts<V, M> {
    /// Computes the contacts: the ends of the overlap interval that the request admits, or the
    /// nearest points of the solids if it admits neither end.
    ///
    /// A lane is not known if its result depends on rounding, or if it needs the nearest points in
    /// addition to an end.
    #[inline(always)]
    fn of<S: Simd, N: Real>(simd: S, line: &ContactLine<V>, sides: &[LaneSide<V, M>; 2]) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let [first, second] = sides;
        let from = first.coordinates[0].larger(second.coordinates[0]);
        let to = first.coordinates[1].smaller(second.coordinates[1]);
        // Overlaps and gaps of up to 4 tolerances depend on rounding; lanes with such an interval
        // fall back.
        let few = lit::<S, N, V>(simd, 4.0) * line.tolerance;
        let is_side = !first.is_point & !second.is_point;
        let is_shared = (to - from).simd_gt(few) & is_side;
        let is_beside = (from - to).simd_gt(few) | !is_side;
        let mut low = LaneContact::of(simd, line, sides, 0, from);
        let mut high = LaneContact::of(simd, line, sides, 1, to);
        low.is_admitted &= is_shared;
        high.is_admitted &= is_shared;
        let is_two = low.is_admitted & high.is_admitted;
        let is_any = low.is_admitted | high.is_admitted;
        // If ends are admitted but neither has the distance of the pair, up to the tolerance, the
        // nearest points are needed as well, and the lane falls back.
        let level = line.distance + line.tolerance;
        let is_level = (low.is_admitted & low.distance.simd_le(level))
            | (high.is_admitted & high.distance.simd_le(level));
        let [[a, b], [c, d]] = [first.at_witness, second.at_witness];
        let witness = LaneContact {
            point1: line.point1,
            distance: line.distance,
            is_admitted: !is_any,
            parts: [a, b, c, d],
        };
        let is_wide = first.is_wide & second.is_wide;
        Self {
            first: high.or(&low, low.is_admitted).or(&witness, !is_any),
            second: high,
            is_two,
            is_known: (is_shared | is_beside) & (is_level | !is_any) & is_wide,
        }
    }

    /// Stores the contacts and their parts; see the figure of [`closed_form`](super::closed_form).
    #[inline(always)]
    fn store<S: Simd, N: Real, const L: usize>(&self, found: &mut LaneContacts<N, 2, L>)
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let parts = self.first.parts.iter().chain(&self.second.parts);
        for (row, part) in found.parts.iter_mut().zip(parts) {
            *row = bits(*part);
        }
        self.first.distance.store(&mut found.distances[0]);
        self.second.distance.store(&mut found.distances[1]);
        for axis in 0..2 {
            self.second.point1[axis].store(&mut found.points1[1][axis]);
        }
        found.is_two = bits(self.is_two);
    }
}
