//! Compares recordings of each version of the format with golden files, so that the format does not
//! change unnoticed.
//!
//! `golden/scene2.rec` and `golden/scene3.rec` have version 1, the files in `golden/version2/` have
//! version 2. These files contain every shape, call and query of their versions, and are read as
//! long as the version is supported. The files in `golden/version3/` contain the calls that are new
//! in version 3. If results change on purpose, or the format gets a new version, run
//! `IMPINGE_BLESS=1 cargo test -p impinge-record golden` and commit the files.

use std::num::NonZeroU64;
use std::path::PathBuf;

use impinge::math::Isometry3;
use impinge::math::na::{Quaternion, Translation3, UnitQuaternion};
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Ball, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_record::{Recorder, Registry, pack, reseal, unpack, validate};

use crate::engine;
use crate::scene::{Scene, Stage};

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

fn written<N: Stage<D>, const D: usize>() -> Vec<u8> {
    let mut scene = Scene::<N, D>::new().with_key_frames(4);
    scene.fill().expect("the shapes can be written");
    (0..10).for_each(|step| scene.step(step).expect("the calls are allowed"));
    scene.recorder.finish().bytes
}

/// Converts a recording without calls of version 3 to version 2 of the format: only the version
/// number and the checksums differ.
fn in_version_2(bytes: &[u8]) -> Vec<u8> {
    let mut earlier = bytes.to_vec();
    earlier[8] = 2;
    reseal(&mut earlier);
    earlier
}

/// Converts a recording to version 1 of the format, whose updates have no numbers of events and no
/// flag.
fn in_version_1(bytes: &[u8], scalar_bytes: usize) -> Vec<u8> {
    let word = |at: usize| {
        let bytes = bytes[at..at + 4].try_into().expect("four bytes");
        u32::from_le_bytes(bytes) as usize
    };
    // The header ends with the name of the writer, two bytes for scalar and dimension, the margin,
    // and the checksum.
    let mut at = 16 + word(12) + 2 + scalar_bytes + 4;
    let mut earlier = bytes[..at].to_vec();
    earlier[8] = 1;
    while at < bytes.len() {
        let (kind, fields) = (bytes[at], &bytes[at + 5..at + 5 + word(at + 1)]);
        let (kind, fields) = match kind {
            15 => (13, [&fields[..16], &fields[29..]].concat()),
            kind => (kind, fields.to_vec()),
        };
        earlier.push(kind);
        earlier.extend(u32::try_from(fields.len()).expect("a short record").to_le_bytes());
        earlier.extend([&fields[..], &[0; 4]].concat());
        at += 5 + word(at + 1) + 4;
    }
    reseal(&mut earlier);
    earlier
}

fn check<N: Stage<D>, const D: usize>(name: &str) {
    let bytes = written::<N, D>();
    compare::<N, D>(&in_version_1(&bytes, N::BYTES), name);
    compare::<N, D>(&in_version_2(&bytes), &format!("version2/{name}"));
}

fn check_engine<N: Stage<D>, const D: usize>(name: &str) {
    let bytes = engine::written::<N, D>(Some(4));
    compare::<N, D>(&bytes, &format!("version3/{name}"));
}

/// Asserts that the golden file has exactly these bytes, and that its replay gives the same
/// results, to the bit.
fn compare<N: Stage<D>, const D: usize>(bytes: &[u8], name: &str) {
    if std::env::var_os("IMPINGE_BLESS").is_some() {
        std::fs::write(file(name), bytes).expect("the golden file can be written");
    }
    let golden = std::fs::read(file(name)).expect("the golden file is in the repository");
    assert_eq!(validate::<N, D, u32>(&golden, &N::registry()), Ok(None), "the same bits");
    let first = bytes.iter().zip(&golden).position(|(now, then)| now != then);
    assert_eq!((first, bytes.len()), (None, golden.len()), "the same format (see the top)");
}

#[test]
fn golden_in_2d() {
    check::<f32, 2>("scene2.rec");
    check_engine::<f32, 2>("engine2.rec");
}

#[test]
fn golden_in_3d() {
    check::<f64, 3>("scene3.rec");
    check_engine::<f64, 3>("engine3.rec");
}

/// Records a ball that rotates, falls and is placed again, so that each of the ways in which
/// packing predicts a pose is the best one in some steps.
fn turning() -> Vec<u8> {
    let recorder = Recorder::<f32, 3, u32>::new(0.02, Registry::new());
    let every = NonZeroU64::new(10).expect("not zero");
    let mut recorder = recorder.expect("a usable margin").with_key_frames(every);
    let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    let kind = GeometricQueryType::Proximity(0.0);
    let ball = recorder.add(Isometry3::identity(), ball, groups, kind, 7).expect("a ball");
    let [mut rotation, turn] = [Quaternion::identity(), Quaternion::new(0.96, 0.0, 0.28, 0.0)];
    for step in 0..40_u8 {
        rotation = turn * rotation;
        let time = f32::from(step % 25);
        let at = Translation3::new(time * 0.3, 8.0 - time * time * 0.1, 0.1);
        let at = Isometry3::from_parts(at, UnitQuaternion::new_unchecked(rotation));
        recorder.set_position(ball, at).expect("finite");
        recorder.update();
    }
    recorder.finish().bytes
}

/// Tests that a recording packed by version 1 of the packed format is unpacked to the bit.
#[test]
fn golden_packed() {
    let packed = pack(&turning()).expect("a recording");
    if std::env::var_os("IMPINGE_BLESS").is_some() {
        std::fs::write(file("version2/packed.rec"), &packed).expect("it can be written");
    }
    let golden = std::fs::read(file("version2/packed.rec")).expect("it is in the repository");
    let bytes = unpack(&golden).expect("a packed recording");
    assert_eq!(validate(&bytes, &Registry::<f32, 3, u32>::new()), Ok(None));
    let now = unpack(&packed).expect("it was just packed");
    assert!(in_version_2(&bytes) == in_version_2(&now), "the same poses");
}
