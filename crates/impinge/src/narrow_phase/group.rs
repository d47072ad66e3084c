//! Pairs that share one algorithm, side by side.
//!
//! Chunks have a constant size, never one that depends on the number of threads. Reading memory ahead of time
//! changes no answer.

use std::sync::OnceLock;

use super::ObjectTable;
use super::rewind::{GroupNote, Parts};
use crate::journal::Journal;
use crate::math::Space;
use crate::memory::Look;

/// Pairs per task: large enough to hide the cost of a task, small enough to spread the load. A
/// constant, so that the order of results never depends on the number of threads.
pub(super) const CHUNK: usize = 128;

/// Pairs in a word of flags.
const WORD: usize = 64;

/// The two objects of a pair, by handle index.
pub(crate) type PairKey = [u32; 2];

/// Some of at most [`CHUNK`] pairs, a bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Chosen([u64; CHUNK / WORD]);

/// The states of some pairs in no particular order, without gaps.
///
/// A pair's place changes when another pair of the group is removed; whoever keeps places is notified.
/// What is asked of all pairs again and again, whether they are due and whether they touch, stands apart
/// from the states, so that who passes over a pair does not wait for its memory.
/// To each state belongs a view: what readers make of it. The views come into being, all together,
/// when the first is asked for: who never asks pays nothing for them.
/// Where pairs may keep contacts while they hardly move ([`Reuse`](super::reuse::Reuse)), a reference
/// belongs to each state too.
#[derive(Debug)]
pub(crate) struct Group<S: Parts, V = (), R = ()> {
    pub(super) keys: Vec<PairKey>,
    /// By pair: to be updated even if both objects stand still.
    pub(super) due: Vec<bool>,
    /// By pair, a bit each, the others zero: it has contact points.
    pub(super) touching: Vec<u64>,
    pub(super) states: Vec<S>,
    /// One for each state, or none at all.
    pub(super) views: OnceLock<Vec<V>>,
    /// One for each state, if there are any.
    pub(super) references: Option<Vec<R>>,
    pub(super) journal: Journal<GroupNote<S, R>>,
    /// The references of the pairs that [`GroupNote::Written`] notes.
    pub(super) reference_journal: Journal<R>,
    /// By pair, if there are marks: the period in which it was noted or came. One begins with each mark.
    pub(super) noted: Vec<u8>,
    pub(super) period: u8,
}

/// Without the views, which whoever reads them first has made anew, and without marks.
impl<S: Parts, V, R: Clone> Clone for Group<S, V, R> {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, source: &Self) {
        let Self { keys, due, touching, states, views, references, .. } = self;
        keys.clone_from(&source.keys);
        due.clone_from(&source.due);
        touching.clone_from(&source.touching);
        states.clone_from(&source.states);
        views.take();
        references.clone_from(&source.references);
        self.journal = Journal::default();
        self.reference_journal = Journal::default();
        self.noted.clear();
    }
}

/// The pairs of a group to work on, side by side.
pub(crate) struct Rows<'a, S, V, R = ()> {
    pub(crate) keys: &'a [PairKey],
    due: &'a mut [bool],
    touching: &'a mut [u64],
    pub(crate) states: &'a mut [S],
    /// As many as states, or none.
    pub(crate) views: &'a mut [V],
    /// As many as states, or none.
    pub(crate) references: &'a mut [R],
}

/// A pair that was taken out of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Taken<S> {
    pub(crate) state: S,
    pub(crate) is_touching: bool,
    /// The pair that now has its place, if any.
    pub(crate) moved: Option<PairKey>,
}

impl<S: Parts, V, R> Default for Group<S, V, R> {
    fn default() -> Self {
        let (keys, due, touching) = (Vec::new(), Vec::new(), Vec::new());
        let (views, references) = (OnceLock::new(), None);
        Self {
            keys,
            due,
            touching,
            states: Vec::new(),
            views,
            references,
            journal: Journal::default(),
            reference_journal: Journal::default(),
            noted: Vec::new(),
            period: 0,
        }
    }
}

/// The word of a pair's flag, and its bit.
const fn flag(place: usize) -> (usize, u64) {
    (place / WORD, 1 << (place % WORD))
}

