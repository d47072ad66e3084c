"""Queries of pairs against values known by arithmetic; batches equal single queries to the bit."""

import pickle

import impinge
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

SHAPES_3D = [
    lambda t: impinge.Ball(0.5, dtype=t),
    lambda t: impinge.Cuboid([0.5, 0.4, 0.3], dtype=t),
    lambda t: impinge.Capsule(0.4, 0.3, dtype=t),
    lambda t: impinge.Cylinder(0.5, 0.4, dtype=t),
    lambda t: impinge.Cone(0.5, 0.4, dtype=t),
    lambda t: impinge.Ellipsoid([0.6, 0.4, 0.3], dtype=t),
    lambda t: impinge.Rounded(impinge.Cuboid([0.3, 0.3, 0.3], dtype=t), 0.1),
    lambda t: impinge.Tetrahedron([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=t),
    lambda t: impinge.TaperedCapsule(0.4, [0.3, 0.1], dtype=t),
    lambda t: impinge.HalfSpace([0.6, 0.8, 0], dtype=t),
    lambda t: impinge.TriMesh([[-1, 0, -1], [1, 0, -1], [0, 0, 1]], [[0, 1, 2]], dtype=t),
    lambda t: impinge.Compound([impinge.Ball(0.3, dtype=t)] * 2, shifted([-0.5, 0.5], dtype=t)),
]
SHAPES_2D = [
    lambda t: impinge.Ball(0.5, dim=2, dtype=t),
    lambda t: impinge.Cuboid([0.5, 0.4], dtype=t),
    lambda t: impinge.Capsule(0.4, 0.3, dim=2, dtype=t),
    lambda t: impinge.ConvexHull([[0, 0], [1, 0], [0, 1]], dtype=t),
    lambda t: impinge.HalfSpace([0.6, 0.8], dtype=t),
    lambda t: impinge.Polyline([[-1, 0], [0, 0.2], [1, 0]], dtype=t),
]


def shifted(offsets, axis=0, dim=3, dtype="float64"):
    """Poses without rotation."""
    poses = np.tile(np.eye(dim + 1, dtype=dtype), (len(offsets), 1, 1))
    poses[:, axis, dim] = offsets
    return poses


def random_poses(count, dim, dtype, seed):
    rng = np.random.default_rng(seed)
    places = rng.uniform(-1.5, 1.5, (count, dim))
    if dim == 2:
        poses = impinge.Poses(places, angles=rng.uniform(-4, 4, count))
    else:
        poses = impinge.Poses(places, quaternions=rng.normal(size=(count, 4)), order="xyzw")
    return np.ascontiguousarray(poses.matrices, dtype=dtype)


def columns(answer):
    return answer if isinstance(answer, tuple) else (answer,)


def assert_row_is(batch, row, alone):
    """Checks equality to the bit, including the signs of zeros."""
    for many, one in zip(columns(batch), columns(alone), strict=True):
        assert many[row].tobytes() == np.asarray(one, many.dtype).tobytes(), (many[row], one)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(
    "ask",
    [
        impinge.distance,
        impinge.closest_points,
        impinge.witness,
        impinge.contact,
        impinge.proximity,
        lambda shape1, poses1, shape2, poses2: impinge.impact(
            shape1, poses1, poses2[..., 0, :-1].copy(), shape2, poses2, poses1[..., 1, :-1].copy(), 3.0
        ),
    ],
)
def test_a_batch_has_the_bits_of_single_questions(ask, dim, dtype):
    kinds = [make(dtype) for make in (SHAPES_2D if dim == 2 else SHAPES_3D)]
    poses1, poses2 = random_poses(9, dim, dtype, 1), random_poses(9, dim, dtype, 2)
    # A rotation by a quarter turn, with negative zeros.
    poses1[0] *= 0
    poses1[0, [0, 1], [1, 0]] = -1, 1
    poses1[0, range(2, dim + 1), range(2, dim + 1)] = 1
    for shape1 in kinds:
        for shape2 in kinds:
            batch = ask(shape1, poses1, shape2, poses2)
            for row in range(9):
                assert_row_is(batch, row, ask(shape1, poses1[row], shape2, poses2[row]))


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_points_and_rays_in_a_batch_have_the_bits_of_single_ones(dim, dtype):
    poses = random_poses(9, dim, dtype, 1)
    points, turned = poses[::-1, :dim, dim].copy(), -poses[:, :dim, dim]
    for shape in [make(dtype) for make in (SHAPES_2D if dim == 2 else SHAPES_3D)]:
        for ask in (
            lambda at, solid=shape: impinge.project_points(solid, poses[at], points[at]),
            lambda at, solid=shape: impinge.project_points(solid, poses[at], points[at], False),
            lambda at, solid=shape: impinge.signed_distance(solid, poses[at], points[at], surface=True),
            lambda at, solid=shape: impinge.contains(solid, poses[at], points[at], surface=True),
            lambda at, solid=shape: impinge.cast_rays(solid, poses[at], points[at], turned[at]),
            lambda at, solid=shape: impinge.cast_rays(solid, poses[at], points[at], turned[at], 1.0, False),
        ):
            batch = ask(slice(None))
            for row in range(9):
                assert_row_is(batch, row, ask(row))


@pytest.mark.parametrize("threads", [1, 2, None])
def test_threads_do_not_change_bytes(threads):
    box, cone = impinge.Cuboid([0.5, 0.4, 0.3]), impinge.Cone(0.5, 0.4)
    poses = random_poses(1000, 3, "float64", 3)
    expected = impinge.witness(box, None, cone, poses, threads=1)
    found = impinge.witness(box, None, cone, poses, threads=threads)
    assert [column.tobytes() for column in found] == [column.tobytes() for column in expected]


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_known_numbers(dtype):
    ball, box = impinge.Ball(1, dtype=dtype), impinge.Cuboid([1, 1, 1], dtype=dtype)
    poses = shifted([0, 2, 3, 7], dtype=dtype)
    assert impinge.distance(box, None, ball, poses).tolist() == [0, 0, 1, 5]
    assert impinge.distance(box, None, ball, poses).dtype == dtype
    found = impinge.witness(box, None, ball, poses)
    assert found.distance.tolist() == [-2, 0, 1, 5]
    assert found.point1[3].tolist() == [1, 0, 0] and found.point2[3].tolist() == [6, 0, 0]
    assert impinge.proximity(box, None, ball, poses, 1.0).tolist() == [0, 0, 1, 2]
    contact = impinge.contact(box, None, ball, poses, 1.0)
    assert contact.depth.tolist() == [2, 0, -1, -np.inf]
    assert np.isnan(contact.normal[3]).all() and contact.normal[2].tolist() == [1, 0, 0]
    assert impinge.nearest(box, None, ball, poses[2:]) == (0, 1.0)
    assert impinge.nearest(box, None, ball, poses[2:], 0.5) == (-1, np.inf)


def test_a_lone_pair_has_scalars():
    ball = impinge.Ball(1)
    assert isinstance(impinge.distance(ball, None, ball, shifted([3])[0]), float)
    found = impinge.witness(ball, None, ball, shifted([3])[0])
    assert isinstance(found.distance, float) and found.point1.shape == (3,)
    assert impinge.distance(ball, None, ball, shifted([3])).shape == (1,)
    assert impinge.distance([ball], None, ball, None).shape == (1,)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_the_answer_about_a_lone_pair_is_a_tuple_with_names(dtype):
    ball, here = impinge.Ball(1, dtype=dtype), shifted([3], dtype=dtype)[0]
    found = impinge.closest_points(ball, None, ball, here)
    assert type(found) is impinge.ClosestPoints
    distance, point1, point2 = found
    assert (distance, point1.dtype, point1.tolist(), point2.tolist()) == (1.0, dtype, [1, 0, 0], [2, 0, 0])
    assert point1.flags.writeable and point1.flags.owndata
    again = pickle.loads(pickle.dumps(found))
    assert type(again) is impinge.ClosestPoints and again.point2.tolist() == [2, 0, 0]
    assert impinge.nearest(ball, None, ball, here) == (0, 1.0)
    assert type(impinge.proximity(ball, None, ball, here)) is int
    assert type(impinge.contains(ball, None, [0, 0, 0])) is bool


def test_one_element_stands_for_all_and_picks_choose():
    small, large = impinge.Ball(1), impinge.Ball(2)
    picked = impinge.Picked([small, large], np.array([0, 1, 1]))
    here = shifted([10, 10, 20])
    assert impinge.distance(small, None, picked, here).tolist() == [8, 7, 17]
    assert impinge.distance([small, large, large], here, small, None).tolist() == [8, 7, 17]
    assert impinge.distance(picked, shifted([10])[0], small, None).tolist() == [8, 7, 7]


def test_manifolds_in_rows():
    floor, box = impinge.Cuboid([9, 1, 9]), impinge.Cuboid([1, 1, 1])
    rows = impinge.contact_manifolds(floor, None, box, shifted([1.75, 9, 1.5], axis=1))
    assert rows.starts.tolist() == [0, 4, 4, 8]
    np.testing.assert_allclose(rows.depth, [0.25] * 4 + [0.5] * 4, rtol=0, atol=1e-12)
    assert (rows.normal == [0, 1, 0]).all()
    corners = np.abs(rows.point1[:, [0, 2]])
    np.testing.assert_allclose(corners, 1, rtol=0, atol=1e-12)
    assert len(rows.of(1).depth) == 0 and len(rows.of(2).depth) == 4
    assert len(impinge.contact_manifolds(floor, None, box, shifted([1.5], axis=1), max_points=1).depth) == 1


def test_impacts():
    ball = impinge.Ball(1)
    velocities = np.array([[-2.0, 0, 0], [2, 0, 0]])
    found = impinge.impact(ball, None, [0, 0, 0], ball, shifted([6, 6]), velocities)
    assert found.time.tolist() == [2, np.inf] and found.is_reached.tolist() == [True, False]
    np.testing.assert_allclose(found.point1[0], [1, 0, 0], atol=1e-9)
    assert impinge.impact(ball, None, [0, 0, 0], ball, shifted([6])[0], [-2, 0, 0], 1.0).time == np.inf


@pytest.mark.parametrize("turn", [{}, {"angular_velocity1": [0, 0, 0]}])
def test_velocities_of_impacts_are_one_or_as_many_as_poses(turn):
    ball, still, slow = impinge.Ball(1), [0, 0, 0], [[-1, 0, 0], [-2, 0, 0]]
    here, three, none = shifted([6])[0], shifted([6] * 3), np.zeros((0, 3))
    found = impinge.impact(ball, None, still, ball, here, slow, **turn)
    np.testing.assert_allclose(found.time, [4, 2], rtol=0, atol=1e-9)
    assert found.point2.shape == (2, 3) and found.is_reached.all()
    for row in range(2):
        assert_row_is(found, row, impinge.impact(ball, None, still, ball, here, slow[row], **turn))
    first = impinge.impact([ball], here, slow, ball, None, still, **turn)
    np.testing.assert_allclose(first.time, [4, 2], rtol=0, atol=1e-9)
    assert impinge.impact(ball, None, still, ball, here, slow[1:], **turn).time.shape == (1,)
    for empty in (
        impinge.impact(ball, None, none, ball, here, [-2, 0, 0], **turn),
        impinge.impact(ball, None, none, ball, three[:0], none, **turn),
        impinge.impact(ball, None, still, ball, three[:0], [-2, 0, 0], **turn),
    ):
        assert empty.time.shape == (0,) and empty.normal.shape == (0, 3)


@pytest.mark.parametrize(
    ("velocity1", "velocity2", "message"),
    [
        (np.zeros((0, 3)), [-2, 0, 0], "velocity1 has 0 elements where 3 are needed"),
        ([0, 0, 0], np.zeros((0, 3)), "velocity2 has 0 elements where 3 are needed"),
        (np.zeros((2, 3)), [-2, 0, 0], "velocity1 has 2 elements where 3 are needed"),
        ([0, 0, 0], np.zeros((4, 3)), "velocity2 has 4 elements where 3 are needed"),
    ],
)
def test_velocities_of_another_length_are_refused(velocity1, velocity2, message):
    with pytest.raises(ValueError, match=message):
        impinge.impact(impinge.Ball(1), None, velocity1, impinge.Ball(1), shifted([6] * 3), velocity2)


def test_pairs_within_are_all_pairs_by_brute_force():
    rng = np.random.default_rng(5)
    poses = np.tile(np.eye(4), (120, 1, 1))
    poses[:, :3, 3] = rng.uniform(-4, 4, (120, 3))
    ball = impinge.Ball(0.5)
    apart = np.linalg.norm(poses[:, None, :3, 3] - poses[None, :, :3, 3], axis=-1) - 1
    for distance in (0.0, 0.3):
        near = np.argwhere(np.triu(apart <= distance, 1))
        assert impinge.pairs_within(ball, poses, distance=distance).tolist() == near.tolist()
        both = np.argwhere(apart[:40] <= distance)
        found = impinge.pairs_within(ball, poses[:40], ball, poses, distance=distance)
        assert found.tolist() == both.tolist() and found.dtype == np.uint32
    touching = impinge.pairs_within(ball, shifted([0, 1, 2.5]), distance=0.5)
    assert touching.tolist() == [[0, 1], [1, 2]], "the distance itself counts"


def test_pairs_within_of_one_shape_at_two_sides():
    ball, here = impinge.Ball(1), shifted([0, 9])
    assert impinge.pairs_within(ball, here[:1], poses2=here[:1]).tolist() == [[0, 0]]
    assert impinge.pairs_within(ball, here, poses2=shifted([9, 1, 0.5])).tolist() == [[0, 1], [0, 2], [1, 0]]
    assert impinge.pairs_within(ball, here, None, None).tolist() == impinge.pairs_within(ball, here).tolist() == []
    assert impinge.pairs_within(ball, here, ball).tolist() == [[0, 0]], "the second ball is at the identity"


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(*[st.floats(-1e6, 1e6)] * 3), min_size=1, max_size=20),
    st.floats(0.001, 1e3),
    st.floats(0.001, 1e3),
)
def test_balls_anywhere(places, radius1, radius2):
    poses = np.tile(np.eye(4), (len(places), 1, 1))
    poses[:, :3, 3] = places
    found = impinge.witness(impinge.Ball(radius1), None, impinge.Ball(radius2), poses)
    expected = np.linalg.norm(poses[:, :3, 3], axis=1) - radius1 - radius2
    scale = np.abs(poses[:, :3, 3]).max() + radius1 + radius2
    np.testing.assert_allclose(found.distance, expected, rtol=0, atol=1e-14 * scale)
    np.testing.assert_allclose(
        found.point2 - found.point1, found.distance[:, None] * found.normal, rtol=0, atol=1e-13 * scale
    )


def test_arrays_that_fit_are_not_copied_and_others_are_converted():
    ball, poses = impinge.Ball(1), shifted([3, 4, 5])
    poses.flags.writeable = False
    expected = impinge.distance(ball, None, ball, poses).tolist()
    for other in (
        poses.astype(np.float32),
        np.asfortranarray(poses),
        poses.tolist(),
        impinge.Poses.from_matrices(poses),
    ):
        assert impinge.distance(ball, None, ball, other).tolist() == expected
    wide = np.zeros((3, 4, 8))
    wide[:, :, ::2] = poses
    assert impinge.distance(ball, None, ball, wide[:, :, ::2]).tolist() == expected


def test_no_elements():
    ball = impinge.Ball(1)
    assert impinge.distance(ball, None, ball, np.zeros((0, 4, 4))).shape == (0,)
    assert impinge.contact_manifolds(ball, None, ball, np.zeros((0, 4, 4))).starts.tolist() == [0]
    assert impinge.pairs_within(ball, np.zeros((0, 4, 4))).shape == (0, 2)
