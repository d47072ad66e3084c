//! Tests of packed recordings: the same calls with the same bits in few bytes, and errors for all
//! other bytes.

use std::num::NonZeroU64;

use impinge::dim3::math::Isometry;
use impinge::dim3::shape::{Ball, ShapeHandle};
use impinge::dim3::world::{CollisionGroups, GeometricQueryType};
use impinge::math::na::{UnitQuaternion, Vector3};
use impinge_record::{
    Difference, Problem, Recorder, Registry, Replay, is_packed, pack, reseal, unpack, validate,
};

use crate::scene::{Scene, Stage};

fn written<N: Stage<D>, const D: usize>() -> Vec<u8> {
    let mut scene = Scene::<N, D>::new().with_key_frames(3);
    scene.fill().expect("the shapes can be written");
    (0..8).for_each(|step| scene.step(step).expect("the calls are allowed"));
    scene.recorder.finish().bytes
}

fn round_trip<N: Stage<D>, const D: usize>() {
    let bytes = written::<N, D>();
    let packed = pack(&bytes).expect("a recording");
    assert!(is_packed(&packed) && !is_packed(&bytes), "they begin otherwise");
    let unpacked = unpack(&packed).expect("it was just packed");
    assert!(unpacked.len() < bytes.len(), "it has no hashes of objects");
    assert_eq!(validate::<N, D, u32>(&unpacked, &N::registry()), Ok(None), "the same bits");
    let replay = |bytes: &[u8]| Replay::open(bytes, &N::registry()).expect("a recording");
    assert_eq!(replay(&unpacked).marks(), replay(&bytes).marks(), "the same time line");
    let again = unpack(&pack(&unpacked).expect("a recording")).expect("it was just packed");
    assert!(again == unpacked, "nothing more is left out");
}

#[test]
fn every_shape_and_call() {
    round_trip::<f32, 2>();
    round_trip::<f64, 2>();
    round_trip::<f32, 3>();
    round_trip::<f64, 3>();
}

#[test]
fn version_1_keeps_all_its_bytes() {
    let golden = include_bytes!("../golden/scene3.rec");
    let packed = pack(golden).expect("a recording");
    assert!(unpack(&packed).expect("it was just packed") == golden, "each byte");
}

#[test]
fn a_recording_without_its_end() {
    let bytes = written::<f64, 2>();
    let replay = Replay::salvage(&bytes[..bytes.len() / 2], &<f64 as Stage<2>>::registry());
    let replay = replay.expect("it has a header");
    let packed = pack(replay.bytes()).expect("whole records");
    let unpacked = unpack(&packed).expect("it was just packed");
    let again = Replay::salvage(unpacked, &<f64 as Stage<2>>::registry()).expect("a header");
    assert_eq!((again.len(), again.marks()), (replay.len(), replay.marks()));
    let cut = pack(&bytes[..bytes.len() - 1]).expect_err("the last record is not whole");
    assert_eq!(cut.problem, Problem::Truncated);
}

/// Asserts that packing and unpacking keep all bits of positions, also of NaN with a payload,
/// infinities and subnormal numbers.
#[test]
fn any_bits_of_positions() {
    let mut recorder = Recorder::<f32, 3, u32>::new(0.02, Registry::new()).expect("usable");
    let (ball, kind) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    let ball = recorder.add(Isometry::identity(), ball, CollisionGroups::new(), kind, 0);
    let ball = ball.expect("a ball");
    let marker = 1234.5_f32;
    for _ in 0..12 {
        recorder.set_position(ball, Isometry::translation(marker, 0.5, -0.0)).expect("finite");
        recorder.update();
    }
    let mut bytes = unpack(&pack(&recorder.finish().bytes).expect("it is one")).expect("packed");
    let bits = [0x7fc1_2345, 0xff80_0000, 0x7f80_0000, 1, 0x8000_0001, 0xffff_ffff, 0x3f80_0000];
    let mut changed = 0;
    for place in 0..bytes.len() - 4 {
        if bytes[place..place + 4] == marker.to_le_bytes() {
            bytes[place..place + 4].copy_from_slice(&u32::to_le_bytes(bits[changed % 7]));
            changed += 1;
        }
    }
    assert_eq!(changed, 12);
    reseal(&mut bytes);
    let packed = pack(&bytes).expect("it is a recording");
    assert!(unpack(&packed).expect("it was just packed") == bytes, "each bit");
}

