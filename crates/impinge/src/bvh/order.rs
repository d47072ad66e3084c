//! The order of slots: a balanced k-d order, so that blocks hold neighbours.
//!
//! The objects are cut on the axis with the largest spread of their centres. The left part fills a
//! power of two of blocks (whole subtrees of the layers above). Both parts are cut in the same way.
//! A join needs 2.2 times fewer block tests than with Morton order, 1.25 times fewer than with
//! Hilbert order.

use super::tree::small;
use super::{Bounds, LANES, NONE, Tree};

/// Least number of items whose two parts are sorted in parallel.
#[cfg(feature = "parallel")]
const PARALLEL_SORT: usize = 4096;

/// An object with its centre, by which it is sorted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item<const D: usize> {
    center: [f32; D],
    pub(super) id: u32,
}

impl<const D: usize> Item<D> {
    /// Returns the sort key: the centre's coordinate on an axis, then the id. Keys of two objects
    /// differ, so the sorted order is unique up to the order within blocks.
    #[inline]
    fn key(&self, axis: usize) -> u64 {
        key(self.center[axis], self.id)
    }
}

/// Returns an integer that sorts by the coordinate, then by the id. -0 sorts before 0.
#[inline]
pub(super) fn key(coordinate: f32, id: u32) -> u64 {
    let bits = coordinate.to_bits();
    let ordered = if bits >> 31 == 0 { bits | 1 << 31 } else { !bits };
    u64::from(ordered) << 32 | u64::from(id)
}

/// Returns the number of items in the left part: the largest power of two of whole blocks that
/// leaves at least one item for the right part. There must be more than 16 items.
fn left_count(items: usize) -> usize {
    items.div_ceil(LANES).next_power_of_two() / 2 * LANES
}

/// Returns the axis with the largest spread of centres, the first in a tie.
fn longest_axis<const D: usize>(items: &[Item<D>]) -> usize {
    let (mut lo, mut hi) = ([f32::INFINITY; D], [f32::NEG_INFINITY; D]);
    for item in items {
        for axis in 0..D {
            let x = item.center[axis];
            lo[axis] = if x < lo[axis] { x } else { lo[axis] };
            hi[axis] = if x > hi[axis] { x } else { hi[axis] };
        }
    }
    let spread = |axis: usize| hi[axis] * 0.5 - lo[axis] * 0.5;
    (1..D).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best })
}

/// Partitions the items into two parts; returns the number in the left part, or `None` if all fit
/// in one block.
pub(super) fn split<const D: usize>(items: &mut [Item<D>]) -> Option<usize> {
    if items.len() <= LANES {
        return None;
    }
    let (axis, left) = (longest_axis(items), left_count(items.len()));
    items.select_nth_unstable_by_key(left, |item| item.key(axis));
    Some(left)
}

/// A plane perpendicular to an axis, stored as the sort key of the first item on its far side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cut {
    axis: usize,
    /// Sort key of the first item on the far side.
    key: u64,
}

impl Cut {
    /// Returns `true` if the item is on the far side of the plane.
    #[inline]
    pub(super) fn is_beyond<const D: usize>(self, item: &Item<D>) -> bool {
        item.key(self.axis) >= self.key
    }
}

/// Partitions items in half along the axis with the largest spread; returns the cut and the number
/// of items on the near side. An empty slice has a default cut.
pub(super) fn cut_in_half<const D: usize>(items: &mut [Item<D>]) -> (Cut, usize) {
    let (axis, half) = (longest_axis(items), items.len() / 2);
    if items.is_empty() {
        return (Cut::default(), 0);
    }
    let (_, first, _) = items.select_nth_unstable_by_key(half, |item| item.key(axis));
    (Cut { axis, key: first.key(axis) }, half)
}

/// Sorts the items in k-d order. The recursion ends, since both parts of a split are smaller.
pub(super) fn sort<const D: usize>(items: &mut [Item<D>]) {
    let Some(left) = split(items) else { return };
    let (first, second) = items.split_at_mut(left);
    #[cfg(feature = "parallel")]
    if first.len() + second.len() >= PARALLEL_SORT {
        rayon::join(|| sort(first), || sort(second));
        return;
    }
    sort(first);
    sort(second);
}

