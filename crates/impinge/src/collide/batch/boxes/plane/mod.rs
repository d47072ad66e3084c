//! Boxes in 2D: the separating axis test and the overlap of two facing sides, one of each box, for
//! several pairs at a time. The lower side is the side of the separating axis, and the upper side
//! is a side of the other box ([`sides`]).
//!
//! ```text
//!    upper   0 *---.___            slot 0, 1   ends of the upper side
//!                      '---* 1     slot 2, 3   ends of the lower side
//!    lower     2 *========* 3      at_ends     two bits for each slot: at the first or second end
//!                                              of the other side
//!
//!   The ends of both sides are ordered by their coordinate along the lower side.
//!   Bits of the byte `sides` of a pair, of which `features` encodes bits 0 to 5 in a code:
//!     0  lower side is perpendicular to y        4  lower side belongs to the second box
//!     1  lower side is at the positive end       5  ends of the upper side are swapped
//!     2  upper side is perpendicular to y        6  pair is beyond the prediction
//!     3  upper side is at the positive end       7  slots are filled
//!   In bits 0 to 3, y and the positive end belong to the frame of the side's own box.
//! ```

mod axis;
mod features;
mod sides;

use self::features::SideFeatures;
use self::sides::BoxSides;
use super::admit::{Admission, Limits, Slots};
use super::choose::SlotChoice;
use super::masks::per_pair;
use super::{Inputs, smaller_size};
use crate::collide::RawManifold;
use crate::collide::batch::{Batch, PairQuestion};
use crate::math::lanes::{bits, lit};
use crate::math::simd::Simd;
use crate::math::{Real, Wide};

/// Number of slots: two for the ends of the upper side, ordered by coordinate along the lower side,
/// then two for the ends of the lower side.
const SLOTS: usize = 4;

/// Results of the kernel for `L` pairs.
pub(in super::super) struct LaneSides<N: Real, const L: usize> {
    slots: Slots<N, 2, SLOTS, L>,
    /// Signed distance of the boxes; negative for an overlap.
    gap: [N; L],
    /// Largest length that counts as a rounding error.
    tolerance: [N; L],
    /// Half the diagonal of the smaller box.
    size: [N; L],
    /// Unit normal from the first box to the second, in the frame of the first.
    normal: [[N; L]; 2],
    /// Flags of the pairs, in the order of the figure: before [`Self::turn`] one mask over the
    /// lanes for each flag, then one byte for each pair.
    sides: [u8; 8],
    /// Two masks for each slot: the lanes where its candidate is at the first end of the other
    /// side, and those where it is at the second. After [`Self::turn`], one byte for each pair.
    at_ends: [u8; 2 * SLOTS],
    /// After [`Self::turn`], one byte for each pair: in the low half the filled slots, in the high
    /// half the slots whose height is the gap, up to rounding.
    filled: [u8; 8],
}

/// Kernel for pairs of boxes in 2D.
pub(in super::super) struct Boxes2;

impl<N: Real, const L: usize> LaneSides<N, L> {
    fn new() -> Self {
        let row = [N::ZERO; L];
        Self {
            slots: Slots::new(),
            gap: row,
            tolerance: row,
            size: row,
            normal: [row; 2],
            sides: [0; 8],
            at_ends: [0; 2 * SLOTS],
            filled: [0; 8],
        }
    }
}

impl<N: Real> Batch<N, 2> for Boxes2 {
    type Found<const L: usize> = LaneSides<N, L>;

    fn blank<const L: usize>() -> LaneSides<N, L> {
        LaneSides::new()
    }

    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, 2, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, 2>,
    ) -> bool {
        inputs.put_boxes(lane, pair)
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, 2, L>,
        found: &mut LaneSides<N, L>,
    ) {
        found.find::<S, V>(simd, inputs);
        found.turn();
    }

    #[inline(always)]
    fn write_manifold<const L: usize>(
        found: &LaneSides<N, L>,
        lane: usize,
        max_points: usize,
        raw: &mut RawManifold<N, 2>,
    ) -> bool {
        found.write_manifold(lane & (L - 1), max_points, raw)
    }
}

