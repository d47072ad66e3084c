//! Replays the recordings in the repository: hashes the state after every step, and asserts that
//! the replay does not differ from the recording.

use std::hash::Hasher;

use impinge::world::CollisionObject;
use impinge_record::{Recordable, Registry, Replay};

use crate::scene_stage::{Digest, digest_state};

/// Returns the hash of the recording of every shape in 2D, in `f32`.
pub(crate) fn in_plane() -> u64 {
    type Object = CollisionObject<f32, 2, u32>;
    let odd = |one: &Object, two: &Object| (one.data() + two.data()) % 2 == 1;
    let bytes = include_bytes!("../../impinge-record/tests/golden/scene2.rec");
    replayed(bytes, &Registry::new().with_filter("odd", odd))
}

/// Returns the hash of the recording of every shape in 3D, in `f64`.
pub(crate) fn in_space() -> u64 {
    type Object = CollisionObject<f64, 3, u32>;
    let odd = |one: &Object, two: &Object| (one.data() + two.data()) % 2 == 1;
    let bytes = include_bytes!("../../impinge-record/tests/golden/scene3.rec");
    replayed(bytes, &Registry::new().with_filter("odd", odd))
}

fn replayed<N: Recordable<D>, const D: usize>(bytes: &[u8], registry: &Registry<N, D, u32>) -> u64 {
    let mut replay = Replay::open(bytes, registry).expect("the golden file is a recording");
    let mut digest = Digest::new();
    for step in 1..=replay.len() {
        replay.seek(step).expect("its calls can be applied");
        digest_state(replay.world(), &mut digest);
    }
    assert_eq!(replay.divergence(), None, "the bits of the machine that recorded it");
    digest.finish()
}