/// Says whether a pair touches, and answers whether that is new.
#[inline]
pub(super) fn set_touching(words: &mut [u64], place: usize, is_touching: bool) -> bool {
    let (word, bit) = flag(place);
    let is_new = (words[word] & bit != 0) != is_touching;
    words[word] ^= if is_new { bit } else { 0 };
    is_new
}

impl<S: Parts, V: Default, R: Clone + Default> Group<S, V, R> {
    /// A group without pairs that has references.
    pub(crate) fn with_references() -> Self {
        Self { references: Some(Vec::new()), ..Self::default() }
    }

    /// Adds a pair, which is due, and answers its place.
    pub(crate) fn push(&mut self, key: PairKey, state: S, is_touching: bool) -> u32 {
        let place = self.keys.len();
        if self.journal.is_on() {
            self.journal.note(GroupNote::Pushed);
            self.noted.push(self.period);
        }
        self.keys.push(key);
        self.due.push(true);
        self.touching.resize(self.keys.len().div_ceil(WORD), 0);
        set_touching(&mut self.touching, place, is_touching);
        self.states.push(state);
        if let Some(views) = self.views.get_mut() {
            views.push(V::default());
        }
        if let Some(references) = &mut self.references {
            references.push(R::default());
        }
        u32::try_from(place).expect("fewer than 2^32 pairs fit in memory")
    }

    /// Takes a pair out; the last one gets its place.
    pub(crate) fn swap_remove(&mut self, place: u32) -> Taken<S> {
        self.note_removed(place);
        let (is_touching, place) = (self.is_touching(place), place as usize);
        let last = self.keys.len() - 1;
        let (word, bit) = flag(last);
        let is_last_touching = self.touching[word] & bit != 0;
        set_touching(&mut self.touching, place, is_last_touching);
        set_touching(&mut self.touching, last, false);
        self.touching.truncate(last.div_ceil(WORD));
        self.keys.swap_remove(place);
        self.due.swap_remove(place);
        if let Some(views) = self.views.get_mut() {
            views.swap_remove(place);
        }
        if let Some(references) = &mut self.references {
            references.swap_remove(place);
        }
        let (state, moved) = (self.states.swap_remove(place), self.keys.get(place).copied());
        Taken { state, is_touching, moved }
    }

    /// Gives the place of a pair to another, which is due and does not touch, and answers whether the first
    /// one did.
    pub(crate) fn replace(&mut self, place: u32, key: PairKey, state: S) -> bool {
        self.note_whole(place);
        let at = place as usize;
        let was_touching = set_touching(&mut self.touching, at, false);
        (self.keys[at], self.due[at], self.states[at]) = (key, true, state);
        if let Some(views) = self.views.get_mut() {
            views[at] = V::default();
        }
        if let Some(references) = &mut self.references {
            references[at] = R::default();
        }
        was_touching
    }

    /// Gives back memory that a group which has stopped to grow does not need.
    pub(crate) fn fit(&mut self, look: Look) {
        look.fit(&mut self.keys);
        look.fit(&mut self.due);
        look.fit(&mut self.states);
        if let Some(references) = &mut self.references {
            look.fit(references);
        }
    }

    /// The pair at a place has contact points.
    pub(crate) fn is_touching(&self, place: u32) -> bool {
        let (word, bit) = flag(place as usize);
        self.touching[word] & bit != 0
    }

    /// Asks for a pair to be updated even if both objects stand still; what it could be held against is
    /// forgotten.
    pub(crate) fn make_due(&mut self, place: u32) {
        self.note_whole(place);
        self.due[place as usize] = true;
        if let Some(references) = &mut self.references {
            references[place as usize] = R::default();
        }
    }

    /// The state of the pair at a place.
    pub(crate) fn state(&self, place: u32) -> &S {
        &self.states[place as usize]
    }

    /// The state of the pair at a place, to change.
    pub(crate) fn state_mut(&mut self, place: u32) -> &mut S {
        self.note_whole(place);
        &mut self.states[place as usize]
    }

