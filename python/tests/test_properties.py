"""Properties for random arrays: batches equal single queries to the bit, sides can be exchanged, nothing crashes."""

import pickle

import impinge
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

RELAXED = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
LENGTHS = st.floats(0.05, 5)
PLACES = st.floats(-4, 4)
DTYPES = st.sampled_from(["float32", "float64"])


@st.composite
def convex(draw, dim, dtype):
    """A convex shape of a random kind and size."""
    sizes = draw(st.lists(LENGTHS, min_size=3, max_size=3))
    ends = np.eye(3)[:2, :dim] * sizes[0]
    makers = [
        lambda: impinge.Ball(sizes[0], dim=dim, dtype=dtype),
        lambda: impinge.Cuboid(sizes[:dim], dtype=dtype),
        lambda: impinge.Ellipsoid(sizes[:dim], dtype=dtype),
        lambda: impinge.Capsule(ends=ends, radius=sizes[1], dtype=dtype),
        lambda: impinge.TaperedCapsule(ends=ends * 3, radii=sizes[1:], dtype=dtype),
        lambda: impinge.Segment(ends, dtype=dtype),
        lambda: impinge.Triangle(np.vstack([ends, -ends[:1] - ends[1:]]), dtype=dtype),
        lambda: impinge.Rounded(impinge.Cuboid(sizes[:dim], dtype=dtype), sizes[1]),
        lambda: impinge.ConvexHull(np.vstack([np.eye(dim) * sizes[:dim], -np.eye(dim)]), dtype=dtype),
    ]
    if dim == 3:
        makers += [
            lambda: impinge.Cylinder(sizes[0], sizes[1], dtype=dtype),
            lambda: impinge.Cone(sizes[0], sizes[1], dtype=dtype),
            lambda: impinge.Tetrahedron(np.vstack([np.zeros(3), np.diag(sizes)]), dtype=dtype),
        ]
    return draw(st.sampled_from(makers))()


@st.composite
def composite(draw, dim, dtype):
    """A random composite shape."""
    size = draw(LENGTHS)
    points = np.array([[-1, 0, 0], [1, 0, 0], [0, 1, 0], [0, 2, 1]])[:, :dim] * size
    heights = np.array([0, 1, 0.5]) if dim == 2 else np.array([[0, 1, 0], [0.5, 0, 1]])
    children = [draw(convex(dim, dtype)), impinge.Polyline(points, dtype=dtype)]
    places = impinge.Poses(np.eye(3)[:2, :dim] * size)
    makers = [
        lambda: impinge.Polyline(points, one_sided=dim == 2, dtype=dtype),
        lambda: impinge.TriMesh(points, [[0, 1, 2]], keep_internal_edges=True, dtype=dtype),
        lambda: impinge.HeightField(heights, [size] * dim, one_sided=True, dtype=dtype),
        lambda: impinge.Compound(children, places),
        lambda: impinge.Compound([impinge.Compound(children, places)], impinge.Poses(np.ones(dim)).matrices[None]),
    ]
    return draw(st.sampled_from(makers))()


@st.composite
def poses(draw, dim, dtype, count):
    places = draw(hnp.arrays(np.float64, (count, dim), elements=PLACES))
    turns = draw(hnp.arrays(np.float64, (count, 4), elements=st.floats(-1, 1)))
    turns[np.abs(turns).max(axis=1) < 0.1] = [0, 0, 0, 1]
    if dim == 2:
        made = impinge.Poses(places, angles=turns[:, 0] * 3)
    else:
        made = impinge.Poses(places, quaternions=turns, order="wxyz")
    return np.ascontiguousarray(made.matrices, dtype=dtype)


@st.composite
def sides(draw):
    dim, dtype, count = draw(st.sampled_from([2, 3])), draw(DTYPES), draw(st.integers(1, 4))
    one, other = (draw(st.one_of(convex(dim, dtype), composite(dim, dtype))) for _ in range(2))
    return one, draw(poses(dim, dtype, count)), other, draw(poses(dim, dtype, count))


def columns(answer):
    return answer if isinstance(answer, tuple) else (answer,)


@RELAXED
@given(sides())
def test_a_batch_is_its_single_questions(given_sides):
    one, poses1, other, poses2 = given_sides
    for ask in (impinge.distance, impinge.witness, impinge.contact, impinge.proximity, impinge.closest_points):
        batch = columns(ask(one, poses1, other, poses2))
        for row in range(len(poses1)):
            alone = columns(ask(one, poses1[row], other, poses2[row]))
            for many, single in zip(batch, alone, strict=True):
                np.testing.assert_array_equal(many[row], np.asarray(single, many.dtype))


