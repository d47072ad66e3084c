//! The tree of the boxes of dirty objects, for queries before the next update.
//!
//! The tree is built at once, in an order that makes searches fast, and then updated box by box:
//! each change costs the path from a leaf block to the root. Changes degrade the order: after
//! `max(32, n / 4)` changes, a tree of `n` boxes is dropped, and the next query builds a new one.
//! So a change costs amortised O(log n), whether queries come after each change or after many. A
//! search costs about as much as a search of the broad phase, plus the test of one block of 16
//! boxes for every 16 boxes that were added since the tree was built.
//!
//! Searching two trees costs more than searching one tree of all boxes. If at least a quarter of
//! the objects are dirty, this tree also has the boxes of all other objects (`has_all`), and
//! queries skip the broad phase.

use super::bodies::WorldBody;
use crate::bounding_volume::Aabb;
use crate::bvh::{Bounds, Lanes, Tree};
use crate::math::{Real, Space};
use crate::partitioning::{Search, Sweep, packed};

/// Minimum number of changes after which a tree is dropped.
const MIN_CHANGES: usize = 32;
/// A tree of `n` boxes is dropped after `n / CHANGES_DIVISOR` changes, if that is more than
/// [`MIN_CHANGES`].
const CHANGES_DIVISOR: usize = 4;

/// A tree of boxes with ids. The ids are handle indices if the tree has the boxes of all objects,
/// else indices in the list of changes.
#[derive(Clone, Debug)]
pub(crate) struct DirtyTree<const D: usize> {
    has_all: bool,
    tree: Tree<D>,
    /// Ids of boxes that no finite `f32` box encloses.
    unbounded: Vec<u32>,
    lanes: Lanes,
    /// Number of changes until the tree should be dropped.
    changes_left: usize,
}

/// Receives a group of ids, each with a lower bound of its key (a time or a distance). Returns the
/// new limit: the search skips boxes whose keys exceed it.
pub(crate) type DirtyVisitor<'a, N> = dyn FnMut(&[(u32, N)]) -> N + 'a;

impl<const D: usize> DirtyTree<D> {
    /// Builds a tree from boxes with distinct ids. `has_all` is `true` if they are the boxes of all
    /// objects.
    pub(crate) fn new<N: Real>(
        has_all: bool,
        boxes: &mut dyn Iterator<Item = (u32, Aabb<N, D>)>,
    ) -> Self {
        let lanes = Lanes::detect();
        let (tree, unbounded) = packed(lanes, boxes);
        let changes_left = MIN_CHANGES.max(tree.len() / CHANGES_DIVISOR);
        Self { has_all, tree, unbounded, lanes, changes_left }
    }

    /// Returns `true` if the tree also has the boxes of the objects that are not dirty; its ids are
    /// then handle indices.
    #[inline]
    pub(crate) const fn has_all(&self) -> bool {
        self.has_all
    }

    /// Returns `true` if the tree has had so many changes that it should be dropped.
    pub(crate) const fn needs_rebuild(&self) -> bool {
        self.changes_left == 0
    }

    /// Returns the id that the object has in the tree if the tree contains it; `None` for an object
    /// that certainly is not in the tree.
    pub(crate) fn id_of<N: Space<D>>(&self, body: &WorldBody<N, D>) -> Option<u32> {
        if self.has_all { Some(body.index()) } else { body.change_index() }
    }

    /// Inserts or replaces the box with this id, and counts the change towards the next rebuild.
    pub(crate) fn put<N: Real>(&mut self, id: u32, aabb: &Aabb<N, D>) {
        let bounds = Bounds::enclosing(aabb);
        if !self.tree.contains(id) || !bounds.is_finite() {
            self.take(id);
        }
        if bounds.is_finite() {
            self.tree.put(id, &bounds);
        } else {
            self.unbounded.push(id);
        }
        self.changes_left = self.changes_left.saturating_sub(1);
    }

