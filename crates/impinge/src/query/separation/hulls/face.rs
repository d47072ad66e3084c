//! A face of one solid, and the vertices of the other that lie nearest to it.

use core::cell::Cell;
use core::ops::ControlFlow;

use super::cloud::{Cloud, Heights, Place, highest_over};
use super::pool::{Asked, Pool};
use super::solid::Flat;
use super::{Found, noise};
use crate::math::simd::Simd;
use crate::math::{Point, Real, Vector, Wide, cross, max, min};
use crate::query::separation::segments::nearest_on_segment;

/// A solid in the frame of the one whose face it is about.
pub(super) struct Side<'s, 'a, N: Real> {
    pub(super) solid: &'s Flat<'a, N>,
    pub(super) cloud: &'s Cloud<N>,
    /// Of the vertices, along the normal of the face or, of its own solid, against it.
    pub(super) heights: Heights<N>,
}

impl<'s, 'a, N: Real> Side<'s, 'a, N> {
    #[inline(always)]
    pub(super) fn new<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        solid: &'s Flat<'a, N>,
        cloud: &'s Cloud<N>,
        along: &Vector<N, 3>,
    ) -> Self {
        Self { solid, cloud, heights: cloud.heights::<S, V>(simd, along) }
    }
}

/// The face of all that the other solid lies farthest above, or least deep below.
pub(super) struct Meeting<'s, 'a, N: Real> {
    pub(super) own: Side<'s, 'a, N>,
    pub(super) other: Side<'s, 'a, N>,
    /// Where the frame of the other solid lies.
    pub(super) place: Place<N>,
    pub(super) face: usize,
    pub(super) normal: Vector<N, 3>,
    pub(super) shrink: N,
    /// The edges of each solid that may decide, if that is known.
    pub(super) pool: Option<Pool<N>>,
    /// What edges were asked about, and within what reach.
    pub(super) asked: Cell<Asked<N>>,
}

/// Whether the other solid lies above the face, there where it is lowest.
enum Seen<N: Real> {
    /// Here, up to noise.
    Above(Vector<N, 3>),
    /// Beside it; a length that the distance of the solids, or their depth, does not exceed.
    Beside(N),
}

impl<N: Real> Meeting<'_, '_, N> {
    /// The answer; `None` if it is not proved.
    ///
    /// Edges are looked at twice: first those near the plane, which mostly decide and are few, then all
    /// within reach. No closures: those are not inlined into vector code.
    #[inline(always)]
    pub(super) fn resolve<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> Option<Found<N>> {
        let height = self.height();
        let (above, reaches) = match self.seen(self.lowest::<S, V>(simd)) {
            Seen::Above(point) if height > N::ZERO => return Some(self.at(&point)),
            Seen::Above(point) => (Some(self.at(&point)), [-height; 2]),
            Seen::Beside(reach) if height > N::ZERO => {
                (None, [min(height * N::TWO + N::lit(1.0 / 16.0), reach), reach])
            }
            Seen::Beside(reach) => (None, [-height, max(reach, -height)]),
        };
        for reach in reaches {
            let is_last = reach >= reaches[1];
            if let ControlFlow::Break(found) = self.within::<S, V>(simd, reach, is_last, above) {
                return found;
            }
        }
        None
    }

