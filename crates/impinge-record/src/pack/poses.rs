//! Encodes poses as residuals: the difference of each number from a prediction.
//!
//! The motion of a body is predictable. Several candidates predict each number of a pose from the
//! last poses of the object. The candidate whose recent residuals of this number were the shortest
//! is used. The reader derives the same choice from the earlier poses, so the choice is not
//! written. All predictions are sums, products and quotients of `f64` in a fixed order, so every
//! machine computes the same bits.

use std::collections::BTreeMap;

use super::streams::{INDICES, Inflated, Streams};
use super::tracks::{Bits, MAX_NUMBERS, Track};
use crate::bytes::{from_zigzag, zigzag};
use crate::error::{Problem, ReadError};
use crate::space::Recordable;

/// The layout of the numbers of a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(super) scalar_bytes: usize,
    /// The number of components of the translation, which precede the components of the rotation.
    pub(super) dimension: usize,
    pub(super) numbers: usize,
}

impl Layout {
    /// Returns the layout for a scalar of `scalar_bytes` bytes and a dimension.
    pub(super) const fn new(scalar_bytes: u8, dimension: u8) -> Result<Self, Problem> {
        let numbers = match dimension {
            2 => <f64 as Recordable<2>>::ISOMETRY_NUMBERS,
            3 => <f64 as Recordable<3>>::ISOMETRY_NUMBERS,
            found => return Err(Problem::Dimension { found }),
        };
        let (scalar_bytes, dimension) = match scalar_bytes {
            4 | 8 => (scalar_bytes as usize, dimension as usize),
            found => return Err(Problem::Scalar { found }),
        };
        Ok(Self { scalar_bytes, dimension, numbers })
    }

    /// Returns the number of bytes of a pose.
    pub(super) const fn pose_bytes(&self) -> usize {
        self.numbers * self.scalar_bytes
    }

    /// Returns a mask of the bits of a number.
    const fn mask(&self) -> u64 {
        u64::MAX >> (64 - 8 * self.scalar_bytes)
    }

    /// Maps the bits of a number to an integer, such that the order of integers is the order of
    /// numbers.
    pub(super) const fn ordered(&self, bits: u64) -> u64 {
        let sign = self.mask() ^ (self.mask() >> 1);
        if bits & sign == 0 { bits | sign } else { !bits & self.mask() }
    }

    /// Returns the bits of the number that [`Self::ordered`] maps to this integer.
    const fn unordered(&self, integer: u64) -> u64 {
        let sign = self.mask() ^ (self.mask() >> 1);
        if integer & sign == 0 { !integer & self.mask() } else { integer ^ sign }
    }

    /// Returns the difference of two ordered integers, modulo 2^(bits of a number), in zigzag
    /// encoding: small differences of either sign are small numbers.
    pub(super) const fn residual(&self, actual: u64, predicted: u64) -> u64 {
        let unused = 64 - 8 * self.scalar_bytes;
        zigzag((actual.wrapping_sub(predicted) << unused).cast_signed() >> unused)
    }

    /// Returns the integer that has this residual from the prediction.
    const fn with_residual(&self, predicted: u64, residual: u64) -> u64 {
        predicted.wrapping_add_signed(from_zigzag(residual)) & self.mask()
    }

    /// Converts the bytes of a pose to the bits of its numbers.
    pub(super) fn bits(&self, bytes: &[u8]) -> Bits {
        let mut bits = [0; MAX_NUMBERS];
        for (own, number) in bits.iter_mut().zip(bytes.chunks_exact(self.scalar_bytes)) {
            let mut wide = [0; 8];
            wide[..self.scalar_bytes].copy_from_slice(number);
            *own = u64::from_le_bytes(wide);
        }
        bits
    }

    /// Converts the bits of the numbers of a pose to bytes.
    pub(super) fn bytes(&self, bits: &Bits) -> Vec<u8> {
        let number = |bits: &u64| bits.to_le_bytes().into_iter().take(self.scalar_bytes);
        bits.iter().take(self.numbers).flat_map(number).collect()
    }
}

