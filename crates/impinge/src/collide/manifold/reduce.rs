//! Chooses contact points: the candidates that span the largest area, projected along the normal.
//!
//! ```text
//!        .-- left --.        `start`: a deepest candidate, `end`: any other; area of both
//!   start -------- end       triangles, each with the farthest candidate on its side
//!        '- right --'
//! ```
//!
//! The best four of a few candidates come from trying all such diagonals. Of more than [`FEW`]
//! candidates, only corners of the convex hull are tried (A. M. Andrew, "Another efficient
//! algorithm for convex hulls in two dimensions", 1979). More than four points come from dynamic
//! programming over these corners (Boyce, Dobkin, Drysdale and Guibas, "Finding extremal polygons",
//! 1985). Both are exact up to [`FEW`] candidates; a longer hull is first reduced ([`coarsen`]).
//!
//! Old points (which continue points of the previous manifold) are all kept if they do not exceed
//! the limit, span [`ENOUGH`] of the best choice and include a deepest one. Otherwise each weighs a
//! bit more than a new one. So solids at rest keep their points even among equal choices.

use core::cmp::Ordering;

use smallvec::SmallVec;

use crate::math::{Mapped, Real, Vector, cross2, max, max_component, min};

/// Up to this number of candidates, the choice is exact.
const FEW: usize = 16;

/// Weight of a new point; an old one has 1. Keeping three old points costs at most 5 % of the area.
const NEW: f64 = 63.0 / 64.0;

/// Bonus of an old point if more than four points are chosen, as a fraction of the hull's area.
const KEPT: f64 = 1.0 / 256.0;

/// Fraction of the best area (length for points in a row) that old points must span to be kept.
const ENOUGH: f64 = 0.9;

/// Points in a strip narrower than this fraction of its length count as a row. Rows are compared by
/// length instead of area, because small offsets change their area much.
const THIN: f64 = 1.0 / 4096.0;

/// A candidate projected along the normal.
#[derive(Clone, Copy)]
pub(in crate::collide) struct Projected<N: Real> {
    pub(in crate::collide) at: Vector<N, 2>,
    /// Index of the candidate.
    pub(in crate::collide) index: usize,
    /// Whether the candidate counts as deepest by the levels of [`projected`].
    pub(in crate::collide) is_deepest: bool,
    /// Whether the candidate is old: continues a point of the previous manifold.
    pub(in crate::collide) is_kept: bool,
}

/// Projected candidates of a manifold, at least one.
pub(in crate::collide) type Projections<N> = SmallVec<[Projected<N>; FEW]>;

/// Indices of chosen candidates.
pub(in crate::collide) type Indices = SmallVec<[usize; 8]>;

/// Projects the `candidates`, each given as (tangent coordinates, distance, whether it is old). A
/// candidate is deepest if its distance is at most `level` or is the smallest. If no old candidate
/// is deepest in this sense, old candidates with a distance up to `slack` are deepest, too.
#[inline]
pub(in crate::collide) fn projected<N: Real>(
    candidates: impl Iterator<Item = (Vector<N, 2>, N, bool)> + Clone,
    [level, slack]: [N; 2],
) -> Projections<N> {
    let lowest = candidates.clone().fold(N::INFINITY, |low, (_, distance, _)| min(distance, low));
    let level = max(level, lowest);
    // If an old point is deepest, no other old point has to stand for it.
    let has_old = candidates.clone().any(|(_, distance, is_kept)| is_kept && distance <= level);
    let slack = if has_old { level } else { slack };
    let mut points = Projections::new();
    for (index, (at, distance, is_kept)) in candidates.enumerate() {
        let is_deepest = distance <= level || is_kept && distance <= slack;
        points.push(Projected { at, index, is_deepest, is_kept });
    }
    points
}

/// Returns the indices, ascending, of at most `limit` candidates that span the largest area, at
/// least one of them deepest.
///
/// Lengths up to `tolerance` are rounding errors. Scaling by a power of two changes no choice.
#[inline]
pub(in crate::collide) fn chosen<N: Real>(
    points: &mut Projections<N>,
    limit: usize,
    tolerance: N,
) -> Indices {
    if points.len() > FEW || limit > 4 {
        return spanning(points, limit, tolerance);
    }
    let tolerance = tolerance * rescale(points);
    let best = sorted(best_four(points, limit, tolerance));
    old_or(best, points, limit, tolerance)
}

