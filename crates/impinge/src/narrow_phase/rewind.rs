//! Rewinding the narrow phase to a mark.
//!
//! Each pair returns to the row of its group that it had at the mark, because contacts are read in
//! the order of the rows. The order of the pair table affects no result, so its pairs are simply
//! inserted and removed.

use super::default_narrow_phase::NOWHERE;
use super::entry::{ContactEntry, CustomContactEntry, CustomProximityEntry, ProximityEntry};
use super::group::{Group, PairKey, set_touching};
use super::pair_groups::{GroupId, Location, PairGroups};
use super::state::{CompositeState, ContactState};
use super::{DefaultNarrowPhase, IdAllocator, ObjectTable};
use smallvec::SmallVec;

use crate::collide::{PairIds, RawManifold, RawPoint};
use crate::journal::Journal;
use crate::math::{Pose, Real, Space, Vector};

/// All data of one row of a group: a pair with its flags, its state and its reference.
#[derive(Clone, Debug)]
pub(crate) struct GroupRow<S, R> {
    key: PairKey,
    due: bool,
    is_touching: bool,
    state: S,
    /// `None` if the group has no references.
    reference: Option<R>,
}

/// The state of a pair, which is recorded in two parts: a head of constant size, and the points in
/// a list of their own. So the note of a pair without contacts takes less memory than the note of a
/// pair with four.
pub(crate) trait Parts: Clone {
    type Head;
    type Point: Copy;

    /// Returns the data that an update may change, without the points.
    fn head(&self) -> Self::Head;

    /// Returns the points.
    fn points(&self) -> &[Self::Point];

    /// Restores the state from its head and its points; `reversed` yields the points in reverse
    /// order.
    fn put_together(&mut self, head: Self::Head, reversed: impl Iterator<Item = Self::Point>);
}

/// The head of the contacts of two convex solids.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactHead<N: Real, const D: usize> {
    normal: Vector<N, D>,
    ids: PairIds,
    is_swapped: bool,
    pose12: Option<Pose<N, D>>,
}

impl<N: Space<D>, const D: usize> Parts for ContactEntry<N, ContactState<N, D>> {
    type Head = ContactHead<N, D>;
    type Point = RawPoint<N, D>;

    fn head(&self) -> Self::Head {
        let (RawManifold { normal, ids, pose12, .. }, is_swapped) = self.state.kept();
        ContactHead { normal: *normal, ids: *ids, is_swapped, pose12: *pose12 }
    }

    fn points(&self) -> &[Self::Point] {
        &self.state.kept().0.points
    }

    fn put_together(&mut self, head: Self::Head, reversed: impl Iterator<Item = Self::Point>) {
        let ContactHead { normal, ids, is_swapped, pose12 } = head;
        let mut points: SmallVec<_> = reversed.collect();
        points.reverse();
        self.state.keep(RawManifold { normal, ids, points, pose12 }, is_swapped);
    }
}

/// Implements [`Parts`] for states that are recorded whole, as heads.
macro_rules! whole {
    ($([$($generics:tt)*] $type:ty;)*) => {
        $(impl<$($generics)*> Parts for $type {
            type Head = Self;
            type Point = ();

            fn head(&self) -> Self {
                self.clone()
            }

            fn points(&self) -> &[()] {
                &[]
            }

            fn put_together(&mut self, head: Self, _: impl Iterator<Item = ()>) {
                *self = head;
            }
        })*
    };
}

whole! {
    [N: Real, const D: usize] ContactEntry<N, CompositeState<N, D>>;
    [N: Real] ProximityEntry<N>;
    [N: Space<D>, const D: usize] CustomContactEntry<N, D>;
    [N: Space<D>, const D: usize] CustomProximityEntry<N, D>;
}

#[cfg(test)]
whole! {
    [] u32;
}

/// A change of a group, which can be undone.
pub(crate) enum GroupNote<S: Parts> {
    /// A pair was added in a new last row.
    Pushed,
    /// The row of a removed pair, to which the last pair of the group moved. The journal also has
    /// all data of the removed pair, as [`KeptPair::Row`].
    Removed(u32),
    /// The row of a pair before a change other than an update, or before its replacement by another
    /// pair. The journal also has all data of the old pair, as [`KeptPair::Row`].
    Replaced(u32),
    /// A pair before an update computed it: its row, the number of its points, its dirty flag and
    /// its touching flag. Its points are in [`Group::point_journal`]. If the group has references,
    /// the journal also has the pair's reference, as [`KeptPair::Reference`].
    Written { place: u32, num_points: u32, due: bool, is_touching: bool, head: S::Head },
}

/// The data of a [`GroupNote`] that owns memory.
pub(crate) enum KeptPair<S, R> {
    Row(Box<GroupRow<S, R>>),
    Reference(R),
}

impl<S, R> KeptPair<S, R> {
    fn reference(self) -> Option<R> {
        match self {
            Self::Row(_) => None,
            Self::Reference(reference) => Some(reference),
        }
    }
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

    /// Records the pairs in the given rows before an update computes them, each pair only once
    /// between two marks. Does nothing if there are no marks.
    fn note(&mut self, places: impl Iterator<Item = u32>) {
        if self.journal.is_on() {
            places.for_each(|place| self.note_one(place));
        }
    }

