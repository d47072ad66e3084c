//! Random numbers that are equal on every run.

use impinge::math::na::{Quaternion, UnitComplex, UnitQuaternion};
use impinge::math::{Real, Vector};

/// `SplitMix64` (Steele, Lea and Flood, 2014). With the flag, half of the sizes and coordinates of
/// the solids made from it are zero.
pub struct Random(pub u64, pub bool);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number from -1 to 1, with so few digits that both scalars represent it exactly.
    pub fn signed(&mut self) -> f64 {
        let high = u32::try_from(self.bits() >> 44).expect("20 bits");
        f64::from(high) / f64::from(1 << 19) - 1.0
    }

    /// Returns a number from `low` to `high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.signed() * 0.5 + 0.5)
    }

    /// Returns 1; with the flag, returns 0 in half of the calls.
    pub fn size_or_zero(&mut self) -> f64 {
        if self.1 && self.bits() & 1 == 0 { 0.0 } else { 1.0 }
    }

    /// Returns a random vector in the unit ball that is longer than 0.1.
    pub fn vector<N: Real, const D: usize>(&mut self) -> Vector<N, D> {
        loop {
            let v = Vector::<f64, D>::from_fn(|_, _| self.signed());
            if v.norm() < 1.0 && v.norm() > 0.1 {
                return v.map(N::lit);
            }
        }
    }

    pub fn direction<N: Real, const D: usize>(&mut self) -> Vector<N, D> {
        self.vector::<N, D>().normalize()
    }

    pub fn turn2<N: Real>(&mut self) -> UnitComplex<N> {
        let v = self.direction::<N, 2>();
        UnitComplex::from_cos_sin_unchecked(v.x, v.y)
    }

    pub fn turn3<N: Real>(&mut self) -> UnitQuaternion<N> {
        let q = Quaternion::new(self.signed(), self.signed(), self.signed(), self.signed() + 1e-3);
        let v = q.coords.normalize().map(N::lit);
        UnitQuaternion::new_normalize(Quaternion::from(v))
    }
}
