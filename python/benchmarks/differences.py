"""Compares the results of all libraries, and decides by bounds which library is right."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from certify import gaps, greatest_gaps, unit, upper_bound
from guarded_fcl import MOST_FAILURES, Fcl
from rivals import COMPARED, Answers, Coal, Impinge
from solids import Array, Solid
from timing import markdown, write_csv

# Differences above this fraction of the sum of both radii are examined.
TOLERANCE = 1e-6
# The number of rows in differences.csv for each pair, family, library and result: those with the largest differences.
# All differences are counted.
KEPT = 5

ABOUT = """\
{line}. `python pairs.py`: {count} poses of each family (apart, near or overlapping, aligned on a grid) and pair,
f64. A difference is one above {tolerance:g} of the sum of the radii; `distance` is zero where they touch, `signed`
the witness's distance, `depth` the contact's. Who is right is found without any library. The greatest gap of
support functions over directions is a lower bound of the signed distance: the directions are 1500 spread ones, the
best of them refined, and the normals of all sides. The distance of the returned points plus how far they lie
outside is an upper bound where solids are apart. An answer is right within the tolerance of the bounds. For
overlaps the lower bound is the truth, up to a search that found nothing shallower; without the normals of any side
the search stays at most {short:.1g} of the size below them.
"""
HEADER = ("pair", "poses", "row", "answer", "rival", "impinge", "theirs", "lower bound", "upper bound", "right")


@dataclass
class Group:
    """The differences between impinge and one other library, for one pair of solids and one kind of result."""

    compared: int
    verdicts: Counter[str]
    largest: float
    # The largest difference: the values of impinge and of the other library, the bounds, which library is right, the
    # family and the row in it.
    example: tuple[object, ...]
    # The largest errors of impinge and of the other library in the rows that differ.
    errors: tuple[float, float]


class Judge:
    """Collects comparisons, and writes the differences."""

    def __init__(self) -> None:
        self.groups: dict[tuple[str, str, str], Group] = {}
        self.rows: list[list[object]] = []
        # For each library and pair: the number of checked normals, the number of normals whose gap is not the signed
        # distance, and the largest such difference.
        self.unproven: dict[tuple[str, str], tuple[int, int, float]] = {}
        # The largest amount by which the largest gap found by the search stays below the gap along a normal of a
        # library, as a fraction of the size.
        self.short = 0.0
        # The poses for which FCL did not return.
        self.failed: list[list[object]] = []

    def summary(self) -> str:
        total = sum(sum(group.verdicts.values()) for group in self.groups.values())
        wrong = sum(group.verdicts["rival"] + group.verdicts["neither"] for group in self.groups.values())
        return f"{total} differences so far, impinge wrong in {wrong}"

    def compare(self, family: str, one: Solid, two: Solid, placed: tuple[Array, Array]) -> None:
        poses1, poses2 = placed
        ours = Impinge(one, poses1, two, poses2).answers()
        size = one.radius + two.radius
        fcl = Fcl(one, poses1, two, poses2)
        rivals = {"Coal": Coal(one, poses1, two, poses2).answers(), "FCL": fcl.answers()}
        if fcl.failed:
            self.failed.append([f"{one.name}, {two.name}", family, len(fcl.failed), str(fcl.failed)])
        sides = {"impinge": ours, **rivals}
        for name, answers in sides.items():
            self._check_normals(name, answers, (one, two), placed)
        differing = {
            (name, answer): _differing(ours, theirs, answer, TOLERANCE * size)
            for name, theirs in rivals.items()
            for answer in COMPARED
        }
        rows = np.flatnonzero(np.any(list(differing.values()), axis=0))
        lower, upper, short = _bounds((one, two), placed, rows, sides)
        self.short = max(self.short, short)
        for (name, answer), is_differing in differing.items():
            chosen = is_differing[rows]
            bounds = rows[chosen], lower[chosen], upper[chosen]
            self._judge(family, (one, two), (name, answer), (ours, rivals[name]), bounds)

    def _check_normals(
        self, name: str, answers: Answers, pair: tuple[Solid, Solid], placed: tuple[Array, Array]
    ) -> None:
        """Checks that the gap along a library's own normal is its own signed distance."""
        one, two = pair
        size = one.radius + two.radius
        has_normal = np.isfinite(answers.normal).all(axis=1) & (np.linalg.norm(answers.normal, axis=1) > 1e-9 * size)
        normal = answers.normal[has_normal]
        unit = normal / np.linalg.norm(normal, axis=1)[:, None]
        if not len(unit):
            return
        poses = [poses[has_normal] for poses in placed]
        off = np.abs(gaps(one, poses[0], two, poses[1], unit[:, None])[:, 0] - answers.signed[has_normal]) / size
        key = (name, f"{one.name}, {two.name}")
        asked, wrong, most = self.unproven.get(key, (0, 0, 0.0))
        # FCL returns no normal. The direction between nearly coincident points is inaccurate, so its bound is looser.
        allowed = 1e-4 if name == "FCL" else TOLERANCE
        self.unproven[key] = asked + len(off), wrong + int((off > allowed).sum()), max(most, float(off.max()))

    def _judge(
        self,
        family: str,
        pair: tuple[Solid, Solid],
        kind: tuple[str, str],
        sides: tuple[Answers, Answers],
        bounds: tuple[Array, Array, Array],
    ) -> None:
        """Counts which library is right in the rows that differ, and keeps the largest differences."""
        (name, answer), (rows, lower, upper) = kind, bounds
        title, size = f"{pair[0].name}, {pair[1].name}", pair[0].radius + pair[1].radius
        values = [getattr(side, answer)[rows] for side in sides]
        errors = [_errors(value, answer, lower, upper) / size for value in values]
        is_right = [error <= TOLERANCE for error in errors]
        names = np.where(
            is_right[0], np.where(is_right[1], "both", "impinge"), np.where(is_right[1], "rival", "neither")
        )
        sizes = _size_of_difference(*values) / size
        compared = int(np.isfinite(_comparable(getattr(sides[1], answer))).sum())
        for at in np.argsort(-sizes, kind="stable")[:KEPT]:
            row = [title, family, int(rows[at]), answer, name, *(float(value[at]) for value in values)]
            self.rows.append([*row, float(lower[at]), float(upper[at]), str(names[at])])
        group = self.groups.setdefault((title, name, answer), Group(0, Counter(), 0.0, (), (0.0, 0.0)))
        group.compared += compared
        group.verdicts.update(str(verdict) for verdict in names)
        if len(rows) and sizes.max() > group.largest:
            at = int(sizes.argmax())
            group.largest = float(sizes[at])
            group.example = (
                *(float(value[at]) for value in values),
                lower[at],
                upper[at],
                str(names[at]),
                family,
                rows[at],
            )
        if len(rows):
            group.errors = tuple(max(old, float(new.max())) for old, new in zip(group.errors, errors, strict=True))

    def write(self, out: Path, line: str, count: int) -> None:
        write_csv(out / "differences.csv", HEADER, self.rows)
        (out / "differences.md").write_text("\n".join(self._text(line, count)))

    def _text(self, line: str, count: int) -> list[str]:
        return [
            "# Pairs of convex solids: differences of answers\n",
            ABOUT.format(line=line, count=count, tolerance=TOLERANCE, short=self.short),
            "## All pairs together\n",
            self._totals(),
            "## Every pair with a difference\n",
            self._groups(),
            "## Normals that do not show the distance\n",
            "Rows in which the gap along the returned normal is not the returned signed distance "
            f"(within {TOLERANCE:g} of the size; FCL returns no normal, so the direction of its points within 1e-4).\n",
            self._normals(),
            "## Where FCL did not return\n",
            "Poses for which its signed distance ran on for a second or ended the process; after "
            f"{MOST_FAILURES} of a pair and family it is not asked for that any more.\n",
            markdown(["pair", "poses", "times", "rows"], self.failed),
        ]

    def _totals(self) -> str:
        rows = []
        for name, answer in sorted({key[1:] for key in self.groups}):
            groups = [group for key, group in self.groups.items() if key[1:] == (name, answer)]
            verdicts: Counter[str] = sum((group.verdicts for group in groups), Counter())
            counts = [verdicts[verdict] for verdict in ("impinge", "rival", "both", "neither")]
            most = [max((group.errors[side] for group in groups), default=0.0) for side in (0, 1)]
            rows.append([name, answer, sum(group.compared for group in groups), sum(counts), *counts, *most])
        header = [
            "rival",
            "answer",
            "compared",
            "differ",
            "impinge right",
            "rival right",
            "both within",
            "neither",
            "worst error of impinge",
            "worst error of rival",
        ]
        return markdown(header, rows)

    def _groups(self) -> str:
        rows = []
        for (title, name, answer), group in self.groups.items():
            if not sum(group.verdicts.values()):
                continue
            ours, theirs, lower, upper, verdict, family, row = group.example
            counts = [group.verdicts[who] for who in ("impinge", "rival", "both", "neither")]
            bounds = f"{lower:.9g}" if upper - lower < TOLERANCE else f"{lower:.9g} to {upper:.9g}"
            example = f"{family} {row}: {ours:.9g}, {name} {theirs:.9g}, certified {bounds}: {verdict}"
            rows.append([title, name, answer, sum(counts), *counts, group.largest, example])
        header = [
            "pair",
            "rival",
            "answer",
            "differ",
            "impinge right",
            "rival right",
            "both",
            "neither",
            "largest",
            "example",
        ]
        return markdown(header, rows)

    def _normals(self) -> str:
        rows = [[name, pair, *numbers] for (name, pair), numbers in sorted(self.unproven.items()) if numbers[1]]
        return markdown(["side", "pair", "asked", "not shown", "most, of the size"], rows)


