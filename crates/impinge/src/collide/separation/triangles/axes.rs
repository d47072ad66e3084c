//! Separating axes of 8 triangles and one convex polyhedron.
//!
//! Two polyhedra overlap iff no normal of a face and no direction perpendicular to an edge of each
//! separates them. If they overlap, the shortest separating translation is along the direction with
//! the least overlap (Gottschalk, Lin and Manocha, "`OBBTree`", 1996). An edge of the solid and a
//! side of the triangle matter only if the edge is the solid's highest along the direction and the
//! side the triangle's lowest. This holds if the side rises above the plane of one face beside the
//! edge and sinks below the plane of the other, and the triangle lies on the outer side (Gregorius,
//! "The Separating Axis Test between Convex Polyhedra", GDC 2013, prunes pairs of edges by their
//! arcs of normals).
//!
//! ```text
//!   feature  0                        the triangle's own normal
//!            1 + face                 a face of the solid, at most 64: `PLANE_BLOCKS` * `LANES`
//!            1024 + 3 * edge + side   an edge of the solid and a side of the triangle
//! ```
//!
//! Lane `i` is triangle `i` of the [`PartPacket`], whose triangles [`super`] has collected from
//! tiles.

use super::{TriangleQuery, rounding_error};
use crate::collide::packet::{LANES, PartPacket};
use crate::collide::separation::hulls::{PLANE_BLOCKS, Polyhedral, THIN};
use crate::math::lanes::{
    bits, cross, dot, either, in_lanes, load, minus, negated, over, rotated_back, spread, times,
};
use crate::math::simd::{Run, Simd, SimdMask};
use crate::math::{Mapped, Matrix, Real, Wide, max, max_component};

/// Sine of the angle below which two edges count as parallel, in units of epsilon.
const PARALLEL: f64 = 16.0;
/// Largest number of faces of a [`Polyhedral`], set by its blocks of planes.
const MAX_FACES: usize = PLANE_BLOCKS * LANES;

/// Direction with the largest gap to the solid, for each of 8 triangles.
pub(super) struct TriangleAxes<N> {
    /// Bits of the triangles that are beyond the limit by more than rounding.
    pub(super) beyond: u8,
    /// Bits of the triangles that are not thin, and whose gaps along `normals` are confirmed by all
    /// vertices.
    pub(super) known: u8,
    /// Unit of length of each pair, a power of two: in this unit neither the triangle, nor the
    /// solid, nor the distance between their origins is larger than 2. `shrink` is 1 / `scale`,
    /// exactly.
    pub(super) scale: [N; LANES],
    pub(super) shrink: [N; LANES],
    /// Corners in the frame of the solid, in units of the pair.
    pub(super) corners: [[[N; LANES]; 3]; 3],
    /// Unit vectors from the triangle to the solid, in the frame of the solid.
    pub(super) normals: [[N; LANES]; 3],
    /// Signed distances along `normals`, in units of each pair.
    pub(super) gaps: [N; LANES],
    /// Feature numbers, decoded by [`AxisFeature`].
    pub(super) features: [N; LANES],
}

/// The feature or the two features that determine a direction, which is perpendicular to them.
pub(super) enum AxisFeature {
    /// The triangle: the direction is one of its two normals.
    Triangle,
    /// A face of the solid, by index.
    Face(usize),
    /// An edge of the solid and a side of the triangle, by index.
    Edges(usize, usize),
}

/// First feature number of each kind.
const TRIANGLE: f64 = 0.0;
const FACES: f64 = 1.0;
const EDGES: f64 = 1024.0;

impl AxisFeature {
    /// Decodes a feature number.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the indices of faces and edges are small and not negative"
    )]
    pub(super) fn of<N: Real>(number: N) -> Self {
        let number = number.as_f64();
        if number >= EDGES {
            let index = (number - EDGES) as usize;
            Self::Edges(index / 3, index % 3)
        } else if number >= FACES {
            Self::Face((number - FACES) as usize)
        } else {
            Self::Triangle
        }
    }
}

/// Returns the length that counts as rounding in a pair with the unit `scale`.
pub(super) fn slack<N: Real>(scale: N) -> N {
    N::lit(16.0) * rounding_error::<N>() * scale
}

