//! The implementation of the scalar `f64`, with the feature `f64`.

use super::{Compiled, Here};
use crate::math::{Real, f64_power_of_two_below};

impl Compiled<2> for f64 {
    type Here = Here;
}

impl Compiled<3> for f64 {
    type Here = Here;
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const HALF: Self = 0.5;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const EPSILON: Self = Self::EPSILON;
    const MAX: Self = Self::MAX;
    const MIN_POSITIVE: Self = Self::MIN_POSITIVE;
    const INFINITY: Self = Self::INFINITY;
    const QUARTER_TURN: [Self; 3] =
        [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

    #[inline]
    fn lit(value: f64) -> Self {
        value
    }

    fn as_f64(self) -> f64 {
        self
    }

    #[inline]
    fn bits(self) -> u64 {
        self.to_bits()
    }

    #[inline]
    fn of_bits(bits: u64) -> Self {
        Self::from_bits(bits)
    }

    #[inline]
    fn power_of_two_below(self) -> Self {
        f64_power_of_two_below(self)
    }

    #[inline]
    fn is_finite_number(self) -> bool {
        self.is_finite()
    }

    fn sine_cosine(self) -> (Self, Self) {
        libm::sincos(self)
    }
}
