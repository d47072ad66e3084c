//! Measures objects whose parts are tested against each other.

use impinge::math::Real;
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::query::{ContactPoint, Proximity, Witness};
use impinge::world::{CollisionObject, CollisionWorld};

use crate::space::Stage;

/// Returns `true` if a world tests the object against itself: its groups enable self-collision, and
/// its shape has parts. A convex solid never touches itself.
pub(crate) fn is_tested<N: Stage<D>, const D: usize, T>(object: &CollisionObject<N, D, T>) -> bool {
    let has_parts = object.shape().geometry().as_composite().is_some();
    object.collision_groups().can_interact_with_self() && has_parts
}

/// Returns the proximity of the parts of an object that are not adjacent, for a margin.
pub(crate) fn proximity<N: Stage<D>, const D: usize, T>(
    object: &CollisionObject<N, D, T>,
    margin: N,
) -> Proximity {
    let (world, handle) = alone(object, GeometricQueryType::Proximity(half(margin)));
    let pair = world.proximity_pair(handle, handle);
    pair.map_or(Proximity::Disjoint, |pair| pair.proximity())
}

/// Returns the deepest contact of the parts of an object that are not adjacent; `None` if their
/// distance exceeds `limit`, or if their overlap is unbounded.
pub(crate) fn witness<N: Stage<D>, const D: usize, T>(
    object: &CollisionObject<N, D, T>,
    limit: N,
) -> Option<Witness<N, D>> {
    let (world, handle) = alone(object, GeometricQueryType::Contacts(half(limit), N::ZERO));
    let points = world.contact_pair(handle, handle)?.views().map(|view| view.deepest_contact());
    let ContactPoint { contact, part1, part2, feature1, feature2, .. } = points.reduce(deeper)?;
    Some(Witness {
        point1: contact.world1,
        point2: contact.world2,
        normal: contact.normal,
        distance: -contact.depth,
        part1,
        part2,
        feature1,
        feature2,
    })
}

/// Returns an updated world that contains a copy of the object, and the handle of the copy.
fn alone<N: Stage<D>, const D: usize, T>(
    object: &CollisionObject<N, D, T>,
    query: GeometricQueryType<N>,
) -> (CollisionWorld<N, D, ()>, CollisionObjectHandle) {
    let mut world = CollisionWorld::new(N::ZERO);
    let (position, shape) = (*object.position(), object.shape().clone());
    let handle = world.add(position, shape, *object.collision_groups(), query, ());
    world.update();
    (world, handle)
}

/// Returns half of the distance. The limit of a pair is the sum of the limits of its two objects,
/// here of the same object twice.
fn half<N: Real>(distance: N) -> N {
    distance * N::lit(0.5)
}

/// Returns the deeper of two contacts; the first if they are equally deep.
fn deeper<N: Real, const D: usize>(
    one: ContactPoint<N, D>,
    other: ContactPoint<N, D>,
) -> ContactPoint<N, D> {
    if other.contact.depth > one.contact.depth { other } else { one }
}
