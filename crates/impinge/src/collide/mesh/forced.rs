//! Contacts along the normal of a face, where the seam of a surface does not admit the normal of
//! the parts: the points, and how deep they are.

use super::normal_filter::is_behind;
use super::part_contact::{Arena, PartConfiguration, PartContact, PartStatus, appended};
use super::scene::Scene;
use crate::collide::manifold::{Along, build_along, build_between};
use crate::collide::{ManifoldRequest, Pair, RawManifold, RawPoint};
use crate::convex::Separation;
use crate::math::{Mapped, Real, Space, Vector};
use crate::shape::{Geometry, Kind};
use crate::tables::ByDimension;

impl<N: Space<D>, const D: usize> PartConfiguration<'_, N, D> {
    /// Builds the manifold of the parts along the normal of a face, from the first shape to the
    /// second in the frame of the first; `tolerance` bounds rounding errors. Returns the length by
    /// which the parts overlap along the normal if the points are less deep: at the front of a body
    /// that is touched from inside, since the part bounds the points. Else returns minus infinity.
    pub(super) fn build_forced(
        &self,
        scene: &Scene<'_, N, D>,
        gap: &Separation<N, D>,
        face: Vector<N, D>,
        tolerance: N,
        request: &ManifoldRequest<N>,
        raw: &mut RawManifold<N, D>,
    ) -> N {
        let (placed, pair, distance) = (self.placed, self.placed.pair(), gap.distance);
        let normal = placed.outward(&gap.normal);
        // The solid comes from inside a body.
        let is_below =
            distance <= N::ZERO && is_behind(&normal, &face) && scene.are_bodies(self.parts);
        let (face, least, overlap) = if is_below {
            let (front, overlap) = self.shallower_front(scene, &face);
            (front, -N::INFINITY, overlap)
        } else {
            (face, least_along(&face, &normal, distance, tolerance), -N::INFINITY)
        };
        let along = Along { normal: placed.inward(&face), least, tolerance };
        raw.normal = along.normal;
        build_along(&pair, &along, request, raw);
        overlap
    }

    /// Returns the front normal, of those of the two parts, along which the parts overlap less;
    /// `face` unless both parts belong to bodies. Both are from the first shape to the second, in
    /// the frame of the first. Also returns the overlap.
    ///
    /// Two solid meshes that are stacked exactly above each other have sides in one plane. The side
    /// of one meets the top of the other along an edge; the top gives the depth of the stack, the
    /// front of the side the width of the mesh.
    fn shallower_front(&self, scene: &Scene<'_, N, D>, face: &Vector<N, D>) -> (Vector<N, D>, N) {
        let [[own1, other2], [other1, own2]] = self.centers;
        let front = |which: usize, toward: Vector<N, D>| {
            let (surface, part) = (scene.surfaces[which]?, self.parts[which]);
            surface.snapped(part, &toward).filter(|_| surface.is_body(part))
        };
        let (pair, placed) = (self.placed.pair(), self.placed);
        let depth = |front| overlap_along(&pair, &placed.inward(front));
        let fronts = (front(0, other1 - own1), front(1, other2 - own2));
        let (Some(front1), Some(front2)) = fronts else { return (*face, depth(face)) };
        let front2 = -placed.in_first_frame(&front2);
        let depths = [depth(&front1), depth(&front2)];
        if depths[0] < depths[1] { (front1, depths[0]) } else { (front2, depths[1]) }
    }
}

/// Largest number of steps of [`reach`].
const MAX_STEPS: usize = 16;
/// The smallest closing speed along a normal at which [`reach`] continues.
const SLOWEST: f64 = 1.0 / 64.0;

