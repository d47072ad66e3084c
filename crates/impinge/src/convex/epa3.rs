//! Nearest supporting plane of a difference that contains the origin, in 3D.
//!
//! G. van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects"
//! (2001): a polytope inside the difference ([`Hull`]) grows outwards at its face nearest to the
//! origin; `epa2` has the figure in 2D. The polytope need not contain the origin: faces with the
//! origin in front of them have a negative offset, so they are the nearest and grow first. The
//! height of every normal tried is a lower bound of the signed distance, and the normal with the
//! largest height is the answer, however the growth ends.

use super::Separation;
use super::candidate::SupportCandidate;
use super::climb::climb;
use super::difference::{Difference, Vertex, rounding_error, tolerance};
use super::extent::{best_of, farthest, widest_pair};
use super::hull::{EpaFace, Hull};
use super::newton::converges;
use super::peak::at_peak;
use super::polish::{lowest, polish};
use super::side::better;
use super::simplex::Simplex;
use super::witness::{Mix, finish, locate, placed};
use crate::math::{Mapped, Real, Vector, cross, max, orthonormal_basis, unit};

/// Cap on the number of local searches after the growth of the hull has ended without an answer.
const CLIMBS: usize = 6;
/// Cosine of the smallest angle between two normals that both start a local search.
const SAME_CLIMB: f64 = 0.95;
/// Cap on the number of support points. Flat faces take about ten, smooth cores about twenty, rims
/// up to a hundred. Only if a whole ring of normals has nearly the largest height, and no `peak` is
/// known, does the growth end at the cap.
const ROUNDS: usize = 128;

/// Largest gap between a face and the boundary of a smooth difference at which Newton's method is
/// tried; also the factor by which this gap shrinks after a failure.
const COARSE: f64 = 1.0 / 1024.0;
/// Smallest cosine of the angle between a face's normal and the normal that Newton's method finds
/// from it. At larger angles, another local maximum may lie between them.
const SAME_SUMMIT: f64 = 1.0 - 1.0 / 64.0;
/// Largest gap of a face near a known maximum at which that maximum is used without another run of
/// Newton's method.
const FINE: f64 = 1.0 / 65536.0;
/// Smallest cosine of the angle between the normals of a face and a known maximum at which that
/// maximum is used without another run of Newton's method.
const SAME_PLACE: f64 = 1.0 - 1.0 / 2048.0;

/// Returns the result of [`super::Simplicial::deepest`].
pub(super) fn deepest<N: Real>(
    difference: &dyn Difference<N, 3>,
    simplex: &Simplex<N, 3>,
) -> Separation<N, 3> {
    if let Some(peak) = difference.peak() {
        let found = at_peak(difference, &peak);
        let beside = if peak.is_ring { beside(difference, &[], &found) } else { None };
        return beside.unwrap_or(found);
    }
    match from_simplex(difference, simplex) {
        Ok(corners) => {
            let mut hull = Hull::new(corners);
            let grown = grow(difference, &mut hull);
            beside(difference, hull.vertices(), &grown).unwrap_or(grown)
        }
        Err(flat) => flat,
    }
}

/// Returns a separation with a larger distance than `grown`, from the rings of normals of round
/// sides; `None` if there is none.
fn beside<N: Real>(
    difference: &dyn Difference<N, 3>,
    vertices: &[Vertex<N, 3>],
    grown: &Separation<N, 3>,
) -> Option<Separation<N, 3>> {
    let mut found = better(difference, &grown.normal, grown.distance)?;
    found.lowest.extend_from_slice(vertices);
    Some(match found.mix {
        Some(mix) => placed(&found.best, &mix, N::HALF),
        None => locate(difference, &found.best, &found.lowest),
    })
}

/// Corners of a tetrahedron to start with; or, as the error, the separation if the difference has
/// no volume.
type Start<N> = Result<[Vertex<N, 3>; 4], Separation<N, 3>>;

/// Smallest thickness of a simplex that is extended, as a fraction of its length.
const THICK: f64 = 1.0 / 1024.0;

