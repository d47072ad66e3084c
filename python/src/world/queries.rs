//! Queries of worlds with many rays, points and shapes. Results are columns, or rows of handles.

use impinge::bounding_volume::{Aabb, Ray};
use impinge::math::na::convert;
use impinge::math::{Point, Vector};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::query::{ClosestPoints, Impact, ImpactOptions, RayIntersection};
use impinge::world::{CollisionGroups, CollisionObject, NearObject, QueryFilter};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::typed::TypedWorld;
use crate::answer::Column;
use crate::error;
use crate::options::FilterOptions;
use crate::side::{Elements, GivenSide, SideArgument, common};
use crate::solid;
use crate::space::{Kind, Numeric};
use crate::supervise::{Call, each};
use crate::vectors::Vectors;
use crate::world::Arrays;

/// The handle that stands for no object.
const NO_OBJECT: u64 = u64::MAX;

/// The name of a query and its options.
#[derive(FromPyObject)]
pub(crate) struct Asking {
    name: String,
    /// The maximum time or distance.
    limit: f64,
    /// The distance at which a moving shape counts as touching.
    target_distance: f64,
    /// The largest number of results for each element; `None` for all results.
    wanted: Option<usize>,
    solid: bool,
    /// Whether open surfaces are allowed: they contain the points on them.
    surface: bool,
}

/// The queries that a world of any scalar and dimension supports.
pub(crate) trait WorldQueries {
    /// Runs a query for arrays. If it has one result for each element, returns the handles and the
    /// other columns. Otherwise returns compressed rows: first the offset of each element's results
    /// (n + 1,), then the handles and the other columns.
    fn ask<'py>(
        &self,
        asking: &Asking,
        given: (&[Bound<'py, PyAny>], Kind),
        filter: Option<&FilterOptions>,
        call: &Call,
    ) -> Arrays<'py>;
}

/// An object and the result of a query about it.
#[derive(Clone, Copy)]
struct Found<N, const D: usize> {
    handle: u64,
    /// A time or distance.
    number: N,
    normal: [N; D],
    points: [[N; D]; 2],
    is_inside: bool,
}

impl<N: Numeric<D>, const D: usize> Found<N, D> {
    /// Returns a result that has a handle only; the handle [`NO_OBJECT`] stands for no result.
    fn of(handle: u64) -> Self {
        let nowhere = [convert::<f64, N>(f64::NAN); D];
        let (number, points) = (N::INFINITY, [nowhere; 2]);
        Self { handle, number, normal: nowhere, points, is_inside: false }
    }
}

/// The columns of a query's result in addition to the handles.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Beside {
    Nothing,
    /// Time and normal.
    Hits,
    /// Time, normal and both points.
    Impacts,
    /// Distance and both points.
    Near,
    /// The point on the object, and whether the given point is inside. For `overlaps_any` the flag
    /// says whether the shape overlaps an object.
    Projections,
}

/// The objects that a query considers.
struct Chosen {
    groups: Option<CollisionGroups>,
    /// The excluded objects, sorted for binary search.
    excluded: Vec<CollisionObjectHandle>,
}

/// A query whose arrays are read. `find` returns the results for an element. Threads cannot share filters, so
/// each element gets its own.
struct Prepared<'a, N: Numeric<D>, const D: usize> {
    len: usize,
    beside: Beside,
    /// Whether the result has all found objects of each element in compressed rows, not one object
    /// for each element.
    in_rows: bool,
    find: Box<Find<'a, N, D>>,
}

type Find<'a, N, const D: usize> =
    dyn Fn(usize, &QueryFilter<'_, N, D, ()>) -> Vec<Found<N, D>> + Sync + 'a;

impl<N: Numeric<D>, const D: usize> WorldQueries for TypedWorld<N, D> {
    fn ask<'py>(
        &self,
        asking: &Asking,
        (given, kind): (&[Bound<'py, PyAny>], Kind),
        filter: Option<&FilterOptions>,
        call: &Call,
    ) -> Arrays<'py> {
        let chosen = self.chosen(filter)?;
        let py = given[0].py();
        let answer = |prepared: Prepared<'_, N, D>| {
            let Prepared { len, beside, in_rows, find } = prepared;
            let found = each(py, len, call, |element| chosen.ask(element, &*find))?;
            columns(py, found, beside, in_rows)
        };
        match (asking.name.as_str(), given) {
            ("ray_hit" | "ray_hits", [origins, directions]) => {
                let vectors =
                    [Vectors::of(origins, "origins")?, Vectors::of(directions, "directions")?];
                answer(self.rays(asking, &vectors)?)
            }
            ("project" | "nearest_to_points" | "containing", [points]) => {
                if asking.name == "containing" && !asking.surface {
                    self.refuse_open(&chosen)?;
                }
                let points = Vectors::of(points, "points")?;
                answer(self.points(asking, &points)?)
            }
            ("in_boxes", [mins, maxs]) => {
                let corners = [Vectors::of(mins, "mins")?, Vectors::of(maxs, "maxs")?];
                answer(self.boxes(&corners)?)
            }
            ("near" | "overlapping" | "overlaps_any", [shapes, poses]) => {
                let given = placed(shapes, poses).read::<N, D>(kind)?;
                answer(self.shapes(asking, &given)?)
            }
            ("cast" | "casts", [shapes, poses, velocities]) => {
                let given = placed(shapes, poses).read::<N, D>(kind)?;
                let velocities = Vectors::of(velocities, "velocities")?;
                answer(self.casts(asking, &given, &velocities)?)
            }
            (name, _) => Err(PyValueError::new_err(format!("there is no question {name:?}"))),
        }
    }
}

