//! Iterator over all manifolds of pairs of convex solids, read in place.

use core::ops::Range;
use core::{iter, slice};

use super::{BuiltIn, View};
use crate::math::Space;
use crate::narrow_phase::ObjectTable;
use crate::narrow_phase::pair_groups::ContactGroup;
use crate::narrow_phase::state::KeptPoints;

/// Iterator over the manifolds with at least one contact, group by group in memory order.
pub(super) struct ConvexViews<'a, N: Space<D>, const D: usize> {
    table: &'a ObjectTable<N, D>,
    groups: slice::Iter<'a, ContactGroup<N, D>>,
    group: Option<&'a ContactGroup<N, D>>,
    /// Index of the next word of flags in the group. `flags` has the flags of the word `word - 1`
    /// whose pairs have not been read yet.
    word: usize,
    flags: u64,
    /// Number of words of flags that the iterator may still read; `usize::MAX` if it is not
    /// restricted to a range.
    left: usize,
}

impl<'a, N: Space<D>, const D: usize> ConvexViews<'a, N, D> {
    pub(super) fn new(groups: &'a [ContactGroup<N, D>], table: &'a ObjectTable<N, D>) -> Self {
        let groups = groups.iter();
        Self { table, groups, group: None, word: 0, flags: 0, left: usize::MAX }
    }

    /// Returns the number of words of flags of all groups.
    pub(super) fn num_words(groups: &[ContactGroup<N, D>]) -> usize {
        groups.iter().map(|group| group.touching().len()).sum()
    }

    /// Restricts the iterator to a range of words of flags, numbered over all groups.
    pub(super) fn of_words(mut self, words: Range<usize>) -> Self {
        (self.left, self.word) = (words.len(), words.start);
        self.group = self.groups.next();
        while let Some(group) = self.group.filter(|group| group.touching().len() <= self.word) {
            self.word -= group.touching().len();
            self.group = self.groups.next();
        }
        self
    }

    /// Advances to the next word of flags that is not zero; `None` after the last word.
    #[inline(never)]
    fn next_word(&mut self) -> Option<&'a ContactGroup<N, D>> {
        loop {
            if let Some(group) = self.group
                && let Some(&flags) = group.touching().get(self.word)
            {
                self.left = self.left.checked_sub(1)?;
                (self.word, self.flags) = (self.word + 1, flags);
                if flags != 0 {
                    self.prefetch(group);
                    return Some(group);
                }
            } else {
                (self.group, self.word) = (Some(self.groups.next()?), 0);
            }
        }
    }

    /// Loads the data of the pairs in `flags`, so that the cache misses overlap. Changes nothing.
    fn prefetch(&self, group: &ContactGroup<N, D>) {
        let (mut flags, mut sum) = (self.flags, 0_u32);
        while flags != 0 {
            let row = take_row(self.word, &mut flags);
            let (key, entry) = (group.keys()[row], &group.states()[row]);
            let pose1 = self.table.pose(entry.state.frame_object(key));
            let loaded = (entry.number == 0) | (pose1.translation[0] > N::ZERO);
            sum = sum.wrapping_add(entry.state.prefetch()).wrapping_add(u32::from(loaded));
        }
        core::hint::black_box(sum);
    }

    /// Advances to the next touching pair; `None` after the last pair.
    #[inline]
    fn next_pair(&mut self) -> Option<(&'a ContactGroup<N, D>, usize)> {
        let group = if self.flags == 0 { self.next_word()? } else { self.group? };
        Some((group, take_row(self.word, &mut self.flags)))
    }

    /// Iterates over all manifolds with at least one contact, and builds those that cannot be read
    /// in place; see [`ObjectTable::needs_built_manifolds`].
    pub(super) fn with_built(mut self) -> impl Iterator<Item = View<'a, N, D>> + Send {
        let next = move || {
            let (group, row) = self.next_pair()?;
            let row = u32::try_from(row).expect("rows are numbers of 32 bits");
            Some((group.key(row), BuiltIn { table: self.table, group, row }))
        };
        iter::from_fn(next).filter_map(|(key, pair)| Some((key[0], key[1], pair.view()?)))
    }
}

/// Clears the lowest set flag of `flags`, the flags of word `word - 1`, and returns the row of its
/// pair.
#[inline]
const fn take_row(word: usize, flags: &mut u64) -> usize {
    let row = (word - 1) * 64 + flags.trailing_zeros() as usize;
    *flags &= *flags - 1;
    row
}

impl<'a, N: Space<D>, const D: usize> Iterator for ConvexViews<'a, N, D> {
    type Item = View<'a, N, D>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let (group, row) = self.next_pair()?;
        let (key, entry) = (group.keys()[row], &group.states()[row]);
        debug_assert!(entry.state.len() > 0, "a touching pair has contacts");
        Some((key[0], key[1], entry.state.view(self.table, key, entry.number)))
    }
}
