//! The bytes of a recording: a header, then records with a running checksum.

use std::ops::Range;

use crate::bytes::{Sink, Source};
use crate::call::Call;
use crate::error::{Problem, ReadError};
use crate::space::Recordable;

/// The version of the format that this crate writes, and the latest version that it reads.
pub const FORMAT_VERSION: u32 = 3;

const MAGIC: [u8; 8] = *b"\x89IPREC\r\n";

/// The version of the library in the header.
const WRITER: &str = concat!("impinge ", env!("CARGO_PKG_VERSION"));

/// The bytes of an unfinished recording, and their checksum.
#[derive(Clone, Debug)]
pub(crate) struct Log {
    pub(crate) bytes: Vec<u8>,
    checksum: crc32fast::Hasher,
}

impl Log {
    /// Creates a log with its header.
    pub(crate) fn new<N: Recordable<D>, const D: usize>(margin: N) -> Self {
        let mut sink = Sink::default();
        sink.bytes.extend(MAGIC);
        sink.word(FORMAT_VERSION);
        sink.blob(WRITER.as_bytes());
        // These fit into a byte: there are at most eight bytes per number and three dimensions.
        sink.bytes.extend([N::BYTES, D].map(|small| u8::try_from(small).unwrap_or(u8::MAX)));
        sink.number(margin);
        let mut log = Self::empty();
        log.append(&sink.bytes);
        log
    }

    /// Appends a record: its kind, the length of its fields, the fields, and the checksum of all
    /// bytes so far except checksums.
    pub(crate) fn record<N: Recordable<D>, const D: usize>(&mut self, call: &Call<N, D>) {
        let (mut fields, mut sink) = (Sink::default(), Sink::default());
        call.write(&mut fields);
        sink.byte(call.kind());
        sink.blob(&fields.bytes);
        self.append(&sink.bytes);
    }

    /// Creates a log without a header, for the unpacker.
    pub(crate) fn empty() -> Self {
        Self { bytes: Vec::new(), checksum: crc32fast::Hasher::new() }
    }

    /// Returns the checksum of all bytes so far except checksums.
    pub(crate) fn checksum(&self) -> u32 {
        self.checksum.clone().finalize()
    }

    /// Appends a header or a record, and its checksum.
    pub(crate) fn append(&mut self, bytes: &[u8]) {
        self.checksum.update(bytes);
        self.bytes.extend(bytes);
        self.bytes.extend(self.checksum().to_le_bytes());
    }
}

/// The content of the header of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// The version of the format.
    pub version: u32,
    /// The program that wrote the recording, with its version.
    pub writer: String,
    /// The number of bytes of a number: 4 for `f32`, 8 for `f64`.
    pub scalar_bytes: u8,
    /// The dimension of the world.
    pub dimension: u8,
}

impl Header {
    /// Reads the header of a recording of any scalar and dimension. The checksum of the header is
    /// not verified.
    ///
    /// # Errors
    /// If the bytes do not begin with the header of a recording of a supported version.
    ///
    /// ```
    /// use impinge_record::{Header, Recorder, Registry};
    ///
    /// let recorder = Recorder::<f32, 3, ()>::new(0.02, Registry::new()).expect("a usable margin");
    /// let header = Header::read(&recorder.finish().bytes).expect("it was just written");
    /// assert_eq!((header.version, header.scalar_bytes, header.dimension), (3, 4, 3));
    /// ```
    pub fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        Self::fields(&mut Source::new(bytes, 0..bytes.len()))
    }

    /// Returns `true` if bytes for which [`Self::read`] returned `error` may be the beginning of a
    /// valid header.
    ///
    /// ```
    /// use impinge_record::{Header, Recorder, Registry};
    ///
    /// let recorder = Recorder::<f32, 3, ()>::new(0.02, Registry::new()).expect("a usable margin");
    /// let bytes = recorder.finish().bytes;
    /// let is_begun = |bytes: &[u8]| Header::read(bytes).is_err_and(|error| Header::is_begun(bytes, &error));
    /// assert!(is_begun(&bytes[..3]) && is_begun(&bytes[..20]) && !is_begun(b"no recording"));
    /// ```
    #[must_use]
    pub fn is_begun(bytes: &[u8], error: &ReadError) -> bool {
        match error.problem {
            Problem::Truncated => true,
            Problem::NotARecording => MAGIC.starts_with(bytes),
            _ => false,
        }
    }

    /// Returns the offset of the checksum of the header; an error if the bytes end before it.
    pub(crate) fn end(bytes: &[u8]) -> Result<usize, ReadError> {
        let mut source = Source::new(bytes, 0..bytes.len());
        let header = Self::fields(&mut source)?;
        source.take(usize::from(header.scalar_bytes))?;
        Ok(source.offset())
    }

    fn fields(source: &mut Source<'_>) -> Result<Self, ReadError> {
        let start = source.error(Problem::NotARecording);
        if source.take(MAGIC.len()).map_err(|_| start.clone())? != MAGIC {
            return Err(start);
        }
        let offset = source.offset();
        let version = source.word()?;
        if !(1..=FORMAT_VERSION).contains(&version) {
            return Err(ReadError { offset, problem: Problem::Version { found: version } });
        }
        let writer = source.text()?;
        Ok(Self { version, writer, scalar_bytes: source.byte()?, dimension: source.byte()? })
    }
}

