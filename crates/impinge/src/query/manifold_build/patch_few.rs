//! Patches of one piece of few points, as most are on rough ground: [`Choosing::fill`] in fixed rows.
//!
//! That is the definition of this, and takes over wherever this declines: points at one place, more on the
//! outline than are asked for, and a deepest point that is none of them.

use smallvec::SmallVec;

use super::super::{PairIds, RawPoint};
use super::patch::{Merging, PatchPoint, Piece, ordering};
use super::patch_outline::{Choosing, ring};
use crate::math::{Real, Space, Vector};

/// Of so many points at most.
const MOST: usize = 8;

/// The points of a piece that the request asks for, as seen along its normal: along the first tangent, then
/// along the second.
struct Row<N: Real> {
    flats: [Vector<N, 2>; MOST],
    points: [usize; MOST],
    count: usize,
}

impl<N: Space<D>, const D: usize> Choosing<'_, N, D> {
    /// Fills the patch of a single piece, whose deepest point is given; answers false, having done nothing,
    /// where that is left to the general way.
    pub(super) fn fill_alone(
        &self,
        (piece, deepest): (&Piece<N, D>, usize),
        (out, ids): (&mut SmallVec<[PatchPoint<N, D>; 4]>, &mut PairIds),
    ) -> bool {
        let Merging { request, points, tolerance, .. } = *self.merging;
        if piece.points.len() == 1 {
            out.push(self.numbered((deepest, points[deepest].distance), (piece, ids)));
            return true;
        }
        if piece.points.len() > MOST {
            return false;
        }
        let tangents = (N::tables().tangents)(&piece.normal);
        let row = Row::new(self.merging, (piece, deepest), &tangents);
        // In the plane two points delimit all there is.
        let is_line = tangents[1] == Vector::<N, D>::zeros();
        let most = request.max_points.max(1);
        let limit = if is_line { most.min(2) } else { most };
        if row.has_copies(N::lit(8.0) * tolerance) {
            return false;
        }
        let (mut outline, mut length) = ([0; 2 * MOST + 2], row.count);
        if length > 2 {
            length = ring((length, |index| row.flats[index as usize]), tolerance, &mut outline);
        } else {
            outline[1] = 1;
        }
        let outline = outline[..length].iter().map(|&index| row.points[index as usize]);
        self.fill_all((piece, deepest), (outline, limit), (out, ids))
    }

    /// Appends all points of an outline in the order of their numbers, if these are no more than a limit and
    /// one of them is as deep as the deepest but for rounding; that one has the distance of the deepest.
    fn fill_all(
        &self,
        (piece, deepest): (&Piece<N, D>, usize),
        (outline, limit): (impl ExactSizeIterator<Item = usize>, usize),
        (out, ids): (&mut SmallVec<[PatchPoint<N, D>; 4]>, &mut PairIds),
    ) -> bool {
        let points = self.merging.points;
        let lowest = points[deepest].distance;
        let (count, mut corners) = (outline.len(), [0; MOST]);
        if count > limit.min(MOST) {
            return false;
        }
        for (corner, index) in corners.iter_mut().zip(outline) {
            *corner = index;
        }
        let corners = &corners[..count];
        let level = lowest + self.merging.tolerance;
        if !corners.iter().any(|&corner| points[corner].distance <= level) {
            return false;
        }
        let nearest = super::deepest_of(count, level, |at| {
            (self.kept[corners[at]].is_some(), points[corners[at]].distance)
        });
        for (at, &corner) in corners.iter().enumerate() {
            let distance = if at == nearest { lowest } else { points[corner].distance };
            let point = self.numbered((corner, distance), (piece, &mut *ids));
            let mut place = out.len();
            out.push(point);
            let out = out.as_mut_slice();
            while place > 0 && out[place - 1].raw.id > point.raw.id {
                out[place] = out[place - 1];
                place -= 1;
            }
            out[place] = point;
        }
        true
    }

    /// A point with its number, or the next one.
    #[inline]
    fn numbered(
        &self,
        (point, distance): (usize, N),
        (piece, ids): (&Piece<N, D>, &mut PairIds),
    ) -> PatchPoint<N, D> {
        let id = self.kept[point].unwrap_or_else(|| ids.next());
        let raw = RawPoint { id, code: 0, distance, ..self.merging.points[point] };
        PatchPoint { raw, parts: piece.parts }
    }
}

