//! From the filled slots of one pair to its manifold: the rules of `choose`, without moving anything.

use smallvec::SmallVec;

use super::LANES;
use super::admit::Slots;
use crate::math::{Real, Vector, cross2};
use crate::query::manifold_build::reduce::{ALMOST, NEW_POINT_WEIGHT};
use crate::query::{RawManifold, RawPoint};
use crate::shape::FeatureId;

/// The most slots of a pair: those of space.
pub(super) const SLOTS: usize = 24;

/// The slots of one pair.
pub(super) struct Choice<'a, N: Real, const D: usize, const COUNT: usize> {
    pub(super) slots: &'a Slots<N, D, COUNT>,
    pub(super) lane: usize,
    /// The slots that hold a candidate, by bits.
    pub(super) valid: u32,
    /// Those with the smallest distance but for rounding.
    pub(super) level: u32,
    pub(super) gap: N,
    pub(super) tolerance: N,
}

/// How the slots of one pair are named.
pub(super) trait Naming {
    /// The features of a candidate, of the first and the second box.
    fn features(&self, slot: usize) -> [FeatureId; 2];

    /// The candidate with the features of a point, among those that there are.
    fn slot<N: Real, const D: usize>(&self, point: &RawPoint<N, D>, valid: u32) -> Option<usize>;

    /// A number, not zero, that no candidate of any pair has but in this slot with these features;
    /// the slot is in the lowest bits.
    fn code(&self, slot: usize) -> u32;
}

/// The bits of a code that are the slot.
const SLOT_BITS: u32 = 31;

/// The slot that a code tells.
#[inline(always)]
const fn slot_of(code: u32) -> usize {
    (code & SLOT_BITS) as usize
}

/// The numbers of the old points, for the slots that have their names.
struct Kept {
    slots: u32,
    /// All of the old points are candidates again, and in the same slots.
    is_still: bool,
    ids: [u32; SLOTS],
}

impl Kept {
    /// Takes over the numbers; no two old points share their names, nor do two slots.
    #[inline(always)]
    fn of<N: Real, const D: usize>(
        old: &[RawPoint<N, D>],
        naming: &impl Naming,
        valid: u32,
    ) -> Self {
        let mut kept = Self { slots: 0, is_still: true, ids: [0; SLOTS] };
        for point in old {
            let own = slot_of(point.code);
            let is_same = point.code == naming.code(own) && valid >> own & 1 == 1;
            kept.is_still &= is_same;
            let slot = if is_same { Some(own) } else { naming.slot(point, valid & !kept.slots) };
            if let Some(slot) = slot {
                kept.slots |= 1 << slot;
                kept.ids[slot] = point.id;
            }
        }
        kept
    }

    #[inline(always)]
    const fn has(&self, slot: usize) -> bool {
        self.slots >> slot & 1 == 1
    }
}

/// Some slots in order.
#[derive(Clone, Copy)]
struct Chosen {
    len: usize,
    slots: [u8; SLOTS],
    /// The same by bits.
    mask: u32,
}

impl Chosen {
    #[inline(always)]
    fn push(&mut self, slot: usize) {
        self.slots[self.len] = slot.to_le_bytes()[0];
        self.mask |= 1 << slot;
        self.len += 1;
    }

    #[inline(always)]
    fn iter(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        self.slots[..self.len].iter().map(|&slot| usize::from(slot))
    }

    #[inline(always)]
    fn insert(&mut self, place: usize, slot: usize) {
        self.slots.copy_within(place..self.len, place + 1);
        self.slots[place] = slot.to_le_bytes()[0];
        self.mask |= 1 << slot;
        self.len += 1;
    }
}

/// The numbers of the bits that are set, upwards.
#[inline(always)]
const fn ones(bits: u32) -> Ones {
    Ones(bits)
}

#[derive(Clone)]
struct Ones(u32);

