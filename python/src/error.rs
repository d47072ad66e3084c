//! Errors of the library as exceptions that name the argument, the row and the value.

use impinge::batch::BatchError;
use impinge::world::GroupError;
use impinge_record::RecordError;
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};

/// Converts an error of a batch; `poses` is the name of the argument with the matrices.
pub(crate) fn of_batch(error: &BatchError, poses: &str) -> PyErr {
    match error {
        BatchError::Cancelled { .. } => PyKeyboardInterrupt::new_err(error.to_string()),
        BatchError::Matrix { index, error } => {
            PyValueError::new_err(format!("{poses}[{index}] is no pose: {error}"))
        }
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// Converts an error of a world, with or without a recorder, to a `ValueError` that names the row
/// of the argument.
pub(crate) fn of_row(error: &RecordError, argument: &str, row: usize) -> PyErr {
    PyValueError::new_err(format!("{argument}[{row}]: {error}"))
}

/// Converts an error of a world that concerns no row of an argument, but the whole call.
pub(crate) fn of_call(error: &RecordError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Converts the error of a group that does not exist.
pub(crate) fn of_groups(error: &GroupError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Checks that a limit is not NaN; it may be infinite.
pub(crate) fn not_nan(name: &str, value: f64) -> Result<(), PyErr> {
    if value.is_nan() {
        return Err(PyValueError::new_err(format!("{name} is nan")));
    }
    Ok(())
}
