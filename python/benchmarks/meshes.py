"""Triangle meshes: compares impinge with Coal, and rays with trimesh and Embree; first results, then times.

    python meshes.py [--quick] [--triangles 1000 10000 100000] [--ray-triangles 1000 82000] [--poses 200] [--rays 300000]
                     [--only WORD] [--out FOLDER]

Writes meshes.md, a table of each query of meshes with meshes and with convex solids, and rays.md. Needs impinge, coal,
trimesh, embreex and scipy.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import coal
import impinge
import numpy as np
import trimesh
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from timing import Side, arguments, interleaved, machine, markdown
from trimesh.ray.ray_pyembree import RayMeshIntersector

PACKAGES = ("impinge", "coal", "trimesh", "embreex", "numpy")
QUESTIONS = ("distance", "witness", "collide", "contacts")
# More contacts than any two meshes of this benchmark have.
ALL_CONTACTS = 1_000_000

# Results that differ by more than this fraction of the size of the solids are reported.
TOLERANCE = 1e-6


@dataclass(frozen=True)
class Body:
    """A solid in both libraries, at rest in its local frame. `reach` is its approximate radius."""

    name: str
    impinge: Any
    coal: Any
    # The rotation from the frame of impinge to that of Coal: the axes differ for cylinders, cones and capsules.
    turn: Any
    reach: float


# Coal's cylinders, cones and capsules stand along z, those of impinge along y.
UPRIGHT = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
STRAIGHT = np.eye(3)


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--triangles", type=int, nargs="+", default=[1_000, 10_000, 100_000], help="of each mesh, about")
    parser.add_argument("--ray-triangles", type=int, nargs="+", default=[1_000, 10_000, 82_000, 100_000, 328_000],
                        help="of each mesh that rays meet, about")
    parser.add_argument("--poses", type=int, default=200, help="of each case")
    parser.add_argument("--rays", type=int, default=300_000, help="of each kind")
    parser.add_argument("--only", default="", help="only pairs whose name contains this; `rays` for rays alone")
    options = parser.parse_args()
    if options.quick:
        options.triangles, options.poses, options.rays, options.rounds = [1_000], 20, 10_000, 2
        options.ray_triangles = [1_000]
    options.out.mkdir(parents=True, exist_ok=True)
    line = machine(PACKAGES)
    rows = [row for pair in pairs(options) for row in pair_rows(*pair, options)]
    write_pairs(rows, line, options)
    write_rays([row for count in options.ray_triangles for row in ray_rows(count, options)], line, options)


def pairs(options: argparse.Namespace) -> Iterator[tuple[Body, Body]]:
    for count in options.triangles:
        mesh = mesh_body(count)
        for other in [mesh, *solids()]:
            if options.only in f"{mesh.name}, {other.name}":
                yield mesh, other


def surface(count: int) -> tuple[Any, Any]:
    """Vertices and triangles of a bumpy ball of radius about 1: grids on a cube, projected so that no triangle is thin."""
    steps = max(round((count / 12) ** 0.5), 1)
    line = np.linspace(-1, 1, steps + 1)
    grid = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    first = (np.arange(steps)[:, None] * (steps + 1) + np.arange(steps)).ravel()
    quads = np.stack([first, first + steps + 1, first + steps + 2, first + 1], axis=-1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    vertices, triangles = [], []
    for axis in range(3):
        for side in (-1, 1):
            points = np.empty((len(grid), 3))
            points[:, axis] = side
            points[:, (axis + 1) % 3], points[:, (axis + 2) % 3] = grid.T
            triangles.append((faces if side > 0 else faces[:, ::-1]) + len(grid) * len(vertices))
            vertices.append(points)
    ball = trimesh.Trimesh(np.concatenate(vertices), np.concatenate(triangles), process=True)
    points = np.tan(ball.vertices * np.pi / 4)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    x, y, z = points.T
    bumps = np.sin(5 * x) * np.cos(6 * y + 1) + 0.5 * np.sin(7 * z)
    return points * (1 + 0.1 * bumps)[:, None], np.asarray(ball.faces)


def mesh_body(count: int) -> Body:
    vertices, triangles = surface(count)
    model = coal_mesh(vertices, triangles)
    return Body(f"mesh of {len(triangles)}", impinge.TriMesh(vertices, triangles), model, STRAIGHT, 1.0)


def coal_mesh(vertices: Any, triangles: Any) -> Any:
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(triangles), len(vertices))
    model.addVertices(vertices)
    model.addTriangles(triangles)
    model.endModel()
    return model


def solids() -> list[Body]:
    """Convex solids about a quarter as large as the meshes."""
    half = np.array([0.3, 0.2, 0.15])
    points = np.random.default_rng(5).normal(size=(40, 3))
    points *= half / np.linalg.norm(points, axis=1, keepdims=True)
    hull = ConvexHull(points)
    kept = points[hull.vertices]
    triangles = coal.StdVec_Triangle()
    for a, b, c in np.searchsorted(hull.vertices, hull.simplices):
        triangles.append(coal.Triangle(int(a), int(b), int(c)))
    vectors = coal.StdVec_Vec3s()
    vectors.extend(list(kept))
    return [
        Body("ball", impinge.Ball(0.2), coal.Sphere(0.2), STRAIGHT, 0.2),
        Body("cuboid", impinge.Cuboid(half), coal.Box(*(2 * half)), STRAIGHT, 0.2),
        Body("capsule", impinge.Capsule(0.2, 0.1), coal.Capsule(0.1, 0.4), UPRIGHT, 0.2),
        Body("cylinder", impinge.Cylinder(0.2, 0.1), coal.Cylinder(0.1, 0.4), UPRIGHT, 0.2),
        Body("cone", impinge.Cone(0.2, 0.1), coal.Cone(0.1, 0.4), UPRIGHT, 0.2),
        Body("ellipsoid", impinge.Ellipsoid(half), coal.Ellipsoid(*half), STRAIGHT, 0.2),
        Body(f"hull of {len(kept)}", impinge.ConvexHull(kept), coal.Convex(vectors, triangles), STRAIGHT, 0.2),
    ]


def cases(one: Body, other: Body) -> dict[str, float]:
    """The distance between the centres of both bodies, for each case."""
    reach = one.reach + other.reach
    if other.reach < one.reach:
        return {"apart": 1.5 * reach, "near": 1.08 * reach, "overlap": one.reach, "inside": 0.5 * one.reach}
    return {"apart": 1.6 * reach, "near": 1.08 * reach, "overlap": 0.85 * reach, "deep": 0.45 * reach}


def matrices(count: int, distance: float) -> Any:
    rng = np.random.default_rng(3)
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, :3] = Rotation.random(count, random_state=rng).as_matrix()
    way = rng.normal(size=(count, 3))
    poses[:, :3, 3] = distance * way / np.linalg.norm(way, axis=1, keepdims=True)
    return poses


def pair_rows(one: Body, other: Body, options: argparse.Namespace) -> Iterator[list[object]]:
    for case, distance in cases(one, other).items():
        poses = matrices(options.poses, distance)
        for question in QUESTIONS:
            sides = {
                "single": ours_single(question, one, other, poses),
                "batch": ours_batch(question, one, other, poses),
                "Coal": coals(question, one, other, poses),
            }
            theirs, mine = np.array(sides["Coal"]()), np.asarray(sides["batch"](), float)
            assert np.array_equal(np.asarray(sides["single"](), float), mine), "a batch has the bits of single calls"
            timed = interleaved({name: Side(run, len(poses)) for name, run in sides.items()}, options.rounds)
            single, batch, rival = (1e6 * timed[name].median for name in sides)
            spread = max(of.spread for of in timed.values())
            yield [f"{one.name}, {other.name}", case, question, single, batch, rival, rival / single, rival / batch, spread,
                   *difference(question, mine, theirs)]
            print(f"{one.name}, {other.name}, {case}, {question}: {single:.1f} {batch:.1f} {rival:.1f} us", flush=True)


def difference(question: str, mine: Any, theirs: Any) -> tuple[int, float]:
    """The number of results that differ, and the largest difference."""
    if question == "distance":
        mine, theirs = np.maximum(mine, 0), np.maximum(theirs, 0)
    off = np.abs(mine - theirs)
    return int((off > TOLERANCE).sum()), float(off.max())


def ours_single(question: str, one: Body, other: Body, poses: Any) -> Callable[[], Any]:
    ask, rows = ours(question), list(poses)
    return lambda: [ask(one.impinge, None, other.impinge, pose) for pose in rows]


def ours_batch(question: str, one: Body, other: Body, poses: Any) -> Callable[[], Any]:
    ask = ours(question)
    return lambda: ask(one.impinge, None, other.impinge, poses, threads=1)


def ours(question: str) -> Callable[..., Any]:
    if question == "distance":
        return impinge.distance
    if question == "witness":
        return lambda *sides, **options: impinge.witness(*sides, **options).distance
    if question == "contacts":
        return lambda *sides, **options: np.isfinite(impinge.contact(*sides, **options).depth)
    return lambda *sides, **options: impinge.proximity(*sides, **options) == 0


def coals(question: str, one: Body, other: Body, poses: Any) -> Callable[[], Any]:
    """A loop of Coal's functors, which reuse requests and results. For two overlapping meshes the distance is zero."""
    here = coal.Transform3s()
    there = [coal.Transform3s(pose[:3, :3] @ other.turn, pose[:3, 3]) for pose in poses]
    is_collision = question in ("collide", "contacts")
    if is_collision:
        call, request, result = coal.ComputeCollision(one.coal, other.coal), coal.CollisionRequest(), coal.CollisionResult()
        if question == "contacts":
            request.num_max_contacts = ALL_CONTACTS
    else:
        call, request, result = coal.ComputeDistance(one.coal, other.coal), coal.DistanceRequest(), coal.DistanceResult()
        request.enable_signed_distance = question == "witness"
    clear = result.clear
    if is_collision:
        return lambda: [(clear(), call(here, pose, request, result) > 0)[1] for pose in there]
    return lambda: [(clear(), call(here, pose, request, result))[1] for pose in there]


