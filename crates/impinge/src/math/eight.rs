//! Eight numbers side by side: what algorithms compute in that treat eight pairs at once.

use fearless_simd::{Select, Simd, SimdFloat, f32x8};

/// A scalar of which eight make a vector, for every instruction set.
#[expect(unnameable_types, reason = "for this crate alone")]
pub trait Eight: Sized {
    /// Eight of them: one register, or two or four.
    type Lanes<S: Simd>: Wide<S, Scalar = Self>;
}

impl Eight for f32 {
    type Lanes<S: Simd> = f32x8<S>;
}

#[cfg(feature = "f64")]
impl Eight for f64 {
    type Lanes<S: Simd> = fearless_simd::f64x8<S>;
}

/// A vector of scalars.
///
/// Used with the operations of IEEE 754 alone (sums, products, quotients, roots, comparisons), so
/// that each lane has the bits that the scalar would have. `Scalar` is another name for `Element`,
/// which generic code cannot equate with its `N` without losing nalgebra's operators on `N`.
#[expect(unnameable_types, reason = "for this crate alone")]
pub trait Wide<S: Simd>: SimdFloat<S> {
    /// What one lane holds.
    type Scalar;

    /// The same number in all lanes.
    fn all(simd: S, value: Self::Scalar) -> Self;
    /// As many numbers as there are lanes.
    fn load(simd: S, numbers: &[Self::Scalar]) -> Self;
    /// Writes as many numbers as there are lanes.
    fn store(self, numbers: &mut [Self::Scalar]);
    /// The greatest, of numbers none of which is NaN; of zeros with different signs either.
    fn greatest(self) -> Self::Scalar;

    /// The smaller number; the second if either is NaN.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.simd_lt(other).select(self, other)
    }

    /// The larger number; the second if either is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.simd_gt(other).select(self, other)
    }
}

impl<S: Simd, V: SimdFloat<S>> Wide<S> for V {
    type Scalar = V::Element;

    #[inline(always)]
    fn all(simd: S, value: V::Element) -> Self {
        V::splat(simd, value)
    }

    #[inline(always)]
    fn load(simd: S, numbers: &[V::Element]) -> Self {
        V::from_slice(simd, numbers)
    }

    #[inline(always)]
    fn store(self, numbers: &mut [V::Element]) {
        self.store_slice(numbers);
    }

    #[inline(always)]
    fn greatest(self) -> V::Element {
        self.reduce_max()
    }
}
