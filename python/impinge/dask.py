"""Queries by many processes or machines with Dask: many poses against one scene, and the pairs of a scene that is too large
for one machine.

    from impinge.dask import ask_scene, self_join

`ask_scene` and `self_join` are recipes on top of the functions of `impinge`. Tasks are pure, so Dask can repeat the tasks of a
lost worker. They run on the current `distributed.Client`, otherwise on the threads of Dask. `pip install 'impinge[dask]'`
installs the dependencies.
"""

from __future__ import annotations

import os
import shutil
import uuid
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, overload

import numpy as np
import pyarrow as pa  # type: ignore[import-untyped, unused-ignore]
import pyarrow.compute as pc  # type: ignore[import-untyped, unused-ignore]
import pyarrow.dataset as ds  # type: ignore[import-untyped, unused-ignore]
import pyarrow.parquet as pq  # type: ignore[import-untyped, unused-ignore]
from dask.base import compute
from dask.delayed import delayed
from numpy.typing import ArrayLike, DTypeLike, NDArray

from impinge._native import boxes, pairs_in_tile
from impinge._poses import Poses
from impinge._scene import Scene
from impinge._shapes import Picked
from impinge._tiles import Tiles, tiles as cut_tiles
from impinge._world import World

if TYPE_CHECKING:
    from dask.array import Array
    from dask.dataframe import DataFrame, Series

    Source: TypeAlias = str | os.PathLike[str] | list[str]

# The block is `Any`: the type of the rows does not determine its type, an array of some dtype or a DataFrame.
Question: TypeAlias = Callable[[World, Any], ArrayLike]


@overload
def ask_scene(question: Question, scene: Scene, rows: Array, *, dtype: DTypeLike = "float64") -> Array: ...
@overload
def ask_scene(question: Question, scene: Scene, rows: DataFrame | Source, *, dtype: DTypeLike = "float64") -> Series: ...
def ask_scene(
    question: Question, scene: Scene, rows: Array | DataFrame | Source, *, dtype: DTypeLike = "float64"
) -> Array | Series:
    """Runs a function for blocks of rows, such as poses or configurations of a robot, with the world of a scene.

    rows: a Dask Array (n, ...), a Dask DataFrame, or a path or paths of Parquet files. question(world, block): gets the scene
    as a `World`, which each process builds once and caches with the bytes of the scene as key, and a NumPy array (m, ...) or a
    pandas DataFrame of m rows; returns an array (m,) of dtype `dtype`. Threads share the world, so `question` must not change
    it.

    Returns a Dask Array (n,), or a Dask Series with the index of the DataFrame, in the order of the rows. The result is not
    computed yet.

    >>> import dask.array, impinge
    >>> from impinge.dask import ask_scene
    >>> scene = impinge.Scene([impinge.Ball(1)] * 2, impinge.Poses([[0, 0, 0], [5, 0, 0]]))
    >>> poses = impinge.Poses([[-3, 0, 0], [2.5, 0, 0], [9, 0, 0]]).matrices
    >>> near = lambda world, poses: world.nearest(impinge.Ball(0.5), poses).distance
    >>> ask_scene(near, scene, dask.array.from_array(poses, chunks=(2, 4, 4))).compute().tolist()
    [1.5, 1.0, 2.5]
    """
    shared = delayed(scene)
    # The methods of Dask are not typed.
    given: Any = rows
    if isinstance(given, (str, os.PathLike, list)):
        import dask.dataframe

        given = dask.dataframe.read_parquet(given)
    if hasattr(given, "map_partitions"):
        series: Series = given.map_partitions(_ask_frame, question, shared, meta=(None, dtype))
        return series
    if not hasattr(given, "map_blocks"):
        raise TypeError(f"rows is no Dask Array, Dask DataFrame or path: {type(given).__name__}")
    whole = given.rechunk({axis: -1 for axis in range(1, given.ndim)})
    inner = list(range(1, given.ndim))
    array: Array = whole.map_blocks(
        _ask, question=question, scene=shared, dtype=dtype, drop_axis=inner, meta=np.empty(0, dtype)
    )
    return array


