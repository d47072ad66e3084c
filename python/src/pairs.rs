//! Queries about pairs of shapes; each side has one shape or many.

use impinge::batch::{
    BatchError, ClosestColumns, ContactColumns, Control, ImpactColumns, ManifoldRows, PairBatch,
    WitnessColumns, pairs_within, pairs_within_one,
};
use impinge::math::na::convert;
use impinge::narrow_phase::ContactPrediction;
use impinge::query::{ImpactOptions, ImpactStatus, Proximity};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

use crate::answer::{
    CLOSEST_POINTS, CONTACT, Class, Column, Extent, IMPACT, MANIFOLDS, NEAREST, Slots, WITNESS,
    into_python,
};
use crate::error::{self, not_nan};
use crate::shapes::kind_of;
use crate::side::{SideArgument, common};
use crate::space::{Kind, Numeric, Task, run_in};
use crate::supervise::{Call, Threads, supervise};
use crate::turning::AskTurning;
use crate::vectors::Vectors;

/// A query about every pair of a batch.
pub(crate) trait Question: Sync {
    /// The columns of the result.
    type Columns<N: Numeric<D>, const D: usize>: IntoIterator<Item = Column<N, D>, IntoIter: ExactSizeIterator>
        + Send;

    /// The class of the result; if `None`, the result is the only column.
    fn class(&self) -> Option<&'static Class>;

    /// The name of the limit in Python, and its value. A query without a limit has an empty name
    /// and zero.
    fn limit(&self) -> (&'static str, f64);

    /// Runs the query for a batch of this extent.
    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        extent: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError>;
}

pub(crate) struct Distances;

impl Question for Distances {
    type Columns<N: Numeric<D>, const D: usize> = [Column<N, D>; 1];

    fn class(&self) -> Option<&'static Class> {
        None
    }