impl<N: Real> TriangleQuery<'_, N> {
    /// Computes the axes for the lanes of `run`: all lanes at once with vector instructions, else
    /// one lane.
    pub(super) fn axes(&self, run: Run, tiles: &PartPacket<N, 3>) -> TriangleAxes<N> {
        in_lanes!(run, simd => self.axes_in_lanes::<_, N::Lanes<_>>(simd, tiles))
    }

    /// Chooses the triangle's own normal, unless a face of the solid has a gap larger by more than
    /// rounding, or a pair of edges has a gap larger than both by more than rounding.
    #[inline(always)]
    fn axes_in_lanes<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        tiles: &PartPacket<N, 3>,
    ) -> TriangleAxes<N> {
        let packet = PlacedPacket::<S, N, V>::new(simd, self, tiles);
        let none = packet.shrink.simd_lt(packet.shrink);
        let mut climbs = [[none; 3]; MAX_FACES];
        let of_solid = packet.query_faces(&mut climbs);
        let beyond = packet.is_beyond(of_solid.gap);
        if bits(beyond) == u8::MAX {
            return packet.stored(&of_solid, beyond, none);
        }
        let directions = packet.directions(&self.pose12.rotation);
        let (front, is_wide) = (&directions.front, directions.is_wide);
        let [above, below] = packet.gaps_along(front);
        let is_above = above.simd_gt(below);
        let own = TriangleAxis {
            gap: is_above.select(above, below),
            normal: either(is_above, &negated(front), front),
            feature: V::all(simd, N::lit(TRIANGLE)),
        };
        let is_less = of_solid.gap.simd_gt(own.gap + V::all(simd, rounding_error()));
        let face = own.or(is_less, &of_solid);
        let beyond = beyond | (packet.is_beyond(face.gap) & is_wide);
        let wanted = is_wide & !beyond;
        if wanted.to_bitmask() == 0 {
            return packet.stored(&face, beyond, none);
        }
        let best = packet.query_edges(&climbs, &directions, wanted, face);
        // Other vertices may reduce the gap of a pair with a short edge, which was tested by its
        // two faces only.
        let [_, gap] = packet.gaps_along(&best.normal);
        let known = is_wide & gap.simd_gt(best.gap - V::all(simd, N::lit(4.0) * rounding_error()));
        packet.stored(&best, beyond | (packet.is_beyond(best.gap) & known), known)
    }
}

/// The best directions so far, unit vectors from the triangles to the solid.
#[derive(Clone, Copy)]
struct TriangleAxis<V> {
    /// Signed distance along the direction, in units of the pair.
    gap: V,
    normal: [V; 3],
    feature: V,
}

impl<V> TriangleAxis<V> {
    /// Selects `other` in the lanes of `is_other`, else `self`.
    #[inline(always)]
    fn or<S: Simd>(&self, is_other: V::Mask, other: &Self) -> Self
    where
        V: Wide<S>,
    {
        Self {
            gap: is_other.select(other.gap, self.gap),
            normal: either(is_other, &other.normal, &self.normal),
            feature: is_other.select(other.feature, self.feature),
        }
    }
}

/// Unit vectors along the sides, and unit normals on the side from which the corners run
/// counter-clockwise, in the frame of the solid; `is_wide` has the triangles that are not thin.
struct Directions<V, M> {
    sides: [[V; 3]; 3],
    front: [V; 3],
    is_wide: M,
}

/// Eight triangles in the frame of the solid, and the solid.
struct PlacedPacket<'a, S, N: Real, V> {
    simd: S,
    solid: &'a Polyhedral<'a, N>,
    /// Corners relative to the origin of the query, in the frame of the triangles.
    given: [[V; 3]; 3],
    /// Corners in the frame of the solid, in units of the pairs.
    corners: [[V; 3]; 3],
    /// Unit of each pair and its reciprocal, as rows and as vectors.
    scales: [N; LANES],
    shrinks: [N; LANES],
    scale: V,
    shrink: V,
    /// The limit plus rounding, in the caller's unit of length.
    beyond: V,
}

