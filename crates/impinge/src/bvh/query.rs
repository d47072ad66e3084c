//! Queries of many boxes against a tree, all together, breadth first.
//!
//! A single search waits for memory at every block; with a few hundred queries together the tests
//! of one layer are independent, so their loads overlap.

use super::LANES;
use super::join::{JoinBoxes, JoinSides, Scratch};
use super::kernel::Kernel;
use super::tree::small;

/// Appends `(slot of the first tree, slot of the second)` for each pair that began or ended and
/// contains one of `slots`, which are changed slots of the first tree. If both trees are the same,
/// a pair of two changed slots is reported only for its lower slot.
#[inline(always)]
pub(super) fn search<K: Kernel, const D: usize>(
    kernel: K,
    sides: JoinSides<'_, D>,
    slots: &[u32],
    out: &mut super::kernel::TaskList,
    scratch: &mut Scratch<D>,
) {
    debug_assert!(!sides.second.is_stale, "queries need a refitted tree");
    let Scratch { tasks, next, swept_slots } = scratch;
    tasks.clear();
    swept_slots.clear();
    // Each query starts at the top block, with the swept box of its slot.
    for (query, &slot) in (0..).zip(slots) {
        tasks.push(query, 0);
        swept_slots.push(sides.first.swept_of_slot(slot));
    }
    // In each layer, the children that a query overlaps become the tasks of the layer below.
    for layer in sides.second.layers.iter().skip(1).rev() {
        next.clear();
        let [queries, blocks] = tasks.parts();
        for (&query, &block) in queries.iter().zip(blocks) {
            let mask =
                kernel.overlaps(&layer.swept_blocks[block as usize], &swept_slots[query as usize]);
            kernel.push(next, query, block * small(LANES), mask);
        }
        core::mem::swap(tasks, next);
    }
    let (leaves, boxes) = (&sides.second.layers[0], JoinBoxes::of(sides));
    let [queries, blocks] = tasks.parts();
    for (&query, &block) in queries.iter().zip(blocks) {
        let slot = slots[query as usize];
        // A pair of two changed slots is left to the query with the lower slot.
        let mut lanes = 0xffff;
        if sides.is_self {
            lanes = !u32::from(leaves.changed[block as usize]) | later_lanes(slot, block);
        }
        boxes.differing(kernel, slot, block).push(kernel, lanes, slot, block, out);
    }
}

/// Returns the lanes of block `block` whose slots are above `slot`, as a mask.
#[inline(always)]
fn later_lanes(slot: u32, block: u32) -> u32 {
    let own = slot / small(LANES);
    match block.cmp(&own) {
        core::cmp::Ordering::Less => 0,
        core::cmp::Ordering::Equal => 0xfffe << (slot % small(LANES)),
        core::cmp::Ordering::Greater => 0xffff,
    }
}
