//! Nearest points of two polygons, from their best axis. The top of a polygon is its vertex
//! farthest along the axis toward the other polygon. In most cases a closed form at the tops gives
//! the nearest points: a corner and a point of a side, or two corners. Otherwise the two sides at
//! one top are compared with the two sides at the other top: each end of a side with each side of
//! the other polygon, 8 pairs at a time.

use super::outline::{PolygonOutline, highest, lane};
use super::polygon_polygon::{Axis, in_middle};
use crate::collide::separation::segments::segment_lanes::nearest_on_segment;
use crate::convex::Separation;
use crate::math::lanes::{dot, either, minus, spread};
use crate::math::simd::Simd;
use crate::math::{Point, Real, Vector, Wide, perp, unit};

/// Two outlines and a unit direction from the first to the second with its gap, which may be
/// negative.
pub(in crate::collide::separation) struct OutlinePair<'a, N: Real> {
    outlines: [&'a PolygonOutline<N>; 2],
    /// Unit direction from the first outline to the second, with its gap.
    axis: Axis<N>,
    /// Vertex of each outline that is farthest toward the other.
    tops: [usize; 2],
    /// Lengths up to this count as rounding errors.
    rounding_error: N,
}

impl<'a, N: Real> OutlinePair<'a, N> {
    /// Finds the tops of both outlines along an axis.
    #[inline(always)]
    pub(in crate::collide::separation) fn of<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        outlines: [&'a PolygonOutline<N>; 2],
        axis: &Axis<N>,
        rounding_error: N,
    ) -> Self {
        let (_, top1) = outlines[0].top::<S, V>(simd, &axis.normal);
        let (_, top2) = outlines[1].top::<S, V>(simd, &-axis.normal);
        Self { outlines, axis: *axis, tops: [top1, top2], rounding_error }
    }