#[test]
fn a_difference_is_found_at_its_step() {
    let bytes = unpack(&pack(&written::<f32, 2>()).expect("a recording")).expect("packed");
    let registry = <f32 as Stage<2>>::registry();
    // The first update record (kind 15, 29 bytes) begins with its hash of the state.
    let head = [15, 29, 0, 0, 0];
    let place = bytes.windows(5).position(|window| window == head).expect("there are updates");
    let mut other = bytes;
    other[place + 5] ^= 1;
    reseal(&mut other);
    let found = validate(&other, &registry).expect("it is a recording").expect("it differs");
    assert_eq!((found.step, found.difference), (0, Difference::State));
}

#[test]
fn damaged_packed_bytes_are_errors() {
    let packed = pack(&written::<f32, 2>()).expect("a recording");
    for length in (0..packed.len()).step_by(13) {
        let error = unpack(&packed[..length]).expect_err("the end is missing");
        assert!(error.offset <= length, "{error} of {length} bytes");
    }
    for place in 0..packed.len() {
        let mut other = packed.clone();
        other[place] ^= 0x21;
        // The bits that pad the last byte of a compressed stream may be changed without effect.
        if let Ok(same) = unpack(&other) {
            assert!(same == unpack(&packed).expect("it is whole"), "byte {place}");
        }
    }
    let nothing = unpack(&written::<f32, 2>()).expect_err("it is not packed");
    assert_eq!((nothing.offset, nothing.problem), (0, Problem::NotARecording));
    assert_eq!(pack(b"text").expect_err("it is text").problem, Problem::NotARecording);
}

#[test]
fn declared_lengths_are_bounded() {
    let packed = pack(&written::<f32, 2>()).expect("a recording");
    for length in [u64::MAX, 1 << 31, 100] {
        let mut other = packed.clone();
        other[14..22].copy_from_slice(&length.to_le_bytes());
        let problem = unpack(&other).expect_err("another length").problem;
        assert!(matches!(problem, Problem::TooLarge { .. }), "{length}: {problem}");
    }
    let mut other = packed;
    other[12] = 5;
    assert_eq!(unpack(&other).expect_err("no scalar").problem, Problem::Scalar { found: 5 });
}

/// Asserts that a move of an object that was never added is an error. Otherwise each index that is
/// moved would take twenty times the memory of its bytes.
#[test]
fn moves_of_no_object_are_errors() {
    let mut recorder = Recorder::<f32, 3, u32>::new(0.02, Registry::new()).expect("usable");
    let (ball, kind) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    let ball = recorder.add(Isometry::identity(), ball, CollisionGroups::new(), kind, 0);
    recorder.set_position(ball.expect("a ball"), Isometry::identity()).expect("finite");
    let mut bytes = recorder.finish().bytes;
    // The record of the move: kind 3, 36 bytes, one position, of object 0.
    let record = [3, 36, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0];
    let place = bytes.windows(13).position(|window| window == record).expect("it is moved") + 9;
    bytes[place] = 77;
    reseal(&mut bytes);
    let error = pack(&bytes).expect_err("there is no object 77");
    assert_eq!((error.offset, error.problem), (place, Problem::NoSuchObject(77)));
}

/// Returns the number of packed bytes per pose, which has 32 bytes unpacked. 200 balls move by
/// `pose`, a function of the ball and the time.
fn bytes_per_pose(mut pose: impl FnMut(u32, f64) -> Isometry<f32>) -> f64 {
    const BALLS: u32 = 200;
    const STEPS: u32 = 300;
    let every = NonZeroU64::new(60).expect("not zero");
    let recorder = Recorder::<f32, 3, ()>::new(0.02, Registry::new()).expect("usable");
    let mut recorder = recorder.with_key_frames(every);
    let (ball, groups) = (ShapeHandle::new(Ball::new(0.1)), CollisionGroups::empty());
    let kind = GeometricQueryType::Proximity(0.0);
    let add = |id| recorder.add(pose(id, 0.0), ball.clone(), groups, kind, ()).expect("usable");
    let handles: Vec<_> = (0..BALLS).map(add).collect();
    for step in 1..=STEPS {
        let time = f64::from(step) / 60.0;
        let poses = handles.iter().zip(0..).map(|(handle, id)| (*handle, pose(id, time)));
        recorder.set_positions(&poses.collect::<Vec<_>>()).expect("finite");
        recorder.update();
    }
    let bytes = recorder.finish().bytes;
    let packed = pack(&bytes).expect("a recording");
    let unpacked = unpack(&packed).expect("it was just packed");
    let divergence = validate(&unpacked, &Registry::<f32, 3, ()>::new());
    assert_eq!(divergence, Ok(None), "the same bits");
    packed.len() as f64 / f64::from(BALLS * STEPS)
}