    fn note_one(&mut self, place: u32) {
        let at = place as usize;
        if core::mem::replace(&mut self.noted[at], self.period) == self.period {
            return;
        }
        let points = self.states[at].points();
        let num_points = u32::try_from(points.len()).expect("few enough points for ids");
        self.point_journal.note_all(points);
        let (due, is_touching) = (self.dirty[at], self.is_touching(place));
        let head = self.states[at].head();
        let written = GroupNote::Written { place, num_points, due, is_touching, head };
        match &self.references {
            None => self.journal.note(written),
            Some(all) => self.journal.note_kept(written, KeptPair::Reference(all[at].clone())),
        }
    }

    /// Records all data of the pair in a row before a change other than an update. Does nothing if
    /// there are no marks.
    pub(super) fn note_whole(&mut self, place: u32) {
        if self.journal.is_on() {
            self.journal.note_kept(GroupNote::Replaced(place), KeptPair::Row(self.row(place)));
            self.noted[place as usize] = self.period;
        }
    }

    /// Records all data of the pair in a row before its removal. Does nothing if there are no
    /// marks.
    pub(super) fn note_removed(&mut self, place: u32) {
        if self.journal.is_on() {
            self.journal.note_kept(GroupNote::Removed(place), KeptPair::Row(self.row(place)));
            self.noted.swap_remove(place as usize);
        }
    }

    /// Records the pairs that the update is about to compute.
    fn note_due<N: Space<D>, const D: usize>(&mut self, table: &ObjectTable<N, D>) {
        let end = if self.journal.is_on() { self.keys.len() } else { 0 };
        for at in 0..end {
            let [first, second] = self.keys[at];
            if self.dirty[at] || table.has_changed(first) || table.has_changed(second) {
                self.note_one(u32::try_from(at).expect("fewer than 2^32 pairs fit in memory"));
            }
        }
    }

    /// Sets a mark, unless the group is empty and has no older mark.
    fn mark(&mut self, number: u64) {
        if !self.is_empty() || self.journal.is_on() {
            self.journal.mark(number, ());
            self.point_journal.mark(number, ());
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
            self.point_journal.forget_before(number);
            if !self.journal.is_on() {
                self.noted = Vec::new();
            }
        }
    }

    /// Undoes all changes of the group since a mark. Calls `changed` with each row in which another
    /// pair may stand now.
    fn rewind(&mut self, number: u64, mut changed: impl FnMut(u32)) {
        let mut journal = core::mem::take(&mut self.journal);
        if !journal.has(number) {
            // A group without this mark was empty when the mark was set.
            while !self.is_empty() {
                self.pop();
            }
            (self.point_journal, self.noted) = (Journal::default(), Vec::new());
            return;
        }
        while let Some(note) = journal.undo(number) {
            match note {
                GroupNote::Written { place, num_points, due, is_touching, head } => {
                    let points = (0..num_points).map_while(|_| self.point_journal.undo(number));
                    self.states[place as usize].put_together(head, points);
                    let reference = self.references.as_ref().map(|_| journal.take_kept());
                    self.put(place, due, is_touching, reference.and_then(KeptPair::reference));
                }
                GroupNote::Pushed => self.pop(),
                GroupNote::Replaced(place) => {
                    if let KeptPair::Row(row) = journal.take_kept() {
                        self.put_row(place, *row);
                        changed(place);
                    }
                }
                GroupNote::Removed(place) => {
                    let KeptPair::Row(row) = journal.take_kept() else { continue };
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
        let _ = self.point_journal.undo(number);
        self.journal = journal;
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

/// Runs `action` for each group, with its [`GroupId`].
macro_rules! each_group {
    ($lanes:expr, |$lane:pat_param, $group:ident| $action:expr) => {{
        let PairGroups { contacts, composites, proximity, custom_contacts, custom_proximity } =
            $lanes;
        for (number, $group) in contacts.numbered_mut() {
            let $lane = GroupId::Contacts(number);
            $action;
        }
        for (number, $group) in proximity.numbered_mut() {
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
    /// Records the pairs at the locations `picked`, which are all in one group, before they are
    /// computed.
    pub(super) fn note(&mut self, picked: &[Location]) {
        let places = picked.iter().map(|at| at.row);
        match picked[0].group {
            GroupId::Contacts(number) => self.contacts.of_mut(number).note(places),
            GroupId::Composites => self.composites.note(places),
            GroupId::Proximity(number) => self.proximity.of_mut(number).note(places),
            GroupId::CustomContacts => self.custom_contacts.note(places),
            GroupId::CustomProximity => self.custom_proximity.note(places),
            GroupId::Nothing => {}
        }
    }

    /// Records the pairs that the update is about to compute.
    pub(super) fn note_due(&mut self, table: &ObjectTable<N, D>) {
        each_group!(self, |_, group| group.note_due(table));
    }
}

/// State of the narrow phase that a mark copies as a whole: the id counter and the keys of the
/// dirty pairs.
#[derive(Clone, Debug)]
pub(crate) struct NarrowHead {
    ids: IdAllocator,
    due: Vec<PairKey>,
}

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Sets a mark for a later [`Self::rewind`]; see [`Journal`](crate::journal::Journal).
    pub(crate) fn mark(&mut self, number: u64) {
        let head = NarrowHead { ids: self.ids.clone(), due: self.dirty_pairs.clone() };
        self.journal.mark(number, head);
        self.pairs.mark(number);
        each_group!(&mut self.groups, |_, group| group.mark(number));
    }

    /// Drops the marks whose numbers are less than `number`.
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
