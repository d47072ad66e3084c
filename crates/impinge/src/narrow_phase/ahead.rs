//! Memory that will be read, asked for ahead of time.
//!
//! The states of pairs lie in a row, but what they are about does not: poses, shapes, what shapes are made of
//! and points of contact lie wherever they were put. Who goes from pair to pair waits for one of these after
//! the other; a processor that meets the reads of several pairs close to each other waits for all at once.

use super::ObjectTable;
use super::entry::{ContactEntry, ProximityEntry, posed};
use super::group::{Chosen, Rows};
use super::state::{CompositeState, ContactState};
use crate::math::{Real, Space, max};
use crate::shape::{Geometry, Kind};

/// For so many pairs reads are made before the first of them is updated: about what a core has in flight.
const PAIRS: usize = 8;

/// Pairs whose memory can be asked for.
pub(super) trait Awaited<N: Space<D>, const D: usize> {
    /// Reads a number of each place that an update of the pair will read; answers one of no meaning.
    fn glance(&self, table: &ObjectTable<N, D>, key: (u32, u32)) -> N;
}

impl<N: Space<D>, const D: usize> Awaited<N, D> for ContactEntry<N, ContactState<N, D>> {
    #[inline]
    fn glance(&self, table: &ObjectTable<N, D>, key: (u32, u32)) -> N {
        max(self.state.glance(), solids(table, key, self.request.prediction))
    }
}

impl<N: Space<D>, const D: usize> Awaited<N, D> for ContactEntry<N, CompositeState<N, D>> {
    #[inline]
    fn glance(&self, table: &ObjectTable<N, D>, (first, second): (u32, u32)) -> N {
        let poses = table.pose(first).translation[0] + table.pose(second).translation[0];
        let [one, other] = [first, second].map(|index| solid(table.shape(index).geometry()));
        max(max(self.state.glance(), poses), max(one, other))
    }
}

impl<N: Space<D>, const D: usize> Awaited<N, D> for ProximityEntry<N> {
    #[inline]
    fn glance(&self, table: &ObjectTable<N, D>, key: (u32, u32)) -> N {
        solids(table, key, self.margin)
    }
}

/// A number of two solids, of which nobody will ask if they are certainly farther apart than a limit.
#[inline]
fn solids<N: Space<D>, const D: usize>(table: &ObjectTable<N, D>, key: (u32, u32), limit: N) -> N {
    if posed(table, key).are_beyond(limit) {
        return N::ZERO;
    }
    max(solid(table.shape(key.0).geometry()), solid(table.shape(key.1).geometry()))
}

/// A number of each place in memory that a small solid takes up.
#[inline]
fn solid<N: Real, const D: usize>(shape: Geometry<'_, N, D>) -> N {
    match shape.0 {
        Kind::Ball(ball) => ball.radius(),
        Kind::Segment(segment) => segment.a()[0],
        Kind::Capsule(capsule) => capsule.radius(),
        Kind::Triangle(triangle) => triangle.corners()[0][0],
        Kind::Cuboid(cuboid) => cuboid.half_extents()[0],
        Kind::Polytope(polytope) => {
            let vertex = polytope.blocks().first().map_or(N::ZERO, |block| block[0][0]);
            let plane = polytope.planes().first().map_or(N::ZERO, |planes| planes.offsets[0]);
            max(vertex, plane)
        }
        Kind::Cylinder(cylinder, _) => cylinder.radius(),
        Kind::Cone(cone, _) => cone.radius(),
        _ => N::ZERO,
    }
}

/// Updates the pairs of a chunk that are due, one by one, a few of which are always known to be next.
pub(super) fn update_due<N: Space<D>, S: Awaited<N, D>, V, const D: usize>(
    rows: &mut Rows<'_, S, V>,
    (table, due): (&ObjectTable<N, D>, Chosen),
    mut update: impl FnMut(&mut Rows<'_, S, V>, usize),
) {
    let mut ahead = due.indices();
    let mut rest = due.indices();
    loop {
        let (mut count, mut seen) = (0, N::ZERO);
        for place in ahead.by_ref().take(PAIRS) {
            seen = max(seen, rows.states[place].glance(table, rows.keys[place]));
            count += 1;
        }
        core::hint::black_box(seen);
        if count == 0 {
            return;
        }
        rest.by_ref().take(count).for_each(|place| update(rows, place));
    }
}
