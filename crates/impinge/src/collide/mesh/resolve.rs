//! Decides which contacts of parts are contacts of the whole shapes.

use smallvec::SmallVec;

use super::at_side::move_to_side;
use super::forced::reach;
use super::part_contact::{Arena, PartContact, PartStatus};
use super::scene::Scene;
use crate::collide::ManifoldRequest;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Point, Real, Space, Vector, max, min};
use crate::shape::Kind;
use crate::tables::ByDimension;

/// Smallest cosine of the angle between two normals that count as one direction.
const ALIKE: f64 = 0.99;

/// Largest number of escapes kept at a time; no two of them have about the same direction.
const MAX_ESCAPES: usize = 32;

/// A translation that resolves the overlap, according to one contact: the second shape moves by
/// `depth` along the unit vector `normal`, which is in the frame of the first shape.
struct Escape<N: Real, const D: usize> {
    normal: Vector<N, D>,
    depth: N,
}

impl<N: Real, const D: usize> Escape<N, D> {
    /// A contact that only touches has an escape without length.
    fn of(contact: &PartContact<N, D>) -> Self {
        Self { normal: contact.piece.normal, depth: max(depth(contact), N::ZERO) }
    }

    /// Returns whether the parts of a contact are apart along their own normal after the motion,
    /// which proves that the escape separates them.
    fn certainly_parts(&self, contact: &PartContact<N, D>) -> bool {
        let rest = contact.distance + contact.normal.dot(&self.normal) * self.depth;
        rest > -contact.tolerance
    }
}

/// Escapes in the order of their depths, the shallowest first. Only the deepest of several escapes
/// with about the same direction is kept.
struct Escapes<N: Real, const D: usize>(SmallVec<[Escape<N, D>; MAX_ESCAPES]>);

/// Drops the contacts that do not hold for the whole shapes.
///
/// Along the normal of a face, the depth is that of the whole solid below the face. For a face that
/// is touched only at its rim, this depth may be the width of the solid: a box on top of a cliff is
/// not deep in the cliff's wall. So the shallower of two explanations of an overlap holds. A
/// contact with a face is dropped if its parts are also separated once the second shape moves along
/// the normal of another, shallower contact by the depth of that contact.
///
/// If no remaining contact is as near as the nearest two parts, the contact of these two parts is
/// kept. So solids that overlap always have a contact, except beside a ghost (a part that stands
/// for a part of a neighbouring shape): there, the neighbouring shape has the contact.
pub(super) fn resolve<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    request: &ManifoldRequest<N>,
    contacts: &mut [PartContact<N, D>],
    arena: &mut Arena<N, D>,
) {
    let drop_hidden = |contacts: &mut [PartContact<N, D>], arena: &Arena<N, D>| {
        if !arena.are_fronts {
            super::hidden::drop_hidden(scene, contacts);
        }
    };
    drop_hidden(contacts, arena);
    if contacts.iter().any(is_forced) {
        leave_explained(scene, contacts, arena);
    }
    let are_reached = reach_missed(scene, request, contacts, arena);
    if are_reached {
        drop_hidden(contacts, arena);
    }
    if move_to_sides(scene, request, contacts, arena) || are_reached {
        leave_explained(scene, contacts, arena);
    }
    keep_one(scene, contacts, arena);
}

/// Returns whether a contact is along the normal of a face that the seam forced on it.
fn is_forced<N: Real, const D: usize>(contact: &PartContact<N, D>) -> bool {
    matches!(contact.status, PartStatus::Snapped | PartStatus::Beyond)
}

/// Drops each contact that another contact explains: the escape of the other contact separates the
/// two parts. First drops `Snapped` contacts, then `Beyond` contacts. Only a contact that is not
/// deeper can explain another.
///
/// Cost: O(n log n) in the number of contacts; each is compared with at most `MAX_ESCAPES` escapes.
fn leave_explained<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contacts: &mut [PartContact<N, D>],
    arena: &Arena<N, D>,
) {
    use PartStatus::{Beyond, Own, Snapped};
    for (explaining, explained) in [([Own; 2], Snapped), ([Own, Snapped], Beyond)] {
        let known = shallowest_first(contacts, |status| explaining.contains(&status));
        let (mut known, mut escapes) = (known.into_iter().peekable(), Escapes(SmallVec::new()));
        for (shallowness, index) in shallowest_first(contacts, |status| status == explained) {
            while let Some((_, other)) = known.next_if(|&(other, _)| other <= shallowness) {
                escapes.add(&contacts[other as usize]);
            }
            let index = index as usize;
            if is_explained(scene, &contacts[index], &escapes, arena) {
                contacts[index].status = PartStatus::Left;
            } else {
                escapes.add(&contacts[index]);
            }
        }
    }
}

