//! SIMD vectors of 8 numbers, and the instruction sets of each target.
//!
//! A kernel is a function that is generic over [`Simd`] and [`Wide`]. All operations follow IEEE
//! 754, so each lane is bitwise equal to a scalar computation. There are two kinds of kernels:
//!
//! * in some kernels, each lane is a pair or a part, independent of the other lanes. [`in_lanes!`]
//!   runs these with the vectors of the target, or lane by lane if [`Level::vectors`] returns
//!   `None`: see [`Level::runs`];
//! * in the other kernels, lanes interact. For example, the lanes are features of one solid, and
//!   the kernel selects the best feature; or a step reads rows that the previous step wrote for all
//!   lanes (chains, balls among triangles, checkers). [`with_lanes!`] runs these with all lanes on
//!   every target, on [`Arrays`](super::arrays::Arrays) if there are no vectors.
//!
//! [`in_lanes!`]: super::lanes::in_lanes
//! [`with_lanes!`]: super::lanes::with_lanes

use core::ops::{
    Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, Div, Mul, Neg, Not, Sub,
};

use fearless_simd::{Select, SimdBase, SimdFloat};

#[cfg(any(
    all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"),
    all(target_arch = "aarch64", target_feature = "neon"),
    all(target_arch = "wasm32", target_feature = "simd128")
))]
use super::halves::Halves;

/// The instruction set of a kernel. It never changes a result.
///
/// On x86 this is AVX2; without AVX2, kernels with interacting lanes use SSE2. Instruction sets
/// between these two are hardly faster than SSE2, registers wider than 8 lanes are of no use, and
/// each instruction set adds one more copy of all kernels.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Level {
    Wide(Vectors),
    /// Vectors of four `f32`, for kernels with interacting lanes. Kernels with independent lanes
    /// run lane by lane, to halve the code.
    #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
    Sse2(fearless_simd::Sse2),
    /// No vectors: arrays of numbers; also used in tests.
    Arrays,
}

/// An instruction set whose vectors make all kernels faster.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Vectors {
    #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
    Avx2(fearless_simd::Avx2),
    #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
    Neon(fearless_simd::Neon),
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128(fearless_simd::WasmSimd128),
}

/// Whether kernels are also compiled for arrays: on targets without vectors, and for tests.
pub(crate) const ON_ARRAYS: bool = cfg!(any(
    test,
    not(any(
        all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"),
        all(target_arch = "aarch64", target_feature = "neon"),
        all(target_arch = "wasm32", target_feature = "simd128")
    ))
));

impl Level {
    /// Returns the best level of this machine.
    #[inline]
    pub(crate) fn new() -> Self {
        let level = fearless_simd::Level::new();
        #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
        let best = match (level.as_avx2(), level.as_sse2()) {
            (Some(avx2), _) => Self::Wide(Vectors::Avx2(avx2)),
            (None, Some(sse2)) => Self::Sse2(sse2),
            (None, None) => Self::Arrays,
        };
        #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
        let best = level.as_neon().map_or(Self::Arrays, |neon| Self::Wide(Vectors::Neon(neon)));
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        let best =
            level.as_wasm_simd128().map_or(Self::Arrays, |simd| Self::Wide(Vectors::Simd128(simd)));
        #[cfg(not(any(
            all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"),
            all(target_arch = "aarch64", target_feature = "neon"),
            all(target_arch = "wasm32", target_feature = "simd128")
        )))]
        let best = {
            let _ = level;
            Self::Arrays
        };
        best
    }

    /// Returns the vectors for kernels with independent lanes; `None` if these kernels must compute
    /// one lane at a time.
    ///
    /// In a build without optimization every vector operation is a chain of calls, and slower than
    /// the scalar operations on its numbers. Such a build computes a pile of boxes 2.5 times as
    /// fast in single lanes. The results are bitwise equal.
    #[inline]
    pub(crate) fn vectors(self) -> Option<Vectors> {
        match self {
            Self::Wide(vectors) if !cfg!(unoptimized) => Some(vectors),
            _ => None,
        }
    }

    /// Returns the runs in which a kernel processes the first `lanes` lanes of a packet: a single
    /// run for all lanes, or one run per lane.
    #[inline]
    pub(crate) fn runs(self, lanes: usize) -> impl Iterator<Item = Run> {
        let vectors = self.vectors();
        let step = if vectors.is_some() { lanes.max(1) } else { 1 };
        (0..lanes).step_by(step).map(move |first| Run { vectors, first, end: first + step })
    }

    /// Returns all levels of this machine, the best first and arrays last, for tests.
    pub(crate) fn available() -> Vec<Self> {
        let mut all = vec![Self::new()];
        #[cfg(target_arch = "x86_64")]
        all.extend(fearless_simd::Level::new().as_sse2().map(Self::Sse2));
        all.push(Self::Arrays);
        all
    }
}

