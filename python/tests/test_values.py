"""Shapes, worlds and checkers as values: equality, pickles, reading back, and all types of arguments."""

import copy
import pickle

import impinge
import numpy as np
import pytest
from test_pairs import SHAPES_2D, SHAPES_3D

TRIANGLES = [[0, 2, 1], [0, 3, 2]]
CORNERS = [[0, 0, 0], [4, 0, 0], [4, 0, 4], [0, 0, 4]]


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_equal_shapes(dim, dtype):
    makes = SHAPES_2D if dim == 2 else SHAPES_3D
    once, again = ([make(dtype) for make in makes] for _ in range(2))
    for row, one in enumerate(once):
        assert one == again[row] and hash(one) == hash(again[row]) and not one != again[row]
        assert one == pickle.loads(pickle.dumps(one))
        assert all(one != other for other in again[:row] + again[row + 1 :])
    assert len({*once, *again}) == len(makes)
    assert once[0] != "a shape" and once[0] != None  # noqa: E711
    assert once[0] != makes[0]("float32" if dtype == "float64" else "float64")


def test_names_are_those_of_the_functions():
    shapes = {
        "TriMesh": impinge.TriMesh(CORNERS, TRIANGLES),
        "Polyline": impinge.Polyline(CORNERS),
        "HeightField": impinge.HeightField(np.zeros((2, 2)), [1, 1, 1]),
        "Compound": impinge.Compound([impinge.Ball(1)], None),
        "ConvexHull": impinge.ConvexHull([*CORNERS, [1, 2, 1]]),
        "Tetrahedron": impinge.Tetrahedron([*CORNERS[:3], [1, 2, 1]]),
        "HalfSpace": impinge.HalfSpace([0, 1, 0]),
        "TaperedCapsule": impinge.TaperedCapsule(radii=[1, 2], ends=[[0, 0, 0], [1, 0, 0]]),
        "Rounded": impinge.Rounded(impinge.Cuboid([1, 1, 1]), 1),
    }
    for name, shape in shapes.items():
        assert (shape.name, repr(shape)) == (name, f"<impinge.{name} 3D float64>")
        assert pickle.loads(pickle.dumps(shape)).name == name
    assert impinge.ConvexHull([[0, 0], [1, 0], [0, 1]]).name == "ConvexHull"


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_vertices_and_faces_are_read_back(dtype):
    mesh = impinge.TriMesh(CORNERS, TRIANGLES, dtype=dtype)
    assert mesh.vertices.tolist() == CORNERS and mesh.vertices.dtype == dtype
    assert mesh.faces.tolist() == TRIANGLES and mesh.faces.dtype == np.uint32
    assert impinge.TriMesh(mesh.vertices, mesh.faces, dtype=dtype) == mesh
    line = impinge.Polyline([[0, 0], [1, 0], [1, 1]], dtype=dtype)
    assert line.vertices.tolist() == [[0, 0], [1, 0], [1, 1]] and line.faces.tolist() == [[0, 1], [1, 2]]
    hull = impinge.ConvexHull([*CORNERS, [1, 2, 1], [1, 0.5, 1]], dtype=dtype)
    assert sorted(hull.vertices.tolist()) == sorted([*CORNERS, [1, 2, 1]])
    assert impinge.Segment(CORNERS[:2], dtype=dtype).vertices.tolist() == CORNERS[:2]
    assert impinge.Triangle(CORNERS[:3], dtype=dtype).vertices.tolist() == CORNERS[:3]
    assert len(impinge.Tetrahedron([*CORNERS[:3], [1, 2, 1]], dtype=dtype).vertices) == 4
    for shape, what in ((impinge.Ball(1), "vertices"), (impinge.Ball(1), "faces"), (hull, "faces")):
        with pytest.raises(AttributeError, match=f"a {shape.name} has no {what}"):
            getattr(shape, what)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_a_hull_in_2d(dtype):
    square = [[0, 0], [1, 1], [1, 0], [0, 1], [0.5, 0.5]]
    hull = impinge.ConvexHull(square, dtype=dtype)
    assert sorted(hull.vertices.tolist()) == [[0, 0], [0, 1], [1, 0], [1, 1]]
    assert hull == impinge.ConvexHull(square[::-1], dtype=dtype) == pickle.loads(pickle.dumps(hull))
    points = np.random.default_rng(5).normal(size=(20, 2)).astype(dtype).astype(float)
    hull = impinge.ConvexHull(points, dtype=dtype)
    assert sorted(hull.vertices.tolist()) == starts_of_sides(points)
    assert 3 < len(hull.vertices) < 20 and impinge.contains(hull, None, points.astype(dtype) * 0.999).all()
    assert pickle.loads(pickle.dumps(hull)).vertices.tolist() == hull.vertices.tolist()