impl<N: Real> Row<N> {
    /// Of few points; the deepest is always one of them, also where its coordinates are no numbers.
    #[inline]
    fn new<const D: usize>(
        merging: &Merging<'_, N, D>,
        (piece, deepest): (&Piece<N, D>, usize),
        tangents: &[Vector<N, D>; 2],
    ) -> Self {
        let Merging { request, points, .. } = *merging;
        let origin = points[deepest].point1;
        let zero = Vector::<N, 2>::zeros();
        let mut row = Self { flats: [zero; MOST], points: [deepest; MOST], count: 1 };
        for index in piece.points.clone() {
            if index == deepest {
                continue;
            }
            let arm = points[index].point1 - origin;
            let flat = Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm));
            let is_turning = request.sine > N::ZERO;
            let reach = if is_turning { request.sine * flat.norm() } else { N::ZERO };
            if points[index].distance <= request.prediction + reach {
                row.insert(flat, index);
            }
        }
        row
    }

    /// Puts a point after those that it does not come before.
    #[inline]
    fn insert(&mut self, flat: Vector<N, 2>, point: usize) {
        let mut at = self.count;
        while at > 0 {
            let before = self.flats[at - 1];
            let order = ordering(flat.x, before.x).then_with(|| ordering(flat.y, before.y));
            if order.is_ge() {
                break;
            }
            (self.flats[at], self.points[at]) = (before, self.points[at - 1]);
            at -= 1;
        }
        (self.flats[at], self.points[at]) = (flat, point);
        self.count += 1;
    }

    /// Two points may be at one place: they are that near along the first tangent. Written so that what is no
    /// number may be.
    #[inline]
    fn has_copies(&self, near: N) -> bool {
        let flats = &self.flats[..self.count];
        flats.windows(2).any(|pair| {
            let is_apart = pair[1].x - pair[0].x > near;
            !is_apart
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;
    use crate::math::noise::Noise;
    use crate::query::ManifoldRequest;
    use crate::query::manifold_build::patch::Kept;
    use crate::query::manifold_build::patch_outline::Members;
    use crate::shape::FeatureId;

    /// Some points at one place or on a line, some beyond reach, some with numbers.
    #[test]
    fn few_points_are_outlined_as_many() {
        let (mut noise, mut built) = (Noise(7), [0; MOST + 1]);
        for round in 0..20_000_usize {
            let count = 1 + round % (MOST + 1);
            let points: Vec<_> = (0..count).map(|at| point(&mut noise, at, round)).collect();
            let normal = noise.vector::<f64>(1.0).normalize();
            let pieces = [Piece { normal, parts: [0, 3], points: 0..count }];
            let sine = [0.0, 0.02][round / 9 % 2];
            let request = ManifoldRequest { prediction: 0.1, sine, max_points: 1 + round / 18 % 8 };
            let merging =
                Merging { request: &request, tolerance: 1e-12, pieces: &pieces, points: &points };
            let numbers = (0..count).map(|at| (noise.next() > 0.3).then_some(9 - at as u32));
            let kept: Kept = numbers.collect();
            let choosing = Choosing { merging: &merging, kept: &kept };
            let deepest = merging.deepest_of(&pieces[0]).expect("there are points");
            let (mut quick, mut general) = (SmallVec::new(), SmallVec::new());
            let (mut ids, mut others) = (PairIds::default(), PairIds::default());
            if !choosing.fill_alone((&pieces[0], deepest), (&mut quick, &mut ids)) {
                assert!(quick.is_empty(), "in round {round} nothing is done");
                continue;
            }
            let (members, all) = (&mut Members::new(), core::iter::once(0));
            choosing.fill_from_all((0, deepest), all, members, (&mut general, &mut others));
            assert_eq!(format!("{quick:?}"), format!("{general:?}"), "in round {round}");
            assert_eq!(ids, others, "in round {round}");
            built[quick.len()] += 1;
        }
        assert!(built[1..6].iter().all(|&count| count > 100), "points: {built:?}");
    }

    fn point(noise: &mut Noise, at: usize, round: usize) -> RawPoint<f64, 3> {
        let place = noise.vector::<f64>(1.0);
        let place = match round / 100 % 8 {
            0 => place.map(|x| x.signum()),
            1 => Vector::<f64, 3>::new(place.x, 0.0, 0.0),
            _ => place,
        };
        let name = u32::try_from(at).expect("few points");
        RawPoint {
            point1: Point::from(place),
            distance: 0.1 * noise.next() - if round % 3 == 0 { 0.0 } else { 0.05 },
            feature1: FeatureId::Vertex(name),
            feature2: FeatureId::Face(0),
            id: 0,
            code: 0,
        }
    }
}
