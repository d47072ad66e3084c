//! Prefetching of the data of pairs with composites.
//!
//! The states of pairs are contiguous, but the data to which they refer are not: poses, shapes,
//! arrays of shapes, cached parts and contact points are scattered in memory. An update of pair
//! after pair would wait for one cache miss at a time. The cache misses of several pairs overlap if
//! their loads are issued close together.

use super::ObjectTable;
use super::entry::{ContactEntry, ContactView};
use super::group::{RowSet, Rows};
use super::reuse::Reference;
use super::state::CompositeState;
use crate::math::{Mapped, Real, Space, max};
use crate::query::ContactManifold;
use crate::shape::{Geometry, Kind};

/// Number of pairs that are prefetched before the first of them is updated: about as many loads as
/// a core keeps in flight.
const PAIRS: usize = 8;

/// The rows of some pairs with composites, with all of their columns.
pub(super) type CompositeRows<'a, N, const D: usize> = Rows<
    'a,
    ContactEntry<N, CompositeState<N, D>>,
    ContactView<Vec<ContactManifold<N, D>>>,
    Reference<N, D>,
>;

/// Updates the pairs `dirty` of a chunk one by one. Each block of [`PAIRS`] pairs is prefetched
/// before it is updated.
pub(super) fn update_prefetched<N: Space<D>, const D: usize>(
    rows: &mut CompositeRows<'_, N, D>,
    table: &ObjectTable<N, D>,
    dirty: RowSet,
    mut update: impl FnMut(&mut CompositeRows<'_, N, D>, usize),
) {
    let mut dirty = dirty.indices();
    let mut next = [0; PAIRS];
    loop {
        let mut count = 0;
        for (slot, row) in next.iter_mut().zip(dirty.by_ref()) {
            *slot = row;
            count += 1;
        }
        prefetch(rows, table, &next[..count]);
        next[..count].iter().for_each(|&row| update(rows, row));
        if count < PAIRS {
            return;
        }
    }
}

/// Reads the cache lines that the updates of some pairs will need. Changes nothing.
fn prefetch<N: Space<D>, const D: usize>(
    rows: &CompositeRows<'_, N, D>,
    table: &ObjectTable<N, D>,
    indices: &[usize],
) {
    let mut loaded = N::ZERO;
    for &row in indices {
        let [one, other] = rows.keys[row].mapped(|index| solid(table.shape(index).geometry()));
        loaded = max(loaded, max(rows.states[row].state.prefetch(), max(one, other)));
    }
    core::hint::black_box(loaded);
}

/// Reads a cache line of a convex solid's data; two lines for a polytope, none for a composite and
/// for kinds that rarely occur. The returned value is meaningless, and only keeps the loads alive.
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
