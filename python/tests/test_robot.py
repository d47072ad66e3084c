"""Robots whose bodies change, made without a file."""

from dataclasses import replace
from types import SimpleNamespace

import impinge
import numpy as np
from impinge.urdf import Body, Robot


def link(name, radius=None):
    """A link with a ball, or without a body."""
    sphere = SimpleNamespace(radius=radius)
    geometry = SimpleNamespace(box=None, sphere=sphere, cylinder=None, mesh=None)
    collision = SimpleNamespace(origin=None, geometry=geometry)
    return SimpleNamespace(name=name, collisions=[] if radius is None else [collision])


def sliding():
    """A ball at the origin and a ball that two joints slide along x, both of radius 1/4."""
    common = {"type": "prismatic", "origin": None, "axis": [1, 0, 0], "mimic": None, "limit": None}
    joints = [
        SimpleNamespace(name="near", parent="base", child="middle", **common),
        SimpleNamespace(name="far", parent="middle", child="tip", **common),
    ]
    links = [link("base", 0.25), link("middle"), link("tip", 0.25)]
    return Robot(SimpleNamespace(robot=SimpleNamespace(links=links, joints=joints)))


def test_a_replaced_body_is_seen():
    robot, at = sliding(), [[1.0, 0.5], [3.0, 0.5]]
    assert robot.pairs.tolist() == [[0, 1]]
    assert robot.self_distance(at).distance.tolist() == [1, 3] and not robot.self_collides(at).any()
    robot.bodies[1] = replace(robot.bodies[1], shape=impinge.Ball(1.5))
    assert robot.self_distance(at).distance.tolist() == [0, 1.75]
    assert robot.self_collides(at).tolist() == [True, False]
    robot.bodies = [robot.bodies[0], replace(robot.bodies[1], shape=impinge.Ball(0.5))]
    assert robot.self_distance(at).distance.tolist() == [0.75, 2.75]


def test_an_appended_body_has_poses():
    robot = sliding()
    assert robot.poses([1.0, 0.5]).shape == (2, 4, 4)
    robot.bodies.append(Body("hand", 2, impinge.Ball(0.125), impinge.Poses([0, 2, 0]).matrices))
    poses = robot.poses([[1.0, 0.5]] * 5)
    assert poses.shape == (5, 3, 4, 4) and poses[0, 2, :3, 3].tolist() == [1.5, 2, 0]
    assert robot.self_distance([[0.5, 1.0]]).body2.tolist() == [1], "the new body is in no pair"
    robot.pairs = np.array([[0, 2]])
    assert robot.self_distance([[0.0, 0.0]]).distance.tolist() == [2 - 0.25 - 0.125]
    del robot.bodies[2]
    robot.pairs = np.array([[0, 1]])
    assert robot.poses([1.0, 0.5]).shape == (2, 4, 4)


def test_the_checker_is_kept():
    robot = sliding()
    robot.frames([0.0, 0.0])
    kept = robot._own()
    assert robot._own() is kept
    robot.allow("base", "tip")
    assert robot._own() is not kept
