"""A robot from a URDF file: which of ten thousand configurations are free of self-collisions."""

import tempfile
from pathlib import Path

import numpy as np
from impinge.urdf import Robot

LINK = '<link name="l{0}"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.9 0.1 0.1"/></geometry></collision></link>'
JOINT = (
    '<joint name="j{0}" type="revolute"><origin xyz="1 0 0"/><parent link="l{0}"/><child link="l{1}"/>'
    '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
)
links = "".join(LINK.format(number) for number in range(5))
joints = "".join(JOINT.format(number, number + 1) for number in range(4))
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "snake.urdf"
    path.write_text(f'<robot name="snake">{links}{joints}</robot>')
    robot = Robot.load(path)

configurations = np.random.default_rng(6).uniform(*robot.limits.T, (10_000, len(robot.joints)))
collides = robot.self_collides(configurations)
nearest = robot.self_distance(configurations[~collides])
print(f"{(~collides).sum()} of {len(collides)} are free; the tightest leaves {nearest.distance.min():.4f}")

assert 0 < collides.sum() < len(collides) and nearest.distance.min() > 0
assert not robot.self_collides([np.zeros(4)])[0], "stretched out it is free"
