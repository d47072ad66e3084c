//! Tests of trees against brute-force lists: joins with few and many changes, searches, and the
//! order of nearest objects.

use core::cell::Cell;

use super::{Bounds, Changes, Frontier, Joiner, Keys, Lanes, Tree};
use crate::bounding_volume::Aabb;
use crate::math::{Point, filled};
use crate::pairs::{pack, unpack};
use crate::samples::samples;

thread_local! {
    static PLACED: Cell<usize> = const { Cell::new(0) };
}

/// Adds to the number of objects placed in slots on this thread, which bounds the work of a step.
pub(super) fn count_placed(count: usize) {
    PLACED.set(PLACED.get() + count);
}

/// Returns and resets the number of objects placed in slots on this thread.
pub(crate) fn take_placed() -> usize {
    PLACED.take()
}

/// Returns a pseudorandom number below `bound`, from a linear congruential generator.
pub(super) fn next(state: &mut u64, bound: u32) -> u32 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    u32::try_from((*state >> 33) % u64::from(bound)).expect("below a u32")
}

fn small_float(value: u32) -> f32 {
    f32::from(u16::try_from(value).expect("small"))
}

/// Returns a random box with corners at multiples of 0.5 and sides of 0 to 2, exact in `f32`.
pub(super) fn random_box<const D: usize>(state: &mut u64, side: u32) -> Bounds<D> {
    let lo: [f32; D] = filled(|_| small_float(next(state, 2 * side)) / 2.0);
    Bounds { lo, hi: lo.map(|x| x + small_float(next(state, 5)) / 2.0) }
}

/// Returns the box shifted along each axis by a random multiple of 0.5, of magnitude up to
/// `max_move / 2`.
fn near<const D: usize>(old: &Bounds<D>, state: &mut u64, max_move: u32) -> Bounds<D> {
    let shift: [f32; D] =
        filled(|_| small_float(next(state, 2 * max_move + 1)) / 2.0 - small_float(max_move) / 2.0);
    Bounds {
        lo: filled(|axis| old.lo[axis] + shift[axis]),
        hi: filled(|axis| old.hi[axis] + shift[axis]),
    }
}

/// A tree and its expected content: by id, the box now and the box at the last commit.
struct Twin<const D: usize> {
    tree: Tree<D>,
    list: Vec<Option<(Bounds<D>, Bounds<D>)>>,
    /// The least id in this tree.
    first: usize,
}

impl<const D: usize> Twin<D> {
    /// Creates a tree of `count` random boxes with ids from `first` on.
    fn new(state: &mut u64, first: u32, count: u32, side: u32) -> Self {
        let (tree, list) = (Tree::new(Lanes::detect()), vec![None; first as usize]);
        let mut twin = Self { tree, list, first: first as usize };
        for id in first..first + count {
            let bounds = random_box(state, side);
            twin.tree.insert(id, &bounds, &Bounds::NOWHERE);
            twin.list.push(Some((bounds, Bounds::NOWHERE)));
        }
        twin
    }

    /// Moves, removes or inserts about one object in `rarity`. Moves go up to `max_move / 2` along
    /// each axis, or anywhere if `max_move` is at least `2 * side`. Then refits and validates the
    /// tree.
    fn change(&mut self, state: &mut u64, side: u32, max_move: u32, rarity: u32) {
        for id in self.first..self.list.len() {
            let number = u32::try_from(id).expect("small");
            if next(state, rarity) != 0 {
                continue;
            }
            let bounds = match &self.list[id] {
                Some((now, _)) if max_move < 2 * side => near(now, state, max_move),
                _ => random_box(state, side),
            };
            match &mut self.list[id] {
                Some(_) if next(state, 5) == 0 => {
                    self.tree.remove(number);
                    self.list[id] = None;
                }
                Some((now, _)) => {
                    self.tree.set_later(number);
                    *now = bounds;
                }
                None => {
                    self.tree.insert(number, &bounds, &Bounds::NOWHERE);
                    self.list[id] = Some((bounds, Bounds::NOWHERE));
                }
            }
        }
        let box_of =
            |object: &Option<(Bounds<D>, Bounds<D>)>| object.map_or(Bounds::EMPTY, |(now, _)| now);
        self.tree.refit_from(&self.list.iter().map(box_of).collect::<Vec<_>>());
        self.tree.validate().expect("sound after a refit");
    }

