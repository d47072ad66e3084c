"""Compares trimesh's collision manager with that of impinge, which has the same interface: meshes of primitives,
results and times."""

from __future__ import annotations

import argparse
from itertools import combinations_with_replacement
from typing import Any

import impinge.trimesh
import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from certify import greatest_gaps
from placements import aligned_poses, matrices
from solids import Solid, corners_alone
from timing import Side, interleaved, markdown

# The tolerance of distances between meshes of size one.
TOLERANCE = 1e-6

ABOUT = """\
{line}. `python pairs.py`: one mesh in each of two managers, one of them moved through {count} poses (half random,
half aligned) by `set_transform`, then `in_collision_other` or `min_distance_other`; microseconds of processor time,
median of {rounds} rounds, impinge on all threads. Distances are compared where both are positive (above 1e-6
differs); poses within 1e-6 of touching count for neither. Wrong is a distance more than 1e-5 off the greatest gap
of support functions.
"""


def run(options: argparse.Namespace, line: str) -> None:
    """Writes managers.md."""
    poses = _poses(20 if options.quick else 300)
    rows = [_row(pair, poses, options.rounds) for pair in combinations_with_replacement(_meshes(), 2)]
    header = [
        "pair",
        "differ: touching",
        "differ: distance",
        "impinge wrong",
        "trimesh wrong",
        "largest",
        "impinge touching us",
        "trimesh touching us",
        "ratio",
        "impinge distance us",
        "trimesh distance us",
        "ratio",
    ]
    text = [
        "# The collision manager of trimesh\n",
        ABOUT.format(line=line, count=len(poses), rounds=options.rounds),
        markdown(header, rows),
    ]
    (options.out / "managers.md").write_text("\n".join(text))


def _meshes() -> dict[str, trimesh.Trimesh]:
    return {
        "box": trimesh.creation.box([1, 0.5, 1.5]),
        "ball of 320": trimesh.creation.icosphere(2, 0.5),
        "cylinder of 128": trimesh.creation.cylinder(0.5, 1, sections=32),
    }


def _poses(count: int) -> Any:
    rng = np.random.default_rng(11)
    rotations = Rotation.random(count // 2, random_state=rng).as_matrix()
    return np.concatenate(
        [matrices(rotations, rng.normal(size=(count // 2, 3))), aligned_poses(rng, count - count // 2)]
    )


def _row(pair: tuple[str, str], poses: Any, rounds: int) -> list[object]:
    meshes = [_meshes()[name] for name in pair]
    sides = [_managers(kind, meshes) for kind in (impinge.trimesh.CollisionManager, trimesh.collision.CollisionManager)]
    touching, distance = (
        [np.array(_through(side, poses, ask)) for side in sides] for ask in ("in_collision_other", "min_distance_other")
    )
    clear = np.abs(distance[0]) > TOLERANCE
    off = np.where((distance[0] > 0) & (distance[1] > 0), np.abs(distance[0] - distance[1]), 0)
    wrong = _wrong([corners_alone("mesh", mesh.vertices) for mesh in meshes], poses, distance, off > TOLERANCE)
    timed = [time for ask in ("in_collision_other", "min_distance_other") for time in _times(sides, poses, ask, rounds)]
    differs = int((touching[0] != touching[1])[clear].sum()), int((off > TOLERANCE).sum())
    return [", ".join(pair), *differs, *wrong, float(off.max(initial=0)), *timed]


def _wrong(solids: list[Solid], poses: Any, distances: list[Any], is_differing: Any) -> tuple[int, int]:
    """The numbers of differing rows in which each side is wrong, by support functions, since the meshes are convex."""
    rows = poses[is_differing]
    true = greatest_gaps(solids[0], np.tile(np.eye(4), (len(rows), 1, 1)), solids[1], rows)
    # If one mesh is inside the other, their surfaces are separated, but there is no gap: such rows are not judged.
    judged = [np.abs(side[is_differing] - true)[true > 0] for side in distances]
    ours, theirs = (int((error > 10 * TOLERANCE).sum()) for error in judged)
    return ours, theirs


def _times(sides: list[Any], poses: Any, ask: str, rounds: int) -> tuple[float, float, float]:
    loops = {name: lambda side=side: _through(side, poses, ask) for name, side in zip("ab", sides, strict=True)}
    found = interleaved({name: Side(loop, len(poses)) for name, loop in loops.items()}, rounds)
    ours, theirs = (1e6 * found[name].median for name in "ab")
    return ours, theirs, theirs / ours


def _managers(kind: Any, meshes: list[Any]) -> tuple[Any, Any]:
    managers = kind(), kind()
    for manager, mesh in zip(managers, meshes, strict=True):
        manager.add_object("mesh", mesh)
    return managers


def _through(managers: tuple[Any, Any], poses: Any, ask: str) -> list[Any]:
    fixed, moved = managers
    found = []
    for pose in poses:
        moved.set_transform("mesh", pose)
        found.append(getattr(fixed, ask)(moved))
    return found
