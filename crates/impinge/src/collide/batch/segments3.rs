//! Contacts of segments and capsules in 3D, for several pairs at a time.
//! `collide/separation/segments/segment_segment.rs` is the code for one pair.
//!
//! Reads these fields of [`Inputs`]: both poses, both `radii`, the ends of both cores, `prediction`
//! and `sine`. Lanes in which the code for one pair takes another branch fall back: if the normal
//! is not the direction between the nearest points, if the cores are nearly parallel, or if the
//! vector between the ends of a core has a largest component outside 2⁻¹⁶ to 2¹⁶.

use super::PairQuestion;
use super::closed_form::{Form, LaneContacts};
use super::gather::Inputs;
use super::nearest::{END_OR_SIDE, farther, half_length};
use super::vectors::{bits, cross, dot, either, lit, minus, norm, plus, rounding_of, times, unit};
use crate::collide::separation::nearest_on_segment;
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};
use crate::shape::FeatureId;

/// Kernel for segments and capsules whose cores are apart and, projected along the normal, not
/// nearly parallel.
pub(super) struct Segments3;

/// Ends of a segment in each lane.
type SegmentEnds<V> = [[V; 3]; 2];

impl<N: Real> Form<N, 3> for Segments3 {
    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, 3, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, 3>,
    ) -> bool {
        inputs.put_cores(lane, pair)
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, 3, L>,
        found: &mut LaneContacts<N, 3, L>,
    ) {
        let pose12 = inputs.pose12::<S, V>(simd);
        let ends1 = [inputs.end::<S, V>(simd, 0, 0), inputs.end::<S, V>(simd, 0, 1)];
        let local2 = [inputs.end::<S, V>(simd, 1, 0), inputs.end::<S, V>(simd, 1, 1)];
        let ends2 = [pose12.point(&local2[0]), pose12.point(&local2[1])];
        let radii = [inputs.radius::<S, V>(simd, 0), inputs.radius::<S, V>(simd, 1)];
        let (points, has_scale) = nearest_of_segments(simd, &ends1, &ends2);
        let (normal, distance, is_best) = best_normal(simd, [&ends1, &ends2], &points);
        let rounded = [
            plus(&points[0], &times(&normal, radii[0])),
            minus(&points[1], &times(&normal, radii[1])),
        ];
        let ((reach1, is_in_range1), (reach2, is_in_range2)) =
            (farther(simd, &ends1), farther(simd, &local2));
        let size = (reach1 + radii[0]) + (reach2 + radii[1]) + pose12.apart();
        let sizes = [half_length(simd, &ends1) + radii[0], half_length(simd, &local2) + radii[1]];
        sizes[0].smaller(sizes[1]).store(&mut found.size);
        let rounding_error = lit::<S, N, V>(simd, 2.0) * rounding_of::<S, N, V>(simd, size);
        // Moves the points from the surface back to the cores, with the rounding of the builder for
        // one pair.
        let core1 = minus(&rounded[0], &times(&normal, radii[0]));
        let core2 = plus(&rounded[1], &times(&normal, radii[1]));
        // Nearly parallel segments may touch in two points, so they fall back.
        let is_crossing = is_crossing(simd, [&ends1, &ends2], &normal, inputs.sine(simd));
        let has_part1 = found.put_end_or_side(0, &core1, &ends1, rounding_error);
        let has_part2 = found.put_end_or_side(2, &core2, &ends2, rounding_error);
        let signed = distance - radii[0] - radii[1];
        let is_apart = has_scale & signed.simd_gt(inputs.prediction::<S, V>(simd));
        let is_found =
            has_scale & is_best & is_in_range1 & is_in_range2 & is_crossing & has_part1 & has_part2;
        found.put(simd, inputs, (signed, is_found | is_apart), [&normal, &rounded[0]]);
    }

    #[inline(always)]
    fn features(parts: u8) -> [FeatureId; 2] {
        [END_OR_SIDE[usize::from(parts & 3)], END_OR_SIDE[usize::from(parts >> 2 & 3)]]
    }
}

/// A point on each of two segments, and the squared distance of the two points.
struct SegmentPoints<V> {
    /// Points on the first and on the second segment, in the frame of the first solid.
    points: SegmentEnds<V>,
    squared: V,
}