    /// The view of the pair at a place.
    pub(crate) fn view(&self, place: u32) -> &V {
        let make = || self.keys.iter().map(|_| V::default()).collect();
        &self.views.get_or_init(make)[place as usize]
    }

    /// The pair at a place.
    pub(crate) fn key(&self, place: u32) -> PairKey {
        self.keys[place as usize]
    }

    /// The pairs, in the order in which they lie.
    pub(crate) fn keys(&self) -> &[PairKey] {
        &self.keys
    }

    /// Their states.
    pub(crate) fn states(&self) -> &[S] {
        &self.states
    }

    /// Which of them touch, sixty-four in a word.
    pub(crate) fn touching(&self) -> &[u64] {
        &self.touching
    }

    /// The touching pairs with their states, in the order in which they lie.
    pub(crate) fn iter_touching(&self) -> impl Iterator<Item = (PairKey, &S)> {
        let pairs = (0..).zip(&self.keys).zip(&self.states);
        let pairs = pairs.filter(|((place, _), _)| self.is_touching(*place));
        pairs.map(|((_, &key), state)| (key, state))
    }

    /// There is no pair.
    pub(crate) const fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// All pairs, their states and their views.
    pub(crate) fn rows(&mut self) -> Rows<'_, S, V, R> {
        let views = self.views.get_mut().map_or(&mut [][..], Vec::as_mut_slice);
        let Self { keys, due, touching, states, references, .. } = self;
        let references = references.as_deref_mut().unwrap_or_default();
        Rows { keys, due, touching, states, views, references }
    }
}

impl Chosen {
    /// Leaves out those that are not to stay.
    pub(super) fn retain(&mut self, mut stays: impl FnMut(usize) -> bool) {
        for index in self.indices() {
            let (word, bit) = flag(index);
            self.0[word] ^= if stays(index) { 0 } else { bit };
        }
    }

    /// Their indices, ascending.
    pub(super) fn indices(mut self) -> impl Iterator<Item = usize> {
        let mut word = 0;
        core::iter::from_fn(move || {
            while self.0[word] == 0 {
                word = Some(word + 1).filter(|&word| word < CHUNK / WORD)?;
            }
            let lowest = self.0[word].trailing_zeros() as usize;
            self.0[word] &= self.0[word] - 1;
            Some(word * WORD + lowest)
        })
    }
}

impl<'a, S, V, R> Rows<'a, S, V, R> {
    /// How many pairs there are.
    pub(crate) const fn len(&self) -> usize {
        self.keys.len()
    }

