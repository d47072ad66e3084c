//! Many rays among triangles together, in lockstep.
//!
//! The next step of a ray depends on data that arrive late from memory and on unpredictable branches. So all rays that
//! open a block do so one after the other, then all rays at leaves test triangles, then all others return to an open
//! block. Within such a phase no ray depends on the one before, there is no unpredictable branch, and loads of several
//! blocks overlap. The order of each single ray is that of [`near_first`](super::near_first).
//!
//! ```text
//! to_open   ── open_blocks ────> to_open | at_leaf | to_return
//! at_leaf   ── look_at_leaves ─> to_return
//! to_return ── go_back ────────> to_open | at_leaf | to_return      a ray in no list is done
//! ```

use super::kernel::{Kernel, with_widest_kernel};
use super::near_first::{LAYERS, RayProbe};
use super::tree::small;
use super::triangles::{TriangleAt, Triangles};
use super::{LANES, NONE, Slabs, Tree};

/// Greatest number of rays processed together.
pub(crate) const RAYS: usize = 64;

/// Receives the triangles that rays may cross.
pub(crate) trait RayVisitor {
    /// Prefetches an object that [`Self::visit`] will read soon.
    fn touch(&self, id: u32);

    /// Tests a triangle that the ray may cross by its limit; returns the new limit, in the units of the slabs.
    fn visit(&mut self, ray: usize, slabs: &Slabs<3>, at: TriangleAt<'_>) -> f32;
}

/// The state of one ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    probe: RayProbe,
    limit: f32,
    /// Bit mask of the layers with an open block that has children left.
    open: u32,
    /// Next block and its layer. At a leaf the layer is wrapped and unused.
    layer: usize,
    block: u32,
    /// Triangles of the leaf block that the ray may cross.
    crossed: u32,
    /// By layer: index of the first child of the open block.
    first: [u32; LAYERS],
}

impl Walk {
    /// Creates the state of a ray at its start.
    #[inline(always)]
    pub(crate) const fn new(probe: RayProbe, limit: f32) -> Self {
        Self { probe, limit, open: 0, layer: 0, block: 0, crossed: 0, first: [0; LAYERS] }
    }
}

/// A list of ray numbers.
#[derive(Clone, Copy)]
struct List {
    rays: [u8; 2 * RAYS],
    len: usize,
}

impl List {
    /// A list without rays.
    const EMPTY: Self = Self { rays: [0; 2 * RAYS], len: 0 };

    /// Appends a ray if `is_in`, without a branch.
    #[inline(always)]
    fn push_if(&mut self, ray: u8, is_in: bool) {
        self.rays[self.len % (2 * RAYS)] = ray;
        self.len += usize::from(is_in);
    }

    /// Returns the rays in the list.
    fn rays(&self) -> &[u8] {
        &self.rays[..self.len]
    }
}

/// Keys of the children of a block, with lanes in the lowest bits; `u32::MAX` for children that are done.
type LaneKeys = [u32; LANES];

/// The rays, and the next action of each: a ray is in at most one list.
struct Stream<'a> {
    walks: &'a mut [Walk],
    /// Keys by ray, then by layer.
    keys: Vec<LaneKeys>,
    layers: usize,
    to_open: List,
    at_leaf: List,
    to_return: List,
}

impl Tree<3> {
    /// As [`Self::visit_triangles`], for at most [`RAYS`] rays together.
    pub(crate) fn visit_triangles_of_many(
        &self,
        triangles: &[Triangles],
        walks: &mut [Walk],
        visitor: &mut impl RayVisitor,
    ) {
        debug_assert!(
            walks.len() <= RAYS && !self.is_empty(),
            "so many bits, and something to find"
        );
        let top = self.layers.len() - 1;
        let mut all = List::EMPTY;
        for ray in (0..).take(walks.len()) {
            all.push_if(ray, true);
        }
        walks.iter_mut().for_each(|walk| walk.layer = top);
        let (to_open, at_leaf) = if top == 0 { (List::EMPTY, all) } else { (all, List::EMPTY) };
        let layers = self.layers.len();
        let keys = vec![[0; LANES]; walks.len() * layers];
        let mut stream = Stream { walks, keys, layers, to_open, at_leaf, to_return: List::EMPTY };
        with_widest_kernel!(self.lanes, kernel => self.run(kernel, triangles, &mut stream, visitor));
    }