/// Computes a contact of a convex solid that the points along the normal of the face missed
/// ([`PartStatus::Missed`]): the part of the solid above the face has another deepest point. The
/// result has the status [`PartStatus::Snapped`], or [`PartStatus::Left`] if there is none.
///
/// ```text
///            │                    the corner of the wedge is below the foot of the wall;
///      ╱╲    │ wall               moved out to the left, then towards the wall, the wedge
///     ╱  ╲   │                    touches the wall first with its inclined side at the foot ·
///    ╱    ╲  │
///   ╱──────╲─·────  floor
/// ```
///
/// The motion is Newton's method on the distance, a convex function of time, as for impacts
/// (Mirtich, "Impulse-based dynamic simulation", 1996).
pub(super) fn reach<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    request: &ManifoldRequest<N>,
    contact: &mut PartContact<N, D>,
    arena: &mut Arena<N, D>,
) {
    let (parts, face) = (contact.parts(), contact.piece.normal);
    let placed = scene.pair(parts);
    let is_from_body = scene.are_bodies(parts) && is_behind(&contact.normal, &face);
    (contact.status, contact.lowest) = (PartStatus::Left, N::INFINITY);
    if is_from_body || matches!(placed.pair().first, Kind::Ball(_)) {
        return;
    }
    let inward = placed.inward(&face);
    let found = first_touch(&placed.pair(), &inward, contact.tolerance);
    let Some((pair, found, depth)) = found else { return };
    let raw = arena.blank();
    build_between(&pair, &Separation { distance: N::ZERO, ..found }, request, raw);
    raw.points.retain(|point| point.distance <= contact.tolerance);
    for point in &mut raw.points {
        point.distance = -depth;
    }
    raw.normal = inward;
    let (piece, lowest) = appended(&placed, parts, arena);
    contact.set_piece(piece, lowest);
    contact.status = PartStatus::Snapped;
    contact.face = Some(-placed.in_second_frame(&face));
}

/// Moves the second solid of an overlapping pair out along `normal`, a unit vector from the first
/// to the second in the frame of the first, and back until both touch. Returns the pair there, its
/// separation, and the length of the whole motion; `None` if the solids do not come to touch.
fn first_touch<'a, N: Space<D>, const D: usize>(
    start: &Pair<'a, N, D>,
    normal: &Vector<N, D>,
    tolerance: N,
) -> Option<(Pair<'a, N, D>, Separation<N, D>, N)> {
    let (mut pair, mut out) = (*start, overlap_along(start, normal));
    for _ in 0..MAX_STEPS {
        pair.pose12.translation = start.pose12.translation + normal * out;
        let found = <N::Algorithms>::separation(&pair, N::INFINITY)?;
        if found.distance <= tolerance {
            return Some((pair, found, out)).filter(|_| out > tolerance);
        }
        let closing = found.normal.dot(normal);
        if closing < N::lit(SLOWEST) {
            return None;
        }
        out -= found.distance / closing;
    }
    None
}

/// Returns the length by which two solids overlap along `normal`, a unit vector from the first to
/// the second in the frame of the first; infinite for half-spaces.
fn overlap_along<N: Real, const D: usize>(pair: &Pair<'_, N, D>, normal: &Vector<N, D>) -> N {
    let maps = [pair.first, pair.second].mapped(|kind| Geometry(kind).as_support_map());
    let [Some(first), Some(second)] = maps else { return N::INFINITY };
    let toward = -pair.pose12.inverse_vector(normal);
    let near = pair.pose12.point(&second.support_point(&toward));
    normal.dot(&(first.support_point(normal) - near))
}

/// Returns the smallest distance that points along the normal of a face may have, if the seam does
/// not admit `normal`, the normal of the two parts, whose distance is `distance`. Both normals have
/// the same frame and sign; `tolerance` bounds rounding errors.
///
/// Points of parts that are apart are no nearer than the parts. Parts that overlap may be deeper
/// along the face's normal. So may parts that only touch, since each of two neighbouring parts may
/// end where the solid crosses their surface:
///
/// ```text
///            │ wall of a box           left, wall: touch       right, wall: touch
///      left  │  right                  surface, wall: overlap by the part below the surface
///   ─────────┼─────────
///            │
/// ```
///
/// But parts that touch at the back of the face do not overlap: the solid is beside the surface.
pub(super) fn least_along<N: Space<D>, const D: usize>(
    face: &Vector<N, D>,
    normal: &Vector<N, D>,
    distance: N,
    tolerance: N,
) -> N {
    let apart = if is_behind(normal, face) { -tolerance } else { tolerance };
    if distance > apart { distance } else { -N::INFINITY }
}

/// Returns whether the points along the normal of a face miss the contact: there are none, or the
/// parts overlap and all points are apart. The face, clipped to the region below the other part,
/// may end beside the overlap.
pub(super) fn overlooks<N: Real, const D: usize>(
    points: &[RawPoint<N, D>],
    distance: N,
    tolerance: N,
) -> bool {
    let highest = if distance <= N::ZERO { tolerance } else { N::INFINITY };
    !points.iter().any(|point| point.distance <= highest)
}
