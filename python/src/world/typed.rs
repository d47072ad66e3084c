//! A world of one scalar and dimension behind [`AnyWorld`]: handles, bulk changes, events and contacts.

use std::collections::BTreeMap;

use impinge::math::Point;
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent};
use impinge::query::Proximity;
use impinge::shape::{MeshError, Polyline, ShapeHandle, TriMesh};
use impinge_record::RecordError;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::kept::KeptWorld;
use super::queries::WorldQueries;
use crate::answer::Column;
use crate::error;
use crate::options::{GroupLists, ObjectOptions, QueryOptions};
use crate::pictures::{PictureView, picture};
use crate::poses::Poses;
use crate::shapes::ShapesArgument;
use crate::side::SideArgument;
use crate::solid::{Standing, standing};
use crate::space::{Kind, Numeric};
use crate::threads::Crew;
use crate::vectors::Vectors;
use crate::world::{AnyWorld, Arrays};

/// A world of the library, with the handles of Python.
pub(crate) struct TypedWorld<N: Numeric<D>, const D: usize> {
    pub(crate) world: KeptWorld<N, D>,
    pub(super) margin: N,
    /// For each index of the library the number of its earlier objects, and the current handle of
    /// the library. The number is `u32::MAX` until the first call that adds an object succeeds.
    pub(super) slots: Vec<(u32, CollisionObjectHandle)>,
    /// The objects that are surfaces or polylines, or have such children.
    pub(super) surfaces: BTreeMap<CollisionObjectHandle, Standing>,
    /// The handles in Python of the removed objects that events name. [`Self::slots`] has the
    /// handle of a later object if their index is used again.
    removed: BTreeMap<CollisionObjectHandle, u64>,
}

impl<N: Numeric<D>, const D: usize> TypedWorld<N, D> {
    pub(crate) const fn new(world: KeptWorld<N, D>, margin: N) -> Self {
        let slots = Vec::new();
        Self { world, margin, slots, surfaces: BTreeMap::new(), removed: BTreeMap::new() }
    }

    /// Converts handles of Python to handles of the library. `ValueError` names the row of a handle
    /// whose object does not exist.
    pub(crate) fn fresh(
        &self,
        handles: &[u64],
        argument: &str,
    ) -> PyResult<Vec<CollisionObjectHandle>> {
        let fresh = |(row, &handle)| {
            let stale = || {
                let message = format!("{argument}[{row}] is {handle}: there is no such object");
                PyValueError::new_err(message)
            };
            self.alive(handle).ok_or_else(stale)
        };
        handles.iter().enumerate().map(fresh).collect()
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "a handle has an index and an age of 32 bits"
    )]
    fn alive(&self, handle: u64) -> Option<CollisionObjectHandle> {
        let (index, age) = (handle as u32, (handle >> 32) as u32);
        let slot = self.slots.get(index as usize).filter(|slot| slot.0 == age)?;
        self.world.contains(slot.1).then_some(slot.1)
    }

    /// Assigns a handle in Python to an object that was just added, and counts the use of its
    /// index.
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

    /// Removes the objects of a call that failed, in order of their addition. Later objects get the
    /// handles that they would get without this call.
    fn withdraw(&mut self, mut added: Vec<CollisionObjectHandle>) {
        for handle in &added {
            if handle.uid() == self.slots.len() {
                self.slots.push((u32::MAX, *handle));
            }
        }
        // The index that is freed last is used next.
        added.reverse();
        let removed = self.world.remove(&added);
        debug_assert!(removed.is_ok(), "they were just added");
    }

    /// Returns the handle in Python of an object of the world.
    pub(crate) fn of(&self, handle: CollisionObjectHandle) -> u64 {
        u64::from(self.slots[handle.uid()].0) << 32 | handle.uid() as u64
    }

    /// Returns the handle in Python of an object that an event names; the object may be removed.
    fn of_event(&self, handle: CollisionObjectHandle) -> u64 {
        self.removed.get(&handle).copied().unwrap_or_else(|| self.of(handle))
    }

    /// Sets the shape of each handle. If one is rejected, the earlier objects get their previous
    /// shapes back, and the error names its row.
    fn exchange(
        &mut self,
        handles: &[CollisionObjectHandle],
        shape_of: impl Fn(usize) -> ShapeHandle<N, D>,
    ) -> PyResult<()> {
        let before: Vec<_> = handles
            .iter()
            .filter_map(|handle| Some(self.world.collision_object(*handle)?.shape().clone()))
            .collect();
        for (row, handle) in handles.iter().enumerate() {
            if let Err(refused) = self.world.set_shape(*handle, shape_of(row)) {
                for (handle, shape) in handles.iter().zip(before).take(row) {
                    let is_known = self.world.set_shape(*handle, shape);
                    debug_assert!(is_known.is_ok(), "it was the shape of the object");
                }
                return Err(error::of_row(&refused, "shapes", row));
            }
        }
        for (row, handle) in handles.iter().enumerate() {
            self.note_surface(*handle, &shape_of(row));
        }
        Ok(())
    }

    /// Records the kind of an object's surface after its shape has been set.
    pub(super) fn note_surface(
        &mut self,
        handle: CollisionObjectHandle,
        shape: &ShapeHandle<N, D>,
    ) {
        match standing(shape) {
            Some(standing) => self.surfaces.insert(handle, standing),
            None => self.surfaces.remove(&handle),
        };
    }

    /// Returns the shape with other vertices; `None` if it is neither a mesh nor a polyline.
    fn deformed(
        shape: &ShapeHandle<N, D>,
        vertices: &[Point<N, D>],
    ) -> Option<Result<ShapeHandle<N, D>, MeshError>> {
        if let Some(mesh) = shape.as_shape::<TriMesh<N, D>>() {
            let mut mesh = mesh.clone();
            return Some(mesh.try_set_vertices(vertices).map(|()| ShapeHandle::new(mesh)));
        }
        let mut line = shape.as_shape::<Polyline<N, D>>()?.clone();
        Some(line.try_set_vertices(vertices).map(|()| ShapeHandle::new(line)))
    }
}

