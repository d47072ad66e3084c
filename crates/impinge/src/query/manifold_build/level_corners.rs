//! Boxes, hulls, triangles, segments and capsules on a half-space, in one pass over their corners.
//!
//! How deep a corner is follows from how far it is above the lowest one along the normal. Names, order and
//! numbers are those of [facets](super::facet) over a [half-space](super::half_space), which define this and
//! which take over for other kinds and cores hardly longer than rounding.

use smallvec::SmallVec;

use super::facet::{LEAST_COSINE, lifted_by};
use super::frame::{Candidate, ROUNDING_ERRORS};
use super::half_space::BOUNDARY;
use super::overlap::Candidates;
use super::{ManifoldRequest, Pair, RawManifold, choose, tangents3};
use crate::math::lanes::{dot, load, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide, max, min};
use crate::shape::{Capsule, ConvexPolyhedron, Cuboid, FaceRing, FeatureId, Kind, Polytope};
use crate::shape::{Segment, SupportMap, Triangle};

/// How many vertices of a hull are looked at side by side.
const LANES: usize = 8;

/// Builds the manifold of a solid and a half-space; answers whether it did.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let Kind::Plane(plane) = pair.second else { return false };
    let normal = -pair.pose12.vector(plane.normal());
    let ground = Ground { normal, origin: pair.pose12.translation, request };
    match pair.first {
        Kind::Cuboid(cuboid) => ground.settle((cuboid, N::ZERO), out),
        Kind::Polytope(hull) => ground.settle((hull, N::ZERO), out),
        Kind::Triangle(triangle) => ground.settle((triangle, N::ZERO), out),
        Kind::Segment(segment) => ground.settle((segment, N::ZERO), out),
        Kind::Capsule(capsule) => ground.settle((capsule, capsule.radius()), out),
        Kind::Rounded(solid) => match solid.inner().0 {
            Kind::Cuboid(cuboid) => ground.settle((cuboid, solid.swelling()), out),
            _ => false,
        },
        _ => false,
    }
}

/// The half-space as the solid sees it, and what is asked.
struct Ground<'a, N: Real> {
    /// Into the half-space.
    normal: Vector<N, 3>,
    /// A point of the boundary.
    origin: Vector<N, 3>,
    request: &'a ManifoldRequest<N>,
}

/// The point of a core that is farthest along the normal, and what follows from it.
struct Lowest<'a, N: Real> {
    normal: Vector<N, 3>,
    core: Point<N, 3>,
    /// How far along the normal it is.
    height: N,
    /// By which the core is swollen.
    radius: N,
    /// Of the whole solid from the half-space.
    distance: N,
    /// Corners up to this far above it count without turning.
    most: N,
    tolerance: N,
    request: &'a ManifoldRequest<N>,
}

/// A point of the solid's surface that may enter the manifold.
struct Corner<N: Real> {
    id: FeatureId,
    point: Point<N, 3>,
    distance: N,
}

type Corners<N> = SmallVec<[Corner<N>; 8]>;

impl<N: Real> Ground<'_, N> {
    fn settle<C: Cornered<N>>(
        &self,
        (solid, radius): (&C, N),
        out: &mut RawManifold<N, 3>,
    ) -> bool {
        let (prediction, normal) = (self.request.prediction, self.normal);
        let core = solid.core_support(&normal);
        let distance = -normal.dot(&(core.coords - self.origin)) - radius;
        if !(distance <= prediction && distance.is_finite_number()) {
            out.points.clear();
            return true;
        }
        let size = solid.reach() + radius + self.origin.norm();
        let tolerance = N::lit(ROUNDING_ERRORS) * N::EPSILON * size;
        let (height, most) = (normal.dot(&core.coords), prediction - distance + tolerance);
        let request = self.request;
        let lowest = Lowest { normal, core, height, radius, distance, most, tolerance, request };
        let mut corners = Corners::new();
        let is_plain = solid.list(&lowest, &mut corners);
        if is_plain {
            out.normal = normal;
            lowest.keep(&mut corners, out);
        }
        is_plain
    }
}

