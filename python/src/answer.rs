//! Results as Python objects: columns become NumPy arrays, and the result for a single element becomes scalars.

use core::ops::{Deref, DerefMut};

use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;

use crate::space::Numeric;

/// The number of elements of a call.
#[derive(Clone, Copy)]
pub(crate) enum Extent {
    /// A single element, whose result is scalars. If `is_quick` is `true`, the query takes no
    /// longer than releasing the interpreter would.
    Lone { is_quick: bool },
    /// Several elements, whose result is arrays.
    Many(usize),
}

impl Extent {
    /// Returns the extent of arguments: a single element if `is_lone`, otherwise `len` elements.
    pub(crate) const fn of(is_lone: bool, is_quick: bool, len: usize) -> Self {
        if is_lone { Self::Lone { is_quick } } else { Self::Many(len) }
    }

    /// The number of elements.
    pub(crate) const fn len(self) -> usize {
        match self {
            Self::Lone { .. } => 1,
            Self::Many(len) => len,
        }
    }

    /// Converts a list with one value for each element to slots. For a single element the list has
    /// one value, which is stored without the list.
    pub(crate) fn of_list<T>(self, mut list: Vec<T>) -> Slots<T> {
        match self {
            Self::Lone { .. } if list.len() == 1 => Slots::One([list.remove(0)]),
            _ => Slots::Many(list),
        }
    }

    /// Creates slots for one value for each element.
    pub(crate) fn slots<T: Clone>(self, empty: T) -> Slots<T> {
        match self {
            Self::Lone { .. } => Slots::One([empty]),
            Self::Many(len) => Slots::Many(vec![empty; len]),
        }
    }
}

/// The values of all elements; the value of a single element is stored without a list.
pub(crate) enum Slots<T> {
    One([T; 1]),
    Many(Vec<T>),
}

impl<T> Slots<T> {
    /// Maps the value of each element.
    pub(crate) fn map<U>(self, other: impl FnMut(T) -> U) -> Slots<U> {
        match self {
            Self::One(slot) => Slots::One(slot.map(other)),
            Self::Many(slots) => slots.into_iter().map(other).collect(),
        }
    }
}

impl<T> Deref for Slots<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match self {
            Self::One(slot) => slot,
            Self::Many(slots) => slots,
        }
    }
}

impl<T> DerefMut for Slots<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match self {
            Self::One(slot) => slot,
            Self::Many(slots) => slots,
        }
    }
}

impl<T> From<Vec<T>> for Slots<T> {
    fn from(slots: Vec<T>) -> Self {
        Self::Many(slots)
    }
}

impl<T> FromIterator<T> for Slots<T> {
    fn from_iter<I: IntoIterator<Item = T>>(slots: I) -> Self {
        Self::Many(slots.into_iter().collect())
    }
}

/// One column of the result of a batch.
pub(crate) enum Column<N, const D: usize> {
    Numbers(Slots<N>),
    Vectors(Slots<[N; D]>),
    Indices(Slots<u32>),
    Codes(Slots<u8>),
    Flags(Slots<bool>),
    Rows(Slots<i64>),
    Handles(Slots<u64>),
}

/// Many elements become an array with one row each; a single element becomes a scalar or an array of `D` numbers.
impl<'py, N: Numeric<D>, const D: usize> IntoPyObject<'py> for Column<N, D> {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::Numbers(Slots::One([number])) => number.as_f64().into_bound_py_any(py),
            Self::Numbers(Slots::Many(column)) => Ok(PyArray1::from_vec(py, column).into_any()),
            Self::Vectors(Slots::One([vector])) => Ok(PyArray1::from_slice(py, &vector).into_any()),
            Self::Vectors(Slots::Many(column)) => {
                let rows = column.len();
                Ok(PyArray1::from_vec(py, column.into_flattened()).reshape([rows, D])?.into_any())
            }
            Self::Indices(column) => values(py, column),
            Self::Codes(column) => values(py, column),
            Self::Flags(column) => values(py, column),
            Self::Rows(column) => values(py, column),
            Self::Handles(column) => values(py, column),
        }
    }
}

/// Converts a column of values that are not floating-point numbers: one value to a Python scalar,
/// several to an array (n,).
fn values<'py, T: Element + IntoPyObject<'py>>(
    py: Python<'py>,
    column: Slots<T>,
) -> PyResult<Bound<'py, PyAny>> {
    match column {
        Slots::One([value]) => value.into_bound_py_any(py),
        Slots::Many(column) => Ok(PyArray1::from_vec(py, column).into_any()),
    }
}

/// Combines the columns of a result into one object: a named tuple of `class`, or the first column
/// if `class` is `None`.
pub(crate) fn into_python<'py, N: Numeric<D>, const D: usize>(
    py: Python<'py>,
    class: Option<&Class>,
    columns: impl IntoIterator<Item = Column<N, D>, IntoIter: ExactSizeIterator>,
) -> PyResult<Bound<'py, PyAny>> {
    match class {
        Some(class) => class.value(PyTuple::new(py, columns)?),
        None => columns.into_iter().next().expect("an answer has a column").into_pyobject(py),
    }
}

/// A class of `impinge._results`. It is imported at its first use.
pub(crate) struct Class {
    name: &'static str,
    found: PyOnceLock<Py<PyAny>>,
}

pub(crate) static CLOSEST_POINTS: Class = Class::new("ClosestPoints");
pub(crate) static WITNESS: Class = Class::new("Witness");
pub(crate) static CONTACT: Class = Class::new("Contact");
pub(crate) static IMPACT: Class = Class::new("Impact");
pub(crate) static NEAREST: Class = Class::new("Nearest");
pub(crate) static MANIFOLDS: Class = Class::new("Manifolds");
pub(crate) static PROJECTION: Class = Class::new("Projection");
pub(crate) static RAY_HIT: Class = Class::new("RayHit");

impl Class {
    const fn new(name: &'static str) -> Self {
        Self { name, found: PyOnceLock::new() }
    }

    /// Creates a value of the class. The classes are named tuples; `tuple.__new__` takes half as long as their own
    /// constructors.
    fn value<'py>(&self, fields: Bound<'py, PyTuple>) -> PyResult<Bound<'py, PyAny>> {
        static MAKE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let py = fields.py();
        let make = MAKE.get_or_try_init(py, || {
            py.get_type::<PyTuple>().getattr("__new__").map(Bound::unbind)
        })?;
        let class = self.found.get_or_try_init(py, || {
            py.import("impinge._results")?.getattr(self.name).map(Bound::unbind)
        })?;
        make.bind(py).call1((class, fields))
    }
}
