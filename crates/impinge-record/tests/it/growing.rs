//! Tests recordings that grow, recordings that end early, and their time lines.

use impinge::dim2::math::{Isometry, Point};
use impinge::dim2::shape::{Ball, Polyline, ShapeHandle};
use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionObject;
use impinge_record::{
    EventCounts, Mark, Problem, Query, Question, ReadError, Recorder, Registry, Replay, validate,
};

use crate::scene::{Scene, Stage, words};

fn scene() -> (Vec<u8>, Vec<Vec<String>>) {
    let mut scene = Scene::<f64, 2>::new().with_key_frames(3);
    scene.fill().expect("the shapes can be written");
    let mut all = Vec::new();
    for step in 0..8 {
        scene.step(step).expect("the calls are allowed");
        all.push(words(&scene.recorder));
    }
    (scene.recorder.finish().bytes, all)
}

#[test]
fn a_recording_grows_in_pieces_of_any_length() {
    let (bytes, all) = scene();
    let registry = <f64 as Stage<2>>::registry();
    for length in [1, 7, 1000] {
        let mut replay = Replay::growing(&registry);
        replay.seek(5).expect("there is no step yet");
        let mut updates = 0;
        for piece in bytes.chunks(length) {
            assert!(!replay.is_complete(), "bytes are missing");
            updates += replay.push(piece).expect("it is the recording");
            assert_eq!(replay.len(), updates, "each is counted once");
        }
        assert!(replay.is_complete() && updates == all.len(), "{updates}");
        replay.seek(updates).expect("its calls can be applied");
        assert_eq!((&words(replay.world()), replay.divergence()), (&all[7], None));
        let more = replay.push(&[0]).expect_err("nothing follows the end");
        assert_eq!(more, ReadError { offset: bytes.len(), problem: Problem::TrailingBytes });
    }
}

#[test]
fn growing_stops_at_damage_and_keeps_what_came() {
    let (mut bytes, _) = scene();
    let place = bytes.len() / 2;
    bytes[place] ^= 1;
    let mut replay = Replay::growing(&<f64 as Stage<2>>::registry());
    let errors: Vec<_> = bytes.chunks(100).filter_map(|piece| replay.push(piece).err()).collect();
    assert!(errors.len() > 3, "every later call: {}", errors.len());
    assert!(errors.iter().all(|error| *error == errors[0]), "the same error");
    let known = replay.len();
    assert!((1..8).contains(&known), "{known}");
    replay.seek(known).expect("its calls can be applied");
}

#[test]
fn every_truncation_can_be_salvaged() {
    let (bytes, all) = scene();
    let registry = <f64 as Stage<2>>::registry();
    let mut steps = 0;
    for length in (0..bytes.len()).step_by(97).chain([bytes.len() - 1]) {
        let Ok(mut replay) = Replay::salvage(&bytes[..length], &registry) else {
            assert!(length < 60, "{length} bytes have a header");
            continue;
        };
        let loss = replay.loss().expect("the end is missing").clone();
        assert_eq!((loss.offset, loss.offset + loss.bytes), (replay.bytes().len(), length));
        assert_eq!(loss.error.problem, Problem::Truncated, "{length}");
        assert!(!replay.is_complete() && replay.len() >= steps, "{length}");
        steps = replay.len();
        replay.seek(steps).expect("its calls can be applied");
        assert!(steps == 0 || words(replay.world()) == all[steps - 1], "{length}");
    }
    assert_eq!(steps, all.len(), "only the last record is missing");
}

#[test]
fn a_flipped_byte_is_where_the_salvaged_recording_ends() {
    let (bytes, _) = scene();
    let registry = <f64 as Stage<2>>::registry();
    let mut lengths = Vec::new();
    for place in (100..bytes.len()).step_by(301) {
        let mut other = bytes.clone();
        other[place] ^= 0x55;
        let replay = Replay::salvage(other, &registry).expect("the header is whole");
        let loss = replay.loss().expect("a byte is wrong");
        assert!(loss.offset <= place && loss.error.offset >= loss.offset, "{place}: {loss:?}");
        lengths.push(replay.len());
    }
    assert!(lengths.is_sorted() && lengths.last() > Some(&5), "{lengths:?}");
    let whole = Replay::salvage(bytes, &registry).expect("it is whole");
    assert!(whole.loss().is_none() && whole.is_complete());
}

type Balls = Recorder<f64, 2, u32>;

/// Records one update of two balls of radius 1 whose centres are 1.5 apart, and of a third ball
/// beside them, a sensor with the margin 1.
fn balls() -> Result<Balls, impinge_record::RecordError> {
    let mut recorder = Balls::new(0.02, Registry::new())?;
    let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    let kinds = [
        GeometricQueryType::Contacts(0.0, 0.0),
        GeometricQueryType::Contacts(0.0, 0.0),
        GeometricQueryType::Proximity(1.0),
    ];
    for ((x, kind), id) in [0.0, 1.5, 4.0].into_iter().zip(kinds).zip(0..) {
        recorder.add(Isometry::translation(x, 0.0), ball.clone(), groups, kind, id)?;
    }
    recorder.update();
    Ok(recorder)
}

