"""Small pictures of shapes, scenes and worlds, for files and notebooks."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from impinge import _native

if TYPE_CHECKING:
    from impinge._scene import Scene
    from impinge._world import World

    Drawable: TypeAlias = _native.Shape | Scene | World

# The largest number of objects for which a notebook shows a picture without a call of `picture`.
MANY = 300


class Picture(NamedTuple):
    """A picture: its bytes, and their format, "svg" in 2D and "png" in 3D.

    >>> import impinge
    >>> picture = impinge.picture(impinge.Ball(1), size=(64, 48))
    >>> picture.format, picture.data[1:4]
    ('png', b'PNG')
    """

    format: str
    data: bytes
    title: str

    def save(self, path: str | PathLike[str]) -> None:
        """Writes a file. ValueError if its extension is not `format`."""
        if Path(path).suffix != f".{self.format}":
            raise ValueError(f"path is {path}: the picture is {self.format}, in which the name of the file ends")
        Path(path).write_bytes(self.data)

    def _repr_html_(self) -> str:
        kind = "image/svg+xml" if self.format == "svg" else "image/png"
        data = base64.b64encode(self.data).decode("ascii")
        return f'<img alt="{escape(self.title)}" src="data:{kind};base64,{data}">'

    def __repr__(self) -> str:
        return f"<impinge.Picture {self.format} of {self.title}, {len(self.data)} bytes>"


class View(NamedTuple):
    """The view of a picture; the fields are those of `PictureView` in Rust."""

    size: tuple[int, int]
    look: tuple[float, float, float]
    up: tuple[float, float, float]
    title: str


def picture(
    of: Drawable,
    *,
    size: Sequence[int] = (480, 360),
    look: Sequence[float] = (-0.7, -0.6, -1.0),
    up: Sequence[float] = (0.0, 1.0, 0.0),
) -> Picture:
    """A picture of a `Shape`, a `Scene` or a `World`, made without a display or a GPU.

    In 2D it is SVG of the width `size[0]`, x to the right and y upwards. In 3D it is PNG of the size (width, height) in pixels;
    the view is along the direction `look` with `up` upwards, and frames all objects. A world is drawn with the contacts and
    proximities of its last update. Equal input gives equal bytes.

    Errors: TypeError if `of` has another type, ValueError if `size` is not two numbers from 1 to 8192 or `look` or
    `up` are not three finite numbers.

    >>> import impinge
    >>> scene = impinge.Scene([impinge.Ball(1, dim=2), impinge.Cuboid([2, 1])], impinge.Poses([[0, 0], [3, 1]]))
    >>> impinge.picture(scene).data.startswith(b"<svg")
    True
    """
    view = View(_size(size), _direction(look, "look"), _direction(up, "up"), _title(of))
    if isinstance(of, _native.Shape):
        format_, data = _native.picture_of(of, None, view)
    elif hasattr(of, "_picture"):
        format_, data = of._picture(view)
    else:
        raise TypeError(f"of is {type(of).__name__}, where a Shape, Scene or World is needed")
    return Picture(format_, data, view.title)


def html_of(of: Drawable) -> str:
    """Returns the HTML of a notebook: a picture and a line of text."""
    caption = escape(_title(of))
    if not isinstance(of, _native.Shape) and len(of) > MANY:
        return f"<p>{caption} (impinge.picture shows them)</p>"
    return f"<figure>{picture(of)._repr_html_()}<figcaption>{caption}</figcaption></figure>"


def _title(of: object) -> str:
    return repr(of).strip("<>")


def _size(size: Sequence[int]) -> tuple[int, int]:
    numbers = [int(number) for number in size]
    if len(numbers) != 2 or not all(1 <= number <= 8192 for number in numbers):
        raise ValueError(f"size is {tuple(size)}, where two numbers from 1 to 8192 are needed")
    return numbers[0], numbers[1]


def _direction(given: Sequence[float], name: str) -> tuple[float, float, float]:
    numbers = [float(number) for number in given]
    if len(numbers) != 3 or not all(abs(number) < float("inf") for number in numbers):
        raise ValueError(f"{name} is {tuple(given)}, where three finite numbers are needed")
    return numbers[0], numbers[1], numbers[2]
