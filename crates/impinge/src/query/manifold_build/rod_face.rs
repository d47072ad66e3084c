//! Segments and capsules against boxes, hulls, triangles, cylinders and cones: the ends of what they share, in one go.
//!
//! Seen along the normal the core is a point or a segment, and the other solid shows a face of few corners, an
//! edge or a vertex. Over a face those ends of the core count that are inside of all sides, and the places
//! where the core leaves the face, all found side by side; everything else is the nearest points alone. Names,
//! order and distances are those of [facets](super::facet) and their [overlap](super::overlap), which define
//! this and which take over where this declines: short sides, corners on the line of the core, edges along it.

use super::faces::{flat, on_side, shown};
use super::facet::{LEAST_COSINE, lifted_by};
use super::fences::{LANES, fence, placed};
use super::frame::{Candidate, Frame};
use super::overlap::Candidates;
use super::segments::{core, part_at};
use super::{ManifoldRequest, Pair, RawManifold, choose, names};
use crate::math::lanes::{load, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Pose, Real, Vector, Wide, cross2, max, max_component};
use crate::query::separation::bare;
use crate::shape::{ConvexPolyhedron, FaceRing, FeatureId, Kind, RoundPart};

/// Builds the manifold of a segment or capsule, the first of a pair, whose nearest points to the other solid
/// are known; answers whether it did.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 3>,
    frame: &Frame<N, 3>,
    (request, limit): (&ManifoldRequest<N>, usize),
    out: &mut RawManifold<N, 3>,
) -> bool {
    let distance = frame.witness.distance;
    if !(distance <= request.prediction && distance.is_finite_number()) {
        return false;
    }
    let Some(core) = Core::of(pair.first, frame) else { return false };
    let (bare, radius) = bare(pair.second);
    let toward = pair.pose12.inverse_vector(&-frame.normal());
    let mut ring = FaceRing::blank();
    let part = match bare {
        Kind::Cylinder(cylinder, _) => cylinder.part_shown(&toward),
        Kind::Cone(cone, _) => cone.part_shown(&toward),
        _ => match shown(&bare, &toward, &mut ring) {
            Ok(_) => return over_face((&core, &ring, radius), &pair.pose12, (frame, limit), out),
            Err(part) => part.and_then(|part| flat_part(&bare, part)),
        },
    };
    part.is_some_and(|part| beside((&core, &part), (pair, radius), frame, out))
}

/// An edge or a vertex as what a round solid might show.
fn flat_part<N: Real>(solid: &Kind<'_, N, 3>, part: FeatureId) -> Option<RoundPart<N>> {
    Some(match (part, solid) {
        (FeatureId::Vertex(_), Kind::Cuboid(cuboid)) => RoundPart::Point(part, cuboid.vertex(part)),
        (FeatureId::Vertex(_), Kind::Polytope(hull)) => RoundPart::Point(part, hull.vertex(part)),
        (FeatureId::Vertex(_), Kind::Triangle(triangle)) => {
            RoundPart::Point(part, triangle.vertex(part))
        }
        (FeatureId::Edge(_), Kind::Triangle(triangle)) => {
            RoundPart::Line(part, triangle.edge(part))
        }
        (FeatureId::Edge(_), Kind::Cuboid(cuboid)) => RoundPart::Line(part, cuboid.edge(part)),
        (FeatureId::Edge(_), Kind::Polytope(hull)) => RoundPart::Line(part, hull.edge(part)),
        _ => return None,
    })
}

/// The core of the first solid as seen along the normal.
struct Core<N: Real> {
    ends: [Point<N, 3>; 2],
    flats: [Vector<N, 2>; 2],
    /// Seen along the normal, and its length so.
    along: Vector<N, 2>,
    length: N,
    radius: N,
    cosine: N,
    /// The name of one that counts as a point.
    point: Option<FeatureId>,
}

