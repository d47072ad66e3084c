//! Compares searches among parts with a scan of all parts.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::math::{Point, Real, Vector};
use impinge::shape::{CompositeShape, PartSearch};
use impinge_reference::random::Random;

/// Returns a random number from -1 to 1 with few digits, so that touching is common.
pub fn coarse(random: &mut Random) -> f64 {
    f64::from(u32::try_from(random.below(65)).expect("few")) / 32.0 - 1.0
}

pub fn coarse_vector<N: Real, const D: usize>(random: &mut Random) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|_, _| N::lit(coarse(random)))
}

/// Returns a random box in the region of `around`, often flat or a point.
pub fn probe<N: Real, const D: usize>(random: &mut Random, around: &Aabb<N, D>) -> Aabb<N, D> {
    let reach = around.half_extents();
    let stretch = N::lit(if random.below(2) == 0 { 1.25 } else { 1.0 });
    let center = around.center() + reach.component_mul(&coarse_vector(random)) * stretch;
    let mut half = reach.component_mul(&coarse_vector::<N, D>(random).abs()) * N::lit(0.25);
    for axis in 0..D {
        if random.below(3) == 0 {
            half[axis] = N::ZERO;
        }
    }
    Aabb::new(center - half, center + half)
}

/// Returns the distance of two boxes; zero if they overlap.
fn distance<N: Real, const D: usize>(a: &Aabb<N, D>, b: &Aabb<N, D>) -> f64 {
    let gap = |axis: usize| {
        let below = b.mins()[axis].as_f64() - a.maxs()[axis].as_f64();
        below.max(a.mins()[axis].as_f64() - b.maxs()[axis].as_f64()).max(0.0)
    };
    (0..D).map(|axis| gap(axis).powi(2)).sum::<f64>().sqrt()
}

/// Returns the time at which a moving box first touches another; zero if they touch at the start,
/// and `None` if they never touch.
fn time<N: Real, const D: usize>(
    a: &Aabb<N, D>,
    velocity: &Vector<N, D>,
    b: &Aabb<N, D>,
) -> Option<f64> {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..D {
        let low = b.mins()[axis].as_f64() - a.maxs()[axis].as_f64();
        let high = b.maxs()[axis].as_f64() - a.mins()[axis].as_f64();
        let speed = velocity[axis].as_f64();
        if speed == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        enter = enter.max((low / speed).min(high / speed));
        leave = leave.min((low / speed).max(high / speed));
    }
    (enter <= leave).then_some(enter)
}

/// Returns the parts that a search found, sorted by index. Asserts that each occurs only once.
fn sorted<T>(mut found: Vec<(u32, T)>) -> Vec<(u32, T)> {
    found.sort_by_key(|(part, _)| *part);
    for two in found.windows(2) {
        assert!(two[0].0 < two[1].0, "part {} comes twice", two[0].0);
    }
    found
}

pub fn overlapping<N: Real, const D: usize>(
    search: &dyn PartSearch<N, D>,
    aabb: &Aabb<N, D>,
) -> Vec<u32> {
    let mut found = Vec::new();
    search.overlapping(aabb, &mut |part| found.push((part, ())));
    sorted(found).into_iter().map(|(part, ())| part).collect()
}

fn nearest<N: Real, const D: usize>(
    search: &dyn PartSearch<N, D>,
    aabb: &Aabb<N, D>,
    limit: N,
) -> Vec<(u32, f64)> {
    let mut found = Vec::new();
    search.nearest(aabb, limit, &mut |part, bound| {
        found.push((part, bound.as_f64()));
        limit
    });
    sorted(found)
}

fn cast<N: Real, const D: usize>(
    search: &dyn PartSearch<N, D>,
    (aabb, velocity): (&Aabb<N, D>, &Vector<N, D>),
    limit: N,
) -> Vec<(u32, f64)> {
    let mut found = Vec::new();
    search.cast(aabb, velocity, limit, &mut |part, bound| {
        found.push((part, bound.as_f64()));
        limit
    });
    sorted(found)
}