    /// Returns the separation of the outlines; `None` if the gap is NaN or plus infinity, or the
    /// axis is not the direction of their nearest points.
    #[inline(always)]
    pub(in crate::collide::separation) fn separation<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
    ) -> Option<Separation<N, 2>> {
        let gap = self.axis.gap;
        match self.clear_case() {
            None if gap <= N::ZERO => Some(self.overlapping()),
            None if gap.is_finite_number() => self.apart::<S, V>(simd),
            found => found,
        }
    }

    /// Returns the separation in the clear cases: the axis is the normal of a side with a corner
    /// above it, the outlines certainly overlap, or corners at the tops are the nearest points.
    /// `None` in all other cases, and if the gap is not finite. The clear cases are decided if the
    /// axis is the best normal of a side; the tips of corners need not be tried.
    #[inline(always)]
    pub(in crate::collide::separation) fn clear_case(&self) -> Option<Separation<N, 2>> {
        let gap = self.axis.gap;
        if !gap.is_finite_number() {
            return None;
        }
        let (is_above1, end1) = self.beside(0);
        let (is_above2, end2) = self.beside(1);
        if gap < -self.rounding_error || gap <= N::ZERO && (is_above1 || is_above2) {
            return Some(self.overlapping());
        }
        let [top1, top2] = [self.top(0), self.top(1)];
        if is_above1 {
            return Some(self.along_axis(top2 - self.axis.normal * gap, top2));
        }
        if is_above2 {
            return Some(self.along_axis(top1, top1 + self.axis.normal * gap));
        }
        self.of_corners([end1, end2])
    }

    #[inline(always)]
    fn top(&self, which: usize) -> Point<N, 2> {
        self.outlines[which].at(self.tops[which])
    }

    #[inline(always)]
    fn along_axis(&self, point1: Point<N, 2>, point2: Point<N, 2>) -> Separation<N, 2> {
        Separation { distance: self.axis.gap, normal: self.axis.normal, point1, point2 }
    }

    /// Returns the depth of a vertex of an outline below the outline's top, along the axis.
    #[inline(always)]
    fn below(&self, which: usize, vertex: usize) -> N {
        let down = self.axis.normal.dot(&(self.top(which) - self.outlines[which].at(vertex)));
        if which == 0 { down } else { -down }
    }

    /// Returns whether the axis is the normal of a side at the top of outline `which` with the
    /// other outline's top above that side. Also returns the end of that side nearer to the other
    /// outline's top; if no side at the top is perpendicular to the axis, `false` and the top of
    /// outline `which`.
    #[inline(always)]
    fn beside(&self, which: usize) -> (bool, usize) {
        let (outline, top) = (self.outlines[which], self.tops[which]);
        let (next, previous) = (outline.next(top), outline.previous(top));
        let slack = N::lit(4.0) * self.rounding_error;
        let other = if self.below(which, next) <= slack {
            next
        } else if self.below(which, previous) <= slack {
            previous
        } else {
            return (false, top);
        };
        let (from, to, above) = (outline.at(top), outline.at(other), self.top(1 - which));
        let along = to - from;
        let (after, before) = ((above - from).dot(&along), (to - above).dot(&along));
        (after > N::ZERO && before > N::ZERO, if before < after { other } else { top })
    }

    /// Returns the separation at the corners `ends`; `None` unless each corner lies in the vertex
    /// region of the other, so that they are the nearest points, and their distance is more than
    /// rounding.
    #[inline(always)]
    fn of_corners(&self, ends: [usize; 2]) -> Option<Separation<N, 2>> {
        let [point1, point2] = [self.outlines[0].at(ends[0]), self.outlines[1].at(ends[1])];
        let between = point2 - point1;
        let is_behind = |which: usize, toward: &Vector<N, 2>| {
            let (outline, end) = (self.outlines[which], ends[which]);
            let at = outline.at(end);
            let before = at - outline.at(outline.previous(end));
            let after = outline.at(outline.next(end)) - at;
            toward.dot(&before) >= N::ZERO && toward.dot(&after) <= N::ZERO
        };
        if !(is_behind(0, &between) && is_behind(1, &-between)) {
            return None;
        }
        let (normal, distance) =
            unit(&between).filter(|(_, length)| *length > self.rounding_error)?;
        Some(Separation { distance, normal, point1, point2 })
    }

    /// Returns the separation of outlines that touch or overlap along the axis. Its points are at
    /// the middle of the overlap interval of both features at the tops.
    #[inline(always)]
    fn overlapping(&self) -> Separation<N, 2> {
        let tangent = perp(&self.axis.normal);
        let [low1, high1] = self.feature(0, &tangent);
        let [low2, high2] = self.feature(1, &tangent);
        in_middle([low1, high1], [low2.0, high2.0], &self.axis)
    }

    /// Returns the lowest and the highest vertex along `tangent`, among the top and its neighbours
    /// that are equally far along the axis, up to rounding.
    #[inline(always)]
    fn feature(&self, which: usize, tangent: &Vector<N, 2>) -> [(N, Point<N, 2>); 2] {
        let (outline, top) = (self.outlines[which], self.tops[which]);
        let at = outline.at(top);
        let (mut low, mut high) = ((tangent.dot(&at.coords), at), (tangent.dot(&at.coords), at));
        for vertex in [outline.previous(top), outline.next(top)] {
            let at = outline.at(vertex);
            let along = tangent.dot(&at.coords);
            if self.below(which, vertex) <= self.rounding_error {
                low = if along < low.0 { (along, at) } else { low };
                high = if along > high.0 { (along, at) } else { high };
            }
        }
        [low, high]
    }

    /// Returns the separation of outlines that are apart along the axis; `None` if the axis is not
    /// the direction of the nearest points.
    #[inline(always)]
    fn apart<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> Option<Separation<N, 2>> {
        let ([own, other], rounding_error) = (self.outlines, self.rounding_error);
        let (around1, around2) = (around(own, self.tops[0]), around(other, self.tops[1]));
        let points = nearest_points::<S, N, V>(simd, &around1, &around2)?;
        let between = points.1 - points.0;
        let slack = N::lit(8.0) * rounding_error;
        let beside = (between - self.axis.normal * self.axis.gap).norm();
        let direct = unit(&between).filter(|_| beside > rounding_error);
        let mut axis = self.axis;
        if let Some((normal, length)) = direct {
            let high1 = own.top::<S, V>(simd, &normal).0;
            let high2 = other.top::<S, V>(simd, &-normal).0;
            if -high2 - high1 + slack >= axis.gap {
                axis = Axis { gap: length, normal };
            }
        }
        let is_met = between.norm() - axis.gap <= N::lit(4.0) * rounding_error;
        let (point1, point2) = points;
        is_met.then_some(Separation { distance: axis.gap, normal: axis.normal, point1, point2 })
    }
}

