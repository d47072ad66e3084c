//! The tree: storage, and changes of single objects.

use super::block_slabs::BlockSlab;
use super::order::Load;
use super::renewal::Renewal;
use super::schedule::Schedule;
use super::{Block, Bounds, LANES, Lanes};
use crate::memory::{Look, clone_fields};

/// Stands for a missing id or a missing slot.
pub(crate) const NONE: u32 = u32::MAX;
/// Number of leaf blocks above which an empty tree releases its memory.
const KEPT_LEAVES: usize = 256;

/// One layer: blocks, and for each block its bounds and the mask of changed lanes.
///
/// A join searches old and present overlaps, so each block also has `swept`: the union of its boxes
/// now and before. Where nothing changed, `swept` equals `bounds`.
#[derive(Debug)]
pub(super) struct Layer<const D: usize> {
    pub(super) blocks: Vec<Block<D>>,
    pub(super) bounds: Vec<Bounds<D>>,
    /// By block: union of its boxes now and before. For an escaped block, of the present boxes
    /// alone.
    pub(super) swept: Vec<Bounds<D>>,
    /// Above the lowest layer: the swept bounds of the blocks below, as lanes.
    pub(super) swept_blocks: Vec<Block<D>>,
    /// By block: mask of the lanes with a change in the lane or below it.
    pub(super) changed: Vec<u16>,
}

clone_fields!([const D: usize] Layer<D> { blocks, bounds, swept, swept_blocks, changed });

impl<const D: usize> Layer<D> {
    /// Creates a layer of zero blocks.
    pub(super) const fn new() -> Self {
        Self {
            blocks: Vec::new(),
            bounds: Vec::new(),
            swept: Vec::new(),
            swept_blocks: Vec::new(),
            changed: Vec::new(),
        }
    }

    /// Sets the number of blocks of a layer; new blocks are empty.
    pub(super) fn resize(&mut self, blocks: usize) {
        self.blocks.resize(blocks, Block::EMPTY);
        self.bounds.resize(blocks, Bounds::EMPTY);
        self.swept.resize(blocks, Bounds::EMPTY);
        self.changed.resize(blocks, 0);
    }

    /// Resizes a layer above the lowest one for `children` blocks in the layer below, at least one.
    /// Lanes without a child become empty.
    pub(super) fn fit_above(&mut self, children: usize) {
        let blocks = children.div_ceil(LANES);
        self.resize(blocks);
        self.swept_blocks.resize(blocks, Block::EMPTY);
        let (last, used) = (blocks - 1, children - (blocks - 1) * LANES);
        for lane in used..LANES {
            self.blocks[last].set_lane(lane, &Bounds::EMPTY);
            self.swept_blocks[last].set_lane(lane, &Bounds::EMPTY);
            self.changed[last] &= !(1 << lane);
        }
    }
}

/// A packed tree over boxes with ids; see the module for the layout.
///
/// Ids are chosen by the caller. They should be small, because they index arrays of the tree. Boxes
/// must be finite with `lo ≤ hi`.
#[derive(Debug)]
pub(crate) struct Tree<const D: usize> {
    pub(super) lanes: Lanes,
    /// The layers, layer 0 first. There is at least one, and the last one has at most one block.
    pub(super) layers: Vec<Layer<D>>,
    /// By leaf block: the boxes at the last [`Self::commit_boxes`], if `remembers`; see
    /// [`Self::was`].
    pub(super) before: Vec<Block<D>>,
    /// Whether `before` is stored only while some box differs from the last commit. Saves memory in
    /// a tree whose objects seldom change.
    pub(super) is_sparing: bool,
    /// Slabs by layer and block, if the owner added them; valid until the boxes change.
    pub(super) slabs: Vec<Vec<Option<BlockSlab<D>>>>,
    /// Whether [`Self::before`] is stored now: always, unless the tree is sparing and no box is
    /// marked as changed.
    pub(super) remembers: bool,
    /// By slot: the object's id, or [`NONE`].
    pub(super) ids: Vec<u32>,
    /// By id: the object's slot, or [`NONE`].
    pub(super) slots: Vec<u32>,
    /// One more than the last slot in use.
    pub(super) end: usize,
    /// Number of objects.
    pub(super) live: usize,
    /// Leaf blocks that were written or got a change bit since the last [`Self::commit_boxes`], as
    /// a list and as flags.
    pub(super) touched: Vec<u32>,
    pub(super) is_touched: Vec<bool>,
    /// Leaf blocks whose swept bounds leave out old boxes; see [`Self::escaped`].
    pub(super) escaped: Vec<u32>,
    /// Scratch: boxes of objects that move between slots.
    pub(super) loads: Vec<Load<D>>,
    /// Scratch: lists of blocks.
    pub(super) dirty: Vec<u32>,
    /// Number of lanes with their change bit set.
    pub(super) changed: usize,
    /// Whether the number of leaf blocks has changed. The upper layers must then be resized.
    pub(super) is_restructured: bool,
    /// Whether a box was written or marked as changed since the last [`Self::refit`]. Searches
    /// would then miss objects.
    pub(super) is_stale: bool,
    pub(super) schedule: Schedule<D>,
    /// The renewal of a sparing tree, while one is in progress.
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

/// Converts an index to `u32`; panics if it does not fit.
#[inline]
pub(super) fn small(value: usize) -> u32 {
    u32::try_from(value).expect("a tree holds fewer than 2^32 objects")
}

impl<const D: usize> Tree<D> {
    /// Creates a tree without objects.
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

