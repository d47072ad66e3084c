"""Processes started by fork, forkserver and spawn return the results of their parent, whatever it computed before."""

import multiprocessing
import threading

import impinge
import numpy as np
import pytest

# Seconds, longer than any query on a busy machine: a child that waits for missing threads never ends.
PATIENCE = 120

METHODS = [
    pytest.param(method, marks=pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning"))
    for method in multiprocessing.get_all_start_methods()
]


def grid(count):
    """A mesh with so many triangles that several threads sort them."""
    rows, columns = np.divmod(np.arange(count * count), count)
    first = np.arange(count * count).reshape(count, count)[:-1, :-1].ravel()
    cells = np.stack([first, first + 1, first + count], axis=1), np.stack([first + 1, first + count + 1, first + count], axis=1)
    return impinge.TriMesh(np.stack([rows, np.zeros(len(rows)), columns], axis=1), np.concatenate(cells))


def many():
    """Work that is divided among threads: batches, worlds, queries before an update, meshes, checkers, tiles."""
    ball, poses = impinge.Ball(0.25), np.tile(np.eye(4), (5000, 1, 1))
    poses[:, :3, 3] = np.random.default_rng(3).uniform(-20, 20, (5000, 3))
    world = impinge.World()
    handles = world.add(ball, poses)
    early = world.overlapping(ball, poses[:3]).handle
    world.update()
    world.set_poses(handles, poses[::-1])
    world.update()
    mesh = grid(70)
    arm = impinge.Checker([impinge.Frame(joint="revolute", axis=[0, 1, 0])], 1, [ball], [0], impinge.Poses([[9, 0, 0]]))
    arm.set_obstacles([ball] * 5000, poses)
    manager_boxes = impinge.boxes(ball, poses)
    return [
        impinge.distance(ball, None, ball, poses).sum(),
        impinge.distance(ball, None, ball, poses, threads=1).sum(),
        impinge.distance(ball, None, ball, poses, threads=2).sum(),
        early.sum(),
        len(world.contacts()),
        world.nearest_to_points(poses[:200, :3, 3], threads=1).distance.sum(),
        impinge.distance(mesh, None, ball, poses).sum(),
        arm.is_free(np.linspace(0, 6, 300)[:, None]).sum(),
        arm.poses(np.linspace(0, 6, 300)[:, None]).sum(),
        len(impinge.tiles(manager_boxes, 8)),
        len(impinge.Scene([ball] * 5000, poses).to_bytes()),
    ]


def one_thread():
    return [impinge.distance(impinge.Ball(1), None, impinge.Ball(1), np.tile(np.eye(4), (300, 1, 1)), threads=1).sum()]


def answer(ask, queue):
    queue.put([float(number) for number in ask()])


def with_a_child(ask, queue):
    """Runs the queries in a child process of this child process."""
    ask()
    answer_of_child = in_child(multiprocessing.get_context("fork"), ask)
    queue.put(answer_of_child)


def in_child(context, ask, target=answer):
    queue = context.SimpleQueue()
    child = context.Process(target=target, args=(ask, queue))
    child.start()
    child.join(PATIENCE)
    if child.is_alive():
        child.kill()
        pytest.fail("the child hangs")
    assert child.exitcode == 0
    return queue.get()


@pytest.mark.parametrize("ask", [many, one_thread])
@pytest.mark.parametrize("method", METHODS)
def test_a_child_answers_as_its_parent(method, ask):
    expected = [float(number) for number in ask()]
    assert in_child(multiprocessing.get_context(method), ask) == expected
    # The parent still returns the same results.
    assert [float(number) for number in ask()] == expected


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_child_of_a_child():
    expected = [float(number) for number in many()]
    assert in_child(multiprocessing.get_context("fork"), many, with_a_child) == expected


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_child_made_while_another_thread_asks():
    expected, stop = [float(number) for number in one_thread()], threading.Event()

    def ask_on():
        while not stop.is_set():
            one_thread()
            many()

    other = threading.Thread(target=ask_on)
    other.start()
    try:
        for _ in range(5):
            assert in_child(multiprocessing.get_context("fork"), one_thread) == expected
    finally:
        stop.set()
        other.join()


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_pool_of_processes_with_a_world_of_the_parent():
    poses = np.tile(np.eye(4), (5000, 1, 1))
    poses[:, 0, 3] = np.arange(5000) * 1.5
    global WORLD
    WORLD = impinge.World()
    WORLD.add(impinge.Ball(1), poses)
    WORLD.update()
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.map_async(count_contacts, range(4)).get(PATIENCE)
    assert found == [4999] * 4


def count_contacts(_):
    WORLD.update()
    return len(WORLD.contacts())
