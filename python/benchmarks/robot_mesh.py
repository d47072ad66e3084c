"""Robots against a mesh of 100 000 triangles: impinge and Coal called through Pinocchio; first results, then times.

    python robot_mesh.py [--quick] [--triangles 100000] [--configurations 20000] [--out FOLDER]

Writes robot_mesh.md. Needs the packages of robots.py and meshes.py.
"""

from __future__ import annotations

from typing import Any

import impinge
import meshes
import numpy as np
import pinocchio
import robots
from timing import Side, arguments, interleaved, machine, markdown

HEADER = ("robot", "bodies", "question", "configurations", "touching", "differ", "impinge us", "Coal us", "Coal / impinge")

# The radius and the centre of the mesh, a bumpy ball within reach of the robots.
RADIUS, PLACE = 0.4, (0.6, 0.1, 0.5)


class Beside:
    """A robot and the mesh in both libraries."""

    def __init__(self, name: str, triangles: int, count: int) -> None:
        self.sides = robots.Sides(name, count)
        vertices, faces = meshes.surface(triangles)
        vertices = vertices * RADIUS
        self.mesh, self.pose = impinge.TriMesh(vertices, faces), np.eye(4)[None].copy()
        self.pose[0, :3, 3] = PLACE
        self._add(meshes.coal_mesh(vertices, faces))

    def _add(self, model: Any) -> None:
        """Replaces the pairs of Pinocchio by the pairs of each body with the mesh."""
        side, place = self.sides.pinocchio, pinocchio.SE3(np.eye(3), np.array(PLACE))
        side.geometry.removeAllCollisionPairs()
        mesh = side.geometry.addGeometryObject(pinocchio.GeometryObject("the mesh", 0, 0, place, model))
        for number in side.numbers:
            side.geometry.addCollisionPair(pinocchio.CollisionPair(number, mesh))
        side.placed = side.geometry.createData()
        side.pool = pinocchio.GeometryPool(side.model, side.geometry, 1)

    def touches(self) -> Any:
        return self.sides.robot.collides(self.sides.configurations, [self.mesh], self.pose)

    def distances(self, count: int) -> Any:
        return self.sides.robot.distance(self.sides.configurations[:count], [self.mesh], self.pose).distance


def rows(name: str, triangles: int, count: int, rounds: int) -> list[list[object]]:
    beside, few = Beside(name, triangles, count), max(count // 20, 10)
    sides = beside.sides
    bodies, coal_rows = len(sides.robot.bodies), sides.pinocchio.rows(sides.configurations)
    ours, theirs = beside.touches(), sides.pinocchio.collides(coal_rows)
    measured = np.array([max(sides.pinocchio.distance(row), 0) for row in coal_rows[:few]])
    off = np.abs(beside.distances(few) - measured) > meshes.TOLERANCE * RADIUS
    free = interleaved(
        {
            "impinge": Side(beside.touches, count),
            "coal": Side(lambda: sides.pinocchio.collides(coal_rows), count),
        },
        rounds,
    )
    near = interleaved(
        {
            "impinge": Side(lambda: beside.distances(few), few),
            "coal": Side(lambda: [sides.pinocchio.distance(row) for row in coal_rows[:few]], few),
        },
        rounds,
    )

    def row(question: str, asked: int, differ: Any, times: Any) -> list[object]:
        mine, other = times["impinge"].median * 1e6, times["coal"].median * 1e6
        return [name, bodies, question, asked, int(ours[:asked].sum()), int(differ.sum()), mine, other, other / mine]

    return [row("touches?", count, ours != theirs, free), row("distance", few, off, near)]


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--triangles", type=int, default=100_000)
    parser.add_argument("--configurations", type=int, default=20_000)
    options = parser.parse_args()
    if options.quick:
        options.triangles, options.configurations, options.rounds = 1000, 200, 2
    options.out.mkdir(parents=True, exist_ok=True)
    line, table = machine(robots.PACKAGES), []
    for name in ("UR5", "Panda"):
        for row in rows(name, options.triangles, options.configurations, options.rounds):
            print(*row)
            table.append(row)
    (options.out / "robot_mesh.md").write_text(
        f"# Robots beside a mesh\n\n{line}. `python robot_mesh.py`: a mesh of about {options.triangles} triangles beside a "
        "robot whose meshes are convex hulls, random configurations; microseconds of processor time of all threads for one "
        f"configuration, frames included, median of {options.rounds} rounds. Coal behind Pinocchio: `touches?` is one call "
        "of C++ that ends a configuration at its first collision, `distance` a call each. `differ`: answers that are not "
        "the same, distances by more than 1e-6 of the mesh's radius.\n\n" + markdown(HEADER, table)
    )


if __name__ == "__main__":
    main()
