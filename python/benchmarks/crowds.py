"""Compares trimesh's collision manager with that of impinge for many objects: the time of moves, and of each call after them.

    python crowds.py [--objects 10 1000 10000] [--out FOLDER]
"""

from __future__ import annotations

import argparse
import gc
import statistics
import time
from collections.abc import Callable, Sequence
from typing import Any

import impinge.trimesh
import numpy as np
import trimesh

from timing import arguments, machine, markdown

# Distances that differ by more than this are printed. The errors of FCL's distances of meshes, about 1e-7, are far below.
TOLERANCE = 1e-4

ABOUT = """\
{line}. `python crowds.py`: meshes on a grid, 2 apart: boxes of 1, which are convex, or bowls of 260 triangles, which are not.
Free, or the last one overlaps its neighbour. The other manager has as many far away, but for one that overlaps the last where
the scene touches. Before each call one mesh moves by up to 0.05 along each axis, or all do. Microseconds of processor time,
median of {rounds} rounds (of one where more than 2000 move), both sides in turn; "move" is one `set_transform`, "both" are all moves and the call, and the last column
is FCL's time for both as a multiple of impinge's.
"""

# The largest number of objects that all move in every round. In larger scenes all objects move in one round only.
FEW = 2000

SIDES = {"impinge": impinge.trimesh.CollisionManager, "trimesh": trimesh.collision.CollisionManager}

Ask = Callable[[Any, str], Any]


def run(options: argparse.Namespace, line: str) -> None:
    """Writes crowds.md."""
    header = ["objects", "mesh", "scene", "moved", "call"]
    header += [f"{what} {side}" for what in ("move", "call", "both") for side in ("impinge", "FCL")] + ["ratio of both"]
    rows: list[list[object]] = []
    for count in options.objects:
        for kind, mesh in _meshes().items():
            for scene in ("free", "touching"):
                crowd = Crowd(mesh, count, scene == "touching")
                rows += [[count, kind, scene, *row] for row in crowd.rows(options.rounds)]
                # Written after each scene, because the large scenes take minutes.
                text = ["# Managers of many objects\n", ABOUT.format(line=line, rounds=options.rounds), markdown(header, rows)]
                (options.out / "crowds.md").write_text("\n".join(text))


def _meshes() -> dict[str, trimesh.Trimesh]:
    ball = trimesh.creation.icosphere(2, 0.5)
    bowl = trimesh.Trimesh(ball.vertices, ball.faces[ball.triangles_center[:, 2] < 0.3])
    return {"box": trimesh.creation.box(), "bowl": bowl}


class Crowd:
    """A manager of each library with the same meshes, a second manager of each, and the moves of the meshes."""

    def __init__(self, mesh: trimesh.Trimesh, count: int, touches: bool) -> None:
        self.mesh, self.rng = mesh, np.random.default_rng(1)
        side = int(np.ceil(count ** (1 / 3)))
        self.places = np.argwhere(np.ones((side,) * 3))[:count] * 2.0
        beside = self.places + [0, 0, 1000.0]
        if touches:
            self.places[-1] = self.places[-2] + 0.25
            beside[-1] = self.places[-1] + 0.125
        self.names = [f"m{number}" for number in range(count)]
        self.managers = {name: self._made(kind, self.places) for name, kind in SIDES.items()}
        self.others = {name: self._made(kind, beside) for name, kind in SIDES.items()}
        # A smaller mesh for the queries of a single mesh. It fits between the others without touching them; in the
        # touching scene it overlaps one of them.
        self.small = mesh.copy()
        self.small.apply_scale(0.75)
        self.probe = np.eye(4)
        self.probe[:3, 3] = self.places[count // 2] + (0.3 if touches else 1.0)

    def _made(self, kind: Any, places: Any) -> Any:
        manager = kind()
        for name, place in zip(self.names, places, strict=True):
            manager.add_object(name, self.mesh, trimesh.transformations.translation_matrix(place))
        return manager

    def rows(self, rounds: int) -> list[list[object]]:
        # FCL takes seconds to move thousands of meshes.
        few = rounds if len(self.names) <= FEW else 1
        ways = {"one": rounds, "all": few}
        return [[moved, name, *self.times(ask, moved, ways[moved])] for moved in ways for name, ask in self.calls().items()]

    def calls(self) -> dict[str, Ask]:
        mesh, small, probe, first = self.mesh, self.small, self.probe, self.names[0]
        return {
            "in_collision_internal": lambda manager, _: manager.in_collision_internal(),
            "in_collision_internal, names": lambda manager, _: manager.in_collision_internal(return_names=True),
            "in_collision_single": lambda manager, _: manager.in_collision_single(small, probe),
            "in_collision_other": lambda manager, side: manager.in_collision_other(self.others[side]),
            "min_distance_internal": lambda manager, _: manager.min_distance_internal(),
            "min_distance_internal, name": lambda manager, _: manager.min_distance_internal(first),
            "min_distance_single": lambda manager, _: manager.min_distance_single(small, probe),
            "min_distance_other": lambda manager, side: manager.min_distance_other(self.others[side]),
            "add and remove": lambda manager, _: (manager.add_object("new", mesh), manager.remove_object("new"))[1],
        }

    def times(self, ask: Ask, moved: str, rounds: int) -> list[float]:
        """Medians in microseconds: one move, the call, and both, each for impinge and FCL; then the ratio of both."""
        seconds: dict[str, list[tuple[float, float]]] = {name: [] for name in SIDES}
        gc.collect()
        gc.disable()
        try:
            for _ in range(rounds + 1):
                poses, answers = self.moves(moved), {}
                for side, manager in self.managers.items():
                    begin = time.process_time()
                    for name, pose in poses:
                        manager.set_transform(name, pose)
                    middle = time.process_time()
                    answers[side] = ask(manager, side)
                    seconds[side].append((middle - begin, time.process_time() - middle))
                self.compare(answers)
        finally:
            gc.enable()
        # The first round warms up.
        moves, calls = ([1e6 * statistics.median(row[part] for row in seconds[side][1:]) for side in SIDES] for part in (0, 1))
        both = [move + call for move, call in zip(moves, calls, strict=True)]
        each = [move / len(poses) for move in moves]
        return [*each, *calls, *both, both[1] / both[0]]

    def moves(self, moved: str) -> list[tuple[str, Any]]:
        chosen: Sequence[int] = range(len(self.names)) if moved == "all" else [int(self.rng.integers(len(self.names)))]
        poses = []
        for number in chosen:
            pose = np.eye(4)
            pose[:3, 3] = self.places[number] + self.rng.uniform(-0.05, 0.05, 3)
            poses.append((self.names[number], pose))
        return poses

    @staticmethod
    def compare(answers: dict[str, Any]) -> None:
        """Prints differing results. Of a result with several values only the first is compared, and of distances only two
        that are both positive."""
        ours, theirs = (answer[0] if isinstance(answer, tuple) else answer for answer in answers.values())
        if isinstance(ours, bool):
            if ours != theirs:
                print(f"touching differs: {ours}, {theirs}")
        elif ours is not None and min(ours, theirs) > 0 and abs(ours - theirs) > TOLERANCE:
            print(f"distances differ: {ours}, {theirs}")


if __name__ == "__main__":
    parser = arguments(__doc__)
    parser.add_argument("--objects", type=int, nargs="+", default=[10, 1000, 10000])
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    run(options, machine(["impinge", "trimesh", "python-fcl", "numpy"]))
