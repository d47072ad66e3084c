//! Pairs computed between two updates.
//!
//! The rows of the table keep the poses of the last update, and contacts are read at these poses. A
//! pair that was computed since then is read at the poses of its computation. The table keeps these
//! poses until the next update begins.

use super::ObjectTable;
use super::entry::posed;
use super::group::PairKey;
use super::objects::ObjectSolid;
use crate::collide::Placed;
use crate::math::{Mapped, Pose, Real, Space};

/// A pair with its shapes and the poses at which it was computed.
#[derive(Clone, Debug)]
pub(super) struct PairSolids<N: Real, const D: usize> {
    pub(super) key: PairKey,
    pub(super) solids: [ObjectSolid<N, D>; 2],
}

/// The poses of the last update that [`ObjectTable::begin_substep`] has replaced in the rows of a
/// pair.
#[derive(Debug)]
pub(crate) struct Substep<N: Space<D>, const D: usize> {
    key: PairKey,
    /// Replaced poses of the first and the second object.
    replaced: [(Pose<N, D>, N::Isometry); 2],
}

impl<N: Space<D>, const D: usize> ObjectTable<N, D> {
    /// Replaces the poses in the rows of a pair's objects, until [`Self::end_substep`]. `None`,
    /// without a change, if an object has no row, and therefore no pair.
    pub(crate) fn begin_substep(
        &mut self,
        key: PairKey,
        isometries: [N::Isometry; 2],
    ) -> Option<Substep<N, D>> {
        if !key.iter().all(|&object| self.has_row(object)) {
            return None;
        }
        let [first, second] = [0, 1].map(|side| {
            let pose = self.shape(key[side]).geometry().pose_at(&isometries[side]);
            self.replace_pose(key[side], (pose, isometries[side]))
        });
        Some(Substep { key, replaced: [first, second] })
    }

    /// Restores the poses of the last update. If `is_computed`, the pair is read at the poses of
    /// the substep until the next update.
    pub(crate) fn end_substep(&mut self, substep: &Substep<N, D>, is_computed: bool) {
        let Substep { key, replaced: [first, second] } = *substep;
        if is_computed {
            let solids = key.map(|object| self.solid(object).clone());
            let pair = PairSolids { key, solids };
            match self.substeps.binary_search_by_key(&key, |pair| pair.key) {
                Ok(index) => self.substeps[index] = pair,
                Err(index) => self.substeps.insert(index, pair),
            }
        }
        // In reverse order, because both rows of the pair of an object with itself are the same.
        self.replace_pose(key[1], second);
        self.replace_pose(key[0], first);
    }

    /// Returns the two solids of a pair at the poses at which its contacts are read: those of its
    /// substep if there is one, else those of the last update.
    pub(super) fn placed_pair(&self, key: PairKey) -> [Placed<'_, N, D>; 2] {
        match self.substep_solids(key) {
            None => posed(self, key).placed(),
            Some(pair) => {
                let [first, second] = &pair.solids;
                [(first.pose, &first.shape), (second.pose, &second.shape)]
                    .mapped(|(pose, shape)| Placed { pose, shape: shape.geometry() })
            }
        }
    }

    /// Returns `true` if the contacts of a pair cannot be read in place at the poses of the rows:
    /// the pair was computed since the last update, or an object has a skin. Manifolds are then
    /// built for its readers.
    pub(super) fn needs_built_manifolds(&self, key: PairKey) -> bool {
        self.substep_solids(key).is_some() || self.skins_of(key) != [N::ZERO; 2]
    }

    /// Returns `true` if there are no substeps and no object has had a skin. No pair then [needs
    /// built manifolds](Self::needs_built_manifolds).
    pub(super) fn reads_in_place(&self) -> bool {
        self.substeps.is_empty() && self.skins.is_empty()
    }

    /// Returns the solids of a pair if it was computed since the last update; else `None`.
    fn substep_solids(&self, key: PairKey) -> Option<&PairSolids<N, D>> {
        let index = self.substeps.binary_search_by_key(&key, |pair| pair.key).ok()?;
        Some(&self.substeps[index])
    }
}