impl<V> SegmentPoints<V> {
    #[inline(always)]
    fn new<S: Simd>(points: SegmentEnds<V>) -> Self
    where
        V: Wide<S>,
    {
        let between = minus(&points[1], &points[0]);
        Self { points, squared: dot(&between, &between) }
    }

    /// Selects `other` in the lanes of `is_admitted` where its points are nearer to each other than
    /// those of `self`. `None` admits all lanes.
    #[inline(always)]
    fn or_nearer<S: Simd>(&self, other: &Self, is_admitted: Option<V::Mask>) -> Self
    where
        V: Wide<S>,
    {
        let is_nearer = other.squared.simd_lt(self.squared);
        let is_nearer = match is_admitted {
            Some(is_admitted) => is_nearer & is_admitted,
            None => is_nearer,
        };
        let points = [
            either(is_nearer, &other.points[0], &self.points[0]),
            either(is_nearer, &other.points[1], &self.points[1]),
        ];
        Self { points, squared: is_nearer.select(other.squared, self.squared) }
    }
}

/// Computes the nearest points of two segments, as the scalar `nearest_of_segments` does. The mask
/// has the lanes where both segments can be scaled: the largest component of each direction vector,
/// by magnitude, is at least 2⁻¹⁶ and less than 2¹⁶ (see [`scaled`]).
#[inline(always)]
pub(super) fn nearest_of_segments<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    ends1: &SegmentEnds<V>,
    ends2: &SegmentEnds<V>,
) -> (SegmentEnds<V>, V::Mask) {
    let on1 = [
        nearest_on_segment(simd, ends1, &ends2[0]).point,
        nearest_on_segment(simd, ends1, &ends2[1]).point,
    ];
    let on2 = [
        nearest_on_segment(simd, ends2, &ends1[0]).point,
        nearest_on_segment(simd, ends2, &ends1[1]).point,
    ];
    let mut best = SegmentPoints::new([ends1[0], on2[0]]);
    for points in [[ends1[1], on2[1]], [on1[0], ends2[0]], [on1[1], ends2[1]]] {
        best = best.or_nearer(&SegmentPoints::new(points), None);
    }
    let (common, is_common, has_scale) = common_perpendicular(simd, ends1, ends2);
    (best.or_nearer(&SegmentPoints::new(common), Some(is_common)).points, has_scale)
}

/// Returns the largest power of two that does not exceed `number`, if `number` is at least 2⁻¹⁶ and
/// less than 2¹⁶; the mask has the lanes where it is.
#[inline(always)]
fn power_of_two_below<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    number: V,
) -> (V, V::Mask) {
    let (least, most) = (lit::<S, N, V>(simd, 1.0 / 65536.0), lit::<S, N, V>(simd, 65536.0));
    let mut power = least;
    for factor in [65536.0, 256.0, 16.0, 4.0, 2.0] {
        let next = power * lit::<S, N, V>(simd, factor);
        power = next.simd_le(number).select(next, power);
    }
    (power, number.simd_ge(least) & number.simd_lt(most))
}

/// Divides a vector by the largest power of two that does not exceed its largest component by
/// magnitude. Also returns the reciprocal of that power, which is exact. The mask has the lanes
/// where the component is at least 2⁻¹⁶ and less than 2¹⁶, as [`power_of_two_below`] requires.
#[inline(always)]
fn scaled<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, v: &[V; 3]) -> ([V; 3], V, V::Mask) {
    let largest = v[2].abs().larger(v[1].abs().larger(v[0].abs()));
    let (size, has_scale) = power_of_two_below(simd, largest);
    let inverse = V::all(simd, N::ONE) / size;
    (times(v, inverse), inverse, has_scale)
}

