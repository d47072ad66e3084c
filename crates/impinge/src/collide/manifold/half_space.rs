//! Contacts of a solid and a half-space: the corners of the solid near the boundary, which has no
//! corners of its own.
//!
//! For flat-faced solids every vertex is a candidate, not only those of the supporting feature: if
//! no face is parallel to the boundary, the near vertices need not belong to one face. For other
//! solids the candidates are the corners of the supporting feature, on the rounded surface.

use super::frame::{Candidate, Candidates, ContactFrame, MIN_COSINE, Which, lifted};
use super::raised::Nearer;
use super::supporting::contact_feature;
use super::{Pair, RawManifold, choose_in_frame};
use crate::math::lanes::{dot, load, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide};
use crate::shape::{Cuboid, Feature, FeatureId, Geometry, Kind, Polytope, SupportMap};

/// The only feature of a half-space.
const BOUNDARY: FeatureId = FeatureId::Face(0);

/// Number of vertices of a hull in one block.
const LANES: usize = 8;

/// Builds the manifold of a solid and a half-space, the second solid, within the prediction.
pub(super) fn build<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    frame: &ContactFrame<N, D>,
    limit: usize,
    out: &mut RawManifold<N, D>,
) {
    let mut candidates = Candidates::new();
    let alone = Above { frame }.corners(pair.first, &mut candidates);
    if candidates.is_empty() {
        candidates.push(Candidate::alone(&frame.witness, [alone, BOUNDARY]));
    }
    if candidates.len() > limit {
        drop_raised(frame, &mut candidates);
    }
    choose_in_frame(pair, frame, &mut candidates, limit, out);
}

/// Drops the corners that lie steeply above nearer ones ([`Nearer`]), such as those of the upper
/// side of a plate. Corners whose distance exceeds the smallest by rounding errors stay.
fn drop_raised<N: Real, const D: usize>(
    frame: &ContactFrame<N, D>,
    candidates: &mut Candidates<N, D>,
) {
    let places = candidates.iter().map(|one| (one.flat, one.distance));
    let nearer = Nearer::new(places, frame.witness.distance + frame.tolerance, frame.sine);
    candidates.retain(|one| !nearer.is_below(&one.flat, one.distance));
}

/// A solid above a half-space, in the contact frame. The methods add the corners of the solid as
/// candidates.
struct Above<'a, N: Real, const D: usize> {
    frame: &'a ContactFrame<N, D>,
}

