//! Converts results of the world and of the naive world, `impinge_reference::world`, into one form.

use std::collections::BTreeMap;

use impinge::math::Space;
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, ProximityEvent};
use impinge::query;
use impinge::world::CollisionWorld;
use impinge_reference::geometry::{Pose, Solid, point_signed_distance};
use impinge_reference::world as reference;
use impinge_reference::world::{Handle, Shape};

/// A solid whose distances are rounded to multiples of 2^-40.
///
/// `impinge_reference::geometry` computes in `f64` and has errors of a unit in the last place for
/// solids that touch along a slanted direction. On the grid of these tests, a distance that differs
/// from a sum of limits does so by far more than 2^-40.
#[derive(Clone, Debug)]
pub(crate) struct OnGrid<const D: usize>(pub(crate) Solid<D>);

fn on_grid(distance: f64) -> f64 {
    const STEPS: f64 = (1_u64 << 40) as f64;
    (distance * STEPS).round() / STEPS
}

impl<const D: usize> Shape<D> for OnGrid<D> {
    fn signed_distance(&self, pose: &Pose<D>, other: &Self, other_pose: &Pose<D>) -> f64 {
        on_grid(self.0.signed_distance(pose, &other.0, other_pose))
    }

    fn bounding_radius(&self) -> f64 {
        self.0.bounding_radius()
    }

    fn ray_cast(&self, pose: &Pose<D>, origin: &[f64; D], direction: &[f64; D]) -> Option<f64> {
        self.0.ray_cast(pose, origin, direction)
    }

    fn contains_point(&self, pose: &Pose<D>, point: &[f64; D]) -> bool {
        on_grid(point_signed_distance(&self.0, pose, point)) <= 0.0
    }

    fn aabb(&self, pose: &Pose<D>) -> ([f64; D], [f64; D]) {
        self.0.aabb(pose)
    }
}

/// The handle in the naive world for each handle of the world, including those of removed objects.
pub(crate) type Twins = BTreeMap<CollisionObjectHandle, Handle>;

pub(crate) fn proximity(proximity: query::Proximity) -> reference::Proximity {
    match proximity {
        query::Proximity::Intersecting => reference::Proximity::Intersecting,
        query::Proximity::WithinMargin => reference::Proximity::WithinMargin,
        query::Proximity::Disjoint => reference::Proximity::Disjoint,
    }
}

pub(crate) fn contact_events(
    twins: &Twins,
    events: &[ContactEvent],
) -> Vec<reference::ContactEvent> {
    let twin = |event: &ContactEvent| match event {
        ContactEvent::Started(a, b) => reference::ContactEvent::Started(twins[a], twins[b]),
        ContactEvent::Stopped(a, b) => reference::ContactEvent::Stopped(twins[a], twins[b]),
    };
    events.iter().map(twin).collect()
}

pub(crate) fn proximity_events(
    twins: &Twins,
    events: &[ProximityEvent],
) -> Vec<reference::ProximityEvent> {
    let twin = |event: &ProximityEvent| reference::ProximityEvent {
        collider1: twins[&event.collider1],
        collider2: twins[&event.collider2],
        previous: proximity(event.prev_status),
        new: proximity(event.new_status),
    };
    events.iter().map(twin).collect()
}

/// Returns the pairs with contact points.
pub(crate) fn touching<N: Space<D>, const D: usize, T>(
    twins: &Twins,
    world: &CollisionWorld<N, D, T>,
) -> Vec<(Handle, Handle)> {
    let touching = world.contact_pairs().filter(|(_, _, pair)| pair.num_contacts() > 0);
    touching.map(|(a, b, _)| (twins[&a.handle()], twins[&b.handle()])).collect()
}

/// Returns the pairs that are not disjoint.
pub(crate) fn close<N: Space<D>, const D: usize, T>(
    twins: &Twins,
    world: &CollisionWorld<N, D, T>,
) -> Vec<(Handle, Handle, reference::Proximity)> {
    let status = world
        .proximity_pairs()
        .map(|(a, b, pair)| (twins[&a.handle()], twins[&b.handle()], proximity(pair.proximity())));
    status.filter(|(_, _, proximity)| *proximity != reference::Proximity::Disjoint).collect()
}
