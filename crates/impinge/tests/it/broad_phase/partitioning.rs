//! Compares a tree over boxes with a scan of all boxes.
//!
//! Coordinates are whole numbers or halves, so that touching is common and the scan, done in `f64`
//! without rounding, is exact.

use impinge::bounding_volume::{Aabb, Ray};
use impinge::math::{Point, Real, Space, Vector};
use impinge::partitioning::{BoxTree, BoxTreeError};
use impinge_reference::random::Random;

/// A box, as its least and its greatest corner.
type Corners<const D: usize> = [[f64; D]; 2];

const COUNTS: [usize; 8] = [0, 1, 2, 16, 17, 257, 600, 4200];

fn point<N: Real, const D: usize>(p: [f64; D]) -> Point<N, D> {
    Point::from(Vector::<N, D>::from_fn(|axis, _| N::lit(p[axis])))
}

fn vector<N: Real, const D: usize>(v: [f64; D]) -> Vector<N, D> {
    point::<N, D>(v).coords
}

fn aabb<N: Real, const D: usize>([lo, hi]: Corners<D>) -> Aabb<N, D> {
    Aabb::new(point(lo), point(hi))
}

fn tree_of<N: Space<D>, const D: usize>(corners: &[Corners<D>]) -> BoxTree<N, D> {
    let tree = BoxTree::from_boxes(&corners.iter().copied().map(aabb).collect::<Vec<_>>());
    tree.validate().expect("sound");
    assert_eq!((tree.len(), tree.is_empty()), (corners.len(), corners.is_empty()), "all of them");
    tree
}

/// Returns a random multiple of 0.5 in `0..side`.
fn half(random: &mut Random, side: usize) -> f64 {
    let doubled = u16::try_from(random.below(2 * side)).expect("a small grid");
    f64::from(doubled) / 2.0
}

fn place<const D: usize>(random: &mut Random, side: usize) -> [f64; D] {
    core::array::from_fn(|_| half(random, side))
}

/// Returns the side of a grid and `count` boxes of extents up to 2 on it. The grid is so large that
/// only a few overlap; some boxes are flat, and some are copies.
fn scene<const D: usize>(random: &mut Random, count: usize) -> (usize, Vec<Corners<D>>) {
    let dimension = u32::try_from(D).expect("small");
    let holds = |side: &usize| side.pow(dimension) >= count;
    let side = (2..).find(holds).expect("one is large enough");
    let mut boxes: Vec<Corners<D>> = Vec::new();
    for index in 0..count {
        let lo: [f64; D] = place(random, side);
        let extent: [f64; D] = core::array::from_fn(|_| half(random, 2));
        let hi = core::array::from_fn(|axis| lo[axis] + extent[axis]);
        boxes.push(if random.below(8) == 0 && index > 0 { boxes[index / 2] } else { [lo, hi] });
    }
    (side, boxes)
}

fn overlap<const D: usize>(a: &Corners<D>, b: &Corners<D>) -> bool {
    (0..D).all(|axis| a[0][axis] <= b[1][axis] && b[0][axis] <= a[1][axis])
}

fn matching<const D: usize>(
    boxes: &[Corners<D>],
    accept: impl Fn(&Corners<D>) -> bool,
) -> Vec<usize> {
    (0..boxes.len()).filter(|&index| accept(&boxes[index])).collect()
}

/// Asserts that at least a tenth of `of` cases found something, so that the test is meaningful.
fn assert_common(what: &str, hits: usize, of: usize) {
    assert!(10 * hits >= of, "{what}: {hits} of {of} found something");
}

fn boxes_and_points<N: Space<D>, const D: usize>() {
    let (mut random, mut hits, mut misses, mut asked) = (Random::new(1), [0; 2], 0, 0);
    for count in COUNTS {
        let (side, boxes) = scene::<D>(&mut random, count);
        let tree = tree_of::<N, D>(&boxes);
        for _ in 0..100 {
            let lo: [f64; D] = place(&mut random, side);
            let query = [lo, lo.map(|x| x + half(&mut random, 2))];
            let expected = matching(&boxes, |corners| overlap(corners, &query));
            assert_eq!(tree.overlapping(&aabb(query)), expected, "boxes at {query:?} of {count}");
            let mut visited = Vec::new();
            tree.visit_overlapping(&aabb(query), |index| visited.push(index));
            visited.sort_unstable();
            assert_eq!(visited, expected, "each once");
            hits[0] += usize::from(!expected.is_empty());
            let expected = matching(&boxes, |corners| overlap(corners, &[lo; 2]));
            assert_eq!(tree.containing(&point(lo)), expected, "boxes that hold {lo:?} of {count}");
            hits[1] += usize::from(!expected.is_empty());
            misses += usize::from(expected.is_empty());
            asked += 1;
        }
    }
    assert_common("boxes", hits[0], asked);
    assert_common("points", hits[1], asked);
    assert_common("points that miss", misses, asked);
}

