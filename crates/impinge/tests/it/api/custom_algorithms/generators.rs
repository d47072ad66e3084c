//! A custom contact algorithm, which computes the contacts of two balls and leaves all other solids
//! to the library.

use super::dim::math::{DIM, Isometry, Point, Real, Unit};
use super::dim::narrow_phase::{
    ContactAlgorithm, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
    DefaultContactDispatcher, IdAllocator,
};
use super::dim::query::{
    Contact, ContactId, ContactKinematic, ContactManifold, ContactSide, TrackedContact,
};
use super::dim::shape::{Ball, FeatureId, Shape};
use super::standalone::{at, vector};

/// The contacts of two balls; `update` returns `false` for all other solids.
#[derive(Clone, Debug, Default)]
pub(super) struct OwnBalls<N: Real> {
    /// Identifier of the pair in contact ids, once it has been allocated.
    pair: Option<u64>,
    /// Number of times that the balls have begun to touch.
    touches: u32,
    manifold: ContactManifold<N>,
}

impl<N: Real> OwnBalls<N> {
    fn contact((ma, a): (&Isometry<N>, &Ball<N>), (mb, b): (&Isometry<N>, &Ball<N>)) -> Contact<N> {
        let (center1, center2) = (ma.translation.vector, mb.translation.vector);
        let normal = Unit::new_normalize(center2 - center1);
        let world1 = Point::from(center1 + normal.into_inner() * a.radius());
        let world2 = Point::from(center2 - normal.into_inner() * b.radius());
        Contact { world1, world2, normal, depth: (world1 - world2).dot(&normal) }
    }
}

impl<N: Real> ContactManifoldGenerator<N, DIM> for OwnBalls<N> {
    fn update(
        &mut self,
        _: &dyn ContactDispatcher<N, DIM>,
        ma: &Isometry<N>,
        a: &dyn Shape<N, DIM>,
        mb: &Isometry<N>,
        b: &dyn Shape<N, DIM>,
        prediction: &ContactPrediction<N>,
        ids: &mut IdAllocator,
    ) -> bool {
        let (Some(a), Some(b)) = (a.as_shape::<Ball<N>>(), b.as_shape::<Ball<N>>()) else {
            self.manifold = ContactManifold::default();
            return false;
        };
        let contact = Self::contact((ma, a), (mb, b));
        if -contact.depth > prediction.linear() {
            self.manifold = ContactManifold::default();
            return true;
        }
        if self.manifold.is_empty() {
            self.touches += 1;
        }
        let side = |ball: &Ball<N>| ContactSide {
            rounding: ball.radius(),
            ..ContactSide::point(FeatureId::Face(0))
        };
        let kinematic = ContactKinematic::from_contact(&contact, (ma, side(a)), (mb, side(b)));
        let pair = *self.pair.get_or_insert_with(|| ids.allocate());
        let id = ContactId::new(pair, self.touches);
        self.manifold = ContactManifold::from_contacts([TrackedContact {
            contact,
            kinematic,
            id,
            part1: 0,
            part2: 0,
        }]);
        true
    }

    fn num_contacts(&self) -> usize {
        self.manifold.len()
    }

    fn contacts<'a>(&'a self, out: &mut Vec<&'a ContactManifold<N>>) {
        out.extend((!self.manifold.is_empty()).then_some(&self.manifold));
    }

    fn boxed_clone(&self) -> ContactAlgorithm<N> {
        Box::new(self.clone())
    }
}

/// The algorithms that the custom dispatcher assigns to pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Policy {
    /// [`OwnBalls`] for two balls, the library's boxed algorithm for other pairs.
    Balls,
    /// [`OwnBalls`] for all pairs, although its `update` returns `false` for most of them.
    OnlyBalls,
    /// No algorithm.
    Nothing,
}

impl<N: Real> ContactDispatcher<N, DIM> for Policy {
    fn get_contact_algorithm(
        &self,
        a: &dyn Shape<N, DIM>,
        b: &dyn Shape<N, DIM>,
    ) -> Option<ContactAlgorithm<N>> {
        let balls = a.as_shape::<Ball<N>>().is_some() && b.as_shape::<Ball<N>>().is_some();
        match self {
            Self::Nothing => None,
            Self::Balls if !balls => DefaultContactDispatcher::new().get_contact_algorithm(a, b),
            _ => Some(Box::new(OwnBalls::default())),
        }
    }
}

/// Asserts that a kinematic made from public parts reproduces the contact at the poses for which it
/// was made. If the second ball moves by a quarter turn around the first and 0.5 farther away, the
/// normal must turn by a quarter and the depth fall from 0.25 to -0.25.
fn own_kinematics<N: Real>() {
    let (ball1, ball2) = (Ball::new(N::ONE), Ball::new(N::HALF));
    let (here, there) = (at::<N>(0.0, 0.0), at::<N>(1.25, 0.0));
    let (mut own, mut ids) = (OwnBalls::default(), IdAllocator::new());
    let prediction = ContactPrediction::new(N::ZERO, N::ZERO, N::ZERO);
    let policy = Policy::Balls;
    assert!(own.update(&policy, &here, &ball1, &there, &ball2, &prediction, &mut ids), "balls");
    let tracked = *own.manifold.deepest_contact().expect("a contact");
    assert_eq!(tracked.kinematic.contact(&here, &there), tracked.contact, "gives it back");
    assert_eq!(tracked.contact.depth, N::lit(0.25), "by hand");
    let moved = tracked.kinematic.contact(&here, &at(0.0, 1.75));
    assert_eq!(moved.depth, N::lit(-0.25), "a quarter round and away");
    assert_eq!(moved.normal.into_inner(), vector(0.0, 1.0), "a quarter round");
}

#[test]
fn contacts_from_public_parts() {
    own_kinematics::<f32>();
    own_kinematics::<f64>();
}
