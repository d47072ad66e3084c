"""A typed program for type checkers: results are not `Any` where that can be avoided, and no type is missing."""

from typing import Any

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


def managed(manager: CollisionManager) -> set[tuple[str, str]]:
    """The flags determine the type of the result."""
    touches: bool = manager.in_collision_internal()
    distance: float = manager.min_distance_internal()
    found, names, data = manager.in_collision_other(CollisionManager(), return_names=True, return_data=True)
    depths: list[float] = [contact.depth for contact in data]
    assert not touches and not found and not depths and distance > 0
    return names


def read_back(mesh: Shape) -> tuple[NDArray[np.floating[Any]], NDArray[np.uint32], bool]:
    distances: NDArray[np.floating[Any]] = impinge.distance([mesh, mesh], None, mesh, None)
    one: float = impinge.distance(mesh, None, mesh, None)
    assert one == distances[0]
    return mesh.vertices, mesh.faces, mesh == impinge.TriMesh(mesh.vertices, mesh.faces, dtype=np.float64)


def main() -> None:
    world = World(0.01, dim=3)
    handles: NDArray[np.uint64] = world.add(impinge.Ball(1), Poses([[0, 0, 0], [5, 0, 0]]), membership=[1])
    world.set_poses(handles, Poses([1, 2, 3]))
    free = gripper(world, impinge.Ball(0.1), np.tile(np.eye(4), (3, 1, 1)))
    data: bytes = record(world).to_bytes() + Scene(shapes()[1], None).to_bytes()
    times = impinge.impact(impinge.Ball(1), None, [1, 0, 0], impinge.Ball(1), None, [0, 0, 0]).time
    picture: impinge.Picture = impinge.picture(world, size=(64, 48))
    manager = CollisionManager()
    assert managed(manager) == set()
    assert read_back(impinge.TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))[2]
    print(free.shape, len(data) > 0, times, picture.format, manager.in_collision_internal())


if __name__ == "__main__":
    main()
