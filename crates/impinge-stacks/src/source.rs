//! The contacts of impinge for the solver.

use core::hash::Hash;

use impinge::narrow_phase::{
    CollisionObjectHandle, ContactQuery, DefaultContactDispatcher, DefaultNarrowPhase,
    DefaultProximityDispatcher,
};
use impinge::query::ContactId;
use impinge::world::{CollisionGroups, CollisionWorld};

use crate::{Body, Contact, Stack, Stage, shape_of};

/// The prediction: pairs have contacts up to this distance.
pub const PREDICTION: f64 = 0.02;

/// A source of contacts of bodies: a collision library.
pub trait ContactSource<N: Stage<D>, const D: usize> {
    /// The id of a contact, which persists from step to step.
    type Id: Copy + Eq + Hash;
    /// Returns the contacts of bodies at their current poses, ordered by the indices of the bodies.
    fn contacts(&mut self, bodies: &[Body<N, D>]) -> Vec<Contact<N, D, Self::Id>>;
}

/// The options of impinge.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choices {
    /// The largest number of points of a manifold; the library's default if `None`.
    pub max_points: Option<usize>,
    /// The tolerance within which pairs reuse contacts; `None` to recompute all.
    pub reuse: Option<f64>,
}

/// A world of impinge, as a source of contacts.
#[expect(missing_debug_implementations, reason = "a world has no short description")]
pub struct Impinge<N: Stage<D>, const D: usize> {
    world: CollisionWorld<N, D, usize>,
    /// For each body, the handle of its object.
    handles: Vec<CollisionObjectHandle>,
}

impl<N: Stage<D>, const D: usize> Impinge<N, D> {
    /// Creates a world with the objects of a scene.
    #[must_use]
    pub fn new(stack: &Stack<D>, choices: Choices) -> Self {
        let mut world = CollisionWorld::new(N::lit(PREDICTION));
        let mut narrow_phase = narrow_phase(choices.max_points);
        if let Some(way) = choices.reuse {
            narrow_phase = narrow_phase.reusing(N::lit(way));
        }
        world.set_narrow_phase(Box::new(narrow_phase));
        let query = ContactQuery::new(N::lit(PREDICTION / 2.0));
        let handles = stack.items.iter().enumerate().map(|(n, item)| {
            let (pose, shape) = (N::pose_of(&item.placement), shape_of(&item.solid));
            world.add(pose, shape, groups(item.density == 0.0), query, n)
        });
        let handles = handles.collect();
        Self { world, handles }
    }
}

/// Returns the collision groups of an object: fixed objects do not interact with each other.
fn groups(is_fixed: bool) -> CollisionGroups {
    let groups = CollisionGroups::new();
    if is_fixed {
        groups.with_membership(&[1]).with_blacklist(&[1])
    } else {
        groups.with_membership(&[0])
    }
}

fn narrow_phase<N: Stage<D>, const D: usize>(
    max_points: Option<usize>,
) -> DefaultNarrowPhase<N, D> {
    let Some(most) = max_points else { return DefaultNarrowPhase::new() };
    let contacts = DefaultContactDispatcher::<D>::with_max_points(most);
    let proximity = DefaultProximityDispatcher::<D>::new();
    DefaultNarrowPhase::with_dispatchers(Box::new(contacts), Box::new(proximity))
}

impl<N: Stage<D>, const D: usize> ContactSource<N, D> for Impinge<N, D> {
    type Id = ContactId;

    fn contacts(&mut self, bodies: &[Body<N, D>]) -> Vec<Contact<N, D, ContactId>> {
        for (handle, body) in self.handles.iter().zip(bodies) {
            if body.inverse_mass != N::ZERO {
                self.world.set_position(*handle, body.pose);
            }
        }
        self.world.update();
        let mut contacts = Vec::new();
        for (first, second, manifold) in self.world.contact_views() {
            contacts.extend(manifold.contacts().map(|point| Contact {
                bodies: [*first.data(), *second.data()],
                points: [point.contact.world1.coords, point.contact.world2.coords],
                normal: *point.contact.normal,
                depth: point.contact.depth,
                id: point.id,
            }));
        }
        contacts.sort_by_key(|contact| contact.bodies);
        contacts
    }
}
