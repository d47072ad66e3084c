//! The functions of batches for Python, with their docstrings.
//!
//! Common to all functions: a shape is a `Shape`, a sequence with one shape for each element, or `Picked`; poses are
//! `None` (the identity), a matrix, an array of matrices, or `Poses`. A single element is paired with each element of
//! the other side.
#![expect(clippy::too_many_arguments, reason = "Python's arguments are named")]

use pyo3::prelude::*;

use crate::pairs::{
    Closest, Contacts, Distances, ImpactCall, Manifolds, Nearest, PairCall, Proximities, Witnesses,
};
use crate::points;
use crate::points::{PointQuestion, ask_points};
use crate::supervise::{Call, Threads, count};

/// Adds the functions about pairs.
pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(distance, module)?)?;
    module.add_function(wrap_pyfunction!(closest_points, module)?)?;
    module.add_function(wrap_pyfunction!(witness, module)?)?;
    module.add_function(wrap_pyfunction!(proximity, module)?)?;
    module.add_function(wrap_pyfunction!(contact, module)?)?;
    module.add_function(wrap_pyfunction!(contact_manifolds, module)?)?;
    module.add_function(wrap_pyfunction!(nearest, module)?)?;
    module.add_function(wrap_pyfunction!(impact, module)?)?;
    module.add_function(wrap_pyfunction!(pairs_within, module)?)?;
    module.add_function(wrap_pyfunction!(project_points, module)?)?;
    module.add_function(wrap_pyfunction!(signed_distance, module)?)?;
    module.add_function(wrap_pyfunction!(contains, module)?)?;
    module.add_function(wrap_pyfunction!(cast_rays, module)?)
}

/// The largest number of points of a manifold: at least one.
struct MaxPoints(usize);

impl FromPyObject<'_, '_> for MaxPoints {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        count(given, "max_points").map(Self)
    }
}

type Object<'py> = Bound<'py, PyAny>;
type Answer<'py> = PyResult<Object<'py>>;

/// The distance of two solids: zero if they touch or overlap.
///
/// shape1, shape2: a `Shape`, a sequence with one shape for each element, or `Picked`.
/// poses1, poses2: `None`, a matrix (D+1, D+1), an array (n, D+1, D+1) or `Poses`. A single pose is used for all
/// elements.
/// threads: the number of threads, by default one for each core. progress: an object with `update(n)`, such as a bar of
/// tqdm.
///
/// Returns a float, or an array (n,) if an argument has many elements: a length in the unit of the shapes.
///
/// Errors: `ValueError` names the argument and the row of a matrix that is not a pose (not finite, not a rotation), an
/// array of wrong shape, or arrays of different lengths; `TypeError` names an argument of wrong type, or a shape of
/// another dim or dtype. `KeyboardInterrupt` on Ctrl-C, and exceptions of `progress`, end the call.
///
/// >>> import impinge, numpy as np
/// >>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [0, 2, 5]
/// >>> impinge.distance(impinge.Ball(1), None, impinge.Ball(0.5), poses)
/// array([0. , 0.5, 3.5])
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2, poses2, *, threads=None, progress=None))]
fn distance<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress).ask(Distances)
}

/// The closest points of two solids whose distance is at most `max_distance`.
///
/// Arguments and errors as in `distance`. Returns `ClosestPoints(distance, point1, point2)`, (n,) and (n, D) in the
/// world frame. If the solids touch or overlap, the distance is zero and the points are NaN. Beyond `max_distance` the
/// distance is infinite and the points are NaN.
///
/// >>> import impinge, numpy as np
/// >>> pose = np.eye(4); pose[0, 3] = 4
/// >>> found = impinge.closest_points(impinge.Ball(1), None, impinge.Cuboid([1, 1, 1]), pose)
/// >>> found.distance, found.point1.tolist()
/// (2.0, [1.0, 0.0, 0.0])
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2, poses2, max_distance=f64::INFINITY, *, threads=None, progress=None))]
fn closest_points<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    max_distance: f64,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress).ask(Closest(max_distance))
}

