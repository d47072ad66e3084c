//! A group: pairs with the same algorithm, in parallel dense arrays.
//!
//! The size of chunks is constant, and does not depend on the number of threads.
//!
//! ```text
//! row          0      1      2     ...            swap_remove(1): the last pair moves to row 1
//! keys        [a,b]  [a,c]  [d,e]                 and `RemovedRow::moved` names it
//! dirty        0      1      0
//! touching    bit 0  bit 1  bit 2  (64 per word)
//! states       S      S      S
//! views        V      V      V     (created at the first read)
//! references   R      R      R     (only with contact reuse)
//! ```

use std::sync::OnceLock;

use super::ObjectTable;
use super::rewind::{GroupNote, KeptPair, Parts};
use crate::journal::Journal;
use crate::math::Space;
use crate::memory::Look;

/// Number of pairs in a task: enough to outweigh the cost of a task, and few enough to balance the
/// load. It is a constant, so that the order of results does not depend on the number of threads.
pub(super) const CHUNK: usize = 128;

/// Number of flags in a word.
const WORD: usize = 64;

/// The two objects of a pair, by handle index.
pub(crate) type PairKey = [u32; 2];

/// A subset of the pairs of a chunk, as a bit set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RowSet([u64; CHUNK / WORD]);

/// Pairs with the same algorithm and their states, without gaps and in unspecified order.
///
/// A pair's row changes when another pair of the group is removed; [`RemovedRow::moved`] reports
/// it. The flags that are read for every pair, dirty and touching, are stored apart from the
/// states, so that skipping a pair does not load its state.
///
/// Each state has a view, in which users read it. All views are created together on first access,
/// so they cost nothing without readers. With contact reuse ([`Reuse`](super::reuse::Reuse)) each
/// state also has a reference.
#[derive(Debug)]
pub(crate) struct Group<S: Parts, V = (), R = ()> {
    pub(super) keys: Vec<PairKey>,
    /// By row: whether the pair must be updated even if neither object moves.
    pub(super) dirty: Vec<bool>,
    /// By row, as bits: whether the pair has contact points. Surplus bits are zero.
    pub(super) touching: Vec<u64>,
    pub(super) states: Vec<S>,
    /// A view for each state; created on first access.
    pub(super) views: OnceLock<Vec<V>>,
    /// For each state, the reference pose and distances of contact reuse; `None` without contact
    /// reuse.
    pub(super) references: Option<Vec<R>>,
    pub(super) journal: Journal<GroupNote<S>, (), KeptPair<S, R>>,
    /// Points of the pairs in [`GroupNote::Written`] notes.
    pub(super) point_journal: Journal<S::Point>,
    /// By row, if there are marks: the period in which the pair was last noted, plus 1 if it was
    /// then noted as a whole, or added.
    pub(super) noted: Vec<u8>,
    /// The current period: even, and greater than 0 if there are marks. Each mark begins a new
    /// period.
    pub(super) period: u8,
}

/// Clones neither the views, which are created again on first access, nor the marks.
impl<S: Parts, V, R: Clone> Clone for Group<S, V, R> {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, source: &Self) {
        let Self { keys, dirty, touching, states, views, references, .. } = self;
        keys.clone_from(&source.keys);
        dirty.clone_from(&source.dirty);
        touching.clone_from(&source.touching);
        states.clone_from(&source.states);
        views.take();
        references.clone_from(&source.references);
        self.journal = Journal::default();
        self.point_journal = Journal::default();
        self.noted.clear();
    }
}

/// Parallel slices over the pairs of a group or of a chunk.
pub(crate) struct Rows<'a, S, V, R = ()> {
    pub(crate) keys: &'a [PairKey],
    dirty: &'a mut [bool],
    touching: &'a mut [u64],
    pub(crate) states: &'a mut [S],
    /// A view for each state; empty if there are no views.
    pub(crate) views: &'a mut [V],
    /// A reference for each state; empty without contact reuse.
    pub(crate) references: &'a mut [R],
}

