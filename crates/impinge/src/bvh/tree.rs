//! The tree: storage and single changes.

use super::block_slabs::BlockSlab;
use super::order::Load;
use super::renewal::Renewal;
use super::schedule::Schedule;
use super::{Block, Bounds, LANES, Lanes};
use crate::memory::{Look, clone_fields};

/// No id, or no slot.
pub(crate) const NONE: u32 = u32::MAX;
/// A tree of more leaf blocks than this gives its memory back when it is empty.
const KEPT_LEAVES: usize = 256;

/// One layer: blocks, and beside each its bounds and which of its lanes changed.
///
/// A join looks for what was near as well as for what is: for it stand beside all that the bounds of
/// the boxes now and before. Where nothing changed, the two are the same.
#[derive(Debug)]
pub(super) struct Layer<const D: usize> {
    pub(super) blocks: Vec<Block<D>>,
    pub(super) bounds: Vec<Bounds<D>>,
    /// By block: the bounds of its boxes now and before.
    pub(super) reach: Vec<Bounds<D>>,
    /// Above the lowest layer: the reach of the blocks below, in blocks.
    pub(super) reaches: Vec<Block<D>>,
    pub(super) changed: Vec<u16>,
}

clone_fields!([const D: usize] Layer<D> { blocks, bounds, reach, reaches, changed });

impl<const D: usize> Layer<D> {
    pub(super) const fn new() -> Self {
        Self {
            blocks: Vec::new(),
            bounds: Vec::new(),
            reach: Vec::new(),
            reaches: Vec::new(),
            changed: Vec::new(),
        }
    }

    /// Sets the number of blocks of the lowest layer; new ones are empty.
    pub(super) fn resize(&mut self, blocks: usize) {
        self.blocks.resize(blocks, Block::EMPTY);
        self.bounds.resize(blocks, Bounds::EMPTY);
        self.reach.resize(blocks, Bounds::EMPTY);
        self.changed.resize(blocks, 0);
    }

    /// Gives a layer above the lowest one the blocks for so many children; lanes without a child are empty.
    pub(super) fn fit_above(&mut self, children: usize) {
        let blocks = children.div_ceil(LANES);
        self.resize(blocks);
        self.reaches.resize(blocks, Block::EMPTY);
        let (last, used) = (blocks - 1, children - (blocks - 1) * LANES);
        for lane in used..LANES {
            self.blocks[last].set_lane(lane, &Bounds::EMPTY);
            self.reaches[last].set_lane(lane, &Bounds::EMPTY);
            self.changed[last] &= !(1 << lane);
        }
    }
}

/// A packed tree over boxes with ids; see the module's page for the layout.
///
/// Ids are dense small numbers of the caller's. Boxes must be finite and not inverted.
#[derive(Debug)]
pub(crate) struct Tree<const D: usize> {
    pub(super) lanes: Lanes,
    /// Layer 0 first; at least one layer, the last one with at most one block.
    pub(super) layers: Vec<Layer<D>>,
    /// By leaf block: the boxes at the last [`Self::settle`]; see [`Self::was`].
    pub(super) before: Vec<Block<D>>,
    /// The boxes at the last settling are those of now unless something is said to have changed: so
    /// that a tree in which this seldom happens has no memory for them.
    pub(super) is_sparing: bool,
    /// By layer and block, if the owner of the tree asked for them: good until the boxes change.
    pub(super) slabs: Vec<Vec<Option<BlockSlab<D>>>>,
    /// [`Self::before`] is in use. Always, unless the tree is sparing.
    pub(super) remembers: bool,
    /// Slot to id.
    pub(super) ids: Vec<u32>,
    /// Id to slot.
    pub(super) slots: Vec<u32>,
    /// One more than the last slot in use.
    pub(super) end: usize,
    /// Objects.
    pub(super) live: usize,
    /// Leaf blocks written to since the last [`Self::settle`], and the same as flags.
    pub(super) touched: Vec<u32>,
    pub(super) is_touched: Vec<bool>,
    /// Leaf blocks whose reach leaves out what was before; see [`Self::escaped`].
    pub(super) escaped: Vec<u32>,
    /// Memory for objects on the move from slot to slot.
    pub(super) loads: Vec<Load<D>>,
    /// Memory for lists of blocks.
    pub(super) dirty: Vec<u32>,
    /// Lanes with their change bit set.
    pub(super) changed: usize,
    /// The number of leaf blocks changed, so that the upper layers must be laid out anew.
    pub(super) is_restructured: bool,
    /// Something was written since the last [`Self::refit`] that searches must see.
    pub(super) is_stale: bool,
    pub(super) schedule: Schedule<D>,
    /// Of a sparing tree.
    pub(super) renewal: Option<Box<Renewal<D>>>,
}

