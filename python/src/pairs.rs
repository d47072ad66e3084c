//! Questions about pairs: one shape or many against one or many.

use impinge::batch::{
    BatchError, ClosestColumns, ContactColumns, Control, ImpactColumns, ManifoldRows, PairBatch,
    WitnessColumns, pairs_within, pairs_within_one,
};
use impinge::math::na::convert;
use impinge::narrow_phase::ContactPrediction;
use impinge::query::{ImpactOptions, ImpactStatus, Proximity};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

use crate::answer::{Column, into_python};
use crate::error::{self, not_nan};
use crate::shapes::kind_of;
use crate::side::SideArgument;
use crate::space::{Kind, Numeric, Task, run_in};
use crate::supervise::{Call, Threads, supervise};
use crate::turning::AskTurning;
use crate::vectors::Vectors;

/// A question about every pair of a batch.
pub(crate) trait Question: Sync {
    /// The class of the answers in `impinge._results`; without, the only column is the answer.
    const CLASS: Option<&'static str>;

    /// What limits the answers, and its name in Python.
    fn limit(&self) -> (&'static str, f64);

    /// Answers as columns.
    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError>;
}

pub(crate) struct Distances;

impl Question for Distances {
    const CLASS: Option<&'static str> = None;

    fn limit(&self) -> (&'static str, f64) {
        ("", 0.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let mut distance = vec![N::ZERO; batch.len()];
        batch.distances(control, &mut distance)?;
        Ok(vec![Column::Numbers(distance)])
    }
}

/// Nearest points up to a distance.
pub(crate) struct Closest(pub(crate) f64);

impl Question for Closest {
    const CLASS: Option<&'static str> = Some("ClosestPoints");

    fn limit(&self) -> (&'static str, f64) {
        ("max_distance", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let (len, zeros) = (batch.len(), [N::ZERO; D]);
        let (mut distance, mut point1, mut point2) =
            (vec![N::ZERO; len], vec![zeros; len], vec![zeros; len]);
        let columns =
            ClosestColumns { distance: &mut distance, point1: &mut point1, point2: &mut point2 };
        batch.closest_points(convert(self.0), control, columns)?;
        Ok(vec![Column::Numbers(distance), Column::Vectors(point1), Column::Vectors(point2)])
    }
}

/// Witnesses up to a distance.
pub(crate) struct Witnesses(pub(crate) f64);

impl Question for Witnesses {
    const CLASS: Option<&'static str> = Some("Witness");

    fn limit(&self) -> (&'static str, f64) {
        ("max_distance", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let (len, zeros) = (batch.len(), [N::ZERO; D]);
        let mut distance = vec![N::ZERO; len];
        let [mut point1, mut point2, mut normal] = [(); 3].map(|()| vec![zeros; len]);
        let [mut part1, mut part2] = [(); 2].map(|()| vec![0; len]);
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
        let [point1, point2, normal] = [point1, point2, normal].map(Column::Vectors);
        let [part1, part2] = [part1, part2].map(Column::Indices);
        Ok(vec![Column::Numbers(distance), point1, point2, normal, part1, part2])
    }
}

/// Proximities with a margin, as 0 (intersecting), 1 (within the margin) and 2 (disjoint).
pub(crate) struct Proximities(pub(crate) f64);

impl Question for Proximities {
    const CLASS: Option<&'static str> = None;

    fn limit(&self) -> (&'static str, f64) {
        ("margin", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let mut found = vec![Proximity::Disjoint; batch.len()];
        batch.proximities(convert(self.0), control, &mut found)?;
        let code = |proximity| match proximity {
            Proximity::Intersecting => 0,
            Proximity::WithinMargin => 1,
            Proximity::Disjoint => 2,
        };
        Ok(vec![Column::Codes(found.into_iter().map(code).collect())])
    }
}

/// Contacts up to a prediction.
pub(crate) struct Contacts(pub(crate) f64);

impl Question for Contacts {
    const CLASS: Option<&'static str> = Some("Contact");

    fn limit(&self) -> (&'static str, f64) {
        ("prediction", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let (len, zeros) = (batch.len(), [N::ZERO; D]);
        let mut depth = vec![N::ZERO; len];
        let [mut point1, mut point2, mut normal] = [(); 3].map(|()| vec![zeros; len]);
        let columns = ContactColumns {
            depth: &mut depth,
            normal: &mut normal,
            point1: &mut point1,
            point2: &mut point2,
        };
        batch.contacts(convert(self.0), control, columns)?;
        let [point1, point2, normal] = [point1, point2, normal].map(Column::Vectors);
        Ok(vec![Column::Numbers(depth), normal, point1, point2])
    }
}

/// The nearest pair up to a distance: its index and distance.
pub(crate) struct Nearest(pub(crate) f64);

impl Question for Nearest {
    const CLASS: Option<&'static str> = Some("Nearest");

    fn limit(&self) -> (&'static str, f64) {
        ("max_distance", self.0)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let found = batch.nearest(convert(self.0), control)?;
        let (index, distance) = found.unwrap_or((usize::MAX, N::INFINITY));
        let index = i64::try_from(index).unwrap_or(-1);
        Ok(vec![Column::Rows(vec![index]), Column::Numbers(vec![distance])])
    }
}

/// Manifolds up to a prediction, as rows.
pub(crate) struct Manifolds {
    pub(crate) prediction: f64,
    pub(crate) max_points: Option<usize>,
}

impl Question for Manifolds {
    const CLASS: Option<&'static str> = Some("Manifolds");

    fn limit(&self) -> (&'static str, f64) {
        ("prediction", self.prediction)
    }

