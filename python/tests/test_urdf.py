"""Robots: frames equal those of yourdfpy, collisions are known by arithmetic."""

import numpy as np
import pytest

yourdfpy = pytest.importorskip("yourdfpy")
trimesh = pytest.importorskip("trimesh")

import impinge  # noqa: E402
from impinge.urdf import Robot  # noqa: E402

# An arm of three links of length one in the plane z = 0, a sliding gripper, and a finger whose joint mimics its joint.
ARM = """<robot name="arm">
  <link name="base"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.5 0 0" rpy="0 1.5707963267948966 0"/>
    <geometry><cylinder radius="0.05" length="1"/></geometry></collision></link>
  <link name="hand"><collision><geometry><mesh filename="tip.stl" scale="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="finger"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 2"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="continuous"><origin xyz="1 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/></joint>
  <joint name="slide" type="prismatic"><origin xyz="1 0 0" rpy="0.3 0.2 0.1"/><parent link="lower"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="follow" type="prismatic"><parent link="hand"/><child link="finger"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="slide" multiplier="-0.5" offset="0.25"/></joint>
</robot>"""


@pytest.fixture
def path(tmp_path):
    trimesh.creation.box().export(tmp_path / "tip.stl")
    (tmp_path / "arm.urdf").write_text(ARM)
    return tmp_path / "arm.urdf"


def test_frames_are_those_of_yourdfpy(path):
    robot = Robot.load(path)
    assert robot.joints == ["shoulder", "elbow", "slide"]
    assert robot.limits.tolist() == [[-3, 3], [-np.inf, np.inf], [0, 0.5]]
    model = yourdfpy.URDF.load(str(path), load_meshes=False)
    configurations = np.random.default_rng(1).uniform(-2, 2, (20, 3))
    frames = robot.frames(configurations)
    assert frames.shape == (20, 5, 4, 4)
    for row, configuration in enumerate(configurations):
        model.update_cfg(dict(zip(robot.joints, configuration, strict=True)))
        for number, link in enumerate(robot.links):
            np.testing.assert_allclose(frames[row, number], model.get_transform(link), atol=1e-12)
    np.testing.assert_array_equal(robot.frames(configurations[3]), frames[3])


@pytest.mark.parametrize("meshes", ["hull", "surface"])
def test_self_collisions(path, meshes):
    robot = Robot.load(path, meshes)
    assert [body.name for body in robot.bodies] == ["base/0", "upper/0", "lower/0", "hand/0"]
    assert robot.pairs.tolist() == [[0, 2], [0, 3], [1, 3]], "links that share a joint may touch"
    straight, folded = [0, 0, 0], [0, np.pi, 0]
    assert robot.self_collides([straight, folded]).tolist() == [False, True]
    found = robot.self_distance([straight])
    # The cylinder begins at distance 1 from the centre of the ball.
    np.testing.assert_allclose(found.distance, 0.9, atol=1e-9)
    assert (found.body1[0], found.body2[0]) == (0, 2)
    robot.allow("base", "lower")
    assert robot.pairs.tolist() == [[0, 3], [1, 3]]
    robot.allow_touching_at(folded)
    assert robot.self_collides([folded]).tolist() == [False]


def test_obstacles(path):
    robot = Robot.load(path)
    shapes, poses = [impinge.Ball(0.2), impinge.Cuboid([1, 1, 1])], impinge.Poses([[0, 1.25, 0], [0, 0, 9]]).matrices
    straight, up = [0, 0, 0], [np.pi / 2, 0, 0]
    assert robot.collides([straight, up], shapes, poses).tolist() == [False, True]
    found = robot.distance([straight, up], shapes, poses)
    # The ball of the base, radius 0.1, extends farther towards the obstacle than the box of the upper link.
    np.testing.assert_allclose(found.distance, [1.25 - 0.2 - 0.1, 0.0], atol=1e-9)
    assert (found.body1[0], found.body2[0]) == (0, 0)


def test_what_is_refused(path):
    robot = Robot.load(path)
    with pytest.raises(ValueError, match=r"\(2,\).*\(n, 3\)"):
        robot.frames([0, 0])
    with pytest.raises(ValueError, match=r"configurations\[1\]: elbow is nan"):
        robot.self_collides([[0, 0, 0], [0, np.nan, 0]])
    with pytest.raises(ValueError, match="tail is no link"):
        robot.allow("tail", "base")


@pytest.mark.parametrize("mimicked", ["nobody", "follow", "shoulder_fixed"])
def test_a_mimic_of_an_unknown_joint_is_named(path, mimicked):
    text = ARM.replace('mimic joint="slide"', f'mimic joint="{mimicked}"')
    fixed = '<link name="nail"/><joint name="shoulder_fixed" type="fixed"><parent link="base"/><child link="nail"/></joint>'
    path.write_text(text.replace("</robot>", f"{fixed}</robot>"))
    with pytest.raises(ValueError, match=f"joint follow mimics {mimicked}.*shoulder.*elbow.*slide"):
        Robot.load(path)
