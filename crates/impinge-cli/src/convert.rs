//! Converts numbers that arguments give to the scalar and dimension of a scene.

use impinge::math::{Real, Vector};

use crate::args::Numbers;
use crate::error::CliError;
use crate::number::significant;

/// Converts a number that an argument gives; an error if it is infinite after rounding to the
/// scalar. `name` is the name of the argument in the error.
pub(crate) fn scalar<N: Real>(name: &'static str, value: f64) -> Result<N, CliError> {
    let converted = N::lit(value);
    if converted.is_finite_number() {
        return Ok(converted);
    }
    Err(CliError::argument(name, significant(value), "is beyond the numbers of the scene"))
}

/// Converts a vector that an argument gives; an error unless it has exactly `D` numbers.
pub(crate) fn vector<N: Real, const D: usize>(
    name: &'static str,
    numbers: &Numbers,
) -> Result<Vector<N, D>, CliError> {
    if numbers.0.len() != D {
        let reason = format!("the scene has {D} dimensions, so {D} numbers are needed");
        return Err(CliError::argument(name, numbers, reason));
    }
    let mut vector = Vector::<N, D>::zeros();
    for (component, number) in vector.iter_mut().zip(&numbers.0) {
        *component = scalar(name, *number)?;
    }
    Ok(vector)
}

/// Converts a direction that an argument gives; an error if it is zero. The result is not
/// normalized.
pub(crate) fn direction<N: Real, const D: usize>(
    name: &'static str,
    numbers: &Numbers,
) -> Result<Vector<N, D>, CliError> {
    let direction = vector(name, numbers)?;
    if direction == Vector::<N, D>::zeros() {
        return Err(CliError::argument(name, numbers, "a direction must not be zero"));
    }
    Ok(direction)
}
