"""Self-collisions of robots: compares `impinge.urdf.Robot` with Coal through Pinocchio and with python-fcl; results,
then times.

    python robots.py [--quick] [--out FOLDER]

Robots of the package example-robot-data, with meshes as convex hulls and the same pairs of bodies in all libraries.
Writes robots.md and robots.csv. Needs impinge, pin, example-robot-data, python-fcl, trimesh and yourdfpy.
"""

from __future__ import annotations

import argparse
import sys
import xml.etree.ElementTree as ElementTree
from itertools import product
from pathlib import Path
from typing import Any

import coal
import fcl
import impinge
import numpy as np
import pinocchio
from impinge.urdf import Robot

from certify import greatest_gaps
from solids import Solid, corners_alone
from timing import Side, arguments, interleaved, machine, markdown, write_csv

PACKAGES = ("impinge", "pin", "coal", "python-fcl", "example-robot-data", "numpy")
# The data folder of cmeel's packages.
SHARE = Path(pinocchio.__file__).resolve().parents[4] / "share"
ROBOTS = {
    "UR5": "ur_description/urdf/ur5_robot.urdf",
    "Panda": "panda_description/urdf/panda.urdf",
    "Talos": "talos_data/robots/talos_reduced.urdf",
}
# The number of differing rows that are examined.
MOST_JUDGED = 20

HEADER = (
    "robot",
    "bodies",
    "pairs",
    "configurations",
    "colliding",
    "question",
    "side",
    "asked",
    "us processor",
    "us wall",
    "times impinge",
)


