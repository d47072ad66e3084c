//! Searches for the triangles that rays may cross, for many rays together, in lockstep.
//!
//! The next step of a single ray waits for loads and depends on unpredictable branches. So all rays
//! that open a block do so one after another, then all rays at leaf blocks test triangles, then all
//! other rays return to an open block. Within such a phase no ray depends on the ray before it,
//! most branches are predictable, and loads of several blocks overlap. Each single ray visits
//! blocks in the order of [`near_first`](super::near_first).
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

/// The caller's exact test of the triangles that rays may cross.
pub(crate) trait RayVisitor {
    /// Prefetches an object that [`Self::visit`] may read soon.
    fn touch(&self, id: u32);

    /// Tests a triangle that the ray with index `ray` may cross by its limit. Returns the new
    /// limit, in the units of the slabs, which must not increase.
    fn visit(&mut self, ray: usize, slabs: &Slabs<3>, at: TriangleAt<'_>) -> f32;
}

/// The state of one ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    probe: RayProbe,
    limit: f32,
    /// Bit mask of the layers with an open block that has unvisited children.
    open: u32,
    /// The block that the ray opens or tests next, and the layer of this block.
    layer: usize,
    block: u32,
    /// Lanes of the leaf block whose triangles the ray may cross.
    crossed: u32,
    /// By layer: index of the first child of the open block.
    first: [u32; LAYERS],
}

impl Walk {
    /// Creates the state of a ray before its first step.
    #[inline(always)]
    pub(crate) const fn new(probe: RayProbe, limit: f32) -> Self {
        Self { probe, limit, open: 0, layer: 0, block: 0, crossed: 0, first: [0; LAYERS] }
    }
}

/// A list of ray indices, with spare capacity for writes past `len`.
#[derive(Clone, Copy)]
struct List {
    rays: [u8; 2 * RAYS],
    len: usize,
}

impl List {
    /// A list without rays.
    const EMPTY: Self = Self { rays: [0; 2 * RAYS], len: 0 };

    /// Appends a ray if `is_in`. Writes the ray past the end in either case, which needs no branch.
    #[inline(always)]
    fn push_if(&mut self, ray: u8, is_in: bool) {
        self.rays[self.len % (2 * RAYS)] = ray;
        self.len += usize::from(is_in);
    }

    /// Returns the ray indices in the list.
    fn rays(&self) -> &[u8] {
        &self.rays[..self.len]
    }
}

/// Keys of the children of a block, with the lane in the lowest four bits; `u32::MAX` for a child
/// that is visited or missed.
type LaneKeys = [u32; LANES];

/// The rays of one search. The rays in one list have the same next action: to open a block, to test
/// the triangles of a leaf block, or to return to an open block. A ray that has finished is in no
/// list.
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
    /// Reports to `visitor` each object whose triangle a ray may cross by its limit, for at most
    /// [`RAYS`] rays. `triangles[i]` has the triangles of leaf block `i`. The tree must not be
    /// empty.
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

    /// Advances the rays until every list is empty.
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

    /// Opens the next block of each ray in `to_open`, repeatedly, until every ray is at a leaf or
    /// has no child to visit.
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
                // If a second lane is entered, the ray returns to this block later.
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

    /// Tests the triangles of the leaf block of each ray in `at_leaf`.
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
    /// Moves each ray in `to_return` to the nearest unvisited child of its lowest open block, if
    /// that child is within the ray's limit. Otherwise closes the block, and the ray looks for
    /// another open block in the next round.
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
            // The key `u32::MAX` becomes NaN, so the comparison is false.
            let is_within = f32::from_bits(least - lane) <= walk.limit;
            walk.open &= !(u32::from(!is_within) << layer);
            (walk.block, walk.layer) = (walk.first[layer] + lane, layer.wrapping_sub(1));
            self.to_open.push_if(ray, is_within & (layer > 1));
            self.at_leaf.push_if(ray, is_within & (layer == 1));
            self.to_return.push_if(ray, !is_within & (walk.open != 0));
        }
    }
}
