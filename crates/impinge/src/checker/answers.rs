//! The three queries of a checker for many configurations: any pair, the first pair, the nearest
//! pair.

use crate::math::order::sort_few;
use core::ops::Range;

use super::chain::{LANES, LaneRow};
use super::exact::{Exact, QuickDistance};
use super::filter::{CandidatePair, CollisionSearch, Other, ScanScratch, SearchMode, scan_at};
use super::odds::PairOdds;
use super::{Checker, NO_PAIR, NearestColumns};
use crate::batch::{BatchError, Control, Progress};
use crate::math::simd::Level;
use crate::math::{Real, Space, max};

/// Angles up to `NEAR_ANGLE` radians are converted to `f32` without reduction. Angles above
/// `FAR_ANGLE` radians become NaN, because the rounding error of the `f64` would be too large; the
/// scan leaves such a configuration to the exact queries.
const NEAR_ANGLE: f64 = 4.0;
const FAR_ANGLE: f64 = 1e8;

/// The state of a query that processes configurations in packets of 8, one per SIMD lane.
struct EightByEight<'a, N: Space<D>, const D: usize> {
    checker: &'a Checker<N, D>,
    configurations: &'a [N],
    exact: Exact<'a, N, D>,
    scratch: ScanScratch<D>,
    search: CollisionSearch,
    odds: PairOdds,
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
            odds: PairOdds::default(),
            level: Level::new(),
        }
    }

    /// Scans the configurations of `range` in packets of up to 8 for pairs within the distance
    /// `limit`. After the scan of a packet, calls `finish` with the range of its configurations.
    fn each(
        &mut self,
        range: Range<usize>,
        limit: N,
        mut finish: impl FnMut(&mut Self, Range<usize>),
    ) {
        let mut start = range.start;
        while start < range.end {
            let packet = start..range.end.min(start + LANES);
            self.scan(&packet, limit);
            self.exact.begin(packet.clone());
            start = packet.end;
            finish(self, packet);
        }
    }

    /// Scans a packet: reads its configurations in `f32` and collects candidate pairs up to
    /// `limit`.
    fn scan(&mut self, packet: &Range<usize>, limit: N) {
        let slides = self.read_numbers(packet);
        let lanes = u8::MAX >> (LANES - packet.len());
        let robot = &self.checker.robot;
        self.search.begin(lanes, limit.as_f32(), (&slides, robot.slide_margin()));
        let (scratch, search) = (&mut self.scratch, &mut self.search);
        scan_at(self.level, robot, &self.checker.surroundings, scratch, search);
    }

    /// Reads the joint values of the nodes in `f32`. Returns for each lane the sum of the
    /// magnitudes of the values of all prismatic joints.
    fn read_numbers(&mut self, packet: &Range<usize>) -> LaneRow<f32> {
        let tree = &self.checker.tree;
        let (width, mut slides) = (tree.columns(), [0.0; LANES]);
        for (index, joint) in tree.joints.iter().enumerate() {
            let column = joint.column().expect("a node has a joint that moves");
            let row = &mut self.scratch.numbers[index];
            let slides_here = tree.nodes[index].slides();
            for lane in 0..LANES {
                let configuration = (packet.start + lane).min(packet.end - 1);
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

    /// Returns the candidate pairs of a lane in ascending order. If the scan could not evaluate the
    /// lane, returns all pairs.
    fn candidates(&self, lane: usize) -> Vec<CandidatePair> {
        if self.search.blind >> lane & 1 == 0 {
            let candidate = self.search.candidates.iter();
            return candidate.filter(|candidate| candidate.lane == lane).copied().collect();
        }
        let all = self.checker.pairs_in_order();
        let mut all: Vec<_> =
            all.map(|pair| CandidatePair { lane, pair, is_certain: false, lower: 0.0 }).collect();
        sort_few(&mut all, |one, other| one.pair < other.pair);
        all
    }
}

/// Converts an angle to `f32`, modulo a full turn if it is large. The error is little more than the
/// rounding error of a number near 4. Returns NaN above `FAR_ANGLE`.
#[inline(always)]
fn angle<N: Real>(value: N) -> f32 {
    let size = value.as_f64().abs();
    if size <= NEAR_ANGLE { value.as_f32() } else { reduced(value) }
}

/// Returns the angle modulo a full turn, reduced in `f64`; NaN above `FAR_ANGLE`.
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

/// Implements [`Checker::are_free`].
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
        sweep.each(range, clearance, |sweep, packet| {
            let hits = sweep.hits(clearance);
            for (lane, index) in packet.enumerate() {
                out[index - first] = hits >> lane & 1 == 0;
            }
        });
    })
}

