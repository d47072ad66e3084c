//! Two automatic doors, each with a sensor: an area with a proximity query. A door is open while
//! somebody is in its area, by a count that is updated from proximity events only. The last visitor
//! is removed inside an area; this causes an event too, so the count returns to zero. The output
//! lists when the doors open and close.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::prelude::*;

/// The data of an object.
enum Thing {
    Sensor { door: &'static str, inside: u32 },
    Visitor,
}

type World = CollisionWorld<f32, Thing>;

/// Returns the groups. Visitors are in group 0. Sensors are in group 1 and interact with group 0
/// only, so that they ignore each other.
fn groups() -> (CollisionGroups, CollisionGroups) {
    let visitors = CollisionGroups::new().with_membership(&[0]);
    let sensors = CollisionGroups::new().with_membership(&[1]).with_whitelist(&[0]);
    (visitors, sensors)
}

/// Updates the count of a sensor. Returns the line to print if its door moves.
fn note(world: &mut World, event: ProximityEvent) -> Option<String> {
    // Either object may be the sensor. A removed visitor has no object any more, only its handle is
    // in the event.
    for handle in [event.collider1, event.collider2] {
        let Some(object) = world.collision_object_mut(handle) else { continue };
        let Thing::Sensor { door, inside } = object.data_mut() else { continue };
        let was_open = *inside > 0;
        *inside += u32::from(event.new_status == Proximity::Intersecting);
        *inside -= u32::from(event.prev_status == Proximity::Intersecting);
        let verb = if *inside > 0 { "opens" } else { "closes" };
        return (was_open != (*inside > 0)).then(|| format!("the {door} door {verb}"));
    }
    None
}

fn main() {
    let mut world = World::new(0.02);
    let (visitor_groups, sensor_groups) = groups();
    // The areas are 4 wide, around x = 0 and x = 10.
    let area = ShapeHandle::new(Cuboid::new(Vector::new(2.0, 2.0)));
    for (door, x) in [("first", 0.0), ("second", 10.0)] {
        let sensor = Thing::Sensor { door, inside: 0 };
        let position = Isometry::translation(x, 0.0);
        world.add(position, area.clone(), sensor_groups, ProximityQuery::default(), sensor);
    }
    // Two visitors of radius 0.5 walk along the x axis by one unit per step.
    let body = ShapeHandle::new(Ball::new(0.5));
    let starts = [-5.0, -8.0];
    let visitors = starts.map(|x| {
        let position = Isometry::translation(x, 0.0);
        world.add(position, body.clone(), visitor_groups, ContactQuery::default(), Thing::Visitor)
    });

    let mut log = Vec::new();
    for step in 0_u8..=20 {
        for (visitor, start) in visitors.into_iter().zip(starts) {
            if world.contains(visitor) {
                world.set_position(visitor, Isometry::translation(start + f32::from(step), 0.0));
            }
        }
        if step == 19 {
            world.remove(&visitors[1..]);
        }
        world.update();
        // The events are copied, since counting changes the world.
        for event in world.proximity_events().to_vec() {
            log.extend(note(&mut world, event).map(|line| format!("step {step:2}: {line}")));
        }
    }
    println!("{}", log.join("\n"));

    // A visitor intersects an area while their centers are less than 2.5 apart. At each step the
    // first visitor is at x = step − 5, the second at x = step − 8. The second one is removed at x
    // = 11.
    let expected = [
        "step  3: the first door opens",
        "step 11: the first door closes",
        "step 13: the second door opens",
        "step 19: the second door closes",
    ];
    assert_eq!(log, expected, "the doors are open while somebody is near");
}
