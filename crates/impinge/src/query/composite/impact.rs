//! The time of impact of a moving composite: the first impact of its parts.

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::mover::Mover;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::each_contact_within;
use crate::collide::parts::between::{Between, PartPair, by_number};
use crate::collide::parts::bounds::loosened;
use crate::collide::parts::{Wanted, find_exits, held_pieces, nearest_between};
use crate::collide::separation::separation as separation_of;
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max_component};
use crate::query::impact::{Arrival, Beginning, Path, begin, size, soon};
use crate::shape::{CompositeShape, FeatureId};

/// The impact of two parts, with their indices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartArrival<N: Real, const D: usize> {
    /// The impact; its separation is in the frame of the first shape if `is_of_whole` is true, else
    /// in the frame of the first part.
    pub(crate) arrival: Arrival<N, D>,
    pub(crate) parts: [u32; 2],
    pub(crate) is_of_whole: bool,
}

/// Returns the first impact of two parts; of several impacts at the same time, the impact with the
/// lowest part indices. `None` if no parts hit each other up to the end of the path.
///
/// The contacts of the whole shapes decide whether a contact at the start is an impact. If none of
/// them is an impact, the contacts of the whole shapes also decide about each later impact of two
/// parts: if the parts of a floor were tested alone, their inner edges would stop a solid that has
/// sunk into the floor.
///
/// If both shapes are composites, the one with fewer parts is searched for the parts that the box
/// of the other composite hits. For each part found, the other composite is searched along the path
/// of that part. A path ends at the first impact found so far. After a start in contact that is not
/// an impact, each part that is hit also costs the contacts of the whole shapes at that time.
pub(crate) fn first_arrival<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    path: &Path<N, D>,
) -> Option<PartArrival<N, D>> {
    let start = WholeContact::Unknown;
    let mut search = PartImpactSearch { between, path, first: None, start, is_early: false };
    search.run();
    if search.is_early && search.start == WholeContact::Free {
        // The impact found so far was not checked against the contacts of the whole shapes: search
        // again.
        search.first = None;
        search.run();
    }
    search.first
}

/// Two parts that certainly do not touch before the time `earliest`, zero or more.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LaterPair<N> {
    earliest: N,
    parts: [u32; 2],
}

struct PartImpactSearch<'a, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    path: &'a Path<N, D>,
    first: Option<PartArrival<N, D>>,
    /// The result of the contacts of the whole shapes at the start.
    start: WholeContact,
    /// Whether an impact was found before `start` was known.
    is_early: bool,
}

/// The result of the contacts of the whole shapes at some time.
#[derive(Clone, Copy, PartialEq, Eq)]
enum WholeContact {
    /// The contacts are not computed yet.
    Unknown,
    /// At least one contact is an impact.
    Hit,
    /// There are contacts, but none is an impact.
    Free,
    /// There are no contacts of the whole shapes, although parts are in contact: each pair of parts
    /// decides on its own.
    Nothing,
}

/// The largest gap of two parts that is treated as contact, in epsilon times [`size`] of the parts.
const ROUNDING: f64 = 64.0;

/// Two normals are treated as equal if their difference has at most this length.
const SAME: f64 = 1.0 / 1024.0;