/// Returns the arguments of a side.
const fn placed<'a, 'py>(
    shapes: &'a Bound<'py, PyAny>,
    poses: &'a Bound<'py, PyAny>,
) -> SideArgument<'a, 'py> {
    SideArgument { shapes, poses, names: &["shape", "poses"] }
}

impl Chosen {
    /// Whether the object is considered.
    fn has<N: Numeric<D>, const D: usize>(&self, object: &CollisionObject<N, D, ()>) -> bool {
        let groups = object.collision_groups();
        self.groups.is_none_or(|own| own.can_interact_with_groups(groups))
            && self.excluded.binary_search(&object.handle()).is_err()
    }

    fn ask<N: Numeric<D>, const D: usize>(
        &self,
        element: usize,
        find: &Find<'_, N, D>,
    ) -> Vec<Found<N, D>> {
        let is_wanted = |object: &CollisionObject<N, D, ()>| {
            self.excluded.binary_search(&object.handle()).is_err()
        };
        let mut filter = QueryFilter::new();
        if let Some(groups) = self.groups {
            filter = filter.groups(groups);
        }
        if !self.excluded.is_empty() {
            filter = filter.predicate(&is_wanted);
        }
        find(element, &filter)
    }
}

impl<N: Numeric<D>, const D: usize> TypedWorld<N, D> {
    fn chosen(&self, filter: Option<&FilterOptions>) -> PyResult<Chosen> {
        let Some(filter) = filter else {
            return Ok(Chosen { groups: None, excluded: Vec::new() });
        };
        let mut excluded = self.fresh(&filter.exclude, "exclude")?;
        excluded.sort_unstable();
        let groups = (!filter.groups.is_empty()).then(|| filter.groups.groups()).transpose();
        Ok(Chosen { groups: groups.map_err(|refused| error::of_groups(&refused))?, excluded })
    }

