//! Checks of the tree's invariants; for tests.

use super::{Block, Bounds, LANES, NONE, Tree};

impl<const D: usize> Tree<D> {
    /// Checks every invariant. Bounds are exact after a refit. After a removal the bounds may be
    /// too large until the next refit; after an insertion or a move the bounds are not checked
    /// until the next refit.
    ///
    /// # Errors
    /// Returns a sentence that names the violated invariant.
    pub(crate) fn validate(&self) -> Result<(), String> {
        self.validate_maps()?;
        self.validate_leaves()?;
        if !self.is_stale {
            self.validate_layers()?;
            self.validate_swept()?;
        }
        self.validate_changes()
    }

    /// Checks that `ids` and `slots` are inverse maps, and that their counts are right.
    fn validate_maps(&self) -> Result<(), String> {
        let live = self.ids.iter().filter(|&&id| id != NONE).count();
        let mapped = self.slots.iter().filter(|&&slot| slot != NONE).count();
        if live != self.live || mapped != self.live {
            return Err(format!("{live} ids, {mapped} slots, {} counted", self.live));
        }
        for (slot, &id) in self.ids.iter().enumerate() {
            if id != NONE && (self.slots[id as usize] as usize != slot || slot >= self.end) {
                return Err(format!("slot {slot} holds {id}, which stands elsewhere"));
            }
        }
        let blocks = self.leaf_count();
        let is_long = self.end > blocks * LANES;
        if is_long || self.ids.len() != blocks * LANES || self.was().len() != blocks {
            return Err(format!("{} slots in {blocks} blocks", self.end));
        }
        Ok(())
    }

    /// Checks that boxes are finite and not inverted, that a free lane has the empty box now and at
    /// the last commit, and that changed lanes are marked.
    fn validate_leaves(&self) -> Result<(), String> {
        for (slot, &id) in self.ids.iter().enumerate() {
            let (block, lane) = (slot / LANES, slot % LANES);
            let (stored, before) = (self.lane(slot), self.was()[block].lane(lane));
            let is_free = id == NONE;
            let empty = Bounds::EMPTY;
            if is_free && (stored != empty || before != empty) {
                return Err(format!("free slot {slot} is not empty"));
            }
            let is_upright = stored.lo.iter().zip(&stored.hi).all(|(lo, hi)| lo <= hi);
            if !(is_free || stored.is_finite() && is_upright) {
                return Err(format!("the box in slot {slot} is no bounded box: {stored:?}"));
            }
            let is_changed = self.layers[0].changed[block] >> lane & 1 == 1;
            if before != stored && !is_changed {
                return Err(format!("slot {slot} changed without a mark"));
            }
        }
        Ok(())
    }

    /// Checks that every layer has the bounds of the layer below, and that the top layer has at
    /// most one block.
    fn validate_layers(&self) -> Result<(), String> {
        // Until the next refit, bounds above a touched block may be too large.
        let is_exact = self.touched.is_empty();
        let agrees = |kept: &Bounds<D>, real: &Bounds<D>| {
            let is_empty = *real == Bounds::EMPTY;
            kept == real || (!is_exact && (is_empty || kept.contains(real)))
        };
        for (index, layer) in self.layers.iter().enumerate() {
            let lengths = [layer.bounds.len(), layer.swept.len(), layer.changed.len()];
            // The lowest layer has no `swept_blocks`.
            let swept_blocks = if index > 0 { layer.blocks.len() } else { 0 };
            if lengths != [layer.blocks.len(); 3] || layer.swept_blocks.len() != swept_blocks {
                return Err(format!("the arrays of layer {index} differ in length"));
            }
            for (block, kept) in layer.blocks.iter().zip(&layer.bounds) {
                if !agrees(kept, &bounds_of(block)) {
                    return Err(format!("bounds {kept:?} in layer {index} are wrong"));
                }
            }
            let Some(parent) = self.layers.get(index + 1) else {
                return (layer.blocks.len() <= 1)
                    .then_some(())
                    .ok_or(format!("{} blocks in the top layer", layer.blocks.len()));
            };
            if parent.blocks.len() != layer.blocks.len().div_ceil(LANES) {
                return Err(format!("layer {} has the wrong length", index + 1));
            }
            // Lanes without a child must be empty.
            for lane in 0..parent.blocks.len() * LANES {
                let kept = parent.blocks[lane / LANES].lane(lane % LANES);
                let real = layer.bounds.get(lane).copied().unwrap_or(Bounds::EMPTY);
                let kept_swept = parent.swept_blocks[lane / LANES].lane(lane % LANES);
                let swept = layer.swept.get(lane).copied().unwrap_or(Bounds::EMPTY);
                if kept != real || kept_swept != swept {
                    return Err(format!("lane {lane} of layer {} is not its child", index + 1));
                }
            }
        }
        Ok(())
    }

    /// Checks that the swept bounds of each leaf block contain its present boxes and, unless the
    /// block is escaped, its old boxes.
    fn validate_swept(&self) -> Result<(), String> {
        for (block, swept) in self.layers[0].swept.iter().enumerate() {
            let has_left = self.escaped.iter().any(|&other| other as usize == block);
            let now = bounds_of(&self.layers[0].blocks[block]);
            let before = bounds_of(&self.was()[block]);
            let holds = |inner: &Bounds<D>| *inner == Bounds::EMPTY || swept.contains(inner);
            if !(holds(&now) && (has_left || holds(&before))) {
                return Err(format!("the reach {swept:?} of block {block} leaves boxes out"));
            }
        }
        Ok(())
    }

    /// Checks that change marks are counted, that their blocks are in `touched`, and that upper
    /// layers have no marks if no lane is changed.
    fn validate_changes(&self) -> Result<(), String> {
        let marked: u32 = self.layers[0].changed.iter().map(|mask| mask.count_ones()).sum();
        if marked as usize != self.changed {
            return Err(format!("{marked} marks, {} counted", self.changed));
        }
        let listed = self.touched.iter().all(|&block| self.is_touched[block as usize]);
        let flagged = self.is_touched.iter().filter(|&&flag| flag).count();
        if !listed || flagged != self.touched.len() {
            return Err("list and flags of touched blocks differ".to_owned());
        }
        let unlisted = |(mask, is_touched): (&u16, &bool)| *mask != 0 && !is_touched;
        if self.layers[0].changed.iter().zip(&self.is_touched).any(unlisted) {
            return Err("a changed block is not listed as touched".to_owned());
        }
        let leftover = |mask: &u16| self.changed == 0 && *mask != 0;
        if self.layers.iter().any(|layer| layer.changed.iter().any(leftover)) {
            return Err("marks are left in the upper layers".to_owned());
        }
        Ok(())
    }
}

/// Returns the union of the boxes of a block.
fn bounds_of<const D: usize>(block: &Block<D>) -> Bounds<D> {
    (0..LANES).fold(Bounds::EMPTY, |all, lane| all.merged(&block.lane(lane)))
}
