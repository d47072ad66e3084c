"""Clashes and insufficient clearances in an assembly of ten thousand parts."""

import impinge
import numpy as np

rng = np.random.default_rng(2)
kinds = [impinge.Cuboid([0.4, 0.05, 0.05]), impinge.Cylinder(0.4, 0.06), impinge.Ball(0.1)]
parts = impinge.Picked(kinds, rng.integers(0, 3, 10_000))
poses = impinge.Poses(rng.uniform(0, 20, (10_000, 3)), rng.normal(size=(10_000, 4)), order="xyzw").matrices

near = impinge.pairs_within(parts, poses, distance=0.02)
one, other = near.T
pair = impinge.Picked(kinds, parts.picks[one]), poses[one], impinge.Picked(kinds, parts.picks[other]), poses[other]
found = impinge.witness(*pair)
clashes = near[found.distance <= 0]
print(
    f"{len(clashes)} clashes, {len(near) - len(clashes)} pairs nearer than 20 mm; the worst is {found.distance.min():.3f} m"
)

assert len(near) > len(clashes) > 0 and (found.distance <= 0.02 + 1e-12).all()
assert (near[:, 0] < near[:, 1]).all()
