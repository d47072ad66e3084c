"""All pairs of a scene that need not fit into memory: Parquet in, Parquet out, on two processes."""

import tempfile
from pathlib import Path

import impinge
import numpy as np
import pyarrow.parquet as pq
from distributed import Client, LocalCluster
from impinge.dask import objects_table, self_join

COUNT, CLEARANCE = 20_000, 0.05


def main(folder: Path) -> None:
    rng = np.random.default_rng(11)
    kinds = [impinge.Ball(0.3), impinge.Cuboid([0.2, 0.3, 0.4]), impinge.Capsule(0.3, 0.2)]
    shapes = impinge.Scene(kinds, impinge.Poses(np.zeros((3, 3))))
    ids, picks = np.arange(COUNT), rng.integers(0, 3, COUNT)
    # A town, its suburbs and the country.
    places = rng.normal(size=(COUNT, 3)) * rng.choice([5.0, 50.0, 500.0], (COUNT, 1))
    poses = impinge.Poses(places, rng.normal(size=(COUNT, 4)), order="xyzw")
    pq.write_table(objects_table(ids, picks, poses), folder / "objects.parquet", row_group_size=4_000)

    found = self_join(folder / "objects.parquet", shapes, folder / "pairs", clearance=CLEARANCE, number_of_tiles=16)

    pairs = pq.read_table(folder / "pairs")
    rows = np.stack([pairs["id1"], pairs["id2"]], axis=1)
    in_one = impinge.pairs_within(impinge.Picked(kinds, picks), poses, distance=CLEARANCE)
    assert np.array_equal(rows, in_one)
    print(f"{found} pairs of {COUNT} objects, the same as in one process")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        local = LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0")
        with local as cluster, Client(cluster):
            main(Path(folder))
