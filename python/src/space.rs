//! Dispatches on the scalar and the dimension of a call. No other module selects `f32` or `f64`, or
//! 2D or 3D, at run time.

use impinge_record::{Header, Recordable};
use numpy::Element;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::pictures::Pictured;
use crate::read_back::Cornered;
use crate::solid::Bounding;
use crate::threads::settle;
use crate::turning::Turning;

/// A scalar and a dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Kind {
    /// Whether the scalar is `f64`; otherwise it is `f32`.
    pub(crate) is_double: bool,
    /// Whether the dimension is 3; otherwise it is 2.
    pub(crate) is_spatial: bool,
}

impl Kind {
    /// Parses the number of dimensions and the name of a dtype of NumPy.
    pub(crate) fn parse(dim: u8, dtype: &str) -> PyResult<Self> {
        let is_spatial = match dim {
            2 => false,
            3 => true,
            _ => return Err(PyValueError::new_err(format!("dim is {dim}: it is 2 or 3"))),
        };
        let is_double = match dtype {
            "float32" => false,
            "float64" => true,
            _ => {
                let message = format!("dtype is {dtype:?}: it is \"float32\" or \"float64\"");
                return Err(PyValueError::new_err(message));
            }
        };
        Ok(Self { is_double, is_spatial })
    }

    /// Returns the scalar and dimension in the header of a recording.
    pub(crate) fn of_header(header: &Header) -> PyResult<Self> {
        let dtype = if header.scalar_bytes == 8 { "float64" } else { "float32" };
        Self::parse(header.dimension, dtype)
    }

    /// The number of dimensions.
    pub(crate) const fn dim(self) -> u8 {
        if self.is_spatial { 3 } else { 2 }
    }

    /// The name of the dtype of NumPy.
    pub(crate) const fn dtype(self) -> &'static str {
        if self.is_double { "float64" } else { "float32" }
    }

    /// Returns an error if an argument has another scalar or dimension.
    pub(crate) fn expect(self, argument: &str, given: Self) -> PyResult<()> {
        if self == given {
            return Ok(());
        }
        let (dim, dtype) = (self.dim(), self.dtype());
        Err(PyTypeError::new_err(format!(
            "{argument} is {}D {}, where {dim}D {dtype} is needed",
            given.dim(),
            given.dtype()
        )))
    }
}

/// A scalar and a dimension that Python supports.
pub(crate) trait Numeric<const D: usize>:
    Recordable<D> + Element + Pictured<D> + Turning<D> + Bounding<D> + Cornered<D>
{
}

impl<N, const D: usize> Numeric<D> for N where
    N: Recordable<D> + Element + Pictured<D> + Turning<D> + Bounding<D> + Cornered<D>
{
}

/// A computation that is generic over the scalar and the dimension. It is a trait, because a closure cannot be
/// generic.
pub(crate) trait Task {
    /// The result of the computation.
    type Answer;

    /// Runs the computation.
    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer>;
}

/// Runs a task with the scalar and dimension of `kind`.
pub(crate) fn run_in<T: Task>(kind: Kind, task: T) -> PyResult<T::Answer> {
    settle()?;
    match (kind.is_double, kind.is_spatial) {
        (false, false) => task.run::<f32, 2>(),
        (false, true) => task.run::<f32, 3>(),
        (true, false) => task.run::<f64, 2>(),
        (true, true) => task.run::<f64, 3>(),
    }
}
