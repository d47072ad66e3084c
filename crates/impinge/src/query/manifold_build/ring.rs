//! The supporting feature of a solid in space as a ring of one to eight corners.
//!
//! A point has one corner, a segment two and no normal, a face three or more and its outward normal. Ids are
//! those of [`SupportMap::core_feature`]; a segment bears its own id on its side.

use super::facet::{LEAST_COSINE, Which};
use super::frame::Frame;
use crate::math::{Point, Pose, Real, Vector, cross, max, max_component};
use crate::shape::{
    ConvexPolyhedron, Cuboid, FaceRing, Feature, FeatureId, Geometry, Kind, Polytope, RoundPart,
    Segment, Triangle,
};

/// The supporting feature of a core as seen along the normal of a frame, and the radius around it.
pub(super) struct SupportRing<N: Real> {
    /// In the frame of its own solid.
    pub(super) ring: FaceRing<N>,
    pub(super) radius: N,
    /// Between the normal and that of the face; of a segment between it and the plane of contact.
    pub(super) cosine: N,
    /// The outward normal of a face in the frame of the first solid.
    pub(super) normal: Vector<N, 3>,
    /// The ends of a segment in the frame of the first solid.
    pub(super) ends: [Point<N, 3>; 2],
}

impl<N: Real> SupportRing<N> {
    /// No feature yet.
    #[inline]
    pub(super) fn blank() -> Self {
        let (ring, normal) = (FaceRing::blank(), Vector::<N, 3>::zeros());
        Self { ring, radius: N::ZERO, cosine: N::ONE, normal, ends: [Point::origin(); 2] }
    }

    /// Makes a blank ring the feature of one solid of a pair, which stands at `pose` in the frame of the first;
    /// `None` for the first itself. False of a feature that has more corners or that tilts too much.
    #[inline]
    pub(super) fn fill(
        &mut self,
        kind: &Kind<'_, N, 3>,
        which: Which,
        pose: Option<&Pose<N, 3>>,
        frame: &Frame<N, 3>,
    ) -> bool {
        let outward = which.outward(frame);
        let direction = pose.map_or(outward, |pose| pose.inverse_vector(&outward));
        let Some(radius) = fill(kind, &direction, &mut self.ring) else { return false };
        self.radius = radius;
        if self.is_segment() {
            let corners = [self.ring.corner(0), self.ring.corner(1)];
            self.ends = corners.map(|corner| pose.map_or(corner, |pose| pose.point(&corner)));
        } else if self.is_face() {
            self.normal = pose.map_or(self.ring.normal, |pose| pose.vector(&self.ring.normal));
            self.cosine = self.normal.dot(&outward);
        }
        self.cosine >= N::lit(LEAST_COSINE)
    }

    #[inline]
    pub(super) const fn is_point(&self) -> bool {
        self.ring.count < 2
    }

    #[inline]
    pub(super) const fn is_segment(&self) -> bool {
        self.ring.count == 2
    }

    #[inline]
    pub(super) const fn is_face(&self) -> bool {
        self.ring.count > 2
    }

    /// Makes a segment that is seen as a point, or that tilts too much, the corner that is nearest to the other
    /// solid. One that is seen as a point keeps its id.
    #[inline]
    pub(super) fn settle(&mut self, which: Which, frame: &Frame<N, 3>) {
        if !self.is_segment() {
            return;
        }
        let way = self.ends[1] - self.ends[0];
        let along = frame.flat(&self.ends[1]) - frame.flat(&self.ends[0]);
        self.cosine = along.norm() / way.norm();
        let is_seen_as_point = max_component(&along) <= frame.tolerance;
        if is_seen_as_point || self.cosine < N::lit(LEAST_COSINE) {
            let end = usize::from(which.outward(frame).dot(&way) > N::ZERO);
            let (id, corner) = (self.ring.ids[end], self.ring.corner(end));
            self.ring.count = 0;
            self.ring.push(&corner, [id; 2]);
            self.ring.id = if is_seen_as_point { self.ring.id } else { id };
            self.cosine = N::ONE;
        }
    }

