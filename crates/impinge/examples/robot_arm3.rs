//! A robot arm of four links is checked in a few poses: does it hit itself, does it hit the pillar beside it, and if
//! neither, how near does it come? Links that share a joint always touch there, so a pair filter rejects these
//! pairs. The distance from obstacles is the least over all links. The output has one verdict for each pose.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use impinge::dim3::prelude::*;

/// What an object is. Links are numbered from the base.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Thing {
    Link(u32),
    Pillar,
}

type World = CollisionWorld<f64, Thing>;
type Object = CollisionObject<f64, Thing>;

const LINKS: usize = 4;
/// Each link is a capsule: its axis has length 1, from joint to joint.
const RADIUS: f64 = 0.125;

/// All pairs but those of links that share a joint.
fn may_touch(object1: &Object, object2: &Object) -> bool {
    match (*object1.data(), *object2.data()) {
        (Thing::Link(one), Thing::Link(two)) => one.abs_diff(two) > 1,
        _ => true,
    }
}

/// The arm, and a pillar of 0.5 × 4 × 0.5 whose axis is 1 from that of the base.
fn build() -> (World, Vec<CollisionObjectHandle>) {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
    world.register_broad_phase_pair_filter("joints", may_touch);
    let pillar = ShapeHandle::new(Cuboid::new(Vector::new(0.25, 2.0, 0.25)));
    world.add(Isometry::translation(1.0, 2.0, 0.0), pillar, groups, query, Thing::Pillar);
    let link = ShapeHandle::new(Capsule::new(0.5, RADIUS));
    let links = (0..)
        .take(LINKS)
        .map(|n| world.add(Isometry::identity(), link.clone(), groups, query, Thing::Link(n)))
        .collect();
    (world, links)
}

/// Where the links are. The base turns the arm about the vertical; each joint bends it on about the z axis
/// that the base has turned, to the left for positive angles.
fn pose(base: f64, joints: [f64; LINKS]) -> [Isometry<f64>; LINKS] {
    let mut joint = Isometry::rotation(Vector::y() * base);
    joints.map(|angle| {
        joint *= Isometry::rotation(Vector::z() * angle);
        let middle = joint * Isometry::translation(0.0, 0.5, 0.0);
        joint *= Isometry::translation(0.0, 1.0, 0.0);
        middle
    })
}

/// The result for one pose.
#[derive(Debug, PartialEq)]
enum Verdict {
    Hits(Thing, Thing),
    Free { distance: f64 },
}

fn check(world: &mut World, links: &[CollisionObjectHandle], poses: &[Isometry<f64>]) -> Verdict {
    for (link, pose) in links.iter().zip(poses) {
        world.set_position(*link, *pose);
    }
    world.update();
    if let Some((object1, object2, _)) = world.contact_manifolds().next() {
        return Verdict::Hits(*object1.data(), *object2.data());
    }
    let is_obstacle = |object: &Object| !matches!(object.data(), Thing::Link(_));
    let (obstacles, link) = (QueryFilter::new().predicate(&is_obstacle), Capsule::new(0.5, RADIUS));
    // The limit shrinks to the best so far, so that most links are rejected by their boxes.
    let nearer = |best, pose: &Isometry<f64>| {
        world.closest_object(pose, &link, best, &obstacles).map_or(best, |found| found.distance)
    };
    Verdict::Free { distance: poses.iter().fold(f64::INFINITY, nearer) }
}

fn main() {
    let (mut world, links) = build();
    let right = -FRAC_PI_2;
    let poses = [
        ("straight up", 0.0, [0.0; LINKS]),
        ("over to the right", 0.0, [0.0, right, 0.0, 0.0]),
        ("over to the left", 0.0, [0.0, -right, 0.0, 0.0]),
        ("the same, turned half around", 2.0 * FRAC_PI_2, [0.0, -right, 0.0, 0.0]),
        ("curled up to the left", 0.0, [0.0, -right, -right, -right]),
        ("to the right, past the corner", FRAC_PI_4, [right, 0.0, 0.0, 0.0]),
    ];
    let mut verdicts = Vec::new();
    for (name, base, joints) in poses {
        let verdict = check(&mut world, &links, &pose(base, joints));
        println!("{name:30} {verdict:.3?}");
        verdicts.push(verdict);
    }

    let is_free = |verdict: &Verdict, by_hand: f64| match verdict {
        Verdict::Free { distance } => (distance - by_hand).abs() < 1e-12,
        Verdict::Hits(..) => false,
    };
    // The pillar's near face is 0.75 from the axis of the upright links.
    assert!(is_free(&verdicts[0], 0.75 - RADIUS), "straight up it is beside the pillar");
    assert_eq!(
        verdicts[1],
        Verdict::Hits(Thing::Pillar, Thing::Link(1)),
        "the second link is in it"
    );
    assert!(is_free(&verdicts[2], 0.75 - RADIUS), "to the left it goes away from it");
    assert_eq!(verdicts[3], verdicts[1], "half a turn makes left right");
    assert_eq!(
        verdicts[4],
        Verdict::Hits(Thing::Link(0), Thing::Link(3)),
        "the last meets the first"
    );
    // At 45° to the face, the nearest edge of the pillar is at (0.75, ±0.25): (0.75 − 0.25) / √2 from the axis.
    assert!(is_free(&verdicts[5], 0.5 / 2.0_f64.sqrt() - RADIUS), "by the edge of the pillar");
}
