//! The set of pairs, with its dense array, its links and its journal.

use super::adjacency::{Adjacency, Link, small};
use crate::journal::Journal;
use crate::memory::{Look, clone_fields};

/// A set of unordered pairs of indices. The [module](super) describes its layout.
///
/// An index may be paired with any index, itself included. Finding, inserting and removing a pair
/// take constant time.
#[derive(Debug, Default)]
pub(crate) struct PairTable {
    pairs: Vec<(u32, u32)>,
    adjacency: Adjacency,
    journal: Journal<PairNote>,
}

clone_fields!([] PairTable { pairs, adjacency, journal });

/// A change of the set, by which a rewind undoes it.
#[derive(Clone, Copy, Debug)]
enum PairNote {
    Inserted(u32, u32),
    Removed(u32, u32),
}

/// The outcome of [`PairTable::insert`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Inserted {
    /// Index of the pair in [`PairTable::pairs`].
    pub index: usize,
    /// Whether the pair was not in the set before; it is then the last one.
    pub is_new: bool,
}

/// Effect of a removal on the dense array: exactly `swap_remove(index)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Removed {
    /// Index of the removed pair.
    pub index: usize,
    /// Old index of the pair that is now at `index`; `None` if the removed pair was the last.
    pub moved_from: Option<usize>,
}

/// Packs a pair into an integer. The order of these integers is the order of `(smaller, larger)`.
#[inline]
#[must_use]
pub(crate) fn pack(a: u32, b: u32) -> u64 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    u64::from(low) << 32 | u64::from(high)
}

/// Returns the pair `(smaller, larger)` that [`pack`] has packed into `key`.
#[inline]
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "takes the two halves apart")]
pub(crate) const fn unpack(key: u64) -> (u32, u32) {
    ((key >> 32) as u32, key as u32)
}

impl PairTable {
    /// Creates a table without pairs.
    #[must_use]
    pub(crate) fn new() -> Self {
        Self::default()
    }

    /// Returns the number of pairs.
    #[must_use]
    pub(crate) fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Returns the pairs, each as `(smaller, larger)`, in an order that depends on the insertions
    /// and removals.
    #[must_use]
    pub(crate) fn pairs(&self) -> &[(u32, u32)] {
        &self.pairs
    }

    /// Returns the number of partners of `a`.
    #[must_use]
    pub(crate) fn count(&self, a: u32) -> usize {
        self.adjacency.count(a)
    }

    /// Iterates over the partners of `a`, each with the index of the pair in [`Self::pairs`].
    pub(crate) fn partners(&self, a: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        self.adjacency.links(a).map(|link| (link.partner, link.pair as usize))
    }

    /// Returns the index of one pair of `a`, in constant time; `None` if `a` has no pair. To remove
    /// an object, remove such pairs until there is none.
    #[must_use]
    pub(crate) fn any_pair_of(&self, a: u32) -> Option<usize> {
        Some(self.adjacency.last_link(a)?.pair as usize)
    }

    /// Returns the index of the pair in [`Self::pairs`]; `None` if it is not in the set. Its ends
    /// may be given in either order.
    #[must_use]
    pub(crate) fn index_of(&self, a: u32, b: u32) -> Option<usize> {
        self.adjacency.pair_of(a, b)
    }

    /// Inserts the pair, unless it is in the set already.
    pub(crate) fn insert(&mut self, a: u32, b: u32) -> Inserted {
        match self.index_of(a, b) {
            Some(index) => Inserted { index, is_new: false },
            None => Inserted { index: self.insert_new(a, b), is_new: true },
        }
    }

    /// Inserts a pair, which must not be in the set, and returns its index, in constant time.
    pub(crate) fn insert_new(&mut self, a: u32, b: u32) -> usize {
        debug_assert!(self.index_of(a, b).is_none(), "the pair {a}, {b} is in the table");
        let index = self.pairs.len();
        self.pairs.push((a, b));
        self.link(index, a, b);
        self.journal.note(PairNote::Inserted(a, b));
        index
    }

    /// Removes the pair `old` and writes `new`, which must not be in the set, at its index. So no
    /// other pair moves. Returns the index; `None`, without a change, if `old` is not in the set.
    /// Constant time.
    pub(crate) fn replace(&mut self, old: (u32, u32), new: (u32, u32)) -> Option<usize> {
        let index = self.unlink(old.0, old.1)?;
        debug_assert!(self.index_of(new.0, new.1).is_none(), "the pair {new:?} is in the table");
        self.link(index, new.0, new.1);
        self.journal.note(PairNote::Removed(old.0, old.1));
        self.journal.note(PairNote::Inserted(new.0, new.1));
        Some(index)
    }

    /// Writes a pair at `index`, and adds its links.
    fn link(&mut self, index: usize, a: u32, b: u32) {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        self.pairs[index] = (low, high);
        self.adjacency.extend_to(high);
        let pair = small(index);
        self.adjacency.push(low, Link { partner: high, pair });
        // An index paired with itself has a single link for both ends.
        if low != high {
            self.adjacency.push(high, Link { partner: low, pair });
        }
    }

