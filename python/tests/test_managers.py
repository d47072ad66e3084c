"""The manager of many meshes returns the results of single queries of all pairs, after any changes."""

import copy
import pickle

import impinge
import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh")

from impinge.trimesh import CollisionManager, scene_to_collision  # noqa: E402


def bowl():
    """A mesh that is neither convex nor closed."""
    ball = trimesh.creation.icosphere(1, 0.5)
    return trimesh.Trimesh(ball.vertices, ball.faces[ball.triangles_center[:, 2] < 0.3])


def meshes():
    return [trimesh.creation.box([0.8, 0.5, 0.6]), bowl(), trimesh.creation.icosphere(1, 0.4)]


def somewhere(rng, size):
    matrix = trimesh.transformations.random_rotation_matrix(rng.random(3))
    matrix[:3, 3] = rng.uniform(-size, size, 3)
    return matrix


class Naive:
    """Shapes and matrices by name; each query tests every pair."""

    def __init__(self):
        self.placed = {}

    def touching(self, one, other):
        return impinge.proximity(*one, *other) == 0

    def pairs(self):
        names = sorted(self.placed)
        return [(one, other) for index, one in enumerate(names) for other in names[index + 1 :]]

    def internal(self):
        return {pair for pair in self.pairs() if self.touching(*(self.placed[name] for name in pair))}

    def other(self, manager):
        return {
            (one, other)
            for one in self.placed
            for other in manager.placed
            if self.touching(self.placed[one], manager.placed[other])
        }

    def distance(self, pairs):
        """The smallest distance; zero if any pair touches."""
        return min((impinge.distance(*one, *other) for one, other in pairs), default=np.inf)


def change(rng, manager, naive, kinds, count, size):
    """Adds, replaces, moves or removes meshes."""
    for _ in range(count):
        name, action = f"m{rng.integers(40)}", rng.random()
        known = name in naive.placed
        if not known or action < 0.1:
            mesh, matrix = kinds[rng.integers(len(kinds))], somewhere(rng, size)
            naive.placed[name] = (manager.add_object(name, mesh, matrix), matrix)
        elif action < 0.25:
            manager.remove_object(name)
            del naive.placed[name]
        else:
            matrix = somewhere(rng, size)
            manager.set_transform(name, matrix)
            naive.placed[name] = (naive.placed[name][0], matrix)


# Few and many changes between queries, in dense and sparse scenes: results from the cache, and results computed anew.
@pytest.mark.parametrize(("count", "size"), [(1, 1.5), (3, 3.0), (30, 2.0), (90, 4.0), (400, 3.0)])
def test_any_changes(count, size):
    rng, kinds = np.random.default_rng(count), meshes()
    managers, naive = (CollisionManager(), CollisionManager()), (Naive(), Naive())
    touching, free = 0, 0
    for _ in range(25):
        for manager, known in zip(managers, naive, strict=True):
            change(rng, manager, known, kinds, count, size)
        (own, others), (mine, theirs) = managers, naive
        expected = mine.internal()
        assert own.in_collision_internal() == bool(expected)
        assert own.in_collision_internal(return_names=True) == (bool(expected), expected)
        distance, names = own.min_distance_internal(return_names=True)
        least = mine.distance([(mine.placed[a], mine.placed[b]) for a, b in mine.pairs()])
        assert (distance <= 0 and names in expected) if expected else distance == pytest.approx(least, abs=1e-9)
        met = mine.other(theirs)
        assert own.in_collision_other(others) == bool(met)
        assert own.in_collision_other(others, return_names=True) == (bool(met), met)
        distance, names = own.min_distance_other(others, return_names=True)
        least = mine.distance([(one, other) for one in mine.placed.values() for other in theirs.placed.values()])
        assert (distance <= 0 and names in met) if met else distance == pytest.approx(least, abs=1e-9)
        touching, free = touching + bool(expected) + bool(met), free + (not expected) + (not met)
    assert touching or free


