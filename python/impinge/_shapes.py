"""Constructors of shapes from numbers and arrays.

Shapes that are given by sizes are centred at the origin of their local frame; capsules, cylinders and cones are along y.
`dtype` is "float64" or "float32", or NumPy's type: the scalar in which the library computes with the shape. Two shapes are
equal, with equal hashes, if they have the same kind and were created from the same numbers. `vertices` and `faces` return
their geometry. Invalid arguments raise ValueError with the value.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._native import Shape
from impinge._poses import DType, dtype_name, numbers

if TYPE_CHECKING:
    from impinge._native import PosesLike


class Picked:
    """Shapes for the elements of a batch by index: element i has `shapes[picks[i]]`.

    >>> import impinge
    >>> kinds = impinge.Picked([impinge.Ball(1), impinge.Ball(2)], [0, 1, 1])
    >>> impinge.distance(kinds, None, impinge.Ball(1), impinge.Poses([5, 0, 0])).tolist()
    [3.0, 2.0, 2.0]
    """

    def __init__(self, shapes: Sequence[Shape], picks: ArrayLike) -> None:
        self.shapes = list(shapes)
        given = np.asarray(picks)
        if given.ndim != 1 or (given.size and not np.issubdtype(given.dtype, np.integer)):
            raise ValueError(f"picks is {given.dtype} of the shape {given.shape}, where (n,) integers are needed")
        if given.size:
            wrong = (given < 0) | (given >= len(self.shapes))
            if wrong.any():
                row = int(np.argmax(wrong))
                raise ValueError(f"picks[{row}] is {given[row]}, but there are {len(self.shapes)} shapes")
        self.picks: NDArray[np.uint32] = given.astype(np.uint32)

    def __len__(self) -> int:
        return len(self.picks)


def _make(
    name: str,
    dim: int,
    dtype: DType,
    values: ArrayLike = (),
    points: NDArray[np.float64] | None = None,
    parts: NDArray[np.uint32] | None = None,
    children: Sequence[Shape] = (),
    poses: PosesLike = None,
    one_sided: bool = False,
    keep_internal_edges: bool = False,
    solid: bool = False,
) -> Shape:
    flat = np.ascontiguousarray(values, dtype=np.float64).ravel()
    if not all(isinstance(child, Shape) for child in children):
        row = next(row for row, child in enumerate(children) if not isinstance(child, Shape))
        raise TypeError(f"shapes[{row}] is {type(children[row]).__name__}, where a Shape is needed")
    flags = one_sided, keep_internal_edges, solid
    return Shape(name, dim, dtype_name(dtype), flat, points, parts, list(children), poses, *flags)


def _floats(values: ArrayLike, name: str) -> NDArray[np.float64]:
    return numbers(values, np.float64, name, "numbers")


def _number(value: Any, name: str) -> float:
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} is no number: {type(value).__name__}") from error


def _finite(rows: NDArray[np.float64], name: str) -> NDArray[np.float64]:
    wrong = ~np.isfinite(rows)
    if wrong.any():
        row = tuple(int(index) for index in np.argwhere(wrong)[0])
        raise ValueError(f"{name}{list(row)} is {rows[row]}")
    return rows


def _rows(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Points as an array (n, 2) or (n, 3)."""
    array = _finite(_floats(values, name), name)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ValueError(f"{name} has the shape {array.shape}, where (n, 2) or (n, 3) is needed")
    return array


def _vector(values: ArrayLike, name: str) -> NDArray[np.float64]:
    array = _finite(_floats(values, name), name)
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


def _dim(given: int) -> int:
    if given not in (2, 3):
        raise ValueError(f"dim is {given}: it is 2 or 3")
    return int(given)


def Ball(radius: float, *, dim: int = 3, dtype: DType = "float64") -> Shape:
    """All points within a radius of the origin.

    >>> Ball(0.5)
    <impinge.Ball 3D float64>
    """
    return _make("Ball", _dim(dim), dtype, [_number(radius, "radius")])


