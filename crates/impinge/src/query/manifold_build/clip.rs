//! The corners of the common area of two supporting features in space, points, segments or faces of up to eight
//! corners.
//!
//! Both are seen along the normal, and how far inside of all sides of one all corners of the other are is
//! computed in lanes. A corner of the common area is a corner of one inside the other, or a crossing of two
//! sides: both solids are treated alike, and no reference face can flip. A segment has one side, whose line a
//! corner must lie on. A point, and two segments that are not parallel, meet at the nearest points alone.
//! What has short sides, no area or more corners is left to [facets](super::facet), and so are parallel
//! segments.

use super::facet::{Which, lifted_by};
use super::fences::{fence, placed};
use super::frame::{Candidate, Frame};
use super::overlap::Candidates;
use super::ring::{SupportRing, crossing_parts};
use super::triangle_face::along_side;
use super::{Pair, RawManifold, add_witness, choose, names};
use crate::math::lanes::{dot, load, minus, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Pose, Real, Vector, Wide, max, max_component, min};
use crate::shape::{FaceRing, FeatureId};

/// How many corners or sides are side by side.
const LANES: usize = FaceRing::<f32>::MOST;

/// The row of the nearest point in [`ProjectedRing::insides`].
const WITNESS: usize = LANES;

/// Builds the manifold of two solids within the prediction whose nearest points are known; returns whether it
/// did.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 3>,
    frame: &Frame<N, 3>,
    limit: usize,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let (pose, normal) = (&pair.pose12, frame.normal());
    let [mut first, mut second] = [SupportRing::blank(), SupportRing::blank()];
    if !(second.fill(&pair.second, Which::Second, Some(pose), frame)
        && first.fill(&pair.first, Which::First, None, frame))
    {
        return false;
    }
    if first.is_segment() && second.is_segment() {
        let parts = crossing_parts([&first, &second], frame);
        return parts.is_some_and(|parts| settle_alone(parts, frame, out));
    }
    first.settle(Which::First, frame);
    second.settle(Which::Second, frame);
    let rings = [&first, &second];
    if !(first.is_face() || second.is_face()) {
        return settle_alone(rings.map(|ring| ring.id_at_witness(frame)), frame, out);
    }
    let mut both = [ProjectedRing::new(first.ring.count), ProjectedRing::new(second.ring.count)];
    if !project(Level::new(), frame, (rings, &mut both), pose) {
        return false;
    }
    let clip = RingClip { frame, rings, projected: &both };
    if first.is_point() || second.is_point() {
        return settle_alone([clip.id_at_witness(0), clip.id_at_witness(1)], frame, out);
    }
    let mut candidates = Candidates::new();
    clip.corners(&mut candidates);
    clip.crossings(&mut candidates);
    let nearest = frame.witness.distance + frame.tolerance;
    if !candidates.iter().any(|candidate| candidate.distance <= nearest) {
        add_witness(frame, [clip.id_at_witness(0), clip.id_at_witness(1)], &mut candidates);
    }
    out.normal = normal;
    choose(&mut candidates, (frame.witness.distance, frame.tolerance), limit, out);
    true
}

/// The nearest points are all there is; returns true.
fn settle_alone<N: Real>(
    parts: [FeatureId; 2],
    frame: &Frame<N, 3>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    out.normal = frame.normal();
    names::settle_alone(&Candidate::alone(&frame.witness, parts), out);
    true
}

/// A ring as seen along the normal. What is beyond the corners that there are means nothing.
struct ProjectedRing<N: Real> {
    /// Of corners.
    count: usize,
    /// The corners by coordinate, in the frame of the first solid, and as seen along the normal.
    points: [[N; LANES]; 3],
    flats: [[N; LANES]; 2],
    /// For each corner of the other ring, and beside a face for the nearest point, how far inside of the sides
    /// of this one it is.
    insides: [[N; LANES]; LANES + 1],
    /// The same as bits: by more than the tolerance, outside by more.
    within: [u8; LANES + 1],
    beyond: [u8; LANES + 1],
    /// A bit for each side.
    sides: u8,
    /// Of a rounded solid the corner nearest to the other: how far below the supporting plane, and where it is
    /// seen.
    top: (N, Vector<N, 2>),
}