@pytest.mark.parametrize("spacing", [1.01, 0.95])
def test_a_grid_that_moves(spacing):
    """Checks touching pairs and distances of a grid with more objects than the log of changes holds. All objects move, or
    one; all are apart, or all touch their neighbours."""
    side = 7
    grid = np.argwhere(np.ones((side,) * 3)) * spacing
    manager, beside = CollisionManager(), CollisionManager()
    box = trimesh.creation.box()
    for number, place in enumerate(grid):
        manager.add_object(f"{number:03}", box, trimesh.transformations.translation_matrix(place))
        shifted = place + [0, 0, side * spacing]
        beside.add_object(f"{number:03}", box, trimesh.transformations.translation_matrix(shifted))
    pairs = 3 * side * side * (side - 1) if spacing < 1 else 0
    faces = side * side if spacing < 1 else 0
    for step in range(4):
        for number, place in enumerate(grid):
            if step % 2 == 0 or number == 100:
                # All objects move by the same vector, so the touching pairs stay.
                matrix = trimesh.transformations.translation_matrix(place + [0.25 * (step // 2), 0, 0])
                manager.set_transform(f"{number:03}", matrix)
        found, names = manager.in_collision_internal(return_names=True)
        assert found == (spacing < 1) and (len(names) == pairs or spacing < 1)
        assert manager.min_distance_internal() == pytest.approx(spacing - 1, abs=1e-9)
        assert len(manager.in_collision_other(beside, return_names=True)[1]) >= faces
        if step < 2:
            assert manager.min_distance_other(beside) == pytest.approx(spacing - 1, abs=1e-9)


def test_single_meshes_and_one_of_the_manager():
    rng, kinds = np.random.default_rng(5), meshes()
    manager, naive = CollisionManager(), Naive()
    change(rng, manager, naive, kinds, 60, 3.0)
    for _ in range(40):
        mesh, matrix = kinds[rng.integers(3)], somewhere(rng, 4.0)
        probe = CollisionManager()
        placed = probe.add_object("probe", mesh, matrix), matrix
        met = {name for name, one in naive.placed.items() if naive.touching(placed, one)}
        assert manager.in_collision_single(mesh, matrix) == bool(met)
        assert manager.in_collision_single(mesh, matrix, return_names=True) == (bool(met), met)
        distance, name = manager.min_distance_single(mesh, matrix, return_name=True)
        least = naive.distance([(placed, one) for one in naive.placed.values()])
        assert (distance <= 0 and name in met) if met else distance == pytest.approx(least, abs=1e-9)
        own = sorted(naive.placed)[rng.integers(len(naive.placed))]
        least = naive.distance([(naive.placed[own], one) for name, one in naive.placed.items() if name != own])
        distance, names = manager.min_distance_internal(own, return_names=True)
        assert own in names and max(distance, 0) == pytest.approx(least, abs=1e-9)


def test_a_manager_beside_itself_and_empty_ones():
    manager = CollisionManager()
    assert manager.in_collision_other(manager, return_names=True) == (False, set())
    assert manager.min_distance_other(CollisionManager()) == np.inf
    manager.add_object("a", trimesh.creation.box())
    assert manager.in_collision_other(manager, return_names=True) == (True, {("a", "a")})
    assert not manager.in_collision_other(CollisionManager()) and not manager.in_collision_internal()
    assert manager.min_distance_internal("a") == np.inf


def test_refused_transforms_name_the_mesh_and_change_nothing():
    manager = CollisionManager()
    manager.add_object("a", trimesh.creation.box())
    with pytest.raises(ValueError, match=r"^a: transform\[0\] is no pose"):
        manager.set_transform("a", np.diag([2.0, 2, 2, 1]))
    with pytest.raises(ValueError, match=r"^b: transform\[0\] is no pose"):
        manager.add_object("b", trimesh.creation.box(), np.full((4, 4), np.nan))
    with pytest.raises(ValueError, match="an array of matrices"):
        manager.set_transform("a", np.eye(4)[None])
    assert manager.in_collision_single(trimesh.creation.box(), np.eye(4), return_names=True) == (True, {"a"})


def test_a_mesh_that_changes_after_it_was_added():
    mesh, manager = trimesh.creation.box(), CollisionManager()
    away = trimesh.transformations.translation_matrix([2, 0, 0])
    manager.add_object("small", mesh)
    assert manager.min_distance_single(mesh, away) == pytest.approx(1.0)
    mesh.apply_scale(2)
    assert manager.min_distance_single(mesh, away) == pytest.approx(0.5)
    # Cached data that is pickled or copied with the mesh has no effect.
    for other in (copy.deepcopy(mesh), pickle.loads(pickle.dumps(mesh))):
        assert manager.min_distance_single(other, away) == pytest.approx(0.5)


def scaled(*factors):
    matrix = np.diag([*factors, 1.0])
    matrix[:3, 3] = [0, 0, 5]
    return matrix


@pytest.mark.parametrize("mesh", meshes(), ids=["box", "bowl", "ball"])
def test_scales_of_nodes_are_baked_in(mesh):
    turn = trimesh.transformations.rotation_matrix(0.5, [1, 2, 3])
    shear = np.eye(4)
    shear[0, 1] = 0.75
    transforms = {
        "even": scaled(2, 2, 2),
        "uneven": scaled(3, 1, 0.5) @ turn,
        "mirrored": scaled(-1, 1, 1),
        "sheared": turn @ shear,
        "rigid": turn,
    }
    for name, transform in transforms.items():
        scene = trimesh.Scene()
        scene.add_geometry(mesh, node_name=name, geom_name="mesh", transform=transform)
        manager, shapes = scene_to_collision(scene)
        baked = mesh.copy()
        baked.apply_transform(transform)
        expected = CollisionManager()
        expected.add_object(name, baked)
        probe = trimesh.creation.icosphere(1, 0.1)
        for place in np.random.default_rng(2).uniform(-4, 8, (30, 3)):
            at = trimesh.transformations.translation_matrix(place)
            assert manager.min_distance_single(probe, at) == pytest.approx(expected.min_distance_single(probe, at), abs=1e-6)
        if name == "mirrored" and shapes[name].name == "TriMesh":
            # The triangles of the reflected mesh are reversed, so that they face outwards as before.
            whole = trimesh.Trimesh(shapes[name].vertices, shapes[name].faces)
            assert np.sign(whole.volume) == np.sign(mesh.volume)


def test_nodes_that_are_no_map_are_named():
    for transform in (scaled(1, 0, 1), scaled(1, np.nan, 1)):
        scene = trimesh.Scene()
        scene.add_geometry(trimesh.creation.box(), node_name="flat")
        scene.graph.transforms.edge_data[("world", "flat")]["matrix"] = transform
        scene.graph.transforms._hash = None
        scene.graph._cache.clear()
        with pytest.raises(ValueError, match="the node 'flat': the transform"):
            scene_to_collision(scene)


def test_nodes_of_one_geometry_share_shapes_by_scale():
    scene = trimesh.Scene()
    geometry = scene.graph[scene.add_geometry(trimesh.creation.box(), node_name="a")][1]
    for name in ("b", "c"):
        scene.graph.update(frame_to=name, matrix=scaled(2, 2, 2), geometry=geometry)
    _, shapes = scene_to_collision(scene)
    assert shapes["b"] is shapes["c"] and shapes["a"] != shapes["b"]
