//! The streams of a packed recording, each compressed separately.

use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;

use crate::bytes::{Sink, Source};
use crate::error::{Problem, ReadError};

/// The stream of record kinds, lengths, and all fields without a stream of their own.
pub(super) const PLAIN: usize = 0;
/// The stream of the differences between consecutive indices of objects.
pub(super) const INDICES: usize = 1;
/// The stream of the low bits of residuals, which are nearly random.
pub(super) const BITS: usize = 2;
/// The first of the streams of symbols: one for each number of a pose.
pub(super) const SYMBOLS: usize = 3;

/// The compression level of deflate: the slowest one except exhaustive search.
const LEVEL: u8 = 9;

/// Residuals below this number are their own symbols.
const SMALL: u64 = 16;
/// The length in bits of the smallest residual that is not its own symbol.
const SHORTEST: u32 = 5;

/// Streams for writing.
#[derive(Debug)]
pub(super) struct Streams {
    sinks: Vec<Sink>,
    /// The bits that do not fill a word yet; the oldest bit is the lowest.
    open: u64,
    open_bits: u32,
}

impl Streams {
    /// Creates streams for poses of `numbers` numbers each.
    pub(super) fn new(numbers: usize) -> Self {
        Self { sinks: vec![Sink::default(); SYMBOLS + numbers], open: 0, open_bits: 0 }
    }

    pub(super) fn sink(&mut self, stream: usize) -> &mut Sink {
        &mut self.sinks[stream]
    }

    /// Writes the residual of one number of a pose. A residual below [`SMALL`] is its own symbol.
    /// Otherwise the symbol encodes the length and the second-highest bit, and the lower bits go to
    /// the stream [`BITS`].
    pub(super) fn residual(&mut self, number: usize, residual: u64) {
        let length = u64::BITS - residual.leading_zeros();
        let (symbol, low) = match length.checked_sub(SHORTEST) {
            None => (residual, 0),
            Some(longer) => {
                let second = residual >> (length - 2) & 1;
                (SMALL + 2 * u64::from(longer) + second, length - 2)
            }
        };
        let symbol = u8::try_from(symbol).expect("64 bits have 136 symbols");
        self.sinks[SYMBOLS + number].byte(symbol);
        self.bits(residual, low);
    }

    /// Writes the lowest `count` bits of a value, the lowest bit first, to the stream [`BITS`].
    fn bits(&mut self, value: u64, count: u32) {
        for bit in 0..count {
            self.open |= (value >> bit & 1) << self.open_bits;
            self.open_bits += 1;
            if self.open_bits == u64::BITS {
                self.sinks[BITS].long(std::mem::take(&mut self.open));
                self.open_bits = 0;
            }
        }
    }

    /// Compresses all streams and writes their number, then the length and the compressed bytes of
    /// each.
    pub(super) fn write(mut self, sink: &mut Sink) {
        self.sinks[BITS].long(self.open);
        sink.count(self.sinks.len());
        for stream in &self.sinks {
            sink.count(stream.bytes.len());
            sink.blob(&compress_to_vec(&stream.bytes, LEVEL));
        }
    }
}

/// Streams for reading.
#[derive(Debug)]
pub(super) struct Inflated {
    streams: Vec<Stream>,
    open: u64,
    open_bits: u32,
}

/// A stream, and the position up to which it was read.
#[derive(Debug)]
struct Stream {
    bytes: Vec<u8>,
    at: usize,
    /// The offset of the stream's compressed bytes in the recording.
    offset: usize,
}

impl Inflated {
    /// Reads all streams; an error if they have more than `limit` bytes in total.
    pub(super) fn read(source: &mut Source<'_>, mut limit: usize) -> Result<Self, ReadError> {
        // The last word of the bits may be padded by up to eight bytes.
        limit += 8;
        let streams = source.list(8, |source| {
            let large = source.offset();
            let length = source.word()? as usize;
            let problem = Problem::TooLarge { bytes: length as u64 };
            limit = limit.checked_sub(length).ok_or(ReadError { offset: large, problem })?;
            let damaged = source.error(Problem::Compression);
            let offset = source.offset();
            let bytes = decompress_to_vec_with_limit(source.blob()?, length);
            let bytes = bytes.ok().filter(|bytes| bytes.len() == length).ok_or(damaged)?;
            Ok(Stream { bytes, at: 0, offset })
        })?;
        Ok(Self { streams, open: 0, open_bits: 0 })
    }

    /// Reads from a stream. Errors have the offset of the stream's compressed bytes.
    pub(super) fn pull<'a, T>(
        &'a mut self,
        stream: usize,
        read: impl FnOnce(&mut Source<'a>) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        let missing = self.error(stream, Problem::Truncated);
        let Stream { bytes, at, offset } = self.streams.get_mut(stream).ok_or(missing)?;
        let mut source = Source::new(bytes, *at..bytes.len());
        let value = read(&mut source);
        *at = source.offset();
        value.map_err(|error| ReadError { offset: *offset, ..error })
    }

    /// Returns an error with the offset of the stream's compressed bytes; 0 if there is no such
    /// stream.
    pub(super) fn error(&self, stream: usize, problem: Problem) -> ReadError {
        ReadError { offset: self.streams.get(stream).map_or(0, |stream| stream.offset), problem }
    }

    /// Returns `true` if all bytes of the stream were read, or if there is no such stream.
    pub(super) fn is_read(&self, stream: usize) -> bool {
        self.streams.get(stream).is_none_or(|stream| stream.at == stream.bytes.len())
    }

    /// Reads the residual of one number of a pose.
    pub(super) fn residual(&mut self, number: usize) -> Result<u64, ReadError> {
        let symbol = u64::from(self.pull(SYMBOLS + number, Source::byte)?);
        let Some(above) = symbol.checked_sub(SMALL) else { return Ok(symbol) };
        let (second, low) = (above & 1, above / 2 + u64::from(SHORTEST) - 2);
        let problem = Problem::BadValue { what: "the symbol of a residual" };
        let low = u32::try_from(low).ok().filter(|low| low + 2 <= u64::BITS);
        let low = low.ok_or_else(|| self.error(SYMBOLS + number, problem))?;
        Ok((2 | second) << low | self.bits(low)?)
    }

    fn bits(&mut self, count: u32) -> Result<u64, ReadError> {
        let mut value = 0;
        for bit in 0..count {
            if self.open_bits == 0 {
                self.open = self.pull(BITS, Source::long)?;
                self.open_bits = u64::BITS;
            }
            value |= (self.open & 1) << bit;
            self.open >>= 1;
            self.open_bits -= 1;
        }
        Ok(value)
    }
}
