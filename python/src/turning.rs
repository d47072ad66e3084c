//! Impacts of moving and rotating solids.

use impinge::math::na::convert;
use impinge::math::{Real, Space, Vector};
use impinge::query::{
    ConstantVelocities, Impact, ImpactOptions, ImpactStatus, RigidMotion, nonlinear_time_of_impact,
};
use impinge::shape::ShapeHandle;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;

use crate::answer::{Column, Extent, IMPACT, into_python};
use crate::pairs::{ImpactCall, PairCall};
use crate::space::{Kind, Numeric, Task};
use crate::supervise::each;
use crate::vectors::Vectors;

/// A scalar and a dimension in which bodies may rotate.
pub(crate) trait Turning<const D: usize>: Space<D> {
    /// The number of components of an angular velocity.
    const ANGULAR: usize;

    /// Returns a motion with constant velocities; `angular` has [`Self::ANGULAR`] components.
    fn motion(
        position: Self::Isometry,
        linear: Vector<Self, D>,
        angular: &[Self],
    ) -> Box<dyn RigidMotion<Self, D>>;
}

impl<N: Real> Turning<2> for N {
    const ANGULAR: usize = 1;

    fn motion(
        position: <N as Space<2>>::Isometry,
        linear: Vector<N, 2>,
        angular: &[N],
    ) -> Box<dyn RigidMotion<N, 2>> {
        Box::new(ConstantVelocities::<N, 2>::new(position, linear, angular[0]))
    }
}

impl<N: Real> Turning<3> for N {
    const ANGULAR: usize = 3;

    fn motion(
        position: <N as Space<3>>::Isometry,
        linear: Vector<N, 3>,
        angular: &[N],
    ) -> Box<dyn RigidMotion<N, 3>> {
        let angular = Vector::<N, 3>::from_fn(|axis, _| angular[axis]);
        Box::new(ConstantVelocities::<N, 3>::new(position, linear, angular))
    }
}

/// Angular velocities as an argument: (n, 1) in 2D, (n, 3) in 3D; `None` is zero.
struct Angular<'py, N: Numeric<D>, const D: usize> {
    rows: Option<PyReadonlyArrayDyn<'py, N>>,
    is_lone: bool,
}

impl<'py, N: Numeric<D>, const D: usize> Angular<'py, N, D> {
    fn of(given: Option<&Bound<'py, PyAny>>, name: &str) -> PyResult<Self> {
        let Some(given) = given else { return Ok(Self { rows: None, is_lone: true }) };
        let py = given.py();
        let reader = py.import("impinge._poses")?.getattr("angular_velocities")?;
        let read = reader.call1((given, D, N::get_dtype(py), name))?;
        let (rows, is_lone) = read.extract::<(Bound<'py, PyAny>, bool)>()?;
        Ok(Self { rows: Some(rows.cast::<PyArrayDyn<N>>()?.try_readonly()?), is_lone })
    }

    /// Returns all numbers, row by row; one row of zeros for a missing argument.
    fn numbers(&self) -> PyResult<Vec<N>> {
        Ok(match &self.rows {
            None => vec![N::ZERO; <N as Turning<D>>::ANGULAR],
            Some(rows) => rows.as_slice()?.to_vec(),
        })
    }
}

/// The bodies on one side of all pairs. A list of length one is used for all pairs.
struct Bodies<'a, N: Numeric<D>, const D: usize> {
    shapes: Vec<&'a ShapeHandle<N, D>>,
    positions: Vec<N::Isometry>,
    linear: &'a [[N; D]],
    angular: Vec<N>,
}

impl<N: Numeric<D>, const D: usize> Bodies<'_, N, D> {
    /// Returns the names and lengths of the arguments; an argument of length one is used for all
    /// elements.
    fn lengths(&self, [poses, linear, angular]: [&'static str; 3]) -> [(&'static str, usize); 3] {
        let turns = self.angular.len() / <N as Turning<D>>::ANGULAR;
        [(poses, self.positions.len()), (linear, self.linear.len()), (angular, turns)]
    }

    fn motion(&self, element: usize) -> Box<dyn RigidMotion<N, D>> {
        let at = |len: usize| if len == 1 { 0 } else { element };
        let width = <N as Turning<D>>::ANGULAR;
        let begin = at(self.angular.len() / width) * width;
        let linear = Vector::from(self.linear[at(self.linear.len())]);
        let position = self.positions[at(self.positions.len())];
        N::motion(position, linear, &self.angular[begin..begin + width])
    }

    fn shape(&self, element: usize) -> &ShapeHandle<N, D> {
        self.shapes[if self.shapes.len() == 1 { 0 } else { element }]
    }
}

