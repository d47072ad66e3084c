//! Boxes, hulls and triangles that show each other whole faces of few corners: the corners of their common area in one
//! go.
//!
//! Such are most contacts of flat solids. Both faces are laid out in lanes, and how far inside of all sides
//! all corners are is found side by side. Names, order and numbers are those of [facets](super::facet) and
//! their [overlap](super::overlap), which are the definition of this, and which take over wherever this
//! declines: parts that are no faces, polygons with short sides, nearest points off the faces.

use super::fences::{fence, placed};
use super::frame::Frame;
use super::overlap::Candidates;
use super::triangle_face::along_side;
use super::{ManifoldRequest, Pair, RawManifold, choose};
use crate::math::lanes::{dot, load, minus, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Pose, Real, Vector, Wide, max_component};
use crate::shape::{Cuboid, FaceRing, FeatureId, Kind};

/// How many corners or sides are side by side.
const LANES: usize = FaceRing::<f32>::MOST;

/// Builds the manifold of two solids whose nearest points are known. If it does not, the parts that they
/// show each other, where these are known then.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 3>,
    frame: &Frame<N, 3>,
    (request, limit): (&ManifoldRequest<N>, usize),
    out: &mut RawManifold<N, 3>,
) -> Result<(), [Option<FeatureId>; 2]> {
    let (distance, normal) = (frame.witness.distance, frame.normal());
    if !(distance <= request.prediction && distance.is_finite_number()) {
        return Err([None; 2]);
    }
    let toward = pair.pose12.inverse_vector(&-normal);
    let [mut first, mut second] = [FaceRing::blank(), FaceRing::blank()];
    let part1 = match shown(&pair.first, &normal, &mut first) {
        Err(None) => return Err([None; 2]),
        other => other,
    };
    let part2 = shown(&pair.second, &toward, &mut second);
    let parts = [part1, part2].map(|part| part.unwrap_or_else(|part| part));
    if part1.is_err() || part2.is_err() {
        return Err(parts);
    }
    let (first, second) = (&first, &second);
    let Some(places) = &Places::of(frame, (first, second), &pair.pose12) else {
        return Err(parts);
    };
    let [lean1, lean2] = [first.normal, pair.pose12.vector(&second.normal)];
    let meeting = Meeting { frame, rings: [first, second], leans: [lean1, lean2], places };
    let mut candidates = Candidates::new();
    meeting.corners(&mut candidates);
    meeting.crossings(&mut candidates);
    let nearest = distance + frame.tolerance;
    if !candidates.iter().any(|candidate| candidate.distance <= nearest) {
        return Err(parts);
    }
    out.normal = normal;
    choose(&mut candidates, (distance, frame.tolerance), limit, out);
    Ok(())
}

/// Makes a blank ring the face that a solid shows to a direction, if that has few corners and an area.
/// Either way gives the name of what it shows, where that is known.
pub(super) fn shown<N: Real>(
    kind: &Kind<'_, N, 3>,
    direction: &Vector<N, 3>,
    ring: &mut FaceRing<N>,
) -> Result<Option<FeatureId>, Option<FeatureId>> {
    let part = match kind {
        Kind::Cuboid(_) => Cuboid::part_shown(direction),
        Kind::Polytope(hull) => hull.part_shown(direction),
        Kind::Triangle(triangle) => {
            if let Some(part @ (FeatureId::Vertex(_) | FeatureId::Edge(_))) =
                triangle.part_shown(direction)
            {
                return Err(Some(part));
            }
            *ring = triangle.face_ring(direction).ok_or(None)?;
            return Ok(None);
        }
        _ => return Err(None),
    };
    let is_face = match (kind, part) {
        (Kind::Cuboid(cuboid), FeatureId::Face(face)) => cuboid.fill_ring(face, ring),
        (Kind::Polytope(hull), FeatureId::Face(face)) => hull.fill_ring(face, ring),
        _ => false,
    };
    if is_face { Ok(Some(part)) } else { Err(Some(part)) }
}

/// A face as seen along the normal of the manifold. What is beyond the corners that there are means
/// nothing.
struct Outline<N> {
    /// The corners by coordinate, in the frame of the first solid, and as seen along the normal.
    points: [[N; LANES]; 3],
    flats: [[N; LANES]; 2],
    /// For each corner of the other outline how far inside of the sides of this one it is.
    insides: [[N; LANES]; LANES],
    /// The same as bits: by more than the tolerance, outside by more.
    within: [u8; LANES],
    beyond: [u8; LANES],
}

/// Both faces, and how they lie to each other.
struct Places<N>([Outline<N>; 2]);

