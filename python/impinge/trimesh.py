"""The collision manager of trimesh, answered by impinge: the same interface, without FCL.

    from impinge.trimesh import CollisionManager, scene_to_collision

Convex meshes (`mesh.is_convex`) are solids and others are surfaces, as they are in trimesh: what is inside a surface without
touching it does not collide. Where meshes overlap, distances are negative: minus the depth, of surfaces that of the triangles
that are deepest in each other.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._native import Shape, contact_manifolds, nearest, pairs_within, project_points, witness
from impinge._shapes import ConvexHull, Picked, TriMesh

if TYPE_CHECKING:
    import trimesh

# What trimesh calls a mesh that was given with a query.
EXTERNAL = "__external"


class ContactData:
    """A contact point of two meshes."""

    def __init__(self, names: tuple[str, str], faces: tuple[int, int], row: Mapping[str, Any]) -> None:
        self.names = set(names)
        self._faces = dict(zip(names, faces, strict=True))
        self._normal, self._point, self._depth = row["normal"], row["point"], row["depth"]

    @property
    def normal(self) -> NDArray[np.float64]:
        """The unit normal, from the first mesh to the second."""
        return np.asarray(self._normal)

    @property
    def point(self) -> NDArray[np.float64]:
        """The point in the world, in the middle of the two surfaces."""
        return np.asarray(self._point)

    @property
    def depth(self) -> float:
        """How deep the meshes overlap there."""
        return float(self._depth)

    def index(self, name: str) -> int:
        """The face of this mesh."""
        return self._faces[name]


class DistanceData:
    """The nearest points of two meshes."""

    def __init__(self, names: tuple[str, str], faces: tuple[int, int], found: Any) -> None:
        self.names = set(names)
        self._points = dict(zip(names, (found.point1, found.point2), strict=True))
        self._faces = dict(zip(names, faces, strict=True))
        self._distance = float(found.distance)

    @property
    def distance(self) -> float:
        """How far the meshes are apart; negative where they overlap."""
        return self._distance

    def index(self, name: str) -> int:
        """The face of this mesh."""
        return self._faces[name]

    def point(self, name: str) -> NDArray[np.float64]:
        """The point on this mesh, in the world."""
        return np.asarray(self._points[name])


class CollisionManager:
    """Meshes by name, each with a transform: who touches whom, and how far apart they are.

    >>> import trimesh
    >>> manager = CollisionManager()
    >>> shape = manager.add_object("box", trimesh.creation.box())
    >>> away = trimesh.transformations.translation_matrix([3, 0, 0])
    >>> manager.in_collision_single(trimesh.creation.box(), away)
    False
    >>> round(manager.min_distance_single(trimesh.creation.box(), away), 9)
    2.0
    """

    def __init__(self) -> None:
        self._shapes: dict[str, Shape] = {}
        # The triangles of convex meshes, which name faces.
        self._surfaces: dict[str, Shape] = {}
        self._transforms: dict[str, NDArray[np.float64]] = {}

    def add_object(self, name: str, mesh: trimesh.Trimesh, transform: ArrayLike | None = None) -> Shape:
        """Adds a mesh, or replaces the one of this name."""
        matrix, surface = _matrix(transform), TriMesh(mesh.vertices, mesh.faces)
        self._place(name, _shape(mesh, surface), surface, matrix)
        return self._shapes[name]

    def remove_object(self, name: str) -> None:
        """Removes a mesh."""
        self._known(name)
        del self._shapes[name], self._surfaces[name], self._transforms[name]

    def set_transform(self, name: str, transform: ArrayLike) -> None:
        """Moves a mesh."""
        self._known(name)
        self._transforms[name] = _matrix(transform)

    def in_collision_single(
        self,
        mesh: trimesh.Trimesh,
        transform: ArrayLike | None = None,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Any:
        """Whether a mesh touches one of the manager: `bool`, and if wanted the names and the contacts."""
        found, pairs, data = self._against(_single(mesh, transform), return_data)
        return _answer(found, {name for name, _ in pairs}, data, return_names, return_data)

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Whether any two meshes touch; the names are pairs in ascending order."""
        names = sorted(self._shapes)
        rows = self._pairs(names, names) if len(names) > 1 else np.empty((0, 2), np.uint32)
        data = self._contacts((names, rows[:, 0]), (self, names, rows[:, 1])) if return_data else []
        pairs = {(names[one], names[other]) for one, other in rows.tolist()}
        return _answer(bool(len(rows)), pairs, data, return_names, return_data)

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Whether a mesh touches one of another manager; the names are pairs, the own first."""
        found, pairs, data = self._against(other_manager, return_data)
        return _answer(found, pairs, data, return_names, return_data)

    def min_distance_single(
        self,
        mesh: trimesh.Trimesh,
        transform: ArrayLike | None = None,
        return_name: bool = False,
        return_data: bool = False,
    ) -> Any:
        """How far a mesh is from the nearest one of the manager."""
        distance, names, data = self._nearest(_single(mesh, transform), None, return_data)
        return _answer(distance, names[0], data, return_name, return_data)

    def min_distance_internal(
        self, name: str | None = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """How far the nearest two meshes are apart; with a name, those of which one is this mesh."""
        one, other = np.triu_indices(len(self._shapes), 1)
        if name is not None:
            self._known(name)
            row = sorted(self._shapes).index(name)
            is_wanted = (one == row) | (other == row)
            one, other = one[is_wanted], other[is_wanted]
        distance, names, data = self._nearest(self, (one, other), return_data)
        return _answer(distance, tuple(sorted(names)), data, return_names, return_data)

    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """How far the nearest meshes of two managers are apart; the own name is the first."""
        distance, names, data = self._nearest(other_manager, None, return_data)
        return _answer(distance, names, data, return_names, return_data)

    def _place(self, name: str, shape: Shape, surface: Shape, matrix: NDArray[np.float64]) -> None:
        self._shapes[name], self._surfaces[name], self._transforms[name] = shape, surface, matrix

    def _faces(self, name: str, parts: Any, points: Any) -> NDArray[np.int64]:
        """The faces that hold points of a mesh: its parts, or of a solid the triangles that are nearest."""
        if self._shapes[name] is self._surfaces[name]:
            return np.asarray(parts, dtype=np.int64)
        found = project_points(self._surfaces[name], self._transforms[name], points, False)
        return np.asarray(found.part, dtype=np.int64)

    def _known(self, name: str) -> None:
        if name not in self._shapes:
            raise ValueError(f"{name} is not in the manager")

    def _placed(self, names: Iterable[str]) -> tuple[list[Shape], NDArray[np.float64]]:
        names = list(names)
        poses = np.array([self._transforms[name] for name in names]).reshape(-1, 4, 4)
        return [self._shapes[name] for name in names], poses

    def _pairs(
        self, names: list[str], others: list[str], manager: CollisionManager | None = None
    ) -> NDArray[np.uint32]:
        """The rows of names that touch; without another manager of this one's own."""
        if manager is None:
            return pairs_within(*self._placed(names))
        return pairs_within(*self._placed(names), *manager._placed(others))

    def _against(self, manager: CollisionManager, return_data: bool) -> tuple[bool, set[tuple[str, str]], list[Any]]:
        names, others = sorted(self._shapes), sorted(manager._shapes)
        if not names or not others:
            return False, set(), []
        rows = self._pairs(names, others, manager)
        data = self._contacts((names, rows[:, 0]), (manager, others, rows[:, 1])) if return_data else []
        return bool(len(rows)), {(names[one], others[other]) for one, other in rows.tolist()}, data

    def _contacts(
        self, own: tuple[list[str], Any], others: tuple[CollisionManager, list[str], Any]
    ) -> list[ContactData]:
        """All contact points of the pairs of these rows."""
        (names, one), (manager, other_names, other) = own, others
        if not len(one):
            return []
        (shapes1, poses1), (shapes2, poses2) = self._placed(names), manager._placed(other_names)
        rows = contact_manifolds(Picked(shapes1, one), poses1[one], Picked(shapes2, other), poses2[other])
        data = []
        for pair in range(len(one)):
            pair_names = names[int(one[pair])], other_names[int(other[pair])]
            found = rows.of(pair)
            if not len(found.depth):
                continue
            faces1 = self._faces(pair_names[0], found.part1, found.point1)
            faces2 = manager._faces(pair_names[1], found.part2, found.point2)
            for index in range(len(found.depth)):
                faces = int(faces1[index]), int(faces2[index])
                middle = (found.point1[index] + found.point2[index]) / 2
                row = {"normal": found.normal[index], "point": middle, "depth": found.depth[index]}
                data.append(ContactData(pair_names, faces, row))
        return data

    def _nearest(
        self, manager: CollisionManager, rows: tuple[Any, Any] | None, with_data: bool
    ) -> tuple[float, tuple[str, str], DistanceData | None]:
        """The nearest of these pairs of numbers, or of all pairs of this manager and another."""
        names, others = sorted(self._shapes), sorted(manager._shapes)
        one, other = rows or (part.ravel() for part in np.indices((len(names), len(others))))
        if not len(one):
            return float("inf"), ("", ""), None
        (shapes1, poses1), (shapes2, poses2) = self._placed(names), manager._placed(others)
        best, distance = nearest(Picked(shapes1, one), poses1[one], Picked(shapes2, other), poses2[other])
        first, second = int(one[best]), int(other[best])
        pair = names[first], others[second]
        # How deep meshes overlap, a witness alone tells.
        if distance > 0 and not with_data:
            return distance, pair, None
        found = witness(shapes1[first], poses1[first], shapes2[second], poses2[second])
        faces = (
            int(self._faces(pair[0], found.part1, found.point1)),
            int(manager._faces(pair[1], found.part2, found.point2)),
        )
        return float(found.distance), pair, DistanceData(pair, faces, found)


