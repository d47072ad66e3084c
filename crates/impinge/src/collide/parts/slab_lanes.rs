//! Lower bounds of the distances from one part to 8 other parts at a time, along the slabs around
//! the first part and along separating axes of each pair.
//!
//! Two triangles in 3D that are not coplanar overlap iff none of these axes separates them: the two
//! normals and the nine cross products of a side of each. If they overlap, the shortest separating
//! translation is along one of these axes (Gottschalk, Lin and Manocha, "`OBBTree`", 1996). For
//! coplanar triangles, only the in-plane normals of one triangle, which its slabs contain, are
//! tested, so the bound may be smaller than the distance. Two triangles in 2D overlap iff no normal
//! of a side of either separates them.

use super::slabs::{AxisSlabs, rounding_unit};
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{bits, cross, dot, in_lanes, load, minus, spread};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Real, Vector, Wide};

/// Corners of parts relative to the origin of the slabs, indexed by corner and axis.
type Corners<V, const D: usize> = [[V; D]; 3];

/// Returns lower bounds of the distances of 8 parts in 2D from the solid inside the slabs; negative
/// for overlaps. If the slabs alone put all parts of a SIMD run (all 8 lanes, or one lane without
/// SIMD) beyond `limit`, the other axes are skipped for that run. So bounds above `limit` may
/// depend on the SIMD level.
pub(crate) fn part_gaps2<N: Real>(
    slabs: &AxisSlabs<N, 2>,
    tiles: &PartPacket<N, 2>,
    limit: N,
) -> [N; LANES] {
    let mut gaps = [N::ZERO; LANES];
    for run in Level::new().runs(LANES) {
        let found =
            in_lanes!(run, simd => in_lanes_2d::<_, N, N::Lanes<_>>(simd, slabs, tiles, limit));
        gaps[run.lanes()].copy_from_slice(&found[run.lanes()]);
    }
    gaps
}

/// Returns lower bounds of the distances of 8 parts in 3D from the solid inside the slabs; negative
/// for overlaps. As in [`part_gaps2`], axes are skipped for a SIMD run that is beyond `limit`, so
/// bounds above `limit` may depend on the SIMD level.
pub(crate) fn part_gaps3<N: Real>(
    slabs: &AxisSlabs<N, 3>,
    tiles: &PartPacket<N, 3>,
    limit: N,
) -> [N; LANES] {
    let mut gaps = [N::ZERO; LANES];
    for run in Level::new().runs(LANES) {
        let found =
            in_lanes!(run, simd => in_lanes_3d::<_, N, N::Lanes<_>>(simd, slabs, tiles, limit));
        gaps[run.lanes()].copy_from_slice(&found[run.lanes()]);
    }
    gaps
}

/// Computes gaps in 2D: along the slabs, then perpendicular to the sides of the other parts.
#[inline(always)]
fn in_lanes_2d<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    slabs: &AxisSlabs<N, 2>,
    tiles: &PartPacket<N, 2>,
    limit: N,
) -> [N; LANES] {
    let corners = translated_corners::<S, N, V, 2>(simd, slabs, tiles);
    let mut gaps = SlabGaps { simd, corners, gaps: V::all(simd, -N::INFINITY) };
    gaps.along(slabs);
    if let Some(own) = slabs.corners.as_ref().filter(|_| gaps.are_within(slabs, limit)) {
        let own = spread_corners(simd, own);
        for side in sides(&gaps.corners) {
            gaps.across(&own, &[-side[1], side[0]]);
        }
    }
    gaps.certain(slabs)
}

/// Computes gaps in 3D: along the slabs, then along the normals of the other parts, then along the
/// cross products of a side of each.
#[inline(always)]
fn in_lanes_3d<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    slabs: &AxisSlabs<N, 3>,
    tiles: &PartPacket<N, 3>,
    limit: N,
) -> [N; LANES] {
    let corners = translated_corners::<S, N, V, 3>(simd, slabs, tiles);
    let mut gaps = SlabGaps { simd, corners, gaps: V::all(simd, -N::INFINITY) };
    gaps.along(slabs);
    let Some(own) = &slabs.corners else { return gaps.certain(slabs) };
    if !gaps.are_within(slabs, limit) {
        return gaps.certain(slabs);
    }
    let (own, others) = (spread_corners(simd, own), sides(&gaps.corners));
    gaps.across(&own, &cross(&others[0], &others[1]));
    if gaps.are_within(slabs, limit) {
        let own_sides = sides(&own);
        for own_side in &own_sides {
            for side in &others {
                gaps.across(&own, &cross(own_side, side));
            }
        }
    }
    gaps.certain(slabs)
}