    fn rays<'a>(
        &'a self,
        asking: &Asking,
        [origins, directions]: &'a [Vectors<'_, N, D>; 2],
    ) -> PyResult<Prepared<'a, N, D>> {
        let (origins, directions) = (origins.rows()?, directions.rows()?);
        let len = common(&[("origins", origins.len()), ("directions", directions.len())])?;
        let (limit, solid, in_rows) = (convert(asking.limit), asking.solid, asking.in_rows());
        let find = move |element, filter: &QueryFilter<'_, N, D, ()>| {
            let origin = Point::from(entry(origins, element));
            let ray = Ray::new(origin, Vector::from(entry(directions, element)));
            if in_rows {
                let hits = self.world.ray_hits(&ray, limit, solid, filter);
                hits.into_iter().map(|(object, hit)| self.hit(object, &hit)).collect()
            } else {
                let hit = self.world.first_ray_hit(&ray, limit, solid, filter);
                hit.map(|(object, hit)| self.hit(object, &hit)).into_iter().collect()
            }
        };
        Ok(Prepared { len, beside: Beside::Hits, in_rows, find: Box::new(find) })
    }

    fn points<'a>(
        &'a self,
        asking: &Asking,
        points: &'a Vectors<'_, N, D>,
    ) -> PyResult<Prepared<'a, N, D>> {
        let points = points.rows()?;
        let at = move |element: usize| Point::from(points[element]);
        let (limit, solid, count) = (convert(asking.limit), asking.solid, asking.count());
        let len = points.len();
        let (beside, find): (_, Box<Find<'a, N, D>>) = match asking.name.as_str() {
            "project" => (
                Beside::Projections,
                Box::new(move |element, filter| {
                    let found = self.world.project_point(&at(element), limit, solid, filter);
                    let found = found.map(|(object, nearest)| Found {
                        points: [points[element], nearest.point.coords.into()],
                        is_inside: nearest.is_inside,
                        ..Found::of(self.of(object.handle()))
                    });
                    found.into_iter().collect()
                }),
            ),
            "containing" if self.surfaces.is_empty() => (
                Beside::Nothing,
                Box::new(move |element, filter| {
                    self.alone(self.world.objects_containing(&at(element), filter))
                }),
            ),
            "containing" => (
                Beside::Nothing,
                Box::new(move |element, filter| self.holding(&at(element), filter)),
            ),
            _ => (
                Beside::Near,
                Box::new(move |element, filter| {
                    let point = at(element);
                    let found = self.world.nearest_to_point(&point, count, limit, filter);
                    found.iter().map(|near| self.near(near)).collect()
                }),
            ),
        };
        Ok(Prepared { len, beside, in_rows: asking.in_rows(), find })
    }

    /// Returns the objects that contain a point, where closed surfaces are solids; none if the
    /// point is not finite.
    fn holding(&self, point: &Point<N, D>, filter: &QueryFilter<'_, N, D, ()>) -> Vec<Found<N, D>> {
        let Ok(here) = Aabb::try_new(*point, *point) else { return Vec::new() };
        let holds = |object: &&CollisionObject<N, D, ()>| {
            solid::contains(object.shape(), &N::pose(object.position()), point)
        };
        self.alone(self.world.objects_in_aabb(&here, filter).filter(holds))
    }

    /// Returns an error if a considered object has an open surface; it names the object with the lowest handle.
    fn refuse_open(&self, chosen: &Chosen) -> PyResult<()> {
        for (&handle, &standing) in &self.surfaces {
            let object = self.world.collision_object(handle);
            let is_asked = object.is_some_and(|object| chosen.has(object));
            if is_asked {
                let name = format!("the object {}", self.of(handle));
                solid::refuse_open(Some(standing), &name)?;
            }
        }
        Ok(())
    }

    fn boxes<'a>(
        &'a self,
        [mins, maxs]: &'a [Vectors<'_, N, D>; 2],
    ) -> PyResult<Prepared<'a, N, D>> {
        let (mins, maxs) = (mins.rows()?, maxs.rows()?);
        let len = common(&[("mins", mins.len()), ("maxs", maxs.len())])?;
        let aabb = |row| {
            let [lower, upper] = [entry(mins, row), entry(maxs, row)].map(Point::from);
            let refused =
                |error| PyValueError::new_err(format!("mins[{row}], maxs[{row}]: {error}"));
            Aabb::try_new(lower, upper).map_err(refused)
        };
        let aabbs: Vec<Aabb<N, D>> = (0..len).map(aabb).collect::<PyResult<_>>()?;
        let find = move |element: usize, filter: &QueryFilter<'_, N, D, ()>| {
            self.alone(self.world.objects_in_aabb(&aabbs[element], filter))
        };
        Ok(Prepared { len, beside: Beside::Nothing, in_rows: true, find: Box::new(find) })
    }

    fn shapes<'a>(
        &'a self,
        asking: &Asking,
        given: &'a GivenSide<'_, '_, N, D>,
    ) -> PyResult<Prepared<'a, N, D>> {
        let Elements { shapes, positions } = given.elements()?;
        let (len, limit, count) = (shapes.len(), convert(asking.limit), asking.count());
        let (beside, find): (_, Box<Find<'a, N, D>>) = match asking.name.as_str() {
            "overlapping" => (
                Beside::Nothing,
                Box::new(move |element, filter| {
                    let (position, shape) = (&positions[element], &**shapes[element]);
                    self.alone(self.world.objects_overlapping(position, shape, filter))
                }),
            ),
            "overlaps_any" => (
                Beside::Projections,
                Box::new(move |element, filter| {
                    let (position, shape) = (&positions[element], &**shapes[element]);
                    let is_inside = self.world.overlaps_any(position, shape, filter);
                    vec![Found { is_inside, ..Found::of(NO_OBJECT) }]
                }),
            ),
            _ => (
                Beside::Near,
                Box::new(move |element, filter| {
                    let (position, shape) = (&positions[element], &**shapes[element]);
                    let found = self.world.nearest_objects(position, shape, count, limit, filter);
                    found.iter().map(|near| self.near(near)).collect()
                }),
            ),
        };
        Ok(Prepared { len, beside, in_rows: asking.in_rows(), find })
    }

    fn casts<'a>(
        &'a self,
        asking: &Asking,
        given: &'a GivenSide<'_, '_, N, D>,
        velocities: &'a Vectors<'_, N, D>,
    ) -> PyResult<Prepared<'a, N, D>> {
        let Elements { shapes, positions } = given.elements()?;
        let velocities = velocities.rows()?;
        let len = common(&[("poses", shapes.len()), ("velocities", velocities.len())])?;
        let in_rows = asking.in_rows();
        let options = ImpactOptions::new()
            .with_max_time(convert(asking.limit))
            .with_target_distance(convert(asking.target_distance));
        let find = move |element, filter: &QueryFilter<'_, N, D, ()>| {
            let (position, shape) = (entry(&positions, element), &**entry(&shapes, element));
            let velocity = Vector::from(entry(velocities, element));
            if in_rows {
                let found =
                    self.world.cast_shape_all(&position, &velocity, shape, &options, filter);
                found.into_iter().map(|(object, impact)| self.impact(object, &impact)).collect()
            } else {
                let found = self.world.cast_shape(&position, &velocity, shape, &options, filter);
                found.map(|(object, impact)| self.impact(object, &impact)).into_iter().collect()
            }
        };
        Ok(Prepared { len, beside: Beside::Impacts, in_rows, find: Box::new(find) })
    }

    fn hit(&self, object: &CollisionObject<N, D, ()>, hit: &RayIntersection<N, D>) -> Found<N, D> {
        Found { number: hit.toi, normal: hit.normal.into(), ..Found::of(self.of(object.handle())) }
    }

    fn impact(&self, object: &CollisionObject<N, D, ()>, impact: &Impact<N, D>) -> Found<N, D> {
        Found {
            number: impact.toi,
            normal: (*impact.normal).into(),
            points: [impact.world1, impact.world2].map(|point| point.coords.into()),
            ..Found::of(self.of(object.handle()))
        }
    }

    fn near(&self, near: &NearObject<'_, N, D, ()>) -> Found<N, D> {
        let found = Found { number: near.distance, ..Found::of(self.of(near.object.handle())) };
        match near.points {
            ClosestPoints::WithinMargin(point1, point2) => {
                Found { points: [point1, point2].map(|point| point.coords.into()), ..found }
            }
            _ => found,
        }
    }

    /// Converts objects to results that have handles only.
    fn alone<'a>(
        &self,
        objects: impl Iterator<Item = &'a CollisionObject<N, D, ()>>,
    ) -> Vec<Found<N, D>> {
        objects.map(|object| Found::of(self.of(object.handle()))).collect()
    }
}