/// Two rings, and where they are seen.
type Projecting<'a, N> = ([&'a SupportRing<N>; 2], &'a mut [ProjectedRing<N>; 2]);

/// [`project_in_lanes`] with the vectors of an instruction set; the numbers do not depend on it.
fn project<N: Real>(
    level: Level,
    frame: &Frame<N, 3>,
    rings: Projecting<'_, N>,
    pose12: &Pose<N, 3>,
) -> bool {
    with_lanes!(level, simd => project_in_lanes::<_, N, N::Lanes<_>>(simd, frame, rings, pose12))
}

/// Fills both; false if a face has no area, or a side without length.
#[inline(always)]
fn project_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    frame: &Frame<N, 3>,
    ([first, second], [one, other]): Projecting<'_, N>,
    pose12: &Pose<N, 3>,
) -> bool {
    let (points1, local2): ([V; 3], [V; 3]) =
        (load(simd, &first.ring.corners), load(simd, &second.ring.corners));
    let points2 = placed(simd, pose12, &local2);
    let (flats1, flats2) = (flat(simd, frame, &points1), flat(simd, frame, &points2));
    one.store(&points1, &flats1);
    other.store(&points2, &flats2);
    if first.radius > N::ZERO {
        one.find_top(Which::First, frame);
    }
    if second.radius > N::ZERO {
        other.find_top(Which::Second, frame);
    }
    one.relate(simd, [&flats1, &flats2], other, frame.tolerance)
        && other.relate(simd, [&flats2, &flats1], one, frame.tolerance)
}

/// Where points are seen along the normal of a frame.
#[inline(always)]
fn flat<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    frame: &Frame<N, 3>,
    points: &[V; 3],
) -> [V; 2] {
    let arms = minus(points, &spread(simd, &frame.witness.point1.coords));
    let [one, other] = frame.tangents();
    [dot(&spread::<S, N, V, 3>(simd, one), &arms), dot(&spread::<S, N, V, 3>(simd, other), &arms)]
}

impl<N: Real> ProjectedRing<N> {
    /// Not yet seen anywhere.
    #[inline]
    fn new(count: usize) -> Self {
        let (row, bits) = ([N::ZERO; LANES], [0; LANES + 1]);
        let sides = match count {
            1 => 0,
            2 => 1,
            _ => u8::MAX >> (LANES - count),
        };
        Self {
            count,
            points: [row; 3],
            flats: [row; 2],
            insides: [row; LANES + 1],
            within: bits,
            beyond: bits,
            sides,
            top: (N::ZERO, Vector::<N, 2>::zeros()),
        }
    }

    #[inline(always)]
    fn store<S: Simd, V: Wide<S, Scalar = N>>(&mut self, points: &[V; 3], flats: &[V; 2]) {
        for (row, values) in self.points.iter_mut().zip(points) {
            values.store(row);
        }
        for (row, values) in self.flats.iter_mut().zip(flats) {
            values.store(row);
        }
    }

