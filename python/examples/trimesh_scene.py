"""A scene of trimesh: its collisions and distances without FCL."""

import numpy as np
import trimesh
from impinge.trimesh import scene_to_collision

scene = trimesh.Scene()
for index, x in enumerate(np.arange(8) * 1.1):
    mesh = trimesh.creation.icosphere(3, 0.5) if index % 2 else trimesh.creation.box()
    scene.add_geometry(mesh, node_name=f"part{index}", transform=trimesh.transformations.translation_matrix([x, 0, 0]))
manager, _ = scene_to_collision(scene)

assert not manager.in_collision_internal()
distance, names = manager.min_distance_internal(return_names=True)
print(f"the nearest parts are {' and '.join(names)}, {distance:.3f} apart")
assert abs(distance - 0.1) < 1e-3

manager.set_transform("part3", trimesh.transformations.translation_matrix([2.5, 0, 0]))
assert manager.in_collision_internal(return_names=True) == (True, {("part2", "part3")})
