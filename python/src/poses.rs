//! Poses as arguments: `None`, or matrices of the scalar of the shapes, read where they lie.

use impinge::batch::{Matrices, OnePose, PoseSource};
use impinge::math::Pose;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::error;
use crate::space::Numeric;

/// An argument with poses.
pub(crate) struct Poses<'py, N: Numeric<D>, const D: usize> {
    /// What Python calls it.
    name: &'static str,
    /// An array of the shape (D+1, D+1) or (n, D+1, D+1) in C order; `None` for the identity.
    matrices: Option<PyReadonlyArrayDyn<'py, N>>,
}

impl<'py, N: Numeric<D>, const D: usize> Poses<'py, N, D> {
    /// Takes an argument; what is no array of the right type and layout goes through `impinge._poses.matrices`.
    pub(crate) fn of(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        if given.is_none() {
            return Ok(Self { name, matrices: None });
        }
        if let Ok(array) = given.cast::<PyArrayDyn<N>>()
            && is_usable::<D>(array.shape())
            && array.is_c_contiguous()
        {
            return Ok(Self { name, matrices: Some(array.try_readonly()?) });
        }
        let py = given.py();
        let dtype = N::get_dtype(py);
        let reader = py.import("impinge._poses")?.getattr("matrices")?;
        let array = reader.call1((given, D, dtype, name))?;
        let matrices = array.cast::<PyArrayDyn<N>>()?.try_readonly()?;
        Ok(Self { name, matrices: Some(matrices) })
    }

    /// There is one pose, not an array of poses.
    pub(crate) fn is_lone(&self) -> bool {
        self.matrices.as_ref().is_none_or(|matrices| matrices.ndim() == 2)
    }

    /// As the library reads them.
    pub(crate) fn source(&self) -> PyResult<Box<dyn PoseSource<N, D> + '_>> {
        let Some(matrices) = &self.matrices else { return Ok(Box::new(OnePose(Pose::identity()))) };
        let matrices = Matrices::try_new(matrices.as_slice()?);
        Ok(Box::new(matrices.map_err(|error| error::of_batch(&error, self.name))?))
    }
}

/// A matrix or an array of matrices.
fn is_usable<const D: usize>(shape: &[usize]) -> bool {
    matches!(shape, [rows, columns] | [_, rows, columns] if [*rows, *columns] == [D + 1, D + 1])
}

/// Poses as an array of the shape (n, D+1, D+1).
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