/// Returns a pseudorandom number between -1 and 1.
fn random(seed: u64) -> f64 {
    let mixed = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    f64::from((mixed >> 40) as u32) / f64::from(1 << 23) - 1.0
}

fn turned(axis: [f64; 3], angle: f64, at: [f64; 3]) -> Isometry<f32> {
    let turn = UnitQuaternion::new(Vector3::from(axis) * angle);
    let at = Vector3::from(at);
    Isometry::from_parts(at.cast::<f32>().into(), turn.cast::<f32>())
}

/// Simulates bodies in `f32`, so their poses have rounding errors. The bodies are thrown from a
/// height, rotate, bounce on the plane y = 0 and come to rest.
fn integrated() -> impl FnMut(u32, f64) -> Isometry<f32> {
    struct Body {
        at: Vector3<f32>,
        velocity: Vector3<f32>,
        rotation: UnitQuaternion<f32>,
        spin: Vector3<f32>,
    }
    let random = |id: u32, salt: u64| random(u64::from(id) * 16 + salt);
    let vector = move |id, salt| {
        Vector3::<u64>::new(0, 1, 2).map(|axis| random(id, salt + axis)).cast::<f32>()
    };
    let mut bodies = Vec::new();
    move |id, time| {
        if time == 0.0 {
            bodies.push(Body {
                at: 10.0 * vector(id, 0) + Vector3::new(0.0, 10.0, 0.0),
                velocity: vector(id, 3),
                rotation: UnitQuaternion::new(vector(id, 6)),
                spin: 3.0 * vector(id, 9),
            });
        }
        let Body { at, velocity, rotation, spin } = &mut bodies[id as usize];
        let step = 1.0 / 60.0;
        velocity.y -= 9.81 * step;
        if at.y + velocity.y * step < 0.0 {
            velocity.y *= -0.3;
            let is_slow = velocity.y < 0.1;
            (*velocity, *spin) =
                if is_slow { Default::default() } else { (*velocity, *spin * 0.7) };
        }
        *at += *velocity * step;
        *rotation = UnitQuaternion::new(*spin * step) * *rotation;
        Isometry::from_parts((*at).into(), *rotation)
    }
}

/// Tests the sizes of packed poses. The page of a recording with 1000 objects and 600 steps has 3
/// megabytes if a pose takes 3.75 bytes, since base64 adds a third.
#[test]
fn free_bodies_take_few_bytes() {
    let own = |id: u32, salt: u64| random(u64::from(id) * 16 + salt);
    let free = bytes_per_pose(|id, time| {
        let at = [0, 1, 2].map(|axis| 10.0 * own(id, axis) + 3.0 * own(id, axis + 3) * time);
        turned([6, 7, 8].map(|salt| own(id, salt)), 4.0 * time + 1.0, at)
    });
    let thrown = bytes_per_pose(|id, time| {
        let at = [0, 1, 2].map(|axis| 10.0 * own(id, axis) + 3.0 * own(id, axis + 3) * time);
        let at = [at[0], at[1] - 4.905 * time * time, at[2]];
        turned([6, 7, 8].map(|salt| own(id, salt)), 2.0 * time, at)
    });
    let resting = bytes_per_pose(|id, time| {
        let fall = (1.0 - time).max(0.0);
        let at = [own(id, 0), fall * fall * (2.0 + own(id, 1)), own(id, 2)];
        turned([6, 7, 8].map(|salt| own(id, salt)), fall * own(id, 3), at)
    });
    let integrated = bytes_per_pose(integrated());
    let mut count = 0;
    let jitter = bytes_per_pose(|_, _| {
        count += 16;
        let at = [0, 1, 2].map(|axis| 10.0 * random(count + axis));
        turned([3, 4, 5].map(|salt| random(count + salt)), 3.0, at)
    });
    assert!(free < 3.0 && thrown < 3.0 && resting < 1.5, "{free} {thrown} {resting}");
    assert!(integrated < 3.0, "{integrated}");
    assert!(jitter < 28.0 * 1.02, "hardly more than the bits: {jitter}");
}