    /// The id of the part of a segment or point that the nearest point, which is seen at zero, lies on.
    pub(super) fn id_at_witness(&self, frame: &Frame<N, 3>) -> FeatureId {
        let near = |end: &Point<N, 3>| frame.flat(end).norm() <= N::TWO * frame.tolerance;
        let end = if self.is_segment() { self.ends.iter().position(near) } else { None };
        end.map_or(self.ring.id, |end| self.ring.ids[end])
    }

    /// The id of the part of a segment that a point on it lies on; `None` if both ends are near.
    fn part_at(&self, point: &Point<N, 3>, noise: N) -> Option<FeatureId> {
        let [from, to] = &self.ends;
        let part = part_at(point, from, &(to - from), noise)?;
        Some(match part {
            FeatureId::Vertex(end) => self.ring.ids[end as usize],
            FeatureId::Edge(_) | FeatureId::Face(_) => self.ring.id,
        })
    }
}

/// The ids of the parts that the nearest points of two segments lie on; `None` of segments that are nearly
/// parallel when seen along the normal, and of those without length.
#[inline]
pub(super) fn crossing_parts<N: Real>(
    [first, second]: [&SupportRing<N>; 2],
    frame: &Frame<N, 3>,
) -> Option<[FeatureId; 2]> {
    let (found, normal) = (&frame.witness, frame.normal());
    let (along1, along2) = (first.ends[1] - first.ends[0], second.ends[1] - second.ends[0]);
    let across = |along: &Vector<N, 3>| along.norm_squared() - normal.dot(along).powi(2);
    // Twice the limit of the facets: which side of it rounding puts a pair on is left to them.
    let least = N::TWO * max(frame.sine, N::lit(16.0) * N::EPSILON);
    let turn = normal.dot(&cross(&along1, &along2));
    if turn * turn <= least * least * across(&along1) * across(&along2) {
        return None;
    }
    let noise = N::TWO * frame.tolerance;
    let core1 = found.point1 - normal * first.radius;
    let core2 = found.point2 + normal * second.radius;
    Some([first.part_at(&core1, noise)?, second.part_at(&core2, noise)?])
}

/// The end that a point of a segment lies at, or the segment; `None` if both ends are that near.
pub(super) fn part_of<N: Real, const D: usize>(
    segment: &Segment<N, D>,
    point: &Point<N, D>,
    noise: N,
) -> Option<FeatureId> {
    part_at(point, segment.a(), &(segment.b() - segment.a()), noise)
}

/// [`part_of`], of a segment given by an end and the way to the other.
fn part_at<N: Real, const D: usize>(
    point: &Point<N, D>,
    from: &Point<N, D>,
    along: &Vector<N, D>,
    noise: N,
) -> Option<FeatureId> {
    let (squared, reached) = (along.norm_squared(), (point - from).dot(along));
    let is_near = |reach: N| reach <= noise * squared.sqrt();
    match (is_near(reached), is_near(squared - reached)) {
        (true, true) => None,
        (true, false) => Some(FeatureId::Vertex(0)),
        (false, true) => Some(FeatureId::Vertex(1)),
        (false, false) => Some(FeatureId::Edge(0)),
    }
}

/// Makes a blank ring the supporting feature of a solid's core, and returns the radius around the core; `None`
/// of more than eight corners, of polygons without a normal and of half-spaces.
fn fill<N: Real>(
    kind: &Kind<'_, N, 3>,
    direction: &Vector<N, 3>,
    ring: &mut FaceRing<N>,
) -> Option<N> {
    let is_filled = match kind {
        Kind::Capsule(capsule) => {
            return fill(&Kind::Segment(capsule.segment()), direction, ring)
                .map(|_| capsule.radius());
        }
        Kind::Rounded(solid) => {
            let inner = fill(&solid.inner().0, direction, ring);
            return inner.map(|radius| radius + solid.swelling());
        }
        Kind::Segment(segment) => {
            let ends = [(FeatureId::Vertex(0), *segment.a()), (FeatureId::Vertex(1), *segment.b())];
            fill_segment(FeatureId::Edge(0), ends, ring)
        }
        Kind::Cuboid(cuboid) => fill_cuboid(cuboid, direction, ring),
        Kind::Polytope(hull) => fill_hull(hull, direction, ring),
        Kind::Triangle(triangle) => fill_triangle(triangle, direction, ring),
        Kind::Cylinder(cylinder, _) => fill_round(cylinder.part_shown(direction), ring),
        Kind::Cone(cone, _) => fill_round(cone.part_shown(direction), ring),
        _ => false,
    };
    if is_filled {
        return Some(N::ZERO);
    }
    let (map, mut feature) = (Geometry(*kind).as_support_map()?, Feature::default());
    map.core_feature(direction, &mut feature);
    fill_feature(&feature, ring).then(|| map.rounding())
}