impl<N: Space<D>, const D: usize> PartImpactSearch<'_, N, D> {
    /// Searches all pairs of parts.
    fn run(&mut self) {
        self.begin_inside();
        match self.between.composites() {
            [None, None] => self.hold([0, 0], N::ZERO),
            [Some(parts1), None] => self.each_on_path(1, 0, parts1),
            [None, Some(parts2)] if self.between.is_half_space_first() => {
                self.of_half_space(parts2);
            }
            [None, Some(parts2)] => self.each_on_path(0, 0, parts2),
            [Some(parts1), Some(parts2)] => self.of_many(parts1, parts2),
        }
    }

    /// Sweeps the box of the composite with more parts through the other composite, and tests each
    /// part found there against the composite with more parts.
    fn of_many(&mut self, parts1: &dyn CompositeShape<N, D>, parts2: &dyn CompositeShape<N, D>) {
        let (which, fewer, more) = by_number(parts1, parts2);
        let aabb = self.grown(&self.between.whole_in_other(1 - which));
        let (velocity, end) = (self.velocity(1 - which), self.end());
        fewer.search().cast(&aabb, &velocity, end, &mut |part, _| {
            self.each_on_path(which, part, more);
            self.end()
        });
    }

    /// Tests the nearest part of a composite against a half-space: the half-space approaches all
    /// parts at the same speed, so it hits the nearest part first. If that part is hit at time
    /// zero, the other parts are tested, too: of several impacts at time zero, the one with the
    /// lowest part index is returned.
    fn of_half_space(&mut self, others: &dyn CompositeShape<N, D>) {
        let nearest = nearest_between(self.between, N::INFINITY, Wanted::Deepest, None);
        let Some(nearest) = nearest else { return };
        self.hold(nearest.parts, N::ZERO);
        if self.first.is_some_and(|first| first.arrival.along <= N::ZERO) {
            self.each_on_path(0, 0, others);
        }
    }

    /// Tests part `part` of shape `which` against the parts of the other shape whose boxes are on
    /// its path, in the order of the lower bounds of their times of contact. Skips each part that,
    /// by [`Mover::earliest`], the moving part does not touch up to the end.
    fn each_on_path(&mut self, which: usize, part: u32, others: &dyn CompositeShape<N, D>) {
        let aabb = self.grown(&self.between.aabb_in_other(which, part));
        let (velocity, end) = (self.velocity(which), self.end());
        let mover = if which == 0 {
            Mover::of_first(self.between, velocity, self.path.target)
        } else {
            None
        };
        let mut waiting = BinaryHeap::new();
        let by_number = |other| if which == 0 { [part, other] } else { [other, part] };
        others.search().cast(&aabb, &velocity, end, &mut |other, time| {
            let earliest =
                mover.as_ref().map(|mover| mover.earliest(&others.part(other), self.end()));
            if let Some(earliest) = earliest.unwrap_or(Some(N::ZERO)) {
                waiting.push(Reverse(LaterPair { earliest, parts: by_number(other) }));
            }
            self.hold_until(time, &mut waiting);
            self.end()
        });
        self.hold_until(N::INFINITY, &mut waiting);
    }

    /// Tests the waiting pairs that may touch up to `time`.
    fn hold_until(&mut self, time: N, waiting: &mut BinaryHeap<Reverse<LaterPair<N>>>) {
        while let Some(Reverse(next)) = waiting.peek().copied()
            && next.earliest <= time
        {
            waiting.pop();
            if next.earliest <= self.end() {
                self.hold(next.parts, next.earliest);
            }
        }
    }

    /// Computes the impact of two parts that do not touch before `earliest`, and keeps it if it is
    /// the earliest so far. If the path is mirrored, parts with equal indices are a mirrored pair,
    /// too.
    fn hold(&mut self, parts: [u32; 2], earliest: N) {
        if self.start == WholeContact::Hit {
            return;
        }
        let placed = self.between.parts(parts);
        let path = Path {
            end: self.first.map_or(self.path.end, |first| first.arrival.along),
            mirrored: self.path.mirrored && parts[0] == parts[1],
            ..path_in_first_part(&placed, self.path)
        };
        let arrival = match begin(&placed.pair(), &path, earliest) {
            Beginning::Apart(arrival) => arrival,
            Beginning::InContact { arrival, counts } => {
                self.begin_in_contact(rounding(&placed));
                Some(arrival).filter(|_| counts && self.start == WholeContact::Nothing)
            }
        };
        let found = arrival.map(|arrival| PartArrival { arrival, parts, is_of_whole: false });
        let is_first =
            |found: &PartArrival<N, D>| self.first.is_none_or(|first| found.is_before(&first));
        let found = found.filter(is_first).and_then(|found| self.confirmed(found, &placed));
        self.is_early |= found.is_some() && self.start == WholeContact::Unknown;
        self.first = found.or(self.first);
    }

    /// Handles a solid that is inside a body (the interior of a closed composite) at the start:
    /// this is a start in contact, although the solid may touch no part.
    fn begin_inside(&mut self) {
        if self.start == WholeContact::Unknown && self.between.has_bodies() {
            let mut inside = held_pieces(self.between);
            find_exits(self.between, &mut inside);
            if !inside.is_empty() {
                self.begin_in_contact(N::ZERO);
            }
        }
    }

    /// Computes the result of the contacts of the whole shapes at the start, unless it is known. If
    /// a contact is an impact, keeps the deepest such contact as the first impact.
    fn begin_in_contact(&mut self, tolerance: N) {
        if self.start == WholeContact::Unknown {
            let whole = WholeQuestion { between: *self.between, path: self.path, along: N::ZERO };
            let (start, hit) = whole.contacts_within(tolerance, &mut |_| {});
            self.start = start;
            self.first = hit.or(self.first);
        }
    }

    /// Checks an impact of two parts after a start in contact that is not an impact. Returns `None`
    /// if the whole shapes have contacts at that time, but none is an impact, and a little later
    /// neither: where a solid slides from one part to the next, only the former may have a contact.
    /// Returns the impact of the whole shapes if one of their contacts is an impact, but none with
    /// the normal of the parts.
    fn confirmed(
        &self,
        found: PartArrival<N, D>,
        placed: &PartPair<'_, N, D>,
    ) -> Option<PartArrival<N, D>> {
        let (Arrival { along, separation, .. }, path) = (&found.arrival, self.path);
        if self.start != WholeContact::Free || *along <= N::ZERO {
            return Some(found);
        }
        let (own, mut is_same) = (placed.in_first(separation).normal, false);
        let mut at = |along: N| {
            let pair = path.moved(&self.between.pair, along);
            let whole = WholeQuestion { between: Between::of_pair(&pair), path, along };
            whole.contacts_within(rounding(placed), &mut |normal| {
                is_same |= (normal - own).norm() <= N::lit(SAME);
            })
        };
        let (contact, hit) = at(*along);
        match contact {
            WholeContact::Free => {
                let length = soon(size(&placed.pair()), rounding(placed));
                let later = *along + length / max_component(&path.velocity);
                Some(found).filter(|_| at(later).0 == WholeContact::Hit)
            }
            WholeContact::Hit if !is_same => hit,
            _ => Some(found),
        }
    }

    /// Returns the velocity of shape `which` in the frame of the other shape.
    fn velocity(&self, which: usize) -> Vector<N, D> {
        let velocity = &self.path.velocity;
        if which == 1 { *velocity } else { -self.between.pose21.vector(velocity) }
    }

    /// Returns a box loosened by the target distance, so that it overlaps every box within that
    /// distance of `aabb`; all of space if a coordinate overflows.
    fn grown(&self, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        let grown = aabb.loosened(self.path.target);
        Aabb::try_new(*grown.mins(), *grown.maxs()).unwrap_or_else(|_| Aabb::unbounded())
    }

    /// Returns the latest time still to be searched: that of the first impact found so far, or else
    /// the end of the path, with a margin for rounding. Negative once the start is an impact.
    fn end(&self) -> N {
        if self.start == WholeContact::Hit {
            return -N::ONE;
        }
        let end = self.first.map_or(self.path.end, |first| first.arrival.along);
        if end >= N::ZERO { loosened(end) } else { -N::ONE }
    }
}

