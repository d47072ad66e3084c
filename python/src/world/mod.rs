//! Worlds: one Python class for all scalars and dimensions, whose calls take many objects at once.
//!
//! A handle in Python is an integer of 64 bits: the low half is the index of the object, the high
//! half the number of earlier objects with that index. A handle is not used again for another
//! object of its world until 2^32 objects have had its index.

mod kept;
mod queries;
mod state;
mod typed;

use impinge::math::na::convert;
use impinge::world::CollisionWorld;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use self::kept::KeptWorld;
use self::queries::{Asking, WorldQueries};
use self::typed::TypedWorld;
use crate::options::{FilterOptions, GroupLists, ObjectOptions, QueryOptions};
use crate::pictures::PictureView;
use crate::shapes::kind_of;
use crate::side::SideArgument;
use crate::space::{Kind, Numeric, Task, run_in};
use crate::supervise::{Call, Threads};
use crate::threads::settle;

/// The columns of a result, as arrays of Python.
pub(crate) type Arrays<'py> = PyResult<Vec<Bound<'py, PyAny>>>;

/// A world of any scalar and dimension: its changes and its queries.
pub(crate) trait AnyWorld: Send + Sync {
    fn add(
        &mut self,
        side: &SideArgument<'_, '_>,
        kind: Kind,
        options: &ObjectOptions,
    ) -> PyResult<Vec<u64>>;
    fn remove(&mut self, handles: &[u64]) -> PyResult<()>;
    fn set_poses(&mut self, handles: &[u64], poses: &Bound<'_, PyAny>) -> PyResult<()>;
    fn set_shapes(
        &mut self,
        handles: &[u64],
        kind: Kind,
        shapes: &Bound<'_, PyAny>,
    ) -> PyResult<()>;
    fn set_vertices(&mut self, handle: u64, vertices: &Bound<'_, PyAny>) -> PyResult<()>;
    fn set_groups(&mut self, handles: &[u64], groups: &GroupLists) -> PyResult<()>;
    fn set_query_types(&mut self, handles: &[u64], query: &QueryOptions) -> PyResult<()>;
    fn update(&mut self, py: Python<'_>) -> PyResult<()>;
    fn record(&mut self) -> PyResult<()>;
    fn stop_recording(&mut self) -> Option<Vec<u8>>;
    fn is_recorded(&self) -> bool;
    /// Returns the bytes of a world with the same objects, and the number of uses of each index.
    fn to_bytes(&self) -> PyResult<(Vec<u8>, Vec<u32>)>;
    /// Fills a new world without objects from the result of [`Self::to_bytes`]; `ages` has the
    /// number of uses of each index.
    fn fill(&mut self, bytes: &[u8], ages: &[u32]) -> PyResult<()>;
    fn picture(&self, view: &PictureView) -> (&'static str, Vec<u8>);
    fn handles(&self) -> Vec<u64>;
    fn shapes(&self, kind: Kind, handles: &[u64]) -> PyResult<Vec<crate::shapes::Shape>>;
    fn poses<'py>(&self, py: Python<'py>, handles: &[u64]) -> PyResult<Bound<'py, PyAny>>;
    fn contact_events<'py>(&self, py: Python<'py>) -> Arrays<'py>;
    fn proximity_events<'py>(&self, py: Python<'py>) -> Arrays<'py>;
    fn contacts<'py>(&self, py: Python<'py>) -> Arrays<'py>;
    fn proximities<'py>(&self, py: Python<'py>) -> Arrays<'py>;
    fn queries(&self) -> &dyn WorldQueries;
}

/// A collision world; `impinge.World` has its docstrings.
#[pyclass(module = "impinge._native")]
pub(crate) struct World {
    kind: Kind,
    world: Box<dyn AnyWorld>,
}

/// Creates a world with a margin.
struct MakeWorld(f64);

impl Task for MakeWorld {
    type Answer = Box<dyn AnyWorld>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let margin = convert::<f64, N>(self.0);
        let world = CollisionWorld::try_new(margin);
        let world = world.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Box::new(TypedWorld::new(KeptWorld::<N, D>::Plain(Box::new(world)), margin)))
    }
}