    /// Removes the box with this id; does nothing if there is none.
    pub(crate) fn take(&mut self, id: u32) {
        if self.tree.contains(id) {
            self.tree.remove(id);
        } else {
            self.unbounded.retain(|&other| other != id);
        }
    }

    /// Calls `found` with groups of ids whose boxes the moving box may touch by the time `limit`,
    /// each with a lower bound of the time of contact.
    pub(crate) fn by_time<N: Real>(
        &self,
        sweep: &Sweep<N, D>,
        limit: N,
        found: &mut DirtyVisitor<'_, N>,
    ) {
        self.search().groups_by_time(sweep, limit, found);
    }

    /// Calls `found` with groups of ids whose boxes may be at most `limit` from `aabb`, each with a
    /// lower bound of the distance.
    pub(crate) fn by_distance<N: Real>(
        &self,
        aabb: &Aabb<N, D>,
        limit: N,
        found: &mut DirtyVisitor<'_, N>,
    ) {
        self.search().groups_by_distance(aabb, limit, found);
    }

    /// Checks the invariants of the tree, and that it has exactly these boxes; the error describes
    /// the violation.
    pub(crate) fn validate<N: Real>(
        &self,
        boxes: &mut dyn Iterator<Item = (u32, Aabb<N, D>)>,
    ) -> Result<(), String> {
        self.tree.validate()?;
        let mut count = 0;
        for (id, aabb) in boxes {
            let (bounds, kept) = (Bounds::enclosing(&aabb), self.tree.bounds(id));
            let is_listed = self.unbounded.contains(&id);
            if kept != Some(bounds).filter(Bounds::is_finite) || is_listed == bounds.is_finite() {
                return Err(format!("the tree of dirty objects has {kept:?} for {id}: {aabb:?}"));
            }
            count += 1;
        }
        let kept = self.tree.len() + self.unbounded.len();
        (kept == count).then_some(()).ok_or(format!("{kept} dirty boxes are kept of {count}"))
    }

