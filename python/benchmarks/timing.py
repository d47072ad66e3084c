"""Times several libraries alternately in one process, in several rounds, by medians; writes tables and the machine."""

from __future__ import annotations

import argparse
import csv
import gc
import importlib.metadata
import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

DEFAULT_OUT = Path(__file__).resolve().parents[2] / "bench" / "python"


@dataclass(frozen=True)
class Timed:
    """Seconds per element: the median, the minimum and the maximum processor time of the rounds, and the median wall
    time."""

    median: float
    least: float
    greatest: float
    wall: float

    @property
    def spread(self) -> float:
        """The range of the rounds as a fraction of the median."""
        return (self.greatest - self.least) / self.median if self.median > 0 else 0.0


@dataclass(frozen=True)
class Side:
    """A timed call, and the number of elements that it processes."""

    run: Callable[[], Any]
    elements: int


def interleaved(sides: Mapping[str, Side], rounds: int = 5) -> dict[str, Timed]:
    """Runs all sides alternately, once unmeasured and then `rounds` times; each round starts with the next side.

    Processor time is that of the whole process with all its threads, since other processes may share the machine.
    """
    names = list(sides)
    for name in names:
        sides[name].run()
    seconds: dict[str, list[tuple[float, float]]] = {name: [] for name in names}
    gc.collect()
    gc.disable()
    try:
        for number in range(rounds):
            first = number % len(names)
            for name in names[first:] + names[:first]:
                begin = time.process_time(), time.perf_counter()
                sides[name].run()
                end = time.process_time(), time.perf_counter()
                seconds[name].append((end[0] - begin[0], end[1] - begin[1]))
    finally:
        gc.enable()
    return {name: _timed(seconds[name], sides[name].elements) for name in names}


def _timed(seconds: list[tuple[float, float]], elements: int) -> Timed:
    processor, wall = ([each / elements for each in clock] for clock in zip(*seconds, strict=True))
    return Timed(statistics.median(processor), min(processor), max(processor), statistics.median(wall))


def machine(packages: Sequence[str]) -> str:
    """The processor, the number of cores, the load, and the versions of Python and of these packages."""
    load = f"load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "load unknown"
    versions = ", ".join(f"{name} {_version(name)}" for name in packages)
    when = time.strftime("%Y-%m-%d")
    return f"{_processor()}, {os.cpu_count()} cores, {load}, Python {platform.python_version()}, {versions}, {when}"


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "absent"


def markdown(header: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """A table in Markdown; columns of numbers are right-aligned."""
    texts = [[_cell(cell) for cell in row] for row in rows]
    right = [bool(rows) and all(_is_number(row[column]) for row in rows) for column in range(len(header))]
    rule = ["---:" if is_right else "---" for is_right in right]
    return "\n".join("| " + " | ".join(line) + " |" for line in [list(header), rule, *texts]) + "\n"


def _is_number(cell: Any) -> bool:
    return cell is None or (isinstance(cell, (int, float)) and not isinstance(cell, bool))


def _cell(cell: Any) -> str:
    if cell is None:
        return "–"
    if isinstance(cell, float):
        return f"{cell:.0f}" if 1000 <= abs(cell) < 1e6 else f"{cell:.3g}"
    return str(cell)


def write_csv(path: Path, header: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Writes a table as CSV, numbers with six digits."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for row in rows:
            writer.writerow([f"{cell:.6g}" if isinstance(cell, float) else cell for cell in row])


def arguments(description: str | None) -> argparse.ArgumentParser:
    """The parser with the options of all benchmarks."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--quick", action="store_true", help="a smoke run with few elements and rounds")
    parser.add_argument("--out", type=Path, default=DEFAULT_OUT, help="the folder of the tables")
    parser.add_argument("--rounds", type=int, default=5, help="of which the median is taken")
    return parser
