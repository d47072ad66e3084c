"""Worlds: bulk changes, events, queries and stale handles."""

import pickle

import impinge
import numpy as np
import pytest


def lifted(heights, dim=3, dtype="float64"):
    poses = np.tile(np.eye(dim + 1, dtype=dtype), (len(heights), 1, 1))
    poses[:, 1, dim] = heights
    return poses


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("dim", [2, 3])
def test_events_come_and_go(dim, dtype):
    world = impinge.World(dim=dim, dtype=dtype)
    floor = world.add(impinge.Cuboid([10] + [1] * (dim - 1), dtype=dtype), None)
    ball = impinge.Ball(0.5, dim=dim, dtype=dtype)
    balls = world.add(ball, lifted([5, 1.25], dim, dtype))
    assert len(world) == 3 and world.handles().tolist() == [*floor, *balls]
    world.update()
    assert world.contact_events().tolist() == [(1, floor[0], balls[1])]
    contacts = world.contacts()
    assert contacts["depth"].tolist() == [0.25] and contacts["normal"][0].tolist() == [0, 1, 0][:dim]
    assert contacts.dtype["depth"] == dtype and contacts["point1"].shape == (1, dim)
    world.set_poses(balls, lifted([1.5, 9], dim, dtype))
    world.update()
    assert sorted(world.contact_events().tolist()) == [(0, floor[0], balls[1]), (1, floor[0], balls[0])]
    world.remove(balls)
    world.update()
    assert world.contact_events()["kind"].tolist() == [0] and len(world) == 1


@pytest.mark.parametrize("is_recorded", [False, True])
def test_events_name_removed_objects_whose_index_is_used_again(is_recorded):
    world, ball = impinge.World(), impinge.Ball(1)
    recording = world.record() if is_recorded else None
    (sensor,) = world.add(ball, lifted([2]), margin=0)
    kept, old = world.add(ball, lifted([0, 1]))
    world.update()
    for _ in range(2):
        started, near = [(1, kept, old)], [(impinge.Proximity.INTERSECTING, sensor, old)]
        assert world.contact_events().tolist() == started and world.proximity_events().tolist()[-1:] == near
        world.remove([old])
        (new,) = world.add(ball, lifted([50]))
        assert new != old and new & 0xFFFFFFFF == old & 0xFFFFFFFF, "the index is used again"
        assert world.contact_events().tolist() == started and world.proximity_events().tolist()[-1:] == near
        world.update()
        assert world.contact_events().tolist() == [(0, kept, old)]
        assert world.proximity_events().tolist() == [(impinge.Proximity.DISJOINT, sensor, old)]
        world.set_poses([new], lifted([1]))
        world.update()
        old = new
    if recording is not None:
        recording.stop()
        assert world.contact_events().tolist() == [(1, kept, old)]


def test_poses_come_back():
    world = impinge.World()
    rng = np.random.default_rng(1)
    poses = impinge.Poses(rng.normal(size=(5, 3)), rng.normal(size=(5, 4)), order="xyzw").matrices
    handles = world.add(impinge.Ball(1), poses)
    np.testing.assert_allclose(world.poses(handles[::-1]), poses[::-1], atol=1e-14)
    world.set_poses(handles[1:2], poses[3])
    np.testing.assert_allclose(world.poses()[1], poses[3], atol=1e-14)


def test_proximity_and_groups():
    world = impinge.World()
    ball = impinge.Ball(1)
    sensor = world.add(ball, None, margin=0.5, membership=[3], whitelist=[1])
    near = world.add(ball, lifted([2.25]), membership=[1], blacklist=[2])
    world.add(ball, lifted([2.25]), membership=[2])
    world.update()
    assert world.proximity_events().tolist() == [(impinge.Proximity.WITHIN_MARGIN, sensor[0], near[0])]
    assert len(world.contacts()) == 0


def test_stale_handles_are_named_and_change_nothing():
    world = impinge.World()
    first = world.add(impinge.Ball(1), lifted([0, 5]))
    world.remove(first[:1])
    again = world.add(impinge.Ball(1), lifted([9]))
    assert again[0] != first[0] and again[0] & 0xFFFFFFFF == first[0] & 0xFFFFFFFF, "the index is used again"
    for call in (
        lambda: world.remove(first),
        lambda: world.set_poses(first[::-1], lifted([1, 1])),
        lambda: world.poses(first),
        lambda: world.remove([12345]),
    ):
        with pytest.raises(ValueError, match=r"handles\[[01]\] is \d+"):
            call()
    with pytest.raises(ValueError, match="twice"):
        world.remove([again[0], again[0]])
    with pytest.raises(ValueError):
        world.set_poses(again, lifted([1, 1]))
    assert len(world) == 2 and world.poses()[:, 1, 3].tolist() == [9, 5]


