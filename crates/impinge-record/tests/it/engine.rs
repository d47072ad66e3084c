//! Tests that the calls for physics engines are recorded and replayed.

use std::num::NonZeroU64;

use impinge::narrow_phase::{ContactEvent, GeometricQueryType};
use impinge::shape::{Ball, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_record::{Problem, Recorder, Replay, pack, unpack, validate};

use crate::scene::{Stage, words};

/// Returns the recording of balls that move through each other, with every call for physics
/// engines. If `key_frames` is not `None`, it is the number of updates between key frames.
pub(crate) fn written<N: Stage<D>, const D: usize>(key_frames: Option<u64>) -> Vec<u8> {
    play::<N, D>(key_frames).0
}

/// Returns the recording, and the text of the world after each update.
fn play<N: Stage<D>, const D: usize>(key_frames: Option<u64>) -> (Vec<u8>, Vec<Vec<String>>) {
    let mut recorder = Recorder::new(N::lit(0.02), N::registry()).expect("a usable margin");
    if let Some(every) = key_frames.and_then(NonZeroU64::new) {
        recorder = recorder.with_key_frames(every);
    }
    let (ball, groups) = (ShapeHandle::new(Ball::new(N::ONE)), CollisionGroups::new());
    let query = |id: u32| match id % 4 {
        3 => GeometricQueryType::Proximity(N::HALF),
        _ => GeometricQueryType::Contacts(N::lit(0.01), N::ZERO),
    };
    let add = |recorder: &mut Recorder<N, D, u32>, id: u32| {
        let at = N::placed(f64::from(id), f64::from(id % 2));
        recorder.add(at, ball.clone(), groups, query(id), id).expect("it can be recorded")
    };
    let handles: Vec<_> = (0..8).map(|id| add(&mut recorder, id)).collect();
    for &fixed in &handles[..3] {
        recorder.set_fixed(fixed, true).expect("alive");
    }
    recorder.set_skin(handles[4], N::lit(0.25)).expect("alive");
    let (mut all, mut kept) = (Vec::new(), 0);
    for step in 0..12_u32 {
        let (from, to) = (f64::from(step % 5), f64::from(step % 7) - 8.0);
        let [from, to] = [from, to].map(|x| N::placed(x, 0.5));
        recorder.set_position_with_prediction(handles[5], from, to).expect("finite");
        recorder
            .set_position(handles[6], N::placed(2.5 - 0.25 * f64::from(step), 1.0))
            .expect("finite");
        for (one, other) in [(6, 1), (5, 4), (7, 6)] {
            let is_kept = recorder.update_pair(handles[one], handles[other]).expect("alive");
            kept += usize::from(is_kept);
        }
        match step {
            3 => recorder.set_fixed(handles[1], false).expect("alive"),
            5 => recorder.refilter_pairs(),
            7 => recorder.refilter_pairs_of(handles[6]).expect("alive"),
            9 => recorder.set_skin(handles[4], N::ZERO).expect("alive"),
            _ => {}
        }
        if step % 3 == 1 {
            recorder.keep_events();
        }
        if step % 2 == 1 {
            recorder.update_with(&mut |a, b| (a.data() + b.data() + step) % 3 != 0);
        } else {
            recorder.update();
        }
        all.push(words(&recorder));
    }
    assert!(kept > 8, "pairs were computed: {kept}");
    recorder.remove(&[handles[0]]).expect("alive");
    recorder.update();
    all.push(words(&recorder));
    let gone = |event: &ContactEvent| event.handles().0 == handles[0];
    assert!(recorder.contact_events().iter().any(gone), "it touched something");
    assert_eq!(recorder.take_removed(handles[0]), Some(0), "beside its events");
    (recorder.finish().bytes, all)
}

fn check<N: Stage<D>, const D: usize>() {
    for key_frames in [None, Some(4), Some(1)] {
        let (bytes, all) = play::<N, D>(key_frames);
        let registry = N::registry();
        assert_eq!(validate::<N, D, u32>(&bytes, &registry), Ok(None), "the same bits");
        let unpacked = unpack(&pack(&bytes).expect("a recording")).expect("just packed");
        assert_eq!(validate::<N, D, u32>(&unpacked, &registry), Ok(None), "packed, too");
        let mut replay = Replay::<N, D, u32>::open(bytes, &registry).expect("a recording");
        let last = all.len();
        for step in (1..=last).chain((1..last).rev()).chain([last, 3, last - 1]) {
            replay.seek(step).expect("its calls can be applied");
            assert_eq!(words(replay.world()), all[step - 1], "{key_frames:?}: after {step}");
            assert_eq!(replay.divergence(), None, "{key_frames:?}: after {step}");
        }
    }
}

#[test]
fn calls_of_engines_in_2d() {
    check::<f32, 2>();
    check::<f64, 2>();
}

#[test]
fn calls_of_engines_in_3d() {
    check::<f32, 3>();
    check::<f64, 3>();
}

/// Asserts that the time line counts calls, not the properties that a key frame repeats.
fn time_line<N: Stage<D>, const D: usize>() {
    let counts = |key_frames| -> Vec<_> {
        let bytes = written::<N, D>(key_frames);
        let replay = Replay::<N, D, u32>::open(bytes, &N::registry()).expect("a recording");
        replay.marks().iter().map(|mark| (mark.moved, mark.changed)).collect()
    };
    let plain = counts(None);
    assert_eq!(plain[..4], [(2, 4), (2, 0), (2, 0), (2, 1)], "two moves in each step");
    assert_eq!(
        (counts(Some(1)), counts(Some(4))),
        (plain.clone(), plain),
        "whatever the key frames"
    );
}

#[test]
fn the_time_line_does_not_depend_on_key_frames() {
    time_line::<f32, 2>();
    time_line::<f64, 3>();
}

/// Asserts that a record with the index of an unknown object is an error.
#[test]
fn calls_about_nobody_are_errors() {
    let bytes = written::<f32, 2>(None);
    // The first record of kind 16 sets object 0 fixed.
    let record = [16, 5, 0, 0, 0, 0, 0, 0, 0, 1];
    let at = bytes.windows(record.len()).position(|window| window == record).expect("it is there");
    let mut changed = bytes;
    changed[at + 5] = 77;
    impinge_record::reseal(&mut changed);
    let error = validate::<f32, 2, u32>(&changed, &<f32 as Stage<2>>::registry());
    assert_eq!(error.expect_err("there is no object 77").problem, Problem::NoSuchObject(77));
}
