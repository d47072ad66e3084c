//! The rotation types that a user's isometry may have.

use super::na::{self, Rotation, UnitComplex, UnitQuaternion};
use super::{Isometry, Pose, Real, Space, Vector};
use crate::tables::entries;

/// A rotation of nalgebra: a unit complex number, a unit quaternion or a rotation matrix. Sealed.
///
/// Functions that take an isometry accept any of these rotations. The operations of a rotation are
/// in nalgebra's trait of the same name.
pub trait AbstractRotation<N: Real, const D: usize>: na::AbstractRotation<N, D> {
    /// Returns the isometry with the kind of its rotation as an enum, so that a function for all
    /// kinds is compiled once.
    #[doc(hidden)]
    fn view(isometry: &Isometry<N, Self, D>) -> IsometryRef<'_, N, D>
    where
        N: Space<D>;
}

/// An isometry with one of the rotations of nalgebra.
#[expect(unnameable_types, reason = "for this crate alone")]
#[derive(Clone, Copy, Debug)]
pub enum IsometryRef<'i, N: Space<D>, const D: usize> {
    /// An isometry with the usual rotation: a unit complex number or quaternion.
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

    /// Returns the position of the local origin.
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
