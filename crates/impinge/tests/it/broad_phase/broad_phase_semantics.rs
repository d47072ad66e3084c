//! Tests each guarantee of the interface of broad phases.

use impinge::bounding_volume::{Aabb, BoundingVolume, Ray};
use impinge::broad_phase::{BroadPhase, BroadPhaseError, DBVTBroadPhase, ProxyHandle};
use impinge::math::{Point, Real, Space, Vector};

use crate::support::samples::stride;

/// Returns the box of a ball around `center`, in `D` dimensions.
fn ball<N: Space<D>, const D: usize>(center: [f64; 3], radius: f64) -> Aabb<N, D> {
    let center = Point::from(Vector::<N, D>::from_fn(|axis, _| N::lit(center[axis])));
    let reach = Vector::<N, D>::repeat(N::lit(radius));
    Aabb::new(center - reach, center + reach)
}

fn yes<T>(_: &T, _: &T) -> bool {
    true
}

/// Updates the broad phase and returns the events: the data of both objects, and `true` if the pair
/// started.
fn events<N: Real, BV: BoundingVolume<N>>(
    broad_phase: &mut impl BroadPhase<N, BV, u32>,
    filter: impl Fn(&u32, &u32) -> bool,
) -> Vec<(u32, u32, bool)> {
    let mut events = Vec::new();
    broad_phase.update(&mut |a, b| filter(a, b), &mut |&a, &b, started| {
        events.push((a, b, started));
    });
    events
}

/// Runs the example of the user guide: four balls form six pairs. Two balls are removed, and five
/// pairs end with them.
fn guide<N: Space<D>, const D: usize>() {
    let mut broad_phase = DBVTBroadPhase::<N, Aabb<N, D>, u32>::new(N::lit(0.2));
    let centers = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.5, 0.5, 0.0]];
    let handles: Vec<ProxyHandle> = centers
        .iter()
        .zip(0..)
        .map(|(&center, data)| broad_phase.create_proxy(ball(center, 0.5), data))
        .collect();
    assert_eq!(broad_phase.num_interferences(), 0, "creation is deferred");
    let all = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(a, b)| (a, b, true));
    assert_eq!(events(&mut broad_phase, yes), all, "in canonical order");
    assert_eq!(broad_phase.num_interferences(), 6, "six pairs");
    let mut calls = 0;
    broad_phase.remove(&handles[..2], &mut |_, _| calls += 1);
    assert_eq!(calls, 5, "all pairs but that of the two that stay");
    assert_eq!(events(&mut broad_phase, yes), [], "removal has been reported");
    assert_eq!(broad_phase.num_interferences(), 1, "one pair is left");
    broad_phase.validate().expect("sound");
}

#[test]
fn the_guides_example() {
    guide::<f32, 2>();
    guide::<f32, 3>();
    guide::<f64, 2>();
    guide::<f64, 3>();
}

#[test]
fn types_are_inferred_and_the_trait_is_object_safe() {
    let mut broad_phase = DBVTBroadPhase::new(0.2);
    let handle = broad_phase.create_proxy(ball::<f32, 2>([0.0; 3], 1.0), "data");
    let explicit = DBVTBroadPhase::<f32, Aabb<f32, 2>, &str>::new(0.2);
    let mut boxed: [Box<dyn BroadPhase<f32, Aabb<f32, 2>, &str> + Send + Sync>; 2] =
        [Box::new(broad_phase), Box::new(explicit)];
    assert_eq!(boxed[0].proxy(handle).expect("there").1, &"data", "data comes back");
    assert!(boxed[1].proxy(handle).is_none(), "the other one is empty");
    boxed[0].update(&mut |_, _| true, &mut |_, _, _| panic!("one object has no pairs"));
}

#[test]
fn small_moves_are_free_and_large_ones_are_not() {
    let mut broad_phase = DBVTBroadPhase::new(0.5);
    let at = |x: f64| ball::<f64, 3>([x, 0.0, 0.0], 0.5);
    let _fixed = broad_phase.create_proxy(at(0.0), 0);
    let mover = broad_phase.create_proxy(at(1.875), 1);
    assert_eq!(events(&mut broad_phase, yes), [(0, 1, true)], "2 · 0.5 + 2 · 0.5 reaches");
    let loose = *broad_phase.loosened_volume(mover).expect("updated");
    broad_phase.deferred_set_bounding_volume(mover, at(2.375));
    assert_eq!(events(&mut broad_phase, yes), [], "still inside the loosened box");
    assert_eq!(broad_phase.loosened_volume(mover), Some(&loose), "which stays");
    assert_eq!(broad_phase.proxy(mover).expect("there").0, &at(2.375), "the exact one moves");
    broad_phase.deferred_set_bounding_volume(mover, at(2.5));
    assert_eq!(broad_phase.proxy(mover).expect("there").0, &at(2.375), "deferred");
    assert_eq!(events(&mut broad_phase, yes), [(0, 1, false)], "it left");
    // Only the last of several moves before an update has an effect.
    broad_phase.deferred_set_bounding_volume(mover, at(0.0));
    broad_phase.deferred_set_bounding_volume(mover, at(50.0));
    assert_eq!(events(&mut broad_phase, yes), [], "it never was at 0");
}