    /// Measures how far inside of the sides of this ring the corners of the other one are; false of a face
    /// without area.
    #[inline(always)]
    fn relate<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        [flats, others]: [&[V; 2]; 2],
        other: &Self,
        tolerance: N,
    ) -> bool {
        match self.count {
            1 => {}
            2 => self.measure_segment(simd, others, other.count, tolerance),
            _ => {
                let inward = fence(simd, flats, (&self.flats, self.count), tolerance);
                let Some(inward) = inward else { return false };
                self.measure(simd, (flats, &inward), (&other.flats, other.count), tolerance);
            }
        }
        true
    }

    /// Measures how far to the left of this segment all corners of the other ring are.
    #[inline(always)]
    fn measure_segment<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        others: &[V; 2],
        count: usize,
        tolerance: N,
    ) {
        let (from, along) = (self.flat(0), self.flat(1) - self.flat(0));
        let left = Vector::<N, 2>::new(-along.y, along.x) / along.norm();
        let [x, y] = spread::<S, N, V, 2>(simd, &left);
        let [from_x, from_y] = spread::<S, N, V, 2>(simd, &from);
        let inside = x * (others[0] - from_x) + y * (others[1] - from_y);
        let within = inside.simd_gt(V::all(simd, tolerance)).to_bitmask();
        let beyond = inside.simd_lt(V::all(simd, -tolerance)).to_bitmask();
        let mut row = [N::ZERO; LANES];
        inside.store(&mut row);
        for corner in 0..count {
            self.insides[corner][0] = row[corner];
            self.within[corner] = u8::from(within >> corner & 1 == 1);
            self.beyond[corner] = u8::from(beyond >> corner & 1 == 1);
        }
    }

    /// Measures how far inside of the sides of this face the corners of the other ring and the nearest point are.
    #[inline(always)]
    fn measure<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        (flats, inward): (&[V; 2], &[V; 2]),
        ([xs, ys], count): (&[[N; LANES]; 2], usize),
        tolerance: N,
    ) {
        let (most, least) = (V::all(simd, tolerance), V::all(simd, -tolerance));
        let mut measure = |row: usize, x: N, y: N| {
            let [x, y] = [V::all(simd, x), V::all(simd, y)];
            let inside = inward[0] * (x - flats[0]) + inward[1] * (y - flats[1]);
            inside.store(&mut self.insides[row]);
            [self.within[row], ..] = inside.simd_gt(most).to_bitmask().to_le_bytes();
            [self.beyond[row], ..] = inside.simd_lt(least).to_bitmask().to_le_bytes();
        };
        for corner in 0..count {
            measure(corner, xs[corner], ys[corner]);
        }
        measure(WITNESS, N::ZERO, N::ZERO);
    }

    /// Finds the corner that is nearest to the other solid, the first of equals.
    fn find_top(&mut self, which: Which, frame: &Frame<N, 3>) {
        let below = |corner: usize| which.below_witness(&self.point(corner), frame);
        let (mut best, mut least) = (0, below(0));
        for corner in 1..self.count {
            let other = below(corner);
            if other < least {
                (best, least) = (corner, other);
            }
        }
        self.top = (least, self.flat(best));
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
        (self.within[from] & self.beyond[to] | self.beyond[from] & self.within[to]) & self.sides
    }

    /// The sides whose lines a row lies on; `None` of one outside. A segment has no inside.
    const fn touched(&self, row: usize) -> Option<u8> {
        let is_segment = self.sides == 1;
        let outside =
            if is_segment { self.within[row] | self.beyond[row] } else { self.beyond[row] };
        if outside & self.sides != 0 { None } else { Some(!self.within[row] & self.sides) }
    }
}

/// Two rings of which one is a face.
struct RingClip<'a, N: Real> {
    frame: &'a Frame<N, 3>,
    rings: [&'a SupportRing<N>; 2],
    projected: &'a [ProjectedRing<N>; 2],
}

const fn next<N: Real>(ring: &FaceRing<N>, corner: usize) -> usize {
    if corner + 1 < ring.count { corner + 1 } else { 0 }
}

