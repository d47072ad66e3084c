//! Answers as Python objects: columns become NumPy arrays, and the answer about a lone pair scalars.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;

use crate::space::Numeric;

/// One fact about each element of a batch.
pub(crate) enum Column<N, const D: usize> {
    Numbers(Vec<N>),
    Vectors(Vec<[N; D]>),
    Indices(Vec<u32>),
    Codes(Vec<u8>),
    Flags(Vec<bool>),
    Rows(Vec<i64>),
    Handles(Vec<u64>),
}

impl<N: Numeric<D>, const D: usize> Column<N, D> {
    /// As an array with one row for each element.
    pub(crate) fn into_array(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(match self {
            Self::Numbers(column) => PyArray1::from_vec(py, column).into_any(),
            Self::Vectors(column) => {
                let rows = column.len();
                PyArray1::from_vec(py, column.into_flattened()).reshape([rows, D])?.into_any()
            }
            Self::Indices(column) => PyArray1::from_vec(py, column).into_any(),
            Self::Codes(column) => PyArray1::from_vec(py, column).into_any(),
            Self::Flags(column) => PyArray1::from_vec(py, column).into_any(),
            Self::Rows(column) => PyArray1::from_vec(py, column).into_any(),
            Self::Handles(column) => PyArray1::from_vec(py, column).into_any(),
        })
    }

    /// The first element alone: a number, or an array of `D` numbers.
    fn into_scalar(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        match self {
            Self::Numbers(column) => column[0].as_f64().into_bound_py_any(py),
            Self::Vectors(column) => Ok(PyArray1::from_slice(py, &column[0]).into_any()),
            Self::Indices(column) => column[0].into_bound_py_any(py),
            Self::Codes(column) => column[0].into_bound_py_any(py),
            Self::Flags(column) => column[0].into_bound_py_any(py),
            Self::Rows(column) => column[0].into_bound_py_any(py),
            Self::Handles(column) => column[0].into_bound_py_any(py),
        }
    }
}

/// Columns as one object: the array itself where there is one column, else a tuple of the class of this name in
/// `impinge._results`. Of a lone pair it has scalars.
pub(crate) fn into_python<'py, N: Numeric<D>, const D: usize>(
    py: Python<'py>,
    class: Option<&str>,
    columns: Vec<Column<N, D>>,
    is_lone: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let fields = columns
        .into_iter()
        .map(|column| if is_lone { column.into_scalar(py) } else { column.into_array(py) });
    let mut fields: Vec<Bound<'py, PyAny>> = fields.collect::<PyResult<_>>()?;
    match class {
        Some(name) => named_tuple(py, name, PyTuple::new(py, fields)?),
        None => Ok(fields.remove(0)),
    }
}

/// A value of a class of `impinge._results`. These are tuples with names, so that the constructor of tuples makes them,
/// which takes half as long as their own.
fn named_tuple<'py>(
    py: Python<'py>,
    class: &str,
    fields: Bound<'py, PyTuple>,
) -> PyResult<Bound<'py, PyAny>> {
    /// The module and the constructor of tuples.
    static FOUND: PyOnceLock<(Py<PyAny>, Py<PyAny>)> = PyOnceLock::new();
    let (results, make) = FOUND.get_or_try_init(py, || {
        let results = py.import("impinge._results")?.into_any().unbind();
        let make = py.get_type::<PyTuple>().getattr("__new__")?.unbind();
        Ok::<_, PyErr>((results, make))
    })?;
    make.bind(py).call1((results.bind(py).getattr(class)?, fields))
}