/// Extends the simplex that contains the origin, or nearly does, to a tetrahedron by support
/// points. A single point or a sliver is replaced by the widest pair of support points first.
fn from_simplex<N: Real>(difference: &dyn Difference<N, 3>, simplex: &Simplex<N, 3>) -> Start<N> {
    match *simplex.vertices() {
        [a, b, c, d] if is_thick(&[a, b, c, d]) => Ok([a, b, c, d]),
        [a, b, c] if is_wide(&[a, b, c]) => from_triangle(difference, [a, b, c]),
        [a, b] if (b.point - a.point).norm() > N::lit(THICK) => from_segment(difference, [a, b]),
        _ => from_segment(difference, widest_pair(difference)),
    }
}

/// Returns whether the tetrahedron is no sliver: its volume is not small relative to the product of
/// its largest face and its longest edge at `a`.
fn is_thick<N: Real>([a, b, c, d]: &[Vertex<N, 3>; 4]) -> bool {
    let (e, f, g) = (b.point - a.point, c.point - a.point, d.point - a.point);
    let (ef, fg, ge) = (cross(&e, &f), cross(&f, &g), cross(&g, &e));
    let area = max(max(ef.norm(), fg.norm()), max(ge.norm(), (ef + fg + ge).norm()));
    let length = max(max(e.norm(), f.norm()), g.norm());
    ef.dot(&g).abs() > N::lit(THICK) * area * length
}

/// Returns whether the area of the triangle is not small relative to the square of its longest
/// edge, and that edge is longer than `THICK`; the size of the pair is about 1.
fn is_wide<N: Real>([a, b, c]: &[Vertex<N, 3>; 3]) -> bool {
    let (e, f, g) = (b.point - a.point, c.point - a.point, c.point - b.point);
    let length = max(max(e.norm(), f.norm()), g.norm());
    length > N::lit(THICK) && cross(&e, &f).norm() > N::lit(THICK) * length * length
}

fn from_segment<N: Real>(difference: &dyn Difference<N, 3>, [a, b]: [Vertex<N, 3>; 2]) -> Start<N> {
    let Some((along, _)) =
        unit(&(b.point - a.point)).filter(|&(_, width)| width > rounding_error())
    else {
        let axis = Vector::<N, 3>::new(N::ONE, N::ZERO, N::ZERO);
        return Err(locate(difference, &best_of(difference, &[axis]), &[a]));
    };
    let (u, v) = orthonormal_basis(&along);
    let mut side = (a, rounding_error());
    for across in [u, -u, v, -v] {
        let found = farthest(difference, &across, &a.point);
        side = if found.1 > side.1 { found } else { side };
    }
    let (c, found) = side;
    if found > rounding_error() {
        return from_triangle(difference, [a, b, c]);
    }
    // The difference is a segment through the origin, or nearly: all directions perpendicular to
    // the segment have the height zero.
    Err(locate(difference, &best_of(difference, &[u, v]), &[a, b]))
}

fn from_triangle<N: Real>(
    difference: &dyn Difference<N, 3>,
    [a, b, c]: [Vertex<N, 3>; 3],
) -> Start<N> {
    let (e, f) = (b.point - a.point, c.point - a.point);
    let Some((normal, _)) = unit(&cross(&e, &f)) else {
        return from_needle(difference, [a, b]);
    };
    let (above, height) = farthest(difference, &normal, &a.point);
    let (below, depth) = farthest(difference, &-normal, &a.point);
    if max(height, depth) > rounding_error() {
        return Ok([a, b, c, if height > depth { above } else { below }]);
    }
    // The difference is a flat disk through the origin, or nearly: its depth along its normal is
    // zero.
    Err(locate(difference, &best_of(difference, &[normal]), &[a, b, c]))
}

/// Returns, as the error, the separation of a difference whose known points lie on the line through
/// `a` and `b`; its normal is perpendicular to that line.
fn from_needle<N: Real>(difference: &dyn Difference<N, 3>, [a, b]: [Vertex<N, 3>; 2]) -> Start<N> {
    let along = unit(&(b.point - a.point)).map(|(along, _)| along);
    let axis = Vector::<N, 3>::new(N::ONE, N::ZERO, N::ZERO);
    let (u, v) = orthonormal_basis(&along.unwrap_or(axis));
    Err(locate(difference, &best_of(difference, &[u, v]), &[a, b]))
}