impl<N: Real> Core<N> {
    fn of(kind: Kind<'_, N, 3>, frame: &Frame<N, 3>) -> Option<Self> {
        let (segment, radius) = core(kind)?;
        let ends = [*segment.a(), *segment.b()];
        let flats = [frame.flat(&ends[0]), frame.flat(&ends[1])];
        let (along, way) = (flats[1] - flats[0], ends[1] - ends[0]);
        let length = along.norm();
        let cosine = length / way.norm();
        let point = if max_component(&along) <= frame.tolerance {
            Some(FeatureId::Edge(0))
        } else if cosine < N::lit(LEAST_COSINE) {
            let is_second = frame.normal().dot(&way) > N::ZERO;
            Some(FeatureId::Vertex(u32::from(is_second)))
        } else {
            None
        };
        Some(Self { ends, flats, along, length, radius, cosine, point })
    }

    /// The part that the witness lies on.
    fn at_witness(&self, frame: &Frame<N, 3>) -> FeatureId {
        let near = |flat: &Vector<N, 2>| flat.norm() <= N::TWO * frame.tolerance;
        match self.point {
            Some(point) => point,
            None if near(&self.flats[0]) => FeatureId::Vertex(0),
            None if near(&self.flats[1]) => FeatureId::Vertex(1),
            None => FeatureId::Edge(0),
        }
    }
}