    /// Returns a search over the `f32` boxes of the tree, without exact boxes.
    fn search<N: Real>(&self) -> Search<'_, N, D, 1> {
        let trees = [&self.tree];
        Search { exact: &[], trees, unbounded: &self.unbounded, lanes: self.lanes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::Block;
    use crate::dim2::math::{Isometry, Point, Vector};
    use crate::dim2::query::Ray;
    use crate::dim2::shape::{Ball, HalfSpace, ShapeHandle};
    use crate::dim2::world::{
        CollisionGroups, CollisionObject, CollisionWorld, GeometricQueryType, QueryFilter,
    };

    type Box2 = Aabb<f32, 2>;
    type World = CollisionWorld<f32, ()>;

    /// Returns a pseudorandom number from 0 to `bound - 1`.
    fn below(state: &mut u64, bound: u16) -> u16 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040);
        u16::try_from((*state >> 33) % u64::from(bound)).expect("below a u16")
    }

    fn square(state: &mut u64, side: u16) -> Box2 {
        Aabb::from_half_extents(random_point(state, side).into(), Vector::repeat(0.5))
    }

    fn random_point(state: &mut u64, side: u16) -> Vector<f32> {
        Vector::from([(); 2].map(|()| f32::from(below(state, side))))
    }

    /// Returns the number of blocks that a search for overlaps with `square` opens.
    fn opened(dirty: &DirtyTree<2>, square: &Box2) -> usize {
        let (mut count, still) = (0, Vector::zeros());
        let test = |block: &Block<2>| {
            count += 1;
            dirty.lanes.times_of_block(block, square, &still).0
        };
        dirty.tree.visit(test, |_| ());
        count
    }

    /// Adds `count` boxes one by one, then moves them one by one, with a search after each change.
    /// Returns the mean number of opened blocks per search while boxes are added, and while they
    /// are moved.
    fn opened_on_average(count: u16, state: &mut u64) -> [f64; 2] {
        let side = (1..256).find(|side| side * side > count).unwrap_or(256) - 1;
        let mut boxes: Vec<(u32, Box2)> = Vec::new();
        let mut dirty = DirtyTree::new::<f32>(false, &mut boxes.iter().copied());
        [0, count].map(|first| {
            let mut all = 0;
            for change in first..first + count {
                let (id, aabb) = (u32::from(change % count), square(state, side));
                boxes.retain(|&(other, _)| other != id);
                boxes.push((id, aabb));
                dirty.put(id, &aabb);
                if dirty.needs_rebuild() {
                    dirty = DirtyTree::new(false, &mut boxes.iter().copied());
                }
                all += opened(&dirty, &square(state, side));
            }
            assert_eq!(dirty.validate(&mut boxes.iter().copied()), Ok(()), "{count} boxes");
            f64::from(u32::try_from(all).expect("few")) / f64::from(count)
        })
    }

    #[test]
    fn searches_among_many_changes_look_at_few_blocks() {
        let [[few_new, few], [many_new, many]] =
            [512, 8192].map(|count| opened_on_average(count, &mut 9));
        // Boxes that were added since the tree was built fill blocks in order of insertion, and a
        // search cannot skip these blocks. On average an eighth of all boxes are in them.
        let unsorted = |count: f64| count / 8.0 / 16.0;
        for (count, opened) in [(512.0, few_new), (8192.0, many_new)] {
            assert!(opened < 8.0 + unsorted(count), "{opened} blocks of {count} boxes");
        }
        assert!(
            many < 8.0 + unsorted(8192.0),
            "{many} blocks where {few} would do for a sixteenth"
        );
    }

    fn add(world: &mut World, shape: &ShapeHandle<f32>, position: Isometry<f32>) {
        let (groups, query) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.01, 0.0));
        world.add(position, shape.clone(), groups, query, ());
    }

    fn change_one(world: &mut World, state: &mut u64) {
        let ball = ShapeHandle::new(Ball::new(0.5));
        let floor = ShapeHandle::new(HalfSpace::new(Vector::y_axis()));
        let handles: Vec<_> = world.objects.iter().map(CollisionObject::handle).collect();
        let handle = handles[usize::from(below(state, 30_000)) % handles.len()];
        let position = Isometry::from(random_point(state, 30));
        match below(state, 120) {
            0 => world.update(),
            1..20 => world.remove(&[handle]),
            20..39 => add(world, &ball, position),
            39..42 => world.set_shape(handle, floor),
            42..52 => world.set_shape(handle, ball),
            52..56 => world.set_collision_groups(handle, CollisionGroups::new()),
            _ => world.set_position(handle, position),
        }
    }

    #[test]
    fn the_tree_of_a_world_follows_every_change() {
        let (mut world, state) = (World::new(0.1), &mut 7);
        let ball = ShapeHandle::new(Ball::new(0.5));
        (0..200).for_each(|_| add(&mut world, &ball, Isometry::from(random_point(state, 30))));
        let (mut trees, mut made) = ([0, 0], 0);
        for change in 0..4000 {
            change_one(&mut world, state);
            let kept = world.objects.changes.existing_dirty_tree().map(DirtyTree::has_all);
            if change % 3 == 0 {
                let ray = Ray::new(Point::origin(), Vector::repeat(1.0));
                let _ = world.first_ray_hit(&ray, 0.0, true, &QueryFilter::new());
                made += usize::from(kept.is_none());
            }
            kept.into_iter().for_each(|has_all| trees[usize::from(has_all)] += 1);
            assert_eq!(world.objects.validate(&*world.broad_phase), Ok(()), "change {change}");
            assert!(
                world.objects.changes.len() <= world.len(),
                "one entry for each object at most"
            );
        }
        assert!(trees[0] > 500 && trees[1] > 500, "some of both kinds: {trees:?}");
        assert!(made > 60, "given up by updates and by wear: {made}");
    }
}
