//! Recordings with bytes changed behind their checksums, which are written anew.

use impinge::narrow_phase::GeometricQueryType;
use impinge::world::CollisionGroups;
use impinge_record::{ReadError, Recordable, Recorder, Registry, Replay, reseal, validate};

use crate::Bytes;
use crate::place::{Dimension, Plane, Room};
use crate::shapes::shape;

/// Records a few objects, changes bytes of the recording, and reads and plays what it has become.
pub fn recording(data: &[u8]) {
    let bytes = &mut Bytes::new(data);
    let choice = bytes.choice(8);
    if choice >= 4 {
        bytes.go_wild();
    }
    match choice % 4 {
        0 => record::<f32, Plane, 2>(bytes),
        1 => record::<f64, Plane, 2>(bytes),
        2 => record::<f32, Room, 3>(bytes),
        _ => record::<f64, Room, 3>(bytes),
    }
}

fn record<N: Recordable<D>, M: Dimension<N, D>, const D: usize>(bytes: &mut Bytes<'_>) {
    let registry = Registry::<N, D, u32>::new();
    let Ok(mut recorder) = Recorder::new(bytes.size::<N>(), registry.clone()) else { return };
    for id in 0..1 + bytes.choice(4) as u32 {
        let (at, shape) = (M::stored(M::position(bytes)), shape::<N, M, D>(bytes));
        let (groups, query) =
            (CollisionGroups::new(), GeometricQueryType::Contacts(bytes.size(), N::ZERO));
        // What the world or the format refuses is not in the recording.
        let _ = recorder.add(at, shape, groups, query, id);
        recorder.update();
    }
    let mut changed = recorder.finish().bytes;
    assert_eq!(validate(&changed, &registry), Ok(None), "as it was written");
    for _ in 0..1 + bytes.choice(4) {
        let place = usize::from(bytes.byte()) * 256 + usize::from(bytes.byte());
        let place = place % changed.len();
        changed[place] = bytes.byte();
    }
    reseal(&mut changed);
    let error = play::<N, D>(&changed, &registry, bytes.choice(6));
    assert!(error.is_none_or(|error| error.offset <= changed.len()));
}

/// Plays a recording forwards and backwards; the error, if there is one.
fn play<N: Recordable<D>, const D: usize>(
    changed: &[u8],
    registry: &Registry<N, D, u32>,
    step: usize,
) -> Option<ReadError> {
    let mut replay = match Replay::open(changed, registry) {
        Ok(replay) => replay,
        Err(error) => return Some(error),
    };
    let back = replay.seek(usize::MAX).and_then(|()| replay.seek(step));
    back.err()
}
