//! From the filled slots of one pair to its manifold: the rules of `choose`, without moving anything.

use smallvec::SmallVec;

use super::clip::{SLOTS, Slots};
use super::names::Naming;
use crate::math::{Real, Vector, cross2, max, min};
use crate::query::RawManifold;
use crate::query::manifold_build::reduce::{ALMOST, NEW_POINT_WEIGHT};

/// The slots of one pair.
pub(super) struct Choice<'a, N: Real> {
    pub(super) slots: &'a Slots<N>,
    pub(super) lane: usize,
    /// The slots that hold a candidate, by bits.
    pub(super) valid: u32,
    /// Those with the smallest distance but for rounding.
    pub(super) level: u32,
    pub(super) gap: N,
    pub(super) prediction: N,
    pub(super) tolerance: N,
}

/// The numbers of the old points, for the slots that have their names.
pub(super) struct Kept {
    slots: u32,
    ids: [u32; SLOTS],
}

impl Kept {
    /// Takes over the numbers; no two old points share their names, nor do two slots.
    #[inline(always)]
    pub(super) fn of<N: Real>(old: &RawManifold<N, 3>, naming: &Naming, valid: u32) -> Self {
        let mut kept = Self { slots: 0, ids: [0; SLOTS] };
        for point in &old.points {
            let slot = naming.slot([point.feature1, point.feature2], valid & !kept.slots);
            if let Some(slot) = slot {
                kept.slots |= 1 << slot;
                kept.ids[slot] = point.id;
            }
        }
        kept
    }

    #[inline(always)]
    pub(super) fn id(&self, slot: usize) -> Option<u32> {
        self.has(slot).then(|| self.ids[slot])
    }

    #[inline(always)]
    fn has(&self, slot: usize) -> bool {
        self.slots >> slot & 1 == 1
    }
}

/// Some slots in order.
#[derive(Clone, Copy)]
pub(super) struct Chosen {
    len: usize,
    slots: [u8; SLOTS],
}

impl Chosen {
    #[inline(always)]
    fn all(valid: u32) -> Self {
        let mut all = Self { len: 0, slots: [0; SLOTS] };
        for slot in ones(valid) {
            all.push(slot);
        }
        all
    }

    #[inline(always)]
    fn push(&mut self, slot: usize) {
        self.slots[self.len] = slot.to_le_bytes()[0];
        self.len += 1;
    }

    #[inline(always)]
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(super) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.slots[..self.len].iter().map(|&slot| usize::from(slot))
    }

    #[inline(always)]
    fn insert(&mut self, place: usize, slot: usize) {
        self.slots.copy_within(place..self.len, place + 1);
        self.slots[place] = slot.to_le_bytes()[0];
        self.len += 1;
    }
}

/// The numbers of the bits that are set, upwards.
#[inline(always)]
fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let slot = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (slot < SLOTS).then_some(slot)
    })
}

impl<N: Real> Choice<'_, N> {
    #[inline(always)]
    pub(super) fn distance(&self, slot: usize) -> N {
        min(max(self.slots.height[slot][self.lane], self.gap), self.prediction)
    }

    #[inline(always)]
    fn flat(&self, slot: usize) -> [N; 2] {
        let [x, y] = &self.slots.flat;
        [x[slot][self.lane], y[slot][self.lane]]
    }

    /// The candidate that stands for the witness: of those whose distance is the smallest but for
    /// rounding one that the previous manifold held, then the deepest.
    #[inline(always)]
    pub(super) fn deepest(&self, kept: &Kept) -> usize {
        let old = self.level & kept.slots;
        let level = if self.level == 0 { self.valid } else { self.level };
        self.lowest(if old == 0 { level } else { old })
    }

    /// The first of some slots with the smallest distance of them.
    #[inline(always)]
    fn lowest(&self, slots: u32) -> usize {
        let (mut lowest, mut distance) = (slots.trailing_zeros() as usize, N::INFINITY);
        if slots.count_ones() > 1 {
            for slot in ones(slots) {
                let new = self.distance(slot);
                if new < distance {
                    (lowest, distance) = (slot, new);
                }
            }
        }
        lowest
    }

    /// At most `limit` candidates.
    #[inline(always)]
    pub(super) fn chosen(&self, deepest: usize, limit: usize, kept: &Kept) -> Chosen {
        if self.valid.count_ones() as usize <= limit {
            Chosen::all(self.valid)
        } else {
            self.outline(deepest, limit, kept)
        }
    }

    /// The deepest, then whatever adds most to the outline, as `reduce::chosen` has it.
    #[inline(always)]
    fn outline(&self, deepest: usize, limit: usize, kept: &Kept) -> Chosen {
        let mut outline = Outline::new(deepest, self.flat(deepest), self.tolerance);
        let rest = self.by_depth(self.valid & !(1 << deepest), kept);
        let mut left = (1_u32 << rest.len) - 1;
        while outline.chosen.len < limit {
            let Some((index, place)) = outline.best_addition(&rest, left) else { break };
            outline.insert(place, usize::from(rest.slots[index]), rest.flat[index]);
            left &= !(1 << index);
        }
        outline.chosen
    }

    /// Slots by distance; of equals the first comes first.
    #[inline(always)]
    fn by_depth(&self, slots: u32, kept: &Kept) -> Rest<N> {
        let (mut order, mut keys) = (Chosen { len: 0, slots: [0; SLOTS] }, [0_i64; SLOTS]);
        for slot in ones(slots) {
            let (key, mut at) = (total(self.distance(slot)), order.len);
            while at > 0 && keys[at - 1] > key {
                (keys[at], order.slots[at]) = (keys[at - 1], order.slots[at - 1]);
                at -= 1;
            }
            (keys[at], order.slots[at]) = (key, slot.to_le_bytes()[0]);
            order.len += 1;
        }
        let mut rest = Rest {
            len: order.len,
            slots: order.slots,
            flat: [[N::ZERO; 2]; SLOTS],
            weights: [N::ONE; SLOTS],
        };
        for (index, slot) in order.iter().enumerate() {
            rest.flat[index] = self.flat(slot);
            if !kept.has(slot) {
                rest.weights[index] = N::lit(NEW_POINT_WEIGHT);
            }
        }
        rest
    }
}

