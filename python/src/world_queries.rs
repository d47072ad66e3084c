//! Questions to worlds about many rays, points and shapes, with answers in columns or rows of handles.

use impinge::bounding_volume::Ray;
use impinge::math::na::convert;
use impinge::math::{Point, Vector};
use impinge::query::ImpactOptions;
use impinge::shape::ShapeHandle;
use impinge::world::QueryFilter;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::answer::Column;
use crate::side::SideArgument;
use crate::space::{Kind, Numeric};
use crate::vectors::Vectors;
use crate::world::{Arrays, TypedWorld};

/// The handle of no object.
const NO_OBJECT: u64 = u64::MAX;

/// Up to how many objects are wanted, and up to which distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowQuestion {
    pub(crate) count: usize,
    pub(crate) max_distance: f64,
}

/// The questions that a world of any scalar and dimension answers.
pub(crate) trait WorldQueries {
    /// For each ray: time, normal and handle of the first object.
    fn cast_rays<'py>(
        &self,
        rays: [&Bound<'py, PyAny>; 2],
        max_time: f64,
        solid: bool,
    ) -> Arrays<'py>;
    /// For each element a row of the nearest objects: starts, handles, distances.
    fn near<'py>(
        &self,
        side: &SideArgument<'_, 'py>,
        kind: Kind,
        question: RowQuestion,
    ) -> Arrays<'py>;
    /// For each point a row of the objects that hold it: starts, handles.
    fn containing<'py>(&self, points: &Bound<'py, PyAny>) -> Arrays<'py>;
    /// For each moving element: time, normal, points and handle of the first object.
    fn cast_shape<'py>(
        &self,
        side: &SideArgument<'_, 'py>,
        kind: Kind,
        velocities: &Bound<'py, PyAny>,
        limits: [f64; 2],
    ) -> Arrays<'py>;
}

/// Lists of handles, one after the other.
struct Rows {
    starts: Vec<i64>,
    handles: Vec<u64>,
}

impl Rows {
    fn new() -> Self {
        Self { starts: vec![0], handles: Vec::new() }
    }

    fn end(&mut self) {
        self.starts.push(i64::try_from(self.handles.len()).unwrap_or(i64::MAX));
    }
}

fn arrays<'py, N: Numeric<D>, const D: usize, const COUNT: usize>(
    py: Python<'py>,
    columns: [Column<N, D>; COUNT],
) -> Arrays<'py> {
    columns.into_iter().map(|column| column.into_array(py)).collect()
}

/// How many elements arguments have together, where one stands for all.
fn common(lengths: &[(&str, usize)]) -> PyResult<usize> {
    let len = lengths.iter().map(|(_, len)| *len).find(|len| *len != 1).unwrap_or(1);
    match lengths.iter().find(|(_, given)| *given != 1 && *given != len) {
        None => Ok(len),
        Some((name, given)) => Err(PyValueError::new_err(format!(
            "{name} has {given} elements where {len} are needed"
        ))),
    }
}

/// The entry of an element in a list, which may have one for all.
fn entry<T: Copy>(list: &[T], element: usize) -> T {
    list[if list.len() == 1 { 0 } else { element }]
}

impl<N: Numeric<D>, const D: usize> TypedWorld<N, D> {
    /// Calls with each element of a side.
    fn each_element(
        &self,
        side: &SideArgument<'_, '_>,
        kind: Kind,
        mut visit: impl FnMut(usize, &ShapeHandle<N, D>, &N::Isometry),
    ) -> PyResult<()> {
        let given = side.read::<N, D>(kind)?;
        let poses = given.poses()?;
        let len = given.side(&*poses)?.len();
        for element in 0..len {
            let pose = poses.pose(if poses.len() == 1 { 0 } else { element });
            visit(element, given.shape(element), &N::isometry(&pose));
        }
        Ok(())
    }
}

