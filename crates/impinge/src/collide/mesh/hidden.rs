//! Drops contacts with faces that lie behind a neighbouring face, as seen from the solid.
//!
//! Each face of a two-sided surface is touched from the side that the centre of the solid is on.
//! Near an edge this rule fails for one of the two faces:
//!
//! ```text
//!      ┌───────────┐
//!      │     ·     │      · centre of a box: in front of the top,
//!  ────┴─────────┐─┘        but behind the plane of the side, whose inside
//!   top          │          it would seem to touch: the side is hidden
//!                │ side
//! ```
//!
//! Where two faces meet, each is behind the plane of the other (a ridge), each is in front of it (a
//! valley), or only one of them is in front of the other's plane. In the last case, this face
//! covers the front side of the other face. So the other face, which is behind its plane, is
//! hidden.

use smallvec::SmallVec;

use super::part_cache::corners_of;
use super::part_contact::{PartContact, PartStatus};
use super::scene::Scene;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Mapped, Point, Real, Space, Vector, max, min};

/// Smallest cosine of the angle between two normals that are alike: faces with such normals do not
/// hide each other.
const ALIKE: f64 = 0.99;
/// Bound of the rounding errors of heights, in units of epsilon times the lengths of both parts.
const ROUNDING: f64 = 16.0;
/// Largest number of faces around a corner that are compared with all other faces there; the
/// nearest to the solid are used. Most corners of surfaces have six faces, but the centre of a fan
/// of triangles has all faces of the fan.
const MAX_HIDING: usize = 16;

/// The side of a plane that a face lies on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PlaneSide {
    Front,
    Back,
    Across,
}

/// A face of the composite in contact with the solid.
struct TouchedFace<N: Real, const D: usize> {
    /// Index of the face's contact.
    contact: usize,
    /// Signed distance of the face's part from the solid.
    distance: N,
    /// Unit normal on the touched side, in the frame of the composite.
    normal: Vector<N, D>,
    /// Corners in the frame of the composite; for a segment the second end occurs twice.
    corners: [Point<N, D>; 3],
}

/// The faces, and the pairs of a corner id and the index of a face at that corner, in ascending
/// order.
type TouchedFaces<N, const D: usize> =
    (SmallVec<[TouchedFace<N, D>; 8]>, SmallVec<[(u64, u32); 24]>);

/// Drops the contacts of a convex solid with faces that a face with a common corner hides.
///
/// Cost: O(n log n) in the number of faces in contact.
pub(super) fn drop_hidden<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contacts: &mut [PartContact<N, D>],
) {
    // If both shapes are composites, there is no single centre that decides the side.
    if !scene.first_is_convex() {
        return;
    }
    let (all, next) = (contacts.iter(), contacts.iter());
    let (all, next) = (all.filter_map(|one| one.face), next.filter_map(|one| one.face).skip(1));
    if all.zip(next).all(|(a, b)| are_alike(&a, &b)) {
        return;
    }
    let (faces, mut corners) = faces_of(scene, contacts);
    for star in corners.chunk_by_mut(|a, b| a.0 == b.0) {
        if star.len() > MAX_HIDING {
            for (corner, face) in &mut *star {
                *corner = order_of(faces[*face as usize].distance);
            }
            sort_keyed(star);
        }
        for (at, (_, first)) in star.iter().enumerate().take(MAX_HIDING) {
            for (_, second) in &star[at + 1..] {
                if let Some(hidden) = hidden_of(&faces[*first as usize], &faces[*second as usize]) {
                    contacts[hidden].status = PartStatus::Left;
                }
            }
        }
    }
}

/// Collects the faces in contact, and the ids of their corners. Leaves out faces of bodies: their
/// fronts are known, and a solid that is inside a body touches faces from behind.
fn faces_of<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contacts: &[PartContact<N, D>],
) -> TouchedFaces<N, D> {
    let (mut faces, mut shared) = TouchedFaces::default();
    faces.reserve(contacts.len());
    shared.reserve(3 * contacts.len());
    let mut next_face = 0;
    for (contact, PartContact { distance, face, piece, .. }) in contacts.iter().enumerate() {
        let (Some(normal), Some(part)) = (*face, scene.second_part(piece.parts[1])) else {
            continue;
        };
        if scene.are_bodies(piece.parts) {
            continue;
        }
        // Parts without corners, as user-defined surfaces may have, hide nothing.
        let Some((corners, _)) = corners_of(&part) else { continue };
        let corners = corners.mapped(|corner| part.pose.point(&corner));
        scene.each_corner(piece.parts[1], |corner| shared.push((corner, next_face)));
        next_face += 1;
        faces.push(TouchedFace { contact, distance: *distance, normal, corners });
    }
    sort_keyed(&mut shared);
    (faces, shared)
}

/// Returns whether faces with these normals are too similar to hide each other.
pub(super) fn are_alike<N: Real, const D: usize>(a: &Vector<N, D>, b: &Vector<N, D>) -> bool {
    a.dot(b) > N::lit(ALIKE)
}

/// Returns the index of the contact with the hidden face of two. A face is hidden if it lies behind
/// the plane of the other face, the other face lies in front of its plane, and the other face
/// overlaps the solid or is not farther from it. `None` if neither face is hidden, or if the
/// normals of both are alike.
fn hidden_of<N: Real, const D: usize>(
    a: &TouchedFace<N, D>,
    b: &TouchedFace<N, D>,
) -> Option<usize> {
    if are_alike(&a.normal, &b.normal) {
        return None;
    }
    let (back, front) = match (side_of(a, b), side_of(b, a)) {
        (PlaneSide::Back, PlaneSide::Front) => (a, b),
        (PlaneSide::Front, PlaneSide::Back) => (b, a),
        _ => return None,
    };
    // A farther face hides nothing, so a larger prediction never removes the contact of an overlap.
    (front.distance <= max(back.distance, N::ZERO)).then_some(back.contact)
}

/// Returns the side of the plane of the face `plane` on which the face `part` lies, up to rounding
/// error; `Across` if it lies on both sides or in the plane.
fn side_of<N: Real, const D: usize>(
    part: &TouchedFace<N, D>,
    plane: &TouchedFace<N, D>,
) -> PlaneSide {
    let origin = plane.corners[0];
    let (mut low, mut high, mut plane_height) = (N::INFINITY, -N::INFINITY, -N::INFINITY);
    let mut size = N::ZERO;
    for (corner, own) in part.corners.iter().zip(&plane.corners) {
        let (arm, own) = (corner - origin, own - origin);
        let rise = plane.normal.dot(&arm);
        (low, high) = (min(low, rise), max(high, rise));
        plane_height = max(plane_height, plane.normal.dot(&own));
        size = max(size, arm.norm_squared() + own.norm_squared());
    }
    let tolerance = N::lit(ROUNDING) * N::EPSILON * N::TWO * size.sqrt();
    match (low - plane_height < -tolerance, high - plane_height > tolerance) {
        (true, false) => PlaneSide::Back,
        (false, true) => PlaneSide::Front,
        _ => PlaneSide::Across,
    }
}
