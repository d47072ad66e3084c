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
from impinge._tiles import Tiles

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
    def _repr_html_(self) -> str: ...

Shapes: TypeAlias = Shape | Sequence[Shape] | Picked
PosesLike: TypeAlias = ArrayLike | Poses | None

@final
class World:
    def __new__(cls, margin: float, dim: int, dtype: str) -> World: ...
    @property
    def dim(self) -> int: ...
    @property
    def dtype(self) -> str: ...
    @property
    def is_recorded(self) -> bool: ...
    def add(self, shapes: Shapes, poses: PosesLike, options: Any) -> list[int]: ...
    def remove(self, handles: Any) -> None: ...
    def set_poses(self, handles: Any, poses: PosesLike) -> None: ...
    def set_shapes(self, handles: Any, shapes: Shapes) -> None: ...
    def set_vertices(self, handle: int, vertices: ArrayLike) -> None: ...
    def set_groups(self, handles: Any, groups: Any) -> None: ...
    def set_query_types(self, handles: Any, query: Any) -> None: ...
    def update(self) -> None: ...
    def record(self) -> None: ...
    def stop_recording(self) -> bytes | None: ...
    def picture(self, view: Any) -> tuple[str, bytes]: ...
    def handles(self) -> list[int]: ...
    def shapes(self, handles: Any) -> list[Shape]: ...
    def poses(self, handles: Any) -> NDArray[Any]: ...
    def contact_events(self) -> list[NDArray[Any]]: ...
    def proximity_events(self) -> list[NDArray[Any]]: ...
    def contacts(self) -> list[NDArray[Any]]: ...
    def proximities(self) -> list[NDArray[Any]]: ...
    def ask(
        self, question: Any, given: list[Any], filter: Any, threads: int | None, progress: Progress | None
    ) -> list[NDArray[Any]]: ...

def picture_of(shapes: Shapes, poses: PosesLike, view: Any) -> tuple[str, bytes]: ...
def recording_page(bytes: bytes, title: str) -> str | None: ...
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
def scene_of_bytes(bytes: bytes) -> tuple[list[Shape], NDArray[Any], int, str]: ...
def shape_of_bytes(bytes: bytes) -> Shape: ...
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
    angular_velocity1: ArrayLike | None = None,
    angular_velocity2: ArrayLike | None = None,
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
def boxes(
    shapes: Shapes, poses: PosesLike, *, threads: int | None = None, progress: Progress | None = None
) -> NDArray[Any]: ...
def pairs_in_tile(
    shapes: Shapes,
    poses: PosesLike,
    ids: ArrayLike,
    tiles: Tiles,
    tile: int,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> NDArray[np.uint64]: ...
def tile_cuts(
    boxes: NDArray[Any], number: int, clearance: float, dim: int, dtype: str
) -> tuple[NDArray[np.uint32], NDArray[Any]]: ...
def tile_bounds(tiles: Tiles) -> NDArray[Any]: ...
def tiles_meeting(tiles: Tiles, boxes: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.uint32]]: ...
def tile_owners(tiles: Tiles, points: ArrayLike) -> NDArray[np.uint32]: ...
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
    surface: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Any: ...
def contains(
    shape: Shapes,
    poses: PosesLike,
    points: ArrayLike,
    *,
    surface: bool = False,
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
