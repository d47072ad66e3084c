//! Rewinding the narrow phase to a mark.
//!
//! Pairs return to their former indices in their groups, because contacts are read in that order.
//! The order of the pair table affects no result, so its pairs are simply inserted and removed.

use super::default_narrow_phase::NOWHERE;
use super::entry::{ContactEntry, CustomContactEntry, CustomProximityEntry, ProximityEntry};
use super::group::{Group, PairKey, set_touching};
use super::pair_groups::{GroupId, Location, PairGroups};
use super::state::{CompositeState, ContactState};
use super::{DefaultNarrowPhase, IdAllocator, ObjectTable};
use crate::collide::{PairIds, RawManifold, RawPoint};
use crate::journal::Journal;
use crate::math::{Pose, Real, Space, Vector};

/// All data of a pair in a group.
#[derive(Clone, Debug)]
pub(crate) struct GroupRow<S, R> {
    key: PairKey,
    due: bool,
    is_touching: bool,
    state: S,
    /// `None` if the group has no references.
    reference: Option<R>,
}

/// A state that is recorded in pieces of constant size, so that the note of a pair with one contact
/// takes less memory than the note of a pair with four.
pub(crate) trait Parts: Clone {
    type Part;

    /// Calls `each` with each piece of the data that an update may change.
    fn each_part(&self, each: impl FnMut(Self::Part));

    /// Restores the data from the pieces, which arrive in the order of [`Self::each_part`].
    fn put_together(&mut self, parts: impl Iterator<Item = Self::Part>);
}

/// A piece of the contacts of two convex solids.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ContactPart<N: Real, const D: usize> {
    Point(RawPoint<N, D>),
    Pose(Pose<N, D>),
    Head { normal: Vector<N, D>, ids: PairIds, is_swapped: bool },
}

impl<N: Space<D>, const D: usize> Parts for ContactEntry<N, ContactState<N, D>> {
    type Part = ContactPart<N, D>;

    fn each_part(&self, mut each: impl FnMut(Self::Part)) {
        let (RawManifold { normal, ids, points, pose12 }, is_swapped) = self.state.kept();
        each(ContactPart::Head { normal: *normal, ids: *ids, is_swapped });
        pose12.iter().for_each(|pose| each(ContactPart::Pose(*pose)));
        points.iter().for_each(|point| each(ContactPart::Point(*point)));
    }

    fn put_together(&mut self, parts: impl Iterator<Item = Self::Part>) {
        let mut raw = RawManifold::default();
        let mut was_swapped = false;
        for part in parts {
            match part {
                ContactPart::Point(point) => raw.points.push(point),
                ContactPart::Pose(pose) => raw.pose12 = Some(pose),
                ContactPart::Head { normal, ids, is_swapped } => {
                    (raw.normal, raw.ids, was_swapped) = (normal, ids, is_swapped);
                }
            }
        }
        self.state.keep(raw, was_swapped);
    }
}

/// Implements [`Parts`] for states that are recorded in a single piece.
macro_rules! in_one_part {
    ($([$($generics:tt)*] $type:ty;)*) => {
        $(impl<$($generics)*> Parts for $type {
            type Part = Self;

            fn each_part(&self, mut each: impl FnMut(Self)) {
                each(self.clone());
            }

            fn put_together(&mut self, parts: impl Iterator<Item = Self>) {
                parts.for_each(|part| *self = part);
            }
        })*
    };
}

in_one_part! {
    [N: Real, const D: usize] ContactEntry<N, CompositeState<N, D>>;
    [N: Real] ProximityEntry<N>;
    [N: Space<D>, const D: usize] CustomContactEntry<N, D>;
    [N: Space<D>, const D: usize] CustomProximityEntry<N, D>;
}

#[cfg(test)]
in_one_part! {
    [] u32;
}

/// A change of a group, which can be undone.
pub(crate) enum GroupNote<S: Parts, R> {
    /// A pair was added at the end.
    Pushed,
    /// A pair was removed, and the last one moved to its index.
    Removed(u32, Box<GroupRow<S, R>>),
    /// A pair before a change other than an update, or before it was replaced.
    Replaced(u32, Box<GroupRow<S, R>>),
    /// A pair before an update computed it; its parts are in the notes that follow.
    Written {
        place: u32,
        due: bool,
        is_touching: bool,
    },
    Part(S::Part),
}

