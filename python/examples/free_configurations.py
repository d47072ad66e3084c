"""A robot of balls among shelves: which of a hundred thousand configurations are free, and their distances."""

import time

import impinge
import numpy as np

# Six joints, alternately about z and y, each a third of a metre after the previous one; four balls along each link.
LENGTH = 1 / 3
step = impinge.Poses([0, 0, LENGTH])
frames = [impinge.Frame(joint="revolute", axis=[0, 0, 1], column=0)]
frames += [
    impinge.Frame(number - 1, step, "revolute", [0, number % 2, (number + 1) % 2], column=number) for number in range(1, 6)
]
on = np.repeat(np.arange(6), 4)
heights = np.tile(np.linspace(0, LENGTH, 4, endpoint=False) + LENGTH / 8, 6)
places = impinge.Poses(np.column_stack([np.zeros((24, 2)), heights]))
# Links that share a joint may touch.
pairs = [(one, two) for one in range(24) for two in range(one + 1, 24) if on[two] - on[one] > 1]
robot = impinge.Checker(frames, 6, [impinge.Ball(0.06)] * 24, on, places, pairs)

# Two boards, two posts, and the floor, on which the first link stands.
shapes = [impinge.Cuboid([0.4, 0.6, 0.02])] * 2 + [impinge.Cylinder(0.75, 0.03)] * 2 + [impinge.HalfSpace([0, 0, 1])]
turn = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
poses = np.tile(np.eye(4), (5, 1, 1))
poses[:4, :3, 3] = [[0.8, 0, 0.6], [0.8, 0, 1.2], [0.5, 0.6, 0.75], [0.5, -0.6, 0.75]]
poses[2:4, :3, :3] = turn
robot.set_obstacles(shapes, poses, ignored=[(ball, 4) for ball in range(4)])

configurations = np.random.default_rng(3).uniform(-2.5, 2.5, (100_000, 6))
start = time.perf_counter()
free = robot.is_free(configurations)
print(f"{free.sum()} of {len(free)} are free, in {time.perf_counter() - start:.3f} s")

wide = robot.is_free(configurations, clearance=0.05)
nearest = robot.nearest(configurations[free][:1000])
print(f"{wide.sum()} with 5 cm to spare; the tightest of a thousand has {1000 * nearest.distance.min():.2f} mm")

assert 0 < wide.sum() < free.sum() < len(free)
assert (nearest.distance > 0).all()
names = robot.first_pair(configurations[~free])
assert (names[:, 1] < 24 + len(shapes)).all(), "a ball, or an obstacle after the 24 balls"
