//! Compares all results for random robots with single queries of all pairs, bit for bit.

use impinge::batch::Control;
use impinge::checker::{NO_PAIR, NearestColumns};
use impinge::math::Space;

use super::brute::Brute;
use super::robots::{Robot, robot2, robot3};
use crate::batch::scene::{assert_number, on_threads};
use crate::support::samples::stride;

/// Compares the results for one clearance, of every ninth configuration from number `start` on; of
/// all if the [`stride`] is 1. Returns the number of finite configurations that are not free, and
/// the number of free ones.
fn check<N: Space<D>, const D: usize>(
    robot: &Robot<N, D>,
    clearance: f64,
    threads: usize,
    start: usize,
) -> [usize; 2] {
    let (count, control) = (robot.count(), Control::new());
    let (clearance, rows) = (N::lit(clearance), &robot.configurations[..]);
    let (mut free, mut first) = (vec![false; count], vec![[7; 2]; count]);
    let (mut distance, mut pair) = (vec![N::ZERO; count], vec![[7; 2]; count]);
    let mut limited = vec![N::ZERO; count];
    let limit = clearance + N::HALF;
    on_threads(threads, || {
        let checker = &robot.checker;
        checker.are_free(rows, clearance, &control, &mut free)?;
        checker.first_pairs(rows, clearance, &control, &mut first)?;
        let out = NearestColumns { distance: &mut distance, pair: &mut pair };
        checker.nearest(rows, N::INFINITY, &control, out)?;
        let out = NearestColumns { distance: &mut limited, ..Default::default() };
        checker.nearest(rows, limit, &control, out)
    })
    .expect("a slot for each");
    // Nine has no factor in common with the 8 lanes of a packet, nor with 5: every fifth random
    // configuration is aligned.
    let step = stride(9);
    for index in (start % step..count).step_by(step) {
        let (brute, what) = (Brute::new(robot, index), format!("configuration {index}"));
        let expected = brute.first(if clearance > N::ZERO { clearance } else { N::ZERO });
        assert_eq!(first[index], expected, "{what}");
        assert_eq!(free[index], brute.is_finite && expected == NO_PAIR, "{what}");
        let (nearest, nearest_pair) = brute.nearest(N::INFINITY);
        assert_eq!(pair[index], nearest_pair, "{what}");
        assert_number(distance[index], nearest, &what);
        assert_number(limited[index], brute.nearest(limit).0, &what);
    }
    let hits = first.iter().filter(|&&pair| pair != NO_PAIR).count();
    [hits, free.iter().filter(|&&is_free| is_free).count()]
}

fn check_all<N: Space<D>, const D: usize>(make: fn(u64, f64) -> Robot<N, D>) {
    let mut counts = [0; 2];
    for (start, (seed, away, clearance, threads)) in
        [(1, 0.0, 0.0, 1), (2, 0.0, 0.125, 4), (3, 1e3, 0.0, 1), (4, 0.0, -1.0, 4)]
            .into_iter()
            .enumerate()
    {
        let [hits, free] = check(&make(seed, away), clearance, threads, start);
        counts = [counts[0] + hits, counts[1] + free];
    }
    let [hits, free] = counts;
    assert!(hits * 20 > free && free * 20 > hits, "{hits} of {free}");
}

#[test]
fn answers_are_those_of_single_calls_in_2d() {
    check_all::<f32, 2>(robot2);
    check_all::<f64, 2>(robot2);
}

#[test]
fn answers_are_those_of_single_calls_in_3d() {
    check_all::<f32, 3>(robot3);
    check_all::<f64, 3>(robot3);
}
