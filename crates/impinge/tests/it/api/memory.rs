//! Tests upper bounds of the memory that a world uses for each object at rest.

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
/// which only the test needs.
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