impl<N: Real, const L: usize> LaneSides<N, L> {
    /// Runs the kernel: tests the axes, chooses the sides and fills the slots. Returns after the
    /// axis test if no lane has a supported pair within the prediction.
    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>>(&mut self, simd: S, inputs: &Inputs<N, 2, L>) {
        let (boxes, prediction) = (inputs.boxes::<S, V>(simd), inputs.prediction::<S, V>(simd));
        let axis = boxes.best_side(simd);
        let is_apart =
            axis.gap.simd_gt(prediction + lit::<S, N, V>(simd, 16.0) * axis.rounding_error);
        let is_near = axis.gap.simd_le(prediction) & axis.is_finite;
        let is_apart = bits(is_apart & axis.is_finite);
        let is_candidate = bits(is_near) & inputs.is_usable;
        // These flags are final if the kernel returns after the axis test.
        self.sides = [0, 0, 0, 0, 0, 0, is_apart, 0];
        if is_candidate == 0 {
            return;
        }
        let sides = BoxSides::of_axis(simd, &boxes, &axis);
        let (gap, sine, tolerance) = (axis.gap, inputs.sine::<S, V>(simd), sides.tolerance);
        let mut admission = Admission::new(simd, Limits { gap, prediction, sine, tolerance });
        self.at_ends = sides.share(simd, &mut admission, &mut self.slots);
        let is_built = bits(admission.is_found() & sides.is_fit) & is_candidate;
        self.sides = [
            bits(sides.is_y),
            bits(sides.is_upward),
            bits(sides.is_own_y),
            bits(sides.is_positive),
            bits(axis.is_second),
            bits(sides.is_reversed),
            is_apart,
            is_built,
        ];
        axis.gap.store(&mut self.gap);
        smaller_size(&boxes).store(&mut self.size);
        sides.tolerance.store(&mut self.tolerance);
        axis.normal[0].store(&mut self.normal[0]);
        axis.normal[1].store(&mut self.normal[1]);
        let is_second = axis.is_second;
        admission.admit(
            simd,
            &mut self.slots,
            #[inline(always)]
            |[coordinate, _], height| sides.point1(simd, &boxes, is_second, coordinate, height),
        );
    }

    /// Transposes the masks, so that `sides`, `at_ends` and `filled` have one byte for each pair.
    #[inline(always)]
    fn turn(&mut self) {
        let [a, b, c, d] = self.slots.valid;
        let [e, f, g, h] = self.slots.level;
        self.filled = per_pair([a, b, c, d, e, f, g, h]);
        (self.sides, self.at_ends) = (per_pair(self.sides), per_pair(self.at_ends));
    }

    /// Replaces the manifold of the pair in `lane`; clears its points if the boxes are beyond the
    /// prediction. Returns `false`, without a change, if the pair has to fall back.
    #[inline(always)]
    fn write_manifold(&self, lane: usize, max_points: usize, raw: &mut RawManifold<N, 2>) -> bool {
        let features = SideFeatures { sides: self.sides[lane], at_ends: self.at_ends[lane] };
        let (is_apart, is_built) = (features.sides & 64 != 0, features.sides & 128 != 0);
        if is_apart {
            raw.points.clear();
        } else if is_built {
            let slots = u32::from(self.filled[lane]);
            let choice = SlotChoice {
                slots: &self.slots,
                lane,
                valid: slots & 15,
                level: slots >> SLOTS,
                gap: self.gap[lane],
                tolerance: self.tolerance[lane],
                size: self.size[lane],
                normal: &self.normal,
            };
            choice.write_manifold(&features, max_points.clamp(1, 2), raw);
        }
        is_apart | is_built
    }
}
