//! Tests that events are equal with every instruction set and any number of threads, that large
//! scenes have the pairs of a brute-force search, and that changes do not spoil the trees for long.

use super::PairFinder;
use super::finder::Container;
use crate::bounding_volume::Aabb;
use crate::bvh::Lanes;
use crate::bvh::tests::take_placed;
use crate::math::{Point, Real, Vector};
use crate::pairs::pack;

/// Returns a pseudorandom number below `bound`, from a linear congruential generator.
fn next(state: &mut u64, bound: u32) -> u32 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    u32::try_from((*state >> 33) % u64::from(bound)).expect("below a u32")
}

/// Returns a random box with sides of 0 to 1.25 and coordinates that are multiples of 1/4, exact in
/// `f32`.
fn random_box<N: Real, const D: usize>(state: &mut u64, side: u32) -> Aabb<N, D> {
    let lo = Vector::<N, D>::from_fn(|_, _| N::lit(f64::from(next(state, 4 * side)) / 4.0));
    let size = Vector::<N, D>::from_fn(|_, _| N::lit(f64::from(next(state, 6)) / 4.0));
    Aabb::new(Point::from(lo), Point::from(lo + size))
}

/// Outcome of a scene: its events, each with its step, the pairs in the order of the table, and the
/// maximum number of still objects.
#[derive(Debug, PartialEq)]
struct Outcome {
    events: Vec<(usize, u32, u32, bool)>,
    pairs: Vec<(u32, u32)>,
    most_still: usize,
}

/// Runs a scene of 90 steps and returns its outcome. In the first 10 and the last 20 steps many
/// objects move, in between few, so that the others come to rest. Each step also removes three
/// objects and inserts them elsewhere. Asserts that the last pairs are those of a brute-force
/// search.
fn play<N: Real, const D: usize>(lanes: Lanes, count: u32, side: u32) -> Outcome {
    let mut finder = PairFinder::<N, D>::with_lanes(N::lit(0.125), lanes).expect("a margin");
    let (mut state, mut events, mut most_still) = (count.into(), Vec::new(), 0);
    for id in 0..count {
        finder.insert(id, random_box(&mut state, side));
    }
    for step in 0..90 {
        let movers = if (10..70).contains(&step) { count / 60 } else { count * 2 / 3 };
        for _ in 0..movers {
            let id = next(&mut state, count);
            let shift = Vector::<N, D>::from_fn(|_, _| {
                N::lit((f64::from(next(&mut state, 9)) - 4.0) / 16.0)
            });
            let old = *finder.exact(id);
            finder.set(id, Aabb::new(old.mins() + shift, old.maxs() + shift));
        }
        for _ in 0..3 {
            let id = next(&mut state, count);
            finder.remove(id);
            finder.insert(id, random_box(&mut state, side));
        }
        if step == 75 {
            finder.refilter_all();
        }
        finder.update(&mut |a, b| (a ^ b) % 16 != 3, &mut |a, b, started| {
            events.push((step, a, b, started));
        });
        most_still = most_still.max(finder.still.len());
    }
    finder.validate().expect("sound");
    compare_with_all_pairs(&finder);
    Outcome { events, pairs: finder.pairs().to_vec(), most_still }
}

fn compare_with_all_pairs<N: Real, const D: usize>(finder: &PairFinder<N, D>) {
    compare_pairs(finder, |a, b| (a ^ b) % 16 != 3);
}

fn compare_pairs<N: Real, const D: usize>(
    finder: &PairFinder<N, D>,
    is_allowed: impl Fn(usize, usize) -> bool,
) {
    let mut expected = Vec::new();
    for a in 0..finder.loose.len() {
        for b in a + 1..finder.loose.len() {
            if is_allowed(a, b) && finder.loose[a].overlaps(&finder.loose[b]) {
                let id = |index: usize| u32::try_from(index).expect("small");
                expected.push(pack(id(a), id(b)));
            }
        }
    }
    let mut pairs: Vec<u64> = finder.pairs().iter().map(|&(a, b)| pack(a, b)).collect();
    pairs.sort_unstable();
    assert_eq!(pairs, expected, "all pairs");
    assert!(
        finder.containers.iter().all(|&container| container != Container::Nowhere),
        "all take part"
    );
}

/// Asserts that objects came to rest, and that there were enough events and pairs for a meaningful
/// test.
fn check_reached(outcome: &Outcome, count: usize) {
    assert!(outcome.most_still > count / 8, "objects came to rest: {}", outcome.most_still);
    assert!(outcome.events.len() > 4 * count, "{} events", outcome.events.len());
    assert!(outcome.pairs.len() > count / 2, "{} pairs", outcome.pairs.len());
}

#[test]
fn every_instruction_set_gives_the_same_events() {
    let expected = play::<f32, 3>(Lanes::scalar(), 2500, 17);
    check_reached(&expected, 2500);
    let plane = play::<f64, 2>(Lanes::scalar(), 1200, 45);
    check_reached(&plane, 1200);
    for lanes in Lanes::available() {
        assert_eq!(play::<f32, 3>(lanes, 2500, 17), expected, "{lanes:?}");
        assert_eq!(play::<f64, 2>(lanes, 1200, 45), plane, "{lanes:?}");
    }
}

/// Compares the pairs of a scene with those of a brute-force search; with more than 16³ = 4096
/// objects, the tree has four layers.
#[test]
fn a_deep_tree() {
    check_reached(&play::<f32, 2>(Lanes::detect(), 5000, 90), 5000);
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_events() {
    let write = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(|| play::<f32, 3>(Lanes::detect(), 6000, 22))
    };
    let expected = write(1);
    check_reached(&expected, 6000);
    for threads in [2, 4] {
        assert!(write(threads) == expected, "{threads} threads");
    }
}