/// A pair that was removed from a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RemovedRow<S> {
    pub(crate) state: S,
    pub(crate) is_touching: bool,
    /// The pair that moved to the row of the removed pair; `None` if the removed pair was the last.
    pub(crate) moved: Option<PairKey>,
}

impl<S: Parts, V, R> Default for Group<S, V, R> {
    fn default() -> Self {
        let (keys, dirty, touching) = (Vec::new(), Vec::new(), Vec::new());
        let (views, references) = (OnceLock::new(), None);
        Self {
            keys,
            dirty,
            touching,
            states: Vec::new(),
            views,
            references,
            journal: Journal::default(),
            point_journal: Journal::default(),
            noted: Vec::new(),
            period: 0,
        }
    }
}

/// Returns the word index of a pair's flag, and its bit.
const fn flag(row: usize) -> (usize, u64) {
    (row / WORD, 1 << (row % WORD))
}

/// Sets whether a pair touches; returns `true` if this changes its flag.
#[inline]
pub(super) fn set_touching(words: &mut [u64], row: usize, is_touching: bool) -> bool {
    let (word, bit) = flag(row);
    let is_new = (words[word] & bit != 0) != is_touching;
    words[word] ^= if is_new { bit } else { 0 };
    is_new
}

impl<S: Parts, V: Default, R: Clone + Default> Group<S, V, R> {
    /// Creates a group without pairs that stores references.
    pub(crate) fn with_references() -> Self {
        Self { references: Some(Vec::new()), ..Self::default() }
    }

    /// Adds a pair, marks it as dirty, and returns its row.
    pub(crate) fn push(&mut self, key: PairKey, state: S, is_touching: bool) -> u32 {
        let row = self.keys.len();
        if self.journal.is_on() {
            self.journal.note(GroupNote::Pushed);
            self.noted.push(self.period + 1);
        }
        self.keys.push(key);
        self.dirty.push(true);
        self.touching.resize(self.keys.len().div_ceil(WORD), 0);
        set_touching(&mut self.touching, row, is_touching);
        self.states.push(state);
        if let Some(views) = self.views.get_mut() {
            views.push(V::default());
        }
        if let Some(references) = &mut self.references {
            references.push(R::default());
        }
        u32::try_from(row).expect("fewer than 2^32 pairs fit in memory")
    }

    /// Removes the pair in a row; the last pair moves to that row.
    pub(crate) fn swap_remove(&mut self, row: u32) -> RemovedRow<S> {
        self.note_removed(row);
        let (is_touching, row) = (self.is_touching(row), row as usize);
        let last = self.keys.len() - 1;
        let (word, bit) = flag(last);
        let is_last_touching = self.touching[word] & bit != 0;
        set_touching(&mut self.touching, row, is_last_touching);
        set_touching(&mut self.touching, last, false);
        self.touching.truncate(last.div_ceil(WORD));
        self.keys.swap_remove(row);
        self.dirty.swap_remove(row);
        if let Some(views) = self.views.get_mut() {
            views.swap_remove(row);
        }
        if let Some(references) = &mut self.references {
            references.swap_remove(row);
        }
        let (state, moved) = (self.states.swap_remove(row), self.keys.get(row).copied());
        RemovedRow { state, is_touching, moved }
    }

    /// Replaces the pair in a row by a new pair, which is dirty and not touching. Returns `true` if
    /// the old pair was touching.
    pub(crate) fn replace(&mut self, row: u32, key: PairKey, state: S) -> bool {
        self.note_whole(row);
        let at = row as usize;
        let was_touching = set_touching(&mut self.touching, at, false);
        (self.keys[at], self.dirty[at], self.states[at]) = (key, true, state);
        if let Some(views) = self.views.get_mut() {
            views[at] = V::default();
        }
        if let Some(references) = &mut self.references {
            references[at] = R::default();
        }
        was_touching
    }

