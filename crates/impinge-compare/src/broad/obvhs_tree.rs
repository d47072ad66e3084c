//! obvhs, used as in its example of a broad phase. A box that left its fat AABB gets a new one. If
//! there are few such boxes, their leaves are moved within the tree; otherwise the tree is rebuilt.
//! Then the tree is searched for the fat AABBs that overlap each new one. obvhs has no events. It
//! is 3D only: in 2D all boxes have the third coordinate zero.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::contender::{Contender, MARGIN, key};
use super::swarm::{Cell, Change};

/// A tree of obvhs.
pub struct Obvhs {
    tree: Bvh2,
    builder: PlocBuilder,
    loosened: Vec<Aabb>,
    left: Vec<u32>,
    candidates: Vec<(u32, u32)>,
}

impl Obvhs {
    /// Builds a tree of the boxes.
    pub fn new<const D: usize>(cells: &[Cell<D>]) -> Self {
        let loosened: Vec<_> = cells.iter().map(|cell| aabb(cell, MARGIN)).collect();
        let mut obvhs = Self {
            tree: Bvh2::default(),
            builder: PlocBuilder::with_capacity(cells.len()),
            loosened,
            left: Vec::new(),
            candidates: Vec::new(),
        };
        obvhs.rebuild();
        obvhs
    }

    fn rebuild(&mut self) {
        let indices = (0..).take(self.loosened.len()).collect();
        let Self { tree, builder, loosened, .. } = self;
        let (distance, precision) = (PlocSearchDistance::VeryLow, SortPrecision::U64);
        builder.build_with_bvh(tree, distance, loosened, indices, precision, 0);
        tree.parents.clear();
        tree.primitives_to_nodes.clear();
    }

    fn repair(&mut self) {
        self.tree.init_parents_if_uninit();
        self.tree.init_primitives_to_nodes_if_uninit();
        for &n in &self.left {
            let node = self.tree.primitives_to_nodes[n as usize] as usize;
            self.tree.resize_node(node, self.loosened[n as usize]);
            self.tree.reinsert_node(node);
        }
    }

    fn ask(&self, n: u32, mut found: impl FnMut(u32)) {
        self.tree.aabb_traverse(self.loosened[n as usize], |tree, node| {
            let node = &tree.nodes[node as usize];
            let leaves = node.first_index..node.first_index + node.prim_count;
            leaves.for_each(|leaf| found(tree.primitive_indices[leaf as usize]));
            true
        });
    }
}

/// Converts a box, enlarged by `margin`; in 2D the third coordinate is zero.
pub fn aabb<const D: usize>(cell: &Cell<D>, margin: f32) -> Aabb {
    let corner = |x: [f32; D]| [0, 1, 2].map(|axis| x.get(axis).copied().unwrap_or(0.0));
    let mins = corner(cell.mins().map(|x| x - margin));
    Aabb::new(mins.into(), corner(cell.maxs().map(|x| x + margin)).into())
}

impl<const D: usize> Contender<D> for Obvhs {
    fn name(&self) -> &'static str {
        "obvhs (no events)"
    }

    fn step(&mut self, change: &Change<D>) {
        self.left.clear();
        self.candidates.clear();
        for (n, cell) in change.replaced.iter().chain(&change.moved) {
            let (exact, loosened) = (aabb(cell, 0.0), &mut self.loosened[*n as usize]);
            let is_within = exact.min.cmpge(loosened.min) & exact.max.cmple(loosened.max);
            if !is_within.all() {
                *loosened = aabb(cell, MARGIN);
                self.left.push(*n);
            }
        }
        if self.left.len() * 8 >= self.loosened.len() {
            self.rebuild();
        } else {
            self.repair();
        }
        let mut candidates = std::mem::take(&mut self.candidates);
        for &n in &self.left {
            self.ask(n, |other| candidates.push((n, other)));
        }
        self.candidates = candidates;
    }

    fn pairs(&mut self) -> Vec<u64> {
        let mut pairs = Vec::new();
        for n in (0..).take(self.loosened.len()) {
            self.ask(n, |other| {
                if other > n {
                    pairs.push(key(n, other))
                }
            });
        }
        pairs
    }
}