/// Computes the missed contacts of a convex solid that no other contact explains ([`reach`]), and
/// drops the others. Returns whether any was computed.
fn reach_missed<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    request: &ManifoldRequest<N>,
    contacts: &mut [PartContact<N, D>],
    arena: &mut Arena<N, D>,
) -> bool {
    use PartStatus::{Left, Missed};
    if contacts.iter().all(|contact| contact.status != Missed) {
        return false;
    }
    let is_held = |status| !matches!(status, Left | Missed);
    // Two composites have many missed contacts, which are not worth their cost there. For a convex
    // solid, the deepest contact alone explains most of them.
    let is_convex = scene.first_is_convex();
    let deepest = least_of(contacts, |contact| is_held(contact.status).then_some(contact.lowest));
    let deepest = deepest.map(|index| Escape::of(&contacts[index]));
    let (mut are_open, mut is_any) = (false, false);
    for contact in contacts.iter_mut().filter(|contact| contact.status == Missed) {
        let is_parted = deepest.as_ref().is_some_and(|deepest| deepest.certainly_parts(contact));
        let is_open = is_convex && !is_parted;
        contact.status = if is_open { Missed } else { Left };
        are_open |= is_open;
    }
    if !are_open {
        return false;
    }
    let held = Escapes::of(contacts, is_held);
    for contact in contacts.iter_mut().filter(|contact| contact.status == Missed) {
        if is_explained(scene, contact, &held, arena) {
            contact.status = Left;
        } else {
            reach(scene, request, contact, arena);
            is_any |= contact.status != Left;
        }
    }
    is_any
}

/// Replaces contacts with faces that are more than twice as deep as their parts by contacts with
/// sides of these parts ([`move_to_side`]), unless a contact with its parts' own normal is about as
/// deep along the same normal. Returns whether any was replaced.
fn move_to_sides<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    request: &ManifoldRequest<N>,
    contacts: &mut [PartContact<N, D>],
    arena: &mut Arena<N, D>,
) -> bool {
    let is_deeper = |contact: &PartContact<N, D>| {
        is_forced(contact) && depth(contact) > contact.tolerance - N::TWO * contact.distance
    };
    if !(scene.first_is_convex() && contacts.iter().any(is_deeper)) {
        return false;
    }
    let own = Escapes::of(contacts, |status| status == PartStatus::Own);
    let mut is_changed = false;
    for contact in contacts.iter_mut().filter(|contact| is_deeper(contact)) {
        let (normal, deepest) = (contact.piece.normal, depth(contact) - contact.tolerance);
        let is_confirmed = |escape: &Escape<N, D>| {
            escape.depth >= deepest && escape.normal.dot(&normal) >= N::lit(ALIKE)
        };
        if !own.0.iter().any(is_confirmed) {
            is_changed |= move_to_side(scene, request, contact, deepest, arena);
        }
    }
    is_changed
}

/// Returns the depth of a contact's deepest point; negative if this point is apart.
fn depth<N: Real, const D: usize>(contact: &PartContact<N, D>) -> N {
    -contact.lowest
}

/// Returns the indices of the contacts whose status satisfies `is_meant`, sorted by depth, the
/// shallowest first; ties keep the order of the contacts.
fn shallowest_first<N: Real, const D: usize>(
    contacts: &[PartContact<N, D>],
    is_meant: impl Fn(PartStatus) -> bool,
) -> SmallVec<[(u64, u32); 16]> {
    let mut order = SmallVec::with_capacity(contacts.len());
    for (contact, index) in contacts.iter().zip(0..) {
        if is_meant(contact.status) {
            order.push((order_of(depth(contact)), index));
        }
    }
    sort_keyed(&mut order);
    order
}

impl<N: Real, const D: usize> Escapes<N, D> {
    /// Returns the escapes of the contacts whose status satisfies `is_meant`.
    fn of(contacts: &[PartContact<N, D>], is_meant: impl Fn(PartStatus) -> bool) -> Self {
        let mut escapes = Self(SmallVec::new());
        for (_, index) in shallowest_first(contacts, is_meant) {
            escapes.add(&contacts[index as usize]);
        }
        escapes
    }

    /// Adds the escape of a contact that is at least as deep as all contacts added before. The new
    /// escape replaces the escape with about the same normal or, if there are [`MAX_ESCAPES`], the
    /// shallowest. Contacts that only touch count: the sides of a box flush with the wall of a block
    /// are explained by the contact with the top of the block.
    fn add(&mut self, contact: &PartContact<N, D>) {
        if depth(contact) < -contact.tolerance {
            return;
        }
        let added = Escape::of(contact);
        let is_alike = |escape: &Escape<N, D>| escape.normal.dot(&added.normal) >= N::lit(ALIKE);
        if let Some(old) = self.0.iter().position(is_alike) {
            self.0.remove(old);
        } else if self.0.len() == MAX_ESCAPES {
            self.0.remove(0);
        }
        self.0.push(added);
    }
}

