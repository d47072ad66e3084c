//! Shapes: handles of the library, of every scalar and dimension, behind one Python class.

use std::any::Any;
use std::sync::Arc;

use impinge::batch::Shapes;
use impinge::math::na::convert;
use impinge::math::{Point, Space, Vector};
use impinge::shape::{Compound, Polyline, ShapeHandle, ShapeKind, TriMesh};
use impinge_record::{Field, Mesh, Problem, ShapeData};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes, PyTuple};

use crate::poses::Poses;
use crate::read_back;
use crate::scene::scene_bytes;
use crate::space::{Kind, Numeric, Task, run_in};

/// A solid or a surface, in its local frame. It is immutable; the functions of the package create it.
#[pyclass(frozen, module = "impinge")]
pub(crate) struct Shape {
    pub(crate) kind: Kind,
    /// A `ShapeHandle` of the scalar and dimension of `kind`.
    handle: Arc<dyn Any + Send + Sync>,
    /// The function of the package that creates such shapes.
    name: String,
}

impl Shape {
    /// Wraps a shape of the library.
    pub(crate) fn of<N: Numeric<D>, const D: usize>(kind: Kind, shape: ShapeHandle<N, D>) -> Self {
        let name = public_name(&shape);
        Self { kind, handle: Arc::new(shape), name }
    }

    /// Returns the shape of the library.
    ///
    /// # Errors
    /// `TypeError` if the shape has another scalar or dimension.
    pub(crate) fn handle<N: Numeric<D>, const D: usize>(
        &self,
        argument: &str,
        kind: Kind,
    ) -> PyResult<&ShapeHandle<N, D>> {
        kind.expect(argument, self.kind)?;
        self.handle.downcast_ref().ok_or_else(|| PyTypeError::new_err("a shape of another kind"))
    }
}

/// The arguments of a constructor as arrays; the kind of shape determines which are used.
struct Description<'a, 'py> {
    name: &'a str,
    numbers: &'a [f64],
    points: Option<PyReadonlyArray2<'py, f64>>,
    parts: Option<PyReadonlyArray2<'py, u32>>,
    children: &'a [PyRef<'py, Shape>],
    poses: &'a Bound<'py, PyAny>,
    one_sided: bool,
    keep_internal_edges: bool,
    solid: bool,
    kind: Kind,
}

/// The arguments of [`Shape`] in Python: name, dimension and scalar, then the fields of
/// [`Description`] from `numbers` to `solid`.
type Arguments<'py> = (
    String,
    u8,
    String,
    PyReadonlyArray1<'py, f64>,
    Option<PyReadonlyArray2<'py, f64>>,
    Option<PyReadonlyArray2<'py, u32>>,
    Vec<PyRef<'py, Shape>>,
    Bound<'py, PyAny>,
    bool,
    bool,
    bool,
);

#[pymethods]
impl Shape {
    /// Internal: the functions of the package create shapes.
    #[new]
    #[pyo3(signature = (*arguments))]
    fn new(arguments: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (name, dim, dtype, numbers, points, parts, children, poses, one_sided, keep, solid) =
            arguments.extract::<Arguments<'_>>()?;
        let kind = Kind::parse(dim, &dtype)?;
        let description = Description {
            name: &name,
            kind,
            numbers: numbers.as_slice()?,
            points,
            parts,
            children: &children,
            poses: &poses,
            one_sided,
            keep_internal_edges: keep,
            solid,
        };
        run_in(kind, Make(&description))
    }

    /// The function that creates such shapes, such as `TriMesh`.
    #[getter]
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The number of dimensions: 2 or 3.
    #[getter]
    fn dim(&self) -> u8 {
        self.kind.dim()
    }

