//! Scenes as canonical bytes: a recording of the calls that add the objects, which has a checksum and a version.

use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::ShapeHandle;
use impinge::world::CollisionGroups;
use impinge_record::{ReadError, RecordError, Recorder, Registry, Replay};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::poses;
use crate::shapes::{Shape, kind_of};
use crate::side::SideArgument;
use crate::space::{Kind, Numeric, Task, run_in};

/// Adds the functions of scenes.
pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(scene_bytes, module)?)?;
    module.add_function(wrap_pyfunction!(scene_of_bytes, module)?)?;
    module.add_function(wrap_pyfunction!(shape_of_bytes, module)?)
}

/// The bytes of shapes at poses.
#[pyfunction]
pub(crate) fn scene_bytes<'py>(
    shapes: &Bound<'py, PyAny>,
    poses: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyBytes>> {
    let kind = kind_of(shapes, "shapes")?;
    let side = SideArgument { shapes, poses, names: ["shapes", "poses"] };
    run_in(kind, Write { side, kind })
}

struct Write<'a, 'py> {
    side: SideArgument<'a, 'py>,
    kind: Kind,
}

impl<'py> Task for Write<'_, 'py> {
    type Answer = Bound<'py, PyBytes>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let given = self.side.read::<N, D>(self.kind)?;
        let poses = given.poses()?;
        let len = given.side(&*poses)?.len();
        let refused = |error: RecordError| PyValueError::new_err(error.to_string());
        let mut recorder = Recorder::new(N::ZERO, Registry::<N, D, ()>::new()).map_err(refused)?;
        let query = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
        for element in 0..len {
            let position = N::isometry(&poses.pose(if poses.len() == 1 { 0 } else { element }));
            let shape = given.shape(element).clone();
            recorder.add(position, shape, CollisionGroups::new(), query, ()).map_err(refused)?;
        }
        Ok(PyBytes::new(self.side.shapes.py(), &recorder.finish().bytes))
    }
}

/// The shapes of the objects, one for each, and their poses, of the bytes of a scene.
#[pyfunction]
fn scene_of_bytes<'py>(
    py: Python<'py>,
    bytes: &[u8],
    dim: u8,
    dtype: &str,
) -> PyResult<(Vec<Py<Shape>>, Bound<'py, PyAny>)> {
    let kind = Kind::parse(dim, dtype)?;
    run_in(kind, Read { py, bytes, kind })
}

/// The only shape of the bytes of a scene.
#[pyfunction]
fn shape_of_bytes(py: Python<'_>, bytes: &[u8], dim: u8, dtype: &str) -> PyResult<Py<Shape>> {
    let (mut shapes, _) = scene_of_bytes(py, bytes, dim, dtype)?;
    shapes.pop().ok_or_else(|| PyValueError::new_err("the scene has no object"))
}

struct Read<'a, 'py> {
    py: Python<'py>,
    bytes: &'a [u8],
    kind: Kind,
}

impl<'py> Task for Read<'_, 'py> {
    type Answer = (Vec<Py<Shape>>, Bound<'py, PyAny>);

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let refused = |error: ReadError| PyValueError::new_err(error.to_string());
        let mut replay = Replay::open(self.bytes, &Registry::<N, D, ()>::new()).map_err(refused)?;
        replay.seek_end().map_err(refused)?;
        let objects = || replay.world().collision_objects();
        let mut shapes: Vec<Py<Shape>> = Vec::with_capacity(replay.world().len());
        let mut last: Option<&ShapeHandle<N, D>> = None;
        for object in objects() {
            let shape = object.shape();
            // Objects that share a shape mostly follow each other.
            let shared = shapes.last().filter(|_| last.is_some_and(|last| last.is_same(shape)));
            let next = match shared {
                Some(shape) => shape.clone_ref(self.py),
                None => Py::new(self.py, Shape::of(self.kind, shape.clone()))?,
            };
            shapes.push(next);
            last = Some(shape);
        }
        let poses = objects().map(|object| N::pose(object.position()));
        Ok((shapes, poses::into_array::<N, D>(self.py, poses)?))
    }
}
