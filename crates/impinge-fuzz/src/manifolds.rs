//! Contact manifolds of a pair over several motions.

use std::collections::BTreeSet;

use impinge::math::{Isometry, Real, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, IdAllocator,
    PairManifoldGenerator,
};
use impinge::query::{ContactId, TrackedContact};

use crate::pair::Pair;
use crate::place::Dimension;
use crate::shapes::parts_of;
use crate::{Bytes, Task, dispatch};

struct Manifolds;

impl Task for Manifolds {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let mut pair = Pair::<N, M::Turn, D>::from_bytes::<M>(bytes);
        let max_points = bytes.choice(9);
        let mut orders = [Kept::new(max_points), Kept::new(max_points)];
        let linear = if bytes.is_moderate() { bytes.size() } else { bytes.number() };
        let prediction = ContactPrediction::new(linear, bytes.number(), bytes.number());
        let mut were_same = false;
        for _ in 0..2 + bytes.choice(6) {
            let contacts = orders[0].update::<M>(&pair, &prediction);
            let swapped = orders[1].update::<M>(&pair.swapped(), &prediction);
            were_same |= pair.are_same();
            if !were_same {
                check_order(&pair, &contacts, &swapped);
            }
            check_deepest(&pair, &contacts, linear);
            pair.m2 = nudged(&pair.m2, bytes);
        }
    }
}

/// Fuzzes [`PairManifoldGenerator`].
pub fn manifolds(data: &[u8]) {
    dispatch(Manifolds, data);
}

fn nudged<N: Real, R: Copy, const D: usize>(
    position: &Isometry<N, R, D>,
    bytes: &mut Bytes<'_>,
) -> Isometry<N, R, D> {
    let mut moved = *position;
    let step = bytes.choice(4);
    let by = bytes.vector::<N, D>() * N::lit([0.0, 0.0625, 0.001, 1.0][step]);
    moved.translation.vector += Vector::<N, D>::from_fn(|axis, _| by[axis]);
    moved
}

/// A generator and the ids that it assigned.
struct Kept<N: Real, const D: usize> {
    generator: PairManifoldGenerator<N, D>,
    ids: IdAllocator,
    alive: BTreeSet<ContactId>,
    ever: BTreeSet<ContactId>,
    max_points: usize,
}

impl<N: Space<D>, const D: usize> Kept<N, D> {
    fn new(max_points: usize) -> Self {
        Self {
            generator: PairManifoldGenerator::new(max_points),
            ids: IdAllocator::new(),
            alive: BTreeSet::new(),
            ever: BTreeSet::new(),
            max_points,
        }
    }

    /// Updates the generator. Checks that each manifold has at least one and at most `max_points`
    /// points, that contact ids are unique, and that ids of ended contacts do not return.
    fn update<M: Dimension<N, D>>(
        &mut self,
        pair: &Pair<N, M::Turn, D>,
        prediction: &ContactPrediction<N>,
    ) -> Vec<TrackedContact<N, D>> {
        let dispatcher = DefaultContactDispatcher::<D>::new();
        let (m1, m2) = (M::stored(pair.m1), M::stored(pair.m2));
        let (generator, ids) = (&mut self.generator, &mut self.ids);
        assert!(generator.update(&dispatcher, &m1, &*pair.g1, &m2, &*pair.g2, prediction, ids));
        let mut manifolds = Vec::new();
        self.generator.contacts(&mut manifolds);
        for manifold in &manifolds {
            let count = manifold.len();
            assert!(count > 0 && count <= self.max_points.max(1), "{count} points: {manifold:?}");
        }
        let contacts: Vec<TrackedContact<N, D>> =
            manifolds.iter().flat_map(|manifold| manifold.contacts()).copied().collect();
        assert_eq!(contacts.len(), self.generator.num_contacts());
        let alive: BTreeSet<ContactId> = contacts.iter().map(|contact| contact.id).collect();
        assert_eq!(alive.len(), contacts.len(), "a name twice: {contacts:?} of\n{pair:?}");
        let risen = alive.iter().find(|id| self.ever.contains(id) && !self.alive.contains(id));
        assert_eq!(risen, None, "a name returns: {contacts:?} of\n{pair:?}");
        self.ever.extend(&alive);
        self.alive = alive;
        contacts
    }
}

/// Checks that the contacts of the swapped pair are the flipped contacts of the pair, in any order.
fn check_order<N: Space<D>, R, const D: usize>(
    pair: &Pair<N, R, D>,
    contacts: &[TrackedContact<N, D>],
    swapped: &[TrackedContact<N, D>],
) where
    R: impinge::math::AbstractRotation<N, D> + Copy,
{
    let sorted = |mut written: Vec<String>| {
        written.sort();
        written
    };
    let own = contacts.iter().map(|contact| format!("{:?}", contact.contact)).collect();
    let flipped = swapped.iter().map(|contact| format!("{:?}", contact.contact.flipped()));
    let (own, flipped) = (sorted(own), sorted(flipped.collect()));
    if own != flipped {
        panic!("\n{own:?}\nis not\n{flipped:?}\nof\n{pair:?}");
    }
}

/// Checks, for moderate numbers, that there is a manifold if and only if there is a contact. The
/// largest depth of a convex pair must equal the depth of the contact up to rounding.
fn check_deepest<N: Space<D>, R, const D: usize>(
    pair: &Pair<N, R, D>,
    contacts: &[TrackedContact<N, D>],
    linear: N,
) where
    R: impinge::math::AbstractRotation<N, D> + Copy,
{
    if !pair.is_moderate {
        return;
    }
    let expected = pair.contact(linear);
    assert_eq!(expected.is_some(), !contacts.is_empty(), "{expected:?} {contacts:?} of\n{pair:?}");
    let Some(expected) = expected else { return };
    if parts_of(&*pair.g1).is_none() && parts_of(&*pair.g2).is_none() {
        let depths = contacts.iter().map(|contact| contact.contact.depth);
        let deepest = depths.reduce(impinge::math::max).expect("there is one");
        let off = (deepest - expected.depth).abs();
        assert!(off <= pair.tolerance(), "{expected:?} {contacts:?} of\n{pair:?}");
    }
}
