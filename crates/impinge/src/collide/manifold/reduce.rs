//! Chooses contact points: the candidates that span the most area, projected along the normal.
//!
//! ```text
//!        .-- left --.        `start`: a deepest candidate, `end`: any other; area of both
//!   start -------- end       triangles, each with the farthest candidate on its side
//!        '- right --'
//! ```
//!
//! The best four of a few candidates come from all such diagonals, so no order of the candidates is
//! needed. More points than four, and four of many, are corners of the convex hull (A. M. Andrew,
//! "Another efficient algorithm for convex hulls in two dimensions", 1979), found by dynamic
//! programming along it (J. E. Boyce, D. P. Dobkin, R. L. Drysdale and L. J. Guibas, "Finding
//! extremal polygons", 1985). Both are exact up to [`FEW`] candidates; a longer hull keeps the
//! corners that add most.
//!
//! Old points, those of the previous manifold, are kept while they span [`ENOUGH`] of the best
//! choice and include a deepest one; otherwise each counts slightly more than a new one. So solids
//! at rest keep their points, also where many choices are equal, as among the eight corners of two
//! squares at 45°.

use core::cmp::Ordering;

use smallvec::SmallVec;

use crate::math::{Mapped, Real, Vector, cross2, max, max_component, min};

/// Up to this many candidates, the best choice is exact.
const FEW: usize = 16;

/// Weight of a new point, where an old one has 1: three old points lose at most 5 % of the best
/// area.
const NEW: f64 = 63.0 / 64.0;

/// Bonus of an old point in choices of more than four, as a share of the hull's area.
const KEPT: f64 = 1.0 / 256.0;

/// Share of the best area, or of the best length of points in a row, that old points have to span.
const ENOUGH: f64 = 0.9;

/// Points in a strip narrower than this share of its length are a row: its ends bound it, and
/// points between them come and go by rounding.
const THIN: f64 = 1.0 / 4096.0;

/// A candidate projected along the normal.
#[derive(Clone, Copy)]
pub(in crate::collide) struct Projected<N: Real> {
    pub(in crate::collide) at: Vector<N, 2>,
    /// Index of the candidate.
    pub(in crate::collide) index: usize,
    /// As deep as the manifold, up to rounding or the slack of an old point.
    pub(in crate::collide) is_deepest: bool,
    /// The previous manifold had it.
    pub(in crate::collide) is_kept: bool,
}

/// All candidates of a manifold, at least one.
pub(in crate::collide) type Projections<N> = SmallVec<[Projected<N>; FEW]>;

/// Indices of some candidates.
pub(in crate::collide) type Indices = SmallVec<[usize; 8]>;

/// Projects the candidates, given as coordinates, distance, and whether the previous manifold had
/// them. As deep as the manifold are those with a distance up to `level`, or the least; if none of
/// these is old, also old ones up to `slack`.
#[inline]
pub(in crate::collide) fn projected<N: Real>(
    candidates: impl Iterator<Item = (Vector<N, 2>, N, bool)> + Clone,
    [level, slack]: [N; 2],
) -> Projections<N> {
    let lowest = candidates.clone().fold(N::INFINITY, |low, (_, distance, _)| min(distance, low));
    let level = max(level, lowest);
    // If an old point is the deepest, no other has to stand for it.
    let has_old = candidates.clone().any(|(_, distance, is_kept)| is_kept && distance <= level);
    let slack = if has_old { level } else { slack };
    let mut points = Projections::new();
    for (index, (at, distance, is_kept)) in candidates.enumerate() {
        let is_deepest = distance <= level || is_kept && distance <= slack;
        points.push(Projected { at, index, is_deepest, is_kept });
    }
    points
}

/// Returns the indices, ascending, of at most `limit` candidates that span the most, one of the
/// deepest among them.
///
/// Lengths below `tolerance` count as rounding. Scaling by a power of two changes nothing.
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

/// Returns the old points, if they are few enough and as good as the best choice.
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

/// Returns twice the area of the convex hull of few points, and their largest distance.
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

