//! Recordings with changed bytes and recomputed checksums.

use impinge::narrow_phase::GeometricQueryType;
use impinge::world::CollisionGroups;
use impinge_record::{
    ReadError, Recordable, Recorder, Registry, Replay, pack, reseal, unpack, validate,
};

use crate::Bytes;
use crate::place::{Dimension, Plane, Room};
use crate::shapes::shape;

/// Records a few objects and changes bytes of the recording. Then reads and plays the result as a
/// whole, in pieces, salvaged, and packed. Errors are allowed, but all these ways must agree about
/// the valid records.
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
        // Calls that the world or the format rejects are not in the recording.
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
    let piece = 1 + usize::from(bytes.byte());
    let error = play::<N, D>(&changed, &registry, bytes.choice(6));
    assert!(error.is_none_or(|error| error.offset <= changed.len()));
    grow::<N, D>(&changed, &registry, piece);
    repack(&changed, bytes);
}

/// Opens a recording, then seeks to its end and back to `step`. Returns the error, if there is one.
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

/// Checks that a recording can be read in pieces if and only if it can be read as a whole, and that
/// salvaging keeps the records before the first error.
fn grow<N: Recordable<D>, const D: usize>(
    changed: &[u8],
    registry: &Registry<N, D, u32>,
    piece: usize,
) {
    let mut growing = Replay::growing(registry);
    let error = changed.chunks(piece).find_map(|piece| growing.push(piece).err());
    assert_eq!(
        error.is_none() && growing.is_complete(),
        Replay::open(changed, registry).is_ok(),
        "as a whole: {error:?}"
    );
    let Ok(salvaged) = Replay::salvage(changed, registry) else {
        assert!(growing.is_empty(), "without a header there is no update");
        return;
    };
    assert_eq!(salvaged.marks(), growing.marks(), "the same records");
    assert_eq!(salvaged.loss().is_none(), growing.is_complete() && error.is_none());
}

/// Checks that a recording that was packed and unpacked stays the same if it is packed and unpacked
/// again, and that changed packed bytes do not panic.
fn repack(changed: &[u8], bytes: &mut Bytes<'_>) {
    let Ok(mut packed) = pack(changed) else { return };
    let unpacked = unpack(&packed).expect("it was just packed");
    let again = pack(&unpacked).map(|packed| unpack(&packed));
    assert_eq!(again, Ok(Ok(unpacked)), "nothing more is left out");
    for _ in 0..1 + bytes.choice(3) {
        let place = usize::from(bytes.byte()) * 256 + usize::from(bytes.byte());
        let place = place % packed.len();
        packed[place] = bytes.byte();
    }
    let error = unpack(&packed).err();
    assert!(error.is_none_or(|error| error.offset <= packed.len()));
}
