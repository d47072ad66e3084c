"""Collision detection in 2D and 3D: one shape or many, arrays of poses in, arrays of answers out.

>>> import impinge, numpy as np
>>> poses = np.tile(np.eye(4), (1000, 1, 1))
>>> poses[:, 0, 3] = np.linspace(0, 10, 1000)
>>> distances = impinge.distance(impinge.Cuboid([1, 1, 1]), None, impinge.Ball(0.5), poses)
>>> distances.shape, float(distances[-1])
((1000,), 8.5)
"""

from impinge._checker import NO_BODY, Checker, Frame, NearestPairs
from impinge._native import (
    Shape,
    cast_rays,
    closest_points,
    contact,
    contact_manifolds,
    contains,
    distance,
    impact,
    nearest,
    pairs_within,
    project_points,
    proximity,
    signed_distance,
    witness,
)
from impinge._poses import Poses
from impinge._results import (
    ClosestPoints,
    Contact,
    Impact,
    Manifolds,
    Nearest,
    Projection,
    Proximity,
    RayHit,
    Witness,
)
from impinge._scene import Scene
from impinge._shapes import (
    Ball,
    Capsule,
    Compound,
    Cone,
    ConvexHull,
    Cuboid,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    HeightField,
    Picked,
    Polyline,
    Rounded,
    Segment,
    TaperedCapsule,
    Tetrahedron,
    Triangle,
    TriMesh,
)
from impinge._world import NO_OBJECT, NearRows, Rows, World, WorldHit

__all__ = [name for name in dir() if not name.startswith("_")]
