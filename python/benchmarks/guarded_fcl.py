"""python-fcl with the interface of `rivals`, in a separate process, because a call may end the process or not
return."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from typing import Any

import fcl
import numpy as np

from rivals import Answers, empty
from solids import Array, Solid

# The seconds after which a call, which usually takes microseconds, counts as not returning, and those after
# which a process counts as not started.
PATIENCE, START = 1.0, 20.0
# The number of failures after which signed distances are no longer requested.
MOST_FAILURES = 2

_FORK = multiprocessing.get_context("fork")


class Fcl:
    """python-fcl with two objects that are moved. Its distances to half-spaces end the process and are not
    requested."""

    def __init__(self, one: Solid, poses1: Array, two: Solid, poses2: Array) -> None:
        self.objects = fcl.CollisionObject(one.fcl), fcl.CollisionObject(two.fcl)
        self.poses = _transforms(one, poses1), _transforms(two, poses2)
        self.has_distance = not (one.is_half_space or two.is_half_space)
        # The rows whose signed distance did not return.
        self.failed: list[int] = []

    def answers(self) -> Answers:
        """The results of all rows. After a failure a new process continues behind the failed row."""
        found, count = empty(len(self.poses[0])), len(self.poses[0])
        row = 0
        while row < count:
            is_signed = self.has_distance and len(self.failed) < MOST_FAILURES
            row = self._run(found, row, is_signed)
            if row < count:
                self.failed.append(row)
                row += 1
        sign = np.where(found.signed < 0, -1, 1)[:, None]
        found.normal = sign * (found.point2 - found.point1)
        return found

    def _run(self, found: Answers, begin: int, is_signed: bool) -> int:
        """Computes results from row `begin` on; returns the row that failed, or the number of rows."""
        receiver, sender = _FORK.Pipe(duplex=False)
        process = _FORK.Process(target=self._answer, args=(sender, begin, is_signed))
        process.start()
        sender.close()
        row, patience = begin, START
        try:
            while row < len(self.poses[0]) and receiver.poll(patience):
                name, value = receiver.recv()
                patience = PATIENCE
                if name == "done":
                    row += 1
                else:
                    getattr(found, name)[row] = value
        except EOFError:
            pass
        process.kill()
        process.join()
        return row

    def _answer(self, sender: Any, begin: int, is_signed: bool) -> None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        (one, two), request = self.objects, fcl.CollisionRequest(enable_contact=True)
        for pose1, pose2 in list(zip(*self.poses, strict=True))[begin:]:
            one.setTransform(pose1)
            two.setTransform(pose2)
            contacts = fcl.CollisionResult()
            touches = fcl.collide(one, two, request, contacts) > 0 and contacts.contacts
            sender.send(("depth", max(c.penetration_depth for c in contacts.contacts) if touches else -np.inf))
            if self.has_distance:
                distance = fcl.distance(one, two, fcl.DistanceRequest(), fcl.DistanceResult())
                sender.send(("distance", max(distance, 0)))
            if is_signed:
                result = fcl.DistanceResult()
                sender.send(("signed", fcl.distance(one, two, fcl.DistanceRequest(True, True), result)))
                sender.send(("point1", result.nearest_points[0]))
                sender.send(("point2", result.nearest_points[1]))
            sender.send(("done", None))

    def loop(self, question: str, count: int) -> Callable[[], Any] | None:
        """A loop over the first poses. `None` if FCL has no such query, or if a trial of the loop in a
        separate process does not succeed."""
        if question != "contact" and not self.has_distance:
            return None
        (one, two), poses = self.objects, [side[:count] for side in self.poses]
        request, ask, result = {
            "distance": (fcl.DistanceRequest(), fcl.distance, fcl.DistanceResult),
            "witness": (fcl.DistanceRequest(True, True), fcl.distance, fcl.DistanceResult),
            "contact": (fcl.CollisionRequest(enable_contact=True), fcl.collide, fcl.CollisionResult),
        }[question]

        def run() -> None:
            for pose1, pose2 in zip(*poses, strict=True):
                one.setTransform(pose1)
                two.setTransform(pose2)
                ask(one, two, request, result())

        return run if _returns(run) else None


def _returns(run: Callable[[], Any]) -> bool:
    """Whether a loop ends without an error within two seconds, tested in a separate process."""

    def quietly() -> None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        run()

    process = _FORK.Process(target=quietly)
    process.start()
    process.join(2 * PATIENCE)
    ended = process.exitcode == 0
    process.kill()
    process.join()
    return ended


def _transforms(solid: Solid, poses: Array) -> list[Any]:
    return [fcl.Transform(pose[:3, :3] @ solid.turn, pose[:3, 3]) for pose in poses]
