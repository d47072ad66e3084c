"""A rotating range finder in a scene of boxes: one million distances."""

import impinge
import numpy as np

world = impinge.World()
rng = np.random.default_rng(3)
places = rng.uniform(-20, 20, (200, 3)) * [1, 0, 1]
places = places[np.linalg.norm(places, axis=1) > 3]
boxes = world.add(impinge.Cuboid([0.5, 1, 0.5]), impinge.Poses(places))
world.update()

angles = np.linspace(0, 2 * np.pi, 100_000, endpoint=False)
directions = np.stack([np.cos(angles), np.zeros_like(angles), np.sin(angles)], axis=1)
hits = world.cast_rays([0, 0, 0], directions, max_time=30)
seen = hits.handle != impinge.NO_OBJECT
print(f"{seen.mean():.0%} of the rays hit, {len(np.unique(hits.handle[seen]))} of {len(boxes)} boxes are seen")

points = directions[seen] * hits.time[seen, None]
inside = impinge.World()
assert (hits.time[~seen] == np.inf).all() and hits.time[seen].max() <= 30
nearest = world.nearest(impinge.Ball(0.0), impinge.Poses(points[:100]))
assert nearest.distance.max() < 1e-9, "where a ray hits there is a box"