def test_refused_objects_leave_nothing():
    world = impinge.World()
    poses = lifted([0, 1, 2])
    poses[2, 0, 3] = np.inf
    with pytest.raises(ValueError, match=r"poses\[2\]"):
        world.add(impinge.Ball(1), poses)
    with pytest.raises(ValueError):
        world.add(impinge.Ball(1), None, prediction=-1)
    with pytest.raises(ValueError):
        world.add(impinge.Ball(1), None, membership=[99])
    with pytest.raises(TypeError):
        world.add(impinge.Ball(1, dim=2), None)
    assert len(world) == 0
    with pytest.raises(ValueError, match="margin"):
        impinge.World(-1)


def test_refused_objects_leave_the_next_handles():
    # A mesh whose coincident vertices were moved apart: a recorded world refuses it, here as the last of four objects.
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=float)
    world, ball = impinge.World(), impinge.Ball(1)
    mesh = world.add(impinge.TriMesh(corners, [[0, 1, 2], [3, 5, 4]]), None)
    corners[3, 0] = 3
    world.set_vertices(mesh[0], corners)
    pair = [ball, *world.shapes()]
    worlds = [impinge.World(), impinge.World()]
    with worlds[0].record("plain"), worlds[1].record("refusing"):
        for number in range(3):
            with pytest.raises(ValueError, match=r"poses\[3\]"):
                worlds[1].add([ball] * 2 + pair, None)
            first, second = ([*world.add([ball] * 3, None), *world.handles()] for world in worlds)
            assert first == second
            for world in worlds:
                world.remove(first[number + 1 : 3])
    copied = pickle.loads(pickle.dumps(worlds[1]))
    assert copied.add([ball] * 5, None).tolist() == worlds[0].add([ball] * 5, None).tolist()


def test_queries():
    world = impinge.World()
    balls = world.add(impinge.Ball(1), lifted([0, 4, 8]))
    world.update()
    hits = world.cast_rays([[0, -5, 0], [0, 20, 0], [9, 0, 0]], [[0, 2, 0], [0, -1, 0], [0, 1, 0]])
    assert hits.time.tolist() == [2, 11, np.inf]
    assert hits.handle.tolist() == [balls[0], balls[2], impinge.NO_OBJECT]
    assert hits.normal[0].tolist() == [0, -1, 0] and np.isnan(hits.normal[2]).all()
    near = world.nearest(impinge.Ball(1), lifted([5, 100]), count=2, max_distance=20)
    assert near.starts.tolist() == [0, 2, 2]
    assert near.handle.tolist() == [balls[1], balls[2]] and near.distance.tolist() == [0, 1]
    inside = world.containing([[0, 0.5, 0], [0, 2, 0], [0, 4, 0]])
    assert inside.starts.tolist() == [0, 1, 1, 2] and inside.handle.tolist() == [balls[0], balls[1]]
    cast = world.cast_shape(impinge.Ball(1), lifted([-5]), [0, 3, 0])
    assert cast.time.tolist() == [1] and cast.handle.tolist() == [balls[0]]
    with pytest.raises(ValueError, match="velocities"):
        world.cast_shape(impinge.Ball(1), lifted([-5, -6, -7]), np.zeros((2, 3)))


def test_contacts_are_those_of_batches():
    """The contacts of a world of a hundred boxes have the depths of a batch of pairs."""
    rng = np.random.default_rng(3)
    poses = impinge.Poses(rng.uniform(-3, 3, (100, 3)), rng.normal(size=(100, 4)), order="xyzw").matrices
    box = impinge.Cuboid([0.5, 0.4, 0.3])
    world = impinge.World()
    handles = world.add(box, poses)
    world.update()
    started = world.contact_events()
    pairs = impinge.pairs_within(box, world.poses())
    assert len(pairs) > 50
    assert [[row["first"], row["second"]] for row in started] == handles[pairs].tolist()