def ray_rows(count: int, options: argparse.Namespace) -> Iterator[list[object]]:
    """Rows of first hits: time and triangle from impinge; from trimesh the triangle, or the triangle and the hit point."""
    vertices, triangles = surface(count)
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    intersector = RayMeshIntersector(mesh)
    for kind, (origins, directions) in rays(options.rays).items():
        name = f"rays, mesh of {len(triangles)}, {kind}"
        if options.only not in name:
            continue
        sides = {"float64": ours_rays(vertices, triangles, origins, directions),
                 "float32": ours_rays(vertices.astype(np.float32), triangles, origins.astype(np.float32),
                                      directions.astype(np.float32)),
                 "triangle": lambda: intersector.intersects_first(origins, directions),
                 "location": lambda: intersector.intersects_location(origins, directions, multiple_hits=False)}
        mine, theirs = sides["float64"](), sides["triangle"]()
        part = np.where(np.isfinite(mine.time), mine.part.astype(np.int64), -1)
        timed = interleaved({name: Side(run, len(origins)) for name, run in sides.items()}, options.rounds)
        double, single, first, place = (1e9 * timed[name].median for name in sides)
        yield [name, double, single, first, place, first / double, first / single, place / double, place / single,
               max(of.spread for of in timed.values()), int((part != theirs).sum()), int(((part < 0) != (theirs < 0)).sum())]
        print(f"{name}: {double:.0f} {single:.0f} {first:.0f} {place:.0f} ns", flush=True)