/// Returns the old points if they are at most `limit`, include a deepest one, and span [`ENOUGH`]
/// of the area or length that `best` spans; else `best`.
fn old_or<N: Real>(best: Indices, points: &[Projected<N>], limit: usize, tolerance: N) -> Indices {
    let old: Projections<N> = points.iter().filter(|point| point.is_kept).copied().collect();
    if old.len() > limit || !old.iter().any(|point| point.is_deepest) {
        return best;
    }
    let is_best = |point: &Projected<N>| best.contains(&point.index);
    if old.len() == best.len() && old.iter().all(is_best) {
        return best;
    }
    let chosen: Projections<N> = points.iter().filter(|point| is_best(point)).copied().collect();
    let ([old_area, old_length], [area, length]) = (span(&old), span(&chosen));
    let is_row = area <= max(tolerance, N::lit(THIN) * length) * length;
    let is_enough = if is_row {
        old.len() <= best.len() && old_length >= length * N::lit(ENOUGH)
    } else {
        old_area >= area * N::lit(ENOUGH)
    };
    if is_enough { sorted(old.iter().map(|point| point.index).collect()) } else { best }
}

/// Returns twice the area of the convex hull of a few points, and the length of its longest chord.
fn span<N: Real>(points: &Projections<N>) -> [N; 2] {
    let ring = hull(&mut points.clone(), N::ZERO);
    let (mut area, mut longest) = (N::ZERO, N::ZERO);
    for (at, corner) in ring.iter().enumerate() {
        area += twice_area(&ring[0], &ring[at.saturating_sub(1)], corner);
        let far = ring[..at].iter().map(|other| (other.at - corner.at).norm());
        longest = far.fold(longest, max);
    }
    [area, longest]
}

/// Computes [`chosen`] from the corners of the convex hull and, if none of them is deepest, a
/// deepest candidate. Keeps others only as old points ([`old_or`]). Cost: O(n log n).
#[inline(never)]
pub(in crate::collide) fn spanning<N: Real>(
    points: &mut Projections<N>,
    limit: usize,
    tolerance: N,
) -> Indices {
    let tolerance = tolerance * rescale(points);
    let best = best_spanning(points, limit, tolerance);
    old_or(best, points, limit, tolerance)
}

fn best_spanning<N: Real>(points: &mut Projections<N>, limit: usize, tolerance: N) -> Indices {
    let mut ring = hull(points, tolerance);
    let has_deepest = ring.iter().any(|corner| corner.is_deepest);
    let inner = if has_deepest { None } else { Some(points[a_deepest(points)]) };
    let count = limit - inner.iter().len();
    if ring.len() > count {
        coarsen(&mut ring, if count < FEW { FEW - inner.iter().len() } else { count });
    }
    if ring.len() > count && limit > 4 {
        ring = largest_polygon(ring, count);
    }
    ring.extend(inner);
    if ring.is_empty() {
        // [`largest_polygon`] finds no polygon if all areas are NaN.
        ring.push(points[a_deepest(points)]);
    }
    if ring.len() > limit {
        return sorted(best_four(&ring, limit, tolerance));
    }
    sorted(ring.iter().map(|corner| corner.index).collect())
}

/// Compares two numbers by value; zeros and NaN are ordered as by [`f64::total_cmp`].
#[inline]
pub(in crate::collide) fn ordering<N: Real>(a: N, b: N) -> Ordering {
    if a < b {
        Ordering::Less
    } else if a > b {
        Ordering::Greater
    } else {
        a.as_f64().total_cmp(&b.as_f64())
    }
}

fn sorted(mut indices: Indices) -> Indices {
    indices.sort_unstable();
    indices
}

/// Returns the position of a deepest candidate, an old one if possible; 0 if none is deepest.
pub(in crate::collide) fn a_deepest<N: Real>(points: &[Projected<N>]) -> usize {
    let is_old = |point: &Projected<N>| point.is_deepest && point.is_kept;
    let old = points.iter().position(is_old);
    old.or_else(|| points.iter().position(|point| point.is_deepest)).unwrap_or(0)
}

