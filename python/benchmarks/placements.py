"""Poses for pairs of solids: apart, near or overlapping, and aligned on a grid."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
from scipy.spatial.transform import Rotation

from certify import gaps, spiral
from solids import Array, Solid

FAMILIES = ("apart", "near", "aligned")


def placements(family: str, one: Solid, two: Solid, count: int) -> tuple[Array, Array]:
    """Poses (count, 4, 4) of both solids. They are the same in every run, and depend only on the family, the
    names of the pair and `count`."""
    seed = [FAMILIES.index(family), *f"{one.name}{two.name}".encode()]
    rng = np.random.default_rng(seed)
    if family == "aligned":
        return aligned_poses(rng, count), aligned_poses(rng, count)
    poses1 = matrices(Rotation.random(count, random_state=rng).as_matrix(), rng.normal(size=(count, 3)))
    poses2 = matrices(Rotation.random(count, random_state=rng).as_matrix(), np.zeros((count, 3)))
    directions = _directions(rng, one, two, poses1, poses2)
    # First the gap along `directions`, in which the second solids lie, becomes a random length. Near pairs are
    # then moved along the direction with the largest gap.
    size = one.radius + two.radius
    _move(size * rng.uniform(0.05, 2, count), directions, (one, poses1), (two, poses2))
    if family == "near":
        wanted = min(one.radius, two.radius) * rng.uniform(-0.6, 0.2, count)
        _move(wanted, _widest(one, poses1, two, poses2), (one, poses1), (two, poses2))
    return poses1, poses2


def _move(wanted: Array, directions: Array, fixed: tuple[Solid, Array], moved: tuple[Solid, Array]) -> None:
    """Moves the second solids along directions (n, 3) until the gaps along these directions are `wanted`."""
    found = gaps(*fixed, *moved, directions[:, None])[:, 0]
    moved[1][:, :3, 3] += directions * (wanted - found)[:, None]


def _widest(one: Solid, poses1: Array, two: Solid, poses2: Array) -> Array:
    """The direction with the largest gap, among a hundred, for each pair."""
    if one.is_half_space or two.is_half_space:
        return poses1[:, :3, 1] if one.is_half_space else -poses2[:, :3, 1]
    spread, found = spiral(100), []
    for begin in range(0, len(poses1), 1000):
        rows = slice(begin, begin + 1000)
        tried = np.broadcast_to(spread, (len(poses1[rows]), *spread.shape))
        found.append(spread[gaps(one, poses1[rows], two, poses2[rows], tried).argmax(axis=1)])
    return np.concatenate(found)


def _directions(rng: np.random.Generator, one: Solid, two: Solid, poses1: Array, poses2: Array) -> Array:
    if one.is_half_space:
        return poses1[:, :3, 1]
    if two.is_half_space:
        return -poses2[:, :3, 1]
    directions = rng.normal(size=(len(poses1), 3))
    return np.asarray(directions / np.linalg.norm(directions, axis=1)[:, None])


def matrices(rotations: Array, translations: Array) -> Array:
    poses = np.tile(np.eye(4), (len(rotations), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = rotations, translations
    return poses


def aligned_poses(rng: np.random.Generator, count: int) -> Array:
    """Rotations by quarter turns, and positions on a grid of spacing 1/4: coplanar faces, collinear edges, equal
    centres."""
    turns = np.array(quarter_turns())[rng.integers(24, size=count)]
    return matrices(turns, rng.integers(-2, 3, size=(count, 3)) / 4)


def quarter_turns() -> list[Array]:
    """The 24 rotations that map the axes onto each other."""
    signed = (
        np.eye(3)[list(order)] * np.array(signs)[:, None]
        for order in permutations(range(3))
        for signs in product((1, -1), repeat=3)
    )
    return [matrix for matrix in signed if np.linalg.det(matrix) > 0]
