//! Tiles of large scenes: arrays in Python, which become tiles of the library during a call.

use impinge::batch::{TileCut, Tiles, boxes as boxes_of, pairs_in_tile as pairs_of, tiles};
use impinge::bounding_volume::Aabb;
use impinge::math::Point;
use impinge::math::na::convert;
use numpy::{PyArray1, PyArray3, PyArrayDyn, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::answer::Extent;
use crate::error;
use crate::shapes::kind_of;
use crate::side::SideArgument;
use crate::space::{Kind, Numeric, Task, run_in};
use crate::supervise::{Call, Threads, supervise};
use crate::vectors::Vectors;

/// Adds the functions about tiles.
pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(boxes, module)?)?;
    module.add_function(wrap_pyfunction!(pairs_in_tile, module)?)?;
    module.add_function(wrap_pyfunction!(tile_cuts, module)?)?;
    module.add_function(wrap_pyfunction!(tile_bounds, module)?)?;
    module.add_function(wrap_pyfunction!(tiles_meeting, module)?)?;
    module.add_function(wrap_pyfunction!(tile_owners, module)?)
}

type Object<'py> = Bound<'py, PyAny>;

/// The bounding box of each object, enlarged by the rounding errors of pairs: the input of `tiles` and `Tiles.meeting`.
///
/// shapes, poses: as in `distance`. Returns (n, 2, D), the lower and the upper corner in the world frame, with the
/// dtype of the shapes; NaN for an object without extent (a composite without parts), infinite where the object is
/// unbounded.
///
/// >>> import impinge
/// >>> impinge.boxes(impinge.Ball(1), impinge.Poses([[0, 0, 0], [5, 0, 0]])).round(6).tolist()[1]
/// [[4.0, -1.0, -1.0], [6.0, 1.0, 1.0]]
#[pyfunction]
#[pyo3(signature = (shapes, poses, *, threads=None, progress=None))]
fn boxes<'py>(
    shapes: &Object<'py>,
    poses: &Object<'py>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Object<'py>> {
    let kind = kind_of(shapes, "shapes")?;
    let side = SideArgument { shapes, poses, names: &["shapes", "poses"] };
    run_in(kind, AskBoxes { side, kind, call: Call::new(threads, progress) })
}

/// The pairs of a tile whose distance is at most the clearance of the tiles, as an ascending array (m, 2) of uint64.
///
/// shapes, poses: as in `distance`, for the objects that `Tiles.meeting` assigns to the tile, in any order. ids: (n,)
/// integers of 0 or more, one for each object, all different. tiles: a `Tiles`. tile: its index.
///
/// Each row has the lower id first. All tiles together have each pair once, and the same pairs as `pairs_within` for
/// all objects, for any tiles. `ValueError` and `TypeError` name the argument, the row and the value.
///
/// >>> import impinge
/// >>> ball, poses = impinge.Ball(1), impinge.Poses([[0, 0, 0], [2.5, 0, 0], [6, 0, 0], [8.5, 0, 0]])
/// >>> tiles = impinge.tiles(impinge.boxes(ball, poses), 2, clearance=0.5)
/// >>> [impinge.pairs_in_tile(ball, poses, [10, 11, 12, 13], tiles, tile).tolist() for tile in range(2)]
/// [[[10, 11]], [[12, 13]]]
#[pyfunction]
#[pyo3(signature = (shapes, poses, ids, tiles, tile, *, threads=None, progress=None))]
fn pairs_in_tile<'py>(
    shapes: &Object<'py>,
    poses: &Object<'py>,
    ids: &Object<'py>,
    tiles: GivenTiles<'py>,
    tile: u32,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Object<'py>> {
    let kind = kind_of(shapes, "shapes")?;
    kind.expect("tiles", tiles.kind()?)?;
    let side = SideArgument { shapes, poses, names: &["shapes", "poses"] };
    run_in(kind, AskTile { side, ids, tiles, tile, call: Call::new(threads, progress), kind })
}

/// Returns the cuts of space into `number` tiles as two columns: the axis and the position of each
/// cut. `boxes` is an array (n, 2, D) in C order.
#[pyfunction]
fn tile_cuts<'py>(
    boxes: &Object<'py>,
    number: u32,
    clearance: f64,
    dim: u8,
    dtype: &str,
) -> PyResult<(Object<'py>, Object<'py>)> {
    run_in(Kind::parse(dim, dtype)?, CutTiles { boxes, number, clearance })
}

