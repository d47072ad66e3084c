//! Supporting features of 3D solids as rings of corners, in the frames of the solids.
//!
//! The features equal those of [`SupportMap::core_feature`], which is also called for the kinds
//! that have no function here. Only the corners of round caps are chosen differently
//! ([`contact_feature`]). A ring is a list of blocks, each a `FaceRing` of up to 8 corners. Most
//! rings have one block; a round cap may need two, and a hull face with more than 8 corners needs
//! one for each 8.

use smallvec::SmallVec;

use super::SLACK;
use super::ring::LANES;
use crate::collide::separation::bare;
use crate::math::{Point, Real, Vector, max};
use crate::shape::{
    ConvexPolyhedron, Cuboid, FaceRing, Feature, FeatureId, Geometry, Kind, RoundPart, Segment,
    SupportMap, Triangle,
};

/// Corners of a feature, 8 per block; the first block holds the id and normal of the feature.
pub(super) type FaceBlocks<N> = SmallVec<[FaceRing<N>; 2]>;

/// Fills a blank ring with the supporting feature of a solid's core in `direction`, in the frame of
/// the solid. Returns the radius of the solid's surface around the core.
pub(super) fn supporting_feature<N: Real>(
    kind: Kind<'_, N, 3>,
    direction: &Vector<N, 3>,
    faces: &mut FaceBlocks<N>,
) -> N {
    let ((kind, radius), face) = (bare(kind), &mut faces[0]);
    let is_filled = match kind {
        Kind::Segment(segment) => fill_segment(segment, face),
        Kind::Capsule(capsule) => fill_segment(capsule.segment(), face),
        Kind::Cuboid(_) | Kind::Polytope(_) => {
            supporting_part(kind, direction).is_some_and(|part| fill_part(kind, part, face))
        }
        Kind::Triangle(triangle) => fill_triangle(triangle, direction, face),
        Kind::Cylinder(cylinder, _) => fill_round(cylinder.supporting_part(direction), face),
        Kind::Cone(cone, _) => fill_round(cone.supporting_part(direction), face),
        _ => false,
    };
    let map = Geometry(kind).as_support_map();
    if let Some(map) = map.filter(|_| !is_filled) {
        fill_feature(map, direction, faces);
    }
    radius + map.map_or(N::ZERO, SupportMap::rounding)
}

fn fill_point<N: Real>(id: FeatureId, point: &Point<N, 3>, face: &mut FaceRing<N>) -> bool {
    face.id = id;
    face.push(point, [id; 2]);
    true
}

/// Fills a blank ring with a segment; `id` becomes the id of the segment and of its side.
fn fill_ends<N: Real>(
    id: FeatureId,
    ends: [(FeatureId, Point<N, 3>); 2],
    face: &mut FaceRing<N>,
) -> bool {
    face.id = id;
    for (end, point) in &ends {
        face.push(point, [*end, id]);
    }
    true
}

fn fill_segment<N: Real>(segment: &Segment<N, 3>, face: &mut FaceRing<N>) -> bool {
    let ends = [(FeatureId::Vertex(0), *segment.a()), (FeatureId::Vertex(1), *segment.b())];
    fill_ends(FeatureId::Edge(0), ends, face)
}

/// Returns the id of the supporting feature of a box or hull in a direction. `None` for other
/// kinds, and for a box with a zero half extent, some of whose parts coincide.
pub(super) fn supporting_part<N: Real>(
    kind: Kind<'_, N, 3>,
    direction: &Vector<N, 3>,
) -> Option<FeatureId> {
    match kind {
        Kind::Cuboid(cuboid) => {
            let is_flat = cuboid.half_extents().iter().any(|half| *half == N::ZERO);
            (!is_flat).then(|| Cuboid::supporting_part(direction))
        }
        Kind::Polytope(hull) => Some(hull.supporting_part(direction)),
        _ => None,
    }
}

/// Fills a blank ring with a part of a box or hull; returns `false` for a face with more than 8
/// corners, and for other kinds.
pub(super) fn fill_part<N: Real>(
    kind: Kind<'_, N, 3>,
    part: FeatureId,
    face: &mut FaceRing<N>,
) -> bool {
    match (kind, part) {
        (Kind::Cuboid(cuboid), FeatureId::Face(index)) => cuboid.fill_ring(index, face),
        (Kind::Cuboid(cuboid), FeatureId::Edge(_)) => fill_ends(part, cuboid.edge(part), face),
        (Kind::Cuboid(cuboid), FeatureId::Vertex(_)) => {
            fill_point(part, &cuboid.vertex(part), face)
        }
        (Kind::Polytope(hull), FeatureId::Face(index)) => hull.fill_ring(index, face),
        (Kind::Polytope(hull), FeatureId::Edge(_)) => fill_ends(part, hull.edge(part), face),
        (Kind::Polytope(hull), FeatureId::Vertex(_)) => fill_point(part, &hull.vertex(part), face),
        _ => false,
    }
}

