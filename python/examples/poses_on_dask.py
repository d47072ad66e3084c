"""Which of many poses of a gripper are free, on two processes, each of which builds the scene once from its bytes."""

import dask.array
import impinge
import numpy as np
from distributed import Client, LocalCluster
from impinge.dask import ask_scene

GRIPPER = impinge.Compound(
    [impinge.Cuboid([0.01, 0.04, 0.01])] * 2 + [impinge.Cuboid([0.06, 0.01, 0.02])],
    impinge.Poses([[-0.05, 0.04, 0], [0.05, 0.04, 0], [0, 0, 0]]),
)


def clearance(world: impinge.World, poses: np.ndarray) -> np.ndarray:
    return world.nearest(GRIPPER, poses).distance


def main() -> None:
    rng = np.random.default_rng(5)
    shapes = [impinge.Cuboid(half) for half in rng.uniform(0.02, 0.1, (200, 3))]
    clutter = impinge.Poses(rng.uniform(-1, 1, (200, 3)), rng.normal(size=(200, 4)), order="xyzw")
    scene = impinge.Scene(shapes, clutter)
    poses = impinge.Poses(rng.uniform(-1, 1, (20_000, 3)), rng.normal(size=(20_000, 4)), order="xyzw").matrices

    blocks = dask.array.from_array(poses, chunks=(2_500, 4, 4))
    distance = ask_scene(clearance, scene, blocks).compute()

    world = impinge.World()
    world.add(scene.shapes, scene.poses)
    world.update()
    assert distance.tobytes() == clearance(world, poses).tobytes()
    print(f"{(distance > 0).mean():.1%} of {len(poses)} poses are free in the scene {scene.checksum[:8]}")


if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0") as local, Client(local):
        main()
