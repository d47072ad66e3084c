"""The manager for trimesh: values known by arithmetic, and results of the manager of trimesh where FCL is installed."""

import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh")

from impinge.trimesh import CollisionManager, scene_to_collision  # noqa: E402


def at(x, y=0.0, z=0.0):
    return trimesh.transformations.translation_matrix([x, y, z])


def three_boxes():
    manager = CollisionManager()
    box = trimesh.creation.box()
    for name, x in (("a", 0.0), ("b", 0.75), ("c", 5.0)):
        manager.add_object(name, box, at(x))
    return manager, box


def test_who_touches_whom():
    manager, box = three_boxes()
    assert manager.in_collision_internal()
    assert manager.in_collision_internal(return_names=True) == (True, {("a", "b")})
    assert manager.in_collision_single(box, at(5.5), return_names=True) == (True, {"c"})
    assert manager.in_collision_single(box, at(5.5, 9)) is False
    manager.set_transform("b", at(2.5))
    assert not manager.in_collision_internal()
    manager.remove_object("c")
    assert not manager.in_collision_single(box, at(5.5))
    other = CollisionManager()
    other.add_object("x", box, at(2.75))
    assert manager.in_collision_other(other, return_names=True) == (True, {("b", "x")})
    for call in (manager.remove_object, lambda name: manager.set_transform(name, at(0))):
        with pytest.raises(ValueError, match="c is not in the manager"):
            call("c")
    with pytest.raises(ValueError, match=r"\(3, 3\)"):
        manager.set_transform("b", np.eye(3))


def test_contacts_lie_on_both_boxes():
    manager, box = three_boxes()
    found, names, data = manager.in_collision_internal(return_names=True, return_data=True)
    assert found and names == {("a", "b")} and data
    for contact in data:
        assert contact.names == {"a", "b"}
        assert 0 <= contact.index("a") < 12 and 0 <= contact.index("b") < 12
        np.testing.assert_allclose(np.linalg.norm(contact.normal), 1, atol=1e-12)
        assert (np.abs(contact.point[1:]) <= 0.5 + 1e-9).all() and contact.depth >= -1e-12


def test_distances():
    manager, box = three_boxes()
    distance, name, data = manager.min_distance_single(box, at(8), return_name=True, return_data=True)
    assert (round(distance, 9), name) == (2.0, "c") and data.distance == distance
    np.testing.assert_allclose(data.point("c")[0], 5.5)
    np.testing.assert_allclose(data.point("__external")[0], 7.5)
    assert 0 <= data.index("c") < 12
    manager.set_transform("b", at(3.5))
    assert manager.min_distance_internal(return_names=True) == (pytest.approx(0.5), ("b", "c"))
    other = CollisionManager()
    other.add_object("x", box, at(0, 4))
    assert manager.min_distance_other(other, return_names=True) == (pytest.approx(3.0), ("a", "x"))
    assert CollisionManager().min_distance_internal() == float("inf")


def test_a_scene():
    box = trimesh.creation.box()
    scene = trimesh.Scene()
    scene.add_geometry(box, node_name="left")
    scene.add_geometry(box, node_name="right", transform=at(0.5))
    manager, shapes = scene_to_collision(scene)
    assert set(shapes) == {"left", "right"}
    assert manager.in_collision_internal(return_names=True) == (True, {("left", "right")})


def test_random_meshes_as_trimesh_has_them():
    pytest.importorskip("fcl")
    rng = np.random.default_rng(1)
    ours, theirs = CollisionManager(), trimesh.collision.CollisionManager()
    for index in range(25):
        mesh = [trimesh.creation.icosphere(2, 0.5), trimesh.creation.box(), trimesh.creation.cylinder(0.4, 1)][
            index % 3
        ]
        matrix = trimesh.transformations.random_rotation_matrix(rng.random(3))
        matrix[:3, 3] = rng.uniform(-2, 2, 3)
        ours.add_object(str(index), mesh, matrix)
        theirs.add_object(str(index), mesh, matrix)
    found, names = ours.in_collision_internal(return_names=True)
    assert (found, names) == theirs.in_collision_internal(return_names=True) and len(names) > 5
    probe = trimesh.creation.icosphere(2, 0.3)
    for place in rng.uniform(-5, 5, (20, 3)):
        expected, mine = (one.min_distance_single(probe, at(*place)) for one in (theirs, ours))
        if expected > 0:
            # FCL's distances of triangles have errors of some 1e-7.
            assert mine == pytest.approx(expected, abs=1e-6)
        else:
            # FCL returns the depth of any overlapping mesh, impinge the depth of the deepest.
            assert mine <= expected + 1e-6


def test_solid_meshes_collide_with_what_is_inside():
    outer, inner = trimesh.creation.torus(5.0, 2.0), trimesh.creation.icosphere(subdivisions=1, radius=0.25)
    away = trimesh.transformations.translation_matrix([5, 0, 0])
    for solid in (False, True):
        manager = CollisionManager(solid=solid)
        manager.add_object("torus", outer)
        assert manager.in_collision_single(inner, away) is solid
        distance = manager.min_distance_single(inner, away)
        assert (distance < -1.5) if solid else (distance > 1)
        manager.add_object("inner", inner, away)
        assert manager.in_collision_internal() is solid
        scene = trimesh.Scene({"torus": outer})
        scene.add_geometry(inner, transform=away)
        assert scene_to_collision(scene, solid=solid)[0].in_collision_internal() is solid
    manager = CollisionManager(solid=True)
    opened = outer.copy()
    opened.faces = opened.faces[1:]
    with pytest.raises(ValueError, match="opened: a solid is closed"):
        manager.add_object("opened", opened)
