//! Contacts of a ball with a segment or capsule, for several pairs at a time.
//! `collide/separation/balls/ball_segment.rs` is the code for one pair.
//!
//! Reads these fields of [`Inputs`]: both `translations`, the segment's rotation, both `radii`,
//! `prediction`, and the ends of the core in `ends[1]`.

use super::closed_form::{Form, LaneContacts};
use super::gather::Inputs;
use super::nearest::{END_OR_SIDE, farther};
use super::vectors::{bits, dot, either, lit, minus, negated, rounding_of, times, unit};
use super::{PairQuestion, Solid};
use crate::collide::separation::nearest_on_segment;
use crate::math::simd::Simd;
use crate::math::{Real, Wide};
use crate::shape::FeatureId;

/// Kernel for a ball and a segment or capsule. The pair falls back to the builder for one pair if
/// the centre of the ball is so close to the core that the direction between them is inexact, or if
/// a squared length is near underflow or overflow (so also if the core has no length).
pub(super) struct BallSegment;

impl<N: Real, const D: usize> Form<N, D> for BallSegment {
    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, D, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, D>,
    ) -> bool {
        let Solid::Ball(ball) = pair.solids[0] else { return false };
        inputs.put_radius(lane, 0, ball.radius());
        inputs.put_beside_ball(lane, pair);
        inputs.put_core(lane, 1, pair.solids[1])
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, D, L>,
        found: &mut LaneContacts<N, D, L>,
    ) {
        let pose12 = inputs.beside_ball::<S, V>(simd);
        let ends = [inputs.end::<S, V>(simd, 1, 0), inputs.end::<S, V>(simd, 1, 1)];
        let (radius, rounding) = (inputs.radius::<S, V>(simd, 0), inputs.radius::<S, V>(simd, 1));
        let center = pose12.inverse_origin(simd);
        let near = nearest_on_segment(simd, &ends, &center);
        let offset = minus(&center, &near.point);
        let (direct, away, is_off) = unit(simd, &offset);
        let (axis, length, is_long) = unit(simd, &near.along);
        // If the nearest point is between the ends of the core and close to the centre of the ball,
        // the offset may be mostly rounding error. So the normal is made perpendicular to the core.
        let (sideways, is_beside) = made_perpendicular(simd, (&direct, is_off), &axis);
        let outward = either(near.is_inside, &sideways, &direct);
        let normal = negated(&pose12.vector(&outward));
        let point1 = times(&normal, radius);
        let (reach, is_in_range) = farther(simd, &ends);
        let size = radius + (reach + rounding) + pose12.apart();
        radius.smaller(lit::<S, N, V>(simd, 0.5) * length + rounding).store(&mut found.size);
        let rounding_error = lit::<S, N, V>(simd, 2.0) * rounding_of::<S, N, V>(simd, size);
        // A core no longer than the rounding error counts as an edge without ends.
        let (slack, is_edge) = (rounding_error * length, length.simd_le(rounding_error));
        let is_first = near.from_first.simd_le(slack) & !is_edge;
        let is_last = near.to_last.simd_le(slack) & !is_edge;
        found.parts[0] = bits(is_first);
        found.parts[1] = bits(is_last & !is_first);
        let is_known = (near.is_inside & is_beside) | (!near.is_inside & is_off);
        let distance = away - rounding - radius;
        found.put(simd, inputs, (distance, is_known & is_long & is_in_range), [&normal, &point1]);
    }

    #[inline(always)]
    fn features(parts: u8) -> [FeatureId; 2] {
        [FeatureId::Face(0), END_OR_SIDE[usize::from(parts & 3)]]
    }
}

/// Makes a unit vector `v` perpendicular to the unit vector `d`, as the scalar `made_perpendicular`
/// does. `is_off` are the lanes where `v` is valid; the returned mask has the lanes where the
/// result is accurate.
#[inline(always)]
fn made_perpendicular<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    (v, is_off): (&[V; D], V::Mask),
    d: &[V; D],
) -> ([V; D], V::Mask) {
    let (once, remainder, is_once) = unit(simd, &minus(v, &times(d, dot(v, d))));
    let (twice, _, is_twice) = unit(simd, &minus(&once, &times(d, dot(&once, d))));
    let least = lit::<S, N, V>(simd, 16.0) * V::all(simd, N::EPSILON);
    (twice, is_off & is_once & is_twice & remainder.simd_gt(least))
}
