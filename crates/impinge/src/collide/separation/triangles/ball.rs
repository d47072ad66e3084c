//! Triangles against a ball: finds the near triangles, 8 at a time, and those that a neighbour
//! hides (whose contact the surface would reject in favour of the neighbour's).
//!
//! A contact at a corner or edge belongs to the whole surface only if no triangle there extends
//! along its normal: no direction into such a triangle has a positive component along the normal
//! (`shape/surface/seam.rs`). If one of these triangles is nearer to the centre of the ball than
//! the corner or edge, the direction to its nearest point has such a component. So distances alone
//! give the result of the rule for normals. Only one of the triangles around the point where a ball
//! rests remains. In close cases no triangle counts as hidden.
//!
//! ```text
//!           o  centre           kind 0, 1, 2: nearest on the side that starts at corner 0, 1, 2
//!          /|                   kind 3, 4, 5: nearest at corner 0, 1, 2
//!    -----*-+------             the left triangle is nearest at its corner *; the right one
//!    left   right               has that corner and is nearer, so it hides the left one
//! ```

use smallvec::SmallVec;

use crate::bounding_volume::Aabb;
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{bits, dot, either, load, minus, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide, filled, max_component, min};

/// A triangle is thin if the squared ratio of its height to its longest side is at most this.
const TALL: f64 = 1.0 / 1000.0;
/// Bound of the rounding errors of squared distances, in epsilons of the squared size of the lane:
/// the distance of the farthest corner from the centre plus the radius. A nearest feature is
/// certain if the centre is farther from the border of its Voronoi region than the root of this
/// bound.
const CLEAR: f64 = 64.0;
/// Kinds of corners start at this number, after the kinds of sides.
const CORNER: f64 = 3.0;
/// Lower bounds of distances are lowered by this many epsilons of the size of the lane.
const ROUNDING: f64 = 128.0;
/// Heights of triangles up to this many epsilons count as rounding; the unit is the size of the
/// lane plus the largest coordinate of the centre.
const HEIGHT: f64 = 64.0;
/// Number of packets with near triangles, before and after the packet of a triangle, in which its
/// neighbours are searched.
const MAX_APART: usize = 8;

/// A ball, and the triangles among which the near ones are searched.
pub(crate) struct BallQuestion<'a, N: Real> {
    pub(crate) tiles: &'a [PartPacket<N, 3>],
    /// Number of triangles. The lanes after the last triangle, in the last packet, hold copies of
    /// it.
    pub(crate) count: usize,
    /// Centre of the ball in the frame of the triangles.
    pub(crate) center: Vector<N, 3>,
    pub(crate) radius: N,
    /// Triangles farther than this from the surface of the ball are skipped. So are triangles whose
    /// boxes do not overlap `within`.
    pub(crate) limit: N,
    /// Box of interest, in the frame of the triangles.
    pub(crate) within: Aabb<N, 3>,
}

/// The triangles near a ball.
pub(crate) struct CandidateTriangles<N> {
    /// Lower bound of the distance from the centre to the triangles in the box; zero if unknown,
    /// infinite if no triangle is in the box.
    pub(crate) from_middle: N,
    /// One entry for each packet with near triangles, in ascending order: its index, the bits of
    /// the triangles within the limit, and the bits of the hidden triangles among them.
    pub(crate) masks: SmallVec<[(usize, [u8; 2]); 8]>,
    /// Lower bound of the squared distances of all hidden triangles; infinite if none is hidden.
    pub(crate) hidden_from: N,
}

/// Finds the triangles near a ball. If `has_seams` is `false`, no triangle counts as hidden.
pub(crate) fn candidate_triangles<N: Real>(
    question: &BallQuestion<'_, N>,
    has_seams: bool,
) -> CandidateTriangles<N> {
    at(Level::new(), question, has_seams)
}

/// Runs the search with the instruction set `level`, on which the result does not depend.
fn at<N: Real>(
    level: Level,
    question: &BallQuestion<'_, N>,
    has_seams: bool,
) -> CandidateTriangles<N> {
    with_lanes!(level, simd => look::<_, N, N::Lanes<_>>(simd, question, has_seams))
}