    /// Removes the pair; `None` if it is not in the set. Moves the last pair into the gap.
    pub(crate) fn remove(&mut self, a: u32, b: u32) -> Option<Removed> {
        let index = self.unlink(a, b)?;
        self.journal.note(PairNote::Removed(a, b));
        Some(self.close_gap(index))
    }

    /// Removes the pair at `index`, in constant time. Moves the last pair into the gap.
    ///
    /// # Panics
    /// If `index` is not below [`Self::len`].
    pub(crate) fn remove_at(&mut self, index: usize) -> Removed {
        let (a, b) = self.pairs[index];
        self.unlink(a, b);
        self.journal.note(PairNote::Removed(a, b));
        self.close_gap(index)
    }

    /// Removes the links of the pair and returns its index; `None` if it is not in the set. The
    /// entry of the dense array stays.
    #[inline]
    fn unlink(&mut self, a: u32, b: u32) -> Option<usize> {
        let index = self.adjacency.remove(a, b)?;
        if a != b {
            self.adjacency.remove(b, a);
        }
        Some(index)
    }

    /// Removes the pair at `index`, whose links have been removed, from the dense array: the last
    /// pair moves to `index`.
    fn close_gap(&mut self, index: usize) -> Removed {
        self.pairs.swap_remove(index);
        let was_last = index == self.pairs.len();
        if !was_last {
            self.relink(index);
        }
        Removed { index, moved_from: (!was_last).then_some(self.pairs.len()) }
    }

    /// Writes `index` to both links of the pair at `index`, which has moved there.
    fn relink(&mut self, index: usize) {
        let ((low, high), pair) = (self.pairs[index], small(index));
        self.adjacency.set_pair(low, Link { partner: high, pair });
        self.adjacency.set_pair(high, Link { partner: low, pair });
    }

    /// Reads the heads of both objects of some packed pairs. These loads are independent of each
    /// other, so the cache misses overlap. Changes nothing.
    #[inline]
    pub(crate) fn prefetch(&self, keys: &[u64]) {
        let count = |key: u64| {
            let (low, high) = unpack(key);
            self.count(low).wrapping_add(self.count(high))
        };
        core::hint::black_box(keys.iter().fold(0, |sum, &key| count(key).wrapping_add(sum)));
    }

    /// Sets a mark with this number; see [`Journal`].
    pub(crate) fn mark(&mut self, number: u64) {
        self.journal.mark(number, ());
    }

    /// Drops the marks with a number less than `number`.
    pub(crate) fn forget_before(&mut self, number: u64) {
        self.journal.forget_before(number);
    }

    /// Undoes all changes since the mark `number`; the order of the pairs is then unspecified.
    /// Calls `undone` with the effect of each removal, and with `None` for each pair that is
    /// inserted at the end of the dense array.
    pub(crate) fn rewind(&mut self, number: u64, mut undone: impl FnMut(Option<Removed>)) {
        let mut journal = core::mem::take(&mut self.journal);
        while let Some(note) = journal.undo(number) {
            match note {
                PairNote::Inserted(a, b) => undone(self.remove(a, b)),
                PairNote::Removed(a, b) => {
                    self.insert_new(a, b);
                    undone(None);
                }
            }
        }
        self.journal = journal;
    }

    /// Releases surplus memory of a table that has stopped growing.
    pub(crate) fn fit(&mut self, look: Look) {
        look.fit(&mut self.pairs);
        self.adjacency.fit(look);
    }

