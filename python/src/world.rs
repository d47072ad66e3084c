//! Worlds: one Python class for every scalar and dimension, with calls about many objects at once.
//!
//! A handle in Python is a number of 64 bits: the index of the object, and above it how often that index was used before.
//! It never comes to mean another object of its world.

use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, GeometricQueryType};
use impinge::query::Proximity;
use impinge::world::{CollisionGroups, CollisionWorld, GroupError};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::answer::Column;
use crate::error;
use crate::poses::Poses;
use crate::shapes::kind_of;
use crate::side::SideArgument;
use crate::space::{Kind, Numeric, Task, run_in};
use crate::world_queries::{RowQuestion, WorldQueries};

/// What a new object is to be, apart from shape and pose.
#[derive(FromPyObject)]
pub(crate) struct ObjectOptions {
    /// Contacts up to the sum of the predictions of both objects; used where there is no margin.
    prediction: f64,
    /// Proximity instead of contacts, with this margin.
    margin: Option<f64>,
    membership: Option<Vec<usize>>,
    whitelist: Option<Vec<usize>>,
    blacklist: Option<Vec<usize>>,
}

/// A world of some scalar and dimension.
pub(crate) trait AnyWorld: Send + Sync {
    fn add(
        &mut self,
        side: &SideArgument<'_, '_>,
        kind: Kind,
        options: &ObjectOptions,
    ) -> PyResult<Vec<u64>>;
    fn remove(&mut self, handles: &[u64]) -> PyResult<()>;
    fn set_poses(&mut self, handles: &[u64], poses: &Bound<'_, PyAny>) -> PyResult<()>;
    fn update(&mut self, py: Python<'_>);
    fn handles(&self) -> Vec<u64>;
    fn poses<'py>(&self, py: Python<'py>, handles: &[u64]) -> PyResult<Bound<'py, PyAny>>;
    fn contact_events<'py>(&self, py: Python<'py>) -> Arrays<'py>;
    fn proximity_events<'py>(&self, py: Python<'py>) -> Arrays<'py>;
    fn contacts<'py>(&self, py: Python<'py>) -> Arrays<'py>;
    fn queries(&self) -> &dyn WorldQueries;
}

/// Columns as Python has them.
pub(crate) type Arrays<'py> = PyResult<Vec<Bound<'py, PyAny>>>;

/// A world of the library.
pub(crate) struct TypedWorld<N: Numeric<D>, const D: usize> {
    pub(crate) world: CollisionWorld<N, D, ()>,
    /// For each index how often it was used, and the handle of the library that has it now.
    slots: Vec<(u32, CollisionObjectHandle)>,
}

impl<N: Numeric<D>, const D: usize> TypedWorld<N, D> {
    /// The handles of the library.
    fn fresh(&self, handles: &[u64]) -> PyResult<Vec<CollisionObjectHandle>> {
        handles.iter().enumerate().map(|(row, &handle)| self.fresh_one(handle, row)).collect()
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "a handle has an index and an age of 32 bits"
    )]
    fn fresh_one(&self, handle: u64, row: usize) -> PyResult<CollisionObjectHandle> {
        let (index, age) = (handle as u32, (handle >> 32) as u32);
        let slot = self.slots.get(index as usize).filter(|slot| slot.0 == age);
        let alive = slot.filter(|slot| self.world.contains(slot.1));
        let stale = || {
            PyValueError::new_err(format!("handles[{row}] is {handle}: there is no such object"))
        };
        alive.map(|slot| slot.1).ok_or_else(stale)
    }

    /// The handle in Python of an object about to be added.
    fn name(&mut self, handle: CollisionObjectHandle) -> u64 {
        let index = handle.uid();
        let age = match self.slots.get_mut(index) {
            Some(slot) => {
                *slot = (slot.0.wrapping_add(1), handle);
                slot.0
            }
            None => {
                self.slots.push((0, handle));
                0
            }
        };
        u64::from(age) << 32 | index as u64
    }

    pub(crate) fn of(&self, handle: CollisionObjectHandle) -> u64 {
        u64::from(self.slots[handle.uid()].0) << 32 | handle.uid() as u64
    }
}

