//! Conversion of the contacts of composites to the public interface.

use crate::collide::mesh::{Patch, PatchPoint};
use crate::collide::pair::pose_between;
use crate::collide::{CompositeContacts, Pair, RawPoint};
use crate::math::{Mapped, Pose, Real, Space, Vector};
use crate::query::kinematic::{ContactKinematic, KinematicSides};
use crate::query::manifold::{TrackedContact, placed};
use crate::query::{ContactId, ContactManifold, ManifoldView, PairRef, Placement};
use crate::shape::{Geometry, Kind, Part, PartSolid};
use crate::tables::ByDimension;

/// Two normals are treated as equal if the length of their difference is at most this many
/// epsilons.
const ROUNDING: f64 = 64.0;

impl<N: Space<D>, const D: usize> CompositeContacts<N, D> {
    /// Returns a view of manifold `patch` without copying it; `None` beyond the last manifold.
    #[inline]
    pub(crate) fn view<'a>(
        &'a self,
        patch: usize,
        placement: Placement<'a, N, D>,
        pair: PairRef<'a, N, D>,
    ) -> Option<ManifoldView<'a, N, D>> {
        Some(ManifoldView::of_patch(self.patches().get(patch)?, placement, pair))
    }

    /// Returns one manifold for each patch, for shapes at given poses; `next` returns the touching
    /// solids of each contact, in order. Reuses the memory of `old`.
    pub(crate) fn manifolds_on<'a>(
        &self,
        poses: [&Pose<N, D>; 2],
        placement: &Placement<'_, N, D>,
        mut next: impl FnMut() -> Option<Touched<'a, N, D>>,
        mut old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> {
        old.resize_with(self.patches().len(), ContactManifold::default);
        for (manifold, patch) in old.iter_mut().zip(self.patches()) {
            manifold.refill(patch.points.iter().filter_map(|point| {
                let touched = next()?;
                let pose12 = pose_between(touched.turns[0], poses);
                Some(touched.tracked(&pose12, patch, point, placement))
            }));
        }
        old
    }
}

/// Converts one contact to the world frame.
pub(in crate::query) fn tracked<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    patch: &Patch<N, D>,
    point: &PatchPoint<N, D>,
    placement: &Placement<'_, N, D>,
) -> TrackedContact<N, D> {
    touched(pair, patch, point, |touched| touched.tracked(&pair.pose12, patch, point, placement))
}

/// The touching solids of a contact: the data of the shapes that its kinematic needs.
pub(crate) struct Touched<'a, N: Real, const D: usize> {
    /// For each shape, the touching part, or the whole shape if it is not a composite.
    pub(crate) solids: [Kind<'a, N, D>; 2],
    /// The poses of `solids` in the frames of the shapes.
    pub(crate) poses: [Pose<N, D>; 2],
    /// [`Geometry::turns`] of each shape.
    pub(crate) turns: [bool; 2],
    /// `true` if the normal is a face normal of the second shape and rotates with that shape,
    /// `false` if it is a face normal of the first shape. `None` if the normal belongs to no face.
    pub(crate) turns_with_second: Option<bool>,
}

/// Calls `read` with the touching solids of a contact.
pub(crate) fn touched<N: Space<D>, R, const D: usize>(
    pair: &Pair<'_, N, D>,
    patch: &Patch<N, D>,
    point: &PatchPoint<N, D>,
    read: impl FnOnce(&Touched<'_, N, D>) -> R,
) -> R {
    let [part1, part2] = point.parts;
    let (part1, part2) = (part_of(pair.first, part1), part_of(pair.second, part2));
    let pose = |part: &Option<Part<'_, N, D>>| part.map_or_else(Pose::identity, |part| part.pose);
    let first = part1.as_ref().map_or(pair.first, |part| part.solid.geometry().0);
    let second = part2.as_ref().map_or(pair.second, |part| part.solid.geometry().0);
    read(&Touched {
        solids: [first, second],
        poses: [pose(&part1), pose(&part2)],
        turns: [pair.first, pair.second].mapped(|kind| Geometry(kind).turns()),
        turns_with_second: turning(pair, patch, point),
    })
}

impl<N: Space<D>, const D: usize> Touched<'_, N, D> {
    /// Converts the contact to the world frame; `pose12` is the pose of the second shape in the
    /// frame of the first.
    pub(crate) fn tracked(
        &self,
        pose12: &Pose<N, D>,
        patch: &Patch<N, D>,
        point: &PatchPoint<N, D>,
        placement: &Placement<'_, N, D>,
    ) -> TrackedContact<N, D> {
        let normal = placement.pose1.vector(&patch.normal);
        let contact = placed(&patch.normal, &point.raw, placement.pose1, normal);
        let kinematic = self.kinematic(pose12, &patch.normal, &point.raw);
        let id = ContactId { pair: placement.pair, number: point.raw.id };
        let [part1, part2] = point.parts;
        let tracked = TrackedContact { contact, kinematic, id, part1, part2 };
        if placement.is_swapped { tracked.flipped() } else { tracked }
    }

    /// Returns the kinematic of the contact's two solids, in the frames of the shapes.
    fn kinematic(
        &self,
        pose12: &Pose<N, D>,
        normal: &Vector<N, D>,
        raw: &RawPoint<N, D>,
    ) -> ContactKinematic<N, D> {
        let ([first, second], [pose1, pose2]) = (self.solids, &self.poses);
        let pose12 = pose1.inverse().compose(&pose12.compose(pose2));
        let raw = RawPoint { point1: pose1.inverse_point(&raw.point1), ..*raw };
        let solids = Pair { first, second, pose12 };
        let normal = pose1.inverse_vector(normal);
        let kinematic = KinematicSides::new(&solids, &normal).kinematic(&raw);
        let kinematic = match self.turns_with_second {
            Some(is_second) => kinematic.turning_with(is_second),
            None => kinematic,
        };
        kinematic.in_frames([pose1, pose2], self.turns)
    }
}

/// Returns true if the normal belongs to a face of the second surface, false if it belongs to a
/// face of the first surface alone, `None` if it belongs to no face.
fn turning<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    patch: &Patch<N, D>,
    point: &PatchPoint<N, D>,
) -> Option<bool> {
    let outward1 = patch.normal;
    let outward2 = -pair.pose12.inverse_vector(&patch.normal);
    let [part1, part2] = point.parts;
    if is_face_normal(pair.second, part2, &outward2) {
        return Some(true);
    }
    is_face_normal(pair.first, part1, &outward1).then_some(false)
}

/// Returns whether the normal is a face normal of the surface at the part, up to rounding. A line
/// in 3D has no face.
fn is_face_normal<N: Space<D>, const D: usize>(
    kind: Kind<'_, N, D>,
    part: u32,
    outward: &Vector<N, D>,
) -> bool {
    let Some(composite) = Geometry(kind).as_composite() else { return false };
    let face = composite.surface().and_then(|surface| surface.snapped(part, outward));
    let is_3d = <N::Algorithms>::tangents(outward)[1] != Vector::<N, D>::zeros();
    let is_line = matches!(composite.part(part).solid, PartSolid::Segment(_)) && is_3d;
    let tolerance = N::lit(ROUNDING) * N::EPSILON;
    face.is_some_and(|face| !is_line && (face - outward).norm() <= tolerance)
}

/// Returns part `part` of a composite; `None` for a shape that is not a composite.
fn part_of<N: Space<D>, const D: usize>(kind: Kind<'_, N, D>, part: u32) -> Option<Part<'_, N, D>> {
    Geometry(kind).as_composite().map(|composite| composite.part(part))
}
