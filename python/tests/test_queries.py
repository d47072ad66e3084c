"""Every query of worlds: values known by arithmetic, filters, and equal results of batches and single queries."""

import _thread
import threading
import time

import impinge
import numpy as np
import pytest
from test_errors import Bar


def on_x(*places, dim=3, dtype="float64"):
    poses = np.tile(np.eye(dim + 1, dtype=dtype), (len(places), 1, 1))
    poses[:, 0, dim] = places
    return poses


def row_of_balls(dim=3, dtype="float64"):
    world = impinge.World(dim=dim, dtype=dtype)
    handles = world.add(impinge.Ball(1, dim=dim, dtype=dtype), on_x(0, 5, 10, dim=dim, dtype=dtype))
    world.update()
    return world, handles


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_known_numbers(dim, dtype):
    world, balls = row_of_balls(dim, dtype)
    small, x, zero = impinge.Ball(0.5, dim=dim, dtype=dtype), np.eye(dim)[0], np.zeros(dim)
    hits = world.ray_hits([-5 * x, 20 * x], [x, -x], 12)
    assert hits.starts.tolist() == [0, 2, 3] and hits.time.tolist() == [4, 9, 9] and hits.time.dtype == dtype
    assert hits.handle.tolist() == [balls[0], balls[1], balls[2]]
    cast = world.cast_shape(small, on_x(-5, dim=dim, dtype=dtype), 2 * x)
    assert cast.time.tolist() == [1.75] and cast.handle.tolist() == [balls[0]]
    np.testing.assert_allclose(cast.point1[0], -x, atol=1e-5)
    casts = world.cast_shape_all(small, on_x(-5, dim=dim, dtype=dtype), 2 * x)
    np.testing.assert_allclose(casts.time, [1.75, 4.25, 6.75], atol=1e-5)
    near = world.within(small, on_x(2, dim=dim, dtype=dtype), 2)
    assert near.handle.tolist() == [balls[0], balls[1]] and near.distance.tolist() == [0.5, 1.5]
    assert near.point1[0][0] == 1.5 and near.point2[0][0] == 1
    assert world.overlapping(small, on_x(0, 2, 5.5, dim=dim, dtype=dtype)).starts.tolist() == [0, 1, 1, 2]
    assert world.overlaps_any(small, on_x(0, 2, 5.5, dim=dim, dtype=dtype)).tolist() == [True, False, True]
    found = world.project_points([3 * x, zero, 99 * x], 10)
    assert found.point[:2].tolist() == [(4 * x).tolist(), zero.tolist()] and np.isnan(found.point[2]).all()
    assert found.is_inside.tolist() == [False, True, False]
    assert found.handle.tolist() == [balls[1], balls[0], impinge.NO_OBJECT]
    nearest = world.nearest_to_points(3 * x, count=2)
    assert nearest.handle.tolist() == [balls[1], balls[0]] and nearest.distance.tolist() == [1, 2]
    boxes = world.in_boxes([zero - 0.5, 4 * x], [zero + 0.5, 20 * x + 1])
    assert boxes.starts.tolist() == [0, 1, 3] and boxes.handle.tolist() == list(balls)
    assert world.containing(zero).handle.tolist() == [balls[0]]


def test_filters_leave_out():
    world = impinge.World()
    red = world.add(impinge.Ball(1), on_x(0), membership=[1])
    blue = world.add(impinge.Ball(1), on_x(5), membership=[2])
    ray = [-5, 0, 0], [1, 0, 0]
    assert world.cast_rays(*ray).handle[0] == red[0]
    for filter in (
        impinge.Filter(exclude=red),
        impinge.Filter(whitelist=[2]),
        impinge.Filter(blacklist=[1]),
        impinge.Filter(blacklist=[1], exclude=red),
    ):
        assert world.cast_rays(*ray, filter=filter).handle[0] == blue[0]
        assert world.ray_hits(*ray, filter=filter).handle.tolist() == [blue[0]]
        assert world.cast_shape(impinge.Ball(1), on_x(-5), [1, 0, 0], filter=filter).handle[0] == blue[0]
        assert world.cast_shape_all(impinge.Ball(1), on_x(-5), [1, 0, 0], filter=filter).handle[0] == blue[0]
        assert world.nearest(impinge.Ball(1), on_x(0), filter=filter).handle[0] == blue[0]
        assert world.within(impinge.Ball(1), on_x(0), 9, filter=filter).handle.tolist() == [blue[0]]
        assert world.overlapping(impinge.Ball(9), None, filter=filter).handle.tolist() == [blue[0]]
        assert not world.overlaps_any(impinge.Ball(1), on_x(-1), filter=filter)[0]
        assert world.containing([0, 0, 0], filter=filter).starts.tolist() == [0, 0]
        assert world.project_points([0, 0, 0], filter=filter).handle[0] == blue[0]
        assert world.nearest_to_points([0, 0, 0], filter=filter).handle[0] == blue[0]
        assert world.in_boxes([-9, -9, -9], [9, 9, 9], filter=filter).handle.tolist() == [blue[0]]
    with pytest.raises(ValueError, match=r"exclude\[0\] is 99"):
        world.cast_rays(*ray, filter=impinge.Filter(exclude=[99]))
    with pytest.raises(TypeError, match="filter is list"):
        world.cast_rays(*ray, filter=[1])
    with pytest.raises(ValueError, match=r"whitelist\[1\] is 30"):
        impinge.Filter(whitelist=[0, 30])