impl<N: Space<D>, const D: usize> EightByEight<'_, N, D> {
    /// Returns the lanes that are not free, as a bit mask.
    fn hits(&mut self, clearance: N) -> u8 {
        let mut hits = self.search.hits;
        let mut put_off = Vec::new();
        for index in 0..self.search.candidates.len() {
            let CandidatePair { lane, pair, .. } = self.search.candidates[index];
            if hits >> lane & 1 == 1 {
                continue;
            }
            let is_hit = match self.exact.quick_distance(pair, lane, clearance) {
                QuickDistance::Known(distance) => distance.is_some(),
                QuickDistance::Unknown if self.odds.are_poor(pair) => {
                    put_off.push((lane, pair));
                    false
                }
                QuickDistance::Unknown => self.search_parts(pair, lane, clearance),
            };
            hits |= u8::from(is_hit) << lane;
        }
        for (lane, pair) in put_off {
            let is_hit = hits >> lane & 1 == 0 && self.search_parts(pair, lane, clearance);
            hits |= u8::from(is_hit) << lane;
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

    /// Returns whether a search of parts finds that a pair is within the clearance. Also records
    /// the result in the statistics.
    fn search_parts(&mut self, pair: (u32, Other), lane: usize, clearance: N) -> bool {
        let is_hit = self.exact.searched(pair, lane, clearance).is_some();
        self.odds.count(pair, is_hit);
        is_hit
    }

    /// Returns the first pair of a lane within the clearance; `None` if the lane is free.
    fn first(&mut self, lane: usize, clearance: N) -> Option<(u32, Other)> {
        let found = self.candidates(lane).into_iter().find(|candidate| {
            candidate.is_certain || self.exact.distance(candidate.pair, lane, clearance).is_some()
        });
        found.map(|candidate| candidate.pair)
    }
}

/// Implements [`Checker::first_pairs`].
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
        sweep.each(range, clearance, |sweep, packet| {
            for (lane, index) in packet.enumerate() {
                let is_blind = sweep.search.blind >> lane & 1 == 1;
                let is_nowhere = is_blind && !sweep.exact.is_finite(lane);
                let pair = if is_nowhere { None } else { sweep.first(lane, clearance) };
                out[index - first] = pair.map_or(NO_PAIR, |pair| checker.numbers_of(pair));
            }
        });
    })
}

