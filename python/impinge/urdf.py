"""Robots from URDF files: frames of many configurations at once, self-collisions, and distances to scenes.

Files are read by yourdfpy, meshes by trimesh. Lengths are as in the file (metres), angles in radians.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._native import Shape, distance, proximity
from impinge._results import Proximity
from impinge._shapes import Ball, ConvexHull, Cuboid, Cylinder, TriMesh

if TYPE_CHECKING:
    import yourdfpy  # type: ignore[import-untyped, unused-ignore]

# Turns z into y: URDF lays cylinders along z, impinge along y.
Z_TO_Y = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])

Frames = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """A shape fixed to a link."""

    name: str
    link: int
    shape: Shape
    # Of the shape in the frame of the link.
    pose: Frames


class NearestBodies(NamedTuple):
    """For each configuration the least distance, and the numbers of the two bodies; the second is of the scene, if any."""

    distance: NDArray[np.float64]
    body1: NDArray[np.int64]
    body2: NDArray[np.int64]


@dataclass(frozen=True)
class _Joint:
    """A joint: which link it moves on which, and by which column of the configuration."""

    parent: int
    child: int
    origin: Frames
    axis: NDArray[np.float64]
    kind: str
    column: int
    # The value is that of the column times the first, plus the second.
    factor: tuple[float, float]


class Robot:
    """Links, joints and the bodies of the links.

    `joints` has the names of the columns of a configuration, `limits` (joints, 2) their least and greatest values, infinite
    for joints without. `pairs` (m, 2) are the bodies that must not touch: at first all of two links that share no joint.
    """

    def __init__(self, model: yourdfpy.URDF, meshes: Literal["hull", "surface"] = "hull") -> None:
        robot = model.robot
        self.links = [link.name for link in robot.links]
        moving = [joint for joint in robot.joints if joint.type != "fixed" and joint.mimic is None]
        self.joints = [joint.name for joint in moving]
        self.limits = np.array([_limits(joint) for joint in moving]).reshape(-1, 2)
        numbers = {name: number for number, name in enumerate(self.links)}
        self._joints = _in_order([_joint(joint, numbers, self.joints) for joint in robot.joints])
        self.bodies = [
            body
            for link in robot.links
            for number, collision in enumerate(link.collisions)
            for body in _bodies(model, numbers[link.name], f"{link.name}/{number}", collision, meshes)
        ]
        self.pairs = self._separate_pairs()

    @classmethod
    def load(cls, path: str | Path, meshes: Literal["hull", "surface"] = "hull") -> Robot:
        """The robot of a file. Meshes become their convex hulls, or surfaces of triangles."""
        import yourdfpy

        return cls(yourdfpy.URDF.load(str(path), load_meshes=False, build_scene_graph=False), meshes)

    def frames(self, configurations: ArrayLike) -> Frames:
        """The poses of all links: (n, links, 4, 4) of configurations (n, joints), (links, 4, 4) of one."""
        given = self._checked(configurations)
        rows = np.atleast_2d(given)
        frames = np.tile(np.eye(4), (len(rows), len(self.links), 1, 1))
        for joint in self._joints:
            value = None if joint.column < 0 else joint.factor[0] * rows[:, joint.column] + joint.factor[1]
            moved = joint.origin if value is None else joint.origin @ _motion(joint, value)
            frames[:, joint.child] = frames[:, joint.parent] @ moved
        if given.ndim == 1:
            frames = frames[0]
        return frames

    def poses(self, configurations: ArrayLike) -> Frames:
        """The poses of all bodies: (n, bodies, 4, 4), or (bodies, 4, 4)."""
        frames = self.frames(configurations)
        local = np.array([body.pose for body in self.bodies]).reshape(-1, 4, 4)
        poses: Frames = frames[..., [body.link for body in self.bodies], :, :] @ local
        return poses

    def allow(self, link1: str, link2: str) -> None:
        """Lets two links touch: their bodies are no longer among `pairs`."""
        for name in (link1, link2):
            if name not in self.links:
                raise ValueError(f"{name} is no link")
        both = {self.links.index(link1), self.links.index(link2)}
        self.pairs = self.pairs[[{self.bodies[one].link, self.bodies[two].link} != both for one, two in self.pairs]]

    def allow_touching_at(self, configurations: ArrayLike) -> None:
        """Lets those bodies touch that do in one of these configurations, as setup assistants do."""
        poses = self.poses(np.atleast_2d(self._checked(configurations)))
        touching = [self._touches(pair, poses).any() for pair in self.pairs]
        self.pairs = self.pairs[~np.array(touching, dtype=bool)]

    def self_collides(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """Whether two bodies touch, for each configuration (n, joints)."""
        poses = self.poses(np.atleast_2d(self._checked(configurations)))
        found = np.zeros(len(poses), dtype=bool)
        for pair in self.pairs:
            free = ~found
            found[free] = self._touches(pair, poses[free])
        return found

    def self_distance(self, configurations: ArrayLike) -> NearestBodies:
        """The nearest two bodies for each configuration (n, joints): zero if they touch."""
        poses = self.poses(np.atleast_2d(self._checked(configurations)))

        def between(pair: NDArray[np.int64]) -> Any:
            one, two = (int(body) for body in pair)
            return distance(self.bodies[one].shape, poses[:, one], self.bodies[two].shape, poses[:, two])

        return _least(self.pairs, len(poses), between)

    def collides(self, configurations: ArrayLike, shapes: Sequence[Shape], obstacles: Any) -> NDArray[np.bool_]:
        """Whether a body touches one of the shapes that stand at these poses (m, 4, 4)."""
        poses = self.poses(np.atleast_2d(self._checked(configurations)))
        found = np.zeros(len(poses), dtype=bool)
        for body, obstacle in np.ndindex(len(self.bodies), len(shapes)):
            free = ~found
            there = proximity(
                self.bodies[body].shape, poses[free, body], shapes[obstacle], np.asarray(obstacles)[obstacle]
            )
            found[free] = there == Proximity.INTERSECTING
        return found

    def distance(self, configurations: ArrayLike, shapes: Sequence[Shape], obstacles: Any) -> NearestBodies:
        """The body and the shape that are nearest for each configuration: zero if they touch."""
        poses = self.poses(np.atleast_2d(self._checked(configurations)))

        def between(pair: NDArray[np.int64]) -> Any:
            body, obstacle = (int(number) for number in pair)
            return distance(self.bodies[body].shape, poses[:, body], shapes[obstacle], np.asarray(obstacles)[obstacle])

        pairs = np.array(list(np.ndindex(len(self.bodies), len(shapes))), dtype=np.int64).reshape(-1, 2)
        return _least(pairs, len(poses), between)

    def _touches(self, pair: NDArray[np.int64], poses: Frames) -> NDArray[np.bool_]:
        one, two = (int(body) for body in pair)
        found = proximity(self.bodies[one].shape, poses[:, one], self.bodies[two].shape, poses[:, two])
        return np.asarray(found == Proximity.INTERSECTING)

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
        """The pairs of bodies of links that are neither one nor joined."""
        joined = {frozenset((joint.parent, joint.child)) for joint in self._joints}

        def is_separate(one: Body, two: Body) -> bool:
            return one.link != two.link and frozenset((one.link, two.link)) not in joined

        pairs = [
            (one, two)
            for one in range(len(self.bodies))
            for two in range(one + 1, len(self.bodies))
            if is_separate(self.bodies[one], self.bodies[two])
        ]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)


def _least(pairs: NDArray[np.int64], count: int, between: Callable[[NDArray[np.int64]], Any]) -> NearestBodies:
    """The pair with the least distance of each of so many configurations; -1 without pairs."""
    best = NearestBodies(np.full(count, np.inf), np.full(count, -1), np.full(count, -1))
    for pair in pairs:
        apart = np.asarray(between(pair))
        nearer = apart < best.distance
        best.distance[nearer] = apart[nearer]
        best.body1[nearer], best.body2[nearer] = pair
    return best


def _limits(joint: Any) -> tuple[float, float]:
    if joint.type == "continuous" or joint.limit is None:
        return -math.inf, math.inf
    lower, upper = joint.limit.lower, joint.limit.upper
    return (-math.inf if lower is None else lower), (math.inf if upper is None else upper)


def _joint(joint: Any, links: dict[str, int], columns: list[str]) -> _Joint:
    if joint.type not in ("fixed", "revolute", "continuous", "prismatic"):
        raise ValueError(
            f"joint {joint.name} is {joint.type}: fixed, revolute, continuous and prismatic joints are known"
        )
    origin = np.eye(4) if joint.origin is None else np.asarray(joint.origin, dtype=np.float64)
    axis = np.array([1.0, 0, 0]) if joint.axis is None else np.asarray(joint.axis, dtype=np.float64)
    length = np.linalg.norm(axis)
    if joint.type != "fixed" and not (np.isfinite(length) and length > 0):
        raise ValueError(f"joint {joint.name} has the axis {axis.tolist()}")
    factor, driver = (1.0, 0.0), joint.name
    if joint.mimic is not None:
        driver = joint.mimic.joint
        multiplier, offset = joint.mimic.multiplier, joint.mimic.offset
        factor = (1.0 if multiplier is None else multiplier, 0.0 if offset is None else offset)
    column = -1 if joint.type == "fixed" else columns.index(driver)
    unit = axis / length if length > 0 else axis
    return _Joint(links[joint.parent], links[joint.child], origin, unit, joint.type, column, factor)


def _in_order(joints: list[_Joint]) -> list[_Joint]:
    """Parents before children."""
    children = {joint.child for joint in joints}
    known = {joint.parent for joint in joints} - children
    ordered: list[_Joint] = []
    while len(ordered) < len(joints):
        ready = [joint for joint in joints if joint.parent in known and joint.child not in known]
        if not ready:
            raise ValueError("the joints have a loop")
        ordered += ready
        known |= {joint.child for joint in ready}
    return ordered


def _motion(joint: _Joint, value: NDArray[np.float64]) -> Frames:
    """The motions (n, 4, 4) of a joint by these values."""
    motion = np.tile(np.eye(4), (len(value), 1, 1))
    if joint.kind == "prismatic":
        motion[:, :3, 3] = value[:, None] * joint.axis
        return motion
    x, y, z = joint.axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, cosine = np.sin(value)[:, None, None], np.cos(value)[:, None, None]
    motion[:, :3, :3] = np.eye(3) + sine * cross + (1 - cosine) * (cross @ cross)
    return motion


def _bodies(model: yourdfpy.URDF, link: int, name: str, collision: Any, meshes: str) -> list[Body]:
    """The bodies of a collision element: one, or one for each part of a mesh file."""
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
