//! Builds the manifold of one pair from its filled slots: the rules of `choose`, without moving any
//! candidate. A set of slots is a `u32`: bit `slot` of each.
//!
//! ```text
//!   code of a point   31        12            5         0
//!                     [1 | faces | parts       | slot   ]   layout of the middle: `Naming::code`
//! ```
//!
//! Bit 31 is always set, so no code is 0, which stands for points without a slot
//! (`raw_manifold.rs`).

use super::admit::Slots;
use crate::collide::manifold::ids::{in_order, is_same_point, near_scale, normals_agree};
use crate::collide::manifold::matching::each_near;
use crate::collide::manifold::reduce::{Projected, Projections, chosen};
use crate::collide::manifold::{ALL, slack_level};
use crate::collide::{RawManifold, RawPoint};
use crate::math::ones::Ones;
use crate::math::{Mapped, Point, Real, Vector};
use crate::shape::FeatureId;

/// The slots of one pair.
pub(super) struct SlotChoice<'a, N: Real, const D: usize, const COUNT: usize, const L: usize> {
    /// Slots of all lanes, of which this pair's are read.
    pub(super) slots: &'a Slots<N, D, COUNT, L>,
    /// Lane of the pair.
    pub(super) lane: usize,
    /// Bits of the slots that hold a candidate.
    pub(super) valid: u32,
    /// Bits of the slots with the smallest distance, up to rounding.
    pub(super) level: u32,
    /// Signed distance of the boxes, which the deepest point takes.
    pub(super) gap: N,
    /// Lengths up to this are rounding errors.
    pub(super) tolerance: N,
    /// Size of the pair, as `collide::size` defines it.
    pub(super) size: N,
    /// Normals of all lanes, from the first box to the second, in the frame of the first.
    pub(super) normal: &'a [[N; L]; D],
}

/// Features and codes of the slots of one pair.
pub(super) trait Naming {
    /// Returns the features of a candidate: of the first and the second box.
    fn features(&self, slot: usize) -> [FeatureId; 2];

    /// Returns the slot in `valid` whose candidate has the features of a point.
    fn slot<N: Real, const D: usize>(&self, point: &RawPoint<N, D>, valid: u32) -> Option<usize>;

    /// Returns the candidates in `among` on a feature of the second box; none unless it is a
    /// vertex.
    #[inline(always)]
    fn on_vertex(&self, feature: FeatureId, among: u32) -> u32 {
        if !matches!(feature, FeatureId::Vertex(_)) {
            return 0;
        }
        let is_on = |slot: &usize| self.features(*slot)[1] == feature;
        Ones::<SLOTS_OF_CODE>(among).filter(is_on).fold(0, |slots, slot| slots | 1 << slot)
    }

    /// Returns a code that no other slot and no other features of any pair have. It is not zero;
    /// the slot is in its lowest bits.
    fn code(&self, slot: usize) -> u32;
}

/// Mask of the slot in a code.
const SLOT_BITS: u32 = 31;
/// Number of slots that a code distinguishes.
const SLOTS_OF_CODE: usize = 32;

/// Decodes the slot.
#[inline(always)]
const fn slot_of(code: u32) -> usize {
    (code & SLOT_BITS) as usize
}

/// Ids of old points, by the slots that continue them.
struct KeptSlots<const COUNT: usize> {
    /// Bits of the slots that continue an old point.
    slots: u32,
    /// All old points are candidates again, in the same slots.
    is_still: bool,
    /// Bits of the old points that no slot continues.
    left: u32,
    /// Id of each slot in `slots`.
    ids: [u32; COUNT],
    /// Slot that continues each old point, by index in the manifold.
    heirs: [u8; COUNT],
}

impl<const COUNT: usize> KeptSlots<COUNT> {
    /// Keeps the ids of `slots` only; updates `left`.
    fn retain<N: Real, const D: usize>(&mut self, slots: u32, old: &[RawPoint<N, D>]) {
        self.slots &= slots;
        self.left = 0;
        for (at, point) in old.iter().enumerate() {
            let is_kept = Ones::<COUNT>(self.slots).any(|slot| self.ids[slot] == point.id);
            self.left |= u32::from(!is_kept) << (at & 31);
        }
    }
}