/// Implements [`Checker::nearest`].
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
        sweep.each(range, limit, |sweep, packet| {
            for (lane, index) in packet.enumerate() {
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
    /// Returns the nearest pair of a lane and its distance; the first pair if several are equally
    /// near. `None` if no pair is within `limit`.
    ///
    /// Candidates are computed in ascending order of their lower bounds; candidates that may touch
    /// have the bound zero and are computed in pair order. So the search ends when the next lower
    /// bound exceeds the best distance, and it returns the first of several touching pairs.
    fn nearest(&mut self, lane: usize, limit: N) -> Option<(N, (u32, Other))> {
        let bound = |candidate: &CandidatePair| max(candidate.lower, 0.0);
        let mut candidates = self.candidates(lane);
        sort_few(&mut candidates, |one, other| {
            let order = bound(one).total_cmp(&bound(other));
            order.then(one.pair.cmp(&other.pair)).is_lt()
        });
        let mut best: Option<(N, (u32, Other))> = None;
        for candidate in &candidates {
            let so_far = best.map_or(limit, |(distance, _)| distance);
            let is_decided = best.is_some_and(|(distance, _)| distance <= N::ZERO);
            if is_decided || f64::from(bound(candidate)) > so_far.as_f64() {
                break;
            }
            let pair = candidate.pair;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checker::{Body, Frame, FrameTree, Joint};
    use crate::math::{Mapped, Point, Pose, Unit, Vector};
    use crate::shape::{ShapeHandle, TriMesh};

    /// Returns the surface of a tetrahedron with its right angles at the origin.
    fn surface(size: f64) -> ShapeHandle<f64, 3> {
        let corners = [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
        let corners = corners.mapped(Point::<f64, 3>::from).to_vec();
        let faces = vec![[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]];
        ShapeHandle::new(TriMesh::new(corners, faces))
    }

    /// Returns a checker of one [`surface`] for each size and position. The last surface slides
    /// along the diagonal; the others are at rest.
    fn slider(surfaces: &[(f64, [f64; 3])], pairs: &[[u32; 2]]) -> Checker<f64, 3> {
        let diagonal = Unit::new_normalize(Vector::<f64, 3>::repeat(1.0));
        let frame = |joint| Frame { parent: None, origin: Pose::identity(), joint };
        let frames = [Joint::fixed(), Joint::prismatic(diagonal, 0)].mapped(frame);
        let tree = FrameTree::try_new(&frames, 1).expect("two frames");
        let bodies = surfaces.iter().enumerate().map(|(index, &(size, position))| Body {
            frame: usize::from(index + 1 == surfaces.len()),
            shape: surface(size),
            pose: Pose::from_translation(position.into()),
        });
        Checker::try_new(tree, bodies.collect(), pairs).expect("bodies")
    }

    /// Returns the configurations that are not free, as a bit mask, and the number of part searches
    /// of each pair of bodies.
    fn searches(checker: &Checker<f64, 3>, rows: &[f64]) -> (u64, Vec<u32>) {
        let mut sweep = EightByEight::new(checker, rows, SearchMode::Any);
        let mut all = 0;
        sweep.each(0..rows.len(), 0.0, |sweep, packet| {
            all |= u64::from(sweep.hits(0.0)) << packet.start;
        });
        let pairs = checker.pairs().iter().map(|&[one, other]| (one, Other::Body(other)));
        (all, pairs.map(|pair| sweep.odds.searches(pair)).collect())
    }

    #[test]
    fn parts_are_searched_where_hulls_touch() {
        let checker = slider(&[(1.0, [0.0; 3]), (1.0, [0.0; 3])], &[[0, 1]]);
        // The surfaces touch up to a slide of 0.577, the height of the corner above the opposite
        // face. Their bounding balls touch up to a slide of 1.7.
        let rows = [0.6, 0.25, 0.75, 0.5, 1.0, 0.57, 1.25, 0.58, 1.5, 1.65];
        assert_eq!(searches(&checker, &rows).0, 0b10_1010);
        assert_eq!(searches(&checker, &rows), (0b10_1010, vec![6]), "of the first six all");
        assert_eq!(searches(&checker, &rows), (0b10_1010, vec![3]), "the hulls are there");
    }

    #[test]
    fn pairs_that_seldom_touch_are_asked_last() {
        // In the first pair one surface is inside the other: only the hulls overlap. The second
        // pair touches in all rows except the last.
        let surfaces = [(8.0, [0.0; 3]), (0.5, [1.0; 3]), (1.0, [20.0; 3]), (1.0, [20.0; 3])];
        let checker = slider(&surfaces, &[[0, 1], [2, 3]]);
        let mut rows = [0.3; 17];
        rows[16] = 1.0;
        let found = [(); 2].map(|()| searches(&checker, &rows));
        assert_eq!(found[0].0, 0xffff);
        assert_eq!(found[1], (0xffff, vec![2, 16]), "at first, and where nothing else touches");
    }
}
