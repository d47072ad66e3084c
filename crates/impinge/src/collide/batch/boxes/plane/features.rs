//! Features and codes of the slots of one pair in 2D.
//!
//! ```text
//!   code   31   12             7         5       0
//!          [1 | ... | 6 bits of | at_end | slot ]
//!                     the sides
//! ```

use super::SLOTS;
use crate::collide::RawPoint;
use crate::collide::batch::boxes::choose::SlotFeatures;
use crate::math::Real;
use crate::shape::FeatureId;

/// Features of one side: the side itself, then its ends at the negative and at the positive
/// coordinate along the side.
type PartFeatures = [FeatureId; 3];

/// Features of the four sides of a box. The index is the axis perpendicular to the side, plus 2 if
/// the side is at the positive coordinate.
static SIDES: [PartFeatures; 4] =
    [parts(0, false), parts(1, false), parts(0, true), parts(1, true)];

/// Returns the vertex whose coordinates on `axis` and on the other axis have these signs.
const fn vertex(axis: usize, is_positive: bool, other_is_positive: bool) -> FeatureId {
    FeatureId::Vertex((is_positive as u32) << axis | (other_is_positive as u32) << (1 - axis))
}

/// Returns the side perpendicular to `axis`, at the positive or negative coordinate.
const fn side(axis: usize, is_positive: bool) -> FeatureId {
    FeatureId::Face(2 * (axis == 1) as u32 + !is_positive as u32)
}

const fn parts(axis: usize, is_positive: bool) -> PartFeatures {
    [side(axis, is_positive), vertex(axis, is_positive, false), vertex(axis, is_positive, true)]
}

/// Returns the index in `parts` of the feature `id`; `None` if the feature belongs to another side.
#[inline(always)]
fn part(parts: &PartFeatures, id: FeatureId) -> Option<usize> {
    let end = usize::from(id == parts[1]) + 2 * usize::from(id == parts[2]);
    (id == parts[end]).then_some(end)
}

/// Features of the slots of one pair, decoded from the masks of the kernel.
#[derive(Clone, Copy)]
pub(super) struct SideFeatures {
    /// Byte of the pair in `LaneSides::sides`.
    pub(super) sides: u8,
    /// Byte of the pair in `LaneSides::at_ends`: two bits for each slot.
    pub(super) at_ends: u8,
}

/// Mask of the bits of `sides` that are stored in a code.
const SIDE_BITS: u8 = 63;
/// Position of `at_end` in a code.
const AT_END_AT: u32 = 5;
/// Position of the bits of `sides` in a code.
const SIDES_AT: u32 = 7;
/// Bit that is set in every code, so that no code is 0.
const MARK: u32 = 1 << 31;

impl SideFeatures {
    /// Returns where the candidate in `slot` lies on the other side: 0 between its ends, 1 at its
    /// first end, 2 at its second end.
    #[inline(always)]
    const fn at_end(self, slot: usize) -> u8 {
        self.at_ends >> (2 * slot) & 3
    }

    #[inline(always)]
    fn below(self) -> &'static PartFeatures {
        &SIDES[usize::from(self.sides & 3)]
    }

    #[inline(always)]
    fn above(self) -> &'static PartFeatures {
        &SIDES[usize::from(self.sides >> 2 & 3)]
    }

    /// Maps the index of an end of the upper side (1 or 2) from the order along the lower side to
    /// the order in its own box, or back. Index 0, the side itself, stays 0.
    #[inline(always)]
    const fn reordered(self, part: usize) -> usize {
        if self.sides & 32 != 0 && part != 0 { 3 - part } else { part }
    }
}

impl SlotFeatures for SideFeatures {
    #[inline(always)]
    fn features(&self, slot: usize) -> [FeatureId; 2] {
        let (own, other) = (usize::from(slot & 1 == 1) + 1, usize::from(self.at_end(slot)));
        let (below, above) = if slot < 2 { (other, own) } else { (own, other) };
        let (below, above) = (self.below()[below], self.above()[self.reordered(above)]);
        if self.sides & 16 == 0 { [below, above] } else { [above, below] }
    }

    #[inline(always)]
    fn slot<N: Real, const D: usize>(&self, point: &RawPoint<N, D>, valid: u32) -> Option<usize> {
        let (first, second) = (point.feature1, point.feature2);
        let (below, above) = if self.sides & 16 == 0 { (first, second) } else { (second, first) };
        let below = part(self.below(), below)?;
        let above = self.reordered(part(self.above(), above)?);
        let is_it = |slot: usize, at_end: usize| {
            valid >> slot & 1 == 1 && usize::from(self.at_end(slot)) == at_end
        };
        if above != 0 && is_it(above - 1, below) {
            return Some(above - 1);
        }
        (below != 0 && is_it(below + 1, above)).then(|| below + 1)
    }

    #[inline(always)]
    fn code(&self, slot: usize) -> u32 {
        let slot = slot & (SLOTS - 1);
        MARK | u32::from(self.sides & SIDE_BITS) << SIDES_AT
            | u32::from(self.at_end(slot)) << AT_END_AT
            | u32::from(slot.to_le_bytes()[0])
    }
}
