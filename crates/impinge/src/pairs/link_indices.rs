//! A hash table of the indices of links, for heavy objects: objects that have had more than 135
//! links.
//!
//! Open addressing with linear probing and deletion without tombstones (Knuth 1973, vol. 3, § 6.4).
//! The table is never iterated, so the order of entries affects nothing.

use crate::memory::clone_fields;

/// The `index` that marks a slot as free.
const FREE: u32 = u32::MAX;
/// Minimum number of slots of a table that is not empty.
const MIN_LENGTH: usize = 256;

/// The key of a link ([`link_key`](super::adjacency)) and the index of the link.
#[derive(Clone, Copy, Debug)]
struct IndexEntry {
    key: u64,
    index: u32,
}

/// A map from links to their indices. The key of a link is its two objects, packed.
#[derive(Debug, Default)]
pub(super) struct LinkIndices {
    /// The slots. Their number is zero or a power of two, and at most half of them are in use.
    entries: Vec<IndexEntry>,
    used: usize,
}

clone_fields!([] LinkIndices { entries, used });

impl LinkIndices {
    /// Returns the index of the link; `None` if it is not in the table.
    pub(super) fn get(&self, key: u64) -> Option<u32> {
        if self.entries.is_empty() {
            return None;
        }
        let entry = self.entries[self.slot_of(key)];
        (entry.index != FREE).then_some(entry.index)
    }

    /// Inserts the link, or changes its index.
    pub(super) fn set(&mut self, key: u64, value: u32) {
        if (self.used + 1) * 2 > self.entries.len() {
            self.grow();
        }
        let slot = self.slot_of(key);
        self.used += usize::from(self.entries[slot].index == FREE);
        self.entries[slot] = IndexEntry { key, index: value };
    }

    /// Removes the link; does nothing if it is not in the table. Later entries of the probe
    /// sequence move back into the gap, up to the first free slot.
    pub(super) fn remove(&mut self, key: u64) {
        if self.entries.is_empty() {
            return;
        }
        let mask = self.entries.len() - 1;
        let mut gap = self.slot_of(key);
        if self.entries[gap].index == FREE {
            return;
        }
        self.used -= 1;
        let mut next = (gap + 1) & mask;
        while self.entries[next].index != FREE {
            // Compares distances from the entry's home slot: the entry may move into the gap if its
            // probe sequence passes the gap.
            let from_home = next.wrapping_sub(self.home_slot(self.entries[next].key)) & mask;
            if from_home >= next.wrapping_sub(gap) & mask {
                self.entries[gap] = self.entries[next];
                gap = next;
            }
            next = (next + 1) & mask;
        }
        self.entries[gap].index = FREE;
    }

    /// Returns the number of links in the table.
    pub(super) const fn len(&self) -> usize {
        self.used
    }

    /// Returns the slot of the key, or the free slot where it belongs. At most half of the slots
    /// are in use, so the loop ends. There must be slots.
    fn slot_of(&self, key: u64) -> usize {
        let mask = self.entries.len() - 1;
        let mut slot = self.home_slot(key);
        while self.entries[slot].index != FREE && self.entries[slot].key != key {
            slot = (slot + 1) & mask;
        }
        slot
    }

    /// Returns the home slot of the key, where its probe sequence begins.
    fn home_slot(&self, key: u64) -> usize {
        // Constants from the golden ratio and from SplitMix64 (Steele et al. 2014).
        let mixed = (key ^ key >> 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (mixed >> 32) as usize & (self.entries.len() - 1)
    }

    /// Doubles the number of slots, and inserts all keys again.
    fn grow(&mut self) {
        let length = (2 * self.entries.len()).max(MIN_LENGTH);
        let free = IndexEntry { key: 0, index: FREE };
        let old = core::mem::replace(&mut self.entries, vec![free; length]);
        for entry in old.iter().filter(|entry| entry.index != FREE) {
            let slot = self.slot_of(entry.key);
            self.entries[slot] = *entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn random_calls_agree_with_a_sorted_map() {
        let (mut state, mut table, mut map) = (5_u64, LinkIndices::default(), BTreeMap::new());
        let mut next = |bound: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(99);
            (state >> 33) % bound
        };
        let mut removed = 0;
        for step in 0..20_000 {
            // The 30 × 30 keys cause collisions; about every other call removes a key.
            let key = next(30) << 32 | next(30);
            if next(2) == 0 {
                let value = u32::try_from(next(1000)).expect("small");
                table.set(key, value);
                map.insert(key, value);
            } else {
                table.remove(key);
                removed += usize::from(map.remove(&key).is_some());
            }
            let probe = next(30) << 32 | next(30);
            assert_eq!(table.get(probe), map.get(&probe).copied(), "step {step}");
            assert_eq!(table.len(), map.len(), "step {step}");
        }
        assert!(removed > 4000, "removals hit: {removed}");
    }
}