    fn answer<N: Numeric<D>, const D: usize>(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let mut rows = ManifoldRows::new();
        let prediction = ContactPrediction::new(convert(self.prediction), N::ZERO, N::ZERO);
        batch.manifolds(&prediction, self.max_points, control, &mut rows)?;
        let ManifoldRows { starts, manifold, point1, point2, normal, depth, part1, part2, .. } =
            rows;
        let starts = starts.into_iter().map(|start| i64::try_from(start).unwrap_or(i64::MAX));
        let [point1, point2, normal] = [point1, point2, normal].map(Column::Vectors);
        let [manifold, part1, part2] = [manifold, part1, part2].map(Column::Indices);
        let starts = Column::Rows(starts.collect());
        Ok(vec![starts, Column::Numbers(depth), normal, point1, point2, manifold, part1, part2])
    }
}

/// The two sides of a call, and how it is to be done.
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
        let side1 = SideArgument { shapes: shape1, poses: poses1, names: ["shape1", "poses1"] };
        let side2 = SideArgument { shapes: shape2, poses: poses2, names: ["shape2", "poses2"] };
        Self { py: shape1.py(), sides: [side1, side2], call: Call::new(threads, progress) }
    }

    /// Asks about the pairs.
    pub(crate) fn ask<Q: Question>(self, question: Q, form: Form) -> PyResult<Bound<'py, PyAny>> {
        let (name, value) = question.limit();
        not_nan(name, value)?;
        let kind = kind_of(self.sides[0].shapes, "shape1")?;
        run_in(kind, Ask { call: self, question, form, kind })
    }

    /// Asks when the shapes of each pair meet.
    pub(crate) fn ask_impacts(self, impacts: ImpactCall<'a, 'py>) -> PyResult<Bound<'py, PyAny>> {
        not_nan("max_time", impacts.max_time)?;
        not_nan("target_distance", impacts.target_distance)?;
        let kind = kind_of(self.sides[0].shapes, "shape1")?;
        if impacts.angular_velocities.iter().any(Option::is_some) {
            return run_in(kind, AskTurning { call: self, impacts, kind });
        }
        run_in(kind, AskImpacts { call: self, impacts, kind })
    }

    /// Asks which elements are near each other; without `is_two_sided` those of the first side.
    pub(crate) fn ask_within(
        self,
        is_two_sided: bool,
        distance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let kind = kind_of(self.sides[0].shapes, "shape1")?;
        run_in(kind, AskWithin { call: self, is_two_sided, distance, kind })
    }
}

/// Whether an answer is a row of scalars or columns.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// Scalars for a lone pair, else columns.
    ByArguments,
    /// Columns.
    Columns,
    /// One answer about all pairs.
    Single,
}

struct Ask<'a, 'py, Q> {
    call: PairCall<'a, 'py>,
    question: Q,
    form: Form,
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
        let found =
            supervise(py, batch.len(), &call, |control| self.question.answer(&batch, control))?;
        let columns = found.map_err(|error| error::of_batch(&error, "poses2"))?;
        let is_lone = match self.form {
            Form::ByArguments => given1.is_lone() && given2.is_lone(),
            Form::Columns => false,
            Form::Single => true,
        };
        into_python(py, Q::CLASS, columns, is_lone)
    }
}

/// Impacts on straight ways.
struct Impacts<'a, N: Numeric<D>, const D: usize> {
    velocities: [&'a [[N; D]]; 2],
    options: ImpactOptions<N>,
}

impl<N: Numeric<D>, const D: usize> Impacts<'_, N, D> {
    fn answer(
        &self,
        batch: &PairBatch<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Column<N, D>>, BatchError> {
        let (len, zeros) = (batch.len(), [N::ZERO; D]);
        let (mut time, mut status) = (vec![N::ZERO; len], vec![None; len]);
        let [mut point1, mut point2, mut normal] = [(); 3].map(|()| vec![zeros; len]);
        let columns = ImpactColumns {
            time: &mut time,
            normal: &mut normal,
            point1: &mut point1,
            point2: &mut point2,
            status: &mut status,
            ..Default::default()
        };
        batch.impacts(self.velocities, &self.options, control, columns)?;
        let is_reached = status.into_iter().map(|status| status == Some(ImpactStatus::Reached));
        let [point1, point2, normal] = [point1, point2, normal].map(Column::Vectors);
        let is_reached = Column::Flags(is_reached.collect());
        Ok(vec![Column::Numbers(time), normal, point1, point2, is_reached])
    }
}

/// How the shapes of pairs move, and up to when.
pub(crate) struct ImpactCall<'a, 'py> {
    pub(crate) velocities: [&'a Bound<'py, PyAny>; 2],
    pub(crate) angular_velocities: [Option<&'a Bound<'py, PyAny>>; 2],
    pub(crate) max_time: f64,
    pub(crate) target_distance: f64,
}

/// Asks when the shapes of each pair meet on straight ways.
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
        let batch = PairBatch::try_new(given1.side(&*poses1)?, given2.side(&*poses2)?);
        let batch = batch.map_err(|error| error::of_batch(&error, "poses2"))?;
        let options = self.impacts.options();
        let impacts = Impacts { velocities: [velocity1.rows()?, velocity2.rows()?], options };
        let found = supervise(py, batch.len(), &call, |control| impacts.answer(&batch, control))?;
        let columns = found.map_err(|error| error::of_batch(&error, "velocities"))?;
        let is_lone =
            given1.is_lone() && given2.is_lone() && velocity1.is_lone() && velocity2.is_lone();
        into_python(py, Some("Impact"), columns, is_lone)
    }
}

/// Asks which elements are near each other.
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
        let found = supervise(py, len, &call, |control| {
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
