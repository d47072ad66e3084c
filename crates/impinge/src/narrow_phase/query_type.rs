//! Query types: whether contacts or proximity are computed for the pairs of an object.

use crate::math::Real;

/// Kind of query that the narrow phase computes for the pairs of an object.
///
/// If either object of a pair has the type `Proximity`, only proximity is computed for the pair.
///
/// ```
/// use impinge::dim2::world::{ContactQuery, GeometricQueryType, ProximityQuery};
///
/// let (body, sensor) = (GeometricQueryType::Contacts(0.1_f32, 0.0), GeometricQueryType::Proximity(0.5));
/// assert_eq!((body.query_limit(), sensor.query_limit()), (0.1, 0.5));
/// // Equal types with named fields, which worlds take as well:
/// assert_eq!(body, ContactQuery::new(0.1).into());
/// assert_eq!(sensor, ProximityQuery { margin: 0.5 }.into());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum GeometricQueryType<N: Real> {
    /// Contacts: the linear prediction, and the angular prediction in radians.
    ///
    /// There are contact points while the solids penetrate, or are no farther apart than the *sum*
    /// of the linear predictions of both objects. The sum of the angular predictions adds points
    /// that would come within that distance if the solids rotated by up to that angle; a sum above
    /// a right angle is treated as a right angle.
    Contacts(N, N),
    /// Proximity: the margin. Solids farther apart than the *sum* of the margins are disjoint.
    ///
    /// An object of type `Contacts` adds nothing to the sum.
    Proximity(N),
}

/// [`GeometricQueryType::Contacts`] with named fields: requests contact points.
///
/// The default has no prediction: contact points exist where the solids touch or overlap.
///
/// ```
/// use impinge::dim3::prelude::*;
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
/// let at = |x| Isometry::translation(x, 0.0, 0.0);
/// world.add(at(0.0), ball.clone(), groups, ContactQuery::default(), ());
/// world.add(at(2.25), ball, groups, ContactQuery::new(0.25).with_angular_prediction(0.09), ());
/// world.update();
/// assert_eq!(world.contact_events().len(), 1, "as near as both predictions together");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactQuery<N: Real> {
    /// The object's contribution to the distance up to which there are contact points.
    pub prediction: N,
    /// The object's contribution, in radians, to the angular prediction of a pair. Points that come
    /// within the distance up to which there are contact points, if the solids rotate by up to that
    /// angle, are contact points too.
    pub angular_prediction: N,
}

/// [`GeometricQueryType::Proximity`] with a named field: reports whether solids are near, without
/// contact points.
///
/// The default has no margin: the margin of the other object alone determines whether a pair is
/// [`WithinMargin`](crate::query::Proximity::WithinMargin).
///
/// ```
/// use impinge::dim2::prelude::*;
///
/// let mut world = CollisionWorld::<f64, &str>::new(0.02);
/// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
/// world.add(Isometry::identity(), ball.clone(), groups, ProximityQuery::default(), "sensor");
/// let car = world.add(Isometry::translation(1.5, 0.0), ball, groups, ContactQuery::default(), "car");
/// world.update();
/// assert_eq!(world.proximity_events()[0].new_status, Proximity::Intersecting);
/// world.set_query_type(car, ProximityQuery { margin: 0.5 });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ProximityQuery<N: Real> {
    /// The object's contribution to the distance up to which a pair is within the margin.
    pub margin: N,
}

impl<N: Real> ContactQuery<N> {
    /// Requests contact points up to the distance `prediction`, without an angular prediction.
    #[must_use]
    pub const fn new(prediction: N) -> Self {
        Self { prediction, angular_prediction: N::ZERO }
    }

    /// Also keeps points that come within the prediction if the solids rotate by up to
    /// `angular_prediction` radians.
    #[must_use]
    pub const fn with_angular_prediction(self, angular_prediction: N) -> Self {
        Self { angular_prediction, ..self }
    }
}

impl<N: Real> ProximityQuery<N> {
    /// Requests proximity with this margin.
    #[must_use]
    pub const fn new(margin: N) -> Self {
        Self { margin }
    }
}

impl<N: Real> From<ContactQuery<N>> for GeometricQueryType<N> {
    fn from(query: ContactQuery<N>) -> Self {
        Self::Contacts(query.prediction, query.angular_prediction)
    }
}

impl<N: Real> From<ProximityQuery<N>> for GeometricQueryType<N> {
    fn from(query: ProximityQuery<N>) -> Self {
        Self::Proximity(query.margin)
    }
}