impl Asking {
    fn in_rows(&self) -> bool {
        !matches!(self.name.as_str(), "ray_hit" | "cast" | "project" | "overlaps_any")
    }

    fn count(&self) -> usize {
        self.wanted.unwrap_or(usize::MAX)
    }
}

/// Returns the entry of an element. The only entry of a list of one belongs to all elements.
fn entry<T: Copy>(list: &[T], element: usize) -> T {
    list[if list.len() == 1 { 0 } else { element }]
}

/// Converts results to columns. With `in_rows`, these are the offsets of each element's results and
/// all results; otherwise one result for each element, with [`NO_OBJECT`] if none was found.
fn columns<N: Numeric<D>, const D: usize>(
    py: Python<'_>,
    mut found: Vec<Vec<Found<N, D>>>,
    beside: Beside,
    in_rows: bool,
) -> Arrays<'_> {
    let mut columns: Vec<Column<N, D>> = Vec::new();
    if in_rows {
        let ends = found.iter().scan(0, |end, row| {
            *end += row.len();
            Some(i64::try_from(*end).unwrap_or(i64::MAX))
        });
        columns.push(Column::Rows(core::iter::once(0).chain(ends).collect()));
    } else {
        found.iter_mut().filter(|row| row.is_empty()).for_each(|row| {
            row.push(Found::of(NO_OBJECT));
        });
    }
    let flat: Vec<Found<N, D>> = found.into_iter().flatten().collect();
    columns.push(Column::Handles(flat.iter().map(|one| one.handle).collect()));
    let number = || Column::Numbers(flat.iter().map(|one| one.number).collect());
    let normal = || Column::Vectors(flat.iter().map(|one| one.normal).collect());
    let point = |side: usize| Column::Vectors(flat.iter().map(|one| one.points[side]).collect());
    let is_inside = || Column::Flags(flat.iter().map(|one| one.is_inside).collect());
    columns.extend(match beside {
        Beside::Nothing => Vec::new(),
        Beside::Hits => vec![number(), normal()],
        Beside::Impacts => vec![number(), normal(), point(0), point(1)],
        Beside::Near => vec![number(), point(0), point(1)],
        Beside::Projections => vec![point(1), is_inside()],
    });
    columns.into_iter().map(|column| column.into_pyobject(py)).collect()
}
