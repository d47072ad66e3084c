//! Reads values from the input bytes of the fuzzer.

use impinge::math::{Point, Real, Vector};

/// The unread rest of the input. Once it is used up all further bytes are zero, so that every input
/// is valid.
#[derive(Debug)]
pub(crate) struct Bytes<'a> {
    rest: &'a [u8],
    /// Whether numbers may be tiny, huge, infinite or NaN. Otherwise they are moderate, and results
    /// must be finite.
    is_wild: bool,
}

impl<'a> Bytes<'a> {
    /// Creates a reader of the whole input.
    pub(crate) const fn new(rest: &'a [u8]) -> Self {
        Self { rest, is_wild: false }
    }

    /// Allows numbers of any size.
    pub(crate) const fn go_wild(&mut self) {
        self.is_wild = true;
    }

    /// Returns whether all numbers are moderate: multiples of 1/1024 with a magnitude of at most
    /// 32.
    pub(crate) const fn is_moderate(&self) -> bool {
        !self.is_wild
    }

    /// Returns whether the input is used up.
    pub(crate) const fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// Returns the next byte.
    pub(crate) fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.rest.split_first() else { return 0 };
        self.rest = rest;
        first
    }

    fn bytes<const COUNT: usize>(&mut self) -> [u8; COUNT] {
        std::array::from_fn(|_| self.byte())
    }

    /// Returns an index below `count`, which is from 1 to 256.
    pub(crate) fn choice(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// Returns a boolean.
    pub(crate) fn coin(&mut self) -> bool {
        self.byte() % 2 == 1
    }

    /// Returns a number. Small and round numbers, for which solids touch exactly, are more frequent
    /// than others.
    pub(crate) fn number<N: Real>(&mut self) -> N {
        let kinds = if self.is_wild { 16 } else { 11 };
        N::lit(match self.choice(kinds) {
            0..4 => f64::from(i8::from_le_bytes(self.bytes())) / 16.0,
            4..8 => f64::from(i8::from_le_bytes(self.bytes()) / 16),
            8..11 => f64::from(i16::from_le_bytes(self.bytes())) / 1024.0,
            11 | 12 => f64::from(f32::from_le_bytes(self.bytes())),
            13 => f64::from(i32::from_le_bytes(self.bytes())),
            14 => f64::from(i8::from_le_bytes(self.bytes())) * 1e-23,
            _ => f64::from_le_bytes(self.bytes()),
        })
    }

    /// Returns a finite number.
    pub(crate) fn finite<N: Real>(&mut self) -> N {
        let number = self.number::<N>();
        if number.is_finite_number() { number } else { N::ONE }
    }

    /// Returns a finite number, zero or more.
    pub(crate) fn size<N: Real>(&mut self) -> N {
        self.finite::<N>().abs()
    }

    /// Returns a vector of any numbers.
    pub(crate) fn vector<N: Real, const D: usize>(&mut self) -> Vector<N, D> {
        Vector::<N, D>::from_fn(|_, _| self.number())
    }

    /// Returns a vector of sizes.
    pub(crate) fn sizes<N: Real, const D: usize>(&mut self) -> Vector<N, D> {
        Vector::<N, D>::from_fn(|_, _| self.size())
    }

    /// Returns a point of finite numbers.
    pub(crate) fn point<N: Real, const D: usize>(&mut self) -> Point<N, D> {
        Point::from(Vector::<N, D>::from_fn(|_, _| self.finite()))
    }

    /// Returns up to 15 points.
    pub(crate) fn points<N: Real, const D: usize>(&mut self) -> Vec<Point<N, D>> {
        let count = self.choice(16);
        (0..count).map(|_| self.point()).collect()
    }

    /// Returns up to 12 tuples of indices below `count`, and rarely one more whose indices equal
    /// `count` and are thus invalid.
    pub(crate) fn indices<const ENDS: usize>(&mut self, count: usize) -> Vec<[u32; ENDS]> {
        let parts = self.choice(13);
        let mut index = || self.choice(count.max(1)) as u32;
        let mut parts: Vec<_> = (0..parts).map(|_| std::array::from_fn(|_| index())).collect();
        if self.byte() == 255 {
            parts.push([count as u32; ENDS]);
        }
        parts
    }
}