/// Computes the impacts of moving and rotating bodies.
pub(crate) struct AskTurning<'a, 'py> {
    pub(crate) call: PairCall<'a, 'py>,
    pub(crate) impacts: ImpactCall<'a, 'py>,
    pub(crate) kind: Kind,
}

impl<'py> Task for AskTurning<'_, 'py> {
    type Answer = Bound<'py, PyAny>;

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let Self { call: PairCall { py, sides, call }, impacts, kind } = self;
        let [linear1, linear2] = impacts.velocities;
        let (linear1, linear2) = (
            Vectors::<N, D>::of(linear1, "velocity1")?,
            Vectors::<N, D>::of(linear2, "velocity2")?,
        );
        let [angular1, angular2] = impacts.angular_velocities;
        let angular1 = Angular::<N, D>::of(angular1, "angular_velocity1")?;
        let angular2 = Angular::<N, D>::of(angular2, "angular_velocity2")?;
        let (given1, given2) = (sides[0].read::<N, D>(kind)?, sides[1].read::<N, D>(kind)?);
        let bodies1 = Bodies {
            shapes: given1.elements()?.shapes,
            positions: given1.elements()?.positions,
            linear: linear1.rows()?,
            angular: angular1.numbers()?,
        };
        let bodies2 = Bodies {
            shapes: given2.elements()?.shapes,
            positions: given2.elements()?.positions,
            linear: linear2.rows()?,
            angular: angular2.numbers()?,
        };
        let lengths = [
            bodies1.lengths(["poses1", "velocity1", "angular_velocity1"]),
            bodies2.lengths(["poses2", "velocity2", "angular_velocity2"]),
        ];
        let len = crate::side::common(&lengths.concat())?;
        let options = impacts.options::<N>();
        let found = each(py, len, &call, |element| {
            let (motion1, motion2) = (bodies1.motion(element), bodies2.motion(element));
            let (shape1, shape2) = (bodies1.shape(element), bodies2.shape(element));
            nonlinear_time_of_impact(&*motion1, &**shape1, &*motion2, &**shape2, &options)
        })?;
        let is_lone = [given1.is_lone(), given2.is_lone(), linear1.is_lone(), linear2.is_lone()];
        let is_lone = is_lone.into_iter().all(|it| it) && angular1.is_lone && angular2.is_lone;
        into_python(py, Some(&IMPACT), columns(&found, Extent::of(is_lone, false, len)))
    }
}

/// Returns the columns of `Impact`: time, normal, both points, and whether the search reached the
/// target distance. It did not if there is no impact, or if the steps were spent before.
fn columns<N: Numeric<D>, const D: usize>(
    found: &[Option<Impact<N, D>>],
    extent: Extent,
) -> [Column<N, D>; 5] {
    let mut time = extent.slots(N::INFINITY);
    let [mut normal, mut point1, mut point2] =
        [(); 3].map(|()| extent.slots([N::lit(f64::NAN); D]));
    let mut is_reached = extent.slots(false);
    for (slot, impact) in found.iter().enumerate() {
        let Some(impact) = impact else { continue };
        time[slot] = impact.toi;
        normal[slot] = (*impact.normal).into();
        point1[slot] = impact.world1.coords.into();
        point2[slot] = impact.world2.coords.into();
        is_reached[slot] = impact.status != ImpactStatus::StepsSpent;
    }
    let [normal, point1, point2] = [normal, point1, point2].map(Column::Vectors);
    [Column::Numbers(time), normal, point1, point2, Column::Flags(is_reached)]
}

impl ImpactCall<'_, '_> {
    /// Returns the limits in the form of the library.
    pub(crate) fn options<N: Real>(&self) -> ImpactOptions<N> {
        ImpactOptions::new()
            .with_max_time(convert(self.max_time))
            .with_target_distance(convert(self.target_distance))
    }
}
