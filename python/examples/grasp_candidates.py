"""Which of many gripper poses around a cup are free, and the depths of the fingers in the cup for the other
poses."""

import impinge
import numpy as np

cup, table = impinge.Cylinder(0.05, 0.04), impinge.HalfSpace([0, 1, 0])
finger = impinge.Capsule(0.03, 0.008)
gripper = impinge.Compound([finger, finger], impinge.Poses([[-0.06, 0, 0], [0.06, 0, 0]]))

rng = np.random.default_rng(1)
places = rng.uniform([-0.1, 0.0, -0.1], [0.1, 0.15, 0.1], (20_000, 3))
poses = impinge.Poses(places, rng.normal(size=(20_000, 4)), order="xyzw")
cup_pose = impinge.Poses([0, 0.05, 0])

apart = impinge.distance(gripper, poses, cup, cup_pose)
height = impinge.distance(gripper, poses, table, None)
free = (apart > 0) & (height > 0)
contact = impinge.contact(gripper, poses, cup, cup_pose)
print(f"{free.sum()} of {len(free)} poses are free; the deepest overlap is {contact.depth.max():.3f} m")

assert 0 < free.sum() < len(free)
assert (contact.depth[apart > 0] == -np.inf).all() and (contact.depth[apart == 0] >= -1e-9).all()
