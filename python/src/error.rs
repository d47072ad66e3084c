//! Errors of the library as exceptions that name the argument, the row and the value.

use impinge::batch::BatchError;
use impinge::world::WorldError;
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};

/// An error of a batch, where `poses` names the argument with the matrices.
pub(crate) fn of_batch(error: &BatchError, poses: &str) -> PyErr {
    match error {
        BatchError::Cancelled { .. } => PyKeyboardInterrupt::new_err(error.to_string()),
        BatchError::Matrix { index, error } => {
            PyValueError::new_err(format!("{poses}[{index}] is no pose: {error}"))
        }
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// An error of a world about a row of an argument.
pub(crate) fn of_world(error: &WorldError, argument: &str, row: usize) -> PyErr {
    PyValueError::new_err(format!("{argument}[{row}]: {error}"))
}
