//! Tests upper bounds of the memory that a world uses for each object at rest, and of the memory
//! that clones and marks allocate.

use crate::support::world_stage;

use allocation_counter::measure;
use impinge::math::Space;
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::world::{CollisionGroups, CollisionWorld};
use world_stage::{Stage, ball};

/// Number of steps after which every object is at rest and spare memory has been released.
const ASLEEP: u32 = 300;
/// Bytes allowed for a world in addition to the memory of its objects.
const WORLD: usize = 200_000;

struct Grid<N: Space<D>, const D: usize> {
    world: CollisionWorld<N, D, ()>,
    handles: Vec<CollisionObjectHandle>,
}

/// Returns the position of object `index` of `count`, on a grid with this spacing.
fn place<const D: usize>(index: usize, count: usize, spacing: f64) -> [f64; D] {
    let volume = |row: usize| row.pow(u32::try_from(D).expect("2 or 3"));
    let row = (1..).find(|&row| volume(row) >= count).expect("some row is long enough");
    let mut rest = index;
    core::array::from_fn(|_| {
        let at = rest % row;
        rest /= row;
        at as f64 * spacing
    })
}

impl<N: Stage<D>, const D: usize> Grid<N, D> {
    /// Creates a world of `count` balls of diameter 1, which share their shape.
    fn new(count: usize, spacing: f64) -> Self {
        let (mut world, shape) = (CollisionWorld::new(N::lit(0.02)), ball::<N, D>(0.5));
        let query = GeometricQueryType::Contacts(N::lit(0.01), N::ZERO);
        let mut handles = Vec::with_capacity(count);
        for index in 0..count {
            let at = N::at(place(index, count, spacing));
            handles.push(world.add(at, shape.clone(), CollisionGroups::new(), query, ()));
        }
        Self { world, handles }
    }

    fn rest(&mut self) {
        (0..ASLEEP).for_each(|_| self.world.update());
    }
}

/// Returns the bytes for each object of the grid that `make` returns. Excludes the list of handles,
/// which only the test needs, and up to [`WORLD`] bytes of the world itself.
fn bytes_each<N: Stage<D>, const D: usize>(count: usize, make: impl FnOnce() -> Grid<N, D>) -> f64 {
    let mut kept = None;
    let used = measure(|| kept = Some(make()));
    let used = usize::try_from(used.bytes_current).expect("more was taken than given back");
    let handles = kept.map_or(0, |grid| size_of_val(&grid.handles[..]));
    (used - handles - WORLD.min(used - handles)) as f64 / count as f64
}

/// Asserts a bound of the bytes for each object that rests and never had pairs. With a spacing of
/// 1.5, balls of diameter 1 are disjoint.
fn sleeps_in<N: Stage<D>, const D: usize>(bound: f64) {
    let count = 20_000;
    let fresh = bytes_each(count, || {
        let mut grid = Grid::<N, D>::new(count, 1.5);
        grid.rest();
        assert_eq!(grid.world.contact_pairs().count(), 0, "all are apart");
        grid
    });
    assert!(fresh <= bound, "{fresh} bytes for an object that sleeps, {bound} are allowed");
}

/// In 3D with `f32` an object takes 96 bytes for its record (pose 28, shape 16 and its numbers 12,
/// query 8, groups 12, handles 16, state 4), 48 for its exact and its loosened box, 24 for its box
/// in the tree, and about 45 for the indices that link these. An eighth is added for growth.
#[test]
fn an_object_that_sleeps_takes_256_bytes() {
    sleeps_in::<f32, 3>(256.0);
    sleeps_in::<f32, 2>(220.0);
    sleeps_in::<f64, 3>(340.0);
    sleeps_in::<f64, 2>(280.0);
}

#[test]
fn a_quiet_step_takes_no_memory() {
    for spacing in [1.0, 1.5] {
        let mut grid = Grid::<f64, 3>::new(3000, spacing);
        grid.rest();
        // Within these 128 steps the world checks twice whether it can release memory.
        let used = measure(|| (0..128).for_each(|_| grid.world.update()));
        assert_eq!(used.count_total, 0, "spacing {spacing}: {used:?}");
    }
}

/// Asserts bounds of the allocations of a clone: 8 blocks and 8192 bytes without objects, 70 blocks
/// with 1000 balls. Empty groups of pairs and scratch lists, if copied, would exceed them.
/// `clone_from` into an equal world must allocate nothing.
#[test]
fn a_clone_of_a_small_world_takes_few_blocks_of_memory() {
    let clone = |count| {
        let grid = Grid::<f64, 3>::new(count, 0.95);
        let mut world = grid.world;
        (0..2).for_each(|_| world.update());
        let mut clone = None;
        let used = measure(|| clone = Some(world.clone()));
        let again = measure(|| clone.as_mut().expect("just made").clone_from(&world));
        (used.count_total, used.bytes_total, again.count_total)
    };
    let [(blocks, bytes, again), (blocks1000, _, again1000)] = [0, 1000].map(clone);
    assert!(blocks <= 8 && bytes <= 8192 && again == 0, "{blocks} blocks, {bytes} bytes, {again}");
    assert!(blocks1000 <= 70 && again1000 == 0, "{blocks1000} blocks, {again1000} again");
}

/// Returns the bytes allocated by 16 steps, each of which makes a mark and moves one ball, and by
/// rewinding the last eight of them. Before, 32 such steps let all buffers grow.
fn marked_steps<const D: usize>(count: usize, spacing: f64) -> [u64; 2]
where
    f32: Stage<D>,
{
    let mut grid = Grid::<f32, D>::new(count, spacing);
    grid.rest();
    let mut marks = Vec::with_capacity(64);
    let mut step = |grid: &mut Grid<f32, D>| {
        marks.push(grid.world.mark());
        let mut at = [0.0; D];
        at[0] = if marks.len() % 2 == 0 { 0.0 } else { 0.04 };
        grid.world.set_position(grid.handles[0], f32::at(at));
        grid.world.update();
    };
    (0..32).for_each(|_| step(&mut grid));
    let steps = measure(|| (0..16).for_each(|_| step(&mut grid)));
    let back = measure(|| grid.world.rewind(marks[marks.len() - 8]));
    [steps.bytes_total, back.bytes_total]
}

/// Asserts that marks and rewinds allocate equally many bytes with few and with thousands of
/// objects at rest. Balls at the smaller spacing have pairs, at the larger spacing none.
#[test]
fn marks_and_rewinds_take_memory_for_changes_alone() {
    for spacing in [0.95, 1.5] {
        let [small, large] = [27, 8000].map(|count| marked_steps::<3>(count, spacing));
        assert_eq!(small, large, "spacing {spacing}: bytes of steps and of going back");
        assert!(small[0] <= 16 * 4096, "spacing {spacing}: {small:?}");
        let [small, large] = [25, 8100].map(|count| marked_steps::<2>(count, spacing));
        assert_eq!(small, large, "spacing {spacing}: bytes of steps and of going back");
    }
}
