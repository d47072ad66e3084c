//! The nearest point of the surface of a convex polygon or hull: a search over all its features.

use super::SurfacePoint;
use super::segment::{feature_at, nearest};
use crate::math::{Mapped, Point, Real, cross};
use crate::shape::{FeatureId, Polytope, PolytopeFace};

/// Returns the projection of a point inside onto the plane of the nearest face. This is the nearest
/// point of the boundary because the solid is convex. `None` for a point outside.
fn from_inside<N: Real, const D: usize>(
    solid: &Polytope<N, D>,
    point: &Point<N, D>,
) -> Option<SurfacePoint<N, D>> {
    let (face, height) = solid.highest_face(point);
    let is_inside = height <= N::ZERO;
    is_inside.then(|| SurfacePoint {
        point: point - solid.faces()[face as usize].normal * height,
        feature: FeatureId::Face(face),
        is_inside,
    })
}

/// Returns the nearest point of the boundary; for a point outside, the nearest point of all sides.
pub(super) fn surface_point2<N: Real>(
    solid: &Polytope<N, 2>,
    point: &Point<N, 2>,
) -> SurfacePoint<N, 2> {
    if let Some(found) = from_inside(solid, point) {
        return found;
    }
    let mut best = SurfacePoint::on(solid.vertices()[0], FeatureId::Vertex(0));
    for (number, face) in (0_u32..).zip(solid.faces()) {
        if let &[a, b] = solid.face_vertices(face) {
            best = best.nearer(on_line(solid, [a, b], FeatureId::Face(number), point), point);
        }
    }
    best
}

/// Returns the nearest point of the boundary. For a point outside, it is the nearest point of all
/// edges, or a projection onto the plane of a face that lies in the face and is nearer.
pub(super) fn surface_point3<N: Real>(
    solid: &Polytope<N, 3>,
    point: &Point<N, 3>,
) -> SurfacePoint<N, 3> {
    if let Some(found) = from_inside(solid, point) {
        return found;
    }
    let mut best = SurfacePoint::on(solid.vertices()[0], FeatureId::Vertex(0));
    for (number, face) in (0_u32..).zip(solid.faces()) {
        let height = face.height_of(point);
        if height > N::ZERO && falls_into(solid, face, point) {
            let foot = SurfacePoint::on(point - face.normal * height, FeatureId::Face(number));
            best = foot.nearer(best, point);
        }
    }
    for (number, edge) in (0_u32..).zip(solid.edges()) {
        best = best.nearer(on_line(solid, edge.vertices, FeatureId::Edge(number), point), point);
    }
    best
}

fn on_line<N: Real, const D: usize>(
    solid: &Polytope<N, D>,
    ends: [u32; 2],
    between: FeatureId,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let [a, b] = ends.mapped(|end| &solid.vertices()[end as usize]);
    let (found, fraction) = nearest([a, b], point);
    SurfacePoint::on(found, feature_at(fraction, ends, between))
}

/// Returns whether the projection of `point` onto the face's plane lies in the face.
fn falls_into<N: Real>(
    solid: &Polytope<N, 3>,
    face: &PolytopeFace<N, 3>,
    point: &Point<N, 3>,
) -> bool {
    let corners = solid.face_vertices(face);
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).all(|(&from, &to)| {
        let (from, to) = (&solid.vertices()[from as usize], &solid.vertices()[to as usize]);
        cross(&(to - from), &(point - from)).dot(&face.normal) >= N::ZERO
    })
}