impl<N: Real> RingClip<'_, N> {
    /// The id of the part of a ring that the nearest point lies on.
    fn id_at_witness(&self, which: usize) -> FeatureId {
        let own = self.rings[which];
        if own.is_face() {
            self.part(which, WITNESS, &Vector::<N, 2>::zeros()).unwrap_or(own.ring.id)
        } else {
            own.id_at_witness(self.frame)
        }
    }

    /// Corners of either ring within the other.
    fn corners(&self, out: &mut Candidates<N, 3>) {
        for (which, own) in self.rings.into_iter().enumerate() {
            let projected = &self.projected[which];
            for (corner, &id) in own.ring.ids.iter().enumerate().take(own.ring.count) {
                let Some(on) = self.part(1 - which, corner, &projected.flat(corner)) else {
                    continue;
                };
                let point = projected.point(corner);
                let under = self.under(1 - which, &point, &projected.flat(corner));
                if which == 0 {
                    self.push([point, under], [id, on], out);
                } else {
                    self.push([under, point], [on, id], out);
                }
            }
        }
    }

    /// The smallest part of a ring that has a place, of which it is known how far inside it is; `None` of a
    /// place outside.
    fn part(&self, which: usize, row: usize, place: &Vector<N, 2>) -> Option<FeatureId> {
        let (own, projected) = (self.rings[which], &self.projected[which]);
        let (ring, mut touched) = (&own.ring, projected.touched(row)?);
        let mut found = None;
        while touched != 0 {
            let from = touched.trailing_zeros() as usize;
            touched &= touched - 1;
            let to = next(ring, from);
            let ids = [ring.ids[from], ring.ids[to], ring.sides[from]];
            let ends = [projected.flat(from), projected.flat(to)];
            found = on_side(ends, ids, place, self.frame.tolerance).or(found);
        }
        if own.is_face() { Some(found.unwrap_or(ring.id)) } else { found }
    }

    /// The point of a ring that is seen at the same place as another one.
    fn under(&self, which: usize, point: &Point<N, 3>, place: &Vector<N, 2>) -> Point<N, 3> {
        let (own, projected) = (self.rings[which], &self.projected[which]);
        if own.is_face() {
            let (normal, lean) = (self.frame.normal(), &own.normal);
            let along = (projected.point(0) - point).dot(lean) / normal.dot(lean);
            return point + normal * along;
        }
        let along = projected.flat(1) - projected.flat(0);
        let share = (place - projected.flat(0)).dot(&along) / along.norm_squared();
        let [from, to] = [projected.point(0), projected.point(1)];
        from + (to - from) * min(max(share, N::ZERO), N::ONE)
    }

    /// Sides that cross well inside both.
    fn crossings(&self, out: &mut Candidates<N, 3>) {
        let (rings, [one, other]) = (self.rings.map(|own| &own.ring), self.projected);
        for side1 in 0..one.sides.count_ones() as usize {
            let next1 = next(rings[0], side1);
            let mut crossed = other.parted(side1, next1);
            while crossed != 0 {
                let side2 = crossed.trailing_zeros() as usize;
                crossed &= crossed - 1;
                let next2 = next(rings[1], side2);
                if one.parted(side2, next2) >> side1 & 1 == 0 {
                    continue;
                }
                let insides1 = [side1, next1].map(|corner| other.insides[corner][side2]);
                let insides2 = [side2, next2].map(|corner| one.insides[corner][side1]);
                let core1 = along_side(&[side1, next1].map(|at| one.point(at)), insides1);
                let core2 = along_side(&[side2, next2].map(|at| other.point(at)), insides2);
                self.push([core1, core2], [rings[0].sides[side1], rings[1].sides[side2]], out);
            }
        }
    }

    /// How far the rounded surface is above a point of the core; see [`super::facet::Facet::lift`].
    fn lift(&self, which: usize, core: &Point<N, 3>) -> N {
        let own = self.rings[which];
        if own.radius <= N::ZERO {
            return N::ZERO;
        }
        let solid = if which == 0 { Which::First } else { Which::Second };
        let (below, (top, at)) = (solid.below_witness(core, self.frame), self.projected[which].top);
        let away = self.frame.flat(core) - at;
        lifted_by((own.radius, own.cosine), (below, top), away.norm_squared())
    }

    /// Adds the points of the surfaces over two points of the cores, once: corners that coincide in both rings
    /// are found from both.
    fn push(
        &self,
        [core1, core2]: [Point<N, 3>; 2],
        features: [FeatureId; 2],
        out: &mut Candidates<N, 3>,
    ) {
        let (normal, lift1) = (self.frame.normal(), self.lift(0, &core1));
        let distance = normal.dot(&(core2 - core1)) - lift1 - self.lift(1, &core2);
        let found = self.frame.candidate(core1 + normal * lift1, distance, features);
        let Some(found) = found else { return };
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
fn on_side<N: Real>(
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