/// The one point of a core and a line or a corner, by the names of the parts it is on.
fn beside<N: Real>(
    (core, part): (&Core<N>, &RoundPart<N>),
    (pair, radius): (&Pair<'_, N, 3>, N),
    frame: &Frame<N, 3>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let on = match part {
        RoundPart::Point(id, _) => Some(*id),
        RoundPart::Line(id, ends) => on_line((core, *id, ends), (pair, radius), frame),
    };
    let Some(on) = on else { return false };
    out.normal = frame.normal();
    let parts = [core.at_witness(frame), on];
    names::settle_alone(&Candidate::alone(&frame.witness, parts), out);
    true
}

/// The ends of a line by their names.
type Ends<N> = [(FeatureId, Point<N, 3>); 2];

/// The part of a line that the witness lies on; `None` of one that runs along the core, which share more
/// than a point.
fn on_line<N: Real>(
    (core, part, ends): (&Core<N>, FeatureId, &Ends<N>),
    (pair, radius): (&Pair<'_, N, 3>, N),
    frame: &Frame<N, 3>,
) -> Option<FeatureId> {
    let points = ends.map(|(_, end)| pair.pose12.point(&end));
    let along = frame.flat(&points[1]) - frame.flat(&points[0]);
    let turn = cross2(&core.along, &along);
    // What turning might make parallel, and ends that lie on the other's line but for rounding, are left to the
    // overlap.
    let least = max(N::TWO * frame.sine, N::lit(1.0 / 16.0));
    if core.point.is_none() && turn.abs() <= least * core.length * along.norm() {
        return None;
    }
    let on = frame.witness.point2 + frame.normal() * radius;
    let found = part_at(&on, &points[0], &(points[1] - points[0]), N::TWO * frame.tolerance)?;
    Some(match found {
        FeatureId::Vertex(0) => ends[0].0,
        FeatureId::Vertex(_) => ends[1].0,
        _ => part,
    })
}

/// A face as seen along the normal. What is beyond the corners that there are means nothing.
struct Outline<N> {
    points: [[N; LANES]; 3],
    flats: [[N; LANES]; 2],
    /// How far inside of the sides the witness and the two ends are, and as bits which by more than
    /// rounding, and which outside by more.
    insides: [[N; LANES]; 3],
    within: [u8; 3],
    beyond: [u8; 3],
    /// How far to the left of the core the corners are, and the same as bits.
    hands: [N; LANES],
    left: u8,
    right: u8,
}

fn outline<N: Real>(
    level: Level,
    ring: &FaceRing<N>,
    (frame, pose): (&Frame<N, 3>, &Pose<N, 3>),
    core: &Core<N>,
) -> Option<Outline<N>> {
    with_lanes!(level, simd => laid_out::<_, N, N::Lanes<_>>(simd, ring, (frame, pose), core))
}

/// Lays a face out; `None` of one that is not plain to see as a polygon.
#[inline(always)]
fn laid_out<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    ring: &FaceRing<N>,
    (frame, pose): (&Frame<N, 3>, &Pose<N, 3>),
    core: &Core<N>,
) -> Option<Outline<N>> {
    let points: [V; 3] = placed(simd, pose, &load(simd, &ring.corners));
    let flats = flat(simd, frame, &points);
    let blank = [N::ZERO; LANES];
    let mut outline = Outline {
        points: [blank; 3],
        flats: [blank; 2],
        insides: [blank; 3],
        within: [0; 3],
        beyond: [0; 3],
        hands: blank,
        left: 0,
        right: 0,
    };
    for (row, numbers) in points.iter().zip(&mut outline.points) {
        row.store(numbers);
    }
    flats[0].store(&mut outline.flats[0]);
    flats[1].store(&mut outline.flats[1]);
    let inward = fence(simd, &flats, (&outline.flats, ring.count), frame.tolerance)?;
    let (most, least) = (V::all(simd, frame.tolerance), V::all(simd, -frame.tolerance));
    let places = [Vector::<N, 2>::zeros(), core.flats[0], core.flats[1]];
    for (at, place) in places.iter().enumerate() {
        let [x, y] = spread::<S, N, V, 2>(simd, place);
        let inside = inward[0] * (x - flats[0]) + inward[1] * (y - flats[1]);
        inside.store(&mut outline.insides[at]);
        [outline.within[at], ..] = inside.simd_gt(most).to_bitmask().to_le_bytes();
        [outline.beyond[at], ..] = inside.simd_lt(least).to_bitmask().to_le_bytes();
    }
    if core.point.is_none() {
        let left = Vector::<N, 2>::new(-core.along.y, core.along.x) / core.length;
        let [x, y] = spread::<S, N, V, 2>(simd, &left);
        let [from_x, from_y] = spread::<S, N, V, 2>(simd, &core.flats[0]);
        let hands = x * (flats[0] - from_x) + y * (flats[1] - from_y);
        hands.store(&mut outline.hands);
        [outline.left, ..] = hands.simd_gt(most).to_bitmask().to_le_bytes();
        [outline.right, ..] = hands.simd_lt(least).to_bitmask().to_le_bytes();
    }
    Some(outline)
}

/// The points of a core over a face; answers whether it found them.
fn over_face<N: Real>(
    (core, ring, radius): (&Core<N>, &FaceRing<N>, N),
    pose: &Pose<N, 3>,
    (frame, limit): (&Frame<N, 3>, usize),
    out: &mut RawManifold<N, 3>,
) -> bool {
    let Some(outline) = &outline(Level::new(), ring, (frame, pose), core) else { return false };
    let lean = pose.vector(&ring.normal);
    let over = Over { frame, core, ring, outline, lean, radius };
    let level = frame.witness.distance + frame.tolerance;
    let mut candidates = Candidates::new();
    if core.point.is_none() {
        if (outline.left | outline.right) & over.all() != over.all() {
            return false;
        }
        over.points(&mut candidates);
    }
    out.normal = frame.normal();
    if !candidates.iter().any(|candidate| candidate.distance <= level) {
        let parts = [core.at_witness(frame), over.part(0, &Vector::<N, 2>::zeros())];
        candidates.retain(|candidate| candidate.features != parts);
        candidates.push(Candidate::alone(&frame.witness, parts));
    }
    choose(&mut candidates, (frame.witness.distance, frame.tolerance), limit, out);
    true
}

/// A core and the face that it is seen over.
struct Over<'a, N: Real> {
    frame: &'a Frame<N, 3>,
    core: &'a Core<N>,
    ring: &'a FaceRing<N>,
    outline: &'a Outline<N>,
    /// The normal of the face in the frame of the core.
    lean: Vector<N, 3>,
    /// By which the face is swollen.
    radius: N,
}