impl<N: Numeric<D>, const D: usize> AnyWorld for TypedWorld<N, D> {
    fn add(
        &mut self,
        side: &SideArgument<'_, '_>,
        kind: Kind,
        options: &ObjectOptions,
    ) -> PyResult<Vec<u64>> {
        let query = query_type::<N>(options);
        let groups = groups(options).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let given = side.read::<N, D>(kind)?;
        let poses = given.poses()?;
        let len = given.side(&*poses)?.len();
        let mut added = Vec::with_capacity(len);
        for element in 0..len {
            let pose = poses.pose(if poses.len() == 1 { 0 } else { element });
            let shape = given.shape(element).clone();
            match self.world.try_add(N::isometry(&pose), shape, groups, query, ()) {
                Ok(handle) => added.push(handle),
                Err(error) => {
                    // Nothing is left of a call that fails.
                    self.world.remove(&added);
                    return Err(error::of_world(&error, "poses", element));
                }
            }
        }
        Ok(added.into_iter().map(|handle| self.name(handle)).collect())
    }

    fn remove(&mut self, handles: &[u64]) -> PyResult<()> {
        let fresh = self.fresh(handles)?;
        let refused = self.world.try_remove(&fresh);
        refused.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    fn set_poses(&mut self, handles: &[u64], poses: &Bound<'_, PyAny>) -> PyResult<()> {
        let fresh = self.fresh(handles)?;
        let given = Poses::<N, D>::of(poses, "poses")?;
        let source = given.source()?;
        if source.len() != 1 && source.len() != fresh.len() {
            let (poses, handles) = (source.len(), fresh.len());
            return Err(PyValueError::new_err(format!("poses has {poses} for {handles} handles")));
        }
        let at = |row| N::isometry(&source.pose(if source.len() == 1 { 0 } else { row }));
        let moves: Vec<_> =
            fresh.iter().enumerate().map(|(row, handle)| (*handle, at(row))).collect();
        let refused = self.world.try_set_positions(&moves);
        refused.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    fn update(&mut self, py: Python<'_>) {
        py.detach(|| self.world.update());
    }

    fn handles(&self) -> Vec<u64> {
        self.world.collision_objects().map(|object| self.of(object.handle())).collect()
    }

    fn poses<'py>(&self, py: Python<'py>, handles: &[u64]) -> PyResult<Bound<'py, PyAny>> {
        let objects = self
            .fresh(handles)?
            .into_iter()
            .filter_map(|handle| self.world.collision_object(handle));
        crate::poses::into_array::<N, D>(py, objects.map(|object| N::pose(object.position())))
    }

    fn contact_events<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        let row = |event: &ContactEvent| {
            let (first, second) = event.handles();
            (u8::from(matches!(event, ContactEvent::Started(..))), self.of(first), self.of(second))
        };
        columns(py, self.world.contact_events().iter().map(row))
    }

    fn proximity_events<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        let rows = self.world.proximity_events().iter().map(|event| {
            (proximity_code(event.new_status), self.of(event.collider1), self.of(event.collider2))
        });
        columns(py, rows)
    }

    fn contacts<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        let (mut first, mut second, mut depth) = (Vec::new(), Vec::new(), Vec::new());
        let (mut normal, mut point1, mut point2) = (Vec::new(), Vec::new(), Vec::new());
        for (object1, object2, view) in self.world.contact_views() {
            for found in view.contacts() {
                first.push(self.of(object1.handle()));
                second.push(self.of(object2.handle()));
                depth.push(found.contact.depth);
                normal.push((*found.contact.normal).into());
                point1.push(found.contact.world1.coords.into());
                point2.push(found.contact.world2.coords.into());
            }
        }
        let columns = [
            Column::<N, D>::Handles(first),
            Column::Handles(second),
            Column::Numbers(depth),
            Column::Vectors(normal),
            Column::Vectors(point1),
            Column::Vectors(point2),
        ];
        columns.into_iter().map(|column| column.into_array(py)).collect()
    }

    fn queries(&self) -> &dyn WorldQueries {
        self
    }
}

