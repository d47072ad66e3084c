//! Scalars, vectors and poses. No other module of the library uses nalgebra directly.
//!
//! The other modules use the aliases of this module for vectors, points and matrices. The library
//! is generic over the scalar `N` (`f32` or `f64`) and the dimension `D` (2 or 3); [`Space`] is the
//! bound for code that depends on the dimension.
//!
//! All results are bitwise equal on every platform. For this reason the library uses no fused
//! multiply-add and no trigonometric functions of the platform, and [`min`] and [`max`] are one
//! comparison and a selection.

pub(crate) mod arrays;
pub(crate) mod eigen;
pub(crate) mod exact;
pub(crate) mod filled;
#[cfg(any(
    all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"),
    all(target_arch = "aarch64", target_feature = "neon"),
    all(target_arch = "wasm32", target_feature = "simd128")
))]
pub(crate) mod halves;
pub(crate) mod lanes;
pub(crate) mod lone;
#[cfg(feature = "serde")]
pub(crate) mod numbers;
pub(crate) mod ones;
pub(crate) mod order;
pub(crate) mod outward;
mod pose;
mod real;
mod rotation;
pub(crate) mod simd;
mod space;
pub(crate) mod trigonometry;
mod vector;
#[cfg(test)]
pub(crate) mod xorshift;

pub use nalgebra as na;
pub use nalgebra::{Isometry, Isometry2, Isometry3, Unit};

pub(crate) use filled::{Mapped, filled};
pub use pose::Pose;
pub use real::Real;
pub(crate) use real::{f32_above, f32_below, f64_power_of_two_below};
pub use rotation::AbstractRotation;
pub(crate) use rotation::{IsometryRef, pose_of};
pub(crate) use simd::Wide;
pub use space::Space;
pub(crate) use vector::is_unit;
pub use vector::{
    centroid, cross, cross2, max, max_component, min, orthonormal_basis, perp, perpendicular_to,
    unit, unit_or,
};

/// A vector of `D` components.
pub type Vector<N, const D: usize> = nalgebra::SVector<N, D>;
/// A point of `D` coordinates.
pub type Point<N, const D: usize> = nalgebra::OPoint<N, nalgebra::Const<D>>;
/// A square matrix with `D` rows; also the type of the rotation in a [`Pose`].
pub type Matrix<N, const D: usize> = nalgebra::SMatrix<N, D, D>;