impl<N: Real> Lowest<'_, N> {
    /// Replaces the points of a manifold by corners, as many as are asked for.
    fn keep(&self, corners: &mut Corners<N>, out: &mut RawManifold<N, 3>) {
        let mut deepest = 0;
        for at in 1..corners.len() {
            deepest = if corners[at].distance < corners[deepest].distance { at } else { deepest };
        }
        corners[deepest].distance = self.distance;
        let limit = self.request.max_points.max(1);
        if corners.len() <= limit && renewed(corners, out) {
            return;
        }
        let mut candidates = Candidates::new();
        let tangents = tangents3(&self.normal);
        for corner in &*corners {
            let arm = corner.point - self.core;
            candidates.push(Candidate {
                point1: corner.point,
                distance: corner.distance,
                flat: Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm)),
                features: [corner.id, BOUNDARY],
                kept_id: None,
            });
        }
        choose(&mut candidates, (self.distance, self.tolerance), limit, out);
    }

    /// Adds a corner that is so far above the lowest one, if it counts: beyond the prediction where turning about the
    /// lowest one brings it as near.
    #[inline(always)]
    fn push(&self, id: FeatureId, point: Point<N, 3>, rise: N, out: &mut Corners<N>) {
        let (prediction, distance) = (self.request.prediction, self.distance + rise);
        if rise <= self.most {
            let distance = min(max(distance, self.distance), prediction);
            out.push(Corner { id, point, distance });
        } else if self.request.sine > N::ZERO {
            let away = point - self.core;
            let arm = (away - self.normal * self.normal.dot(&away)).norm();
            if distance <= prediction + self.request.sine * arm {
                out.push(Corner { id, point, distance });
            }
        }
    }

    /// The lowest point alone.
    fn push_alone(&self, id: FeatureId, out: &mut Corners<N>) {
        self.push(id, self.core + self.normal * self.radius, N::ZERO, out);
    }

    /// Adds the point of the surface below a corner of a part that leans by an angle of a given cosine.
    fn push_lifted(&self, id: FeatureId, core: Point<N, 3>, cosine: N, out: &mut Corners<N>) {
        let away = core - self.core;
        let along = self.normal.dot(&away);
        let room = self.radius - along;
        let away_squared = (away - self.normal * along).norm_squared();
        let lift = lifted_by((self.radius, cosine), (room, self.radius), away_squared);
        self.push(id, core + self.normal * lift, room - lift, out);
    }
}

/// Gives the points of a manifold that are these corners new places; `false` if it had others.
fn renewed<N: Real>(corners: &Corners<N>, out: &mut RawManifold<N, 3>) -> bool {
    if out.points.len() != corners.len() {
        return false;
    }
    let mut found = 0_u64;
    for old in &mut out.points {
        for (at, corner) in corners.iter().enumerate() {
            if [old.feature1, old.feature2] == [corner.id, BOUNDARY] {
                (old.point1, old.distance, old.code) = (corner.point, corner.distance, 0);
                found |= 1 << at;
                break;
            }
        }
    }
    found.count_ones() as usize == corners.len()
}