ABOUT = """\
{line}. `python robots.py`: random configurations within the limits (at most half a turn either way), meshes as
convex hulls, the bodies of two links that share no joint and do not touch at zero. Medians of {rounds} rounds, all
sides in turn in one process. `us processor` is the time of all threads together for one configuration, `us wall`
what passed: impinge uses all threads, the others one. Coal runs behind Pinocchio, whose frames are part of its
time: `one call of C++` is `computeCollisionsInParallel` with one thread, `a call each` `computeCollisions` and
`computeDistances` from Python. FCL has its transforms ready, without frames. All end a configuration at its first
collision. Of the configurations that differ the first {judged} are judged by support functions, unless cylinders
may decide.
"""


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--configurations", type=int, default=100_000)
    options = parser.parse_args()
    if options.quick:
        options.configurations, options.rounds = 300, 2
    options.out.mkdir(parents=True, exist_ok=True)
    line = machine(PACKAGES)
    rows: list[list[object]] = []
    answers: list[list[object]] = []
    for name in list(ROBOTS)[: 1 if options.quick else None]:
        # Talos has twelve hundred pairs, so fewer configurations.
        sides = Sides(name, options.configurations // (50 if name == "Talos" else 1))
        answers += sides.differences()
        rows += sides.times(options.rounds)
        write(options, line, answers, rows)
        print(f"{name}: done", file=sys.stderr, flush=True)


class Sides:
    """One robot in all libraries, with the same configurations and pairs of bodies."""

    def __init__(self, name: str, count: int) -> None:
        path = SHARE / "example-robot-data" / "robots" / ROBOTS[name]
        self.name, self.robot = name, Robot.load(path)
        limits = np.clip(self.robot.limits, -np.pi, np.pi)
        self.robot.allow_touching_at(np.clip(np.zeros(len(limits)), *limits.T))
        self.configurations = np.random.default_rng(5).uniform(*limits.T, (count, len(limits)))
        self.pinocchio = Pinocchio(path, self.robot)
        self.rows = self.pinocchio.rows(self.configurations)
        # FCL is a loop in Python over all pairs, so it gets fewer configurations.
        self.few = min(count, 100_000 // max(len(self.robot.pairs), 1) // 5)

    def differences(self) -> list[list[object]]:
        """Rows with the number of configurations whose results differ, and the pairs concerned."""
        ours = self.robot.self_collides(self.configurations)
        theirs = {
            "Coal": (self.pinocchio.collides(self.rows), len(self.rows)),
            "FCL": (np.array(Fcl(self, self.few).run()), self.few),
        }
        distance = self.robot.self_distance(self.configurations[: self.few]).distance
        measured = np.array([self.pinocchio.distance(row) for row in self.rows[: self.few]])
        off = np.abs(distance - np.maximum(measured, 0))
        table = []
        for rival, (found, count) in theirs.items():
            differing = np.flatnonzero(ours[:count] != found)
            verdicts = [self._touches(row) for row in differing[:MOST_JUDGED]]
            judged = len([verdict for verdict in verdicts if verdict is not None])
            right = len([1 for at, verdict in enumerate(verdicts) if verdict == ours[differing[at]]])
            notes = [self._note(row, ours[row], rival, found[row]) for row in differing[:3]]
            counts = int(ours[:count].sum()), len(differing), right, judged - right
            largest = float(off.max()) if rival == "Coal" else None
            table.append([self.name, rival, count, *counts, largest, "; ".join(notes) or "none"])
        return table

    def _touches(self, row: int) -> bool | None:
        """Whether a pair overlaps in a configuration, by support functions; `None` if it depends on a pair with a shape
        without corners."""
        poses = self.robot.poses(self.configurations[row])[:, None]
        corners, is_sure = self.pinocchio.corners, True
        for one, two in self.robot.pairs:
            if corners[one] is None or corners[two] is None:
                is_sure = False
            elif greatest_gaps(corners[one], poses[one], corners[two], poses[two])[0] < 0:
                return True
        return False if is_sure else None

    def _note(self, row: int, ours: bool, rival: str, theirs: bool) -> str:
        """A text with the results of a configuration and its smallest signed distances, computed by single queries."""
        poses = self.robot.poses(self.configurations[row])
        bodies = self.robot.bodies
        signed = [
            float(impinge.witness(bodies[one].shape, poses[one], bodies[two].shape, poses[two]).distance)
            for one, two in self.robot.pairs
        ]
        one, two = self.robot.pairs[int(np.argmin(signed))]
        answers = f"impinge {'touches' if ours else 'free'}, {rival} {'touches' if theirs else 'free'}"
        least = f"least signed distance {min(signed):.3g}, of Coal {min(self.pinocchio.signed(self.rows[row])):.3g}"
        return f"{row}, {bodies[one].name}, {bodies[two].name}: {answers}, {least}"

    def times(self, rounds: int) -> list[list[object]]:
        """Microseconds per configuration, by query and library: processor time, and wall time with all threads."""
        count, some = len(self.configurations), min(len(self.configurations), 2_000)
        first = self.configurations[:some]
        fcl_side = Fcl(self, self.few)
        questions: dict[str, dict[str, Side]] = {
            "free?": {
                "impinge Robot": Side(lambda: self.robot.self_collides(self.configurations), count),
                "Coal, one call of C++": Side(lambda: self.pinocchio.collides(self.rows), count),
                "Coal, a call each": Side(lambda: self.pinocchio.collides_each(self.rows[:some]), some),
                "FCL, a call each pair": Side(fcl_side.run, self.few),
            },
            "distance": {
                "impinge Robot": Side(lambda: self.robot.self_distance(first), some),
                "Coal, a call each": Side(lambda: [self.pinocchio.distance(row) for row in self.rows[:some]], some),
            },
        }
        colliding = int(self.robot.self_collides(self.configurations).sum())
        table = []
        for question, sides in questions.items():
            found = interleaved(sides, rounds)
            for name, side in sides.items():
                table.append(
                    [
                        self.name,
                        len(self.robot.bodies),
                        len(self.robot.pairs),
                        count,
                        colliding,
                        question,
                        name,
                        side.elements,
                        1e6 * found[name].median,
                        1e6 * found[name].wall,
                        found[name].median / found["impinge Robot"].median,
                    ]
                )
        return table


class Pinocchio:
    """Coal called through Pinocchio: frames and collisions in C++."""

    def __init__(self, path: Path, robot: Robot) -> None:
        self.model = pinocchio.buildModelFromUrdf(str(path))
        kind = pinocchio.GeometryType.COLLISION
        self.geometry = pinocchio.buildGeomFromUrdf(self.model, str(path), kind, None, [str(SHARE)])
        for solid in self.geometry.geometryObjects:
            solid.geometry = _hull(solid.geometry)
        names = {solid.name: number for number, solid in enumerate(self.geometry.geometryObjects)}
        # The index that each of the robot's bodies has in Pinocchio's geometry.
        self.numbers = [names["_".join(body.name.rsplit("/", 1))] for body in robot.bodies]
        for one, two in robot.pairs:
            self.geometry.addCollisionPair(pinocchio.CollisionPair(self.numbers[one], self.numbers[two]))
        # The two bodies of a pair may be stored swapped, but the pairs keep their order.
        assert len(self.geometry.collisionPairs) == len(robot.pairs)
        self.columns = _columns(path, self.model, robot)
        self.data, self.placed = self.model.createData(), self.geometry.createData()
        self.corners = [_corners(self.geometry.geometryObjects[number].geometry) for number in self.numbers]
        self.pool = pinocchio.GeometryPool(self.model, self.geometry, 1)

    def rows(self, configurations: Any) -> Any:
        """Configurations in the layout of the Pinocchio model, with mimic joints and with cosine and sine of circular
        joints."""
        rows = np.zeros((len(configurations), self.model.nq))
        for index, is_circle, column, multiplier, offset in self.columns:
            value = multiplier * configurations[:, column] + offset
            if is_circle:
                rows[:, index], rows[:, index + 1] = np.cos(value), np.sin(value)
            else:
                rows[:, index] = value
        return rows

    def collides(self, rows: Any) -> Any:
        """One call for all configurations, on one thread; each ends at its first collision."""
        return np.array(
            pinocchio.computeCollisionsInParallel(1, self.pool, np.asfortranarray(rows.T), True), dtype=bool
        )

    def collides_each(self, rows: Any) -> list[bool]:
        model, data, geometry, placed = self.model, self.data, self.geometry, self.placed
        return [pinocchio.computeCollisions(model, data, geometry, placed, row, True) for row in rows]

    def distance(self, row: Any) -> float:
        """The smallest distance of all pairs."""
        at = pinocchio.computeDistances(self.model, self.data, self.geometry, self.placed, row)
        return float(self.placed.distanceResults[at].min_distance)

    def signed(self, row: Any) -> list[float]:
        """The signed distances of all pairs."""
        pinocchio.computeDistances(self.model, self.data, self.geometry, self.placed, row)
        return [float(result.min_distance) for result in self.placed.distanceResults]


def _hull(geometry: Any) -> Any:
    if not isinstance(geometry, coal.BVHModelBase):
        return geometry
    geometry.buildConvexHull(True, "Qt")
    return geometry.convex


def _corners(shape: Any) -> Solid | None:
    """The vertices of hulls and boxes as a solid for `certify`; `None` for other shapes."""
    if isinstance(shape, coal.Box):
        signs = np.array(list(product((-1.0, 1), repeat=3)))
        return corners_alone("box", signs * shape.halfSide)
    if isinstance(shape, coal.ConvexBase):
        return corners_alone("hull", np.array([shape.point(number) for number in range(shape.num_points)]))
    return None


def _columns(path: Path, model: Any, robot: Robot) -> list[tuple[int, bool, int, float, float]]:
    """For each joint of the model: its index, whether it has a cosine and a sine, the column of the robot that drives
    it, and the multiplier and the offset of a mimic joint."""
    mimics = {}
    for joint in ElementTree.parse(path).getroot().iter("joint"):
        if (mimic := joint.find("mimic")) is not None:
            factors = float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))
            mimics[joint.get("name")] = (mimic.get("joint"), *factors)
    columns = []
    for name, joint in zip(list(model.names)[1:], list(model.joints)[1:], strict=True):
        driver, multiplier, offset = mimics.get(name, (name, 1.0, 0.0))
        columns.append((joint.idx_q, joint.nq == 2, robot.joints.index(driver), multiplier, offset))
    return columns


