"""The extension module: what `impinge` exports of it is documented there."""

from collections.abc import Sequence
from typing import Any, Protocol, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._poses import Poses
from impinge._results import (
    ClosestPoints,
    Contact,
    Impact,
    Manifolds,
    Nearest,
    Projection,
    RayHit,
    Witness,
)
from impinge._shapes import Picked

class Progress(Protocol):
    def update(self, count: int, /) -> Any: ...

@final
class Shape:
    def __new__(cls, *arguments: Any) -> Shape: ...
    @property
    def name(self) -> str: ...
    @property
    def dim(self) -> int: ...
    @property
    def dtype(self) -> str: ...

Shapes: TypeAlias = Shape | Sequence[Shape] | Picked
PosesLike: TypeAlias = ArrayLike | Poses | None

@final
class World:
    def __new__(cls, margin: float, dim: int, dtype: str) -> World: ...
    @property
    def dim(self) -> int: ...
    @property
    def dtype(self) -> str: ...
    def add(self, shapes: Shapes, poses: PosesLike, options: Any) -> list[int]: ...
    def remove(self, handles: Any) -> None: ...
    def set_poses(self, handles: Any, poses: PosesLike) -> None: ...
    def update(self) -> None: ...
    def handles(self) -> list[int]: ...
    def poses(self, handles: Any) -> NDArray[Any]: ...
    def contact_events(self) -> list[NDArray[Any]]: ...
    def proximity_events(self) -> list[NDArray[Any]]: ...
    def contacts(self) -> list[NDArray[Any]]: ...
    def cast_rays(
        self, origins: ArrayLike, directions: ArrayLike, max_time: float, solid: bool
    ) -> list[NDArray[Any]]: ...
    def near(self, shapes: Shapes, poses: PosesLike, count: int, max_distance: float) -> list[NDArray[Any]]: ...
    def containing(self, points: ArrayLike) -> list[NDArray[Any]]: ...
    def cast_shape(
        self, shapes: Shapes, poses: PosesLike, velocities: ArrayLike, max_time: float, target_distance: float
    ) -> list[NDArray[Any]]: ...

@final
class NativeChecker:
    def __new__(cls, *arguments: Any) -> NativeChecker: ...
    def set_obstacles(self, shapes: list[Shape], poses: NDArray[Any], ignored: NDArray[np.uint32]) -> None: ...
    def place(self, rows: NDArray[Any], of_bodies: bool) -> NDArray[Any]: ...
    def ask(
        self,
        question: str,
        rows: NDArray[Any],
        limit: float,
        count: int,
        threads: int | None,
        progress: Progress | None,
    ) -> list[NDArray[Any]]: ...

def scene_bytes(shapes: Shapes, poses: PosesLike) -> bytes: ...
def scene_of_bytes(bytes: bytes, dim: int, dtype: str) -> tuple[list[Shape], NDArray[Any]]: ...
def shape_of_bytes(bytes: bytes, dim: int, dtype: str) -> Shape: ...
def distance(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Any: ...
def closest_points(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    max_distance: float = ...,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> ClosestPoints: ...
def witness(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    max_distance: float = ...,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Witness: ...
def proximity(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    margin: float = 0.0,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Any: ...
def contact(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    prediction: float = 0.0,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Contact: ...
def contact_manifolds(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    prediction: float = 0.0,
    max_points: int | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Manifolds: ...
def nearest(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    max_distance: float = ...,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Nearest: ...
def impact(
    shape1: Shapes,
    poses1: PosesLike,
    velocity1: ArrayLike,
    shape2: Shapes,
    poses2: PosesLike,
    velocity2: ArrayLike,
    max_time: float = ...,
    target_distance: float = 0.0,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Impact: ...
def pairs_within(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes | None = None,
    poses2: PosesLike = None,
    *,
    distance: float = 0.0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> NDArray[np.uint32]: ...
def project_points(
    shape: Shapes,
    poses: PosesLike,
    points: ArrayLike,
    solid: bool = True,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Projection: ...
def signed_distance(
    shape: Shapes,
    poses: PosesLike,
    points: ArrayLike,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Any: ...
def contains(
    shape: Shapes,
    poses: PosesLike,
    points: ArrayLike,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Any: ...
def cast_rays(
    shape: Shapes,
    poses: PosesLike,
    origins: ArrayLike,
    directions: ArrayLike,
    max_time: float = ...,
    solid: bool = True,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> RayHit: ...
