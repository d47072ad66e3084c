//! The vertices and faces of shapes, as arrays.

use impinge::math::{Point, Real, Space};
use impinge::shape::{
    ConvexHull, ConvexPolygon, Polyline, Segment, ShapeError, ShapeHandle, Tetrahedron, TriMesh,
    Triangle,
};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;

use crate::answer::Column;
use crate::shapes::Shape;
use crate::space::{Numeric, Task, run_in};

/// A scalar and a dimension, with the convex shapes that exist in this dimension only.
pub(crate) trait Cornered<const D: usize>: Space<D> {
    /// Returns the vertices of a convex shape that exists in this dimension only; `None` for other
    /// shapes.
    fn own_corners(shape: &ShapeHandle<Self, D>) -> Option<Vec<Point<Self, D>>>;

    /// Returns the corners of the convex hull of points in 2D, in any order: counter-clockwise, from
    /// the corner with the smallest x. In 3D, which has no outlines, returns the points.
    ///
    /// `ConvexPolygon::try_new` keeps these corners to the bit, so a pickle has the same corners.
    ///
    /// # Errors
    /// If the points span no area.
    fn outline(points: &[Point<Self, D>]) -> Result<Vec<Point<Self, D>>, ShapeError>;

    /// Whether the shape is a tetrahedron, not a convex hull.
    fn is_tetrahedron(shape: &ShapeHandle<Self, D>) -> bool;
}

impl<N: Real> Cornered<2> for N {
    fn own_corners(shape: &ShapeHandle<N, 2>) -> Option<Vec<Point<N, 2>>> {
        Some(shape.as_shape::<ConvexPolygon<N>>()?.polytope().vertices().to_vec())
    }

    fn outline(points: &[Point<N, 2>]) -> Result<Vec<Point<N, 2>>, ShapeError> {
        let mut corners = points.to_vec();
        // The hull of the corners of a dense hull may lack some of them, which lie within rounding
        // of a side. After the first pass, each pass but the last removes at least one corner.
        for _ in 0..points.len() {
            let hull = ConvexPolygon::try_from_points(&corners)?.vertices().to_vec();
            if hull == corners {
                break;
            }
            corners = hull;
        }
        Ok(corners)
    }

    fn is_tetrahedron(_: &ShapeHandle<N, 2>) -> bool {
        false
    }
}

impl<N: Real> Cornered<3> for N {
    fn own_corners(shape: &ShapeHandle<N, 3>) -> Option<Vec<Point<N, 3>>> {
        if let Some(hull) = shape.as_shape::<ConvexHull<N>>() {
            return Some(hull.polytope().vertices().to_vec());
        }
        Some(shape.as_shape::<Tetrahedron<N>>()?.corners().to_vec())
    }

    fn outline(points: &[Point<N, 3>]) -> Result<Vec<Point<N, 3>>, ShapeError> {
        Ok(points.to_vec())
    }

    fn is_tetrahedron(shape: &ShapeHandle<N, 3>) -> bool {
        shape.as_shape::<Tetrahedron<N>>().is_some()
    }
}

/// Returns the vertices of a shape, (n, D).
///
/// # Errors
/// `AttributeError` if the shape has no vertices.
pub(crate) fn vertices<'py>(py: Python<'py>, shape: &Shape) -> PyResult<Bound<'py, PyAny>> {
    run_in(shape.kind, Vertices { py, shape })
}

/// Returns the faces of a shape as indices of vertices: (m, 3), for polylines (m, 2).
///
/// # Errors
/// `AttributeError` if the shape has no faces.
pub(crate) fn faces<'py>(py: Python<'py>, shape: &Shape) -> PyResult<Bound<'py, PyAny>> {
    run_in(shape.kind, Faces { py, shape })
}

struct Vertices<'a, 'py> {
    py: Python<'py>,
    shape: &'a Shape,
}

impl<'py> Task for Vertices<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let handle = self.shape.handle::<N, D>("shape", self.shape.kind)?;
        let corners = corners(handle).ok_or_else(|| lacking(self.shape, "vertices"))?;
        let rows: Vec<[N; D]> = corners.iter().map(|corner| corner.coords.into()).collect();
        Column::Vectors(rows.into()).into_pyobject(self.py)
    }
}

fn corners<N: Numeric<D>, const D: usize>(shape: &ShapeHandle<N, D>) -> Option<Vec<Point<N, D>>> {
    if let Some(mesh) = shape.as_shape::<TriMesh<N, D>>() {
        return Some(mesh.vertices().to_vec());
    }
    if let Some(line) = shape.as_shape::<Polyline<N, D>>() {
        return Some(line.vertices().to_vec());
    }
    if let Some(triangle) = shape.as_shape::<Triangle<N, D>>() {
        return Some(triangle.corners().to_vec());
    }
    if let Some(segment) = shape.as_shape::<Segment<N, D>>() {
        return Some(vec![*segment.a(), *segment.b()]);
    }
    N::own_corners(shape)
}

struct Faces<'a, 'py> {
    py: Python<'py>,
    shape: &'a Shape,
}

impl<'py> Task for Faces<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let handle = self.shape.handle::<N, D>("shape", self.shape.kind)?;
        if let Some(mesh) = handle.as_shape::<TriMesh<N, D>>() {
            return rows(self.py, mesh.triangles());
        }
        match handle.as_shape::<Polyline<N, D>>() {
            Some(line) => rows(self.py, line.segments()),
            None => Err(lacking(self.shape, "faces")),
        }
    }
}

fn rows<'py, const ENDS: usize>(
    py: Python<'py>,
    parts: &[[u32; ENDS]],
) -> PyResult<Bound<'py, PyAny>> {
    let numbers = PyArray1::from_slice(py, parts.as_flattened());
    Ok(numbers.reshape([parts.len(), ENDS])?.into_any())
}

fn lacking(shape: &Shape, what: &str) -> PyErr {
    PyAttributeError::new_err(format!("a {} has no {what}", shape.name()))
}