/// The nearest or deepest points of two shapes, with the signed distance, the normal and the parts.
///
/// Arguments and errors as in `distance`. Returns `Witness(distance, point1, point2, normal, part1, part2)`, (n,) and
/// (n, D) in the world frame; the normal points from the first to the second shape. The distance is negative if the
/// shapes overlap, and `point2 = point1 + distance * normal`. Beyond `max_distance` the distance is infinite, points
/// and normal are NaN and parts are 4294967295.
///
/// >>> import impinge, numpy as np
/// >>> pose = np.eye(4); pose[0, 3] = 1.75
/// >>> found = impinge.witness(impinge.Ball(1), None, impinge.Ball(1), pose)
/// >>> found.distance, found.normal.tolist()
/// (-0.25, [1.0, 0.0, 0.0])
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2, poses2, max_distance=f64::INFINITY, *, threads=None, progress=None))]
fn witness<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    max_distance: f64,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress).ask(Witnesses(max_distance))
}

/// Whether two solids intersect (0), are at most `margin` apart (1), or farther (2): see `Proximity`.
///
/// Arguments and errors as in `distance`. Returns an int, or an array (n,) of uint8. Touching counts as intersecting.
///
/// >>> import impinge, numpy as np
/// >>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [2, 3, 4]
/// >>> impinge.proximity(impinge.Ball(1), None, impinge.Ball(1), poses, 1.0).tolist()
/// [0, 1, 2]
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2, poses2, margin=0.0, *, threads=None, progress=None))]
fn proximity<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    margin: f64,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress).ask(Proximities(margin))
}

/// The contact of two solids that overlap, touch, or are at most `prediction` apart.
///
/// Arguments and errors as in `distance`. Returns `Contact(depth, normal, point1, point2)`, (n,) and (n, D) in the
/// world frame. The depth is positive if the solids overlap, minus the distance if they are apart, and `-inf` without a
/// contact; normal and points are then NaN. The normal points from the first to the second solid. For composites the
/// contact is the deepest one of their manifolds.
///
/// >>> import impinge, numpy as np
/// >>> pose = np.eye(4); pose[1, 3] = 1.75
/// >>> found = impinge.contact(impinge.Cuboid([10, 1, 10]), None, impinge.Ball(1), pose)
/// >>> found.depth, found.normal.tolist()
/// (0.25, [0.0, 1.0, 0.0])
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2, poses2, prediction=0.0, *, threads=None, progress=None))]
fn contact<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    prediction: f64,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress).ask(Contacts(prediction))
}

/// All contact points of each pair that is at most `prediction` apart.
///
/// Arguments and errors as in `distance`; `max_points` limits the points of a manifold. Returns `Manifolds`, a table
/// with one row for each point: pair i has the rows `starts[i]` to `starts[i + 1]` of `depth`, `normal`, `point1`,
/// `point2`, `manifold` (its index within the pair), `part1` and `part2`.
///
/// >>> import impinge, numpy as np
/// >>> pose = np.eye(4); pose[1, 3] = 1.9
/// >>> found = impinge.contact_manifolds(impinge.Cuboid([9, 1, 9]), None, impinge.Cuboid([1, 1, 1]), pose)
/// >>> found.starts.tolist(), found.depth.round(3).tolist()
/// ([0, 4], [0.1, 0.1, 0.1, 0.1])
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2, poses2, prediction=0.0, max_points=None, *, threads=None, progress=None))]
fn contact_manifolds<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    prediction: f64,
    max_points: Option<MaxPoints>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress)
        .ask(Manifolds { prediction, max_points: max_points.map(|given| given.0) })
}

