"""Tiles, and the recipes for Dask on a local cluster of two processes."""

import os
import pickle

import impinge
import numpy as np
import pytest

KINDS = [(dim, dtype) for dim in (2, 3) for dtype in ("float32", "float64")]


def heap(count, dim=3, dtype="float64", seed=3):
    """Balls, boxes and capsules in clusters of very different density, with a huge box and a half-space."""
    rng = np.random.default_rng(seed)
    up = np.eye(dim)[1]
    shapes = [
        impinge.Ball(0.4, dim=dim, dtype=dtype),
        impinge.Cuboid([0.3] * dim, dtype=dtype),
        impinge.Capsule(0.3, 0.2, dim=dim, dtype=dtype),
        impinge.Cuboid([30] * dim, dtype=dtype),
        impinge.HalfSpace(up, dtype=dtype),
    ]
    places = rng.normal(size=(count, dim)) * 10.0 ** rng.integers(0, 3, (count, 1)) * 4 + rng.integers(0, 3, (count, 1))
    picks = rng.integers(0, 3, count)
    picks[:2] = [3, 4]
    places[1] -= 20 * up
    ids = rng.permutation(10 * count)[:count].astype(np.uint64)
    poses = impinge.Poses(places).matrices.astype(dtype)
    return shapes, picks, poses, ids


def in_one(shapes, picks, poses, ids, clearance):
    """The pairs of ids that a single call finds."""
    pairs = np.sort(ids[impinge.pairs_within(impinge.Picked(shapes, picks), poses, distance=clearance)], axis=1)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


@pytest.mark.parametrize(("dim", "dtype"), KINDS)
def test_tiles_have_the_pairs_of_one_call(dim, dtype):
    shapes, picks, poses, ids = heap(2000, dim, dtype)
    expected = in_one(shapes, picks, poses, ids, 0.1)
    boxes = impinge.boxes(impinge.Picked(shapes, picks), poses)
    assert boxes.shape == (2000, 2, dim) and boxes.dtype == dtype and np.isinf(boxes[1]).any()
    for number in (1, 7, 64):
        tiles = pickle.loads(pickle.dumps(impinge.tiles(boxes[::7], number, clearance=0.1)))
        assert tiles == impinge.tiles(boxes[::7], number, clearance=0.1) and len(tiles) == number
        assert tiles.bounds.shape == (number, 2, dim)
        rows = tiles.meeting(boxes)
        owner = tiles.owner(poses[:, :dim, dim])
        assert all(owner[i] in rows.tile[rows.starts[i] : rows.starts[i + 1]] for i in range(100))
        objects = np.repeat(np.arange(2000), np.diff(rows.starts))
        found = []
        for tile in range(number):
            here = objects[rows.tile == tile]
            given = impinge.Picked(shapes, picks[here])
            found.append(impinge.pairs_in_tile(given, poses[here], ids[here], tiles, tile))
        found = np.concatenate(found)
        assert found.dtype == np.uint64 and len(expected) > 1000
        assert np.array_equal(found[np.lexsort((found[:, 1], found[:, 0]))], expected)


def test_what_is_no_tile_is_refused():
    ball, poses = impinge.Ball(1), impinge.Poses([[0, 0, 0], [5, 0, 0]])
    tiles = impinge.tiles(impinge.boxes(ball, poses), 2)
    for message, call in {
        "ids[1] is -1": lambda: impinge.pairs_in_tile(ball, poses, [0, -1], tiles, 0),
        "`ids` has 3 elements where 2 are needed": lambda: impinge.pairs_in_tile(ball, poses, [0, 1, 2], tiles, 0),
        "there is no tile 2 of 2": lambda: impinge.pairs_in_tile(ball, poses, [0, 1], tiles, 2),
        "0 tiles": lambda: impinge.tiles(np.zeros((1, 2, 3)), 0),
        "the distance is -1": lambda: impinge.tiles(np.zeros((1, 2, 3)), 2, clearance=-1),
        "boxes[1]: the box is inverted on axis 0": lambda: impinge.tiles([[[0, 0], [1, 1]], [[1, 0], [0, 1]]], 2),
        "boxes has the shape (2, 3)": lambda: impinge.tiles(np.zeros((2, 3)), 2),
        "cut 1 at 3 on axis 0": lambda: impinge.Tiles([0, 0, 0], [1, 3, 2]),
        "there are 1 axes and 2 cuts": lambda: impinge.Tiles([0], [1, 3]),
        "axes[0] is 4294967296": lambda: impinge.Tiles(np.array([2**32]), [1.0]),
        "axes[1] is -1": lambda: impinge.Tiles([0, -1], [1.0, 2.0]),
        "axes[0] is 2, where 0 to 1 is needed in 2D": lambda: impinge.Tiles([2], [1.0], dim=2),
        "axes is float64, where integers are needed": lambda: impinge.Tiles([0.7], [1.0]),
        "axes is bool, where integers are needed": lambda: impinge.Tiles([True], [1.0]),
        "axes has the shape (1, 2)": lambda: impinge.Tiles([[0, 4]], [1.0]),
        "ids has the shape (1, 2)": lambda: impinge.pairs_in_tile(ball, poses, [[1, -1]], tiles, 0),
    }.items():
        with pytest.raises(ValueError, match="^" + ".*" + "".join(f"\\{c}" if c in "[]()." else c for c in message)):
            call()
    with pytest.raises(TypeError, match="tiles is 3D float64, where 2D float64 is needed"):
        impinge.pairs_in_tile(impinge.Ball(1, dim=2), None, [0], tiles, 0)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_tiles_do_not_change_with_arrays_of_the_caller(dtype):
    axes, cuts = np.array([0, 1], dtype=np.uint32), np.array([2.5, 0.0], dtype=dtype)
    tiles = impinge.Tiles(axes, cuts, dim=2, dtype=dtype)
    points = [[0, 7], [3, -1], [3, 0]]
    before = (tiles.owner(points).tolist(), hash(tiles))
    axes[:], cuts[:] = [1, 0], [9.0, -9.0]
    assert (tiles.owner(points).tolist(), hash(tiles)) == before == ([0, 1, 2], hash(pickle.loads(pickle.dumps(tiles))))
    for column in (tiles.axes, tiles.cuts):
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 0
    assert tiles == impinge.Tiles([0, 1], [2.5, 0.0], dim=2, dtype=dtype) and len(impinge.Tiles([], [])) == 1


