"""Results of queries of worlds: columns of arrays, or rows of lists."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from impinge._results import Flags, Floats

Handles: TypeAlias = NDArray[np.uint64]

NO_OBJECT = int(np.iinfo(np.uint64).max)
"""The handle of no object, where a query has no answer."""


class WorldHit(NamedTuple):
    """The first hits of rays: time (n,), normal (n, D) and handle (n,); infinite, NaN and `NO_OBJECT` without a hit."""

    time: Floats
    normal: Floats
    handle: Handles


class WorldImpact(NamedTuple):
    """The first hits of moving shapes: time (n,), normal (n, D) from the shape to the object, handle (n,), points (n, D)."""

    time: Floats
    normal: Floats
    handle: Handles
    point1: Floats
    point2: Floats


class WorldProjection(NamedTuple):
    """The nearest points on objects: point (n, D), is_inside (n,), handle (n,); NaN and `NO_OBJECT` without a result."""

    point: Floats
    is_inside: Flags
    handle: Handles


class Rows(NamedTuple):
    """Lists of objects: the objects of element i are `starts[i]` to `starts[i + 1]` of `handle`."""

    starts: NDArray[np.int64]
    handle: Handles


class HitRows(NamedTuple):
    """Lists of objects that rays hit, sorted by time."""

    starts: NDArray[np.int64]
    handle: Handles
    time: Floats
    normal: Floats


class ImpactRows(NamedTuple):
    """Lists of objects that moving shapes hit, sorted by time."""

    starts: NDArray[np.int64]
    handle: Handles
    time: Floats
    normal: Floats
    point1: Floats
    point2: Floats


class NearRows(NamedTuple):
    """Lists of objects with their distances, the nearest first, and the closest points: NaN where they overlap."""

    starts: NDArray[np.int64]
    handle: Handles
    distance: Floats
    point1: Floats
    point2: Floats
