//! Points and vectors as arguments: arrays of the shape (D,) or (n, D), read where they lie.

use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::space::Numeric;

/// An argument with one vector or many.
pub(crate) struct Vectors<'py, N: Numeric<D>, const D: usize>(PyReadonlyArrayDyn<'py, N>);

impl<'py, N: Numeric<D>, const D: usize> Vectors<'py, N, D> {
    /// Takes an argument; what is no array of the right type and layout goes through `impinge._poses.vectors`.
    pub(crate) fn of(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        if let Ok(array) = given.cast::<PyArrayDyn<N>>()
            && matches!(array.shape(), [width] | [_, width] if *width == D)
            && array.is_c_contiguous()
        {
            return Ok(Self(array.try_readonly()?));
        }
        let py = given.py();
        let reader = py.import("impinge._poses")?.getattr("vectors")?;
        let array = reader.call1((given, D, N::get_dtype(py), name))?;
        Ok(Self(array.cast::<PyArrayDyn<N>>()?.try_readonly()?))
    }

    /// There is one vector, not an array of vectors.
    pub(crate) fn is_lone(&self) -> bool {
        self.0.ndim() == 1
    }

    /// As the library reads them.
    pub(crate) fn rows(&self) -> PyResult<&[[N; D]]> {
        Ok(self.0.as_slice()?.as_chunks().0)
    }
}