/// Scales all coordinates by a power of two so that the largest is about 1 and areas neither
/// overflow nor underflow; returns the factor.
fn rescale<N: Real>(points: &mut [Projected<N>]) -> N {
    let extent = points.iter().fold(N::ZERO, |extent, point| max(extent, max_component(&point.at)));
    let scale = N::ONE / extent.power_of_two_below();
    for point in points {
        point.at *= scale;
    }
    scale
}

/// Returns the indices of at most `limit` points, and at most four, that span the largest area.
fn best_four<N: Real>(points: &[Projected<N>], limit: usize, tolerance: N) -> Indices {
    let best = if limit > 2 { best_diagonal(points, limit > 3, tolerance) } else { None };
    let mut chosen = best.unwrap_or_else(|| farthest(points, limit, tolerance));
    for index in &mut chosen {
        *index = points[*index].index;
    }
    chosen
}

/// Returns the positions of a deepest point and, if `limit` > 1, of the point farthest from it, if
/// beyond `tolerance`. If `limit` > 2, also of a row's other end beyond the deepest point.
fn farthest<N: Real>(points: &[Projected<N>], limit: usize, tolerance: N) -> Indices {
    let mut chosen = Indices::from_slice(&[a_deepest(points)]);
    let mut most = tolerance;
    for (from, _) in points.iter().enumerate().filter(|(_, point)| limit > 1 && point.is_deepest) {
        let (to, length) = farthest_from(points, from);
        if length > most {
            (chosen, most) = (Indices::from_slice(&[from, to]), length);
        }
    }
    if let [_, end] = *chosen
        && limit > 2
    {
        let (other, length) = farthest_from(points, end);
        if length > most + tolerance {
            chosen.push(other);
        }
    }
    chosen
}

/// Returns the position of the point farthest from the point at `from`, and their weighted
/// distance.
fn farthest_from<N: Real>(points: &[Projected<N>], from: usize) -> (usize, N) {
    let (mut best, mut most) = (from, N::ZERO);
    for (to, point) in points.iter().enumerate() {
        let length = (point.at - points[from].at).norm() * weight(point) * weight(&points[from]);
        if length > most {
            (best, most) = (to, length);
        }
    }
    (best, most)
}

/// Returns the factor of a point in areas and distances: 1 for an old point, else [`NEW`].
#[inline]
fn weight<N: Real>(point: &Projected<N>) -> N {
    if point.is_kept { N::ONE } else { N::lit(NEW) }
}

/// Coordinates and weights of up to [`FEW`] points, in rows of [`LANES`] for SIMD.
struct CoordinateRows<N: Real> {
    x: [[N; LANES]; FEW / LANES],
    y: [[N; LANES]; FEW / LANES],
    weights: [[N; LANES]; FEW / LANES],
    /// Number of used rows.
    len: usize,
}

/// Number of points in one row.
const LANES: usize = 4;

impl<N: Real> CoordinateRows<N> {
    #[inline]
    fn of(points: &[Projected<N>]) -> Self {
        let zero = [[N::ZERO; LANES]; FEW / LANES];
        let mut rows = Self { x: zero, y: zero, weights: zero, len: points.len().div_ceil(LANES) };
        for (index, point) in points.iter().enumerate() {
            let (row, lane) = (index / LANES, index % LANES);
            (rows.x[row][lane], rows.y[row][lane]) = (point.at.x, point.at.y);
            rows.weights[row][lane] = weight(point);
        }
        rows
    }

    /// Returns twice the largest weighted areas of triangles to the left and right of a diagonal.
    #[inline]
    fn sides(&self, start: &Projected<N>, end: &Projected<N>) -> [N; 2] {
        let edge = end.at - start.at;
        let base = cross2(&edge, &start.at);
        let [mut lefts, mut rights] = [[N::ZERO; LANES]; 2];
        let rows = self.x.iter().zip(&self.y).zip(&self.weights);
        for ((x, y), weights) in rows.take(self.len) {
            for lane in 0..LANES {
                let area = (edge.x * y[lane] - edge.y * x[lane] - base) * weights[lane];
                lefts[lane] = max(lefts[lane], area);
                rights[lane] = min(rights[lane], area);
            }
        }
        let ([a, b, c, d], [e, f, g, h]) = (lefts, rights);
        [max(max(a, b), max(c, d)), -min(min(e, f), min(g, h))]
    }
}

