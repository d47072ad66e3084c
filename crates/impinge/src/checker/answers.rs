//! The three questions about many configurations.

use crate::math::order::sort_few;
use core::ops::Range;

use super::chain::{LANES, LaneRow};
use super::exact::Exact;
use super::filter::{CollisionSearch, NearPair, Other, ScanScratch, SearchMode, scan_at};
use super::{Checker, NO_PAIR, NearestColumns};
use crate::batch::{BatchError, Control, Progress};
use crate::math::simd::Level;
use crate::math::{Real, Space, max};

/// Angles up to this need no reduction; beyond the other they have none in `f32`.
const NEAR_ANGLE: f64 = 4.0;
const FAR_ANGLE: f64 = 1e8;

/// What treats eight configurations after the other.
struct EightByEight<'a, N: Space<D>, const D: usize> {
    checker: &'a Checker<N, D>,
    configurations: &'a [N],
    exact: Exact<'a, N, D>,
    scratch: ScanScratch<D>,
    search: CollisionSearch,
    level: Level,
}

impl<'a, N: Space<D>, const D: usize> EightByEight<'a, N, D> {
    fn new(checker: &'a Checker<N, D>, configurations: &'a [N], mode: SearchMode) -> Self {
        Self {
            checker,
            configurations,
            exact: Exact::new(checker, configurations),
            scratch: ScanScratch::new(&checker.robot),
            search: CollisionSearch::new(mode),
            level: Level::new(),
        }
    }

    /// Calls with up to eight configurations at a time, after the scan.
    fn each(
        &mut self,
        range: Range<usize>,
        limit: N,
        mut settle: impl FnMut(&mut Self, Range<usize>),
    ) {
        let mut start = range.start;
        while start < range.end {
            let eight = start..range.end.min(start + LANES);
            self.scan(&eight, limit);
            self.exact.begin(eight.clone());
            start = eight.end;
            settle(self, eight);
        }
    }

    fn scan(&mut self, eight: &Range<usize>, limit: N) {
        let slides = self.read_numbers(eight);
        let lanes = u8::MAX >> (LANES - eight.len());
        let robot = &self.checker.robot;
        self.search.begin(lanes, limit.as_f32(), (&slides, robot.slide_margin()));
        let (scratch, search) = (&mut self.scratch, &mut self.search);
        scan_at(self.level, robot, &self.checker.surroundings, scratch, search);
    }

    /// The numbers of the nodes in `f32`; returns how far things slide in each lane.
    fn read_numbers(&mut self, eight: &Range<usize>) -> LaneRow<f32> {
        let tree = &self.checker.tree;
        let (width, mut slides) = (tree.columns(), [0.0; LANES]);
        for (index, joint) in tree.joints.iter().enumerate() {
            let column = joint.column().expect("a node has a joint that moves");
            let row = &mut self.scratch.numbers[index];
            let slides_here = tree.nodes[index].slides();
            for lane in 0..LANES {
                let configuration = (eight.start + lane).min(eight.end - 1);
                let given = self.configurations[configuration * width + column];
                let value = joint.value_at(given);
                if slides_here {
                    row[lane] = value.as_f32();
                    slides[lane] += row[lane].abs();
                } else {
                    row[lane] = angle(value);
                }
            }
        }
        slides
    }

    /// The pairs that are near in a lane in their order; of a lane in which the filter is blind all.
    fn candidates(&self, lane: usize) -> Vec<NearPair> {
        if self.search.blind >> lane & 1 == 0 {
            let near = self.search.near.iter();
            return near.filter(|near| near.lane == lane).copied().collect();
        }
        let all = self.checker.pairs_in_order();
        let mut all: Vec<_> =
            all.map(|pair| NearPair { lane, pair, is_certain: false, lower: 0.0 }).collect();
        sort_few(&mut all, |one, other| one.pair < other.pair);
        all
    }
}

/// An angle in `f32`, off by little more than a rounding error of 4; NaN for what is too large.
#[inline(always)]
fn angle<N: Real>(value: N) -> f32 {
    let size = value.as_f64().abs();
    if size <= NEAR_ANGLE { value.as_f32() } else { reduced(value) }
}

#[cold]
fn reduced<N: Real>(value: N) -> f32 {
    let value = value.as_f64();
    if value.abs() <= FAR_ANGLE {
        let turns = (value / core::f64::consts::TAU).round();
        N::lit(value - turns * core::f64::consts::TAU).as_f32()
    } else {
        f32::NAN
    }
}

/// See [`Checker::are_free`].
pub(super) fn are_free<N: Space<D>, const D: usize>(
    checker: &Checker<N, D>,
    (configurations, clearance): (&[N], N),
    control: &Control<'_>,
    out: &mut [bool],
) -> Result<(), BatchError> {
    let clearance = max(clearance, N::ZERO);
    Progress::new(control).run(out.len(), out, |range, out: &mut [bool]| {
        let mut sweep = EightByEight::new(checker, configurations, SearchMode::Any);
        let first = range.start;
        sweep.each(range, clearance, |sweep, eight| {
            let hits = sweep.hits(clearance);
            for (lane, index) in eight.enumerate() {
                out[index - first] = hits >> lane & 1 == 0;
            }
        });
    })
}

