"""Who is right: bounds of signed distances that come from no library.

The signed distance of two convex solids is the greatest gap over all unit directions: the distance if they are apart,
minus the depth if they overlap. The gap along any direction, by support functions, is a lower bound; that of two points
which lie in the solids an upper one. Between them is searched: directions spread over the sphere, the best refined.
"""

from __future__ import annotations

import numpy as np

from solids import Array, Solid

# Rows that are searched at once, to bound memory.
CHUNK = 200
# Directions tried around each of the best at once.
TRIES = 20


def gaps(one: Solid, poses1: Array, two: Solid, poses2: Array, directions: Array) -> Array:
    """The gaps (n, m) of n pairs along unit directions (n, m, 3) from the first to the second.

    With a half-space only the direction of its normal counts, whatever is given.
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
    """What the distance is at most if these points (n, 3) lie in the solids; how far they do not is added."""
    total = np.linalg.norm(points[0] - points[1], axis=1)
    for solid, poses, at in ((one, poses1, points[0]), (two, poses2, points[1])):
        local = np.einsum("nji,nj->ni", poses[:, :3, :3], at - poses[:, :3, 3])
        total = total + solid.excess(local)
    return np.asarray(total)


def greatest_gaps(one: Solid, poses1: Array, two: Solid, poses2: Array) -> Array:
    """The greatest gaps (n,) found by a search that knows no answer of any library."""
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
    # Each direction's own step and last move: longer after a better try, shorter after none.
    step, move = np.full(values.shape, 0.06), np.zeros(directions.shape)
    for _ in range(150):
        noise = rng.normal(size=(*directions.shape[:2], TRIES, 3))
        # Half of the tries go along the last move: kinks of the gap are narrow ridges.
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
    """Unit vectors; up for those that are zero or no numbers."""
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
    """The axes and the diagonals, where aligned solids have their answers."""
    grid = np.stack(np.meshgrid(*[[-1.0, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return unit(grid[np.any(grid != 0, axis=1)])
