//! Depth of a flat-sided solid in a cylinder or a cone, without growing a polytope.
//!
//! The depth along a unit vector `m` is the support function of the Minkowski difference of the
//! cores; the result is its minimum. A minimum on a smooth part of the sphere of directions
//! requires that both radii of curvature of the difference are at least the depth. Vertices of the
//! flat solid have radii zero, a rim has a radius above zero only along itself, and an apex has
//! radii zero. So the minimum lies on one of these:
//!
//! ```text
//!   normals of faces and caps     points on the sphere       tried one by one
//!   edges of the flat solid       arcs between the normals   searched by `arc`
//!                                 of its two faces
//!   the round side                a circle of normals        searched by `arc` in four quarters
//! ```
//!
//! [`arc`] proves its minimum. Every search is one-dimensional, unlike the growing of a polytope
//! towards a curved surface.
//!
//! Extents may be zero: an edge without length has an arc of normals of its vertex, which are valid
//! directions too. These cases fall back to the general algorithm:
//!
//! - round solids, segments or triangles of almost no size, whose normals are unknown;
//! - hulls with too many vertices;
//! - polytopes that are flat up to rounding, whose vertices contradict the depth found along their
//!   normals;
//! - rings of almost equal depths, where arcs along the ring would be split too often.
//!
//! For two polytopes, restricting the search to faces and edges is the separating axis test. The
//! search here applies the same argument to the parts of cylinders and cones.

mod arc;
mod flat;
mod round;

use smallvec::SmallVec;

use self::arc::{Arc, ArcSearch, RidgeLine};
use self::flat::Flat;
pub(super) use self::round::Round;
use super::flat_core::FlatCore;
use super::revolved::coaxial;
use super::{general, wrong_kinds};
use crate::collide::Pair;
use crate::convex::{self, Peak, Peaks, Separation};
use crate::math::{Mapped, Pose, Real, Vector, cross, max, min, unit};
use crate::shape::{Geometry, SupportMap};

/// Returns the separation of a flat-sided solid, segment or capsule from a cylinder or cone; `None`
/// above `limit`.
///
/// If the solids are apart, the result is bit-identical to that of the general algorithm.
/// [`OverlapPeaks`] finds the normal of an overlap.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (flat, round) = cores(pair);
    let loosened = general::loosened(&flat, round, &pair.pose12, limit);
    let found = convex::separation_by(&flat, round, &pair.pose12, loosened, &OverlapPeaks { pair });
    found.filter(|found| found.distance <= limit)
}

/// Returns the distance of [`separation`]; zero instead if the search finds that the cores
/// certainly overlap. `None` above `limit`.
pub(super) fn distance<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<N> {
    let (flat, round) = cores(pair);
    let loosened = general::loosened(&flat, round, &pair.pose12, limit);
    let found = convex::distance_by(&flat, round, &pair.pose12, loosened, &OverlapPeaks { pair });
    found.filter(|distance| *distance <= limit)
}

/// Returns the flat solid and the round one.
fn cores<'a, N: Real>(pair: &Pair<'a, N, 3>) -> (FlatCore<'a, N, 3>, &'a dyn SupportMap<N, 3>) {
    match (FlatCore::of(pair.first), Geometry(pair.second).as_support_map()) {
        (Some(flat), Some(round)) => (flat, round),
        _ => wrong_kinds(pair),
    }
}

/// Gives the general algorithm the normal of least depth for a pair whose cores overlap.
struct OverlapPeaks<'a, 'b, N: Real> {
    pair: &'b Pair<'a, N, 3>,
}

impl<N: Real> Peaks<N, 3> for OverlapPeaks<'_, '_, N> {
    fn best(&self, shrink: N, gap: N) -> Option<Peak<N, 3>> {
        if let Some(peak) = coaxial::peak(self.pair, shrink) {
            return Some(peak);
        }
        let round = Round::new(&self.pair.second, shrink)?;
        let flat = Flat::new(&self.pair.first, &self.pair.pose12, shrink)?;
        let mut depth_search = DepthSearch {
            flat: &flat,
            round: &round,
            least: N::INFINITY,
            at: DepthFeature::Face(0),
            normal: Vector::<N, 3>::y(),
        };
        depth_search.search(gap)?;
        if !depth_search.is_confirmed(gap) {
            return None;
        }
        Some(depth_search.peak(&self.pair.pose12, shrink))
    }
}