impl<N: Real> Places<N> {
    /// `None` if a face is not plain to see as a polygon.
    fn of(
        frame: &Frame<N, 3>,
        (first, second): (&FaceRing<N>, &FaceRing<N>),
        pose12: &Pose<N, 3>,
    ) -> Option<Self> {
        at(Level::new(), frame, [first, second], pose12)
    }
}

/// [`laid_out`] with the vectors of an instruction set; the numbers do not depend on it.
fn at<N: Real>(
    level: Level,
    frame: &Frame<N, 3>,
    rings: [&FaceRing<N>; 2],
    pose12: &Pose<N, 3>,
) -> Option<Places<N>> {
    with_lanes!(level, simd => laid_out::<_, N, N::Lanes<_>>(simd, frame, rings, pose12))
}

#[inline(always)]
fn laid_out<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    frame: &Frame<N, 3>,
    [first, second]: [&FaceRing<N>; 2],
    pose12: &Pose<N, 3>,
) -> Option<Places<N>> {
    let (points1, local2): ([V; 3], [V; 3]) =
        (load(simd, &first.corners), load(simd, &second.corners));
    let points2 = placed(simd, pose12, &local2);
    let (flats1, flats2) = (flat(simd, frame, &points1), flat(simd, frame, &points2));
    let mut places = Places([Outline::new(&points1, &flats1), Outline::new(&points2, &flats2)]);
    let [one, other] = &mut places.0;
    let tolerance = frame.tolerance;
    let inward1 = fence(simd, &flats1, (&one.flats, first.count), tolerance)?;
    let inward2 = fence(simd, &flats2, (&other.flats, second.count), tolerance)?;
    one.hold(simd, (&flats1, &inward1), (&other.flats, second.count), tolerance);
    other.hold(simd, (&flats2, &inward2), (&one.flats, first.count), tolerance);
    Some(places)
}

/// Where points are seen along the normal of a frame.
#[inline(always)]
pub(super) fn flat<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    frame: &Frame<N, 3>,
    points: &[V; 3],
) -> [V; 2] {
    let arms = minus(points, &spread(simd, &frame.witness.point1.coords));
    let [one, other] = frame.tangents();
    [dot(&spread::<S, N, V, 3>(simd, one), &arms), dot(&spread::<S, N, V, 3>(simd, other), &arms)]
}

impl<N: Real> Outline<N> {
    #[inline(always)]
    fn new<S: Simd, V: Wide<S, Scalar = N>>(points: &[V; 3], flats: &[V; 2]) -> Self {
        let (row, bits) = ([N::ZERO; LANES], [0; LANES]);
        let insides = [row; LANES];
        let mut outline =
            Self { points: [row; 3], flats: [row; 2], insides, within: bits, beyond: bits };
        for (row, values) in outline.points.iter_mut().zip(points) {
            values.store(row);
        }
        for (row, values) in outline.flats.iter_mut().zip(flats) {
            values.store(row);
        }
        outline
    }

    /// Measures how far inside of the sides of this face the corners of the other one are.
    #[inline(always)]
    fn hold<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        (flats, inward): (&[V; 2], &[V; 2]),
        ([xs, ys], count): (&[[N; LANES]; 2], usize),
        tolerance: N,
    ) {
        let (most, least) = (V::all(simd, tolerance), V::all(simd, -tolerance));
        for corner in 0..count {
            let [x, y] = [V::all(simd, xs[corner]), V::all(simd, ys[corner])];
            let inside = inward[0] * (x - flats[0]) + inward[1] * (y - flats[1]);
            inside.store(&mut self.insides[corner]);
            [self.within[corner], ..] = inside.simd_gt(most).to_bitmask().to_le_bytes();
            [self.beyond[corner], ..] = inside.simd_lt(least).to_bitmask().to_le_bytes();
        }
    }

    fn point(&self, corner: usize) -> Point<N, 3> {
        let [x, y, z] = &self.points;
        Point::<N, 3>::new(x[corner], y[corner], z[corner])
    }

    fn flat(&self, corner: usize) -> Vector<N, 2> {
        let [x, y] = &self.flats;
        Vector::<N, 2>::new(x[corner], y[corner])
    }

    /// The sides between whose lines and a third the corners of the other lie, neither on it.
    const fn parted(&self, from: usize, to: usize) -> u8 {
        self.within[from] & self.beyond[to] | self.beyond[from] & self.within[to]
    }
}

/// The two faces.
struct Meeting<'a, N: Real> {
    frame: &'a Frame<N, 3>,
    rings: [&'a FaceRing<N>; 2],
    /// Their outward normals in the frame of the first solid.
    leans: [Vector<N, 3>; 2],
    places: &'a Places<N>,
}