def ours_rays(vertices: Any, triangles: Any, origins: Any, directions: Any) -> Callable[[], Any]:
    mesh = impinge.TriMesh(vertices, triangles, dtype=str(vertices.dtype))
    return lambda: impinge.cast_rays(mesh, None, origins, directions, threads=1)


def rays(count: int) -> dict[str, tuple[Any, Any]]:
    """Rays of a camera, row by row, and rays from around the mesh to random points in it."""
    side = max(int(count**0.5), 1)
    x, y = np.meshgrid(np.linspace(-0.35, 0.35, side), np.linspace(-0.35, 0.35, side))
    directions = np.stack([x.ravel(), y.ravel(), np.ones(side * side)], axis=-1)
    camera = np.tile([0.0, 0, -4], (side * side, 1)), directions
    rng = np.random.default_rng(9)
    start, end = rng.normal(size=(2, side * side, 3))
    start *= 3 / np.linalg.norm(start, axis=1, keepdims=True)
    end *= 0.9 / np.linalg.norm(end, axis=1, keepdims=True)
    return {"camera": camera, "random": (start, end - start)}


def write_pairs(rows: list[list[object]], line: str, options: argparse.Namespace) -> None:
    header = ["pair", "poses", "question", "single us", "batch us", "Coal us", "Coal / single", "Coal / batch", "spread",
              "differ", "largest"]
    text = [
        "# Meshes\n",
        f"{line}. `python meshes.py`: microseconds of processor time for a pose, one thread, median of {options.rounds} rounds of "
        f"{options.poses} poses. Coal's BVHs are of OBBRSS. The witness is the signed distance, of the deepest two parts where several "
        "overlap; Coal answers zero where two meshes overlap, and with a convex solid the depth of parts that it came upon. `contacts`: the "
        "deepest contact that the whole has, beside one contact of every two parts that overlap. "
        f"`differ` counts answers that are farther apart than {TOLERANCE}, `largest` is by how much.\n",
        markdown(header, rows),
    ]
    (options.out / "meshes.md").write_text("\n".join(text))


def write_rays(rows: list[list[object]], line: str, options: argparse.Namespace) -> None:
    header = ["rays", "float64 ns", "float32 ns", "Embree, triangle ns", "Embree, place ns", "triangle / float64",
              "triangle / float32", "place / float64", "place / float32", "spread", "other triangles", "other misses"]
    text = [
        "# Rays\n",
        f"{line}. `python meshes.py`: nanoseconds of processor time for a ray, one thread, median of {options.rounds} rounds. impinge "
        "answers time, normal, triangle and side; trimesh with Embree the triangle (`intersects_first`), or that and the place "
        "(`intersects_location`). Embree computes in single precision.\n",
        markdown(header, rows),
    ]
    (options.out / "rays.md").write_text("\n".join(text))


if __name__ == "__main__":
    main()
