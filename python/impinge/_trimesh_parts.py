"""Parts of the collision manager of `impinge.trimesh`: contacts, distances, and meshes as shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._native import Shape, contact_manifolds, project_points, witness
from impinge._results import Floats, Witness
from impinge._shapes import ConvexHull, TriMesh

if TYPE_CHECKING:
    import trimesh

Matrix = NDArray[np.float64]

# The key under which a mesh of trimesh caches its geometry, until its vertices or faces change.
KEY = "impinge_geometry"

# The key under which a mesh of trimesh caches its geometry as a solid body, until it changes.
SOLID_KEY = "impinge_solid_geometry"

# The largest difference of a linear map from the rotation that replaces it.
ROUNDING = 1e-6


class ContactRow(TypedDict):
    """A contact point as the library returns it."""

    normal: Floats
    point: Floats
    depth: float


class ContactData:
    """A contact point of two meshes."""

    def __init__(self, names: tuple[str, str], faces: tuple[int, int], row: ContactRow) -> None:
        self.names = set(names)
        self._faces = dict(zip(names, faces, strict=True))
        self._normal, self._point, self._depth = row["normal"], row["point"], row["depth"]

    @property
    def normal(self) -> NDArray[np.float64]:
        """The unit normal, from the first mesh to the second."""
        return np.asarray(self._normal, np.float64)

    @property
    def point(self) -> NDArray[np.float64]:
        """The point in the world frame, in the middle between the two surfaces."""
        return np.asarray(self._point, np.float64)

    @property
    def depth(self) -> float:
        """The penetration depth at the point."""
        return float(self._depth)

    def index(self, name: str) -> int:
        """The index of the face of the mesh `name`."""
        return self._faces[name]


class DistanceData:
    """The closest points of two meshes."""

    def __init__(self, names: tuple[str, str], faces: tuple[int, int], found: Witness) -> None:
        self.names = set(names)
        self._points = dict(zip(names, (found.point1, found.point2), strict=True))
        self._faces = dict(zip(names, faces, strict=True))
        self._distance = float(found.distance)

    @property
    def distance(self) -> float:
        """The distance of the meshes; negative where they overlap."""
        return self._distance

    def index(self, name: str) -> int:
        """The index of the face of the mesh `name`."""
        return self._faces[name]

    def point(self, name: str) -> NDArray[np.float64]:
        """The point on this mesh, in the world frame."""
        return np.asarray(self._points[name], np.float64)


class Geometry:
    """A mesh as a shape. A convex mesh is a convex solid; another mesh is a surface, or a solid mesh if `is_body`.

    Flat meshes are convex but have no volume, so they are surfaces. ValueError if `is_body` and the mesh bounds no volume.
    """

    def __init__(self, vertices: ArrayLike, faces: ArrayLike, is_convex: bool, is_body: bool = False) -> None:
        self.vertices, self.faces = np.array(vertices, dtype=np.float64), np.array(faces)
        self._surface: Shape | None = None
        self.is_body = is_body
        self.is_solid = is_convex
        try:
            self.shape = ConvexHull(self.vertices) if is_convex else self.surface
        except ValueError:
            self.is_solid, self.shape = False, self.surface

    @classmethod
    def of(cls, mesh: trimesh.Trimesh, is_body: bool = False) -> Geometry:
        """Returns the geometry of a mesh. The mesh caches it until its vertices or faces change."""
        cache, key = getattr(mesh, "_cache", None), SOLID_KEY if is_body else KEY
        found = None if cache is None else cache[key]
        if isinstance(found, cls):
            return found
        made = cls(mesh.vertices, mesh.faces, bool(mesh.is_convex), is_body)
        if cache is not None:
            cache[key] = made
        return made

    @property
    def surface(self) -> Shape:
        """The mesh as a `TriMesh`; its parts have the indices of `faces`."""
        if self._surface is None:
            self._surface = TriMesh(self.vertices, self.faces, solid=self.is_body and not self.is_solid)
        return self._surface

    def stretched(self, stretch: Matrix) -> Geometry:
        """Returns the mesh after a linear map (3, 3). If it is a reflection, triangles are reversed, so that they face
        outwards."""
        faces = self.faces if np.linalg.det(stretch) > 0 else self.faces[:, ::-1]
        return Geometry(self.vertices @ stretch.T, faces, self.is_solid, self.is_body)


class Placed(NamedTuple):
    """A mesh with a name and a transform."""

    name: str
    geometry: Geometry
    transform: Matrix

    def faces(self, parts: ArrayLike, points: ArrayLike) -> NDArray[np.int64]:
        """Returns the face of each point: the part of a surface; for a convex solid the nearest triangle."""
        if not self.geometry.is_solid:
            return np.asarray(parts, dtype=np.int64)
        found = project_points(self.geometry.surface, self.transform, points, False)
        return np.asarray(found.part, dtype=np.int64)


def matrix_of(transform: ArrayLike | None) -> Matrix:
    """Returns a copy of a transform."""
    matrix = np.eye(4) if transform is None else np.array(transform, dtype=np.float64, order="C")
    if matrix.shape != (4, 4):
        raise ValueError(f"transform has the shape {matrix.shape}, where (4, 4) is needed")
    return matrix


def rotation_and_stretch(transform: Matrix) -> tuple[Matrix, Matrix | None]:
    """Returns a transform without scale, and the linear map (3, 3) to apply before it; `None` if there is no such map.

    ValueError if the transform is singular, not finite, or has a last row other than 0, 0, 0, 1.
    """
    linear = transform[:3, :3]
    if not np.isfinite(transform).all() or not np.array_equal(transform[3], [0, 0, 0, 1]):
        raise ValueError(f"the transform is no affine map: {transform.tolist()}")
    left, scales, right = np.linalg.svd(linear)
    if not scales[-1] > ROUNDING * scales[0]:
        raise ValueError(f"the transform flattens: its scales are {scales.tolist()}")
    if np.abs(scales - 1).max() <= ROUNDING and np.linalg.det(linear) > 0:
        return transform, None
    # The polar decomposition; a reflection belongs to the map applied before the rotation.
    rotation = left @ right
    if np.linalg.det(rotation) < 0:
        rotation = -rotation
    rigid = transform.copy()
    rigid[:3, :3] = rotation
    return rigid, rotation.T @ linear


def contacts(pairs: list[tuple[Placed, Placed]]) -> list[ContactData]:
    """Returns all contact points of pairs of meshes."""
    if not pairs:
        return []
    ones, others = zip(*pairs, strict=True)
    (shapes1, poses1), (shapes2, poses2) = _columns(ones), _columns(others)
    rows = contact_manifolds(shapes1, poses1, shapes2, poses2)
    data = []
    for number, (one, other) in enumerate(pairs):
        found = rows.of(number)
        if not len(found.depth):
            continue
        faces = zip(one.faces(found.part1, found.point1), other.faces(found.part2, found.point2), strict=True)
        for index, (face1, face2) in enumerate(faces):
            middle = (found.point1[index] + found.point2[index]) / 2
            row: ContactRow = {"normal": found.normal[index], "point": middle, "depth": found.depth[index]}
            data.append(ContactData((one.name, other.name), (int(face1), int(face2)), row))
    return data


def _columns(placed: tuple[Placed, ...]) -> tuple[list[Shape], NDArray[np.float64]]:
    return [one.geometry.shape for one in placed], np.array([one.transform for one in placed])


def measured(one: Placed, other: Placed) -> DistanceData:
    """Returns the nearest or deepest points of two meshes."""
    found = witness(one.geometry.shape, one.transform, other.geometry.shape, other.transform)
    faces = int(one.faces(found.part1, found.point1)), int(other.faces(found.part2, found.point2))
    return DistanceData((one.name, other.name), faces, found)