    /// The same rows, to be used once more afterwards.
    pub(crate) fn reborrow(&mut self) -> Rows<'_, S, V, R> {
        let Rows { keys, due, touching, states, views, references } = self;
        Rows { keys, due, touching, states, views, references }
    }

    /// The rows in pieces of [`CHUNK`], the last one perhaps shorter.
    pub(crate) fn chunks(self) -> impl Iterator<Item = Rows<'a, S, V, R>> {
        let (mut views, mut due) = (self.views.chunks_mut(CHUNK), self.due.chunks_mut(CHUNK));
        let mut touching = self.touching.chunks_mut(CHUNK / WORD);
        let mut references = self.references.chunks_mut(CHUNK);
        let pairs = self.keys.chunks(CHUNK).zip(self.states.chunks_mut(CHUNK));
        pairs.map(move |(keys, states)| Rows {
            keys,
            due: due.next().unwrap_or_default(),
            touching: touching.next().unwrap_or_default(),
            states,
            views: views.next().unwrap_or_default(),
            references: references.next().unwrap_or_default(),
        })
    }

    /// A pair with its state and its view.
    #[inline]
    pub(crate) fn row(&mut self, index: usize) -> (PairKey, &mut S, Option<&mut V>) {
        (self.keys[index], &mut self.states[index], self.views.get_mut(index))
    }

    /// The pair needs a new query: it is due, or one of its objects changed. If so, it is due no more.
    #[inline]
    pub(crate) fn take_due<N: Space<D>, const D: usize>(
        &mut self,
        index: usize,
        table: &ObjectTable<N, D>,
    ) -> bool {
        let [first, second] = self.keys[index];
        self.take_mark(index) | table.has_changed(first) | table.has_changed(second)
    }

    /// The pair is marked as due; it is so no more.
    #[inline]
    pub(crate) fn take_mark(&mut self, index: usize) -> bool {
        core::mem::take(&mut self.due[index])
    }

    /// Those of a chunk of pairs that need a new query. Nothing is due any more.
    ///
    /// Whether objects changed is known before the memory of the pairs comes: no branch waits for it.
    pub(super) fn take_all_due<N: Space<D>, const D: usize>(
        &mut self,
        table: &ObjectTable<N, D>,
    ) -> Chosen {
        let mut chosen = Chosen([0; CHUNK / WORD]);
        for index in 0..self.keys.len().min(CHUNK) {
            let is_due = self.take_due(index, table);
            chosen.0[index / WORD] |= u64::from(is_due) << (index % WORD);
        }
        chosen
    }

    /// Says that the pair has contact points, or none, and answers whether that is new.
    #[inline]
    pub(crate) fn set_touching(&mut self, index: usize, is_touching: bool) -> bool {
        set_touching(self.touching, index, is_touching)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_pair_fills_the_gap() {
        let mut group = Group::<u32>::default();
        for n in 0..3 {
            assert_eq!(group.push([n, n + 1], n, n == 2), n, "places are dense");
        }
        let taken = |state, is_touching, moved| Taken { state, is_touching, moved };
        assert_eq!(
            group.swap_remove(0),
            taken(0, false, Some([2, 3])),
            "the last moves to the front"
        );
        assert_eq!((group.key(0), *group.state(0)), ([2, 3], 2), "with its state");
        assert_eq!(group.touching(), [1], "and with its flag");
        assert_eq!(group.swap_remove(1), taken(1, false, None), "nobody moves when the last goes");
        assert_eq!(group.swap_remove(0), taken(2, true, None), "none is left");
        assert!(group.touching().is_empty(), "nor a flag");
    }

    #[test]
    fn flags_follow_their_pairs() {
        let mut group = Group::<u32>::default();
        let is_third = |n: u32| n.is_multiple_of(3);
        for n in 0..200 {
            group.push([n, n], n, is_third(n));
        }
        for step in 0..150 {
            let place = step * 7 % (200 - step);
            let state = *group.state(place);
            assert_eq!(group.swap_remove(place).is_touching, is_third(state), "that of {state}");
        }
        let touching: Vec<_> = group.iter_touching().map(|(_, &state)| state).collect();
        let expected = group.states().iter().copied().filter(|&n| is_third(n));
        assert_eq!(touching, expected.collect::<Vec<_>>(), "in order");
        assert!((10..25).contains(&touching.len()), "about a third: {}", touching.len());
        for mut rows in group.rows().chunks() {
            let flags = (0..rows.len()).map(|n| (is_third(*rows.row(n).1), n)).collect::<Vec<_>>();
            assert!(flags.iter().all(|&(flag, n)| !rows.set_touching(n, flag)), "nothing new");
            assert!(flags.iter().all(|&(flag, n)| rows.set_touching(n, !flag)), "all new");
        }
    }

    #[test]
    fn views_follow_their_pairs_once_there_are_any() {
        let mut group = Group::<u32, Option<u32>>::default();
        for n in 0..5 {
            group.push([n, n + 1], n, false);
        }
        assert!(group.rows().views.is_empty(), "nobody asked");
        assert_eq!(*group.view(3), None, "made now");
        for index in 0..5 {
            let mut rows = group.rows();
            let (_, state, view) = rows.row(index);
            *view.expect("one for each") = Some(*state);
        }
        group.swap_remove(1);
        group.push([9, 9], 9, false);
        assert_eq!([1, 4].map(|place| *group.view(place)), [Some(4), None], "moved, and new");
        for n in 5..130 {
            group.push([n, n], n, false);
        }
        let sizes = group.rows().chunks().map(|rows| (rows.states.len(), rows.views.len()));
        assert_eq!(sizes.collect::<Vec<_>>(), [(128, 128), (2, 2)], "cut alike");
    }
}