/// Returns the lower and upper corner of each tile: (n, 2, D).
#[pyfunction]
fn tile_bounds<'py>(py: Python<'py>, tiles: GivenTiles<'py>) -> PyResult<Object<'py>> {
    run_in(tiles.kind()?, Bounds { py, tiles })
}

/// Returns the two arrays of `TileRows`: the offset of each box's first tile, followed by the total
/// number, and the indices of the tiles. `boxes` is an array (n, 2, D) in C order.
#[pyfunction]
fn tiles_meeting<'py>(
    tiles: GivenTiles<'py>,
    boxes: &Object<'py>,
) -> PyResult<(Object<'py>, Object<'py>)> {
    run_in(tiles.kind()?, Meeting { tiles, boxes })
}

/// Returns the tile that contains each point.
#[pyfunction]
fn tile_owners<'py>(tiles: GivenTiles<'py>, points: &Object<'py>) -> PyResult<Object<'py>> {
    run_in(tiles.kind()?, Owners { tiles, points })
}

/// The fields of the Python class `Tiles`.
#[derive(FromPyObject)]
struct GivenTiles<'py> {
    axes: PyReadonlyArray1<'py, u32>,
    cuts: Bound<'py, PyAny>,
    clearance: f64,
    dim: u8,
    dtype: String,
}

impl GivenTiles<'_> {
    fn kind(&self) -> PyResult<Kind> {
        Kind::parse(self.dim, &self.dtype)
    }

    fn read<N: Numeric<D>, const D: usize>(&self) -> PyResult<Tiles<N, D>> {
        let places = self.cuts.extract::<PyReadonlyArray1<'_, N>>()?;
        let (axes, places) = (self.axes.as_slice()?, places.as_slice()?);
        if axes.len() != places.len() {
            let (axes, cuts) = (axes.len(), places.len());
            return Err(PyValueError::new_err(format!("there are {axes} axes and {cuts} cuts")));
        }
        let cuts = axes.iter().zip(places).map(|(&axis, &at)| TileCut { axis, at });
        Tiles::try_from_cuts(convert(self.clearance), cuts.collect())
            .map_err(|error| error::of_batch(&error, "tiles"))
    }
}

/// Converts boxes to those of the library; a row of NaN becomes `None`.
fn read_boxes<N: Numeric<D>, const D: usize>(
    given: &Bound<'_, PyAny>,
) -> PyResult<Vec<Option<Aabb<N, D>>>> {
    let array = given.cast::<PyArrayDyn<N>>()?.try_readonly()?;
    let corners: &[[N; D]] = array.as_slice()?.as_chunks().0;
    let is_nan = |x: &N| x.partial_cmp(x).is_none();
    let read = |(row, [low, high]): (usize, &[[N; D]; 2])| {
        if low.iter().chain(high).all(is_nan) {
            return Ok(None);
        }
        let aabb = Aabb::try_new(Point::from(*low), Point::from(*high));
        aabb.map(Some).map_err(|error| PyValueError::new_err(format!("boxes[{row}]: {error}")))
    };
    corners.as_chunks().0.iter().enumerate().map(read).collect()
}

/// Converts boxes to an array (n, 2, D); `None` becomes a row of NaN.
fn boxes_array<N: Numeric<D>, const D: usize>(
    py: Python<'_>,
    boxes: impl ExactSizeIterator<Item = Option<Aabb<N, D>>>,
) -> PyResult<Bound<'_, PyAny>> {
    let count = boxes.len();
    let nowhere = [[N::lit(f64::NAN); D]; 2];
    let corners = boxes.map(|aabb| {
        aabb.map_or(nowhere, |aabb| [aabb.mins(), aabb.maxs()].map(|corner| corner.coords.into()))
    });
    let numbers: Vec<[[N; D]; 2]> = corners.collect();
    let flat = numbers.into_flattened().into_flattened();
    let array: Bound<'_, PyArray3<N>> = PyArray1::from_vec(py, flat).reshape([count, 2, D])?;
    Ok(array.into_any())
}

/// The task of [`boxes`].
struct AskBoxes<'a, 'py> {
    side: SideArgument<'a, 'py>,
    kind: Kind,
    call: Call,
}

