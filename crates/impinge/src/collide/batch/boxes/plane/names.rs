//! Features and codes of the slots of one pair in 2D.
//!
//! ```text
//!   code   31   12             7         5       0
//!          [1 | ... | 6 bits of | at_end | slot ]
//!                     the sides
//! ```

use super::SLOTS;
use crate::collide::RawPoint;
use crate::collide::batch::boxes::choose::Naming;
use crate::math::Real;
use crate::shape::FeatureId;

/// Features of a side: the side, its end on the negative side of its axis, and its other end.
type PartNames = [FeatureId; 3];

/// Sides of a box, by axis across them plus 2 on the positive side.
static SIDES: [PartNames; 4] = [parts(0, false), parts(1, false), parts(0, true), parts(1, true)];

/// Returns the vertex with these signs: of the coordinate on `axis`, and of the other coordinate.
const fn vertex(axis: usize, is_positive: bool, other_is_positive: bool) -> FeatureId {
    FeatureId::Vertex((is_positive as u32) << axis | (other_is_positive as u32) << (1 - axis))
}

/// Returns the side perpendicular to an axis.
const fn side(axis: usize, is_positive: bool) -> FeatureId {
    FeatureId::Face(2 * (axis == 1) as u32 + !is_positive as u32)
}

const fn parts(axis: usize, is_positive: bool) -> PartNames {
    [side(axis, is_positive), vertex(axis, is_positive, false), vertex(axis, is_positive, true)]
}

/// Returns the index of the part with this id.
#[inline(always)]
fn part(parts: &PartNames, id: FeatureId) -> Option<usize> {
    let end = usize::from(id == parts[1]) + 2 * usize::from(id == parts[2]);
    (id == parts[end]).then_some(end)
}

/// Names of the slots of one pair: the byte `LaneSides::sides`, and two bits for each slot that say
/// whether it is at the first or the second end of the other side.
#[derive(Clone, Copy)]
pub(super) struct SideNames {
    /// Byte of the pair in `LaneSides::sides`.
    pub(super) sides: u8,
    /// Byte of the pair in `LaneSides::at_ends`: two bits for each slot.
    pub(super) at_ends: u8,
}

/// The bits of the sides that a code holds, and their positions in it; bit 31 of every code is set.
const SIDE_BITS: u8 = 63;
const AT_END_AT: u32 = 5;
const SIDES_AT: u32 = 7;
const MARK: u32 = 1 << 31;

impl SideNames {
    /// Returns 0 for a slot beside the other side's inside, 1 at its first end, 2 at its second.
    #[inline(always)]
    const fn at_end(self, slot: usize) -> u8 {
        self.at_ends >> (2 * slot) & 3
    }

    #[inline(always)]
    fn below(self) -> &'static PartNames {
        &SIDES[usize::from(self.sides & 3)]
    }

    #[inline(always)]
    fn above(self) -> &'static PartNames {
        &SIDES[usize::from(self.sides >> 2 & 3)]
    }

    /// Maps an end of the upper side from the order of places to the order of its box, or back.
    #[inline(always)]
    const fn turned(self, part: usize) -> usize {
        if self.sides & 32 != 0 && part != 0 { 3 - part } else { part }
    }
}

impl Naming for SideNames {
    #[inline(always)]
    fn features(&self, slot: usize) -> [FeatureId; 2] {
        let (own, other) = (usize::from(slot & 1 == 1) + 1, usize::from(self.at_end(slot)));
        let (below, above) = if slot < 2 { (other, own) } else { (own, other) };
        let (below, above) = (self.below()[below], self.above()[self.turned(above)]);
        if self.sides & 16 == 0 { [below, above] } else { [above, below] }
    }

    #[inline(always)]
    fn slot<N: Real, const D: usize>(&self, point: &RawPoint<N, D>, valid: u32) -> Option<usize> {
        let (first, second) = (point.feature1, point.feature2);
        let (below, above) = if self.sides & 16 == 0 { (first, second) } else { (second, first) };
        let below = part(self.below(), below)?;
        let above = self.turned(part(self.above(), above)?);
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
