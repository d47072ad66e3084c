"""Worlds: objects that stay, with a broad phase, contacts that are kept, events, and queries about all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge import _native

Handles = NDArray[np.uint64]

NO_OBJECT = int(np.iinfo(np.uint64).max)
"""The handle of no object, where a query has no answer."""

EVENT = ["kind", "first", "second"]
CONTACT = ["first", "second", "depth", "normal", "point1", "point2"]


class WorldHit(NamedTuple):
    """What rays or moving shapes hit first: infinite time, NaN and `NO_OBJECT` without a hit."""

    time: Any
    normal: Any
    handle: Handles


class Rows(NamedTuple):
    """Lists of objects: those of element i are `starts[i]` to `starts[i + 1]`."""

    starts: NDArray[np.int64]
    handle: Handles


class NearRows(NamedTuple):
    """Lists of objects with their distances, the nearest first."""

    starts: NDArray[np.int64]
    handle: Handles
    distance: Any


class World:
    """Objects with shapes and poses; `update` finds who touches whom.

    margin: by how much boxes are fattened, in lengths. Handles are uint64; one never comes to mean another object of its world,
    and a stale one raises ValueError that names its row. Calls that raise change nothing.

    >>> import impinge
    >>> world = impinge.World()
    >>> floor = world.add(impinge.Cuboid([10, 1, 10]), None)
    >>> balls = world.add(impinge.Ball(1), impinge.Poses([[0, 1.9, 0], [5, 3, 0]]))
    >>> world.update()
    >>> world.contact_events()[["kind", "second"]].tolist()
    [(1, 1)]
    >>> world.contacts()["depth"].round(3).tolist()
    [0.1]
    """

    def __init__(self, margin: float = 0.02, *, dim: int = 3, dtype: str = "float64") -> None:
        self._world = _native.World(margin, dim, dtype)

    @property
    def dim(self) -> int:
        """2 or 3."""
        return self._world.dim

    @property
    def dtype(self) -> str:
        """ "float32" or "float64"."""
        return self._world.dtype

    def add(
        self,
        shapes: Any,
        poses: Any,
        *,
        prediction: float = 0.0,
        margin: float | None = None,
        membership: Sequence[int] | None = None,
        whitelist: Sequence[int] | None = None,
        blacklist: Sequence[int] | None = None,
    ) -> Handles:
        """Adds objects, as many as there are shapes or poses, and returns their handles in this order.

        prediction: contacts exist up to the sum of those of both objects. margin: proximity instead of contacts. The
        lists are of groups 0 to 29: two objects are a pair if each has a group of the other's whitelist and none of its blacklist.
        """
        options = _Options(prediction, margin, membership, whitelist, blacklist)
        return _handles(self._world.add(shapes, poses, options))

    def remove(self, handles: ArrayLike) -> None:
        """Removes objects."""
        self._world.remove(_handles(handles))

    def set_poses(self, handles: ArrayLike, poses: Any) -> None:
        """Moves objects: a pose for each, or one for all."""
        self._world.set_poses(_handles(handles), poses)

    def update(self) -> None:
        """Brings pairs, contacts and events up to date."""
        self._world.update()

    def __len__(self) -> int:
        return len(self._world.handles())

    def handles(self) -> Handles:
        """The handles of all objects, in order."""
        return _handles(self._world.handles())

    def poses(self, handles: ArrayLike | None = None) -> NDArray[Any]:
        """The poses of objects, without handles of all: (n, D+1, D+1)."""
        return self._world.poses(self.handles() if handles is None else _handles(handles))

    def contact_events(self) -> NDArray[Any]:
        """What changed at the last update: `kind` (1 started, 0 stopped), `first`, `second`."""
        return _structured(EVENT, self._world.contact_events())

    def proximity_events(self) -> NDArray[Any]:
        """What changed at the last update: `kind` (a `Proximity`), `first`, `second`."""
        return _structured(EVENT, self._world.proximity_events())

    def contacts(self) -> NDArray[Any]:
        """All contact points as of the last update: a structured array.

        Fields: `first`, `second` (handles), `depth` (negative where they are apart), `normal` (from the first to the second),
        `point1`, `point2` (world frame).
        """
        return _structured(CONTACT, self._world.contacts())

    def cast_rays(self, origins: Any, directions: Any, max_time: float = np.inf, *, solid: bool = True) -> WorldHit:
        """The first object that each ray meets; times are in units of the length of its direction."""
        return WorldHit(*self._world.cast_rays(origins, directions, max_time, solid))

    def cast_shape(
        self, shape: Any, poses: Any, velocities: Any, max_time: float = np.inf, target_distance: float = 0.0
    ) -> WorldHit:
        """The first object that each moving shape comes within `target_distance` of; it does not turn."""
        return WorldHit(*self._world.cast_shape(shape, poses, velocities, max_time, target_distance))

    def nearest(self, shape: Any, poses: Any, count: int = 1, max_distance: float = np.inf) -> NearRows:
        """For each placed shape the nearest objects, at most `count` of them and at most `max_distance` away."""
        return NearRows(*self._world.near(shape, poses, count, max_distance))

    def containing(self, points: Any) -> Rows:
        """For each point the objects that hold it."""
        return Rows(*self._world.containing(points))


class _Options(NamedTuple):
    prediction: float
    margin: float | None
    membership: Sequence[int] | None
    whitelist: Sequence[int] | None
    blacklist: Sequence[int] | None


def _handles(given: ArrayLike) -> Handles:
    array = np.atleast_1d(np.asarray(given))
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"handles are {array.dtype}, where integers are needed")
    return array.astype(np.uint64)


def _structured(names: Sequence[str], columns: Sequence[NDArray[Any]]) -> NDArray[Any]:
    fields = [(name, column.dtype, column.shape[1:]) for name, column in zip(names, columns, strict=True)]
    table = np.empty(len(columns[0]), dtype=fields)
    for name, column in zip(names, columns, strict=True):
        table[name] = column
    return table
