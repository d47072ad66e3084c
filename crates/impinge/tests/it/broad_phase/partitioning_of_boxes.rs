//! Compares searches of a tree with a box, at rest or moving, with a scan of all boxes.
//!
//! Coordinates that are whole numbers or halves do not round in the scan, which uses `f64`, so
//! results must be equal. For other coordinates the methods of single boxes give the expected
//! results.

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::math::{Point, Real, Space, Vector};
use impinge::partitioning::BoxTree;
use impinge_reference::random::Random;

/// A box, as its least and its greatest corner.
type Corners<const D: usize> = [[f64; D]; 2];
/// Results of a search: the key (a distance or a time) and the index of the box.
type Found<N> = Vec<(N, usize)>;

const COUNTS: [usize; 5] = [0, 1, 17, 300, 2500];

fn vector<N: Real, const D: usize>(v: [f64; D]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(v[axis]))
}

fn aabb<N: Real, const D: usize>([lo, hi]: Corners<D>) -> Aabb<N, D> {
    Aabb::new(Point::from(vector(lo)), Point::from(vector(hi)))
}

fn tree_of<N: Space<D>, const D: usize>(corners: &[Corners<D>]) -> BoxTree<N, D> {
    BoxTree::from_boxes(&corners.iter().copied().map(aabb).collect::<Vec<_>>())
}

/// Returns a random multiple of 0.5 in `0..side`.
fn half(random: &mut Random, side: usize) -> f64 {
    let doubled = u16::try_from(random.below(2 * side)).expect("a small grid");
    f64::from(doubled) / 2.0
}

/// Returns a random box of extents up to 2, which may be flat.
fn small_box<const D: usize>(random: &mut Random, side: usize) -> Corners<D> {
    let lo: [f64; D] = core::array::from_fn(|_| half(random, side));
    [lo, lo.map(|x| x + half(random, 2))]
}

fn nearest<N: Space<D>, const D: usize>(
    tree: &BoxTree<N, D>,
    aabb: &Aabb<N, D>,
    max: N,
) -> Found<N> {
    let mut found = Vec::new();
    tree.visit_nearest_to_box(aabb, max, |index, distance| {
        found.push((distance, index));
        max
    });
    found
}

fn touched<N: Space<D>, const D: usize>(
    tree: &BoxTree<N, D>,
    aabb: &Aabb<N, D>,
    velocity: &Vector<N, D>,
    max: N,
) -> Found<N> {
    let mut found = Vec::new();
    tree.visit_cast(aabb, velocity, max, |index, time| {
        found.push((time, index));
        max
    });
    found
}

fn sorted<N: Real>(keys: impl Iterator<Item = Option<N>>) -> Found<N> {
    let mut all: Found<N> =
        keys.enumerate().filter_map(|(index, key)| Some((key?, index))).collect();
    all.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    all
}

/// Returns the key of the middle result, and the results up to that key, inclusively.
fn up_to<N: Real>(all: &Found<N>) -> (N, Found<N>) {
    let limit = all.get(all.len() / 2).map_or(N::ONE, |&(key, _)| key);
    (limit, all.iter().copied().filter(|&(key, _)| key <= limit).collect())
}

fn distance_squared<const D: usize>(a: &Corners<D>, b: &Corners<D>) -> f64 {
    let gap = |axis: usize| (a[0][axis] - b[1][axis]).max(b[0][axis] - a[1][axis]).max(0.0);
    (0..D).map(|axis| gap(axis) * gap(axis)).sum()
}

/// Returns the time at which a moving box first touches another: the least time at which two faces
/// are level while the boxes touch; zero if they touch at the start, and `None` if they never
/// touch.
fn touching<const D: usize>(own: &Corners<D>, other: &Corners<D>, v: &[f64; D]) -> Option<f64> {
    let level = |axis: usize| {
        let faces = [other[0][axis] - own[1][axis], other[1][axis] - own[0][axis]];
        faces.map(|gap| gap / v[axis])
    };
    let times = (0..D).filter(|&axis| v[axis] != 0.0).flat_map(level).chain([0.0]);
    let meet = |time: f64| {
        let moved = own.map(|corner| core::array::from_fn(|axis| corner[axis] + time * v[axis]));
        distance_squared(&moved, other) == 0.0
    };
    times.filter(|&time| time >= 0.0 && meet(time)).min_by(f64::total_cmp)
}

