//! The contacts of composites as users see them.

use super::CompositeContacts;
use crate::math::{Pose, Space};
use crate::query::kinematic::{ContactKinematic, Sides};
use crate::query::manifold::{TrackedContact, placed};
use crate::query::manifold_build::{Patch, PatchPoint};
use crate::query::{ContactId, ContactManifold, Pair, Placement};
use crate::shape::{Geometry, Kind, Part};

impl<N: Space<D>, const D: usize> CompositeContacts<N, D> {
    /// One manifold for each patch; `pair` is that of the last update. They are written over the
    /// memory of old ones.
    pub(crate) fn manifolds(
        &self,
        pair: &Pair<'_, N, D>,
        placement: &Placement<'_, N, D>,
        mut old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> {
        old.resize_with(self.patches.len(), ContactManifold::default);
        for (manifold, patch) in old.iter_mut().zip(&self.patches) {
            let tracked = patch.points.iter().map(|point| tracked(pair, patch, point, placement));
            manifold.refill(tracked);
        }
        old
    }
}

/// One contact in the world.
fn tracked<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    patch: &Patch<N, D>,
    point: &PatchPoint<N, D>,
    placement: &Placement<'_, N, D>,
) -> TrackedContact<N, D> {
    let normal = placement.pose1.vector(&patch.normal);
    let contact = placed(&patch.normal, &point.raw, placement.pose1, normal);
    let kinematic = kinematic(pair, patch, point);
    let id = ContactId { pair: placement.pair, number: point.raw.id };
    let [part1, part2] = point.parts;
    let tracked = TrackedContact { contact, kinematic, id, part1, part2 };
    if placement.is_swapped { tracked.flipped() } else { tracked }
}

/// How a contact moves: as one of its two parts, seen from the frames of the shapes.
fn kinematic<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    patch: &Patch<N, D>,
    point: &PatchPoint<N, D>,
) -> ContactKinematic<N, D> {
    let [part1, part2] = point.parts;
    let (part1, part2) = (part_of(pair.first, part1), part_of(pair.second, part2));
    let pose = |part: &Option<Part<'_, N, D>>| part.map_or_else(Pose::identity, |part| part.pose);
    let (pose1, pose2) = (pose(&part1), pose(&part2));
    let first = part1.as_ref().map_or(pair.first, |part| part.solid.geometry().0);
    let second = part2.as_ref().map_or(pair.second, |part| part.solid.geometry().0);
    let pose12 = pose1.inverse().compose(&pair.pose12.compose(&pose2));
    let mut raw = point.raw;
    raw.point1 = pose1.inverse_point(&raw.point1);
    let parts = Pair { first, second, pose12 };
    let normal = pose1.inverse_vector(&patch.normal);
    Sides::new(&parts, &normal).kinematic(&raw).seen_from(&pose1, &pose2)
}

/// The part of a shape that a number names; `None` of a shape that is its own part.
fn part_of<N: Space<D>, const D: usize>(kind: Kind<'_, N, D>, part: u32) -> Option<Part<'_, N, D>> {
    Geometry(kind).as_composite().map(|composite| composite.part(part))
}