class Fcl:
    """python-fcl: a loop in Python, with frames computed beforehand."""

    def __init__(self, sides: Sides, count: int) -> None:
        robot, geometry = sides.robot, sides.pinocchio.geometry
        by_name = {solid.name: solid.geometry for solid in geometry.geometryObjects}
        shapes = [by_name["_".join(body.name.rsplit("/", 1))] for body in robot.bodies]
        self.objects = [fcl.CollisionObject(_fcl_shape(shape)) for shape in shapes]
        self.pairs = [(self.objects[one], self.objects[two]) for one, two in robot.pairs]
        model, data, placed = sides.pinocchio.model, sides.pinocchio.data, sides.pinocchio.placed
        names = {solid.name: number for number, solid in enumerate(geometry.geometryObjects)}
        order = [names["_".join(body.name.rsplit("/", 1))] for body in robot.bodies]
        self.poses = []
        for row in sides.rows[:count]:
            pinocchio.updateGeometryPlacements(model, data, geometry, placed, row)
            self.poses.append([fcl.Transform(placed.oMg[at].rotation, placed.oMg[at].translation) for at in order])

    def run(self) -> list[bool]:
        request, found = fcl.CollisionRequest(), []
        for poses in self.poses:
            for body, pose in zip(self.objects, poses, strict=True):
                body.setTransform(pose)
            found.append(any(fcl.collide(one, two, request, fcl.CollisionResult()) > 0 for one, two in self.pairs))
        return found


def _fcl_shape(shape: Any) -> Any:
    """The solid as a shape of FCL: a box, a ball, a cylinder, or a convex hull."""
    if isinstance(shape, coal.Box):
        return fcl.Box(*(2 * shape.halfSide))
    if isinstance(shape, coal.Sphere):
        return fcl.Sphere(shape.radius)
    if isinstance(shape, coal.Cylinder):
        return fcl.Cylinder(shape.radius, 2 * shape.halfLength)
    points = np.array([shape.point(number) for number in range(shape.num_points)])
    faces = [[3, *(int(shape.polygons(number)[corner]) for corner in range(3))] for number in range(shape.num_polygons)]
    return fcl.Convex(points, len(faces), np.array(faces).ravel())


def write(options: argparse.Namespace, line: str, answers: list[list[object]], rows: list[list[object]]) -> None:
    write_csv(options.out / "robots.csv", HEADER, rows)
    compared = [
        "robot",
        "rival",
        "configurations",
        "colliding",
        "differ",
        "impinge right",
        "rival right",
        "largest difference of distance, m",
        "first rows that differ",
    ]
    text = [
        "# Self-collisions of robots\n",
        ABOUT.format(line=line, rounds=options.rounds, judged=MOST_JUDGED),
        "## Answers\n",
        markdown(compared, answers),
        "## Times\n",
        markdown(HEADER, rows),
    ]
    (options.out / "robots.md").write_text("\n".join(text))


if __name__ == "__main__":
    main()
