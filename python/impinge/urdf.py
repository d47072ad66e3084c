"""Robots from URDF files: frames of many configurations at once, self-collisions, and distances to scenes.

Files are read by yourdfpy, meshes by trimesh. Lengths are as in the file (metres), angles in radians.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._checker import Checker, Frame
from impinge._native import Shape
from impinge._shapes import Ball, ConvexHull, Cuboid, Cylinder, TriMesh

if TYPE_CHECKING:
    import yourdfpy  # type: ignore[import-untyped, unused-ignore]

    from impinge._native import PosesLike

# Rotates the z axis, along which cylinders of URDF lie, to the y axis, along which cylinders of impinge lie.
Z_TO_Y = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])

Frames = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """A shape fixed to a link."""

    name: str
    link: int
    shape: Shape
    # The pose of the shape in the frame of the link.
    pose: Frames


class NearestBodies(NamedTuple):
    """The smallest distance in each configuration, and the indices of the nearest two: two bodies, or a body and a shape of
    the scene."""

    distance: NDArray[np.float64]
    body1: NDArray[np.int64]
    body2: NDArray[np.int64]


class _Kept(NamedTuple):
    """A checker, and the pairs and bodies of the robot for which it was created."""

    pairs: NDArray[np.int64]
    bodies: list[Body]
    checker: Checker

    def is_of(self, robot: Robot) -> bool:
        """Returns whether the robot has these pairs and these very bodies."""
        is_same_length = len(self.bodies) == len(robot.bodies)
        are_same = is_same_length and all(map(operator.is_, self.bodies, robot.bodies))
        return are_same and np.array_equal(self.pairs, robot.pairs)


class Robot:
    """The links and joints of a robot, and the bodies that are fixed to the links.

    `joints` are the names of the columns of a configuration, `limits` (joints, 2) their minima and maxima, infinite
    for joints without limits. `pairs` (m, 2) are the bodies that must not touch: initially all pairs of bodies of
    different links without a common joint. `bodies` is a list whose elements may be replaced; a body that is appended is in
    no pair until `pairs` has one.
    """

    def __init__(self, model: yourdfpy.URDF, meshes: Literal["hull", "surface"] = "hull") -> None:
        robot = model.robot
        self.links: list[str] = [link.name for link in robot.links]
        moving = [joint for joint in robot.joints if joint.type != "fixed" and joint.mimic is None]
        self.joints: list[str] = [joint.name for joint in moving]
        self.limits: NDArray[np.float64] = np.array([_limits(joint) for joint in moving]).reshape(-1, 2)
        numbers = {name: number for number, name in enumerate(self.links)}
        self._frames = [Frame()] * len(self.links)
        for joint in robot.joints:
            self._frames[numbers[joint.child]] = _frame(joint, numbers, self.joints)
        self.bodies: list[Body] = [
            body
            for link in robot.links
            for number, collision in enumerate(link.collisions)
            for body in _bodies(model, numbers[link.name], f"{link.name}/{number}", collision, meshes)
        ]
        self.pairs = self._separate_pairs()
        # The checker of `pairs`, kept between calls because it caches convex hulls of meshes.
        self._kept: _Kept | None = None

    @classmethod
    def load(cls, path: str | Path, meshes: Literal["hull", "surface"] = "hull") -> Robot:
        """Reads a robot from a file. Meshes become their convex hulls, or surfaces of triangles."""
        import yourdfpy

        return cls(yourdfpy.URDF.load(str(path), load_meshes=False, build_scene_graph=False), meshes)

    def frames(self, configurations: ArrayLike) -> Frames:
        """The poses of all links: (n, links, 4, 4) for configurations (n, joints), (links, 4, 4) for a single
        configuration."""
        return np.asarray(self._own().frames(self._checked(configurations)), np.float64)

    def poses(self, configurations: ArrayLike) -> Frames:
        """The poses of all bodies: (n, bodies, 4, 4) for configurations (n, joints), (bodies, 4, 4) for a single
        configuration."""
        return np.asarray(self._own().poses(self._checked(configurations)), np.float64)

    def checker(self, pairs: ArrayLike | None = None) -> Checker:
        """Returns a checker of the robot without obstacles; `pairs` are the bodies that must not touch, by default
        `self.pairs`."""
        shapes, on = [body.shape for body in self.bodies], [body.link for body in self.bodies]
        local = np.array([body.pose for body in self.bodies]).reshape(-1, 4, 4)
        wanted = self.pairs if pairs is None else pairs
        return Checker(self._frames, len(self.joints), shapes, on, local, wanted)

    def allow(self, link1: str, link2: str) -> None:
        """Lets two links touch: removes the pairs of their bodies from `pairs`."""
        for name in (link1, link2):
            if name not in self.links:
                raise ValueError(f"{name} is no link")
        both = {self.links.index(link1), self.links.index(link2)}
        self.pairs = self.pairs[[{self.bodies[one].link, self.bodies[two].link} != both for one, two in self.pairs]]

    def allow_touching_at(self, configurations: ArrayLike) -> None:
        """Removes the pairs of bodies that touch in one of these configurations from `pairs`, as setup assistants do."""
        rows = np.atleast_2d(self._checked(configurations))
        touching = [not self.checker([pair]).is_free(rows).all() for pair in self.pairs]
        self.pairs = self.pairs[~np.array(touching, dtype=bool)]

    def self_collides(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """Whether any of `pairs` touches, for each configuration (n, joints)."""
        return ~self._own().is_free(np.atleast_2d(self._checked(configurations)))

    def self_distance(self, configurations: ArrayLike) -> NearestBodies:
        """The nearest of `pairs` for each configuration (n, joints): distance zero if the pair touches; infinite, and bodies
        -1, if there are no pairs."""
        return self._nearest(self._own(), configurations, 0)

    def collides(self, configurations: ArrayLike, shapes: Sequence[Shape], obstacles: PosesLike) -> NDArray[np.bool_]:
        """Whether a body touches one of the shapes at the poses `obstacles` (m, 4, 4), for each configuration."""
        return ~self._among(shapes, obstacles).is_free(np.atleast_2d(self._checked(configurations)))

    def distance(self, configurations: ArrayLike, shapes: Sequence[Shape], obstacles: PosesLike) -> NearestBodies:
        """The nearest pair of a body and a shape for each configuration: distance zero if they touch."""
        return self._nearest(self._among(shapes, obstacles), configurations, len(self.bodies))

    def _own(self) -> Checker:
        """Returns the cached checker of `pairs`, without obstacles. It is created again if pairs or bodies have changed."""
        kept = self._kept
        if kept is None or not kept.is_of(self):
            kept = self._kept = _Kept(np.array(self.pairs), list(self.bodies), self.checker())
        return kept.checker

    def _among(self, shapes: Sequence[Shape], obstacles: PosesLike) -> Checker:
        """Returns a checker with obstacles, and without pairs of bodies."""
        checker = self.checker([])
        checker.set_obstacles(shapes, obstacles)
        return checker

    def _nearest(self, checker: Checker, configurations: ArrayLike, first: int) -> NearestBodies:
        """Returns the nearest bodies; `first`, the index of the first obstacle, is subtracted from the second indices."""
        distance, pair = checker.nearest(np.atleast_2d(self._checked(configurations)))
        body1, body2 = pair.astype(np.int64).T
        is_none = np.isinf(distance)
        numbers = np.where(is_none, -1, body1), np.where(is_none, -1, body2 - first)
        return NearestBodies(np.asarray(distance, np.float64), *numbers)

    def _checked(self, configurations: ArrayLike) -> NDArray[np.float64]:
        array = np.asarray(configurations, dtype=np.float64)
        if array.ndim not in (1, 2) or array.shape[-1] != len(self.joints):
            need = f"({len(self.joints)},) or (n, {len(self.joints)})"
            raise ValueError(f"configurations has the shape {array.shape}, where {need} is needed")
        if not np.isfinite(array).all():
            row, joint = np.argwhere(~np.isfinite(np.atleast_2d(array)))[0]
            value = np.atleast_2d(array)[row, joint]
            raise ValueError(f"configurations[{row}]: {self.joints[joint]} is {value}")
        return array

    def _separate_pairs(self) -> NDArray[np.int64]:
        """Returns the pairs of bodies of different links without a common joint."""
        joined = {frozenset((frame.parent, child)) for child, frame in enumerate(self._frames)}

        def is_separate(one: Body, two: Body) -> bool:
            return one.link != two.link and frozenset((one.link, two.link)) not in joined

        pairs = [
            (one, two)
            for one in range(len(self.bodies))
            for two in range(one + 1, len(self.bodies))
            if is_separate(self.bodies[one], self.bodies[two])
        ]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)


def _limits(joint: Any) -> tuple[float, float]:
    if joint.type == "continuous" or joint.limit is None:
        return -math.inf, math.inf
    lower, upper = joint.limit.lower, joint.limit.upper
    return (-math.inf if lower is None else lower), (math.inf if upper is None else upper)


def _frame(joint: Any, links: dict[str, int], columns: list[str]) -> Frame:
    """Returns the frame of the child of a joint."""
    if joint.type not in ("fixed", "revolute", "continuous", "prismatic"):
        raise ValueError(
            f"joint {joint.name} is {joint.type}: fixed, revolute, continuous and prismatic joints are known"
        )
    parent, origin = links[joint.parent], joint.origin
    if joint.type == "fixed":
        return Frame(parent, origin)
    axis = np.array([1.0, 0, 0]) if joint.axis is None else np.asarray(joint.axis, dtype=np.float64)
    if not (np.isfinite(axis).all() and axis.any()):
        raise ValueError(f"joint {joint.name} has the axis {axis.tolist()}")
    kind: Literal["revolute", "prismatic"] = "prismatic" if joint.type == "prismatic" else "revolute"
    if joint.mimic is None:
        return Frame(parent, origin, kind, axis, columns.index(joint.name))
    if joint.mimic.joint not in columns:
        known = f"the moving joints without a mimic are {columns}"
        raise ValueError(f"joint {joint.name} mimics {joint.mimic.joint}, which is none of them: {known}")
    multiplier = 1.0 if joint.mimic.multiplier is None else joint.mimic.multiplier
    offset = 0.0 if joint.mimic.offset is None else joint.mimic.offset
    return Frame(parent, origin, kind, axis, columns.index(joint.mimic.joint), multiplier, offset)


def _bodies(model: yourdfpy.URDF, link: int, name: str, collision: Any, meshes: str) -> list[Body]:
    """Returns the body of a collision element, in a list."""
    origin = np.eye(4) if collision.origin is None else np.asarray(collision.origin, dtype=np.float64)
    geometry = collision.geometry
    if geometry.box is not None:
        return [Body(name, link, Cuboid(np.asarray(geometry.box.size) / 2), origin)]
    if geometry.sphere is not None:
        return [Body(name, link, Ball(geometry.sphere.radius), origin)]
    if geometry.cylinder is not None:
        shape = Cylinder(geometry.cylinder.length / 2, geometry.cylinder.radius)
        return [Body(name, link, shape, origin @ Z_TO_Y.T)]
    if geometry.mesh is None:
        raise ValueError(f"{name} has no shape that is known")
    return [Body(name, link, _mesh(model, geometry.mesh, meshes), origin)]


def _mesh(model: yourdfpy.URDF, mesh: Any, meshes: str) -> Shape:
    import trimesh

    path = model._filename_handler(fname=mesh.filename)
    loaded: Any = trimesh.load(path, force="mesh")
    scale = np.ones(3) if mesh.scale is None else np.asarray(mesh.scale, dtype=np.float64)
    vertices = np.asarray(loaded.vertices) * scale
    return ConvexHull(vertices) if meshes == "hull" else TriMesh(vertices, loaded.faces)
