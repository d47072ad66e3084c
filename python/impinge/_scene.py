"""Scenes: shapes at poses as a value, with canonical bytes."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from impinge import _native
from impinge._native import Shape
from impinge._pictures import View, html_of
from impinge._poses import DType, DTypeName, dtype_name
from impinge._results import Floats

if TYPE_CHECKING:
    from impinge._native import PosesLike, Shapes


class Scene:
    """Immutable shapes at poses, which compare, hash and pickle by their bytes.

    shapes, poses: as in `impinge.distance`; at least one object. ValueError names the row of an invalid pose.

    The bytes are a recording of the calls that add the objects (the format of `impinge-record`): versioned, with a checksum,
    equal on every machine. Poses are stored as unit quaternions: the matrices of `poses` may differ from the arguments in the
    last digits.

    >>> import impinge, pickle
    >>> scene = impinge.Scene([impinge.Ball(1), impinge.Cuboid([1, 2, 3])], impinge.Poses([[0, 0, 0], [5, 0, 0]]))
    >>> len(scene), pickle.loads(pickle.dumps(scene)) == scene
    (2, True)
    >>> impinge.distance(scene.shapes, scene.poses, impinge.Ball(1), impinge.Poses([2.5, 0, 0])).tolist()
    [0.5, 0.5]
    """

    def __init__(self, shapes: Shapes, poses: PosesLike) -> None:
        self._take(_native.scene_bytes(shapes, poses))

    def _take(self, data: bytes) -> None:
        self._shapes, self._poses, self.dim, dtype = _native.scene_of_bytes(data)
        self.dtype: DTypeName = dtype
        self._poses.flags.writeable = False
        self._bytes = data

    @classmethod
    def from_bytes(cls, data: bytes, *, dim: int | None = None, dtype: DType | None = None) -> Scene:
        """Restores the scene of `to_bytes`. ValueError names the offset of damage, or a `dim` or `dtype` that does not match.

        >>> import impinge
        >>> data = impinge.Scene(impinge.Ball(1, dim=2), None).to_bytes()
        >>> impinge.Scene.from_bytes(data)
        <impinge.Scene of 1 objects, 2D float64>
        """
        scene = cls.__new__(cls)
        scene._take(bytes(data))
        wanted = None if dtype is None else dtype_name(dtype)
        for name, asked, given in (("dim", dim, scene.dim), ("dtype", wanted, scene.dtype)):
            if asked not in (None, given):
                raise ValueError(f"{name} is {asked!r}, but the scene is of {given!r}")
        return scene

    def to_bytes(self) -> bytes:
        """The canonical bytes."""
        return self._bytes

    @property
    def checksum(self) -> str:
        """SHA-256 of the bytes, in hexadecimal digits, for instance as a cache key."""
        return hashlib.sha256(self._bytes).hexdigest()

    @property
    def shapes(self) -> list[Shape]:
        """The shape of each object."""
        return list(self._shapes)

    @property
    def poses(self) -> Floats:
        """The pose of each object: (n, D+1, D+1), read-only."""
        return self._poses

    def __len__(self) -> int:
        return len(self._shapes)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self._bytes == other._bytes

    def __hash__(self) -> int:
        return hash(self._bytes)

    def __reduce__(self) -> tuple[object, ...]:
        return (Scene.from_bytes, (self._bytes,))

    def _picture(self, view: View) -> tuple[str, bytes]:
        return _native.picture_of(self._shapes, self._poses, view)

    def _repr_html_(self) -> str:
        return html_of(self)

    def __repr__(self) -> str:
        return f"<impinge.Scene of {len(self)} objects, {self.dim}D {self.dtype}>"
