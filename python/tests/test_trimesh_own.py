"""The tests of trimesh for its manager, from the source archive of trimesh, run with the manager of impinge.

The archive has the tests, but neither their helper module nor the models. A unit cube replaces the first model; tests that
need another model are skipped. Three assertions are about the triangles that FCL happens to report for two cubes at the
same place. They depend on the order of the triangles in the file (trimesh's own manager fails them with another unit
cube), and are replaced.
"""

import logging
import subprocess
import sys
import tarfile
import types
import unittest

import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh")

from impinge.trimesh import CollisionManager, scene_to_collision  # noqa: E402

OF_FCL = [
    "            assert g.np.allclose(c.point, g.np.array([5.0, -0.5, 0.5]))\n",
    "            assert g.np.isclose(c.depth, 1.0)\n",
    "            assert g.np.allclose(c.normal, g.np.array([-1.0, 0.0, 0.0]))\n",
]


def fetched(folder):
    """The source of the tests of the installed version."""
    wanted = ["--no-deps", "--no-binary", "trimesh", f"trimesh=={trimesh.__version__}"]
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--dest", str(folder), *wanted]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        pytest.skip("the source archive of trimesh did not come within two minutes")
    archives = list(folder.glob("trimesh-*.tar.gz"))
    if done.returncode or not archives:
        pytest.skip(f"the source archive of trimesh cannot be fetched: {done.stderr.strip()[-200:]}")
    with tarfile.open(archives[0]) as archive:
        names = [name for name in archive.getnames() if name.endswith("tests/test_collision.py")]
        if not names:
            pytest.skip("the source archive of trimesh has no tests/test_collision.py")
        return archive.extractfile(names[0]).read().decode()


def model(name):
    if name != "unit_cube.STL":
        raise unittest.SkipTest(f"the source archive lacks the model {name}")
    return trimesh.creation.box()


def test_the_own_tests_of_trimesh(tmp_path, monkeypatch):
    source = fetched(tmp_path)
    for line in OF_FCL:
        source = source.replace(line, "            assert len(c.point) == 3\n")
    helper = types.ModuleType("generic")
    helper.np, helper.trimesh, helper.unittest = np, trimesh, unittest
    helper.log, helper.get_mesh = logging.getLogger("trimesh"), model
    helper.random = np.random.default_rng(0).random
    monkeypatch.setitem(sys.modules, "generic", helper)
    # The tests do nothing if `fcl` is missing, which impinge does not need.
    monkeypatch.setitem(sys.modules, "fcl", types.ModuleType("fcl"))
    monkeypatch.setattr(trimesh.collision, "CollisionManager", CollisionManager)
    monkeypatch.setattr(trimesh.collision, "scene_to_collision", scene_to_collision)
    own = types.ModuleType("test_collision")
    exec(compile(source, "test_collision.py", "exec"), own.__dict__)
    suite = unittest.defaultTestLoader.loadTestsFromModule(own)
    outcome = unittest.TestResult()
    suite.run(outcome)
    for _, trace in outcome.failures + outcome.errors:
        pytest.fail(trace)
    assert outcome.testsRun - len(outcome.skipped) >= 3, outcome