    /// The dtype of its numbers: "float32" or "float64".
    #[getter]
    fn dtype(&self) -> &'static str {
        self.kind.dtype()
    }

    /// The vertices (n, D) of a mesh, a polyline, a hull, a triangle or a segment, in the local frame; `AttributeError`
    /// for other shapes. For a hull these are the vertices of its surface.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        read_back::vertices(py, self)
    }

    /// The indices of the vertices of each triangle of a mesh (m, 3), or of each segment of a polyline (m, 2);
    /// `AttributeError` for other shapes.
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        read_back::faces(py, self)
    }

    /// Shapes are equal if they have the same name, dim and dtype, and the same bytes as a scene.
    fn __eq__(slf: &Bound<'_, Self>, other: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
        let py = slf.py();
        let Ok(other) = other.cast::<Self>() else { return Ok(py.NotImplemented()) };
        let is_equal = slf.is(other)
            || (slf.get().kind == other.get().kind
                && slf.get().name == other.get().name
                && bytes_of(slf)?.as_bytes() == bytes_of(other)?.as_bytes());
        Ok(PyBool::new(py, is_equal).to_owned().into_any().unbind())
    }

    fn __hash__(slf: &Bound<'_, Self>) -> PyResult<isize> {
        bytes_of(slf)?.hash()
    }

    fn __repr__(&self) -> String {
        format!("<impinge.{} {}D {}>", self.name, self.dim(), self.dtype())
    }

    /// A small picture, for notebooks.
    #[pyo3(name = "_repr_html_")]
    fn repr_html<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let pictures = slf.py().import("impinge._pictures")?;
        pictures.getattr("html_of")?.call1((slf,))
    }

    /// A shape is pickled as the bytes of a scene of this shape alone.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let bytes = bytes_of(slf)?;
        let read = py.import("impinge._native")?.getattr("shape_of_bytes")?;
        (read, (bytes,)).into_pyobject(py)
    }
}

/// Returns the bytes of a scene of this shape alone. Equality, hashes and pickles of shapes use
/// these bytes.
fn bytes_of<'py>(shape: &Bound<'py, Shape>) -> PyResult<Bound<'py, PyBytes>> {
    scene_bytes(shape.as_any(), &shape.py().None().into_bound(shape.py()))
}

/// Returns the name of the function that creates such shapes; for other shapes, their name in the library.
fn public_name<N: Numeric<D>, const D: usize>(shape: &ShapeHandle<N, D>) -> String {
    match shape.geometry().kind() {
        ShapeKind::Plane => "HalfSpace".to_owned(),
        ShapeKind::Polytope if N::is_tetrahedron(shape) => "Tetrahedron".to_owned(),
        ShapeKind::Polytope => "ConvexHull".to_owned(),
        ShapeKind::Composite if shape.as_shape::<TriMesh<N, D>>().is_some() => "TriMesh".to_owned(),
        ShapeKind::Composite if shape.as_shape::<Polyline<N, D>>().is_some() => {
            "Polyline".to_owned()
        }
        ShapeKind::Composite if shape.as_shape::<Compound<N, D>>().is_some() => {
            "Compound".to_owned()
        }
        ShapeKind::Composite => "HeightField".to_owned(),
        kind => format!("{kind:?}"),
    }
}

/// Creates a shape of the library.
struct Make<'d, 'a, 'py>(&'d Description<'a, 'py>);

impl Task for Make<'_, '_, '_> {
    type Answer = Shape;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let Self(description) = self;
        let children: Vec<ShapeHandle<N, D>> = description
            .children
            .iter()
            .map(|child| child.handle("a child", description.kind).cloned())
            .collect::<PyResult<_>>()?;
        let data = description.data::<N, D>()?;
        let child = |number: u32| Ok(children[number as usize].clone());
        let shape: ShapeHandle<N, D> = data.make(&child).map_err(|problem| refused(&problem))?;
        Ok(Shape::of(description.kind, shape))
    }
}

fn refused(problem: &Problem) -> PyErr {
    PyValueError::new_err(problem.to_string())
}

impl Description<'_, '_> {
    /// Converts the arguments of the constructor to this scalar and dimension.
    fn data<N: Numeric<D>, const D: usize>(&self) -> PyResult<ShapeData<N, D>> {
        let data = match self.name {
            "Ball" => ShapeData::Ball(self.number(0)?),
            "Cuboid" => ShapeData::Cuboid(self.vector()?),
            "Ellipsoid" => ShapeData::Ellipsoid(self.vector()?),
            "HalfSpace" => ShapeData::HalfSpace(self.vector()?),
            "Capsule" => ShapeData::Capsule { ends: self.points()?, radius: self.number(0)? },
            "TaperedCapsule" => ShapeData::TaperedCapsule {
                ends: self.points()?,
                radii: [self.number(0)?, self.number(1)?],
            },
            "Cylinder" => ShapeData::Cylinder([self.number(0)?, self.number(1)?]),
            "Cone" => ShapeData::Cone([self.number(0)?, self.number(1)?]),
            "Segment" => ShapeData::Segment(self.points()?),
            "Triangle" => ShapeData::Triangle(self.points()?),
            "Tetrahedron" => ShapeData::Tetrahedron(self.points()?),
            "Rounded" => ShapeData::Rounded { shape: 0, radius: self.number(0)? },
            _ => return self.composite(),
        };
        Ok(data)
    }

