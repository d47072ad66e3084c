//! Describes an object, and the state of a world at a step.

use impinge::bounding_volume::Aabb;
use impinge::math::{Real, Space, max};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, GeometricQueryType};
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_record::RecordData;

use crate::answer::{Ends, ObjectAnswer, ShownPair, ShownQuery, Status, StatusEvent};
use crate::explain::proximity_text;
use crate::groups;
use crate::shape_text::shape_text;
use crate::space::{Viewed, coordinates};

/// The maximum number of events listed in a status. The status also has the number of all events.
const MAX_EVENTS: usize = 200;

/// The maximum number of bytes in the label of data that is not text.
const MAX_BYTES: usize = 16;

/// Returns the object whose handle has the index `number`; `None` if there is none. The page does
/// not have the generation of the handle, so all objects are searched.
pub(crate) fn object_of<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    number: u32,
) -> Option<&CollisionObject<N, D, T>> {
    world.collision_objects().find(|object| object.handle().uid() == number as usize)
}

/// Returns the description of an object.
pub(crate) fn object_answer<N: Viewed<D>, const D: usize, T: RecordData>(
    world: &CollisionWorld<N, D, T>,
    object: &CollisionObject<N, D, T>,
) -> ObjectAnswer {
    let (handle, position) = (object.handle(), object.position());
    ObjectAnswer {
        object: handle.uid(),
        shape: shape_text(&**object.shape()),
        label: label(&object.data().to_bytes()),
        translation: coordinates(&N::translation(position)),
        rotation: N::quaternion(position),
        groups: groups::shown(object.collision_groups()),
        query: shown_query(object.query_type()),
        tight_box: ends(&object.shape().aabb(&N::pose(position))),
        loosened_box: world.loosened_aabb(handle).as_ref().and_then(ends),
        pairs: pairs(world, handle),
    }
}

/// Returns the corners of a box with the least and the greatest coordinates; `None` if the box is
/// unbounded.
fn ends<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> Ends {
    let corners = [aabb.mins(), aabb.maxs()].map(|point| coordinates(&point.coords));
    aabb.is_bounded().then_some(corners)
}

/// Returns the data of an object as a label: text if it is UTF-8 without control characters,
/// otherwise the first bytes in hexadecimal.
fn label(bytes: &[u8]) -> String {
    let text = str::from_utf8(bytes).ok();
    if let Some(text) = text.filter(|text| !text.chars().any(char::is_control)) {
        return text.to_owned();
    }
    let shown = bytes.iter().take(MAX_BYTES).map(|byte| format!("{byte:02x}"));
    let rest = if bytes.len() > MAX_BYTES { "…" } else { "" };
    format!("{}{rest}", shown.collect::<String>())
}

fn shown_query<N: Real>(query: GeometricQueryType<N>) -> ShownQuery {
    match query {
        GeometricQueryType::Contacts(linear, angular) => {
            ShownQuery::Contacts { linear: linear.as_f64(), angular: angular.as_f64() }
        }
        GeometricQueryType::Proximity(margin) => ShownQuery::Proximity { margin: margin.as_f64() },
    }
}

/// Returns the pairs of an object that have contacts, or a proximity other than disjoint, sorted by
/// the handles of the other objects. An object that is tested against itself is its own partner.
fn pairs<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    handle: CollisionObjectHandle,
) -> Vec<ShownPair> {
    // The contacts with one object are consecutive, so `dedup` leaves each object once.
    let mut partners: Vec<_> =
        world.contacts_with(handle).map(|(other, _)| other.handle()).collect();
    partners.dedup();
    let contacts = partners.into_iter().filter_map(|other| {
        let pair = world.contact_pair(handle, other)?;
        // The depth of a pair is the largest depth of all its manifolds.
        let deepest = pair.views().map(|view| view.deepest_contact().contact.depth).reduce(max)?;
        let (object, contacts, depth) = (other.uid(), pair.num_contacts(), deepest.as_f64());
        Some((other, ShownPair::Contacts { object, contacts, depth, touching: contacts > 0 }))
    });
    let near = world.proximities_with(handle).map(|(other, proximity)| {
        let (object, status) = (other.handle().uid(), proximity_text(proximity));
        (other.handle(), ShownPair::Proximity { object, status })
    });
    let mut pairs: Vec<_> = contacts.chain(near).collect();
    pairs.sort_by_key(|(other, _)| *other);
    pairs.into_iter().map(|(_, pair)| pair).collect()
}

/// Returns the state of a world. Members that only recordings or samples have are empty.
pub(crate) fn status<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    step: usize,
) -> Status {
    let contacts = world.contact_events().iter().map(|event| {
        let (a, b) = event.handles();
        let started = matches!(event, ContactEvent::Started(..));
        StatusEvent::Contact { started, a: a.uid(), b: b.uid() }
    });
    let proximities = world.proximity_events().iter().map(|event| StatusEvent::Proximity {
        a: event.collider1.uid(),
        b: event.collider2.uid(),
        before: proximity_text(event.prev_status),
        after: proximity_text(event.new_status),
    });
    // The events of contacts precede those of proximities; the limit applies to the whole list.
    Status {
        step,
        objects: world.len(),
        pairs: world.contact_pairs().count() + world.proximity_pairs().count(),
        contacts: world.contact_views().map(|(_, _, view)| view.len()).sum(),
        diverged: None,
        notes: Vec::new(),
        events: contacts.chain(proximities).take(MAX_EVENTS).collect(),
        event_count: world.contact_events().len() + world.proximity_events().len(),
        controls: Vec::new(),
        readouts: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_text_where_they_can_be() {
        assert_eq!(label("Kiste 3 ☃".as_bytes()), "Kiste 3 ☃");
        assert_eq!(label(&[3, 0, 0, 0]), "03000000");
        assert_eq!(label(&[0xff; 20]), format!("{}…", "ff".repeat(16)));
        assert_eq!(label(&[]), "");
    }
}
