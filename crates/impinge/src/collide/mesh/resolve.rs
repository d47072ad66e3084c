//! Decides which contacts of parts are contacts of the whole shapes.

use smallvec::SmallVec;

use super::part_contact::{Arena, PartContact, PartStatus};
use super::scene::Scene;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Real, Space, Vector, max};

/// Normals with a larger cosine count as one direction.
const ALIKE: f64 = 0.99;

/// Ways out that are kept at a time, of different directions.
const MAX_WAYS: usize = 32;

/// A way out of the overlap, according to one contact: the second shape moves along `normal` by
/// `depth`.
struct WayOut<N: Real, const D: usize> {
    normal: Vector<N, D>,
    depth: N,
}

/// Ways out, added shallowest first; of each direction only the longest is kept.
struct Ways<N: Real, const D: usize>(SmallVec<[WayOut<N, D>; MAX_WAYS]>);

/// Drops the contacts that do not hold for the whole shapes.
///
/// Along the normal of a face the depth is that of the whole solid below the face. For a face that
/// is touched only at its rim this may be the width of the solid: a box on top of a cliff is not
/// deep in its wall. So the shallower of two explanations of an overlap holds. A contact with a
/// face is dropped if its parts are also separated once the shapes move along the normal of
/// another, shallower contact by the depth of that.
///
/// If no remaining contact is as near as the nearest two parts, the contact of these two is kept:
/// solids that overlap always have a contact.
pub(super) fn resolve<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contacts: &mut [PartContact<N, D>],
    arena: &mut Arena<N, D>,
) {
    if !arena.are_fronts {
        super::hidden::drop_hidden(scene, contacts);
    }
    let is_asked = |contact: &PartContact<N, D>| {
        matches!(contact.status, PartStatus::Snapped | PartStatus::Beyond)
    };
    if contacts.iter().any(is_asked) {
        leave_explained(scene, contacts, arena);
    }
    keep_one(contacts, arena);
}

/// Drops contacts with faces that other contacts explain: first those that are not beyond a ridge,
/// then those that are.
///
/// Cost: O(n log n) in the number of contacts, each compared with at most `MAX_WAYS` ways out.
fn leave_explained<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contacts: &mut [PartContact<N, D>],
    arena: &Arena<N, D>,
) {
    use PartStatus::{Beyond, Own, Snapped};
    for (explaining, asked) in [([Own; 2], Snapped), ([Own, Snapped], Beyond)] {
        let known = shallowest_first(contacts, |status| explaining.contains(&status));
        let (mut known, mut ways) = (known.into_iter().peekable(), Ways(SmallVec::new()));
        for (shallowness, index) in shallowest_first(contacts, |status| status == asked) {
            while let Some((_, other)) = known.next_if(|&(other, _)| other <= shallowness) {
                ways.add(&contacts[other as usize]);
            }
            let index = index as usize;
            if is_explained(scene, &contacts[index], &ways, arena) {
                contacts[index].status = PartStatus::Left;
            } else {
                ways.add(&contacts[index]);
            }
        }
    }
}

/// The depth of a contact; negative if it is apart.
fn depth<N: Real, const D: usize>(contact: &PartContact<N, D>) -> N {
    -contact.lowest
}

/// Returns the indices of the contacts with some statuses, sorted by depth, the shallowest first;
/// ties keep the order of the parts.
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

impl<N: Real, const D: usize> Ways<N, D> {
    /// Adds the way out of a contact that is at least as deep as all before. It replaces the one of
    /// about the same normal, or the first if there are too many.
    fn add(&mut self, contact: &PartContact<N, D>) {
        let (normal, depth) = (contact.piece.normal, depth(contact));
        if depth <= N::ZERO {
            return;
        }
        let is_alike = |way: &WayOut<N, D>| way.normal.dot(&normal) >= N::lit(ALIKE);
        if let Some(old) = self.0.iter().position(is_alike) {
            self.0.remove(old);
        } else if self.0.len() == MAX_WAYS {
            self.0.remove(0);
        }
        self.0.push(WayOut { normal, depth });
    }
}

/// Whether one of the ways out separates the two parts of a contact. A contact that is not beyond a
/// ridge is not explained by a way along its own normal.
fn is_explained<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    contact: &PartContact<N, D>,
    ways: &Ways<N, D>,
    arena: &Arena<N, D>,
) -> bool {
    let normal = contact.piece.normal;
    if depth(contact) <= contact.tolerance {
        return false;
    }
    let is_beyond = contact.status == PartStatus::Beyond;
    // A way shorter than the depth of the parts does not separate them.
    let least = -contact.distance - contact.tolerance;
    let is_asked = |way: &&WayOut<N, D>| {
        way.depth >= least && (is_beyond || way.normal.dot(&normal) < N::lit(ALIKE))
    };
    // The known separating plane of the parts may suffice after the motion.
    let rest = |way: &WayOut<N, D>| contact.distance + contact.normal.dot(&way.normal) * way.depth;
    let (mut asked, room): (SmallVec<[&WayOut<N, D>; 16]>, N) =
        (SmallVec::new(), -contact.tolerance);
    for way in ways.0.iter().filter(is_asked) {
        if rest(way) > room {
            return true;
        }
        asked.push(way);
    }
    // If a point of the part stays well inside the solid, they are not separated.
    let points = &arena.points[contact.piece.points.clone()];
    let mut shifts = SmallVec::<[Vector<N, D>; 16]>::new();
    for way in asked {
        let shift = way.normal * way.depth;
        let is_held = points.iter().any(|point| {
            let moved = point.point1 + normal * point.distance + shift;
            scene.is_within(&moved, N::TWO * contact.tolerance)
        });
        if !is_held {
            shifts.push(shift);
        }
    }
    !shifts.is_empty() && scene.pair(contact.parts()).is_parted_by_one(&shifts, contact.tolerance)
}

/// Adds the contact of the nearest two parts if all contacts that hold are farther. If they are
/// farther by rounding alone, their distance is corrected instead.
fn keep_one<N: Real, const D: usize>(contacts: &mut [PartContact<N, D>], arena: &mut Arena<N, D>) {
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
        _ => {
            // Its points, if any, are along the normal of a face and farther: they are computed
            // anew.
            contacts[nearest].status = PartStatus::Own;
            contacts[nearest].piece.points = 0..0;
        }
    }
}

/// Returns the index of the least value among the contacts, the first in a tie; contacts without a
/// value are skipped.
fn least_of<N: Real, const D: usize>(
    contacts: &[PartContact<N, D>],
    value: impl Fn(&PartContact<N, D>) -> Option<N>,
) -> Option<usize> {
    let all = contacts.iter().enumerate();
    let said = all.filter_map(|(index, contact)| Some((index, value(contact)?)));
    let least = said.reduce(|best, next| if next.1 < best.1 { next } else { best });
    least.map(|(index, _)| index)
}
