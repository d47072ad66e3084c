//! The small deterministic generator of all tests: it gives the same numbers on every machine and
//! in every build.
//!
//! `SplitMix64` (Guy Steele, Doug Lea, Christine Flood: Fast Splittable Pseudorandom Number
//! Generators, 2014): a counter whose bits are mixed. Only the four operations and the square root
//! are used, so the values have the same bits everywhere.

use crate::geometry::Pose;
use crate::geometry::vector::{axis, norm, perpendicular, scale};

/// A stream of random values, determined by its seed.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Creates the stream of a seed. Neighbouring seeds give unrelated streams.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a multiple of 2^-53 in [0, 1).
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number in [low, high); `low` if both bounds are equal. Rounding can give `high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Returns a number in [low, low * 2^doublings): first the number of doublings of `low` is
    /// drawn, then a factor in [1, 2). Returns `low` if `doublings` is 0.
    pub fn magnitude(&mut self, low: f64, doublings: u32) -> f64 {
        let Ok(count @ 1..) = usize::try_from(doublings) else { return low };
        let doubled = (0..self.below(count)).fold(low, |value, _| 2.0 * value);
        doubled * (1.0 + self.share())
    }

    /// Returns an integer in 0..count.
    ///
    /// # Panics
    /// If `count` is zero.
    pub fn below(&mut self, count: usize) -> usize {
        assert!(count > 0, "there is no number below zero");
        let count = u64::try_from(count).expect("a count fits 64 bits");
        usize::try_from(self.bits() % count).expect("it is below a usize")
    }

    /// Returns `true` with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.share() < probability
    }

    /// Returns a random item of the slice.
    ///
    /// # Panics
    /// If the slice is empty.
    pub fn pick<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        &items[self.below(items.len())]
    }

    /// Returns a multiple of 2^-k in [-limit, limit]. Sums and differences of a few such numbers
    /// are exact in `f32` too.
    pub fn grid(&mut self, limit: u32, k: u32) -> f64 {
        let steps = u64::from(limit) << k;
        let step = self.bits() % (2 * steps + 1);
        (step as f64 - steps as f64) / (1u64 << k) as f64
    }

    /// Returns a number of [low, high), rounded toward zero to an `f32`. It must be in the normal
    /// range of `f32`. The rounding can move it out of the interval if a bound is not an `f32`.
    pub fn single(&mut self, low: f64, high: f64) -> f64 {
        f32_toward_zero(self.range(low, high))
    }

    /// Returns a vector with all components in [-limit, limit).
    pub fn vector<const D: usize>(&mut self, limit: f64) -> [f64; D] {
        std::array::from_fn(|_| self.range(-limit, limit))
    }

    /// Returns a unit vector, distributed uniformly over all directions.
    pub fn unit_vector<const D: usize>(&mut self) -> [f64; D] {
        // Points of the cube are drawn until one lies in the ball. Points near its centre are
        // rejected too, since they would lose digits.
        loop {
            let v = self.vector::<D>(1.0);
            let length = norm(&v);
            if length > 0.01 && length <= 1.0 {
                return scale(&v, 1.0 / length);
            }
        }
    }

    /// Returns a unit quaternion `[x, y, z, w]`, distributed uniformly over all rotations.
    pub fn quaternion(&mut self) -> [f64; 4] {
        self.unit_vector()
    }

    /// Returns the rows of a rotation matrix, distributed uniformly over all rotations of 2D or 3D.
    ///
    /// # Panics
    /// Unless D is 2 or 3.
    pub fn rotation<const D: usize>(&mut self) -> [[f64; D]; D] {
        let first: [f64; D] = self.unit_vector();
        let mut rows: [[f64; D]; D] = std::array::from_fn(axis);
        rows[0] = first;
        if D == 2 {
            rows[1] = perpendicular(&[first]);
            return rows;
        }
        // The second row is the perpendicular component of a random direction, the third the cross
        // product. A direction nearly parallel to the first row is drawn again.
        loop {
            let cross = perpendicular::<D>(&[first, self.unit_vector()]);
            let length = norm(&cross);
            if length > 0.1 {
                rows[2] = scale(&cross, 1.0 / length);
                rows[1] = perpendicular(&[rows[2], first]);
                return rows;
            }
        }
    }

    /// Returns a pose with a random rotation, and a translation with all components in [-limit,
    /// limit).
    pub fn pose<const D: usize>(&mut self, limit: f64) -> Pose<D> {
        Pose { rotation: self.rotation(), translation: self.vector(limit) }
    }
}

/// Rounds toward zero to an `f32`, for values in the normal range of `f32`.
fn f32_toward_zero(value: f64) -> f64 {
    let dropped = 52 - 23;
    f64::from_bits(value.to_bits() >> dropped << dropped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::dot;

    #[test]
    fn known_stream() {
        // The first outputs for seed 1234567 that other implementations publish.
        let mut random = Random::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn values_keep_their_promises() {
        let mut random = Random::new(1);
        let mut sum = 0.0;
        for _ in 0..1000 {
            let x = random.range(-3.0, 5.0);
            assert!((-3.0..5.0).contains(&x), "range {x}");
            sum += x;
            let x = random.grid(4, 3);
            assert!(x.abs() <= 4.0 && (x * 8.0).fract() == 0.0, "grid {x}");
            let x = random.single(-3.0, 5.0);
            assert_eq!(x.to_bits() << 35, 0, "single {x}");
            assert!(random.below(7) < 7, "below");
            assert!((norm(&random.unit_vector::<3>()) - 1.0).abs() < 1e-15, "unit vector");
            assert!((0.25..16.0).contains(&random.magnitude(0.25, 6)), "magnitude");
        }
        assert!((sum / 1000.0 - 1.0).abs() < 0.2, "mean {}", sum / 1000.0);
    }

    #[test]
    fn rotations_are_rotations() {
        let mut random = Random::new(2);
        for _ in 0..100 {
            let [x, y, z] = random.rotation::<3>();
            assert!(dot(&x, &y).abs() < 1e-14 && dot(&y, &z).abs() < 1e-14, "{x:?} {y:?} {z:?}");
            assert!((dot(&perpendicular(&[x, y]), &z) - 1.0).abs() < 1e-14, "{x:?} {y:?} {z:?}");
            let [x, y] = random.rotation::<2>();
            assert_eq!([-x[1], x[0]], y);
        }
    }
}