fn on_a_grid<N: Space<D>, const D: usize>() {
    let (mut random, mut hits, mut misses) = (Random::new(11), 0, 0);
    for count in COUNTS {
        // The grid is so large that only a few boxes overlap.
        let holds = |side: &usize| (0..D).map(|_| side).product::<usize>() >= count;
        let side = (3..).find(holds).expect("one is large enough");
        let boxes: Vec<Corners<D>> = (0..count).map(|_| small_box(&mut random, side)).collect();
        let tree = tree_of::<N, D>(&boxes);
        for _ in 0..25 {
            let own: Corners<D> = small_box(&mut random, side);
            let squares = boxes.iter().map(|other| N::lit(distance_squared(&own, other)));
            let expected = sorted(squares.map(|squared| Some(squared.sqrt())));
            assert_eq!(nearest(&tree, &aabb(own), N::INFINITY), expected, "{own:?} of {count}");
            let (limit, within) = up_to(&expected);
            assert_eq!(nearest(&tree, &aabb(own), limit), within, "{own:?} up to {limit}");
            // Speeds are powers of two or zero, so all quotients are exact.
            let v: [f64; D] =
                core::array::from_fn(|_| [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0][random.below(6)]);
            let times = boxes.iter().map(|other| touching(&own, other, &v).map(N::lit));
            let (expected, velocity) = (sorted(times), vector(v));
            let found = touched(&tree, &aabb(own), &velocity, N::INFINITY);
            assert_eq!(found, expected, "{own:?} along {v:?} of {count}");
            let (limit, within) = up_to(&expected);
            let found = touched(&tree, &aabb(own), &velocity, limit);
            assert_eq!(found, within, "{own:?} along {v:?} up to {limit}");
            hits += expected.len();
            misses += count - expected.len();
        }
    }
    assert!(hits > 1000 && misses > 1000, "some are met, some are not: {hits}, {misses}");
}

/// Tests boxes with coordinates that no `f32` represents, near the origin and far from it. The
/// tree, which has `f32` boxes, only proposes candidates; the boxes as given decide.
fn anywhere<N: Space<D>, const D: usize>() {
    around::<N, D>(0.0);
    around::<N, D>(1e6);
}

fn around<N: Space<D>, const D: usize>(offset: f64) {
    let (mut random, mut hits) = (Random::new(12), 0);
    let place = |random: &mut Random| -> [f64; D] {
        core::array::from_fn(|_| offset + random.range(-5.0, 5.0))
    };
    let random_box = |random: &mut Random| {
        let lo = place(random);
        aabb::<N, D>([lo, lo.map(|x| x + random.magnitude(1e-9, 32))])
    };
    let boxes: Vec<Aabb<N, D>> = (0..500).map(|_| random_box(&mut random)).collect();
    let tree = BoxTree::from_boxes(&boxes);
    for round in 0..150 {
        let own = random_box(&mut random);
        let velocity = boxes[random.below(500)].mins() - own.mins();
        let expected = sorted(boxes.iter().map(|other| Some(other.distance_to_aabb(&own))));
        assert_eq!(nearest(&tree, &own, N::INFINITY), expected, "round {round}");
        let enter = |other: &Aabb<N, D>| other.sweep_interval(&own, &velocity).map(|times| times.0);
        let expected = sorted(boxes.iter().map(enter));
        assert_eq!(touched(&tree, &own, &velocity, N::INFINITY), expected, "round {round}");
        hits += expected.len();
    }
    assert!(hits > 300, "they meet more than what they aim at: {hits}");
}

fn unbounded<N: Space<D>, const D: usize>() {
    let end = |x: f64| if x > 3.0 { f64::INFINITY } else { x };
    let mut random = Random::new(13);
    let boxes: Vec<Corners<D>> = (0..60)
        .map(|_| {
            let [lo, hi] = small_box(&mut random, 5);
            [lo, hi.map(end)]
        })
        .collect();
    let tree = tree_of::<N, D>(&boxes);
    for _ in 0..50 {
        let mut own: Corners<D> = small_box(&mut random, 5);
        own[0][0] = f64::NEG_INFINITY;
        let squares = boxes.iter().map(|other| N::lit(distance_squared(&own, other)));
        let expected = sorted(squares.map(|squared| Some(squared.sqrt())));
        assert_eq!(nearest(&tree, &aabb(own), N::INFINITY), expected, "from {own:?}");
        let v = [0.5; D];
        let expected = sorted(boxes.iter().map(|other| touching(&own, other, &v).map(N::lit)));
        let found = touched(&tree, &aabb(own), &vector(v), N::INFINITY);
        assert_eq!(found, expected, "{own:?} moves");
    }
    let everything = nearest(&tree, &Aabb::unbounded(), N::ZERO);
    assert_eq!(everything, sorted((0..60).map(|_| Some(N::ZERO))), "all lie in all of space");
    let found = touched(&tree, &Aabb::unbounded(), &Vector::<N, D>::zeros(), N::ZERO);
    assert_eq!(found, everything, "and rest there");
}

