"""Collision detection in 2D and 3D: one shape or many, arrays of poses in, arrays of results out.

>>> import impinge, numpy as np
>>> poses = np.tile(np.eye(4), (1000, 1, 1))
>>> poses[:, 0, 3] = np.linspace(0, 10, 1000)
>>> distances = impinge.distance(impinge.Cuboid([1, 1, 1]), None, impinge.Ball(0.5), poses)
>>> distances.shape, float(distances[-1])
((1000,), 8.5)

`pip install ./python` in the repository of impinge builds it from source. The build needs Rust 1.95 or later with cargo
(https://rustup.rs) and a C compiler as linker, and takes some minutes; pip fetches maturin and NumPy. The page of
recordings is an optional part, built as `python/README.md` describes. `impinge.__version__` is the version.
"""

from impinge._checker import NO_BODY, Checker, Frame, NearestPairs
from impinge._native import (
    Shape,
    __version__,
    boxes,
    cast_rays,
    closest_points,
    contact,
    contact_manifolds,
    contains,
    distance,
    impact,
    nearest,
    pairs_in_tile,
    pairs_within,
    project_points,
    proximity,
    signed_distance,
    witness,
)
from impinge._pictures import Picture, picture
from impinge._poses import Poses
from impinge._recording import Recording
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
from impinge._tiles import TileRows, Tiles, tiles
from impinge._world import World
from impinge._world_arguments import Filter
from impinge._world_results import (
    NO_OBJECT,
    HitRows,
    ImpactRows,
    NearRows,
    Rows,
    WorldHit,
    WorldImpact,
    WorldProjection,
)

__all__ = [
    "Ball",
    "Capsule",
    "Checker",
    "ClosestPoints",
    "Compound",
    "Cone",
    "Contact",
    "ConvexHull",
    "Cuboid",
    "Cylinder",
    "Ellipsoid",
    "Filter",
    "Frame",
    "HalfSpace",
    "HeightField",
    "HitRows",
    "Impact",
    "ImpactRows",
    "Manifolds",
    "NO_BODY",
    "NO_OBJECT",
    "NearRows",
    "Nearest",
    "NearestPairs",
    "Picked",
    "Picture",
    "Polyline",
    "Poses",
    "Projection",
    "Proximity",
    "RayHit",
    "Recording",
    "Rounded",
    "Rows",
    "Scene",
    "Segment",
    "Shape",
    "TaperedCapsule",
    "Tetrahedron",
    "TileRows",
    "Tiles",
    "TriMesh",
    "Triangle",
    "Witness",
    "World",
    "WorldHit",
    "WorldImpact",
    "WorldProjection",
    "__version__",
    "boxes",
    "cast_rays",
    "closest_points",
    "contact",
    "contact_manifolds",
    "contains",
    "distance",
    "impact",
    "nearest",
    "pairs_in_tile",
    "pairs_within",
    "picture",
    "project_points",
    "proximity",
    "signed_distance",
    "tiles",
    "witness",
]