def test_nothing_and_nowhere():
    none = impinge.tiles(np.empty((0, 2, 3)), 5)
    assert len(none) == 5 and none.meeting(np.empty((0, 2, 3))).starts.tolist() == [0]
    assert none.meeting(np.full((1, 2, 3), np.nan)).starts.tolist() == [0, 0]
    empty = impinge.Picked([impinge.Ball(1)], [])
    assert impinge.pairs_in_tile(empty, np.empty((0, 4, 4)), [], none, 4).shape == (0, 2)


@pytest.fixture(scope="module")
def client():
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("pyarrow")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0", memory_limit=0
    )
    with cluster, distributed.Client(cluster) as client:
        yield client


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """Two files, each with several row groups."""
    import pyarrow.parquet as pq
    from impinge.dask import objects_table

    folder = tmp_path_factory.mktemp("source")
    shapes, picks, poses, ids = heap(6000)
    for number, rows in enumerate(np.array_split(np.arange(6000), 2)):
        table = objects_table(ids[rows], picks[rows], poses[rows])
        pq.write_table(table, folder / f"objects-{number}.parquet", row_group_size=800)
    return folder, impinge.Scene(shapes, impinge.Poses(np.zeros((5, 3)))), in_one(shapes, picks, poses, ids, 0.05)