fn limits<N: Space<D>, const D: usize>() {
    // Points at 1, 2, 2 and 3 on every axis. The search starts at the origin.
    let boxes = [3.0, 2.0, 1.0, 2.0].map(|x| [[x; D]; 2]);
    let (tree, origin) = (tree_of::<N, D>(&boxes), aabb::<N, D>([[0.0; D]; 2]));
    let v = vector([1.0; D]);
    let found = touched(&tree, &origin, &v, N::TWO);
    assert_eq!(found, [(N::ONE, 2), (N::TWO, 1), (N::TWO, 3)], "ties by index, the limit counts");
    for (stop, expected) in [(N::ONE, 1), (-N::ONE, 1), (N::lit(f64::NAN), 1), (N::TWO, 3)] {
        let (mut times, mut distances) = (0, 0);
        tree.visit_cast(&origin, &v, N::INFINITY, |_, _| {
            times += 1;
            stop
        });
        tree.visit_nearest_to_box(&origin, N::INFINITY, |_, distance| {
            distances += 1;
            distance * stop
        });
        assert_eq!(times, expected, "stopped by {stop}");
        assert!(distances <= expected, "stopped by {stop}");
    }
    for limit in [-N::ONE, N::lit(f64::NAN)] {
        assert!(touched(&tree, &origin, &v, limit).is_empty(), "no time: {limit}");
        assert!(nearest(&tree, &origin, limit).is_empty(), "no room: {limit}");
    }
    let none = tree_of::<N, D>(&[]);
    assert!(touched(&none, &origin, &v, N::INFINITY).is_empty(), "there is nothing");
    assert!(nearest(&none, &Aabb::unbounded(), N::INFINITY).is_empty(), "there is nothing");
}

/// Asserts that the order and the limit hold for distances whose squares overflow the scalar.
fn huge<N: Space<D>, const D: usize>() {
    let unit = N::MAX.as_f32().min(f32::MAX / 8.0);
    let unit = f64::from(unit) / 64.0;
    let boxes: Vec<Corners<D>> = (0..40)
        .map(|x| [[f64::from(x % 20) * unit; D], [f64::from(x % 20 + 1) * unit; D]])
        .collect();
    let tree = tree_of::<N, D>(&boxes);
    let own = aabb([[-1.0; D], [0.5 * unit; D]]);
    let expected = sorted(tree.boxes().iter().map(|other| Some(other.distance_to_aabb(&own))));
    let finite = expected.iter().filter(|(distance, _)| distance.is_finite_number()).count();
    assert_eq!(finite, 40, "no distance is infinite: {expected:?}");
    assert_eq!(nearest(&tree, &own, N::INFINITY), expected, "in order");
    let (limit, within) = up_to(&expected);
    assert_eq!(nearest(&tree, &own, limit), within, "up to {limit}");
}

fn not_a_number<N: Space<D>, const D: usize>() {
    let unit = aabb::<N, D>([[0.0; D], [1.0; D]]);
    let (tree, v) = (BoxTree::from_boxes(&[unit, Aabb::unbounded()]), vector([1.0; D]));
    let far = Point::from(Vector::<N, D>::repeat(N::INFINITY));
    let bad = [unit.loosened(N::lit(f64::NAN)), unit.loosened(-N::ONE), Aabb::new(far, far)];
    for own in bad {
        assert!(nearest(&tree, &own, N::INFINITY).is_empty(), "{own:?}");
        assert!(touched(&tree, &own, &v, N::INFINITY).is_empty(), "{own:?}");
    }
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..D {
            let mut velocity = v;
            velocity[axis] = N::lit(value);
            assert!(touched(&tree, &unit, &velocity, N::INFINITY).is_empty(), "{velocity}");
        }
    }
}

in_tests! {
    on_a_grid, anywhere, unbounded, limits, huge, not_a_number,
}