/// A query for the contacts of the whole shapes at the time `along`.
struct WholeQuestion<'p, 'a, N: Real, const D: usize> {
    between: Between<'a, N, D>,
    path: &'p Path<N, D>,
    along: N,
}

impl<N: Space<D>, const D: usize> WholeQuestion<'_, '_, N, D> {
    /// Returns the result of the contacts within the target distance plus `tolerance`, and, if any
    /// of them is an impact, the deepest contact that is an impact. Calls `visit` with the normal
    /// of each contact that is an impact.
    fn contacts_within(
        &self,
        tolerance: N,
        visit: &mut dyn FnMut(&Vector<N, D>),
    ) -> (WholeContact, Option<PartArrival<N, D>>) {
        let (path, mut is_free) = (self.path, false);
        let mut deepest: Option<PartArrival<N, D>> = None;
        each_contact_within(&self.between, path.target + tolerance, &mut |found| {
            let (parts, separation) = (found.parts, found.separation);
            let placed = self.between.parts(parts);
            let (gap, tolerance) = (separation.distance - path.target, rounding(&placed));
            if gap > tolerance {
                return;
            }
            let path = Path { mirrored: path.mirrored && parts[0] == parts[1], ..*path };
            let slack = path.slack(tolerance);
            // The depth of an overlap is along the normal of a surface, not along that of the parts.
            let counts_soon = || {
                let (own, pair) = (path_in_first_part(&placed, &path), placed.pair());
                let counts = |found| own.counts_soon(&pair, &found, tolerance);
                gap < -slack || separation_of(&pair, N::INFINITY).is_none_or(counts)
            };
            if !(path.counts_at_start(&separation.normal, gap, tolerance) && counts_soon()) {
                is_free = true;
                return;
            }
            visit(&separation.normal);
            let is_deeper =
                |than: PartArrival<N, D>| separation.distance < than.arrival.separation.distance;
            if deepest.is_none_or(is_deeper) {
                let arrival = Arrival::in_contact(self.along, separation, gap, slack);
                deepest = Some(PartArrival { arrival, parts, is_of_whole: true });
            }
        });
        match deepest {
            Some(_) => (WholeContact::Hit, deepest),
            None if is_free => (WholeContact::Free, None),
            None => (WholeContact::Nothing, None),
        }
    }
}

