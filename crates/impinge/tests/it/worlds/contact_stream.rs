//! Tests contact streams. The index of each contact in the points of the previous fill is compared
//! with a map from contact ids to indices.

use crate::support::{scene_stage, world_stage};

use std::collections::BTreeMap;

use impinge::math::{Point, Space};
use impinge::narrow_phase::ContactStream;
use impinge::query::ContactId;
use impinge::shape::{Polyline, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_scenes::{Scene, mixed_shapes, pile, shaken, spawn_and_despawn};

use scene_stage::{Play, Player, assert_stream_agrees};
use world_stage::{Stage, add, contacts, cube};

/// A stream, and for each contact of the last fill the index to which its point in the next fill
/// must refer.
struct Checked<N: Space<D>, const D: usize> {
    stream: ContactStream<N, D>,
    /// The index of each contact in the points of the last fill.
    indices: BTreeMap<ContactId, usize>,
    /// Number of contacts that the previous fill had too, summed over all fills.
    kept: usize,
    /// Number of contacts that the previous fill did not have, summed over all fills.
    new: usize,
}

impl<N: Space<D>, const D: usize> Checked<N, D> {
    fn new() -> Self {
        Self { stream: ContactStream::new(), indices: BTreeMap::new(), kept: 0, new: 0 }
    }

    /// Fills the stream. Asserts that it has the contacts of the world, and that each point refers
    /// to the index that its id had in the previous fill.
    fn fill<T>(&mut self, world: &CollisionWorld<N, D, T>) {
        world.read_contacts(&mut self.stream);
        assert_stream_agrees(world, &self.stream);
        let mut indices = BTreeMap::new();
        for manifold in self.stream.manifolds() {
            for index in manifold.range() {
                let point = &self.stream.points()[index];
                let id = manifold.id(point);
                assert_eq!(point.previous(), self.indices.get(&id).copied(), "of {id:?}");
                assert_eq!(indices.insert(id, index), None, "{id:?} occurs once");
                *if point.previous().is_some() { &mut self.kept } else { &mut self.new } += 1;
            }
        }
        self.indices = indices;
    }
}

/// Returns a pile of `count` boxes that is shaken, so that contacts begin and end at each step.
fn shaken_pile<const D: usize>(count: usize) -> Scene<D> {
    shaken(pile(count), 0.25)
}

fn follows_scenes<N: Play<D>, const D: usize>() {
    let scenes: [fn(usize) -> Scene<D>; 4] = [pile, shaken_pile, mixed_shapes, spawn_and_despawn];
    for (number, make) in scenes.into_iter().enumerate() {
        let (mut player, mut checked) = (Player::<N, D>::new(make(150), 1.0), Checked::new());
        for step in 0..12 {
            player.step();
            // Skips the fill after every fifth update, so that the previous fill is sometimes two
            // updates old.
            if step % 5 != 3 {
                checked.fill(&player.world);
            }
        }
        let Checked { kept, new, .. } = checked;
        assert!(kept > 0 && new > 0, "scene {number}: {kept} kept, {new} new");
    }
}

/// Tests a row of boxes. Many boxes are removed at once, so that the remaining pairs move into the
/// memory of the removed pairs.
fn finds_pairs_that_moved_in_memory<N: Stage<D>, const D: usize>() {
    let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.01));
    let mut handles: Vec<_> =
        (0..200).map(|n| add(&mut world, f64::from(n), &cube(0.5), contacts(0.125))).collect();
    let mut checked = Checked::new();
    world.update();
    checked.fill(&world);
    let all = checked.new;
    assert!(all >= 199, "each box touches the next");
    // Removes 60 consecutive boxes, which is more than the window in which the stream searches, and
    // two single boxes.
    world.remove(&handles.drain(20..80).collect::<Vec<_>>());
    world.remove(&[handles.remove(3), handles.remove(90)]);
    checked.fill(&world);
    world.update();
    checked.fill(&world);
    assert_eq!(checked.new, all, "no contact is new: the others only moved in memory");
    // Moves all boxes apart, so that no contact is left, and then back, so that all contacts are
    // new.
    let far = add(&mut world, 300.0, &cube(0.5), contacts(0.125));
    for (n, handle) in handles.iter().enumerate() {
        world.set_position(*handle, N::on_x(2.0 * n as f64));
    }
    world.update();
    checked.fill(&world);
    assert!(checked.stream.points().is_empty() && world.contains(far), "all are apart");
    for (n, handle) in handles.iter().enumerate() {
        world.set_position(*handle, N::on_x(n as f64));
    }
    world.update();
    let kept = checked.kept;
    checked.fill(&world);
    assert_eq!(checked.kept, kept, "a contact that comes back is new");
    checked.stream.clear();
    assert!(checked.stream.points().is_empty() && checked.stream.manifolds().is_empty(), "cleared");
    checked.indices.clear();
    checked.fill(&world);
    assert_eq!(checked.kept, kept, "nothing is known after clearing");
}

