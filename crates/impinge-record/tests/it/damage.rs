//! Tests that bytes that are no recording give errors with offsets, and no panic.

use impinge::dim2::math::Isometry;
use impinge::dim2::shape::{Ball, Cuboid, ShapeHandle};
use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
use impinge::math::Vector;
use impinge_record::{
    Difference, ObjectField, Problem, ReadError, RecordError, Recorder, Registry, Replay, reseal,
    validate,
};

use crate::scene::{Scene, Stage};

fn registry() -> Registry<f32, 2, u32> {
    <f32 as Stage<2>>::registry()
}

/// Returns the recording of a few objects, calls of several kinds and two updates, in less than a
/// kilobyte.
fn small() -> Vec<u8> {
    let mut recorder = Recorder::new(0.02_f32, registry()).expect("a usable margin");
    let ball = ShapeHandle::new(Ball::new(1.0));
    let square = ShapeHandle::new(Cuboid::new(Vector::<f32, 2>::repeat(1.0)));
    let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    let mut handles = Vec::new();
    for (shape, id) in [(ball, 1), (square, 2)] {
        let (at, groups) = (Isometry::translation(0.0, id as f32), CollisionGroups::new());
        handles.push(recorder.add(at, shape, groups, contacts, id).expect("usable"));
    }
    recorder.update();
    recorder.set_position(handles[0], Isometry::translation(0.5, 1.0)).expect("usable");
    recorder.register_broad_phase_pair_filter("odd").expect("it is known");
    recorder.update();
    recorder.finish().bytes
}

fn outcome(bytes: &[u8]) -> Result<bool, ReadError> {
    validate(bytes, &registry()).map(|divergence| divergence.is_none())
}

#[test]
fn every_truncation_is_an_error() {
    let bytes = small();
    assert_eq!(outcome(&bytes), Ok(true), "as it was written");
    for length in 0..bytes.len() {
        let error = outcome(&bytes[..length]).expect_err("the end is missing");
        assert!(error.offset <= length, "{error} of {length} bytes");
    }
    let error = outcome(&[&bytes[..], &[0]].concat()).expect_err("a byte follows");
    assert_eq!(error, ReadError { offset: bytes.len(), problem: Problem::TrailingBytes });
}

#[test]
fn every_flipped_byte_is_an_error() {
    let bytes = small();
    for index in 0..bytes.len() {
        for flip in [1, 0x80, 0xff] {
            let mut other = bytes.clone();
            other[index] ^= flip;
            assert!(outcome(&other).is_err(), "byte {index} with {flip:#x}");
        }
    }
}

/// Asserts that a recording with a changed byte and correct checksums causes no panic: it gives an
/// error with an offset in the bytes, a divergence, or an equal world.
#[test]
fn every_flipped_byte_with_right_checksums() {
    let bytes = small();
    let (mut errors, mut divergences, mut same) = (0, 0, 0);
    for index in 0..bytes.len() {
        for flip in [1, 0x40, 0x80, 0xff] {
            let mut other = bytes.clone();
            other[index] ^= flip;
            reseal(&mut other);
            match outcome(&other) {
                Err(error) => {
                    assert!(error.offset <= other.len(), "{error}");
                    errors += 1;
                }
                Ok(false) => divergences += 1,
                Ok(true) => same += 1,
            }
        }
    }
    assert!(errors > 100 && divergences > 100 && same > 10, "{errors} {divergences} {same}");
}

fn large_scene_damaged<N: Stage<D>, const D: usize>() {
    let mut scene = Scene::<N, D>::new().with_key_frames(2);
    scene.fill().expect("the shapes can be written");
    (0..4).for_each(|step| scene.step(step).expect("the calls are allowed"));
    let bytes = scene.recorder.finish().bytes;
    let (mut random, mut errors) = (7_u64, 0);
    for _ in 0..150 {
        let mut other = bytes.clone();
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let index = usize::try_from(random >> 33).expect("31 bits") % other.len();
        other[index] = other[index].wrapping_add(random.to_le_bytes()[2] | 1);
        reseal(&mut other);
        errors += u32::from(validate::<N, D, u32>(&other, &N::registry()).is_err());
    }
    assert!(errors > 5, "{errors} of 150");
}