clone_fields!([const D: usize] Tree<D> {
    lanes, layers, before, is_sparing, slabs, remembers, ids, slots, end, live, touched, is_touched, escaped,
    loads, dirty, changed, is_restructured, is_stale, schedule, renewal,
});

impl<const D: usize> Default for Tree<D> {
    fn default() -> Self {
        Self::new(Lanes::detect())
    }
}

/// A position as the `u32` it is stored as.
#[inline]
pub(super) fn small(value: usize) -> u32 {
    u32::try_from(value).expect("a tree holds fewer than 2^32 objects")
}

impl<const D: usize> Tree<D> {
    /// A tree without objects.
    #[must_use]
    pub(crate) fn new(lanes: Lanes) -> Self {
        Self {
            lanes,
            layers: vec![Layer::new()],
            before: Vec::new(),
            is_sparing: false,
            slabs: Vec::new(),
            remembers: true,
            ids: Vec::new(),
            slots: Vec::new(),
            end: 0,
            live: 0,
            touched: Vec::new(),
            is_touched: Vec::new(),
            escaped: Vec::new(),
            loads: Vec::new(),
            dirty: Vec::new(),
            changed: 0,
            is_restructured: false,
            is_stale: false,
            schedule: Schedule::default(),
            renewal: None,
        }
    }

    /// A tree without objects, for objects that seldom change: it spares memory.
    pub(crate) fn sparing(lanes: Lanes) -> Self {
        Self { is_sparing: true, remembers: false, ..Self::new(lanes) }
    }

    /// From here on the objects count as such that seldom change.
    pub(crate) fn spare(&mut self) {
        debug_assert_eq!(self.changed, 0, "a settled tree");
        (self.is_sparing, self.remembers, self.before) = (true, false, Vec::new());
        (self.loads, self.dirty, self.touched) = (Vec::new(), Vec::new(), Vec::new());
        self.give_back();
    }

    /// From here on the objects count as such that change often.
    pub(crate) fn spend(&mut self) {
        (self.is_sparing, self.renewal) = (false, None);
        self.remember();
    }

    /// The number of objects.
    #[must_use]
    pub(crate) const fn len(&self) -> usize {
        self.live
    }

    /// There is no object.
    #[must_use]
    pub(crate) const fn is_empty(&self) -> bool {
        self.live == 0
    }

    /// The object is in the tree.
    #[must_use]
    pub(crate) fn contains(&self, id: u32) -> bool {
        self.slot(id).is_some()
    }

    /// The box of the object, if it is in the tree.
    #[must_use]
    pub(crate) fn bounds(&self, id: u32) -> Option<Bounds<D>> {
        self.slot(id).map(|slot| self.lane(slot))
    }

    /// The box in a slot.
    #[inline]
    pub(super) fn lane(&self, slot: usize) -> Bounds<D> {
        self.layers[0].blocks[slot / LANES].lane(slot % LANES)
    }

    /// The slot of an object that is likely to be near a point: in each block the child whose middle is nearest comes next,
    /// so that each layer is seen once. `None` where nothing is finite, or squares of distances are too large for `f32`.
    pub(super) fn slot_near(&self, place: &[f32; D]) -> Option<u32> {
        self.layers.iter().rev().try_fold(0, |at, layer| {
            let lane = layer.blocks[at as usize].nearest_lane(place)?;
            Some(at * small(LANES) + small(lane))
        })
    }

    /// Calls `visit` with the bounds of each block that holds something, the lowest layer first.
    #[cfg(feature = "debug_render")]
    pub(crate) fn each_node(&self, visit: &mut dyn FnMut(&Bounds<D>)) {
        let bounds = self.layers.iter().flat_map(|layer| &layer.bounds);
        bounds.filter(|bounds| bounds.is_finite()).for_each(visit);
    }

    /// The number of leaf blocks.
    pub(super) fn leaf_count(&self) -> usize {
        self.layers[0].blocks.len()
    }

    /// By leaf block: the boxes at the last [`Self::settle`].
    #[inline]
    pub(super) fn was(&self) -> &[Block<D>] {
        if self.remembers { &self.before } else { &self.layers[0].blocks }
    }

