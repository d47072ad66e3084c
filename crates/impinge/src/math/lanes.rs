//! Vectors and poses in SIMD lanes: each coordinate is a SIMD vector.
//!
//! Each operation sums in the order of its scalar counterpart, so that each lane is bitwise equal
//! to the scalar result. This file avoids `map`, since closures that are passed to `map` are not
//! inlined into SIMD code.

use super::simd::{Simd, SimdMask};
use super::{Matrix, Pose, Real, Vector, Wide, max};
use crate::math::filled;

/// Runs `$body` with `$simd` bound to the vectors of a [`Level`](super::simd::Level), or to arrays.
///
/// `$body` is compiled for each instruction set, so it should be a call of a kernel.
macro_rules! with_lanes {
    ($level:expr, $simd:ident => $body:expr) => {
        match $level {
            $crate::math::simd::Level::Wide(vectors) => {
                $crate::math::lanes::with_vectors!(vectors, $simd => $body)
            }
            #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
            $crate::math::simd::Level::Sse2($simd) => $crate::math::lanes::vectorized!($simd, $body),
            $crate::math::simd::Level::Arrays if $crate::math::simd::ON_ARRAYS => {
                let $simd = $crate::math::arrays::Arrays;
                $body
            }
            $crate::math::simd::Level::Arrays => unreachable!("this target has vectors"),
        }
    };
}

/// Runs `$body` with `$simd` bound to the vectors of a [`Run`](super::simd::Run), or to the single
/// lane of the run.
macro_rules! in_lanes {
    ($run:expr, $simd:ident => $body:expr) => {
        match $run.vectors {
            Some(vectors) => $crate::math::lanes::with_vectors!(vectors, $simd => $body),
            None => {
                let $simd = $crate::math::lone::OneLane($run.first);
                $body
            }
        }
    };
}

/// Runs `$body` with `$simd` bound to the vectors of an instruction set.
macro_rules! with_vectors {
    ($vectors:expr, $simd:ident => $body:expr) => {
        match $vectors {
            #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
            $crate::math::simd::Vectors::Avx2($simd) => {
                $crate::math::lanes::vectorized!($simd, $body)
            }
            #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
            $crate::math::simd::Vectors::Neon($simd) => {
                $crate::math::lanes::vectorized!($simd, $body)
            }
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            $crate::math::simd::Vectors::Simd128($simd) => {
                $crate::math::lanes::vectorized!($simd, $body)
            }
        }
    };
}

/// Compiles `$body` for an instruction set.
macro_rules! vectorized {
    ($simd:ident, $body:expr) => {
        fearless_simd::Simd::vectorize(
            $simd,
            #[inline(always)]
            || $body,
        )
    };
}

pub(crate) use {in_lanes, vectorized, with_lanes, with_vectors};

/// Broadcasts a literal to all lanes.
#[inline(always)]
pub(crate) fn lit<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, value: f64) -> V {
    V::all(simd, N::lit(value))
}

/// Returns the greatest of the numbers in the 8 lanes.
#[inline(always)]
pub(crate) fn highest_lane<S: Simd, N: Real, V: Wide<S, Scalar = N>>(numbers: V) -> N {
    let mut lanes = [N::ZERO; 8];
    numbers.store(&mut lanes);
    let [a, b, c, d, e, f, g, h] = lanes;
    max(max(max(a, e), max(c, g)), max(max(b, f), max(d, h)))
}

/// Broadcasts a vector to all lanes.
#[inline(always)]
pub(crate) fn spread<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    v: &Vector<N, D>,
) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| V::all(simd, v[axis]),
    )
}

/// Loads one vector for each lane; the block has one row per coordinate.
#[inline(always)]
pub(crate) fn load<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize, const L: usize>(
    simd: S,
    block: &[[N; L]; D],
) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| V::load(simd, &block[axis]),
    )
}

/// Returns `a − b` in each lane.
#[inline(always)]
pub(crate) fn minus<S: Simd, V: Wide<S>, const D: usize>(a: &[V; D], b: &[V; D]) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| a[axis] - b[axis],
    )
}

/// Returns `a + b` in each lane.
#[inline(always)]
pub(crate) fn plus<S: Simd, V: Wide<S>, const D: usize>(a: &[V; D], b: &[V; D]) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| a[axis] + b[axis],
    )
}

/// Returns each vector times the factor of its lane.
#[inline(always)]
pub(crate) fn times<S: Simd, V: Wide<S>, const D: usize>(v: &[V; D], factor: V) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| v[axis] * factor,
    )
}

/// Returns `−v` in each lane.
#[inline(always)]
pub(crate) fn negated<S: Simd, V: Wide<S>, const D: usize>(v: &[V; D]) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| -v[axis],
    )
}

/// Returns each vector divided by the divisor of its lane.
#[inline(always)]
pub(crate) fn over<S: Simd, V: Wide<S>, const D: usize>(v: &[V; D], divisor: V) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| v[axis] / divisor,
    )
}