/// The boxes of all parts, for scans.
pub struct Boxes<N: Real, const D: usize> {
    pub of_parts: Vec<(u32, Aabb<N, D>)>,
    pub around: Aabb<N, D>,
}

/// Counts of results, so that a test can assert that there were enough.
#[derive(Debug, Default)]
pub struct Found {
    pub hits: usize,
    pub misses: usize,
}

impl<N: Real, const D: usize> Boxes<N, D> {
    pub fn new(shape: &dyn CompositeShape<N, D>, is_there: impl Fn(u32) -> bool) -> Self {
        let boxed = |number: u32| {
            let part = shape.part(number);
            (number, part.solid.as_shape().aabb(&part.pose))
        };
        let of_parts: Vec<_> =
            (0..shape.num_parts()).filter(|&part| is_there(part)).map(boxed).collect();
        let all = of_parts.iter().map(|(_, aabb)| *aabb);
        let around = all.reduce(|all, aabb| all.merged(&aabb)).expect("there are parts");
        Self { of_parts, around }
    }

    /// Compares random queries with a scan of all boxes. Returns how many of the queries for
    /// overlaps found parts, and how many found none.
    pub fn check(&self, search: &dyn PartSearch<N, D>, random: &mut Random, count: usize) -> Found {
        let mut found = Found::default();
        assert!(search.bounds().contains(&self.around), "{:?} leaves out parts", search.bounds());
        for _ in 0..count {
            let aabb = probe(random, &self.around);
            self.check_overlap(search, &aabb, &mut found);
            self.check_nearest(search, &aabb, random);
            let speed = self.around.half_extents();
            let mut velocity = speed.component_mul(&coarse_vector::<N, D>(random));
            if random.below(4) == 0 {
                velocity[random.below(D)] = N::ZERO;
            }
            self.check_cast(search, (&aabb, &velocity), random);
        }
        found
    }

    fn check_overlap(&self, search: &dyn PartSearch<N, D>, aabb: &Aabb<N, D>, count: &mut Found) {
        let meets = |(_, own): &&(u32, Aabb<N, D>)| own.intersects(aabb);
        let expected: Vec<u32> =
            self.of_parts.iter().filter(meets).map(|(part, _)| *part).collect();
        let found = overlapping(search, aabb);
        assert_eq!(found, expected, "overlapping {aabb:?}");
        if found.is_empty() { count.misses += 1 } else { count.hits += 1 }
    }

    fn check_nearest(&self, search: &dyn PartSearch<N, D>, aabb: &Aabb<N, D>, random: &mut Random) {
        let all: Vec<_> =
            self.of_parts.iter().map(|(part, own)| (*part, distance(aabb, own))).collect();
        let (_, limit) = all[random.below(all.len())];
        let found = nearest(search, aabb, N::lit(limit));
        check_bounds(&found, &all, N::lit(limit).as_f64(), N::EPSILON.as_f64());
        // If the visitor lowers the limit to the best distance, the nearest part is still visited.
        let (mut best, mut looked_at) = (f64::INFINITY, 0);
        search.nearest(aabb, N::INFINITY, &mut |part, _| {
            looked_at += 1;
            let own = all.iter().find(|(other, _)| *other == part).expect("a part that is there").1;
            best = best.min(own);
            N::lit(best)
        });
        let least = all.iter().map(|(_, distance)| *distance).fold(f64::INFINITY, f64::min);
        assert_eq!(best, least, "the nearest of {aabb:?}, after {looked_at}");
    }