impl Iterator for Ones {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let slot = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (slot < SLOTS).then_some(slot)
    }

    #[inline(always)]
    fn count(self) -> usize {
        self.0.count_ones() as usize
    }
}

impl<N: Real, const D: usize, const COUNT: usize> Choice<'_, N, D, COUNT> {
    /// Replaces the points of a manifold, whose normal is given, by at most `limit` of the candidates.
    #[inline(always)]
    pub(super) fn settle(&self, naming: &impl Naming, limit: usize, raw: &mut RawManifold<N, D>) {
        let kept = Kept::of(&raw.points, naming, self.valid);
        let deepest = self.deepest(kept.slots);
        if self.valid.count_ones() as usize > limit {
            let chosen = self.outline(deepest, limit, kept.slots);
            if kept.is_still && kept.slots == chosen.mask {
                self.put_all(deepest, raw);
            } else {
                self.replace(chosen.iter(), deepest, (&kept, naming), raw);
            }
        } else if kept.is_still && kept.slots == self.valid {
            self.put_all(deepest, raw);
        } else {
            self.replace(ones(self.valid), deepest, (&kept, naming), raw);
        }
    }

    /// Nothing has changed but places.
    #[inline(always)]
    fn put_all(&self, deepest: usize, raw: &mut RawManifold<N, D>) {
        for point in &mut raw.points {
            self.put(slot_of(point.code), deepest, point);
        }
    }

    /// Puts the points of some slots, in order of their numbers, in the place of those there are.
    #[inline(always)]
    fn replace(
        &self,
        chosen: impl Iterator<Item = usize> + Clone,
        deepest: usize,
        (kept, naming): (&Kept, &impl Naming),
        raw: &mut RawManifold<N, D>,
    ) {
        raw.points.resize(chosen.clone().count(), RawPoint::default());
        let (mut last, mut is_sorted) = (0, true);
        for (slot, point) in chosen.zip(&mut raw.points) {
            point.id = if kept.has(slot) { kept.ids[slot] } else { raw.ids.next() };
            is_sorted &= last <= point.id;
            last = point.id;
            self.put(slot, deepest, point);
            [point.feature1, point.feature2] = naming.features(slot);
            point.code = naming.code(slot);
        }
        if !is_sorted {
            raw.points.sort_by_key(|point| point.id);
        }
    }

    /// Says where the candidate of a slot is.
    #[inline(always)]
    fn put(&self, slot: usize, deepest: usize, point: &mut RawPoint<N, D>) {
        let lane = self.lane & (LANES - 1);
        for (x, row) in point.point1.iter_mut().zip(&self.slots.points1[slot]) {
            *x = row[lane];
        }
        point.distance = if slot == deepest { self.gap } else { self.distance(slot) };
    }

    #[inline(always)]
    fn distance(&self, slot: usize) -> N {
        self.slots.distances[slot][self.lane & (LANES - 1)]
    }

    #[inline(always)]
    fn flat(&self, slot: usize) -> [N; 2] {
        let [x, y] = &self.slots.flat;
        [x[slot][self.lane & (LANES - 1)], y[slot][self.lane & (LANES - 1)]]
    }

    /// The candidate that stands for the witness: of those whose distance is the smallest but for
    /// rounding one that the previous manifold held, then the deepest.
    #[inline(always)]
    fn deepest(&self, kept: u32) -> usize {
        let old = self.level & kept;
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

    /// The deepest, then whatever adds most to the outline, as `reduce::chosen` has it.
    #[inline(always)]
    fn outline(&self, deepest: usize, limit: usize, kept: u32) -> Chosen {
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
    fn by_depth(&self, slots: u32, kept: u32) -> Rest<N> {
        let (mut order, mut keys) = (Chosen { len: 0, slots: [0; SLOTS], mask: 0 }, [0_i64; SLOTS]);
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
            if kept >> slot & 1 == 0 {
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
        let mut chosen = Chosen { len: 0, slots: [0; SLOTS], mask: 0 };
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