/// Returns [`with_sides`] of the diagonal that spans the largest weighted area: with the triangles
/// on both sides if `is_four`, else with the larger one. `None` if all points lie in a row.
fn best_diagonal<N: Real>(points: &[Projected<N>], is_four: bool, tolerance: N) -> Option<Indices> {
    let (mut ends, mut most) = ([0; 2], N::ZERO);
    let rows = CoordinateRows::of(points);
    for (first, start) in points.iter().enumerate().filter(|(_, point)| point.is_deepest) {
        for (opposite, end) in points.iter().enumerate() {
            // A diagonal between two deepest points is tried once.
            if opposite == first || opposite < first && end.is_deepest {
                continue;
            }
            let [left, right] = rows.sides(start, end);
            let area = if is_four { left + right } else { max(left, right) };
            let area = area * weight(start) * weight(end);
            if area > most {
                (ends, most) = ([first, opposite], area);
            }
        }
    }
    with_sides(points, ends, is_four, tolerance)
}

/// Returns the ends of a diagonal and, if `is_four`, the farthest point on each side, else the
/// farther of these two. `None` if no point is farther from the diagonal than the tolerance.
fn with_sides<N: Real>(
    points: &[Projected<N>],
    ends: [usize; 2],
    is_four: bool,
    tolerance: N,
) -> Option<Indices> {
    let [start, end] = ends.mapped(|index| &points[index]);
    let least = tolerance * (end.at - start.at).norm();
    let (mut corners, [mut left, mut right]) = (Indices::from_slice(&ends), [least; 2]);
    let mut sides = [None; 2];
    for (index, point) in points.iter().enumerate() {
        let area = twice_area(start, end, point) * weight(point);
        if area > left {
            (left, sides[0]) = (area, Some(index));
        }
        if -area > right {
            (right, sides[1]) = (-area, Some(index));
        }
    }
    if !is_four {
        sides[usize::from(left >= right)] = None;
    }
    for index in sides.into_iter().flatten() {
        corners.push(index);
    }
    (corners.len() > 2).then_some(corners)
}

/// Sorts the points; returns the corners of their hull, counter-clockwise, [thinned](thin).
fn hull<N: Real>(points: &mut [Projected<N>], tolerance: N) -> Projections<N> {
    points.sort_by(|a, b| ordering(a.at.x, b.at.x).then_with(|| ordering(a.at.y, b.at.y)));
    let mut ring = Projections::new();
    chain(points.iter(), &mut ring);
    if points.len() > 1 {
        // Each chain ends where the other starts.
        ring.pop();
        chain(points.iter().rev(), &mut ring);
        ring.pop();
    }
    thin(&mut ring, tolerance);
    ring
}

/// Appends the corners of one half of the hull, with a left turn at every corner.
fn chain<'p, N: Real>(points: impl Iterator<Item = &'p Projected<N>>, ring: &mut Projections<N>) {
    let start = ring.len();
    for next in points {
        while let [.., from, at] = &ring[start..] {
            if twice_area(from, at, next) > N::ZERO {
                break;
            }
            ring.pop();
        }
        ring.push(*next);
    }
}

/// Returns twice the area of a triangle, positive if it is counter-clockwise.
#[inline]
fn twice_area<N: Real>(a: &Projected<N>, b: &Projected<N>, c: &Projected<N>) -> N {
    cross2(&(b.at - a.at), &(c.at - a.at))
}

/// Removes corners in line with their neighbours: new, old, new deepest, and old deepest ones last.
fn thin<N: Real>(ring: &mut Projections<N>, tolerance: N) {
    for rank in 0..4 {
        let mut at = 0;
        while ring.len() > 2 && at < ring.len() {
            let [before, after] = [at + ring.len() - 1, at + 1].mapped(|index| index % ring.len());
            let own = &ring[at];
            let is_next = u8::from(own.is_kept) + 2 * u8::from(own.is_deepest) == rank;
            if is_next && is_between(own, [&ring[before], &ring[after]], tolerance) {
                ring.remove(at);
            } else {
                at += 1;
            }
        }
    }
}