def scene_to_collision(scene: trimesh.Scene) -> tuple[CollisionManager, dict[str, Shape]]:
    """A manager with the meshes of a scene of trimesh, by the names of its nodes, and their shapes."""
    manager = CollisionManager()
    shapes: dict[Any, tuple[Shape, Shape]] = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        if geometry not in shapes:
            mesh = scene.geometry[geometry]
            surface = TriMesh(mesh.vertices, mesh.faces)
            shapes[geometry] = _shape(mesh, surface), surface
        manager._place(node, *shapes[geometry], _matrix(transform))
    return manager, dict(manager._shapes)


def _single(mesh: trimesh.Trimesh, transform: ArrayLike | None) -> CollisionManager:
    """A manager with one mesh."""
    manager = CollisionManager()
    manager.add_object(EXTERNAL, mesh, transform)
    return manager


def _shape(mesh: trimesh.Trimesh, surface: Shape) -> Shape:
    """The solid of a convex mesh, the surface of others: of flat ones too, which are convex and have no volume."""
    if not mesh.is_convex:
        return surface
    try:
        return ConvexHull(mesh.vertices)
    except ValueError:
        return surface


def _matrix(transform: ArrayLike | None) -> NDArray[np.float64]:
    matrix = np.eye(4) if transform is None else np.array(transform, dtype=np.float64)
    if matrix.shape != (4, 4):
        raise ValueError(f"transform has the shape {matrix.shape}, where (4, 4) is needed")
    return matrix


def _answer(found: Any, names: Any, data: Any, with_names: bool, with_data: bool) -> Any:
    """The forms of trimesh's answers: alone, or a tuple with what else was wanted."""
    if with_names and with_data:
        return found, names, data
    if with_names:
        return found, names
    return (found, data) if with_data else found
