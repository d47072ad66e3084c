//! Splits records into streams, and rebuilds records from streams.

use std::collections::BTreeMap;

use super::poses::{Layout, PoseKind, Poses};
use super::streams::{INDICES, Inflated, PLAIN, Streams};
use crate::bytes::{Sink, Source, from_zigzag, zigzag};
use crate::call::kinds;
use crate::error::{Problem, ReadError};
use crate::log::{Cursor, Header, Log, Raw};

/// The number of bytes of an update before the flag that announces hashes of objects.
const UPDATE_BYTES: usize = 28;

/// The maximum length of a description, in bytes, that is not written again while it is unchanged.
/// If longer descriptions were repeated, a few packed bytes could unpack to many bytes.
const REPEATED_BYTES: usize = 256;

/// The bytes that describe each object, by index: shape, groups, query type and data.
type Descriptions = BTreeMap<u32, Vec<u8>>;

/// A recording split into streams.
#[derive(Debug)]
pub(super) struct Packed {
    pub(super) streams: Streams,
    /// The number of bytes of the unpacked recording.
    pub(super) length: u64,
    /// The last checksum of the unpacked recording.
    pub(super) checksum: u32,
}

/// Splits the records of a recording into streams.
#[derive(Debug)]
pub(super) struct Packer {
    layout: Layout,
    streams: Streams,
    poses: Poses,
    descriptions: Descriptions,
    /// The last index that was written.
    index: u32,
    checksum: crc32fast::Hasher,
    length: usize,
}

impl Packer {
    /// Creates a packer for recordings with this header.
    pub(super) fn new(header: &Header) -> Result<Self, ReadError> {
        let layout = Layout::new(header.scalar_bytes, header.dimension);
        let layout = layout.map_err(|problem| ReadError { offset: 0, problem })?;
        Ok(Self {
            layout,
            streams: Streams::new(layout.numbers),
            poses: Poses::new(layout),
            descriptions: Descriptions::new(),
            index: 0,
            checksum: crc32fast::Hasher::new(),
            length: 0,
        })
    }

    pub(super) fn pack(mut self, bytes: &[u8]) -> Result<Packed, ReadError> {
        let (end, mut cursor) = (Header::end(bytes)?, Cursor::default());
        cursor.pass(bytes, end)?;
        self.plain_bytes(&bytes[..end]);
        self.count(&[&bytes[..end]]);
        while cursor.offset() < bytes.len() {
            let start = cursor.offset();
            let raw = Raw::at(bytes, start)?;
            cursor.pass(bytes, raw.fields.end)?;
            self.streams.sink(PLAIN).byte(raw.kind);
            let mut source = Source::new(bytes, raw.fields.clone());
            match raw.kind {
                kinds::UPDATE => self.update(source.take(UPDATE_BYTES)?),
                _ => {
                    self.fields(raw.kind, &mut source)?;
                    self.count(&[&bytes[start..raw.fields.end]]);
                }
            }
        }
        let (length, checksum) = (self.length as u64, self.checksum.finalize());
        Ok(Packed { streams: self.streams, length, checksum })
    }

    /// Adds the bytes of a record to the checksum and the length of the unpacked recording, and the
    /// four bytes of its checksum to the length.
    fn count(&mut self, parts: &[&[u8]]) {
        for part in parts {
            self.checksum.update(part);
            self.length += part.len();
        }
        self.length += 4;
    }

    fn plain_bytes(&mut self, bytes: &[u8]) {
        let plain = self.streams.sink(PLAIN);
        plain.varint(bytes.len() as u64);
        plain.bytes.extend(bytes);
    }

    /// Adds an update. `hashes` are the bytes before the hashes of objects, which are omitted.
    fn update(&mut self, hashes: &[u8]) {
        self.streams.sink(PLAIN).bytes.extend(hashes);
        let mut head = Sink::default();
        head.byte(kinds::UPDATE);
        head.count(hashes.len() + 1);
        self.count(&[&head.bytes, hashes, &[0]]);
    }

    fn fields(&mut self, kind: u8, source: &mut Source<'_>) -> Result<(), ReadError> {
        match kind {
            kinds::ADD => self.object(source)?,
            kinds::SET_POSITIONS => {
                for _ in 0..self.list(source)? {
                    self.pose(source, PoseKind::Moved)?;
                }
            }
            kinds::KEY_FRAME => {
                for _ in 0..self.list(source)? {
                    self.plain_bytes(source.blob()?);
                }
                for _ in 0..self.list(source)? {
                    let vacant = source.word()?;
                    self.streams.sink(PLAIN).word(vacant);
                }
                for _ in 0..self.list(source)? {
                    self.object(source)?;
                }
            }
            _ => self.plain_bytes(source.take(source.remaining())?),
        }
        source.finish()
    }

    /// Adds the length of a list and returns it; the elements are added by the caller.
    fn list(&mut self, source: &mut Source<'_>) -> Result<usize, ReadError> {
        let length = source.count(4)?;
        self.streams.sink(PLAIN).varint(length as u64);
        Ok(length)
    }

    fn object(&mut self, source: &mut Source<'_>) -> Result<(), ReadError> {
        let index = self.pose(source, PoseKind::Placed)?;
        let start = source.offset();
        // The first bytes are the index of the shape (4) and the groups (13).
        source.take(4 + 13)?;
        let numbers = if source.choice(2, "the kind of a query type")? == 0 { 2 } else { 1 };
        source.take(numbers * self.layout.scalar_bytes)?;
        source.blob()?;
        let description = source.since(start);
        if self.descriptions.get(&index).is_some_and(|known| known == description) {
            self.streams.sink(PLAIN).varint(0);
            return Ok(());
        }
        self.plain_bytes(description);
        remember(&mut self.descriptions, index, description);
        Ok(())
    }

