"""Worlds: persistent objects with a broad phase, cached contacts, events, and queries about all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge import _native
from impinge._native import Shape
from impinge._poses import DType, DTypeName, dtype_name
from impinge._pictures import View, html_of
from impinge._recording import Recording
from impinge._results import Floats
from impinge._world_arguments import Options, Query, groups_of, handles_of, structured
from impinge._world_queries import WorldQueries
from impinge._world_results import Handles

if TYPE_CHECKING:
    from impinge._native import PosesLike, Shapes

EVENT = ["kind", "first", "second"]
CONTACT = ["first", "second", "depth", "normal", "point1", "point2", "part1", "part2"]


class World(WorldQueries):
    """Objects with shapes and poses; `update` computes their contacts.

    margin: the length by which boxes of the broad phase are enlarged. dim: 2 or 3. dtype: "float64" or "float32", of shapes and
    results. Handles are uint64 arrays (n,). A handle is never reused for another object of its world; a stale handle raises
    ValueError that names its row. Calls that raise change nothing. Queries use changes at once, pairs and events at the next
    `update`.

    A world can be pickled, and its copy has the same handles; events and contacts of the copy begin at its first `update`.

    Queries take many elements, or a single one. They take `filter` (a `Filter`),
    `threads` and `progress` (an object with `update(n)`, such as a bar of tqdm). Other Python threads run meanwhile, and Ctrl-C
    interrupts them.

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

    def __init__(self, margin: float = 0.02, *, dim: int = 3, dtype: DType = "float64") -> None:
        if dim not in (2, 3):
            raise ValueError(f"dim is {dim}: it is 2 or 3")
        self._margin = float(margin)
        self._world = _native.World(self._margin, dim, dtype_name(dtype))
        self._recording: Recording | None = None

    def __reduce__(self) -> tuple[object, ...]:
        """Pickles objects, handles, groups and query types; pairs, contacts and events start at the next `update`."""
        if self._recording is not None:
            raise TypeError(f"the world is recorded: the recording {self._recording.title!r} has not stopped")
        return (_unpickled, (self._margin, self.dim, self.dtype, *self._world.to_bytes()))

    @property
    def dim(self) -> int:
        """The number of dimensions: 2 or 3."""
        return self._world.dim

    @property
    def dtype(self) -> DTypeName:
        """ "float32" or "float64"."""
        return self._world.dtype

    def add(
        self,
        shapes: Shapes,
        poses: PosesLike,
        *,
        prediction: float = 0.0,
        margin: float | None = None,
        membership: Sequence[int] | None = None,
        whitelist: Sequence[int] | None = None,
        blacklist: Sequence[int] | None = None,
    ) -> Handles:
        """Adds objects, as many as there are shapes or poses, and returns their handles (n,) in this order.

        shapes, poses: as in `impinge.distance`. prediction: contacts exist up to the sum of the predictions of both objects, a
        length. margin: proximity up to this length instead of contacts. The lists are of groups 0 to 29: two objects are a pair
        if each is in a group of the other's whitelist and in none of its blacklist.

        Errors: ValueError names the row of an invalid pose; TypeError a shape of another dim or dtype. No object is then added.

        >>> from impinge import *
        >>> World().add([Ball(1), Ball(2)], Poses([[0, 0, 0], [9, 0, 0]])).tolist()
        [0, 1]
        """
        groups = groups_of(membership, whitelist, blacklist)
        return handles_of(self._world.add(shapes, poses, Options(Query(prediction, margin), groups)))

    def remove(self, handles: ArrayLike) -> None:
        """Removes objects (n,), without duplicates.

        >>> from impinge import *
        >>> world = World()
        >>> world.remove(world.add(Ball(1), None))
        >>> len(world)
        0
        """
        self._world.remove(handles_of(handles))

    def set_poses(self, handles: ArrayLike, poses: PosesLike) -> None:
        """Moves objects (n,): a pose for each, or one for all.

        >>> from impinge import *
        >>> world = World()
        >>> world.set_poses(world.add(Ball(1), None), Poses([1, 2, 3]))
        >>> world.poses()[0, :3, 3].tolist()
        [1.0, 2.0, 3.0]
        """
        self._world.set_poses(handles_of(handles), poses)

    def set_shapes(self, handles: ArrayLike, shapes: Shapes) -> None:
        """Sets the shapes of objects (n,): one for each, or one for all.

        >>> from impinge import *
        >>> world = World()
        >>> world.set_shapes(world.add(Ball(1), None), Cuboid([1, 1, 1]))
        >>> world.shapes()
        [<impinge.Cuboid 3D float64>]
        """
        self._world.set_shapes(handles_of(handles), shapes)

    def set_vertices(self, handle: int, vertices: ArrayLike) -> None:
        """Deforms the `TriMesh` or `Polyline` of one object: vertices (n, D), as many as it has, in the local frame.

        Contacts on parts that hardly move keep their ids. This costs less than setting a new shape: adjacency and the tree of
        boxes are kept.

        >>> from impinge import *
        >>> world = World(dim=2)
        >>> rope = world.add(Polyline([[-1, 0], [0, 0], [1, 0]]), None)
        >>> world.set_vertices(rope[0], [[-1, 0], [0, 2], [1, 0]])
        >>> world.cast_rays([0, 9], [0, -1]).time.tolist()
        [7.0]
        """
        array = handles_of(handle, "handle")
        if len(array) != 1:
            raise ValueError(f"handle has {len(array)} numbers, where one is needed")
        self._world.set_vertices(int(array[0]), vertices)

    def set_groups(
        self,
        handles: ArrayLike,
        *,
        membership: Sequence[int] | None = None,
        whitelist: Sequence[int] | None = None,
        blacklist: Sequence[int] | None = None,
    ) -> None:
        """Sets the groups of objects (n,); missing lists are those of new objects.

        >>> from impinge import *
        >>> world = World()
        >>> balls = world.add(Ball(1), Poses([[0, 0, 0], [1, 0, 0]]))
        >>> world.set_groups(balls, membership=[1], blacklist=[1])
        >>> world.update()
        >>> len(world.contacts())
        0
        """
        self._world.set_groups(handles_of(handles), groups_of(membership, whitelist, blacklist))

    def set_query_types(self, handles: ArrayLike, *, prediction: float = 0.0, margin: float | None = None) -> None:
        """Sets the query types of objects (n,): contacts with a prediction, or proximity with a margin; see `add`.

        >>> from impinge import *
        >>> world = World()
        >>> world.set_query_types(world.add(Ball(1), Poses([[0, 0, 0], [3, 0, 0]])), margin=1)
        >>> world.update()
        >>> world.proximities()["kind"].tolist()
        [1]
        """
        self._world.set_query_types(handles_of(handles), Query(prediction, margin))

    def update(self) -> None:
        """Updates pairs, contacts and events."""
        self._world.update()
        if self._recording is not None:
            self._recording.updates += 1

    def record(self, title: str = "impinge") -> Recording:
        """Starts a recording, from the current objects on; see `Recording`.

        It updates the world, which is the first recorded update. There is one recording at a time: ValueError if another one
        has not stopped.
        """
        if self._recording is not None:
            raise ValueError(f"the recording {self._recording.title!r} has not stopped")
        recording = Recording(self, title)
        self._world.record()
        recording.updates = 1
        self._recording = recording
        return recording

    def _stop(self) -> bytes:
        self._recording = None
        return self._world.stop_recording() or b""

    def __len__(self) -> int:
        return len(self._world.handles())

    def handles(self) -> Handles:
        """The handles of all objects (n,), in order."""
        return handles_of(self._world.handles())

    def shapes(self, handles: ArrayLike | None = None) -> list[Shape]:
        """The shapes of objects; without handles those of all."""
        return self._world.shapes(self.handles() if handles is None else handles_of(handles))

    def poses(self, handles: ArrayLike | None = None) -> Floats:
        """The poses of objects; without handles those of all: (n, D+1, D+1)."""
        return self._world.poses(self.handles() if handles is None else handles_of(handles))

    def contact_events(self) -> NDArray[np.void]:
        """The contact events of the last update: a structured array (m,) with `kind` (1 started, 0 stopped), `first`, `second`."""
        return structured(EVENT, self._world.contact_events())

    def proximity_events(self) -> NDArray[np.void]:
        """The proximity events of the last update: a structured array (m,) with `kind` (a `Proximity`), `first`, `second`."""
        return structured(EVENT, self._world.proximity_events())

    def contacts(self) -> NDArray[np.void]:
        """All contact points found by the last update: a structured array (m,).

        Fields: `first`, `second` (handles), `depth` (a length, negative where the objects are apart), `normal` (D,) from the first
        to the second, `point1`, `point2` (D,) in the world frame, `part1`, `part2` (indices of parts, such as triangles).
        """
        return structured(CONTACT, self._world.contacts())

    def proximities(self) -> NDArray[np.void]:
        """The pairs with a margin that intersect or are within the margin: a structured array (m,) like `proximity_events`."""
        return structured(EVENT, self._world.proximities())

    def _picture(self, view: View) -> tuple[str, bytes]:
        return self._world.picture(view)

    def _repr_html_(self) -> str:
        return html_of(self)

    def __repr__(self) -> str:
        return f"<impinge.World of {len(self)} objects, {self.dim}D {self.dtype}>"


def _unpickled(margin: float, dim: int, dtype: DType, data: bytes, ages: list[int]) -> World:
    """Restores the world of `World.__reduce__`."""
    world = World(margin, dim=dim, dtype=dtype)
    world._world.fill(data, ages)
    return world