def starts_of_sides(points):
    """Returns the sorted points from which some line to another point has all other points on its left."""

    def is_side(one, two):
        (x, y), ways = points[two] - points[one], np.delete(points, [one, two], axis=0) - points[one]
        return (x * ways[:, 1] - y * ways[:, 0] > 0).all()

    count = range(len(points))
    return sorted(points[one].tolist() for one in count if any(is_side(one, two) for two in count if two != one))


def test_a_dense_hull_in_2d_is_pickled():
    # Points of this ellipse are within rounding of the line between their neighbours, so the hull leaves out almost half of
    # them, and the hull of its corners leaves out some more.
    angles = np.random.default_rng(1).uniform(0, 2 * np.pi, 5000)
    points = np.stack([np.cos(angles) * 0.5, np.sin(angles)], axis=1)
    hull = impinge.ConvexHull(points, dtype="float32")
    assert 2000 < len(hull.vertices) < 3000
    assert pickle.loads(pickle.dumps(hull)) == hull == impinge.ConvexHull(hull.vertices, dtype="float32")
    assert np.abs(impinge.signed_distance(hull, None, points.astype(np.float32))).max() < 1e-5


def test_points_without_an_area_have_no_hull():
    for points, message in {
        ((0, 0), (1, 1), (2, 2)): "the points span no solid: they lie on one line",
        ((1, 2), (1, 2), (1, 2)): "the points span no solid: they coincide",
        ((0, 0), (1, 1)): "2 points were given, at least 3 are needed",
    }.items():
        with pytest.raises(ValueError, match=message):
            impinge.ConvexHull(points)


@pytest.mark.parametrize("dtype", [np.float32, np.dtype("float32"), "float32"])
def test_dtypes_of_numpy(dtype):
    ball = impinge.Ball(1, dtype=dtype)
    assert ball.dtype == "float32" and ball == impinge.Ball(1, dtype="float32")
    assert impinge.World(dtype=dtype).dtype == "float32"
    scene = impinge.Scene(ball, None)
    assert impinge.Scene.from_bytes(scene.to_bytes(), dtype=dtype) == scene
    assert impinge.Tiles([0], [1.0], dtype=dtype).dtype == "float32"
    assert impinge.Ball(1, dtype=float).dtype == impinge.Ball(1, dtype=np.float64).dtype == "float64"


@pytest.mark.parametrize("dtype", ["float16", np.int64, None, "no type", np.complex128])
def test_other_dtypes_are_refused(dtype):
    for make in (impinge.Ball, lambda _, dtype: impinge.World(dtype=dtype)):
        with pytest.raises(ValueError, match="dtype is .*float32.*float64"):
            make(1, dtype=dtype)


def test_the_version():
    assert impinge.__version__.count(".") == 2 and "__version__" in impinge.__all__
    assert "install" in impinge.__doc__


