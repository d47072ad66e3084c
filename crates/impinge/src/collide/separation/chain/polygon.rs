//! Computes separations of segments of a chain from a polygon of up to 8 vertices, with or without
//! a radius, 8 segments at a time.

use super::super::polygons::outline::{PolygonOutline, Row};
use super::super::polygons::polygon_polygon::{Axis, of_axis};
use super::super::shared_corner::with_shared_corner;
use super::{ChainQuestion, EightSegments, Links};
use crate::collide::Pair;
use crate::collide::packet::LANES;
use crate::math::lanes::{bits, dot, either, negated, over, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Real, Vector, Wide, min};
use crate::shape::{Kind, Segment};

/// Adds the separations of the segments within the limit from the solid to `links`. `None` unless
/// the solid is a polygon of at most 8 vertices, with or without a radius, and if some lane has no
/// result.
pub(super) fn links<N: Real>(
    level: Level,
    question: &ChainQuestion<'_, N>,
    links: &mut Links<N>,
) -> Option<()> {
    with_lanes!(level, simd => search::<_, N, N::Lanes<_>>(simd, question, links))
}

/// Finds the best axes of 8 segments at a time, culls the segments beyond the limit, and computes
/// the separation of each remaining segment along its axis. `None` in the cases listed at
/// [`links`].
#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &ChainQuestion<'_, N>,
    links: &mut Links<N>,
) -> Option<()> {
    let solid =
        PolygonOutline::of::<S, V>(simd, &question.solid).filter(|solid| solid.count <= LANES)?;
    let solid = solid.placed::<S, V>(simd, &question.pose12);
    let solid = PolygonExtents::new::<S, V>(simd, solid);
    for (block, tiles) in question.tiles.iter().enumerate() {
        let packet = EightSegments::<V>::of(simd, tiles, question)?;
        links.from_middle = min(links.from_middle, packet.least());
        let axes = SegmentAxes::of(simd, &packet, &solid, question.limit);
        let mut within = !axes.beyond & question.lanes_of(block);
        while within != 0 {
            let lane = (within.trailing_zeros() as usize).min(LANES - 1);
            within &= within - 1;
            let [a, b, _] = tiles.corners(lane);
            let segment = Segment::of_finite(a - question.origin, b - question.origin);
            let own = PolygonOutline::of_segment::<S, V>(simd, &segment, N::ZERO)?;
            let outlines = [&own, &solid.outline];
            let found =
                of_axis::<S, N, V>(simd, outlines, &axes.axis(lane), axes.rounding_error[lane])?;
            let (first, second) = (Kind::Segment(&segment), question.solid);
            let pair = Pair { first, second, pose12: question.pose12 };
            let found = with_shared_corner(&pair, found);
            if found.distance <= question.limit {
                links.found.push((block * LANES + lane, found));
            }
        }
    }
    Some(())
}

/// A polygon in the frame of the segments, with its extents along the normals of its sides and
/// along its tips ([`PolygonOutline::tips`]).
struct PolygonExtents<N: Real> {
    outline: PolygonOutline<N>,
    /// Upper bound of the distance of the vertices from the origin.
    size: N,
    /// Extent along the normal of each side.
    extents: Row<N>,
    /// Direction of the tip at each vertex.
    tips: [Row<N>; 2],
    /// Extent of the polygon along each tip.
    tip_extents: Row<N>,
    /// Bits of the vertices with a tip.
    are_tips: u64,
}

impl<N: Real> PolygonExtents<N> {
    /// Computes the extents of a polygon along the normals of its sides and its tips.
    #[inline(always)]
    fn new<S: Simd, V: Wide<S, Scalar = N>>(simd: S, outline: PolygonOutline<N>) -> Self {
        let (mut tips, mut tip_extents) = ([[N::ZERO; LANES]; 2], [N::ZERO; LANES]);
        let (directions, is_tip) = outline.tips::<S, V>(simd, 0);
        for axis in 0..2 {
            directions[axis].store(&mut tips[axis]);
        }
        let mut extents = [N::ZERO; LANES];
        for (vertex, extent) in extents.iter_mut().enumerate().take(outline.count) {
            *extent = outline.normal(vertex).dot(&outline.at(vertex).coords);
        }
        let are_tips = is_tip.to_bitmask();
        if are_tips != 0 {
            outline.extent(simd, &directions).store(&mut tip_extents);
        }
        let size = outline.size::<S, V>(simd);
        Self { outline, size, extents, tips, tip_extents, are_tips }
    }
}

/// The direction with the largest gap between each of 8 segments and a polygon.
struct SegmentAxes<N> {
    /// Signed distance along the best direction of each segment, without the radius of the polygon.
    gaps: Row<N>,
    /// Unit vectors from the segment to the polygon.
    normals: [Row<N>; 2],
    /// Rounding error of lengths of each pair.
    rounding_error: Row<N>,
    /// Bits of the segments beyond the limit.
    beyond: u8,
}

/// Direction with the largest gap so far.
struct BestDirection<V> {
    gap: V,
    normal: [V; 2],
}

