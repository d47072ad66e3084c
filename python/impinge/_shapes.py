"""The shapes, made from numbers and arrays.

All lie around the origin of their own frame; capsules, cylinders and cones along y. `dtype` is "float64" or "float32":
the scalar in which the library works with the shape. Refused arguments raise ValueError with the value.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._native import Shape

DType = Literal["float32", "float64"]


class Picked:
    """Shapes for the elements of a batch by number: element i has `shapes[picks[i]]`.

    >>> import impinge
    >>> kinds = impinge.Picked([impinge.Ball(1), impinge.Ball(2)], [0, 1, 1])
    >>> impinge.distance(kinds, None, impinge.Ball(1), impinge.Poses([5, 0, 0])).tolist()
    [3.0, 2.0, 2.0]
    """

    def __init__(self, shapes: Sequence[Shape], picks: ArrayLike) -> None:
        self.shapes = list(shapes)
        numbers = np.asarray(picks)
        if numbers.ndim != 1 or (numbers.size and not np.issubdtype(numbers.dtype, np.integer)):
            raise ValueError(f"picks is {numbers.dtype} of the shape {numbers.shape}, where (n,) integers are needed")
        wrong = (numbers < 0) | (numbers >= len(self.shapes))
        if wrong.any():
            row = int(np.argmax(wrong))
            raise ValueError(f"picks[{row}] is {numbers[row]}, but there are {len(self.shapes)} shapes")
        self.picks: NDArray[np.uint32] = np.ascontiguousarray(numbers, dtype=np.uint32)

    def __len__(self) -> int:
        return len(self.picks)


def _make(
    name: str,
    dim: int,
    dtype: str,
    numbers: ArrayLike = (),
    points: Any = None,
    parts: Any = None,
    children: Sequence[Shape] = (),
    poses: Any = None,
    one_sided: bool = False,
    keep_internal_edges: bool = False,
) -> Shape:
    flat = np.ascontiguousarray(numbers, dtype=np.float64).ravel()
    return Shape(name, dim, dtype, flat, points, parts, list(children), poses, one_sided, keep_internal_edges)


def _rows(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Points as rows of two or three numbers."""
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ValueError(f"{name} has the shape {array.shape}, where (n, 2) or (n, 3) is needed")
    return array


def _vector(values: ArrayLike, name: str) -> NDArray[np.float64]:
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.ndim != 1 or array.shape[0] not in (2, 3):
        raise ValueError(f"{name} has the shape {array.shape}, where (2,) or (3,) is needed")
    return array


def _indices(values: ArrayLike, width: int, count: int, name: str) -> NDArray[np.uint32]:
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != width or not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"{name} is {array.dtype} of the shape {array.shape}, where (n, {width}) integers are needed")
    wrong = ((array < 0) | (array >= count)).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(f"{name}[{row}] is {array[row].tolist()}, but there are {count} vertices")
    return np.ascontiguousarray(array, dtype=np.uint32)


def Ball(radius: float, *, dim: int = 3, dtype: DType = "float64") -> Shape:
    """All points within a radius of the origin.

    >>> Ball(0.5)
    <impinge.Ball 3D float64>
    """
    return _make("Ball", dim, dtype, [radius])