#[test]
fn all_shapes_with_damage() {
    large_scene_damaged::<f32, 2>();
    large_scene_damaged::<f64, 3>();
}

#[test]
fn other_versions_scalars_and_dimensions() {
    let bytes = small();
    let mut later = bytes.clone();
    later[8] = 4;
    let version = ReadError { offset: 8, problem: Problem::Version { found: 4 } };
    assert_eq!(outcome(&later), Err(version));
    let other = validate::<f64, 2, u32>(&bytes, &<f64 as Stage<2>>::registry());
    let other = other.expect_err("the numbers are of f32");
    assert_eq!(other.problem, Problem::Scalar { found: 4 });
    let other = validate::<f32, 3, u32>(&bytes, &<f32 as Stage<3>>::registry());
    let other = other.expect_err("the world has two dimensions");
    assert_eq!(other.problem, Problem::Dimension { found: 2 });
    let nothing = outcome(b"something else").expect_err("it is text");
    assert_eq!(nothing, ReadError { offset: 0, problem: Problem::NotARecording });
}

#[test]
fn a_length_beyond_the_end_is_refused_before_memory_is_taken() {
    let mut bytes = small();
    // Overwrites the length of the writer's name in the header.
    bytes[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    let error = outcome(&bytes).expect_err("four gigabytes of name");
    assert_eq!(error, ReadError { offset: 12, problem: Problem::Truncated });
}

/// Asserts that a recording with a changed position is reported as a divergence, with the first
/// step and object that differ.
#[test]
fn a_divergence_names_the_object() {
    let bytes = small();
    let position = 0.5_f32.to_le_bytes();
    let places = bytes.windows(4).enumerate().filter(|(_, window)| *window == position);
    let place = places.map(|(place, _)| place).next_back().expect("the ball was moved there");
    let mut other = bytes;
    other[place..place + 4].copy_from_slice(&0.75_f32.to_le_bytes());
    reseal(&mut other);
    let found = validate(&other, &registry()).expect("it is a recording");
    let found = found.expect("the ball is elsewhere");
    let field = ObjectField::Description;
    assert_eq!((found.step, found.difference), (1, Difference::Object { index: 0, field }));
    let replay = Replay::open(other, &registry());
    let mut replay = replay.expect("it is a recording");
    replay.seek(1).expect("its calls can be applied");
    assert_eq!(replay.divergence(), None, "not yet");
    replay.seek(2).expect("its calls can be applied");
    assert_eq!(replay.divergence(), Some(found), "now");
}

/// Asserts that a divergence names the right object after removals, when the indices of new objects
/// leave a gap to those of the remaining objects.
#[test]
fn a_divergence_names_the_object_beyond_a_gap() -> Result<(), RecordError> {
    let mut recorder = Recorder::<f32, 2, u32>::new(0.02, registry())?;
    let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    let add = |recorder: &mut Recorder<f32, 2, u32>, x| {
        recorder.add(Isometry::translation(x, 7.0), ball.clone(), groups, query, 0)
    };
    let mut handles = Vec::new();
    for x in [10.0, 20.0, 30.0, 40.0, 50.0] {
        handles.push(add(&mut recorder, x)?);
    }
    recorder.update();
    recorder.remove(&handles[1..])?;
    recorder.update();
    let (last, other) = (add(&mut recorder, 0.5)?.uid(), add(&mut recorder, 60.0)?.uid());
    recorder.update();
    assert!(last > other && other > 1, "index 1 is free, so there is a gap");
    let bytes = recorder.finish().bytes;
    let position = 0.5_f32.to_le_bytes();
    let places = bytes.windows(4).enumerate().filter(|(_, window)| *window == position);
    let place =
        places.map(|(place, _)| place).next_back().expect("the position of the last object");
    let mut damaged = bytes;
    damaged[place..place + 4].copy_from_slice(&0.75_f32.to_le_bytes());
    reseal(&mut damaged);
    let found = validate(&damaged, &registry()).expect("it is a recording");
    let found = found.expect("one object is elsewhere").difference;
    let field = ObjectField::Description;
    assert_eq!(found, Difference::Object { index: last, field }, "the object that is elsewhere");
    Ok(())
}
