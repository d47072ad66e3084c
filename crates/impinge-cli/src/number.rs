//! Formats numbers of either scalar for output.

use core::fmt;

use impinge::math::{Point, Real, Vector};
use impinge_record::Scalar;
use serde::{Serialize, Serializer};

/// A number and the scalar in which it was computed.
///
/// In JSON it is the shortest decimal that reads back as the same number of that scalar, or null
/// for NaN and infinities. `Display` writes six significant digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    value: f64,
    is_single: bool,
}

impl Number {
    /// Creates a number from a scalar.
    pub(crate) fn new<N: Scalar>(value: N) -> Self {
        Self { value: value.as_f64(), is_single: N::BYTES == 4 }
    }

    /// Returns the coordinates of a point.
    pub(crate) fn of_point<N: Scalar, const D: usize>(point: &Point<N, D>) -> Vec<Self> {
        Self::of_vector(&point.coords)
    }

    /// Returns the components of a vector.
    pub(crate) fn of_vector<N: Scalar, const D: usize>(vector: &Vector<N, D>) -> Vec<Self> {
        vector.iter().copied().map(Self::new).collect()
    }

    /// Returns the number without rounding.
    pub(crate) const fn value(self) -> f64 {
        self.value
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.is_single {
            serializer.serialize_f32(Real::as_f32(self.value))
        } else {
            serializer.serialize_f64(self.value)
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&significant(self.value))
    }
}

/// Formats a number with six significant digits, without trailing zeros, and zero without a sign.
pub(crate) fn significant(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse::<f64>().unwrap_or(value);
    let size = rounded.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if size.is_finite() && !(1e-5..1e9).contains(&size) {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    }
}

/// Formats coordinates in parentheses, separated by commas.
pub(crate) fn tuple(numbers: &[Number]) -> String {
    let words: Vec<_> = numbers.iter().map(Number::to_string).collect();
    format!("({})", words.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits() {
        let written =
            [0.1 + 0.2, -0.0, 2.0 / 3.0, 1234567.0, 1e-7, 2.5e12, f64::INFINITY, f64::NAN];
        let texts = written.map(significant);
        assert_eq!(texts, ["0.3", "0", "0.666667", "1234570", "1e-7", "2.5e12", "inf", "NaN"]);
    }

    #[test]
    fn json_is_shortest_by_scalar() {
        let json = |number: Number| serde_json::to_string(&number).expect("a number");
        assert_eq!(json(Number::new(0.1_f32)), "0.1", "not 0.10000000149011612");
        assert_eq!(json(Number::new(0.1_f32.as_f64())), "0.10000000149011612");
        assert_eq!(json(Number::new(f64::INFINITY)), "null");
    }
}
