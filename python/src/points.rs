//! Queries of points and rays against placed shapes.

use impinge::batch::{HitColumns, PointBatch, ProjectionColumns, RayColumns};
use impinge::math::Point;
use impinge::math::na::convert;
use pyo3::prelude::*;

use crate::answer::{Column, Extent, PROJECTION, RAY_HIT, into_python};
use crate::error::{self, not_nan};
use crate::shapes::kind_of;
use crate::side::{GivenSide, SideArgument};
use crate::solid;
use crate::space::{Kind, Numeric, Task, run_in};
use crate::supervise::{Call, each, supervise};
use crate::vectors::Vectors;

/// A query about points.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum PointQuestion {
    /// The nearest point of the shape; if `solid`, a point inside is its own projection.
    Project { solid: bool },
    /// The signed distance, negative inside. Open surfaces have no inside: they are an error unless
    /// `surface` is `true`.
    SignedDistance { surface: bool },
    /// Whether the point is inside. Open surfaces are an error unless `surface` is `true`.
    Contains { surface: bool },
}

impl PointQuestion {
    /// Returns the field `surface` of a query about the inside, in which closed surfaces are
    /// solids; `None` for a projection.
    const fn is_about_inside(self) -> Option<bool> {
        match self {
            Self::Project { .. } => None,
            Self::SignedDistance { surface } | Self::Contains { surface } => Some(surface),
        }
    }
}

/// A query about points and the placed shapes of a side.
struct AskPoints<'a, 'py> {
    side: SideArgument<'a, 'py>,
    points: &'a Bound<'py, PyAny>,
    question: PointQuestion,
    call: Call,
    kind: Kind,
}

/// Runs a query about points in the world frame.
pub(crate) fn ask_points<'py>(
    [shape, poses, points]: [&Bound<'py, PyAny>; 3],
    question: PointQuestion,
    call: Call,
) -> PyResult<Bound<'py, PyAny>> {
    let kind = kind_of(shape, "shape")?;
    let side = SideArgument { shapes: shape, poses, names: &["shape", "poses"] };
    run_in(kind, AskPoints { side, points, question, call, kind })
}

impl<'py> Task for AskPoints<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let py = self.points.py();
        let points = Vectors::<N, D>::of(self.points, "points")?;
        let given = self.side.read::<N, D>(self.kind)?;
        let poses = given.poses()?;
        let batch = PointBatch::try_new(given.side(&*poses)?, points.rows()?);
        let batch = batch.map_err(|error| error::of_batch(&error, "points"))?;
        let is_lone = given.is_lone() && points.is_lone();
        let extent = Extent::of(is_lone, given.is_quick(), batch.len());
        if let Some(surface) = self.question.is_about_inside()
            && given.has_surface(surface)?
        {
            let column = self.of_solids(&given, points.rows()?, extent)?;
            return into_python(py, None, [column]);
        }
        let found = supervise(py, extent, &self.call, |control| match self.question {
            PointQuestion::SignedDistance { .. } => {
                let mut distance = extent.slots(N::ZERO);
                batch.signed_distances(control, &mut distance)?;
                Ok(vec![Column::Numbers(distance)])
            }
            PointQuestion::Contains { .. } => {
                let mut is_inside = extent.slots(false);
                batch.contains(control, &mut is_inside)?;
                Ok(vec![Column::Flags(is_inside)])
            }
            PointQuestion::Project { solid } => {
                let mut point = extent.slots([N::ZERO; D]);
                let (mut is_inside, mut part) = (extent.slots(false), extent.slots(0));
                let columns = ProjectionColumns {
                    point: &mut point,
                    is_inside: &mut is_inside,
                    part: &mut part,
                    ..Default::default()
                };
                batch.project(solid, control, columns)?;
                Ok(vec![Column::Vectors(point), Column::Flags(is_inside), Column::Indices(part)])
            }
        })?;
        let columns: Vec<Column<N, D>> =
            found.map_err(|error| error::of_batch(&error, "points"))?;
        let class = matches!(self.question, PointQuestion::Project { .. }).then_some(&PROJECTION);
        into_python(py, class, columns)
    }
}