/// The lanes that a kernel processes at once: all used lanes with vectors, else a single lane
/// ([`OneLane`](super::lone::OneLane)).
///
/// A kernel stores valid results only for the lanes of its run. Each lane is bitwise equal in both
/// cases, since lanes are independent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub(crate) vectors: Option<Vectors>,
    pub(crate) first: usize,
    end: usize,
}

impl Run {
    /// Returns the lanes of this run.
    #[inline]
    pub(crate) fn lanes(&self) -> core::ops::Range<usize> {
        self.first..self.end
    }

    /// Returns the bits of the lanes of this run, and zero for other lanes; `bits` has a bit for
    /// each of 8 lanes.
    #[inline]
    pub(crate) fn of_bits(&self, bits: u8) -> u8 {
        self.lanes().fold(0, |own, lane| own | bits & 1 << lane)
    }
}

/// A scalar that has vectors of 8 lanes.
#[expect(unnameable_types, reason = "for this crate alone")]
pub trait Eight: Sized {
    /// The type of vectors of 8 such scalars.
    type Lanes<S: Simd>: Wide<S, Scalar = Self>;
}

impl Eight for f32 {
    type Lanes<S: Simd> = S::F32x8;
}

impl Eight for f64 {
    type Lanes<S: Simd> = S::F64x8;
}

/// An instruction set with its vector types. A value of such a type proves that the machine
/// supports the instruction set.
#[expect(unnameable_types, reason = "for this crate alone")]
pub trait Simd: Copy {
    /// A vector of eight `f32`.
    type F32x8: Wide<Self, Scalar = f32>;
    /// A vector of eight `f64`.
    type F64x8: Wide<Self, Scalar = f64>;
}

/// A vector mask: a truth value in each lane.
#[expect(unnameable_types, reason = "for this crate alone")]
pub trait SimdMask<S: Simd>:
    Copy
    + BitAnd<Output = Self>
    + BitAndAssign
    + BitOr<Output = Self>
    + BitOrAssign
    + BitXor<Output = Self>
    + Not<Output = Self>
{
    /// The number of lanes.
    const LEN: usize;

    /// Returns a bit for each lane; bit `i` is lane `i`.
    fn to_bitmask(self) -> u64;
    /// Returns whether the mask is true in any lane.
    fn any_true(self) -> bool;
    /// Returns whether the mask is true in all lanes.
    fn all_true(self) -> bool;

    /// Returns, in each lane, `one` where the mask is true, else `other`.
    #[inline(always)]
    fn select<V: Wide<S, Mask = Self>>(self, one: V, other: V) -> V {
        V::selected(self, one, other)
    }
}