def unaligned(array):
    """A copy of the array whose address is off by one byte."""
    room = np.empty(array.nbytes + 1, dtype=np.uint8)
    moved = room[1:].view(array.dtype).reshape(array.shape)
    moved[...] = array
    assert not moved.flags.aligned
    return moved


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_unaligned_arrays(dtype):
    ball = impinge.Ball(1, dtype=dtype)
    poses = np.tile(np.eye(4, dtype=dtype), (3, 1, 1))
    poses[:, 0, 3] = [3, 4, 5]
    points = poses[:, :3, 3].copy()
    assert impinge.distance(ball, None, ball, unaligned(poses)).tolist() == [1, 2, 3]
    assert impinge.distance(ball, None, ball, unaligned(poses[0])) == 1
    assert impinge.signed_distance(ball, None, unaligned(points)).tolist() == [2, 3, 4]
    assert impinge.cast_rays(ball, None, unaligned(points), unaligned(-points)).time.round(6).tolist()[1] == 0.75
    moving = impinge.impact(
        ball, None, unaligned(points[0]), ball, unaligned(poses), unaligned(-points), angular_velocity1=unaligned(points[0])
    )
    assert np.isfinite(moving.time).all()
    world = impinge.World(dtype=dtype)
    handles = world.add(ball, unaligned(poses))
    world.set_poses(handles, unaligned(poses))
    assert len(world.containing(unaligned(points)).handle) == 7
    assert impinge.TriMesh(unaligned(np.array(CORNERS, dtype=dtype)), unaligned(np.array(TRIANGLES)), dtype=dtype).name
    checker = impinge.Checker([impinge.Frame(joint="prismatic", axis=[1, 0, 0])], 1, [ball], [0], unaligned(poses[:1]))
    assert checker.is_free(unaligned(np.zeros((100, 1), dtype=dtype))).all()


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_a_pickled_world(dim, dtype):
    rng = np.random.default_rng(dim)
    world = impinge.World(0.125, dim=dim, dtype=dtype)
    ball = impinge.Ball(1, dim=dim, dtype=dtype)
    places = impinge.Poses(rng.uniform(-4, 4, (30, dim)))
    handles = world.add(ball, places, membership=[2], blacklist=[5])
    sensor = world.add(impinge.Cuboid([1] * dim, dtype=dtype), None, margin=0.5)
    # Indices that are freed and reused: their handles differ.
    world.remove(handles[[3, 20, 7]])
    again = world.add(ball, None, membership=[5], prediction=0.25)
    world.remove(world.add([ball] * 3, None)[1:])
    mesh = impinge.Polyline([[0] * dim, [1] * dim], dtype=dtype)
    world.add(mesh, None)
    copied = pickle.loads(pickle.dumps(world))
    assert (copied.dim, copied.dtype, len(copied)) == (dim, dtype, len(world))
    assert copied.handles().tolist() == world.handles().tolist()
    assert copied.shapes() == world.shapes() and (copied.poses() == world.poses()).all()
    for one in (world, copied):
        one.set_groups(again, membership=[1])
        one.update()
    for found in ("contacts", "proximities"):
        mine, theirs = (np.sort(getattr(one, found)(), order=["first", "second"]) for one in (world, copied))
        assert mine.tobytes() == theirs.tobytes()
    assert len(world.contacts()) > 3 and len(world.proximities()) > 0
    # Both continue in the same way: the next object has the same handle, and stale handles stay stale.
    assert world.add(ball, None).tolist() == copied.add(ball, None).tolist()
    assert world.add([ball] * 4, None).tolist() == copied.add([ball] * 4, None).tolist()
    with pytest.raises(ValueError, match="no such object"):
        copied.poses(handles[3:4])
    assert copied.proximities()["first"].tolist() == world.proximities()["first"].tolist() and sensor is not None
    with pytest.raises(ValueError, match="not closed"):
        copied.containing([0.0] * dim)


def test_a_pickled_world_whose_index_is_used_up():
    world, ball = impinge.World(), impinge.Ball(1)
    first, kept = world.add([ball] * 2, None)
    for _ in range(1 << 16):
        world.remove(first)
        (first,) = world.add(ball, None)
    copied = pickle.loads(pickle.dumps(world))
    assert first == 2 and copied.handles().tolist() == world.handles().tolist() == [kept, first]
    copied.update()
    assert len(copied.contacts()) == 1
    # The index 0, which the world does not use again, is the last one that the copy uses. Its handles are new.
    world.remove(first)
    copied.remove(first)
    after = [one.add([ball] * 2, None).tolist() for one in (world, copied)]
    assert after == [[1 << 32 | 2, 3], [1 << 32 | 2, 1 << 48]]
    with pytest.raises(ValueError, match="no such object"):
        copied.poses(0)


