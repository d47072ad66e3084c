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
use super::size;
use crate::collide::manifold::build_between;
use crate::collide::{ManifoldRequest, Pair};
use crate::convex::Separation;
use crate::math::{Point, Pose, Space, Vector, unit};
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

/// Returns the least overlap, below `deepest`, of a solid, which is the first shape, with the line
/// of a side of a triangle: the separation of the solid and the line, in the frame of the solid,
/// with the points on the side and a normal that the edge there admits. `None` if there is none,
/// for balls, and for parts other than triangles.
fn least_at_sides<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contact: &PartContact<N, D>,
    deepest: N,
) -> Option<Separation<N, D>> {
    let (solid, surface) = (scene.between.pair.first, scene.surfaces[1]?);
    // The nearest point of a triangle to the centre of a ball decides its normal exactly.
    if matches!(solid, Kind::Ball(_)) {
        return None;
    }
    let own = scene.second_part(contact.parts()[1])?;
    let PartSolid::Triangle(triangle) = &own.solid else { return None };
    let (turn, origin) = (&scene.between.pair.pose12, scene.between.pose21.translation);
    let in_solid = |corner: &Point<N, D>| turn.vector(&(own.pose.point(corner).coords - origin));
    let [a, b, c] = triangle.corners().each_ref().map(in_solid);
    let mut least: Option<Separation<N, D>> = None;
    for (side, ends) in (0_u32..).zip([[a, b], [b, c], [c, a]]) {
        let admits = |toward: &Vector<N, D>| {
            let outward = -turn.inverse_vector(toward);
            let own = surface.snapped(contact.parts()[1], &outward);
            let is_of_face = own.is_some_and(|own| are_alike(&own, &outward));
            // The back of the face is on the wrong side of the surface.
            let is_back = is_of_face && contact.piece.normal.dot(toward) < N::ZERO;
            !is_back && surface.admits(contact.parts()[1], FeatureId::Edge(side), &outward)
        };
        let Some((along, length)) = unit(&(ends[1] - ends[0])) else { continue };
        // Unless the edge admits the normal of the parts, without its component along the edge, it
        // rarely admits the normal of the line.
        let across = contact.normal - along * contact.normal.dot(&along);
        if !unit(&across).is_some_and(|(across, _)| admits(&across)) {
            continue;
        }
        let most = least.map_or(deepest, |least| -least.distance);
        let Some(found) = on_line(solid, &ends, &along) else { continue };
        let at = along.dot(&(found.point2.coords - ends[0]));
        let is_on_side = at >= -contact.tolerance && at <= length + contact.tolerance;
        if is_on_side && -found.distance < most && admits(&found.normal) {
            least = Some(found);
        }
    }
    least
}

/// Returns the separation of a solid and the line through two points, the direction of which is
/// `along`; `None` unless they overlap.
fn on_line<N: Space<D>, const D: usize>(
    solid: Kind<'_, N, D>,
    [a, b]: &[Vector<N, D>; 2],
    along: &Vector<N, D>,
) -> Option<Separation<N, D>> {
    // The segment ends outside the solid.
    let past = along * (N::TWO * size(Geometry(solid).as_support_map()?) + a.norm());
    let line = Segment::of_finite(Point::from(a - past), Point::from(b + past));
    let pair = Pair { first: Kind::Segment(&line), second: solid, pose12: Pose::identity() };
    let found = <N::Algorithms>::separation(&pair, N::ZERO)?;
    Some(found.flipped(&Pose::identity()))
}
