//! Tests the statements in the descriptions of samples about moving objects.

use std::collections::BTreeSet;

use impinge::math::Space;
use impinge::query::{PointQuery, distance};
use impinge::world::QueryFilter;

use super::support::{Object, Stage, choose, labelled, position, readout, running, set_number};

fn contact_points_lie_on_both<const D: usize>()
where
    f32: Stage<D>,
{
    let mut stack = running::<D>("stack");
    for _ in 0..300 {
        stack.advance().expect("it goes on");
        for (one, two, manifold) in stack.world().contact_views() {
            for point in manifold.contacts() {
                let gap = |object: &Object<D>, at| {
                    object.shape().distance_to_point(&position(object), at, false).abs()
                };
                let gaps = [gap(one, &point.contact.world1), gap(two, &point.contact.world2)];
                assert!(gaps.iter().all(|gap| *gap < 1e-4), "{gaps:?} at {}", stack.step());
            }
        }
    }
    for n in 0..8_u8 {
        let place = f32::pose(labelled(stack.world(), &format!("box {n}")).position()).translation;
        let height = place[1] - f32::from(n) - 0.5;
        assert!(height.abs() < 0.1 && place[0].abs() < 0.2, "box {n} stays where it is: {place}");
    }
    let per_pair = 1 << (D - 1);
    assert_eq!(readout(&stack, "Contact points"), (8 * per_pair).to_string(), "of whole faces");
}

#[test]
fn a_stack_stands_on_points_of_both_solids() {
    contact_points_lie_on_both::<2>();
    contact_points_lie_on_both::<3>();
}

fn comes_to_rest<const D: usize>()
where
    f32: Stage<D>,
{
    let mut pile = running::<D>("pile");
    for _ in 0..900 {
        pile.advance().expect("it goes on");
    }
    let number = |label| readout(&pile, label).parse::<f32>().expect("a number");
    assert!(number("Fastest body") < 0.2, "{} per second", number("Fastest body"));
    assert!(number("Deepest contact") < 0.05, "{} deep", number("Deepest contact"));
    for object in pile.world().collision_objects() {
        let place = f32::pose(object.position()).translation;
        assert!(place[1] > -0.1 && place[0].abs() < 4.0, "{} is at {place}", object.data());
    }
}

#[test]
fn a_pile_comes_to_rest_between_its_walls() {
    comes_to_rest::<2>();
    comes_to_rest::<3>();
}

fn keeps_its_distance<const D: usize>(speed: f64)
where
    f32: Stage<D>,
{
    let mut yard = running::<D>("character");
    set_number(&mut yard, "speed", speed);
    let mut least = f32::INFINITY;
    for _ in 0..600 {
        yard.advance().expect("it goes on");
        let body = labelled(yard.world(), "character");
        let others = QueryFilter::new().exclude(body.handle());
        let near = yard.world().closest_object(body.position(), &**body.shape(), 100.0, &others);
        least = least.min(near.expect("a wall is near").distance);
        assert!(least > 0.01, "{least} at step {}", yard.step());
    }
    assert!(least < 0.03, "it came to the walls: {least}");
}

#[test]
fn the_character_never_penetrates() {
    for speed in [3.0, 60.0] {
        keeps_its_distance::<2>(speed);
        keeps_its_distance::<3>(speed);
    }
}

fn never_pass<const D: usize>()
where
    f32: Stage<D>,
{
    let mut room = running::<D>("bullets");
    set_number(&mut room, "speed", 3000.0);
    for _ in 0..120 {
        room.advance().expect("it goes on");
        for n in 0..12 {
            let bullet = labelled(room.world(), &format!("bullet {n}"));
            let place = f32::pose(bullet.position()).translation;
            let is_left = place[0] < 0.0;
            assert_eq!(is_left, n % 2 == 0, "bullet {n} stays on its side: {place}");
            assert!(place.iter().all(|x| x.abs() < 5.0), "bullet {n} stays inside: {place}");
        }
    }
    let bounces: usize = readout(&room, "Reflections").parse().expect("a count");
    assert!(bounces > 1000, "{bounces} reflections");
}

#[test]
fn bullets_never_pass_walls() {
    never_pass::<2>();
    never_pass::<3>();
}