/// Grows the hull until its nearest face is on the boundary of the difference, for at most
/// [`ROUNDS`] support points. Returns the separation with the best normal found.
fn grow<N: Real>(difference: &dyn Difference<N, 3>, hull: &mut Hull<N>) -> Separation<N, 3> {
    let Some(first) = hull.nearest() else { return locate_any(difference, hull) };
    let mut best = SupportCandidate::along(difference, -hull.face(first).outward);
    let mut summits = Summits::of(difference);
    for _ in 0..ROUNDS {
        let Some(index) = hull.nearest() else { break };
        let face = *hull.face(index);
        if let Some(found) = summits.answer(&face, &best) {
            return found;
        }
        let candidate = SupportCandidate::along(difference, -face.outward);
        best.improve(&candidate);
        if let Some(top) = summits.beyond(difference, hull, &face, &candidate) {
            best.improve(&top);
            hull.finalize(index, -top.height);
            continue;
        }
        if -candidate.height - face.offset <= tolerance() {
            if face.is_final {
                break;
            }
            let corners = face.corners.mapped(|corner| *hull.vertex(corner));
            let before = best.height;
            if let Some(mix) = polish(difference, &mut best, &corners) {
                return placed(&best, &mix, N::HALF);
            }
            let is_closed = -candidate.height - face.offset <= rounding_error();
            if is_closed {
                if best.height <= before {
                    best.prefer(candidate, N::TWO * tolerance());
                }
                let mix = Mix::nearest(&best, &corners);
                return finish(difference, &best, &mix, hull.vertices());
            }
            // On flat faces the gap closes at once; on smooth parts Newton's method is faster than
            // growing.
            if converges(difference, &mut best) {
                hull.keep(&[best.vertex]);
                return locate(difference, &best, hull.vertices());
            }
        }
        if hull.contains(&candidate.vertex) {
            // The support point is already a vertex, yet lies beyond this face: rounding has made
            // the hull non-convex. The face grows no more; its offset becomes `-candidate.height`.
            hull.finalize(index, -candidate.height);
        } else {
            hull.extend(index, candidate.vertex);
        }
    }
    climb_on(difference, hull, &mut best);
    hull.keep(&[best.vertex]);
    let near = lowest(hull.vertices(), &best.normal);
    match polish(difference, &mut best, &near) {
        Some(mix) => placed(&best, &mix, N::HALF),
        None => locate(difference, &best, hull.vertices()),
    }
}

/// The highest of the local maxima of the height that Newton's method found from faces of the hull;
/// used only in a smooth difference.
struct Summits<N: Real> {
    highest: Option<Summit<N>>,
    /// Largest gap of a face from which Newton's method is tried; 0 if the difference is not
    /// smooth.
    coarse: N,
}

impl<N: Real> Summits<N> {
    fn of(difference: &dyn Difference<N, 3>) -> Self {
        let coarse = if difference.is_smooth() { N::lit(COARSE) } else { N::ZERO };
        Self { highest: None, coarse }
    }

    /// Returns the separation of the highest maximum if no face is nearer to the origin and no
    /// better normal was found; else `None`.
    fn answer(
        &self,
        nearest: &EpaFace<N>,
        best: &SupportCandidate<N, 3>,
    ) -> Option<Separation<N, 3>> {
        let Summit { top, mix } = self.highest.as_ref()?;
        let is_answer = -nearest.offset - top.height <= tolerance()
            && best.height - top.height <= rounding_error();
        is_answer.then(|| placed(top, mix, N::HALF))
    }

