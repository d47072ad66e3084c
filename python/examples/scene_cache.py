"""A scene sent to workers as bytes, and built once by each: the results are equal to the bit."""

from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache

import impinge
import numpy as np

rng = np.random.default_rng(7)
shapes = [impinge.Cuboid([0.2, 0.3, 0.4]), impinge.Ball(0.3)] * 50
scene = impinge.Scene(shapes, impinge.Poses(rng.uniform(-5, 5, (100, 3)), rng.normal(size=(100, 4)), order="xyzw"))


@lru_cache
def made(data: bytes) -> impinge.World:
    """The world of a scene; a worker caches it with the bytes as the key."""
    given = impinge.Scene.from_bytes(data)
    world = impinge.World()
    world.add(given.shapes, given.poses)
    world.update()
    return world


def clearance(chunk: np.ndarray) -> np.ndarray:
    return made(scene.to_bytes()).nearest(impinge.Ball(0.1), chunk).distance


poses = impinge.Poses(rng.uniform(-6, 6, (5_000, 3))).matrices
with ThreadPoolExecutor(2) as pool:
    shared = np.concatenate(list(pool.map(clearance, np.array_split(poses, 8))))
print(f"{(shared == 0).mean():.1%} of the poses touch the scene {scene.checksum[:8]}")
assert shared.tobytes() == clearance(poses).tobytes()
