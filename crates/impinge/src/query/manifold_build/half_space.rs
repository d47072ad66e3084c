//! A solid against a half-space, whose face has no end.
//!
//! Every vertex of a polytope counts, not only those of the face that faces the half-space: where no
//! face is parallel to it, the near vertices need not belong to one face.

use super::facet::Facet;
use super::frame::Frame;
use super::overlap::Candidates;
use crate::math::{Point, Real, Vector};
use crate::shape::{Cuboid, FeatureId, Kind};

/// The only feature of a half-space.
pub(super) const BOUNDARY: FeatureId = FeatureId::Face(0);

/// Adds the points of the first solid, of which the facet is given, above the boundary of the second.
///
/// None of a point: its witness says all.
pub(super) fn candidates<N: Real, const D: usize>(
    kind: Kind<'_, N, D>,
    facet: &Facet<N, D>,
    frame: &Frame<N, D>,
    out: &mut Candidates<N, D>,
) {
    let most = frame.most();
    let mut push = |id: FeatureId, point: Point<N, D>| {
        let distance = frame.witness.distance - frame.height(&point);
        if distance > most {
            return;
        }
        if let Some(found) = frame.candidate(point, distance, [id, BOUNDARY]) {
            out.push(found);
        }
    };
    match kind {
        Kind::Cuboid(cuboid) => cuboid_vertices(cuboid).for_each(|(id, point)| push(id, point)),
        Kind::Polytope(polytope) => {
            (0_u32..).zip(polytope.vertices()).for_each(|(i, v)| push(FeatureId::Vertex(i), *v));
        }
        Kind::Triangle(triangle) => {
            let corners = triangle.corners();
            let is_first = |i: usize| corners[..i].iter().all(|corner| *corner != corners[i]);
            let named = (0_u32..).zip(corners).filter(|&(i, _)| is_first(i as usize));
            named.for_each(|(i, v)| push(FeatureId::Vertex(i), *v));
        }
        _ => facet_corners(facet, frame, &mut push),
    }
}

/// The corners of the part that faces the half-space, on the rounded surface.
fn facet_corners<N: Real, const D: usize>(
    facet: &Facet<N, D>,
    frame: &Frame<N, D>,
    push: &mut impl FnMut(FeatureId, Point<N, D>),
) {
    for corner in facet.corners.iter().filter(|_| !facet.is_point()) {
        let lift = facet.lift(&corner.point, frame);
        push(corner.id, corner.point + frame.normal() * lift);
    }
}

/// The vertices of a box and their names, as documented there; of vertices that coincide, for the
/// box is flat, the one with the least number.
fn cuboid_vertices<N: Real, const D: usize>(
    cuboid: &Cuboid<N, D>,
) -> impl Iterator<Item = (FeatureId, Point<N, D>)> {
    let half_extents = cuboid.half_extents();
    let has = |corner: u32, axis: usize| corner >> axis & 1 == 1;
    let is_first =
        move |&corner: &u32| (0..D).all(|axis| !has(corner, axis) || half_extents[axis] > N::ZERO);
    (0..1_u32 << D).filter(is_first).map(move |corner| {
        let mut position: Vector<N, D> = *half_extents;
        for axis in (0..D).filter(|&axis| !has(corner, axis)) {
            position[axis] = -position[axis];
        }
        (FeatureId::Vertex(corner), Point::from(position))
    })
}
