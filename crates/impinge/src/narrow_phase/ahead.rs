//! Memory that will be read, asked for ahead of time.
//!
//! The states of pairs lie in a row, but what they are about does not: poses, shapes, what shapes are made of
//! and points of contact lie wherever they were put. Who goes from pair to pair waits for one of these after
//! the other; a processor that meets the reads of several pairs close to each other waits for all at once.

use super::ObjectTable;
use super::entry::{ContactEntry, ProximityEntry};
use super::group::{Chosen, Rows};
use super::state::{CompositeState, ContactState};
use crate::math::{Real, Space, max};
use crate::shape::{Geometry, Kind};

/// For so many pairs reads are made before the first of them is updated: about what a core has in flight.
const PAIRS: usize = 8;

/// Pairs whose memory can be asked for.
pub(super) trait Awaited<N: Space<D>, const D: usize> {
    /// The objects are certainly so far apart that an update will not ask what they are.
    fn is_far(&self, table: &ObjectTable<N, D>, key: (u32, u32)) -> bool;

    /// A number of each place that an update reads of what is kept of the pair; of no meaning.
    fn glance(&self) -> N;
}

impl<N: Space<D>, const D: usize> Awaited<N, D> for ContactEntry<N, ContactState<N, D>> {
    #[inline]
    fn is_far(&self, table: &ObjectTable<N, D>, key: (u32, u32)) -> bool {
        are_beyond(table, key, self.request.prediction)
    }

    #[inline]
    fn glance(&self) -> N {
        self.state.glance()
    }
}

impl<N: Space<D>, const D: usize> Awaited<N, D> for ContactEntry<N, CompositeState<N, D>> {
    /// Nothing is known of composites.
    #[inline]
    fn is_far(&self, _: &ObjectTable<N, D>, _: (u32, u32)) -> bool {
        false
    }

    #[inline]
    fn glance(&self) -> N {
        self.state.glance()
    }
}

impl<N: Space<D>, const D: usize> Awaited<N, D> for ProximityEntry<N> {
    #[inline]
    fn is_far(&self, table: &ObjectTable<N, D>, key: (u32, u32)) -> bool {
        are_beyond(table, key, self.margin)
    }

    #[inline]
    fn glance(&self) -> N {
        N::ZERO
    }
}

/// Two objects are certainly farther apart than a limit.
#[inline]
fn are_beyond<N: Space<D>, const D: usize>(
    table: &ObjectTable<N, D>,
    (first, second): (u32, u32),
    limit: N,
) -> bool {
    let between = table.pose(second).translation - table.pose(first).translation;
    table.bounds(first).is_clear_of(table.bounds(second), &between, limit)
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
    let mut due = due.indices();
    let mut next = [0; PAIRS];
    loop {
        let mut count = 0;
        for (slot, place) in next.iter_mut().zip(due.by_ref()) {
            *slot = place;
            count += 1;
        }
        await_all(rows, table, &next[..count]);
        next[..count].iter().for_each(|&place| update(rows, place));
        if count < PAIRS {
            return;
        }
    }
}

/// Reads a little of all that the updates of some pairs will read. What tells whether shapes are needed comes
/// for all pairs before the shapes do for any.
#[inline]
fn await_all<N: Space<D>, S: Awaited<N, D>, V, const D: usize>(
    rows: &Rows<'_, S, V>,
    table: &ObjectTable<N, D>,
    places: &[usize],
) {
    let (mut are_near, mut seen) = ([false; PAIRS], N::ZERO);
    for (is_near, &place) in are_near.iter_mut().zip(places) {
        *is_near = !rows.states[place].is_far(table, rows.keys[place]);
    }
    for (_, &place) in are_near.iter().zip(places).filter(|(is_near, _)| **is_near) {
        let (first, second) = rows.keys[place];
        let [one, other] = [first, second].map(|index| solid(table.shape(index).geometry()));
        seen = max(seen, max(rows.states[place].glance(), max(one, other)));
    }
    core::hint::black_box(seen);
}