/// Finds near triangles packet by packet, then which of them a neighbour hides.
#[inline(always)]
fn look<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &BallQuestion<'_, N>,
    has_seams: bool,
) -> CandidateTriangles<N> {
    let mut features: SmallVec<[NearestFeatures<N>; 8]> = SmallVec::new();
    let mut candidates = CandidateTriangles {
        from_middle: N::INFINITY,
        masks: SmallVec::new(),
        hidden_from: N::INFINITY,
    };
    for (block, tiles) in question.tiles.iter().enumerate() {
        let meant = u8::MAX >> (LANES - (question.count - block * LANES).min(LANES));
        let within = meant & bits(are_within::<S, N, V>(simd, question, tiles));
        if within == 0 {
            continue;
        }
        let packet = TrianglePacket::<V>::of(simd, question, tiles);
        let (mut own, least) = packet.nearest_features(simd, question, block, within, has_seams);
        candidates.from_middle = min(candidates.from_middle, least);
        if own.mask != 0 {
            own.sides &= own.mask;
            candidates.masks.push((block, [own.mask, 0]));
            features.push(own);
        }
    }
    for (at, own) in features.iter().enumerate() {
        let mut sides_left = own.sides;
        while sides_left != 0 {
            let lane = sides_left.trailing_zeros() as usize;
            sides_left &= sides_left - 1;
            let around =
                &features[at.saturating_sub(MAX_APART)..features.len().min(at + 1 + MAX_APART)];
            if is_hidden::<S, N, V>(simd, question, around, own, lane) {
                candidates.masks[at].1[1] |= 1 << lane;
                candidates.hidden_from = min(candidates.hidden_from, own.least[lane]);
            }
        }
    }
    candidates
}

/// Returns the lanes whose triangles have boxes that overlap `question.within`.
#[inline(always)]
fn are_within<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &BallQuestion<'_, N>,
    tiles: &PartPacket<N, 3>,
) -> V::Mask {
    let (low, high) = (question.within.mins(), question.within.maxs());
    let all = V::all(simd, N::ZERO);
    let mut within = all.simd_eq(all);
    for axis in 0..3 {
        let [a, b, c] = &tiles.corners;
        let (a, b, c) = (V::load(simd, &a[axis]), V::load(simd, &b[axis]), V::load(simd, &c[axis]));
        within = within
            & a.smaller(b).smaller(c).simd_le(V::all(simd, high[axis]))
            & a.larger(b).larger(c).simd_ge(V::all(simd, low[axis]));
    }
    within
}

/// Nearest features of 8 triangles.
struct NearestFeatures<N> {
    /// Index of the packet.
    block: usize,
    /// Bits of the triangles that may be within the limit.
    mask: u8,
    /// Bits of the triangles whose nearest point certainly lies on a side or corner.
    sides: u8,
    /// Nearest feature: a side by the index of its first corner, a corner by its index plus 3.
    kinds: [N; LANES],
    /// Lower bounds of the squared distances from the centre of the ball.
    least: [N; LANES],
    /// Upper bounds of the squared distances from the centre of the ball; infinite for triangles
    /// that must not hide others, because they are thin or small.
    most: [N; LANES],
}

/// Eight triangles relative to the centre of the ball.
struct TrianglePacket<V> {
    /// Corners relative to the centre of the ball.
    corners: [[V; 3]; 3],
    /// Squared lengths of the sides, from each corner to the next.
    squares: [V; 3],
    /// Coordinate of the centre along each side, measured from its first corner, times the length
    /// of the side.
    along: [V; 3],
    /// Four times the squared area.
    area: V,
    /// Barycentric coordinates of the centre's projection, times `area`.
    shares: [V; 3],
    /// Nearest points to the centre.
    nearest: [V; 3],
    /// Squared distances of the nearest points.
    squared: V,
    /// Squared distances of the farthest corners from the centre.
    farthest: V,
}