/// Returns the time at which a ray enters a box: the least time, from zero on, at which it is in
/// the box and on one of its faces; zero if it starts in the box, and `None` if it never meets it.
/// With the numbers of these tests nothing rounds.
fn entry<const D: usize>([lo, hi]: &Corners<D>, from: &[f64; D], dir: &[f64; D]) -> Option<f64> {
    let crossing = |axis: usize| [lo, hi].map(|face| (face[axis] - from[axis]) / dir[axis]);
    let crossings = (0..D).filter(|&axis| dir[axis] != 0.0).flat_map(crossing);
    let is_in = |time: f64| {
        let at: [f64; D] = core::array::from_fn(|axis| from[axis] + time * dir[axis]);
        overlap(&[*lo, *hi], &[at; 2])
    };
    let times = crossings.chain([0.0]).filter(|&time| time >= 0.0 && is_in(time));
    times.min_by(f64::total_cmp)
}

fn rays<N: Space<D>, const D: usize>() {
    let (mut random, mut hits, mut asked) = (Random::new(2), 0, 0);
    for count in COUNTS {
        let (side, boxes) = scene::<D>(&mut random, count);
        let tree = tree_of::<N, D>(&boxes);
        for _ in 0..100 {
            let from: [f64; D] = place(&mut random, side);
            // Speeds are powers of two or zero, so all quotients are exact.
            let dir: [f64; D] =
                core::array::from_fn(|_| [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0][random.below(6)]);
            let ray = Ray::new(point::<N, D>(from), vector(dir));
            let mut expected: Vec<(f64, usize)> = (0..count)
                .filter_map(|index| Some((entry(&boxes[index], &from, &dir)?, index)))
                .collect();
            let indices: Vec<usize> = expected.iter().map(|&(_, index)| index).collect();
            assert_eq!(tree.hit_by(&ray), indices, "{from:?} along {dir:?} of {count}");
            expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            let mut found = Vec::new();
            tree.visit_ray(&ray, N::INFINITY, |index, time| {
                found.push((time.as_f64(), index));
                N::INFINITY
            });
            assert_eq!(found, expected, "in order of (time, index)");
            assert_limits(&tree, &ray, &expected);
            hits += usize::from(!expected.is_empty());
            asked += 1;
        }
    }
    assert_common("rays", hits, asked);
}

/// Asserts that a maximum time removes the end of the list of hits, and changes nothing else.
fn assert_limits<N: Space<D>, const D: usize>(
    tree: &BoxTree<N, D>,
    ray: &Ray<N, D>,
    expected: &[(f64, usize)],
) {
    let first = expected.first().map(|&(time, index)| (index, N::lit(time)));
    assert_eq!(tree.first_hit(ray, N::INFINITY), first, "the first of them");
    let Some(&(middle, _)) = expected.get(expected.len() / 2) else { return };
    let within = expected.iter().filter(|&&(time, _)| time <= middle).count();
    let (mut before, mut after) = (0, 0);
    tree.visit_ray(ray, N::lit(middle), |_, _| {
        before += 1;
        N::INFINITY
    });
    tree.visit_ray(ray, N::INFINITY, |_, _| {
        after += 1;
        N::lit(middle)
    });
    assert_eq!((before, after), (within, within), "up to {middle}, and the limit never grows");
    let mut asked = 0;
    tree.visit_ray(ray, N::lit(middle), |_, _| {
        asked += 1;
        N::lit(f64::NAN)
    });
    assert_eq!(asked, 1, "NaN ends it");
}

fn distance_squared<const D: usize>([lo, hi]: &Corners<D>, p: &[f64; D]) -> f64 {
    let gap = |axis: usize| (lo[axis] - p[axis]).max(p[axis] - hi[axis]).max(0.0);
    (0..D).map(|axis| gap(axis) * gap(axis)).sum()
}

