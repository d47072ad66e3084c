//! Look-up of the impulse that a contact had in the previous step.

use core::hash::Hash;
use std::collections::HashMap;

use impinge::math::{Vector, min};

use crate::{Body, Contact, Impulse, Turn};

/// The impulses of the previous step.
#[derive(Clone, Debug)]
pub enum Memory<N: Turn<D>, const D: usize, K> {
    /// Found by the ids of contacts, as in an engine.
    Ids(HashMap<K, Impulse<N, D>>),
    /// Found by positions, without ids: points of the same two bodies are paired, nearest first.
    /// The comparison shows how much of an instability is due to ids.
    Places(Vec<Place<N, D>>),
}

/// The position of a contact, and its impulse.
#[derive(Clone, Copy, Debug)]
pub struct Place<N: Turn<D>, const D: usize> {
    bodies: [usize; 2],
    /// The point on each body, in the frame of that body.
    own: [Vector<N, D>; 2],
    impulse: Impulse<N, D>,
}

impl<N: Turn<D>, const D: usize, K: Copy + Eq + Hash> Memory<N, D, K> {
    /// Creates an empty memory with look-up by ids.
    #[must_use]
    pub fn by_ids() -> Self {
        Self::Ids(HashMap::new())
    }

    /// Creates an empty memory with look-up by positions.
    #[must_use]
    pub fn by_place() -> Self {
        Self::Places(Vec::new())
    }

    /// Returns the start impulse of each contact, in order; zero for a contact that is not found.
    pub(crate) fn recalled(
        &self,
        bodies: &[Body<N, D>],
        contacts: &[Contact<N, D, K>],
    ) -> Vec<Impulse<N, D>> {
        let none = Impulse { normal: N::ZERO, friction: Vector::<N, D>::zeros() };
        match self {
            Self::Ids(map) => {
                contacts.iter().map(|contact| *map.get(&contact.id).unwrap_or(&none)).collect()
            }
            Self::Places(places) => {
                let mut found = vec![none; contacts.len()];
                for (new, old) in nearest_pairs(bodies, contacts, places) {
                    found[new] = places[old].impulse;
                }
                found
            }
        }
    }

    /// Stores the impulses of a step.
    pub(crate) fn store(
        &mut self,
        bodies: &[Body<N, D>],
        contacts: &[Contact<N, D, K>],
        impulses: impl Iterator<Item = Impulse<N, D>>,
    ) {
        let all = contacts.iter().zip(impulses);
        match self {
            Self::Ids(map) => {
                map.clear();
                map.extend(all.map(|(contact, impulse)| (contact.id, impulse)));
            }
            Self::Places(places) => {
                places.clear();
                places.extend(all.map(|(contact, impulse)| Place {
                    bodies: contact.bodies,
                    own: own_points(bodies, contact),
                    impulse,
                }));
            }
        }
    }
}

/// Returns the points of a contact in the frames of its bodies.
pub(crate) fn own_points<N: Turn<D>, const D: usize, K>(
    bodies: &[Body<N, D>],
    contact: &Contact<N, D, K>,
) -> [Vector<N, D>; 2] {
    [0, 1].map(|n| N::local_point(&bodies[contact.bodies[n]].pose, &contact.points[n]))
}

/// Returns the distance that a contact point has moved, on the body on which it has moved less.
pub(crate) fn way<N: Turn<D>, const D: usize>(
    [old1, old2]: &[Vector<N, D>; 2],
    [new1, new2]: &[Vector<N, D>; 2],
) -> N {
    min((old1 - new1).norm(), (old2 - new2).norm())
}

/// Returns the indices of a new and an old contact of the same bodies, for each pair found. An
/// index occurs at most once; the nearest contacts are paired first.
fn nearest_pairs<N: Turn<D>, const D: usize, K>(
    bodies: &[Body<N, D>],
    contacts: &[Contact<N, D, K>],
    places: &[Place<N, D>],
) -> Vec<(usize, usize)> {
    let mut candidates = Vec::new();
    for (new, contact) in contacts.iter().enumerate() {
        let own = own_points(bodies, contact);
        let pair = places.iter().enumerate().filter(|(_, place)| place.bodies == contact.bodies);
        candidates.extend(pair.map(|(old, place)| (way(&place.own, &own).as_f64(), new, old)));
    }
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut news, mut olds) = (vec![false; contacts.len()], vec![false; places.len()]);
    let mut chosen = Vec::new();
    for (_, new, old) in candidates {
        if !news[new] && !olds[old] {
            (news[new], olds[old]) = (true, true);
            chosen.push((new, old));
        }
    }
    chosen
}