impl<'a, S: Simd, N: Real, V: Wide<S, Scalar = N>> PlacedPacket<'a, S, N, V> {
    /// Loads a packet, computes the units, and transforms the corners to the frame of the solid.
    #[inline(always)]
    fn new(simd: S, query: &TriangleQuery<'a, N>, tiles: &PartPacket<N, 3>) -> Self {
        let origin: [V; 3] = spread(simd, &query.parts.origin);
        let given = [
            minus(&load(simd, &tiles.corners[0]), &origin),
            minus(&load(simd, &tiles.corners[1]), &origin),
            minus(&load(simd, &tiles.corners[2]), &origin),
        ];
        let own = max(query.solid.reach, max_component(&query.pose12.translation));
        let [scales, shrinks] = units(simd, own, &given);
        let (scale, shrink) = (V::load(simd, &scales), V::load(simd, &shrinks));
        let center: [V; 3] = spread(simd, &query.pose12.translation);
        let mut corners = given;
        for corner in &mut corners {
            let arm = times(&minus(corner, &center), shrink);
            *corner = rotated_back(simd, &query.pose12.rotation, &arm);
        }
        let slack = V::all(simd, slack(N::ONE)) * scale;
        let beyond = V::all(simd, query.limit) + slack;
        Self { simd, solid: query.solid, given, corners, scales, shrinks, scale, shrink, beyond }
    }

    /// Returns the lanes in which a gap proves that the triangle is beyond the limit.
    #[inline(always)]
    fn is_beyond(&self, gap: V) -> V::Mask {
        let has_units = self.shrink.simd_lt(V::all(self.simd, N::INFINITY));
        (gap * self.scale).simd_gt(self.beyond) & has_units
    }

    /// Writes the best directions and the masks to rows.
    #[inline(always)]
    fn stored(&self, best: &TriangleAxis<V>, beyond: V::Mask, known: V::Mask) -> TriangleAxes<N> {
        let blank = [N::ZERO; LANES];
        let mut axes = TriangleAxes {
            beyond: bits(beyond),
            known: bits(known),
            scale: self.scales,
            shrink: self.shrinks,
            corners: [[blank; 3]; 3],
            normals: [blank; 3],
            gaps: blank,
            features: blank,
        };
        for (rows, corner) in axes.corners.iter_mut().zip(&self.corners) {
            for (row, values) in rows.iter_mut().zip(corner) {
                values.store(row);
            }
        }
        for (row, values) in axes.normals.iter_mut().zip(&best.normal) {
            values.store(row);
        }
        best.gap.store(&mut axes.gaps);
        best.feature.store(&mut axes.features);
        axes
    }

    /// Computes the directions from the sides before they are translated, so that the distance of
    /// the origins adds no rounding error.
    #[inline(always)]
    fn directions(&self, turn: &Matrix<N, 3>) -> Directions<V, V::Mask> {
        let (simd, [a, b, c], shrink) = (self.simd, &self.given, self.shrink);
        let edges =
            [times(&minus(b, a), shrink), times(&minus(c, b), shrink), times(&minus(a, c), shrink)];
        let squared =
            [dot(&edges[0], &edges[0]), dot(&edges[1], &edges[1]), dot(&edges[2], &edges[2])];
        let longest = squared[0].larger(squared[1]).larger(squared[2]);
        let across = cross(&edges[0], &edges[1]);
        let area = dot(&across, &across).sqrt();
        let is_wide = area.simd_gt(V::all(simd, N::lit(THIN)) * longest)
            & longest.simd_gt(V::all(simd, N::MIN_POSITIVE.sqrt()));
        let mut sides = edges;
        for (side, squared) in sides.iter_mut().zip(squared) {
            *side = rotated_back(simd, turn, &over(side, squared.sqrt()));
        }
        Directions { sides, front: rotated_back(simd, turn, &over(&across, area)), is_wide }
    }

    /// Returns the gaps from the triangles to the solid along the unit vectors `-along` and
    /// `along`.
    #[inline(always)]
    fn gaps_along(&self, along: &[V; 3]) -> [V; 2] {
        let mut top = -V::all(self.simd, N::INFINITY);
        let mut bottom = -top;
        for vertex in 0..self.solid.vertices {
            let height = dot(&spread(self.simd, &self.solid.vertex(vertex)), along);
            (bottom, top) = (height.smaller(bottom), height.larger(top));
        }
        let [a, b, c] = &self.corners;
        let (a, b, c) = (dot(a, along), dot(b, along), dot(c, along));
        let (low, high) = (a.smaller(b).smaller(c), a.larger(b).larger(c));
        [low - top * self.shrink, bottom * self.shrink - high]
    }

