//! The trees of rstar and bvh, rebuilt at each step. The tree of rstar is intersected with itself,
//! the tree of bvh is searched for every box. Both return all pairs of exact boxes, not of enlarged
//! ones, and have no events.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use impinge::math::na::Point;
use rstar::{AABB, RTree, RTreeObject};

use super::contender::{Contender, key};
use super::swarm::{Cell, Change};

/// A box with its index.
#[derive(Clone, Copy, Debug)]
pub struct Leaf<const D: usize> {
    number: u32,
    node: usize,
    cell: Cell<D>,
}

/// Returns the boxes with their indices.
pub fn leaves<const D: usize>(cells: &[Cell<D>]) -> Vec<Leaf<D>> {
    (0..).zip(cells).map(|(number, cell)| Leaf { number, node: 0, cell: *cell }).collect()
}

impl<const D: usize> Leaf<D> {
    /// Returns the index of the box.
    pub fn number(&self) -> u32 {
        self.number
    }
}

impl<const D: usize> Bounded<f32, D> for Leaf<D> {
    fn aabb(&self) -> Aabb<f32, D> {
        Aabb::with_bounds(Point::from(self.cell.mins()), Point::from(self.cell.maxs()))
    }
}

impl<const D: usize> BHShape<f32, D> for Leaf<D> {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl<const D: usize> RTreeObject for Leaf<D> {
    type Envelope = AABB<[f32; D]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.cell.mins(), self.cell.maxs())
    }
}

/// A contender that rebuilds the tree of rstar or of bvh at each step.
pub struct Rebuilt<const D: usize> {
    name: &'static str,
    find: fn(&mut Vec<Leaf<D>>, &mut Vec<(u32, u32)>),
    leaves: Vec<Leaf<D>>,
    found: Vec<(u32, u32)>,
}

impl<const D: usize> Rebuilt<D> {
    /// Creates the contender that uses rstar.
    pub fn rstar(cells: &[Cell<D>]) -> Self {
        Self { name: "rstar (rebuilt)", find: by_rstar, leaves: leaves(cells), found: Vec::new() }
    }

    /// Creates the contender that uses bvh.
    pub fn bvh(cells: &[Cell<D>]) -> Self {
        Self { name: "bvh (rebuilt)", find: by_bvh, leaves: leaves(cells), found: Vec::new() }
    }
}

fn by_rstar<const D: usize>(leaves: &mut Vec<Leaf<D>>, found: &mut Vec<(u32, u32)>) {
    let tree = RTree::bulk_load(leaves.clone());
    let pairs = tree.intersection_candidates_with_other_tree(&tree);
    let pairs = pairs.map(|(a, b)| (a.number, b.number));
    found.extend(pairs.filter(|(a, b)| a < b));
}

fn by_bvh<const D: usize>(leaves: &mut Vec<Leaf<D>>, found: &mut Vec<(u32, u32)>) {
    let tree = Bvh::build(leaves);
    for leaf in &*leaves {
        let query = leaf.aabb();
        // The traversal also returns leaves whose boxes do not overlap the query.
        let met = tree
            .traverse_iterator(&query, leaves)
            .filter(|other| other.number > leaf.number && other.aabb().intersects_aabb(&query));
        found.extend(met.map(|other| (leaf.number, other.number)));
    }
}

impl<const D: usize> Contender<D> for Rebuilt<D> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn step(&mut self, change: &Change<D>) {
        for (n, cell) in change.replaced.iter().chain(&change.moved) {
            self.leaves[*n as usize].cell = *cell;
        }
        self.found.clear();
        (self.find)(&mut self.leaves, &mut self.found);
    }

    fn pairs(&mut self) -> Vec<u64> {
        self.found.iter().map(|(a, b)| key(*a, *b)).collect()
    }
}