def self_join(
    source: str | os.PathLike[str] | Sequence[str],
    shapes: Scene,
    output: str | os.PathLike[str],
    *,
    clearance: float = 0.0,
    number_of_tiles: int = 64,
    sample: int = 200_000,
) -> int:
    """Writes all pairs of objects whose distance is at most `clearance`, out of core, and returns their number.

    source: Parquet as a file, files or a folder, with the columns of `objects_table`: `id` (integers of 0 or more, all
    different), `shape` (the index of an object of `shapes`, whose own poses are ignored), `pose` ((D+1)**2 numbers, a matrix
    row by row, or D+1 lists of D+1 numbers, as pandas writes a column of matrices). output: a folder, which is created and
    which all workers can access. Its files `part-*.parquet` have the columns `id1` < `id2` (uint64), sorted across all parts.

    The bytes of the output depend on `source`, `shapes`, `clearance` and `sample` alone, not on the number of tiles or
    workers, or on workers that die. `impinge.pairs_within` in one process finds the same pairs. About `sample` objects define
    the tiles. The rows are read twice, one row group at a time. A worker holds one row group, or one tile with its pairs, or
    one part of the output. Intermediate files are in a folder beside the output with the suffix `.scratch`, which is removed
    at the end.

    ValueError names a column that is missing, has nulls or a wrong type, and a shape that does not exist. FileExistsError if
    the output exists.
    """
    output = Path(output)
    if output.exists():
        raise FileExistsError(f"there is an output: {output}")
    units = _row_groups(source, shapes.dim)
    scratch = output.with_name(output.name + ".scratch")
    # Intermediate files of a process that died.
    shutil.rmtree(scratch, ignore_errors=True)
    try:
        return _join(units, shapes, scratch, output, _Options(clearance, number_of_tiles, sample))
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


class _Options(NamedTuple):
    clearance: float
    number_of_tiles: int
    sample: int


