"""Recordings of worlds: bytes that replay to the bit, and a page that shows them."""

from __future__ import annotations

from html import escape
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from impinge import _native

if TYPE_CHECKING:
    from impinge._world import World

NO_PAGE = (
    "this build of impinge has no page: it was built without the feature `page` "
    "(see python/README.md); the command `impinge export FILE.implog -o FILE.html` makes the page of a saved recording"
)


class Recording:
    """A recording of every change and update of a world between `World.record` and `stop`.

    A `with` block ends the recording at its end. `save` writes one HTML file that replays the recording in any browser, without a
    network, or the recording itself as `.implog`. A notebook shows it in place, `height` pixels high.

    >>> import impinge
    >>> world = impinge.World()
    >>> ball = world.add(impinge.Ball(1), None)
    >>> with world.record("A ball falls") as recording:
    ...     for height in (3, 2, 1):
    ...         world.set_poses(ball, impinge.Poses([0, height, 0]))
    ...         world.update()
    >>> recording
    <impinge.Recording 'A ball falls', 3D float64, 4 updates>
    """

    def __init__(self, world: World, title: str) -> None:
        self._world: World | None = world
        self.title = title
        self.dim, self.dtype = world.dim, world.dtype
        self.updates = 0
        self.height = 480
        self._bytes = b""

    def stop(self) -> None:
        """Ends the recording; the world can still be used. A second call does nothing."""
        if self._world is not None:
            world, self._world = self._world, None
            self._bytes = world._stop()

    def to_bytes(self) -> bytes:
        """Returns the recording in the format of the command `impinge` and the crate `impinge-record`. ValueError before `stop`."""
        if self._world is not None:
            raise ValueError("the recording has not stopped: leave its `with` block, or call stop()")
        return self._bytes

    def to_html(self) -> str:
        """Returns an HTML page. RuntimeError if the package was built without the page, ValueError before `stop`."""
        page = _native.recording_page(self.to_bytes(), self.title)
        if page is None:
            raise RuntimeError(NO_PAGE)
        return page

    def save(self, path: str | PathLike[str]) -> None:
        """Writes a file with the extension `.html` (see `to_html`) or `.implog` (see `to_bytes`)."""
        target = Path(path)
        if target.suffix == ".html":
            target.write_text(self.to_html(), encoding="utf-8")
        elif target.suffix == ".implog":
            target.write_bytes(self.to_bytes())
        else:
            raise ValueError(f"path is {path}: the name of a recording ends in .html or .implog")

    def _repr_html_(self) -> str:
        if self._world is not None:
            return f"<p>{escape(repr(self))}</p>"
        page = _native.recording_page(self._bytes, self.title)
        if page is None:
            return f"<p>{escape(repr(self))}: {escape(NO_PAGE)}</p>"
        style = f"width: 100%; height: {int(self.height)}px; border: 1px solid #ccc"
        return f'<iframe title="{escape(self.title)}" style="{style}" srcdoc="{escape(page)}"></iframe>'

    def __enter__(self) -> Recording:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def __repr__(self) -> str:
        state = "" if self._world is None else ", not stopped"
        return f"<impinge.Recording {self.title!r}, {self.dim}D {self.dtype}, {self.updates} updates{state}>"
