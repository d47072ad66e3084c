"""Compares the configuration checker with single queries of all pairs at the poses that it computes."""

import impinge
import numpy as np
import pytest
from impinge import Checker, Frame, Poses

NONE = [impinge.NO_BODY, impinge.NO_BODY]


def arm(dim, dtype):
    """A checker with three joints, three kinds of bodies and three obstacles."""
    axis = [0, 0, 1] if dim == 3 else None
    ahead = np.eye(dim + 1)
    ahead[0, dim] = 1
    side = np.eye(dim)[1]
    frames = [
        Frame(1, ahead, "revolute", axis, column=1, factor=-1.0, offset=0.25),
        Frame(None, None, "revolute", axis, column=0),
        Frame(0, ahead, "prismatic", side, column=2),
        Frame(2),
    ]
    shapes = [
        impinge.Ball(0.25, dim=dim, dtype=dtype),
        impinge.Cuboid([0.3] * dim, dtype=dtype),
        impinge.Capsule(0.2, 0.1, dim=dim, dtype=dtype),
        impinge.Ball(0.1, dim=dim, dtype=dtype),
    ]
    checker = Checker(frames, 3, shapes, [1, 0, 2, 3], None, [(0, 2), (3, 0), (1, 3)])
    poses = np.tile(np.eye(dim + 1), (3, 1, 1))
    poses[:, :2, dim] = [[1.5, 1.0], [-1.2, 0.4], [0.0, -2.0]]
    obstacles = [shapes[0], shapes[1], impinge.HalfSpace(side, dtype=dtype)]
    checker.set_obstacles(obstacles, poses, ignored=[(0, 1)])
    return checker, shapes, obstacles, poses


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_answers_are_those_of_single_calls(dim, dtype):
    checker, shapes, obstacles, places = arm(dim, dtype)
    configurations = np.random.default_rng(dim).uniform(-2, 2, (500, 3)).astype(dtype)
    configurations[7, 1] = np.nan
    finite = np.arange(500) != 7
    poses = checker.poses(configurations)
    assert poses.shape == (500, 4, dim + 1, dim + 1) and poses.dtype == dtype
    pairs = [(one, two) for one in range(4) for two in range(4, 7) if (one, two) != (0, 5)] + [(0, 2), (0, 3), (1, 3)]
    pairs.sort()

    def between(one, two):
        if two < 4:
            return impinge.distance(shapes[one], poses[finite, one], shapes[two], poses[finite, two])
        return impinge.distance(shapes[one], poses[finite, one], obstacles[two - 4], places[two - 4])

    all_distances = np.array([between(one, two) for one, two in pairs])
    for clearance in (0.0, 0.25):
        touching = all_distances <= clearance
        free = checker.is_free(configurations, clearance)
        assert not free[7] and 0 < free.sum() < 499
        np.testing.assert_array_equal(free[finite], ~touching.any(axis=0))
        first = checker.first_pair(configurations, clearance, threads=1)
        expected = [pairs[column.argmax()] if column.any() else NONE for column in touching.T]
        np.testing.assert_array_equal(first[finite], expected)
        assert first[7].tolist() == NONE
    found = checker.nearest(configurations)
    np.testing.assert_array_equal(found.distance[finite], all_distances.min(axis=0))
    np.testing.assert_array_equal(found.pair[finite], np.array(pairs)[all_distances.argmin(axis=0)])
    assert np.isnan(found.distance[7]) and found.pair[7].tolist() == NONE
    near = checker.nearest(configurations, 0.25).distance[finite]
    np.testing.assert_array_equal(near, np.where(found.distance[finite] <= 0.25, found.distance[finite], np.inf))
    np.testing.assert_array_equal(checker.frames(configurations[3])[1], checker.frames(configurations)[3, 1])


def test_meshes_answer_as_single_calls_however_often_they_are_asked():
    # A box that is open above: its convex hull is nearer than the surface.
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4]]
    cup, ball = impinge.TriMesh(corners, faces), impinge.Ball(0.2)
    slides = [Frame(None, None, "prismatic", axis, column) for column, axis in enumerate(np.eye(3))]
    frames = [slides[0], slides[1]._replace(parent=0), slides[2]._replace(parent=1), Frame()]
    checker = Checker(frames, 3, [cup, cup, ball], [3, 2, 2], None, [(0, 1), (0, 2)])
    configurations = np.random.default_rng(3).uniform(-1.2, 1.2, (1000, 3))
    poses = checker.poses(configurations)
    distances = np.array([impinge.distance(cup, poses[:, 0], other, poses[:, at]) for at, other in ((1, cup), (2, ball))])
    hull = impinge.distance(impinge.ConvexHull(corners), poses[:, 0], ball, poses[:, 2])
    assert ((hull == 0) & (distances[1] > 0)).any(), "in the cup"
    touching = (distances == 0).any(axis=0)
    assert 100 < touching.sum() < 900
    for _ in range(2):
        np.testing.assert_array_equal(checker.is_free(configurations), ~touching)
        np.testing.assert_array_equal(checker.nearest(configurations).distance, distances.min(axis=0))
    np.testing.assert_array_equal([checker.is_free(row)[0] for row in configurations[:100]], ~touching[:100])


