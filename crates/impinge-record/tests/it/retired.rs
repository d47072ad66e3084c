//! Tests of worlds whose indices are retired: 2^16 objects had them.

use std::num::NonZeroU64;

use impinge::dim2::math::Isometry;
use impinge::dim2::shape::{Ball, ShapeHandle};
use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge_record::{Problem, Recorder, Registry, Replay, reseal, validate};

type World = CollisionWorld<f32, ()>;

const QUERY: GeometricQueryType<f32> = GeometricQueryType::Contacts(0.0, 0.0);

fn ball() -> ShapeHandle<f32> {
    ShapeHandle::new(Ball::new(1.0))
}

fn add(world: &mut World) -> CollisionObjectHandle {
    world.add(Isometry::identity(), ball(), CollisionGroups::new(), QUERY, ())
}

/// Returns a world whose only object is the last one of index 0.
fn worn() -> (World, CollisionObjectHandle) {
    let mut world = World::new(0.02);
    let mut last = add(&mut world);
    for _ in 0..u16::MAX {
        world.remove(&[last]);
        last = add(&mut world);
    }
    assert_eq!(last.uid(), 0, "the index is used again");
    (world, last)
}

/// Adds two objects and removes them, twice, with updates. Returns the recording, and the indices
/// of the objects after each update.
fn recorded(world: World, key_frames: u64) -> (Vec<u8>, Vec<Vec<usize>>) {
    let recorder = Recorder::of_world(world, 0.02, Registry::new()).expect("it can be recorded");
    let every = NonZeroU64::new(key_frames).expect("not zero");
    let mut recorder = recorder.with_key_frames(every);
    let indices = |world: &World| world.collision_objects().map(|one| one.handle().uid()).collect();
    let mut all = vec![indices(&recorder)];
    for _ in 0..2 {
        let added = [(); 2].map(|()| {
            let groups = CollisionGroups::new();
            recorder.add(Isometry::identity(), ball(), groups, QUERY, ()).expect("usable")
        });
        recorder.update();
        all.push(indices(&recorder));
        added.iter().for_each(|one| recorder.remove(&[*one]).expect("alive"));
        recorder.update();
        all.push(indices(&recorder));
    }
    (recorder.finish().bytes, all)
}

fn check(world: &World, added: [usize; 2], case: &str) {
    for key_frames in [1, 2, 100] {
        let (bytes, all) = recorded(world.clone(), key_frames);
        assert!(added.iter().all(|index| all[1].contains(index)), "{case}: {all:?}");
        let registry = Registry::<f32, 2, ()>::new();
        assert_eq!(validate(&bytes, &registry), Ok(None), "{case}");
        let mut replay = Replay::open(bytes, &registry).expect("a recording");
        let last = all.len();
        for step in (1..=last).chain((1..last).rev()).chain([last]) {
            replay.seek(step).unwrap_or_else(|error| panic!("{case}, step {step}: {error}"));
            let objects = replay.world().collision_objects();
            assert!(objects.map(|one| one.handle().uid()).eq(all[step - 1].clone()), "{case}");
            assert_eq!(replay.divergence(), None, "{case}");
        }
    }
}

#[test]
fn retired_indices_are_not_used_in_a_replay() {
    let (mut world, last) = worn();
    let mut free = world.clone();
    free.remove(&[last]);
    check(&free, [1, 2], "the only index is retired");

    let [one, two, _] = [(); 3].map(|()| add(&mut world));
    let mut between = world.clone();
    between.remove(&[last]);
    check(&between, [4, 5], "it is before the others");
    between.remove(&[one, two]);
    check(&between, [1, 2], "it is beside free ones");
}

#[test]
fn an_index_that_retires_while_it_is_recorded() {
    let (mut world, last) = worn();
    let other = add(&mut world);
    let mut recorder = Recorder::of_world(world, 0.02, Registry::new()).expect("a world");
    let mut add = |remove: CollisionObjectHandle| {
        recorder.remove(&[remove]).expect("alive");
        let added = recorder.add(Isometry::identity(), ball(), CollisionGroups::new(), QUERY, ());
        recorder.update();
        added.expect("usable").uid()
    };
    assert_eq!([add(last), add(other)], [2, 1], "index 0 is not used again");
    let bytes = recorder.finish().bytes;
    assert_eq!(validate(&bytes, &Registry::<f32, 2, ()>::new()), Ok(None));
}

/// Asserts that a replay does not make room for any index that a recording contains.
#[test]
fn far_indices_are_refused() {
    let mut recorder = Recorder::<f32, 2, ()>::new(0.02, Registry::new()).expect("usable");
    let groups = CollisionGroups::new();
    recorder.add(Isometry::identity(), ball(), groups, QUERY, ()).expect("usable");
    recorder.update();
    let bytes = recorder.finish().bytes;
    // The record of the object begins with kind 2 and its length, and the index 0.
    let head = [2, 50, 0, 0, 0, 0, 0, 0, 0];
    let place = bytes.windows(9).position(|window| window == head).expect("an object is added");
    for index in [1025, u32::MAX] {
        let mut other = bytes.clone();
        other[place + 5..place + 9].copy_from_slice(&index.to_le_bytes());
        reseal(&mut other);
        let error = validate(&other, &Registry::<f32, 2, ()>::new()).expect_err("far");
        assert_eq!(error.problem, Problem::OtherIndex { recorded: index, replayed: 1024 });
    }
}
