"""Errors name the argument, the row and the value, and change nothing."""

import threading
import time

import impinge
import numpy as np
import pytest

BALL = impinge.Ball(1)
HERE = np.tile(np.eye(4), (3, 1, 1))


@pytest.mark.parametrize(
    ("call", "error", "parts"),
    [
        (lambda: impinge.Ball(-1), ValueError, ["-1"]),
        (lambda: impinge.Ball(np.nan), ValueError, ["NaN"]),
        (lambda: impinge.Ball(1, dim=4), ValueError, ["dim is 4"]),
        (lambda: impinge.Ball(1, dtype="float16"), ValueError, ["float16"]),
        (lambda: impinge.Cuboid([1, 1, 1, 1]), ValueError, ["half_extents", "(4,)"]),
        (lambda: impinge.HalfSpace([0, 0, 0]), ValueError, ["normal", "[0.0, 0.0, 0.0]"]),
        (lambda: impinge.Capsule(1, 0.5, ends=[[0, 0, 0], [1, 0, 0]]), ValueError, ["ends"]),
        (lambda: impinge.TriMesh(np.zeros((3, 3)), [[0, 1, 5]]), ValueError, ["triangles[0]", "5", "3 vertices"]),
        (lambda: impinge.Picked([BALL], [0, 1]), ValueError, ["picks[1] is 1", "1 shapes"]),
        (lambda: impinge.distance(BALL, None, impinge.Ball(1, dim=2), None), TypeError, ["shape2", "2D", "3D"]),
        (lambda: impinge.distance(BALL, None, impinge.Ball(1, dtype="float32"), None), TypeError, ["float32"]),
        (lambda: impinge.distance(BALL, None, "ball", None), TypeError, ["shape2"]),
        (lambda: impinge.distance([], None, BALL, None), ValueError, ["shape1 has no shape"]),
        (lambda: impinge.distance(BALL, None, BALL, np.eye(3)), ValueError, ["poses2", "(3, 3)"]),
        (lambda: impinge.distance(BALL, None, BALL, "here"), TypeError, ["poses2", "<U4"]),
        (lambda: impinge.distance(BALL, HERE, BALL, HERE[:2]), ValueError, ["2", "3"]),
        (lambda: impinge.distance([BALL] * 2, HERE, BALL, None), ValueError, ["poses1", "3", "2"]),
        (lambda: impinge.distance(BALL, None, BALL, 2 * HERE), ValueError, ["poses2[0]"]),
        (lambda: impinge.distance(BALL, None, BALL, None, threads=0), ValueError, ["threads is 0"]),
        (lambda: impinge.pairs_within(BALL, HERE, distance=-1), ValueError, ["-1"]),
        (lambda: impinge.Poses([0, 0, 0], quaternions=[0, 0, 0, 1]), ValueError, ["order"]),
        (lambda: impinge.Poses([0, 0, 0], quaternions=[0, 0, 0, 0], order="xyzw"), ValueError, ["quaternions[0]"]),
        (lambda: impinge.Poses([[0, 0, 0], [0, np.nan, 0]]), ValueError, ["translations[1, 1]", "nan"]),
        (lambda: impinge.Poses(np.zeros((2, 3)), np.ones((3, 4)), order="xyzw"), ValueError, ["3 rotations", "2"]),
        (lambda: impinge.Scene.from_bytes(b"no scene"), ValueError, ["recording"]),
    ],
)
def test_what_is_refused(call, error, parts):
    with pytest.raises(error) as caught:
        call()
    for part in parts:
        assert part in str(caught.value), str(caught.value)


def test_a_matrix_that_mirrors_is_named():
    poses = HERE.copy()
    poses[1, 0, 0] = -1
    with pytest.raises(ValueError, match=r"poses2\[1\].*determinant -1"):
        impinge.distance(BALL, None, BALL, poses)
    poses[1] = np.eye(4)
    poses[2, 1, 3] = np.nan
    with pytest.raises(ValueError, match=r"poses1\[2\].*NaN"):
        impinge.distance(BALL, poses, BALL, None)


