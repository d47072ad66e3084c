//! Tests properties that every sample must have.

use std::collections::BTreeSet;

use impinge::math::Space;
use impinge::query::Proximity;
use impinge_record::validate;
use impinge_samples::{
    Control, ControlKind, ControlValue, Entry, Make, Running, SampleError, Shows, entries,
};

use super::support::{Stage, drawn};

/// Returns the number of tested steps, which is small for the sample of ten thousand boxes.
fn steps(entry: &Entry) -> usize {
    if entry.name == "boxes3" { 4 } else { 120 }
}

fn start<const D: usize>(entry: &Entry) -> Running<D>
where
    f32: Stage<D>,
{
    let sample = f32::make(entry).expect("of this dimension");
    Running::new(sample).unwrap_or_else(|error| panic!("{} starts: {error}", entry.name))
}

fn advance<const D: usize>(entry: &Entry, running: &mut Running<D>)
where
    f32: Stage<D>,
{
    let done = running.advance();
    done.unwrap_or_else(|error| panic!("{} at step {}: {error}", entry.name, running.step()));
}

/// Asserts that all positions, depths, readouts and drawn lines are finite.
fn check_finite<const D: usize>(entry: &Entry, running: &Running<D>)
where
    f32: Stage<D>,
{
    for object in running.world().collision_objects() {
        let pose = f32::pose(object.position());
        assert!(pose.is_finite(), "{}: {}", entry.name, object.data());
    }
    for (one, two, manifold) in running.world().contact_views() {
        let depth = manifold.deepest_contact().contact.depth;
        assert!(depth.is_finite(), "{}: {} and {}", entry.name, one.data(), two.data());
    }
    for readout in running.readouts() {
        assert!(!readout.value.contains("NaN"), "{}: {readout:?}", entry.name);
        assert!(!readout.value.contains("inf"), "{}: {readout:?}", entry.name);
    }
    assert_eq!(drawn(running).broken, 0, "{} draws what is finite", entry.name);
}

/// Returns `true` if the world of a sample now has the property that its entry claims: a contact,
/// an intersection event or a drawn line.
fn is_shown<const D: usize>(entry: &Entry, running: &Running<D>) -> bool
where
    f32: Stage<D>,
{
    let intersects = |status| status == Proximity::Intersecting;
    match entry.shows {
        Shows::Contacts => running.world().contact_views().next().is_some(),
        Shows::ProximityEvents => {
            running.world().proximity_events().iter().any(|event| intersects(event.new_status))
        }
        Shows::Drawing => drawn(running).lines > 0,
    }
}

fn run<const D: usize>(entry: &Entry)
where
    f32: Stage<D>,
{
    let mut running = start::<D>(entry);
    let mut shown = is_shown(entry, &running);
    for step in 0..steps(entry) {
        advance(entry, &mut running);
        shown |= is_shown(entry, &running);
        if step % 20 == 0 {
            check_finite(entry, &running);
        }
    }
    check_finite(entry, &running);
    assert!(shown, "{} shows {:?}", entry.name, entry.shows);
    // The recording continues after a restart.
    running.restart().expect("it starts again");
    advance(entry, &mut running);
    assert_eq!(running.step(), 1, "{} counts its steps anew", entry.name);
    let (registry, bytes) = (running.registry(), running.finish());
    assert_eq!(validate(&bytes, &registry), Ok(None), "the recording of {}", entry.name);
}

#[test]
fn every_sample_runs_shows_something_and_is_recorded() {
    for entry in entries() {
        match entry.make {
            Make::Plane(_) => run::<2>(entry),
            Make::Space(_) => run::<3>(entry),
        }
    }
}

fn bytes<const D: usize>(entry: &Entry) -> Vec<u8>
where
    f32: Stage<D>,
{
    let mut running = start::<D>(entry);
    (0..10).for_each(|_| advance(entry, &mut running));
    running.finish()
}

#[test]
fn every_sample_is_the_same_on_every_run() {
    for entry in entries().iter().filter(|entry| entry.name != "boxes3") {
        let is_same = match entry.make {
            Make::Plane(_) => bytes::<2>(entry) == bytes::<2>(entry),
            Make::Space(_) => bytes::<3>(entry) == bytes::<3>(entry),
        };
        assert!(is_same, "{}", entry.name);
    }
}