/// The kind and the position of a record in the bytes.
#[derive(Clone, Debug)]
pub(crate) struct Raw {
    pub(crate) kind: u8,
    /// The range of the fields.
    pub(crate) fields: Range<usize>,
    /// The offset of the next record.
    pub(crate) end: usize,
}

impl Raw {
    /// Finds the record at an offset, without verifying its checksum.
    pub(crate) fn at(bytes: &[u8], offset: usize) -> Result<Self, ReadError> {
        let mut source = Source::new(bytes, offset..bytes.len());
        let (kind, length) = (source.byte()?, source.count(1)?);
        let start = source.offset();
        source.take(length)?;
        source.take(4)?;
        Ok(Self { kind, fields: start..start + length, end: source.offset() })
    }

    pub(crate) fn call<N: Recordable<D>, const D: usize>(
        &self,
        bytes: &[u8],
    ) -> Result<Call<N, D>, ReadError> {
        Call::read(self.kind, &mut Source::new(bytes, self.fields.clone()))
    }
}

/// The position up to which a recording was read. It advances by records with correct checksums.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cursor {
    checksum: crc32fast::Hasher,
    offset: usize,
}

impl Cursor {
    /// Returns the offset of the next record; 0 before the header.
    pub(crate) const fn offset(&self) -> usize {
        self.offset
    }

    /// Reads the header and verifies its checksum; returns the margin of the world.
    pub(crate) fn header<N: Recordable<D>, const D: usize>(
        &mut self,
        bytes: &[u8],
    ) -> Result<N, ReadError> {
        let mut source = Source::new(bytes, 0..bytes.len());
        let header = Header::fields(&mut source)?;
        let offset = source.offset() - 2;
        if usize::from(header.scalar_bytes) != N::BYTES {
            let problem = Problem::Scalar { found: header.scalar_bytes };
            return Err(ReadError { offset, problem });
        }
        if usize::from(header.dimension) != D {
            let problem = Problem::Dimension { found: header.dimension };
            return Err(ReadError { offset: offset + 1, problem });
        }
        let margin = source.number()?;
        self.pass(bytes, source.offset())?;
        Ok(margin)
    }

    /// Verifies the checksum at the offset `end`, which covers all earlier bytes except checksums.
    /// Moves the cursor behind this checksum.
    pub(crate) fn pass(&mut self, bytes: &[u8], end: usize) -> Result<(), ReadError> {
        let mut source = Source::new(bytes, end..bytes.len());
        let expected = source.word()?;
        let mut checksum = self.checksum.clone();
        checksum.update(&bytes[self.offset..end]);
        if checksum.clone().finalize() != expected {
            return Err(ReadError { offset: end, problem: Problem::Checksum });
        }
        *self = Self { checksum, offset: source.offset() };
        Ok(())
    }
}

/// Recomputes the checksums of a recording, up to the first incomplete record. For tests that
/// change bytes of a recording.
#[doc(hidden)]
pub fn reseal(bytes: &mut [u8]) {
    let mut checksum = crc32fast::Hasher::new();
    let Ok(mut end) = Header::end(bytes) else { return };
    let mut start = 0;
    while let Some(sum) = bytes.get(end..end + 4).map(|_| {
        checksum.update(&bytes[start..end]);
        checksum.clone().finalize()
    }) {
        bytes[end..end + 4].copy_from_slice(&sum.to_le_bytes());
        start = end + 4;
        let Ok(raw) = Raw::at(bytes, start) else { return };
        end = raw.fields.end;
    }
}