/// The query of a pair: predictions or margins summed over its two objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PairQuery<N: Real> {
    Contacts { linear: N, angular: N },
    Proximity { margin: N },
}

impl<N: Real> GeometricQueryType<N> {
    /// Returns the linear prediction or the margin. The broad phase grows the object's box by this
    /// distance.
    #[must_use]
    pub fn query_limit(&self) -> N {
        match *self {
            Self::Contacts(linear, _) => linear,
            Self::Proximity(margin) => margin,
        }
    }

    /// Returns the predictions with named fields; `None` for a proximity query.
    #[must_use]
    pub fn as_contacts(&self) -> Option<ContactQuery<N>> {
        match *self {
            Self::Contacts(prediction, angular_prediction) => {
                Some(ContactQuery { prediction, angular_prediction })
            }
            Self::Proximity(_) => None,
        }
    }

    /// Returns the margin with a named field; `None` for a contact query.
    #[must_use]
    pub fn as_proximity(&self) -> Option<ProximityQuery<N>> {
        match *self {
            Self::Proximity(margin) => Some(ProximityQuery { margin }),
            Self::Contacts(..) => None,
        }
    }

    /// Returns the query of a pair of objects with these types: proximity if either type is
    /// `Proximity`.
    pub(crate) fn pair(self, other: Self) -> PairQuery<N> {
        match (self, other) {
            (Self::Contacts(linear1, angular1), Self::Contacts(linear2, angular2)) => {
                PairQuery::Contacts { linear: linear1 + linear2, angular: angular1 + angular2 }
            }
            (Self::Proximity(margin), Self::Contacts(..))
            | (Self::Contacts(..), Self::Proximity(margin)) => PairQuery::Proximity { margin },
            (Self::Proximity(margin1), Self::Proximity(margin2)) => {
                PairQuery::Proximity { margin: margin1 + margin2 }
            }
        }
    }

    /// Returns the first number that is negative or not finite; `None` if all numbers are valid.
    pub(crate) fn bad_number(&self) -> Option<N> {
        let numbers = match *self {
            Self::Contacts(linear, angular) => [linear, angular],
            Self::Proximity(margin) => [margin, N::ZERO],
        };
        numbers.into_iter().find(|x| !x.is_finite_number() || *x < N::ZERO)
    }
}

/// A query type as two numbers: both predictions, or the margin and −1. The numbers of a query type
/// are never negative, so −1 identifies a proximity query.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PackedQuery<N: Real>([N; 2]);

impl<N: Real> PackedQuery<N> {
    pub(crate) fn new(query: GeometricQueryType<N>) -> Self {
        match query {
            GeometricQueryType::Contacts(linear, angular) => Self([linear, angular]),
            GeometricQueryType::Proximity(margin) => Self([margin, -N::ONE]),
        }
    }

    /// Returns the query type.
    #[inline]
    pub(crate) fn get(self) -> GeometricQueryType<N> {
        let [first, second] = self.0;
        if second < N::ZERO {
            return GeometricQueryType::Proximity(first);
        }
        GeometricQueryType::Contacts(first, second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_and_unpacked() {
        use GeometricQueryType::{Contacts, Proximity};
        for query in [Contacts(0.0, 0.0), Contacts(0.5_f32, 2.0), Proximity(0.0), Proximity(3.0)] {
            assert_eq!(PackedQuery::new(query).get(), query);
        }
    }

    #[test]
    fn sums_and_precedence() {
        use GeometricQueryType::{Contacts, Proximity};
        let contacts = Contacts(0.25_f32, 0.5);
        assert_eq!(
            contacts.pair(Contacts(0.5, 0.0)),
            PairQuery::Contacts { linear: 0.75, angular: 0.5 },
            "both predictions add"
        );
        let near = PairQuery::Proximity { margin: 2.0 };
        assert_eq!(contacts.pair(Proximity(2.0)), near, "proximity wins");
        assert_eq!(Proximity(2.0).pair(contacts), near, "in both orders");
        assert_eq!(Proximity(1.5).pair(Proximity(0.5)), near, "margins add");
    }

    #[test]
    fn bad_numbers_are_found() {
        assert_eq!(GeometricQueryType::Contacts(0.0_f32, 0.0).bad_number(), None, "zero is fine");
        assert_eq!(GeometricQueryType::Contacts(0.0_f32, -1.0).bad_number(), Some(-1.0), "angle");
        assert!(GeometricQueryType::Proximity(f64::NAN).bad_number().is_some(), "NaN");
    }
}