#[test]
fn touching_counts_also_without_a_margin() {
    let mut broad_phase = DBVTBroadPhase::new(0.0);
    let _first = broad_phase.create_proxy(ball::<f32, 2>([0.0; 3], 0.5), 0);
    let _second = broad_phase.create_proxy(ball::<f32, 2>([1.0, 1.0, 0.0], 0.5), 1);
    let _third = broad_phase.create_proxy(ball::<f32, 2>([1.5, 1.5, 0.0], 0.0), 2);
    assert_eq!(events(&mut broad_phase, yes), [(0, 1, true), (1, 2, true)], "corners touch");
}

#[test]
fn pairs_follow_a_filter_that_changes() {
    let mut broad_phase = DBVTBroadPhase::new(0.1);
    let handles =
        [0, 1, 2, 3].map(|data| broad_phase.create_proxy(ball::<f32, 3>([0.0; 3], 1.0), data));
    let even = |a: &u32, b: &u32| (a + b).is_multiple_of(2);
    let odd = |a: &u32, b: &u32| !(a + b).is_multiple_of(2);
    assert_eq!(events(&mut broad_phase, even), [(0, 2, true), (1, 3, true)], "even sums");
    broad_phase.deferred_set_bounding_volume(handles[0], ball([0.5, 0.0, 0.0], 1.0));
    assert_eq!(events(&mut broad_phase, odd), [], "nobody asked for recomputation");
    broad_phase.deferred_recompute_all_proximities_with(handles[0]);
    let of_zero = [(0, 1, true), (0, 2, false), (0, 3, true)];
    assert_eq!(events(&mut broad_phase, odd), of_zero, "the pairs of object 0");
    broad_phase.deferred_recompute_all_proximities();
    let rest = [(1, 2, true), (1, 3, false), (2, 3, true)];
    assert_eq!(events(&mut broad_phase, odd), rest, "all the others");
    assert_eq!(events(&mut broad_phase, even), [], "the request is spent");
    broad_phase.validate().expect("sound");
}

#[test]
fn unbounded_and_enormous_boxes_meet_everything_they_should() {
    let mut broad_phase = DBVTBroadPhase::new(0.1);
    let infinity = f64::INFINITY;
    let floor =
        Aabb::new(Point::<f64, 2>::new(-infinity, -infinity), Point::<f64, 2>::new(infinity, 0.0));
    let _floor = broad_phase.create_proxy(floor, 0);
    let low = broad_phase.create_proxy(ball([3.0, 0.5, 0.0], 0.5), 1);
    let _high = broad_phase.create_proxy(ball([3.0, 9.0, 0.0], 0.5), 2);
    let _far = broad_phase.create_proxy(ball([1e300, -1e300, 0.0], 1e299), 3);
    let _all = broad_phase.create_proxy(Aabb::unbounded(), 4);
    let started = [(0, 1), (0, 3), (0, 4), (1, 4), (2, 4), (3, 4)];
    assert_eq!(events(&mut broad_phase, yes), started.map(|(a, b)| (a, b, true)), "at first");
    broad_phase.deferred_set_bounding_volume(low, ball([1e30, 1e30, 0.0], 1.0));
    assert_eq!(events(&mut broad_phase, yes), [(0, 1, false)], "up and away");
    broad_phase.deferred_set_bounding_volume(low, ball([1e300, -1e300, 0.0], 0.0));
    assert_eq!(events(&mut broad_phase, yes), [(0, 1, true), (1, 3, true)], "beyond f32");
    broad_phase.deferred_set_bounding_volume(low, ball([3.0, 9.5, 0.0], 0.5));
    assert_eq!(events(&mut broad_phase, yes), [(0, 1, false), (1, 2, true), (1, 3, false)], "back");
    let mut hit = Vec::new();
    let up = Ray::new(Point::<f64, 2>::new(3.0, -1.0), Vector::<f64, 2>::new(0.0, 1.0));
    broad_phase.visit_ray(&up, 1e9, &mut |data| {
        hit.push(*data);
        1e9
    });
    assert_eq!(hit, [0, 4, 2, 1], "by time of entry, then by handle");
    broad_phase.validate().expect("sound");
}

