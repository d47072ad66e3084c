"""A program with types, for type checkers: what users write is not `Any` where it need not be, and nothing is missing."""

import impinge
import numpy as np
from impinge import Filter, Poses, Recording, Scene, Shape, World
from impinge.trimesh import CollisionManager
from numpy.typing import NDArray


def shapes() -> list[Shape]:
    ball: Shape = impinge.Ball(0.5, dtype="float32")
    field = impinge.HeightField(np.zeros((3, 3)), [1, 1, 1], holes=np.zeros((2, 2), bool), backward=True)
    both = impinge.Compound([impinge.Cuboid([1, 1, 1]), impinge.Cone(1, 0.5)], Poses(np.zeros((2, 3))))
    return [ball, field, both]


def gripper(world: World, hand: Shape, tools: NDArray[np.float64]) -> NDArray[np.bool_]:
    others = Filter(exclude=world.handles()[:1], blacklist=[3])
    return ~world.overlaps_any(hand, tools, filter=others, threads=1)


def record(world: World) -> Recording:
    with world.record("typed") as recording:
        world.update()
    return recording


def main() -> None:
    world = World(0.01, dim=3)
    handles: NDArray[np.uint64] = world.add(impinge.Ball(1), Poses([[0, 0, 0], [5, 0, 0]]), membership=[1])
    world.set_poses(handles, Poses([1, 2, 3]))
    free = gripper(world, impinge.Ball(0.1), np.tile(np.eye(4), (3, 1, 1)))
    data: bytes = record(world).to_bytes() + Scene(shapes()[1], None).to_bytes()
    times = impinge.impact(impinge.Ball(1), None, [1, 0, 0], impinge.Ball(1), None, [0, 0, 0]).time
    picture: impinge.Picture = impinge.picture(world, size=(64, 48))
    manager = CollisionManager()
    print(free.shape, len(data) > 0, times, picture.format, manager.in_collision_internal())


if __name__ == "__main__":
    main()