def test_a_recorded_world_is_not_pickled():
    world = impinge.World()
    with world.record("film"), pytest.raises(TypeError, match="film"):
        pickle.dumps(world)
    assert len(pickle.loads(pickle.dumps(world))) == 0


def test_a_pickled_checker():
    arm = [
        impinge.Frame(joint="revolute", axis=[0, 0, 1], column=0),
        impinge.Frame(0, impinge.Poses([1, 0, 0]), "revolute", [0, 0, 1], column=1),
    ]
    hands = impinge.Poses([[1, 0, 0], [1, 0, 0]])
    checker = impinge.Checker(arm, 2, [impinge.Ball(0.25)] * 2, [0, 1], hands, pairs=[[0, 1]])
    configurations = np.random.default_rng(0).uniform(-3, 3, (200, 2))
    for _ in range(2):
        copied = pickle.loads(pickle.dumps(checker))
        assert (copied.is_free(configurations) == checker.is_free(configurations)).all()
        assert (copied.nearest(configurations).pair == checker.nearest(configurations).pair).all()
        assert (copied.frames(configurations) == checker.frames(configurations)).all()
        checker.set_obstacles([impinge.Cuboid([0.5, 4, 4])], impinge.Poses([[2.5, 0, 0]]), ignored=[[0, 0]])
    assert 0 < copied.is_free(configurations).mean() < 1


def test_a_pickled_checker_keeps_its_axes():
    axis = np.array([1.0, 0, 0])
    checker = impinge.Checker([impinge.Frame(joint="prismatic", axis=axis)], 1, [impinge.Ball(1)], [0])
    before = checker.frames([2.0])
    assert before[0, :3, 3].tolist() == [2, 0, 0]
    axis[:] = 0, 1, 0
    for copied in (copy.copy(checker), copy.deepcopy(checker), pickle.loads(pickle.dumps(checker))):
        assert (copied.frames([2.0]) == before).all()


@pytest.mark.parametrize("digits", [3, 5, 8])
def test_the_nearest_pose_of_rounded_digits(digits):
    rng = np.random.default_rng(digits)
    exact = impinge.Poses(rng.normal(size=(50, 3)), rng.normal(size=(50, 4)), order="wxyz").matrices
    rounded = exact.round(digits)
    poses = impinge.Poses.nearest_to(rounded, tolerance=2 * 10.0**-digits)
    np.testing.assert_allclose(poses.matrices, exact, atol=2 * 10.0**-digits)
    products = np.swapaxes(poses.matrices[:, :3, :3], 1, 2) @ poses.matrices[:, :3, :3]
    np.testing.assert_allclose(products, np.tile(np.eye(3), (50, 1, 1)), atol=1e-14)
    assert (poses.matrices[:, :3, 3] == rounded[:, :3, 3]).all()
    impinge.distance(impinge.Ball(1), None, impinge.Ball(1), poses)
    flat = impinge.Poses([1, 2], angles=0.7).matrices.round(digits)
    assert impinge.Poses.nearest_to(flat, tolerance=2 * 10.0**-digits).matrices.shape == (3, 3)


def test_what_is_no_rounded_pose():
    good = np.eye(4)
    scaled, mirrored, projective = np.diag([1, 1, 1.25, 1]), np.diag([1.0, -1, 1, 1]), np.eye(4)
    projective[3, 0] = 0.5
    for bad in (scaled, mirrored, projective):
        with pytest.raises(ValueError, match=r"matrices\[1\] is no rounded pose: a number is [0-9.]+ off"):
            impinge.Poses.nearest_to([good, bad])
    with pytest.raises(ValueError, match=r"matrices\[0, 3\] is nan"):
        impinge.Poses.nearest_to(np.where(np.eye(4)[::-1] > 0, np.nan, good))
    with pytest.raises(ValueError, match="order is 'xzyw'"):
        impinge.Poses([0, 0, 0], [0, 0, 0, 1], order="xzyw")