    /// From here on the boxes may differ from those at the last settling.
    #[inline]
    fn remember(&mut self) {
        if !self.remembers {
            self.before.clone_from(&self.layers[0].blocks);
            self.remembers = true;
        }
    }

    /// The box of the object at the last [`Self::settle`]: empty for one that is new.
    pub(crate) fn before(&self, id: u32) -> Option<Bounds<D>> {
        self.slot(id).map(|slot| self.was()[slot / LANES].lane(slot % LANES))
    }

    pub(super) fn slot(&self, id: u32) -> Option<usize> {
        let slot = self.slots.get(id as usize).copied().filter(|&slot| slot != NONE)?;
        Some(slot as usize)
    }

    fn expect_slot(&self, id: u32) -> usize {
        self.slot(id).expect("the object is in the tree")
    }

    /// Adds an object. `before` is the box it had at the last [`Self::settle`]: pairs that
    /// overlapped then do not begin now. It is [`Bounds::NOWHERE`] for an object that is new.
    ///
    /// # Panics
    /// If the object is in the tree already.
    pub(crate) fn insert(&mut self, id: u32, bounds: &Bounds<D>, before: &Bounds<D>) {
        self.remember();
        let slot = self.insert_still(id, bounds);
        self.before[slot / LANES].set_lane(slot % LANES, &before.clamped());
        self.mark_changed(slot);
    }

    /// Adds an object that has stood there, in another tree, since before the last
    /// [`Self::settle`]: it begins no pairs. Returns its slot.
    pub(crate) fn insert_still(&mut self, id: u32, bounds: &Bounds<D>) -> usize {
        assert!(!self.contains(id), "object {id} is in the tree already");
        debug_assert!(bounds.is_finite(), "trees hold bounded boxes: {bounds:?}");
        let slot = self.find_place(bounds);
        self.put_at(slot, id, bounds);
        slot
    }

    /// Adds an object behind all others, as if it had always been there.
    pub(super) fn append(&mut self, id: u32, bounds: &Bounds<D>) {
        let slot = self.append_slot();
        self.put_at(slot, id, bounds);
    }

    /// Adds an object in a free slot, as if it had always been there.
    fn put_at(&mut self, slot: usize, id: u32, bounds: &Bounds<D>) {
        #[cfg(test)]
        super::tests::count_placed(1);
        if self.slots.len() <= id as usize {
            self.slots.resize(id as usize + 1, NONE);
        }
        self.slots[id as usize] = small(slot);
        self.ids[slot] = id;
        self.end = self.end.max(slot + 1);
        self.live += 1;
        self.note_late(id);
        self.write(slot, bounds);
        if self.remembers {
            self.before[slot / LANES].set_lane(slot % LANES, bounds);
        }
    }

    /// Gives the object another box as if it had always had it: it begins no pairs.
    ///
    /// # Panics
    /// If the object is not in the tree.
    pub(crate) fn set_still(&mut self, id: u32, bounds: &Bounds<D>) {
        debug_assert!(bounds.is_finite(), "trees hold bounded boxes: {bounds:?}");
        let slot = self.expect_slot(id);
        self.write(slot, bounds);
        if self.remembers {
            self.before[slot / LANES].set_lane(slot % LANES, bounds);
        }
        if let Some(renewal) = &mut self.renewal {
            renewal.set(id, bounds);
        }
    }

    /// Announces that the object has another box, which the next [`Self::refit_from`] fetches.
    ///
    /// # Panics
    /// If the object is not in the tree.
    #[inline]
    pub(crate) fn set_later(&mut self, id: u32) {
        self.remember();
        let slot = self.slots[id as usize] as usize;
        let (block, bit) = (slot / LANES, 1 << (slot % LANES));
        let mask = &mut self.layers[0].changed[block];
        let was_unchanged = *mask == 0;
        self.changed += usize::from(*mask & bit == 0);
        *mask |= bit;
        self.is_stale = true;
        // A block with changed lanes is listed already.
        if was_unchanged {
            self.touch(block);
        }
    }

    /// Makes all pairs of the object begin anew: as if it had not been there before.
    ///
    /// # Panics
    /// If the object is not in the tree.
    pub(crate) fn forget_before(&mut self, id: u32) {
        let slot = self.expect_slot(id);
        self.remember();
        self.before[slot / LANES].set_lane(slot % LANES, &Bounds::EMPTY);
        self.touch(slot / LANES);
        self.mark_changed(slot);
    }