/// Computes [`chosen`] from the corners of the convex hull alone, also if they are no more than the
/// limit. Cost: O(n log n) for n candidates.
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
        // Areas that are NaN.
        ring.push(points[a_deepest(points)]);
    }
    if ring.len() > limit {
        return sorted(best_four(&ring, limit, tolerance));
    }
    sorted(ring.iter().map(|corner| corner.index).collect())
}

/// Total order of numbers; most take one comparison.
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

/// Returns the index of a deepest candidate, of an old one if there is one.
pub(in crate::collide) fn a_deepest<N: Real>(points: &[Projected<N>]) -> usize {
    let is_old = |point: &Projected<N>| point.is_deepest && point.is_kept;
    let old = points.iter().position(is_old);
    old.or_else(|| points.iter().position(|point| point.is_deepest)).unwrap_or(0)
}

/// Scales the largest coordinate to about 1, so that areas neither overflow nor underflow; returns
/// the factor, a power of two.
fn rescale<N: Real>(points: &mut [Projected<N>]) -> N {
    let extent = points.iter().fold(N::ZERO, |extent, point| max(extent, max_component(&point.at)));
    let scale = N::ONE / extent.power_of_two_below();
    for point in points {
        point.at *= scale;
    }
    scale
}

/// Returns at most four of few points, and no more than `limit`: those that span the most.
fn best_four<N: Real>(points: &[Projected<N>], limit: usize, tolerance: N) -> Indices {
    let best = if limit > 2 { best_diagonal(points, limit > 3, tolerance) } else { None };
    let mut chosen = best.unwrap_or_else(|| farthest(points, limit, tolerance));
    for place in &mut chosen {
        *place = points[*place].index;
    }
    chosen
}

/// Returns a deepest point, the one farthest from it, and the other end if all lie in a row.
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

/// Returns the point farthest from another, and their weighted distance.
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

/// Returns the weight of a point.
#[inline]
fn weight<N: Real>(point: &Projected<N>) -> N {
    if point.is_kept { N::ONE } else { N::lit(NEW) }
}

/// Coordinates and weights of few points, side by side for vectors.
struct CoordinateRows<N: Real> {
    x: [[N; LANES]; FEW / LANES],
    y: [[N; LANES]; FEW / LANES],
    weights: [[N; LANES]; FEW / LANES],
    /// Number of used rows.
    len: usize,
}

/// Numbers in one row.
const LANES: usize = 4;

impl<N: Real> CoordinateRows<N> {
    #[inline]
    fn of(points: &[Projected<N>]) -> Self {
        let zero = [[N::ZERO; LANES]; FEW / LANES];
        let mut rows = Self { x: zero, y: zero, weights: zero, len: points.len().div_ceil(LANES) };
        for (place, point) in points.iter().enumerate() {
            let (row, lane) = (place / LANES, place % LANES);
            (rows.x[row][lane], rows.y[row][lane]) = (point.at.x, point.at.y);
            rows.weights[row][lane] = weight(point);
        }
        rows
    }

    /// Returns twice the areas that a diagonal spans with the farthest points on its left and
    /// right.
    #[inline]
    fn sides(&self, start: &Projected<N>, end: &Projected<N>) -> [N; 2] {
        let way = end.at - start.at;
        let base = cross2(&way, &start.at);
        let [mut lefts, mut rights] = [[N::ZERO; LANES]; 2];
        let rows = self.x.iter().zip(&self.y).zip(&self.weights);
        for ((x, y), weights) in rows.take(self.len) {
            for lane in 0..LANES {
                let area = (way.x * y[lane] - way.y * x[lane] - base) * weights[lane];
                lefts[lane] = max(lefts[lane], area);
                rights[lane] = min(rights[lane], area);
            }
        }
        let ([a, b, c, d], [e, f, g, h]) = (lefts, rights);
        [max(max(a, b), max(c, d)), -min(min(e, f), min(g, h))]
    }
}

/// Returns the ends of the best diagonal and the farthest points on both sides, or on one side
/// unless `is_four`; `None` if all points lie in a row.
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