impl<N: Real> Over<'_, N> {
    /// A bit for each corner or side.
    const fn all(&self) -> u8 {
        u8::MAX >> (LANES - self.ring.count)
    }

    const fn next(&self, corner: usize) -> usize {
        if corner + 1 < self.ring.count { corner + 1 } else { 0 }
    }

    fn corner(&self, at: usize) -> Point<N, 3> {
        let [x, y, z] = &self.outline.points;
        Point::<N, 3>::new(x[at], y[at], z[at])
    }

    fn flat(&self, at: usize) -> Vector<N, 2> {
        let [x, y] = &self.outline.flats;
        Vector::<N, 2>::new(x[at], y[at])
    }

    /// The smallest part of the face that has a place, of which it is known how far inside it is: the place of
    /// the witness or, from 1, that of an end.
    fn part(&self, which: usize, place: &Vector<N, 2>) -> FeatureId {
        let (within, beyond) = (self.outline.within[which], self.outline.beyond[which]);
        let mut found = None;
        let is_over = beyond & self.all() == 0;
        let mut touched = if is_over { !within & self.all() } else { 0 };
        while touched != 0 {
            let from = touched.trailing_zeros() as usize;
            touched &= touched - 1;
            let to = self.next(from);
            let names = [self.ring.ids[from], self.ring.ids[to], self.ring.sides[from]];
            let ends = [self.flat(from), self.flat(to)];
            found = on_side(ends, names, place, self.frame.tolerance).or(found);
        }
        found.unwrap_or(self.ring.id)
    }

    /// The ends of the core over the face, and where the core crosses its sides.
    fn points(&self, out: &mut Candidates<N, 3>) {
        let (outline, core) = (self.outline, self.core);
        for (end, id) in [FeatureId::Vertex(0), FeatureId::Vertex(1)].into_iter().enumerate() {
            if outline.beyond[end + 1] & self.all() == 0 {
                let (point, normal) = (core.ends[end], self.frame.normal());
                let along = (self.corner(0) - point).dot(&self.lean) / normal.dot(&self.lean);
                let on = self.part(end + 1, &core.flats[end]);
                self.push([point, point + normal * along], [id, on], out);
            }
        }
        let [_, within1, within2] = outline.within;
        let [_, beyond1, beyond2] = outline.beyond;
        let mut crossed = (within1 & beyond2 | beyond1 & within2) & self.all();
        while crossed != 0 {
            let side = crossed.trailing_zeros() as usize;
            crossed &= crossed - 1;
            let next = self.next(side);
            if (outline.left >> side ^ outline.left >> next) & 1 == 0 {
                continue;
            }
            let share = |[from, to]: [N; 2]| from / (from - to);
            let own = share([outline.insides[1][side], outline.insides[2][side]]);
            let other = share([outline.hands[side], outline.hands[next]]);
            let [from, to] = [self.corner(side), self.corner(next)];
            let cores =
                [core.ends[0] + (core.ends[1] - core.ends[0]) * own, from + (to - from) * other];
            self.push(cores, [FeatureId::Edge(0), self.ring.sides[side]], out);
        }
    }

    /// Adds the points of the surfaces at two points of the cores, if they are asked for.
    fn push(
        &self,
        [core1, core2]: [Point<N, 3>; 2],
        features: [FeatureId; 2],
        out: &mut Candidates<N, 3>,
    ) {
        let normal = self.frame.normal();
        let (lift1, lift2) = (self.lift_of_core(&core1), self.lift_of_face(&core2));
        let distance = normal.dot(&(core2 - core1)) - lift1 - lift2;
        if let Some(found) = self.frame.candidate(core1 + normal * lift1, distance, features) {
            out.push(found);
        }
    }

    /// How far the surface of the first solid is above a point of its core.
    fn lift_of_core(&self, point: &Point<N, 3>) -> N {
        let core = self.core;
        if core.radius <= N::ZERO {
            return N::ZERO;
        }
        let rooms = [-self.frame.height(&core.ends[0]), -self.frame.height(&core.ends[1])];
        let low = usize::from(rooms[1] < rooms[0]);
        let away = self.frame.flat(point) - core.flats[low];
        let room = -self.frame.height(point);
        lifted_by((core.radius, core.cosine), (room, rooms[low]), away.norm_squared())
    }

    /// The same of the face, below it.
    fn lift_of_face(&self, point: &Point<N, 3>) -> N {
        if self.radius <= N::ZERO {
            return N::ZERO;
        }
        let room = |point: &Point<N, 3>| self.frame.height(point) - self.frame.witness.distance;
        let (mut low, mut top) = (0, room(&self.corner(0)));
        for at in 1..self.ring.count {
            let other = room(&self.corner(at));
            if other < top {
                (low, top) = (at, other);
            }
        }
        let away = self.frame.flat(point) - self.flat(low);
        let cosine = -self.lean.dot(&self.frame.normal());
        lifted_by((self.radius, cosine), (room(point), top), away.norm_squared())
    }
}