    /// Converts the arguments of convex hulls and composites.
    fn composite<N: Numeric<D>, const D: usize>(&self) -> PyResult<ShapeData<N, D>> {
        Ok(match self.name {
            "ConvexHull" => ShapeData::Hull { points: self.vertices()?, faces: Vec::new() },
            "ConvexPolygon" => ShapeData::Outline(self.outline()?),
            "TriMesh" => ShapeData::TriMesh(self.mesh()?),
            "Polyline" => ShapeData::Polyline(self.mesh()?),
            "HeightField" => ShapeData::HeightField(self.field()?),
            "Compound" => ShapeData::Compound(self.placed_children::<N, D>()?),
            name => return Err(PyValueError::new_err(format!("there is no shape {name:?}"))),
        })
    }

    fn number<N: Numeric<D>, const D: usize>(&self, index: usize) -> PyResult<N> {
        let missing = || PyValueError::new_err(format!("{} lacks number {index}", self.name));
        self.numbers.get(index).map(|number| convert(*number)).ok_or_else(missing)
    }

    /// Returns all numbers as a vector.
    fn vector<N: Numeric<D>, const D: usize>(&self) -> PyResult<Vector<N, D>> {
        if self.numbers.len() != D {
            let given = self.numbers.len();
            return Err(PyValueError::new_err(format!(
                "{} has {given} numbers in {D}D",
                self.name
            )));
        }
        Ok(Vector::from_fn(|axis, _| convert(self.numbers[axis])))
    }

    /// Returns all points.
    fn vertices<N: Numeric<D>, const D: usize>(&self) -> PyResult<Vec<Point<N, D>>> {
        let Some(points) = &self.points else {
            return Err(PyValueError::new_err(format!("{} lacks points", self.name)));
        };
        let (rows, _) = points.as_slice()?.as_chunks::<D>();
        Ok(rows
            .iter()
            .map(|row| Point::from(Vector::from_fn(|axis, _| convert(row[axis]))))
            .collect())
    }

    /// Returns the corners of the convex hull of all points, in 2D.
    fn outline<N: Numeric<D>, const D: usize>(&self) -> PyResult<Vec<Point<N, D>>> {
        let points = self.vertices::<N, D>()?;
        N::outline(&points).map_err(|error| refused(&Problem::from(error)))
    }

    /// Returns all points, of which there must be `COUNT`.
    fn points<N: Numeric<D>, const D: usize, const COUNT: usize>(
        &self,
    ) -> PyResult<[Point<N, D>; COUNT]> {
        let wrong = |points: Vec<_>| {
            PyValueError::new_err(format!("{} has {} points, not {COUNT}", self.name, points.len()))
        };
        self.vertices()?.try_into().map_err(wrong)
    }

    fn mesh<N: Space<D> + Numeric<D>, const D: usize, const ENDS: usize>(
        &self,
    ) -> PyResult<Mesh<N, D, ENDS>> {
        let Some(parts) = &self.parts else {
            return Err(PyValueError::new_err(format!("{} lacks parts", self.name)));
        };
        Ok(Mesh {
            vertices: self.vertices()?,
            parts: parts.as_slice()?.as_chunks::<ENDS>().0.to_vec(),
            ghosts: Vec::new(),
            is_one_sided: self.one_sided,
            is_solid: self.solid,
            keeps_internal_edges: self.keep_internal_edges,
        })
    }

    /// Reads a height field: the first `D` numbers are the scale, the next one is the number of columns, and the others
    /// are the heights.
    fn field<N: Numeric<D>, const D: usize>(&self) -> PyResult<Field<N, D>> {
        let [scale @ .., columns] = &self.numbers[..self.numbers.len().min(D + 1)] else {
            return Err(PyValueError::new_err("HeightField lacks numbers"));
        };
        let heights: Vec<N> =
            self.numbers.iter().skip(D + 1).map(|&height| convert(height)).collect();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count from Python's side"
        )]
        let columns = *columns as usize;
        let Some(marks) = &self.parts else {
            return Err(PyValueError::new_err("HeightField lacks marks"));
        };
        let marks = marks.as_slice()?.iter().map(|&mark| u8::try_from(mark).unwrap_or(0));
        Ok(Field {
            columns,
            heights,
            scale: Vector::from_fn(|axis, _| convert(scale[axis])),
            marks: marks.collect(),
            is_one_sided: self.one_sided,
            keeps_internal_edges: self.keep_internal_edges,
        })
    }

    fn placed_children<N: Numeric<D>, const D: usize>(&self) -> PyResult<Vec<(N::Isometry, u32)>> {
        let poses = Poses::<N, D>::of(self.poses, "poses")?;
        let source = poses.source()?;
        if source.len() != self.children.len() {
            let (poses, shapes) = (source.len(), self.children.len());
            return Err(PyValueError::new_err(format!("{poses} poses for {shapes} shapes")));
        }
        Ok((0..)
            .take(source.len())
            .map(|child| (N::isometry(&source.pose(child as usize)), child))
            .collect())
    }
}