fn nearest<N: Space<D>, const D: usize>() {
    let (mut random, mut inside, mut asked) = (Random::new(3), 0, 0);
    for count in COUNTS {
        let (side, boxes) = scene::<D>(&mut random, count);
        let tree = tree_of::<N, D>(&boxes);
        for _ in 0..30 {
            let p: [f64; D] = place(&mut random, side);
            // The squared distances are exact, so both scalars take the root of the same number.
            let mut expected: Vec<(f64, usize)> =
                (0..count).map(|index| (distance_squared(&boxes[index], &p), index)).collect();
            expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            let expected: Vec<(N, usize)> =
                expected.iter().map(|&(squared, index)| (N::lit(squared).sqrt(), index)).collect();
            let mut found = Vec::new();
            tree.visit_nearest(&point(p), N::INFINITY, |index, distance| {
                found.push((distance, index));
                N::INFINITY
            });
            assert_eq!(found, expected, "all by (distance, index) from {p:?} of {count}");
            let first = expected.first().map(|&(distance, index)| (index, distance));
            assert_eq!(tree.nearest(&point(p), N::INFINITY), first, "the nearest");
            let reach = N::lit(half(&mut random, 4));
            let within = expected.iter().filter(|&&(distance, _)| distance <= reach).count();
            let mut visited = 0;
            tree.visit_nearest(&point(p), reach, |_, _| {
                visited += 1;
                reach
            });
            assert_eq!(visited, within, "up to {reach}, that included");
            inside += usize::from(first.is_some_and(|(_, distance)| distance == N::ZERO));
            asked += 1;
        }
    }
    assert_common("points in boxes", inside, asked);
    assert_common("points outside", asked - inside, asked);
}

/// Tests boxes with coordinates that no `f32` represents. The tree, which has `f32` boxes, only
/// proposes candidates; the boxes as given decide. Ordered searches give the bits of the methods of
/// [`Aabb`].
fn anywhere<N: Space<D>, const D: usize>() {
    let (mut random, mut proposed) = (Random::new(4), 0);
    let lo = |random: &mut Random| core::array::from_fn(|_| random.range(-10.0, 10.0));
    let boxes: Vec<Aabb<N, D>> = (0..700)
        .map(|_| {
            let lo: [f64; D] = lo(&mut random);
            aabb([lo, lo.map(|x| x + random.magnitude(1e-9, 36))])
        })
        .collect();
    let tree = BoxTree::from_boxes(&boxes);
    tree.validate().expect("sound");
    for round in 0..300 {
        let target = boxes[random.below(700)].mins().coords;
        let origin = point::<N, D>(lo(&mut random));
        let ray = Ray::new(origin, target - origin.coords);
        let mut expected: Vec<(N, usize)> = (0..700)
            .filter_map(|index| Some((boxes[index].ray_interval(&ray)?.0, index)))
            .collect();
        expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        let mut found = Vec::new();
        tree.visit_ray(&ray, N::INFINITY, |index, time| {
            found.push((time, index));
            N::INFINITY
        });
        assert_eq!(found, expected, "round {round}");
        proposed += found.len();
        let mut expected: Vec<(N, usize)> =
            (0..700).map(|index| (boxes[index].distance_to_point(&origin), index)).collect();
        expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        let mut found = Vec::new();
        tree.visit_nearest(&origin, N::INFINITY, |index, distance| {
            found.push((distance, index));
            N::INFINITY
        });
        assert_eq!(found, expected, "round {round}");
    }
    assert!(proposed > 600, "rays meet more than what they aim at: {proposed}");
}

fn unbounded<N: Space<D>, const D: usize>() {
    let beyond = |x: f64| if x > 3.0 { f64::INFINITY } else { x };
    let (mut random, boxes) = (Random::new(6), scene::<D>(&mut Random::new(5), 60).1);
    let boxes: Vec<Corners<D>> = boxes.iter().map(|[lo, hi]| [*lo, hi.map(beyond)]).collect();
    let endless = boxes.iter().filter(|[_, hi]| hi.iter().any(|x| x.is_infinite())).count();
    assert!((5..55).contains(&endless), "{endless} of 60 are unbounded");
    let tree = tree_of::<N, D>(&boxes);
    for _ in 0..200 {
        let p: [f64; D] = core::array::from_fn(|_| 100.0 * half(&mut random, 2));
        let expected = matching(&boxes, |corners| overlap(corners, &[p; 2]));
        assert_eq!(tree.containing(&point(p)), expected, "far out");
        let found = tree.nearest(&point(p), N::INFINITY).map(|(_, d)| (d * d).as_f64());
        let squares = boxes.iter().map(|corners| distance_squared(corners, &p));
        let least = squares.fold(f64::INFINITY, f64::min);
        assert!(
            (found.expect("there are boxes") - least).abs() <= 4.0 * N::EPSILON.as_f64() * least,
            "{p:?}"
        );
        let everything = tree.overlapping(&Aabb::unbounded());
        assert_eq!(everything, (0..60).collect::<Vec<_>>(), "all boxes lie in all of space");
    }
    let all = tree.bounds().expect("there are boxes");
    assert!(!all.is_bounded(), "around everything");
    // Three unbounded boxes, which one ray hits.
    let tree = tree_of::<N, D>(&[[[f64::NEG_INFINITY; D], [f64::INFINITY; D]]; 3]);
    let ray = Ray::new(Point::origin(), vector([1.0; D]));
    assert_eq!(tree.hit_by(&ray), [0, 1, 2], "inside at once");
    assert_eq!(tree.first_hit(&ray, N::ZERO), Some((0, N::ZERO)), "the least index");
    let bare = tree_of::<N, D>(&[[[0.0; D], [f64::INFINITY; D]]]);
    assert_eq!(bare.nearest(&point([-2.0; D]), N::ONE), None, "too far");
}