/// The candidates that an outline may grow by, the deepest first.
struct Rest<N: Real> {
    len: usize,
    slots: [u8; SLOTS],
    flat: [[N; 2]; SLOTS],
    /// What their gain counts for.
    weights: [N; SLOTS],
}

/// The points chosen so far, counter-clockwise.
struct Outline<N: Real> {
    chosen: Chosen,
    corners: [[N; 2]; SLOTS],
    tolerance: N,
}

/// From a corner to the next, and the least area beyond it that is more than rounding errors.
#[derive(Clone, Copy)]
struct OutlineSide<N: Real> {
    from: [N; 2],
    along: Vector<N, 2>,
    least: N,
}

impl<N: Real> Outline<N> {
    #[inline(always)]
    fn new(slot: usize, flat: [N; 2], tolerance: N) -> Self {
        let mut chosen = Chosen { len: 0, slots: [0; SLOTS] };
        chosen.push(slot);
        Self { chosen, corners: [flat; SLOTS], tolerance }
    }

    #[inline(always)]
    fn insert(&mut self, place: usize, slot: usize, flat: [N; 2]) {
        self.corners.copy_within(place..self.chosen.len, place + 1);
        self.corners[place] = flat;
        self.chosen.insert(place, slot);
    }

    /// The candidate that adds most and its place in the outline; `None` if none adds more than
    /// rounding errors.
    #[inline(always)]
    fn best_addition(&self, rest: &Rest<N>, left: u32) -> Option<(usize, usize)> {
        let mut sides: SmallVec<[OutlineSide<N>; 8]> = SmallVec::new();
        if self.chosen.len > 1 {
            sides.extend((0..self.chosen.len).map(|at| self.side(at)));
        }
        let (mut best, mut best_gain) = (None, N::ZERO);
        for index in ones(left) {
            let flat = Vector::<N, 2>::from(rest.flat[index]);
            let (gain, place) = if sides.is_empty() {
                let distance = (flat - Vector::<N, 2>::from(self.corners[0])).norm();
                (if distance > self.tolerance { distance } else { N::ZERO }, 1)
            } else {
                beyond(&sides, &flat)
            };
            let gain = gain * rest.weights[index];
            if gain > best_gain * N::lit(ALMOST) {
                (best, best_gain) = (Some((index, place)), gain);
            }
        }
        best
    }

    #[inline(always)]
    fn side(&self, at: usize) -> OutlineSide<N> {
        let next = if at + 1 < self.chosen.len { at + 1 } else { 0 };
        let from = self.corners[at];
        let along = Vector::<N, 2>::from(self.corners[next]) - Vector::<N, 2>::from(from);
        OutlineSide { from, along, least: self.tolerance * along.norm() }
    }
}

/// The largest area (doubled) that a place spans with a side of the outline from outside, and its
/// place in the outline.
#[inline(always)]
fn beyond<N: Real>(sides: &[OutlineSide<N>], flat: &Vector<N, 2>) -> (N, usize) {
    let (mut gain, mut best) = (N::ZERO, 0);
    for (at, side) in sides.iter().enumerate() {
        let area = -cross2(&side.along, &(flat - Vector::<N, 2>::from(side.from)));
        if area > gain && area > side.least {
            (gain, best) = (area, at + 1);
        }
    }
    (gain, best)
}

/// A number that is ordered as `total_cmp` orders the scalar.
#[inline(always)]
fn total<N: Real>(value: N) -> i64 {
    let bits = value.as_f64().to_bits().cast_signed();
    if bits < 0 { bits ^ i64::MAX } else { bits }
}