impl<S: Parts, V: Default, R: Clone + Default> Group<S, V, R> {
    fn row(&self, place: u32) -> Box<GroupRow<S, R>> {
        let at = place as usize;
        Box::new(GroupRow {
            key: self.keys[at],
            due: self.dirty[at],
            is_touching: self.is_touching(place),
            state: self.states[at].clone(),
            reference: self.references.as_ref().map(|references| references[at].clone()),
        })
    }

    /// Records a pair before an update computes it, if there are marks and the pair has not been
    /// recorded since the last mark.
    pub(super) fn note(&mut self, place: u32) {
        let at = place as usize;
        if !self.journal.is_on()
            || core::mem::replace(&mut self.noted[at], self.period) == self.period
        {
            return;
        }
        let (due, is_touching) = (self.dirty[at], self.is_touching(place));
        self.journal.note(GroupNote::Written { place, due, is_touching });
        self.states[at].each_part(|part| self.journal.note(GroupNote::Part(part)));
        if let Some(references) = &self.references {
            self.reference_journal.note(references[at].clone());
        }
    }

    /// Records a pair before a change other than an update, if there are marks.
    pub(super) fn note_whole(&mut self, place: u32) {
        if self.journal.is_on() {
            self.journal.note(GroupNote::Replaced(place, self.row(place)));
            self.noted[place as usize] = self.period;
        }
    }

    /// Records a pair before its removal, if there are marks.
    pub(super) fn note_removed(&mut self, place: u32) {
        if self.journal.is_on() {
            self.journal.note(GroupNote::Removed(place, self.row(place)));
            self.noted.swap_remove(place as usize);
        }
    }

    /// Records the pairs that the update is about to compute.
    fn note_due<N: Space<D>, const D: usize>(&mut self, table: &ObjectTable<N, D>) {
        for place in 0..self.keys.len() {
            let [first, second] = self.keys[place];
            if self.dirty[place] || table.has_changed(first) || table.has_changed(second) {
                self.note(u32::try_from(place).expect("fewer than 2^32 pairs fit in memory"));
            }
        }
    }

    /// Sets a mark, unless the group is empty and has no older mark.
    fn mark(&mut self, number: u64) {
        if !self.is_empty() || self.journal.is_on() {
            self.journal.mark(number, ());
            self.reference_journal.mark(number, ());
            self.noted.resize(self.keys.len(), 0);
            self.begin_period();
        }
    }

    fn begin_period(&mut self) {
        self.period = self.period.wrapping_add(1);
        if self.period == 0 {
            self.noted.fill(0);
            self.period = 1;
        }
    }

    fn forget_before(&mut self, number: u64) {
        if self.journal.is_on() {
            self.journal.forget_before(number);
            self.reference_journal.forget_before(number);
            if !self.journal.is_on() {
                self.noted = Vec::new();
            }
        }
    }

    /// Undoes all changes since a mark. Calls `changed` with each index whose pair may have
    /// changed.
    fn rewind(&mut self, number: u64, mut changed: impl FnMut(u32)) {
        let mut journal = core::mem::take(&mut self.journal);
        if !journal.has(number) {
            // A group without this mark was empty when the mark was set.
            while !self.is_empty() {
                self.pop();
            }
            (self.reference_journal, self.noted) = (Journal::default(), Vec::new());
            return;
        }
        let mut parts = Vec::new();
        while let Some(note) = journal.undo(number) {
            match note {
                GroupNote::Part(part) => parts.push(part),
                GroupNote::Written { place, due, is_touching } => {
                    self.states[place as usize].put_together(parts.drain(..).rev());
                    let reference = self.references.as_ref();
                    let reference = reference.and_then(|_| self.reference_journal.undo(number));
                    self.put(place, due, is_touching, reference);
                }
                GroupNote::Pushed => self.pop(),
                GroupNote::Replaced(place, row) => {
                    self.put_row(place, *row);
                    changed(place);
                }
                GroupNote::Removed(place, row) => {
                    let last = self.push(row.key, row.state.clone(), false);
                    if place != last {
                        self.put_row(last, *self.row(place));
                    }
                    self.put_row(place, *row);
                    changed(place);
                    changed(last);
                }
            }
        }
        let _ = self.reference_journal.undo(number);
        self.journal = journal;
        self.noted.clear();
        self.noted.resize(self.keys.len(), 0);
        self.begin_period();
    }