def contents(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def test_self_join_is_one_process(client, source, tmp_path):
    import pyarrow.parquet as pq
    from impinge.dask import self_join

    folder, scene, expected = source
    outputs = []
    for number in (1, 7, 64):
        output = tmp_path / f"pairs-{number}"
        found = self_join(folder, scene, output, clearance=0.05, number_of_tiles=number, sample=1000)
        assert found == len(expected) > 4000
        outputs.append(contents(output))
    assert outputs[0] == outputs[1] == outputs[2] and len(outputs[0]) == 8
    parts = [pq.read_table(tmp_path / "pairs-7" / name) for name in outputs[0]]
    pairs = np.concatenate([np.stack([part["id1"], part["id2"]], axis=1) for part in parts])
    assert pairs.tobytes() == expected.tobytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["pairs-1", "pairs-64", "pairs-7"], "no scratch is left"



@pytest.mark.parametrize("form", ["rows", "numbers", "fixed rows"])
def test_matrices_as_others_write_them(source, tmp_path, form):
    """Columns of pandas with a matrix in each cell, as lists of rows or flat, and nested lists of fixed size."""
    pd, pa = pytest.importorskip("pandas"), pytest.importorskip("pyarrow")
    import pyarrow.parquet as pq
    from impinge.dask import self_join

    _, scene, _ = source
    shapes, picks, poses, ids = heap(300)
    cells = [pose.ravel() if form == "numbers" else list(pose) for pose in poses]
    path = tmp_path / "frame.parquet"
    if form == "fixed rows":
        kind = pa.list_(pa.list_(pa.float64(), 4), 4)
        column = pa.array(poses.tolist(), kind)
        pq.write_table(pa.table({"id": pa.array(ids), "shape": pa.array(picks), "pose": column}), path)
    else:
        pd.DataFrame({"id": ids, "shape": picks, "pose": cells}).to_parquet(path)
    assert self_join(path, scene, tmp_path / "out", clearance=0.5) == len(in_one(shapes, picks, poses, ids, 0.5)) > 10
    for number, (cell, message) in enumerate(
        {0: ([[1.0] * 4] * 3, "row 1 where 4 are needed"), 1: ([[1.0] * 4] * 3 + [[1.0] * 5], "row 1, list 3, where 4")}.values()
    ):
        bad = tmp_path / f"bad-{number}.parquet"
        pd.DataFrame({"id": [1, 2], "shape": [0, 0], "pose": [list(poses[0]), cell]}).to_parquet(bad)
        with pytest.raises(ValueError, match=message):
            self_join(bad, scene, tmp_path / "none")


def test_a_killed_worker_changes_nothing(client, source, tmp_path, monkeypatch):
    import impinge.dask

    folder, scene, expected = source
    calm = tmp_path / "calm"
    impinge.dask.self_join(folder, scene, calm, clearance=0.05, number_of_tiles=7, sample=1000)
    for name in ("_share_out", "_join_tile", "_merge"):
        task, mark = getattr(impinge.dask, name), tmp_path / f"{name}.mark"
        client.wait_for_workers(2)
        # One of the two workers dies in the middle of a task: after it wrote its files, before it reports success.
        victim = sorted(client.run(os.getpid).values())[0]

        def dying(*given, task=task, mark=mark, victim=victim):
            found = task(*given)
            if os.getpid() == victim and not mark.exists():
                mark.touch()
                os.kill(victim, 9)
            return found

        output = tmp_path / name
        with monkeypatch.context() as patch:
            patch.setattr(impinge.dask, name, dying)
            found = impinge.dask.self_join(folder, scene, output, clearance=0.05, number_of_tiles=7, sample=1000)
        assert mark.exists(), "a worker was killed"
        assert found == len(expected) and contents(output) == contents(calm)


def test_self_join_refuses(source, tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq
    from impinge.dask import objects_table, self_join

    folder, scene, _ = source
    (tmp_path / "there").mkdir()
    with pytest.raises(FileExistsError):
        self_join(folder, scene, tmp_path / "there")
    flat = objects_table([1], [0], impinge.Poses([[0, 0]]))
    cases = {
        "lacks the column 'shape'": flat.drop_columns(["shape"]),
        "a list of 16 numbers, or of 4 rows, is needed in 3D": flat,
        "picks\\[0\\] is 9, but there are 5 shapes": objects_table([1], [9], impinge.Poses([[0, 0, 0]])),
        "the column 'id' has nulls": objects_table([1], [0], impinge.Poses([[0, 0, 0]])).set_column(
            0, "id", pa.array([None], pa.uint64())
        ),
    }
    for number, (message, table) in enumerate(cases.items()):
        path = tmp_path / f"{number}.parquet"
        pq.write_table(table, path)
        with pytest.raises(ValueError, match=message):
            self_join(path, scene, tmp_path / f"out-{number}")
        assert not list(tmp_path.glob("out-*")), "nothing is left"


def test_a_scene_is_asked_in_row_order(client, tmp_path):
    da, dd = pytest.importorskip("dask.array"), pytest.importorskip("dask.dataframe")
    import pandas as pd
    from impinge.dask import ask_scene

    shapes, picks, poses, _ = heap(300)
    scene = impinge.Scene([shapes[pick] for pick in picks[2:]], poses[2:])
    probes = impinge.Poses(np.random.default_rng(5).normal(size=(1000, 3)) * 40).matrices
    ball = impinge.Ball(0.5)
    expected = impinge.World()
    expected.add(scene.shapes, scene.poses)
    expected.update()
    expected = expected.nearest(ball, probes).distance

    def near(world, poses):
        return world.nearest(ball, poses).distance

    def near_frame(world, frame):
        return near(world, impinge.Poses(frame[["x", "y", "z"]].to_numpy()).matrices)

    found = ask_scene(near, scene, da.from_array(probes, chunks=(130, 2, 4)))
    assert found.compute().tobytes() == expected.tobytes()
    pd.DataFrame(probes[:, :3, 3], columns=["x", "y", "z"]).to_parquet(tmp_path / "probes.parquet", row_group_size=300)
    found = ask_scene(near_frame, scene, tmp_path / "probes.parquet").compute()
    assert found.to_numpy().tobytes() == expected.tobytes()
    frame = dd.from_pandas(pd.DataFrame(probes[:, :3, 3], columns=["x", "y", "z"]), npartitions=7)
    assert ask_scene(near_frame, scene, frame).compute().to_numpy().tobytes() == expected.tobytes()
    with pytest.raises(TypeError, match="rows is no Dask Array"):
        ask_scene(near, scene, probes)