    /// Advances all rays until every list is empty.
    #[inline(always)]
    fn run<K: Kernel>(
        &self,
        kernel: K,
        triangles: &[Triangles],
        stream: &mut Stream<'_>,
        visitor: &mut impl RayVisitor,
    ) {
        while stream.to_open.len + stream.at_leaf.len + stream.to_return.len > 0 {
            self.open_blocks(kernel, stream);
            self.look_at_leaves(kernel, triangles, stream, visitor);
            stream.go_back(kernel);
        }
    }

    /// Opens the block of each ray, which continues with the nearest child.
    #[inline(always)]
    fn open_blocks<K: Kernel>(&self, kernel: K, stream: &mut Stream<'_>) {
        while stream.to_open.len > 0 {
            let rays = core::mem::replace(&mut stream.to_open, List::EMPTY);
            for &ray in rays.rays() {
                let walk = &mut stream.walks[usize::from(ray)];
                let layer = walk.layer % LAYERS;
                let block = &self.layers[layer].blocks[walk.block as usize];
                let keys = &mut stream.keys[usize::from(ray) * stream.layers + layer];
                let (mask, least) =
                    kernel.enter_nearest(block, &walk.probe.slabs, walk.limit, keys);
                let (first, lane) = (walk.block * small(LANES), least % small(LANES));
                keys[lane as usize] = u32::MAX;
                // With a second lane to visit, the ray will return to this block.
                let (is_any, has_more) = (mask != 0, mask & mask.wrapping_sub(1) != 0);
                walk.open |= u32::from(has_more) << layer;
                walk.first[layer] = first;
                (walk.block, walk.layer) = (first + lane, layer.wrapping_sub(1));
                stream.to_open.push_if(ray, is_any & (layer > 1));
                stream.at_leaf.push_if(ray, is_any & (layer == 1));
                stream.to_return.push_if(ray, !is_any & (walk.open != 0));
            }
        }
    }

    /// Tests the triangles of the leaf block of each ray at a leaf.
    #[inline(always)]
    fn look_at_leaves<K: Kernel>(
        &self,
        kernel: K,
        triangles: &[Triangles],
        stream: &mut Stream<'_>,
        visitor: &mut impl RayVisitor,
    ) {
        let rays = core::mem::replace(&mut stream.at_leaf, List::EMPTY);
        let mut crossing = List::EMPTY;
        for &ray in rays.rays() {
            let walk = &mut stream.walks[usize::from(ray)];
            let own = &triangles[walk.block as usize];
            walk.crossed = kernel.crossed(own, &walk.probe.line, walk.limit);
            crossing.push_if(ray, walk.crossed != 0);
            stream.to_return.push_if(ray, (walk.crossed == 0) & (walk.open != 0));
        }
        for &ray in crossing.rays() {
            let walk = &stream.walks[usize::from(ray)];
            visitor.touch(
                self.ids[walk.block as usize * LANES + walk.crossed.trailing_zeros() as usize],
            );
        }
        for &ray in crossing.rays() {
            let walk = &mut stream.walks[usize::from(ray)];
            let block = walk.block as usize;
            let mut mask = walk.crossed;
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                let id = self.ids[block * LANES + lane];
                if id != NONE {
                    let at = TriangleAt { id, block: &triangles[block], lane };
                    walk.limit = visitor.visit(ray.into(), &walk.probe.slabs, at);
                }
            }
            stream.to_return.push_if(ray, walk.open != 0);
        }
    }
}

impl Stream<'_> {
    /// Moves each ray to the next child of its lowest open block, if that is within its limit. Otherwise the rest of
    /// the block is skipped, and the ray looks for another open block in the next round.
    #[inline(always)]
    fn go_back<K: Kernel>(&mut self, kernel: K) {
        let rays = core::mem::replace(&mut self.to_return, List::EMPTY);
        for &ray in rays.rays() {
            let walk = &mut self.walks[usize::from(ray)];
            let layer = walk.open.trailing_zeros() as usize % LAYERS;
            let keys = &mut self.keys[usize::from(ray) * self.layers + layer];
            let least = kernel.least_lane_key(keys);
            let lane = least % small(LANES);
            keys[lane as usize] = u32::MAX;
            // `u32::MAX` as a key is NaN, so the comparison is false.
            let is_within = f32::from_bits(least - lane) <= walk.limit;
            walk.open &= !(u32::from(!is_within) << layer);
            (walk.block, walk.layer) = (walk.first[layer] + lane, layer.wrapping_sub(1));
            self.to_open.push_if(ray, is_within & (layer > 1));
            self.at_leaf.push_if(ray, is_within & (layer == 1));
            self.to_return.push_if(ray, !is_within & (walk.open != 0));
        }
    }
}