/// Computes the ends of the common perpendicular of two lines, as the scalar `common_perpendicular`
/// does. The first mask has the lanes where the lines are not parallel and both ends lie on the
/// segments. The second has the lanes where both segments can be scaled: the largest component of
/// each direction vector, by magnitude, is at least 2⁻¹⁶ and less than 2¹⁶ (see [`scaled`]).
#[inline(always)]
fn common_perpendicular<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    ends1: &SegmentEnds<V>,
    ends2: &SegmentEnds<V>,
) -> (SegmentEnds<V>, V::Mask, V::Mask) {
    let (along1, along2) = (minus(&ends1[1], &ends1[0]), minus(&ends2[1], &ends2[0]));
    let (toward1, inverse1, has_scale1) = scaled(simd, &along1);
    let (toward2, inverse2, has_scale2) = scaled(simd, &along2);
    let across = cross(&toward1, &toward2);
    let squared = dot(&across, &across);
    let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
    let tiny = V::all(simd, N::lit(64.0) * N::EPSILON * N::EPSILON);
    let least = tiny * dot(&toward1, &toward1) * dot(&toward2, &toward2);
    let (mut s, mut t, mut between) = (zero, zero, minus(&ends2[0], &ends1[0]));
    let mut points = [ends1[0], ends2[0]];
    for _ in 0..3 {
        s += dot(&cross(&between, &toward2), &across) / squared * inverse1;
        t += dot(&cross(&between, &toward1), &across) / squared * inverse2;
        points = [plus(&ends1[0], &times(&along1, s)), plus(&ends2[0], &times(&along2, t))];
        between = minus(&points[1], &points[0]);
    }
    let is_inside = s.simd_ge(zero) & s.simd_le(one) & t.simd_ge(zero) & t.simd_le(one);
    (points, is_inside & squared.simd_gt(least), has_scale1 & has_scale2)
}

/// Computes the unit vector and the distance between the nearest points. The mask has the lanes
/// where the scalar `best_normal` chooses this direction: where the projections of the cores onto
/// it are apart by this distance, up to rounding.
#[inline(always)]
fn best_normal<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [ends1, ends2]: [&SegmentEnds<V>; 2],
    points: &SegmentEnds<V>,
) -> ([V; 3], V, V::Mask) {
    let mut reach = V::all(simd, N::ZERO);
    for end in [&ends1[0], &ends1[1], &ends2[0], &ends2[1]] {
        reach = norm(end).larger(reach);
    }
    let rounding_error = lit::<S, N, V>(simd, 8.0) * V::all(simd, N::EPSILON) * reach;
    let (normal, distance, is_in_range) = unit(simd, &minus(&points[1], &points[0]));
    let high = dot(&normal, &ends1[1]).larger(dot(&normal, &ends1[0]));
    let low = dot(&normal, &ends2[1]).smaller(dot(&normal, &ends2[0]));
    let is_best = (low - high + rounding_error / lit::<S, N, V>(simd, 4.0)).simd_ge(distance);
    (normal, distance, is_best & is_in_range)
}

/// Returns the lanes where the angle between the segments, projected along the normal, has a sine
/// of more than twice `sine` and more than 32 epsilons.
#[inline(always)]
fn is_crossing<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [ends1, ends2]: [&SegmentEnds<V>; 2],
    normal: &[V; 3],
    sine: V,
) -> V::Mask {
    let (along1, along2) = (minus(&ends1[1], &ends1[0]), minus(&ends2[1], &ends2[0]));
    let (flat1, flat2) = (flat(&along1, normal), flat(&along2, normal));
    let rounding_error = lit::<S, N, V>(simd, 16.0) * V::all(simd, N::EPSILON);
    let least = lit::<S, N, V>(simd, 2.0) * sine.larger(rounding_error);
    let turn = dot(normal, &cross(&along1, &along2));
    (turn * turn).simd_gt(least * least * flat1 * flat2)
}

/// Returns the squared length of the vector `along`, projected along a unit normal.
#[inline(always)]
fn flat<S: Simd, V: Wide<S>>(along: &[V; 3], normal: &[V; 3]) -> V {
    let high = dot(normal, along);
    dot(along, along) - high * high
}

impl<N: Real, const L: usize> LaneContacts<N, 3, L> {
    /// Stores the part of a segment that a point lies on, as `part_of` of `manifold/ring.rs` does:
    /// in row `slot` of `parts` a mask of the lanes where the point is at the first end, in the
    /// next row those where it is at the last end. Returns the lanes where the point is not at both
    /// ends.
    #[inline(always)]
    fn put_end_or_side<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        slot: usize,
        point: &[V; 3],
        [first, last]: &SegmentEnds<V>,
        rounding_error: V,
    ) -> V::Mask {
        let along = minus(last, first);
        let (squared, reached) = (dot(&along, &along), dot(&minus(point, first), &along));
        let slack = rounding_error * squared.sqrt();
        let (is_first, is_last) = (reached.simd_le(slack), (squared - reached).simd_le(slack));
        self.parts[slot] = bits(is_first);
        self.parts[slot + 1] = bits(is_last);
        !(is_first & is_last)
    }
}