    /// Checks every invariant of the layout; for tests.
    ///
    /// # Errors
    /// Returns a sentence that names the violated invariant.
    pub(crate) fn validate(&self) -> Result<(), String> {
        self.adjacency.validate()?;
        for (index, &(low, high)) in self.pairs.iter().enumerate() {
            let pair = Some(small(index));
            let mut ends = [(low, high), (high, low)].into_iter().map(|(from, to)| {
                self.adjacency.links(from).find(|link| link.partner == to).map(|link| link.pair)
            });
            if low > high || ends.any(|end| end != pair) {
                return Err(format!("pair {index} = ({low}, {high}) is linked wrongly"));
            }
        }
        let links: usize = (0..small(self.adjacency.num_objects())).map(|a| self.count(a)).sum();
        let self_pairs = self.pairs.iter().filter(|(low, high)| low == high).count();
        if links + self_pairs != 2 * self.pairs.len() {
            return Err(format!("{links} links for {} pairs", self.pairs.len()));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::samples;
    use std::collections::BTreeSet;

    /// Returns a pseudorandom number below `bound`, from a linear congruential generator.
    fn next(state: &mut u64, bound: u32) -> u32 {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((*state >> 33) % u64::from(bound)).expect("below a u32")
    }

    #[test]
    fn random_calls_agree_with_a_sorted_set() {
        let (mut state, mut table, mut set) = (7, PairTable::new(), BTreeSet::new());
        let (mut payload, mut found) = (Vec::new(), 0);
        for step in 0..20_000_u32 {
            // 40 indices have 820 pairs, so about every second call meets a pair that is in the
            // set.
            let (a, b) = (next(&mut state, 40), next(&mut state, 40));
            assert_eq!(table.index_of(a, b).is_some(), set.contains(&pack(a, b)), "step {step}");
            if next(&mut state, 2) == 0 {
                let inserted = table.insert(a, b);
                assert_eq!(inserted.is_new, set.insert(pack(a, b)), "step {step}");
                if inserted.is_new {
                    payload.push(pack(a, b));
                }
                assert_eq!(payload[inserted.index], pack(b, a), "payload stays in step");
            } else if let Some(removed) = table.remove(a, b) {
                found += 1;
                assert!(set.remove(&pack(a, b)), "step {step}");
                assert_eq!(
                    removed.moved_from.is_some(),
                    removed.index + 1 < payload.len(),
                    "moved"
                );
                assert_eq!(payload.swap_remove(removed.index), pack(a, b), "payload in step");
            }
            if step % 500 == 0 {
                table.validate().expect("sound");
            }
        }
        assert!((6_000..14_000).contains(&(found * 2)), "half of the removals hit: {found}");
        let listed: Vec<u64> = table.pairs().iter().map(|&(a, b)| pack(a, b)).collect();
        assert_eq!(listed, payload, "the dense array moves as documented");
        let mut partners: Vec<u32> = table.partners(3).map(|(b, _)| b).collect();
        partners.sort_unstable();
        let expected: Vec<u32> = (0..40).filter(|&b| set.contains(&pack(3, b))).collect();
        assert_eq!(partners, expected, "partners of 3");
    }

    #[test]
    fn an_object_with_very_many_partners() {
        let mut table = PairTable::new();
        let half = samples(10_000);
        let count = u32::try_from(2 * half).expect("fewer than 2^32 partners");
        for b in 1..=count {
            table.insert(0, b);
        }
        assert_eq!(table.count(0), 2 * half, "all are partners of 0");
        // With ten times the samples, a search that is linear in the number of partners would need
        // 2·10^10 steps here.
        for b in (1..=count).rev().step_by(2) {
            assert!(table.remove(b, 0).is_some(), "{b} was there");
        }
        table.validate().expect("sound");
        assert_eq!((table.len(), table.count(0)), (half, half), "half are left");
        let mut taken = 0;
        while let Some(index) = table.any_pair_of(0) {
            table.remove_at(index);
            taken += 1;
        }
        assert_eq!((taken, table.len()), (half, 0), "an object taken out");
    }

    #[test]
    fn many_objects_with_many_partners() {
        // All pairs of 180 indices: every object is heavy.
        let mut table = PairTable::new();
        for b in 0..180 {
            (0..=b).for_each(|a| _ = table.insert(b, a));
        }
        table.validate().expect("sound");
        assert_eq!(table.len(), 180 * 181 / 2, "each with each, and with itself");
        // Removes and replaces pairs until few objects are heavy.
        let (mut state, mut set) = (3, BTreeSet::new());
        set.extend(table.pairs().iter().map(|&(a, b)| pack(a, b)));
        for step in 0..16_000_u32 {
            let (a, b) = (next(&mut state, 180), next(&mut state, 180));
            let index = usize::try_from(next(&mut state, small(set.len()))).expect("small");
            if table.index_of(a, b).is_none() && step % 8 == 0 {
                let (old1, old2) = table.pairs()[index];
                assert_eq!(table.replace((old2, old1), (a, b)), Some(index), "step {step}");
                assert!(set.remove(&pack(old1, old2)) && set.insert(pack(a, b)), "step {step}");
                assert_eq!(table.index_of(b, a), Some(index), "no pair moves");
            } else {
                let (old1, old2) = table.pairs()[index];
                table.remove_at(index);
                assert!(set.remove(&pack(old1, old2)), "step {step}");
            }
            if step % 1000 == 0 {
                table.validate().expect("sound");
            }
            assert_eq!(table.index_of(a, b).is_some(), set.contains(&pack(a, b)), "step {step}");
        }
        table.validate().expect("sound");
        assert!((100..4000).contains(&table.len()), "{} pairs are left", table.len());
    }

    #[test]
    fn a_number_with_itself() {
        let mut table = PairTable::new();
        for (a, b) in [(4, 4), (4, 5), (3, 4)] {
            table.insert(a, b);
        }
        assert!(!table.insert(4, 4).is_new, "it is there");
        assert_eq!(table.partners(4).collect::<Vec<_>>(), [(4, 0), (5, 1), (3, 2)], "one link");
        table.validate().expect("sound");
        assert_eq!(table.remove(4, 4), Some(Removed { index: 0, moved_from: Some(2) }), "gone");
        table.validate().expect("sound");
        assert_eq!(table.partners(4).collect::<Vec<_>>(), [(3, 0), (5, 1)], "the others stay");
    }
}
