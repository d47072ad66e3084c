"""Writes files of what a notebook displays: a picture of a scene, and a page that replays blocks falling onto a table.

A notebook displays a shape, a `Scene`, a `World` or a `Recording` at the end of a cell without such code.
"""

import tempfile
from pathlib import Path

import impinge
import numpy as np

folder = Path(tempfile.mkdtemp())
table, block = impinge.Cuboid([4, 0.25, 4]), impinge.Rounded(impinge.Cuboid([0.5, 0.25, 0.3]), 0.05)
world = impinge.World()
world.add(table, None)
rng = np.random.default_rng(1)
places = np.column_stack([rng.uniform(-3, 3, 12), np.linspace(1, 6, 12), rng.uniform(-3, 3, 12)])
blocks = world.add(block, impinge.Poses(places))

with world.record("Blocks fall onto a table") as recording:
    while places[:, 1].max() > 0.545:
        # A block falls until it lies on the table, 5 mm in it.
        places[:, 1] = np.maximum(places[:, 1] - 0.1, 0.545)
        world.set_poses(blocks, impinge.Poses(places))
        world.update()

picture = impinge.picture(world, size=(640, 480))
picture.save(folder / "table.png")
try:
    recording.save(folder / "table.html")
    written = "table.html, which opens in any browser"
except RuntimeError:
    # Built without the page; the command `impinge export table.implog -o table.html` writes it.
    recording.save(folder / "table.implog")
    written = "table.implog"
assert len(world.contacts()) >= 12 * 4 and recording.updates > 50
print(f"{recording.updates} updates, {len(world.contacts())} contact points; wrote {folder}/table.png and {written}")