    /// Creates a tree without objects that stores old boxes only while some box has changed
    /// ([`Self::is_sparing`]). It uses less memory if objects seldom change.
    pub(crate) fn sparing(lanes: Lanes) -> Self {
        Self { is_sparing: true, remembers: false, ..Self::new(lanes) }
    }

    /// Makes the tree sparing ([`Self::is_sparing`]), for objects that seldom change. No box may
    /// have changed since the last commit; blocks that lost an object since then stay listed.
    pub(crate) fn spare(&mut self) {
        debug_assert_eq!(self.changed, 0, "a tree with committed boxes");
        (self.is_sparing, self.remembers, self.before) = (true, false, Vec::new());
        (self.loads, self.dirty) = (Vec::new(), Vec::new());
        self.give_back();
    }

    /// Makes a sparing tree ordinary, for objects that change often. Drops a renewal in progress.
    pub(crate) fn spend(&mut self) {
        (self.is_sparing, self.renewal) = (false, None);
        self.remember();
    }

    /// Returns the number of objects.
    #[must_use]
    pub(crate) const fn len(&self) -> usize {
        self.live
    }

    /// Returns `true` if there is no object.
    #[must_use]
    pub(crate) const fn is_empty(&self) -> bool {
        self.live == 0
    }

    /// Returns `true` if the object is in the tree.
    #[must_use]
    pub(crate) fn contains(&self, id: u32) -> bool {
        self.slot(id).is_some()
    }

    /// Returns the box of the object; `None` if it is not in the tree.
    #[must_use]
    pub(crate) fn bounds(&self, id: u32) -> Option<Bounds<D>> {
        self.slot(id).map(|slot| self.lane(slot))
    }

    /// Returns the box in a slot.
    #[inline]
    pub(super) fn lane(&self, slot: usize) -> Bounds<D> {
        self.layers[0].blocks[slot / LANES].lane(slot % LANES)
    }

    /// Returns a slot that is probably near a point: descends in each layer to the child with the
    /// nearest centre. `None` if no box is finite, or squared distances overflow `f32`.
    pub(super) fn slot_near(&self, point: &[f32; D]) -> Option<u32> {
        self.layers.iter().rev().try_fold(0, |at, layer| {
            let lane = layer.blocks[at as usize].nearest_lane(point)?;
            Some(at * small(LANES) + small(lane))
        })
    }

    /// Calls `visit` with the bounds of each block that is not empty, the lowest layer first.
    #[cfg(feature = "debug_render")]
    pub(crate) fn each_node(&self, visit: &mut dyn FnMut(&Bounds<D>)) {
        let bounds = self.layers.iter().flat_map(|layer| &layer.bounds);
        bounds.filter(|bounds| bounds.is_finite()).for_each(visit);
    }

    /// Returns the number of leaf blocks.
    pub(super) fn leaf_count(&self) -> usize {
        self.layers[0].blocks.len()
    }

    /// Returns the boxes at the last [`Self::commit_boxes`], by leaf block.
    #[inline]
    pub(super) fn was(&self) -> &[Block<D>] {
        if self.remembers { &self.before } else { &self.layers[0].blocks }
    }

    /// Copies the present leaf boxes to `before`, unless `before` is stored already. Must be called
    /// before a box is marked as changed.
    #[inline]
    fn remember(&mut self) {
        if !self.remembers {
            self.before.clone_from(&self.layers[0].blocks);
            self.remembers = true;
        }
    }

    /// Returns the box of the object at the last [`Self::commit_boxes`], which is empty for a new
    /// object; `None` if the object is not in the tree.
    pub(crate) fn before(&self, id: u32) -> Option<Bounds<D>> {
        self.slot(id).map(|slot| self.was()[slot / LANES].lane(slot % LANES))
    }

    /// Returns the slot of the object; `None` if it is not in the tree.
    pub(super) fn slot(&self, id: u32) -> Option<usize> {
        let slot = self.slots.get(id as usize).copied().filter(|&slot| slot != NONE)?;
        Some(slot as usize)
    }

    /// Returns the slot of the object; panics if it is not in the tree.
    fn expect_slot(&self, id: u32) -> usize {
        self.slot(id).expect("the object is in the tree")
    }

