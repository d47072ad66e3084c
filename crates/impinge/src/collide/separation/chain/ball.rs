//! Computes separations of segments of a chain from a ball, 8 segments at a time.

use super::super::balls::ball_segment;
use super::{ChainQuestion, EightSegments, Links};
use crate::collide::Pair;
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{bits, with_lanes};
use crate::math::simd::{Level, Simd};
use crate::math::{Real, Wide, min};
use crate::shape::{Ball, Kind, Segment};

/// Adds the separations of the ball from the segments within the limit to `links`; `None` if a
/// length is close to underflow or overflow.
pub(super) fn links<N: Real>(
    level: Level,
    question: &ChainQuestion<'_, N>,
    ball: &Ball<N>,
    links: &mut Links<N>,
) -> Option<()> {
    for (block, tiles) in question.tiles.iter().enumerate() {
        let (beyond, least) = at(level, tiles, question, ball.radius())?;
        links.from_middle = min(links.from_middle, least);
        let mut within = !beyond & question.lanes_of(block);
        while within != 0 {
            let lane = within.trailing_zeros() as usize;
            within &= within - 1;
            let [a, b, _] = tiles.corners(lane);
            let segment = Segment::of_finite(a - question.origin, b - question.origin);
            let (first, second) = (question.solid, Kind::Segment(&segment));
            let pair = Pair { first, second, pose12: question.pose12 };
            let found = ball_segment::separation(&pair, question.limit);
            links.found.extend(found.map(|found| (block * LANES + lane, found)));
        }
    }
    Some(())
}

/// Returns the bits of the segments beyond the limit, and the smallest distance of the segments
/// from the centre of the ball. `None` if a squared length is close to underflow or overflow.
/// `level` selects the instruction set; the result does not depend on it.
fn at<N: Real>(
    level: Level,
    tiles: &PartPacket<N, 2>,
    question: &ChainQuestion<'_, N>,
    radius: N,
) -> Option<(u8, N)> {
    with_lanes!(level, simd => beyond::<_, N, N::Lanes<_>>(simd, tiles, question, radius))
}

/// Compares distances, bit-identical to those of [`ball_segment`], with the limit; returns the
/// result of [`at`].
#[inline(always)]
fn beyond<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    tiles: &PartPacket<N, 2>,
    question: &ChainQuestion<'_, N>,
    radius: N,
) -> Option<(u8, N)> {
    let packet = EightSegments::<V>::of(simd, tiles, question)?;
    let distance = packet.from_middle.sqrt() - V::all(simd, radius);
    let beyond = distance.simd_gt(V::all(simd, question.limit));
    Some((bits(beyond), packet.least()))
}
