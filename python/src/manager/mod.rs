//! The engine of `impinge.trimesh.CollisionManager`: objects by index, and their contacts.
//!
//! Names, triangles and data of contacts are handled in Python. Everything is in 3D and `f64`.

mod changes;
mod crowd;
mod meeting;
mod reach;

use core::sync::atomic::{AtomicU64, Ordering};

use impinge::math::Isometry3;
use impinge::math::Space;
use impinge::world::WorldError;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use self::crowd::{Crowd, Nearest, Pair, Solid, depth_at, index_of};
use self::meeting::{Crowds, Meeting};
use crate::poses::{Poses, into_array};
use crate::shapes::Shape;
use crate::space::Kind;
use crate::threads::settle;

const KIND: Kind = Kind { is_double: true, is_spatial: true };

/// The indices of two objects and their distance, negative if the objects overlap.
type Found = (u32, u32, f64);

/// Objects with shapes and transforms, by index; an index is reused after its object is removed.
#[pyclass(module = "impinge._native")]
pub(crate) struct Manager {
    crowd: Crowd,
    /// The unique number of this manager.
    number: u64,
    /// The cached results about one other manager: the last one that a query compared with this
    /// manager.
    meeting: Option<Meeting>,
}

#[pymethods]
impl Manager {
    #[new]
    fn new() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        Self { crowd: Crowd::new(), number, meeting: None }
    }

    /// Adds an object and returns its index.
    fn add(&mut self, shape: &Shape, transform: &Bound<'_, PyAny>) -> PyResult<u32> {
        settle()?;
        self.crowd.add(position(transform)?, solid(shape)?.clone()).map_err(|error| refused(&error))
    }

    fn remove(&mut self, index: u32) -> PyResult<()> {
        settle()?;
        self.crowd.remove(index).map_err(|error| refused(&error))
    }

    fn place(&mut self, index: u32, transform: &Bound<'_, PyAny>) -> PyResult<()> {
        settle()?;
        self.crowd.place(index, position(transform)?).map_err(|error| refused(&error))
    }

    /// Returns the transforms of objects: (n, 4, 4).
    fn transforms<'py>(&self, py: Python<'py>, indices: Vec<u32>) -> PyResult<Bound<'py, PyAny>> {
        let objects = indices.iter().filter_map(|&index| self.crowd.object(index));
        into_array::<f64, 3>(py, objects.map(|object| <f64 as Space<3>>::pose(object.position())))
    }

    /// Returns `true` if any two objects of this manager touch.
    fn is_touching(&mut self) -> PyResult<bool> {
        settle()?;
        Ok(self.crowd.touching_pair().is_some())
    }

    /// Returns all touching pairs.
    fn touching(&mut self) -> PyResult<Vec<(u32, u32)>> {
        settle()?;
        Ok(self.crowd.touching().iter().map(indices).collect())
    }

    /// Returns the nearest pair of this manager's objects; `None` if there are fewer than two.
    fn nearest(&mut self) -> PyResult<Option<Found>> {
        settle()?;
        Ok(self.crowd.nearest_pair().map(found))
    }

    /// Returns the nearest pair that contains the object with this index, the object of the lower
    /// handle first. `None` if there is no other object.
    fn nearest_beside(&mut self, index: u32) -> PyResult<Option<Found>> {
        settle()?;
        Ok(self.crowd.nearest_beside(index).map(found))
    }

    /// Whether a shape that is not an object touches an object.
    fn meets_any(&self, shape: &Shape, transform: &Bound<'_, PyAny>) -> PyResult<bool> {
        settle()?;
        Ok(self.crowd.meets_any(&position(transform)?, &**solid(shape)?))
    }

    /// Returns the objects that a shape touches.
    fn met_by(&self, shape: &Shape, transform: &Bound<'_, PyAny>) -> PyResult<Vec<u32>> {
        settle()?;
        let position = position(transform)?;
        let met = self.crowd.met_by(&position, &**solid(shape)?);
        Ok(met.map(|object| index_of(object.handle())).collect())
    }

    /// Returns the object nearest to a shape, and its distance, negative if they overlap; `None` if
    /// there are no objects.
    fn nearest_to(
        &self,
        shape: &Shape,
        transform: &Bound<'_, PyAny>,
    ) -> PyResult<Option<(u32, f64)>> {
        settle()?;
        let (position, solid) = (position(transform)?, &**solid(shape)?);
        let found = self.crowd.nearest_to(&position, solid, f64::INFINITY);
        Ok(found.and_then(|(handle, distance)| {
            let object = self.crowd.get(handle)?;
            let is_apart = distance > 0.0;
            let signed = if is_apart { distance } else { -depth_at(&position, solid, object) };
            Some((index_of(handle), signed))
        }))
    }

    /// Whether an object touches an object of another manager.
    fn is_touching_other(&mut self, other: &Self) -> PyResult<bool> {
        settle()?;
        Ok(self.touching_pair_with(other).is_some())
    }

    /// Returns all touching pairs of an object and an object of another manager.
    fn touching_other(&mut self, other: &Self) -> PyResult<Vec<(u32, u32)>> {
        settle()?;
        let meeting = self.meet(other);
        Ok(self.meeting.insert(meeting).touching.iter().map(indices).collect())
    }

    /// Returns the nearest pair of an object of this manager and an object of another manager;
    /// `None` if one of them has no objects.
    fn nearest_other(&mut self, other: &Self) -> PyResult<Option<Found>> {
        settle()?;
        let crowds = Crowds(&self.crowd, &other.crowd);
        let known = self.meeting.as_mut().filter(|meeting| meeting.other == other.number);
        if let Some(nearest) = known.and_then(|meeting| meeting.overlap(crowds)) {
            return Ok(Some(found(nearest)));
        }
        let mut meeting = self.meet(other);
        let crowds = Crowds(&self.crowd, &other.crowd);
        let nearest = meeting.overlap(crowds).or_else(|| meeting.nearest_pair(crowds));
        self.meeting = Some(meeting);
        Ok(nearest.map(found))
    }
}