    /// Inserts an object. `before` is its box at the last [`Self::commit_boxes`]: pairs whose boxes
    /// overlapped then do not begin now. Pass [`Bounds::NOWHERE`] for a new object.
    ///
    /// # Panics
    /// If the object is in the tree already.
    pub(crate) fn insert(&mut self, id: u32, bounds: &Bounds<D>, before: &Bounds<D>) {
        self.remember();
        let slot = self.insert_still(id, bounds);
        self.before[slot / LANES].set_lane(slot % LANES, &before.clamped());
        self.mark_changed(slot);
    }

    /// Inserts an object whose box counts as unchanged since the last [`Self::commit_boxes`], such
    /// as an object from another tree: none of its pairs begin. Returns its slot. Panics if the
    /// object is in the tree already.
    pub(crate) fn insert_still(&mut self, id: u32, bounds: &Bounds<D>) -> usize {
        assert!(!self.contains(id), "object {id} is in the tree already");
        debug_assert!(bounds.is_finite(), "trees hold bounded boxes: {bounds:?}");
        let slot = self.find_slot(bounds);
        self.put_at(slot, id, bounds);
        slot
    }

    /// Inserts an object in the slot after the last one in use. Its box counts as unchanged: no
    /// pairs begin.
    pub(super) fn append(&mut self, id: u32, bounds: &Bounds<D>) {
        let slot = self.append_slot();
        self.put_at(slot, id, bounds);
    }

    /// Writes an object to a free slot. Its box counts as unchanged: no pairs begin.
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

    /// Sets the box of an object, which then counts as unchanged: no pairs begin or end.
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

    /// Marks an object as changed; the next [`Self::refit_from`] reads its new box.
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
        // A block with changed lanes is in the list already.
        if was_unchanged {
            self.touch(block);
        }
    }

    /// Empties the old box of the object, so that each of its present overlaps begins anew.
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

    /// Removes the object. Its ended pairs are not reported, and searches no longer find it.
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

    /// Writes the box in a slot; the next refit updates the layers above.
    #[inline]
    fn write(&mut self, slot: usize, bounds: &Bounds<D>) {
        self.layers[0].blocks[slot / LANES].set_lane(slot % LANES, bounds);
        self.touch(slot / LANES);
        self.is_stale = true;
    }

    #[inline]
    /// Sets the change bit of a slot, and increments `changed` if the bit was not set.
    pub(super) fn mark_changed(&mut self, slot: usize) {
        let mask = &mut self.layers[0].changed[slot / LANES];
        let bit = 1 << (slot % LANES);
        self.changed += usize::from(*mask & bit == 0);
        *mask |= bit;
    }

    #[inline]
    /// Lists a leaf block as written since the last [`Self::commit_boxes`].
    pub(super) fn touch(&mut self, block: usize) {
        if !self.is_touched[block] {
            self.is_touched[block] = true;
            self.touched.push(small(block));
        }
    }

    /// Sets the number of leaf blocks; new blocks are empty. The next refit resizes the upper
    /// layers.
    pub(super) fn resize_leaves(&mut self, blocks: usize) {
        self.layers[0].resize(blocks);
        if self.remembers {
            self.before.resize(blocks, Block::EMPTY);
        }
        self.is_touched.resize(blocks, false);
        self.ids.resize(blocks * LANES, NONE);
        self.is_restructured = true;
    }

    /// Removes all objects. Keeps the memory of a tree of at most [`KEPT_LEAVES`] leaf blocks.
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

    /// Releases surplus memory of a tree that has stopped growing.
    pub(crate) fn fit(&mut self, look: Look) {
        let Layer { blocks, bounds, swept, changed, .. } = &mut self.layers[0];
        look.fit(blocks);
        look.fit(bounds);
        look.fit(swept);
        look.fit(changed);
        look.fit(&mut self.before);
        look.fit(&mut self.ids);
        look.fit(&mut self.slots);
        look.fit(&mut self.is_touched);
        look.trim(&mut self.touched);
        look.trim(&mut self.dirty);
    }

    /// Returns the sum of the half surfaces of all leaf blocks, added in block order: a measure of
    /// the cost of searches.
    pub(crate) fn leaf_surface(&self) -> f64 {
        self.layers[0].bounds.iter().map(Bounds::half_surface).sum()
    }

    /// Returns the ids in the order of the slots, which is a spatial order; [`NONE`] for a free
    /// slot.
    pub(crate) fn slots_in_order(&self) -> &[u32] {
        &self.ids[..self.end]
    }

    /// Lists the slots of changed lanes; ascending if `touched` is.
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

    /// Iterates over the changed objects in escaped blocks, as of the last refit. The
    /// [`super::Joiner`] may not have reported all ended pairs of these objects.
    pub(crate) fn escaped(&self) -> impl Iterator<Item = u32> + '_ {
        let changed = move |&block: &u32| {
            let mask = self.layers[0].changed[block as usize];
            let lanes = (0..LANES).filter(move |lane| mask >> lane & 1 == 1);
            lanes.map(move |lane| self.ids[block as usize * LANES + lane])
        };
        self.escaped.iter().flat_map(changed)
    }
}