impl<V> TrianglePacket<V> {
    /// Computes nearest points and barycentric coordinates of a packet.
    #[inline(always)]
    fn of<S: Simd, N: Real>(
        simd: S,
        question: &BallQuestion<'_, N>,
        tiles: &PartPacket<N, 3>,
    ) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let center: [V; 3] = spread(simd, &question.center);
        let a = minus(&load(simd, &tiles.corners[0]), &center);
        let b = minus(&load(simd, &tiles.corners[1]), &center);
        let c = minus(&load(simd, &tiles.corners[2]), &center);
        let (ab, bc, ca) = (minus(&b, &a), minus(&c, &b), minus(&a, &c));
        let squares = [dot(&ab, &ab), dot(&bc, &bc), dot(&ca, &ca)];
        let along = [-dot(&ab, &a), -dot(&bc, &b), -dot(&ca, &c)];
        // Both sides at the first corner are taken from that corner: `turn` is their dot product,
        // `to_c` the coordinate of the centre along the second side, times its length.
        let (turn, to_c) = (-dot(&ab, &ca), dot(&ca, &a));
        let area = squares[0] * squares[2] - turn * turn;
        let at_b = along[0] * squares[2] - to_c * turn;
        let at_c = to_c * squares[0] - along[0] * turn;
        let shares = [area - at_b - at_c, at_b, at_c];
        let zero = V::all(simd, N::ZERO);
        let is_over =
            shares[0].simd_ge(zero) & at_b.simd_ge(zero) & at_c.simd_ge(zero) & area.simd_gt(zero);
        let (share_b, share_c) = (at_b / area, at_c / area);
        let below: [V; 3] = filled(
            #[inline(always)]
            |axis| a[axis] + ab[axis] * share_b - ca[axis] * share_c,
        );
        let beside = [
            on_side(simd, &a, &ab, along[0] / squares[0]),
            on_side(simd, &b, &bc, along[1] / squares[1]),
            on_side(simd, &c, &ca, along[2] / squares[2]),
        ];
        let beside = shorter(&shorter(&beside[0], &beside[1]), &beside[2]);
        let nearest = either(is_over, &below, &beside);
        let farthest = dot(&a, &a).larger(dot(&b, &b)).larger(dot(&c, &c));
        let squared = dot(&nearest, &nearest);
        Self { corners: [a, b, c], squares, along, area, shares, nearest, squared, farthest }
    }

    /// Returns the nearest features, and the smallest of the lower bounds of the distances of all 8
    /// triangles.
    #[inline(always)]
    fn nearest_features<S: Simd, N: Real>(
        &self,
        simd: S,
        question: &BallQuestion<'_, N>,
        block: usize,
        within: u8,
        has_seams: bool,
    ) -> (NearestFeatures<N>, N)
    where
        V: Wide<S, Scalar = N>,
    {
        let radius = V::all(simd, question.radius);
        let size = self.farthest.sqrt() + radius;
        let (bound, is_bound) = self.bound(simd, size);
        let is_beyond = is_bound & bound.simd_gt(radius + V::all(simd, question.limit));
        let mut known = [N::ZERO; LANES];
        bound.store(&mut known);
        let [a, b, c, d, e, f, g, h] = known;
        let least = min(min(min(a, e), min(c, g)), min(min(b, f), min(d, h)));
        let (blank, most) = ([N::ZERO; LANES], [N::INFINITY; LANES]);
        let mask = within & bits(!is_beyond);
        let mut features =
            NearestFeatures { block, mask, sides: 0, kinds: blank, least: blank, most };
        if mask != 0 && has_seams {
            let clear = V::all(simd, N::lit(CLEAR) * N::EPSILON) * (size * size);
            let is_tall = self.is_tall(simd, size, clear, max_component(&question.center));
            let (kind, margin) = self.beside(simd);
            let is_beside = is_tall & margin.simd_gt(clear.sqrt()) & is_bound;
            features.sides = bits(is_beside);
            kind.store(&mut features.kinds);
            (self.squared - clear).store(&mut features.least);
            let most = is_tall.select(self.squared + clear, V::all(simd, N::INFINITY));
            most.store(&mut features.most);
        }
        (features, least)
    }

    /// Returns lower bounds of the distances, from the planes through the nearest points
    /// perpendicular to their directions; zero in lanes without a bound. The mask has the lanes
    /// with a bound.
    #[inline(always)]
    fn bound<S: Simd, N: Real>(&self, simd: S, size: V) -> (V, V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let ([a, b, c], nearest, length) = (&self.corners, &self.nearest, self.squared.sqrt());
        let low = dot(nearest, a).smaller(dot(nearest, b)).smaller(dot(nearest, c));
        let slack = V::all(simd, N::lit(ROUNDING) * N::EPSILON) * size;
        let bound = low / length - slack;
        // `is_bound` is false for NaN, and for values that are inexact because of underflow.
        let is_bound = bound.simd_gt(slack)
            & low.simd_gt(V::all(simd, N::MIN_POSITIVE / N::EPSILON))
            & size.simd_lt(V::all(simd, N::MAX.sqrt()));
        (is_bound.select(bound, V::all(simd, N::ZERO)), is_bound)
    }

    /// Returns the lanes whose triangles are neither thin nor small relative to their distance from
    /// the origin, and whose areas are far from underflow and overflow.
    #[inline(always)]
    fn is_tall<S: Simd, N: Real>(&self, simd: S, size: V, clear: V, away: N) -> V::Mask
    where
        V: Wide<S, Scalar = N>,
    {
        let longest = self.squares[0].larger(self.squares[1]).larger(self.squares[2]);
        let height = V::all(simd, N::lit(HEIGHT) * N::EPSILON) * (size + V::all(simd, away));
        self.area.simd_gt(V::all(simd, N::lit(TALL)) * longest * longest)
            & self.area.simd_gt(height * height * longest)
            & longest.simd_gt(clear)
            & self.area.simd_gt(V::all(simd, N::MIN_POSITIVE / N::EPSILON))
            & self.area.simd_lt(V::all(simd, N::MAX * N::EPSILON))
    }

    /// Returns the side or corner nearest to the centre, and the distance by which the centre is
    /// inside the Voronoi region of this feature; if the distance is not positive, the feature is
    /// unknown.
    #[inline(always)]
    fn beside<S: Simd, N: Real>(&self, simd: S) -> (V, V)
    where
        V: Wide<S, Scalar = N>,
    {
        let area = self.area.sqrt();
        let root = [self.squares[0].sqrt(), self.squares[1].sqrt(), self.squares[2].sqrt()];
        let past = [self.along[0] / root[0], self.along[1] / root[1], self.along[2] / root[2]];
        let left = [root[0] - past[0], root[1] - past[1], root[2] - past[2]];
        // Distances of the centre's projection outside the sides, from the barycentric coordinates
        // of the opposite corners.
        let outside = [
            -self.shares[2] / (area * root[0]),
            -self.shares[0] / (area * root[1]),
            -self.shares[1] / (area * root[2]),
        ];
        let (mut kind, mut margin) = (V::all(simd, N::ZERO), V::all(simd, -N::INFINITY));
        for (at, number) in [0.0, 1.0, 2.0].into_iter().enumerate() {
            let before = (at + 2) % 3;
            let aside = outside[at].larger(outside[before]);
            let of_side = outside[at].smaller(past[at]).smaller(left[at]);
            let of_corner = aside.smaller(-past[at]).smaller(-left[before]);
            for (new, number) in [(of_side, number), (of_corner, number + CORNER)] {
                let is_more = new.simd_gt(margin);
                kind = is_more.select(V::all(simd, N::lit(number)), kind);
                margin = is_more.select(new, margin);
            }
        }
        (kind, margin)
    }
}