    fn limit(&self) -> (&'static str, f64) {
        ("", 0.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        extent: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError> {
        let mut distance = extent.slots(N::ZERO);
        batch.distances(control, &mut distance)?;
        Ok([Column::Numbers(distance)])
    }
}

/// Closest points up to a distance.
pub(crate) struct Closest(pub(crate) f64);

impl Question for Closest {
    type Columns<N: Numeric<D>, const D: usize> = [Column<N, D>; 3];

    fn class(&self) -> Option<&'static Class> {
        Some(&CLOSEST_POINTS)
    }

    fn limit(&self) -> (&'static str, f64) {
        ("max_distance", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        extent: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError> {
        let mut distance = extent.slots(N::ZERO);
        let mut point1 = extent.slots([N::ZERO; D]);
        let mut point2 = extent.slots([N::ZERO; D]);
        let columns =
            ClosestColumns { distance: &mut distance, point1: &mut point1, point2: &mut point2 };
        batch.closest_points(convert(self.0), control, columns)?;
        Ok([Column::Numbers(distance), Column::Vectors(point1), Column::Vectors(point2)])
    }
}

/// Witnesses up to a distance.
pub(crate) struct Witnesses(pub(crate) f64);

impl Question for Witnesses {
    type Columns<N: Numeric<D>, const D: usize> = [Column<N, D>; 6];

    fn class(&self) -> Option<&'static Class> {
        Some(&WITNESS)
    }

    fn limit(&self) -> (&'static str, f64) {
        ("max_distance", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        extent: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError> {
        let mut distance = extent.slots(N::ZERO);
        let mut point1 = extent.slots([N::ZERO; D]);
        let (mut point2, mut normal) = (extent.slots([N::ZERO; D]), extent.slots([N::ZERO; D]));
        let (mut part1, mut part2) = (extent.slots(0), extent.slots(0));
        let columns = WitnessColumns {
            distance: &mut distance,
            point1: &mut point1,
            point2: &mut point2,
            normal: &mut normal,
            part1: &mut part1,
            part2: &mut part2,
            ..Default::default()
        };
        batch.witnesses(convert(self.0), control, columns)?;
        Ok([
            Column::Numbers(distance),
            Column::Vectors(point1),
            Column::Vectors(point2),
            Column::Vectors(normal),
            Column::Indices(part1),
            Column::Indices(part2),
        ])
    }
}

/// Proximities with a margin, as 0 (intersecting), 1 (within the margin) and 2 (disjoint).
pub(crate) struct Proximities(pub(crate) f64);

impl Question for Proximities {
    type Columns<N: Numeric<D>, const D: usize> = [Column<N, D>; 1];

    fn class(&self) -> Option<&'static Class> {
        None
    }

    fn limit(&self) -> (&'static str, f64) {
        ("margin", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        extent: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError> {
        let mut found = extent.slots(Proximity::Disjoint);
        batch.proximities(convert(self.0), control, &mut found)?;
        let code = |proximity| match proximity {
            Proximity::Intersecting => 0,
            Proximity::WithinMargin => 1,
            Proximity::Disjoint => 2,
        };
        Ok([Column::Codes(found.map(code))])
    }
}

/// Contacts up to a prediction.
pub(crate) struct Contacts(pub(crate) f64);

impl Question for Contacts {
    type Columns<N: Numeric<D>, const D: usize> = [Column<N, D>; 4];

    fn class(&self) -> Option<&'static Class> {
        Some(&CONTACT)
    }

    fn limit(&self) -> (&'static str, f64) {
        ("prediction", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        extent: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError> {
        let mut depth = extent.slots(N::ZERO);
        let mut point1 = extent.slots([N::ZERO; D]);
        let (mut point2, mut normal) = (extent.slots([N::ZERO; D]), extent.slots([N::ZERO; D]));
        let columns = ContactColumns {
            depth: &mut depth,
            normal: &mut normal,
            point1: &mut point1,
            point2: &mut point2,
        };
        batch.contacts(convert(self.0), control, columns)?;
        Ok([
            Column::Numbers(depth),
            Column::Vectors(normal),
            Column::Vectors(point1),
            Column::Vectors(point2),
        ])
    }
}

/// The nearest pair up to a distance: its index and distance; -1 and infinity if there is none.
pub(crate) struct Nearest(pub(crate) f64);

impl Question for Nearest {
    type Columns<N: Numeric<D>, const D: usize> = [Column<N, D>; 2];

    fn class(&self) -> Option<&'static Class> {
        Some(&NEAREST)
    }

    fn limit(&self) -> (&'static str, f64) {
        ("max_distance", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        _: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError> {
        let found = batch.nearest(convert(self.0), control)?;
        let (index, distance) = found.unwrap_or((usize::MAX, N::INFINITY));
        let index = i64::try_from(index).unwrap_or(-1);
        Ok([Column::Rows(Slots::One([index])), Column::Numbers(Slots::One([distance]))])
    }
}

/// Manifolds up to a prediction, with one row for each contact point.
pub(crate) struct Manifolds {
    pub(crate) prediction: f64,
    pub(crate) max_points: Option<usize>,
}

impl Question for Manifolds {
    type Columns<N: Numeric<D>, const D: usize> = [Column<N, D>; 8];

    fn class(&self) -> Option<&'static Class> {
        Some(&MANIFOLDS)
    }

    fn limit(&self) -> (&'static str, f64) {
        ("prediction", self.prediction)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        _: Extent,
        control: &Control<'_>,
    ) -> Result<Self::Columns<N, D>, BatchError> {
        let mut rows = ManifoldRows::new();
        let prediction = ContactPrediction::new(convert(self.prediction), N::ZERO, N::ZERO);
        batch.manifolds(&prediction, self.max_points, control, &mut rows)?;
        let ManifoldRows { starts, manifold, point1, point2, normal, depth, part1, part2, .. } =
            rows;
        let starts = starts.into_iter().map(|start| i64::try_from(start).unwrap_or(i64::MAX));
        let [point1, point2, normal] =
            [point1, point2, normal].map(|column| Column::Vectors(column.into()));
        let [manifold, part1, part2] =
            [manifold, part1, part2].map(|column| Column::Indices(column.into()));
        let (starts, depth) = (Column::Rows(starts.collect()), Column::Numbers(depth.into()));
        Ok([starts, depth, normal, point1, point2, manifold, part1, part2])
    }
}

/// The two sides of a call, and its options.
pub(crate) struct PairCall<'a, 'py> {
    pub(crate) py: Python<'py>,
    pub(crate) sides: [SideArgument<'a, 'py>; 2],
    pub(crate) call: Call,
}

impl<'a, 'py> PairCall<'a, 'py> {
    pub(crate) fn new(
        [shape1, poses1, shape2, poses2]: [&'a Bound<'py, PyAny>; 4],
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
    ) -> Self {
        let side1 = SideArgument { shapes: shape1, poses: poses1, names: &["shape1", "poses1"] };
        let side2 = SideArgument { shapes: shape2, poses: poses2, names: &["shape2", "poses2"] };
        Self { py: shape1.py(), sides: [side1, side2], call: Call::new(threads, progress) }
    }

    /// Runs a query about the pairs.
    pub(crate) fn ask<Q: Question>(self, question: Q) -> PyResult<Bound<'py, PyAny>> {
        let (name, value) = question.limit();
        not_nan(name, value)?;
        let kind = kind_of(self.sides[0].shapes, "shape1")?;
        run_in(kind, Ask { call: self, question, kind })
    }

    /// Computes the first impact of each pair.
    pub(crate) fn ask_impacts(self, impacts: ImpactCall<'a, 'py>) -> PyResult<Bound<'py, PyAny>> {
        not_nan("max_time", impacts.max_time)?;
        not_nan("target_distance", impacts.target_distance)?;
        let kind = kind_of(self.sides[0].shapes, "shape1")?;
        if impacts.angular_velocities.iter().any(Option::is_some) {
            return run_in(kind, AskTurning { call: self, impacts, kind });
        }
        run_in(kind, AskImpacts { call: self, impacts, kind })
    }

    /// Computes the pairs of elements within `distance`: of both sides if `is_two_sided`, otherwise
    /// of the first side alone.
    pub(crate) fn ask_within(
        self,
        is_two_sided: bool,
        distance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let kind = kind_of(self.sides[0].shapes, "shape1")?;
        run_in(kind, AskWithin { call: self, is_two_sided, distance, kind })
    }
}

struct Ask<'a, 'py, Q> {
    call: PairCall<'a, 'py>,
    question: Q,
    kind: Kind,
}

impl<'py, Q: Question> Task for Ask<'_, 'py, Q> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let PairCall { py, sides: [side1, side2], call } = self.call;
        let (given1, given2) = (side1.read::<N, D>(self.kind)?, side2.read::<N, D>(self.kind)?);
        let (poses1, poses2) = (given1.poses()?, given2.poses()?);
        let batch = PairBatch::try_new(given1.side(&*poses1)?, given2.side(&*poses2)?);
        let batch = batch.map_err(|error| error::of_batch(&error, "poses2"))?;
        let is_lone = given1.is_lone() && given2.is_lone();
        let is_quick = given1.is_quick() && given2.is_quick();
        let extent = Extent::of(is_lone, is_quick, batch.len());
        let found =
            supervise(py, extent, &call, |control| self.question.answer(&batch, extent, control))?;
        let columns = found.map_err(|error| error::of_batch(&error, "poses2"))?;
        into_python(py, self.question.class(), columns)
    }
}

/// Impacts of shapes that move with constant velocities, without rotation.
struct Impacts<'a, N: Numeric<D>, const D: usize> {
    velocities: [&'a [[N; D]]; 2],
    options: ImpactOptions<N>,
}

impl<N: Numeric<D>, const D: usize> Impacts<'_, N, D> {
    fn answer(
        &self,
        batch: &PairBatch<'_, N, D>,
        extent: Extent,
        control: &Control<'_>,
    ) -> Result<[Column<N, D>; 5], BatchError> {
        let (mut time, mut status) = (extent.slots(N::ZERO), extent.slots(None));
        let mut point1 = extent.slots([N::ZERO; D]);
        let (mut point2, mut normal) = (extent.slots([N::ZERO; D]), extent.slots([N::ZERO; D]));
        let columns = ImpactColumns {
            time: &mut time,
            normal: &mut normal,
            point1: &mut point1,
            point2: &mut point2,
            status: &mut status,
            ..Default::default()
        };
        batch.impacts(self.velocities, &self.options, control, columns)?;
        let is_known = |status: ImpactStatus| status != ImpactStatus::StepsSpent;
        let is_reached = status.map(|status| status.is_some_and(is_known));
        Ok([
            Column::Numbers(time),
            Column::Vectors(normal),
            Column::Vectors(point1),
            Column::Vectors(point2),
            Column::Flags(is_reached),
        ])
    }
}

/// The velocities of both sides, and the limits.
pub(crate) struct ImpactCall<'a, 'py> {
    pub(crate) velocities: [&'a Bound<'py, PyAny>; 2],
    pub(crate) angular_velocities: [Option<&'a Bound<'py, PyAny>>; 2],
    pub(crate) max_time: f64,
    pub(crate) target_distance: f64,
}

/// Computes the impact of each pair, without rotation.
struct AskImpacts<'a, 'py> {
    call: PairCall<'a, 'py>,
    impacts: ImpactCall<'a, 'py>,
    kind: Kind,
}

impl<'py> Task for AskImpacts<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let PairCall { py, sides: [side1, side2], call } = self.call;
        let [velocity1, velocity2] = self.impacts.velocities;
        let velocity1 = Vectors::<N, D>::of(velocity1, "velocity1")?;
        let velocity2 = Vectors::<N, D>::of(velocity2, "velocity2")?;
        let (given1, given2) = (side1.read::<N, D>(self.kind)?, side2.read::<N, D>(self.kind)?);
        let (poses1, poses2) = (given1.poses()?, given2.poses()?);
        let (side1, mut side2) = (given1.side(&*poses1)?, given2.side(&*poses2)?);
        let velocities = [velocity1.rows()?, velocity2.rows()?];
        let len = common(&[
            ("poses1", side1.len()),
            ("poses2", side2.len()),
            ("velocity1", velocities[0].len()),
            ("velocity2", velocities[1].len()),
        ])?;
        // A batch takes its length from the sides alone: a single pair is repeated for each velocity.
        let repeated: Vec<_>;
        if len != 1 && [side1.len(), side2.len()] == [1, 1] {
            repeated = vec![poses2.pose(0); len];
            side2 = given2.side(&repeated)?;
        }
        let batch = PairBatch::try_new(side1, side2);
        let batch = batch.map_err(|error| error::of_batch(&error, "poses2"))?;
        let impacts = Impacts { velocities, options: self.impacts.options() };
        let is_lone =
            given1.is_lone() && given2.is_lone() && velocity1.is_lone() && velocity2.is_lone();
        let is_quick = given1.is_quick() && given2.is_quick();
        let extent = Extent::of(is_lone, is_quick, batch.len());
        let found =
            supervise(py, extent, &call, |control| impacts.answer(&batch, extent, control))?;
        let columns = found.map_err(|error| error::of_batch(&error, "velocities"))?;
        into_python(py, Some(&IMPACT), columns)
    }
}

/// Computes the pairs of elements within `distance`.
struct AskWithin<'a, 'py> {
    call: PairCall<'a, 'py>,
    is_two_sided: bool,
    distance: f64,
    kind: Kind,
}

impl<'py> Task for AskWithin<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let PairCall { py, sides: [side1, side2], call } = self.call;
        let (given1, given2) = (side1.read::<N, D>(self.kind)?, side2.read::<N, D>(self.kind)?);
        let (poses1, poses2) = (given1.poses()?, given2.poses()?);
        let (side1, side2) = (given1.side(&*poses1)?, given2.side(&*poses2)?);
        let (len, distance) = (side1.len().max(side2.len()), convert(self.distance));
        let found = supervise(py, Extent::Many(len), &call, |control| {
            if self.is_two_sided {
                pairs_within(&side1, &side2, distance, control)
            } else {
                pairs_within_one(&side1, distance, control)
            }
        })?;
        let pairs = found.map_err(|error| error::of_batch(&error, "poses1"))?;
        let rows = pairs.len();
        Ok(PyArray1::from_vec(py, pairs.into_flattened()).reshape([rows, 2])?.into_any())
    }
}
