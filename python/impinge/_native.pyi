"""The extension module. `impinge` re-exports its public names, which are documented there."""

from collections.abc import Sequence
from typing import Any, Protocol, TypeAlias, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impinge._pictures import View
from impinge._poses import DTypeName, Poses
from impinge._results import (
    ClosestPoints,
    Contact,
    Flags,
    Floats,
    Impact,
    Indices,
    Manifolds,
    Nearest,
    Projection,
    RayHit,
    Witness,
)
from impinge._shapes import Picked
from impinge._tiles import Tiles
from impinge._world_arguments import Filter, Groups, Options, Query, Question
from impinge._world_results import Handles

__version__: str

class Progress(Protocol):
    def update(self, count: int, /) -> object: ...

@final
class Shape:
    def __new__(cls, *arguments: object) -> Shape: ...
    @property
    def name(self) -> str: ...
    @property
    def dim(self) -> int: ...
    @property
    def dtype(self) -> DTypeName: ...
    @property
    def vertices(self) -> Floats: ...
    @property
    def faces(self) -> Indices: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...

Shapes: TypeAlias = Shape | Sequence[Shape] | Picked
PosesLike: TypeAlias = ArrayLike | Poses | None

# The result is a scalar if each side of the query has one `Shape` at one pose and there is one point or vector, else an
# array. The type of an argument distinguishes one from many if it is `None`, or a list of numbers, of rows or of shapes.
# A NumPy array or `Poses` may be either, so the result is then the union of both types.
OnePose: TypeAlias = Sequence[Sequence[float]] | None
OneVector: TypeAlias = Sequence[float]
Vectors: TypeAlias = Sequence[Sequence[float]]
Several: TypeAlias = Sequence[Shape] | Picked
Codes: TypeAlias = NDArray[np.uint8]

Threads: TypeAlias = int | None
ProgressLike: TypeAlias = Progress | None
# Columns of several dtypes.
Columns: TypeAlias = list[NDArray[Any]]

@final
class World:
    def __new__(cls, margin: float, dim: int, dtype: str) -> World: ...
    @property
    def dim(self) -> int: ...
    @property
    def dtype(self) -> DTypeName: ...
    @property
    def is_recorded(self) -> bool: ...
    def add(self, shapes: Shapes, poses: PosesLike, options: Options) -> list[int]: ...
    def remove(self, handles: Handles) -> None: ...
    def set_poses(self, handles: Handles, poses: PosesLike) -> None: ...
    def set_shapes(self, handles: Handles, shapes: Shapes) -> None: ...
    def set_vertices(self, handle: int, vertices: ArrayLike) -> None: ...
    def set_groups(self, handles: Handles, groups: Groups) -> None: ...
    def set_query_types(self, handles: Handles, query: Query) -> None: ...
    def update(self) -> None: ...
    def record(self) -> None: ...
    def stop_recording(self) -> bytes | None: ...
    def to_bytes(self) -> tuple[bytes, list[int]]: ...
    def fill(self, bytes: bytes, ages: list[int]) -> None: ...
    def picture(self, view: View) -> tuple[str, bytes]: ...
    def handles(self) -> list[int]: ...
    def shapes(self, handles: Handles) -> list[Shape]: ...
    def poses(self, handles: Handles) -> Floats: ...
    def contact_events(self) -> Columns: ...
    def proximity_events(self) -> Columns: ...
    def contacts(self) -> Columns: ...
    def proximities(self) -> Columns: ...
    def ask(
        self,
        question: Question,
        given: Sequence[object],
        filter: Filter | None,
        threads: Threads,
        progress: ProgressLike,
    ) -> Columns: ...