/// Returns the labels of the pairs of objects that overlap, by testing all pairs. Pairs of links
/// with a common joint and pairs of obstacles are excluded.
fn overlaps<const D: usize>(objects: &[&Object<D>]) -> BTreeSet<String>
where
    f32: Stage<D>,
{
    let link = |object: &Object<D>| object.data().strip_prefix("link ")?.parse::<i32>().ok();
    let mut pairs = BTreeSet::new();
    for (index, one) in objects.iter().enumerate() {
        for two in &objects[index + 1..] {
            let is_pair = match [link(one), link(two)] {
                [Some(one), Some(two)] => (one - two).abs() > 1,
                [None, None] => false,
                _ => true,
            };
            let (place1, place2) = (position(one), position(two));
            let apart = distance(&place1, &**one.shape(), &place2, &**two.shape());
            if is_pair && apart <= 0.0 {
                pairs.insert(format!("{} and {}", one.data(), two.data()));
            }
        }
    }
    pairs
}

fn marks_what_overlaps<const D: usize>()
where
    f32: Stage<D>,
{
    let mut arm = running::<D>("arm");
    let mut seen = 0;
    for _ in 0..600 {
        arm.advance().expect("it goes on");
        let objects: Vec<_> = arm.world().collision_objects().collect();
        let expected = overlaps(&objects);
        let marked = readout(&arm, "Collisions");
        let marked: BTreeSet<_> =
            marked.split(", ").filter(|text| *text != "none").map(str::to_owned).collect();
        assert_eq!(marked, expected, "at step {}", arm.step());
        seen += expected.len();
    }
    assert!(seen > 20, "{seen} collisions");
}

#[test]
fn the_arm_marks_the_links_that_overlap() {
    marks_what_overlaps::<2>();
    marks_what_overlaps::<3>();
}

fn turns_back<const D: usize>()
where
    f32: Stage<D>,
{
    let mut arm = running::<D>("arm");
    choose(&mut arm, "when", "it turns back");
    assert_eq!(readout(&arm, "Collisions"), "none", "it starts free");
    for _ in 0..600 {
        arm.advance().expect("it goes on");
        assert_eq!(readout(&arm, "Collisions"), "none", "at step {}", arm.step());
    }
}

#[test]
fn the_arm_can_turn_back_before_it_hits() {
    turns_back::<2>();
    turns_back::<3>();
}

fn closes_until_it_touches<const D: usize>(kind: &str)
where
    f32: Stage<D>,
{
    let mut gripper = running::<D>("gripper");
    choose(&mut gripper, "object", kind);
    let mut most = 0;
    for _ in 0..320 {
        gripper.advance().expect("it goes on");
        for (one, two, manifold) in gripper.world().contact_views() {
            let depth = manifold.deepest_contact().contact.depth;
            assert!(depth < 1e-3, "{} and {}: {depth} deep", one.data(), two.data());
        }
        let touching: usize = readout(&gripper, "Fingers that touch").parse().expect("a count");
        most = most.max(touching);
    }
    assert_eq!(most, 2, "both fingers touch the {kind}");
}

#[test]
fn the_gripper_stops_at_contact() {
    for kind in ["ball", "box", "capsule", "polygon", "rounded box", "ellipse"] {
        closes_until_it_touches::<2>(kind);
    }
    for kind in ["ball", "box", "capsule", "cylinder", "cone", "tetrahedron", "hull"] {
        closes_until_it_touches::<3>(kind);
    }
}

/// Returns the numbers of boxes, balls and capsules that entered their sensors, after one round of
/// the belt and after two.
fn entered<const D: usize>() -> [[i32; 3]; 2]
where
    f32: Stage<D>,
{
    let mut belt = running::<D>("conveyor");
    [1, 2].map(|_| {
        // The belt of length 14 moves by 2 per second: one round takes 420 steps.
        (0..420).for_each(|_| belt.advance().expect("it goes on"));
        ["Boxes that entered", "Balls that entered", "Capsules that entered"]
            .map(|label| readout(&belt, label).parse().expect("a count"))
    })
}

#[test]
fn each_piece_is_counted_once_a_round() {
    for [first, second] in [entered::<2>(), entered::<3>()] {
        let round = [0, 1, 2].map(|kind| second[kind] - first[kind]);
        assert_eq!(round, [4, 3, 3], "ten pieces of three kinds");
    }
}
