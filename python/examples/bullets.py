"""When and where a thousand moving balls hit a rotated box, without tunnelling at any speed."""

import impinge
import numpy as np

rng = np.random.default_rng(5)
target, ball = impinge.Cuboid([1, 0.01, 1]), impinge.Ball(0.05)
pose = impinge.Poses([0, 0, 0], [0, 0, np.sin(0.2), np.cos(0.2)], order="xyzw")
starts = rng.uniform([-2, 5, -2], [2, 6, 2], (1000, 3))
velocities = np.tile([0.0, -1000.0, 0.0], (1000, 1))

hit = impinge.impact(target, pose, [0, 0, 0], ball, impinge.Poses(starts), velocities, max_time=0.05)
reached = np.isfinite(hit.time)
print(f"{reached.sum()} of 1000 hit within 50 ms, the first after {hit.time.min() * 1e3:.2f} ms")

there = starts[reached] + velocities[reached] * hit.time[reached, None]
gap = impinge.witness(target, pose, ball, impinge.Poses(there)).distance
assert 100 < reached.sum() < 1000 and np.abs(gap).max() < 1e-3
