//! Errors of meshes and polylines.

use core::fmt;

use crate::math::{Point, Real, Vector};

/// The reason why a [`TriMesh`](crate::shape::TriMesh) or a [`Polyline`](crate::shape::Polyline)
/// rejected its input. Parts are the triangles or segments.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::{MeshError, Polyline};
///
/// let refused = Polyline::<f32>::try_open(vec![Point::origin()]).expect_err("one vertex");
/// assert_eq!(refused, MeshError::TooFewVertices { given: 1 });
/// assert_eq!(refused.to_string(), "a line through vertices needs two of them, 1 is given");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// There are no parts.
    Empty,
    /// Fewer than two vertices were given for a line through consecutive vertices.
    TooFewVertices {
        /// The number of vertices given.
        given: usize,
    },
    /// A coordinate of a vertex is NaN or infinite.
    VertexNotFinite {
        /// The index of the first such vertex.
        vertex: usize,
    },
    /// A part refers to a vertex that does not exist.
    NoSuchVertex {
        /// The index of the part.
        part: usize,
        /// The vertex index that the part contains.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// There are more vertices or parts than 32-bit indices allow.
    TooMany {
        /// The number of vertices or parts given.
        given: usize,
    },
    /// The number of vertices to move differs from the number of vertices of the shape.
    WrongCount {
        /// The number of vertices given.
        given: usize,
        /// The number of vertices that the mesh or polyline has.
        needed: usize,
    },
    /// A solid has a border: the edge of a triangle, or the end of a segment, that no other
    /// triangle or segment continues.
    NotClosed {
        /// The index of the part.
        part: usize,
        /// The vertices at the ends of the edge; for an open line, its end vertex twice.
        edge: [u32; 2],
    },
    /// The parts of a solid disagree about the inside. Each edge must be traversed equally often in
    /// both directions; at each vertex of a line, as many segments must start as end.
    NotOriented {
        /// The index of a part at the edge or vertex.
        part: usize,
        /// The vertices at the ends of the edge; for a line, the vertex twice.
        edge: [u32; 2],
    },
    /// The front of a closed surface faces its inside, and the surface does not bound a cavity in
    /// another closed surface.
    InsideOut {
        /// The index of the first part of the surface.
        part: usize,
    },
    /// A factor of a scale is zero, infinite or NaN.
    BadScale {
        /// The index of the axis: 0 for x.
        axis: usize,
        /// The scale along that axis of the shape's frame.
        value: f64,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => {
                write!(f, "no part is given: a mesh needs a triangle, a polyline a segment")
            }
            Self::TooFewVertices { given } => {
                write!(f, "a line through vertices needs two of them, {given} is given")
            }
            Self::VertexNotFinite { vertex } => write!(f, "vertex {vertex} is not finite"),
            Self::NoSuchVertex { part, vertex, vertices } => {
                write!(f, "part {part} names vertex {vertex}, but there are {vertices} vertices")
            }
            Self::TooMany { given } => {
                write!(f, "{given} vertices or parts are more than 32 bits can number")
            }
            Self::WrongCount { given, needed } => {
                write!(f, "{given} vertices were given for {needed}")
            }
            Self::NotClosed { part, edge: [from, to] } if from == to => {
                write!(
                    f,
                    "a solid is closed, but part {part} ends at vertex {from}, and none goes on"
                )
            }
            Self::NotClosed { part, edge: [from, to] } => write!(
                f,
                "a solid is closed, but nothing is beyond the edge from vertex {from} to {to} of part {part}"
            ),
            Self::NotOriented { part, edge: [from, to] } if from == to => write!(
                f,
                "as many segments of a solid start at a vertex as end there, but not at vertex {from} of part {part}"
            ),
            Self::NotOriented { part, edge: [from, to] } => write!(
                f,
                "the fronts of a solid agree across edges, but not at the edge from vertex {from} to {to} of part {part}"
            ),
            Self::InsideOut { part } => {
                write!(f, "the surface of part {part} has its front inside: flip its parts")
            }
            Self::BadScale { axis, value } => write!(f, "the scale along axis {axis} is {value}"),
        }
    }
}

impl std::error::Error for MeshError {}

/// The maximum number of vertices and of parts. The corners of all parts together must fit 32-bit
/// indices, of which a few values are reserved.
const MAX: usize = (u32::MAX / 3 - 2) as usize;

/// Checks that all vertices are finite and that there are at most [`MAX`].
pub(in crate::shape) fn check_vertices<N: Real, const D: usize>(
    vertices: &[Point<N, D>],
) -> Result<(), MeshError> {
    let is_finite = |point: &Point<N, D>| point.iter().all(|x| x.is_finite_number());
    match vertices.iter().position(|point| !is_finite(point)) {
        Some(vertex) => Err(MeshError::VertexNotFinite { vertex }),
        None if vertices.len() > MAX => Err(MeshError::TooMany { given: vertices.len() }),
        None => Ok(()),
    }
}

/// Checks that there is at least one part and at most [`MAX`], and that all vertex indices are
/// valid.
pub(in crate::shape) fn check_parts<const K: usize>(
    parts: &[[u32; K]],
    vertices: usize,
) -> Result<(), MeshError> {
    if parts.is_empty() {
        return Err(MeshError::Empty);
    }
    if parts.len() > MAX {
        return Err(MeshError::TooMany { given: parts.len() });
    }
    for (part, corners) in parts.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices) {
            return Err(MeshError::NoSuchVertex { part, vertex, vertices });
        }
    }
    Ok(())
}

/// Checks that all moved vertices are finite, and that their number is `needed`.
pub(in crate::shape) fn check_moved<N: Real, const D: usize>(
    vertices: &[Point<N, D>],
    needed: usize,
) -> Result<(), MeshError> {
    if vertices.len() != needed {
        return Err(MeshError::WrongCount { given: vertices.len(), needed });
    }
    check_vertices(vertices)
}

/// Checks that each component of the scale is finite and not zero.
pub(in crate::shape) fn check_scale<N: Real, const D: usize>(
    scale: &Vector<N, D>,
) -> Result<(), MeshError> {
    let is_bad = |x: &N| *x == N::ZERO || !x.is_finite_number();
    match scale.iter().position(is_bad) {
        Some(axis) => Err(MeshError::BadScale { axis, value: scale[axis].as_f64() }),
        None => Ok(()),
    }
}

/// Returns the mesh or polyline, or panics with the text of the error.
#[track_caller]
pub(in crate::shape) fn or_panic<S>(result: Result<S, MeshError>) -> S {
    match result {
        Ok(mesh) => mesh,
        Err(error) => panic!("{error}"),
    }
}