impl Manager {
    /// Returns up-to-date results about another manager. Updates the cached results if they are
    /// about `other`. If none are cached, computes them; cached results about a third manager are
    /// dropped. The cache is then empty, and the caller stores the returned results in it.
    fn meet(&mut self, other: &Self) -> Meeting {
        let crowds = Crowds(&self.crowd, &other.crowd);
        let known = self.meeting.take().filter(|meeting| meeting.other == other.number);
        match known {
            None => Meeting::new(other.number, crowds),
            Some(mut meeting) => {
                meeting.update(crowds);
                meeting
            }
        }
    }

    /// Returns a touching pair of an object and an object of another manager: the first cached pair
    /// if it still touches, else the first pair of the updated results. If it returns `None`, no
    /// pair touches, and the cached results are up to date.
    fn touching_pair_with(&mut self, other: &Self) -> Option<Pair> {
        let crowds = Crowds(&self.crowd, &other.crowd);
        let known = self.meeting.as_ref().filter(|meeting| meeting.other == other.number);
        if let Some(pair) = known.and_then(|meeting| meeting.touching_pair(crowds)) {
            return Some(pair);
        }
        let meeting = self.meet(other);
        self.meeting.insert(meeting).touching.first().copied()
    }
}

fn indices(pair: &Pair) -> (u32, u32) {
    (index_of(pair.0), index_of(pair.1))
}

fn found(nearest: Nearest) -> Found {
    let (one, other) = indices(&nearest.pair);
    (one, other, nearest.distance)
}

fn position(transform: &Bound<'_, PyAny>) -> PyResult<Isometry3<f64>> {
    let given = Poses::<f64, 3>::of(transform, "transform")?;
    if !given.is_lone() {
        return Err(PyValueError::new_err(
            "transform is an array of matrices, where one is needed",
        ));
    }
    Ok(<f64 as Space<3>>::isometry(&given.source()?.pose(0)))
}

fn solid(shape: &Shape) -> PyResult<&Solid> {
    shape.handle::<f64, 3>("shape", KIND)
}

fn refused(error: &WorldError) -> PyErr {
    PyValueError::new_err(error.to_string())
}