    /// Queries the face directions of the solid; returns for each lane the direction with the
    /// largest gap. `climbs` receives, for each face, the lanes in which each side of the triangle
    /// rises along the face's normal.
    #[inline(always)]
    fn query_faces(&self, climbs: &mut [[V::Mask; 3]; MAX_FACES]) -> TriangleAxis<V> {
        let (simd, zero) = (self.simd, V::all(self.simd, N::ZERO));
        let mut best =
            TriangleAxis { gap: -V::all(simd, N::INFINITY), normal: [zero; 3], feature: zero };
        let mut feature = V::all(simd, N::lit(FACES));
        for (face, climbs) in climbs.iter_mut().enumerate().take(self.solid.faces()) {
            let outward: [V; 3] = spread(simd, &self.solid.normal(face));
            let [a, b, c] = &self.corners;
            let (a, b, c) = (dot(&outward, a), dot(&outward, b), dot(&outward, c));
            let offset = V::all(simd, self.solid.offset(face)) * self.shrink;
            let gap = a.smaller(b).smaller(c) - offset;
            *climbs = [b.simd_gt(a), c.simd_gt(b), a.simd_gt(c)];
            let found = TriangleAxis { gap, normal: negated(&outward), feature };
            best = best.or(gap.simd_gt(best.gap), &found);
            feature += V::all(simd, N::ONE);
        }
        best
    }

    /// Queries the directions perpendicular to an edge of the solid and a side of a triangle.
    /// Returns for each lane the direction with the largest gap if this gap exceeds the gap of
    /// `face` by more than rounding, else the direction of `face`.
    #[inline(always)]
    fn query_edges(
        &self,
        climbs: &[[V::Mask; 3]; MAX_FACES],
        directions: &Directions<V, V::Mask>,
        wanted: V::Mask,
        face: TriangleAxis<V>,
    ) -> TriangleAxis<V> {
        let (simd, zero, one) = (self.simd, V::all(self.simd, N::ZERO), V::all(self.simd, N::ONE));
        let mut feature = V::all(simd, N::lit(EDGES)) - one;
        let sine = N::lit(PARALLEL) * N::EPSILON;
        let (mut best, mut bound) = (face, face.gap + V::all(simd, rounding_error()));
        for edge in self.solid.edges {
            let [first, second] = edge.faces.mapped(|face| &climbs[face as usize]);
            let [from, to] = edge.vertices.mapped(|end| self.solid.vertex(end as usize));
            let along = times(&spread(simd, &(to - from)), self.shrink);
            let start = times(&spread(simd, &from), self.shrink);
            // The edge runs counter-clockwise around its first face, so its product with a side
            // that rises along the normal of that face points out of the solid. The triangle lies
            // beyond the side if the edge runs forward.
            let is_forward = dot(&directions.front, &along).simd_ge(zero);
            let least = V::all(simd, sine * sine) * dot(&along, &along);
            for side in 0..3 {
                feature += one;
                let is_candidate =
                    (first[side] ^ second[side]) & !(is_forward ^ first[side]) & wanted;
                if is_candidate.to_bitmask() == 0 {
                    continue;
                }
                let outward = first[side].select(one, -one);
                let across = times(&cross(&along, &directions.sides[side]), outward);
                let slack = dot(&across, &minus(&self.corners[side], &start));
                let squared = dot(&across, &across);
                let length = squared.sqrt();
                // Parallel edges have no common perpendicular; a face normal then has a gap as
                // large.
                let is_more = is_candidate & squared.simd_gt(least) & slack.simd_gt(bound * length);
                // Divisions cost more than all other steps, and few directions improve on the best
                // so far.
                if is_more.to_bitmask() == 0 {
                    continue;
                }
                let gap = slack / length;
                let found = TriangleAxis { gap, normal: over(&across, -length), feature };
                best = best.or(is_more, &found);
                bound = is_more.select(gap, bound);
            }
        }
        best
    }
}

/// Returns the unit of each pair and its reciprocal, which is infinite if the size of the pair is
/// zero or not finite. `own` is the larger of the solid's bounding radius and the largest
/// coordinate of the offset between the origins.
#[inline(always)]
fn units<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: N,
    corners: &[[V; 3]; 3],
) -> [[N; LANES]; 2] {
    let mut most = V::all(simd, own);
    for corner in corners {
        for value in corner {
            most = value.abs().larger(most);
        }
    }
    let (mut sizes, mut shrinks) = ([N::ZERO; LANES], [N::INFINITY; LANES]);
    most.store(&mut sizes);
    for (size, shrink) in sizes.iter_mut().zip(&mut shrinks) {
        let is_scalable = *size > N::ZERO && size.is_finite_number();
        let scale = size.power_of_two_below();
        *shrink = if is_scalable { N::ONE / scale } else { N::INFINITY };
        *size = scale;
    }
    [sizes, shrinks]
}
