"""Worlds: objects that stay, with a broad phase, contacts that are kept, events, and queries about all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge import _native
from impinge._native import Shape
from impinge._pictures import View, html_of
from impinge._recording import Recording
from impinge._world_arguments import (
    Filter,
    Options,
    Query,
    Question,
    count_of,
    groups_of,
    handles_of,
    limit,
    structured,
)
from impinge._world_results import (
    Handles,
    HitRows,
    ImpactRows,
    NearRows,
    Rows,
    WorldHit,
    WorldImpact,
    WorldProjection,
)

if TYPE_CHECKING:
    from impinge._native import Progress

EVENT = ["kind", "first", "second"]
CONTACT = ["first", "second", "depth", "normal", "point1", "point2", "part1", "part2"]


class World:
    """Objects with shapes and poses; `update` finds who touches whom.

    margin: by how much boxes are fattened, in lengths. dim: 2 or 3. dtype: "float64" or "float32", that of shapes and answers.
    Handles are uint64 arrays (n,); one never comes to mean another object of its world, and a stale one raises ValueError that
    names its row. Calls that raise change nothing. Queries see changes at once, pairs and events at the next `update`.

    Queries are asked about many elements at once, and one element may be given alone. They take `filter` (a `Filter`),
    `threads` and `progress` (an object with `update(n)`, as tqdm's bars); other threads of Python run meanwhile, and Ctrl-C
    ends them.

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
        if dim not in (2, 3):
            raise ValueError(f"dim is {dim}: it is 2 or 3")
        self._world = _native.World(margin, dim, dtype)
        self._recording: Recording | None = None

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
        """Adds objects, as many as there are shapes or poses, and returns their handles (n,) in this order.

        shapes, poses: as of `impinge.distance`. prediction: contacts exist up to the sum of those of both objects, a length.
        margin: proximity up to this length instead of contacts. The lists are of groups 0 to 29: two objects are a pair if
        each has a group of the other's whitelist and none of its blacklist.

        Errors: ValueError names the row of a pose that is none; TypeError a shape of another dim or dtype. No object is added.

        >>> from impinge import *
        >>> World().add([Ball(1), Ball(2)], Poses([[0, 0, 0], [9, 0, 0]])).tolist()
        [0, 1]
        """
        groups = groups_of(membership, whitelist, blacklist)
        return handles_of(self._world.add(shapes, poses, Options(Query(prediction, margin), groups)))

    def remove(self, handles: ArrayLike) -> None:
        """Removes objects (n,), each of which occurs once.

        >>> from impinge import *
        >>> world = World()
        >>> world.remove(world.add(Ball(1), None))
        >>> len(world)
        0
        """
        self._world.remove(handles_of(handles))

    def set_poses(self, handles: ArrayLike, poses: Any) -> None:
        """Moves objects (n,): a pose for each, or one for all.

        >>> from impinge import *
        >>> world = World()
        >>> world.set_poses(world.add(Ball(1), None), Poses([1, 2, 3]))
        >>> world.poses()[0, :3, 3].tolist()
        [1.0, 2.0, 3.0]
        """
        self._world.set_poses(handles_of(handles), poses)

    def set_shapes(self, handles: ArrayLike, shapes: Any) -> None:
        """Gives objects (n,) other shapes: one for each, or one for all.

        >>> from impinge import *
        >>> world = World()
        >>> world.set_shapes(world.add(Ball(1), None), Cuboid([1, 1, 1]))
        >>> world.shapes()
        [<impinge.Cuboid 3D float64>]
        """
        self._world.set_shapes(handles_of(handles), shapes)

    def set_vertices(self, handle: int, vertices: ArrayLike) -> None:
        """Bends the `TriMesh` or `Polyline` of one object: vertices (n, D), as many as it has, in the frame of the shape.

        Contacts on parts that stay keep their names. It costs less than a new shape: the triangles and the tree of boxes stay.

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
        """Gives objects (n,) other groups; lists that are not given are those of new objects.

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
        """What is found of objects (n,): contacts with a prediction, or proximity with a margin; see `add`.

        >>> from impinge import *
        >>> world = World()
        >>> world.set_query_types(world.add(Ball(1), Poses([[0, 0, 0], [3, 0, 0]])), margin=1)
        >>> world.update()
        >>> world.proximities()["kind"].tolist()
        [1]
        """
        self._world.set_query_types(handles_of(handles), Query(prediction, margin))

    def update(self) -> None:
        """Brings pairs, contacts and events up to date."""
        self._world.update()
        if self._recording is not None:
            self._recording.updates += 1

    def record(self, title: str = "impinge") -> Recording:
        """Begins to record what happens, from the objects that there are; see `Recording`.

        It updates the world, which is the first of the updates. One recording at a time: ValueError if there is another
        that has not stopped.
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
        """The shapes of objects, without handles of all."""
        return self._world.shapes(self.handles() if handles is None else handles_of(handles))

    def poses(self, handles: ArrayLike | None = None) -> NDArray[Any]:
        """The poses of objects, without handles of all: (n, D+1, D+1)."""
        return self._world.poses(self.handles() if handles is None else handles_of(handles))

    def contact_events(self) -> NDArray[Any]:
        """What changed at the last update: a structured array (m,) with `kind` (1 started, 0 stopped), `first`, `second`."""
        return structured(EVENT, self._world.contact_events())

    def proximity_events(self) -> NDArray[Any]:
        """What changed at the last update: a structured array (m,) with `kind` (a `Proximity`), `first`, `second`."""
        return structured(EVENT, self._world.proximity_events())

    def contacts(self) -> NDArray[Any]:
        """All contact points as of the last update: a structured array (m,).

        Fields: `first`, `second` (handles), `depth` (a length, negative where they are apart), `normal` (D,) from the first to
        the second, `point1`, `point2` (D,) in the world frame, `part1`, `part2` (numbers of triangles and the like).
        """
        return structured(CONTACT, self._world.contacts())

    def proximities(self) -> NDArray[Any]:
        """The pairs with a margin that intersect or are within it: a structured array (m,) like `proximity_events`."""
        return structured(EVENT, self._world.proximities())

    def cast_rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        max_time: float = np.inf,
        *,
        solid: bool = True,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> WorldHit:
        """The first object that each ray meets.

        origins, directions: (D,) or (n, D); times are in units of the length of a direction. solid: rays that begin inside an
        object hit it at once; otherwise where they leave it.

        >>> from impinge import *
        >>> world = World()
        >>> ball = world.add(Ball(1), None)
        >>> world.cast_rays([[-3, 0, 0], [-3, 5, 0]], [1, 0, 0]).time.tolist()
        [2.0, inf]
        """
        question = Question("ray_hit", limit(max_time, "max_time"), solid=bool(solid))
        handle, time, normal = self._ask(question, [origins, directions], filter, threads, progress)
        return WorldHit(time, normal, handle)

    def ray_hits(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        max_time: float = np.inf,
        *,
        solid: bool = True,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> HitRows:
        """All objects that each ray meets, each where it is met first; arguments as of `cast_rays`.

        >>> from impinge import *
        >>> world = World()
        >>> balls = world.add(Ball(1), Poses([[0, 0, 0], [5, 0, 0]]))
        >>> world.ray_hits([-3, 0, 0], [1, 0, 0]).time.tolist()
        [2.0, 7.0]
        """
        question = Question("ray_hits", limit(max_time, "max_time"), solid=bool(solid))
        return HitRows(*self._ask(question, [origins, directions], filter, threads, progress))

    def cast_shape(
        self,
        shape: Any,
        poses: Any,
        velocities: ArrayLike,
        max_time: float = np.inf,
        target_distance: float = 0.0,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> WorldImpact:
        """The first object that each moving shape comes within `target_distance` of; it does not turn.

        velocities: (D,) or (n, D), lengths per unit of time; the rest as of `impinge.impact`.

        >>> from impinge import *
        >>> world = World()
        >>> ball = world.add(Ball(1), None)
        >>> world.cast_shape(Ball(1), Poses([-4, 0, 0]), [2, 0, 0]).time.tolist()
        [1.0]
        """
        question = Question("cast", limit(max_time, "max_time"), limit(target_distance, "target_distance"))
        found = self._ask(question, [shape, poses, velocities], filter, threads, progress)
        handle, time, normal, point1, point2 = found
        return WorldImpact(time, normal, handle, point1, point2)

    def cast_shape_all(
        self,
        shape: Any,
        poses: Any,
        velocities: ArrayLike,
        max_time: float = np.inf,
        target_distance: float = 0.0,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> ImpactRows:
        """All objects that each moving shape meets on its way; arguments as of `cast_shape`."""
        question = Question("casts", limit(max_time, "max_time"), limit(target_distance, "target_distance"))
        return ImpactRows(*self._ask(question, [shape, poses, velocities], filter, threads, progress))

    def nearest(
        self,
        shape: Any,
        poses: Any,
        count: int = 1,
        max_distance: float = np.inf,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NearRows:
        """For each placed shape the nearest objects, at most `count` of them and at most `max_distance` away.

        >>> from impinge import *
        >>> world = World()
        >>> balls = world.add(Ball(1), Poses([[4, 0, 0], [9, 0, 0]]))
        >>> world.nearest(Ball(1), None, count=2).distance.tolist()
        [2.0, 7.0]
        """
        question = Question("near", limit(max_distance, "max_distance"), wanted=count_of(count))
        return NearRows(*self._ask(question, [shape, poses], filter, threads, progress))

    def within(
        self,
        shape: Any,
        poses: Any,
        distance: float,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NearRows:
        """For each placed shape all objects at most `distance` away, the nearest first."""
        question = Question("near", limit(distance, "distance"))
        return NearRows(*self._ask(question, [shape, poses], filter, threads, progress))

    def overlapping(
        self,
        shape: Any,
        poses: Any,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Rows:
        """For each placed shape the objects that it touches, in order of handles.

        >>> from impinge import *
        >>> world = World()
        >>> balls = world.add(Ball(1), Poses([[0, 0, 0], [1, 0, 0], [9, 0, 0]]))
        >>> world.overlapping(Ball(0.5), None).handle.tolist()
        [0, 1]
        """
        return Rows(*self._ask(Question("overlapping"), [shape, poses], filter, threads, progress))

    def overlaps_any(
        self,
        shape: Any,
        poses: Any,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NDArray[np.bool_]:
        """Whether each placed shape touches an object: bools (n,). Quicker than `overlapping`."""
        found = self._ask(Question("overlaps_any"), [shape, poses], filter, threads, progress)
        return np.asarray(found[-1])

    def containing(
        self,
        points: ArrayLike,
        *,
        surface: bool = False,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Rows:
        """For each point (D,) or (n, D) the objects that hold it, in order of handles.

        Closed meshes in 3D and closed lines in 2D are solids here. ValueError names an object that the question is about
        whose mesh, line or height field is not closed, near or far: leave it out with `filter`, or have such objects asked as
        surfaces, which hold the points on them, with `surface=True`.

        >>> from impinge import *
        >>> world = World(dim=2)
        >>> room = world.add(Polyline([[0, 0], [4, 0], [4, 4], [0, 4]], [[0, 1], [1, 2], [2, 3], [3, 0]]), None)
        >>> world.containing([[2, 2], [5, 2]]).handle.tolist()
        [0]
        """
        question = Question("containing", surface=bool(surface))
        return Rows(*self._ask(question, [points], filter, threads, progress))

    def project_points(
        self,
        points: ArrayLike,
        max_distance: float = np.inf,
        *,
        solid: bool = True,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> WorldProjection:
        """For each point (D,) or (n, D) the nearest point on an object; one inside is its own if `solid`.

        >>> from impinge import *
        >>> world = World()
        >>> ball = world.add(Ball(1), None)
        >>> world.project_points([3, 0, 0]).point.tolist()
        [[1.0, 0.0, 0.0]]
        """
        question = Question("project", limit(max_distance, "max_distance"), solid=bool(solid))
        handle, point, is_inside = self._ask(question, [points], filter, threads, progress)
        return WorldProjection(point, is_inside, handle)

    def nearest_to_points(
        self,
        points: ArrayLike,
        count: int = 1,
        max_distance: float = np.inf,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NearRows:
        """For each point (D,) or (n, D) the nearest objects, at most `count` and at most `max_distance` away."""
        question = Question("nearest_to_points", limit(max_distance, "max_distance"), wanted=count_of(count))
        return NearRows(*self._ask(question, [points], filter, threads, progress))

    def in_boxes(
        self,
        mins: ArrayLike,
        maxs: ArrayLike,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Rows:
        """For each axis-aligned box the objects whose boxes meet it: corners mins and maxs, (D,) or (n, D).

        ValueError names the row of a box whose least corner is above its greatest.
        """
        return Rows(*self._ask(Question("in_boxes"), [mins, maxs], filter, threads, progress))

    def _ask(
        self,
        question: Question,
        given: list[Any],
        filter: Filter | None,
        threads: int | None,
        progress: Progress | None,
    ) -> Any:
        if filter is not None and not isinstance(filter, Filter):
            raise TypeError(f"filter is {type(filter).__name__}, where an impinge.Filter is needed")
        return self._world.ask(question, given, filter, threads, progress)

    def _picture(self, view: View) -> tuple[str, bytes]:
        return self._world.picture(view)

    def _repr_html_(self) -> str:
        return html_of(self)

    def __repr__(self) -> str:
        return f"<impinge.World of {len(self)} objects, {self.dim}D {self.dtype}>"
