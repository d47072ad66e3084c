//! Computes separations of segments of a chain from a segment or capsule, 8 segments at a time.

use super::super::polygons::polygon_polygon;
use super::super::segments::segment_lanes::SegmentGap;
use super::{ChainQuestion, EightSegments, Links};
use crate::collide::Pair;
use crate::collide::packet::{LANES, PartPacket};
use crate::convex::Separation;
use crate::math::lanes::{LanePose, bits, spread, with_lanes};
use crate::math::simd::{Level, Simd};
use crate::math::{Point, Real, Vector, Wide, min};
use crate::shape::{Kind, Segment};

/// Adds the separations of the segments within the limit from `core`, a segment with a radius, to
/// `links`; `None` if a length in some lane is close to underflow or overflow.
pub(super) fn links<N: Real>(
    level: Level,
    question: &ChainQuestion<'_, N>,
    core: &Segment<N, 2>,
    radius: N,
    links: &mut Links<N>,
) -> Option<()> {
    for (block, tiles) in question.tiles.iter().enumerate() {
        let gaps = with_lanes!(level, simd => {
            SegmentGaps::of::<_, N::Lanes<_>>(simd, tiles, question, core)
        })?;
        links.from_middle = min(links.from_middle, gaps.least);
        let lanes = question.lanes_of(block);
        for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
            let found = match gaps.separation(lane) {
                Some(cores) => Some(cores.rounded(N::ZERO, radius)),
                None => {
                    let [a, b, _] = tiles.corners(lane);
                    alone(question, &Segment::of_finite(a - question.origin, b - question.origin))
                }
            };
            let found = found.filter(|found| found.distance <= question.limit);
            links.found.extend(found.map(|found| (block * LANES + lane, found)));
        }
    }
    Some(())
}

/// Computes the separation of one segment for which [`SegmentGaps`] has no valid lane; `None` above
/// the limit.
#[inline(never)]
fn alone<N: Real>(
    question: &ChainQuestion<'_, N>,
    segment: &Segment<N, 2>,
) -> Option<Separation<N, 2>> {
    let (solid, segment) = (question.solid, Kind::Segment(segment));
    let comes_first = matches!(solid, Kind::Segment(_));
    let (first, second) = if comes_first { (solid, segment) } else { (segment, solid) };
    let pair = Pair { first, second, pose12: question.pose12 };
    polygon_polygon::separation_of_outlines(&pair, question.limit)
}

/// Separations of 8 segments of a chain from a core, one value per lane.
struct SegmentGaps<N> {
    /// Signed distances of the cores.
    gaps: [N; LANES],
    /// Unit normals from the first core of each pair to the second.
    normals: [[N; LANES]; 2],
    /// Nearest points of both cores, in the frame of the first.
    points: [[[N; LANES]; 2]; 2],
    /// Bits of the lanes whose values are valid.
    known: u8,
    /// Smallest distance of the segments from the centre of the solid, up to rounding.
    least: N,
}

impl<N: Real> SegmentGaps<N> {
    /// Computes the gaps of a packet, with the two cores of each pair in canonical order; `None` if
    /// a squared length is close to underflow or overflow.
    #[inline(always)]
    fn of<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        tiles: &PartPacket<N, 2>,
        question: &ChainQuestion<'_, N>,
        core: &Segment<N, 2>,
    ) -> Option<Self> {
        let packet = EightSegments::<V>::of(simd, tiles, question)?;
        let own: [Point<N, 2>; 2] = [*core.a(), *core.b()];
        let found = if let Kind::Segment(_) = question.solid {
            let own: [[V; 2]; 2] = own.map(|end| spread(simd, &end.coords));
            let pose12 = LanePose::of(simd, &question.pose12);
            let chain = [pose12.point(&packet.ends[0]), pose12.point(&packet.ends[1])];
            SegmentGap::of(simd, [&own, &chain])
        } else {
            let own = own.map(|end| spread(simd, &question.pose12.point(&end).coords));
            SegmentGap::of(simd, [&packet.ends, &own])
        };
        let row = [N::ZERO; LANES];
        let mut gaps = Self {
            gaps: row,
            normals: [row; 2],
            points: [[row; 2]; 2],
            known: bits(found.is_known),
            least: packet.least(),
        };
        found.gap.store(&mut gaps.gaps);
        for axis in 0..2 {
            found.normal[axis].store(&mut gaps.normals[axis]);
            found.points[0][axis].store(&mut gaps.points[0][axis]);
            found.points[1][axis].store(&mut gaps.points[1][axis]);
        }
        Some(gaps)
    }

    /// Returns the separation in one lane; `None` where it is not known.
    fn separation(&self, lane: usize) -> Option<Separation<N, 2>> {
        let vector = |rows: &[[N; LANES]; 2]| Vector::<N, 2>::new(rows[0][lane], rows[1][lane]);
        let [point1, point2] = [0, 1].map(|which| Point::from(vector(&self.points[which])));
        let (distance, normal) = (self.gaps[lane], vector(&self.normals));
        let is_known = self.known >> lane & 1 == 1;
        is_known.then_some(Separation { distance, normal, point1, point2 })
    }
}
