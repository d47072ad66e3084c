"""Results of the functions: columns of arrays, or scalars for a single pair.

`_results.pyi` has the types for type checkers, with parameters that tell arrays from scalars.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.floating[Any]]
Flags: TypeAlias = NDArray[np.bool_]
Indices: TypeAlias = NDArray[np.uint32]


class Proximity(IntEnum):
    """The proximity of two shapes: the numbers that `proximity` returns."""

    INTERSECTING = 0
    WITHIN_MARGIN = 1
    DISJOINT = 2


class ClosestPoints(NamedTuple):
    """The closest points of two shapes, in the world frame; (n,) and (n, D), or a float and (D,)."""

    distance: float | Floats
    point1: Floats
    point2: Floats


class Witness(NamedTuple):
    """The nearest or deepest points of two shapes, and the parts of composites at these points: (n,) and (n, D), or
    scalars."""

    distance: float | Floats
    point1: Floats
    point2: Floats
    normal: Floats
    part1: int | Indices
    part2: int | Indices


class Contact(NamedTuple):
    """The contact of two shapes: depth (n,), positive where they overlap, normal and points (n, D), or scalars."""

    depth: float | Floats
    normal: Floats
    point1: Floats
    point2: Floats


class Impact(NamedTuple):
    """The impact of two moving shapes: time (n,), normal and points (n, D), or scalars."""

    time: float | Floats
    normal: Floats
    point1: Floats
    point2: Floats
    is_reached: bool | Flags


class Nearest(NamedTuple):
    """The nearest pair of a batch; -1 if none is within the limit."""

    pair: int
    distance: float


class Manifolds(NamedTuple):
    """Contact points in rows. The rows of pair i are `starts[i]` to `starts[i + 1]` of the other columns, (m,) and (m,
    D)."""

    starts: NDArray[np.int64]
    depth: Floats
    normal: Floats
    point1: Floats
    point2: Floats
    manifold: Indices
    part1: Indices
    part2: Indices

    def of(self, pair: int) -> Manifolds:
        """The contact points of one pair.

        >>> import impinge, numpy as np
        >>> poses = np.tile(np.eye(4), (2, 1, 1)); poses[:, 1, 3] = [5, 1.5]
        >>> rows = impinge.contact_manifolds(impinge.Ball(1), None, impinge.Ball(1), poses)
        >>> len(rows.of(0).depth), rows.of(1).depth.tolist()
        (0, [0.5])
        """
        if not 0 <= pair < len(self.starts) - 1:
            raise IndexError(f"there is no pair {pair}")
        begin, end = int(self.starts[pair]), int(self.starts[pair + 1])
        rows = slice(begin, end)
        return Manifolds(
            self.starts[pair : pair + 2] - begin,
            self.depth[rows],
            self.normal[rows],
            self.point1[rows],
            self.point2[rows],
            self.manifold[rows],
            self.part1[rows],
            self.part2[rows],
        )


class Projection(NamedTuple):
    """The points of shapes nearest to the query points, whether these are inside, and parts: (n, D), (n,) and (n,), or
    scalars."""

    point: Floats
    is_inside: bool | Flags
    part: int | Indices


class RayHit(NamedTuple):
    """The first hits of rays: (n,), (n, D) and (n,); the time is infinite without a hit."""

    time: float | Floats
    normal: Floats
    part: int | Indices