    /// Takes the object out. Searches do not find it from now on.
    ///
    /// # Panics
    /// If the object is not in the tree.
    pub(crate) fn remove(&mut self, id: u32) {
        let slot = self.expect_slot(id);
        let (block, lane) = (slot / LANES, slot % LANES);
        self.slots[id as usize] = NONE;
        self.ids[slot] = NONE;
        self.live -= 1;
        self.layers[0].blocks[block].set_lane(lane, &Bounds::EMPTY);
        if self.remembers {
            self.before[block].set_lane(lane, &Bounds::EMPTY);
        }
        let bit = self.layers[0].changed[block] & 1 << lane;
        self.changed -= usize::from(bit != 0);
        self.layers[0].changed[block] &= !bit;
        self.touch(block);
        if let Some(renewal) = &mut self.renewal {
            renewal.remove(id);
        }
    }

    /// Writes the box; what is above follows in the next refit.
    #[inline]
    fn write(&mut self, slot: usize, bounds: &Bounds<D>) {
        self.layers[0].blocks[slot / LANES].set_lane(slot % LANES, bounds);
        self.touch(slot / LANES);
        self.is_stale = true;
    }

    #[inline]
    pub(super) fn mark_changed(&mut self, slot: usize) {
        let mask = &mut self.layers[0].changed[slot / LANES];
        let bit = 1 << (slot % LANES);
        self.changed += usize::from(*mask & bit == 0);
        *mask |= bit;
    }

    #[inline]
    pub(super) fn touch(&mut self, block: usize) {
        if !self.is_touched[block] {
            self.is_touched[block] = true;
            self.touched.push(small(block));
        }
    }

    /// Sets the number of leaf blocks; new ones are empty.
    pub(super) fn resize_leaves(&mut self, blocks: usize) {
        self.layers[0].resize(blocks);
        if self.remembers {
            self.before.resize(blocks, Block::EMPTY);
        }
        self.is_touched.resize(blocks, false);
        self.ids.resize(blocks * LANES, NONE);
        self.is_restructured = true;
    }

    /// Forgets every object. Keeps the memory if it is little.
    pub(crate) fn clear(&mut self) {
        if self.leaf_count() > KEPT_LEAVES {
            let empty = if self.is_sparing { Self::sparing } else { Self::new };
            *self = empty(self.lanes);
            return;
        }
        self.resize_leaves(0);
        self.shape_layers();
        self.slots.clear();
        self.touched.clear();
        self.escaped.clear();
        (self.schedule, self.renewal) = (Schedule::default(), None);
        (self.end, self.live, self.changed) = (0, 0, 0);
        (self.is_restructured, self.is_stale) = (false, false);
    }

    /// Gives back memory that a tree that has stopped to grow does not need.
    pub(crate) fn fit(&mut self, look: Look) {
        let Layer { blocks, bounds, reach, changed, .. } = &mut self.layers[0];
        look.fit(blocks);
        look.fit(bounds);
        look.fit(reach);
        look.fit(changed);
        look.fit(&mut self.before);
        look.fit(&mut self.ids);
        look.fit(&mut self.slots);
        look.fit(&mut self.is_touched);
        look.trim(&mut self.touched);
        look.trim(&mut self.dirty);
    }

    /// The half surfaces of all leaf blocks, summed in their order: what a search pays.
    pub(crate) fn leaf_surface(&self) -> f64 {
        self.layers[0].bounds.iter().map(Bounds::half_surface).sum()
    }

    /// The ids by slot, which is an order of space; [`NONE`] for free slots.
    pub(crate) fn slots_in_order(&self) -> &[u32] {
        &self.ids[..self.end]
    }

    /// The slots of changed lanes, ascending if the touched blocks are.
    pub(super) fn list_changed_slots(&self, slots: &mut Vec<u32>) {
        slots.clear();
        for &block in &self.touched {
            let mut mask = self.layers[0].changed[block as usize];
            while mask != 0 {
                slots.push(block * small(LANES) + mask.trailing_zeros());
                mask &= mask - 1;
            }
        }
    }

    /// Changed objects (by id) of whose pairs the [`super::Joiner`] need not have reported those
    /// that ended: objects that were elsewhere before, and their changed neighbours. As of the last
    /// refit.
    pub(crate) fn escaped(&self) -> impl Iterator<Item = u32> + '_ {
        let changed = move |&block: &u32| {
            let mask = self.layers[0].changed[block as usize];
            let lanes = (0..LANES).filter(move |lane| mask >> lane & 1 == 1);
            lanes.map(move |lane| self.ids[block as usize * LANES + lane])
        };
        self.escaped.iter().flat_map(changed)
    }
}