/// Fills a ring with the supporting feature of a triangle in a direction. Returns `false`, with the
/// ring unchanged, for thin triangles and where rounding may decide between two features.
fn fill_triangle<N: Real>(
    triangle: &Triangle<N, 3>,
    direction: &Vector<N, 3>,
    face: &mut FaceRing<N>,
) -> bool {
    match triangle.supporting_part(direction) {
        Some(FeatureId::Face(_)) => triangle.fill_ring(direction, face),
        Some(edge @ FeatureId::Edge(_)) => return fill_ends(edge, triangle.edge(edge), face),
        Some(vertex @ FeatureId::Vertex(_)) => {
            return fill_point(vertex, &triangle.vertex(vertex), face);
        }
        None => return false,
    }
    true
}

/// Fills a ring with a point or line of a cylinder or cone. `part` is `None` for a cap; then
/// returns `false`.
fn fill_round<N: Real>(part: Option<RoundPart<N>>, face: &mut FaceRing<N>) -> bool {
    match part {
        Some(RoundPart::Point(id, point)) => fill_point(id, &point, face),
        Some(RoundPart::Line(id, ends)) => fill_ends(id, ends, face),
        None => false,
    }
}

/// Fills `out` with the supporting feature of a core in `direction`, with the corners that contacts
/// use. Returns one additional corner, if needed; it precedes the first corner of `out`.
///
/// The corners of a round cap are fixed on the solid: they are the corners that `core_feature`
/// returns for the cap's own normal. So a solid that vibrates on its cap touches with the same
/// points at any small tilt. The lowest point of the rim is its farthest point along `direction`.
/// If it lies between two of the fixed corners, it is returned as the additional corner. If the
/// tilt is so large that no old corner may stand for the lowest point (`SLACK`), the corners are
/// placed around the lowest point instead: the cap rolls on its rim.
pub(super) fn contact_feature<N: Real, const D: usize>(
    map: &dyn SupportMap<N, D>,
    direction: &Vector<N, D>,
    out: &mut Feature<N, D>,
) -> Option<Point<N, D>> {
    map.core_feature(direction, out);
    let normal = if out.vertices.len() > 2 { map.round_face(direction)? } else { return None };
    // The corners for the cap's own normal: fixed on the solid.
    map.core_feature(&normal, out);
    let lowest = map.core_support(direction);
    let height = |point: &Point<N, D>| point.coords.dot(direction);
    let top = out.vertices.iter().map(height).fold(-N::INFINITY, max);
    // Distance by which the lowest point of the rim lies beyond the farthest corner, along
    // `direction`.
    let (lower, reach) = (height(&lowest) - top, map.reach());
    if lower > N::lit(SLACK) * reach {
        map.core_feature(direction, out);
        return None;
    }
    let is_between = lower > N::lit(4.0) * N::EPSILON * reach;
    is_between.then(|| {
        start_after(&lowest, out);
        lowest
    })
}

/// Rotates the list of corners so that it begins with the corner that follows a point of the rim.
fn start_after<N: Real, const D: usize>(point: &Point<N, D>, out: &mut Feature<N, D>) {
    let count = out.vertices.len();
    let distance = |at: usize| (out.vertices[at] - point).norm();
    let around = |at: usize| distance(at) + distance((at + 1) % count);
    let nearer = |best: usize, at: usize| if around(at) < around(best) { at } else { best };
    let before = (1..count).fold(0, nearer);
    out.vertices.rotate_left((before + 1) % count);
}

/// Fills the rings with the supporting feature of any solid, with the corners of
/// [`contact_feature`]. A feature without corners, as user-defined solids may have, becomes the
/// support point.
fn fill_feature<N: Real>(
    map: &dyn SupportMap<N, 3>,
    direction: &Vector<N, 3>,
    faces: &mut FaceBlocks<N>,
) {
    let mut feature = Feature::default();
    let extra = contact_feature(map, direction, &mut feature);
    if feature.vertices.is_empty() || feature.vertex_ids.is_empty() {
        fill_point(feature.id, &map.core_support(direction), &mut faces[0]);
        return;
    }
    faces[0].id = feature.id;
    faces[0].normal = feature.normal.unwrap_or_else(Vector::<N, 3>::zeros);
    let ids = feature.vertex_ids.iter().enumerate().map(|(at, &id)| {
        let side = feature.side_ids.get(at).copied();
        [id, side.unwrap_or(feature.id)]
    });
    // All corners of a rim have the same ids, so `extra` gets those of the first corner.
    let first = ids.clone().take(extra.iter().count());
    let corners = extra.iter().chain(&feature.vertices);
    for (at, (vertex, ids)) in corners.zip(first.chain(ids)).enumerate() {
        if at / LANES == faces.len() {
            faces.push(FaceRing::blank());
        }
        faces[at / LANES].push(vertex, ids);
    }
}