/// Returns the values to test: the minimum, the middle and the maximum of a number, all words of a
/// choice, both values of a flag, and the press of a button.
fn values(control: &Control) -> Vec<ControlValue> {
    match control.kind {
        ControlKind::Number { min, max, .. } => {
            [min, (min + max) / 2.0, max].map(ControlValue::Number).into()
        }
        ControlKind::Choice { choices, .. } => {
            choices.iter().map(|choice| ControlValue::Choice((*choice).to_owned())).collect()
        }
        ControlKind::Flag { .. } => [true, false].map(ControlValue::Flag).into(),
        ControlKind::Button => vec![ControlValue::Pressed],
    }
}

fn turn_controls<const D: usize>(entry: &Entry)
where
    f32: Stage<D>,
{
    let mut running = start::<D>(entry);
    for control in running.controls().to_vec() {
        for value in values(&control) {
            let set = running.set_control(control.name, &value);
            set.unwrap_or_else(|error| panic!("{} {value:?}: {error}", control.name));
            advance(entry, &mut running);
            check_finite(entry, &running);
        }
        // The initial value is restored, so that each control is tested alone.
        running.set_control(control.name, &first_value(&control)).expect("its own value");
    }
    refuse_controls(&mut running);
}

fn first_value(control: &Control) -> ControlValue {
    match control.kind {
        ControlKind::Number { value, .. } => ControlValue::Number(value),
        ControlKind::Choice { value, .. } => ControlValue::Choice(value.to_owned()),
        ControlKind::Flag { value } => ControlValue::Flag(value),
        ControlKind::Button => ControlValue::Pressed,
    }
}

fn refuse_controls<const D: usize>(running: &mut Running<D>)
where
    f32: Stage<D>,
{
    let unknown = running.set_control("no such", &ControlValue::Flag(true));
    assert_eq!(unknown, Err(SampleError::UnknownControl("no such".to_owned())), "a name");
    for control in running.controls().to_vec() {
        let wrong = match control.kind {
            ControlKind::Number { .. } => ControlValue::Flag(true),
            _ => ControlValue::Number(1.0),
        };
        let refused = running.set_control(control.name, &wrong);
        let expected = SampleError::WrongKind { name: control.name, value: wrong };
        assert_eq!(refused, Err(expected), "{}", control.name);
        if let ControlKind::Number { max, .. } = control.kind {
            for value in [f64::NAN, f64::INFINITY, 2.0 * max + 1.0] {
                let refused = running.set_control(control.name, &ControlValue::Number(value));
                let is_bounds = matches!(refused, Err(SampleError::OutOfBounds { .. }));
                assert!(is_bounds, "{} = {value}", control.name);
            }
        }
    }
}

#[test]
fn every_control_works_at_its_least_middle_and_greatest_value() {
    for entry in entries() {
        match entry.make {
            Make::Plane(_) => turn_controls::<2>(entry),
            Make::Space(_) => turn_controls::<3>(entry),
        }
    }
}

#[test]
fn names_are_unique_and_texts_have_two_sentences() {
    let names: BTreeSet<_> = entries().iter().map(|entry| entry.name).collect();
    let titles: BTreeSet<_> = entries().iter().map(|entry| entry.title).collect();
    assert_eq!([names.len(), titles.len()], [entries().len(); 2], "of names and titles");
    assert!(entries().len() >= 24, "{} samples", entries().len());
    for entry in entries() {
        let sentences = entry.about.split_terminator(". ").count();
        assert_eq!(sentences, 2, "{}: {}", entry.name, entry.about);
        assert!(entry.about.ends_with('.'), "{}", entry.name);
        assert!(entry.name.ends_with(&entry.make.dimension().to_string()), "{}", entry.name);
    }
}

fn drag_everywhere<const D: usize>(entry: &Entry)
where
    f32: Stage<D>,
{
    let mut running = start::<D>(entry);
    let object = running.world().collision_objects().next().expect("there is one");
    let (handle, position) = (object.handle(), *object.position());
    let mut pose = f32::pose(&position);
    pose.translation[0] += 1.0;
    running.drag(handle, &f32::isometry(&pose)).expect("a finite position");
    advance(entry, &mut running);
    check_finite(entry, &running);
    pose.translation[0] = f32::NAN;
    let broken = running.drag(handle, &f32::isometry(&pose));
    assert!(matches!(broken, Err(SampleError::World(_))), "{}: {broken:?}", entry.name);
}

#[test]
fn objects_are_dragged_to_finite_positions_only() {
    for entry in entries().iter().filter(|entry| entry.name != "boxes3") {
        match entry.make {
            Make::Plane(_) => drag_everywhere::<2>(entry),
            Make::Space(_) => drag_everywhere::<3>(entry),
        }
    }
}
