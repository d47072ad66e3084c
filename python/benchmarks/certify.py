"""Bounds of signed distances that do not depend on any library, to decide which library is right.

The signed distance of two convex solids is the largest gap over all unit directions: the distance if they are apart,
minus the depth if they overlap. The gap along any direction, computed by support functions, is a lower bound. The
distance of two points that lie in the solids is an upper bound. The lower bound is maximised over directions spread
over the sphere; the eight best are refined by random search.
"""

from __future__ import annotations

import numpy as np

from solids import Array, Solid

# The number of pairs that are searched together, to bound memory.
CHUNK = 200
# Directions tried around each of the best directions in one iteration.
TRIES = 20


def gaps(one: Solid, poses1: Array, two: Solid, poses2: Array, directions: Array) -> Array:
    """The gaps (n, m) of n pairs along unit directions (n, m, 3) from the first to the second solid.

    With a half-space the direction of its normal replaces `directions`, because no other direction has a finite gap.
    """
    if one.is_half_space:
        directions = np.broadcast_to(poses1[:, None, :3, 1], directions.shape)
    elif two.is_half_space:
        directions = np.broadcast_to(-poses2[:, None, :3, 1], directions.shape)
    between = _farthest(two, poses2, -directions) - _farthest(one, poses1, directions)
    return np.asarray((between * directions).sum(-1))


def _farthest(solid: Solid, poses: Array, directions: Array) -> Array:
    rotations = poses[:, :3, :3]
    points = solid.support(directions @ rotations)
    return np.asarray(points @ rotations.transpose(0, 2, 1) + poses[:, None, :3, 3])


def upper_bound(one: Solid, poses1: Array, two: Solid, poses2: Array, points: tuple[Array, Array]) -> Array:
    """An upper bound (n,) of the distance of the solids, from one point (n, 3) near each solid: the distance of the
    points, plus a bound of the distance of each point from its solid."""
    total = np.linalg.norm(points[0] - points[1], axis=1)
    for solid, poses, at in ((one, poses1, points[0]), (two, poses2, points[1])):
        local = np.einsum("nji,nj->ni", poses[:, :3, :3], at - poses[:, :3, 3])
        total = total + solid.excess(local)
    return np.asarray(total)


def greatest_gaps(one: Solid, poses1: Array, two: Solid, poses2: Array) -> Array:
    """The largest gaps (n,), found by a search that uses no result of any library."""
    found = [
        _search(one, poses1[rows], two, poses2[rows])
        for rows in (slice(begin, begin + CHUNK) for begin in range(0, len(poses1), CHUNK))
    ]
    return np.concatenate(found) if found else np.zeros(0)


def _search(one: Solid, poses1: Array, two: Solid, poses2: Array) -> Array:
    spread = np.concatenate([spiral(1500), _axes()])
    starts = np.broadcast_to(spread, (len(poses1), *spread.shape))
    values = gaps(one, poses1, two, poses2, starts)
    if one.is_half_space or two.is_half_space:
        return values[:, 0]
    best = np.argsort(-values, axis=1)[:, :8]
    directions = spread[best]
    values = np.take_along_axis(values, best, 1)
    rng = np.random.default_rng(1)
    # The step length of each direction, doubled after a try with a larger gap, else reduced; and the direction's
    # last successful move.
    step, move = np.full(values.shape, 0.06), np.zeros(directions.shape)
    for _ in range(150):
        noise = rng.normal(size=(*directions.shape[:2], TRIES, 3))
        # Half of the tries follow the last move, because the gap has narrow ridges at its kinks.
        along = rng.normal(size=(*values.shape, TRIES, 1)) * (np.arange(TRIES) % 2)[:, None] * 2
        thin = np.where(np.arange(TRIES) % 2, 0.1, 1.0)[:, None]
        tried = unit(directions[:, :, None] + step[..., None, None] * noise * thin + along * move[:, :, None])
        reached = gaps(one, poses1, two, poses2, tried.reshape(len(best), -1, 3)).reshape(tried.shape[:3])
        at = reached.argmax(axis=2)[..., None]
        found = np.take_along_axis(reached, at, 2)[..., 0]
        chosen = np.take_along_axis(tried, at[..., None], 2)[:, :, 0]
        is_better = found > values
        move = np.where(is_better[..., None], chosen - directions, 0.7 * move)
        directions = np.where(is_better[..., None], chosen, directions)
        values = np.where(is_better, found, values)
        step *= np.where(is_better, 2.0, 0.75)
    return np.asarray(values.max(axis=1))


def unit(vectors: Array) -> Array:
    """Unit vectors (..., 3); the y axis replaces zero vectors and vectors with NaN."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    up = np.array([0.0, 1, 0])
    return np.where(length > 0, np.nan_to_num(vectors) / np.where(length > 0, length, 1), up)


def spiral(count: int) -> Array:
    """Directions spread evenly over the sphere."""
    height = 1 - (2 * np.arange(count) + 1) / count
    angle = np.arange(count) * np.pi * (3 - np.sqrt(5))
    aside = np.sqrt(1 - height * height)
    return np.stack([aside * np.cos(angle), height, aside * np.sin(angle)], axis=1)


def _axes() -> Array:
    """The unit directions along the axes and the diagonals. The largest gap of solids with parallel axes is often
    along one of them."""
    grid = np.stack(np.meshgrid(*[[-1.0, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return unit(grid[np.any(grid != 0, axis=1)])
