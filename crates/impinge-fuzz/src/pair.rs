//! Queries about two shapes, in both orders.

use std::fmt::Debug;

use impinge::math::{AbstractRotation, Isometry, Pose, Space, max};
use impinge::query::{self, ClosestPoints, Proximity};
use impinge::shape::{Shape, ShapeHandle, ShapeKind};

use crate::place::Dimension;
use crate::shapes::{anatomy, is_unbounded, parts_of, reach, shape};
use crate::{Bytes, Task, dispatch};

/// Two placed shapes.
pub(crate) struct Pair<N: Space<D>, R, const D: usize> {
    pub(crate) m1: Isometry<N, R, D>,
    pub(crate) g1: ShapeHandle<N, D>,
    pub(crate) m2: Isometry<N, R, D>,
    pub(crate) g2: ShapeHandle<N, D>,
    /// Whether all numbers are moderate, so that results must be finite.
    pub(crate) is_moderate: bool,
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Copy, const D: usize> Pair<N, R, D> {
    pub(crate) fn from_bytes<M: Dimension<N, D, Turn = R>>(bytes: &mut Bytes<'_>) -> Self {
        let (g1, m1) = (shape::<N, M, D>(bytes), M::position(bytes));
        // Equal shapes and equal positions are more frequent than by chance.
        let g2 = if bytes.choice(8) == 0 { g1.clone() } else { shape::<N, M, D>(bytes) };
        let m2 = if bytes.choice(8) == 0 { m1 } else { M::position(bytes) };
        Self { m1, g1, m2, g2, is_moderate: bytes.is_moderate() }
    }

    pub(crate) fn swapped(&self) -> Self {
        Self {
            m1: self.m2,
            g1: self.g2.clone(),
            m2: self.m1,
            g2: self.g1.clone(),
            is_moderate: self.is_moderate,
        }
    }

    /// Returns whether both shapes and both poses are equal, so that their order is arbitrary. The
    /// rotation of a ball is ignored.
    pub(crate) fn are_same(&self) -> bool {
        let is_ball = self.g1.geometry().kind() == ShapeKind::Ball;
        let place = |m| if is_ball { Pose::unturned(m) } else { Pose::from_isometry(m) };
        let places = [&self.m1, &self.m2].map(|m| format!("{:?}", place(m)));
        places[0] == places[1] && anatomy(&*self.g1) == anatomy(&*self.g2)
    }

    /// Returns whether both poses are finite.
    pub(crate) fn is_placed(&self) -> bool {
        [&self.m1, &self.m2].iter().all(|m| Pose::from_isometry(*m).is_finite())
    }

    /// Checks that swapped arguments give the flipped result. If the shapes and poses are equal,
    /// the result may also be the same without a flip.
    pub(crate) fn check_flip<A: PartialEq + Debug>(
        &self,
        own: &A,
        other: &A,
        flip: impl Fn(&A) -> A,
    ) {
        if same(own, &flip(other)) || (self.are_same() && same(own, other)) {
            return;
        }
        panic!("\n{own:?}\nis not\n{other:?}\nswapped, of\n{self:?}");
    }

    /// Returns the tolerance for the rounding errors of a length: 256 epsilons of the sum of both
    /// positions and both extents.
    pub(crate) fn tolerance(&self) -> N {
        let places = [&self.m1, &self.m2]
            .iter()
            .fold(N::ZERO, |sum, m| m.translation.vector.iter().fold(sum, |sum, x| sum + x.abs()));
        N::EPSILON * N::lit(256.0) * (places + reach(&*self.g1) + reach(&*self.g2))
    }
}

impl<N: Space<D>, R: AbstractRotation<N, D>, const D: usize> Debug for Pair<N, R, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (m, g) in [(&self.m1, &self.g1), (&self.m2, &self.g2)] {
            writeln!(f, "{} at {:?}", anatomy(&**g), Pose::from_isometry(m))?;
        }
        Ok(())
    }
}

/// Returns whether both values are equal, or are equal when printed, as two NaN are.
pub(crate) fn same<A: PartialEq + Debug>(one: &A, other: &A) -> bool {
    one == other || format!("{one:?}") == format!("{other:?}")
}

#[derive(Clone, Copy)]
enum Question {
    Distance,
    ClosestPoints,
    Proximity,
    Contact,
    Witness,
}

impl Task for Question {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let pair = Pair::<N, M::Turn, D>::from_bytes::<M>(bytes);
        match self {
            Self::Distance => pair.check_distance(),
            Self::ClosestPoints => pair.check_closest_points(bytes.number()),
            Self::Proximity => pair.check_proximity(bytes.number()),
            Self::Contact => pair.check_contact(bytes.number()),
            Self::Witness => pair.check_witness(bytes.number()),
        }
    }
}

/// Fuzzes [`query::distance`].
pub fn distance(data: &[u8]) {
    dispatch(Question::Distance, data);
}

/// Fuzzes [`query::closest_points`].
pub fn closest_points(data: &[u8]) {
    dispatch(Question::ClosestPoints, data);
}

/// Fuzzes [`query::proximity`].
pub fn proximity(data: &[u8]) {
    dispatch(Question::Proximity, data);
}

/// Fuzzes [`query::contact`].
pub fn contact(data: &[u8]) {
    dispatch(Question::Contact, data);
}