/// Corners of 8 parts, and the largest gap found so far for each of them.
struct SlabGaps<S, V, const D: usize> {
    simd: S,
    corners: Corners<V, D>,
    gaps: V,
}

impl<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize> SlabGaps<S, V, D> {
    /// Raises each gap to the largest gap along the slabs if that is larger.
    #[inline(always)]
    fn along(&mut self, slabs: &AxisSlabs<N, D>) {
        for slab in &slabs.slabs {
            let [low, high] = extent(&self.corners, &spread(self.simd, &slab.along));
            let above = low - V::all(self.simd, slab.highest);
            let below = V::all(self.simd, slab.lowest) - high;
            self.gaps = above.larger(below).larger(self.gaps);
        }
    }

    /// Raises each gap to the gap along `along` between the part with the corners `own` and the
    /// part of the lane, if that is larger. `along` may have any length; the axis is skipped if its
    /// squared length is close to underflow or overflows.
    #[inline(always)]
    fn across(&mut self, own: &Corners<V, D>, along: &[V; D]) {
        let squared = dot(along, along);
        let ([low, high], [own_low, own_high]) = (extent(&self.corners, along), extent(own, along));
        let gap = (low - own_high).larger(own_low - high) / squared.sqrt();
        let simd = self.simd;
        let is_length = squared.simd_gt(V::all(simd, N::MIN_POSITIVE / N::EPSILON))
            & squared.simd_lt(V::all(simd, N::INFINITY));
        self.gaps = is_length.select(gap, -V::all(simd, N::INFINITY)).larger(self.gaps);
    }

    /// Returns whether the gaps so far leave some part that may be within `limit`.
    #[inline(always)]
    fn are_within(&self, slabs: &AxisSlabs<N, D>, limit: N) -> bool {
        let beyond = V::all(self.simd, limit) + self.slack(slabs);
        bits(self.gaps.simd_gt(beyond)) != u8::MAX
    }

    /// Returns the rounding error of each gap.
    #[inline(always)]
    fn slack(&self, slabs: &AxisSlabs<N, D>) -> V {
        let mut size = V::all(self.simd, slabs.size);
        for corner in &self.corners {
            for value in corner {
                size = value.abs().larger(size);
            }
        }
        size * V::all(self.simd, rounding_unit())
    }

    /// Returns the gaps minus their rounding error; minus infinity for lengths that are too small
    /// to be precise.
    #[inline(always)]
    fn certain(&self, slabs: &AxisSlabs<N, D>) -> [N; LANES] {
        let (simd, slack) = (self.simd, self.slack(slabs));
        // Subnormal lengths have a large relative rounding error.
        let least = N::MIN_POSITIVE / N::EPSILON * rounding_unit::<N>();
        let is_precise = slack.simd_gt(V::all(simd, least));
        let gaps = is_precise.select(self.gaps - slack, -V::all(simd, N::INFINITY));
        let mut lanes = [N::ZERO; LANES];
        gaps.store(&mut lanes);
        lanes
    }
}

/// Returns the corners of 8 parts relative to the origin of the slabs.
#[inline(always)]
fn translated_corners<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    slabs: &AxisSlabs<N, D>,
    tiles: &PartPacket<N, D>,
) -> Corners<V, D> {
    let origin: [V; D] = spread(simd, &slabs.origin);
    let [a, b, c] = &tiles.corners;
    let (a, b, c) = (load(simd, a), load(simd, b), load(simd, c));
    [minus(&a, &origin), minus(&b, &origin), minus(&c, &origin)]
}

/// Copies the corners of one part into all lanes.
#[inline(always)]
fn spread_corners<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [a, b, c]: &[Vector<N, D>; 3],
) -> Corners<V, D> {
    [spread(simd, a), spread(simd, b), spread(simd, c)]
}

/// Returns the vectors from each corner to the next, and from the last to the first.
#[inline(always)]
fn sides<S: Simd, V: Wide<S>, const D: usize>([a, b, c]: &Corners<V, D>) -> Corners<V, D> {
    [minus(b, a), minus(c, b), minus(a, c)]
}

/// Returns the smallest and the largest dot product of the corners with `along`.
#[inline(always)]
fn extent<S: Simd, V: Wide<S>, const D: usize>(
    [a, b, c]: &Corners<V, D>,
    along: &[V; D],
) -> [V; 2] {
    let (a, b, c) = (dot(a, along), dot(b, along), dot(c, along));
    [a.smaller(b).smaller(c), a.larger(b).larger(c)]
}