#[test]
fn misuse_is_told_and_changes_nothing() {
    type P = Point<f32, 2>;
    let mut broad_phase = DBVTBroadPhase::new(0.1);
    let good = ball::<f32, 2>([0.0; 3], 1.0);
    let [first, second] = [0, 1].map(|data| broad_phase.create_proxy(good, data));
    assert_eq!(events(&mut broad_phase, yes).len(), 1, "a pair");
    let none = &mut |_: &u32, _: &u32| panic!("nothing is removed");
    let twice = broad_phase.try_remove(&[first, second, first], none);
    assert_eq!(twice, Err(BroadPhaseError::RemovedTwice(first)), "twice in one list");
    broad_phase.remove(&[first], &mut |_, _| ());
    let stale = Err(BroadPhaseError::StaleHandle(first));
    assert_eq!(broad_phase.try_remove(&[second, first], none), stale, "gone");
    assert_eq!(broad_phase.try_deferred_set_bounding_volume(first, good), stale, "gone");
    assert_eq!(broad_phase.try_deferred_recompute_all_proximities_with(first), stale, "gone");
    let again = broad_phase.create_proxy(good, 2);
    assert_eq!(again.uid(), first.uid(), "the index is used again");
    assert_eq!(broad_phase.proxy(first), None, "and yet the old handle finds nothing");
    let text = BroadPhaseError::StaleHandle(first).to_string();
    assert_eq!(text, format!("there is no proxy {first:?}"), "the error names the handle");
    // Boxes are checked when users create them, but later arithmetic can still make them invalid.
    assert!(Aabb::try_new(P::new(f32::NAN, 0.0), P::origin()).is_err(), "NaN");
    for bad in [good.loosened(f32::NAN), good.loosened(-2.0)] {
        let refused = broad_phase.try_create_proxy(bad, 3);
        assert_eq!(refused, Err(BroadPhaseError::BadVolume(None)), "{bad:?}");
        let refused = broad_phase.try_deferred_set_bounding_volume(second, bad);
        assert_eq!(refused, Err(BroadPhaseError::BadVolume(Some(second))), "{bad:?}");
        let mut found = Vec::new();
        broad_phase.interferences_with_bounding_volume(&bad, &mut found);
        assert!(found.is_empty(), "a bad box meets nothing");
    }
    for margin in [-1.0, f32::NAN, f32::INFINITY] {
        let refused = DBVTBroadPhase::<f32, Aabb<f32, 2>, ()>::try_new(margin);
        assert!(matches!(refused, Err(BroadPhaseError::BadMargin(_))), "{margin}");
    }
    assert_eq!(events(&mut broad_phase, yes), [(2, 1, true)], "all as if nothing had been tried");
}

#[test]
fn handles_of_other_broad_phases_are_refused() {
    let [(mut own, handle), (_, foreign)] = [0, 1].map(|data| {
        let mut broad_phase = DBVTBroadPhase::new(0.1);
        let handle = broad_phase.create_proxy(ball::<f64, 3>([0.0; 3], 1.0), data);
        (broad_phase, handle)
    });
    let forged = ProxyHandle::new(0, 0);
    for unknown in [foreign, forged] {
        let refused = Err(BroadPhaseError::StaleHandle(unknown));
        let volume = ball([9.0; 3], 1.0);
        assert_eq!(own.try_remove(&[unknown], &mut |_, _| ()), refused, "remove");
        assert_eq!(own.try_deferred_set_bounding_volume(unknown, volume), refused, "move");
        let again = own.try_deferred_recompute_all_proximities_with(unknown);
        assert_eq!(again, refused, "filter again");
        assert!(own.proxy(unknown).is_none() && own.loosened_volume(unknown).is_none(), "look up");
    }
    let twin = own.clone();
    assert!(own.proxy(handle).is_some() && twin.proxy(handle).is_some(), "its own, and a clone's");
}

#[test]
#[should_panic(expected = "there is no proxy ProxyHandle { index: 0, generation: 0 }")]
fn removing_twice_panics() {
    let mut broad_phase = DBVTBroadPhase::new(0.1);
    let handle = broad_phase.create_proxy(ball::<f32, 2>([0.0; 3], 1.0), ());
    broad_phase.remove(&[handle], &mut |(), ()| ());
    broad_phase.remove(&[handle], &mut |(), ()| ());
}

