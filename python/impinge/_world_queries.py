"""Queries of worlds about many elements: rays, moving shapes, shapes, points and boxes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge import _native
from impinge._world_arguments import Filter, Question, count_of, limit
from impinge._world_results import (
    HitRows,
    ImpactRows,
    NearRows,
    Rows,
    WorldHit,
    WorldImpact,
    WorldProjection,
)

if TYPE_CHECKING:
    from impinge._native import PosesLike, Progress, Shapes


class WorldQueries:
    """The queries of `World`."""

    _world: _native.World

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
        """Returns the first object that each ray hits.

        origins, directions: (D,) or (n, D); times are in units of the length of a direction. solid: rays that begin inside an
        object hit it at time zero; otherwise where they leave it.

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
        """Returns all objects that each ray hits, each with its first hit; arguments as in `cast_rays`.

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
        shape: Shapes,
        poses: PosesLike,
        velocities: ArrayLike,
        max_time: float = np.inf,
        target_distance: float = 0.0,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> WorldImpact:
        """Returns the first object that each moving shape comes within `target_distance` of; the shape does not rotate.

        velocities: (D,) or (n, D), lengths per unit of time; other arguments as in `impinge.impact`.

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
        shape: Shapes,
        poses: PosesLike,
        velocities: ArrayLike,
        max_time: float = np.inf,
        target_distance: float = 0.0,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> ImpactRows:
        """Returns all objects that each moving shape hits on its path; arguments as in `cast_shape`."""
        question = Question("casts", limit(max_time, "max_time"), limit(target_distance, "target_distance"))
        return ImpactRows(*self._ask(question, [shape, poses, velocities], filter, threads, progress))

    def nearest(
        self,
        shape: Shapes,
        poses: PosesLike,
        count: int = 1,
        max_distance: float = np.inf,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NearRows:
        """Returns for each placed shape the nearest objects, at most `count` of them, within `max_distance`.

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
        shape: Shapes,
        poses: PosesLike,
        distance: float,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NearRows:
        """Returns for each placed shape all objects within `distance`, the nearest first."""
        question = Question("near", limit(distance, "distance"))
        return NearRows(*self._ask(question, [shape, poses], filter, threads, progress))

    def overlapping(
        self,
        shape: Shapes,
        poses: PosesLike,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Rows:
        """Returns for each placed shape the objects that it touches, in order of handles.

        >>> from impinge import *
        >>> world = World()
        >>> balls = world.add(Ball(1), Poses([[0, 0, 0], [1, 0, 0], [9, 0, 0]]))
        >>> world.overlapping(Ball(0.5), None).handle.tolist()
        [0, 1]
        """
        return Rows(*self._ask(Question("overlapping"), [shape, poses], filter, threads, progress))

    def overlaps_any(
        self,
        shape: Shapes,
        poses: PosesLike,
        *,
        filter: Filter | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NDArray[np.bool_]:
        """Whether each placed shape touches an object: bools (n,). Faster than `overlapping`."""
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
        """Returns for each point (D,) or (n, D) the objects that contain it, in order of handles.

        Closed meshes in 3D and closed polylines in 2D are solids here. ValueError names an object whose mesh, polyline or height
        field is not closed, near or far: exclude it by `filter`, or treat such objects as
        surfaces, which contain the points on them, by `surface=True`.

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
        """Returns for each point (D,) or (n, D) the nearest point on an object. If `solid`, a point inside an object is
        returned itself.

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
        """Returns for each point (D,) or (n, D) the nearest objects, at most `count`, within `max_distance`."""
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
        """Returns for each axis-aligned box, given by its corners `mins` and `maxs`, (D,) or (n, D), the objects whose
        bounding boxes overlap it.

        ValueError names the row of a box whose lower corner is above its upper corner.
        """
        return Rows(*self._ask(Question("in_boxes"), [mins, maxs], filter, threads, progress))

    def _ask(
        self,
        question: Question,
        given: Sequence[object],
        filter: Filter | None,
        threads: int | None,
        progress: Progress | None,
    ) -> list[NDArray[Any]]:
        if filter is not None and not isinstance(filter, Filter):
            raise TypeError(f"filter is {type(filter).__name__}, where an impinge.Filter is needed")
        return self._world.ask(question, given, filter, threads, progress)
