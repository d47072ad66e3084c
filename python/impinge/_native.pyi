"""The extension module: what `impinge` exports of it is documented there."""

from collections.abc import Sequence
from typing import Any, Literal, Protocol, TypeAlias, final, overload

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

__version__: str

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
    def dtype(self) -> Literal["float32", "float64"]: ...
    @property
    def vertices(self) -> NDArray[np.floating[Any]]: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...

Shapes: TypeAlias = Shape | Sequence[Shape] | Picked
PosesLike: TypeAlias = ArrayLike | Poses | None

Floats: TypeAlias = NDArray[np.floating[Any]]
# One shape for each element: the answer is an array.
Several: TypeAlias = Sequence[Shape] | Picked

@final
class World:
    def __new__(cls, margin: float, dim: int, dtype: str) -> World: ...
    @property
    def dim(self) -> int: ...
    @property
    def dtype(self) -> Literal["float32", "float64"]: ...
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
    def to_bytes(self) -> tuple[bytes, list[int]]: ...
    def fill(self, bytes: bytes, ages: list[int]) -> None: ...
    def picture(self, view: Any) -> tuple[str, bytes]: ...
    def handles(self) -> list[int]: ...
    def shapes(self, handles: Any) -> list[Shape]: ...
    def poses(self, handles: Any) -> Floats: ...
    def contact_events(self) -> list[Floats]: ...
    def proximity_events(self) -> list[Floats]: ...
    def contacts(self) -> list[Floats]: ...
    def proximities(self) -> list[Floats]: ...
    def ask(
        self, question: Any, given: list[Any], filter: Any, threads: int | None, progress: Progress | None
    ) -> list[Floats]: ...

def picture_of(shapes: Shapes, poses: PosesLike, view: Any) -> tuple[str, bytes]: ...
def recording_page(bytes: bytes, title: str) -> str | None: ...
@final
class NativeChecker:
    def __new__(cls, *arguments: Any) -> NativeChecker: ...
    def set_obstacles(self, shapes: list[Shape], poses: Floats, ignored: NDArray[np.uint32]) -> None: ...
    def place(self, rows: Floats, of_bodies: bool) -> Floats: ...
    def ask(
        self,
        question: str,
        rows: Floats,
        limit: float,
        count: int,
        threads: int | None,
        progress: Progress | None,
    ) -> list[Floats]: ...

@final
class Manager:
    def __new__(cls) -> Manager: ...
    def add(self, shape: Shape, transform: NDArray[np.float64]) -> int: ...
    def remove(self, index: int) -> None: ...
    def place(self, index: int, transform: ArrayLike) -> None: ...
    def transforms(self, indices: list[int]) -> NDArray[np.float64]: ...
    def is_touching(self) -> bool: ...
    def touching(self) -> list[tuple[int, int]]: ...
    def nearest(self) -> tuple[int, int, float] | None: ...
    def nearest_beside(self, index: int) -> tuple[int, int, float] | None: ...
    def meets_any(self, shape: Shape, transform: NDArray[np.float64]) -> bool: ...
    def met_by(self, shape: Shape, transform: NDArray[np.float64]) -> list[int]: ...
    def nearest_to(self, shape: Shape, transform: NDArray[np.float64]) -> tuple[int, float] | None: ...
    def is_touching_other(self, other: Manager) -> bool: ...
    def touching_other(self, other: Manager) -> list[tuple[int, int]]: ...
    def nearest_other(self, other: Manager) -> tuple[int, int, float] | None: ...

def scene_bytes(shapes: Shapes, poses: PosesLike) -> bytes: ...
def scene_of_bytes(bytes: bytes) -> tuple[list[Shape], Floats, int, Literal["float32", "float64"]]: ...
def shape_of_bytes(bytes: bytes) -> Shape: ...
@overload
def distance(
    shape1: Shape,
    poses1: None,
    shape2: Shape,
    poses2: None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> float: ...
@overload
def distance(
    shape1: Several,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Floats: ...
@overload
def distance(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Several,
    poses2: PosesLike,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Floats: ...
@overload
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
@overload
def proximity(
    shape1: Shape,
    poses1: None,
    shape2: Shape,
    poses2: None,
    margin: float = 0.0,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> int: ...
@overload
def proximity(
    shape1: Several,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    margin: float = 0.0,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> NDArray[np.uint8]: ...
@overload
def proximity(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Several,
    poses2: PosesLike,
    margin: float = 0.0,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> NDArray[np.uint8]: ...
@overload
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
) -> Floats: ...
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
    boxes: Floats, number: int, clearance: float, dim: int, dtype: str
) -> tuple[NDArray[np.uint32], Floats]: ...
def tile_bounds(tiles: Tiles) -> Floats: ...
def tiles_meeting(tiles: Tiles, boxes: Floats) -> tuple[NDArray[np.int64], NDArray[np.uint32]]: ...
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
@overload
def signed_distance(
    shape: Several,
    poses: PosesLike,
    points: ArrayLike,
    *,
    surface: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Floats: ...
@overload
def signed_distance(
    shape: Shapes,
    poses: PosesLike,
    points: ArrayLike,
    *,
    surface: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Any: ...
@overload
def contains(
    shape: Several,
    poses: PosesLike,
    points: ArrayLike,
    *,
    surface: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> NDArray[np.bool_]: ...
@overload
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
