"""Pairs of convex solids: compares impinge with Coal, python-fcl and trimesh; first results, then times.

    python pairs.py [--quick] [--out FOLDER]

Writes differences.md and differences.csv (differing results, and which library is right), pairs.md and pairs.csv
(times), and managers.md (trimesh's collision manager). Needs impinge, coal, python-fcl, trimesh and scipy.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from itertools import combinations_with_replacement

import numpy as np

import managers
from differences import Judge
from guarded_fcl import Fcl
from placements import FAMILIES, placements
from rivals import QUESTIONS, Coal, Impinge
from solids import Array, Solid, solids
from timing import Side, arguments, interleaved, machine, markdown, write_csv

PACKAGES = ("impinge", "coal", "python-fcl", "trimesh", "numpy")

# The targets for the time of a loop over Coal's functor divided by the time of a batch of impinge: of primitives,
# and of pairs with a hull.
GOAL_PRIMITIVES, GOAL_HULLS = 50.0, 10.0

HEADER = (
    "pair",
    "poses",
    "question",
    "impinge single ns",
    "Coal functor ns",
    "Coal plain ns",
    "FCL ns",
    "impinge batch ns",
    "Coal read ns",
    "single / Coal",
    "Coal / batch",
    "Coal read / batch",
    "spread",
)


ABOUT = """\
{line}. `python pairs.py`: {poses} pairs of poses for each family, {rounds} rounds, medians of processor time in
nanoseconds for one pair (loops in Python over the first {loops}), one thread, f64, all sides in turn in one
process. `single`: impinge called for each pair. `Coal functor`: `ComputeDistance` or `ComputeCollision` with ready
transforms, a ready request and a cleared result, nothing read; `plain`: `coal.distance` or `coal.collide` with a
new result; `read`: with points and normals read. `batch`: one call of impinge for all. `distance` is without,
`witness` with sign, points and normal. The triangle is a convex of three points for Coal and FCL.
"""


def main() -> None:
    parser = arguments(__doc__)
    parser.add_argument("--poses", type=int, default=10_000, help="of each family, for the times")
    parser.add_argument("--answers", type=int, default=500, help="of each family, whose answers are compared")
    parser.add_argument("--only", default="", help="only pairs whose name contains this")
    parser.add_argument("--skip-times", action="store_true", help="compare the answers alone")
    parser.add_argument("--skip-answers", action="store_true", help="take the times alone")
    options = parser.parse_args()
    if options.quick:
        options.poses, options.answers, options.rounds = 200, 100, 2
    options.out.mkdir(parents=True, exist_ok=True)
    line = machine(PACKAGES)
    if not options.skip_answers:
        compare(options, line)
    if not options.skip_times:
        measure(options, line)


def compare(options: argparse.Namespace, line: str) -> None:
    """Compares the results of all pairs."""
    judge = Judge()
    for one, two in pairs(options):
        for family in FAMILIES:
            judge.compare(family, one, two, placements(family, one, two, options.answers))
        print(f"answers of {one.name}, {two.name}: {judge.summary()}", flush=True)
    judge.write(options.out, line, options.answers)


def measure(options: argparse.Namespace, line: str) -> None:
    """Measures the times of all pairs."""
    rows: list[list[object]] = []
    for one, two in pairs(options):
        for family in FAMILIES:
            rows += times(family, one, two, options)
        print(f"times of {one.name}, {two.name}", flush=True)
    write_times(rows, line, options)
    managers.run(options, line)


def pairs(options: argparse.Namespace) -> Iterator[tuple[Solid, Solid]]:
    for one, two in combinations_with_replacement(solids(options.quick), 2):
        if not (one.is_half_space and two.is_half_space) and options.only in f"{one.name}, {two.name}":
            yield one, two


def times(family: str, one: Solid, two: Solid, options: argparse.Namespace) -> list[list[object]]:
    """The rows of one pair: for each query, nanoseconds per pair of poses."""
    placed: tuple[Array, Array] = placements(family, one, two, options.poses)
    sides = [library(one, placed[0], two, placed[1]) for library in (Impinge, Coal, Fcl)]
    return [_times(sides, f"{one.name}, {two.name}", family, question, options) for question in QUESTIONS]


def _times(sides: list, pair: str, family: str, question: str, options: argparse.Namespace) -> list[object]:
    ours, theirs, fcl = sides
    count = loops(options.poses)
    few = max(count // 10, 1)
    timed = {
        "single": Side(ours.loop(question, count), count),
        "coal": Side(theirs.loop(question, count), count),
        "plain": Side(theirs.plain(question, count), count),
        "read": Side(theirs.read(question, count), count),
        "batch": Side(ours.batch(question), options.poses),
    }
    if (loop := fcl.loop(question, few)) is not None:
        timed["fcl"] = Side(loop, few)
    found = interleaved(timed, options.rounds)
    ns = {name: 1e9 * side.median for name, side in found.items()}
    return [
        pair,
        family,
        question,
        ns["single"],
        ns["coal"],
        ns["plain"],
        ns.get("fcl"),
        ns["batch"],
        ns["read"],
        ns["single"] / ns["coal"],
        ns["coal"] / ns["batch"],
        ns["read"] / ns["batch"],
        max(found["coal"].spread, found["batch"].spread),
    ]


def loops(poses: int) -> int:
    """The number of poses for loops in Python, a quarter of all: each iteration costs the same."""
    return max(poses // 4, 1)


def goal(pair: str) -> float:
    return GOAL_HULLS if "hull" in pair else GOAL_PRIMITIVES


def write_times(rows: list[list[object]], line: str, options: argparse.Namespace) -> None:
    """Writes a summary by query, the cases that miss their target, the slowest first, and the table of all cases."""
    write_csv(options.out / "pairs.csv", HEADER, rows)
    slow_single = sorted((row for row in rows if row[9] > 1), key=lambda row: -row[9])
    slow_batch = sorted((row for row in rows if row[10] < goal(row[0])), key=lambda row: row[10] / goal(row[0]))
    text = [
        "# Pairs of convex solids: times\n",
        ABOUT.format(line=line, poses=options.poses, loops=loops(options.poses), rounds=options.rounds),
        "## By question and poses\n",
        markdown(*_summary(rows)),
        f"## Single calls slower than Coal's functor: {len(slow_single)} of {len(rows)}\n",
        markdown(*_part(slow_single, (0, 1, 2, 3, 4, 5, 9))),
        f"## Batches below {GOAL_PRIMITIVES:.0f} times (hulls {GOAL_HULLS:.0f} times) Coal's loop: "
        f"{len(slow_batch)} of {len(rows)}\n",
        markdown(*_part(slow_batch, (0, 1, 2, 7, 4, 8, 10, 11))),
        "## All\n",
        markdown(HEADER, rows),
    ]
    (options.out / "pairs.md").write_text("\n".join(text))


def _part(rows: list[list[object]], columns: tuple[int, ...]) -> tuple[list[str], list[list[object]]]:
    return [HEADER[column] for column in columns], [[row[column] for column in columns] for row in rows]


def _summary(rows: list[list[object]]) -> tuple[list[str], list[list[object]]]:
    table: list[list[object]] = []
    for is_hull in (False, True):
        for question in QUESTIONS:
            for family in FAMILIES:
                of = [row for row in rows if ("hull" in row[0], row[1], row[2]) == (is_hull, family, question)]
                if not of:
                    continue
                single, batch, read = (np.array([row[column] for row in of], dtype=float) for column in (9, 10, 11))
                versus_fcl = [row[6] / row[7] for row in of if row[6] is not None]
                table.append(
                    [
                        "hulls" if is_hull else "primitives",
                        question,
                        family,
                        len(of),
                        int((single <= 1).sum()),
                        float(np.median(single)),
                        float(np.median(batch)),
                        float(batch.min()),
                        int(sum(row[10] >= goal(row[0]) for row in of)),
                        float(np.median(read)),
                        float(np.median(versus_fcl)) if versus_fcl else None,
                    ]
                )
    header = [
        "of",
        "question",
        "poses",
        "pairs",
        "single as fast",
        "median single / Coal",
        "median Coal / batch",
        "worst Coal / batch",
        "goal reached",
        "median Coal read / batch",
        "median FCL / batch",
    ]
    return header, table


if __name__ == "__main__":
    main()