#[test]
fn a_filter_that_panics_is_asked_again() {
    let mut broad_phase = DBVTBroadPhase::new(0.1);
    for data in 0..4 {
        let _ = broad_phase.create_proxy(ball::<f32, 2>([0.0; 3], 1.0), data);
    }
    let first = broad_phase.create_proxy(ball::<f32, 2>([9.0; 3], 1.0), 4);
    let failing = std::panic::AssertUnwindSafe(|| {
        broad_phase.update(&mut |_, &b| b < 3 || panic!("a filter fails"), &mut |_, _, _| ());
    });
    assert!(std::panic::catch_unwind(failing).is_err(), "the panic passes through");
    assert_eq!(broad_phase.num_interferences(), 0, "nothing has started");
    broad_phase.remove(&[first], &mut |_, _| panic!("no pairs"));
    assert_eq!(events(&mut broad_phase, yes).len(), 6, "nothing is lost");
    broad_phase.validate().expect("sound");
}

/// Moves a bar over a row of 5000 balls to and fro by half the length of the row. Asserts that 2500
/// pairs begin or end at once.
#[test]
fn an_object_with_five_thousand_pairs() {
    let mut broad_phase = DBVTBroadPhase::new(0.125);
    let long = |x: f64| {
        Aabb::new(
            Point::<f32, 3>::new(f32::lit(x), 0.0, 0.0),
            Point::<f32, 3>::new(f32::lit(x + 9998.5), 1.0, 1.0),
        )
    };
    let bar = broad_phase.create_proxy(long(0.0), 0);
    let small: Vec<ProxyHandle> = (0..5000)
        .map(|i| broad_phase.create_proxy(ball([f64::from(2 * i), 0.5, 0.5], 0.25), i + 1))
        .collect();
    assert_eq!(events(&mut broad_phase, yes).len(), 5000, "the bar covers the row");
    for round in 0..20 {
        broad_phase.deferred_set_bounding_volume(bar, long(5000.0));
        let gone = events(&mut broad_phase, yes);
        // The pairs that end satisfy 2i + 0.25 + 0.125 < 5000 - 0.125, so i < 2500.
        assert_eq!(gone.len(), 2500, "round {round}");
        assert!(
            gone.iter().all(|&(a, b, started)| a == 0 && b <= 2500 && !started),
            "the left half"
        );
        broad_phase.deferred_set_bounding_volume(bar, long(0.0));
        assert_eq!(events(&mut broad_phase, yes).len(), 2500, "they are back");
    }
    let mut calls = 0;
    broad_phase.remove(&small[..2000], &mut |_, _| calls += 1);
    assert_eq!((calls, broad_phase.num_interferences()), (2000, 3000), "each had one pair");
    broad_phase.remove(&[bar], &mut |_, _| calls += 1);
    assert_eq!((calls, broad_phase.num_interferences()), (5000, 0), "the rest");
    broad_phase.validate().expect("sound");
}

/// Asserts the number of pairs of 20000 points in groups of ten along a line, and of 375 points at
/// one position; of 1500 if the [`stride`] is 1. Work that is quadratic in the number of objects
/// would make the test very slow.
#[test]
fn twenty_thousand_objects_at_one_point() {
    let mut broad_phase = DBVTBroadPhase::new(0.0);
    for i in 0..20_000_u32 {
        let place = [f64::from(i / 10), 0.0, 0.0];
        let _ = broad_phase.create_proxy(ball::<f32, 3>(place, 0.0), i);
    }
    assert_eq!(events(&mut broad_phase, yes).len(), 2000 * 45, "all pairs of each heap");
    broad_phase.validate().expect("sound");
    // All points at one position are pairwise in contact, so there are fewer points here.
    let mut broad_phase = DBVTBroadPhase::new(0.0);
    let count = 1500 / stride(4);
    let heap: Vec<ProxyHandle> = (0..)
        .take(count)
        .map(|i| broad_phase.create_proxy(ball::<f64, 2>([0.1; 3], 0.0), i))
        .collect();
    assert_eq!(events(&mut broad_phase, yes).len(), count * (count - 1) / 2, "all pairs");
    let mut calls = 0;
    broad_phase.remove(&heap[..count - 100], &mut |_, _| calls += 1);
    assert_eq!(calls, count * (count - 1) / 2 - 100 * 99 / 2, "all but those that stay");
    broad_phase.validate().expect("sound");
    assert_eq!(events(&mut broad_phase, yes), [], "nothing new");
}
