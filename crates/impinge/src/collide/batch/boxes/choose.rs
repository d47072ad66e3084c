//! Builds the manifold of one pair from its filled slots by the rules of `manifold::choose`,
//! without moving candidates. A set of slots is a `u32` whose bit `slot` belongs to that slot.
//!
//! ```text
//!   code of a point   31        12            5         0
//!                     [1 | faces | parts       | slot   ]   middle bits: `SlotFeatures::code`
//! ```
//!
//! Bit 31 is set in every code, because the code 0 marks a point without a slot
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

/// The slots of one pair, from which the points of its manifold are chosen.
pub(super) struct SlotChoice<'a, N: Real, const D: usize, const COUNT: usize, const L: usize> {
    /// Slots of all lanes; only `lane` is read.
    pub(super) slots: &'a Slots<N, D, COUNT, L>,
    /// Lane of the pair.
    pub(super) lane: usize,
    /// Bits of the filled slots.
    pub(super) valid: u32,
    /// Bits of the slots whose height is the gap, up to rounding.
    pub(super) level: u32,
    /// Signed distance of the boxes. The slot that [`Self::deepest`] returns gets exactly this
    /// distance.
    pub(super) gap: N,
    /// Largest length that counts as a rounding error.
    pub(super) tolerance: N,
    /// Length scale of the pair, as `collide::size` defines it.
    pub(super) size: N,
    /// Normals of all lanes, from the first box to the second, in the frame of the first.
    pub(super) normal: &'a [[N; L]; D],
}

/// Features and codes of the slots of one pair.
pub(super) trait SlotFeatures {
    /// Returns the features of the candidate in `slot`, on the first box and on the second.
    fn features(&self, slot: usize) -> [FeatureId; 2];

    /// Returns the slot in `valid` whose candidate has the features of `point`; `None` if there is
    /// none.
    fn slot<N: Real, const D: usize>(&self, point: &RawPoint<N, D>, valid: u32) -> Option<usize>;

    /// Returns the slots in `among` whose candidate is on `feature` of the second box; 0 unless the
    /// feature is a vertex.
    #[inline(always)]
    fn on_vertex(&self, feature: FeatureId, among: u32) -> u32 {
        if !matches!(feature, FeatureId::Vertex(_)) {
            return 0;
        }
        let is_on = |slot: &usize| self.features(*slot)[1] == feature;
        Ones::<SLOTS_OF_CODE>(among).filter(is_on).fold(0, |slots, slot| slots | 1 << slot)
    }

    /// Returns the code of the candidate in `slot`: not 0, different for every slot and every pair
    /// of features, with the slot in its lowest bits.
    fn code(&self, slot: usize) -> u32;
}

/// Mask of the bits that hold the slot in a code.
const SLOT_BITS: u32 = 31;
/// Number of slots that a code distinguishes.
const SLOTS_OF_CODE: usize = 32;

/// Returns the slot stored in a code.
#[inline(always)]
const fn slot_of(code: u32) -> usize {
    (code & SLOT_BITS) as usize
}

/// Assignment of the points of the previous update to the slots that continue them.
struct KeptSlots<const COUNT: usize> {
    /// Bits of the slots that continue an old point.
    slots: u32,
    /// Whether every old point still has its candidate, in the slot of its code.
    is_still: bool,
    /// Bits of the old points (by index in the manifold) that no slot continues.
    left: u32,
    /// Id of each slot in `slots`.
    ids: [u32; COUNT],
    /// Slot that continues each old point, by the point's index in the manifold.
    heirs: [u8; COUNT],
}

impl<const COUNT: usize> KeptSlots<COUNT> {
    /// Drops the assignments to slots outside `slots`; updates `left`.
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
    /// Replaces the points of a manifold by at most `limit` candidates, and its normal by the new
    /// normal.
    ///
    /// 1. Old points find their slots by code, else by features ([`Self::kept`]).
    /// 2. Slots that are too far from their old points lose the ids ([`Self::drop_jumped`]).
    /// 3. Old points without a slot pass on their ids by position ([`Self::match_positions`]).
    /// 4. If there are more than `limit` candidates, some are chosen, with a preference for slots
    ///    that continue old points ([`Self::chosen`]); ids of unchosen slots pass to chosen slots
    ///    near them.
    /// 5. If only positions changed, the points are updated in place ([`Self::put_all`]); else new
    ///    points get ids and all points are written in the order of ids ([`Self::replace`]).
    #[inline(always)]
    pub(super) fn write_manifold(
        &self,
        slot_features: &impl SlotFeatures,
        limit: usize,
        raw: &mut RawManifold<N, D>,
    ) {
        let mut kept = self.kept(&raw.points, slot_features);
        if !kept.is_still {
            self.drop_jumped(raw, &mut kept);
        }
        let normal = self.normal();
        // Ids pass by position only if the normal turned by at most 45°.
        let may_match = normals_agree(&raw.normal, &normal);
        if may_match && kept.left != 0 && kept.slots != self.valid {
            self.match_positions(slot_features, raw, self.valid, &mut kept);
        }
        // All candidates are kept if they are no more than `limit` and `ALL`, as in
        // `manifold::choose`.
        let is_full = self.valid.count_ones() as usize <= limit.min(ALL);
        let slots = if is_full { self.valid } else { self.chosen(limit, kept.slots) };
        if may_match && !is_full && !raw.points.is_empty() && slots & !kept.slots != 0 {
            // Ids of slots that are not chosen pass to chosen slots near them.
            kept.retain(slots, &raw.points);
            if kept.left != 0 {
                self.match_positions(slot_features, raw, slots, &mut kept);
            }
        }
        let deepest = self.deepest(slots, kept.slots);
        if kept.is_still && kept.slots == slots {
            self.put_all(deepest, raw);
        } else {
            if slots & !kept.slots != 0 {
                self.begin(slots & !kept.slots, &mut kept, raw);
            }
            self.replace(slots, deepest, &kept, slot_features, raw);
        }
        raw.normal = normal;
    }