/// The kind of call that gives an object a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PoseKind {
    /// The position of the object was set.
    Moved,
    /// The object was added, or is part of a key frame. Then its pose is most likely the last pose
    /// of its index.
    Placed,
}

/// The last poses of all objects by index, up to the current record.
#[derive(Debug)]
pub(super) struct Poses {
    layout: Layout,
    tracks: BTreeMap<u32, Track>,
}

impl Poses {
    pub(super) const fn new(layout: Layout) -> Self {
        Self { layout, tracks: BTreeMap::new() }
    }

    /// Returns the track of an object; an error if the object is moved but was never placed. So the
    /// bytes of a recording pay for its tracks: a move takes few packed bytes, a placed object many.
    fn track(&mut self, index: u32, kind: PoseKind) -> Result<&mut Track, Problem> {
        match kind {
            PoseKind::Placed => Ok(self.tracks.entry(index).or_default()),
            PoseKind::Moved => self.tracks.get_mut(&index).ok_or(Problem::NoSuchObject(index)),
        }
    }

    /// Writes the residuals of a pose.
    pub(super) fn write(
        &mut self,
        index: u32,
        pose: &Bits,
        kind: PoseKind,
        streams: &mut Streams,
    ) -> Result<(), Problem> {
        let layout = self.layout;
        let track = self.track(index, kind)?;
        let predictions = track.predictions(&layout, kind);
        for (number, bits) in pose.iter().enumerate().take(layout.numbers) {
            let predicted = track.best(number, &predictions);
            let actual = layout.ordered(*bits);
            streams.residual(number, layout.residual(actual, predicted));
        }
        track.learn(&layout, pose, kind, &predictions);
        Ok(())
    }

    /// Reads the residuals of a pose.
    pub(super) fn read(
        &mut self,
        index: u32,
        kind: PoseKind,
        streams: &mut Inflated,
    ) -> Result<Bits, ReadError> {
        let layout = self.layout;
        let track = self.track(index, kind).map_err(|problem| streams.error(INDICES, problem))?;
        let predictions = track.predictions(&layout, kind);
        let mut pose = [0; MAX_NUMBERS];
        for (number, bits) in pose.iter_mut().enumerate().take(layout.numbers) {
            let predicted = track.best(number, &predictions);
            let actual = layout.with_residual(predicted, streams.residual(number)?);
            *bits = layout.unordered(actual);
        }
        track.learn(&layout, &pose, kind, &predictions);
        Ok(pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bytes::{Sink, Source};

    /// Returns the streams of a list of poses, which are all zero.
    fn streams(poses: usize, layout: &Layout) -> Inflated {
        let mut streams = Streams::new(layout.numbers);
        for number in (0..poses).flat_map(|_| 0..layout.numbers) {
            streams.residual(number, 0);
        }
        let mut sink = Sink::default();
        streams.write(&mut sink);
        let mut source = Source::new(&sink.bytes, 0..sink.bytes.len());
        Inflated::read(&mut source, 1000).expect("they were just written")
    }

    #[test]
    fn a_packed_move_of_no_object_is_an_error() {
        let layout = Layout::new(4, 3).expect("a layout");
        let (mut poses, mut streams) = (Poses::new(layout), streams(3, &layout));
        let mut read = |index, kind| poses.read(index, kind, &mut streams);
        assert!(read(5, PoseKind::Placed).is_ok() && read(5, PoseKind::Moved).is_ok());
        let error = read(6, PoseKind::Moved).expect_err("there is no object 6");
        assert_eq!(error.problem, Problem::NoSuchObject(6));
        assert_eq!(poses.tracks.len(), 1, "it takes no memory");
    }

    /// Asserts that an object that is only placed takes about as much memory as its bytes.
    #[test]
    fn placed_objects_have_no_history() {
        assert_eq!(size_of::<Track>(), 8 * MAX_NUMBERS + size_of::<usize>());
    }
}
