"""The collision manager of trimesh on impinge: the same interface, without FCL.

    from impinge.trimesh import CollisionManager, scene_to_collision

Convex meshes (`mesh.is_convex`) are solids and other meshes are surfaces, as in trimesh: a mesh inside a surface collides with
it only if the two touch. With `solid=True` all meshes are solids, and must be closed. The distance of overlapping meshes is
minus their depth; for surfaces, minus the depth of the two triangles that overlap most. If several pairs overlap, one of them
is returned.

A manager caches its results: the cost of a query depends on the changes since the last query, not on the number of meshes.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal, TypeAlias, TypeVar, overload

from numpy.typing import ArrayLike

from impinge._native import Manager, Shape
from impinge._trimesh_parts import (
    ContactData,
    DistanceData,
    Geometry,
    Placed,
    contacts,
    matrix_of,
    measured,
    rotation_and_stretch,
)

if TYPE_CHECKING:
    import trimesh

__all__ = ["CollisionManager", "ContactData", "DistanceData", "scene_to_collision"]

# The name that trimesh uses for the mesh of a query.
EXTERNAL = "__external"

Contacts: TypeAlias = list[ContactData]
Pairs: TypeAlias = set[tuple[str, str]]
Nearest: TypeAlias = tuple[str, str]
No: TypeAlias = Literal[False]
Yes: TypeAlias = Literal[True]

Found = TypeVar("Found")
Names = TypeVar("Names")
Data = TypeVar("Data")
# A result alone, or a tuple with the requested extras. Overloads narrow it if the flags are literals.
Answer: TypeAlias = Found | tuple[Found, Names] | tuple[Found, Data] | tuple[Found, Names, Data]


class CollisionManager:
    """Meshes by name, each with a transform, and queries of their contacts and distances.

    solid: a mesh collides with meshes inside it, even if no faces touch. ValueError for a mesh that is not closed.

    >>> import trimesh
    >>> manager = CollisionManager()
    >>> shape = manager.add_object("box", trimesh.creation.box())
    >>> away = trimesh.transformations.translation_matrix([3, 0, 0])
    >>> manager.in_collision_single(trimesh.creation.box(), away)
    False
    >>> round(manager.min_distance_single(trimesh.creation.box(), away), 9)
    2.0
    """

    def __init__(self, solid: bool = False) -> None:
        self._engine = Manager()
        self._solid = solid
        # The index of each name in the engine, which stores the transforms; the name and the mesh of each index.
        self._indices: dict[str, int] = {}
        self._meshes: dict[int, tuple[str, Geometry]] = {}

    def add_object(self, name: str, mesh: trimesh.Trimesh, transform: ArrayLike | None = None) -> Shape:
        """Adds a mesh, or replaces the mesh of this name. ValueError for a transform that is not a rotation and translation,
        and, if meshes are solid, for a mesh that is not closed or is inside out."""
        return self._add(Placed(name, self._geometry(mesh, name), matrix_of(transform)))

    def remove_object(self, name: str) -> None:
        """Removes a mesh."""
        index = self._known(name)
        self._engine.remove(index)
        del self._indices[name], self._meshes[index]

    def set_transform(self, name: str, transform: ArrayLike) -> None:
        """Moves a mesh. ValueError for a transform that is not a rotation and translation."""
        index = self._indices.get(name)
        if index is None:
            index = self._known(name)
        try:
            self._engine.place(index, transform)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None

    @overload
    def in_collision_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., return_names: No = ..., return_data: No = ...
    ) -> bool: ...
    @overload
    def in_collision_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., *, return_names: Yes, return_data: No = ...
    ) -> tuple[bool, set[str]]: ...
    @overload
    def in_collision_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., return_names: No = ..., *, return_data: Yes
    ) -> tuple[bool, Contacts]: ...
    @overload
    def in_collision_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., *, return_names: Yes, return_data: Yes
    ) -> tuple[bool, set[str], Contacts]: ...
    @overload
    def in_collision_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., return_names: bool = ..., return_data: bool = ...
    ) -> Answer[bool, set[str], Contacts]: ...
    def in_collision_single(
        self,
        mesh: trimesh.Trimesh,
        transform: ArrayLike | None = None,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Answer[bool, set[str], Contacts]:
        """Whether a mesh touches a mesh of the manager: `bool`, and optionally the names and the contacts."""
        external = Placed(EXTERNAL, self._geometry(mesh, EXTERNAL), matrix_of(transform))
        shape = external.geometry.shape
        if not (return_names or return_data):
            return self._engine.meets_any(shape, external.transform)
        met = self._engine.met_by(shape, external.transform)
        data = contacts([(own, external) for own in self._placed(met)]) if return_data else []
        return _answer(bool(met), {self._meshes[index][0] for index in met}, data, return_names, return_data)

    @overload
    def in_collision_internal(self, return_names: No = ..., return_data: No = ...) -> bool: ...
    @overload
    def in_collision_internal(self, return_names: Yes, return_data: No = ...) -> tuple[bool, Pairs]: ...
    @overload
    def in_collision_internal(self, return_names: No = ..., *, return_data: Yes) -> tuple[bool, Contacts]: ...
    @overload
    def in_collision_internal(self, return_names: Yes, return_data: Yes) -> tuple[bool, Pairs, Contacts]: ...
    @overload
    def in_collision_internal(
        self, return_names: bool = ..., return_data: bool = ...
    ) -> Answer[bool, Pairs, Contacts]: ...
    def in_collision_internal(
        self, return_names: bool = False, return_data: bool = False
    ) -> Answer[bool, Pairs, Contacts]:
        """Whether any two meshes touch; the names are pairs in ascending order."""
        if not (return_names or return_data):
            return self._engine.is_touching()
        rows, meshes = self._engine.touching(), self._meshes
        names = {_ordered(meshes[one][0], meshes[other][0]) for one, other in rows}
        data = contacts([_by_name(pair) for pair in self._pairs(rows, self)]) if return_data else []
        return _answer(bool(rows), names, data, return_names, return_data)

    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: No = ..., return_data: No = ...
    ) -> bool: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: Yes, return_data: No = ...
    ) -> tuple[bool, Pairs]: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: No = ..., *, return_data: Yes
    ) -> tuple[bool, Contacts]: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: Yes, return_data: Yes
    ) -> tuple[bool, Pairs, Contacts]: ...
    @overload
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = ..., return_data: bool = ...
    ) -> Answer[bool, Pairs, Contacts]: ...
    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Answer[bool, Pairs, Contacts]:
        """Whether a mesh touches a mesh of another manager; the names are pairs, the name in this manager first."""
        other = self._beside(other_manager)
        if not (return_names or return_data):
            return self._engine.is_touching_other(other._engine)
        rows = self._engine.touching_other(other._engine)
        names = {(self._meshes[one][0], other._meshes[index][0]) for one, index in rows}
        data = contacts(self._pairs(rows, other)) if return_data else []
        return _answer(bool(rows), names, data, return_names, return_data)

    @overload
    def min_distance_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., return_name: No = ..., return_data: No = ...
    ) -> float: ...
    @overload
    def min_distance_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., *, return_name: Yes, return_data: No = ...
    ) -> tuple[float, str]: ...
    @overload
    def min_distance_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., return_name: No = ..., *, return_data: Yes
    ) -> tuple[float, DistanceData | None]: ...
    @overload
    def min_distance_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., *, return_name: Yes, return_data: Yes
    ) -> tuple[float, str, DistanceData | None]: ...
    @overload
    def min_distance_single(
        self, mesh: trimesh.Trimesh, transform: ArrayLike | None = ..., return_name: bool = ..., return_data: bool = ...
    ) -> Answer[float, str, DistanceData | None]: ...
    def min_distance_single(
        self,
        mesh: trimesh.Trimesh,
        transform: ArrayLike | None = None,
        return_name: bool = False,
        return_data: bool = False,
    ) -> Answer[float, str, DistanceData | None]:
        """The distance of a mesh from the nearest mesh of the manager."""
        external = Placed(EXTERNAL, self._geometry(mesh, EXTERNAL), matrix_of(transform))
        found = self._engine.nearest_to(external.geometry.shape, external.transform)
        if found is None:
            return _answer(float("inf"), "", None, return_name, return_data)
        index, distance = found
        data = measured(self._placed([index])[0], external) if return_data else None
        distance = distance if data is None else data.distance
        return _answer(distance, self._meshes[index][0], data, return_name, return_data)

    @overload
    def min_distance_internal(
        self, name: str | None = ..., return_names: No = ..., return_data: No = ...
    ) -> float: ...
    @overload
    def min_distance_internal(
        self, name: str | None = ..., *, return_names: Yes, return_data: No = ...
    ) -> tuple[float, Nearest]: ...
    @overload
    def min_distance_internal(
        self, name: str | None = ..., return_names: No = ..., *, return_data: Yes
    ) -> tuple[float, DistanceData | None]: ...
    @overload
    def min_distance_internal(
        self, name: str | None = ..., *, return_names: Yes, return_data: Yes
    ) -> tuple[float, Nearest, DistanceData | None]: ...
    @overload
    def min_distance_internal(
        self, name: str | None = ..., return_names: bool = ..., return_data: bool = ...
    ) -> Answer[float, Nearest, DistanceData | None]: ...
    def min_distance_internal(
        self, name: str | None = None, return_names: bool = False, return_data: bool = False
    ) -> Answer[float, Nearest, DistanceData | None]:
        """The distance of the two nearest meshes; with a name, of this mesh and the mesh nearest to it."""
        engine = self._engine
        found = engine.nearest() if name is None else engine.nearest_beside(self._known(name))
        if found is None:
            return _answer(float("inf"), ("", ""), None, return_names, return_data)
        one, other, distance = found
        names = _ordered(self._meshes[one][0], self._meshes[other][0])
        data = measured(*_by_name(self._pairs([(one, other)], self)[0])) if return_data else None
        return _answer(distance if data is None else data.distance, names, data, return_names, return_data)

    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: No = ..., return_data: No = ...
    ) -> float: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: Yes, return_data: No = ...
    ) -> tuple[float, Nearest]: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: No = ..., *, return_data: Yes
    ) -> tuple[float, DistanceData | None]: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: Yes, return_data: Yes
    ) -> tuple[float, Nearest, DistanceData | None]: ...
    @overload
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = ..., return_data: bool = ...
    ) -> Answer[float, Nearest, DistanceData | None]: ...
    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Answer[float, Nearest, DistanceData | None]:
        """The distance of the two nearest meshes of two managers; the name in this manager comes first."""
        manager = self._beside(other_manager)
        found = self._engine.nearest_other(manager._engine)
        if found is None:
            return _answer(float("inf"), ("", ""), None, return_names, return_data)
        one, other, distance = found
        names = self._meshes[one][0], manager._meshes[other][0]
        data = measured(*self._pairs([(one, other)], manager)[0]) if return_data else None
        return _answer(distance if data is None else data.distance, names, data, return_names, return_data)

    def _geometry(self, mesh: trimesh.Trimesh, name: str) -> Geometry:
        try:
            return Geometry.of(mesh, self._solid)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None

    def _add(self, placed: Placed) -> Shape:
        try:
            index = self._engine.add(placed.geometry.shape, placed.transform)
        except ValueError as error:
            raise ValueError(f"{placed.name}: {error}") from None
        if placed.name in self._indices:
            self.remove_object(placed.name)
        self._indices[placed.name], self._meshes[index] = index, (placed.name, placed.geometry)
        return placed.geometry.shape

    def _known(self, name: str) -> int:
        if name not in self._indices:
            raise ValueError(f"{name} is not in the manager")
        return self._indices[name]

    def _placed(self, indices: list[int]) -> list[Placed]:
        """Returns meshes with their transforms."""
        transforms = self._engine.transforms(indices)
        return [Placed(*self._meshes[index], matrix) for index, matrix in zip(indices, transforms, strict=True)]

    def _pairs(self, rows: list[tuple[int, int]], other: CollisionManager) -> list[tuple[Placed, Placed]]:
        """Returns the pairs of `rows`, each a mesh of this manager and a mesh of `other`."""
        ones, others = self._placed([one for one, _ in rows]), other._placed([index for _, index in rows])
        return list(zip(ones, others, strict=True))

    def _beside(self, other: CollisionManager) -> CollisionManager:
        """Returns the other manager, or a copy of this manager if both are the same."""
        return other if other is not self else _manager(self._placed(list(self._meshes)), self._solid)


def scene_to_collision(scene: trimesh.Scene, solid: bool = False) -> tuple[CollisionManager, dict[str, Shape]]:
    """Returns a manager with the meshes of a scene of trimesh, by the names of their nodes, and their shapes; `solid` as in
    `CollisionManager`.

    Scale, shear and reflection of a node are applied to the vertices of its shape; `set_transform` then moves this shape
    by a rotation and a translation. ValueError names a node whose transform is singular or not affine.
    """
    placed, known = [], {}
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        try:
            rigid, stretch = rotation_and_stretch(matrix_of(transform))
        except ValueError as error:
            raise ValueError(f"the node {node!r}: {error}") from None
        key = name, None if stretch is None else stretch.tobytes()
        if key not in known:
            try:
                geometry = Geometry.of(scene.geometry[name], solid)
                known[key] = geometry if stretch is None else geometry.stretched(stretch)
            except ValueError as error:
                raise ValueError(f"the node {node!r}: {error}") from None
        placed.append(Placed(node, known[key], rigid))
    return _manager(placed, solid), {one.name: one.geometry.shape for one in placed}


def _manager(placed: Iterable[Placed], solid: bool) -> CollisionManager:
    manager = CollisionManager(solid)
    for one in placed:
        manager._add(one)
    return manager


def _ordered(one: str, other: str) -> tuple[str, str]:
    return (one, other) if one <= other else (other, one)


def _by_name(pair: tuple[Placed, Placed]) -> tuple[Placed, Placed]:
    one, other = pair
    return pair if one.name <= other.name else (other, one)


def _answer(
    found: Found, names: Names, data: Data, with_names: bool, with_data: bool
) -> Answer[Found, Names, Data]:
    """Returns a result in the form of trimesh: alone, or a tuple with the requested extras."""
    if with_names and with_data:
        return found, names, data
    if with_names:
        return found, names
    return (found, data) if with_data else found
