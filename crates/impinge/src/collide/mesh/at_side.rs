//! The overlap of a solid with one side of a triangle, for a solid that overlaps the triangle least
//! along a normal that the surface does not admit at a corner.
//!
//! ```text
//!         │     ╱╲
//!   plate │   ╱    ╲         seen from above: the crate overlaps the triangles at the corner ·
//!         │ ╱        ╲       least along its own sides, but the border of the plate admits only
//!         ·    crate ╱       the normal to the right, along which the crate is deeper
//!         │ ╲      ╱
//!         │   ╲  ╱
//! ```
//!
//! A segment on the line of the border, longer than the solid, has this normal and this depth.

use super::hidden::are_alike;
use super::part_contact::{Arena, PartContact, PartStatus, appended};
use super::scene::Scene;
use crate::collide::manifold::build_between;
use crate::collide::{ManifoldRequest, Pair};
use crate::convex::Separation;
use crate::math::{Point, Pose, Space, unit};
use crate::shape::{FeatureId, Geometry, Kind, PartSolid, Segment};
use crate::tables::ByDimension;

/// Replaces a contact of overlapping parts by that with a side of the triangle, if an edge admits
/// the normal across it and the overlap along this normal is less than `deepest`. Returns whether
/// the contact was replaced.
pub(super) fn move_to_side<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    request: &ManifoldRequest<N>,
    contact: &mut PartContact<N, D>,
    deepest: N,
    arena: &mut Arena<N, D>,
) -> bool {
    let Some(found) = least_at_sides(scene, contact, deepest) else { return false };
    let placed = scene.pair(contact.parts());
    build_between(&placed.pair(), &placed.of_kinds(&found), request, arena.blank());
    let (piece, lowest) = appended(&placed, contact.parts(), arena);
    contact.set_piece(piece, lowest);
    (contact.status, contact.face) = (PartStatus::Own, None);
    true
}

/// Returns the separation of a solid, which is the first shape, and the line of a side of a
/// triangle, along which they overlap least and less than `deepest`, in the frame of the solid. Its
/// normal is one that the edge at the side admits, and its points are on the side. `None` if there
/// is none, and for other shapes and parts.
fn least_at_sides<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contact: &PartContact<N, D>,
    deepest: N,
) -> Option<Separation<N, D>> {
    let solid = scene.between.pair.first;
    let surface = scene.surfaces[1].filter(|_| !matches!(solid, Kind::Ball(_)))?;
    let reach = Geometry(solid).as_support_map()?.reach();
    let [_, part] = contact.parts();
    let own = scene.second_part(part)?;
    let PartSolid::Triangle(triangle) = &own.solid else { return None };
    let (turn, origin) = (&scene.between.pair.pose12, scene.between.pose21.translation);
    let in_solid = |corner: &Point<N, D>| turn.vector(&(own.pose.point(corner).coords - origin));
    let corners = triangle.corners().each_ref().map(in_solid);
    let mut least: Option<Separation<N, D>> = None;
    for side in [0_u32, 1, 2] {
        let [a, b] = [corners[side as usize], corners[(side as usize + 1) % 3]];
        let Some((along, length)) = unit(&(b - a)) else { continue };
        // Unless the edge admits the part of the parts' normal across it, the normal of the line
        // is rarely admitted either.
        let across = contact.normal - along * contact.normal.dot(&along);
        let Some((across, _)) = unit(&across) else { continue };
        if !surface.admits(part, FeatureId::Edge(side), &-turn.inverse_vector(&across)) {
            continue;
        }
        // The line ends outside the solid.
        let past = along * (N::TWO * reach + a.norm());
        let line = Segment::of_finite(Point::from(a - past), Point::from(b + past));
        let pair = Pair { first: Kind::Segment(&line), second: solid, pose12: Pose::identity() };
        let most = least.map_or(deepest, |least| -least.distance);
        let found = <N::Algorithms>::separation(&pair, N::ZERO);
        let Some(found) = found.filter(|found| -found.distance < most) else { continue };
        let outward = turn.inverse_vector(&found.normal);
        let is_of_face =
            surface.snapped(part, &outward).is_some_and(|own| are_alike(&own, &outward));
        let is_back = is_of_face && contact.piece.normal.dot(&found.normal) > N::ZERO;
        if is_back || !surface.admits(part, FeatureId::Edge(side), &outward) {
            continue;
        }
        let at = along.dot(&(found.point1.coords - a));
        if at < -contact.tolerance || at > length + contact.tolerance {
            continue;
        }
        let [point1, point2] = [found.point2, found.point1];
        least = Some(Separation { normal: -found.normal, point1, point2, ..found });
    }
    least
}
