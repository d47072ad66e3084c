//! Points and vectors as arguments: arrays of the shape (D,) or (n, D).

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::space::Numeric;

/// The numbers of an array in C order.
pub(crate) enum Numbers<'py, N: Element> {
    /// The numbers of a single vector or matrix. Copying them is faster than locking the array.
    One(Vec<N>),
    /// The numbers of many vectors or matrices, read without a copy.
    Many(PyReadonlyArrayDyn<'py, N>),
}

impl<'py, N: Element> Numbers<'py, N> {
    /// Reads an array. A single vector or matrix has `axes` axes, an array of several has one axis
    /// more.
    pub(crate) fn of(array: &Bound<'py, PyArrayDyn<N>>, axes: usize) -> PyResult<Self> {
        Ok(if array.ndim() == axes {
            Self::One(array.to_vec()?)
        } else {
            Self::Many(array.try_readonly()?)
        })
    }

    /// Whether the array is a single vector or matrix.
    pub(crate) const fn is_lone(&self) -> bool {
        matches!(self, Self::One(_))
    }

    /// Returns all numbers.
    pub(crate) fn as_slice(&self) -> PyResult<&[N]> {
        Ok(match self {
            Self::One(numbers) => numbers,
            Self::Many(numbers) => numbers.as_slice()?,
        })
    }
}

/// An argument with one vector or many.
pub(crate) struct Vectors<'py, N: Numeric<D>, const D: usize>(Numbers<'py, N>);

impl<'py, N: Numeric<D>, const D: usize> Vectors<'py, N, D> {
    /// Reads an argument. Anything but an array of the right type and layout is converted by
    /// `impinge._poses.vectors`.
    pub(crate) fn of(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        if let Ok(array) = given.cast::<PyArrayDyn<N>>()
            && matches!(array.shape(), [width] | [_, width] if *width == D)
            && array.is_c_contiguous()
            && array.is_aligned()
        {
            return Ok(Self(Numbers::of(array, 1)?));
        }
        let py = given.py();
        let reader = py.import("impinge._poses")?.getattr("vectors")?;
        let array = reader.call1((given, D, N::get_dtype(py), name))?;
        Ok(Self(Numbers::of(array.cast::<PyArrayDyn<N>>()?, 1)?))
    }

    /// Whether the argument is a single vector, not an array of vectors.
    pub(crate) const fn is_lone(&self) -> bool {
        self.0.is_lone()
    }

    /// Returns the vectors in the form of the library.
    pub(crate) fn rows(&self) -> PyResult<&[[N; D]]> {
        Ok(self.0.as_slice()?.as_chunks().0)
    }
}
