"""Tiles: a division of space into regions with about equally many objects, to compute the pairs of a large scene in many
processes."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge import _native
from impinge._poses import DType, DTypeName, dtype_name
from impinge._results import Floats, Indices


class TileRows(NamedTuple):
    """Lists of tiles. The tiles of object i are `tile[starts[i]:starts[i + 1]]`."""

    starts: NDArray[np.int64]
    tile: Indices


class Tiles:
    """A division of space into tiles, with the clearance of the pairs; `tiles` creates it.

    It consists of plain numbers, from which another process can create an equal value; it pickles. axes: (t - 1,) integers, the
    axis perpendicular to each cut. cuts: (t - 1,), its position. Each cut comes before the cuts of its two parts, and those of
    the lower part come first. The attributes `axes`, of uint32, and `cuts` are read-only copies.

    >>> import impinge
    >>> tiles = impinge.Tiles([0, 1], [2.5, 0.0], dim=2)
    >>> len(tiles), tiles.owner([[0, 7], [3, -1], [3, 0]]).tolist()
    (3, [0, 1, 2])
    """

    def __init__(
        self, axes: ArrayLike, cuts: ArrayLike, *, clearance: float = 0.0, dim: int = 3, dtype: DType = "float64"
    ) -> None:
        self.axes: Indices = _fixed(_axes(axes, dim))
        self.clearance, self.dim = float(clearance), dim
        self.dtype: DTypeName = dtype_name(dtype)
        self.cuts: Floats = _fixed(_column(cuts, self.dtype, "cuts"))
        # The library rejects invalid tiles.
        self._bounds = _native.tile_bounds(self)

    def __len__(self) -> int:
        return len(self._bounds)

    @property
    def bounds(self) -> Floats:
        """The lower and the upper corner of each tile, infinite at the outside: (t, 2, D)."""
        return self._bounds.copy()

    def meeting(self, boxes: ArrayLike) -> TileRows:
        """Returns the tiles of each object: all tiles that its box, enlarged by half the clearance, overlaps.

        boxes: (n, 2, D) of `impinge.boxes`. An object with a box of NaN has no tile; a huge object may be in all tiles.

        >>> import impinge
        >>> impinge.Tiles([0], [2.5]).meeting(impinge.boxes(impinge.Ball(1), impinge.Poses([[0, 0, 0], [2, 0, 0]])))
        TileRows(starts=array([0, 1, 3]), tile=array([0, 0, 1], dtype=uint32))
        """
        return TileRows(*_native.tiles_meeting(self, _boxes(boxes, self.dim, self.dtype)))

    def owner(self, points: ArrayLike) -> Indices:
        """Returns the tile that contains each point (n, D). A point on a cut is in the upper part."""
        return _native.tile_owners(self, points)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Tiles):
            return NotImplemented
        mine, theirs = (
            (tiles.dim, tiles.dtype, tiles.clearance, tiles.axes.tolist(), tiles.cuts.tolist())
            for tiles in (self, other)
        )
        return mine == theirs

    def __hash__(self) -> int:
        return hash((self.dim, self.dtype, self.clearance, self.cuts.tobytes()))

    def __reduce__(self) -> tuple[object, ...]:
        # As plain numbers, because arrays received from a network may be unaligned in memory.
        return (_read, (self.axes.tolist(), self.cuts.tolist(), self.clearance, self.dim, self.dtype))

    def __repr__(self) -> str:
        return f"<impinge.Tiles of {len(self)} tiles, {self.dim}D {self.dtype}>"


def _read(axes: list[int], cuts: list[float], clearance: float, dim: int, dtype: DType) -> Tiles:
    return Tiles(axes, cuts, clearance=clearance, dim=dim, dtype=dtype)


def tiles(boxes: ArrayLike, number: int, *, clearance: float = 0.0) -> Tiles:
    """Cuts space into tiles with about equally many objects in each.

    boxes: (n, 2, D) of `impinge.boxes`, of all objects or of a sample of some hundred for each tile; of float32 for shapes of
    float32. clearance: the largest distance of pairs. The tiles depend on the arguments alone. The pairs do not depend on the
    tiles: a poor sample only costs time. ValueError names the row of an invalid box.

    >>> import impinge, numpy as np
    >>> poses = impinge.Poses(np.random.default_rng(1).normal(size=(1000, 3)) ** 3)
    >>> found = impinge.tiles(impinge.boxes(impinge.Ball(0.01), poses), 8)
    >>> counts = np.bincount(found.meeting(impinge.boxes(impinge.Ball(0.01), poses)).tile)
    >>> len(found), bool(counts.max() < 2 * counts.mean())
    (8, True)
    """
    array = np.asarray(boxes)
    dtype: DType = "float32" if array.dtype == np.float32 else "float64"
    dim = array.shape[-1] if array.ndim == 3 and array.shape[-1] in (2, 3) else 3
    axes, cuts = _native.tile_cuts(_boxes(array, dim, dtype), number, clearance, dim, dtype_name(dtype))
    return Tiles(axes, cuts, clearance=clearance, dim=dim, dtype=dtype)


def _boxes(given: ArrayLike, dim: int, dtype: DType) -> Floats:
    array = np.require(given, dtype=dtype, requirements=["C", "A"])
    if array.ndim != 3 or array.shape[1:] != (2, dim):
        raise ValueError(f"boxes has the shape {array.shape}, where (n, 2, {dim}) is needed in {dim}D")
    return array


def _column(given: ArrayLike, dtype: Any, name: str) -> NDArray[Any]:
    array = np.require(given, dtype=dtype, requirements=["C", "A"])
    if array.ndim != 1:
        raise ValueError(f"{name} has the shape {array.shape}, where (n,) is needed")
    return array


def _fixed(column: NDArray[Any]) -> NDArray[Any]:
    """Returns a read-only copy, which does not change with an array of the caller."""
    copied = column.copy()
    copied.flags.writeable = False
    return copied


def _integers(given: ArrayLike, name: str) -> NDArray[Any]:
    """Converts an argument to an array (n,). Its elements are integers; an empty array may have another type."""
    array = _column(given, None, name)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"{name} is {array.dtype}, where integers are needed")
    return array


def _axes(given: ArrayLike, dim: int) -> Indices:
    """Converts an argument with axes of cuts to an array (n,)."""
    array = _integers(given, "axes")
    wrong = (array < 0) | (array >= dim)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(f"axes[{row}] is {array[row]}, where 0 to {dim - 1} is needed in {dim}D")
    return _column(array, np.uint32, "axes")


def ids(given: ArrayLike) -> NDArray[np.uint64]:
    """Converts an argument with ids of objects to an array (n,)."""
    array = _integers(given, "ids")
    if array.size and array.min() < 0:
        row = int(np.argmax(array < 0))
        raise ValueError(f"ids[{row}] is {array[row]}, where 0 or more is needed")
    return _column(array, np.uint64, "ids")
