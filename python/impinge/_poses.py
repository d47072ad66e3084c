"""Converts poses and vectors of common forms to arrays that the library reads without a copy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation  # type: ignore[import-untyped, unused-ignore]

Array: TypeAlias = NDArray[np.float64]

DTypeName: TypeAlias = Literal["float32", "float64"]

DType: TypeAlias = DTypeName | type[np.float32] | type[np.float64] | type[float] | np.dtype[Any]
"""The scalar of shapes and answers: its name, or the type of NumPy."""

Order: TypeAlias = Literal["xyzw", "wxyz"]
"""The order of the numbers of quaternions."""

Index: TypeAlias = SupportsIndex | slice | Sequence[int] | NDArray[np.integer[Any]] | NDArray[np.bool_]
"""The type of an index of poses, as for the rows of a NumPy array."""


class Poses:
    """Rotations and translations as matrices: `Poses.matrices` has the shape (n, D+1, D+1), or (D+1, D+1).

    A pose x -> rotation x + translation maps the local frame of a shape to the world frame. Any function that takes poses
    also takes the matrices themselves; those in C order and of the dtype of the shape are not copied.

    Errors: ValueError names the row and the value if an array has a wrong shape, a number is not finite or a quaternion is
    zero.

    translations: (D,) or (n, D), in the unit of the shapes. quaternions: (4,) or (n, 4), of any length but zero, in the
    order "xyzw" (SciPy, ROS) or "wxyz" (MuJoCo, trimesh), in 3D. angles: a number or (n,) in radians, counter-clockwise, in 2D.

    >>> half_turn = Poses([1, 2, 3], quaternions=[0, 0, 1, 0], order="xyzw")
    >>> half_turn.matrices[0].tolist()
    [-1.0, 0.0, 0.0, 1.0]
    >>> Poses([[1, 2], [3, 4]], angles=np.pi / 2).matrices.shape
    (2, 3, 3)
    """

    def __init__(
        self,
        translations: ArrayLike,
        quaternions: ArrayLike | None = None,
        *,
        order: Order | None = None,
        angles: ArrayLike | None = None,
    ) -> None:
        places = _finite(_floats(translations, "translations"), "translations")
        if places.ndim not in (1, 2) or places.shape[-1] not in (2, 3):
            raise ValueError(f"translations has the shape {places.shape}, where (D,) or (n, D) is needed")
        if quaternions is not None:
            if places.shape[-1] != 3:
                raise ValueError("quaternions are rotations of 3D, but translations have 2 numbers")
            if order not in ("xyzw", "wxyz"):
                raise ValueError(f'order is {order!r}: name the order of quaternions, "xyzw" or "wxyz"')
            rotations = _of_quaternions(_floats(quaternions, "quaternions"), order)
        elif angles is not None:
            if places.shape[-1] != 2:
                raise ValueError("angles are rotations of 2D, but translations have 3 numbers")
            rotations = _of_angles(_finite(_floats(angles, "angles"), "angles"))
        else:
            rotations = np.eye(places.shape[-1])
        self.matrices: Array = _joined(rotations, places)

    @classmethod
    def from_rotation(cls, rotation: Rotation, translations: ArrayLike) -> Poses:
        """Creates poses from a `scipy.spatial.transform.Rotation`, one or many, and translations (3,) or (n, 3).

        >>> from scipy.spatial.transform import Rotation
        >>> Poses.from_rotation(Rotation.from_euler("z", [[90], [180]], degrees=True), [1, 2, 3])
        <impinge.Poses (2, 4, 4)>
        """
        if not hasattr(rotation, "as_matrix"):
            raise TypeError(f"rotation is {type(rotation).__name__}, where a Rotation of SciPy is needed")
        poses = cls(translations)
        if poses.matrices.shape[-1] != 4:
            raise ValueError("rotation is of 3D, but translations have 2 numbers")
        poses.matrices = _joined(np.asarray(rotation.as_matrix()), poses.matrices[..., :-1, -1])
        return poses

    @classmethod
    def from_matrices(cls, matrices: ArrayLike) -> Poses:
        """Creates poses from matrices (D+1, D+1) or (n, D+1, D+1), in 2D or 3D. They are validated by the functions that use
        them.

        >>> Poses.from_matrices(np.eye(3))
        <impinge.Poses (3, 3)>
        """
        array = _floats(matrices, "matrices")
        if array.ndim not in (2, 3) or array.shape[-2:] not in ((3, 3), (4, 4)):
            raise ValueError(f"matrices has the shape {array.shape}, where (D+1, D+1) or (n, D+1, D+1) is needed")
        poses = cls(np.zeros(array.shape[-1] - 1))
        poses.matrices = array
        return poses

    @classmethod
    def nearest_to(cls, matrices: ArrayLike, tolerance: float = 1e-3) -> Poses:
        """Creates poses from matrices (D+1, D+1) or (n, D+1, D+1) with rounded digits, by the nearest rotations.

        ValueError names the first matrix with a number farther than `tolerance` from its nearest pose, for instance a scaled
        or mirrored one.

        >>> rounded = [[0.866, -0.5, 0, 1], [0.5, 0.866, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
        >>> Poses.nearest_to(rounded).matrices[0].round(6).tolist()
        [0.866019, -0.500011, 0.0, 1.0]
        """
        poses = cls.from_matrices(matrices)
        given = _finite(poses.matrices, "matrices")
        left, _, right = np.linalg.svd(given[..., :-1, :-1])
        # If the matrix is a reflection, no rotation is within a small tolerance.
        turned = left * np.where(np.linalg.det(left @ right) < 0, -1.0, 1.0)[..., None, None] @ right
        nearest = _joined(turned, given[..., :-1, -1])
        off = np.abs(nearest - given).max(axis=(-2, -1))
        if not (off <= tolerance).all():
            row = int(np.argmax(off > tolerance))
            name = "matrices" if given.ndim == 2 else f"matrices[{row}]"
            raise ValueError(f"{name} is no rounded pose: a number is {off.flat[row]:.3g} off, where {tolerance:.3g} is allowed")
        poses.matrices = nearest
        return poses

    def __len__(self) -> int:
        if self.matrices.ndim == 2:
            raise TypeError("one pose has no length")
        return len(self.matrices)

    def __getitem__(self, index: Index) -> Poses:
        if self.matrices.ndim == 2:
            raise TypeError("one pose has no elements")
        return Poses.from_matrices(self.matrices[index])

    def __repr__(self) -> str:
        return f"<impinge.Poses {self.matrices.shape}>"


def dtype_name(given: Any) -> DTypeName:
    """Returns the name of a scalar. ValueError for one that the library does not support."""
    try:
        name = None if given is None else np.dtype(given).name
    except TypeError:
        name = None
    if name == "float32":
        return "float32"
    if name == "float64":
        return "float64"
    raise ValueError(f'dtype is {given!r}: it is "float32" or "float64"')


def _floats(given: ArrayLike, name: str) -> Array:
    return numbers(given, np.float64, name, "numbers")


def _finite(array: Array, name: str) -> Array:
    if not np.isfinite(array).all():
        row = tuple(int(index) for index in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name}{list(row)} is {array[row]}")
    return array


def _of_quaternions(quaternions: Array, order: Order) -> Array:
    _finite(quaternions, "quaternions")
    if quaternions.ndim not in (1, 2) or quaternions.shape[-1] != 4:
        raise ValueError(f"quaternions has the shape {quaternions.shape}, where (4,) or (n, 4) is needed")
    # Scaled first so that the largest component is 1: then squares neither overflow nor underflow.
    largest = np.abs(quaternions).max(axis=-1, keepdims=True)
    if not (largest > 0).all():
        row = int(np.argmin(largest.ravel()))
        raise ValueError(f"quaternions[{row}] is zero")
    scaled = quaternions / largest
    unit = scaled / np.linalg.norm(scaled, axis=-1, keepdims=True)
    if order == "wxyz":
        unit = np.roll(unit, -1, axis=-1)
    x, y, z, w = np.moveaxis(unit, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _of_angles(angles: Array) -> Array:
    if angles.ndim > 1:
        raise ValueError(f"angles has the shape {angles.shape}, where a number or (n,) is needed")
    cosine, sine = np.cos(angles), np.sin(angles)
    return np.stack([np.stack([cosine, -sine], axis=-1), np.stack([sine, cosine], axis=-1)], axis=-2)


def _joined(rotations: Array, translations: Array) -> Array:
    """Returns homogeneous matrices; a single rotation or translation is broadcast."""
    many = {len(rotations)} if rotations.ndim == 3 else set()
    many |= {len(translations)} if translations.ndim == 2 else set()
    if len(many) > 1:
        raise ValueError(f"there are {len(rotations)} rotations and {len(translations)} translations")
    dim = translations.shape[-1]
    matrices = np.zeros((*many, dim + 1, dim + 1))
    matrices[..., :dim, :dim] = rotations
    matrices[..., :dim, dim] = translations
    matrices[..., dim, dim] = 1
    return matrices


def numbers(given: object, dtype: DTypeLike, name: str, what: str) -> NDArray[Any]:
    """Converts an argument to an array of this type, aligned and in C order. TypeError for complex numbers, texts and ragged
    lists."""
    try:
        array = np.asarray(given)
        if array.dtype.kind in "biufO":
            return np.require(array, dtype=dtype, requirements=["C", "A"])
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} is no array of {what}: {type(given).__name__}") from error
    raise TypeError(f"{name} is no array of {what}: {array.dtype}")


def matrices(given: object, dim: int, dtype: DTypeLike, name: str) -> NDArray[Any]:
    """Converts an argument to an array (dim+1, dim+1) or (n, dim+1, dim+1) in C order."""
    if isinstance(given, Poses):
        given = given.matrices
    array = numbers(given, dtype, name, "matrices, Poses or None")
    if array.ndim not in (2, 3) or array.shape[-2:] != (dim + 1, dim + 1):
        need = f"({dim + 1}, {dim + 1}) or (n, {dim + 1}, {dim + 1})"
        raise ValueError(f"{name} has the shape {array.shape}, where {need} is needed in {dim}D")
    return array


def vectors(given: object, dim: int, dtype: DTypeLike, name: str) -> NDArray[Any]:
    """Converts an argument to an array (dim,) or (n, dim) in C order."""
    array = numbers(given, dtype, name, "vectors")
    if array.ndim not in (1, 2) or array.shape[-1] != dim:
        raise ValueError(f"{name} has the shape {array.shape}, where ({dim},) or (n, {dim}) is needed in {dim}D")
    return array


def angular_velocities(given: object, dim: int, dtype: DTypeLike, name: str) -> tuple[NDArray[Any], bool]:
    """Converts an argument to rows of one number in 2D, of three in 3D; also returns whether it was a single row."""
    need = "a number or (n,)" if dim == 2 else "(3,) or (n, 3)"
    array = numbers(given, dtype, name, "angular velocities")
    is_lone = array.ndim == dim - 2
    if array.ndim not in (dim - 2, dim - 1) or (dim == 3 and array.shape[-1] != 3):
        raise ValueError(f"{name} has the shape {array.shape}, where {need} is needed in {dim}D")
    return np.ascontiguousarray(array.reshape(-1, 1 if dim == 2 else 3)), is_lone
