//! The rotation types that an isometry of the user may have.

use super::na::{self, Rotation, UnitComplex, UnitQuaternion};
use super::{Isometry, Pose, Real, Space, Vector};
use crate::tables::entries;

/// A rotation type of nalgebra: a unit complex number, a unit quaternion or a rotation matrix. The
/// trait is sealed.
///
/// Functions that take an isometry accept any of these rotations. The operations of a rotation are
/// in nalgebra's trait of the same name.
pub trait AbstractRotation<N: Real, const D: usize>: na::AbstractRotation<N, D> {
    /// Returns a reference to the isometry, tagged with the type of its rotation. So a function for
    /// all rotation types is compiled only once.
    #[doc(hidden)]
    fn view(isometry: &Isometry<N, Self, D>) -> IsometryRef<'_, N, D>
    where
        N: Space<D>;
}

/// A reference to an isometry with one of the rotation types of nalgebra.
#[expect(unnameable_types, reason = "for this crate alone")]
#[derive(Clone, Copy, Debug)]
pub enum IsometryRef<'i, N: Space<D>, const D: usize> {
    /// An isometry of the type [`Space::Isometry`]: with a unit complex number in 2D, a unit
    /// quaternion in 3D.
    Own(&'i N::Isometry),
    /// An isometry with a rotation matrix.
    ByMatrix(&'i Isometry<N, Rotation<N, D>, D>),
}

impl<N: Real> AbstractRotation<N, 2> for UnitComplex<N> {
    #[inline(always)]
    fn view(isometry: &Isometry<N, Self, 2>) -> IsometryRef<'_, N, 2> {
        IsometryRef::Own(isometry)
    }
}

impl<N: Real> AbstractRotation<N, 3> for UnitQuaternion<N> {
    #[inline(always)]
    fn view(isometry: &Isometry<N, Self, 3>) -> IsometryRef<'_, N, 3> {
        IsometryRef::Own(isometry)
    }
}

impl<N: Real, const D: usize> AbstractRotation<N, D> for Rotation<N, D> {
    #[inline(always)]
    fn view(isometry: &Isometry<N, Self, D>) -> IsometryRef<'_, N, D>
    where
        N: Space<D>,
    {
        IsometryRef::ByMatrix(isometry)
    }
}

impl<N: Space<D>, const D: usize> IsometryRef<'_, N, D> {
    /// Converts the isometry to a pose.
    #[inline]
    pub(crate) fn pose(self) -> Pose<N, D> {
        entries::pose_of(self)
    }

    /// Implements [`Pose::unturned`].
    #[inline]
    pub(crate) fn unturned(self) -> Pose<N, D> {
        match self {
            Self::Own(isometry) => N::unturned(isometry),
            Self::ByMatrix(isometry) => Pose::unturned(isometry),
        }
    }

    /// Returns the translation: the position of the local origin in the outer frame.
    #[inline]
    pub(crate) fn translation(self) -> Vector<N, D> {
        match self {
            Self::Own(isometry) => N::translation(isometry),
            Self::ByMatrix(isometry) => isometry.translation.vector,
        }
    }
}

/// Implements [`IsometryRef::pose`].
#[inline]
pub(crate) fn pose_of<N: Space<D>, const D: usize>(isometry: IsometryRef<'_, N, D>) -> Pose<N, D> {
    match isometry {
        IsometryRef::Own(isometry) => N::pose(isometry),
        IsometryRef::ByMatrix(isometry) => Pose::from_isometry(isometry),
    }
}