/// Returns whether one of the escapes separates the two parts of a contact. A `Snapped` contact is
/// not explained by an escape along its own normal. `false` for a contact without overlap beyond
/// rounding.
fn is_explained<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contact: &PartContact<N, D>,
    escapes: &Escapes<N, D>,
    arena: &Arena<N, D>,
) -> bool {
    let normal = contact.piece.normal;
    if depth(contact) <= contact.tolerance {
        return false;
    }
    let is_any_normal = contact.status != PartStatus::Snapped;
    // An escape that is shorter than the depth of the parts does not separate the parts.
    let least = -contact.distance - contact.tolerance;
    let is_relevant = |escape: &&Escape<N, D>| {
        escape.depth >= least && (is_any_normal || escape.normal.dot(&normal) < N::lit(ALIKE))
    };
    let mut relevant = SmallVec::<[&Escape<N, D>; 16]>::new();
    for escape in escapes.0.iter().filter(is_relevant) {
        if escape.certainly_parts(contact) {
            return true;
        }
        relevant.push(escape);
    }
    // If a point of the part stays well inside the solid, the motion does not separate part and
    // solid.
    let points = &arena.points[contact.piece.points.clone()];
    let mut shifts = SmallVec::<[Vector<N, D>; 16]>::new();
    for escape in relevant {
        let shift = escape.normal * escape.depth;
        let is_held = points.iter().any(|point| {
            let moved = point.point1 + normal * point.distance + shift;
            is_within(scene.between.pair.first, &moved, N::TWO * contact.tolerance)
        });
        if !is_held {
            shifts.push(shift);
        }
    }
    !shifts.is_empty() && scene.pair(contact.parts()).is_parted_by_one(&shifts, contact.tolerance)
}

/// Returns whether a point, in the frame of the solid, lies in it deeper than `depth`. Then a
/// translation of length up to `depth` does not move the point out of the solid. `false` for
/// composites and half-spaces.
fn is_within<N: Space<D>, const D: usize>(
    solid: Kind<'_, N, D>,
    point: &Point<N, D>,
    depth: N,
) -> bool {
    match solid {
        Kind::Composite(_) | Kind::Plane(_) => false,
        Kind::Cuboid(cuboid) => (0..D).all(|axis| {
            let half = cuboid.half_extents()[axis];
            min(half - point[axis], point[axis] + half) > depth
        }),
        // A hull without faces is a segment or a point.
        Kind::Polytope(hull) => {
            let mut faces = hull.faces().iter();
            !hull.faces().is_empty()
                && faces.all(|face| face.offset - face.normal.dot(&point.coords) > depth)
        }
        first => {
            let found = <N::Algorithms>::surface_point(first, point);
            found.is_inside && (found.point - point).norm() > depth
        }
    }
}

/// Restores the contact of the nearest two parts if all contacts that hold are farther. If the
/// nearest contact that holds is farther only by rounding, the distances of its points are
/// corrected instead. Changes nothing if a ghost is nearer: the neighbouring shape that the ghost
/// represents has the contact.
fn keep_one<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contacts: &mut [PartContact<N, D>],
    arena: &mut Arena<N, D>,
) {
    let nearest = least_of(contacts, |contact| Some(contact.distance));
    let Some(nearest) = nearest else { return };
    let (least, tolerance) =
        (max(contacts[nearest].distance, N::ZERO), contacts[nearest].tolerance);
    let kept = least_of(contacts, |contact| {
        (contact.status != PartStatus::Left).then_some(contact.lowest)
    });
    match kept.map(|index| (index, contacts[index].lowest)) {
        Some((_, lowest)) if lowest <= least => {}
        Some((index, lowest)) if lowest <= least + tolerance => {
            for point in &mut arena.points[contacts[index].piece.points.clone()] {
                point.distance = max(point.distance - lowest, N::ZERO) + least;
            }
            contacts[index].lowest = least;
        }
        _ if is_of_neighbour(scene, &contacts[nearest]) => {}
        _ => {
            // The points of this contact, if it has any, are along the normal of a face and
            // farther. So they are computed again.
            contacts[nearest].status = PartStatus::Own;
            contacts[nearest].piece.points = 0..0;
        }
    }
}

/// Returns whether a ghost beside the parts of a contact is nearer than these. At equal distances a
/// touching contact is left to the neighbouring shape, since its normal would be that of an inner
/// edge. Of equal overlaps the part with the lower index has the contact: a ghost that comes after
/// the part in one tile comes before it in the neighbouring tile, which has the same overlap.
fn is_of_neighbour<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contact: &PartContact<N, D>,
) -> bool {
    let (distance, tolerance, mut is_nearer) = (contact.distance, contact.tolerance, false);
    scene.each_ghost_beside(contact.parts(), &mut |ghosts| {
        let pair = scene.pair(ghosts);
        let found = <N::Algorithms>::separation(&pair.pair(), distance + tolerance);
        let is_clear = |found: N| found < distance - tolerance;
        let is_before = || distance > -tolerance || ghosts < contact.parts();
        is_nearer |= found.is_some_and(|found| is_clear(found.distance) || is_before());
    });
    is_nearer
}

/// Returns the index of the contact with the smallest value, the first in a tie. Contacts without a
/// value are skipped; `None` if no contact has one.
fn least_of<N: Real, const D: usize>(
    contacts: &[PartContact<N, D>],
    value: impl Fn(&PartContact<N, D>) -> Option<N>,
) -> Option<usize> {
    let all = contacts.iter().enumerate();
    let values = all.filter_map(|(index, contact)| Some((index, value(contact)?)));
    let least = values.reduce(|best, next| if next.1 < best.1 { next } else { best });
    least.map(|(index, _)| index)
}