    fn check_cast(
        &self,
        search: &dyn PartSearch<N, D>,
        (aabb, velocity): (&Aabb<N, D>, &Vector<N, D>),
        random: &mut Random,
    ) {
        let met = |(part, own): &(u32, Aabb<N, D>)| Some((*part, time(aabb, velocity, own)?));
        let all: Vec<_> = self.of_parts.iter().filter_map(met).collect();
        let limit = if all.is_empty() { 1.0 } else { all[random.below(all.len())].1 };
        let found = cast(search, (aabb, velocity), N::lit(limit));
        let grazing = |part: u32| {
            let own = &self.of_parts.iter().find(|(other, _)| *other == part).expect("there").1;
            let slack = own.half_extents().norm()
                + aabb.center().coords.norm()
                + own.center().coords.norm();
            time(aabb, velocity, &own.loosened(slack * N::lit(64.0) * N::EPSILON))
        };
        let known: Vec<_> = found
            .iter()
            .filter_map(|&(part, _)| all.iter().find(|(other, _)| *other == part).copied())
            .collect();
        for &(part, _) in
            found.iter().filter(|(part, _)| known.iter().all(|(other, _)| other != part))
        {
            assert!(grazing(part).is_some(), "part {part} is far from {aabb:?} along {velocity:?}");
        }
        let in_time: Vec<_> = found
            .iter()
            .copied()
            .filter(|(part, _)| known.iter().any(|(other, _)| other == part))
            .collect();
        check_bounds(&in_time, &all, N::lit(limit).as_f64(), N::EPSILON.as_f64());
    }
}

/// Asserts that parts clearly within the limit were found and parts clearly beyond were not, and
/// that each bound is at most the distance and close to it.
fn check_bounds(found: &[(u32, f64)], all: &[(u32, f64)], limit: f64, epsilon: f64) {
    let slack = 64.0 * epsilon;
    for &(part, own) in all {
        let bound = found.iter().find(|(other, _)| *other == part).map(|(_, bound)| *bound);
        match bound {
            Some(bound) => {
                assert!(bound <= own, "part {part}: {bound} is no bound of {own}");
                assert!(bound >= own * (1.0 - slack), "part {part}: {bound} is far from {own}");
                assert!(own * (1.0 - slack) <= limit, "part {part} at {own} is beyond {limit}");
            }
            None => assert!(own > limit, "part {part} at {own} is within {limit}"),
        }
    }
}

/// Asserts that searches with random boxes find each part of which a listed point is in the box,
/// near the box or on its path. The points are in the frame of the composite. Returns the number of
/// points found in boxes.
pub fn check_points<N: Real, const D: usize>(
    search: &dyn PartSearch<N, D>,
    points: &[(u32, Point<N, D>)],
    random: &mut Random,
    count: usize,
) -> usize {
    let all: Vec<_> = points.iter().map(|(_, point)| *point).collect();
    let around = Aabb::from_points(&all).expect("there are points");
    let mut hits = 0;
    for _ in 0..count {
        let mut aabb = probe(random, &around);
        if random.below(2) == 0 {
            // A box around a point, which may be the point alone.
            let point = all[random.below(all.len())];
            let half = aabb.half_extents();
            aabb = Aabb::new(point - half, point + half);
        }
        let velocity = around.half_extents().component_mul(&coarse_vector::<N, D>(random));
        let (inside, limit) =
            (overlapping(search, &aabb), around.half_extents().norm() * N::lit(0.3));
        let (near, met) = (nearest(search, &aabb, limit), cast(search, (&aabb, &velocity), N::ONE));
        for (part, point) in points {
            let own = Aabb::new(*point, *point);
            if aabb.contains_point(point) {
                hits += 1;
                assert!(
                    inside.binary_search(part).is_ok(),
                    "part {part}, of which {point} is in {aabb:?}"
                );
            }
            let bound =
                |found: &[(u32, f64)]| found.iter().find(|(p, _)| p == part).map(|(_, b)| *b);
            let slack = 64.0 * N::EPSILON.as_f64();
            let apart = distance(&aabb, &own);
            if apart <= limit.as_f64() * (1.0 - slack) {
                let bound = bound(&near).expect("near enough to be found");
                assert!(
                    bound <= apart * (1.0 + slack),
                    "part {part}: {bound} is no bound of {apart}"
                );
            }
            if let Some(time) = time(&aabb, &velocity, &own).filter(|time| *time <= 1.0 - slack) {
                let bound = bound(&met).expect("met in time");
                assert!(
                    bound <= time * (1.0 + slack) + slack,
                    "part {part}: {bound} is no bound of {time}"
                );
            }
        }
    }
    hits
}