/// The nearest pair of a batch: `Nearest(pair, distance)`, or -1 and an infinite distance beyond `max_distance`.
///
/// Arguments and errors as in `distance`. This is faster than computing all distances, because the
/// smallest distance found so far limits the search in the other pairs. Among equal distances the
/// pair with the lowest index is returned.
///
/// >>> import impinge, numpy as np
/// >>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [7, 3, 5]
/// >>> impinge.nearest(impinge.Ball(1), None, impinge.Ball(1), poses)
/// Nearest(pair=1, distance=1.0)
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2, poses2, max_distance=f64::INFINITY, *, threads=None, progress=None))]
fn nearest<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    max_distance: f64,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress).ask(Nearest(max_distance))
}

/// The time at which two moving solids first come within `target_distance`.
///
/// Arguments and errors as in `distance`; the velocities are (D,) or (n, D), in the world frame per unit of time. A
/// single velocity is used for all elements, and a single pair for all velocities.
/// `angular_velocity1`, `angular_velocity2`: in 2D a number or (n,) in radians, counter-clockwise; in 3D (3,) or (n,
/// 3), the axis in the world frame times radians; zero by default. The solids rotate about the origins of their local
/// frames. Returns `Impact(time, normal, point1, point2, is_reached)`, points and normal at that time; without an
/// impact by `max_time` the time is infinite. `is_reached` is false if the search ended early: the solids do not touch
/// before `time`.
///
/// >>> import impinge, numpy as np
/// >>> pose = np.eye(4); pose[0, 3] = 6
/// >>> impinge.impact(impinge.Ball(1), None, [0, 0, 0], impinge.Ball(1), pose, [-2, 0, 0]).time
/// 2.0
/// >>> bar, pin = impinge.Cuboid([2, 0]), impinge.Ball(0.5, dim=2)
/// >>> turn = {"angular_velocity1": np.pi / 2, "max_time": 1}
/// >>> found = impinge.impact(bar, None, [0, 0], pin, impinge.Poses([0, 1]), [0, 0], **turn)
/// >>> round(found.time, 9)
/// 0.666666667
#[pyfunction]
#[pyo3(signature = (shape1, poses1, velocity1, shape2, poses2, velocity2, max_time=f64::INFINITY, target_distance=0.0, *, angular_velocity1=None, angular_velocity2=None, threads=None, progress=None))]
fn impact<'py>(
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    velocity1: &Object<'py>,
    shape2: &Object<'py>,
    poses2: &Object<'py>,
    velocity2: &Object<'py>,
    max_time: f64,
    target_distance: f64,
    angular_velocity1: Option<&Object<'py>>,
    angular_velocity2: Option<&Object<'py>>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    PairCall::new([shape1, poses1, shape2, poses2], threads, progress).ask_impacts(ImpactCall {
        velocities: [velocity1, velocity2],
        angular_velocities: [angular_velocity1, angular_velocity2],
        max_time,
        target_distance,
    })
}

/// The pairs of elements that are at most `distance` apart, as an ascending array (m, 2) of uint32.
///
/// With one side, the pairs are [i, j] with i < j. With two sides, i is of the first and j of the second side. With
/// `poses2` and no `shape2`, the shapes of both sides are `shape1`.
/// Arguments and errors as in `distance`; `ValueError` also if `distance` is negative or NaN.
///
/// >>> import impinge, numpy as np
/// >>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [0, 3, 6.5]
/// >>> impinge.pairs_within(impinge.Ball(1), poses, distance=1.0).tolist()
/// [[0, 1]]
#[pyfunction]
#[pyo3(signature = (shape1, poses1, shape2=None, poses2=None, *, distance=0.0, threads=None, progress=None))]
fn pairs_within<'py>(
    py: Python<'py>,
    shape1: &Object<'py>,
    poses1: &Object<'py>,
    shape2: Option<&Object<'py>>,
    poses2: Option<&Object<'py>>,
    distance: f64,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    let none = py.None().into_bound(py);
    let call = |shape2| {
        PairCall::new([shape1, poses1, shape2, poses2.unwrap_or(&none)], threads, progress)
    };
    let is_two_sided = shape2.is_some() || poses2.is_some();
    call(shape2.unwrap_or(shape1)).ask_within(is_two_sided, distance)
}

