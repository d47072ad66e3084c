//! From the filled slots of one pair to its manifold: the rules of `choose`, without moving anything.

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
    pub(super) slots: &'a Slots<N, D, COUNT, L>,
    pub(super) lane: usize,
    /// The slots that hold a candidate, by bits.
    pub(super) valid: u32,
    /// Those with the smallest distance but for rounding.
    pub(super) level: u32,
    pub(super) gap: N,
    pub(super) tolerance: N,
    /// Of the pair, for what is in proportion to it.
    pub(super) size: N,
    pub(super) normal: &'a [[N; L]; D],
}

/// How the slots of one pair are named.
pub(super) trait Naming {
    /// The features of a candidate, of the first and the second box.
    fn features(&self, slot: usize) -> [FeatureId; 2];

    /// The candidate with the features of a point, among those that there are.
    fn slot<N: Real, const D: usize>(&self, point: &RawPoint<N, D>, valid: u32) -> Option<usize>;

    /// The candidates that lie on a feature of the second box, if it is a vertex; else none.
    #[inline(always)]
    fn on_vertex(&self, feature: FeatureId, among: u32) -> u32 {
        if !matches!(feature, FeatureId::Vertex(_)) {
            return 0;
        }
        let is_on = |slot: &usize| self.features(*slot)[1] == feature;
        Ones::<SLOTS_OF_CODE>(among).filter(is_on).fold(0, |slots, slot| slots | 1 << slot)
    }

    /// A number, not zero, that no candidate of any pair has but in this slot with these features;
    /// the slot is in the lowest bits.
    fn code(&self, slot: usize) -> u32;
}

/// The bits of a code that are the slot.
const SLOT_BITS: u32 = 31;
/// A code tells one of so many slots.
const SLOTS_OF_CODE: usize = 32;

/// The slot that a code tells.
#[inline(always)]
const fn slot_of(code: u32) -> usize {
    (code & SLOT_BITS) as usize
}

/// The ids of the old points, for the slots that continue them.
struct KeptSlots<const COUNT: usize> {
    slots: u32,
    /// All of the old points are candidates again, and in the same slots.
    is_still: bool,
    /// The old points that are not, by bits.
    left: u32,
    ids: [u32; COUNT],
    /// The slots of old points that are, by place in the manifold.
    heirs: [u8; COUNT],
}

impl<const COUNT: usize> KeptSlots<COUNT> {
    /// Leaves the ids of some slots, and the old points whose ids these have not.
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
    /// Replaces the points of a manifold, and its normal, by at most `limit` of the candidates.
    #[inline(always)]
    pub(super) fn settle(&self, naming: &impl Naming, limit: usize, raw: &mut RawManifold<N, D>) {
        let mut kept = self.kept(&raw.points, naming);
        if !kept.is_still {
            self.drop_jumped(&raw.points, &mut kept);
        }
        let normal = self.normal();
        let may_match = normals_agree(&raw.normal, &normal);
        if may_match && kept.left != 0 && kept.slots != self.valid {
            self.match_places(naming, raw, self.valid, &mut kept);
        }
        let is_full = self.valid.count_ones() as usize <= limit.min(ALL);
        let slots = if is_full { self.valid } else { self.chosen(limit, kept.slots) };
        if may_match && !is_full && !raw.points.is_empty() && slots & !kept.slots != 0 {
            // The ids of candidates that are not chosen go to chosen ones near them.
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

    /// The ids of old points on the same features; no two old points share their names, nor do two slots.
    #[inline(always)]
    fn kept(&self, old: &[RawPoint<N, D>], naming: &impl Naming) -> KeptSlots<COUNT> {
        let mut kept =
            KeptSlots { slots: 0, is_still: true, left: 0, ids: [0; COUNT], heirs: [0; COUNT] };
        for (at, point) in old.iter().enumerate() {
            let own = slot_of(point.code);
            let is_same = point.code == naming.code(own) && self.valid >> own & 1 == 1;
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

    /// Takes the ids of old points back from slots that are too far from them ([`is_same_point`]).
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

    /// A candidate at a place, with the features of an old point, is the same.
    #[inline(always)]
    fn is_same(&self, old: &RawPoint<N, D>, place: &Point<N, D>) -> bool {
        is_same_point([old.feature1, old.feature2], &(place - old.point1), || self.size)
    }

    /// Gives those of some slots that have no ids those of the old points that are left, by place.
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

    /// Nothing has changed but places.
    #[inline(always)]
    fn put_all(&self, deepest: usize, raw: &mut RawManifold<N, D>) {
        let mut has_jumped = false;
        for point in &mut raw.points {
            let old = *point;
            self.place(slot_of(point.code), deepest, point);
            if !self.is_same(&old, &point.point1) {
                (point.id, has_jumped) = (raw.ids.next(), true);
            }
        }
        if has_jumped {
            raw.sort_points();
        }
    }

    /// Puts the points of some slots, by bits, in the place of those there are.
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

    /// Gives some slots new ids.
    #[inline(never)]
    fn begin(&self, new: u32, kept: &mut KeptSlots<COUNT>, raw: &mut RawManifold<N, D>) {
        for (_, slot) in in_order(Ones::<COUNT>(new).map(|slot| (slot, self.point1(slot)))) {
            kept.ids[slot] = raw.ids.next();
        }
    }

    /// Some slots in the order of their ids, and how many there are.
    #[inline(always)]
    fn by_ids(slots: u32, kept: &KeptSlots<COUNT>) -> ([usize; COUNT], usize) {
        let (mut order, mut count) = ([0; COUNT], 0);
        for slot in Ones::<COUNT>(slots) {
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

    /// Says where the candidate of a slot is.
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

    /// Of some slots the one that stands for the witness: of those whose distance is the smallest but for
    /// rounding one that the previous manifold held, then the deepest.
    #[inline(always)]
    fn deepest(&self, slots: u32, kept: u32) -> usize {
        let level = self.level & slots;
        let preferred = [level & kept, level, slots];
        self.lowest(preferred.into_iter().find(|&slots| slots != 0).unwrap_or(slots))
    }

    /// The first of some slots with the smallest distance of them.
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

    /// At most `limit` slots, by bits, as `reduce::chosen` has them.
    #[inline(always)]
    fn chosen(&self, limit: usize, kept: u32) -> u32 {
        let mut level = self.level;
        if level == 0 {
            let least = self.distance(self.lowest(self.valid));
            let lowest = Ones::<COUNT>(self.valid).filter(|&slot| self.distance(slot) <= least);
            level = lowest.fold(0, |slots, slot| slots | 1 << slot);
        }
        // An old point that is the deepest needs none to stand for it.
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
