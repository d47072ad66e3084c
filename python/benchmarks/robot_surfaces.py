"""Self-collisions of robots with surface meshes: compares `impinge.Checker` with Coal through Pinocchio.

    python robot_surfaces.py [--quick] [--out FOLDER]

Robots of the package example-robot-data as read by Pinocchio, with unmodified meshes. Writes robot_surfaces.md. Needs impinge,
pin and example-robot-data.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import coal
import impinge
import numpy as np
import pinocchio

from timing import Side, arguments, interleaved, machine, markdown

PACKAGES = ("impinge", "pin", "coal", "example-robot-data", "numpy")
SHARE = Path(pinocchio.__file__).resolve().parents[4] / "share"
SOLIDS, PICTURES = pinocchio.GeometryType.COLLISION, pinocchio.GeometryType.VISUAL
# The file, the kind of meshes, the prefixes of the names of the bodies, and the number of configurations.
ROBOTS = {
    "UR5": ("ur_description/urdf/ur5_robot.urdf", SOLIDS, ("",), 10_000),
    "Allegro hand": ("allegro_hand_description/urdf/allegro_right_hand.urdf", PICTURES, ("",), 10_000),
    "Psyonic hand": ("alex_description/urdf/alex_psyonic_hands.urdf", SOLIDS, ("RightPsyonic", "Right_"), 10_000),
    "Alex": ("alex_description/urdf/alex_psyonic_hands.urdf", SOLIDS, ("",), 2_000),
    "Talos": ("talos_data/robots/talos_full_v2.urdf", SOLIDS, ("",), 2_000),
}
HEADER = (
    *("robot", "bodies", "triangles", "pairs", "configurations", "about", "colliding", "differ"),
    *("impinge us", "Coal us", "Coal / impinge"),
)
# The standard deviation of configurations near zero, in radians.
NEAR = 0.3
# Rotates the z axis, along which cylinders of Coal lie, to the y axis.
Z_TO_Y = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


class Robot:
    """A robot in both libraries. Its pairs are bodies of joints that are not consecutive, and that do not touch if all joints are at
    zero."""

    def __init__(self, name: str) -> None:
        file, kind, names, _ = ROBOTS[name]
        path = str(SHARE / "example-robot-data" / "robots" / file)
        self.model = pinocchio.buildModelFromUrdf(path)
        read = pinocchio.buildGeomFromUrdf(self.model, path, kind, None, [str(SHARE)])
        self.geometry = pinocchio.GeometryModel()
        for body in read.geometryObjects:
            if body.name.startswith(names):
                self.geometry.addGeometryObject(body)
        self.bodies = list(self.geometry.geometryObjects)
        self._pair()
        joints = [self.model.joints[number] for number in range(1, self.model.njoints)]
        # The index at which the values of each joint begin; a joint without limits has a cosine and a sine.
        self.columns = [(joint.idx_q, joint.nq == 2) for joint in joints]
        low, high = self.model.lowerPositionLimit, self.model.upperPositionLimit
        limits = [(-np.pi, np.pi) if is_circle else (low[at], high[at]) for at, is_circle in self.columns]
        self.limits = np.clip(limits, -np.pi, np.pi)
        self.pool = pinocchio.GeometryPool(self.model, self.geometry, 1)
        self.checker = self._checker()

    def _pair(self) -> None:
        self.geometry.addAllCollisionPairs()
        model, data, placed = self.model, self.model.createData(), self.geometry.createData()
        pinocchio.computeCollisions(model, data, self.geometry, placed, pinocchio.neutral(model), False)

        def is_meant(number: int, pair: Any) -> bool:
            one, two = (self.bodies[body].parentJoint for body in (pair.first, pair.second))
            is_joined = one == two or model.parents[one] == two or model.parents[two] == one
            return not is_joined and not placed.collisionResults[number].isCollision()

        pairs = [pair for number, pair in enumerate(self.geometry.collisionPairs) if is_meant(number, pair)]
        self.pairs = [(pair.first, pair.second) for pair in pairs]
        self.geometry.removeAllCollisionPairs()
        for one, two in self.pairs:
            self.geometry.addCollisionPair(pinocchio.CollisionPair(one, two))

    def _checker(self) -> impinge.Checker:
        """The checker of impinge with the same bodies and pairs: the world as the first frame, then a frame for each joint."""
        data = self.model.createData()
        pinocchio.computeJointJacobians(self.model, data, pinocchio.neutral(self.model))
        frames = [impinge.Frame()]
        for number in range(1, self.model.njoints):
            motion = np.asarray(data.joints[number].S).reshape(6)
            kind, axis = ("prismatic", motion[:3]) if motion[:3].any() else ("revolute", motion[3:])
            origin = self.model.jointPlacements[number].homogeneous
            frames.append(impinge.Frame(self.model.parents[number], origin, kind, axis, number - 1))
        placed = [_shape(body) for body in self.bodies]
        shapes, poses = [shape for shape, _ in placed], np.array([pose for _, pose in placed])
        on = [body.parentJoint for body in self.bodies]
        return impinge.Checker(frames, len(frames) - 1, shapes, on, poses, self.pairs)

    def triangles(self) -> int:
        return sum(body.geometry.num_tris for body in self.bodies if isinstance(body.geometry, coal.BVHModelBase))

    def configurations(self, about: str, count: int) -> Any:
        """Random configurations anywhere within the limits, or near zero, where few collide."""
        random, (low, high) = np.random.default_rng(5), self.limits.T
        if about == "anywhere":
            return random.uniform(low, high, (count, len(low)))
        return np.clip(np.clip(0, low, high) + random.normal(0, NEAR, (count, len(low))), low, high)

    def rows(self, configurations: Any) -> Any:
        """Configurations in the layout of the Pinocchio model, one per column."""
        rows = np.zeros((len(configurations), self.model.nq))
        for (at, is_circle), values in zip(self.columns, configurations.T, strict=True):
            rows[:, at] = np.cos(values) if is_circle else values
            if is_circle:
                rows[:, at + 1] = np.sin(values)
        return np.asfortranarray(rows.T)

    def collides(self, rows: Any) -> Any:
        """The results of Coal: one call for all configurations, on one thread; each ends at its first collision."""
        return np.array(pinocchio.computeCollisionsInParallel(1, self.pool, rows, True), dtype=bool)


def _shape(body: Any) -> tuple[Any, Any]:
    """A shape of impinge, and its pose in the frame of its joint."""
    solid, pose = body.geometry, body.placement.homogeneous
    if isinstance(solid, coal.BVHModelBase):
        faces = [[solid.tri_indices(face)[corner] for corner in range(3)] for face in range(solid.num_tris)]
        return impinge.TriMesh(solid.vertices(), faces), pose
    if isinstance(solid, coal.Box):
        return impinge.Cuboid(solid.halfSide), pose
    if isinstance(solid, coal.Sphere):
        return impinge.Ball(solid.radius), pose
    return impinge.Cylinder(solid.halfLength, solid.radius), pose @ Z_TO_Y.T


def compare(name: str, options: argparse.Namespace) -> list[list[object]]:
    robot, table = Robot(name), []
    for about in ("anywhere", "zero"):
        count = 200 if options.quick else ROBOTS[name][3]
        ours = robot.configurations(about, count)
        theirs, free = robot.rows(ours), robot.checker.is_free(ours)
        sides = {
            "impinge": Side(lambda rows=ours: robot.checker.is_free(rows, threads=1), count),
            "Coal": Side(lambda rows=theirs: robot.collides(rows), count),
        }
        differing = int((free == robot.collides(theirs)).sum())
        found = interleaved(sides, options.rounds)
        times = [1e6 * found[side].median for side in ("impinge", "Coal")]
        sizes = (len(robot.bodies), robot.triangles(), len(robot.pairs), count)
        table.append([name, *sizes, about, int((~free).sum()), differing, *times, times[1] / times[0]])
        print(*table[-1], flush=True)
    return table


def main() -> None:
    options = arguments(__doc__).parse_args()
    if options.quick:
        options.rounds = 2
    options.out.mkdir(parents=True, exist_ok=True)
    line = machine(PACKAGES)
    rows = [row for name in list(ROBOTS)[: 1 if options.quick else None] for row in compare(name, options)]
    about = (
        f"# Self-collisions of robots of surfaces\n\n{line}. `python robot_surfaces.py`: meshes as they are, of the Allegro hand those "
        f"that are shown, of Psyonic hand those of Alex's right hand. Random configurations anywhere within the limits or about zero "
        f"(a deviation of {NEAR}); the bodies of two joints that do not follow each other and do not touch at zero. Microseconds of "
        f"processor time for one configuration, frames included, one thread, median of {options.rounds} rounds. Coal behind "
        f"Pinocchio, one call of C++. Both end a configuration at its first collision. `differ`: configurations about which the two "
        f"disagree.\n\n"
    )
    (options.out / "robot_surfaces.md").write_text(about + markdown(HEADER, rows))


if __name__ == "__main__":
    main()
