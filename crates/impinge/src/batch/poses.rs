//! The poses of the elements of a batch, and the traits by which a program provides them.

use core::ops::Range;

use crate::math::{AbstractRotation, Isometry, Pose, Real, Space, Vector};

/// A type that describes the pose of a shape: [`Pose`], an isometry of nalgebra, or a custom type.
///
/// ```
/// use impinge::dim2::batch::AsPose;
/// use impinge::dim2::math::{Pose, Vector};
///
/// /// A body that does not turn.
/// struct Body([f32; 2]);
///
/// impl AsPose<f32, 2> for Body {
///     fn to_pose(&self) -> Pose<f32, 2> {
///         Pose::from_translation(Vector::from(self.0))
///     }
/// }
/// assert_eq!(Body([1.0, 2.0]).translation(), Vector::new(1.0, 2.0));
/// ```
pub trait AsPose<N: Real, const D: usize>: Sync {
    /// Returns the pose as a rotation matrix and a translation.
    fn to_pose(&self) -> Pose<N, D>;

    /// Returns the translation alone, with the bits of [`Self::to_pose`]. Queries use it to reject
    /// distant shapes without computing a rotation.
    fn translation(&self) -> Vector<N, D> {
        self.to_pose().translation
    }

    /// Returns the pose to use for a shape that every rotation maps to itself, such as a ball: the
    /// rotation may be the identity. See [`Pose::unturned`].
    fn unturned(&self) -> Pose<N, D> {
        self.to_pose().without_rotation()
    }
}

impl<N: Real, const D: usize> AsPose<N, D> for Pose<N, D> {
    #[inline]
    fn to_pose(&self) -> Self {
        *self
    }

    #[inline]
    fn translation(&self) -> Vector<N, D> {
        self.translation
    }
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize> AsPose<N, D>
    for Isometry<N, R, D>
{
    #[inline]
    fn to_pose(&self) -> Pose<N, D> {
        Pose::from_isometry(self)
    }

    #[inline]
    fn translation(&self) -> Vector<N, D> {
        self.translation.vector
    }

    #[inline]
    fn unturned(&self) -> Pose<N, D> {
        Pose::unturned(self)
    }
}

/// The poses of one side of a batch, by index.
///
/// Vectors, arrays and slices of types with [`AsPose`] implement this trait (pass `&slice`, since
/// the batch takes a reference), as do [`Matrices`](super::Matrices) and [`OnePose`]. Implement it
/// to read poses in place from other memory.
///
/// A source of length 1 provides the pose of every element of its side. Poses need not be finite:
/// an element whose pose is not finite has no result.
pub trait PoseSource<N: Real, const D: usize>: Sync {
    /// Returns the number of poses.
    fn len(&self) -> usize;

    /// Returns pose `index` as a rotation matrix and a translation. `index` is less than
    /// [`Self::len`]; equal indices must give equal poses.
    fn pose(&self, index: usize) -> Pose<N, D>;

    /// Returns `true` if there is no pose.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the translation of pose `index`, with the bits of [`Self::pose`].
    fn translation(&self, index: usize) -> Vector<N, D> {
        self.pose(index).translation
    }

    /// Returns pose `index` for a shape that every rotation maps to itself: see
    /// [`AsPose::unturned`].
    fn unturned(&self, index: usize) -> Pose<N, D> {
        self.pose(index).without_rotation()
    }

    /// Appends the poses of a range of indices to `out`, so that many poses cost one virtual call.
    fn append(&self, range: Range<usize>, out: &mut Vec<Pose<N, D>>) {
        out.reserve(range.len());
        for index in range {
            out.push(self.pose(index));
        }
    }

    /// Appends the results of [`Self::unturned`] for a range of indices to `out`.
    fn append_unturned(&self, range: Range<usize>, out: &mut Vec<Pose<N, D>>) {
        out.reserve(range.len());
        for index in range {
            out.push(self.unturned(index));
        }
    }
}

/// A source of one pose, which all elements share.
///
/// ```
/// use impinge::dim3::batch::{OnePose, PoseSource};
/// use impinge::dim3::math::Isometry;
///
/// let above = OnePose(Isometry::translation(0.0_f64, 2.0, 0.0));
/// assert_eq!((above.len(), above.pose(0).translation.y), (1, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnePose<P>(pub P);

impl<N: Real, P: AsPose<N, D>, const D: usize> PoseSource<N, D> for OnePose<P> {
    fn len(&self) -> usize {
        1
    }

    fn pose(&self, _: usize) -> Pose<N, D> {
        self.0.to_pose()
    }

    fn translation(&self, _: usize) -> Vector<N, D> {
        self.0.translation()
    }

    fn unturned(&self, _: usize) -> Pose<N, D> {
        self.0.unturned()
    }
}

impl<N: Real, P: AsPose<N, D>, const D: usize> PoseSource<N, D> for &[P] {
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline]
    fn pose(&self, index: usize) -> Pose<N, D> {
        self[index].to_pose()
    }

    #[inline]
    fn translation(&self, index: usize) -> Vector<N, D> {
        self[index].translation()
    }

    #[inline]
    fn unturned(&self, index: usize) -> Pose<N, D> {
        self[index].unturned()
    }
}

impl<N: Real, P: AsPose<N, D>, const D: usize> PoseSource<N, D> for Vec<P> {
    fn len(&self) -> usize {
        self.as_slice().len()
    }

    #[inline]
    fn pose(&self, index: usize) -> Pose<N, D> {
        self[index].to_pose()
    }

    #[inline]
    fn translation(&self, index: usize) -> Vector<N, D> {
        self[index].translation()
    }

    #[inline]
    fn unturned(&self, index: usize) -> Pose<N, D> {
        self[index].unturned()
    }
}

impl<N: Real, P: AsPose<N, D>, const COUNT: usize, const D: usize> PoseSource<N, D> for [P; COUNT] {
    fn len(&self) -> usize {
        COUNT
    }

    #[inline]
    fn pose(&self, index: usize) -> Pose<N, D> {
        self[index].to_pose()
    }

    #[inline]
    fn translation(&self, index: usize) -> Vector<N, D> {
        self[index].translation()
    }

    #[inline]
    fn unturned(&self, index: usize) -> Pose<N, D> {
        self[index].unturned()
    }
}