impl<N: Numeric<D>, const D: usize> WorldQueries for TypedWorld<N, D> {
    fn cast_rays<'py>(
        &self,
        [origins, directions]: [&Bound<'py, PyAny>; 2],
        max_time: f64,
        solid: bool,
    ) -> Arrays<'py> {
        let py = origins.py();
        let origins = Vectors::<N, D>::of(origins, "origins")?;
        let directions = Vectors::<N, D>::of(directions, "directions")?;
        let (origins, directions) = (origins.rows()?, directions.rows()?);
        let len = common(&[("origins", origins.len()), ("directions", directions.len())])?;
        let (mut time, mut handles) = (vec![N::INFINITY; len], vec![NO_OBJECT; len]);
        let mut normal = vec![[not_a_number::<N, D>(); D]; len];
        py.detach(|| {
            let filter = QueryFilter::new();
            for element in 0..len {
                let origin = Point::from(Vector::from(entry(origins, element)));
                let ray = Ray::new(origin, Vector::from(entry(directions, element)));
                let found = self.world.first_ray_hit(&ray, convert(max_time), solid, &filter);
                if let Some((object, hit)) = found {
                    time[element] = hit.toi;
                    normal[element] = hit.normal.into();
                    handles[element] = self.of(object.handle());
                }
            }
        });
        arrays(
            py,
            [Column::<N, D>::Numbers(time), Column::Vectors(normal), Column::Handles(handles)],
        )
    }

    fn near<'py>(
        &self,
        side: &SideArgument<'_, 'py>,
        kind: Kind,
        question: RowQuestion,
    ) -> Arrays<'py> {
        let (mut rows, mut distances, filter) = (Rows::new(), Vec::new(), QueryFilter::new());
        let RowQuestion { count, max_distance } = question;
        self.each_element(side, kind, |_, shape, position| {
            let limit = convert(max_distance);
            for near in self.world.nearest_objects(position, &**shape, count, limit, &filter) {
                rows.handles.push(self.of(near.object.handle()));
                distances.push(near.distance);
            }
            rows.end();
        })?;
        let distances = Column::<N, D>::Numbers(distances);
        arrays(
            side.shapes.py(),
            [Column::Rows(rows.starts), Column::Handles(rows.handles), distances],
        )
    }

    fn containing<'py>(&self, points: &Bound<'py, PyAny>) -> Arrays<'py> {
        let py = points.py();
        let points = Vectors::<N, D>::of(points, "points")?;
        let (mut rows, filter) = (Rows::new(), QueryFilter::new());
        for point in points.rows()? {
            let point = Point::from(Vector::from(*point));
            rows.handles.extend(
                self.world
                    .objects_containing(&point, &filter)
                    .map(|object| self.of(object.handle())),
            );
            rows.end();
        }
        arrays(py, [Column::<N, D>::Rows(rows.starts), Column::Handles(rows.handles)])
    }

    fn cast_shape<'py>(
        &self,
        side: &SideArgument<'_, 'py>,
        kind: Kind,
        velocities: &Bound<'py, PyAny>,
        [max_time, target_distance]: [f64; 2],
    ) -> Arrays<'py> {
        let py = velocities.py();
        let velocities = Vectors::<N, D>::of(velocities, "velocities")?;
        let velocities = velocities.rows()?;
        let options = ImpactOptions::new()
            .with_max_time(convert(max_time))
            .with_target_distance(convert(target_distance));
        let (mut time, mut normal, mut handles) = (Vec::new(), Vec::new(), Vec::new());
        let (filter, mut len) = (QueryFilter::new(), 0);
        self.each_element(side, kind, |element, shape, position| {
            len = element + 1;
            let Some(velocity) = velocities.get(if velocities.len() == 1 { 0 } else { element })
            else {
                return;
            };
            let velocity = Vector::from(*velocity);
            let found = self.world.cast_shape(position, &velocity, &**shape, &options, &filter);
            time.push(found.map_or(N::INFINITY, |(_, impact)| impact.toi));
            normal.push(
                found.map_or([not_a_number::<N, D>(); D], |(_, impact)| (*impact.normal).into()),
            );
            handles.push(found.map_or(NO_OBJECT, |(object, _)| self.of(object.handle())));
        })?;
        common(&[("poses", len), ("velocities", velocities.len())])?;
        arrays(
            py,
            [Column::<N, D>::Numbers(time), Column::Vectors(normal), Column::Handles(handles)],
        )
    }
}

/// What there is where there is no answer.
fn not_a_number<N: Numeric<D>, const D: usize>() -> N {
    convert(f64::NAN)
}
