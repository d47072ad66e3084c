"""Types of `_results.py`: NamedTuples with type parameters, which Python 3.10 does not support at run time.

A parameter is the type of a scalar for one pair, or of an array (n,) for many, so that `Contact[float]` is the contact of one
pair. A class without parameters stands for both. Vectors are arrays in both cases, (D,) and (n, D).
"""

from enum import IntEnum
from typing import Any, Generic, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeVar

Floats: TypeAlias = NDArray[np.floating[Any]]
Flags: TypeAlias = NDArray[np.bool_]
Indices: TypeAlias = NDArray[np.uint32]

Number = TypeVar("Number", bound=float | Floats, covariant=True, default=float | Floats)
Flag = TypeVar("Flag", bound=bool | Flags, covariant=True, default=bool | Flags)
Index = TypeVar("Index", bound=int | Indices, covariant=True, default=int | Indices)

class Proximity(IntEnum):
    INTERSECTING = 0
    WITHIN_MARGIN = 1
    DISJOINT = 2

class ClosestPoints(NamedTuple, Generic[Number]):
    distance: Number
    point1: Floats
    point2: Floats

class Witness(NamedTuple, Generic[Number, Index]):
    distance: Number
    point1: Floats
    point2: Floats
    normal: Floats
    part1: Index
    part2: Index

class Contact(NamedTuple, Generic[Number]):
    depth: Number
    normal: Floats
    point1: Floats
    point2: Floats

class Impact(NamedTuple, Generic[Number, Flag]):
    time: Number
    normal: Floats
    point1: Floats
    point2: Floats
    is_reached: Flag

class Nearest(NamedTuple):
    pair: int
    distance: float

class Manifolds(NamedTuple):
    starts: NDArray[np.int64]
    depth: Floats
    normal: Floats
    point1: Floats
    point2: Floats
    manifold: Indices
    part1: Indices
    part2: Indices

    def of(self, pair: int) -> Manifolds: ...

class Projection(NamedTuple, Generic[Flag, Index]):
    point: Floats
    is_inside: Flag
    part: Index

class RayHit(NamedTuple, Generic[Number, Index]):
    time: Number
    normal: Floats
    part: Index