/// Fuzzes [`query::witness`].
pub fn witness(data: &[u8]) {
    dispatch(Question::Witness, data);
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Copy, const D: usize> Pair<N, R, D> {
    fn shapes(&self) -> [&dyn Shape<N, D>; 2] {
        [&*self.g1, &*self.g2]
    }

    /// Returns whether both shapes are unbounded. If two half-spaces overlap without bound, the
    /// pair has no contact, or only a contact of other parts.
    fn may_be_endless(&self) -> bool {
        self.shapes().into_iter().all(is_unbounded)
    }

    pub(crate) fn distance(&self) -> N {
        query::distance(&self.m1, &*self.g1, &self.m2, &*self.g2)
    }

    pub(crate) fn closest_points(&self, limit: N) -> ClosestPoints<N, D> {
        query::closest_points(&self.m1, &*self.g1, &self.m2, &*self.g2, limit)
    }

    pub(crate) fn proximity(&self, margin: N) -> Proximity {
        query::proximity(&self.m1, &*self.g1, &self.m2, &*self.g2, margin)
    }

    pub(crate) fn contact(&self, prediction: N) -> Option<query::Contact<N, D>> {
        query::contact(&self.m1, &*self.g1, &self.m2, &*self.g2, prediction)
    }

    pub(crate) fn witness(&self, limit: N) -> Option<query::Witness<N, D>> {
        query::witness(&self.m1, &*self.g1, &self.m2, &*self.g2, limit)
    }

    fn check_distance(&self) {
        let distance = self.distance();
        self.check_flip(&distance, &self.swapped().distance(), |other| *other);
        assert!(distance >= N::ZERO, "{distance} of\n{self:?}");
        if !self.is_placed() {
            assert_eq!(distance, N::INFINITY, "nothing is there:\n{self:?}");
        }
        if !self.is_moderate {
            return;
        }
        let is_convex = self.shapes().iter().all(|shape| parts_of(*shape).is_none());
        assert!(distance.is_finite_number() || !is_convex, "{self:?}");
        let touches = distance == N::ZERO;
        assert_eq!(self.proximity(N::ZERO) == Proximity::Intersecting, touches, "{self:?}");
        let points = self.closest_points(N::INFINITY);
        assert_eq!(points == ClosestPoints::Intersecting, touches, "{points:?} of\n{self:?}");
        let has_contact = self.contact(N::ZERO).is_some();
        assert!(
            has_contact == touches || (touches && self.may_be_endless()),
            "{distance} {self:?}"
        );
    }

    fn check_closest_points(&self, limit: N) {
        let (points, distance) = (self.closest_points(limit), self.distance());
        self.check_flip(&points, &self.swapped().closest_points(limit), ClosestPoints::flipped);
        if !self.is_moderate {
            return;
        }
        let limit = max(limit, N::ZERO);
        let is_near = distance <= limit && self.is_placed();
        // A composite without parts has an infinite distance and no closest points, whatever the
        // limit.
        let is_nothing = distance == N::INFINITY && limit == N::INFINITY;
        let found = points != ClosestPoints::Disjoint;
        assert!(found == is_near || is_nothing, "{points:?} at {distance}, {limit}:\n{self:?}");
        let ClosestPoints::WithinMargin(point1, point2) = points else { return };
        assert!(same(&points, &self.closest_points(N::INFINITY)), "a limit changes:\n{self:?}");
        let error = ((point2 - point1).norm() - distance).abs();
        assert!(error <= self.tolerance(), "{points:?}, but {distance}:\n{self:?}");
    }

    fn check_proximity(&self, margin: N) {
        let (proximity, distance) = (self.proximity(margin), self.distance());
        self.check_flip(&proximity, &self.swapped().proximity(margin), |other| *other);
        let expected = if distance == N::ZERO {
            Proximity::Intersecting
        } else if distance <= margin {
            Proximity::WithinMargin
        } else {
            Proximity::Disjoint
        };
        if self.is_moderate {
            assert_eq!(proximity, expected, "{distance}, {margin}: {self:?}");
        }
    }

    fn check_contact(&self, prediction: N) {
        let contact = self.contact(prediction);
        let flip = |other: &Option<query::Contact<N, D>>| other.map(|contact| contact.flipped());
        self.check_flip(&contact, &self.swapped().contact(prediction), flip);
        let Some(contact) = contact else { return };
        assert!(self.is_placed() && contact.depth >= -prediction, "{contact:?} of\n{self:?}");
        if !self.is_moderate {
            return;
        }
        assert!(same(&Some(contact), &self.contact(N::INFINITY)), "a limit changes:\n{self:?}");
        let (depth, distance) = (contact.depth, self.distance());
        let is_distance = max(-depth, N::ZERO) == distance || self.may_be_endless();
        assert!(is_distance, "{contact:?}, {distance} of\n{self:?}");
        let length = contact.normal.norm();
        assert!((length - N::ONE).abs() <= N::EPSILON * N::lit(64.0), "{contact:?} of\n{self:?}");
        let error = contact.world2 - (contact.world1 - *contact.normal * depth);
        assert!(error.norm() <= self.tolerance(), "{contact:?} of\n{self:?}");
    }

    fn check_witness(&self, limit: N) {
        let witness = self.witness(limit);
        let flip = |other: &Option<query::Witness<N, D>>| other.map(|witness| witness.flipped());
        self.check_flip(&witness, &self.swapped().witness(limit), flip);
        let Some(witness) = witness else { return };
        assert!(self.is_placed() && witness.distance <= limit, "{witness:?} of\n{self:?}");
        for (part, shape) in [witness.part1, witness.part2].into_iter().zip(self.shapes()) {
            assert!(part < parts_of(shape).unwrap_or(1), "{witness:?} of\n{self:?}");
        }
        if self.is_moderate {
            let is_distance = max(witness.distance, N::ZERO) == self.distance();
            assert!(is_distance || self.may_be_endless(), "{witness:?} of\n{self:?}");
            let error = witness.point2 - (witness.point1 + *witness.normal * witness.distance);
            assert!(error.norm() <= self.tolerance(), "{witness:?} of\n{self:?}");
        }
    }
}
