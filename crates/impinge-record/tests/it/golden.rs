//! Recordings in the repository, written by version 1 of the format: it must not change unnoticed.
//!
//! `golden/scene2.rec` and `golden/scene3.rec` have every shape, call and question. They are read as long as the
//! format is known. If answers change on purpose, or the format gets a new version, run
//! `IMPINGE_BLESS=1 cargo test -p impinge-record golden` and commit the files.

use std::path::PathBuf;

use impinge_record::validate;

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

fn check<N: Stage<D>, const D: usize>(name: &str) {
    let bytes = written::<N, D>();
    if std::env::var_os("IMPINGE_BLESS").is_some() {
        std::fs::write(file(name), &bytes).expect("the golden file can be written");
    }
    let golden = std::fs::read(file(name)).expect("the golden file is in the repository");
    assert_eq!(validate::<N, D, u32>(&golden, &N::registry()), Ok(None), "the same bits");
    let first = bytes.iter().zip(&golden).position(|(now, then)| now != then);
    assert_eq!((first, bytes.len()), (None, golden.len()), "the same format (see the top)");
}

#[test]
fn golden_in_2d() {
    check::<f32, 2>("scene2.rec");
}

#[test]
fn golden_in_3d() {
    check::<f64, 3>("scene3.rec");
}