/// A bit for each corner or side.
const fn all<N: Real>(ring: &FaceRing<N>) -> u8 {
    u8::MAX >> (LANES - ring.count)
}

const fn next<N: Real>(ring: &FaceRing<N>, corner: usize) -> usize {
    if corner + 1 < ring.count { corner + 1 } else { 0 }
}

impl<N: Real> Meeting<'_, N> {
    /// Corners of either face within the other.
    fn corners(&self, out: &mut Candidates<N, 3>) {
        for (which, ring) in self.rings.into_iter().enumerate() {
            let (own, other) = (&self.places.0[which], &self.places.0[1 - which]);
            let sides = all(self.rings[1 - which]);
            for corner in 0..ring.count {
                if other.beyond[corner] & sides != 0 {
                    continue;
                }
                let touched = !other.within[corner] & sides;
                let on = self.part(1 - which, touched, &own.flat(corner));
                let point = own.point(corner);
                let under = self.under(1 - which, &point);
                if which == 0 {
                    self.push([point, under], [ring.ids[corner], on], out);
                } else {
                    self.push([under, point], [on, ring.ids[corner]], out);
                }
            }
        }
    }

    /// The smallest part of a face that has a place inside, which is close to some sides.
    fn part(&self, which: usize, mut touched: u8, place: &Vector<N, 2>) -> FeatureId {
        let (ring, outline) = (self.rings[which], &self.places.0[which]);
        let mut found = None;
        while touched != 0 {
            let from = touched.trailing_zeros() as usize;
            touched &= touched - 1;
            let to = next(ring, from);
            let names = [ring.ids[from], ring.ids[to], ring.sides[from]];
            let ends = [outline.flat(from), outline.flat(to)];
            found = on_side(ends, names, place, self.frame.tolerance).or(found);
        }
        found.unwrap_or(ring.id)
    }

    /// The point of a face that is seen at the same place as another one.
    fn under(&self, which: usize, point: &Point<N, 3>) -> Point<N, 3> {
        let (normal, lean) = (self.frame.normal(), &self.leans[which]);
        let along = (self.places.0[which].point(0) - point).dot(lean) / normal.dot(lean);
        point + normal * along
    }

    /// Sides that cross well inside both.
    fn crossings(&self, out: &mut Candidates<N, 3>) {
        let ([ring1, ring2], [one, other]) = (self.rings, &self.places.0);
        for side1 in 0..ring1.count {
            let next1 = next(ring1, side1);
            let mut crossed = other.parted(side1, next1) & all(ring2);
            while crossed != 0 {
                let side2 = crossed.trailing_zeros() as usize;
                crossed &= crossed - 1;
                let next2 = next(ring2, side2);
                if one.parted(side2, next2) >> side1 & 1 == 0 {
                    continue;
                }
                let insides1 = [side1, next1].map(|corner| other.insides[corner][side2]);
                let insides2 = [side2, next2].map(|corner| one.insides[corner][side1]);
                let core1 = along_side(&[side1, next1].map(|at| one.point(at)), insides1);
                let core2 = along_side(&[side2, next2].map(|at| other.point(at)), insides2);
                self.push([core1, core2], [ring1.sides[side1], ring2.sides[side2]], out);
            }
        }
    }

    /// Adds a pair of points, once: corners that coincide in both faces are found from both.
    fn push(
        &self,
        [core1, core2]: [Point<N, 3>; 2],
        features: [FeatureId; 2],
        out: &mut Candidates<N, 3>,
    ) {
        let distance = self.frame.normal().dot(&(core2 - core1));
        // As a facet adds it that is not rounded: a zero has no sign then.
        let point1 = core1 + self.frame.normal() * N::ZERO;
        let Some(found) = self.frame.candidate(point1, distance, features) else { return };
        let near = N::lit(4.0) * self.frame.tolerance;
        for old in &*out {
            if old.features == found.features {
                let away = old.flat - found.flat;
                if max_component(&away) <= near && away.norm() <= near {
                    return;
                }
            }
        }
        out.push(found);
    }
}

/// The part of a side that contains a place on its line: one of its corners or itself.
pub(super) fn on_side<N: Real>(
    ends: [Vector<N, 2>; 2],
    [from, to, side]: [FeatureId; 3],
    place: &Vector<N, 2>,
    tolerance: N,
) -> Option<FeatureId> {
    let near = |end: &Vector<N, 2>| (end - place).norm() <= N::TWO * tolerance;
    if near(&ends[0]) {
        return Some(from);
    }
    if near(&ends[1]) {
        return Some(to);
    }
    let along = ends[1] - ends[0];
    let (share, length) = ((place - ends[0]).dot(&along), along.norm());
    (share >= N::ZERO && share <= length * length).then_some(side)
}