impl<N: Numeric<D>, const D: usize> AnyWorld for TypedWorld<N, D> {
    fn add(
        &mut self,
        side: &SideArgument<'_, '_>,
        kind: Kind,
        options: &ObjectOptions,
    ) -> PyResult<Vec<u64>> {
        let query = options.query.query_type::<N>();
        let groups = options.groups.groups().map_err(|refused| error::of_groups(&refused))?;
        let given = side.read::<N, D>(kind)?;
        let poses = given.poses()?;
        let len = given.side(&*poses)?.len();
        let mut added = Vec::with_capacity(len);
        for element in 0..len {
            let pose = poses.pose(if poses.len() == 1 { 0 } else { element });
            let shape = given.shape(element).clone();
            match self.world.add(N::isometry(&pose), shape, groups, query) {
                Ok(handle) => added.push(handle),
                Err(refused) => {
                    self.withdraw(added);
                    return Err(error::of_row(&refused, "poses", element));
                }
            }
        }
        for (element, handle) in added.iter().enumerate() {
            self.note_surface(*handle, given.shape(element));
        }
        Ok(added.into_iter().map(|handle| self.name(handle)).collect())
    }

    fn remove(&mut self, handles: &[u64]) -> PyResult<()> {
        let fresh = self.fresh(handles, "handles")?;
        self.world.remove(&fresh).map_err(|refused| error::of_call(&refused))?;
        for (handle, name) in fresh.iter().zip(handles) {
            self.surfaces.remove(handle);
            if self.world.removed_object(*handle).is_some() {
                self.removed.insert(*handle, *name);
            }
        }
        Ok(())
    }

    fn set_poses(&mut self, handles: &[u64], poses: &Bound<'_, PyAny>) -> PyResult<()> {
        let fresh = self.fresh(handles, "handles")?;
        let given = Poses::<N, D>::of(poses, "poses")?;
        let source = given.source()?;
        one_or_all("poses", source.len(), fresh.len())?;
        let at = |row| N::isometry(&source.pose(if source.len() == 1 { 0 } else { row }));
        let moves: Vec<_> =
            fresh.iter().enumerate().map(|(row, handle)| (*handle, at(row))).collect();
        self.world.set_positions(&moves).map_err(|refused| error::of_call(&refused))
    }

    fn set_shapes(
        &mut self,
        handles: &[u64],
        kind: Kind,
        shapes: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let fresh = self.fresh(handles, "handles")?;
        let given = ShapesArgument::<N, D>::of(shapes, "shapes", kind)?;
        one_or_all("shapes", given.shapes()?.len(), fresh.len())?;
        self.exchange(&fresh, |row| given.at(row).clone())
    }

    fn set_vertices(&mut self, handle: u64, vertices: &Bound<'_, PyAny>) -> PyResult<()> {
        let fresh = self.fresh(&[handle], "handle")?;
        let rows = Vectors::<N, D>::of(vertices, "vertices")?;
        let points: Vec<_> = rows.rows()?.iter().map(|row| Point::from(*row)).collect();
        let object = self.world.collision_object(fresh[0]);
        let shape = object.expect("the handle is fresh").shape();
        let Some(deformed) = Self::deformed(shape, &points) else {
            let message = format!("handle is {handle}: its shape is no TriMesh and no Polyline");
            return Err(PyValueError::new_err(message));
        };
        let refused = |error: MeshError| PyValueError::new_err(format!("vertices: {error}"));
        let shape = deformed.map_err(refused)?;
        self.exchange(&fresh, |_| shape.clone())
    }

    fn set_groups(&mut self, handles: &[u64], groups: &GroupLists) -> PyResult<()> {
        let groups = groups.groups().map_err(|refused| error::of_groups(&refused))?;
        for handle in self.fresh(handles, "handles")? {
            self.world.set_groups(handle, groups).map_err(|refused| error::of_call(&refused))?;
        }
        Ok(())
    }

    fn set_query_types(&mut self, handles: &[u64], query: &QueryOptions) -> PyResult<()> {
        // All objects get the same query type: if it is rejected, it is rejected for the first object.
        for handle in self.fresh(handles, "handles")? {
            let changed = self.world.set_query(handle, query.query_type());
            changed.map_err(|refused| error::of_call(&refused))?;
        }
        Ok(())
    }