    /// The answer by edges within a reach, unless more of them may have a better one.
    #[inline(always)]
    fn within<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        reach: N,
        is_last: bool,
        above: Option<Found<N>>,
    ) -> ControlFlow<Option<Found<N>>> {
        let mut are_apart = self.height() > N::ZERO;
        if !are_apart {
            let Some(crossing) = self.crossing::<S, V>(simd, reach) else {
                return if above.is_some() {
                    ControlFlow::Break(above)
                } else if is_last {
                    ControlFlow::Break(self.nearly_above::<S, V>(simd))
                } else {
                    ControlFlow::Continue(())
                };
            };
            let found = self.across::<S, V>(simd, &crossing);
            if let Some(found) = found
                && (is_last || self.is_certain::<S, V>(simd, &found))
            {
                return ControlFlow::Break(Some(found));
            }
            are_apart = found.is_none() && crossing.height > N::ZERO;
        }
        let found = if are_apart { self.nearest::<S, V>(simd, reach) } else { None };
        let is_decided = found.is_some() || is_last;
        if is_decided { ControlFlow::Break(found) } else { ControlFlow::Continue(()) }
    }

    /// Whether an answer across edges is one whatever other edges there are: the solids are apart, or
    /// have a point in common, so that none farther from the plane than the way out along the normal of
    /// the face can be better.
    #[inline(always)]
    fn is_certain<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, found: &Found<N>) -> bool {
        let middle = (found.on_own + found.on_other) * N::HALF;
        found.distance > N::ZERO || self.is_common::<S, V>(simd, &middle)
    }

    /// Whether both solids hold a point, up to noise.
    #[inline(always)]
    fn is_common<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, point: &Vector<N, 3>) -> bool {
        let in_other = self.place.rotation.tr_mul(&(point - self.place.translation));
        let (own, other) = (self.own.solid.planes, self.other.solid.planes);
        highest_over::<S, N, V>(simd, own, self.shrink, point) <= noise()
            && highest_over::<S, N, V>(simd, other, self.shrink, &in_other) <= noise()
    }

    /// How far the other solid lies above the plane of the face.
    pub(super) fn height(&self) -> N {
        self.other.heights.low - self.level()
    }

    /// How far along its normal the face lies.
    pub(super) fn level(&self) -> N {
        self.own.solid.offset(self.face) * self.shrink
    }

    /// The answer with a point of the other solid that lies above the face.
    fn at(&self, point: &Vector<N, 3>) -> Found<N> {
        let distance = self.height();
        let on_own = point - self.normal * distance;
        Found { distance, normal: self.normal, on_own, on_other: *point }
    }

    /// The first of the lowest vertices that lies above the face, or, of edges and faces that are lowest,
    /// some point that does.
    fn seen(&self, lowest: u32) -> Seen<N> {
        let (mut reach, mut rest) = (N::INFINITY, lowest);
        while rest != 0 {
            let point = self.other.cloud.at(rest.trailing_zeros() as usize);
            match self.distance_beside(&point) {
                None => return Seen::Above(point),
                Some(beside) => reach = min(beside, reach),
            }
            rest &= rest - 1;
        }
        let among = if lowest.count_ones() > 1 { self.among(lowest) } else { None };
        among.map_or(Seen::Beside(reach), Seen::Above)
    }

    /// The vertices of the other solid that are lowest, up to noise, as bits.
    #[inline(always)]
    fn lowest<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> u32 {
        self.other.heights.up_to::<S, V>(simd, self.other.heights.low + noise())
    }

    /// The answer where no edges are better than the face by more than noise, though the lowest vertex lies
    /// beside it: the solids are all but flush there, and an edge that is as low but for noise enters what
    /// lies above the face.
    #[inline(always)]
    fn nearly_above<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> Option<Found<N>> {
        let most = self.other.heights.low + N::lit(3.0) * noise();
        let low = self.other.heights.up_to::<S, V>(simd, most);
        let is_low = |vertex: u32| low >> vertex & 1 == 1;
        for edge in self.other.solid.edges {
            let [from, to] = edge.vertices;
            if !is_low(from) && !is_low(to) {
                continue;
            }
            let ends = if is_low(from) { [from, to] } else { [to, from] };
            let [from, to] = ends.map(|vertex| self.other.cloud.at(vertex as usize));
            let Some((share, _)) = self.span([from, to]) else { continue };
            let point = from + (to - from) * share;
            if self.normal.dot(&point) <= most {
                return Some(self.at(&point));
            }
        }
        None
    }

    /// The ends of the sides of the face, and the vectors in its plane into the face across them, as long as
    /// the sides.
    fn sides(&self) -> impl Iterator<Item = ([Vector<N, 3>; 2], Vector<N, 3>)> {
        let ring = self.own.solid.ring(self.face);
        let last = ring[ring.len() - 1];
        let mut from = self.own.cloud.at(last as usize);
        ring.iter().map(move |&vertex| {
            let to = self.own.cloud.at(vertex as usize);
            let ends = [core::mem::replace(&mut from, to), to];
            (ends, cross(&self.normal, &(ends[1] - ends[0])))
        })
    }

    /// The distance from the face of a point that does not lie above it; `None` of one that does, up
    /// to noise.
    fn distance_beside(&self, point: &Vector<N, 3>) -> Option<N> {
        let mut least: Option<N> = None;
        for (ends, inward) in self.sides() {
            let inside = inward.dot(&(point - ends[0]));
            let is_beside = inside < N::ZERO
                && inside * inside > noise::<N>() * noise() * inward.norm_squared();
            if is_beside {
                let nearest = nearest_on_segment(&ends.map(Point::from), &Point::from(*point)).0;
                let squared = (point - nearest.coords).norm_squared();
                least = Some(least.map_or(squared, |least| min(squared, least)));
            }
        }
        least.map(N::sqrt)
    }

    /// A point of the edges between some vertices that lies above the face; or, of the faces between
    /// them, above a corner of the face.
    fn among(&self, lowest: u32) -> Option<Vector<N, 3>> {
        let solid = self.other.solid;
        let is_lowest = |vertex: &u32| lowest >> *vertex & 1 == 1;
        let edges = solid.edges.iter().filter(|edge| edge.vertices.iter().all(is_lowest));
        let mut crossing = edges.filter_map(|edge| {
            self.clipped(edge.vertices.map(|vertex| self.other.cloud.at(vertex as usize)))
        });
        if let Some(point) = crossing.next() {
            return Some(point);
        }
        let corner = self.own.cloud.at(self.own.solid.ring(self.face)[0] as usize);
        let mut faces = (0..solid.faces()).filter(|&face| solid.ring(face).iter().all(is_lowest));
        faces.any(|face| self.is_under(face, &corner)).then(|| corner + self.normal * self.height())
    }

    /// The middle of the part of an edge that lies above the face.
    fn clipped(&self, [a, b]: [Vector<N, 3>; 2]) -> Option<Vector<N, 3>> {
        let (from, to) = self.span([a, b])?;
        Some(a + (b - a) * ((from + to) * N::HALF))
    }

    /// Where the part of an edge that lies above the face begins and ends, as shares of the edge.
    fn span(&self, [a, b]: [Vector<N, 3>; 2]) -> Option<(N, N)> {
        let (mut from, mut to) = (N::ZERO, N::ONE);
        for (ends, inward) in self.sides() {
            let [inside1, inside2] = [a, b].map(|end| inward.dot(&(end - ends[0])));
            if inside1 < N::ZERO && inside2 < N::ZERO {
                return None;
            }
            if (inside1 < N::ZERO) != (inside2 < N::ZERO) {
                let at = inside1 / (inside1 - inside2);
                (from, to) =
                    if inside1 < N::ZERO { (max(at, from), to) } else { (from, min(at, to)) };
            }
        }
        (from <= to).then_some((from, to))
    }

    /// Whether a face of the other solid that lies along the plane lies above a point.
    fn is_under(&self, face: usize, point: &Vector<N, 3>) -> bool {
        let ring = self.other.solid.ring(face);
        let at = |place: usize| self.other.cloud.at(ring[place % ring.len()] as usize);
        // It faces the other way, so it runs clockwise about the normal.
        (0..ring.len()).all(|place| {
            let (from, to) = (at(place), at(place + 1));
            cross(&self.normal, &(to - from)).dot(&(point - from)) <= N::ZERO
        })
    }
}
