//! The fields of a record: little-endian numbers, and lists. The length of a list is checked before
//! memory is allocated for it.

use std::ops::Range;

use crate::Scalar;
use crate::error::{Problem, ReadError};

/// Maps signed to unsigned numbers (zigzag encoding), so that small magnitudes become small
/// numbers: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
pub(crate) const fn zigzag(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)).cast_unsigned()
}

/// Returns the signed number that [`zigzag`] maps to this number.
pub(crate) const fn from_zigzag(zigzag: u64) -> i64 {
    (zigzag >> 1).cast_signed() ^ -(zigzag & 1).cast_signed()
}

/// Writes the bytes of one record.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sink {
    pub(crate) bytes: Vec<u8>,
}

impl Sink {
    /// Writes one byte, used for kinds and flags.
    pub(crate) fn byte(&mut self, value: u8) {
        self.bytes.push(value);
    }

    /// Writes a byte, 0 or 1.
    pub(crate) fn flag(&mut self, value: bool) {
        self.byte(u8::from(value));
    }

    /// Writes four bytes, used for masks and the indices of objects and shapes.
    pub(crate) fn word(&mut self, value: u32) {
        self.bytes.extend(value.to_le_bytes());
    }

    /// Writes a number in bytes of seven bits, the lowest bits first. All bytes but the last have
    /// the highest bit set.
    pub(crate) fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.bytes.push(value.to_le_bytes()[0] | 0x80);
            value >>= 7;
        }
        self.bytes.push(value.to_le_bytes()[0]);
    }

    /// Writes eight bytes, used for hashes.
    pub(crate) fn long(&mut self, value: u64) {
        self.bytes.extend(value.to_le_bytes());
    }

    /// Writes the bits of a number, in as many bytes as the scalar has.
    pub(crate) fn number<N: Scalar>(&mut self, value: N) {
        self.bytes.extend(&value.bits().to_le_bytes()[..N::BYTES]);
    }

    /// Writes numbers without their count, which the reader knows.
    pub(crate) fn numbers<N: Scalar>(&mut self, values: &[N]) {
        values.iter().for_each(|value| self.number(*value));
    }

    /// Writes the length of a list. No list of a world has 2^32 elements.
    pub(crate) fn count(&mut self, length: usize) {
        self.word(u32::try_from(length).expect("a world numbers its parts by 32 bits"));
    }

    /// Writes a list of bytes with its length.
    pub(crate) fn blob(&mut self, bytes: &[u8]) {
        self.count(bytes.len());
        self.bytes.extend(bytes);
    }
}

/// Reads a range of the bytes of a recording. Every error contains the offset in the recording.
#[derive(Clone, Debug)]
pub(crate) struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    end: usize,
}

impl<'a> Source<'a> {
    /// Creates a reader of the fields in `range`, which must be within `bytes`.
    pub(crate) const fn new(bytes: &'a [u8], range: Range<usize>) -> Self {
        Self { bytes, at: range.start, end: range.end }
    }

    /// Returns the offset of the next field.
    pub(crate) const fn offset(&self) -> usize {
        self.at
    }

    /// Returns the number of bytes left in the range.
    pub(crate) const fn remaining(&self) -> usize {
        self.end - self.at
    }

    /// Returns the bytes between `offset` and the next field.
    pub(crate) fn since(&self, offset: usize) -> &'a [u8] {
        &self.bytes[offset..self.at]
    }

    /// Returns an error with the offset of the next field.
    pub(crate) const fn error(&self, problem: Problem) -> ReadError {
        ReadError { offset: self.at, problem }
    }

    /// Reads the next `length` bytes; an error if fewer are left in the range.
    pub(crate) fn take(&mut self, length: usize) -> Result<&'a [u8], ReadError> {
        if length > self.remaining() {
            return Err(self.error(Problem::Truncated));
        }
        let start = self.at;
        self.at += length;
        Ok(&self.bytes[start..self.at])
    }

    fn array<const LENGTH: usize>(&mut self) -> Result<[u8; LENGTH], ReadError> {
        let mut array = [0; LENGTH];
        array.copy_from_slice(self.take(LENGTH)?);
        Ok(array)
    }

    pub(crate) fn byte(&mut self) -> Result<u8, ReadError> {
        self.array::<1>().map(|[byte]| byte)
    }

    /// Reads a byte less than `count`; `what` names the field in the error.
    pub(crate) fn choice(&mut self, count: u8, what: &'static str) -> Result<u8, ReadError> {
        let offset = self.at;
        let value = self.byte()?;
        let problem = Problem::BadValue { what };
        if value < count { Ok(value) } else { Err(ReadError { offset, problem }) }
    }

    pub(crate) fn flag(&mut self) -> Result<bool, ReadError> {
        self.choice(2, "a flag").map(|value| value == 1)
    }

    pub(crate) fn word(&mut self) -> Result<u32, ReadError> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn long(&mut self) -> Result<u64, ReadError> {
        self.array().map(u64::from_le_bytes)
    }

    /// Reads a number that [`Sink::varint`] has written.
    pub(crate) fn varint(&mut self) -> Result<u64, ReadError> {
        let error = self.error(Problem::BadValue { what: "a number of several bytes" });
        let mut value = 0;
        for shift in (0..u64::BITS).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(error)
    }

    pub(crate) fn number<N: Scalar>(&mut self) -> Result<N, ReadError> {
        let mut bits = [0; 8];
        bits[..N::BYTES].copy_from_slice(self.take(N::BYTES)?);
        Ok(N::of_bits(u64::from_le_bytes(bits)))
    }

    /// Reads `count` numbers. Memory is allocated only if the range contains as many.
    pub(crate) fn numbers<N: Scalar>(&mut self, count: usize) -> Result<Vec<N>, ReadError> {
        if count.saturating_mul(N::BYTES) > self.remaining() {
            return Err(self.error(Problem::Truncated));
        }
        (0..count).map(|_| self.number()).collect()
    }

    /// Reads the length of a list. `least`, at least 1, is the minimum size of an element in bytes.
    /// It is an error if the list does not fit into the rest of the range.
    pub(crate) fn count(&mut self, least: usize) -> Result<usize, ReadError> {
        let offset = self.at;
        let count = self.word()? as usize;
        let fits = count.saturating_mul(least) <= self.remaining();
        let problem = Problem::Truncated;
        if fits { Ok(count) } else { Err(ReadError { offset, problem }) }
    }

    /// Reads a list whose elements have at least `least` bytes each.
    pub(crate) fn list<E>(
        &mut self,
        least: usize,
        mut element: impl FnMut(&mut Self) -> Result<E, ReadError>,
    ) -> Result<Vec<E>, ReadError> {
        let count = self.count(least)?;
        (0..count).map(|_| element(self)).collect()
    }

    /// Reads a list of bytes, without a copy.
    pub(crate) fn blob(&mut self) -> Result<&'a [u8], ReadError> {
        let length = self.count(1)?;
        self.take(length)
    }

    /// Reads a list of bytes as UTF-8.
    pub(crate) fn text(&mut self) -> Result<String, ReadError> {
        let offset = self.at;
        let bytes = self.blob()?.to_vec();
        let problem = Problem::BadValue { what: "a name" };
        String::from_utf8(bytes).map_err(|_| ReadError { offset, problem })
    }

    /// Checks that the whole range was read.
    pub(crate) fn finish(&self) -> Result<(), ReadError> {
        if self.remaining() == 0 { Ok(()) } else { Err(self.error(Problem::TrailingBytes)) }
    }
}