    fn update(&mut self, py: Python<'_>) -> PyResult<()> {
        let crew = Crew::of(py, None)?;
        py.detach(|| crew.run(|| self.world.update()));
        self.removed.retain(|handle, _| self.world.removed_object(*handle).is_some());
        Ok(())
    }

    fn record(&mut self) -> PyResult<()> {
        self.world.record(self.margin).map_err(|refused: RecordError| error::of_call(&refused))
    }

    fn stop_recording(&mut self) -> Option<Vec<u8>> {
        self.world.stop()
    }

    fn is_recorded(&self) -> bool {
        self.world.is_recorded()
    }

    fn to_bytes(&self) -> PyResult<(Vec<u8>, Vec<u32>)> {
        self.write().map_err(|refused| error::of_call(&refused))
    }

    fn fill(&mut self, bytes: &[u8], ages: &[u32]) -> PyResult<()> {
        self.read(bytes, ages).map_err(|damage| PyValueError::new_err(damage.to_string()))
    }

    fn picture(&self, view: &PictureView) -> (&'static str, Vec<u8>) {
        picture(&*self.world, view)
    }

    fn handles(&self) -> Vec<u64> {
        self.world.collision_objects().map(|object| self.of(object.handle())).collect()
    }

    fn shapes(&self, kind: Kind, handles: &[u64]) -> PyResult<Vec<crate::shapes::Shape>> {
        let objects = self.fresh(handles, "handles")?;
        let objects = objects.into_iter().filter_map(|handle| self.world.collision_object(handle));
        Ok(objects.map(|object| crate::shapes::Shape::of(kind, object.shape().clone())).collect())
    }

    fn poses<'py>(&self, py: Python<'py>, handles: &[u64]) -> PyResult<Bound<'py, PyAny>> {
        let objects = self.fresh(handles, "handles")?;
        let objects = objects.into_iter().filter_map(|handle| self.world.collision_object(handle));
        crate::poses::into_array::<N, D>(py, objects.map(|object| N::pose(object.position())))
    }

    fn contact_events<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        let row = |event: &ContactEvent| {
            let (first, second) = event.handles();
            let kind = u8::from(matches!(event, ContactEvent::Started(..)));
            (kind, self.of_event(first), self.of_event(second))
        };
        columns(py, self.world.contact_events().iter().map(row))
    }

    fn proximity_events<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        let rows = self.world.proximity_events().iter().map(|event| {
            let handles = [event.collider1, event.collider2].map(|handle| self.of_event(handle));
            (proximity_code(event.new_status), handles[0], handles[1])
        });
        columns(py, rows)
    }

    fn contacts<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        let (mut first, mut second, mut depth) = (Vec::new(), Vec::new(), Vec::new());
        let [mut normal, mut point1, mut point2] = [(); 3].map(|()| Vec::new());
        let [mut part1, mut part2] = [(); 2].map(|()| Vec::new());
        for (object1, object2, view) in self.world.contact_views() {
            for found in view.contacts() {
                first.push(self.of(object1.handle()));
                second.push(self.of(object2.handle()));
                depth.push(found.contact.depth);
                normal.push((*found.contact.normal).into());
                point1.push(found.contact.world1.coords.into());
                point2.push(found.contact.world2.coords.into());
                part1.push(found.part1);
                part2.push(found.part2);
            }
        }
        let [first, second] = [first, second].map(|column| Column::<N, D>::Handles(column.into()));
        let [normal, point1, point2] =
            [normal, point1, point2].map(|column| Column::Vectors(column.into()));
        let [part1, part2] = [part1, part2].map(|column| Column::Indices(column.into()));
        let depth = Column::Numbers(depth.into());
        let columns = [first, second, depth, normal, point1, point2, part1, part2];
        columns.into_iter().map(|column| column.into_pyobject(py)).collect()
    }

    fn proximities<'py>(&self, py: Python<'py>) -> Arrays<'py> {
        let pairs = self.world.proximity_pairs();
        let near = pairs.filter(|(.., pair)| pair.proximity() != Proximity::Disjoint);
        let rows = near.map(|(object1, object2, pair)| {
            let code = proximity_code(pair.proximity());
            (code, self.of(object1.handle()), self.of(object2.handle()))
        });
        columns(py, rows)
    }

    fn queries(&self) -> &dyn WorldQueries {
        self
    }
}

/// Checks that an argument has a row for each handle, or a single row for all.
fn one_or_all(argument: &str, rows: usize, handles: usize) -> PyResult<()> {
    if rows == 1 || rows == handles {
        return Ok(());
    }
    Err(PyValueError::new_err(format!("{argument} has {rows} for {handles} handles")))
}

/// Converts rows, each a code and two handles, to columns.
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

/// The code of a proximity in Python.
const fn proximity_code(proximity: Proximity) -> u8 {
    match proximity {
        Proximity::Intersecting => 0,
        Proximity::WithinMargin => 1,
        Proximity::Disjoint => 2,
    }
}
