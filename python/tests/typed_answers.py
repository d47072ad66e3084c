"""A program for type checkers: the type of every result. Running it checks that the results have these types.

A call has one element, many elements, or an argument that may have either: an array of NumPy or `Poses`.
"""

from typing import Any, Literal, TypeVar

import impinge
import numpy as np
import trimesh
from dask.array import Array
from dask.dataframe import DataFrame, Series
from impinge import Checker, Contact, Impact, Picked, Poses, Projection, RayHit, Scene, Shape, Tiles, Witness, World
from impinge.dask import ask_scene
from impinge.trimesh import CollisionManager, ContactData, DistanceData
from impinge.urdf import NearestBodies, Robot
from numpy.typing import NDArray
from typing_extensions import assert_type

T = TypeVar("T")
Floats = NDArray[np.floating[Any]]
Bools = NDArray[np.bool_]
Numbers = NDArray[np.uint32]
Many = NDArray[np.float64] | Poses

BALL = impinge.Ball(1)
POSE: list[list[float]] = [[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def one(answer: T) -> T:
    """Returns the result, in which vectors are arrays and all else is scalars."""
    for value in answer if isinstance(answer, tuple) else (answer,):
        assert isinstance(value, (bool, int, float)) or (isinstance(value, np.ndarray) and value.shape == (3,)), value
    return answer


def many(answer: T) -> T:
    """Returns the result, in which everything is an array with a row for each element."""
    for value in answer if isinstance(answer, tuple) else (answer,):
        assert isinstance(value, np.ndarray) and value.shape in ((2,), (2, 3)), value
    return answer


def pairs(each: list[Shape], picked: Picked) -> None:
    assert_type(one(impinge.distance(BALL, None, BALL, POSE)), float)
    assert_type(many(impinge.distance(each, None, BALL, POSE)), Floats)
    assert_type(many(impinge.distance(BALL, None, picked, None)), Floats)

    assert_type(one(impinge.proximity(BALL, None, BALL, POSE)), int)
    assert_type(many(impinge.proximity(BALL, None, each, None)), NDArray[np.uint8])

    assert_type(one(impinge.closest_points(BALL, None, BALL, POSE)), impinge.ClosestPoints[float])
    assert_type(many(impinge.closest_points(each, None, BALL, POSE)), impinge.ClosestPoints[Floats])

    found = one(impinge.witness(BALL, None, BALL, None, 1.0))
    assert_type(found, Witness[float, int])
    assert_type((found.distance, found.normal, found.part1), tuple[float, Floats, int])
    assert_type(many(impinge.witness(BALL, None, picked, None)), Witness[Floats, Numbers])

    contact = one(impinge.contact(BALL, None, BALL, POSE, 2.0))
    assert_type(contact, Contact[float])
    assert_type((contact.depth, contact.point1), tuple[float, Floats])
    assert_type(many(impinge.contact(picked, None, BALL, None)).depth, Floats)


def pairs_of_either(poses: Many, each: list[Shape]) -> None:
    assert_type(many(impinge.distance(BALL, None, BALL, poses)), float | Floats)
    assert_type(many(impinge.distance(each, None, BALL, poses)), Floats)
    # A list of one shape is used for all elements, as the shape is, but the result is an array.
    assert_type(many(impinge.distance([BALL], None, BALL, poses)), Floats)
    assert_type(many(impinge.proximity(BALL, None, BALL, poses)), int | NDArray[np.uint8])
    assert_type(many(impinge.closest_points(BALL, None, BALL, poses)).distance, float | Floats)
    assert_type(many(impinge.witness(BALL, None, BALL, poses)).part1, int | Numbers)
    contact: Contact = many(impinge.contact(BALL, poses, BALL, None))
    assert_type((contact.depth, contact.normal), tuple[float | Floats, Floats])
    assert_type(impinge.nearest(BALL, None, BALL, poses), impinge.Nearest)
    assert_type(impinge.contact_manifolds(BALL, None, BALL, poses).of(0).part2, Numbers)
    assert_type(impinge.pairs_within(BALL, poses), Numbers)
    assert_type(impinge.boxes(BALL, poses), Floats)


def moving(each: list[Shape], poses: Many) -> None:
    speed, speeds = [1.0, 0.0, 0.0], [[1, 0, 0], [0, 1, 0]]
    assert_type(one(impinge.impact(BALL, None, speed, BALL, POSE, (0.0, 0, 0))), Impact[float, bool])
    assert_type(many(impinge.impact(each, None, speed, BALL, POSE, speed)), Impact[Floats, Bools])
    assert_type(many(impinge.impact(BALL, None, speed, each, None, speed)), Impact[Floats, Bools])
    assert_type(many(impinge.impact(BALL, poses, speeds, BALL, None, speed)), Impact[Floats, Bools])
    assert_type(many(impinge.impact(BALL, None, speed, BALL, poses, speeds)).is_reached, Bools)
    assert_type(many(impinge.impact(BALL, None, speed, BALL, poses, speed)).time, float | Floats)
    turning = one(impinge.impact(BALL, None, speed, BALL, POSE, speed, 1, angular_velocity1=speed))
    assert_type(turning.is_reached, bool | Bools)


def points(each: list[Shape], array: NDArray[np.float64]) -> None:
    point, rows = [3.0, 0.0, 0.0], [(3, 0, 0), (4, 0, 0)]
    assert_type(one(impinge.signed_distance(BALL, None, point)), float)
    assert_type(many(impinge.signed_distance(each, None, point)), Floats)
    assert_type(many(impinge.signed_distance(BALL, None, rows)), Floats)
    assert_type(many(impinge.signed_distance(BALL, POSE, array, surface=True)), float | Floats)

    assert_type(one(impinge.contains(BALL, POSE, point)), bool)
    assert_type(many(impinge.contains(each, None, point)), Bools)
    assert_type(many(impinge.contains(BALL, None, rows)), Bools)
    assert_type(many(impinge.contains(BALL, None, array)), bool | Bools)

    assert_type(one(impinge.project_points(BALL, None, point)), Projection[bool, int])
    assert_type(many(impinge.project_points(each, None, point)), Projection[Bools, Numbers])
    assert_type(many(impinge.project_points(BALL, None, rows)), Projection[Bools, Numbers])
    assert_type(many(impinge.project_points(BALL, None, array)), Projection)

    assert_type(one(impinge.cast_rays(BALL, None, point, [-1, 0, 0])), RayHit[float, int])
    assert_type(many(impinge.cast_rays(each, None, point, [-1, 0, 0])), RayHit[Floats, Numbers])
    assert_type(many(impinge.cast_rays(BALL, None, rows, [-1, 0, 0])), RayHit[Floats, Numbers])
    assert_type(many(impinge.cast_rays(BALL, None, point, rows)).part, Numbers)
    assert_type(many(impinge.cast_rays(BALL, None, array, point)).time, float | Floats)


def values(poses: Poses, scene: Scene, tiles: Tiles, shape: Shape) -> None:
    assert_type((poses.matrices, poses[0], poses[[0]], poses[:1]), tuple[NDArray[np.float64], Poses, Poses, Poses])
    assert_type((scene.poses, scene.shapes, scene.dim, scene.to_bytes()), tuple[Floats, list[Shape], int, bytes])
    assert_type(scene.dtype, Literal["float32", "float64"])
    assert_type((tiles.axes, tiles.cuts, tiles.bounds), tuple[Numbers, Floats, Floats])
    assert_type(tiles.dtype, Literal["float32", "float64"])
    assert_type((tiles.meeting(np.zeros((0, 2, 3))).tile, tiles.owner([[0, 0, 0]])), tuple[Numbers, Numbers])
    assert_type((shape.vertices, shape.faces, shape.dtype), tuple[Floats, Numbers, Literal["float32", "float64"]])
    assert_type(impinge.picture(scene), impinge.Picture)


def worlds(world: World) -> None:
    assert_type(world.poses(), Floats)
    assert_type(world.contacts(), NDArray[np.void])
    assert_type(world.cast_rays([-9, 0, 0], [1, 0, 0]), impinge.WorldHit)
    assert_type(world.cast_rays([-9, 0, 0], [1, 0, 0]).handle, NDArray[np.uint64])
    assert_type(world.nearest(BALL, None).distance, Floats)
    assert_type(world.project_points([9, 0, 0]).is_inside, Bools)
    assert_type(world.overlaps_any(BALL, None), Bools)


def checked(checker: Checker) -> None:
    assert_type((checker.frames([0.0]), checker.poses([0.0])), tuple[Floats, Floats])
    assert_type((checker.is_free([0.0]), checker.first_pair([0.0])), tuple[Bools, Numbers])
    assert_type((checker.nearest([0.0]).distance, checker.nearest([0.0]).pair), tuple[Floats, Numbers])
    assert_type((checker.dim, checker.dtype), tuple[int, Literal["float32", "float64"]])


def managed(manager: CollisionManager, mesh: trimesh.Trimesh, flag: bool) -> None:
    assert_type(manager.in_collision_single(mesh), bool)
    assert_type(manager.in_collision_single(mesh, return_names=True), tuple[bool, set[str]])
    assert_type(
        manager.in_collision_single(mesh, None, flag),
        bool | tuple[bool, set[str]] | tuple[bool, list[ContactData]] | tuple[bool, set[str], list[ContactData]],
    )
    assert_type(manager.in_collision_internal(True), tuple[bool, set[tuple[str, str]]])
    assert_type(manager.in_collision_internal(return_data=True)[1], list[ContactData])
    other = CollisionManager()
    assert_type(manager.in_collision_other(other, True, True)[2], list[ContactData])
    assert_type(manager.min_distance_single(mesh, return_data=True), tuple[float, DistanceData | None])
    assert_type(manager.min_distance_other(other, False), float)
    assert_type(
        manager.min_distance_internal(None, flag, return_data=flag),
        float
        | tuple[float, tuple[str, str]]
        | tuple[float, DistanceData | None]
        | tuple[float, tuple[str, str], DistanceData | None],
    )


def robots(robot: Robot) -> None:
    assert_type((robot.frames([0.0]), robot.poses([0.0])), tuple[NDArray[np.float64], NDArray[np.float64]])
    assert_type((robot.links, robot.joints, robot.limits), tuple[list[str], list[str], NDArray[np.float64]])
    assert_type(robot.pairs, NDArray[np.int64])
    assert_type(robot.distance([0.0], [BALL], None), NearestBodies)


def spread(scene: Scene, poses: Array, rows: DataFrame) -> None:
    def near(world: World, block: NDArray[np.float64]) -> Floats:
        return world.nearest(BALL, block).distance

    assert_type(ask_scene(near, scene, poses), Array)
    assert_type(ask_scene(lambda world, block: block["x"], scene, rows), Series)
    assert_type(ask_scene(lambda world, block: block["x"], scene, "rows.parquet"), Series)


def main() -> None:
    each, picked, poses = [BALL, BALL], Picked([BALL], [0, 0]), Poses([[3, 0, 0], [4, 0, 0]])
    pairs(each, picked)
    for either in (poses, poses.matrices):
        pairs_of_either(either, each)
        moving(each, either)
    points(each, np.array([[3.0, 0, 0], [4, 0, 0]]))
    values(poses, Scene(BALL, None), Tiles([0], [0.5]), impinge.TriMesh(np.eye(3), [[0, 1, 2]]))
    world = World()
    world.add(BALL, None)
    worlds(world)
    checked(Checker([impinge.Frame(None, Poses([1, 0, 0]))], 1))
    manager = CollisionManager()
    manager.add_object("box", trimesh.creation.box())
    managed(manager, trimesh.creation.box(), False)


if __name__ == "__main__":
    main()