/// Returns whether some triangle of `features` that is neither thin nor small contains the nearest
/// side or corner of triangle `lane` of `own`, and is certainly nearer to the centre.
#[inline(always)]
fn is_hidden<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &BallQuestion<'_, N>,
    features: &[NearestFeatures<N>],
    own: &NearestFeatures<N>,
    lane: usize,
) -> bool {
    let (kind, least) = (own.kinds[lane], own.least[lane]);
    let is_corner = kind >= N::lit(CORNER);
    let number = if is_corner { kind - N::lit(CORNER) } else { kind };
    let at = if number == N::ZERO { 0 } else { 1 + usize::from(number > N::ONE) };
    let corners = question.tiles[own.block].corners(lane);
    let (from, to) = (corners[at], corners[(at + 1) % 3]);
    for other in features {
        let tiles = &question.tiles[other.block];
        let is_nearer = V::load(simd, &other.most).simd_lt(V::all(simd, least));
        let hides = is_nearer & has_corner::<S, N, V>(simd, tiles, &from);
        let hides = if is_corner { hides } else { hides & has_corner::<S, N, V>(simd, tiles, &to) };
        if hides.any_true() {
            return true;
        }
    }
    false
}

/// Returns the lanes whose triangles have a corner at a point.
#[inline(always)]
fn has_corner<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    tiles: &PartPacket<N, 3>,
    point: &Point<N, 3>,
) -> V::Mask {
    let point: [V; 3] = spread(simd, &point.coords);
    let is_at = |corner: usize| {
        let rows: [V; 3] = load(simd, &tiles.corners[corner]);
        rows[0].simd_eq(point[0]) & rows[1].simd_eq(point[1]) & rows[2].simd_eq(point[2])
    };
    is_at(0) | is_at(1) | is_at(2)
}