/// An argument with shapes: a single shape, a shape for each element, or an object with the fields `shapes` and
/// `picks`.
pub(crate) enum ShapesArgument<'a, 'py, N: Numeric<D>, const D: usize> {
    One(&'a ShapeHandle<N, D>),
    Each(Vec<ShapeHandle<N, D>>),
    Picked { shapes: Vec<ShapeHandle<N, D>>, picks: PyReadonlyArray1<'py, u32> },
}

/// The shapes that an argument gives, and the indices into them if it has the field `picks`.
type Given<'py> = (Vec<PyRef<'py, Shape>>, Option<PyReadonlyArray1<'py, u32>>);

fn given<'py>(argument: &Bound<'py, PyAny>, name: &str) -> PyResult<Given<'py>> {
    let py = argument.py();
    let wrong = |error: PyErr| {
        let message = format!("{name} is no Shape, sequence of Shapes, or Picked");
        let refused = PyTypeError::new_err(message);
        refused.set_cause(py, Some(error));
        refused
    };
    match argument.getattr_opt("picks")? {
        None => Ok((argument.extract().map_err(wrong)?, None)),
        Some(picks) => {
            let shapes = argument.getattr("shapes")?.extract().map_err(wrong)?;
            Ok((shapes, Some(picks.extract()?)))
        }
    }
}

/// Returns the scalar and dimension of the first shape that an argument gives.
pub(crate) fn kind_of(argument: &Bound<'_, PyAny>, name: &str) -> PyResult<Kind> {
    if let Ok(shape) = argument.cast::<Shape>() {
        return Ok(shape.get().kind);
    }
    match given(argument, name)?.0.first() {
        Some(shape) => Ok(shape.kind),
        None => Err(PyValueError::new_err(format!("{name} has no shape"))),
    }
}

impl<'a, 'py, N: Numeric<D>, const D: usize> ShapesArgument<'a, 'py, N, D> {
    pub(crate) fn of(argument: &'a Bound<'py, PyAny>, name: &str, kind: Kind) -> PyResult<Self> {
        if let Ok(shape) = argument.cast::<Shape>() {
            return Ok(Self::One(shape.get().handle(name, kind)?));
        }
        let (shapes, picks) = given(argument, name)?;
        let handles = shapes
            .iter()
            .enumerate()
            .map(|(index, shape)| shape.handle(&format!("{name}[{index}]"), kind).cloned());
        let shapes = handles.collect::<PyResult<_>>()?;
        Ok(match picks {
            None => Self::Each(shapes),
            Some(picks) => Self::Picked { shapes, picks },
        })
    }

    /// Returns the shape if the argument is a single shape, not a sequence.
    pub(crate) const fn lone(&self) -> Option<&'a ShapeHandle<N, D>> {
        match self {
            Self::One(shape) => Some(shape),
            _ => None,
        }
    }

    /// Returns the shapes of the argument without repetition by elements: one, one for each
    /// element, or those that `picks` refers to.
    pub(crate) fn distinct(&self) -> &[ShapeHandle<N, D>] {
        match self {
            Self::One(shape) => core::slice::from_ref(*shape),
            Self::Each(shapes) | Self::Picked { shapes, .. } => shapes,
        }
    }

    /// Returns the shape of an element; a single shape belongs to all elements.
    pub(crate) fn at(&self, element: usize) -> &ShapeHandle<N, D> {
        let index = |len| if len == 1 { 0 } else { element };
        match self {
            Self::One(shape) => shape,
            Self::Each(shapes) => &shapes[index(shapes.len())],
            Self::Picked { shapes, picks } => {
                let picks = picks.as_array();
                &shapes[picks[index(picks.len())] as usize]
            }
        }
    }

    /// Returns the shapes in the form of the library.
    pub(crate) fn shapes(&self) -> PyResult<Shapes<'_, N, D>> {
        Ok(match self {
            Self::One(shape) => Shapes::One(&***shape),
            Self::Each(shapes) => Shapes::Each(shapes),
            Self::Picked { shapes, picks } => Shapes::Picked { shapes, picks: picks.as_slice()? },
        })
    }
}