    fn commit_boxes(&mut self) {
        self.tree.commit_boxes();
        self.tree.maintain();
        self.tree.validate().expect("sound after settling");
        self.list.iter_mut().flatten().for_each(|(now, before)| *before = *now);
    }

    fn objects(&self) -> impl Iterator<Item = (u32, &(Bounds<D>, Bounds<D>))> {
        (0..).zip(&self.list).filter_map(|(id, object)| Some((id, object.as_ref()?)))
    }
}

/// Returns, by brute force, the pairs of distinct objects that began or ended.
fn differences<const D: usize>(first: &Twin<D>, second: &Twin<D>) -> Changes {
    let mut changes = Changes::default();
    for (a, (now1, before1)) in first.objects() {
        for (b, (now2, before2)) in second.objects() {
            match (now1.overlaps(now2), before1.overlaps(before2)) {
                (true, false) if a != b => changes.began.push(pack(a, b)),
                (false, true) => changes.ended.push(pack(a, b)),
                _ => {}
            }
        }
    }
    for keys in [&mut changes.began, &mut changes.ended] {
        keys.sort_unstable();
        keys.dedup();
    }
    changes
}

fn sorted(mut keys: Vec<u64>) -> Vec<u64> {
    keys.sort_unstable();
    keys
}

/// Asserts that a join found all began pairs, and all ended pairs except pairs of escaped objects.
/// Returns the numbers of began and ended pairs that it found.
fn check_changes<const D: usize>(
    found: Changes,
    (first, second): (&Twin<D>, &Twin<D>),
) -> (usize, usize) {
    let expected = differences(first, second);
    let escaped: Vec<u32> = first.tree.escaped().chain(second.tree.escaped()).collect();
    let counts = (found.began.len(), found.ended.len());
    let ended = sorted(found.ended);
    assert!(sorted(found.began) == expected.began, "began");
    assert!(ended.windows(2).all(|two| two[0] < two[1]), "each once");
    assert!(ended.iter().all(|key| expected.ended.binary_search(key).is_ok()), "ended in truth");
    for key in expected.ended.iter().filter(|key| ended.binary_search(key).is_err()) {
        let (a, b) = unpack(*key);
        assert!(escaped.contains(&a) || escaped.contains(&b), "({a}, {b}) ended unnoticed");
    }
    counts
}

/// Checks joins of two trees over 25 steps with [`check_changes`]. In each step about one object in
/// `rarity1` of the first tree and in `rarity2` of the second changes; moves go up to `max_move /
/// 2` along each axis, or anywhere if `max_move` is at least `2 * side`.
fn check_joins<const D: usize>(side: u32, rarity1: u32, rarity2: u32, max_move: u32) {
    let mut state = u64::from(side * 100 + rarity1 * 10 + rarity2);
    let mut first = Twin::<D>::new(&mut state, 0, 700, side);
    let mut second = Twin::<D>::new(&mut state, 700, 90, side);
    let (mut joiner, mut found) = (Joiner::default(), (0, 0));
    let rounds = samples(3);
    for _ in 0..rounds {
        first.change(&mut state, side, max_move, rarity1);
        second.change(&mut state, side, max_move, rarity2);
        let (mut own, mut across) = (Changes::default(), Changes::default());
        joiner.self_join(&first.tree, &mut own);
        joiner.cross_join(&first.tree, &second.tree, &mut across);
        for counts in
            [check_changes(own, (&first, &first)), check_changes(across, (&first, &second))]
        {
            found = (found.0 + counts.0, found.1 + counts.1);
        }
        first.commit_boxes();
        second.commit_boxes();
    }
    assert!(found.0 > 40 * rounds, "{} beginnings", found.0);
    assert!(found.1 > 30 * rounds || max_move > 4, "{} ends", found.1);
}