def Cuboid(half_extents: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A box, or a rectangle in 2D, with half extents (D,), none of which is negative.

    >>> Cuboid([1, 2]), Cuboid([1, 2, 3], dtype="float32")
    (<impinge.Cuboid 2D float64>, <impinge.Cuboid 3D float32>)
    """
    half = _vector(half_extents, "half_extents")
    return _make("Cuboid", len(half), dtype, half)


def Ellipsoid(half_axes: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """An ellipsoid, or an ellipse in 2D, with half axes (D,).

    >>> Ellipsoid([3, 2, 1])
    <impinge.Ellipsoid 3D float64>
    """
    half = _vector(half_axes, "half_axes")
    return _make("Ellipsoid", len(half), dtype, half)


def HalfSpace(normal: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """All points behind a plane (in 2D a line) through the origin; the normal (D,) points outwards and is normalized.

    >>> HalfSpace([0, 1, 0])
    <impinge.HalfSpace 3D float64>
    """
    direction = _vector(normal, "normal")
    length = np.linalg.norm(direction)
    if not (np.isfinite(length) and length > 0):
        raise ValueError(f"normal is {direction.tolist()}, which has no direction")
    unit = (direction / length).astype(dtype)
    # The vector must have unit length after rounding to the scalar of the shape.
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
    """The points within a radius of a segment: along y from -half_height to half_height, or between two ends (2, D).

    >>> Capsule(1.0, 0.25), Capsule(ends=[[0, 0], [3, 4]], radius=1)
    (<impinge.Capsule 3D float64>, <impinge.Capsule 2D float64>)
    """
    points = _between(half_height, ends, dim)
    return _make("Capsule", points.shape[1], dtype, [_number(radius, "radius")], points)


def TaperedCapsule(
    half_height: float | None = None,
    radii: ArrayLike = (0.5, 0.5),
    *,
    ends: ArrayLike | None = None,
    dim: int = 3,
    dtype: DType = "float64",
) -> Shape:
    """The hull of two balls with radii (2,) around the lower and the upper end, or around two given ends (2, D).

    >>> TaperedCapsule(1.0, [0.5, 0.25])
    <impinge.TaperedCapsule 3D float64>
    """
    points = _between(half_height, ends, dim)
    both = _floats(radii, "radii")
    if both.shape != (2,):
        raise ValueError(f"radii has the shape {both.shape}, where (2,) is needed")
    return _make("TaperedCapsule", points.shape[1], dtype, both, points)


def _between(half_height: float | None, ends: ArrayLike | None, dim: int) -> NDArray[np.float64]:
    if (half_height is None) == (ends is None):
        raise ValueError("give either half_height or ends")
    if ends is not None:
        return _rows(ends, "ends")
    points = np.zeros((2, _dim(dim)))
    height = _number(half_height, "half_height")
    if not 0 <= height < np.inf:
        raise ValueError(f"half_height is {height}: it is finite and not negative")
    points[:, 1] = [-height, height]
    return points


def Cylinder(half_height: float, radius: float, *, dtype: DType = "float64") -> Shape:
    """A cylinder along y, in 3D.

    >>> Cylinder(1.0, 0.5)
    <impinge.Cylinder 3D float64>
    """
    return _make("Cylinder", 3, dtype, [_number(half_height, "half_height"), _number(radius, "radius")])


def Cone(half_height: float, radius: float, *, dtype: DType = "float64") -> Shape:
    """A cone along y with its apex on top, in 3D: the base of this radius is at -half_height.

    >>> Cone(1.0, 0.5)
    <impinge.Cone 3D float64>
    """
    return _make("Cone", 3, dtype, [_number(half_height, "half_height"), _number(radius, "radius")])


def Segment(ends: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A segment between two points (2, D).

    >>> Segment([[0, 0], [1, 0]])
    <impinge.Segment 2D float64>
    """
    points = _rows(ends, "ends")
    return _make("Segment", points.shape[1], dtype, points=points)


def Triangle(corners: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """A filled triangle of three points (3, D).

    >>> Triangle([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    <impinge.Triangle 3D float64>
    """
    points = _rows(corners, "corners")
    return _make("Triangle", points.shape[1], dtype, points=points)


def Tetrahedron(corners: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """The hull of four points (4, 3).

    >>> Tetrahedron([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    <impinge.Tetrahedron 3D float64>
    """
    points = _rows(corners, "corners")
    if points.shape != (4, 3):
        raise ValueError(f"corners has the shape {points.shape}, where (4, 3) is needed")
    return _make("Tetrahedron", 3, dtype, points=points)


def Rounded(shape: Shape, radius: float) -> Shape:
    """The points within a radius of a convex shape. ValueError for a half-space or a composite.

    >>> Rounded(Cuboid([1, 1, 1]), 0.25)
    <impinge.Rounded 3D float64>
    """
    if not isinstance(shape, Shape):
        raise TypeError(f"shape is {type(shape).__name__}, where a Shape is needed")
    return _make("Rounded", shape.dim, shape.dtype, [_number(radius, "radius")], children=[shape])


def ConvexHull(points: ArrayLike, *, dtype: DType = "float64") -> Shape:
    """The convex hull of points (n, 3); in 2D of points (n, 2). ValueError if the hull has no volume (in 2D no area).

    The points may be in any order, and inside the hull. In 2D the vertices are counter-clockwise, from the one with the
    smallest x.

    >>> ConvexHull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0.1, 0.1]])
    <impinge.ConvexHull 3D float64>
    >>> ConvexHull([[0, 0], [1, 1], [1, 0], [0, 1], [0.5, 0.5]]).vertices.tolist()
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
    """
    rows = _rows(points, "points")
    name = "ConvexHull" if rows.shape[1] == 3 else "ConvexPolygon"
    return _make(name, rows.shape[1], dtype, points=rows)


def TriMesh(
    vertices: ArrayLike,
    triangles: ArrayLike,
    *,
    one_sided: bool = False,
    solid: bool = False,
    keep_internal_edges: bool = False,
    dtype: DType = "float64",
) -> Shape:
    """A surface of triangles, filled in 2D: vertices (n, D) and vertex indices of the triangles (m, 3).

    The corners are in counter-clockwise order as seen from outside. ValueError names the row of an invalid triangle or vertex.

    one_sided: there are no contacts from behind. keep_internal_edges: contacts treat each triangle separately.

    A closed mesh has an inside for `contains`, `signed_distance` and `World.containing`; all other queries treat it as a
    surface, unless `solid` is true: then shapes inside it are in contact too, and their contacts lead out. In 3D, ValueError
    names the edge at which a solid is not closed, or a triangle whose front is inside.

    >>> import impinge
    >>> corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]
    >>> pyramid = TriMesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], solid=True)
    >>> impinge.contact(pyramid, None, Ball(0.25), impinge.Poses([1, 1, 0.5])).depth
    0.75
    >>> mesh = TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> mesh, mesh.vertices.shape, mesh.faces.tolist()
    (<impinge.TriMesh 3D float64>, (3, 3), [[0, 1, 2]])
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
        solid=solid,
        keep_internal_edges=keep_internal_edges,
    )


def Polyline(
    vertices: ArrayLike,
    segments: ArrayLike | None = None,
    *,
    one_sided: bool = False,
    solid: bool = False,
    keep_internal_edges: bool = False,
    dtype: DType = "float64",
) -> Shape:
    """A chain of segments: vertices (n, D), and vertex indices of the segments (m, 2); by default consecutive vertices.

    In 2D a closed polyline has an inside for points, as a closed mesh in 3D. With `solid`, which requires a closed and
    counter-clockwise polyline, it has an inside in all queries.

    >>> Polyline([[0, 0], [1, 0], [1, 1]])
    <impinge.Polyline 2D float64>
    """
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
        solid=solid,
        keep_internal_edges=keep_internal_edges,
    )


def HeightField(
    heights: ArrayLike,
    scale: ArrayLike,
    *,
    holes: ArrayLike | None = None,
    ghosts: ArrayLike | None = None,
    backward: ArrayLike | bool = False,
    one_sided: bool = False,
    keep_internal_edges: bool = False,
    dtype: DType = "float64",
) -> Shape:
    """Heights along y over a grid around the origin: (rows, columns) in 3D, rows along z; (n,) in 2D.

    scale: (D,), the extents of the whole grid along x (and z), and the factor of heights along y. holes: bools for missing
    cells, (n-1,) in 2D and (rows-1, columns-1) in 3D, or (rows-1, columns-1, 2) for the triangles of cells. ghosts: bools
    (n-1,) or (rows-1, columns-1) for cells that nothing touches, but whose edges to other cells are internal edges. Ghosts are
    the border that a tile of a terrain shares with its neighbours; with ghosts nothing bumps into the edge between two tiles.
    backward: a bool, or one for each cell in 3D, whether the two triangles of the cell share the other diagonal. one_sided:
    there are no contacts from below.

    >>> import impinge
    >>> field = HeightField([[0, 0, 0], [0, 2, 0], [0, 0, 0]], [4, 0.5, 4], holes=[[True, False], [False, False]])
    >>> impinge.cast_rays(field, None, [[-1, 9, -1], [1, 9, 1]], [0, -1, 0]).time.tolist()
    [inf, 8.5]
    >>> tile = HeightField([0.0] * 5, [4, 1], ghosts=[True, False, False, True])
    >>> impinge.cast_rays(tile, None, [[-1.5, 9], [0.5, 9]], [0, -1]).time.tolist()
    [inf, 9.0]
    """
    grid = _finite(_floats(heights, "heights"), "heights")
    if grid.ndim not in (1, 2) or min(grid.shape) < 2:
        need = "(n,) or (rows, columns) with at least 2"
        raise ValueError(f"heights has the shape {grid.shape}, where {need} is needed")
    factors = _vector(scale, "scale")
    if len(factors) != grid.ndim + 1:
        raise ValueError(f"scale has {len(factors)} numbers, where {grid.ndim + 1} are needed")
    values = np.concatenate([factors, [grid.shape[-1]], grid.ravel()])
    return _make(
        "HeightField",
        grid.ndim + 1,
        dtype,
        values,
        parts=_marks(tuple(size - 1 for size in grid.shape), holes, ghosts, backward),
        one_sided=one_sided,
        keep_internal_edges=keep_internal_edges,
    )


def _marks(
    cells: tuple[int, ...], holes: ArrayLike | None, ghosts: ArrayLike | None, backward: ArrayLike
) -> NDArray[np.uint32]:
    """Returns the flags of cells: bits 0 and 1 for missing triangles, bit 2 for the other diagonal, bit 3 for ghosts."""
    marks = np.zeros(cells, dtype=np.uint32)
    if holes is not None:
        missing = _bools(holes, "holes")
        if missing.shape == (*cells, 2) and len(cells) == 2:
            marks |= missing[..., 0] * np.uint32(1) | missing[..., 1] * np.uint32(2)
        elif missing.shape == cells:
            marks |= missing * np.uint32(3 if len(cells) == 2 else 1)
        else:
            raise ValueError(f"holes has the shape {missing.shape}, where {cells} is needed")
    if ghosts is not None:
        untouched = _bools(ghosts, "ghosts")
        if untouched.shape != cells:
            raise ValueError(f"ghosts has the shape {untouched.shape}, where {cells} is needed")
        marks |= untouched * np.uint32(8)
    turned = _bools(backward, "backward")
    if turned.shape not in ((), cells) or (turned.any() and len(cells) == 1):
        raise ValueError(f"backward has the shape {turned.shape}, where a bool or, in 3D, {cells} is needed")
    marks |= turned * np.uint32(4)
    return marks.reshape(-1, 1)


def _bools(given: ArrayLike, name: str) -> NDArray[np.bool_]:
    array = np.asarray(given)
    if array.dtype != np.bool_:
        raise TypeError(f"{name} is {array.dtype}, where bools are needed")
    return array


def Compound(shapes: Sequence[Shape], poses: PosesLike) -> Shape:
    """A compound of shapes, each at its pose in the frame of the compound: as many poses (n, D+1, D+1) as shapes.

    The shapes may be compounds and other composites. ValueError if there is no shape, or a half-space among them.

    >>> import impinge
    >>> Compound([Ball(1), Cuboid([1, 1, 1])], impinge.Poses([[0, 0, 0], [3, 0, 0]]))
    <impinge.Compound 3D float64>
    """
    if isinstance(shapes, Shape):
        raise TypeError("shapes is a Shape, where a sequence of Shapes is needed")
    if len(shapes) == 0:
        raise ValueError("shapes is empty")
    if not isinstance(shapes[0], Shape):
        raise TypeError(f"shapes[0] is {type(shapes[0]).__name__}, where a Shape is needed")
    return _make("Compound", shapes[0].dim, shapes[0].dtype, children=shapes, poses=poses)
