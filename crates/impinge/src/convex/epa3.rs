//! The nearest supporting plane of a difference that holds the origin, in space.
//!
//! G. van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects"
//! (2001): a polytope inside the difference grows outwards at its face nearest to the origin. Here
//! the polytope need not hold the origin: faces that see the origin in front of them have a negative
//! offset, are nearest of all, and grow first. Every normal it comes by is certified, and the best
//! one is the answer however the growth ends.

use smallvec::SmallVec;

use super::Separation;
use super::candidate::Candidate;
use super::climb::climb;
use super::difference::{Difference, Vertex, noise, tolerance};
use super::extent::{best_of, farthest, widest_pair};
use super::hull::Hull;
use super::simplex::Simplex;
use super::witness::locate;
use crate::math::{Real, Vector, cross, max, orthonormal_basis, unit};

/// Cap on the number of support points. Flat faces take about ten, curved ones up to a hundred; where
/// a whole ring of normals is equally good, as for coaxial cylinders, the cap is what stops.
const ROUNDS: usize = 128;

/// See [`super::Simplicial::deepest`].
pub(super) fn deepest<N: Real>(
    difference: &dyn Difference<N, 3>,
    simplex: &Simplex<N, 3>,
) -> Separation<N, 3> {
    match from_simplex(simplex).map_or_else(|| from_extent(difference), Ok) {
        Ok(mut hull) => grow(difference, &mut hull),
        Err(flat) => flat,
    }
}

/// The tetrahedron that is known to hold the origin, if there is one and it is not a sliver.
fn from_simplex<N: Real>(simplex: &Simplex<N, 3>) -> Option<Hull<N>> {
    let &[a, b, c, d] = simplex.vertices() else { return None };
    let (e, f, g) = (b.point - a.point, c.point - a.point, d.point - a.point);
    let (ef, fg, ge) = (cross(&e, &f), cross(&f, &g), cross(&g, &e));
    let area = max(max(ef.norm(), fg.norm()), max(ge.norm(), (ef + fg + ge).norm()));
    let length = max(max(e.norm(), f.norm()), g.norm());
    let thick = N::lit(1.0 / 1024.0) * area * length;
    (ef.dot(&g).abs() > thick).then(|| Hull::new([a, b, c, d]))
}

/// A tetrahedron of extreme points; or the answer at once, if the difference is flat.
fn from_extent<N: Real>(difference: &dyn Difference<N, 3>) -> Result<Hull<N>, Separation<N, 3>> {
    let [a, b] = widest_pair(difference);
    let Some((along, _)) = unit(&(b.point - a.point)).filter(|&(_, width)| width > noise()) else {
        let axis = Vector::<N, 3>::new(N::ONE, N::ZERO, N::ZERO);
        return Err(locate(&best_of(difference, &[axis]), &[a]));
    };
    let (u, v) = orthonormal_basis(&along);
    let mut side = (a, noise());
    for across in [u, -u, v, -v] {
        let found = farthest(difference, &across, &a.point);
        side = if found.1 > side.1 { found } else { side };
    }
    let (c, found) = side;
    let normal = unit(&cross(&(b.point - a.point), &(c.point - a.point)));
    let Some((normal, _)) = normal.filter(|_| found > noise()) else {
        // A segment through the origin, or nearly: all that is across it is as good.
        return Err(locate(&best_of(difference, &[u, v]), &[a, b]));
    };
    let (above, height) = farthest(difference, &normal, &a.point);
    let (below, depth) = farthest(difference, &-normal, &a.point);
    if max(height, depth) > noise() {
        return Ok(Hull::new([a, b, c, if height > depth { above } else { below }]));
    }
    Err(flat(difference, [a, b, c], &normal))
}

/// The answer where the difference is a flat disk through the origin, or nearly: its depth is
/// across the disk, and zero. The points come from its outline.
fn flat<N: Real>(
    difference: &dyn Difference<N, 3>,
    corners: [Vertex<N, 3>; 3],
    normal: &Vector<N, 3>,
) -> Separation<N, 3> {
    let mut outline: SmallVec<[Vertex<N, 3>; 16]> = SmallVec::from_slice(&corners);
    let (u, v) = orthonormal_basis(normal);
    for across in [u, v, u + v, u - v] {
        outline.push(difference.lowest(&across));
        outline.push(difference.lowest(&-across));
    }
    locate(&best_of(difference, &[*normal]), &outline)
}

/// Where the hull lies nearest to the origin, once it has grown to the difference there.
fn grow<N: Real>(difference: &dyn Difference<N, 3>, hull: &mut Hull<N>) -> Separation<N, 3> {
    let Some(first) = hull.nearest() else { return locate_any(difference, hull) };
    let mut best = Candidate::along(difference, -hull.face(first).outward);
    let mut closed = false;
    for _ in 0..ROUNDS {
        let Some(index) = hull.nearest() else { break };
        let face = *hull.face(index);
        let candidate = Candidate::along(difference, -face.outward);
        best.improve(&candidate);
        closed = -best.height - face.offset <= tolerance();
        if closed {
            break;
        }
        if -candidate.height - face.offset <= noise() || hull.contains(&candidate.vertex) {
            // It grows no more: what counts from now on is its certificate.
            hull.settle(index, -candidate.height);
        } else {
            hull.extend(index, candidate.vertex);
        }
    }
    if !closed {
        polish(difference, hull, &mut best);
    }
    hull.keep(&[best.vertex]);
    locate(&best, hull.vertices())
}

/// Goes on from the best normal and from that of the nearest face, at the cap.
fn polish<N: Real>(
    difference: &dyn Difference<N, 3>,
    hull: &mut Hull<N>,
    best: &mut Candidate<N, 3>,
) {
    let nearest = hull.nearest().map(|index| -hull.face(index).outward);
    climb(difference, best);
    if let Some(normal) = nearest {
        let mut other = Candidate::along(difference, normal);
        climb(difference, &mut other);
        best.improve(&other);
    }
}

/// What is left to say when no face of the hull has a normal.
fn locate_any<N: Real>(difference: &dyn Difference<N, 3>, hull: &Hull<N>) -> Separation<N, 3> {
    let axes = [
        Vector::<N, 3>::new(N::ONE, N::ZERO, N::ZERO),
        Vector::<N, 3>::new(N::ZERO, N::ONE, N::ZERO),
        Vector::<N, 3>::new(N::ZERO, N::ZERO, N::ONE),
    ];
    locate(&best_of(difference, &axes), hull.vertices())
}
