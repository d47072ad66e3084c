//! Closed surfaces and polylines as solids, in queries about points.
//!
//! In the library a mesh that was not made solid is a surface without an interior, and `TriMesh::signed_distance`
//! returns its distance with the sign of the enclosed volume. Here a closed mesh in 3D and a closed polyline in 2D are
//! solids. Other meshes, polylines and height fields are *open*: they bound nothing, and a query about their inside is
//! an error unless the caller declares them surfaces (`surface=True`). A compound is the union of its children.

use impinge::math::{Point, Pose, Real, Space};
use impinge::query::PointQuery;
use impinge::shape::{Compound, HeightField, Polyline, ShapeHandle, ShapeKind, TriMesh};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::space::Numeric;

/// A scalar and a dimension in which surfaces may bound a solid.
pub(crate) trait Bounding<const D: usize>: Space<D> {
    /// Returns the signed distance of a point in the local frame from a mesh or polyline, negative inside; `None` if
    /// the shape bounds nothing, and for solids.
    fn signed_distance(shape: &ShapeHandle<Self, D>, point: &Point<Self, D>) -> Option<Self>;

    /// Returns whether a point in the local frame lies inside a mesh or polyline, or on it; `None`
    /// if the shape bounds nothing, and for solids.
    fn encloses(shape: &ShapeHandle<Self, D>, point: &Point<Self, D>) -> Option<bool>;

    /// Returns the kind of a surface or polyline; `None` for other shapes.
    fn standing(shape: &ShapeHandle<Self, D>) -> Option<Standing>;
}

/// The kind of a shape with a surface but no interior of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    /// The surface bounds a solid.
    Closed,
    /// The surface bounds nothing; the string is the name of its shape.
    Open(&'static str),
}

impl<N: Real> Bounding<2> for N {
    fn signed_distance(shape: &ShapeHandle<N, 2>, point: &Point<N, 2>) -> Option<N> {
        shape.as_shape::<Polyline<N, 2>>()?.signed_distance(point)
    }

    fn encloses(shape: &ShapeHandle<N, 2>, point: &Point<N, 2>) -> Option<bool> {
        shape.as_shape::<Polyline<N, 2>>()?.encloses(point)
    }

    /// Returns `None` for a mesh: in 2D its triangles are filled.
    fn standing(shape: &ShapeHandle<N, 2>) -> Option<Standing> {
        if let Some(line) = shape.as_shape::<Polyline<N, 2>>() {
            let is_closed = line.is_outline();
            return Some(if is_closed { Standing::Closed } else { Standing::Open("Polyline") });
        }
        shape.as_shape::<HeightField<N, 2>>().map(|_| Standing::Open("HeightField"))
    }
}

impl<N: Real> Bounding<3> for N {
    fn signed_distance(shape: &ShapeHandle<N, 3>, point: &Point<N, 3>) -> Option<N> {
        shape.as_shape::<TriMesh<N, 3>>()?.signed_distance(point)
    }

    fn encloses(shape: &ShapeHandle<N, 3>, point: &Point<N, 3>) -> Option<bool> {
        shape.as_shape::<TriMesh<N, 3>>()?.encloses(point)
    }

    fn standing(shape: &ShapeHandle<N, 3>) -> Option<Standing> {
        if let Some(mesh) = shape.as_shape::<TriMesh<N, 3>>() {
            let is_closed = mesh.is_volume();
            return Some(if is_closed { Standing::Closed } else { Standing::Open("TriMesh") });
        }
        // A polyline bounds nothing in 3D.
        if shape.as_shape::<Polyline<N, 3>>().is_some() {
            return Some(Standing::Open("Polyline"));
        }
        shape.as_shape::<HeightField<N, 3>>().map(|_| Standing::Open("HeightField"))
    }
}

/// Returns the kind of the shape; `None` for solids. A compound is open if a child is open, otherwise closed if a
/// child is closed.
pub(crate) fn standing<N: Numeric<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
) -> Option<Standing> {
    if shape.geometry().kind() != ShapeKind::Composite {
        return None;
    }
    if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
        let all = compound.children().iter().filter_map(|(_, child)| standing(child));
        return all.reduce(|one, other| if one == Standing::Closed { other } else { one });
    }
    N::standing(shape)
}

/// Returns an error if `standing` is that of an open surface; `name` is the argument with the
/// shape.
///
/// # Errors
/// `ValueError`, with the name of the argument and the name of the shape.
pub(crate) fn refuse_open(standing: Option<Standing>, name: &str) -> PyResult<()> {
    let Some(Standing::Open(kind)) = standing else { return Ok(()) };
    Err(PyValueError::new_err(format!(
        "{name} has a {kind} that is not closed: it has no inside, and is asked as a surface by surface=True"
    )))
}

/// Whether a point lies in the placed shape or on its boundary. The point is in the frame in which
/// `pose` places the shape.
pub(crate) fn contains<N: Numeric<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    pose: &Pose<N, D>,
    point: &Point<N, D>,
) -> bool {
    let local = pose.inverse_point(point);
    if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
        let mut children = compound.children().iter();
        return children.any(|(at, child)| contains(child, &N::pose(at), &local));
    }
    N::encloses(shape, &local).unwrap_or_else(|| shape.contains_local_point(&local))
}

/// Returns the distance of a point from the placed shape, negative inside. The point is in the frame in which `pose`
/// places the shape. For a compound the result is the smallest distance of its children.
pub(crate) fn signed_distance<N: Numeric<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    pose: &Pose<N, D>,
    point: &Point<N, D>,
) -> N {
    let local = pose.inverse_point(point);
    if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
        let distances = compound.children().iter();
        let distances = distances.map(|(at, child)| signed_distance(child, &N::pose(at), &local));
        return distances.fold(N::INFINITY, |one, other| if other < one { other } else { one });
    }
    let of_bounded = N::signed_distance(shape, &local);
    of_bounded.unwrap_or_else(|| shape.signed_distance_to_local_point(&local))
}