#[test]
fn joins_in_every_regime() {
    for max_move in [2, 1000] {
        check_joins::<2>(20, 1, 1, max_move);
        check_joins::<2>(20, 40, 1000, max_move);
        check_joins::<3>(8, 1000, 2, max_move);
        check_joins::<3>(8, 30, 30, max_move);
        check_joins::<3>(8, 2, 1000, max_move);
    }
}

#[test]
fn searches_find_what_a_list_finds() {
    let mut state = 77;
    let mut twin = Twin::<3>::new(&mut state, 0, 600, 10);
    let mut found_any = 0;
    for _ in 0..60 {
        twin.change(&mut state, 10, 1000, 10);
        twin.commit_boxes();
        let mut query = random_box(&mut state, 10);
        if next(&mut state, 4) == 0 {
            query.lo[1] = f32::NEG_INFINITY;
        }
        let mut found = Vec::new();
        twin.tree.visit_overlapping(&query, |id| found.push(id));
        found.sort_unstable();
        let hits = twin.objects().filter(|(_, (now, _))| now.overlaps(&query));
        let expected: Vec<u32> = hits.map(|(id, _)| id).collect();
        found_any += usize::from(!expected.is_empty());
        assert_eq!(found, expected, "{query:?}");
    }
    assert!(found_any > 20, "{found_any} searches found something");
}

#[test]
fn the_nearest_come_first() {
    let mut state = 78;
    let mut twin = Twin::<2>::new(&mut state, 0, 900, 40);
    twin.tree.refit();
    for _ in 0..50 {
        let point: [f64; 2] = [next(&mut state, 40).into(), next(&mut state, 40).into()];
        let point = Point::<f64, 2>::from(point);
        let distance = |id: u32| {
            let (now, _) = twin.list[id as usize]?;
            let corner = |x: [f32; 2]| Point::<f64, 2>::from(x.map(f64::from));
            Some(Aabb::new(corner(now.lo), corner(now.hi)).distance_to_point(&point))
        };
        let mut expected: Vec<(f64, u32)> =
            twin.objects().filter_map(|(id, _)| Some((distance(id)?, id))).collect();
        expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        let mut found = Vec::new();
        let block = |block: &_| Lanes::detect().distance_of_block(block, &Aabb::at(point));
        let keys = Keys { block, object: distance };
        Frontier::new().search(&[&twin.tree], f64::MAX, &keys, |id, key| {
            found.push((key, id));
            if found.len() < 20 { f64::MAX } else { -1.0 }
        });
        assert_eq!(found, expected[..20], "the twenty nearest of {point}");
    }
}

/// Tests that a tree keeps its invariants, and has no leftovers, if it is emptied and filled again
/// three times.
#[test]
fn emptied_and_filled() {
    let mut state = 5;
    let mut twin = Twin::<2>::new(&mut state, 0, 300, 10);
    twin.tree.refit();
    twin.commit_boxes();
    for round in 0..3 {
        for id in 0..300 {
            twin.tree.remove(id);
        }
        twin.tree.refit();
        twin.tree.commit_boxes();
        twin.tree.maintain();
        twin.tree.validate().expect("sound");
        assert!(twin.tree.is_empty(), "round {round}");
        twin.tree.visit_overlapping(&random_box(&mut state, 10), |_| panic!("it is empty"));
        for id in 0..300 {
            twin.tree.insert(id, &random_box(&mut state, 10), &Bounds::NOWHERE);
        }
        twin.tree.refit();
        assert_eq!(twin.tree.changed, 300, "all are new");
        twin.tree.commit_boxes();
        twin.tree.validate().expect("sound");
    }
}