impl<N: Real, const D: usize> Above<'_, N, D> {
    /// Adds the corners that the request admits. Returns the feature of the solid at the nearest
    /// point, which the caller uses if no corner is admitted. For boxes, hulls and triangles it is
    /// a placeholder, because one of their vertices is the nearest point.
    fn corners(&self, kind: Kind<'_, N, D>, out: &mut Candidates<N, D>) -> FeatureId {
        match kind {
            Kind::Cuboid(cuboid) => self.vertices_of_box(cuboid, out),
            Kind::Polytope(hull) => {
                with_lanes!(Level::new(), simd =>
                    self.vertices_in_lanes::<_, N::Lanes<_>>(simd, hull, out));
            }
            Kind::Triangle(triangle) => {
                let corners = triangle.corners();
                for (at, id) in (0_u32..3).enumerate() {
                    // Coinciding corners are added once.
                    if !corners[..at].contains(&corners[at]) {
                        self.push(FeatureId::Vertex(id), corners[at], out);
                    }
                }
            }
            _ => {
                if let Some(map) = Geometry(kind).as_support_map() {
                    return self.feature_corners(map, out);
                }
            }
        }
        BOUNDARY
    }

    /// Adds a corner, if the request admits it.
    fn push(&self, id: FeatureId, point: Point<N, D>, out: &mut Candidates<N, D>) {
        // The boundary is perpendicular to the normal, so heights give distances.
        let distance = self.frame.witness.distance - self.frame.height(&point);
        if distance <= self.frame.most() {
            out.extend(self.frame.candidate(point, distance, [id, BOUNDARY]));
        }
    }

    /// Adds the vertices of a box. Vertices of a flat box coincide in groups; of each group, only
    /// the vertex with the lowest index is added.
    fn vertices_of_box(&self, cuboid: &Cuboid<N, D>, out: &mut Candidates<N, D>) {
        let half = cuboid.half_extents();
        let has = |vertex: u32, axis: usize| vertex >> axis & 1 == 1;
        for vertex in 0..1_u32 << D {
            if (0..D).all(|axis| !has(vertex, axis) || half[axis] > N::ZERO) {
                let toward = |axis: usize| if has(vertex, axis) { half[axis] } else { -half[axis] };
                let point = Point::from(Vector::<N, D>::from_fn(|axis, _| toward(axis)));
                self.push(FeatureId::Vertex(vertex), point, out);
            }
        }
    }

    /// Adds the vertices of a hull. They are tested 8 at a time; those that may be near are tested
    /// again one by one.
    #[inline(always)]
    fn vertices_in_lanes<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        hull: &Polytope<N, D>,
        out: &mut Candidates<N, D>,
    ) {
        let frame = self.frame;
        let along: [V; D] = spread(simd, &frame.normal());
        // The limit is loosened by the tolerance, because `push` computes the distance of each near
        // vertex again, with another rounding error.
        let top = frame.normal().dot(&frame.witness.point1.coords) - frame.tolerance;
        let least = V::all(simd, top + frame.witness.distance - frame.most());
        for (first, block) in (0_u32..).step_by(LANES).zip(hull.blocks()) {
            let heights = dot(&load::<_, _, V, D, LANES>(simd, block), &along);
            let mut near = heights.simd_ge(least).to_bitmask();
            while near != 0 {
                let vertex = first + near.trailing_zeros();
                near &= near - 1;
                // Lanes after the last vertex hold copies of it.
                if let Some(point) = hull.vertices().get(vertex as usize) {
                    self.push(FeatureId::Vertex(vertex), *point, out);
                }
            }
        }
    }

    /// Adds the corners of the core's supporting feature, on the rounded surface. Adds none for a
    /// point, for a segment along the normal, and for a feature tilted by more than 60°. In the
    /// last case, returns the id of the corner nearest to the boundary; else the id of the feature.
    fn feature_corners(&self, map: &dyn SupportMap<N, D>, out: &mut Candidates<N, D>) -> FeatureId {
        let (frame, radius, mut feature) = (self.frame, map.rounding(), Feature::default());
        let extra = contact_feature(map, &frame.normal(), &mut feature);
        // All corners of a rim have the same id, so the additional corner `extra`, which comes
        // first, gets the id of the first vertex.
        let ids = feature.vertex_ids.iter().copied();
        let ids = ids.clone().take(extra.iter().count()).chain(ids);
        let corners = extra.iter().chain(&feature.vertices).zip(ids);
        let below = |core: &Point<N, D>| Which::First.below_witness(core, frame);
        let lower = |best: (_, _), at: (_, _)| if below(at.0) < below(best.0) { at } else { best };
        let Some((top, id)) = corners.clone().reduce(lower) else { return feature.id };
        let Some(cosine) = self.cosine(&feature) else { return feature.id };
        // Written so that NaN counts as tilted.
        let is_flat = cosine >= N::lit(MIN_COSINE);
        if !is_flat {
            return id;
        }
        for (core, id) in corners {
            let away = frame.flat(core) - frame.flat(top);
            let lift = if radius > N::ZERO {
                lifted(radius, cosine, below(core), below(top), away.norm_squared())
            } else {
                N::ZERO
            };
            self.push(id, core + frame.normal() * lift, out);
        }
        feature.id
    }

    /// Returns the cosine of the angle between the normals of the boundary and a face, or between a
    /// segment and the boundary; `None` for a point, and for a segment that projects to a point.
    fn cosine(&self, feature: &Feature<N, D>) -> Option<N> {
        let normal = self.frame.normal();
        match feature.vertices.as_slice() {
            [_] => None,
            [from, to] => {
                let along = to - from;
                let length = (along - normal * normal.dot(&along)).norm();
                (length > self.frame.tolerance).then(|| length / along.norm())
            }
            _ => Some(feature.normal.map_or(N::ZERO, |own| own.dot(&normal))),
        }
    }
}
