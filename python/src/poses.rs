//! Poses as arguments: `None`, or matrices of the scalar of the shapes.

use core::ops::Deref;

use impinge::batch::{AsPose, Matrices, OnePose, PoseSource};
use impinge::math::Pose;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::error;
use crate::space::Numeric;
use crate::vectors::Numbers;

/// An argument with poses.
pub(crate) struct Poses<'py, N: Numeric<D>, const D: usize> {
    /// The name of the argument in Python.
    name: &'static str,
    /// A matrix (D+1, D+1) or an array (n, D+1, D+1); `None` is the identity.
    given: Option<Numbers<'py, N>>,
}

impl<'py, N: Numeric<D>, const D: usize> Poses<'py, N, D> {
    /// Reads an argument. Anything but an array of the right type and layout is converted by
    /// `impinge._poses.matrices`.
    pub(crate) fn of(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        if given.is_none() {
            return Ok(Self { name, given: None });
        }
        if let Ok(array) = given.cast::<PyArrayDyn<N>>()
            && is_usable::<D>(array.shape())
            && array.is_c_contiguous()
            && array.is_aligned()
        {
            return Ok(Self { name, given: Some(Numbers::of(array, 2)?) });
        }
        let py = given.py();
        let dtype = N::get_dtype(py);
        let reader = py.import("impinge._poses")?.getattr("matrices")?;
        let array = reader.call1((given, D, dtype, name))?;
        Ok(Self { name, given: Some(Numbers::of(array.cast::<PyArrayDyn<N>>()?, 2)?) })
    }

    /// Whether the argument is a single pose, not an array of poses.
    pub(crate) fn is_lone(&self) -> bool {
        self.given.as_ref().is_none_or(Numbers::is_lone)
    }

    /// Returns the poses as a source for the library.
    pub(crate) fn source(&self) -> PyResult<Source<'_, N, D>> {
        let Some(numbers) = &self.given else {
            return Ok(Source::Identity(OnePose(Identity)));
        };
        let matrices = Matrices::try_new(numbers.as_slice()?);
        Ok(Source::Matrices(matrices.map_err(|error| error::of_batch(&error, self.name))?))
    }
}

/// The pose of a missing argument.
pub(crate) struct Identity;

impl<N: Numeric<D>, const D: usize> AsPose<N, D> for Identity {
    fn to_pose(&self) -> Pose<N, D> {
        Pose::identity()
    }
}

/// The poses that an argument gives: its matrices, or the identity if it is missing.
pub(crate) enum Source<'a, N: Numeric<D>, const D: usize> {
    Identity(OnePose<Identity>),
    Matrices(Matrices<'a, N, D>),
}

impl<'a, N: Numeric<D>, const D: usize> Deref for Source<'a, N, D> {
    type Target = dyn PoseSource<N, D> + 'a;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Identity(identity) => identity,
            Self::Matrices(matrices) => matrices,
        }
    }
}

/// Whether an array of this shape is a matrix (D+1, D+1), or an array of such matrices.
fn is_usable<const D: usize>(shape: &[usize]) -> bool {
    matches!(shape, [rows, columns] | [_, rows, columns] if [*rows, *columns] == [D + 1, D + 1])
}

/// Converts poses to an array of the shape (n, D+1, D+1).
pub(crate) fn into_array<N: Numeric<D>, const D: usize>(
    py: Python<'_>,
    poses: impl Iterator<Item = Pose<N, D>>,
) -> PyResult<Bound<'_, PyAny>> {
    let (mut numbers, mut count) = (Vec::new(), 0);
    for Pose { rotation, translation } in poses {
        for row in 0..D {
            numbers.extend(rotation.row(row).iter());
            numbers.push(translation[row]);
        }
        numbers.extend([N::ZERO; D]);
        numbers.push(N::ONE);
        count += 1;
    }
    Ok(PyArray1::from_vec(py, numbers).reshape([count, D + 1, D + 1])?.into_any())
}
