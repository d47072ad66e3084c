//! Contacts of two balls, for several pairs at a time. `collide/separation/balls/ball_ball.rs` is
//! the code for one pair.
//!
//! Reads these fields of [`Inputs`]: both `translations`, both `radii` and `prediction`.

use super::closed_form::{Form, LaneContacts};
use super::gather::Inputs;
use super::vectors::{times, unit};
use super::{PairQuestion, Solid};
use crate::math::simd::Simd;
use crate::math::{Real, Wide};
use crate::shape::FeatureId;

/// Kernel for two balls. The pair falls back to the builder for one pair if the square of the
/// distance of the centres is near underflow (so also if the centres coincide) or overflow.
pub(super) struct BallBall;

impl<N: Real, const D: usize> Form<N, D> for BallBall {
    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, D, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, D>,
    ) -> bool {
        let [Solid::Ball(ball1), Solid::Ball(ball2)] = pair.solids else { return false };
        inputs.put_centers(lane, pair);
        inputs.put_radius(lane, 0, ball1.radius());
        inputs.put_radius(lane, 1, ball2.radius());
        true
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, D, L>,
        found: &mut LaneContacts<N, D, L>,
    ) {
        let (normal, apart, is_in_range) = unit(simd, &inputs.away::<S, V>(simd));
        let (radius1, radius2) = (inputs.radius::<S, V>(simd, 0), inputs.radius::<S, V>(simd, 1));
        let distance = apart - radius1 - radius2;
        let point1 = times(&normal, radius1);
        radius1.smaller(radius2).store(&mut found.size);
        found.put(simd, inputs, (distance, is_in_range), [&normal, &point1]);
    }

    #[inline(always)]
    fn features(_: u8) -> [FeatureId; 2] {
        [FeatureId::Face(0); 2]
    }
}