#[pymethods]
impl World {
    #[new]
    fn new(margin: f64, dim: u8, dtype: &str) -> PyResult<Self> {
        let kind = Kind::parse(dim, dtype)?;
        Ok(Self { kind, world: run_in(kind, MakeWorld(margin))? })
    }

    #[getter]
    fn dim(&self) -> u8 {
        self.kind.dim()
    }

    #[getter]
    fn dtype(&self) -> &'static str {
        self.kind.dtype()
    }

    fn add(
        &mut self,
        shapes: &Bound<'_, PyAny>,
        poses: &Bound<'_, PyAny>,
        options: ObjectOptions,
    ) -> PyResult<Vec<u64>> {
        self.kind.expect("shapes", kind_of(shapes, "shapes")?)?;
        let side = SideArgument { shapes, poses, names: &["shapes", "poses"] };
        self.world.add(&side, self.kind, &options)
    }

    fn remove(&mut self, handles: Vec<u64>) -> PyResult<()> {
        self.world.remove(&handles)
    }

    fn set_poses(&mut self, handles: Vec<u64>, poses: &Bound<'_, PyAny>) -> PyResult<()> {
        self.world.set_poses(&handles, poses)
    }

    fn set_shapes(&mut self, handles: Vec<u64>, shapes: &Bound<'_, PyAny>) -> PyResult<()> {
        self.kind.expect("shapes", kind_of(shapes, "shapes")?)?;
        self.world.set_shapes(&handles, self.kind, shapes)
    }

    fn set_vertices(&mut self, handle: u64, vertices: &Bound<'_, PyAny>) -> PyResult<()> {
        settle()?;
        self.world.set_vertices(handle, vertices)
    }

    fn set_groups(&mut self, handles: Vec<u64>, groups: GroupLists) -> PyResult<()> {
        self.world.set_groups(&handles, &groups)
    }

    fn set_query_types(&mut self, handles: Vec<u64>, query: QueryOptions) -> PyResult<()> {
        self.world.set_query_types(&handles, &query)
    }

    fn update(&mut self, py: Python<'_>) -> PyResult<()> {
        self.world.update(py)
    }

    /// Returns the bytes of a world with the same objects, and the number of uses of each index.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyBytes>, Vec<u32>)> {
        settle()?;
        let (bytes, ages) = self.world.to_bytes()?;
        Ok((PyBytes::new(py, &bytes), ages))
    }

    /// Fills a new world from the result of `to_bytes`.
    fn fill(&mut self, bytes: &[u8], ages: Vec<u32>) -> PyResult<()> {
        settle()?;
        self.world.fill(bytes, &ages)
    }

    fn record(&mut self) -> PyResult<()> {
        settle()?;
        self.world.record()
    }

    fn stop_recording<'py>(&mut self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        self.world.stop_recording().map(|bytes| PyBytes::new(py, &bytes))
    }

    #[getter]
    fn is_recorded(&self) -> bool {
        self.world.is_recorded()
    }

    fn picture<'py>(
        &self,
        py: Python<'py>,
        view: PictureView,
    ) -> PyResult<(&'static str, Bound<'py, PyBytes>)> {
        settle()?;
        let (format, bytes) = py.detach(|| self.world.picture(&view));
        Ok((format, PyBytes::new(py, &bytes)))
    }

    fn handles(&self) -> Vec<u64> {
        self.world.handles()
    }

    fn shapes(&self, handles: Vec<u64>) -> PyResult<Vec<crate::shapes::Shape>> {
        self.world.shapes(self.kind, &handles)
    }

    fn poses<'py>(&self, py: Python<'py>, handles: Vec<u64>) -> PyResult<Bound<'py, PyAny>> {
        self.world.poses(py, &handles)
    }

    fn contact_events<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        self.world.contact_events(py)
    }

    fn proximity_events<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        self.world.proximity_events(py)
    }

    fn contacts<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        self.world.contacts(py)
    }

    fn proximities<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        self.world.proximities(py)
    }

    /// Runs the query `question` with the arrays `given`.
    fn ask<'py>(
        &self,
        question: Asking,
        given: Vec<Bound<'py, PyAny>>,
        filter: Option<FilterOptions>,
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
    ) -> Arrays<'py> {
        settle()?;
        let call = Call::new(threads, progress);
        self.world.queries().ask(&question, (&given, self.kind), filter.as_ref(), &call)
    }
}
