//! Generations of handles, which distinguish the successive objects at one index of a table, and
//! the handles of different tables.

use core::fmt;
use core::hash::{Hash, Hasher};
use core::sync::atomic::{AtomicU32, Ordering};

/// The part of a handle besides the index: the number of earlier objects at the index (16 bits),
/// and a tag of the table (16 bits). A single comparison of 32 bits rejects both stale handles and
/// handles of other tables.
///
/// Generations are ordered by count; the tag matters only between handles of different tables.
/// `Hash`, `Debug` and the serialized form use the count alone, so that they do not depend on the
/// order in which tables are created. Tags repeat after 65535 tables; a cloned table keeps its tag.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "u16", into = "u16"))]
pub(crate) struct Generation(u32);

/// The lowest bit of the count.
const ONE: u32 = 1 << 16;

/// The number of tables created so far in this process; wraps.
static TABLES: AtomicU32 = AtomicU32::new(0);

impl Generation {
    /// Returns the first generation of a new table, with a new tag and the count 0.
    pub(crate) fn of_new_table() -> Self {
        Self(1 + TABLES.fetch_add(1, Ordering::Relaxed) % (ONE - 1))
    }

    /// Returns a generation with the tag 0. No table has this tag, so every table rejects the
    /// generation.
    pub(crate) const fn of_no_table(count: u16) -> Self {
        Self((count as u32) << 16)
    }

    /// Returns the generation with the tag of this generation and the count `count`.
    #[cfg(feature = "serde")]
    pub(crate) const fn with_count(self, count: u16) -> Self {
        Self((count as u32) << 16 | self.0 & (ONE - 1))
    }

    /// Returns the number of earlier objects at the index.
    pub(crate) const fn count(self) -> u16 {
        (self.0 >> 16) as u16
    }

    /// Returns the generation of the next object at this index; `None` if the count would exceed 16
    /// bits.
    pub(crate) fn next(self) -> Option<Self> {
        self.0.checked_add(ONE).map(Self)
    }
}

impl From<u16> for Generation {
    fn from(count: u16) -> Self {
        Self::of_no_table(count)
    }
}

impl From<Generation> for u16 {
    fn from(generation: Generation) -> Self {
        generation.count()
    }
}

impl fmt::Debug for Generation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.count().fmt(f)
    }
}

impl Hash for Generation {
    fn hash<H: Hasher>(&self, state: &mut H) {
        u32::from(self.count()).hash(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generations_of_two_tables_differ_and_look_alike() {
        let [one, other] = [Generation::of_new_table(), Generation::of_new_table()];
        assert!(one != other && one != Generation::of_no_table(0), "three tables");
        assert_eq!(format!("{one:?}"), format!("{other:?}"), "no message depends on the tag");
        let next = one.next().expect("the second of many");
        assert!(one < next && other < next, "by count first");
    }

    #[test]
    fn counts_end() {
        let mut generation = Generation::of_new_table();
        let mut lives = 1;
        while let Some(next) = generation.next() {
            generation = next;
            lives += 1;
        }
        assert_eq!((lives, generation.count()), (65536, u16::MAX), "all counts are used");
    }
}
