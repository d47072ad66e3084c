"""A world whose objects move: which pairs started and stopped touching."""

import impinge
import numpy as np

world = impinge.World()
floor = world.add(impinge.HalfSpace([0, 1, 0]), None)
balls = world.add(impinge.Ball(0.5), impinge.Poses([[2 * x, 2.0 + x, 0] for x in range(10)]))
log = []
for step in range(1, 121):
    height = np.abs((2.0 + np.arange(10)) - 0.1 * step) + 0.45
    world.set_poses(balls, impinge.Poses(np.stack([2.0 * np.arange(10), height, np.zeros(10)], axis=1)))
    world.update()
    log += [(step, *event) for event in world.contact_events().tolist()]

started = [(step, ball) for step, kind, _, ball in log if kind]
print(f"{len(started)} balls reached the floor, the first at step {started[0][0]}, the last at {started[-1][0]}")
assert [ball for _, ball in started] == balls.tolist(), "in order of their heights"
assert len(log) == 20, "each begins and ends once"
assert len(world.contacts()) == 0
