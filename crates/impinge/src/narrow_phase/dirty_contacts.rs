//! The dirty pairs of a group, as the input of kernels that compute several pairs in SIMD lanes.

use super::ObjectTable;
use super::entry::{ContactEntry, ContactView};
use super::group::Rows;
use super::reuse::Reference;
use super::state::ContactState;
use super::update::{PairChanges, note_touching};
use crate::collide::{KeptPairs, PairQuestion, RawManifold, Solid, update_pairs2, update_pairs3};
use crate::math::Space;
use crate::query::ContactManifold;

/// The rows of some pairs of convex solids, with all of their columns.
pub(super) type ContactRows<'a, N, const D: usize> = Rows<
    'a,
    ContactEntry<N, ContactState<N, D>>,
    ContactView<ContactManifold<N, D>>,
    Reference<N, D>,
>;

/// The pairs of a chunk that must be computed. All of them have copies of their solids.
pub(crate) struct DirtyContacts<'r, 't, N: Space<D>, const D: usize> {
    pub(super) rows: ContactRows<'r, N, D>,
    /// Indices of the dirty pairs in `rows`.
    pub(super) indices: &'t [usize],
    pub(super) table: &'t ObjectTable<N, D>,
    pub(super) changes: &'t mut PairChanges,
}

/// Updates pairs of the narrow phase in 2D by [`update_pairs2`]; returns `false` if there is no
/// kernel for their kinds.
pub(crate) fn update_lanes2<N: Space<2>>(
    solids: [&Solid<N, 2>; 2],
    dirty: &mut DirtyContacts<'_, '_, N, 2>,
) -> bool {
    update_pairs2(solids, dirty)
}

/// Updates pairs of the narrow phase in 3D by [`update_pairs3`]; returns `false` if there is no
/// kernel for their kinds.
pub(crate) fn update_lanes3<N: Space<3>>(
    solids: [&Solid<N, 3>; 2],
    dirty: &mut DirtyContacts<'_, '_, N, 3>,
) -> bool {
    update_pairs3(solids, dirty)
}

impl<N: Space<D>, const D: usize> KeptPairs<N, D> for DirtyContacts<'_, '_, N, D> {
    #[inline(always)]
    fn len(&self) -> usize {
        self.indices.len()
    }

    #[inline(always)]
    fn begin(&mut self, index: usize) -> PairQuestion<'_, N, D> {
        ContactView::expire_any(self.rows.views.get_mut(self.indices[index]));
        self.parts(index).0
    }

    #[inline(always)]
    fn parts(&mut self, index: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>) {
        let row = self.indices[index];
        let [first, second] = self.rows.keys[row];
        let poses = [self.table.pose(first), self.table.pose(second)];
        let entry = &mut self.rows.states[row];
        entry
            .state
            .canonical_question(poses, &entry.request)
            .expect("all pairs of a group have their solids")
    }

    #[inline(always)]
    fn raw(&mut self, index: usize) -> &mut RawManifold<N, D> {
        self.rows.states[self.indices[index]].state.raw_mut()
    }

    #[inline(always)]
    fn end(&mut self, index: usize) {
        let row = self.indices[index];
        let is_touching = self.rows.states[row].is_touching();
        note_touching(&mut self.rows, row, is_touching, self.changes);
    }
}
