"""Pictures for notebooks, and recordings as files."""

import base64
import re
import zlib

import impinge
import numpy as np
import pytest
from impinge import _native

HAS_PAGE = _native.recording_page(impinge.Scene(impinge.Ball(1), None).to_bytes(), "a page") is not None


def pixels(png):
    """The samples of a PNG with 8 bits and no interlacing. The filters are not undone: the bytes are compared only."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = (int.from_bytes(png[at : at + 4], "big") for at in (16, 20))
    place, data = 8, b""
    while place < len(png):
        length = int.from_bytes(png[place : place + 4], "big")
        if png[place + 4 : place + 8] == b"IDAT":
            data += png[place + 8 : place + 8 + length]
        place += length + 12
    return (width, height), zlib.decompress(data)


def world_of_two(dim=3, dtype="float64"):
    world = impinge.World(dim=dim, dtype=dtype)
    world.add(impinge.Cuboid([3] + [0.5] * (dim - 1), dtype=dtype), None)
    place = [0, 1.25, 0][:dim]
    ball = world.add(impinge.Ball(1, dim=dim, dtype=dtype), impinge.Poses(place))
    world.update()
    return world, ball


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_pictures_in_3d(dtype):
    world, _ = world_of_two(dtype=dtype)
    picture = impinge.picture(world, size=(200, 150))
    size, samples = pixels(picture.data)
    assert picture.format == "png" and size == (200, 150) and len(set(samples)) > 20, "something is drawn"
    assert picture == impinge.picture(world, size=(200, 150)), "the same bytes"
    assert picture != impinge.picture(world, size=(200, 150), look=(0, -1, 0), up=(0, 0, 1))


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_pictures_in_2d(dtype, tmp_path):
    world, _ = world_of_two(2, dtype)
    picture = impinge.picture(world)
    text = picture.data.decode()
    assert picture.format == "svg" and text.count('class="object"') == 1 and "contact-point" in text
    picture.save(tmp_path / "world.svg")
    assert (tmp_path / "world.svg").read_bytes() == picture.data
    with pytest.raises(ValueError, match="svg"):
        picture.save(tmp_path / "world.png")


@pytest.mark.parametrize("dim", [2, 3])
def test_notebooks_show_pictures(dim):
    world, _ = world_of_two(dim)
    scene = impinge.Scene(world.shapes(), world.poses())
    for shown in (world, scene, scene.shapes[0]):
        html = shown._repr_html_()
        found = re.search(r'<img alt="([^"]*)" src="data:image/(png|svg\+xml);base64,([^"]*)">', html)
        assert found and found[1].startswith("impinge.") and len(base64.b64decode(found[3])) > 300
        assert "&lt;" not in html and html.startswith("<figure>")


def test_many_objects_are_counted_not_drawn():
    world = impinge.World()
    world.add(impinge.Ball(1), np.tile(np.eye(4), (301, 1, 1)))
    assert world._repr_html_() == "<p>impinge.World of 301 objects, 3D float64 (impinge.picture shows them)</p>"


@pytest.mark.parametrize(
    ("options", "part"),
    [({"size": (0, 5)}, "size"), ({"size": (5,)}, "size"), ({"look": (1, 2)}, "look"), ({"up": (0, np.nan, 0)}, "up")],
)
def test_pictures_that_are_refused(options, part):
    with pytest.raises(ValueError, match=part):
        impinge.picture(impinge.Ball(1), **options)
    with pytest.raises(TypeError, match="of is int"):
        impinge.picture(5)


def recorded(dim=3, dtype="float64"):
    world, ball = world_of_two(dim, dtype)
    with world.record("A <ball> rises") as recording:
        for height in (1.5, 2.0, 3.0):
            place = [0, height, 0][:dim]
            world.set_poses(ball, impinge.Poses(place))
            world.update()
        world.remove(ball)
        world.update()
    return world, recording


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_recordings_hold_what_happened(dim, dtype, tmp_path):
    world, recording = recorded(dim, dtype)
    assert len(world) == 1 and recording.updates == 5
    recording.save(tmp_path / "run.implog")
    data = (tmp_path / "run.implog").read_bytes()
    assert data == recording.to_bytes()
    last = impinge.Scene.from_bytes(data)
    assert (last.dim, last.dtype, len(last)) == (dim, dtype, 1), "the scene at the end"
    damaged = bytearray(data)
    damaged[len(data) // 2] ^= 1
    with pytest.raises(ValueError):
        impinge.Scene.from_bytes(bytes(damaged))


def test_a_recorded_world_says_what_others_say():
    plain, ball = world_of_two()
    other, same = world_of_two()
    with other.record():
        for height in (1.5, 1.25, 2.0, 0.5):
            for world, handle in ((plain, ball), (other, same)):
                world.set_poses(handle, impinge.Poses([0, height, 0]))
                world.update()
            assert plain.contacts().tobytes() == other.contacts().tobytes()
            assert plain.contact_events().tolist() == other.contact_events().tolist()
            assert plain.handles().tolist() == other.handles().tolist()
        stale = other.add(impinge.Ball(1), None)
        other.remove(stale)
        with pytest.raises(ValueError, match="handles"):
            other.remove(stale)
        with pytest.raises(ValueError, match=r"poses\[1\]"):
            other.add(impinge.Ball(1), np.array([np.eye(4), np.full((4, 4), np.nan)]))
        assert len(other) == 2
        other.set_shapes(same, impinge.Cuboid([1, 1, 1]))
        other.set_groups(same, membership=[3])
        other.set_query_types(same, margin=1)


def test_one_recording_at_a_time():
    world, _ = world_of_two()
    recording = world.record("first")
    with pytest.raises(ValueError, match="first"):
        world.record("second")
    with pytest.raises(ValueError, match="not stopped"):
        recording.to_bytes()
    assert "not stopped" in recording._repr_html_()
    recording.stop()
    recording.stop()
    assert world.record("second").title == "second"


def test_names_of_files(tmp_path):
    _, recording = recorded()
    with pytest.raises(ValueError, match=r"\.html or \.implog"):
        recording.save(tmp_path / "run.txt")


@pytest.mark.skipif(not HAS_PAGE, reason="this build of the package has no page")
def test_the_page(tmp_path):
    _, recording = recorded()
    recording.save(tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text()
    assert page == recording.to_html() and page.startswith("<!") and "A &lt;ball&gt; rises" in page
    shown = recording._repr_html_()
    assert shown.startswith('<iframe title="A &lt;ball&gt; rises"') and shown.endswith("</iframe>")
    assert shown.count('"') == 6, "the page is inside an attribute"


@pytest.mark.skipif(HAS_PAGE, reason="this build of the package has the page")
def test_without_the_page_it_says_what_is_missing(tmp_path):
    _, recording = recorded()
    with pytest.raises(RuntimeError, match="feature `page`"):
        recording.save(tmp_path / "run.html")
    assert not (tmp_path / "run.html").exists()
    assert "feature `page`" in recording._repr_html_() and "implog" in recording._repr_html_()