    /// Assigns old points to slots by code, else by features. This is unambiguous, because each
    /// pair of features occurs at most once among the points and once among the slots.
    #[inline(always)]
    fn kept(&self, old: &[RawPoint<N, D>], slot_features: &impl SlotFeatures) -> KeptSlots<COUNT> {
        let mut kept =
            KeptSlots { slots: 0, is_still: true, left: 0, ids: [0; COUNT], heirs: [0; COUNT] };
        for (at, point) in old.iter().enumerate() {
            let own = slot_of(point.code);
            let is_same = point.code == slot_features.code(own) && self.valid >> own & 1 == 1;
            // A slot continues one old point at most.
            let free = self.valid & !kept.slots;
            let slot = if is_same { Some(own) } else { slot_features.slot(point, free) };
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

    /// Removes the ids of slots whose candidate is too far from the old point with the same
    /// features ([`is_same_point`]).
    #[inline(always)]
    fn drop_jumped(&self, raw: &RawManifold<N, D>, kept: &mut KeptSlots<COUNT>) {
        for (at, point) in raw.points.iter().enumerate() {
            let (slot, is_left) = (usize::from(kept.heirs[at % COUNT]), kept.left >> (at & 31) & 1);
            if is_left == 0 && !self.is_same(point, &raw.normal, &self.point1(slot)) {
                kept.slots &= !(1 << slot);
                kept.left |= 1 << (at & 31);
            }
        }
    }

    /// Returns whether a candidate at `position`, with the features of `old`, continues `old`, a
    /// point of a contact with `old_normal`.
    #[inline(always)]
    fn is_same(
        &self,
        old: &RawPoint<N, D>,
        old_normal: &Vector<N, D>,
        position: &Point<N, D>,
    ) -> bool {
        let (features, moved) = ([old.feature1, old.feature2], position - old.point1);
        is_same_point(features, &moved, || [*old_normal, self.normal()], || self.size)
    }

    /// Passes the ids of the old points in `kept.left` to slots in `some` that have no id: each to
    /// the nearest slot within the near length ([`each_near`]).
    #[inline(never)]
    fn match_positions(
        &self,
        slot_features: &impl SlotFeatures,
        raw: &RawManifold<N, D>,
        some: u32,
        kept: &mut KeptSlots<COUNT>,
    ) {
        let (old, scale) = (&raw.points, near_scale(self.size));
        each_near(
            [kept.left, some & !kept.slots],
            |at, among| slot_features.on_vertex(old[at].feature2, among),
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

    /// Updates positions and distances of the points in place; slots and features are unchanged. A
    /// point that jumped gets a new id, and the points are then sorted again.
    #[inline(always)]
    fn put_all(&self, deepest: usize, raw: &mut RawManifold<N, D>) {
        let mut has_jumped = false;
        for point in &mut raw.points {
            let old = *point;
            self.write_position(slot_of(point.code), deepest, point);
            // A crossing of two edges that jumped or turned is a new contact and gets a new id.
            if !self.is_same(&old, &raw.normal, &point.point1) {
                (point.id, has_jumped) = (raw.ids.next(), true);
            }
        }
        if has_jumped {
            raw.sort_points();
        }
    }

    /// Replaces the points by the candidates in `slots`, ordered by id.
    #[inline(always)]
    fn replace(
        &self,
        slots: u32,
        deepest: usize,
        kept: &KeptSlots<COUNT>,
        slot_features: &impl SlotFeatures,
        raw: &mut RawManifold<N, D>,
    ) {
        let (order, count) = Self::by_ids(slots, kept);
        raw.points.resize(count, RawPoint::default());
        for (&slot, point) in order.iter().zip(&mut raw.points) {
            point.id = kept.ids[slot];
            self.write_position(slot, deepest, point);
            [point.feature1, point.feature2] = slot_features.features(slot);
            point.code = slot_features.code(slot);
        }
    }

    /// Assigns new ids to the slots in `new`, in the order used by the builder for one pair.
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
    fn write_position(&self, slot: usize, deepest: usize, point: &mut RawPoint<N, D>) {
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

    /// Returns the slot that gets the distance `gap`: the slot with the smallest distance among the
    /// level slots that continue an old point; if there are none, among all level slots; if there
    /// are none either, among all slots.
    #[inline(always)]
    fn deepest(&self, slots: u32, kept: u32) -> usize {
        let level = self.level & slots;
        let preferred = [level & kept, level, slots];
        self.lowest(preferred.into_iter().find(|&slots| slots != 0).unwrap_or(slots))
    }

    /// Returns the slot of `slots` with the smallest distance; the lowest index wins a tie.
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

    /// Returns at most `limit` slots, by the rule of `reduce::chosen`.
    #[inline(always)]
    fn chosen(&self, limit: usize, kept: u32) -> u32 {
        // If no candidate is at the gap, the lowest candidates count as level.
        let mut level = self.level;
        if level == 0 {
            let least = self.distance(self.lowest(self.valid));
            let lowest = Ones::<COUNT>(self.valid).filter(|&slot| self.distance(slot) <= least);
            level = lowest.fold(0, |slots, slot| slots | 1 << slot);
        }
        // If a level slot continues an old point, only level slots count as deepest.
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