def test_batches_have_the_answers_of_single_questions():
    """Equal to the bit for any number of threads; the progress bar counts every element."""
    rng = np.random.default_rng(1)
    world = impinge.World()
    places = impinge.Poses(rng.uniform(-9, 9, (200, 3)), rng.normal(size=(200, 4)), order="xyzw").matrices
    world.add(impinge.Cuboid([0.5, 0.4, 0.3]), places)
    probes = impinge.Poses(rng.uniform(-9, 9, (500, 3))).matrices
    points, turned = probes[:, :3, 3].copy(), rng.normal(size=(500, 3))
    cone = impinge.Cone(0.5, 0.4)
    questions = [
        lambda at, **more: world.cast_rays(points[at], turned[at], **more),
        lambda at, **more: world.ray_hits(points[at], turned[at], **more),
        lambda at, **more: world.cast_shape(cone, probes[at], turned[at], **more),
        lambda at, **more: world.cast_shape_all(cone, probes[at], turned[at], 5.0, **more),
        lambda at, **more: world.nearest(cone, probes[at], 3, **more),
        lambda at, **more: world.overlapping(cone, probes[at], **more),
        lambda at, **more: (world.overlaps_any(cone, probes[at], **more),),
        lambda at, **more: world.containing(points[at], **more),
        lambda at, **more: world.project_points(points[at], **more),
        lambda at, **more: world.nearest_to_points(points[at], 2, **more),
        lambda at, **more: world.in_boxes(points[at], points[at] + 1, **more),
    ]
    for ask in questions:
        bar = Bar()
        batch = ask(slice(None), progress=bar)
        assert bar.total == 500
        for threads in (1, 3):
            again = ask(slice(None), threads=threads)
            assert [column.tobytes() for column in again] == [column.tobytes() for column in batch]
        has_rows = getattr(batch, "_fields", ("",))[0] == "starts"
        for element in (0, 63, 64, 499):
            alone = ask(element)
            begin, end = (batch.starts[element : element + 2]) if has_rows else (element, element + 1)
            for many, one in list(zip(batch, alone, strict=True))[int(has_rows) :]:
                np.testing.assert_array_equal(many[begin:end], one)


def test_a_failing_bar_ends_a_query_and_the_world_goes_on():
    world, _ = row_of_balls()
    with pytest.raises(RuntimeError, match="enough"):
        world.cast_rays(np.zeros((100_000, 3)), [1, 0, 0], progress=Bar(RuntimeError("enough")))
    assert world.cast_rays([-5, 0, 0], [1, 0, 0]).time[0] == 4


@pytest.mark.parametrize(
    ("call", "parts"),
    [
        (lambda world: world.cast_rays([0, 0], [1, 0, 0]), ["origins", "(2,)"]),
        (lambda world: world.cast_rays(np.zeros((2, 3)), np.zeros((3, 3))), ["directions", "3", "2"]),
        (lambda world: world.cast_rays([0, 0, 0], [1, 0, 0], np.nan), ["max_time is nan"]),
        (lambda world: world.cast_rays([0, 0, 0], [1, 0, 0], threads=0), ["threads is 0"]),
        (lambda world: world.cast_rays([0, 0, 0], [1, 0, 0], threads=-1), ["threads is -1"]),
        (lambda world: world.nearest(impinge.Ball(1), None, -1), ["count is -1"]),
        (lambda world: world.in_boxes([[0, 0, 0], [1, 0, 0]], [[1, 1, 1], [0, 1, 1]]), ["mins[1]"]),
        (lambda world: world.set_shapes(world.handles(), [impinge.Ball(1)] * 2), ["shapes", "2", "3"]),
        (lambda world: world.set_vertices(world.handles()[0], [[0, 0, 0]]), ["handle", "TriMesh"]),
        (lambda world: world.set_groups([-1], membership=[1]), ["handles[0] is -1"]),
        (lambda world: world.set_query_types(world.handles(), margin=-1), ["-1"]),
    ],
)
def test_errors_name_the_argument(call, parts):
    world, _ = row_of_balls()
    with pytest.raises(ValueError) as caught:
        call(world)
    for part in parts:
        assert part in str(caught.value), str(caught.value)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_meshes_bend(dtype):
    world = impinge.World(dtype=dtype)
    flat = np.array([[-1, 0, -1], [1, 0, -1], [0, 0, 1]])
    cloth = world.add(impinge.TriMesh(flat, [[0, 1, 2]], dtype=dtype), None)
    ball = world.add(impinge.Ball(0.5, dtype=dtype), impinge.Poses([0, 1, 0]))
    world.update()
    assert len(world.contacts()) == 0
    world.set_vertices(cloth[0], flat + [0, 0.75, 0])
    world.update()
    assert world.contact_events().tolist() == [(1, cloth[0], ball[0])]
    with pytest.raises(ValueError, match="vertices"):
        world.set_vertices(cloth[0], flat[:2])
    with pytest.raises(ValueError):
        world.set_vertices(cloth[0], np.full((3, 3), np.nan))
    world.update()
    assert len(world.contacts()) == 1


