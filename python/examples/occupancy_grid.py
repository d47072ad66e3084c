"""Which cells of a grid are inside a scene, and the distances of the other cells."""

import impinge
import numpy as np

scene = impinge.Scene(
    [impinge.Ball(1), impinge.Cuboid([0.5, 1, 0.5]), impinge.Cone(1, 0.8)],
    impinge.Poses([[-2, 0, 0], [0, 0, 0], [2, 0, 0]]),
)
axes = [np.linspace(-3.5, 3.5, 71), np.linspace(-1.5, 1.5, 31), np.linspace(-1.5, 1.5, 31)]
points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)

distance = np.full(len(points), np.inf)
for shape, pose in zip(scene.shapes, scene.poses, strict=True):
    distance = np.minimum(distance, impinge.signed_distance(shape, pose, points))
occupied = distance <= 0
print(f"{occupied.mean():.1%} of {len(points)} points are occupied; {scene.checksum[:8]} names the scene in caches")

cell = 0.1**3
ball, box, cone = 4 / 3 * np.pi, 2.0, np.pi * 0.8**2 * 2 / 3
assert abs(occupied.sum() * cell - (ball + box + cone)) < 0.15 * (ball + box + cone), "about the volume"
