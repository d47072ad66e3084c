//! The configuration checker for Python: arrays of numbers in, columns out.

use std::any::Any;
use std::sync::{Arc, PoisonError, RwLock};

use impinge::batch::{BatchError, Control};
use impinge::checker::{
    Body, Checker, CheckerError, Frame, FrameTree, Joint, NearestColumns, Obstacle,
};
use impinge::math::na::convert;
use impinge::math::{Matrix, Pose, Unit, Vector};
use impinge::shape::ShapeHandle;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::answer::{Column, Extent};
use crate::error;
use crate::poses::{self, Poses};
use crate::shapes::Shape;
use crate::space::{Kind, Numeric, Task, run_in};
use crate::supervise::{Call, Threads, supervise};

/// A checker of any scalar and dimension; `impinge.Checker` reads the arguments.
#[pyclass(frozen, module = "impinge")]
pub(crate) struct NativeChecker {
    kind: Kind,
    /// An `Arc<Checker>` of this scalar and dimension, which is replaced when the obstacles change.
    checker: RwLock<Arc<dyn Any + Send + Sync>>,
}

/// The frames as columns: parents (-1 for the world), origins, columns of the configuration (-1 for fixed joints),
/// generators of rotations and axes of translations (zero for other joints), factors and offsets.
type FrameColumns<'py> = (
    Vec<i64>,
    Bound<'py, PyAny>,
    Vec<i64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
);

/// Shapes, the frame of each, and their poses in these frames.
type BodyColumns<'py> = (Vec<PyRef<'py, Shape>>, Vec<usize>, Bound<'py, PyAny>);

/// The arguments of [`NativeChecker`]: dimension, scalar, frames, number of columns, bodies, pairs.
type Arguments<'py> =
    (u8, String, FrameColumns<'py>, usize, BodyColumns<'py>, PyReadonlyArray2<'py, u32>);

#[pymethods]
impl NativeChecker {
    #[new]
    #[pyo3(signature = (*arguments))]
    fn new(arguments: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (dim, dtype, frames, columns, bodies, pairs) = arguments.extract::<Arguments<'_>>()?;
        let kind = Kind::parse(dim, &dtype)?;
        let pairs = rows_of(&pairs)?;
        let checker = run_in(kind, Make { kind, frames, columns, bodies, pairs })?;
        Ok(Self { kind, checker: RwLock::new(checker) })
    }

    /// Replaces all obstacles. `ignored` has a row (m, 2) for each pair of a body and an obstacle
    /// that no query tests.
    fn set_obstacles(
        &self,
        shapes: Vec<PyRef<'_, Shape>>,
        poses: &Bound<'_, PyAny>,
        ignored: PyReadonlyArray2<'_, u32>,
    ) -> PyResult<()> {
        let ignored = rows_of(&ignored)?;
        let old = self.current();
        let task = Surround { kind: self.kind, old, shapes, poses, ignored };
        let replaced = run_in(self.kind, task)?;
        *self.checker.write().unwrap_or_else(PoisonError::into_inner) = replaced;
        Ok(())
    }

    /// Returns the poses of all frames, or of all bodies if `of_bodies` is `true`, for each row
    /// (one configuration): an array (n * count, D+1, D+1).
    fn place<'py>(
        &self,
        py: Python<'py>,
        rows: &Bound<'py, PyAny>,
        of_bodies: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        run_in(self.kind, Place { py, checker: self.current(), rows, of_bodies })
    }

    /// Runs a query for each row: "free", "pair" or "nearest"; returns the columns of the result.
    #[pyo3(signature = (question, rows, limit, count, threads, progress))]
    #[expect(clippy::too_many_arguments, reason = "Python's arguments are named")]
    fn ask<'py>(
        &self,
        py: Python<'py>,
        question: &str,
        rows: &Bound<'py, PyAny>,
        limit: f64,
        count: usize,
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let (checker, call) = (self.current(), Call::new(threads, progress));
        run_in(self.kind, Ask { py, checker, question, rows, limit, count, call })
    }
}

