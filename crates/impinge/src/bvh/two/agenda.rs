//! Queues of pairs of blocks waiting to be opened: a stack, and a heap by distance.

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use smallvec::SmallVec;

/// Number of pairs that a stack stores without an allocation.
pub(super) const STACK: usize = 48;

/// A pair of blocks, one of each tree.
#[derive(Clone, Copy)]
pub(super) struct OpenPair {
    pub(super) layers: [u8; 2],
    pub(super) blocks: [u32; 2],
    /// Gap between the regions of the two blocks: a lower bound of the distance of any two objects
    /// in them, up to the search's bound of rounding errors. Minus infinity if unknown, NaN if the
    /// maximum distance is infinite.
    pub(super) gap: f32,
}

/// A queue of pairs of blocks; `take` returns `None` when it is empty.
pub(super) trait Agenda {
    fn put(&mut self, pair: OpenPair);
    fn take(&mut self) -> Option<OpenPair>;
}

/// A stack: takes the pair that was put last.
impl Agenda for SmallVec<[OpenPair; STACK]> {
    fn put(&mut self, pair: OpenPair) {
        self.push(pair);
    }

    fn take(&mut self) -> Option<OpenPair> {
        self.pop()
    }
}

/// A heap: takes the pair with the least gap. In a tie, the pair with the lowest sum of layers,
/// then the pair with the lowest block indices.
impl Agenda for BinaryHeap<Reverse<RankedPair>> {
    fn put(&mut self, pair: OpenPair) {
        // Non-negative floats have the same order as their bits. A negative or NaN gap counts as 0.
        let gap = if pair.gap > 0.0 { pair.gap.to_bits() } else { 0 };
        let layers = pair.layers.map(u32::from);
        let rank = (gap, layers[0] + layers[1], pair.blocks);
        self.push(Reverse(RankedPair { rank, pair }));
    }

    fn take(&mut self) -> Option<OpenPair> {
        self.pop().map(|Reverse(RankedPair { pair, .. })| pair)
    }
}

/// A pair of blocks with its rank: its gap, the sum of its layers, and its block indices.
#[derive(Clone, Copy)]
pub(super) struct RankedPair {
    rank: (u32, u32, [u32; 2]),
    pair: OpenPair,
}

impl PartialEq for RankedPair {
    fn eq(&self, other: &Self) -> bool {
        self.rank == other.rank
    }
}

impl Eq for RankedPair {}

impl PartialOrd for RankedPair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for RankedPair {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank.cmp(&other.rank)
    }
}
