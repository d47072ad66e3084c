"""The configuration checker: bodies on moving frames, obstacles, and many configurations in one call."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._native import NativeChecker
from impinge._poses import DTypeName, matrices
from impinge._results import Floats, Indices
from impinge._world_arguments import limit as not_nan

if TYPE_CHECKING:
    from impinge._native import PosesLike, Progress, Shape

NO_BODY = 4294967295
"""The numbers of a pair that there is not."""


class Frame(NamedTuple):
    """A frame on a joint: its pose is `parent @ origin @ motion`.

    `parent` is the index of a frame, `None` for the world, and `origin` a matrix (D+1, D+1), `None` for the identity. A
    revolute joint rotates by radians about `axis` (D,); in 2D it needs no axis and rotates counter-clockwise. A prismatic
    joint translates along `axis`. The joint value is the value in `column` of the configuration times `factor`, plus
    `offset`.
    """

    parent: int | None = None
    origin: PosesLike = None
    joint: Literal["fixed", "revolute", "prismatic"] = "fixed"
    axis: ArrayLike | None = None
    column: int = 0
    factor: float = 1.0
    offset: float = 0.0


class NearestPairs(NamedTuple):
    """The smallest distance (n,) of each configuration, and its pair (n, 2); infinite and `NO_BODY` beyond the limit."""

    distance: Floats
    pair: Indices


class Checker:
    """Tests many configurations of a robot for collisions with itself and with obstacles.

    frames: a sequence of `Frame`. columns: the number of values of a configuration.
    shapes: the bodies, a sequence of b `Shape`; on: the frame of each (b,); poses: their poses in these frames,
    (b, D+1, D+1), or `None` for the identity. pairs (m, 2): the bodies that must not touch.

    Configurations are arrays (n, columns), or a single one (columns,); results have a row for each. A pair is two indices of
    bodies; obstacles have the indices from b on. The lower index comes first, and among several pairs the first is returned.
    A configuration that is not finite is not free, has the distance NaN and no pair.

    >>> import impinge, numpy as np
    >>> arm = [impinge.Frame(joint="revolute", axis=[0, 0, 1], column=0),
    ...        impinge.Frame(0, impinge.Poses([1, 0, 0]), "revolute", [0, 0, 1], column=1)]
    >>> ends = impinge.Poses([[1, 0, 0], [1, 0, 0]])
    >>> checker = impinge.Checker(arm, 2, [impinge.Ball(0.25)] * 2, [0, 1], ends, pairs=[[0, 1]])
    >>> checker.set_obstacles([impinge.Cuboid([0.5, 4, 4])], impinge.Poses([[3, 0, 0]]))
    >>> configurations = [[0, 0], [np.pi / 2, 0], [0, np.pi / 2]]
    >>> checker.is_free(configurations, clearance=0.3).tolist()
    [False, True, True]
    >>> checker.first_pair(configurations, clearance=0.3)[0].tolist()
    [1, 2]
    >>> round(float(checker.nearest(configurations[0]).distance[0]), 6)
    0.25

    A checker pickles with its obstacles.
    """

    def __init__(
        self,
        frames: Sequence[Frame],
        columns: int,
        shapes: Sequence[Shape] = (),
        on: Iterable[int] = (),
        poses: PosesLike = None,
        pairs: ArrayLike = (),
    ) -> None:
        bodies = list(shapes)
        self.dim = bodies[0].dim if bodies else 3
        self.dtype: DTypeName = bodies[0].dtype if bodies else "float64"
        self.columns = columns
        frame_of = [_index(frame, f"on[{row}]") for row, frame in enumerate(on)]
        if len(frame_of) != len(bodies):
            raise ValueError(f"on has {len(frame_of)} elements, where {len(bodies)} are needed")
        self._counts = (len(frames), len(bodies))
        placed, apart = self._poses(poses, len(bodies), "poses"), _pairs(pairs, "pairs")
        read = _columns(frames, self.dim, self.dtype)
        self._native = NativeChecker(self.dim, self.dtype, read, columns, (bodies, frame_of, placed), apart)
        # A copy, for pickles: the caller may change its arrays later.
        own = [
            frame._replace(origin=origin.copy(), axis=None if frame.axis is None else np.array(frame.axis))
            for frame, origin in zip(frames, read[1], strict=True)
        ]
        self._made_of = (own, columns, bodies, frame_of, placed.copy(), apart.copy())
        self._obstacles: tuple[Any, ...] | None = None

    def set_obstacles(self, shapes: Sequence[Shape], poses: PosesLike = None, ignored: ArrayLike = ()) -> None:
        """Replaces all obstacles by shapes (o,) at poses (o, D+1, D+1). `ignored` (m, 2) are pairs that may touch: the index
        of a body and that of an obstacle, from zero."""
        obstacles = list(shapes)
        placed = self._poses(poses, len(obstacles), "poses")
        may_touch = _pairs(ignored, "ignored")
        self._native.set_obstacles(obstacles, placed, may_touch)
        self._obstacles = (obstacles, placed.copy(), may_touch.copy())

    def __reduce__(self) -> tuple[object, ...]:
        """Pickles its arguments and its obstacles."""
        return (_unpickled, (self._made_of, self._obstacles))

    def frames(self, configurations: ArrayLike) -> Floats:
        """The poses of all frames: (n, frames, D+1, D+1), or (frames, D+1, D+1)."""
        return self._placed(configurations, False)

    def poses(self, configurations: ArrayLike) -> Floats:
        """The poses of all bodies: (n, b, D+1, D+1), or (b, D+1, D+1)."""
        return self._placed(configurations, True)

    def is_free(
        self,
        configurations: ArrayLike,
        clearance: float = 0.0,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NDArray[np.bool_]:
        """Whether all pairs are farther apart than `clearance`; with clearance 0, whether no pair touches: (n,)."""
        free: NDArray[np.bool_] = self._ask("free", configurations, not_nan(clearance, "clearance"), threads, progress)[0]
        return free

    def first_pair(
        self,
        configurations: ArrayLike,
        clearance: float = 0.0,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Indices:
        """The first pair whose distance is at most `clearance`: (n, 2); `NO_BODY` twice for a free configuration."""
        pair: Indices = self._ask("pair", configurations, not_nan(clearance, "clearance"), threads, progress)[1]
        return pair.reshape(-1, 2)

    def nearest(
        self,
        configurations: ArrayLike,
        limit: float = math.inf,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NearestPairs:
        """The nearest pair and its distance, up to `limit`; 0 if the pair touches: `NearestPairs(distance, pair)`."""
        _, pair, distance = self._ask("nearest", configurations, not_nan(limit, "limit"), threads, progress)
        return NearestPairs(distance, pair.reshape(-1, 2))

    def _ask(
        self,
        question: str,
        configurations: ArrayLike,
        limit: float,
        threads: int | None,
        progress: Progress | None,
    ) -> list[NDArray[Any]]:
        rows = np.atleast_2d(self._rows(configurations))
        return self._native.ask(question, rows.reshape(-1), limit, len(rows), threads, progress)

    def _placed(self, configurations: ArrayLike, of_bodies: bool) -> Floats:
        rows = self._rows(configurations)
        size = self.dim + 1
        count = self._counts[of_bodies]
        if self.columns:
            poses = self._native.place(rows.reshape(-1), of_bodies)
        else:
            # Without columns the poses are the same for all configurations.
            poses = np.tile(self._native.place(rows.reshape(-1), of_bodies), (math.prod(rows.shape[:-1]), 1, 1))
        return poses.reshape(*rows.shape[:-1], count, size, size)

    def _rows(self, configurations: ArrayLike) -> Floats:
        rows = np.require(configurations, dtype=self.dtype, requirements=["C", "A"])
        if rows.ndim not in (1, 2) or rows.shape[-1] != self.columns:
            need = f"({self.columns},) or (n, {self.columns})"
            raise ValueError(f"configurations has the shape {rows.shape}, where {need} is needed")
        return rows

    def _poses(self, poses: PosesLike, count: int, name: str) -> Floats:
        size = self.dim + 1
        if poses is None:
            return np.tile(np.eye(size, dtype=self.dtype), (count, 1, 1))
        array = np.asarray(matrices(poses, self.dim, self.dtype, name)).reshape(-1, size, size)
        if len(array) != count:
            raise ValueError(f"{name} has {len(array)} elements, where {count} are needed")
        return array


def _unpickled(made_of: tuple[Any, ...], obstacles: tuple[Any, ...] | None) -> Checker:
    """Restores the checker of `Checker.__reduce__`."""
    checker = Checker(*made_of)
    if obstacles is not None:
        checker.set_obstacles(*obstacles)
    return checker


def _pairs(pairs: ArrayLike, name: str) -> Indices:
    array = np.asarray(pairs)
    if array.size == 0:
        return np.zeros((0, 2), dtype=np.uint32)
    if array.ndim != 2 or array.shape[1] != 2 or not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"{name} is {array.dtype} of the shape {array.shape}, where (m, 2) integers are needed")
    wrong = ((array < 0) | (array >= NO_BODY)).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(f"{name}[{row}] is {array[row].tolist()}, where indices from 0 to {NO_BODY - 1} are needed")
    return np.ascontiguousarray(array, dtype=np.uint32)


def _index(value: SupportsIndex, name: str) -> int:
    """Converts an index to `int`. TypeError names a value that is not an integer, ValueError a negative one."""
    try:
        index = operator.index(value)
    except TypeError as error:
        raise TypeError(f"{name} is {value!r}, where an integer is needed") from error
    if index < 0:
        raise ValueError(f"{name} is {index}: it is not negative")
    return index


def _columns(frames: Sequence[Frame], dim: int, dtype: str) -> tuple[Any, ...]:
    """Converts frames to the arguments of the native class."""
    count, size = len(frames), dim + 1
    origins = np.tile(np.eye(size, dtype=dtype), (count, 1, 1))
    generators, axes, factors = np.zeros((count, dim * dim)), np.zeros((count, dim)), np.zeros((count, 2))
    parents, columns = [], []
    for number, frame in enumerate(frames):
        parents.append(-1 if frame.parent is None else _index(frame.parent, f"frames[{number}].parent"))
        columns.append(-1 if frame.joint == "fixed" else _index(frame.column, f"frames[{number}].column"))
        if frame.origin is not None:
            origins[number] = np.asarray(matrices(frame.origin, dim, dtype, f"frames[{number}].origin")).reshape(size, size)
        factors[number] = frame.factor, frame.offset
        if frame.joint == "prismatic":
            axes[number] = _unit(frame, number, dim)
        elif frame.joint == "revolute":
            generators[number] = _generator(frame, number, dim)
        elif frame.joint != "fixed":
            raise ValueError(f"frames[{number}] has the joint {frame.joint!r}")
    return parents, origins, columns, generators, axes, factors


def _generator(frame: Frame, number: int, dim: int) -> NDArray[np.float64]:
    """The matrix of the cross product with the axis, x -> axis × x, row by row."""
    if dim == 2:
        return np.array([0.0, -1.0, 1.0, 0.0])
    x, y, z = _unit(frame, number, dim)
    return np.array([0.0, -z, y, z, 0.0, -x, -y, x, 0.0])


def _unit(frame: Frame, number: int, dim: int) -> NDArray[np.float64]:
    axis = np.zeros(0) if frame.axis is None else np.asarray(frame.axis, dtype=np.float64)
    length = float(np.linalg.norm(axis))
    if axis.shape != (dim,) or not (math.isfinite(length) and length > 0):
        raise ValueError(f"frames[{number}] has the axis {axis.tolist()}")
    unit: NDArray[np.float64] = axis / length
    return unit