#[test]
fn the_time_line_counts_calls_and_events() -> Result<(), impinge_record::RecordError> {
    let mut recorder = balls()?;
    let handles: Vec<_> = recorder.collision_objects().map(CollisionObject::handle).collect();
    recorder.set_position(handles[0], Isometry::translation(-3.0, 0.0))?;
    recorder.set_data(handles[1], 9)?;
    let query = Query::new(Question::Containing(Point::new(1.5, 0.0)));
    assert_eq!(recorder.ask(&query)?.len(), 1, "the second ball");
    assert_eq!(recorder.ask_where(&query, |object| *object.data() != 9)?.len(), 0);
    recorder.update();
    recorder.clear();
    recorder.update();
    let mut replay = Replay::open(recorder.finish().bytes, &Registry::<f64, 2, u32>::new())
        .expect("it was just written");
    let events =
        |started, stopped, proximities| Some(EventCounts { started, stopped, proximities });
    let marks = [
        Mark { added: 3, events: events(1, 0, 1), ..Mark::default() },
        Mark { moved: 1, changed: 1, queries: 2, events: events(0, 1, 0), ..Mark::default() },
        Mark { removed: 3, events: events(0, 0, 1), ..Mark::default() },
    ];
    assert_eq!(replay.marks(), marks);
    for (step, queries) in [(1, 0), (2, 2), (3, 0), (2, 2), (0, 0)] {
        replay.seek(step).expect("its calls can be applied");
        assert_eq!(replay.queries().len(), queries, "step {step}");
    }
    replay.seek(2).expect("its calls can be applied");
    let answers = replay.queries().iter().map(|asked| asked.answer.len());
    assert_eq!(answers.collect::<Vec<_>>(), [1, 0]);
    let excluded = replay.queries()[1].query.excluded.iter().map(CollisionObjectHandle::uid);
    assert!(excluded.eq([handles[1].uid()]), "what the predicate refuses");
    assert!(replay.queries().iter().all(|asked| asked.is_same), "with the same bits");
    Ok(())
}

/// Asserts that a seek to the last step undoes the calls after its update, which `seek_end` applies.
#[test]
fn a_seek_from_the_end_to_the_last_step_goes_back() -> Result<(), impinge_record::RecordError> {
    let mut recorder = balls()?;
    let first = recorder.collision_objects().next().expect("a ball").handle();
    recorder.set_position(first, Isometry::translation(5.0, 0.0))?;
    let mut replay = Replay::open(recorder.finish().bytes, &Registry::new()).expect("it is whole");
    let at = |replay: &Replay<f64, 2, u32>| {
        let first = replay.world().collision_objects().next().expect("a ball");
        first.position().translation.x
    };
    replay.seek(1).expect("its calls can be applied");
    assert_eq!(at(&replay), 0.0, "just after the update");
    replay.seek_end().expect("its calls can be applied");
    assert_eq!(at(&replay), 5.0, "at the end");
    replay.seek(1).expect("its calls can be applied");
    assert_eq!(at(&replay), 0.0, "again just after the update");
    Ok(())
}

#[test]
fn a_changed_world_is_undone_by_the_next_seek() -> Result<(), impinge_record::RecordError> {
    let bytes = balls()?.finish().bytes;
    let mut replay = Replay::open(bytes, &Registry::<f64, 2, u32>::new()).expect("a recording");
    replay.seek(1).expect("its calls can be applied");
    let before = words(replay.world());
    let handle = replay.world().collision_objects().next().expect("a ball").handle();
    let world = replay.world_mut();
    world.set_position(handle, Isometry::translation(0.0, 50.0));
    world.update();
    assert_ne!(words(replay.world()), before, "it was moved away");
    replay.seek(1).expect("its calls can be applied");
    assert_eq!((words(replay.world()), replay.divergence()), (before, None));
    Ok(())
}

/// Asserts that the replay of a long polyline, which is deformed at each step under balls, has the
/// recorded bits. In the recorded world the search tree of the polyline is refitted; in the replay
/// it is built anew.
#[test]
fn deformed_shapes_have_the_same_bits() -> Result<(), impinge_record::RecordError> {
    let mut recorder = balls()?;
    let (groups, kind) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.5, 0.0));
    let bent = |step: u32| {
        let wave = move |i: u32| f64::from((i * (step + 3) * 7) % 13) / 26.0;
        (0..60).map(|i| Point::new(f64::from(i) / 8.0 - 2.0, wave(i) - 1.25)).collect::<Vec<_>>()
    };
    let line = ShapeHandle::new(Polyline::open(bent(0)));
    let line = recorder.add(Isometry::identity(), line, groups, kind, 5)?;
    for step in 1..12 {
        let points = bent(step);
        recorder.deform(line, |line: &mut Polyline<f64>| line.set_vertices(&points))?;
        recorder.update();
        assert!(recorder.contact_views().count() > 1, "the balls touch the line");
    }
    let refused = recorder.deform(line, |_: &mut Ball<f64>| ());
    assert!(refused.is_err(), "it is no ball");
    let registry = Registry::<f64, 2, u32>::new();
    assert_eq!(validate(&recorder.finish().bytes, &registry), Ok(None));
    Ok(())
}
