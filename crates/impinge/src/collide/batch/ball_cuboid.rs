//! Contacts of a ball and a box, for several pairs at a time.
//! `collide/separation/balls/ball_cuboid.rs` is the code for one pair.
//!
//! Reads these fields of [`Inputs`]: both `translations`, the box's rotation, the ball's
//! `radii[0]`, `prediction`, and the half extents in `ends[1][0]`.

use super::closed_form::{Form, LaneContacts};
use super::gather::Inputs;
use super::vectors::{bits, length_of, lit, minus, negated, rounding_of, times, unit};
use super::{PairQuestion, Solid};
use crate::math::simd::Simd;
use crate::math::{Real, Wide, filled};
use crate::shape::{Cuboid, FeatureId};

/// Kernel for a ball and a box. The pair falls back to the builder for one pair if the centre of
/// the ball lies in the box, if a half extent is at most four times the rounding error, or if the
/// squared half diagonal or the squared distance of the centre from the box is near underflow or
/// overflow.
pub(super) struct BallCuboid;

impl<N: Real, const D: usize> Form<N, D> for BallCuboid {
    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, D, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, D>,
    ) -> bool {
        let [Solid::Ball(ball), Solid::Cuboid(cuboid)] = pair.solids else { return false };
        inputs.put_beside_ball(lane, pair);
        inputs.put_radius(lane, 0, ball.radius());
        inputs.put_end(lane, 1, 0, cuboid.half_extents());
        true
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, D, L>,
        found: &mut LaneContacts<N, D, L>,
    ) {
        let (pose12, half) = (inputs.beside_ball::<S, V>(simd), inputs.end(simd, 1, 0));
        let radius = inputs.radius(simd, 0);
        let center = pose12.inverse_origin(simd);
        // Point of the box nearest to the centre of the ball. If the centre is inside the box, this
        // point is the centre itself, and the pair falls back.
        let clamped = filled(
            #[inline(always)]
            |axis| center[axis].smaller(half[axis]).larger(-half[axis]),
        );
        let (outward, away, is_outside) = unit(simd, &minus(&center, &clamped));
        let normal = negated(&pose12.vector(&outward));
        let point1 = times(&normal, radius);
        let (reach, is_box) = length_of(simd, &half);
        let rounding_error = rounding_of::<S, N, V>(simd, radius + reach + pose12.apart());
        // Transforms the point to the ball's frame and back, so that it is rounded as in the
        // builder for one pair.
        let touched = pose12.inverse_point(&pose12.point(&clamped));
        radius.smaller(reach).store(&mut found.size);
        let is_thick = found.put_part(simd, [&touched, &half], rounding_error);
        let is_certain = is_outside & is_box & is_thick;
        found.put(simd, inputs, (away - radius, is_certain), [&normal, &point1]);
    }

    #[inline(always)]
    fn features(parts: u8) -> [FeatureId; 2] {
        [FeatureId::Face(0), Cuboid::<N, D>::id_of_bits(parts)]
    }
}

impl<N: Real, const D: usize, const L: usize> LaneContacts<N, D, L> {
    /// Stores which feature of its box contains `point`, as `Cuboid::part_at` computes it: for each
    /// axis, a mask of the lanes where the feature extends along the axis; then for each axis, a
    /// mask of the lanes where the coordinate of `point` is not negative. Returns the lanes where
    /// all half extents exceed four times `rounding_error` and `point` is not deeper than
    /// `rounding_error` inside the box.
    #[inline(always)]
    fn put_part<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        [point, half]: [&[V; D]; 2],
        rounding_error: V,
    ) -> V::Mask {
        let thin = lit::<S, N, V>(simd, 4.0) * rounding_error;
        let mut is_thick = half[0].simd_gt(thin);
        let mut is_inside = point[0].abs().simd_lt(half[0] - rounding_error);
        for axis in 0..D {
            let is_free = point[axis].abs().simd_lt(half[axis] - rounding_error);
            is_thick &= half[axis].simd_gt(thin);
            is_inside &= is_free;
            self.parts[axis] = bits(is_free);
            self.parts[D + axis] = !bits(point[axis].simd_lt(V::all(simd, N::ZERO)));
        }
        is_thick & !is_inside
    }
}
