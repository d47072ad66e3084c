//! Faces hidden from the solid, because it is on the back of their neighbours.
//!
//! Each face of a two-sided surface is touched from the side that the centre of the solid is on.
//! Near an edge that is wrong for one of two faces:
//!
//! ```text
//!      ┌───────────┐
//!      │     ·     │      · centre of a box: in front of the top,
//!  ────┴─────────┐─┘        but behind the plane of the side, whose inside
//!   top          │          it would seem to touch: the side is hidden
//!                │ side
//! ```
//!
//! Two faces that meet are each behind the other (a ridge), each in front of the other (a valley),
//! or the first is in front of the second but the second behind the first. In the last case no
//! solid is in front of both, and the face behind is hidden.

use smallvec::SmallVec;

use super::part_cache::corners_of;
use super::part_contact::{PartContact, PartStatus};
use super::scene::Scene;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Mapped, Point, Real, Space, Vector, max, min};

/// Faces do not hide each other if the cosine of their normals is larger.
const ALIKE: f64 = 0.99;
/// Rounding error of heights, in units of epsilon times the lengths of both parts.
const ROUNDING: f64 = 16.0;
/// Faces around a corner that can hide others: those nearest to the solid. Surfaces have six around
/// most corners, but a fan of triangles has all around one.
const MAX_HIDING: usize = 16;

/// The side of a plane that a face lies on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PlaneSide {
    Front,
    Back,
    Across,
}

/// A face in contact.
struct TouchedFace<N: Real, const D: usize> {
    /// Its index among the contacts.
    contact: usize,
    /// The distance of its part from the solid.
    distance: N,
    /// Unit, on the touched side.
    normal: Vector<N, D>,
    /// A segment has its second end twice.
    corners: [Point<N, D>; 3],
}

/// The faces, and the pairs of corner id and face index, sorted.
type TouchedFaces<N, const D: usize> =
    (SmallVec<[TouchedFace<N, D>; 8]>, SmallVec<[(u64, u32); 24]>);

/// Drops the contacts of a convex solid with faces that are hidden by faces with a common corner.
///
/// Cost: O(n log n) in the number of faces in contact.
pub(super) fn drop_hidden<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contacts: &mut [PartContact<N, D>],
) {
    // Two composites have no single centre that is on one side.
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

/// Collects the faces in contact.
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
        // Parts without corners, which a user's surface may have, hide nothing.
        let Some((corners, _)) = corners_of(&part) else { continue };
        let corners = corners.mapped(|corner| part.pose.point(&corner));
        scene.each_corner(piece.parts[1], |corner| shared.push((corner, next_face)));
        next_face += 1;
        faces.push(TouchedFace { contact, distance: *distance, normal, corners });
    }
    sort_keyed(&mut shared);
    (faces, shared)
}

/// Whether faces with these normals cannot hide each other.
pub(super) fn are_alike<N: Real, const D: usize>(a: &Vector<N, D>, b: &Vector<N, D>) -> bool {
    a.dot(b) > N::lit(ALIKE)
}

/// Returns the contact that is hidden: its face is behind the other, but the other is not behind
/// it.
fn hidden_of<N: Real, const D: usize>(
    a: &TouchedFace<N, D>,
    b: &TouchedFace<N, D>,
) -> Option<usize> {
    if are_alike(&a.normal, &b.normal) {
        return None;
    }
    let (back, front) = match (place(a, b), place(b, a)) {
        (PlaneSide::Back, PlaneSide::Front) => (a, b),
        (PlaneSide::Front, PlaneSide::Back) => (b, a),
        _ => return None,
    };
    // A farther face hides nothing, so that the prediction never changes an overlap.
    (front.distance <= max(back.distance, N::ZERO)).then_some(back.contact)
}

/// Returns the side of the plane of one face that the other lies on, within rounding error.
fn place<N: Real, const D: usize>(
    part: &TouchedFace<N, D>,
    plane: &TouchedFace<N, D>,
) -> PlaneSide {
    let origin = plane.corners[0];
    let (mut low, mut high, mut level) = (N::INFINITY, -N::INFINITY, -N::INFINITY);
    let mut size = N::ZERO;
    for (corner, own) in part.corners.iter().zip(&plane.corners) {
        let (arm, own) = (corner - origin, own - origin);
        let rise = plane.normal.dot(&arm);
        (low, high) = (min(low, rise), max(high, rise));
        level = max(level, plane.normal.dot(&own));
        size = max(size, arm.norm_squared() + own.norm_squared());
    }
    let room = N::lit(ROUNDING) * N::EPSILON * N::TWO * size.sqrt();
    match (low - level < -room, high - level > room) {
        (true, false) => PlaneSide::Back,
        (false, true) => PlaneSide::Front,
        _ => PlaneSide::Across,
    }
}