impl NativeChecker {
    fn current(&self) -> Arc<dyn Any + Send + Sync> {
        self.checker.read().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

fn refused(error: CheckerError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

fn of_kind<N: Numeric<D>, const D: usize>(
    checker: Arc<dyn Any + Send + Sync>,
) -> PyResult<Arc<Checker<N, D>>> {
    checker.downcast().map_err(|_| PyTypeError::new_err("a checker of another kind"))
}

/// Returns the rows of an array (m, 2).
fn rows_of(pairs: &PyReadonlyArray2<'_, u32>) -> PyResult<Vec<[u32; 2]>> {
    Ok(pairs.as_slice()?.as_chunks::<2>().0.to_vec())
}

struct Make<'py> {
    kind: Kind,
    frames: FrameColumns<'py>,
    columns: usize,
    bodies: BodyColumns<'py>,
    pairs: Vec<[u32; 2]>,
}

impl Task for Make<'_> {
    type Answer = Arc<dyn Any + Send + Sync>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let tree = FrameTree::try_new(&self.frames::<N, D>()?, self.columns).map_err(refused)?;
        let (shapes, on, poses) = &self.bodies;
        let poses = Poses::<N, D>::of(poses, "poses")?;
        let poses = poses.source()?;
        let bodies = shapes.iter().zip(on).enumerate().map(|(index, (shape, &frame))| {
            let shape: &ShapeHandle<N, D> = shape.handle("shapes", self.kind)?;
            Ok(Body { frame, shape: shape.clone(), pose: poses.pose(index) })
        });
        let bodies = bodies.collect::<PyResult<Vec<_>>>()?;
        Ok(Arc::new(Checker::try_new(tree, bodies, &self.pairs).map_err(refused)?))
    }
}

impl Make<'_> {
    fn frames<N: Numeric<D>, const D: usize>(&self) -> PyResult<Vec<Frame<N, D>>> {
        let (parents, origins, columns, generators, axes, factors) = &self.frames;
        let origins = Poses::<N, D>::of(origins, "origins")?;
        let origins = origins.source()?;
        let (generators, axes, factors) =
            (generators.as_array(), axes.as_array(), factors.as_array());
        let number = |value: f64| -> N { convert(value) };
        let frame = |(index, (&parent, &column)): (usize, (&i64, &i64))| {
            let place = |row, axis| number(generators[[index, row * D + axis]]);
            let generator = Matrix::<N, D>::from_fn(place);
            let axis = Vector::<N, D>::from_fn(|axis, _| number(axes[[index, axis]]));
            let joint = match usize::try_from(column) {
                Err(_) => Joint::fixed(),
                Ok(column) if axis == Vector::<N, D>::zeros() => Joint::turning(generator, column),
                Ok(column) => Joint::prismatic(Unit::new_unchecked(axis), column),
            };
            let joint = joint.with_factor(number(factors[[index, 0]]));
            let joint = joint.with_offset(number(factors[[index, 1]]));
            Frame { parent: usize::try_from(parent).ok(), origin: origins.pose(index), joint }
        };
        Ok(parents.iter().zip(columns).enumerate().map(frame).collect())
    }
}

struct Surround<'a, 'py> {
    kind: Kind,
    old: Arc<dyn Any + Send + Sync>,
    shapes: Vec<PyRef<'py, Shape>>,
    poses: &'a Bound<'py, PyAny>,
    ignored: Vec<[u32; 2]>,
}