/// Returns the predecessor of a vertex, the vertex and its successor.
#[inline(always)]
fn around<N: Real>(outline: &PolygonOutline<N>, vertex: usize) -> [Point<N, 2>; 3] {
    [outline.at(outline.previous(vertex)), outline.at(vertex), outline.at(outline.next(vertex))]
}

/// Returns the nearest points of the sides at two vertices; `around1` and `around2` hold each
/// vertex between its neighbours. `None` if the squared distances are not finite.
///
/// ```text
///   lane     0  1  2  3  4  5  6  7      `on2`: point of side 2 nearest to the end of side 1
///   side 1   b  b  b  b  a  a  a  a      `on1`: point of side 1 nearest to the end of side 2
///   side 2   b  b  a  a  b  b  a  a      b: side before the vertex, a: side after it
///   end      f  t  f  t  f  t  f  t      f: from, t: to
/// ```
///
/// In a tie the first pair is taken, in the order of sides of the first outline, sides of the
/// second, ends of the first, ends of the second.
#[inline(always)]
pub(in crate::collide::separation) fn nearest_points<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    around1: &[Point<N, 2>; 3],
    around2: &[Point<N, 2>; 3],
) -> Option<(Point<N, 2>, Point<N, 2>)> {
    let (zero, no, yes) = (V::all(simd, N::ZERO), N::ZERO, N::ONE);
    let is_second1 = V::load(simd, &[no, no, no, no, yes, yes, yes, yes]).simd_gt(zero);
    let is_second2 = V::load(simd, &[no, no, yes, yes, no, no, yes, yes]).simd_gt(zero);
    let is_end = V::load(simd, &[no, yes, no, yes, no, yes, no, yes]).simd_gt(zero);
    let before1: [V; 2] = spread(simd, &around1[0].coords);
    let at1: [V; 2] = spread(simd, &around1[1].coords);
    let after1: [V; 2] = spread(simd, &around1[2].coords);
    let before2: [V; 2] = spread(simd, &around2[0].coords);
    let at2: [V; 2] = spread(simd, &around2[1].coords);
    let after2: [V; 2] = spread(simd, &around2[2].coords);
    let from1 = either(is_second1, &at1, &before1);
    let to1 = either(is_second1, &after1, &at1);
    let from2 = either(is_second2, &at2, &before2);
    let to2 = either(is_second2, &after2, &at2);
    let end1 = either(is_end, &to1, &from1);
    let end2 = either(is_end, &to2, &from2);
    let on2 = nearest_on_segment(simd, &[from2, to2], &end1).point;
    let on1 = nearest_on_segment(simd, &[from1, to1], &end2).point;
    let (offset1, offset2) = (minus(&on2, &end1), minus(&on1, &end2));
    let (low1, lane1) = highest(simd, -dot(&offset1, &offset1));
    let (low2, lane2) = highest(simd, -dot(&offset2, &offset2));
    let (low1, low2) = (-low1, -low2);
    let is_finite = low1 < N::INFINITY && low2 < N::INFINITY;
    if !is_finite {
        return None;
    }
    let (rank1, rank2) = ((lane1 >> 1) * 4 + (lane1 & 1), (lane2 >> 1) * 4 + (lane2 & 1) + 2);
    let is_first = low1 < low2 || low1 == low2 && rank1 < rank2;
    Some(if is_first {
        (lane(&end1, lane1), lane(&on2, lane1))
    } else {
        (lane(&on1, lane2), lane(&end2, lane2))
    })
}
