//! Which of the contacts of the parts are contacts of the whole.

use smallvec::SmallVec;

use super::part_contact::{Arena, PartContact, PartStatus};
use super::scene::Scene;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Real, Space, Vector, max};

/// Normals whose cosine is above this say the same.
const ALIKE: f64 = 0.99;

/// So many ways of different directions are known at a time.
const MAX_WAYS: usize = 32;

/// A way to part the two shapes as far as some of their parts know: a normal and a depth along it.
struct WayOut<N: Real, const D: usize> {
    normal: Vector<N, D>,
    depth: N,
}

/// Ways to part the shapes, found shallowest first: the longest of each direction.
struct Ways<N: Real, const D: usize>(SmallVec<[WayOut<N, D>; MAX_WAYS]>);

/// Leaves the contacts that hold for the whole.
///
/// Along the normal of a face the depth is that of the whole solid below the face, which for a face
/// that is met at its rim only may be the width of the solid: a box on the top of a cliff is not
/// deep in its wall. So of two explanations of an overlap the shallower holds: what is left out is a
/// contact with a face whose part comes free as well when the solids are parted along the normal of
/// another contact by that one's depth, where that is less.
///
/// If nothing else says how near the solids are, what the nearest two parts say on their own holds:
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

/// Leaves out contacts with faces that other contacts explain, first such as are none beyond a ridge.
///
/// Cost: O(n log n) in the number of contacts, each held against a limited number of ways.
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

/// How deep a contact is.
fn depth<N: Real, const D: usize>(contact: &PartContact<N, D>) -> N {
    -contact.lowest
}

/// The indices of the contacts with some statuses, each with its place in the order of depths; of equals that
/// with the first parts comes first.
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
    /// Adds a contact that is no shallower than those before, in the place of one along about its
    /// normal; or, where there are too many, of the one that was first.
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

/// Another way parts the two parts too: one that is no longer, and of a contact with a face that
/// is not beyond a ridge one that leads elsewhere.
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
    // A way that is shorter than the parts are deep in each other does not part them.
    let least = -contact.distance - contact.tolerance;
    let is_asked = |way: &&WayOut<N, D>| {
        way.depth >= least && (is_beyond || way.normal.dot(&normal) < N::lit(ALIKE))
    };
    // The plane that is known to part the two best may do so well enough once they are moved.
    let rest = |way: &WayOut<N, D>| contact.distance + contact.normal.dot(&way.normal) * way.depth;
    let (mut asked, room): (SmallVec<[&WayOut<N, D>; 16]>, N) =
        (SmallVec::new(), -contact.tolerance);
    for way in ways.0.iter().filter(is_asked) {
        if rest(way) > room {
            return true;
        }
        asked.push(way);
    }
    // A point of the part that is still well within the solid says that they are not parted.
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

/// If the contacts that hold are farther than the nearest two parts, adds that of these. What is
/// apart by rounding only, where parts touch, is made to touch.
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
            // Points that it has are of a face's normal, and farther.
            contacts[nearest].status = PartStatus::Own;
            contacts[nearest].piece.points = 0..0;
        }
    }
}

/// The index of the least of some number of the contacts, the first of equals.
fn least_of<N: Real, const D: usize>(
    contacts: &[PartContact<N, D>],
    value: impl Fn(&PartContact<N, D>) -> Option<N>,
) -> Option<usize> {
    let all = contacts.iter().enumerate();
    let said = all.filter_map(|(index, contact)| Some((index, value(contact)?)));
    let least = said.reduce(|best, next| if next.1 < best.1 { next } else { best });
    least.map(|(index, _)| index)
}