    /// Releases surplus memory of a group that has stopped growing.
    pub(crate) fn fit(&mut self, look: Look) {
        look.fit(&mut self.keys);
        look.fit(&mut self.dirty);
        look.fit(&mut self.states);
        if let Some(references) = &mut self.references {
            look.fit(references);
        }
    }

    /// Returns `true` if the pair in a row has contact points.
    pub(crate) fn is_touching(&self, row: u32) -> bool {
        let (word, bit) = flag(row as usize);
        self.touching[word] & bit != 0
    }

    /// Marks a pair as dirty, so that the next update computes it even if neither object moves.
    /// Drops its reference.
    pub(crate) fn mark_dirty(&mut self, row: u32) {
        self.note_whole(row);
        self.dirty[row as usize] = true;
        if let Some(references) = &mut self.references {
            references[row as usize] = R::default();
        }
    }

    /// Returns the state of the pair in a row.
    pub(crate) fn state(&self, row: u32) -> &S {
        &self.states[row as usize]
    }

    /// Returns the state of the pair in a row, for changes; records its old value if there are
    /// marks.
    pub(crate) fn state_mut(&mut self, row: u32) -> &mut S {
        self.note_whole(row);
        &mut self.states[row as usize]
    }

    /// Returns the view of the pair in a row; creates all views on first access.
    pub(crate) fn view(&self, row: u32) -> &V {
        let make = || self.keys.iter().map(|_| V::default()).collect();
        &self.views.get_or_init(make)[row as usize]
    }

    /// Returns the key of the pair in a row.
    pub(crate) fn key(&self, row: u32) -> PairKey {
        self.keys[row as usize]
    }

    /// Returns the keys of all pairs, by row.
    pub(crate) fn keys(&self) -> &[PairKey] {
        &self.keys
    }

    /// Returns the states of all pairs, by row.
    pub(crate) fn states(&self) -> &[S] {
        &self.states
    }

    /// Returns the touching flags, 64 in a word; the lowest bit is the lowest row.
    pub(crate) fn touching(&self) -> &[u64] {
        &self.touching
    }

    /// Iterates over the touching pairs with their states, by ascending row.
    pub(crate) fn iter_touching(&self) -> impl Iterator<Item = (PairKey, &S)> {
        let pairs = (0..).zip(&self.keys).zip(&self.states);
        let pairs = pairs.filter(|((row, _), _)| self.is_touching(*row));
        pairs.map(|((_, &key), state)| (key, state))
    }

    /// Returns `true` if there is no pair.
    pub(crate) const fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// Returns slices over all pairs.
    pub(crate) fn rows(&mut self) -> Rows<'_, S, V, R> {
        let views = self.views.get_mut().map_or(&mut [][..], Vec::as_mut_slice);
        let Self { keys, dirty, touching, states, references, .. } = self;
        let references = references.as_deref_mut().unwrap_or_default();
        Rows { keys, dirty, touching, states, views, references }
    }
}

impl RowSet {
    /// Removes from the set the rows for which `stays` returns `false`.
    pub(super) fn retain(&mut self, mut stays: impl FnMut(usize) -> bool) {
        for index in self.indices() {
            let (word, bit) = flag(index);
            self.0[word] ^= if stays(index) { 0 } else { bit };
        }
    }

    /// Iterates over the indices in ascending order.
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
    /// Returns the number of pairs.
    pub(crate) const fn len(&self) -> usize {
        self.keys.len()
    }

