"""Coal and impinge with one interface: the results of a pair at many poses, and loops to time.

Poses are converted before a loop is timed: to transforms of Coal, and to matrices (4, 4) for single calls of impinge.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import coal
import impinge
import numpy as np

from solids import Array, Solid

QUESTIONS = ("distance", "witness", "contact")
# The fields of `Answers` that are compared.
COMPARED = ("distance", "signed", "depth")


@dataclass
class Answers:
    """The results of a library for n pairs; NaN where it has none."""

    # Zero for touching or overlapping solids.
    distance: Array
    # The signed distance: minus the depth of overlapping solids.
    signed: Array
    normal: Array
    point1: Array
    point2: Array
    # The depth of the contact; minus infinity without a contact.
    depth: Array


def empty(count: int) -> Answers:
    nothing = np.full((count, 3), np.nan)
    one = np.full(count, np.nan)
    return Answers(one.copy(), one.copy(), nothing.copy(), nothing.copy(), nothing.copy(), one.copy())


class Impinge:
    """impinge: single calls from Python, and one call for all poses on one thread."""

    def __init__(self, one: Solid, poses1: Array, two: Solid, poses2: Array) -> None:
        self.shapes = one.impinge, two.impinge
        self.poses = poses1, poses2
        self.single = list(poses1), list(poses2)

    def answers(self) -> Answers:
        (shape1, shape2), (poses1, poses2) = self.shapes, self.poses
        found = impinge.witness(shape1, poses1, shape2, poses2)
        distance = impinge.distance(shape1, poses1, shape2, poses2)
        depth = impinge.contact(shape1, poses1, shape2, poses2).depth
        return Answers(distance, found.distance, found.normal, found.point1, found.point2, depth)

    def loop(self, question: str, count: int) -> Callable[[], Any]:
        ask = getattr(impinge, question)
        (shape1, shape2), (poses1, poses2) = self.shapes, (side[:count] for side in self.single)
        return lambda: [ask(shape1, one, shape2, two) for one, two in zip(poses1, poses2, strict=True)]

    def batch(self, question: str) -> Callable[[], Any]:
        ask = getattr(impinge, question)
        (shape1, shape2), (poses1, poses2) = self.shapes, self.poses
        return lambda: ask(shape1, poses1, shape2, poses2, threads=1)


class Coal:
    """Coal: functors that hold the pair and its function, with requests and results that are reused.

    A result must be cleared before each call: one that already holds a touching pair is returned unchanged.
    """

    def __init__(self, one: Solid, poses1: Array, two: Solid, poses2: Array) -> None:
        self.shapes = one.coal, two.coal
        self.poses = _coal_poses(one, poses1), _coal_poses(two, poses2)

    def answers(self) -> Answers:
        found = empty(len(self.poses[0]))
        unsigned, signed = _coal_distance_request(False), _coal_distance_request(True)
        measure, collide = coal.ComputeDistance(*self.shapes), coal.ComputeCollision(*self.shapes)
        for row, poses in enumerate(zip(*self.poses, strict=True)):
            found.distance[row] = max(measure(*poses, unsigned, coal.DistanceResult()), 0)
            result = coal.DistanceResult()
            found.signed[row] = measure(*poses, signed, result)
            found.normal[row] = result.normal
            found.point1[row], found.point2[row] = result.getNearestPoint1(), result.getNearestPoint2()
            contacts = coal.CollisionResult()
            collide(*poses, coal.CollisionRequest(), contacts)
            touches = contacts.isCollision()
            found.depth[row] = -contacts.getContact(0).penetration_depth if touches else -np.inf
        return found

    def loop(self, question: str, count: int) -> Callable[[], Any]:
        """A loop of calls only: the results are not read."""
        call, request, result = self._functor(question)
        clear, (poses1, poses2) = result.clear, (side[:count] for side in self.poses)
        return lambda: [(clear(), call(one, two, request, result)) for one, two in zip(poses1, poses2, strict=True)]

    def plain(self, question: str, count: int) -> Callable[[], Any]:
        """A loop of the plain functions, which take shapes, with a new result for each call."""
        call, kind = (
            (coal.collide, coal.CollisionResult) if question == "contact" else (coal.distance, coal.DistanceResult)
        )
        request = self._functor(question)[1]
        (shape1, shape2), (poses1, poses2) = self.shapes, (side[:count] for side in self.poses)
        return lambda: [
            call(shape1, one, shape2, two, request, kind()) for one, two in zip(poses1, poses2, strict=True)
        ]

    def read(self, question: str, count: int) -> Callable[[], Any]:
        """A loop of calls whose points and normals are read, since the batch of impinge returns them."""
        call, request, result = self._functor(question)
        clear, (poses1, poses2) = result.clear, (side[:count] for side in self.poses)
        if question == "contact":
            take = _coal_contact
        elif question == "witness":
            take = _coal_witness
        else:
            return self.loop(question, count)

        def run() -> list[Any]:
            rows = []
            for one, two in zip(poses1, poses2, strict=True):
                clear()
                call(one, two, request, result)
                rows.append(take(result))
            return rows

        return run

    def _functor(self, question: str) -> tuple[Any, Any, Any]:
        if question == "contact":
            return coal.ComputeCollision(*self.shapes), coal.CollisionRequest(), coal.CollisionResult()
        request = _coal_distance_request(question == "witness")
        return coal.ComputeDistance(*self.shapes), request, coal.DistanceResult()


def _coal_poses(solid: Solid, poses: Array) -> list[Any]:
    return [coal.Transform3s(pose[:3, :3] @ solid.turn, pose[:3, 3]) for pose in poses]


def _coal_distance_request(is_signed: bool) -> Any:
    request = coal.DistanceRequest()
    request.enable_signed_distance = is_signed
    return request


def _coal_witness(result: Any) -> tuple[Any, ...]:
    return result.min_distance, result.getNearestPoint1(), result.getNearestPoint2(), result.normal


def _coal_contact(result: Any) -> tuple[Any, ...] | None:
    if not result.isCollision():
        return None
    found = result.getContact(0)
    return found.penetration_depth, found.normal, found.getNearestPoint1(), found.getNearestPoint2()
