//! Iterator over all contacts of pairs of convex solids, read in place.

use core::ops::Range;
use core::{iter, slice};

use super::ObjectTable;
use super::lanes::ContactGroup;
use super::state::KeptPoints;
use super::view::{BuiltIn, View};
use crate::math::Space;

/// Iterates over the manifolds with at least one contact, group by group in memory order.
pub(super) struct ConvexViews<'a, N: Space<D>, const D: usize> {
    table: &'a ObjectTable<N, D>,
    groups: slice::Iter<'a, ContactGroup<N, D>>,
    group: Option<&'a ContactGroup<N, D>>,
    /// Index of the next word of flags in the group, and the remaining flags of the word before it.
    word: usize,
    flags: u64,
    /// Number of words that have not been read yet.
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
                    self.fetch(group);
                    return Some(group);
                }
            } else {
                (self.group, self.word) = (Some(self.groups.next()?), 0);
            }
        }
    }

    /// Prefetches the data of the pairs of a word of flags, so that their loads overlap. Changes
    /// nothing.
    fn fetch(&self, group: &ContactGroup<N, D>) {
        let (mut flags, mut sum) = (self.flags, 0_u32);
        while flags != 0 {
            let place = place(self.word, &mut flags);
            let (key, entry) = (group.keys()[place], &group.states()[place]);
            let home = self.table.pose(entry.state.home(key));
            let seen = (entry.number == 0) | (home.translation[0] > N::ZERO);
            sum = sum.wrapping_add(entry.state.fetch()).wrapping_add(u32::from(seen));
        }
        core::hint::black_box(sum);
    }

    /// Advances to the next touching pair; `None` after the last pair.
    #[inline]
    fn next_pair(&mut self) -> Option<(&'a ContactGroup<N, D>, usize)> {
        let group = if self.flags == 0 { self.next_word()? } else { self.group? };
        Some((group, place(self.word, &mut self.flags)))
    }

    /// Iterates over the same contacts when some pairs are particular: manifolds of these pairs are
    /// built for the reader.
    pub(super) fn particular(mut self) -> impl Iterator<Item = View<'a, N, D>> + Send {
        let next = move || {
            let (group, place) = self.next_pair()?;
            let place = u32::try_from(place).expect("places are numbers of 32 bits");
            Some((group.key(place), BuiltIn { table: self.table, group, place }))
        };
        iter::from_fn(next).filter_map(|(key, pair)| Some((key[0], key[1], pair.view()?)))
    }
}

/// Clears the lowest flag of the word before `word`, and returns the index of its pair.
#[inline]
const fn place(word: usize, flags: &mut u64) -> usize {
    let place = (word - 1) * 64 + flags.trailing_zeros() as usize;
    *flags &= *flags - 1;
    place
}

impl<'a, N: Space<D>, const D: usize> Iterator for ConvexViews<'a, N, D> {
    type Item = View<'a, N, D>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let (group, place) = self.next_pair()?;
        let (key, entry) = (group.keys()[place], &group.states()[place]);
        debug_assert!(entry.state.len() > 0, "a touching pair has contacts");
        Some((key[0], key[1], entry.state.view(self.table, key, entry.number)))
    }
}