/// Feature on which the direction of least depth lies.
#[derive(Clone, Copy)]
enum DepthFeature {
    /// A normal of the flat solid, by index.
    Face(usize),
    /// The normal of a cap.
    Cap,
    /// A direction on the arc of an edge, by the edge's index.
    Edge(usize),
    /// A direction on the circle of normals of the round side.
    Side,
}

/// State of the search, in the frame of the round solid and in units of the pair. Directions are
/// from the round solid to the flat one.
struct DepthSearch<'a, N: Real> {
    flat: &'a Flat<N>,
    round: &'a Round<N>,
    /// Least depth so far; `at` is its feature and `normal` its direction.
    least: N,
    at: DepthFeature,
    normal: Vector<N, 3>,
}

impl<N: Real> DepthSearch<'_, N> {
    /// Searches all features for the least depth, to within `gap`; `None` if arcs are split too
    /// often.
    fn search(&mut self, gap: N) -> Option<()> {
        let mut ends = SmallVec::<[Vector<N, 3>; 16]>::new();
        for (index, (normal, vertex)) in self.flat.normals.iter().enumerate() {
            let end = self.round.support(normal);
            let depth = normal.dot(&(end - self.flat.vertices[*vertex as usize]));
            self.note(depth, DepthFeature::Face(index), *normal);
            ends.push(end);
        }
        for &up in self.round.caps() {
            let normal = Vector::<N, 3>::y() * N::lit(up);
            let low = self.flat.lowest(&normal);
            let depth = self.round.half - normal.dot(&self.flat.vertices[low]);
            self.note(depth, DepthFeature::Cap, normal);
        }
        if self.search_edges(&ends, gap).is_some() {
            return self.search_side(gap);
        }
        // Arcs are split too often if normals around the axis have almost equal depths, because the
        // bounds then exclude few parts. The search over the side finds the best normal directly.
        self.search_side(gap)?;
        self.search_edges(&ends, gap)
    }

    fn search_edges(&mut self, ends: &[Vector<N, 3>], gap: N) -> Option<()> {
        (0..self.flat.edges.len()).try_for_each(|edge| self.search_edge(edge, ends, gap))
    }

    fn note(&mut self, depth: N, at: DepthFeature, normal: Vector<N, 3>) {
        if depth < self.least {
            (self.least, self.at, self.normal) = (depth, at, normal);
        }
    }

    /// Returns whether all vertices confirm the depth found, up to 8 times `gap`. The depth was
    /// computed with the vertices of one face or edge, which are lowest only up to the accuracy of
    /// the face normals.
    fn is_confirmed(&self, gap: N) -> bool {
        let lowest = self.flat.vertices[self.flat.lowest(&self.normal)];
        let depth = self.normal.dot(&(self.round.support(&self.normal) - lowest));
        depth - self.least <= N::lit(8.0) * gap
    }

    /// Searches the normals of an edge. They lie in the plane perpendicular to the edge, in which
    /// the whole edge projects to one point. `ends` are the support points of the round solid along
    /// the normals of the flat one. `None` if the arc is split too often.
    fn search_edge(&mut self, edge: usize, ends: &[Vector<N, 3>], gap: N) -> Option<()> {
        let (round, vertices) = (self.round, &self.flat.vertices);
        let flat::Edge { vertices: ends_of_edge, normals: [first, second] } = self.flat.edges[edge];
        let [vertex, other] = ends_of_edge.mapped(|vertex| vertices[vertex as usize]);
        let [from, to] = [first, second].mapped(|normal| self.flat.normals[normal as usize].0);
        let ends = [first, second].mapped(|normal| ends[normal as usize]);
        let heights = ends.mapped(|end| [from.dot(&(end - vertex)), to.dot(&(end - vertex))]);
        if arc::are_above(&heights, self.least - gap) {
            return Some(());
        }
        let Some(across) = across(&(other - vertex), [&from, &to]) else { return Some(()) };
        let (cosine, sine) = (from.dot(&to), max(across.dot(&to), N::ZERO));
        // Between normals as close as this the depth falls by less than `gap`. The condition is
        // linear in the angle, because next to the normal of a cap the support point on its rim
        // moves as fast as the normal turns.
        if cosine > N::ZERO && sine <= gap {
            return Some(());
        }
        let line = |point: &Vector<N, 3>| {
            let away = point - vertex;
            RidgeLine {
                base: N::ZERO,
                toward: Vector::<N, 2>::new(away.dot(&from), away.dot(&across)),
            }
        };
        let arc = Arc {
            ends: [Vector::<N, 2>::x(), Vector::<N, 2>::new(cosine, sine)],
            lines: ends.mapped(|end| line(&end)),
        };
        let lift = |u: &Vector<N, 2>| from * u.x + across * u.y;
        let mut search = ArcSearch::new(self.least, gap);
        search.run(arc, |u| line(&round.support(&lift(u))))?;
        if let Some(u) = search.best {
            self.note(search.least, DepthFeature::Edge(edge), lift(&u));
        }
        Some(())
    }

    /// Searches the normals of the round side. `None` if an arc is split too often.
    fn search_side(&mut self, gap: N) -> Option<()> {
        let (flat, slope) = (self.flat, self.round.slope());
        let lift = |u: &Vector<N, 2>| {
            Vector::<N, 3>::new(u.x * slope.aside, slope.along, u.y * slope.aside)
        };
        let line = |u: &Vector<N, 2>| {
            let vertex = flat.vertices[flat.lowest(&lift(u))];
            let toward = Vector::<N, 2>::new(vertex.x, vertex.z) * -slope.aside;
            RidgeLine { base: slope.extent - slope.along * vertex.y, toward }
        };
        let (x, y) = (Vector::<N, 2>::x(), Vector::<N, 2>::y());
        let mut search = ArcSearch::new(self.least, gap);
        let starts = [x, y, -x, -y];
        let lines = starts.mapped(|u| line(&u));
        (0..4).for_each(|index| search.note(&starts[index], &lines[index]));
        for index in 0..4 {
            let next = (index + 1) % 4;
            let arc =
                Arc { ends: [starts[index], starts[next]], lines: [lines[index], lines[next]] };
            search.run(arc, line)?;
        }
        if let Some(u) = search.best {
            self.note(search.least, DepthFeature::Side, lift(&u));
        }
        Some(())
    }

    /// Returns the result as a [`Peak`] in the frame of the flat solid.
    fn peak(&self, pose12: &Pose<N, 3>, shrink: N) -> Peak<N, 3> {
        let opposite = -(pose12.rotation * self.normal);
        let (is_exact, normal) = match self.at {
            DepthFeature::Face(index) => (true, self.flat.own_normals[index]),
            DepthFeature::Cap => (true, opposite),
            _ => (false, unit(&opposite).map_or(opposite, |(normal, _)| normal)),
        };
        let low = self.touched();
        let on_round =
            self.round.touched(&self.normal, low.iter().map(|v| &self.flat.vertices[*v]));
        let in_first = |point: Vector<N, 3>| pose12.rotation * point + pose12.translation * shrink;
        Peak {
            normal,
            is_exact,
            is_ring: false,
            on1: low.iter().map(|&vertex| self.flat.own_vertices[vertex]).collect(),
            on2: on_round.into_iter().map(in_first).collect(),
        }
    }

    /// Returns the vertices of the flat solid that may touch: both ends of the edge, or up to 8 of
    /// the vertices that are lowest along the normal.
    fn touched(&self) -> SmallVec<[usize; 8]> {
        if let DepthFeature::Edge(edge) = self.at {
            return self.flat.edges[edge].vertices.iter().map(|&vertex| vertex as usize).collect();
        }
        let height = |vertex: &Vector<N, 3>| self.normal.dot(vertex);
        let vertices = &self.flat.vertices;
        let low = vertices.iter().fold(N::INFINITY, |low, vertex| min(height(vertex), low));
        let slack = N::EPSILON.sqrt();
        let is_low = |index: &usize| height(&vertices[*index]) <= low + slack;
        (0..vertices.len()).filter(is_low).take(8).collect()
    }
}

/// Returns the unit vector perpendicular to the first normal of an edge, in the plane of both
/// normals and towards the second. It is computed from the difference of the normals or from the
/// cross product of the edge and the first normal: the longer of these vectors is more accurate.
/// `None` if both are zero.
fn across<N: Real>(edge: &Vector<N, 3>, [from, to]: [&Vector<N, 3>; 2]) -> Option<Vector<N, 3>> {
    let aside = unit(&(to - from * from.dot(to)));
    let Some((by_edge, length)) = unit(&cross(edge, from)) else { return Some(aside?.0) };
    match aside {
        Some((aside, sine)) if sine >= length => Some(aside),
        // Almost opposite normals do not define the side; the direction of the edge does.
        Some((aside, sine)) if sine > N::EPSILON.sqrt() && aside.dot(&by_edge) < N::ZERO => {
            Some(-by_edge)
        }
        _ => Some(by_edge),
    }
}

#[cfg(test)]
pub(super) mod tests;