impl<'py> Task for AskBoxes<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let py = self.side.poses.py();
        let given = self.side.read::<N, D>(self.kind)?;
        let poses = given.poses()?;
        let side = given.side(&*poses)?;
        let extent = Extent::Many(side.len());
        let found = supervise(py, extent, &self.call, |control| boxes_of(&side, control))?;
        let boxes = found.map_err(|error| error::of_batch(&error, "poses"))?;
        boxes_array(py, boxes.into_iter())
    }
}

/// The task of [`pairs_in_tile`].
struct AskTile<'a, 'py> {
    side: SideArgument<'a, 'py>,
    ids: &'a Bound<'py, PyAny>,
    tiles: GivenTiles<'py>,
    tile: u32,
    call: Call,
    kind: Kind,
}

impl<'py> Task for AskTile<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let py = self.ids.py();
        let reader = py.import("impinge._tiles")?.getattr("ids")?;
        let ids: PyReadonlyArray1<'_, u64> = reader.call1((self.ids,))?.extract()?;
        let (ids, tiles) = (ids.as_slice()?, self.tiles.read::<N, D>()?);
        let given = self.side.read::<N, D>(self.kind)?;
        let poses = given.poses()?;
        let side = given.side(&*poses)?;
        let found = supervise(py, Extent::Many(side.len()), &self.call, |control| {
            pairs_of(&side, ids, &tiles, self.tile, control)
        })?;
        let pairs = found.map_err(|error| error::of_batch(&error, "poses"))?;
        let rows = pairs.len();
        Ok(PyArray1::from_vec(py, pairs.into_flattened()).reshape([rows, 2])?.into_any())
    }
}

/// The task of [`tile_cuts`].
struct CutTiles<'a, 'py> {
    boxes: &'a Bound<'py, PyAny>,
    number: u32,
    clearance: f64,
}

impl<'py> Task for CutTiles<'_, 'py> {
    type Answer = (Bound<'py, PyAny>, Bound<'py, PyAny>);

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let py = self.boxes.py();
        let boxes = read_boxes::<N, D>(self.boxes)?;
        let made = py.detach(|| tiles(&boxes, self.number, convert(self.clearance)));
        let tiles = made.map_err(|error| error::of_batch(&error, "boxes"))?;
        let axes = tiles.cuts().iter().map(|cut| cut.axis);
        let places = tiles.cuts().iter().map(|cut| cut.at);
        let axes = PyArray1::from_iter(py, axes).into_any();
        Ok((axes, PyArray1::from_iter(py, places).into_any()))
    }
}

/// The task of [`tile_bounds`].
struct Bounds<'py> {
    py: Python<'py>,
    tiles: GivenTiles<'py>,
}

impl<'py> Task for Bounds<'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        boxes_array(self.py, self.tiles.read::<N, D>()?.bounds().into_iter().map(Some))
    }
}

/// The task of [`tiles_meeting`].
struct Meeting<'a, 'py> {
    tiles: GivenTiles<'py>,
    boxes: &'a Bound<'py, PyAny>,
}

impl<'py> Task for Meeting<'_, 'py> {
    type Answer = (Bound<'py, PyAny>, Bound<'py, PyAny>);

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let py = self.boxes.py();
        let (tiles, boxes) = (self.tiles.read::<N, D>()?, read_boxes::<N, D>(self.boxes)?);
        let rows = py.detach(|| tiles.meeting(&boxes));
        let row = |start: usize| i64::try_from(start).expect("memory holds it");
        let starts = PyArray1::from_iter(py, rows.starts.into_iter().map(row)).into_any();
        Ok((starts, PyArray1::from_vec(py, rows.tiles).into_any()))
    }
}

/// The task of [`tile_owners`].
struct Owners<'a, 'py> {
    tiles: GivenTiles<'py>,
    points: &'a Bound<'py, PyAny>,
}

impl<'py> Task for Owners<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let tiles = self.tiles.read::<N, D>()?;
        let points = Vectors::<N, D>::of(self.points, "points")?;
        let owners = points.rows()?.iter().map(|point| tiles.owner(&Point::from(*point)));
        Ok(PyArray1::from_iter(self.points.py(), owners).into_any())
    }
}