/// The data of an object that moves from its old slot to a new one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Load<const D: usize> {
    bounds: Bounds<D>,
    before: Bounds<D>,
    id: u32,
    is_changed: bool,
}

impl<const D: usize> Tree<D> {
    /// Lists the objects in the slots at and after `start`, in slot order.
    pub(super) fn list_items(&self, start: usize, items: &mut Vec<Item<D>>) {
        items.clear();
        items.extend((start..self.end).filter_map(|slot| self.item(self.ids[slot])));
    }

    /// Returns the centre and id of an object; `None` if it is not in the tree.
    #[inline]
    pub(super) fn item(&self, id: u32) -> Option<Item<D>> {
        let center = self.lane(self.slot(id)?).center();
        Some(Item { center, id })
    }

    /// Assigns the listed objects, in order, to the slots from `start` (a multiple of 16), and
    /// drops surplus blocks. `ids` must list every object at or after `start` exactly once.
    pub(super) fn rearrange(&mut self, start: usize, ids: &[u32]) {
        let mut loads = core::mem::take(&mut self.loads);
        loads.clear();
        loads.extend(ids.iter().map(|&id| self.load(id)));
        #[cfg(test)]
        super::tests::count_placed(ids.len());
        self.layers[0].changed[start / LANES..].fill(0);
        for (offset, load) in loads.iter().enumerate() {
            self.unload(start + offset, load);
        }
        if !self.is_sparing {
            self.loads = loads;
        }
        self.end = start + ids.len();
        self.drop_blocks_after_end();
        for block in start / LANES..self.leaf_count() {
            self.touch(block);
        }
        self.is_stale = true;
    }

    fn load(&self, id: u32) -> Load<D> {
        let slot = self.slots[id as usize] as usize;
        let (block, lane) = (slot / LANES, slot % LANES);
        Load {
            bounds: self.lane(slot),
            before: self.was()[block].lane(lane),
            id,
            is_changed: self.layers[0].changed[block] >> lane & 1 == 1,
        }
    }

    fn unload(&mut self, slot: usize, load: &Load<D>) {
        let (block, lane) = (slot / LANES, slot % LANES);
        self.slots[load.id as usize] = small(slot);
        self.ids[slot] = load.id;
        self.layers[0].blocks[block].set_lane(lane, &load.bounds);
        if self.remembers {
            self.before[block].set_lane(lane, &load.before);
        }
        self.layers[0].changed[block] |= u16::from(load.is_changed) << lane;
    }

    /// Drops the free slots after the last object, and the blocks that contain only such slots.
    pub(crate) fn drop_free_end(&mut self) {
        while self.end > 0 && self.ids[self.end - 1] == NONE {
            self.end -= 1;
        }
        self.schedule.forget_slots_from(self.end);
        self.drop_blocks_after_end();
    }

    /// Empties the lanes at and after `end` in the last block, and drops later blocks.
    fn drop_blocks_after_end(&mut self) {
        let blocks = self.end.div_ceil(LANES);
        for slot in self.end..blocks * LANES {
            self.ids[slot] = NONE;
            let (block, lane) = (slot / LANES, slot % LANES);
            self.layers[0].blocks[block].set_lane(lane, &Bounds::EMPTY);
            if self.remembers {
                self.before[block].set_lane(lane, &Bounds::EMPTY);
            }
        }
        if blocks != self.leaf_count() {
            self.resize_leaves(blocks);
            self.touched.retain(|&block| (block as usize) < blocks);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_parts_fill_whole_subtrees() {
        for (items, left) in [(17, 16), (32, 16), (33, 32), (64, 32), (65, 64), (1000, 512)] {
            assert_eq!(left_count(items), left, "{items} items");
        }
    }

    #[test]
    fn keys_order_as_the_numbers_do() {
        let numbers = [f32::NEG_INFINITY, -2.0, -1e-40, 0.0, 1e-40, 3.0, f32::INFINITY];
        let keys = numbers.map(|x| Item { center: [x], id: 9 }.key(0));
        assert!(keys.is_sorted(), "{keys:?}");
        let tied = Item { center: [1.0], id: 3 }.key(0) < Item { center: [1.0], id: 4 }.key(0);
        assert!(tied, "ties go by id");
    }
}