def test_turning_bodies_meet():
    """The bar rotates by 90 degrees per unit of time. It touches the pin, radius 0.5 at distance 1, after 60 degrees."""
    bar, pin = impinge.Cuboid([2, 0]), impinge.Ball(0.5, dim=2)
    found = impinge.impact(
        bar, None, [0, 0], pin, impinge.Poses([[0, 1], [0, 9]]), [0, 0], 1.0, angular_velocity1=[np.pi / 2, np.pi / 2]
    )
    np.testing.assert_allclose(found.time, [2 / 3, np.inf], atol=1e-12)
    assert found.is_reached.tolist() == [True, False] and np.isnan(found.point1[1]).all()
    space = impinge.impact(
        impinge.Cuboid([2, 0, 1]), None, [0, 0, 0], impinge.Ball(0.5), impinge.Poses([0, 1, 0]), [0, 0, 0], 1.0,
        angular_velocity1=[0, 0, np.pi / 2],
    )  # fmt: skip
    assert space.time == pytest.approx(2 / 3, abs=1e-9)
    still = impinge.impact(
        impinge.Ball(1), None, [0, 0, 0], impinge.Ball(1), impinge.Poses([6, 0, 0]), [-2, 0, 0], angular_velocity2=[0, 1, 0]
    )
    assert still.time == pytest.approx(2, abs=1e-9), "a ball that turns is where it would be"
    with pytest.raises(ValueError, match=r"angular_velocity1.*\(2,\)"):
        impinge.impact(
            impinge.Ball(1), None, [0, 0, 0], impinge.Ball(1), None, [0, 0, 0], angular_velocity1=[1, 2]
        )


def test_height_fields_have_holes_and_diagonals():
    heights = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]
    down = [0, -1, 0]
    cells = [[-1, 5, -1], [1, 5, -1], [-1, 5, 1], [1, 5, 1]]
    holes = [[True, False], [False, True]]
    field = impinge.HeightField(heights, [4, 1, 4], holes=holes)
    assert impinge.cast_rays(field, None, cells, down).time.tolist() == [np.inf, 5, 5, np.inf]
    one = np.zeros((2, 2, 2), bool)
    one[0, 0, 0] = True
    parts = impinge.HeightField(heights, [4, 1, 4], holes=one)
    beside = impinge.cast_rays(parts, None, [[-1.9, 5, -0.1], [-0.1, 5, -1.9]], down).time
    assert sorted(beside.tolist()) == [5, np.inf], "one triangle of two"
    # The diagonal of a cell decides whether it is a ridge or a valley.
    saddle = [[0, 1], [1, 0]]
    middle = [
        impinge.cast_rays(impinge.HeightField(saddle, [2, 1, 2], backward=turned), None, [0, 5, 0], down).time
        for turned in (False, True)
    ]
    assert sorted(middle) == [4, 5]
    line = impinge.HeightField([0, 0, 0], [4, 1], holes=[True, False])
    assert impinge.cast_rays(line, None, [[-1, 5], [1, 5]], [0, -1]).time.tolist() == [np.inf, 5]
    with pytest.raises(ValueError, match=r"holes.*\(3,\)"):
        impinge.HeightField(heights, [4, 1, 4], holes=[True, True, False])
    with pytest.raises(TypeError, match="backward"):
        impinge.HeightField(heights, [4, 1, 4], backward=3)


def test_ctrl_c_ends_a_query_and_other_threads_run_meanwhile():
    world = impinge.World()
    rng = np.random.default_rng(1)
    world.add(impinge.Ball(1), impinge.Poses(rng.uniform(-20, 20, (300, 3))))
    rays, ticks = rng.normal(size=(3_000_000, 3)), []

    def interrupt():
        for _ in range(20):
            time.sleep(0.01)
            ticks.append(time.monotonic())
        _thread.interrupt_main()

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        world.ray_hits(np.zeros(3), rays)
    thread.join()
    assert len(ticks) == 20
    assert len(world) == 300