/// Returns the point of a side nearest to the origin. `share` is the unclamped parameter along
/// `side`.
#[inline(always)]
fn on_side<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    start: &[V; 3],
    side: &[V; 3],
    share: V,
) -> [V; 3] {
    let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
    // A side without length counts as its start.
    let share = share.simd_gt(zero).select(share.smaller(one), zero);
    filled(
        #[inline(always)]
        |axis| start[axis] + side[axis] * share,
    )
}

#[inline(always)]
fn shorter<S: Simd, V: Wide<S>>(first: &[V; 3], second: &[V; 3]) -> [V; 3] {
    either(dot(second, second).simd_lt(dot(first, first)), second, first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::separation::hulls::tests::Random;

    /// Returns a strip of 10 triangles with shared corners around the origin, between two rows of
    /// points; copies of the last triangle fill the packets.
    fn strip<N: Real>(random: &mut Random) -> Vec<PartPacket<N, 3>> {
        let mut points: Vec<Point<N, 3>> = Vec::new();
        for at in 0..12_u32 {
            let [x, z] = [at / 2, at % 2].map(|n| N::lit(f64::from(n) - 2.0));
            let position = Vector::<N, 3>::new(x, N::ZERO, z * N::TWO + N::ONE);
            points.push(Point::from(position + random.vector::<N>() * N::lit(0.3)));
        }
        let mut tiles = vec![PartPacket::blank(), PartPacket::blank()];
        for at in 0..16 {
            let first = at.min(9);
            let corners = [points[first], points[first + 1], points[first + 2]];
            tiles[at / LANES].put(at % LANES, &corners);
        }
        tiles
    }

    fn compare<N: Real>(seed: u64) {
        let (random, mut hidden) = (&mut Random(seed), 0);
        for _ in 0..300 {
            let tiles = strip::<N>(random);
            let center = random.vector::<N>() * N::HALF;
            let (radius, limit) = (N::ONE, N::lit(0.1));
            let half_extents = Vector::<N, 3>::repeat(N::lit(1.2));
            let within = Aabb::around(Point::from(center), half_extents);
            let question = BallQuestion { tiles: &tiles, count: 10, center, radius, limit, within };
            let expected = candidate_triangles(&question, true);
            for level in Level::available() {
                let found = at(level, &question, true);
                assert_eq!(found.masks, expected.masks, "{level:?}");
                assert_eq!(found.from_middle, expected.from_middle, "{level:?}");
                assert_eq!(found.hidden_from, expected.hidden_from, "{level:?}");
            }
            let found = candidate_triangles(&question, false);
            for ((_, [all, without]), (_, [same, with])) in found.masks.iter().zip(&expected.masks)
            {
                assert_eq!((all, *without), (same, 0), "without seams none is hidden");
                hidden += with.count_ones();
            }
        }
        assert!(hidden > 300, "{hidden} are hidden");
    }

    #[test]
    fn projections_from_balls_do_not_depend_on_vectors() {
        compare::<f32>(21);
        compare::<f64>(22);
    }
}