@RELAXED
@given(sides())
def test_sides_can_be_exchanged(given_sides):
    one, poses1, other, poses2 = given_sides
    there, back = impinge.distance(one, poses1, other, poses2), impinge.distance(other, poses2, one, poses1)
    assert there.tobytes() == back.tobytes()
    there, back = impinge.proximity(one, poses1, other, poses2, 0.5), impinge.proximity(other, poses2, one, poses1, 0.5)
    assert there.tolist() == back.tolist()
    there, back = impinge.witness(one, poses1, other, poses2), impinge.witness(other, poses2, one, poses1)
    assert there.distance.tobytes() == back.distance.tobytes()


@RELAXED
@given(sides())
def test_scenes_come_back(given_sides):
    one, poses1, other, poses2 = given_sides
    shapes, placed = [one] * len(poses1) + [other] * len(poses2), np.concatenate([poses1, poses2])
    scene = impinge.Scene(shapes, placed)
    for again in (impinge.Scene.from_bytes(scene.to_bytes()), pickle.loads(pickle.dumps(scene))):
        assert again == scene and hash(again) == hash(scene) and again.to_bytes() == scene.to_bytes()
    copies = [pickle.loads(pickle.dumps(shape)) for shape in shapes]
    assert impinge.Scene(copies, placed) == scene, "equal shapes make equal scenes, shared or not"


ODD = st.one_of(
    hnp.arrays(
        st.sampled_from([np.float64, np.float32, np.int64, np.bool_, np.complex128, np.dtype("U3"), np.dtype("O")]),
        hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5),
    ),
    hnp.arrays(np.float64, (2, 4, 4), elements=st.sampled_from([0.0, 1.0, -1.0, np.nan, np.inf, 1e300, 1e-310])),
    hnp.arrays(np.float64, (2, 3), elements=st.sampled_from([0.0, 1.0, np.nan, np.inf, -np.inf, 1e300])),
    st.sampled_from([None, "poses", 3, object(), [], [[]], {}, [1, 2, 3], [[1, 2], [3]], np.eye(4), np.eye(3)]),
)
NUMBERS = st.one_of(st.floats(), st.integers(-3, 10**20), st.none(), st.text(max_size=2))
BALL, BOX = impinge.Ball(1), impinge.Cuboid([1, 2, 3])


def refuse_or_answer(call):
    """Allows no exceptions but ValueError and TypeError with a message."""
    try:
        return call()
    except (ValueError, TypeError) as error:
        assert str(error)
        return None


@settings(RELAXED, max_examples=150)
@given(ODD, ODD, NUMBERS, NUMBERS)
def test_no_array_crashes_a_question(array1, array2, number1, number2):
    calls = [
        lambda: impinge.distance(BALL, array1, BOX, array2),
        lambda: impinge.witness(BALL, array1, BOX, array2, number1),
        lambda: impinge.contact_manifolds(BALL, array1, BOX, array2, number1, number2),
        lambda: impinge.distance(BALL, array1, BOX, None, threads=number2),
        lambda: impinge.pairs_within(BALL, array1, distance=number1),
        lambda: impinge.impact(BALL, array1, array2, BOX, None, [1, 0, 0], number1, number2),
        lambda: impinge.impact(BALL, None, [1, 0, 0], BOX, None, array1, 9.0, angular_velocity1=array2),
        lambda: impinge.project_points(BALL, array1, array2),
        lambda: impinge.cast_rays(BALL, None, array1, array2, number1),
        lambda: impinge.distance(array1, None, BALL, array2),
        lambda: impinge.boxes(BALL, array1),
        lambda: impinge.Poses(array1, array2, order="xyzw"),
        lambda: impinge.Poses.from_matrices(array1),
        lambda: impinge.Picked([BALL, BOX], array1),
        lambda: impinge.Scene(BALL, array1),
        lambda: impinge.Ball(number1, dim=2),
        lambda: impinge.Capsule(number1, number2),
        lambda: impinge.Cuboid(array1),
        lambda: impinge.HalfSpace(array1),
        lambda: impinge.ConvexHull(array1),
        lambda: impinge.TriMesh(array1, array2),
        lambda: impinge.Polyline(array1, array2),
        lambda: impinge.HeightField(array1, array2),
        lambda: impinge.HeightField([[0, 0], [0, 0]], [1, 1, 1], holes=array1, backward=array2),
        lambda: impinge.Compound([BALL, BOX], array1),
    ]
    for call in calls:
        refuse_or_answer(call)