/// The points of shapes nearest to points in the world frame.
///
/// shape, poses: as in `distance`. points: (D,) or (n, D). Returns `Projection(point, is_inside, part)`, (n, D), (n,)
/// and (n,). Errors as in `distance`, but points may have any values. A point inside is its own projection if `solid`,
/// otherwise it is projected to the boundary. Points that are not finite have the projection NaN and the part
/// 4294967295. Meshes and polylines are surfaces here: no point is inside.
///
/// >>> import impinge
/// >>> impinge.project_points(impinge.Ball(1), None, [4, 0, 0]).point.tolist()
/// [1.0, 0.0, 0.0]
#[pyfunction]
#[pyo3(signature = (shape, poses, points, solid=true, *, threads=None, progress=None))]
fn project_points<'py>(
    shape: &Object<'py>,
    poses: &Object<'py>,
    points: &Object<'py>,
    solid: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    let question = PointQuestion::Project { solid };
    ask_points([shape, poses, points], question, Call::new(threads, progress))
}

/// The distances of points from shapes, negative inside.
///
/// Arguments and errors as in `project_points`. Returns a float or an array (n,), lengths; infinite for points that are
/// not finite. Closed meshes in 3D and closed polylines in 2D are solids here, and in `contains`. `ValueError` names a
/// mesh, polyline or height field that is not closed, because it has no inside. With `surface=True` it is a surface,
/// and all distances from it are positive or zero.
///
/// >>> import impinge
/// >>> impinge.signed_distance(impinge.Ball(2), None, [[5, 0, 0], [0, 1, 0]]).tolist()
/// [3.0, -1.0]
#[pyfunction]
#[pyo3(signature = (shape, poses, points, *, surface=false, threads=None, progress=None))]
fn signed_distance<'py>(
    shape: &Object<'py>,
    poses: &Object<'py>,
    points: &Object<'py>,
    surface: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    let question = PointQuestion::SignedDistance { surface };
    ask_points([shape, poses, points], question, Call::new(threads, progress))
}

/// Whether points are inside shapes, or on them.
///
/// Arguments and errors as in `signed_distance`. Returns a bool or an array (n,) of bools. With `surface=True` a mesh,
/// polyline or height field that is not closed contains the points on it.
///
/// >>> import impinge
/// >>> impinge.contains(impinge.Cuboid([1, 1]), None, [[0, 0], [1, 1], [1, 2]]).tolist()
/// [True, True, False]
#[pyfunction]
#[pyo3(signature = (shape, poses, points, *, surface=false, threads=None, progress=None))]
fn contains<'py>(
    shape: &Object<'py>,
    poses: &Object<'py>,
    points: &Object<'py>,
    surface: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    let question = PointQuestion::Contains { surface };
    ask_points([shape, poses, points], question, Call::new(threads, progress))
}

/// The first hits of rays on shapes.
///
/// shape, poses: as in `distance`. origins, directions: (D,) or (n, D); a direction need not be a unit vector, and
/// times are in units of its length. Returns `RayHit(time, normal, part)`, (n,), (n, D) and (n,); the time is infinite
/// without a hit by `max_time`. A ray that starts inside hits at time zero if `solid`, otherwise where it leaves the
/// shape.
///
/// >>> import impinge
/// >>> hit = impinge.cast_rays(impinge.Ball(1), None, [-4, 0, 0], [2, 0, 0])
/// >>> hit.time, hit.normal.tolist()
/// (1.5, [-1.0, 0.0, 0.0])
#[pyfunction]
#[pyo3(signature = (shape, poses, origins, directions, max_time=f64::INFINITY, solid=true, *, threads=None, progress=None))]
fn cast_rays<'py>(
    shape: &Object<'py>,
    poses: &Object<'py>,
    origins: &Object<'py>,
    directions: &Object<'py>,
    max_time: f64,
    solid: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> Answer<'py> {
    let call = Call::new(threads, progress);
    points::cast_rays([shape, poses, origins, directions], max_time, solid, call)
}
