//! Computes separations of the segments of a chain in 2D from one solid, 8 segments at a time.
//!
//! The kernels run the algorithms of [`polygon_polygon`](super::polygons::polygon_polygon),
//! [`segment_lanes`](super::segments::segment_lanes) and
//! [`ball_segment`](super::balls::ball_segment) in the same order of operations, so results are
//! bit-identical to those of single segments. Segments beyond the limit are culled. For each
//! remaining segment the separation is computed: from a polygon along the axis that the culling
//! test chose, from a segment by the nearest points that the culling test found, and from a ball by
//! the algorithm for one pair.
//!
//! ```text
//!   question.tiles   [0 1 2 3 4 5 6 7] [8 9 . . . . . .]    corners 0 and 1 of each `PartPacket`
//!   links.found      (index, separation) for each segment within the limit:
//!                    index = tile * 8 + lane, below `count`
//! ```
//!
//! Caller: `collide/mesh/chain.rs`, which gathers the tiles.

mod ball;
mod polygon;
mod segment;
#[cfg(test)]
mod tests;

use smallvec::SmallVec;

use super::segments::segment_lanes::nearest_on_segment;
use crate::collide::packet::{LANES, PartPacket};
use crate::convex::Separation;
use crate::math::lanes::{dot, load, minus, spread};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Pose, Real, Vector, Wide};
use crate::shape::Kind;

/// Segments of a chain, and a solid near them.
pub(crate) struct ChainQuestion<'a, N: Real> {
    /// Corners of the segments, 8 per packet, in the frame of the chain.
    pub(crate) tiles: &'a [PartPacket<N, 2>],
    /// Number of segments. Results in later lanes of the last packet are dropped, but these lanes
    /// must hold segments with a length, too.
    pub(crate) count: usize,
    /// Point in the frame of the chain that is subtracted from all corners before a pair is
    /// computed; the frame of the segments has its origin there.
    pub(crate) origin: Vector<N, 2>,
    pub(crate) solid: Kind<'a, N, 2>,
    /// Pose of the second solid of each pair in the frame of the first. If `solid` is a ball or
    /// segment, it is the first of the pair, and this is the pose of the segments' frame. Any other
    /// solid is the second, and this is its pose in the segments' frame.
    pub(crate) pose12: Pose<N, 2>,
    /// Centre of the solid in the frame of the chain.
    pub(crate) center: Point<N, 2>,
    /// Largest distance of interest; larger separations are dropped.
    pub(crate) limit: N,
}

/// Separations found between segments and the solid.
pub(crate) struct Links<N: Real> {
    /// Smallest distance of the segments from the centre of the solid, up to rounding.
    pub(crate) from_middle: N,
    /// Separations within the limit, by index of the segment.
    pub(crate) found: SmallVec<[(usize, Separation<N, 2>); 6]>,
}

impl<N: Real> Links<N> {
    /// Creates an empty list; `from_middle` is the smallest distance known so far.
    pub(crate) fn new(from_middle: N) -> Self {
        Self { from_middle, found: SmallVec::new() }
    }
}

/// Computes the separations of the segments from the solid and adds them to `links`. `None` if the
/// pose is not finite, the solid has no kernel, or some lane has no result; then all segments have
/// to be computed one by one, and `links` may hold some of the separations.
pub(crate) fn links<N: Real>(question: &ChainQuestion<'_, N>, links: &mut Links<N>) -> Option<()> {
    links_at(Level::new(), question, links)
}

/// Runs [`links`] with the instruction set `level`, on which the result does not depend.
fn links_at<N: Real>(
    level: Level,
    question: &ChainQuestion<'_, N>,
    links: &mut Links<N>,
) -> Option<()> {
    if !question.pose12.is_finite() {
        return None;
    }
    match &question.solid {
        Kind::Ball(ball) => ball::links(level, question, ball, links),
        Kind::Segment(core) => segment::links(level, question, core, N::ZERO, links),
        Kind::Capsule(capsule) => {
            segment::links(level, question, capsule.segment(), capsule.radius(), links)
        }
        _ => polygon::links(level, question, links),
    }
}

impl<N: Real> ChainQuestion<'_, N> {
    /// Returns the bits of those lanes of a packet that hold segments.
    fn lanes_of(&self, block: usize) -> u8 {
        u8::MAX >> (LANES - (self.count - block * LANES).min(LANES))
    }
}

/// Eight segments, relative to the origin of the question.
struct EightSegments<V> {
    /// First and second ends.
    ends: [[V; 2]; 2],
    /// Vector from the first end to the second.
    side: [V; 2],
    /// Squared length of `side`.
    squared: V,
    /// Squared distances from the centre of the solid.
    from_middle: V,
}

impl<V> EightSegments<V> {
    /// Loads the segments of a tile; `None` if a squared length is close to underflow or overflow.
    #[inline(always)]
    fn of<S: Simd, N: Real>(
        simd: S,
        tiles: &PartPacket<N, 2>,
        question: &ChainQuestion<'_, N>,
    ) -> Option<Self>
    where
        V: Wide<S, Scalar = N>,
    {
        let origin: [V; 2] = spread(simd, &question.origin);
        let a: [V; 2] = minus(&load(simd, &tiles.corners[0]), &origin);
        let b: [V; 2] = minus(&load(simd, &tiles.corners[1]), &origin);
        let side = minus(&b, &a);
        let squared = dot(&side, &side);
        let is_in_range = squared.simd_gt(V::all(simd, N::MIN_POSITIVE.sqrt()))
            & squared.simd_lt(V::all(simd, N::MAX.sqrt()));
        if !is_in_range.all_true() {
            return None;
        }
        let center: [V; 2] = spread(simd, &(question.center.coords - question.origin));
        let offset = minus(&center, &nearest_on_segment(simd, &[a, b], &center).point);
        Some(Self { ends: [a, b], side, squared, from_middle: dot(&offset, &offset) })
    }

    /// Returns the smallest distance of the segments from the centre of the solid.
    #[inline(always)]
    fn least<S: Simd, N: Real>(&self) -> N
    where
        V: Wide<S, Scalar = N>,
    {
        let mut squares = [N::ZERO; LANES];
        self.from_middle.store(&mut squares);
        let [a, b, c, d, e, f, g, h] = squares;
        let least = |x: N, y: N| if x < y { x } else { y };
        least(least(least(a, e), least(c, g)), least(least(b, f), least(d, h))).sqrt()
    }
}