/// Returns the ends of a diagonal and the points farthest from it.
fn with_sides<N: Real>(
    points: &[Projected<N>],
    ends: [usize; 2],
    is_four: bool,
    tolerance: N,
) -> Option<Indices> {
    let [start, end] = ends.mapped(|place| &points[place]);
    let least = tolerance * (end.at - start.at).norm();
    let (mut corners, [mut left, mut right]) = (Indices::from_slice(&ends), [least; 2]);
    let mut sides = [None; 2];
    for (place, point) in points.iter().enumerate() {
        let area = twice_area(start, end, point) * weight(point);
        if area > left {
            (left, sides[0]) = (area, Some(place));
        }
        if -area > right {
            (right, sides[1]) = (-area, Some(place));
        }
    }
    if !is_four {
        sides[usize::from(left >= right)] = None;
    }
    for place in sides.into_iter().flatten() {
        corners.push(place);
    }
    (corners.len() > 2).then_some(corners)
}

/// Returns the corners of the convex hull, counter-clockwise.
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

/// Appends one side of the hull, from the first point to the last: every corner turns left.
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

/// Twice the area of a triangle, positive if it is counter-clockwise.
#[inline]
fn twice_area<N: Real>(a: &Projected<N>, b: &Projected<N>, c: &Projected<N>) -> N {
    cross2(&(b.at - a.at), &(c.at - a.at))
}

/// Removes corners that lie, up to rounding, between their neighbours: deepest ones last, and old
/// ones before them.
fn thin<N: Real>(ring: &mut Projections<N>, tolerance: N) {
    for rank in 0..4 {
        let mut at = 0;
        while ring.len() > 2 && at < ring.len() {
            let [before, after] = [at + ring.len() - 1, at + 1].mapped(|place| place % ring.len());
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

/// Returns whether a point lies between two others. An end of points in a row may have the same
/// inner point on both sides, which both chains contain; `length` is zero then, and the end stays.
fn is_between<N: Real>(own: &Projected<N>, ends: [&Projected<N>; 2], tolerance: N) -> bool {
    let (way, arm) = (ends[1].at - ends[0].at, own.at - ends[0].at);
    let (length, along) = (way.norm(), way.dot(&arm));
    let room = tolerance * length;
    let is_in_row = cross2(&way, &arm).abs() <= room && length > N::ZERO;
    is_in_row && along >= -room && along <= length * length + room
}

/// Reduces a hull to at most `count` corners: old ones, a deepest one if there is one, and
/// repeatedly the one that adds most.
fn coarsen<N: Real>(ring: &mut Projections<N>, count: usize) {
    if ring.len() <= count {
        return;
    }
    let first = a_deepest(ring);
    ring.rotate_left(first);
    let mut places: SmallVec<[usize; FEW]> = SmallVec::from_slice(&[0]);
    places.extend((1..ring.len()).filter(|&place| ring[place].is_kept).take(count - 1));
    while places.len() < count {
        let Some((at, place)) = best_addition(ring, &places) else { break };
        places.insert(at, place);
    }
    *ring = places.iter().map(|&place| ring[place]).collect();
}

/// Returns the corner that adds most to `places`, of which the first is 0, and its position there.
fn best_addition<N: Real>(ring: &[Projected<N>], places: &[usize]) -> Option<(usize, usize)> {
    let (mut best, mut most) = (None, N::ZERO);
    for (at, &from) in places.iter().enumerate() {
        let (to, end) = places.get(at + 1).map_or((ring.len(), 0), |&to| (to, to));
        for place in from + 1..to {
            let added = if from == end {
                (ring[place].at - ring[from].at).norm()
            } else {
                twice_area(&ring[from], &ring[place], &ring[end])
            };
            if added > most {
                (best, most) = (Some((at + 1, place)), added);
            }
        }
    }
    best
}

/// Returns the polygon of `count` corners that spans the most, with a deepest one if there is any.
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
        // All polygons with this corner are known.
        ring.remove(0);
    }
    best
}

/// Returns the largest polygon of `count` corners that has the first one, and twice its area: the
/// best ways to each corner over `number` others give those over one more.
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
