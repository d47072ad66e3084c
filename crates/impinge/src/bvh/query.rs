//! Many boxes against a tree at once, breadth first.
//!
//! A single search waits for memory at every block; a few hundred together do not, because the
//! tests of one layer do not depend on each other.

use super::LANES;
use super::join::{Scratch, Sides, overlapped_before};
use super::kernel::Kernel;
use super::tree::small;

/// Appends `(slot of the first tree, slot of the second)` for each pair that began with one of
/// the listed changed slots. In a tree of its own, a pair of two changed slots is reported by the
/// lower one.
#[inline(always)]
pub(super) fn ask<K: Kernel, const D: usize>(
    kernel: K,
    sides: Sides<'_, D>,
    slots: &[u32],
    out: &mut super::kernel::TaskList,
    scratch: &mut Scratch,
) {
    debug_assert!(!sides.second.is_stale, "queries need a refitted tree");
    let Scratch { tasks, next, .. } = scratch;
    tasks.clear();
    for &slot in slots {
        tasks.push(slot, 0);
    }
    for layer in sides.second.layers.iter().skip(1).rev() {
        next.clear();
        let (queries, blocks) = tasks.parts();
        for (&slot, &block) in queries.iter().zip(blocks) {
            let query = &sides.first.boxes[slot as usize];
            let mask = kernel.overlaps(&layer.blocks[block as usize], query);
            kernel.push(next, slot, block * small(LANES), mask);
        }
        core::mem::swap(tasks, next);
    }
    let leaves = &sides.second.layers[0];
    let (queries, blocks) = tasks.parts();
    for (&slot, &block) in queries.iter().zip(blocks) {
        let mut mask =
            kernel.overlaps(&leaves.blocks[block as usize], &sides.first.boxes[slot as usize]);
        if sides.is_self {
            mask &= !u32::from(leaves.changed[block as usize]) | later_lanes(slot, block);
        }
        if mask != 0 {
            mask &= !overlapped_before(kernel, sides, slot, block);
            kernel.push(out, slot, block * small(LANES), mask);
        }
    }
}

/// The lanes of the block whose slots are above `slot`.
#[inline(always)]
fn later_lanes(slot: u32, block: u32) -> u32 {
    let own = slot / small(LANES);
    match block.cmp(&own) {
        core::cmp::Ordering::Less => 0,
        core::cmp::Ordering::Equal => 0xfffe << (slot % small(LANES)),
        core::cmp::Ordering::Greater => 0xffff,
    }
}