impl<N: Space<D>, const D: usize> EightByEight<'_, N, D> {
    /// The lanes that are not free.
    fn hits(&mut self, clearance: N) -> u8 {
        let mut hits = self.search.hits;
        for &NearPair { lane, pair, .. } in &self.search.near {
            if hits >> lane & 1 == 0 {
                let found = self.exact.distance(pair, lane, clearance);
                hits |= u8::from(found.is_some()) << lane;
            }
        }
        let mut blind = self.search.blind;
        while blind != 0 {
            let lane = blind.trailing_zeros() as usize;
            blind &= blind - 1;
            let is_free = self.exact.is_finite(lane) && self.first(lane, clearance).is_none();
            hits |= u8::from(!is_free) << lane;
        }
        hits
    }

    /// The first pair of a lane that is not farther apart than the clearance.
    fn first(&mut self, lane: usize, clearance: N) -> Option<(u32, Other)> {
        let found = self.candidates(lane).into_iter().find(|near| {
            near.is_certain || self.exact.distance(near.pair, lane, clearance).is_some()
        });
        found.map(|near| near.pair)
    }
}

/// See [`Checker::first_pairs`].
pub(super) fn first_pairs<N: Space<D>, const D: usize>(
    checker: &Checker<N, D>,
    (configurations, clearance): (&[N], N),
    control: &Control<'_>,
    out: &mut [[u32; 2]],
) -> Result<(), BatchError> {
    let clearance = max(clearance, N::ZERO);
    Progress::new(control).run(out.len(), out, |range, out: &mut [[u32; 2]]| {
        let mut sweep = EightByEight::new(checker, configurations, SearchMode::All);
        let first = range.start;
        sweep.each(range, clearance, |sweep, eight| {
            for (lane, index) in eight.enumerate() {
                let is_blind = sweep.search.blind >> lane & 1 == 1;
                let is_nowhere = is_blind && !sweep.exact.is_finite(lane);
                let pair = if is_nowhere { None } else { sweep.first(lane, clearance) };
                out[index - first] = pair.map_or(NO_PAIR, |pair| checker.numbers_of(pair));
            }
        });
    })
}

/// See [`Checker::nearest`].
pub(super) fn nearest<N: Space<D>, const D: usize>(
    checker: &Checker<N, D>,
    (configurations, limit, count): (&[N], N, usize),
    control: &Control<'_>,
    out: NearestColumns<'_, N>,
) -> Result<(), BatchError> {
    let limit = max(limit, N::ZERO);
    Progress::new(control).run(count, out, |range, mut out: NearestColumns<'_, N>| {
        let mut sweep = EightByEight::new(checker, configurations, SearchMode::Nearest);
        let first = range.start;
        sweep.each(range, limit, |sweep, eight| {
            for (lane, index) in eight.enumerate() {
                let is_blind = sweep.search.blind >> lane & 1 == 1;
                if is_blind && !sweep.exact.is_finite(lane) {
                    out.put(index - first, N::lit(f64::NAN), NO_PAIR);
                    continue;
                }
                let found = sweep.nearest(lane, limit);
                let distance = found.map_or(N::INFINITY, |(distance, _)| distance);
                let pair = found.map_or(NO_PAIR, |(_, pair)| checker.numbers_of(pair));
                out.put(index - first, distance, pair);
            }
        });
    })
}

impl<N: Space<D>, const D: usize> EightByEight<'_, N, D> {
    /// The nearest pair of a lane up to a limit, of equally near ones the first.
    ///
    /// The pairs are asked by their lower bounds, those that may touch in their order; so all that follow one that is
    /// nearer than their bound are farther, and of two that touch the first comes first.
    fn nearest(&mut self, lane: usize, limit: N) -> Option<(N, (u32, Other))> {
        let bound = |near: &NearPair| max(near.lower, 0.0);
        let mut candidates = self.candidates(lane);
        sort_few(&mut candidates, |one, other| {
            let order = bound(one).total_cmp(&bound(other));
            order.then(one.pair.cmp(&other.pair)).is_lt()
        });
        let mut best: Option<(N, (u32, Other))> = None;
        for near in &candidates {
            let so_far = best.map_or(limit, |(distance, _)| distance);
            let is_settled = best.is_some_and(|(distance, _)| distance <= N::ZERO);
            if is_settled || f64::from(bound(near)) > so_far.as_f64() {
                break;
            }
            let pair = near.pair;
            let Some(found) = self.exact.distance(pair, lane, so_far) else { continue };
            let is_better = best.is_none_or(|(distance, first)| {
                found < distance || (found == distance && pair < first)
            });
            if is_better {
                best = Some((found, pair));
            }
        }
        best
    }
}
