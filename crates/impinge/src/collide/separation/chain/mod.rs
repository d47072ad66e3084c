//! The segments of a chain in 2D against one solid, eight side by side.
//!
//! The algorithms of [`polygon_polygon`](super::polygons::polygon_polygon), [`segment_lanes`](super::segments::segment_lanes) and
//! [`ball_segment`](super::balls::ball_segment), in the same order of operations, so that the answers have the same bits:
//! most segments are culled as beyond the limit, the rest computed from what is known then.

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

/// Some segments, and a solid among them.
pub(crate) struct ChainQuestion<'a, N: Real> {
    pub(crate) tiles: &'a [PartPacket<N, 2>],
    /// How many segments there are; what is left of the last tiles counts for nothing.
    pub(crate) count: usize,
    /// Where pairs of a segment and the solid are seen from.
    pub(crate) origin: Vector<N, 2>,
    pub(crate) solid: Kind<'a, N, 2>,
    /// That of the pairs: of the solid in the frame of the segments, but of these in the frame of a ball or
    /// segment, which comes first.
    pub(crate) pose12: Pose<N, 2>,
    /// The solid's middle, in the frame of the segments.
    pub(crate) center: Point<N, 2>,
    /// Separations beyond this are of no interest.
    pub(crate) limit: N,
}

/// What is found of segments.
pub(crate) struct Links<N: Real> {
    /// The least distance from the solid's middle, but for rounding.
    pub(crate) from_middle: N,
    /// Those within the limit, by their number.
    pub(crate) found: SmallVec<[(usize, Separation<N, 2>); 6]>,
}

impl<N: Real> Links<N> {
    /// None, where nothing else is nearer to the solid's middle.
    pub(crate) fn new(from_middle: N) -> Self {
        Self { from_middle, found: SmallVec::new() }
    }
}

/// The separations of segments from a solid; `None` where the usual ways do not lead to one.
pub(crate) fn links<N: Real>(question: &ChainQuestion<'_, N>, links: &mut Links<N>) -> Option<()> {
    links_at(Level::new(), question, links)
}

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
    /// A bit for each segment of some tiles.
    fn lanes_of(&self, block: usize) -> u8 {
        u8::MAX >> (LANES - (self.count - block * LANES).min(LANES))
    }
}

/// Eight segments as seen from the origin of the pairs.
struct EightSegments<V> {
    ends: [[V; 2]; 2],
    /// From the first end to the second, and the square of that.
    side: [V; 2],
    squared: V,
    /// The squared distances from the solid's middle.
    from_middle: V,
}

impl<V> EightSegments<V> {
    /// `None` if a length is no usual number.
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
        let is_usual = squared.simd_gt(V::all(simd, N::MIN_POSITIVE.sqrt()))
            & squared.simd_lt(V::all(simd, N::MAX.sqrt()));
        if !is_usual.all_true() {
            return None;
        }
        let center: [V; 2] = spread(simd, &(question.center.coords - question.origin));
        let offset = minus(&center, &nearest_on_segment(simd, &[a, b], &center).point);
        Some(Self { ends: [a, b], side, squared, from_middle: dot(&offset, &offset) })
    }

    /// The least of the distances from the solid's middle.
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