@settings(RELAXED, max_examples=100)
@given(ODD, ODD, NUMBERS, NUMBERS)
def test_no_array_crashes_or_changes_a_world(array1, array2, number1, number2):
    world = impinge.World()
    handles = world.add(BALL, impinge.Poses([[0, 0, 0], [3, 0, 0]]))
    before, count = world.poses().tobytes(), len(world)
    calls = [
        lambda: world.remove(array1),
        lambda: world.set_poses(array1, array2),
        lambda: world.set_shapes(handles, array1),
        lambda: world.set_vertices(array1, array2),
        lambda: world.set_groups(handles, membership=array1),
        lambda: world.set_query_types(handles, margin=number1),
        lambda: world.cast_rays(array1, array2, number1),
        lambda: world.ray_hits(array1, array2),
        lambda: world.cast_shape(BALL, array1, array2, number1, number2),
        lambda: world.nearest(BALL, array1, number1, number2),
        lambda: world.overlapping(array1, array2),
        lambda: world.containing(array1),
        lambda: world.project_points(array1, number1),
        lambda: world.in_boxes(array1, array2),
        lambda: world.cast_rays([0, 0, 0], [1, 0, 0], filter=impinge.Filter(exclude=array1)),
    ]
    for call in calls:
        try:
            call()
        except (ValueError, TypeError) as error:
            assert str(error)
            assert world.poses().tobytes() == before and len(world.shapes()) == count, "nothing is changed"
        else:
            before, count = world.poses().tobytes(), len(world)
    world.update()


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_any_layout_of_memory_is_read(dtype):
    ball, box = impinge.Ball(0.5, dtype=dtype), impinge.Cuboid([1, 1, 1], dtype=dtype)
    rng = np.random.default_rng(1)
    places = impinge.Poses(rng.uniform(-3, 3, (6, 3)), rng.normal(size=(6, 4)), order="xyzw").matrices.astype(dtype)
    expected = impinge.distance(box, None, ball, places).tobytes()
    strided = np.zeros((12, 4, 4), dtype)
    strided[::2] = places
    locked = places.copy()
    locked.flags.writeable = False
    swapped = places.astype(places.dtype.newbyteorder())
    for array in (np.asfortranarray(places), strided[::2], places[::-1][::-1], locked, swapped, places.tolist()):
        assert impinge.distance(box, None, ball, array).tobytes() == expected
    with pytest.raises(ValueError, match=r"poses2\[4\].*"):
        broken = np.asfortranarray(places)
        broken[4, 0, 0] = np.nan
        impinge.distance(box, None, ball, broken)


@RELAXED
@given(st.data())
def test_worlds_are_a_naive_model(data):
    """After bulk changes in any order, the touching pairs are those of single queries, and the events are the changes
    since the last update."""
    dim, dtype = data.draw(st.sampled_from([2, 3])), data.draw(DTYPES)
    world, model, before = impinge.World(dim=dim, dtype=dtype), {}, set()
    ball = impinge.Ball(0.75, dim=dim, dtype=dtype)
    for _ in range(data.draw(st.integers(1, 6))):
        what = data.draw(st.sampled_from(["add", "move", "remove", "shape", "record"]))
        known = sorted(model)
        some = data.draw(st.lists(st.sampled_from(known), unique=True)) if known else []
        new = data.draw(poses(dim, dtype, len(some) or 2))
        if what == "add":
            handles = world.add(ball, new)
            model |= {int(handle): (ball, pose) for handle, pose in zip(handles, new, strict=True)}
        elif what == "move" and some:
            world.set_poses(some, new)
            model |= {handle: (model[handle][0], pose) for handle, pose in zip(some, new, strict=True)}
        elif what == "remove":
            world.remove(some)
            model = {handle: known for handle, known in model.items() if handle not in some}
        elif what == "shape" and some:
            shape = data.draw(convex(dim, dtype))
            world.set_shapes(some, shape)
            model |= {handle: (shape, model[handle][1]) for handle in some}
        recording = world.record() if what == "record" else None
        world.update()
        handles = world.handles().tolist()
        assert sorted(handles) == sorted(model)
        expected = {
            (one, other)
            for place, one in enumerate(handles)
            for other in handles[place + 1 :]
            if impinge.proximity(model[one][0], world.poses([one])[0], model[other][0], world.poses([other])[0]) == 0
        }
        contacts = world.contacts()
        assert {(row["first"], row["second"]) for row in contacts.tolist() and contacts} == expected
        if recording is None:
            events = world.contact_events().tolist()
            started = {(one, other) for kind, one, other in events if kind == 1}
            stopped = {(one, other) for kind, one, other in events if kind == 0}
            assert started == expected - before and stopped == before - expected
        else:
            recording.stop()
        before = expected
