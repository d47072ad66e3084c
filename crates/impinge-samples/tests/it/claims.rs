//! Tests the statements in the descriptions of samples about worlds and pairs of shapes.

use impinge_samples::ControlValue;

use super::support::{Stage, choose, readout, running, set_number};

fn every_pair_touches<const D: usize>()
where
    f32: Stage<D>,
{
    let mut grid = running::<D>("pairs");
    for _ in 0..60 {
        grid.advance().expect("it goes on");
        let touching = readout(&grid, "Pairs with contacts");
        assert_eq!(touching, readout(&grid, "Pairs of kinds"), "at step {}", grid.step());
    }
}

#[test]
fn every_pair_of_kinds_has_contacts() {
    every_pair_touches::<2>();
    every_pair_touches::<3>();
}

/// Returns the maximum of 1 − |y| over all normals on the path over the floor and back.
fn greatest_lean<const D: usize>(contacts: &str) -> f32
where
    f32: Stage<D>,
{
    let mut floor = running::<D>("floor");
    choose(&mut floor, "contacts", contacts);
    let (mut lean, mut seen) = (0.0_f32, 0);
    for _ in 0..600 {
        floor.advance().expect("it goes on");
        for (_, _, manifold) in floor.world().contact_views() {
            let normal = manifold.normal();
            seen += 1;
            lean = lean.max(1.0 - normal[1].abs());
        }
    }
    assert!(seen >= 600, "it touches the floor at each step");
    lean
}

#[test]
fn normals_on_the_floor_stay_vertical() {
    let leans = [greatest_lean::<2>("of the surface"), greatest_lean::<3>("of the surface")];
    assert!(leans.iter().all(|lean| *lean < 1e-6), "{leans:?}");
}

#[test]
fn triangles_by_themselves_make_bumps() {
    let leans = [greatest_lean::<2>("of each triangle"), greatest_lean::<3>("of each triangle")];
    assert!(leans.iter().all(|lean| *lean > 0.1), "{leans:?}");
}

fn scales_exactly<const D: usize>()
where
    f32: Stage<D>,
{
    let expected = {
        let mut scene = running::<D>("scaling");
        (0..40).for_each(|_| scene.advance().expect("it goes on"));
        [readout(&scene, "The same in sizes"), readout(&scene, "Contact points")]
    };
    for exponent in -10..=20 {
        let mut scene = running::<D>("scaling");
        set_number(&mut scene, "exponent", f64::from(exponent));
        (0..40).for_each(|_| scene.advance().expect("it goes on"));
        let found = [readout(&scene, "The same in sizes"), readout(&scene, "Contact points")];
        assert_eq!(found, expected, "at the power {exponent}");
    }
}

#[test]
fn contacts_are_the_same_at_every_size() {
    scales_exactly::<2>();
    scales_exactly::<3>();
}

/// Moves the ball up through the hill and down again. Returns whether a contact normal, which
/// points from the hill to the ball, pointed upwards, and whether one pointed downwards.
fn pushes<const D: usize>(is_one_sided: bool) -> [bool; 2]
where
    f32: Stage<D>,
{
    let mut hill = running::<D>("one-sided");
    hill.set_control("one sided", &ControlValue::Flag(is_one_sided)).expect("a flag");
    let mut pushes = [false; 2];
    for _ in 0..240 {
        hill.advance().expect("it goes on");
        for (_, _, manifold) in hill.world().contact_views() {
            pushes[usize::from(manifold.normal()[1] < 0.0)] = true;
        }
    }
    pushes
}

#[test]
fn a_surface_with_one_side_never_pushes_down() {
    assert_eq!([pushes::<2>(true), pushes::<3>(true)], [[true, false]; 2], "with one side");
    assert_eq!([pushes::<2>(false), pushes::<3>(false)], [[true, true]; 2], "with both");
}

fn teams_keep_apart<const D: usize>()
where
    f32: Stage<D>,
{
    let mut groups = running::<D>("groups");
    let mut seen = [0, 0];
    for (rule, count) in [("own team", 0), ("other teams", 1)] {
        choose(&mut groups, "rule", rule);
        for _ in 0..60 {
            groups.advance().expect("it goes on");
            let labels = ["Contacts within a team", "Contacts between teams"];
            let counts = labels.map(|label| readout(&groups, label).parse::<usize>());
            let counts = counts.map(|count| count.expect("a count"));
            assert_eq!(counts[1 - count], 0, "{rule} at step {}", groups.step());
            seen[count] += counts[count];
        }
    }
    assert!(seen.iter().all(|seen| *seen > 0), "both rules let something touch: {seen:?}");
    choose(&mut groups, "rule", "nobody");
    assert_eq!(groups.world().contact_views().count(), 0, "nobody touches anybody");
}

#[test]
fn groups_decide_who_touches() {
    teams_keep_apart::<2>();
    teams_keep_apart::<3>();
}

fn all_balls_ride<const D: usize>()
where
    f32: Stage<D>,
{
    let mut sea = running::<D>("waves");
    for _ in 0..70 {
        sea.advance().expect("it goes on");
        let touching = readout(&sea, "Balls on the surface");
        assert!(touching.parse::<usize>().expect("a count") >= 7, "at step {}", sea.step());
    }
}

#[test]
fn balls_ride_on_the_surface_as_it_is_now() {
    all_balls_ride::<2>();
    all_balls_ride::<3>();
}

fn bars_stop_at_a_touch<const D: usize>()
where
    f32: Stage<D>,
{
    let mut bars = running::<D>("spinning");
    for spin in [4.0, -9.0, 30.0] {
        set_number(&mut bars, "spin", spin);
        let time: f32 = readout(&bars, "Time of impact").parse().expect("they hit");
        let mut least = f32::INFINITY;
        for _ in 0..240 {
            bars.advance().expect("it goes on");
            least = least.min(readout(&bars, "Distance").parse().expect("a number"));
            for (_, _, manifold) in bars.world().contact_views() {
                let depth = manifold.deepest_contact().contact.depth;
                assert!(depth < 1e-3, "{depth} deep at step {} of {time}", bars.step());
            }
        }
        assert!(least < 1e-3, "they stop {least} apart");
    }
}

#[test]
fn spinning_bars_stop_where_they_touch() {
    bars_stop_at_a_touch::<2>();
    bars_stop_at_a_touch::<3>();
}