/// After all boxes have moved elsewhere, 30 updates restore the order of slots: the surface of the
/// leaves is then less than 1.1 times that of a new tree.
#[test]
fn renewal_keeps_the_tree_good() {
    let mut finder = PairFinder::<f32, 3>::try_new(0.05).expect("a margin");
    let mut state = 3;
    for id in 0..3000 {
        finder.insert(id, random_box(&mut state, 20));
    }
    let update = |finder: &mut PairFinder<f32, 3>| {
        finder.update(&mut |_, _| true, &mut |_, _, _| ());
    };
    update(&mut finder);
    let fresh = finder.moving.leaf_surface();
    for id in 0..3000 {
        // Every box moves to a random position, which makes the order as bad as possible.
        finder.set(id, random_box(&mut state, 20));
    }
    update(&mut finder);
    let spoilt = finder.moving.leaf_surface();
    assert!(spoilt > 3.0 * fresh, "{spoilt} against {fresh}");
    (0..30).for_each(|_| update(&mut finder));
    let renewed = finder.moving.leaf_surface();
    assert!(renewed < 1.1 * fresh, "{renewed} against {fresh}");
    finder.validate().expect("sound");
}

/// An object that is inserted elsewhere under an old id does not get the old object's slot when a
/// renewal that began earlier is applied. Over 60 steps, each of which replaces a tenth of the
/// objects, the mean leaf surface stays below twice that of a fresh tree.
#[test]
fn respawned_objects_keep_the_tree_good() {
    let mut finder = PairFinder::<f32, 3>::try_new(0.05).expect("a margin");
    let mut state = 4;
    for id in 0..3000 {
        finder.insert(id, random_box(&mut state, 20));
    }
    finder.update(&mut |_, _| true, &mut |_, _, _| ());
    let surface =
        |finder: &PairFinder<f32, 3>| finder.moving.leaf_surface() + finder.still.leaf_surface();
    let (fresh, mut sum) = (surface(&finder), 0.0);
    for _ in 0..60 {
        for _ in 0..300 {
            let id = next(&mut state, 3000);
            finder.remove(id);
            finder.insert(id, random_box(&mut state, 20));
        }
        finder.update(&mut |_, _| true, &mut |_, _, _| ());
        sum += surface(&finder) / 60.0;
    }
    assert!(sum < 2.0 * fresh, "{sum} on average against {fresh}");
    finder.validate().expect("sound");
    compare_pairs(&finder, |_, _| true);
}

/// If 10 of 30 000 objects move after a bulk insertion, the other objects come to rest, and no
/// update from the third on moves 2500 objects or more between slots.
#[test]
fn no_update_handles_many_objects_at_rest() {
    let (count, movers, state) = (30_000, 10, &mut 5);
    let mut finder = PairFinder::<f32, 3>::try_new(0.125).expect("a margin");
    (0..count).for_each(|id| finder.insert(id, random_box(state, 400)));
    for step in 0..400 {
        for id in 0..movers {
            let old = *finder.exact(id);
            let shift = Vector::<f32, 3>::new(0.25, 0.0, 0.0);
            finder.set(id, Aabb::new(old.mins() + shift, old.maxs() + shift));
        }
        finder.update(&mut |_, _| true, &mut |_, _, _| {});
        let placed = take_placed();
        assert!(step < 2 || placed < 2500, "{placed} objects are moved in step {step}");
        if step % 50 == 0 {
            assert_eq!(finder.validate(), Ok(()), "in step {step}");
        }
    }
    assert!(finder.still.len() > 29_900, "{} are still", finder.still.len());
}

/// Each update inserts 20 objects, which do not move. They come to rest in small groups: no update
/// moves 4500 objects or more between slots, and fewer than 3000 objects count as moving.
#[test]
fn a_stream_of_objects_comes_to_rest_bit_by_bit() {
    let state = &mut 6;
    let mut finder = PairFinder::<f32, 2>::try_new(0.125).expect("a margin");
    for step in 0..600 {
        (0..20).for_each(|k| finder.insert(20 * step + k, random_box(state, 400)));
        finder.update(&mut |_, _| true, &mut |_, _, _| {});
        let (placed, moving) = (take_placed(), finder.moving.len());
        assert!(placed < 4500, "{placed} objects are moved in step {step}");
        assert!(moving < 3000, "{moving} count as moving in step {step}");
    }
    assert_eq!(finder.validate(), Ok(()), "sound");
    assert!(finder.still.len() > 8_000, "{} are still", finder.still.len());
}

/// Each update removes one of 2000 overlapping boxes in a row, and nothing moves. The others come
/// to rest, also by an exchange of the trees in an update after a removal, and keep being found.
#[test]
fn removals_do_not_disturb_objects_at_rest() {
    let unit = |x: u32| {
        let center = Point::<f64, 2>::new(f64::from(x), 0.0);
        Aabb::from_half_extents(center, Vector::repeat(0.625))
    };
    let mut finder = PairFinder::<f64, 2>::try_new(0.125).expect("a margin");
    (0..2000).for_each(|id| finder.insert(id, unit(id)));
    let mut removed = 0;
    for step in 0..100 {
        finder.update(&mut |_, _| true, &mut |_, _, _| ());
        assert_eq!(finder.validate(), Ok(()), "in step {step}");
        finder.remove(19 * step);
        removed += 1;
    }
    assert!(finder.still.len() > 1800, "{} are still", finder.still.len());
    finder.refilter_all();
    let mut stopped = 0;
    finder.update(&mut |_, _| false, &mut |_, _, has_started| stopped += u32::from(!has_started));
    // The first of the row had one neighbour, each other removed box two.
    assert_eq!(stopped, 1999 - 2 * removed + 1, "all pairs that are left");
}
