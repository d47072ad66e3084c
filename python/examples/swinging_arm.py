"""When arms that swing at different speeds hit a post."""

import impinge
import numpy as np

arm = impinge.Capsule(ends=[[0, 0, 0], [1.2, 0, 0]], radius=0.08)
post = impinge.Cylinder(1.0, 0.1)
speeds = np.linspace(0.5, 3.0, 6)
turning = np.column_stack([np.zeros(6), speeds, np.zeros(6)])
# The post stands in the path of the arm, an eighth of a turn ahead: a rotation about y takes x to -z.
post_at = impinge.Poses([np.cos(np.pi / 4), 0, -np.sin(np.pi / 4)])
found = impinge.impact(arm, None, [0, 0, 0], post, post_at, [0, 0, 0], max_time=2.0, angular_velocity1=turning)
angles = found.time * speeds
hits = np.isfinite(found.time)
assert hits.all() and np.ptp(angles) < 1e-6, "all hit at the same angle, sooner or later"
assert angles[0] < np.pi / 4, "before the middle of the post, by both radii"
for speed, time in zip(speeds, found.time, strict=True):
    print(f"{speed:.1f} rad/s: hits after {time:.3f} s, at {np.degrees(speed * time):.2f} degrees")