    pub(crate) fn reborrow(&mut self) -> Rows<'_, S, V, R> {
        let Rows { keys, dirty, touching, states, views, references } = self;
        Rows { keys, dirty, touching, states, views, references }
    }

    /// Splits the slices into chunks of [`CHUNK`] pairs; the last chunk may be shorter.
    pub(crate) fn chunks(self) -> impl Iterator<Item = Rows<'a, S, V, R>> {
        let (mut views, mut dirty) = (self.views.chunks_mut(CHUNK), self.dirty.chunks_mut(CHUNK));
        let mut touching = self.touching.chunks_mut(CHUNK / WORD);
        let mut references = self.references.chunks_mut(CHUNK);
        let pairs = self.keys.chunks(CHUNK).zip(self.states.chunks_mut(CHUNK));
        pairs.map(move |(keys, states)| Rows {
            keys,
            dirty: dirty.next().unwrap_or_default(),
            touching: touching.next().unwrap_or_default(),
            states,
            views: views.next().unwrap_or_default(),
            references: references.next().unwrap_or_default(),
        })
    }

    /// Returns the key of a pair, its state, and its view if the group has views.
    #[inline]
    pub(crate) fn row(&mut self, row: usize) -> (PairKey, &mut S, Option<&mut V>) {
        (self.keys[row], &mut self.states[row], self.views.get_mut(row))
    }

    /// Returns `true` if the pair must be computed: it is marked as dirty, or one of its objects
    /// changed. Clears the mark.
    #[inline]
    pub(crate) fn take_dirty<N: Space<D>, const D: usize>(
        &mut self,
        row: usize,
        table: &ObjectTable<N, D>,
    ) -> bool {
        let [first, second] = self.keys[row];
        self.take_dirty_flag(row) | table.has_changed(first) | table.has_changed(second)
    }

    /// Returns `true` if the pair is marked as dirty, and clears the mark.
    #[inline]
    pub(crate) fn take_dirty_flag(&mut self, row: usize) -> bool {
        core::mem::take(&mut self.dirty[row])
    }

    /// Returns the pairs of a chunk that must be computed, and clears their marks.
    ///
    /// The loop reads only flags and change bits, and has no branches. So it does not wait for the
    /// states of pairs to load.
    pub(super) fn take_all_dirty<N: Space<D>, const D: usize>(
        &mut self,
        table: &ObjectTable<N, D>,
    ) -> RowSet {
        let mut selected = RowSet([0; CHUNK / WORD]);
        for row in 0..self.keys.len().min(CHUNK) {
            let is_dirty = self.take_dirty(row, table);
            selected.0[row / WORD] |= u64::from(is_dirty) << (row % WORD);
        }
        selected
    }

    /// Sets whether the pair has contact points; returns `true` if this changes its flag.
    #[inline]
    pub(crate) fn set_touching(&mut self, row: usize, is_touching: bool) -> bool {
        set_touching(self.touching, row, is_touching)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_pair_fills_the_gap() {
        let mut group = Group::<u32>::default();
        for n in 0..3 {
            assert_eq!(group.push([n, n + 1], n, n == 2), n, "rows are dense");
        }
        let removed = |state, is_touching, moved| RemovedRow { state, is_touching, moved };
        assert_eq!(
            group.swap_remove(0),
            removed(0, false, Some([2, 3])),
            "the last moves to the front"
        );
        assert_eq!((group.key(0), *group.state(0)), ([2, 3], 2), "with its state");
        assert_eq!(group.touching(), [1], "and with its flag");
        assert_eq!(
            group.swap_remove(1),
            removed(1, false, None),
            "nobody moves when the last goes"
        );
        assert_eq!(group.swap_remove(0), removed(2, true, None), "none is left");
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
            let row = step * 7 % (200 - step);
            let state = *group.state(row);
            assert_eq!(group.swap_remove(row).is_touching, is_third(state), "that of {state}");
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
        assert_eq!([1, 4].map(|row| *group.view(row)), [Some(4), None], "moved, and new");
        for n in 5..130 {
            group.push([n, n], n, false);
        }
        let sizes = group.rows().chunks().map(|rows| (rows.states.len(), rows.views.len()));
        assert_eq!(sizes.collect::<Vec<_>>(), [(128, 128), (2, 2)], "cut alike");
    }
}
