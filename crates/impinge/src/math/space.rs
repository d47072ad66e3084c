//! What is particular to the plane and to space, behind one bound.

use super::na::{Rotation2, Rotation3, UnitComplex, UnitQuaternion};
use super::{Isometry2, Isometry3, Pose, Real};
use crate::tables::Tables;
use core::fmt::Debug;

/// The scalar `Self` in `D` dimensions: implemented for every [`Real`] with `D` = 2 and `D` = 3.
///
/// Generic code that needs an algorithm of one dimension asks for `N: Space<D>`; a function for one
/// dimension only needs `N: Real`, which implies it.
pub trait Space<const D: usize>: Real {
    /// The user's type of a pose: nalgebra's `Isometry2` or `Isometry3`.
    type Isometry: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// The pose that an isometry describes.
    fn pose(isometry: &Self::Isometry) -> Pose<Self, D>;

    /// The isometry that a pose describes, up to rounding.
    fn isometry(pose: &Pose<Self, D>) -> Self::Isometry;

    /// The entry points compiled in this crate for this scalar and dimension.
    #[doc(hidden)]
    fn tables() -> &'static Tables<Self, D>;
}

impl<N: Real> Space<2> for N {
    type Isometry = Isometry2<N>;

    #[inline]
    fn pose(isometry: &Isometry2<N>) -> Pose<N, 2> {
        Pose::from_isometry(isometry)
    }

    fn isometry(pose: &Pose<N, 2>) -> Isometry2<N> {
        let rotation = Rotation2::from_matrix_unchecked(pose.rotation);
        let rotation = UnitComplex::from_rotation_matrix(&rotation);
        Isometry2::from_parts(pose.translation.into(), rotation)
    }

    fn tables() -> &'static Tables<N, 2> {
        N::plane()
    }
}

impl<N: Real> Space<3> for N {
    type Isometry = Isometry3<N>;

    #[inline]
    fn pose(isometry: &Isometry3<N>) -> Pose<N, 3> {
        Pose::from_isometry(isometry)
    }

    fn isometry(pose: &Pose<N, 3>) -> Isometry3<N> {
        let rotation = Rotation3::from_matrix_unchecked(pose.rotation);
        let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
        Isometry3::from_parts(pose.translation.into(), rotation)
    }

    fn tables() -> &'static Tables<N, 3> {
        N::space()
    }
}
