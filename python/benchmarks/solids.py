"""The solids of the benchmarks: for each library, and as support functions in NumPy that are independent of any
library.

All are in the frame of impinge, in which capsules, cylinders and cones lie along y; in Coal and FCL they lie along z.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import coal
import fcl
import impinge
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

Array = NDArray[np.float64]

# From the frame of Coal and FCL to that of impinge: z becomes y.
Z_TO_Y = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


@dataclass(frozen=True)
class Solid:
    """One solid: its shape in each library, and its functions for `certify`."""

    name: str
    impinge: Any
    coal: Any
    fcl: Any
    # The rotation from the frame of Coal and FCL to that of impinge.
    turn: Array
    # The farthest points (..., 3) of the solid along directions (..., 3).
    support: Callable[[Array], Array]
    # A lower bound of the distance of points (..., 3) outside the solid; zero inside.
    excess: Callable[[Array], Array]
    # The radius of a ball around the origin that contains the solid; for a half-space a scale for placements.
    radius: float
    is_half_space: bool = False

    @property
    def is_hull(self) -> bool:
        return self.name.startswith("hull")


def solids(quick: bool = False) -> list[Solid]:
    """All solids that the libraries have in common."""
    rng = np.random.default_rng(7)
    triangle = np.array([[-0.5, 0, -0.5], [0.5, 0, -0.5], [0, 0, 0.5]])
    made = [_sphere(0.5), _box(np.array([0.5, 0.25, 0.75])), _hull("hull12", _on_ball(rng, 12))]
    if quick:
        return made
    return [
        *made[:2],
        _capsule(0.5, 0.25),
        _cylinder(0.5, 0.5),
        _cone(0.5, 0.5),
        _ellipsoid(np.array([0.5, 0.25, 0.75])),
        _half_space(),
        made[2],
        _hull("hull64", _on_ball(rng, 64)),
        _flat("triangle", triangle),
    ]


def _on_ball(rng: np.random.Generator, count: int) -> Array:
    points = rng.normal(size=(count, 3))
    return np.asarray(0.5 * points / np.linalg.norm(points, axis=1)[:, None])


def _unit(vectors: Array) -> Array:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0, length, 1.0))


def _sphere(radius: float) -> Solid:
    return Solid(
        "sphere",
        impinge.Ball(radius),
        coal.Sphere(radius),
        fcl.Sphere(radius),
        np.eye(3),
        lambda n: radius * _unit(n),
        lambda p: np.maximum(np.linalg.norm(p, axis=-1) - radius, 0),
        radius,
    )


def _box(half: Array) -> Solid:
    return Solid(
        "box",
        impinge.Cuboid(half),
        coal.Box(*(2 * half)),
        fcl.Box(*(2 * half)),
        np.eye(3),
        lambda n: np.where(n >= 0, half, -half),
        lambda p: np.linalg.norm(np.maximum(np.abs(p) - half, 0), axis=-1),
        float(np.linalg.norm(half)),
    )


def _capsule(half_height: float, radius: float) -> Solid:
    def support(n: Array) -> Array:
        points = radius * _unit(n)
        points[..., 1] += np.where(n[..., 1] >= 0, half_height, -half_height)
        return points

    def excess(p: Array) -> Array:
        from_axis = p.copy()
        from_axis[..., 1] -= np.clip(p[..., 1], -half_height, half_height)
        return np.maximum(np.linalg.norm(from_axis, axis=-1) - radius, 0)

    shapes = (coal.Capsule(radius, 2 * half_height), fcl.Capsule(radius, 2 * half_height))
    return Solid(
        "capsule", impinge.Capsule(half_height, radius), *shapes, Z_TO_Y, support, excess, half_height + radius
    )


def _rim(n: Array, radius: float) -> Array:
    """The farthest points, along directions, of a circle around the y axis."""
    flat = n.copy()
    flat[..., 1] = 0
    return radius * _unit(flat)


def _cylinder(half_height: float, radius: float) -> Solid:
    def support(n: Array) -> Array:
        points = _rim(n, radius)
        points[..., 1] = np.where(n[..., 1] >= 0, half_height, -half_height)
        return points

    def excess(p: Array) -> Array:
        beyond = np.maximum(np.abs(p[..., 1]) - half_height, 0)
        aside = np.maximum(np.hypot(p[..., 0], p[..., 2]) - radius, 0)
        return np.hypot(beyond, aside)

    shapes = (coal.Cylinder(radius, 2 * half_height), fcl.Cylinder(radius, 2 * half_height))
    size = float(np.hypot(half_height, radius))
    return Solid("cylinder", impinge.Cylinder(half_height, radius), *shapes, Z_TO_Y, support, excess, size)


def _cone(half_height: float, radius: float) -> Solid:
    apex = np.array([0, half_height, 0])

    def support(n: Array) -> Array:
        base = _rim(n, radius)
        base[..., 1] = -half_height
        is_apex = (n * apex).sum(-1) >= (n * base).sum(-1)
        return np.where(is_apex[..., None], apex, base)

    def excess(p: Array) -> Array:
        # The distances below the base and outside the mantle, in the half-plane of the axis and the point.
        aside, along = np.hypot(p[..., 0], p[..., 2]), p[..., 1]
        slant = np.hypot(2 * half_height, radius)
        mantle = (aside * 2 * half_height + (along - half_height) * radius) / slant
        below = -half_height - along
        return np.maximum(np.maximum(mantle, below), 0)

    shapes = (coal.Cone(radius, 2 * half_height), fcl.Cone(radius, 2 * half_height))
    size = float(np.hypot(half_height, radius))
    return Solid("cone", impinge.Cone(half_height, radius), *shapes, Z_TO_Y, support, excess, size)


def _ellipsoid(half: Array) -> Solid:
    def support(n: Array) -> Array:
        return half * _unit(half * n)

    def excess(p: Array) -> Array:
        return np.maximum(np.linalg.norm(p / half, axis=-1) - 1, 0) * half.min()

    shapes = (coal.Ellipsoid(*half), fcl.Ellipsoid(*half))
    return Solid("ellipsoid", impinge.Ellipsoid(half), *shapes, np.eye(3), support, excess, float(half.max()))


def _half_space() -> Solid:
    up = np.array([0.0, 0, 1])
    return Solid(
        "half-space",
        impinge.HalfSpace([0, 1, 0]),
        coal.Halfspace(up, 0.0),
        fcl.Halfspace(up, 0.0),
        Z_TO_Y,
        # Right only along the normal of the half-space; `certify` uses no other direction.
        np.zeros_like,
        lambda p: np.maximum(p[..., 1], 0),
        0.5,
        is_half_space=True,
    )


def of_points(points: Array) -> Callable[[Array], Array]:
    def support(n: Array) -> Array:
        return np.asarray(points[(n @ points.T).argmax(axis=-1)])

    return support


def _hull(name: str, points: Array) -> Solid:
    found = ConvexHull(points)
    faces = [_outward(points, face, plane) for face, plane in zip(found.simplices, found.equations, strict=True)]

    def excess(p: Array) -> Array:
        return np.maximum((p @ found.equations[:, :3].T + found.equations[:, 3]).max(axis=-1), 0)

    shapes = (coal_convex(points, faces), _fcl_convex(points, faces))
    size = float(np.linalg.norm(points, axis=1).max())
    return Solid(name, impinge.ConvexHull(points), *shapes, np.eye(3), of_points(points), excess, size)


def _outward(points: Array, face: Any, plane: Array) -> list[int]:
    one, two, three = (int(corner) for corner in face)
    turn = np.cross(points[two] - points[one], points[three] - points[one])
    return [one, two, three] if turn @ plane[:3] > 0 else [one, three, two]


def corners_alone(name: str, points: Array) -> Solid:
    """The hull of points for `certify`, without shapes of the libraries."""
    size = float(np.linalg.norm(points, axis=1).max())
    return Solid(name, None, None, None, np.eye(3), of_points(points), lambda p: np.zeros(p.shape[:-1]), size)


def _flat(name: str, corners: Array) -> Solid:
    """A triangle. For Coal and FCL, whose triangles return no results, it is a convex of three points with a face on
    each side."""
    normal = _unit(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
    sides = [np.cross(corners[(i + 1) % 3] - corners[i], normal) for i in range(3)]
    planes = [(_unit(side), float(_unit(side) @ corners[i])) for i, side in enumerate(sides)]
    planes += [(normal, float(normal @ corners[0])), (-normal, -float(normal @ corners[0]))]

    def excess(p: Array) -> Array:
        return np.maximum(np.max([p @ n - offset for n, offset in planes], axis=0), 0)

    faces = [[0, 1, 2], [0, 2, 1]]
    shapes = (coal_convex(corners, faces), _fcl_convex(corners, faces))
    size = float(np.linalg.norm(corners, axis=1).max())
    return Solid(name, impinge.Triangle(corners), *shapes, np.eye(3), of_points(corners), excess, size)


def coal_convex(points: Array, faces: list[list[int]]) -> Any:
    """A convex of Coal with the adjacency of its vertices."""
    vertices, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for point in points:
        vertices.append(point)
    for face in faces:
        triangles.append(coal.Triangle(*face))
    return coal.Convex(vertices, triangles)


def _fcl_convex(points: Array, faces: list[list[int]]) -> Any:
    flat = np.array([number for face in faces for number in (3, *face)])
    return fcl.Convex(points, len(faces), flat)