def wrong_matrices(dim):
    """Matrices that are not poses: not finite, wrong last row, scaled, sheared, mirrored."""
    matrices = np.tile(np.eye(dim + 1), (6, 1, 1))
    matrices[0, 1, dim] = np.nan
    matrices[1, 0, 0] = np.inf
    matrices[2, dim, 0] = 0.5
    matrices[3, 0, 0] = 2
    matrices[4, 0, 1] = 0.25
    matrices[5, 0, 0] = -1
    return matrices


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_a_lone_matrix_is_refused_as_that_of_a_batch(dim, dtype):
    shape, zero = impinge.Ball(1, dim=dim, dtype=dtype), np.zeros(dim, dtype)
    calls = {
        "poses": [
            lambda poses: impinge.project_points(shape, poses, zero),
            lambda poses: impinge.signed_distance(shape, poses, zero),
            lambda poses: impinge.contains(shape, poses, zero),
            lambda poses: impinge.cast_rays(shape, poses, zero, zero),
        ]
    }
    questions = [
        impinge.distance,
        impinge.closest_points,
        impinge.witness,
        impinge.proximity,
        impinge.contact,
        impinge.contact_manifolds,
        impinge.nearest,
        lambda shape1, poses1, shape2, poses2: impinge.impact(shape1, poses1, zero, shape2, poses2, zero),
    ]
    calls["poses1"] = [lambda poses, ask=ask: ask(shape, poses, shape, None) for ask in questions]
    calls["poses2"] = [lambda poses, ask=ask: ask(shape, None, shape, poses) for ask in questions]
    for argument, asked in calls.items():
        for call in asked:
            for matrix in wrong_matrices(dim).astype(dtype):
                texts = []
                for poses in (matrix, matrix[None], matrix.tolist()):
                    with pytest.raises(ValueError) as caught:
                        call(poses)
                    texts.append(str(caught.value))
                assert texts[0].startswith(f"{argument}[0] is no pose: ") and len(set(texts)) == 1, texts


class Bar:
    def __init__(self, fail=None):
        self.total, self.fail = 0, fail

    def update(self, count):
        self.total += count
        if self.fail:
            raise self.fail


def test_progress_counts_all_elements():
    bar = Bar()
    impinge.distance(BALL, None, BALL, np.tile(np.eye(4), (5000, 1, 1)), progress=bar)
    assert bar.total == 5000
    bar = Bar()
    assert impinge.distance(BALL, None, BALL, HERE[0], progress=bar, threads=1) == 0
    assert bar.total == 1


def slow_batch(progress=None, count=4000):
    """A batch that takes some hundredths of a second for each pose: the manifolds of a large convex hull in a height
    field."""
    grid = np.random.default_rng(1).uniform(0, 1, (60, 60))
    field = impinge.HeightField(grid, [10, 1, 10])
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, 1, 3] = np.linspace(0.1, 0.2, count)
    return impinge.contact_manifolds(
        field, None, impinge.ConvexHull(np.random.default_rng(2).normal(size=(300, 3)) * 3), poses, progress=progress
    )


def test_an_exception_of_the_bar_ends_the_work():
    began = time.monotonic()
    with pytest.raises(RuntimeError, match="enough"):
        slow_batch(Bar(RuntimeError("enough")))
    ended = time.monotonic()
    assert ended > began
    assert impinge.distance(BALL, None, BALL, None) == 0, "it works on"


def test_ctrl_c_interrupts():
    import _thread

    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        slow_batch()
    timer.join()


def test_the_interpreter_is_released():
    """Another thread runs while a batch is computed."""
    count, is_done = 0, threading.Event()

    def work():
        slow_batch(count=100)
        is_done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not is_done.is_set():
        count += 1
        time.sleep(0.001)
    thread.join()
    assert count > 10