impl<V> BestDirection<V> {
    /// Tries another direction; it replaces the best one only if its gap is larger.
    #[inline(always)]
    fn attempt<S: Simd>(&mut self, gap: V, normal: &[V; 2])
    where
        V: Wide<S>,
    {
        let is_more = gap.simd_gt(self.gap);
        self.gap = is_more.select(gap, self.gap);
        self.normal = either(is_more, normal, &self.normal);
    }
}

impl<N: Real> SegmentAxes<N> {
    /// Finds the direction with the largest gap for each segment of the packet. The directions of
    /// the segment are tried first, then those of the polygon; the first wins a tie.
    #[inline(always)]
    fn of<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        packet: &EightSegments<V>,
        solid: &PolygonExtents<N>,
        limit: N,
    ) -> Self {
        let [a, b] = &packet.ends;
        let mut best = of_segments(simd, [a, b], &packet.side, packet.squared, &solid.outline);
        add_polygon(simd, [a, b], solid, &mut best);
        let rounding = solid.outline.rounding;
        let sizes = [a[0].abs() + a[1].abs(), b[0].abs() + b[1].abs()];
        let size = sizes[0].larger(sizes[1]).larger(V::all(simd, solid.size));
        let rounding_error = V::all(simd, N::lit(4.0) * N::EPSILON) * size;
        let slack = rounding_error + V::all(simd, N::EPSILON * rounding);
        let max_gap = V::all(simd, limit) + V::all(simd, N::lit(16.0)) * slack;
        // The gap is a lower bound. A gap beyond the limit by more than rounding rejects the
        // segment.
        let beyond = (best.gap - V::all(simd, rounding)).simd_gt(max_gap);
        let (beyond, zeros) = (bits(beyond), [N::ZERO; LANES]);
        let mut axes = Self { gaps: zeros, normals: [zeros; 2], rounding_error: zeros, beyond };
        best.gap.store(&mut axes.gaps);
        best.normal[0].store(&mut axes.normals[0]);
        best.normal[1].store(&mut axes.normals[1]);
        rounding_error.store(&mut axes.rounding_error);
        axes
    }

    fn axis(&self, lane: usize) -> Axis<N> {
        let normal = Vector::<N, 2>::new(self.normals[0][lane], self.normals[1][lane]);
        Axis { gap: self.gaps[lane], normal }
    }
}

/// Returns for each lane the direction with the largest gap among the segment's own directions:
/// both normals, and both tips, which are the directions along the segment.
#[inline(always)]
fn of_segments<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [a, b]: [&[V; 2]; 2],
    side: &[V; 2],
    squared: V,
    solid: &PolygonOutline<N>,
) -> BestDirection<V> {
    let length = squared.sqrt();
    let front = [side[1] / length, -(side[0] / length)];
    let back = negated(&front);
    // Computed by the formula of [`PolygonOutline::tips`], for an outline with two sides.
    let tip = [front[1] - back[1], back[0] - front[0]];
    let tip = over(&tip, dot(&tip, &tip).sqrt());
    let (low, high) = heights(simd, &front, solid);
    let (first, second) = (dot(&front, a), dot(&front, b));
    let mut best = BestDirection { gap: low - first, normal: front };
    let (tip_low, tip_high) = heights(simd, &tip, solid);
    let (tip_first, tip_second) = (dot(&tip, a), dot(&tip, b));
    best.attempt(tip_low - tip_first.larger(tip_second), &tip);
    best.attempt(second - high, &back);
    best.attempt(tip_first.smaller(tip_second) - tip_high, &negated(&tip));
    best
}

/// Returns the smallest and the largest coordinate of a polygon along directions.
#[inline(always)]
fn heights<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    directions: &[V; 2],
    solid: &PolygonOutline<N>,
) -> (V, V) {
    let (mut low, mut high) = (V::all(simd, N::INFINITY), V::all(simd, -N::INFINITY));
    for vertex in 0..solid.count {
        let at: [V; 2] = spread(simd, &solid.at(vertex).coords);
        let along = dot(directions, &at);
        (low, high) = (along.smaller(low), along.larger(high));
    }
    (low, high)
}

/// Tries the polygon's directions: for each vertex the normal of the side that starts there, then
/// its tip.
#[inline(always)]
fn add_polygon<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [a, b]: [&[V; 2]; 2],
    solid: &PolygonExtents<N>,
    best: &mut BestDirection<V>,
) {
    for vertex in 0..solid.outline.count.min(LANES) {
        let normal = solid.outline.normal(vertex);
        add(simd, [a, b], [normal.x, normal.y], solid.extents[vertex], best);
        if solid.are_tips >> vertex & 1 == 1 {
            let direction = [solid.tips[0][vertex], solid.tips[1][vertex]];
            add(simd, [a, b], direction, solid.tip_extents[vertex], best);
        }
    }
}

/// Tries a direction that points out of the polygon; `extent` is the polygon's extent along it.
#[inline(always)]
fn add<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [a, b]: [&[V; 2]; 2],
    direction: [N; 2],
    extent: N,
    best: &mut BestDirection<V>,
) {
    let direction = [V::all(simd, direction[0]), V::all(simd, direction[1])];
    let low = dot(&direction, a).smaller(dot(&direction, b));
    best.attempt(low - V::all(simd, extent), &negated(&direction));
}