def picture_of(shapes: Shapes, poses: PosesLike, view: View) -> tuple[str, bytes]: ...
def recording_page(bytes: bytes, title: str) -> str | None: ...
@final
class NativeChecker:
    def __new__(cls, *arguments: object) -> NativeChecker: ...
    def set_obstacles(self, shapes: list[Shape], poses: Floats, ignored: Indices) -> None: ...
    def place(self, rows: Floats, of_bodies: bool) -> Floats: ...
    def ask(
        self,
        question: str,
        rows: Floats,
        limit: float,
        count: int,
        threads: Threads,
        progress: ProgressLike,
    ) -> Columns: ...

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
def scene_of_bytes(bytes: bytes) -> tuple[list[Shape], Floats, int, DTypeName]: ...
def shape_of_bytes(bytes: bytes) -> Shape: ...
@overload
def distance(
    shape1: Shape, poses1: OnePose, shape2: Shape, poses2: OnePose,
    *, threads: Threads = None, progress: ProgressLike = None,
) -> float: ...
@overload
def distance(
    shape1: Several, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    *, threads: Threads = None, progress: ProgressLike = None,
) -> Floats: ...
@overload
def distance(
    shape1: Shapes, poses1: PosesLike, shape2: Several, poses2: PosesLike,
    *, threads: Threads = None, progress: ProgressLike = None,
) -> Floats: ...
@overload
def distance(
    shape1: Shapes, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    *, threads: Threads = None, progress: ProgressLike = None,
) -> float | Floats: ...
@overload
def closest_points(
    shape1: Shape, poses1: OnePose, shape2: Shape, poses2: OnePose,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> ClosestPoints[float]: ...
@overload
def closest_points(
    shape1: Several, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> ClosestPoints[Floats]: ...
@overload
def closest_points(
    shape1: Shapes, poses1: PosesLike, shape2: Several, poses2: PosesLike,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> ClosestPoints[Floats]: ...
@overload
def closest_points(
    shape1: Shapes, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> ClosestPoints: ...
@overload
def witness(
    shape1: Shape, poses1: OnePose, shape2: Shape, poses2: OnePose,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> Witness[float, int]: ...
@overload
def witness(
    shape1: Several, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> Witness[Floats, Indices]: ...
@overload
def witness(
    shape1: Shapes, poses1: PosesLike, shape2: Several, poses2: PosesLike,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> Witness[Floats, Indices]: ...
@overload
def witness(
    shape1: Shapes, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    max_distance: float = ..., *, threads: Threads = None, progress: ProgressLike = None,
) -> Witness: ...
@overload
def proximity(
    shape1: Shape, poses1: OnePose, shape2: Shape, poses2: OnePose,
    margin: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> int: ...
@overload
def proximity(
    shape1: Several, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    margin: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> Codes: ...
@overload
def proximity(
    shape1: Shapes, poses1: PosesLike, shape2: Several, poses2: PosesLike,
    margin: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> Codes: ...
@overload
def proximity(
    shape1: Shapes, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    margin: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> int | Codes: ...
@overload
def contact(
    shape1: Shape, poses1: OnePose, shape2: Shape, poses2: OnePose,
    prediction: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> Contact[float]: ...
@overload
def contact(
    shape1: Several, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    prediction: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> Contact[Floats]: ...
@overload
def contact(
    shape1: Shapes, poses1: PosesLike, shape2: Several, poses2: PosesLike,
    prediction: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> Contact[Floats]: ...
@overload
def contact(
    shape1: Shapes, poses1: PosesLike, shape2: Shapes, poses2: PosesLike,
    prediction: float = 0.0, *, threads: Threads = None, progress: ProgressLike = None,
) -> Contact: ...
def contact_manifolds(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    prediction: float = 0.0,
    max_points: int | None = None,
    *,
    threads: Threads = None,
    progress: ProgressLike = None,
) -> Manifolds: ...
def nearest(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes,
    poses2: PosesLike,
    max_distance: float = ...,
    *,
    threads: Threads = None,
    progress: ProgressLike = None,
) -> Nearest: ...
@overload
def impact(
    shape1: Shape, poses1: OnePose, velocity1: OneVector, shape2: Shape, poses2: OnePose, velocity2: OneVector,
    max_time: float = ..., target_distance: float = 0.0, *,
    # In 2D a list of numbers has one angular velocity for each element; in 3D it is a single vector.
    angular_velocity1: float | None = None, angular_velocity2: float | None = None,
    threads: Threads = None, progress: ProgressLike = None,
) -> Impact[float, bool]: ...
@overload
def impact(
    shape1: Several, poses1: PosesLike, velocity1: ArrayLike, shape2: Shapes, poses2: PosesLike, velocity2: ArrayLike,
    max_time: float = ..., target_distance: float = 0.0, *,
    angular_velocity1: ArrayLike | None = None, angular_velocity2: ArrayLike | None = None,
    threads: Threads = None, progress: ProgressLike = None,
) -> Impact[Floats, Flags]: ...
@overload
def impact(
    shape1: Shapes, poses1: PosesLike, velocity1: ArrayLike, shape2: Several, poses2: PosesLike, velocity2: ArrayLike,
    max_time: float = ..., target_distance: float = 0.0, *,
    angular_velocity1: ArrayLike | None = None, angular_velocity2: ArrayLike | None = None,
    threads: Threads = None, progress: ProgressLike = None,
) -> Impact[Floats, Flags]: ...
@overload
def impact(
    shape1: Shapes, poses1: PosesLike, velocity1: Vectors, shape2: Shapes, poses2: PosesLike, velocity2: ArrayLike,
    max_time: float = ..., target_distance: float = 0.0, *,
    angular_velocity1: ArrayLike | None = None, angular_velocity2: ArrayLike | None = None,
    threads: Threads = None, progress: ProgressLike = None,
) -> Impact[Floats, Flags]: ...
@overload
def impact(
    shape1: Shapes, poses1: PosesLike, velocity1: ArrayLike, shape2: Shapes, poses2: PosesLike, velocity2: Vectors,
    max_time: float = ..., target_distance: float = 0.0, *,
    angular_velocity1: ArrayLike | None = None, angular_velocity2: ArrayLike | None = None,
    threads: Threads = None, progress: ProgressLike = None,
) -> Impact[Floats, Flags]: ...
@overload
def impact(
    shape1: Shapes, poses1: PosesLike, velocity1: ArrayLike, shape2: Shapes, poses2: PosesLike, velocity2: ArrayLike,
    max_time: float = ..., target_distance: float = 0.0, *,
    angular_velocity1: ArrayLike | None = None, angular_velocity2: ArrayLike | None = None,
    threads: Threads = None, progress: ProgressLike = None,
) -> Impact: ...
def pairs_within(
    shape1: Shapes,
    poses1: PosesLike,
    shape2: Shapes | None = None,
    poses2: PosesLike = None,
    *,
    distance: float = 0.0,
    threads: Threads = None,
    progress: ProgressLike = None,
) -> Indices: ...
def boxes(shapes: Shapes, poses: PosesLike, *, threads: Threads = None, progress: ProgressLike = None) -> Floats: ...
def pairs_in_tile(
    shapes: Shapes,
    poses: PosesLike,
    ids: ArrayLike,
    tiles: Tiles,
    tile: int,
    *,
    threads: Threads = None,
    progress: ProgressLike = None,
) -> NDArray[np.uint64]: ...
def tile_cuts(boxes: Floats, number: int, clearance: float, dim: int, dtype: str) -> tuple[Indices, Floats]: ...
def tile_bounds(tiles: Tiles) -> Floats: ...
def tiles_meeting(tiles: Tiles, boxes: Floats) -> tuple[NDArray[np.int64], Indices]: ...
def tile_owners(tiles: Tiles, points: ArrayLike) -> Indices: ...
@overload
def project_points(
    shape: Shape, poses: OnePose, points: OneVector,
    solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> Projection[bool, int]: ...
@overload
def project_points(
    shape: Several, poses: PosesLike, points: ArrayLike,
    solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> Projection[Flags, Indices]: ...
@overload
def project_points(
    shape: Shapes, poses: PosesLike, points: Vectors,
    solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> Projection[Flags, Indices]: ...
@overload
def project_points(
    shape: Shapes, poses: PosesLike, points: ArrayLike,
    solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> Projection: ...
@overload
def signed_distance(
    shape: Shape, poses: OnePose, points: OneVector,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> float: ...
@overload
def signed_distance(
    shape: Several, poses: PosesLike, points: ArrayLike,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> Floats: ...
@overload
def signed_distance(
    shape: Shapes, poses: PosesLike, points: Vectors,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> Floats: ...
@overload
def signed_distance(
    shape: Shapes, poses: PosesLike, points: ArrayLike,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> float | Floats: ...
@overload
def contains(
    shape: Shape, poses: OnePose, points: OneVector,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> bool: ...
@overload
def contains(
    shape: Several, poses: PosesLike, points: ArrayLike,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> Flags: ...
@overload
def contains(
    shape: Shapes, poses: PosesLike, points: Vectors,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> Flags: ...
@overload
def contains(
    shape: Shapes, poses: PosesLike, points: ArrayLike,
    *, surface: bool = False, threads: Threads = None, progress: ProgressLike = None,
) -> bool | Flags: ...
@overload
def cast_rays(
    shape: Shape, poses: OnePose, origins: OneVector, directions: OneVector,
    max_time: float = ..., solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> RayHit[float, int]: ...
@overload
def cast_rays(
    shape: Several, poses: PosesLike, origins: ArrayLike, directions: ArrayLike,
    max_time: float = ..., solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> RayHit[Floats, Indices]: ...
@overload
def cast_rays(
    shape: Shapes, poses: PosesLike, origins: Vectors, directions: ArrayLike,
    max_time: float = ..., solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> RayHit[Floats, Indices]: ...
@overload
def cast_rays(
    shape: Shapes, poses: PosesLike, origins: ArrayLike, directions: Vectors,
    max_time: float = ..., solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> RayHit[Floats, Indices]: ...
@overload
def cast_rays(
    shape: Shapes, poses: PosesLike, origins: ArrayLike, directions: ArrayLike,
    max_time: float = ..., solid: bool = True, *, threads: Threads = None, progress: ProgressLike = None,
) -> RayHit: ...
