"""Heights and slopes of a terrain below many points, by rays."""

import impinge
import numpy as np

x, z = np.meshgrid(np.linspace(-50, 50, 201), np.linspace(-50, 50, 201))
terrain = impinge.HeightField(5 * np.sin(x / 10) * np.cos(z / 12), [100, 1, 100])

rng = np.random.default_rng(4)
places = rng.uniform(-45, 45, (50_000, 2))
origins = np.stack([places[:, 0], np.full(len(places), 100.0), places[:, 1]], axis=1)
hits = impinge.cast_rays(terrain, None, origins, [0, -1, 0])
height = 100 - hits.time
slope = np.degrees(np.arccos(np.abs(hits.normal[:, 1])))
print(f"heights {height.min():.1f} to {height.max():.1f} m, steepest {slope.max():.0f} degrees")

expected = 5 * np.sin(places[:, 0] / 10) * np.cos(places[:, 1] / 12)
assert np.abs(height - expected).max() < 0.01, "the grid is fine enough"