/// Returns the dot product in each lane, summed in the order of the axes.
#[inline(always)]
pub(crate) fn dot<S: Simd, V: Wide<S>, const D: usize>(a: &[V; D], b: &[V; D]) -> V {
    let mut sum = a[0] * b[0];
    for axis in 1..D {
        sum += a[axis] * b[axis];
    }
    sum
}

/// Returns the length of the vector in each lane.
#[inline(always)]
pub(crate) fn norm<S: Simd, V: Wide<S>, const D: usize>(v: &[V; D]) -> V {
    dot(v, v).sqrt()
}

/// Returns the cross product in each lane.
#[inline(always)]
pub(crate) fn cross<S: Simd, V: Wide<S>>(a: &[V; 3], b: &[V; 3]) -> [V; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the components of a vector along `axes` in each lane: rotates it into the frame with
/// these axes.
#[inline(always)]
pub(crate) fn rotated_into<S: Simd, V: Wide<S>, const D: usize>(
    axes: &[[V; D]; D],
    vector: &[V; D],
) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| dot(&axes[axis], vector),
    )
}

/// Rotates the vector in each lane by the inverse of a rotation that is equal for all lanes.
#[inline(always)]
pub(crate) fn rotated_back<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    turn: &Matrix<N, 3>,
    v: &[V; 3],
) -> [V; 3] {
    filled(
        #[inline(always)]
        |axis| {
            let column: [V; 3] = filled(
                #[inline(always)]
                |row| V::all(simd, turn[(row, axis)]),
            );
            dot(&column, v)
        },
    )
}

/// Returns, in each lane, the vector `one` where `is` is true, else the vector `other`.
#[inline(always)]
pub(crate) fn either<S: Simd, V: Wide<S>, const D: usize>(
    is: V::Mask,
    one: &[V; D],
    other: &[V; D],
) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| is.select(one[axis], other[axis]),
    )
}

/// Returns, in each lane, the mask `one` where `is` is true, else the mask `other`.
#[inline(always)]
pub(crate) fn either_mask<S: Simd, M: SimdMask<S>>(is: M, one: M, other: M) -> M {
    (is & one) | (!is & other)
}

/// Returns a mask of 8 lanes as 8 bits; bit `i` is lane `i`.
#[inline(always)]
pub(crate) fn bits<S: Simd, M: SimdMask<S>>(mask: M) -> u8 {
    let [low, ..] = mask.to_bitmask().to_le_bytes();
    low
}

/// A [`Pose`] in each lane; the rotation is stored column by column.
pub(crate) struct LanePose<V, const D: usize> {
    pub(crate) rotation: [[V; D]; D],
    pub(crate) translation: [V; D],
}

impl<V, const D: usize> LanePose<V, D> {
    /// Broadcasts a pose to all lanes.
    #[inline(always)]
    pub(crate) fn of<S: Simd, N: Real>(simd: S, pose: &Pose<N, D>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let rotation = filled(
            #[inline(always)]
            |column| {
                filled(
                    #[inline(always)]
                    |row| V::all(simd, pose.rotation[(row, column)]),
                )
            },
        );
        Self { rotation, translation: spread(simd, &pose.translation) }
    }

    /// Computes [`Pose::vector`] in each lane.
    #[inline(always)]
    pub(crate) fn vector<S: Simd>(&self, local: &[V; D]) -> [V; D]
    where
        V: Wide<S>,
    {
        filled(
            #[inline(always)]
            |row| {
                let terms: [V; D] = filled(
                    #[inline(always)]
                    |column| self.rotation[column][row] * local[column],
                );
                let mut sum = terms[0];
                for &term in &terms[1..] {
                    sum += term;
                }
                sum
            },
        )
    }

    /// Computes [`Pose::point`] in each lane.
    #[inline(always)]
    pub(crate) fn point<S: Simd>(&self, local: &[V; D]) -> [V; D]
    where
        V: Wide<S>,
    {
        plus(&self.vector(local), &self.translation)
    }

    /// Computes [`Pose::inverse_point`] in each lane.
    #[inline(always)]
    pub(crate) fn inverse_point<S: Simd>(&self, outer: &[V; D]) -> [V; D]
    where
        V: Wide<S>,
    {
        rotated_into(&self.rotation, &minus(outer, &self.translation))
    }

    /// Computes [`Pose::inverse_point`] of the origin in each lane.
    #[inline(always)]
    pub(crate) fn inverse_origin<S: Simd, N: Real>(&self, simd: S) -> [V; D]
    where
        V: Wide<S, Scalar = N>,
    {
        self.inverse_point(&[V::all(simd, N::ZERO); D])
    }

    /// Returns the distance between the origins of two solids in each lane, if this is the pose of
    /// one solid in the frame of the other.
    #[inline(always)]
    pub(crate) fn apart<S: Simd>(&self) -> V
    where
        V: Wide<S>,
    {
        norm(&self.translation)
    }
}