fn fill_point<N: Real>(id: FeatureId, point: &Point<N, 3>, ring: &mut FaceRing<N>) -> bool {
    ring.id = id;
    ring.push(point, [id; 2]);
    true
}

fn fill_segment<N: Real>(
    id: FeatureId,
    ends: [(FeatureId, Point<N, 3>); 2],
    ring: &mut FaceRing<N>,
) -> bool {
    ring.id = id;
    for (end, point) in &ends {
        ring.push(point, [*end, id]);
    }
    true
}

/// False of a flat box, some of whose parts coincide.
fn fill_cuboid<N: Real>(
    cuboid: &Cuboid<N, 3>,
    direction: &Vector<N, 3>,
    ring: &mut FaceRing<N>,
) -> bool {
    let is_flat = cuboid.half_extents().iter().any(|half| *half == N::ZERO);
    !is_flat
        && match Cuboid::part_shown(direction) {
            FeatureId::Face(face) => cuboid.fill_ring(face, ring),
            edge @ FeatureId::Edge(_) => fill_segment(edge, cuboid.edge(edge), ring),
            vertex @ FeatureId::Vertex(_) => fill_point(vertex, &cuboid.vertex(vertex), ring),
        }
}

fn fill_hull<N: Real>(
    hull: &Polytope<N, 3>,
    direction: &Vector<N, 3>,
    ring: &mut FaceRing<N>,
) -> bool {
    match hull.part_shown(direction) {
        FeatureId::Face(face) => hull.fill_ring(face, ring),
        edge @ FeatureId::Edge(_) => fill_segment(edge, hull.edge(edge), ring),
        vertex @ FeatureId::Vertex(_) => fill_point(vertex, &hull.vertex(vertex), ring),
    }
}

/// False of thin triangles, and where rounding decides what faces the direction.
fn fill_triangle<N: Real>(
    triangle: &Triangle<N, 3>,
    direction: &Vector<N, 3>,
    ring: &mut FaceRing<N>,
) -> bool {
    match triangle.part_shown(direction) {
        Some(edge @ FeatureId::Edge(_)) => fill_segment(edge, triangle.edge(edge), ring),
        Some(vertex @ FeatureId::Vertex(_)) => fill_point(vertex, &triangle.vertex(vertex), ring),
        Some(FeatureId::Face(_)) => match triangle.face_ring(direction) {
            Some(face) => {
                *ring = face;
                true
            }
            None => false,
        },
        None => false,
    }
}

/// False of a cap.
fn fill_round<N: Real>(part: Option<RoundPart<N>>, ring: &mut FaceRing<N>) -> bool {
    match part {
        Some(RoundPart::Point(id, point)) => fill_point(id, &point, ring),
        Some(RoundPart::Line(id, ends)) => fill_segment(id, ends, ring),
        None => false,
    }
}

/// Any feature of at most eight corners; a polygon needs a normal.
fn fill_feature<N: Real>(feature: &Feature<N, 3>, ring: &mut FaceRing<N>) -> bool {
    let count = feature.vertices.len();
    let is_small = (1..=FaceRing::<N>::MOST).contains(&count);
    if !is_small || count > 2 && feature.normal.is_none() {
        return false;
    }
    ring.id = feature.id;
    ring.normal = feature.normal.unwrap_or_else(Vector::<N, 3>::zeros);
    for (at, (vertex, &id)) in feature.vertices.iter().zip(&feature.vertex_ids).enumerate() {
        let side = if count > 2 { feature.side_ids.get(at).copied() } else { None };
        ring.push(vertex, [id, side.unwrap_or(feature.id)]);
    }
    true
}
