//! Scenes as canonical bytes: a recording of the calls that add the objects, with a checksum and a version.

use std::collections::BTreeMap;

use impinge::math::{Pose, Real};
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Compound, Rounded, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_record::{Header, ReadError, RecordError, Recorder, Registry, Replay, ShapeData};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error;
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
    let side = SideArgument { shapes, poses, names: &["shapes", "poses"] };
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
        let mut shapes = EqualShapes { by_bytes: BTreeMap::new(), last: None };
        let mut recorder = recorder::<N, D>().map_err(|refused| error::of_call(&refused))?;
        for element in 0..len {
            let position = N::isometry(&poses.pose(if poses.len() == 1 { 0 } else { element }));
            let added = shapes.shared(given.shape(element)).and_then(|shape| {
                recorder.add(position, shape, CollisionGroups::new(), contacts(), ())
            });
            added.map_err(|refused| error::of_row(&refused, "poses", element))?;
        }
        Ok(PyBytes::new(self.side.shapes.py(), &recorder.finish().bytes))
    }
}

/// The query type of the objects of scenes. It has no effect, because the world of a scene is never
/// updated.
const fn contacts<N: Real>() -> GeometricQueryType<N> {
    GeometricQueryType::Contacts(N::ZERO, N::ZERO)
}

/// Creates a recorder of a world without objects.
fn recorder<N: Numeric<D>, const D: usize>() -> Result<Recorder<N, D, ()>, RecordError> {
    Recorder::new(N::ZERO, Registry::new())
}

/// Replaces equal shapes by one shared handle. A recording stores a shape once for each handle; so
/// a scene stores each distinct shape once.
struct EqualShapes<N: Numeric<D>, const D: usize> {
    /// The key is the recording of the shape alone.
    by_bytes: BTreeMap<Vec<u8>, ShapeHandle<N, D>>,
    /// The last shape and its shared handle: objects that share a shape are usually consecutive.
    last: Option<[ShapeHandle<N, D>; 2]>,
}

impl<N: Numeric<D>, const D: usize> EqualShapes<N, D> {
    /// Returns the handle that replaces all shapes equal to `shape`.
    fn shared(&mut self, shape: &ShapeHandle<N, D>) -> Result<ShapeHandle<N, D>, RecordError> {
        if let Some([_, shared]) = self.last.as_ref().filter(|[given, _]| given.is_same(shape)) {
            return Ok(shared.clone());
        }
        let with_shared = self.with_shared_children(shape)?;
        let mut alone = recorder::<N, D>()?;
        let (here, groups) = (N::isometry(&Pose::identity()), CollisionGroups::new());
        alone.add(here, with_shared.clone(), groups, contacts(), ())?;
        let shared = self.by_bytes.entry(alone.finish().bytes).or_insert(with_shared).clone();
        self.last = Some([shape.clone(), shared.clone()]);
        Ok(shared)
    }

    /// Rebuilds the shape from shared shapes. A recorder rejects shapes that nest too deeply.
    fn with_shared_children(
        &mut self,
        shape: &ShapeHandle<N, D>,
    ) -> Result<ShapeHandle<N, D>, RecordError> {
        let (mut children, mut placed) = (Vec::new(), Vec::new());
        let data = if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
            for (number, (position, child)) in (0..).zip(compound.children()) {
                placed.push((*position, number));
                children.push(self.shared(child)?);
            }
            ShapeData::Compound(placed)
        } else if let Some(rounded) = shape.as_shape::<Rounded<N, D>>() {
            children.push(self.shared(rounded.shape())?);
            ShapeData::Rounded { shape: 0, radius: rounded.radius() }
        } else {
            return Ok(shape.clone());
        };
        let child = |number: u32| Ok(children[number as usize].clone());
        Ok(data.make(&child).expect("the numbers are those of a shape"))
    }
}

/// Shapes, poses, dimension and scalar of a scene.
type SceneParts<'py> = (Vec<Py<Shape>>, Bound<'py, PyAny>, u8, &'static str);

/// Decodes a scene: the shapes of the objects, one for each, their poses, the dimension and the scalar.
#[pyfunction]
fn scene_of_bytes<'py>(py: Python<'py>, bytes: &[u8]) -> PyResult<SceneParts<'py>> {
    let kind = Kind::of_header(&Header::read(bytes).map_err(|error| refused(&error))?)?;
    let (shapes, poses) = run_in(kind, Read { py, bytes, kind })?;
    Ok((shapes, poses, kind.dim(), kind.dtype()))
}

/// Returns the shape of the last object of a scene. The scene of a pickled shape has one object.
#[pyfunction]
fn shape_of_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Py<Shape>> {
    let (mut shapes, ..) = scene_of_bytes(py, bytes)?;
    shapes.pop().ok_or_else(|| PyValueError::new_err("the scene has no object"))
}

fn refused(error: &ReadError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

struct Read<'a, 'py> {
    py: Python<'py>,
    bytes: &'a [u8],
    kind: Kind,
}

impl<'py> Task for Read<'_, 'py> {
    type Answer = (Vec<Py<Shape>>, Bound<'py, PyAny>);

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let replay = Replay::open(self.bytes, &Registry::<N, D, ()>::new());
        let mut replay = replay.map_err(|error| refused(&error))?;
        replay.seek_end().map_err(|error| refused(&error))?;
        let objects = || replay.world().collision_objects();
        let mut shapes: Vec<Py<Shape>> = Vec::with_capacity(replay.world().len());
        let mut last: Option<&ShapeHandle<N, D>> = None;
        for object in objects() {
            let shape = object.shape();
            // Objects that share a shape are usually consecutive.
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
