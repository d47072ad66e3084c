"""Shapes, poses and scenes as values."""

import pickle

import impinge
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_pairs import SHAPES_2D, SHAPES_3D, random_poses

MORE_3D = [
    impinge.HalfSpace([1, 2, 3]),
    impinge.Capsule(ends=[[0, 0, 0], [1, 2, 3]], radius=0.5),
    impinge.TaperedCapsule(1.0, [0.5, 0.2]),
    impinge.Segment([[0, 0, 0], [1, 0, 0]]),
    impinge.Triangle([[0, 0, 0], [1, 0, 0], [0, 1, 0]]),
    impinge.ConvexHull(np.random.default_rng(1).normal(size=(20, 3))),
    impinge.HeightField(np.arange(12.0).reshape(3, 4) % 5, [4, 0.5, 3]),
    impinge.Compound([impinge.Ball(1), impinge.Cuboid([1, 1, 1])], impinge.Poses([[0, 0, 0], [3, 0, 0]])),
]
ALL = MORE_3D + [make(t) for make in SHAPES_3D + SHAPES_2D for t in ("float32", "float64")]


@pytest.mark.parametrize("shape", ALL, ids=repr)
def test_shapes_are_pickled(shape):
    again = pickle.loads(pickle.dumps(shape))
    assert repr(again) == repr(shape)
    ball = impinge.Ball(0.25, dim=shape.dim, dtype=shape.dtype)
    poses = random_poses(50, shape.dim, shape.dtype, 4)
    before, after = (impinge.witness(one, None, ball, poses) for one in (shape, again))
    assert [column.tobytes() for column in before] == [column.tobytes() for column in after]


def test_half_space_keeps_its_direction():
    found = impinge.signed_distance(impinge.HalfSpace([0, 0, 2], dtype="float32"), None, [[0, 0, 3], [5, 5, -1]])
    assert found.tolist() == [3, -1]


def test_heights_lie_where_they_should():
    field = impinge.HeightField([[0, 0, 0], [0, 2, 0], [0, 0, 0]], [4, 0.5, 4])
    assert impinge.cast_rays(field, None, [0, 9, 0], [0, -1, 0]).time == 8, "half of the height of two, in the middle"
    assert impinge.cast_rays(field, None, [2, 9, 2], [0, -1, 0]).time == 9
    assert impinge.cast_rays(field, None, [2.1, 9, 2], [0, -1, 0]).time == np.inf


def test_points_and_rays():
    box = impinge.Cuboid([1, 2, 3])
    assert impinge.signed_distance(box, None, [[4, 0, 0], [0, 0, 0], [1, 2, 3]]).tolist() == [3, -1, 0]
    assert impinge.contains(box, None, [[1, 2, 3], [1.001, 0, 0]]).tolist() == [True, False]
    found = impinge.project_points(box, None, [[5, 5, 0], [0.5, 0, 0]], solid=False)
    assert found.point.tolist() == [[1, 2, 0], [1, 0, 0]] and found.is_inside.tolist() == [False, True]
    hits = impinge.cast_rays(box, None, [[-5, 0, 0], [-5, 9, 0], [0, 0, 0]], [2, 0, 0])
    assert hits.time.tolist() == [2, np.inf, 0]
    assert impinge.cast_rays(box, None, [0, 0, 0], [2, 0, 0], solid=False).time == 0.5
    assert impinge.cast_rays(box, None, [-5, 0, 0], [2, 0, 0], 1.5).time == np.inf


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(-10, 10), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 1e-3))
def test_quaternions_turn_as_scipy_does(quaternion):
    rotation = pytest.importorskip("scipy.spatial.transform").Rotation.from_quat(quaternion)
    for poses in (
        impinge.Poses([1, 2, 3], quaternion, order="xyzw"),
        impinge.Poses([1, 2, 3], np.roll(quaternion, 1), order="wxyz"),
        impinge.Poses.from_rotation(rotation, [1, 2, 3]),
    ):
        np.testing.assert_allclose(poses.matrices[:3, :3], rotation.as_matrix(), atol=1e-12)
        assert poses.matrices[:3, 3].tolist() == [1, 2, 3] and poses.matrices[3].tolist() == [0, 0, 0, 1]


def test_angles_are_counter_clockwise():
    poses = impinge.Poses([[0, 0], [1, 2]], angles=[np.pi / 2, 0])
    np.testing.assert_allclose(poses.matrices[0] @ [1, 0, 1], [0, 1, 1], atol=1e-15)
    assert len(poses) == 2 and poses[1].matrices.tolist() == [[1, 0, 1], [0, 1, 2], [0, 0, 1]]


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_scenes_are_values(dim, dtype):
    shapes = [make(dtype) for make in (SHAPES_2D if dim == 2 else SHAPES_3D)]
    poses = random_poses(len(shapes), dim, dtype, 7)
    scene = impinge.Scene(shapes, poses)
    np.testing.assert_allclose(scene.poses, poses, atol=1e-6)
    again = impinge.Scene.from_bytes(scene.to_bytes(), dim=dim, dtype=dtype)
    assert again == scene and hash(again) == hash(scene) and again.checksum == scene.checksum
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert impinge.Scene(shapes, np.roll(poses, 1, axis=0)) != scene
    ball = impinge.Ball(0.5, dim=dim, dtype=dtype)
    before, after = (impinge.distance(one.shapes, one.poses, ball, None) for one in (scene, again))
    assert before.tobytes() == after.tobytes()


def test_damaged_scenes_are_refused():
    data = impinge.Scene([impinge.Ball(1)], None).to_bytes()
    for cut in range(len(data)):
        with pytest.raises(ValueError):
            impinge.Scene.from_bytes(data[:cut])
    for place in range(len(data)):
        damaged = bytearray(data)
        damaged[place] ^= 1
        with pytest.raises(ValueError):
            impinge.Scene.from_bytes(bytes(damaged))
    with pytest.raises(ValueError):
        impinge.Scene.from_bytes(data, dtype="float32")