def _comparable(values: Array) -> Array:
    """The values, with 0 for missing contacts (minus infinity), which count as results."""
    return np.where(np.isneginf(values), 0, values)


def _differing(ours: Answers, theirs: Answers, answer: str, tolerance: float) -> Array:
    """Whether results differ. A contact and a missing contact differ only if the depth exceeds the tolerance; a result
    of NaN differs from none."""
    one, two = getattr(ours, answer), getattr(theirs, answer)
    return np.asarray(_size_of_difference(one, two) > tolerance)


def _size_of_difference(one: Array, two: Array) -> Array:
    off = np.abs(np.maximum(one, 0) - np.maximum(two, 0)) if np.isneginf([one, two]).any() else np.abs(one - two)
    return np.nan_to_num(off, nan=0.0, posinf=np.inf)


def _bounds(
    pair: tuple[Solid, Solid], placed: tuple[Array, Array], rows: Array, sides: dict[str, Answers]
) -> tuple[Array, Array, float]:
    """A lower and an upper bound (n,) of the true signed distances of rows, and the largest amount, as a fraction of
    the size, by which the search alone stays below the lower bound."""
    one, two = pair
    poses1, poses2 = (poses[rows] for poses in placed)
    normals = np.stack([answers.normal[rows] for answers in sides.values()], axis=1)
    alone = greatest_gaps(one, poses1, two, poses2)
    lower = np.maximum(alone, gaps(one, poses1, two, poses2, unit(normals)).max(axis=1))
    short = float(((lower - alone) / (one.radius + two.radius)).max(initial=0))
    apart = np.full(len(rows), np.inf)
    for answers in sides.values():
        points = answers.point1[rows], answers.point2[rows]
        found = upper_bound(one, poses1, two, poses2, points)
        apart = np.where(np.isfinite(found), np.minimum(apart, found), apart)
    # The distance of two points of the solids bounds the signed distance only if the solids are apart. For overlapping
    # solids the lower bound is taken as the truth.
    return lower, np.where(lower > 0, np.maximum(apart, lower), lower), short


def _errors(values: Array, answer: str, lower: Array, upper: Array) -> Array:
    """The distances of results from the interval between the bounds; zero inside it."""
    if answer == "distance":
        lower, upper = np.maximum(lower, 0), np.maximum(upper, 0)
    if answer == "depth":
        lower, upper, values = np.maximum(-upper, 0), np.maximum(-lower, 0), np.maximum(values, 0)
    return np.asarray(np.maximum(np.maximum(lower - values, values - upper), 0))
