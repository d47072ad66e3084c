"""Scenes: shapes at poses as a value, with canonical bytes."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import Any

from numpy.typing import NDArray

from impinge import _native
from impinge._native import Shape


class Scene:
    """Shapes at poses that do not change: it compares, hashes and pickles by its bytes.

    The bytes are a recording of the calls that add the objects (the format of `impinge-record`): versioned, checksummed, the
    same on every machine. Poses are kept as unit quaternions: `poses` has their matrices, which may differ in the last digits
    from those given.

    >>> import impinge, pickle
    >>> scene = impinge.Scene([impinge.Ball(1), impinge.Cuboid([1, 2, 3])], impinge.Poses([[0, 0, 0], [5, 0, 0]]))
    >>> len(scene), pickle.loads(pickle.dumps(scene)) == scene
    (2, True)
    >>> impinge.distance(scene.shapes, scene.poses, impinge.Ball(1), impinge.Poses([2.5, 0, 0])).tolist()
    [0.5, 0.5]
    """

    def __init__(self, shapes: Shape | Sequence[Shape], poses: Any) -> None:
        first = shapes if isinstance(shapes, Shape) else shapes[0]
        self._take(_native.scene_bytes(shapes, poses), first.dim, first.dtype)

    def _take(self, data: bytes, dim: int, dtype: str) -> None:
        self._shapes, self._poses = _native.scene_of_bytes(data, dim, dtype)
        self._poses.flags.writeable = False
        self._bytes, self.dim, self.dtype = data, dim, dtype

    @classmethod
    def from_bytes(cls, data: bytes, *, dim: int = 3, dtype: str = "float64") -> Scene:
        """The scene of `to_bytes`. ValueError names the offset of what is damaged."""
        scene = cls.__new__(cls)
        scene._take(bytes(data), dim, dtype)
        return scene

    def to_bytes(self) -> bytes:
        """The canonical bytes."""
        return self._bytes

    @property
    def checksum(self) -> str:
        """SHA-256 of the bytes, in hexadecimal digits: a name for caches."""
        return hashlib.sha256(self._bytes).hexdigest()

    @property
    def shapes(self) -> list[Shape]:
        """The shape of each object."""
        return list(self._shapes)

    @property
    def poses(self) -> NDArray[Any]:
        """The pose of each object: (n, D+1, D+1), read-only."""
        return self._poses

    def __len__(self) -> int:
        return len(self._shapes)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return (self.dim, self.dtype, self._bytes) == (other.dim, other.dtype, other._bytes)

    def __hash__(self) -> int:
        return hash((self.dim, self.dtype, self._bytes))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_read, (self._bytes, self.dim, self.dtype))

    def __repr__(self) -> str:
        return f"<impinge.Scene of {len(self)} objects, {self.dim}D {self.dtype}>"


def _read(data: bytes, dim: int, dtype: str) -> Scene:
    return Scene.from_bytes(data, dim=dim, dtype=dtype)
