//! Nearest supporting line of a difference that contains the origin, in 2D.
//!
//! ```text
//!         .-------.            polygon inside the difference; outward: normal of its nearest side
//!        / .-----. \           offset: signed distance of the side from the origin o
//!       | |   o   |-*          *: support point along outward, at -height
//!        \ '-----' /           grown there until -height - offset <= tolerance
//!         '-------'
//! ```
//!
//! G. van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects"
//! (2001): a polygon inside the difference grows outwards at its side nearest to the origin. Unlike
//! in that paper, the polygon need not contain the origin: sides with the origin in front of them
//! have a negative offset, so they are the nearest and grow first.

use smallvec::SmallVec;

use super::Separation;
use super::candidate::SupportCandidate;
use super::climb::climb;
use super::difference::{Difference, Vertex, rounding_error, tolerance};
use super::extent::{best_of, farthest, widest_pair};
use super::newton::converges;
use super::polish::polish;
use super::simplex::Simplex;
use super::witness::{Mix, finish, locate, placed};
use crate::math::{Real, Vector, cross2, perp, unit};

/// Cap on the number of support points. Polygons need about as many as they have sides near the
/// origin.
const ROUNDS: usize = 96;

/// A side of the polygon, from `start` to the `start` of the next side.
#[derive(Clone, Copy)]
struct PolygonEdge<N: Real> {
    start: Vertex<N, 2>,
    /// Outward unit normal of the side; zero if the side is too short.
    outward: Vector<N, 2>,
    /// Signed distance of the side's line from the origin along `outward`, negative if the origin
    /// is in front of the side; infinite if the side is too short to have a normal.
    offset: N,
}

/// Sides of the polygon, counter-clockwise.
type EpaRing<N> = SmallVec<[PolygonEdge<N>; 16]>;

impl<N: Real> PolygonEdge<N> {
    fn new(start: Vertex<N, 2>, end: &Vertex<N, 2>) -> Self {
        let edge = end.point - start.point;
        let sound = edge.norm_squared() > rounding_error::<N>() * rounding_error();
        match unit(&-perp(&edge)) {
            Some((outward, _)) if sound => {
                Self { start, outward, offset: outward.dot(&start.point) }
            }
            _ => Self { start, outward: Vector::<N, 2>::zeros(), offset: N::INFINITY },
        }
    }
}

/// Returns the result of [`super::Simplicial::deepest`].
pub(super) fn deepest<N: Real>(
    difference: &dyn Difference<N, 2>,
    simplex: &Simplex<N, 2>,
) -> Separation<N, 2> {
    match from_simplex(simplex).map_or_else(|| from_extent(difference), Ok) {
        Ok(mut ring) => grow(difference, &mut ring),
        Err(flat) => flat,
    }
}

fn ring_of<N: Real>(corners: &[Vertex<N, 2>]) -> EpaRing<N> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&start, end)| PolygonEdge::new(start, end)).collect()
}

/// Returns the simplex as a polygon, counter-clockwise; `None` if the simplex is not a triangle or
/// is a sliver.
fn from_simplex<N: Real>(simplex: &Simplex<N, 2>) -> Option<EpaRing<N>> {
    let &[a, b, c] = simplex.vertices() else { return None };
    let (e, f, g) = (b.point - a.point, c.point - a.point, c.point - b.point);
    let area = cross2(&e, &f);
    let thick = N::lit(1.0 / 1024.0) * (e.norm_squared() + f.norm_squared() + g.norm_squared());
    if area > thick {
        Some(ring_of(&[a, b, c]))
    } else if -area > thick {
        Some(ring_of(&[a, c, b]))
    } else {
        None
    }
}

/// Returns a polygon of extreme points of the difference; or, as the error, the separation if the
/// difference is a segment or a point.
fn from_extent<N: Real>(difference: &dyn Difference<N, 2>) -> Result<EpaRing<N>, Separation<N, 2>> {
    let [a, b] = widest_pair(difference);
    let edge = b.point - a.point;
    let Some((along, _)) = unit(&edge).filter(|&(_, width)| width > rounding_error()) else {
        let axis = Vector::<N, 2>::new(N::ONE, N::ZERO);
        return Err(locate(difference, &best_of(difference, &[axis]), &[a]));
    };
    let left = perp(&along);
    let (on_left, beyond_left) = farthest(difference, &left, &a.point);
    let (on_right, beyond_right) = farthest(difference, &-left, &a.point);
    let corners = [(on_right, beyond_right), (b, N::INFINITY), (on_left, beyond_left)];
    let mut ring: SmallVec<[Vertex<N, 2>; 4]> = SmallVec::from_slice(&[a]);
    ring.extend(
        corners.iter().filter(|(_, beyond)| *beyond > rounding_error()).map(|(vertex, _)| *vertex),
    );
    if ring.len() > 2 {
        return Ok(ring_of(&ring));
    }
    // The difference is a segment through the origin, or nearly: its depth along the normal of the
    // segment is zero.
    Err(locate(difference, &best_of(difference, &[left]), &ring))
}

/// Grows the polygon until its nearest side is on the boundary of the difference, for at most
/// [`ROUNDS`] support points. Returns the separation with the best normal found.
fn grow<N: Real>(difference: &dyn Difference<N, 2>, ring: &mut EpaRing<N>) -> Separation<N, 2> {
    let mut best = SupportCandidate::along(difference, -ring[0].outward);
    for _ in 0..ROUNDS {
        let index = nearest_side(ring);
        let (side, next) = (ring[index], ring[(index + 1) % ring.len()].start);
        let candidate = SupportCandidate::along(difference, -side.outward);
        best.improve(&candidate);
        if -candidate.height - side.offset <= tolerance() {
            let before = best.height;
            if let Some(mix) = polish(difference, &mut best, &[side.start, next]) {
                return placed(&best, &mix, N::HALF);
            }
            let is_closed = -candidate.height - side.offset <= rounding_error();
            if is_closed {
                if best.height <= before {
                    best.prefer(candidate, N::TWO * tolerance());
                }
                let mix = Mix::nearest(&best, &[side.start, next]);
                return finish(difference, &best, &mix, &vertices(ring, &best));
            }
            // On flat sides the gap closes at once; on smooth parts Newton's method is faster than
            // growing.
            if converges(difference, &mut best) {
                return locate(difference, &best, &vertices(ring, &best));
            }
        }
        let known = ring.iter().any(|other| other.start.point == candidate.vertex.point);
        if known {
            // The support point is already a vertex, so the side grows no more; its offset becomes
            // `-candidate.height`.
            ring[index].offset = -candidate.height;
            continue;
        }
        ring[index] = PolygonEdge::new(side.start, &candidate.vertex);
        ring.insert(index + 1, PolygonEdge::new(candidate.vertex, &next));
    }
    climb(difference, &mut best);
    locate(difference, &best, &vertices(ring, &best))
}

/// Returns the vertices of the polygon and the support point of `best`.
fn vertices<N: Real>(
    ring: &EpaRing<N>,
    best: &SupportCandidate<N, 2>,
) -> SmallVec<[Vertex<N, 2>; 16]> {
    ring.iter().map(|side| side.start).chain([best.vertex]).collect()
}

fn nearest_side<N: Real>(ring: &EpaRing<N>) -> usize {
    let (mut nearest, mut offset) = (0, N::INFINITY);
    for (index, side) in ring.iter().enumerate() {
        if side.offset < offset {
            (nearest, offset) = (index, side.offset);
        }
    }
    nearest
}