fn few_and_equal<N: Space<D>, const D: usize>() {
    let none = tree_of::<N, D>(&[]);
    let (origin, ray) = (Point::origin(), Ray::new(Point::origin(), vector([1.0; D])));
    assert!(none.overlapping(&Aabb::unbounded()).is_empty(), "there is nothing");
    assert!(none.containing(&origin).is_empty() && none.hit_by(&ray).is_empty(), "nothing");
    assert_eq!(none.nearest(&origin, N::INFINITY), None, "nothing");
    assert_eq!(none.bounds(), None, "around nothing");
    // A thousand equal points: every list is in ascending order of the index.
    let tree = tree_of::<N, D>(&[[[2.0; D]; 2]; 1000]);
    let all: Vec<usize> = (0..1000).collect();
    assert_eq!(tree.containing(&point([2.0; D])), all, "a point holds itself");
    assert_eq!(tree.hit_by(&ray), all, "straight through it");
    let mut found = Vec::new();
    tree.visit_ray(&ray, N::TWO, |index, time| {
        assert_eq!(time, N::TWO, "all at once");
        found.push(index);
        N::TWO
    });
    tree.visit_nearest(&origin, N::INFINITY, |index, _| {
        found.push(index);
        N::INFINITY
    });
    assert_eq!(found, [all.clone(), all].concat(), "by index");
    assert_eq!(tree.first_hit(&ray, N::ONE), None, "later than that");
}

fn not_a_number<N: Space<D>, const D: usize>() {
    let good = Aabb::<N, D>::new(Point::origin(), point([1.0; D]));
    let tree = BoxTree::from_boxes(&[good, Aabb::unbounded()]);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(N::lit) {
        for axis in 0..D {
            let (mut p, mut v) = (Point::<N, D>::origin(), vector::<N, D>([1.0; D]));
            (p[axis], v[axis]) = (bad, bad);
            for ray in [Ray::new(p, vector([1.0; D])), Ray::new(Point::origin(), v)] {
                assert!(tree.hit_by(&ray).is_empty(), "{ray:?}");
                assert_eq!(tree.first_hit(&ray, N::INFINITY), None, "{ray:?}");
            }
            assert_eq!(tree.nearest(&p, N::INFINITY), None, "{p}");
            let everywhere: &[usize] = if bad.partial_cmp(&N::ZERO).is_some() { &[1] } else { &[] };
            assert_eq!(tree.containing(&p), everywhere, "{p}");
        }
    }
    let nan = N::lit(f64::NAN);
    assert_eq!(tree.nearest(&Point::origin(), nan), None, "no limit");
    assert_eq!(tree.nearest(&Point::origin(), -N::ONE), None, "no room");
    use impinge::bounding_volume::BoundingVolume;
    let inverted = good.loosened(-N::ONE);
    let error = BoxTree::try_from_boxes(&[good, inverted]).map(|tree| tree.len());
    let is_bad = |error: BoxTreeError, index: usize| matches!(error, BoxTreeError::BadBox { index: at, .. } if at == index);
    assert!(error.is_err_and(|error| is_bad(error, 1)), "arithmetic can invert a box");
    let error = BoxTree::try_from_boxes(&[good.loosened(nan)]).map(|tree| tree.len());
    assert!(error.is_err_and(|error| is_bad(error, 0)), "and spoil it");
}

#[test]
#[should_panic(expected = "box 0 is unusable: the box is inverted on axis 0")]
fn bad_boxes_panic() {
    use impinge::bounding_volume::BoundingVolume;
    let inverted = aabb::<f32, 2>([[0.0; 2], [1.0; 2]]).loosened(-1.0);
    let _ = BoxTree::from_boxes(&[inverted]);
}

in_tests! {
    boxes_and_points, rays, nearest, anywhere, unbounded, few_and_equal, not_a_number,
}
