//! Which of the pairs of blocks that are put off comes next.

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use smallvec::SmallVec;

/// So many pairs of blocks are put off without memory of their own.
pub(super) const STACK: usize = 48;

/// A block of each tree.
#[derive(Clone, Copy)]
pub(super) struct OpenPair {
    pub(super) layers: [u8; 2],
    pub(super) blocks: [u32; 2],
    /// No two objects in them are nearer, but for rounding; NaN where the reach has no limit.
    pub(super) gap: f32,
}

/// The pairs of blocks that are put off.
pub(super) trait Agenda {
    fn put(&mut self, pair: OpenPair);
    fn take(&mut self) -> Option<OpenPair>;
}

/// The last that was put off.
impl Agenda for SmallVec<[OpenPair; STACK]> {
    fn put(&mut self, pair: OpenPair) {
        self.push(pair);
    }

    fn take(&mut self) -> Option<OpenPair> {
        self.pop()
    }
}

/// The least gap, and of several the lowest blocks.
impl Agenda for BinaryHeap<Reverse<RankedPair>> {
    fn put(&mut self, pair: OpenPair) {
        // The bits of numbers that are not negative have the order of the numbers.
        let gap = if pair.gap > 0.0 { pair.gap.to_bits() } else { 0 };
        let layers = pair.layers.map(u32::from);
        let rank = (gap, layers[0] + layers[1], pair.blocks);
        self.push(Reverse(RankedPair { rank, pair }));
    }

    fn take(&mut self) -> Option<OpenPair> {
        self.pop().map(|Reverse(RankedPair { pair, .. })| pair)
    }
}

/// A pair of blocks by its gap, the layers of both and their numbers.
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