impl Task for Surround<'_, '_> {
    type Answer = Arc<dyn Any + Send + Sync>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let mut checker = of_kind::<N, D>(self.old)?;
        let poses = Poses::<N, D>::of(self.poses, "poses")?;
        let poses = poses.source()?;
        let obstacles = self.shapes.iter().enumerate().map(|(index, shape)| {
            let shape: &ShapeHandle<N, D> = shape.handle("shapes", self.kind)?;
            Ok(Obstacle { shape: shape.clone(), pose: poses.pose(index) })
        });
        let obstacles = obstacles.collect::<PyResult<Vec<_>>>()?;
        // A concurrent call continues with the previous obstacles.
        let replaced = Arc::make_mut(&mut checker);
        replaced.try_set_obstacles(obstacles, &self.ignored).map_err(refused)?;
        Ok(checker)
    }
}

/// Borrows the numbers of the configurations. They must be an array of the checker's scalar; an
/// array of another type is an error.
fn numbers<'py, N: Numeric<D>, const D: usize>(
    rows: &Bound<'py, PyAny>,
) -> PyResult<PyReadonlyArray1<'py, N>> {
    Ok(rows.cast::<PyArray1<N>>()?.try_readonly()?)
}

fn of_batch(error: &BatchError) -> PyErr {
    error::of_batch(error, "configurations")
}

struct Place<'a, 'py> {
    py: Python<'py>,
    checker: Arc<dyn Any + Send + Sync>,
    rows: &'a Bound<'py, PyAny>,
    of_bodies: bool,
}

impl<'py> Task for Place<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let checker = of_kind::<N, D>(self.checker)?;
        let rows = numbers::<N, D>(self.rows)?;
        let (rows, frames) = (rows.as_slice()?, checker.frames());
        let count = rows.len().checked_div(frames.columns()).unwrap_or(1);
        let width = if self.of_bodies { checker.bodies().len() } else { frames.len() };
        let mut poses = vec![Pose::<N, D>::identity(); count * width];
        let placed = self.py.detach(|| {
            let control = Control::new();
            if self.of_bodies {
                checker.place_bodies(rows, &control, &mut poses)
            } else {
                frames.place(rows, &control, &mut poses)
            }
        });
        placed.map_err(|error| of_batch(&error))?;
        poses::into_array(self.py, poses.into_iter())
    }
}

struct Ask<'a, 'py> {
    py: Python<'py>,
    checker: Arc<dyn Any + Send + Sync>,
    question: &'a str,
    rows: &'a Bound<'py, PyAny>,
    limit: f64,
    count: usize,
    call: Call,
}

impl<'py> Task for Ask<'_, 'py> {
    type Answer = Vec<Bound<'py, PyAny>>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let checker = of_kind::<N, D>(self.checker)?;
        let rows = numbers::<N, D>(self.rows)?;
        let (rows, count, limit) = (rows.as_slice()?, self.count, convert(self.limit));
        let question = self.question;
        let work = |control: &Control<'_>| {
            let (mut free, mut pairs, mut distance) = (Vec::new(), Vec::new(), Vec::new());
            match question {
                "free" => {
                    free = vec![false; count];
                    checker.are_free(rows, limit, control, &mut free)?;
                }
                "pair" => {
                    pairs = vec![[0; 2]; count];
                    checker.first_pairs(rows, limit, control, &mut pairs)?;
                }
                _ => {
                    (pairs, distance) = (vec![[0; 2]; count], vec![convert(0.0); count]);
                    let out = NearestColumns { distance: &mut distance, pair: &mut pairs };
                    checker.nearest(rows, limit, control, out)?;
                }
            }
            Ok((free, pairs, distance))
        };
        let found = supervise(self.py, Extent::Many(count), &self.call, work)?;
        let (free, pairs, distance): (Vec<bool>, Vec<[u32; 2]>, Vec<N>) =
            found.map_err(|error| of_batch(&error))?;
        let pairs = Column::<N, D>::Indices(pairs.into_flattened().into());
        [Column::Flags(free.into()), pairs, Column::Numbers(distance.into())]
            .into_iter()
            .map(|column| column.into_pyobject(self.py))
            .collect()
    }
}