/// A solid of which a half-space sees corners.
trait Cornered<N: Real>: SupportMap<N, 3> {
    /// Lists the corners in the order of the general builder; `false` if it is not plain which these are.
    fn list(&self, lowest: &Lowest<'_, N>, out: &mut Corners<N>) -> bool;
}

impl<N: Real> Cornered<N> for Cuboid<N, 3> {
    fn list(&self, lowest: &Lowest<'_, N>, out: &mut Corners<N>) -> bool {
        if lowest.radius > N::ZERO {
            return list_rounded(self, lowest, out);
        }
        let half = self.half_extents();
        let (mut support, mut flat) = (0, 0);
        for axis in 0..3 {
            support |= usize::from(lowest.core[axis] >= N::ZERO) << axis;
            flat |= usize::from(half[axis] <= N::ZERO) << axis;
        }
        let twice = |axis: usize| N::TWO * half[axis] * lowest.normal[axis].abs();
        let [x, y, z] = [twice(0), twice(1), twice(2)];
        // By the axes along which a vertex is at the other end.
        let rises = [N::ZERO, x, y, x + y, z, x + z, y + z, x + y + z];
        // Of vertices that coincide, for the box is flat, the one with the least number.
        for (vertex, id) in (0_u32..8).enumerate().filter(|(vertex, _)| vertex & flat == 0) {
            let rise = rises[(vertex ^ support) & !flat];
            let is_far = |axis: usize| vertex >> axis & 1 == 1;
            let toward = |axis: usize| if is_far(axis) { half[axis] } else { -half[axis] };
            let point = Point::<N, 3>::new(toward(0), toward(1), toward(2));
            lowest.push(FeatureId::Vertex(id), point, rise, out);
        }
        true
    }
}

/// The corners of the part that a rounded box shows.
fn list_rounded<N: Real>(
    cuboid: &Cuboid<N, 3>,
    lowest: &Lowest<'_, N>,
    out: &mut Corners<N>,
) -> bool {
    let half = cuboid.half_extents();
    if half.iter().any(|&half| half <= N::lit(64.0) * lowest.tolerance) {
        return false;
    }
    match Cuboid::part_shown(&lowest.normal) {
        FeatureId::Face(face) => {
            let mut ring = FaceRing::blank();
            cuboid.fill_ring(face, &mut ring);
            let cosine = ring.normal.dot(&lowest.normal);
            for at in 0..ring.count {
                lowest.push_lifted(ring.ids[at], ring.corner(at), cosine, out);
            }
        }
        part @ FeatureId::Edge(_) => {
            let ends = cuboid.edge(part);
            let along = ends[1].1 - ends[0].1;
            let across = along - lowest.normal * lowest.normal.dot(&along);
            let cosine = across.norm() / along.norm();
            for (id, end) in ends {
                lowest.push_lifted(id, end, cosine, out);
            }
        }
        vertex @ FeatureId::Vertex(_) => lowest.push_alone(vertex, out),
    }
    true
}

impl<N: Real> Cornered<N> for Triangle<N, 3> {
    fn list(&self, lowest: &Lowest<'_, N>, out: &mut Corners<N>) -> bool {
        let corners = self.corners();
        for (at, id) in (0_u32..3).enumerate() {
            if corners[..at].iter().all(|corner| *corner != corners[at]) {
                let rise = lowest.height - lowest.normal.dot(&corners[at].coords);
                lowest.push(FeatureId::Vertex(id), corners[at], rise, out);
            }
        }
        true
    }
}

impl<N: Real> Cornered<N> for Polytope<N, 3> {
    fn list(&self, lowest: &Lowest<'_, N>, out: &mut Corners<N>) -> bool {
        list_hull(Level::new(), self, lowest, out);
        true
    }
}

/// The vertices of a hull with the vectors of an instruction set; the answer does not depend on it.
fn list_hull<N: Real>(
    level: Level,
    hull: &Polytope<N, 3>,
    lowest: &Lowest<'_, N>,
    out: &mut Corners<N>,
) {
    with_lanes!(level, simd => list_in_lanes::<_, N, N::Lanes<_>>(simd, hull, lowest, out));
}

#[inline(always)]
fn list_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    hull: &Polytope<N, 3>,
    lowest: &Lowest<'_, N>,
    out: &mut Corners<N>,
) {
    let along: [V; 3] = spread(simd, &lowest.normal);
    let most = if lowest.request.sine > N::ZERO { N::INFINITY } else { lowest.most };
    let (height, most) = (V::all(simd, lowest.height), V::all(simd, most));
    let (vertices, mut rises) = (hull.vertices(), [N::ZERO; LANES]);
    let mut first = 0;
    for block in hull.blocks() {
        let rise = height - dot(&load::<_, _, V, 3, LANES>(simd, block), &along);
        let mut near = rise.simd_le(most).to_bitmask();
        rise.store(&mut rises);
        while near != 0 {
            let lane = near.trailing_zeros();
            near &= near - 1;
            // What lies beyond the last vertex is that vertex again.
            if let Some(vertex) = vertices.get((first + lane) as usize) {
                lowest.push(FeatureId::Vertex(first + lane), *vertex, rises[lane as usize], out);
            }
        }
        first += 8;
    }
}

impl<N: Real> Cornered<N> for Segment<N, 3> {
    fn list(&self, lowest: &Lowest<'_, N>, out: &mut Corners<N>) -> bool {
        let ends = [*self.a(), *self.b()];
        let along = ends[1] - ends[0];
        let climb = lowest.normal.dot(&along);
        let across = (along - lowest.normal * climb).norm();
        // One that is seen as a point has no ends.
        if across <= lowest.tolerance * N::HALF {
            lowest.push_alone(FeatureId::Edge(0), out);
            return true;
        }
        if across <= N::lit(8.0) * lowest.tolerance {
            return false;
        }
        let cosine = across / along.norm();
        if cosine < N::lit(LEAST_COSINE) {
            lowest.push_alone(FeatureId::Vertex(u32::from(climb > N::ZERO)), out);
            return true;
        }
        lowest.push_lifted(FeatureId::Vertex(0), ends[0], cosine, out);
        lowest.push_lifted(FeatureId::Vertex(1), ends[1], cosine, out);
        true
    }
}

impl<N: Real> Cornered<N> for Capsule<N, 3> {
    fn list(&self, lowest: &Lowest<'_, N>, out: &mut Corners<N>) -> bool {
        self.segment().list(lowest, out)
    }
}