    /// Packs the index and the pose of an object; returns the index.
    fn pose(&mut self, source: &mut Source<'_>, kind: PoseKind) -> Result<u32, ReadError> {
        let place = source.offset();
        let index = source.word()?;
        let difference = i64::from(index) - i64::from(self.index);
        self.streams.sink(INDICES).varint(zigzag(difference));
        self.index = index;
        let pose = self.layout.bits(source.take(self.layout.pose_bytes())?);
        let written = self.poses.write(index, &pose, kind, &mut self.streams);
        written.map_err(|problem| ReadError { offset: place, problem })?;
        Ok(index)
    }
}

/// Stores the description of an object if it is short, so that it is not written again while it is
/// unchanged.
fn remember(descriptions: &mut Descriptions, index: u32, description: &[u8]) {
    if description.len() <= REPEATED_BYTES {
        descriptions.insert(index, description.to_vec());
    } else {
        descriptions.remove(&index);
    }
}

/// Rebuilds the records of a recording from streams.
#[derive(Debug)]
pub(super) struct Unpacker {
    layout: Layout,
    streams: Inflated,
    poses: Poses,
    descriptions: Descriptions,
    /// The last index that was read.
    index: u32,
    /// The number of bytes of the unpacked recording.
    limit: usize,
}

impl Unpacker {
    /// Creates an unpacker for a recording of `limit` bytes.
    pub(super) fn new(layout: Layout, streams: Inflated, limit: usize) -> Self {
        let (poses, descriptions) = (Poses::new(layout), Descriptions::new());
        Self { layout, streams, poses, descriptions, index: 0, limit }
    }

    pub(super) fn unpack(mut self) -> Result<Log, ReadError> {
        let mut log = Log::empty();
        log.append(&self.plain_bytes()?);
        while !self.streams.is_read(PLAIN) {
            let kind = self.streams.pull(PLAIN, Source::byte)?;
            let mut fields = Sink::default();
            self.fields(kind, &mut fields)?;
            let mut record = Sink::default();
            record.byte(kind);
            record.blob(&fields.bytes);
            log.append(&record.bytes);
            self.check(log.bytes.len())?;
        }
        Ok(log)
    }

    /// Checks that `length` does not exceed the length of the unpacked recording.
    fn check(&self, length: usize) -> Result<(), ReadError> {
        let problem = Problem::BadValue { what: "the length of the recording" };
        if length <= self.limit { Ok(()) } else { Err(ReadError { offset: 0, problem }) }
    }

    fn plain_bytes(&mut self) -> Result<Vec<u8>, ReadError> {
        let length = self.list_length()?;
        self.streams.pull(PLAIN, |source| Ok(source.take(length as usize)?.to_vec()))
    }

    fn list_length(&mut self) -> Result<u32, ReadError> {
        self.streams.pull(PLAIN, |source| {
            let error = source.error(Problem::BadValue { what: "a length" });
            u32::try_from(source.varint()?).map_err(|_| error)
        })
    }

    fn fields(&mut self, kind: u8, sink: &mut Sink) -> Result<(), ReadError> {
        match kind {
            kinds::ADD => self.object(sink)?,
            kinds::SET_POSITIONS => {
                for _ in 0..self.list(sink)? {
                    self.pose(sink, PoseKind::Moved)?;
                }
            }
            kinds::KEY_FRAME => {
                for _ in 0..self.list(sink)? {
                    sink.blob(&self.plain_bytes()?);
                }
                for _ in 0..self.list(sink)? {
                    sink.word(self.streams.pull(PLAIN, Source::word)?);
                }
                for _ in 0..self.list(sink)? {
                    self.object(sink)?;
                }
            }
            kinds::UPDATE => {
                let hashes = self
                    .streams
                    .pull(PLAIN, |source| source.take(UPDATE_BYTES).map(<[u8]>::to_vec))?;
                sink.bytes.extend(hashes);
                sink.flag(false);
            }
            _ => sink.bytes.extend(self.plain_bytes()?),
        }
        Ok(())
    }

    /// Reads the length of a list, writes it and returns it; the elements are read by the caller.
    fn list(&mut self, sink: &mut Sink) -> Result<u32, ReadError> {
        let length = self.list_length()?;
        sink.word(length);
        Ok(length)
    }

    fn object(&mut self, sink: &mut Sink) -> Result<(), ReadError> {
        let index = self.pose(sink, PoseKind::Placed)?;
        let description = self.plain_bytes()?;
        if !description.is_empty() {
            remember(&mut self.descriptions, index, &description);
            sink.bytes.extend(description);
            return Ok(());
        }
        let missing = self.streams.error(PLAIN, Problem::NoSuchObject(index));
        sink.bytes.extend(self.descriptions.get(&index).ok_or(missing)?);
        Ok(())
    }

    /// Unpacks the index and the pose of an object; returns the index.
    fn pose(&mut self, sink: &mut Sink, kind: PoseKind) -> Result<u32, ReadError> {
        let difference = from_zigzag(self.streams.pull(INDICES, Source::varint)?);
        let index = u32::try_from(i64::from(self.index).wrapping_add(difference));
        let problem = Problem::BadValue { what: "the index of an object" };
        self.index = index.map_err(|_| self.streams.error(INDICES, problem))?;
        let pose = self.poses.read(self.index, kind, &mut self.streams)?;
        sink.word(self.index);
        sink.bytes.extend(self.layout.bytes(&pose));
        self.check(sink.bytes.len())?;
        Ok(self.index)
    }
}