    /// Returns the local maximum beyond a face: a known one close to the face, or the result of
    /// Newton's method from `candidate`. `None` if the method is not tried or does not converge, or
    /// if the maximum may not be the only one.
    fn beyond(
        &mut self,
        difference: &dyn Difference<N, 3>,
        hull: &Hull<N>,
        face: &EpaFace<N>,
        candidate: &SupportCandidate<N, 3>,
    ) -> Option<SupportCandidate<N, 3>> {
        let gap = -candidate.height - face.offset;
        if gap <= tolerance() || gap > self.coarse || face.is_final {
            return None;
        }
        if let Some(known) = self.highest.as_ref().filter(|known| known.stands_for(face, gap)) {
            return Some(known.top);
        }
        let Some(found) = Summit::beside(difference, hull, face, *candidate) else {
            self.coarse *= N::lit(COARSE);
            return None;
        };
        let top = found.top;
        if self.highest.as_ref().is_none_or(|known| top.height > known.top.height) {
            self.highest = Some(found);
        }
        Some(top)
    }
}

/// A local maximum of the height: a normal, and points of the cores that face each other along it.
struct Summit<N: Real> {
    top: SupportCandidate<N, 3>,
    mix: Mix<N, 3>,
}

impl<N: Real> Summit<N> {
    /// Returns whether this maximum may be used for `face` without another run of Newton's method:
    /// whether their normals nearly agree and `gap`, the distance from the face to its support
    /// point, is small.
    fn stands_for(&self, face: &EpaFace<N>, gap: N) -> bool {
        gap <= N::lit(FINE) && -self.top.normal.dot(&face.outward) >= N::lit(SAME_PLACE)
    }

    /// Returns the maximum that Newton's method finds from a face. `None` if the method does not
    /// converge, or if the maximum's normal is so far from the face's normal that another maximum
    /// may lie between them.
    fn beside(
        difference: &dyn Difference<N, 3>,
        hull: &Hull<N>,
        face: &EpaFace<N>,
        mut top: SupportCandidate<N, 3>,
    ) -> Option<Self> {
        let corners = face.corners.mapped(|corner| *hull.vertex(corner));
        let mix = polish(difference, &mut top, &corners)?;
        let is_close = -top.normal.dot(&face.outward) >= N::lit(SAME_SUMMIT);
        is_close.then_some(Self { top, mix })
    }
}

/// Improves `best` by local searches from the best normals of the faces, after the growth of the
/// hull ended without an answer: at the cap, or because rounding made the hull non-convex. For a
/// small solid deep in a large round one, many normals far apart are nearly as good as the best, so
/// several are tried.
fn climb_on<N: Real>(
    difference: &dyn Difference<N, 3>,
    hull: &Hull<N>,
    best: &mut SupportCandidate<N, 3>,
) {
    // A normal better than `best` can only lie beyond a face that is nearer than the depth of
    // `best`.
    let nearer = hull.nearer_than(-best.height - tolerance());
    let mut starts: Vec<_> =
        nearer.map(|outward| SupportCandidate::along(difference, -outward)).collect();
    starts.push(*best);
    for _ in 0..CLIMBS {
        let Some(mut start) = starts.iter().copied().reduce(higher) else { break };
        starts.retain(|other| other.normal.dot(&start.normal) < N::lit(SAME_CLIMB));
        // If Newton's method confirms a maximum, a local search cannot improve it.
        let near = lowest(hull.vertices(), &start.normal);
        if polish(difference, &mut start, &near).is_none() {
            climb(difference, &mut start);
        }
        best.improve(&start);
    }
    converges(difference, best);
}

/// Returns the candidate with the larger height, the first of equals.
fn higher<N: Real>(
    first: SupportCandidate<N, 3>,
    second: SupportCandidate<N, 3>,
) -> SupportCandidate<N, 3> {
    if second.height > first.height { second } else { first }
}

/// Returns the separation for the best coordinate axis, if no face of the hull has a normal.
fn locate_any<N: Real>(difference: &dyn Difference<N, 3>, hull: &Hull<N>) -> Separation<N, 3> {
    let axes = [
        Vector::<N, 3>::new(N::ONE, N::ZERO, N::ZERO),
        Vector::<N, 3>::new(N::ZERO, N::ONE, N::ZERO),
        Vector::<N, 3>::new(N::ZERO, N::ZERO, N::ONE),
    ];
    locate(difference, &best_of(difference, &axes), hull.vertices())
}
