//! Tests that a replay has the bits of the recorded world.

use impinge::world::{CollisionObject, CollisionWorld};
use impinge_record::{Header, Replay, validate};

use crate::scene::{Scene, Stage, words};

/// The text of the world after each update, and the recording.
struct Played {
    words: Vec<Vec<String>>,
    bytes: Vec<u8>,
}

fn play<N: Stage<D>, const D: usize>(mut scene: Scene<N, D>, steps: u32) -> Played {
    let mut all = Vec::new();
    for step in 0..steps {
        scene.step(step).expect("the calls are allowed");
        all.push(words(&scene.recorder));
    }
    assert!(scene.recorder.contact_views().count() > 3, "objects touch");
    assert!(scene.recorder.proximity_pairs().count() > 0, "objects are near");
    Played { words: all, bytes: scene.recorder.finish().bytes }
}

fn filled<N: Stage<D>, const D: usize>() -> Scene<N, D> {
    let mut scene = Scene::new();
    scene.fill().expect("the shapes can be written");
    scene
}

/// Seeks steps forwards and backwards, near and far. Asserts that the replay has the recorded text
/// after each and reports no divergence. `before` is the number of updates before the first text.
fn check<N: Stage<D>, const D: usize>(played: &Played, before: usize) {
    let registry = N::registry();
    assert_eq!(validate::<N, D, u32>(&played.bytes, &registry), Ok(None), "the same bits");
    let mut replay =
        Replay::<N, D, u32>::open(played.bytes.clone(), &registry).expect("a recording");
    assert_eq!(replay.len(), played.words.len() + before, "all updates");
    let last = played.words.len();
    for step in (1..=last).chain((1..last).rev()).chain([last, 2, last - 1, last - 2]) {
        replay.seek(step + before).expect("its calls can be applied");
        assert_eq!(replay.step(), step + before, "it is there");
        assert_eq!(words(replay.world()), played.words[step - 1], "after {step} updates");
        assert_eq!(replay.divergence(), None, "after {step} updates");
    }
    replay.seek(0).expect("the beginning");
    assert!(replay.world().is_empty(), "nothing was called yet");
}

fn in_every_way<N: Stage<D>, const D: usize>() {
    check::<N, D>(&play(filled::<N, D>(), 12), 0);
    check::<N, D>(&play(filled::<N, D>().with_key_frames(3), 12), 0);
    check::<N, D>(&play(filled::<N, D>().with_key_frames(1), 6), 0);
}

#[test]
fn every_shape_and_call_in_2d() {
    in_every_way::<f32, 2>();
    in_every_way::<f64, 2>();
}

#[test]
fn every_shape_and_call_in_3d() {
    in_every_way::<f32, 3>();
    in_every_way::<f64, 3>();
}

/// Returns a world with a history: objects were removed in another order than that of their
/// handles.
fn old_world<N: Stage<D>, const D: usize>() -> CollisionWorld<N, D, u32> {
    let mut scene = filled::<N, D>();
    (0..5).for_each(|step| scene.step(step).expect("the calls are allowed"));
    let mut world = scene.recorder.finish().world;
    let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
    world.remove(&[handles[7], handles[2], handles[4]]);
    world
}

fn from_the_middle<N: Stage<D>, const D: usize>() {
    let world = old_world::<N, D>();
    assert!(world.vacant_indices().count() >= 3, "indices are taken again");
    check::<N, D>(&play(Scene::of_world(world), 10), 1);
    let scene = Scene::of_world(old_world::<N, D>());
    check::<N, D>(&play(scene.with_key_frames(4), 10), 1);
}

#[test]
fn a_world_that_has_objects() {
    from_the_middle::<f32, 2>();
    from_the_middle::<f64, 3>();
}

#[test]
fn events_do_not_depend_on_key_frames() {
    let events = |played: &Played| -> Vec<Vec<String>> {
        let is_event = |word: &&String| word.starts_with("Some");
        let of = |words: &Vec<String>| words.iter().filter(is_event).cloned().collect();
        played.words.iter().map(of).collect()
    };
    let plain = play(filled::<f64, 3>(), 10);
    let framed = play(filled::<f64, 3>().with_key_frames(2), 10);
    assert!(events(&plain).iter().flatten().count() > 10, "there are events");
    assert_eq!(events(&plain), events(&framed), "an exchange of phases starts nothing");
}

#[test]
fn the_header_says_what_it_is() {
    let bytes = Scene::<f64, 2>::new().recorder.finish().bytes;
    let header = Header::read(&bytes).expect("a header");
    assert_eq!((header.version, header.scalar_bytes, header.dimension), (3, 8, 2));
    assert!(header.writer.starts_with("impinge "), "{header:?}");
}
