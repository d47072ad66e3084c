"""Runs all examples, which check their results, and the programs in the README and the guide."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
# In the repository the guide is beside the package. Tests of a wheel find it beside the tests.
PAGES = ["python.md", "many-machines.md"]
PLACES = [ROOT / "README.md", *(folder / page for page in PAGES for folder in (ROOT, ROOT.parent / "guide"))]
TEXTS = [path for path in PLACES if path.exists()]


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples(path, capsys):
    needed = {"impinge.urdf": "yourdfpy", "impinge.dask": "distributed"}
    for package in re.findall(r"^(?:from|import) (trimesh|impinge\.urdf|impinge\.dask)", path.read_text(), re.MULTILINE):
        pytest.importorskip(needed.get(package, package))
    runpy.run_path(str(path), run_name="__main__")
    assert capsys.readouterr().out.strip(), "it says what it found"


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.stem)
def test_texts(path):
    """Runs all blocks of a page as one program; an exception fails the test."""
    blocks = re.findall(r"^```python\n(.*?)^```", path.read_text(), re.MULTILINE | re.DOTALL)
    assert blocks
    exec(compile("\n".join(blocks), str(path), "exec"), {"__name__": "__main__"})


def test_there_are_texts_and_examples():
    assert len(TEXTS) == 3 and len(list((ROOT / "examples").glob("*.py"))) >= 12