impl<N: Real, const D: usize, const COUNT: usize, const L: usize> SlotChoice<'_, N, D, COUNT, L> {
    /// Replaces the points of a manifold, and its normal, by at most `limit` candidates.
    ///
    /// 1. Old points find their slots by code, else by features ([`Self::kept`]).
    /// 2. Slots that jumped lose their ids ([`Self::drop_jumped`]).
    /// 3. Old points that are left give their ids by position ([`Self::match_places`]).
    /// 4. If there are too many candidates, some are chosen, with a preference for old points
    ///    ([`Self::chosen`]); ids of the others pass to chosen ones near them.
    /// 5. If nothing changed but positions, points are updated in place ([`Self::put_all`]); else
    ///    new ones get ids, and all are written in the order of ids ([`Self::replace`]).
    #[inline(always)]
    pub(super) fn settle(&self, naming: &impl Naming, limit: usize, raw: &mut RawManifold<N, D>) {
        let mut kept = self.kept(&raw.points, naming);
        if !kept.is_still {
            self.drop_jumped(&raw.points, &mut kept);
        }
        let normal = self.normal();
        // By position, only if the normal turned by at most 45°.
        let may_match = normals_agree(&raw.normal, &normal);
        if may_match && kept.left != 0 && kept.slots != self.valid {
            self.match_places(naming, raw, self.valid, &mut kept);
        }
        // Up to four candidates are all kept, as by `manifold::choose`.
        let is_full = self.valid.count_ones() as usize <= limit.min(ALL);
        let slots = if is_full { self.valid } else { self.chosen(limit, kept.slots) };
        if may_match && !is_full && !raw.points.is_empty() && slots & !kept.slots != 0 {
            // Ids of candidates that are not chosen go to chosen ones near them.
            kept.retain(slots, &raw.points);
            if kept.left != 0 {
                self.match_places(naming, raw, slots, &mut kept);
            }
        }
        let deepest = self.deepest(slots, kept.slots);
        if kept.is_still && kept.slots == slots {
            self.put_all(deepest, raw);
        } else {
            if slots & !kept.slots != 0 {
                self.begin(slots & !kept.slots, &mut kept, raw);
            }
            self.replace(slots, deepest, &kept, naming, raw);
        }
        raw.normal = normal;
    }

    /// Finds the slots of old points by their features; features of points, and of slots, are
    /// distinct.
    #[inline(always)]
    fn kept(&self, old: &[RawPoint<N, D>], naming: &impl Naming) -> KeptSlots<COUNT> {
        let mut kept =
            KeptSlots { slots: 0, is_still: true, left: 0, ids: [0; COUNT], heirs: [0; COUNT] };
        for (at, point) in old.iter().enumerate() {
            let own = slot_of(point.code);
            let is_same = point.code == naming.code(own) && self.valid >> own & 1 == 1;
            // A slot continues one old point at most.
            let free = self.valid & !kept.slots;
            let slot = if is_same { Some(own) } else { naming.slot(point, free) };
            kept.is_still &= is_same;
            if let Some(slot) = slot {
                kept.slots |= 1 << slot;
                kept.ids[slot] = point.id;
                kept.heirs[at % COUNT] = slot.to_le_bytes()[0];
            } else {
                kept.left |= 1 << (at & 31);
            }
        }
        kept
    }

    /// Takes ids back from slots that are too far from their old points ([`is_same_point`]).
    #[inline(always)]
    fn drop_jumped(&self, old: &[RawPoint<N, D>], kept: &mut KeptSlots<COUNT>) {
        for (at, point) in old.iter().enumerate() {
            let (slot, is_left) = (usize::from(kept.heirs[at % COUNT]), kept.left >> (at & 31) & 1);
            if is_left == 0 && !self.is_same(point, &self.point1(slot)) {
                kept.slots &= !(1 << slot);
                kept.left |= 1 << (at & 31);
            }
        }
    }

    /// Returns whether a candidate at `place`, with the features of `old`, is the same point.
    #[inline(always)]
    fn is_same(&self, old: &RawPoint<N, D>, place: &Point<N, D>) -> bool {
        is_same_point([old.feature1, old.feature2], &(place - old.point1), || self.size)
    }

    /// Gives the ids of the remaining old points to slots of `some` without an id, by position.
    #[inline(never)]
    fn match_places(
        &self,
        naming: &impl Naming,
        raw: &RawManifold<N, D>,
        some: u32,
        kept: &mut KeptSlots<COUNT>,
    ) {
        let (old, scale) = (&raw.points, near_scale(self.size));
        each_near(
            [kept.left, some & !kept.slots],
            |at, among| naming.on_vertex(old[at].feature2, among),
            |at, slot| ((self.point1(slot) - old[at].point1) * scale).norm_squared(),
            |at, slot| {
                kept.slots |= 1 << slot;
                kept.ids[slot] = old[at].id;
            },
        );
    }

    #[inline(always)]
    fn normal(&self) -> Vector<N, D> {
        let lane = self.lane & (L - 1);
        Vector::<N, D>::from_fn(
            #[inline(always)]
            |axis, _| self.normal[axis][lane],
        )
    }

    /// Updates positions and distances: slots, features and order have not changed.
    #[inline(always)]
    fn put_all(&self, deepest: usize, raw: &mut RawManifold<N, D>) {
        let mut has_jumped = false;
        for point in &mut raw.points {
            let old = *point;
            self.place(slot_of(point.code), deepest, point);
            // A crossing of two edges that jumped is a new contact.
            if !self.is_same(&old, &point.point1) {
                (point.id, has_jumped) = (raw.ids.next(), true);
            }
        }
        if has_jumped {
            raw.sort_points();
        }
    }

    /// Replaces the points by those of `slots`.
    #[inline(always)]
    fn replace(
        &self,
        slots: u32,
        deepest: usize,
        kept: &KeptSlots<COUNT>,
        naming: &impl Naming,
        raw: &mut RawManifold<N, D>,
    ) {
        let (order, count) = Self::by_ids(slots, kept);
        raw.points.resize(count, RawPoint::default());
        for (&slot, point) in order.iter().zip(&mut raw.points) {
            point.id = kept.ids[slot];
            self.place(slot, deepest, point);
            [point.feature1, point.feature2] = naming.features(slot);
            point.code = naming.code(slot);
        }
    }

    /// Gives new ids to the slots `new`, in the order in which the builder for one pair numbers
    /// points.
    #[inline(never)]
    fn begin(&self, new: u32, kept: &mut KeptSlots<COUNT>, raw: &mut RawManifold<N, D>) {
        for (_, slot) in in_order(Ones::<COUNT>(new).map(|slot| (slot, self.point1(slot)))) {
            kept.ids[slot] = raw.ids.next();
        }
    }

    /// Returns the slots in the order of their ids, and their number.
    #[inline(always)]
    fn by_ids(slots: u32, kept: &KeptSlots<COUNT>) -> ([usize; COUNT], usize) {
        let (mut order, mut count) = ([0; COUNT], 0);
        for slot in Ones::<COUNT>(slots) {
            // Insertion sort of a few slots.
            let mut at = count;
            while at > 0 && kept.ids[order[at - 1]] > kept.ids[slot] {
                order[at] = order[at - 1];
                at -= 1;
            }
            order[at] = slot;
            count += 1;
        }
        (order, count)
    }

    /// Writes position and distance of the candidate of a slot.
    #[inline(always)]
    fn place(&self, slot: usize, deepest: usize, point: &mut RawPoint<N, D>) {
        point.point1 = self.point1(slot);
        point.distance = if slot == deepest { self.gap } else { self.distance(slot) };
    }

    #[inline(always)]
    fn point1(&self, slot: usize) -> Point<N, D> {
        let (lane, rows) = (self.lane & (L - 1), &self.slots.points1[slot]);
        Point::from(Vector::<N, D>::from_fn(
            #[inline(always)]
            |axis, _| rows[axis][lane],
        ))
    }

    #[inline(always)]
    fn distance(&self, slot: usize) -> N {
        self.slots.distances[slot][self.lane & (L - 1)]
    }

    #[inline(always)]
    fn flat(&self, slot: usize) -> Vector<N, 2> {
        let [x, y] = &self.slots.flat;
        let lane = self.lane & (L - 1);
        Vector::<N, 2>::new(x[slot][lane], y[slot][lane])
    }

    /// Returns the slot that stands for the witness: among those with the smallest distance up to
    /// rounding one that continues an old point; then the deepest.
    #[inline(always)]
    fn deepest(&self, slots: u32, kept: u32) -> usize {
        let level = self.level & slots;
        let preferred = [level & kept, level, slots];
        self.lowest(preferred.into_iter().find(|&slots| slots != 0).unwrap_or(slots))
    }

    /// Returns the first slot with the smallest distance.
    #[inline(always)]
    fn lowest(&self, slots: u32) -> usize {
        let (mut lowest, mut distance) = (slots.trailing_zeros() as usize, N::INFINITY);
        if slots.count_ones() > 1 {
            for slot in Ones::<COUNT>(slots) {
                let new = self.distance(slot);
                if new < distance {
                    (lowest, distance) = (slot, new);
                }
            }
        }
        lowest
    }

    /// Returns at most `limit` slots, chosen as `reduce::chosen` does.
    #[inline(always)]
    fn chosen(&self, limit: usize, kept: u32) -> u32 {
        // Without a candidate at the gap, the lowest ones are level.
        let mut level = self.level;
        if level == 0 {
            let least = self.distance(self.lowest(self.valid));
            let lowest = Ones::<COUNT>(self.valid).filter(|&slot| self.distance(slot) <= least);
            level = lowest.fold(0, |slots, slot| slots | 1 << slot);
        }
        // If an old point is the deepest, no other has to stand for it.
        let has_old = level & kept != 0;
        let slack =
            if has_old { -N::INFINITY } else { slack_level(self.gap, self.size, self.tolerance) };
        let mut points = Projections::new();
        for slot in Ones::<COUNT>(self.valid) {
            let [is_level, is_kept] = [level, kept].mapped(|slots| slots >> slot & 1 == 1);
            let is_deepest = is_level || is_kept && self.distance(slot) <= slack;
            points.push(Projected { at: self.flat(slot), index: slot, is_deepest, is_kept });
        }
        chosen(&mut points, limit, self.tolerance).iter().fold(0, |slots, slot| slots | 1 << slot)
    }
}