    fn pop(&mut self) {
        if let Some(last) = self.keys.len().checked_sub(1) {
            self.swap_remove(u32::try_from(last).expect("fewer than 2^32 pairs fit in memory"));
        }
    }

    fn put_row(&mut self, place: u32, row: GroupRow<S, R>) {
        let GroupRow { key, due, is_touching, state, reference } = row;
        (self.keys[place as usize], self.states[place as usize]) = (key, state);
        self.put(place, due, is_touching, reference);
    }

    fn put(&mut self, place: u32, due: bool, is_touching: bool, reference: Option<R>) {
        let at = place as usize;
        self.dirty[at] = due;
        set_touching(&mut self.touching, at, is_touching);
        if let Some(views) = self.views.get_mut() {
            views[at] = V::default();
        }
        if let Some((references, reference)) = self.references.as_mut().zip(reference) {
            references[at] = reference;
        }
    }
}

/// Runs `action` for each group, with its location.
macro_rules! each_group {
    ($lanes:expr, |$lane:pat_param, $group:ident| $action:expr) => {{
        let PairGroups { contacts, composites, proximity, custom_contacts, custom_proximity } =
            $lanes;
        for (number, $group) in (0..).zip(contacts) {
            let $lane = GroupId::Contacts(number);
            $action;
        }
        for (number, $group) in (0..).zip(proximity) {
            let $lane = GroupId::Proximity(number);
            $action;
        }
        {
            let ($lane, $group) = (GroupId::Composites, composites);
            $action;
        }
        {
            let ($lane, $group) = (GroupId::CustomContacts, custom_contacts);
            $action;
        }
        {
            let ($lane, $group) = (GroupId::CustomProximity, custom_proximity);
            $action;
        }
    }};
}

impl<N: Space<D>, const D: usize> PairGroups<N, D> {
    /// Records the pairs at some locations before they are computed.
    pub(super) fn note(&mut self, picked: &[Location]) {
        for &Location { group, row } in picked {
            match group {
                GroupId::Contacts(number) => self.contacts[usize::from(number)].note(row),
                GroupId::Composites => self.composites.note(row),
                GroupId::Proximity(number) => self.proximity[usize::from(number)].note(row),
                GroupId::CustomContacts => self.custom_contacts.note(row),
                GroupId::CustomProximity => self.custom_proximity.note(row),
                GroupId::Nothing => {}
            }
        }
    }

    /// Records the pairs that the update is about to compute.
    pub(super) fn note_due(&mut self, table: &ObjectTable<N, D>) {
        each_group!(self, |_, group| group.note_due(table));
    }
}

/// State of the narrow phase that a mark copies as a whole.
#[derive(Clone, Debug)]
pub(crate) struct NarrowHead {
    ids: IdAllocator,
    due: Vec<PairKey>,
}

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Sets a mark; see [`Journal`](crate::journal::Journal).
    pub(crate) fn mark(&mut self, number: u64) {
        let head = NarrowHead { ids: self.ids.clone(), due: self.dirty_pairs.clone() };
        self.journal.mark(number, head);
        self.pairs.mark(number);
        each_group!(&mut self.groups, |_, group| group.mark(number));
    }

    /// Drops the marks with smaller numbers.
    pub(crate) fn forget_before(&mut self, number: u64) {
        self.journal.forget_before(number);
        self.pairs.forget_before(number);
        each_group!(&mut self.groups, |_, group| group.forget_before(number));
    }

    /// Undoes all changes since a mark. The cost is proportional to the number of changes.
    pub(crate) fn rewind(&mut self, number: u64) {
        let locations = &mut self.locations;
        self.pairs.rewind(number, |undone| match undone {
            Some(removed) => {
                locations.swap_remove(removed.index);
            }
            None => locations.push(NOWHERE),
        });
        each_group!(&mut self.groups, |lane, group| {
            let mut places = Vec::new();
            group.rewind(number, |place| places.push(place));
            for place in places {
                let Some(&[first, second]) = group.keys.get(place as usize) else { continue };
                if let Some(index) = self.pairs.index_of(first, second) {
                    self.locations[index] = Location { group: lane, row: place };
                }
            }
        });
        while self.journal.undo(number).is_some() {}
        if let Some(NarrowHead { ids, due }) = self.journal.head() {
            self.ids = ids.clone();
            self.dirty_pairs.clone_from(due);
        }
        self.forget_order();
    }
}
