//! Names of the slots of one pair in 2D.

use super::SLOTS;
use crate::collide::RawPoint;
use crate::collide::batch::boxes::choose::Naming;
use crate::math::Real;
use crate::shape::FeatureId;

/// A side, the end on the negative side of the axis along it, the other end.
type PartNames = [FeatureId; 3];

/// The sides of a box by their axis, plus twice whether they are on its positive side.
static SIDES: [PartNames; 4] = [parts(0, false), parts(1, false), parts(0, true), parts(1, true)];

/// The vertex with these positive coordinates: along the axis, and along the other one.
const fn vertex(axis: usize, is_positive: bool, other_is_positive: bool) -> FeatureId {
    FeatureId::Vertex((is_positive as u32) << axis | (other_is_positive as u32) << (1 - axis))
}

/// The side that is perpendicular to an axis.
const fn side(axis: usize, is_positive: bool) -> FeatureId {
    FeatureId::Face(2 * (axis == 1) as u32 + !is_positive as u32)
}

const fn parts(axis: usize, is_positive: bool) -> PartNames {
    [side(axis, is_positive), vertex(axis, is_positive, false), vertex(axis, is_positive, true)]
}

/// The part of these that has a name.
#[inline(always)]
fn part(parts: &PartNames, id: FeatureId) -> Option<usize> {
    let end = usize::from(id == parts[1]) + 2 * usize::from(id == parts[2]);
    (id == parts[end]).then_some(end)
}

/// How the slots of one pair are named: from the bits of the sides (`EightSides::sides`), and two bits for
/// each slot that say whether it is at the first end of the other side or the second.
#[derive(Clone, Copy)]
pub(super) struct SideNames {
    pub(super) sides: u8,
    pub(super) at_ends: u8,
}

/// The bits of the sides that names depend on, and where they stand in a code; every code has the
/// last bit.
const SIDE_BITS: u8 = 63;
const AT_END_AT: u32 = 5;
const SIDES_AT: u32 = 7;
const MARK: u32 = 1 << 31;

impl SideNames {
    /// The side that a slot is beside (0), or its first or second end.
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

    /// An end of the upper side by its place along the lower one, or the reverse.
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