/// A vector of scalars.
#[expect(unnameable_types, reason = "for this crate alone")]
pub trait Wide<S: Simd>:
    Copy
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The type of a lane.
    type Scalar;
    /// The type of masks: the results of comparisons.
    type Mask: SimdMask<S>;

    /// Broadcasts a number to all lanes.
    fn all(simd: S, value: Self::Scalar) -> Self;
    /// Loads one number for each lane from the start of `numbers`.
    fn load(simd: S, numbers: &[Self::Scalar]) -> Self;
    /// Stores the number of each lane to the start of `numbers`.
    fn store(self, numbers: &mut [Self::Scalar]);

    /// Returns the square root of each lane.
    fn sqrt(self) -> Self;
    /// Returns the magnitude of each lane.
    fn abs(self) -> Self;

    /// Returns the mask of the lanes where `self` is less than `other`; false for NaN.
    fn simd_lt(self, other: Self) -> Self::Mask;
    /// Returns the mask of the lanes where `self` is greater than `other`; false for NaN.
    fn simd_gt(self, other: Self) -> Self::Mask;
    /// Returns the mask of the lanes where `self` is at most `other`; false for NaN.
    fn simd_le(self, other: Self) -> Self::Mask;
    /// Returns the mask of the lanes where `self` is at least `other`; false for NaN.
    fn simd_ge(self, other: Self) -> Self::Mask;
    /// Returns the mask of the lanes where `self` equals `other`; false for NaN.
    fn simd_eq(self, other: Self) -> Self::Mask;

    /// Implements [`SimdMask::select`].
    fn selected(mask: Self::Mask, one: Self, other: Self) -> Self;

    /// Returns the smaller number in each lane; `other` if either is NaN.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.simd_lt(other).select(self, other)
    }

    /// Returns the larger number in each lane; `other` if either is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.simd_gt(other).select(self, other)
    }
}

#[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
impl Simd for fearless_simd::Avx2 {
    type F32x8 = fearless_simd::f32x8<Self>;
    type F64x8 = Halves<fearless_simd::f64x4<Self>>;
}

/// Eight `f64` are emulated by an array. A vector would take four of the 16 registers and hardly be
/// faster, and compiling such kernels took a tenth of the library's compile time.
#[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
impl Simd for fearless_simd::Sse2 {
    type F32x8 = Halves<fearless_simd::f32x4<Self>>;
    type F64x8 = super::arrays::Array<f64>;
}

#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
impl Simd for fearless_simd::Neon {
    type F32x8 = Halves<fearless_simd::f32x4<Self>>;
    type F64x8 = Halves<Halves<fearless_simd::f64x2<Self>>>;
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
impl Simd for fearless_simd::WasmSimd128 {
    type F32x8 = Halves<fearless_simd::f32x4<Self>>;
    type F64x8 = Halves<Halves<fearless_simd::f64x2<Self>>>;
}

impl<S: fearless_simd::Simd + Simd, M: fearless_simd::SimdMask<S>> SimdMask<S> for M {
    const LEN: usize = M::LEN;

    #[inline(always)]
    fn to_bitmask(self) -> u64 {
        fearless_simd::SimdMask::to_bitmask(self)
    }

    #[inline(always)]
    fn any_true(self) -> bool {
        fearless_simd::SimdMask::any_true(self)
    }

    #[inline(always)]
    fn all_true(self) -> bool {
        fearless_simd::SimdMask::all_true(self)
    }
}

impl<S: fearless_simd::Simd + Simd, V: SimdFloat<S>> Wide<S> for V {
    type Scalar = V::Element;
    type Mask = <V as SimdBase<S>>::Mask;

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
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        SimdBase::abs(self)
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> Self::Mask {
        SimdBase::simd_lt(self, other)
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> Self::Mask {
        SimdBase::simd_gt(self, other)
    }

    #[inline(always)]
    fn simd_le(self, other: Self) -> Self::Mask {
        SimdBase::simd_le(self, other)
    }

    #[inline(always)]
    fn simd_ge(self, other: Self) -> Self::Mask {
        SimdBase::simd_ge(self, other)
    }

    #[inline(always)]
    fn simd_eq(self, other: Self) -> Self::Mask {
        SimdBase::simd_eq(self, other)
    }

    #[inline(always)]
    fn selected(mask: Self::Mask, one: Self, other: Self) -> Self {
        Select::select(mask, one, other)
    }
}