def _join(units: list[Any], shapes: Scene, scratch: Path, output: Path, options: _Options) -> int:
    starts = np.cumsum([0, *(unit.count_rows() for unit in units)])
    shared = delayed(shapes)

    step = max(1, int(starts[-1]) // max(1, options.sample))
    sampled = _run(_sample, [(unit, int(start), shared, step) for unit, start in zip(units, starts, strict=False)])
    picked = np.concatenate([found for _, found in sampled] or [np.empty((0, 2, shapes.dim), shapes.dtype)])
    tiles = cut_tiles(picked, options.number_of_tiles, clearance=options.clearance)
    firsts = _even_ranges([found for found, _ in sampled], len(units))

    _run(_share_out, [(unit, number, shared, tiles, scratch) for number, unit in enumerate(units)])
    found = _run(_join_tile, [(tile, shared, tiles, firsts, scratch) for tile in range(len(tiles))])
    _run(_merge, [(number, scratch, output) for number in range(len(firsts) + 1)])
    return int(sum(found))


def objects_table(ids: ArrayLike, picks: ArrayLike, poses: ArrayLike | Poses) -> pa.Table:
    """Returns objects as a table of pyarrow, which can be written as Parquet for `self_join`.

    ids: (n,) integers. picks: (n,) integers, the index of the shape of each object. poses: (n, D+1, D+1), or `Poses`.

    >>> import impinge
    >>> from impinge.dask import objects_table
    >>> objects_table([7, 9], [0, 0], impinge.Poses([[1, 2], [3, 4]])).schema.names
    ['id', 'shape', 'pose']
    """
    matrices = np.ascontiguousarray(poses.matrices if isinstance(poses, Poses) else poses)
    flat = pa.FixedSizeListArray.from_arrays(pa.array(matrices.reshape(-1)), int(np.prod(matrices.shape[1:])))
    columns = [pa.array(np.asarray(ids, np.uint64)), pa.array(np.asarray(picks, np.uint32)), flat]
    return pa.table(columns, ["id", "shape", "pose"])


@lru_cache(maxsize=4)
def _world(scene: Scene) -> World:
    world = World(dim=scene.dim, dtype=scene.dtype)
    world.add(scene.shapes, scene.poses)
    world.update()
    return world


def _ask(block: Any, question: Question, scene: Scene) -> NDArray[Any]:
    if isinstance(block, np.ndarray):
        # Arrays received over a network may be unaligned.
        block = np.require(block, requirements=["C", "A"])
    found = np.asarray(question(_world(scene), block))
    if found.shape != (len(block),):
        raise ValueError(f"the answer has the shape {found.shape}, where ({len(block)},) is needed")
    return found


def _ask_frame(frame: Any, question: Question, scene: Scene) -> Any:
    import pandas as pd  # type: ignore[import-untyped, unused-ignore]

    return pd.Series(_ask(frame, question, scene), index=frame.index)


def _run(task: Callable[..., Any], arguments: Sequence[tuple[Any, ...]]) -> tuple[Any, ...]:
    """Runs a task for each tuple of arguments, in any order and on any worker; returns the results in order."""
    tasks = [delayed(task, pure=False)(*given) for given in arguments]
    results: tuple[Any, ...] = compute(*tasks)  # type: ignore[no-untyped-call, unused-ignore]
    return results


def _row_groups(source: Any, dim: int) -> list[Any]:
    dataset = ds.dataset(os.fspath(source) if isinstance(source, os.PathLike) else source, format="parquet")
    for name in ("id", "shape", "pose"):
        if name not in dataset.schema.names:
            raise ValueError(f"the source lacks the column {name!r}: it has {dataset.schema.names}")
    kind, depth = dataset.schema.field("pose").type, 0
    leaf = kind
    while _is_list(leaf):
        leaf, depth = leaf.value_type, depth + 1
    is_number = pa.types.is_floating(leaf) or pa.types.is_integer(leaf)
    size = getattr(kind, "list_size", None)
    if depth not in (1, 2) or not is_number or (depth == 1 and size not in (None, (dim + 1) ** 2)):
        needed = f"a list of {(dim + 1) ** 2} numbers, or of {dim + 1} rows,"
        raise ValueError(f"the column 'pose' is {kind}, where {needed} is needed in {dim}D")
    return [group for fragment in dataset.get_fragments() for group in fragment.split_by_row_group()]


def _read(table: pa.Table, shapes: Scene) -> tuple[NDArray[np.uint64], Picked, NDArray[Any]]:
    """Returns the ids, shapes and poses of a table."""
    for name in ("id", "shape", "pose"):
        if table[name].null_count:
            raise ValueError(f"the column {name!r} has nulls")
    ids = table["id"].cast(pa.uint64()).to_numpy()
    poses = _matrices(table["pose"], shapes.dim + 1)
    return ids, Picked(shapes.shapes, table["shape"].to_numpy()), poses


def _is_list(kind: Any) -> bool:
    return bool(pa.types.is_list(kind) or pa.types.is_large_list(kind) or pa.types.is_fixed_size_list(kind))


def _matrices(column: Any, width: int) -> NDArray[Any]:
    """Returns the matrices (n, width, width) of a column of lists of all their numbers, or of lists of rows."""
    levels = []
    while _is_list(column.type):
        levels.append(pc.list_value_length(column).to_numpy())
        column = pc.list_flatten(column)
    wanted = [width * width] if len(levels) == 1 else [width, width]
    for lengths, length in zip(levels, wanted, strict=True):
        wrong = ~(lengths == length)
        if wrong.any():
            row = int(np.argmax(wrong))
            place = f"row {row}" if lengths is levels[0] else f"row {row // width}, list {row % width},"
            raise ValueError(f"the column 'pose' has {lengths[row]} numbers or lists in {place} where {length} are needed")
    if column.null_count:
        raise ValueError("the column 'pose' has nulls")
    numbers: NDArray[Any] = np.require(column.to_numpy(), requirements=["C", "A"])
    return numbers.reshape(-1, width, width)


def _sample(unit: Any, start: int, shapes: Scene, step: int) -> tuple[NDArray[np.uint64], NDArray[Any]]:
    """Returns the ids and boxes of a random sample, about one of `step` rows; `start` is the index of the first row."""
    table = unit.to_table(columns=["id", "shape", "pose"])
    # Random rows, because rows of a grid are periodic.
    ids, picked, poses = _read(table.take(np.flatnonzero(_noise(start, len(table)) % step == 0)), shapes)
    return ids, boxes(picked, poses, threads=1)


def _noise(start: int, count: int) -> NDArray[np.uint64]:
    """Returns pseudorandom numbers for rows, equal on every worker: SplitMix64 (Steele, Lea and Flood 2014)."""
    bits = np.arange(start + 1, start + count + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return bits ^ (bits >> np.uint64(31))


def _even_ranges(ids: list[NDArray[np.uint64]], parts: int) -> NDArray[np.uint64]:
    """Returns the first id of each part of the output but the first; the ids do not depend on the tiles."""
    every = np.sort(np.concatenate(ids or [np.empty(0, np.uint64)]))
    return every[np.arange(1, parts) * len(every) // parts] if len(every) else every


def _share_out(unit: Any, number: int, shapes: Scene, tiles: Tiles, scratch: Path) -> None:
    """Writes the objects of a row group to the folders of their tiles."""
    table = unit.to_table(columns=["id", "shape", "pose"])
    _, picked, poses = _read(table, shapes)
    rows = tiles.meeting(boxes(picked, poses, threads=1))
    objects = np.repeat(np.arange(len(table)), np.diff(rows.starts))[np.argsort(rows.tile, kind="stable")]
    _write_parts(table.take, objects, np.bincount(rows.tile, minlength=len(tiles)), scratch / "objects", number)


def _join_tile(tile: int, shapes: Scene, tiles: Tiles, firsts: NDArray[np.uint64], scratch: Path) -> int:
    """Writes the pairs of a tile to the folders of the parts of the output."""
    table = _read_parts(scratch / "objects", tile)
    if table is None:
        return 0
    ids, picked, poses = _read(table, shapes)
    pairs = pairs_in_tile(picked, poses, ids, tiles, tile, threads=1)
    parts = np.bincount(np.searchsorted(firsts, pairs[:, 0], side="right"), minlength=len(firsts) + 1)
    _write_parts(lambda chosen: _pairs_table(pairs[chosen]), np.arange(len(pairs)), parts, scratch / "pairs", tile)
    return len(pairs)


def _merge(number: int, scratch: Path, output: Path) -> None:
    """Writes a part of the output."""
    table = _read_parts(scratch / "pairs", number)
    pairs = np.empty((0, 2), np.uint64)
    if table is not None:
        pairs = np.stack([table["id1"].to_numpy(), table["id2"].to_numpy()], axis=1)
    _write(_pairs_table(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]), output / f"part-{number:05}.parquet")


def _pairs_table(pairs: NDArray[np.uint64]) -> pa.Table:
    return pa.table([pa.array(pairs[:, 0]), pa.array(pairs[:, 1])], ["id1", "id2"])


def _write_parts(
    take: Callable[[NDArray[Any]], pa.Table], rows: NDArray[Any], counts: NDArray[Any], folder: Path, number: int
) -> None:
    """Writes consecutive rows to the folders of their keys: `counts[k]` rows to the folder of key k, in ascending order of
    keys."""
    ends = np.cumsum(counts)
    for key in np.flatnonzero(counts):
        _write(take(rows[ends[key] - counts[key] : ends[key]]), folder / f"key={key}" / f"part-{number:05}.parquet")


def _read_parts(folder: Path, key: int) -> pa.Table | None:
    """Returns the rows that were written for a key, in the order of the parts; None if there are no rows."""
    paths = sorted((folder / f"key={key}").glob("part-*.parquet"))
    return pa.concat_tables([pq.read_table(path, partitioning=None) for path in paths]) if paths else None


def _write(table: pa.Table, path: Path) -> None:
    """Writes a file atomically: it is complete or absent, even if the process dies or two processes write it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f".{path.name}.{uuid.uuid4().hex}")
    pq.write_table(table, unfinished, compression="lz4")
    os.replace(unfinished, path)
