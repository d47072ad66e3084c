//! Poses as arguments: `None`, or matrices of the scalar of the shapes, read where they lie.

use impinge::batch::{Matrices, OnePose, PoseSource};
use impinge::math::Pose;
use numpy::{
    Element, PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use crate::error;
use crate::space::Numeric;

/// An argument with poses.
pub(crate) struct Poses<'py, N: Numeric<D>, const D: usize> {
    /// What Python calls it.
    name: &'static str,
    given: GivenPoses<'py, N>,
}

/// One pose or many.
enum GivenPoses<'py, N: Element> {
    /// The identity.
    Identity,
    /// A copy of a matrix (D+1, D+1): sooner made than a lock on the array.
    One(Vec<N>),
    /// An array of the shape (n, D+1, D+1) in C order, which is read where it lies.
    Many(PyReadonlyArrayDyn<'py, N>),
}

impl<'py, N: Element> GivenPoses<'py, N> {
    /// Of an array of the right shape and layout.
    fn of(array: &Bound<'py, PyArrayDyn<N>>) -> PyResult<Self> {
        Ok(if array.ndim() == 2 {
            Self::One(array.to_vec()?)
        } else {
            Self::Many(array.try_readonly()?)
        })
    }
}

impl<'py, N: Numeric<D>, const D: usize> Poses<'py, N, D> {
    /// Takes an argument; what is no array of the right type and layout goes through `impinge._poses.matrices`.
    pub(crate) fn of(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        if given.is_none() {
            return Ok(Self { name, given: GivenPoses::Identity });
        }
        if let Ok(array) = given.cast::<PyArrayDyn<N>>()
            && is_usable::<D>(array.shape())
            && array.is_c_contiguous()
        {
            return Ok(Self { name, given: GivenPoses::of(array)? });
        }
        let py = given.py();
        let dtype = N::get_dtype(py);
        let reader = py.import("impinge._poses")?.getattr("matrices")?;
        let array = reader.call1((given, D, dtype, name))?;
        Ok(Self { name, given: GivenPoses::of(array.cast::<PyArrayDyn<N>>()?)? })
    }

    /// There is one pose, not an array of poses.
    pub(crate) fn is_lone(&self) -> bool {
        !matches!(self.given, GivenPoses::Many(_))
    }

    /// As the library reads them.
    pub(crate) fn source(&self) -> PyResult<Box<dyn PoseSource<N, D> + '_>> {
        let numbers = match &self.given {
            GivenPoses::Identity => return Ok(Box::new(OnePose(Pose::identity()))),
            GivenPoses::One(numbers) => numbers,
            GivenPoses::Many(matrices) => matrices.as_slice()?,
        };
        let matrices = Matrices::try_new(numbers);
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