/// Fills a stream after each step of a box that slides over a zigzag, with a skin in the second
/// half. Asserts that the pair has several manifolds in at least one fill.
fn follows_patches<N: Stage<D>, const D: usize>(zigzag: ShapeHandle<N, D>) {
    let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.01));
    add(&mut world, 0.0, &zigzag, contacts(0.0));
    let solid = add(&mut world, 0.0, &cube(2.25), contacts(0.0));
    let mut checked = Checked::new();
    let mut most = 0;
    for step in 0..24 {
        let mut at = [0.0; D];
        (at[0], at[1]) = (f64::from(step) * 0.125, 2.125);
        world.set_position(solid, N::at(at));
        world.set_skin(solid, N::lit(if step < 12 { 0.0 } else { 0.0625 }));
        world.update();
        checked.fill(&world);
        most = most.max(checked.stream.manifolds().len());
    }
    assert!(most > 1, "several manifolds: {most}");
    assert!(checked.kept > checked.new, "{} kept, {} new", checked.kept, checked.new);
}

#[test]
fn patches_2d() {
    fn zigzag<N: Space<2>>() -> ShapeHandle<N, 2> {
        let point = |n: i32| [f64::from(n) * 0.5, if n % 2 == 0 { 0.0 } else { 0.125 }];
        let points = (-20..=20).map(|n| Point::from(point(n).map(N::lit)));
        ShapeHandle::new(Polyline::open(points.collect()))
    }
    follows_patches::<f32, 2>(zigzag());
    follows_patches::<f64, 2>(zigzag());
}

#[test]
fn patches_3d() {
    fn zigzag<N: Space<3>>() -> ShapeHandle<N, 3> {
        let point = |n: u32| {
            let [i, k] = [n % 41, n / 41].map(f64::from);
            [i * 0.5 - 10.0, if (n % 41).is_multiple_of(2) { 0.0 } else { 0.125 }, k * 10.0 - 5.0]
        };
        let points = (0..82).map(|n| Point::from(point(n).map(N::lit)));
        let cells = (0..40).flat_map(|n| [[n, n + 41, n + 42], [n, n + 42, n + 1]]);
        ShapeHandle::new(TriMesh::new(points.collect(), cells.collect()))
    }
    follows_patches::<f32, 3>(zigzag());
    follows_patches::<f64, 3>(zigzag());
}

/// Tests that a removed object is in no stream, even before the next update, and that an object
/// that reuses its index is not in the stream either.
fn skips_removed_objects<N: Stage<D>, const D: usize>() {
    let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.01));
    let handles = [0.0, 0.75].map(|x| add(&mut world, x, &cube(0.5), contacts(0.0)));
    world.update();
    let mut stream = ContactStream::new();
    world.read_contacts(&mut stream);
    assert_eq!(stream.manifolds().len(), 1, "they overlap");
    let manifold = &stream.manifolds()[0];
    assert_eq!([manifold.object1, manifold.object2], handles, "in the order of handles");
    world.remove(&handles[..1]);
    world.add(N::on_x(0.0), cube(0.5), CollisionGroups::new(), contacts(0.0), ());
    world.read_contacts(&mut stream);
    assert_eq!(stream.manifolds().len(), 0, "the new object has no contact before an update");
}

in_tests!(follows_scenes, finds_pairs_that_moved_in_memory, skips_removed_objects);