/// Returns the largest gap of two parts that is treated as contact.
fn rounding<N: Real, const D: usize>(placed: &PartPair<'_, N, D>) -> N {
    N::lit(ROUNDING) * N::EPSILON * size(&placed.pair())
}

/// Converts a path from the frame of the first shape to the frame of its part.
fn path_in_first_part<N: Real, const D: usize>(
    placed: &PartPair<'_, N, D>,
    path: &Path<N, D>,
) -> Path<N, D> {
    Path { velocity: placed.to_first_part(&path.velocity), ..*path }
}

impl<N: Space<D>, const D: usize> PartArrival<N, D> {
    /// Returns the separation of the parts at the impact, in the frame of the first shape, and the
    /// touching features.
    pub(crate) fn separation_with_features(
        &self,
        between: &Between<'_, N, D>,
        path: &Path<N, D>,
    ) -> (Separation<N, D>, [FeatureId; 2]) {
        let (placed, found) = (between.parts(self.parts), &self.arrival.separation);
        let [in_shape, local] = match self.is_of_whole {
            true => [*found, placed.in_first_part(found)],
            false => [placed.in_first(found), *found],
        };
        let arrival = Arrival { separation: local, ..self.arrival };
        (in_shape, arrival.features(&placed.pair(), &path_in_first_part(&placed, path)))
    }
}

impl<N: Real, const D: usize> PartArrival<N, D> {
    /// Returns whether this impact is earlier than `other`, or at the same time with lower part
    /// indices.
    fn is_before(&self, other: &Self) -> bool {
        let (along, others) = (self.arrival.along, other.arrival.along);
        along < others || (along == others && self.parts < other.parts)
    }
}

impl<N: Real> Ord for LaterPair<N> {
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |of: &Self| ((of.earliest + N::ZERO).bits(), of.parts);
        key(self).cmp(&key(other))
    }
}

impl<N: Real> PartialOrd for LaterPair<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<N: Real> Eq for LaterPair<N> {}