/// Rows of codes and two handles as columns.
fn columns(py: Python<'_>, rows: impl Iterator<Item = (u8, u64, u64)>) -> Arrays<'_> {
    let (mut codes, mut first, mut second) = (Vec::new(), Vec::new(), Vec::new());
    for (code, one, other) in rows {
        codes.push(code);
        first.push(one);
        second.push(other);
    }
    let handles = |column| PyArray1::from_vec(py, column).into_any();
    Ok(vec![PyArray1::from_vec(py, codes).into_any(), handles(first), handles(second)])
}

/// The number of a proximity in Python.
pub(crate) const fn proximity_code(proximity: Proximity) -> u8 {
    match proximity {
        Proximity::Intersecting => 0,
        Proximity::WithinMargin => 1,
        Proximity::Disjoint => 2,
    }
}

fn query_type<N: impinge::math::Real>(options: &ObjectOptions) -> GeometricQueryType<N> {
    let number = impinge::math::na::convert::<f64, N>;
    match options.margin {
        Some(margin) => GeometricQueryType::Proximity(number(margin)),
        None => GeometricQueryType::Contacts(number(options.prediction), N::ZERO),
    }
}

fn groups(options: &ObjectOptions) -> Result<CollisionGroups, GroupError> {
    let mut groups = CollisionGroups::new();
    if let Some(membership) = &options.membership {
        groups.try_set_membership(membership)?;
    }
    if let Some(whitelist) = &options.whitelist {
        groups.try_set_whitelist(whitelist)?;
    }
    if let Some(blacklist) = &options.blacklist {
        groups.try_set_blacklist(blacklist)?;
    }
    Ok(groups)
}

/// A collision world; `impinge.World` has its texts.
#[pyclass(module = "impinge._native")]
pub(crate) struct World {
    kind: Kind,
    world: Box<dyn AnyWorld>,
}

/// Makes a world with a margin.
struct MakeWorld(f64);

impl Task for MakeWorld {
    type Answer = Box<dyn AnyWorld>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let world = CollisionWorld::try_new(impinge::math::na::convert::<f64, N>(self.0));
        let world = world.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Box::new(TypedWorld { world, slots: Vec::new() }))
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
        let side = SideArgument { shapes, poses, names: ["shapes", "poses"] };
        self.world.add(&side, self.kind, &options)
    }

    fn remove(&mut self, handles: Vec<u64>) -> PyResult<()> {
        self.world.remove(&handles)
    }

    fn set_poses(&mut self, handles: Vec<u64>, poses: &Bound<'_, PyAny>) -> PyResult<()> {
        self.world.set_poses(&handles, poses)
    }

    fn update(&mut self, py: Python<'_>) {
        self.world.update(py);
    }

    fn handles(&self) -> Vec<u64> {
        self.world.handles()
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

    fn cast_rays<'py>(
        &self,
        origins: &Bound<'py, PyAny>,
        directions: &Bound<'py, PyAny>,
        max_time: f64,
        solid: bool,
    ) -> Arrays<'py> {
        self.world.queries().cast_rays([origins, directions], max_time, solid)
    }

    fn near<'py>(
        &self,
        shapes: &Bound<'py, PyAny>,
        poses: &Bound<'py, PyAny>,
        count: usize,
        max_distance: f64,
    ) -> Arrays<'py> {
        let side = SideArgument { shapes, poses, names: ["shape", "poses"] };
        let question = RowQuestion { count, max_distance };
        self.world.queries().near(&side, self.kind, question)
    }

    fn containing<'py>(&self, points: &Bound<'py, PyAny>) -> Arrays<'py> {
        self.world.queries().containing(points)
    }

    fn cast_shape<'py>(
        &self,
        shapes: &Bound<'py, PyAny>,
        poses: &Bound<'py, PyAny>,
        velocities: &Bound<'py, PyAny>,
        max_time: f64,
        target_distance: f64,
    ) -> Arrays<'py> {
        let side = SideArgument { shapes, poses, names: ["shape", "poses"] };
        let limits = [max_time, target_distance];
        self.world.queries().cast_shape(&side, self.kind, velocities, limits)
    }
}
