//! Pseudorandom numbers, which are the same on every platform.

/// `SplitMix64`: Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators" (2014).
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Creates the sequence of a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    const fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Returns a number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        // 53 bits fill the fraction of an f64 exactly.
        let scale = 1.0 / f64::from(1_u32 << 27) / f64::from(1_u32 << 26);
        (self.bits() >> 11) as f64 * scale
    }

    /// Returns a number in [`low`, `high`), up to rounding.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Returns an integer in 0..`bound`.
    ///
    /// # Panics
    /// If `bound` is zero.
    pub fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.bits() % (bound as u64)).expect("below a usize")
    }

    /// Returns a random unit vector; all directions are equally likely. Draws points of a cube
    /// until one lies in the unit ball, but not near its centre, and normalizes this point.
    pub fn direction<const D: usize>(&mut self) -> [f64; D] {
        loop {
            let v: [f64; D] = std::array::from_fn(|_| self.between(-1.0, 1.0));
            let squared: f64 = v.iter().map(|x| x * x).sum();
            // In 2D and 3D at least half of the drawn points are accepted.
            if (0.01..=1.0).contains(&squared) {
                return v.map(|x| x / squared.sqrt());
            }
        }
    }

    /// Shuffles the items, so that neighbours in space are not neighbours in memory.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

/// Returns the `D`-th root of `x ≥ 0`.
///
/// Newton's iteration from above decreases monotonically. While far from the root, each step
/// divides the error by at least `D / (D − 1)`, so that 200 iterations suffice for any count of
/// objects.
pub(crate) fn root<const D: usize>(x: f64) -> f64 {
    let degree = D as f64;
    let mut guess = if x > 1.0 { x } else { 1.0 };
    for _ in 0..200 {
        let power = (1..D).fold(1.0, |power, _| power * guess);
        guess = ((degree - 1.0) * guess + x / power) / degree;
    }
    guess
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots() {
        assert!((root::<2>(2.0) - 2f64.sqrt()).abs() < 1e-15, "square root");
        assert!((root::<3>(27.0) - 3.0).abs() < 1e-14, "cube root");
        assert!((root::<3>(1e9) - 1e3).abs() < 1e-9, "a large one");
    }

    #[test]
    fn random_numbers_are_these_everywhere() {
        // The first output for seed 0 in the authors' reference code.
        assert_eq!(Random::new(0).bits(), 0xe220_a839_7b1d_cdaf);
        let mut random = Random::new(7);
        let mean = (0..1000).map(|_| random.unit()).sum::<f64>() / 1000.0;
        assert!((0.45..0.55).contains(&mean), "mean {mean}");
        let direction: [f64; 3] = random.direction();
        let squared: f64 = direction.iter().map(|x| x * x).sum();
        assert!((squared - 1.0).abs() < 1e-15, "unit: {squared}");
    }

    #[test]
    fn shuffling_keeps_all_items() {
        let mut items: Vec<usize> = (0..100).collect();
        Random::new(1).shuffle(&mut items);
        assert!(items.iter().enumerate().filter(|(i, x)| i == *x).count() < 10, "most moved");
        items.sort_unstable();
        assert_eq!(items, (0..100).collect::<Vec<_>>());
    }
}
