"""The self-join of many objects on local processes: wall time, and memory of each worker.

    python benchmarks/self_join.py --objects 10000000 --workers 2 --tiles 128
    python benchmarks/self_join.py --objects 1000000 --check

Balls, boxes and capsules in clusters of 50 000 on average, in random order; the densest cluster is a thousand times as dense
as the loosest. With `--check` the pairs are compared with those of one call in this process.
"""

import argparse
import multiprocessing
import resource
import shutil
import tempfile
import time
from pathlib import Path

import impinge
import numpy as np
import pyarrow.parquet as pq
from distributed import Client, LocalCluster
from impinge.dask import objects_table, self_join

SHAPES = [impinge.Ball(0.4), impinge.Cuboid([0.3, 0.4, 0.5]), impinge.Capsule(0.4, 0.25)]
ROW_GROUP = 250_000
CLEARANCE = 0.05


def objects(count, seed=1):
    """Yields the objects by row groups: ids, shapes, poses."""
    heaps = max(1, count // 50_000)
    rng = np.random.default_rng(seed)
    places = rng.uniform(0, 400 * heaps ** (1 / 3), (heaps, 3))
    sizes = 8 * 10 ** rng.uniform(0, 1, (heaps, 1))
    for start in range(0, count, ROW_GROUP):
        rng = np.random.default_rng([seed, start])
        ids = np.arange(start, min(count, start + ROW_GROUP))
        heap = rng.integers(0, heaps, len(ids))
        at = places[heap] + sizes[heap] * rng.normal(size=(len(ids), 3))
        poses = impinge.Poses(at, rng.normal(size=(len(ids), 4)), order="xyzw").matrices
        yield ids, rng.integers(0, len(SHAPES), len(ids)), poses


def write(path, count):
    unfinished = path.with_suffix(".unfinished")
    with pq.ParquetWriter(unfinished, objects_table([], [], np.empty((0, 4, 4))).schema, compression="lz4") as writer:
        for group in objects(count):
            writer.write_table(objects_table(*group), row_group_size=ROW_GROUP)
    unfinished.rename(path)


def in_one(count):
    picks, poses = zip(*((picks, poses) for _, picks, poses in objects(count)), strict=True)
    picked, poses = impinge.Picked(SHAPES, np.concatenate(picks)), np.concatenate(poses)
    start = time.perf_counter()
    pairs = impinge.pairs_within(picked, poses, distance=CLEARANCE)
    return pairs, time.perf_counter() - start


def memory():
    """The peak memory of this process, in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main(given, folder):
    source, output = folder / f"objects-{given.objects}.parquet", folder / f"pairs-{given.objects}"
    if not source.exists():
        # In another process, because child processes inherit the peak memory of this one.
        process = multiprocessing.get_context("spawn").Process(target=write, args=(source, given.objects))
        process.start()
        process.join()
    shutil.rmtree(output, ignore_errors=True)
    print(f"{given.objects} objects, {source.stat().st_size / 1e6:.0f} MB of Parquet", flush=True)
    local = LocalCluster(given.workers, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0", memory_limit=0)
    with local, Client(local) as client:
        client.wait_for_workers(given.workers)
        before = client.run(memory).values()
        print(f"idle workers held {', '.join(f'{each:.0f}' for each in before)} MB", flush=True)
        start = time.perf_counter()
        shapes = impinge.Scene(SHAPES, impinge.Poses(np.zeros((len(SHAPES), 3))))
        found = self_join(source, shapes, output, clearance=CLEARANCE, number_of_tiles=given.tiles)
        seconds = time.perf_counter() - start
        held = ", ".join(f"{each:.0f}" for each in client.run(memory).values())
    print(f"{found} pairs in {seconds:.1f} s with {given.tiles} tiles; workers held at most {held} MB", flush=True)
    if given.check:
        pairs = pq.read_table(output)
        expected, seconds = in_one(given.objects)
        rows = np.stack([pairs["id1"], pairs["id2"]], axis=1)
        assert np.array_equal(rows, expected), "not the pairs of one process"
        print(f"the same as one process, whose call took {seconds:.1f} s and which held {memory():.0f} MB")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objects", type=int, default=1_000_000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--tiles", type=int, default=64)
    parser.add_argument("--folder", help="keeps the objects and pairs, and uses objects again that are there")
    parser.add_argument("--check", action="store_true", help="compare with one process")
    given = parser.parse_args()
    if given.folder:
        main(given, Path(given.folder))
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(given, Path(folder))