def test_without_columns_and_bodies():
    checker = Checker([], 0)
    assert checker.is_free(np.zeros((3, 0))).tolist() == [True] * 3
    assert checker.poses(np.zeros((3, 0))).shape == (3, 0, 4, 4)
    still = Checker([Frame(origin=Poses([1, 0, 0]))], 0, [impinge.Ball(1)], [0])
    assert still.poses(np.zeros((2, 0)))[:, 0, 0, 3].tolist() == [1, 1]
    still.set_obstacles([impinge.Ball(1)])
    assert still.nearest(np.zeros((2, 0))).distance.tolist() == [0, 0]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Checker([Frame(1)], 0), "frame 0 has the parent 1 of 1 frames"),
        (lambda: Checker([Frame(1), Frame(0)], 0), "the parents of frame 0 have a loop"),
        (lambda: Checker([Frame(None, None, "revolute", [0, 0, 1], 2)], 2), "driven by column 2 of 2"),
        (lambda: Checker([Frame(None, None, "prismatic", [0, 0, 0])], 1), r"frames\[0\] has the axis"),
        (lambda: Checker([Frame()], 0, [impinge.Ball(1)], [1]), "body 0 is on frame 1 of 1"),
        (lambda: Checker([Frame()], 0, [impinge.Ball(1)], [0, 0]), "on has 2 elements, where 1 are needed"),
        (lambda: Checker([Frame()], 0, [impinge.Ball(1)] * 2, [0, 0], None, [(0, 2)]), r"`pairs\[0\]` is 0 and 2"),
        (lambda: Checker([Frame()], 0, [impinge.Ball(1)], [0]).set_obstacles([], None, [(0, 0)]), r"`ignored\[0\]`"),
        (lambda: Checker([Frame()], 2).is_free([0.0]), r"configurations has the shape \(1,\)"),
        (lambda: with_pairs([[0, 1], [2**32, 1]]), r"pairs\[1\] is \[4294967296, 1\]"),
        (lambda: with_pairs([[0, -1]]), r"pairs\[0\] is \[0, -1\]"),
        (lambda: with_pairs([[0.7, 1]]), r"pairs is float64 of the shape \(1, 2\)"),
        (lambda: with_pairs([[np.nan, 1]]), "pairs is float64"),
        (lambda: with_pairs([0, 1]), r"pairs is int64 of the shape \(2,\)"),
        (lambda: with_pairs([]).set_obstacles([impinge.Ball(1)], None, [[2**32, 0]]), r"ignored\[0\] is \[4294967296"),
        (lambda: Checker([Frame()], 0, [impinge.Ball(1)], [-1]), r"on\[0\] is -1"),
        (lambda: Checker([Frame(-1)], 0), r"frames\[0\].parent is -1"),
        (lambda: Checker([Frame(None, None, "revolute", [0, 0, 1], -1)], 1), r"frames\[0\].column is -1"),
        (lambda: with_pairs([]).is_free([[]], np.nan), "clearance is nan"),
        (lambda: with_pairs([]).first_pair([[]], np.nan), "clearance is nan"),
        (lambda: with_pairs([]).nearest([[]], np.nan), "limit is nan"),
    ],
)
def test_what_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def with_pairs(pairs):
    """A checker of two bodies on a fixed frame."""
    return Checker([Frame()], 0, [impinge.Ball(1)] * 2, [0, 0], None, pairs)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Checker([Frame(), Frame()], 0, [impinge.Ball(1)], [1.9]), r"on\[0\] is 1.9"),
        (lambda: Checker([Frame(0.9), Frame()], 0), r"frames\[0\].parent is 0.9"),
        (lambda: Checker([Frame(None, None, "revolute", [0, 0, 1], 0.9)], 1), r"frames\[0\].column is 0.9"),
    ],
)
def test_indices_are_integers(call, message):
    with pytest.raises(TypeError, match=message):
        call()
    indices = np.array([1, 0], dtype=np.uint8)
    balls = [impinge.Ball(1)] * 2
    assert not Checker([Frame(), Frame()], 0, balls, indices, None, indices[None]).is_free([[]]).any(), "any integers"
