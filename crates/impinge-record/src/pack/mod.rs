//! Packed recordings: the calls of a recording in about a tenth of its bytes.
//!
//! Records are split into streams, and poses are predicted from earlier poses, as `poses.rs`
//! describes. The residuals are small numbers, which deflate compresses well.

mod poses;
mod records;
mod streams;
mod tracks;

use crate::bytes::{Sink, Source};
use crate::error::{Problem, ReadError};
use crate::log::Header;
use records::{Packer, Unpacker};
use streams::Inflated;

const MAGIC: [u8; 8] = *b"\x89IPPAC\r\n";

const PACKED_VERSION: u32 = 1;

/// The maximum size in bytes of a recording that can be packed, or that results from unpacking.
pub const MAX_UNPACKED: usize = 1 << 30;

/// The maximum number of bytes of the streams per byte of the recording. It bounds the memory of
/// unpacking.
const STREAM_BYTES: usize = 2;

/// Returns `true` if the bytes begin with the signature of a packed recording.
#[must_use]
pub fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Packs a recording. The last record may be missing, but the bytes must end with a complete
/// record.
///
/// [`unpack`] returns the same recording to the bit, except for the hashes of objects in its
/// updates. These are omitted, since random bits cannot be compressed. A differing replay is still
/// detected at its step, by the hash of the state, but the object is unknown. Updates of version 1
/// of the format keep the hashes.
///
/// Costs time in proportion to the number of bytes, and about three times their memory, beside at
/// most 700 bytes for each object.
///
/// # Errors
/// If the bytes are no recording, a checksum is wrong, a record is incomplete, a record moves an
/// object that was never added, or the recording has more than [`MAX_UNPACKED`] bytes.
///
/// ```
/// use impinge_record::{Recorder, Registry, is_packed, pack, unpack, validate};
///
/// let registry = Registry::<f64, 2, ()>::new();
/// let mut recorder = Recorder::new(0.02, registry.clone())?;
/// (0..100).for_each(|_| recorder.update());
/// let bytes = recorder.finish().bytes;
/// let packed = pack(&bytes).expect("it was just written");
/// assert!(is_packed(&packed) && packed.len() < bytes.len() / 10);
/// let bytes = unpack(&packed).expect("it was just packed");
/// assert_eq!(validate(&bytes, &registry), Ok(None), "the replay has the same bits");
/// # Ok::<(), impinge_record::RecordError>(())
/// ```
pub fn pack(bytes: &[u8]) -> Result<Vec<u8>, ReadError> {
    if bytes.len() > MAX_UNPACKED {
        let problem = Problem::TooLarge { bytes: bytes.len() as u64 };
        return Err(ReadError { offset: 0, problem });
    }
    let header = Header::read(bytes)?;
    let packed = Packer::new(&header)?.pack(bytes)?;
    let mut sink = Sink::default();
    sink.bytes.extend(MAGIC);
    sink.word(PACKED_VERSION);
    sink.bytes.extend([header.scalar_bytes, header.dimension]);
    sink.long(packed.length);
    sink.word(packed.checksum);
    packed.streams.write(&mut sink);
    Ok(sink.bytes)
}

/// Unpacks a recording.
///
/// Costs time in proportion to the number of bytes of the recording, and about three times their
/// memory, beside at most 700 bytes for each object. Errors in compressed data have the offset at
/// which this data begins.
///
/// # Errors
/// If the bytes are no packed recording of a supported version, if they were changed, or if the
/// recording would have more than [`MAX_UNPACKED`] bytes.
pub fn unpack(bytes: &[u8]) -> Result<Vec<u8>, ReadError> {
    let mut source = Source::new(bytes, 0..bytes.len());
    let start = source.error(Problem::NotARecording);
    if source.take(MAGIC.len()).map_err(|_| start.clone())? != MAGIC {
        return Err(start);
    }
    let version = source.error(Problem::Version { found: 0 });
    match source.word()? {
        PACKED_VERSION => {}
        found => return Err(ReadError { problem: Problem::Version { found }, ..version }),
    }
    let layout = poses::Layout::new(source.byte()?, source.byte()?);
    let layout = layout.map_err(|problem| source.error(problem))?;
    let large = source.offset();
    let length = source.long()?;
    let limit = usize::try_from(length).ok().filter(|length| *length <= MAX_UNPACKED);
    let problem = Problem::TooLarge { bytes: length };
    let limit = limit.ok_or(ReadError { offset: large, problem })?;
    let (offset, checksum) = (source.offset(), source.word()?);
    let streams = Inflated::read(&mut source, limit.saturating_mul(STREAM_BYTES))?;
    source.finish()?;
    let log = Unpacker::new(layout, streams, limit).unpack()?;
    let is_same = log.bytes.len() == limit && log.checksum() == checksum;
    let problem = Problem::Checksum;
    if is_same { Ok(log.bytes) } else { Err(ReadError { offset, problem }) }
}
