"""Checks arguments of worlds: groups, filters, handles and queries."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._world_results import Handles

GROUPS = 30


class Filter:
    """The objects that a query of a `World` considers: all, except those that are excluded here.

    membership, whitelist, blacklist: indices of the groups, 0 to 29, of the query, as in `World.add`. exclude: handles of excluded
    objects, for instance the object that makes the query.

    >>> import impinge
    >>> world = impinge.World()
    >>> balls = world.add(impinge.Ball(1), impinge.Poses([[0, 0, 0], [5, 0, 0]]))
    >>> others = impinge.Filter(exclude=balls[:1])
    >>> bool(world.cast_rays([0, 0, 0], [1, 0, 0], filter=others).handle[0] == balls[1])
    True
    """

    def __init__(
        self,
        *,
        membership: Sequence[int] | None = None,
        whitelist: Sequence[int] | None = None,
        blacklist: Sequence[int] | None = None,
        exclude: ArrayLike = (),
    ) -> None:
        self.groups = groups_of(membership, whitelist, blacklist)
        self.exclude = handles_of(exclude, "exclude")

    def __repr__(self) -> str:
        return f"impinge.Filter({self.groups}, {len(self.exclude)} excluded)"


class Query(NamedTuple):
    prediction: float
    margin: float | None


class Groups(NamedTuple):
    membership: list[int] | None
    whitelist: list[int] | None
    blacklist: list[int] | None


class Options(NamedTuple):
    query: Query
    groups: Groups


class Question(NamedTuple):
    name: str
    limit: float = np.inf
    target_distance: float = 0.0
    wanted: int | None = None
    solid: bool = True
    surface: bool = False


def groups_of(
    membership: Sequence[int] | None, whitelist: Sequence[int] | None, blacklist: Sequence[int] | None
) -> Groups:
    return Groups(
        _group_list(membership, "membership"), _group_list(whitelist, "whitelist"), _group_list(blacklist, "blacklist")
    )


def _group_list(given: Sequence[int] | None, name: str) -> list[int] | None:
    if given is None:
        return None
    array = np.asarray(given)
    if array.size and (array.ndim != 1 or not np.issubdtype(array.dtype, np.integer)):
        raise TypeError(f"{name} is {array.dtype} of the shape {array.shape}, where (n,) integers are needed")
    for row, group in enumerate(array.tolist()):
        if not 0 <= group < GROUPS:
            raise ValueError(f"{name}[{row}] is {group}: groups are 0 to {GROUPS - 1}")
    return [int(group) for group in array.tolist()]


def limit(value: float, name: str) -> float:
    if value != value:
        raise ValueError(f"{name} is nan")
    return value


def count_of(value: int) -> int:
    if not isinstance(value, int | np.integer):
        raise TypeError(f"count is {type(value).__name__}, where an integer is needed")
    if value < 0:
        raise ValueError(f"count is {value}: it is not negative")
    return int(value)


def handles_of(given: ArrayLike, name: str = "handles") -> Handles:
    array = np.atleast_1d(np.asarray(given))
    if array.size == 0:
        return np.empty(0, dtype=np.uint64)
    if array.ndim != 1 or not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"{name} is {array.dtype} of the shape {array.shape}, where (n,) integers are needed")
    if (array < 0).any():
        row = int(np.argmax(array < 0))
        raise ValueError(f"{name}[{row}] is {array[row]}: there is no such object")
    return array.astype(np.uint64)


def structured(names: Sequence[str], columns: Sequence[NDArray[Any]]) -> NDArray[np.void]:
    fields = [(name, column.dtype, column.shape[1:]) for name, column in zip(names, columns, strict=True)]
    table = np.empty(len(columns[0]), dtype=fields)
    for name, column in zip(names, columns, strict=True):
        table[name] = column
    return table
