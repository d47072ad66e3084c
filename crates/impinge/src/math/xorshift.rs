//! Random numbers for unit tests.

use super::{Real, Vector};

/// A generator of random numbers from -1 to 1 (Marsaglia, "Xorshift RNGs", 2003). The state must
/// not be zero.
pub(crate) struct Xorshift(pub(crate) u64);

impl Xorshift {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector<N: Real>(&mut self, size: f64) -> Vector<N, 3> {
        Vector::<N, 3>::from_fn(|_, _| N::lit(size * self.next()))
    }
}
