//! Iterator over all manifolds of pairs with composites, read in place.

use core::iter;
use core::ops::Range;

use super::{Composite, View};
use crate::math::{Space, max};
use crate::narrow_phase::ObjectTable;
use crate::narrow_phase::pair_groups::CompositeGroup;

/// Iterator over the manifolds with at least one contact, in memory order.
pub(super) struct CompositeViews<'a, N: Space<D>, const D: usize> {
    table: &'a ObjectTable<N, D>,
    group: &'a CompositeGroup<N, D>,
    /// Touching flags, 64 in a word.
    touching: &'a [u64],
    /// Index of the next word of flags. `flags` has the flags of the word `word - 1` whose pairs
    /// have not been read yet.
    word: usize,
    flags: u64,
    /// Row of the current pair, and the index of the patch that is read next. A patch has the
    /// contacts of one manifold. The index is `usize::MAX` if there is no current pair.
    row: usize,
    patch: usize,
}

impl<'a, N: Space<D>, const D: usize> CompositeViews<'a, N, D> {
    pub(super) fn new(group: &'a CompositeGroup<N, D>, table: &'a ObjectTable<N, D>) -> Self {
        let touching = group.touching();
        Self { table, group, touching, word: 0, flags: 0, row: 0, patch: usize::MAX }
    }

    /// Restricts the iterator to a range of words of flags.
    pub(super) fn of_words(self, words: Range<usize>) -> Self {
        Self { touching: &self.touching[..words.end], word: words.start, ..self }
    }

    /// Advances to the next touching pair; `None` after the last pair.
    #[inline(never)]
    fn next_pair(&mut self) -> Option<()> {
        while self.flags == 0 {
            self.flags = *self.touching.get(self.word)?;
            self.word += 1;
            self.prefetch();
        }
        (self.row, self.patch) = (self.lowest_row(self.flags), 0);
        self.flags &= self.flags - 1;
        Some(())
    }

    /// Returns the row of the pair of the lowest set bit in `flags`, which are flags of the word
    /// `self.word - 1`.
    const fn lowest_row(&self, flags: u64) -> usize {
        (self.word - 1) * 64 + flags.trailing_zeros() as usize
    }

    /// Loads the data of the pairs in `flags`, so that the cache misses overlap. Changes nothing.
    fn prefetch(&self) {
        let (mut flags, mut loaded) = (self.flags, N::ZERO);
        while flags != 0 {
            let row = self.lowest_row(flags);
            flags &= flags - 1;
            let (key, entry) = (self.group.keys()[row], &self.group.states()[row]);
            let pose1 = self.table.pose(entry.state.frame_object(key));
            loaded = max(loaded, max(entry.state.prefetch(), pose1.translation[0]));
        }
        core::hint::black_box(loaded);
    }

    /// Iterates over all manifolds with at least one contact, and builds those that cannot be read
    /// in place; see [`ObjectTable::needs_built_manifolds`].
    pub(super) fn with_built(mut self) -> impl Iterator<Item = View<'a, N, D>> + Send {
        let next = move || {
            self.next_pair()?;
            let (group, row) = (self.group, u32::try_from(self.row).ok()?);
            Some((group.key(row), Composite { table: self.table, group, row }))
        };
        iter::from_fn(next)
            .flat_map(|(key, pair)| pair.views().map(move |view| (key[0], key[1], view)))
    }
}

impl<'a, N: Space<D>, const D: usize> Iterator for CompositeViews<'a, N, D> {
    type Item = View<'a, N, D>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if self.patch != usize::MAX {
                let (key, entry) = (self.group.keys()[self.row], &self.group.states()[self.row]);
                let view = entry.state.view(self.table, key, entry.number, self.patch);
                self.patch += 1;
                if let Some(view) = view {
                    return Some((key[0], key[1], view));
                }
                self.patch = usize::MAX;
            }
            self.next_pair()?;
        }
    }
}
