"""Measures configurations of a robot checked per second: the scenes of MotionBenchMaker, robots as spheres.

    python configurations.py FOLDER [--quick] [--scenes 700] [--count 2048] [--threads 1] [--out FOLDER]

Writes configurations.md.

FOLDER has `vamp_panda.json` and `vamp_panda.npz`, and those of ur5 and fetch: the spherised robots of vamp (W. Thomason, Z.
Kingston, L. E. Kavraki, 2024) and the problems of MotionBenchMaker (C. Chamzas et al., 2021). Configurations are random
within the joint limits. No test is made of links that are joined, that touch at the start, or that touch in nearly all
configurations, nor of obstacles and links that do not move. A sample of the results is compared with single queries of all
pairs.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import impinge
import numpy as np
from timing import arguments, machine, markdown

TARGET = 2e6
HEADER = (
    *("robot", "scalar", "scenes", "spheres", "pairs", "part not free"),
    *("million configurations a second", "of the target", "differing"),
)
# Rotates the y axis, along which cylinders of impinge lie, to the z axis.
Y_TO_Z = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])


class Robot:
    """A robot from a file, its pairs, and its scenes."""

    def __init__(self, folder: Path, name: str, dtype: str) -> None:
        self.data = json.loads((folder / f"vamp_{name}.json").read_text())
        self.scenes = np.load(folder / f"vamp_{name}.npz")
        self.dtype = dtype
        self.joints = self.data["joint_names"]
        limits = {joint["name"]: joint["limit"] for joint in self.data["joints"]}
        self.limits = np.array([limits[name] for name in self.joints])
        self.spheres, self.link = np.array(self.data["spheres"]), np.array(self.data["link_of"])
        self.frames = self._frames()
        self.pairs = self._pairs()
        self.checker = self._checker(self.pairs)
        self.starts = np.concatenate([[0], np.cumsum(self.scenes["counts"])])

    def _frames(self) -> list[impinge.Frame]:
        frames = [impinge.Frame()] * len(self.data["links"])
        for joint in self.data["joints"]:
            origin = np.array(joint["origin"]).reshape(4, 4)
            frame = impinge.Frame(joint["parent"], origin)
            if joint["name"] in self.joints:
                kind = "prismatic" if joint["type"] == "prismatic" else "revolute"
                frame = frame._replace(joint=kind, axis=joint["axis"], column=self.joints.index(joint["name"]))
            frames[joint["child"]] = frame
        return frames

    def _checker(self, pairs: Any) -> impinge.Checker:
        shapes = [impinge.Ball(radius, dtype=self.dtype) for radius in self.spheres[:, 3]]
        return impinge.Checker(
            self.frames, len(self.joints), shapes, self.link, impinge.Poses(self.spheres[:, :3]), pairs
        )

    def random(self, generator: np.random.Generator, count: int) -> Any:
        low, high = self.limits.T
        return generator.uniform(low, high, (count, len(low))).astype(self.dtype)

    def _pairs(self) -> Any:
        rows = np.vstack([self.scenes["starts"][:1], self.random(np.random.default_rng(1), 300)])
        poses = self._checker([]).poses(rows)[..., :3, 3]
        joined = {frozenset((frame.parent, child)) for child, frame in enumerate(self.frames)}
        wanted = []
        for one, two in np.argwhere(np.triu(np.ones((len(self.data["links"]),) * 2, dtype=bool), 1)):
            first, second = np.flatnonzero(self.link == one), np.flatnonzero(self.link == two)
            if frozenset((one, two)) in joined or not (len(first) and len(second)):
                continue
            apart = np.linalg.norm(poses[:, first, None] - poses[:, None, second], axis=-1)
            radii = self.spheres[first, None, 3] + self.spheres[None, second, 3]
            touching = (apart <= radii).any(axis=(1, 2))
            if not touching[0] and touching.mean() < 0.95:
                wanted += [(i, j) for i in first for j in second]
        return np.sort(np.array(wanted), axis=1)

    def still(self) -> Any:
        """The indices of the spheres that no joint moves."""
        moves = [frame.joint != "fixed" for frame in self.frames]

        def is_still(link: int | None) -> bool:
            return link is None or (not moves[link] and is_still(self.frames[link].parent))

        return [body for body, link in enumerate(self.link) if is_still(int(link))]

    def set_scene(self, number: int) -> tuple[list[Any], Any]:
        rows = range(self.starts[number], self.starts[number + 1])
        shapes, poses = [], np.tile(np.eye(4), (len(rows), 1, 1))
        for place, row in enumerate(rows):
            size, pose = self.scenes["sizes"][row], self.scenes["poses"][row]
            poses[place] = matrix(pose)
            if self.scenes["kinds"][row] == 1:
                shapes.append(impinge.Cuboid(size, dtype=self.dtype))
            else:
                shapes.append(impinge.Cylinder(size[0], size[1], dtype=self.dtype))
                poses[place] @= Y_TO_Z
        ignored = [(body, obstacle) for body in self.still() for obstacle in range(len(rows))]
        self.checker.set_obstacles(shapes, poses, ignored)
        return shapes, poses


def matrix(pose: Any) -> Any:
    """The matrix of a position and a quaternion w, x, y, z."""
    w, x, y, z = pose[3:] / np.linalg.norm(pose[3:])
    found = np.eye(4)
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    found[:3, 3] = pose[:3]
    return found


def by_pairs(robot: Robot, rows: Any, shapes: list[Any], obstacles: Any) -> Any:
    """Whether each configuration is free, by single queries of all pairs."""
    poses, still = robot.checker.poses(rows), set(robot.still())
    balls = [impinge.Ball(radius, dtype=robot.dtype) for radius in robot.spheres[:, 3]]
    free = np.ones(len(rows), dtype=bool)
    for one, two in robot.pairs:
        free &= impinge.proximity(balls[one], poses[:, one], balls[two], poses[:, two]) != 0
    for body in range(len(balls)):
        for shape, pose in zip(shapes, obstacles, strict=True) if body not in still else ():
            free &= impinge.proximity(balls[body], poses[:, body], shape, pose) != 0
    return free


def measure(robot: Robot, options: argparse.Namespace) -> tuple[float, float, int]:
    """Configurations per second, the fraction that is not free, and the number of results that differ from `by_pairs`."""
    generator, seconds, hits, wrong = np.random.default_rng(7), 0.0, 0, 0
    # One thread is timed by its processor time, so that other processes have little influence.
    clock = time.process_time if options.threads == 1 else time.perf_counter
    numbers = np.linspace(0, len(robot.scenes["counts"]) - 1, options.scenes).astype(int)
    for index, number in enumerate(numbers):
        shapes, obstacles = robot.set_scene(number)
        rows = robot.random(generator, options.count)
        times = []
        for _ in range(3):
            start = clock()
            free = robot.checker.is_free(rows, threads=options.threads)
            times.append(clock() - start)
        seconds += min(times)
        hits += int((~free).sum())
        if index % 10 == 0:
            wrong += int((free[:256] != by_pairs(robot, rows[:256], shapes, obstacles)).sum())
    checked = len(numbers) * options.count
    return checked / seconds, hits / checked, wrong


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--scenes", type=int, default=700, help="of each robot")
    parser.add_argument("--count", type=int, default=2048, help="of configurations in each scene")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    if options.quick:
        options.scenes, options.count = 10, 512
    options.out.mkdir(parents=True, exist_ok=True)
    line, rows = machine(("impinge", "numpy")), []
    for name in ("panda", "ur5", "fetch"):
        for dtype in ("float32", "float64"):
            robot = Robot(options.folder, name, dtype)
            rate, hits, wrong = measure(robot, options)
            sizes = [options.scenes, len(robot.spheres), len(robot.pairs)]
            rows.append([name, dtype, *sizes, hits, rate / 1e6, rate / TARGET, wrong])
            print(*rows[-1])
    (options.out / "configurations.md").write_text(
        f"# Configurations of robots as spheres\n\n{line}. `python configurations.py FOLDER`: {options.count} random "
        f"configurations in each scene, free or not, {options.threads} thread, the best of three calls. `differing`: answers "
        f"about 256 configurations of every tenth scene that are not those of single calls.\n\n" + markdown(HEADER, rows)
    )


if __name__ == "__main__":
    main()