/// Returns whether a point lies between two others, up to rounding. An end of a row may have the
/// same neighbour on both sides; `length` is zero then, and the end stays.
fn is_between<N: Real>(own: &Projected<N>, ends: [&Projected<N>; 2], tolerance: N) -> bool {
    let (edge, arm) = (ends[1].at - ends[0].at, own.at - ends[0].at);
    let (length, along) = (edge.norm(), edge.dot(&arm));
    let slack = tolerance * length;
    let is_in_row = cross2(&edge, &arm).abs() <= slack && length > N::ZERO;
    is_in_row && along >= -slack && along <= length * length + slack
}

/// Reduces a hull to `count` corners at most: a deepest, old ones, and those that add most area.
fn coarsen<N: Real>(ring: &mut Projections<N>, count: usize) {
    if ring.len() <= count {
        return;
    }
    let first = a_deepest(ring);
    ring.rotate_left(first);
    let mut indices: SmallVec<[usize; FEW]> = SmallVec::from_slice(&[0]);
    indices.extend((1..ring.len()).filter(|&index| ring[index].is_kept).take(count - 1));
    while indices.len() < count {
        let Some((at, index)) = best_addition(ring, &indices) else { break };
        indices.insert(at, index);
    }
    *ring = indices.iter().map(|&index| ring[index]).collect();
}

/// Returns the position in `indices` and the index of the corner that adds the most area to the
/// polygon of `indices`; `indices[0]` must be 0. `None` if no corner adds area.
fn best_addition<N: Real>(ring: &[Projected<N>], indices: &[usize]) -> Option<(usize, usize)> {
    let (mut best, mut most) = (None, N::ZERO);
    for (at, &from) in indices.iter().enumerate() {
        let (to, end) = indices.get(at + 1).map_or((ring.len(), 0), |&to| (to, to));
        for index in from + 1..to {
            let added = if from == end {
                (ring[index].at - ring[from].at).norm()
            } else {
                twice_area(&ring[from], &ring[index], &ring[end])
            };
            if added > most {
                (best, most) = (Some((at + 1, index)), added);
            }
        }
    }
    best
}

/// Returns `count` corners with the largest area plus bonuses, one of them deepest if possible.
fn largest_polygon<N: Real>(mut ring: Projections<N>, count: usize) -> Projections<N> {
    let has_deepest = ring.iter().any(|corner| corner.is_deepest);
    let is_first = |corner: &Projected<N>| corner.is_deepest || !has_deepest;
    let sides = (1..ring.len()).map(|to| twice_area(&ring[0], &ring[to - 1], &ring[to]));
    let bonus = sides.fold(N::ZERO, |sum, area| sum + area) * N::lit(KEPT);
    let (mut best, mut most) = (Projections::new(), -N::INFINITY);
    while ring.len() >= count
        && let Some(first) = ring.iter().position(is_first)
    {
        ring.rotate_left(first);
        let (span, polygon) = largest_with_first(&ring, count, bonus);
        if span > most {
            (best, most) = (polygon, span);
        }
        // All polygons with this corner have been tried.
        ring.remove(0);
    }
    best
}

/// Returns twice the largest area, with bonuses, of a polygon of `count` corners that has corner 0,
/// and that polygon. Dynamic programming: the best paths of `number` sides from corner 0 give the
/// best paths of `number + 1` sides.
fn largest_with_first<N: Real>(
    ring: &[Projected<N>],
    count: usize,
    bonus: N,
) -> (N, Projections<N>) {
    let own = |corner: &Projected<N>| if corner.is_kept { bonus } else { N::ZERO };
    let mut spans = [N::ZERO; FEW];
    let mut before = [[0; FEW]; FEW];
    for (number, row) in before.iter_mut().enumerate().take(count).skip(1) {
        for to in (number..ring.len()).rev() {
            let (mut most, mut last) = (-N::INFINITY, 0);
            for at in number - 1..if number == 1 { 1 } else { to } {
                let span = spans[at] + twice_area(&ring[0], &ring[at], &ring[to]);
                if span > most {
                    (most, last) = (span, at);
                }
            }
            (spans[to], row[to]) = (most + own(&ring[to]), last);
        }
    }
    let ends = count - 1..ring.len();
    let mut last = ends.fold(count - 1, |a, b| if spans[b] > spans[a] { b } else { a });
    let span = spans[last] + own(&ring[0]);
    let mut polygon = Projections::new();
    for number in (0..count).rev() {
        polygon.push(ring[last]);
        last = before[number][last];
    }
    (span, polygon)
}