def Cuboid(half_extents: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A box, or a rectangle in 2D, of half the side lengths."""
    half = _vector(half_extents, "half_extents")
    return _make("Cuboid", len(half), dtype, half)


def Ellipsoid(half_axes: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A stretched ball, or an ellipse in 2D."""
    half = _vector(half_axes, "half_axes")
    return _make("Ellipsoid", len(half), dtype, half)


def HalfSpace(normal: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """All points behind a plane (a line in 2D) through the origin; the normal points out and is normalized."""
    direction = _vector(normal, "normal")
    length = np.linalg.norm(direction)
    if not (np.isfinite(length) and length > 0):
        raise ValueError(f"normal is {direction.tolist()}, which has no direction")
    unit = (direction / length).astype(dtype)
    # In the scalar of the shape it must be a unit vector again.
    unit = (unit / np.linalg.norm(unit)).astype(np.float64)
    return _make("HalfSpace", len(direction), dtype, unit)


def Capsule(
    half_height: float | None = None,
    radius: float = 0.5,
    *,
    ends: ArrayLike | None = None,
    dim: int = 3,
    dtype: DType = "float64",
) -> Shape:
    """The points within a radius of a segment: along y from -half_height to half_height, or between two ends."""
    points = _between(half_height, ends, dim)
    return _make("Capsule", points.shape[1], dtype, [radius], points)


def TaperedCapsule(
    half_height: float | None = None,
    radii: ArrayLike = (0.5, 0.5),
    *,
    ends: ArrayLike | None = None,
    dim: int = 3,
    dtype: DType = "float64",
) -> Shape:
    """The hull of two balls with these radii around the lower and the upper end."""
    points = _between(half_height, ends, dim)
    return _make("TaperedCapsule", points.shape[1], dtype, radii, points)


def _between(half_height: float | None, ends: ArrayLike | None, dim: int) -> NDArray[np.float64]:
    if (half_height is None) == (ends is None):
        raise ValueError("give either half_height or ends")
    if ends is not None:
        return _rows(ends, "ends")
    points = np.zeros((2, dim))
    points[:, 1] = [-float(half_height or 0), float(half_height or 0)]
    return points


def Cylinder(half_height: float, radius: float, *, dtype: DType = "float64") -> Shape:
    """A cylinder along y, in 3D."""
    return _make("Cylinder", 3, dtype, [half_height, radius])


def Cone(half_height: float, radius: float, *, dtype: DType = "float64") -> Shape:
    """A cone along y with its apex on top, in 3D: the base is at -half_height."""
    return _make("Cone", 3, dtype, [half_height, radius])


def Segment(ends: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A straight line between two points (2, D)."""
    points = _rows(ends, "ends")
    return _make("Segment", points.shape[1], dtype, points=points)


def Triangle(corners: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A filled triangle of three points (3, D)."""
    points = _rows(corners, "corners")
    return _make("Triangle", points.shape[1], dtype, points=points)


def Tetrahedron(corners: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A solid of four points (4, 3)."""
    return _make("Tetrahedron", 3, dtype, points=_rows(corners, "corners"))


def Rounded(shape: Shape, radius: float) -> Shape:
    """The points within a radius of a convex shape."""
    return _make("Rounded", shape.dim, shape.dtype, [radius], children=[shape])


def ConvexHull(points: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """The convex hull of points (n, 3); in 2D of points (n, 2)."""
    rows = _rows(points, "points")
    name = "ConvexHull" if rows.shape[1] == 3 else "ConvexPolygon"
    return _make(name, rows.shape[1], dtype, points=rows)


def TriMesh(
    vertices: ArrayLike,
    triangles: ArrayLike,
    *,
    one_sided: bool = False,
    keep_internal_edges: bool = False,
    dtype: DType = "float64",
) -> Shape:
    """A surface of triangles: vertices (n, D) and the numbers of their corners (m, 3), counter-clockwise from outside.

    one_sided: nothing touches it from behind. keep_internal_edges: contacts treat each triangle on its own.

    >>> TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    <impinge.Composite 3D float64>
    """
    rows = _rows(vertices, "vertices")
    parts = _indices(triangles, 3, len(rows), "triangles")
    return _make(
        "TriMesh",
        rows.shape[1],
        dtype,
        points=rows,
        parts=parts,
        one_sided=one_sided,
        keep_internal_edges=keep_internal_edges,
    )


def Polyline(
    vertices: ArrayLike,
    segments: ArrayLike | None = None,
    *,
    one_sided: bool = False,
    keep_internal_edges: bool = False,
    dtype: DType = "float64",
) -> Shape:
    """A line of segments: vertices (n, D), and the numbers of the ends (m, 2); without, one vertex after the other."""
    rows = _rows(vertices, "vertices")
    if segments is None:
        segments = np.stack([np.arange(len(rows) - 1), np.arange(1, len(rows))], axis=1)
    parts = _indices(segments, 2, len(rows), "segments")
    return _make(
        "Polyline",
        rows.shape[1],
        dtype,
        points=rows,
        parts=parts,
        one_sided=one_sided,
        keep_internal_edges=keep_internal_edges,
    )


def HeightField(
    heights: ArrayLike,
    scale: ArrayLike,
    *,
    one_sided: bool = False,
    keep_internal_edges: bool = False,
    dtype: DType = "float64",
) -> Shape:
    """Heights along y over a grid around the origin: (rows, columns) in 3D, rows along z; (n,) in 2D.

    The scale has the sizes of the whole grid along x (and z), and the factor of heights along y.
    """
    grid = np.ascontiguousarray(heights, dtype=np.float64)
    if grid.ndim not in (1, 2):
        raise ValueError(f"heights has the shape {grid.shape}, where (n,) or (rows, columns) is needed")
    factors = _vector(scale, "scale")
    if len(factors) != grid.ndim + 1:
        raise ValueError(f"scale has {len(factors)} numbers, where {grid.ndim + 1} are needed")
    numbers = np.concatenate([factors, [grid.shape[-1]], grid.ravel()])
    return _make(
        "HeightField", grid.ndim + 1, dtype, numbers, one_sided=one_sided, keep_internal_edges=keep_internal_edges
    )


def Compound(shapes: Sequence[Shape], poses: Any) -> Shape:
    """Shapes that move as one, each at its pose in the frame of the compound."""
    if not shapes:
        raise ValueError("shapes is empty")
    return _make("Compound", shapes[0].dim, shapes[0].dtype, children=shapes, poses=poses)