impl AskPoints<'_, '_> {
    /// Computes a query about the inside for shapes of which at least one is a surface or polyline.
    /// Closed surfaces count as solids here. For a pose or point that is not finite, the result is
    /// `false` or infinity.
    fn of_solids<N: Numeric<D>, const D: usize>(
        &self,
        given: &GivenSide<'_, '_, N, D>,
        points: &[[N; D]],
        extent: Extent,
    ) -> PyResult<Column<N, D>> {
        let (py, len, placed) = (self.points.py(), extent.len(), given.placed()?);
        let at = |element: usize| {
            let (shape, pose) = &placed[if placed.len() == 1 { 0 } else { element }];
            let point = points[if points.len() == 1 { 0 } else { element }];
            let is_finite = pose.is_finite() && point.iter().all(|x| x.is_finite_number());
            is_finite.then_some((*shape, pose, Point::from(point)))
        };
        Ok(if let PointQuestion::Contains { .. } = self.question {
            let holds = |element| {
                at(element).is_some_and(|(shape, pose, point)| solid::contains(shape, pose, &point))
            };
            Column::Flags(extent.of_list(each(py, len, &self.call, holds)?))
        } else {
            let distance = |element| {
                at(element).map_or(N::INFINITY, |(shape, pose, point)| {
                    solid::signed_distance(shape, pose, &point)
                })
            };
            Column::Numbers(extent.of_list(each(py, len, &self.call, distance)?))
        })
    }
}

/// Rays that are cast on the placed shapes of a side.
struct CastRays<'a, 'py> {
    side: SideArgument<'a, 'py>,
    rays: [&'a Bound<'py, PyAny>; 2],
    max_time: f64,
    solid: bool,
    call: Call,
    kind: Kind,
}

/// Casts rays with these origins and directions.
pub(crate) fn cast_rays<'py>(
    [shape, poses, origins, directions]: [&Bound<'py, PyAny>; 4],
    max_time: f64,
    solid: bool,
    call: Call,
) -> PyResult<Bound<'py, PyAny>> {
    not_nan("max_time", max_time)?;
    let kind = kind_of(shape, "shape")?;
    let side = SideArgument { shapes: shape, poses, names: &["shape", "poses"] };
    run_in(kind, CastRays { side, rays: [origins, directions], max_time, solid, call, kind })
}

impl<'py> Task for CastRays<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let [origins, directions] = self.rays;
        let py = origins.py();
        let origins = Vectors::<N, D>::of(origins, "origins")?;
        let directions = Vectors::<N, D>::of(directions, "directions")?;
        let given = self.side.read::<N, D>(self.kind)?;
        let poses = given.poses()?;
        let rays = RayColumns::try_new(given.side(&*poses)?, origins.rows()?, directions.rows()?);
        let rays = rays.map_err(|error| error::of_batch(&error, "origins"))?;
        let rays = rays.until(convert(self.max_time));
        let rays = if self.solid { rays } else { rays.hollow() };
        let is_lone = given.is_lone() && origins.is_lone() && directions.is_lone();
        let extent = Extent::of(is_lone, given.is_quick(), rays.len());
        let found = supervise(py, extent, &self.call, |control| {
            let (mut time, mut normal) = (extent.slots(N::ZERO), extent.slots([N::ZERO; D]));
            let mut part = extent.slots(0);
            let columns = HitColumns {
                time: &mut time,
                normal: &mut normal,
                part: &mut part,
                ..Default::default()
            };
            rays.cast(control, columns)?;
            Ok([Column::Numbers(time), Column::Vectors(normal), Column::Indices(part)])
        })?;
        let columns: [Column<N, D>; 3] =
            found.map_err(|error| error::of_batch(&error, "origins"))?;
        into_python(py, Some(&RAY_HIT), columns)
    }
}
