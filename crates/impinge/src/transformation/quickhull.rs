//! Quickhull in 3D, with exact visibility tests and a tolerance below which points are not added.
//!
//! Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls" (1996). The facets
//! visible from a point are decided by exact orientation. So they are always connected, their
//! border is always one loop, and no facet is without area: the surface stays closed and weakly
//! convex for every input. Points outside by at most the tolerance are not added.

use super::lattice::{area_vector, volume};
use super::span::{distance_from_segment, larger, precedes};
use crate::math::order::sort_few;
use crate::math::{Mapped, Point, Vector};

type P3 = Point<f64, 3>;

const NONE: u32 = u32::MAX;

/// The value of [`Facet::visited`] for a facet that was removed from the surface.
const GONE: u32 = u32::MAX;

/// 2⁻⁴⁰. If a rounded height above a facet's plane exceeds this in magnitude, its sign is right and
/// its magnitude is accurate within a quarter.
///
/// The error of a normal is 2⁻⁴⁵, which is multiplied by offsets below 7; rounding the products
/// adds 2⁻⁴⁹.
pub(super) const DOUBT: f64 = 1.0 / (1_u64 << 40) as f64;

/// A triangle of the surface, with its corners counter-clockwise seen from outside.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    pub(super) corners: [u32; 3],
    /// The facet beyond the side from each corner to the next.
    pub(super) neighbors: [u32; 3],
    /// The outward unit normal, with an error of at most 2⁻⁴⁵.
    pub(super) normal: Vector<f64, 3>,
    /// The scalar product of the normal with the points of the facet's plane.
    offset: f64,
    /// Twice the facet's area; six times a volume divided by it is a height.
    pub(super) doubled_area: f64,
    /// The first point of the facet's list of outside points; [`NONE`] if the list is empty.
    waiting: u32,
    /// The number of the last search that found the facet visible; 0 if none has, [`GONE`] if the
    /// facet was removed.
    visited: u32,
}

impl Facet {
    fn new(points: &[P3], corners: [u32; 3], neighbors: [u32; 3]) -> Self {
        let corner_points = corners.mapped(|corner| &points[at(corner)]);
        let [a, b, c] = corner_points;
        let (u, v) = (b - a, c - a);
        let mut across = u.cross(&v);
        // The cross product has a rounding error of 2⁻⁵⁰ times the product of the lengths of `u`
        // and `v`. This error is at most 2⁻⁴⁵ of the length of the cross product if that length is
        // at least 1/32 of the product. A shorter cross product is recomputed exactly.
        if across.norm_squared() * 1024.0 < u.norm_squared() * v.norm_squared() {
            across = area_vector(corner_points);
        }
        let doubled_area = across.norm();
        let normal = across * (1.0 / doubled_area);
        let offset = normal.dot(&a.coords);
        Self { corners, neighbors, normal, offset, doubled_area, waiting: NONE, visited: 0 }
    }

    /// Returns the height of a point over the facet, positive in front, with an error below
    /// [`DOUBT`].
    fn rough_height(&self, point: &P3) -> f64 {
        self.normal.dot(&point.coords) - self.offset
    }

    /// Returns the height of a point over the facet, positive in front; the sign is exact.
    pub(super) fn height(&self, points: &[P3], point: u32) -> f64 {
        let point = &points[at(point)];
        let height = self.rough_height(point);
        if height.abs() > DOUBT { height } else { self.exact_height(points, point) }
    }

    #[cold]
    fn exact_height(&self, points: &[P3], point: &P3) -> f64 {
        volume(self.corners.mapped(|corner| &points[at(corner)]), point) / self.doubled_area
    }
}

/// A point outside the surface, in the list of one facet that it is in front of.
#[derive(Clone, Copy)]
struct WaitingPoint {
    /// The height of the point over that facet.
    height: f64,
    /// The next point in the list.
    next: u32,
}

/// A side between a visible and an invisible facet: its vertices in the order of the visible facet,
/// and the invisible facet `beyond`.
#[derive(Clone, Copy)]
struct HorizonSide {
    from: u32,
    to: u32,
    beyond: u32,
}

/// The surface under construction.
pub(super) struct HullSurface<'a> {
    points: &'a [P3],
    /// Points that are outside the surface by no more than this are not added.
    tolerance: f64,
    facets: Vec<Facet>,
    /// The list entry of each point. Valid only for points in the list of some facet.
    waiting: Vec<WaitingPoint>,
    searches: u32,
    /// The facets that the last search found visible.
    visible: Vec<u32>,
    /// The border of the visible facets, in order of the vertices where its sides start.
    horizon: Vec<HorizonSide>,
    /// For each vertex of the last border, the new facet on the side that starts there.
    fan: Vec<u32>,
}

pub(super) fn at(index: u32) -> usize {
    index as usize
}

pub(super) fn index_of(position: usize) -> u32 {
    u32::try_from(position).expect("a hull has fewer than 2³² points and triangles")
}

impl<'a> HullSurface<'a> {
    /// Returns the facets of the hull, grown from a tetrahedron of four of the points; `None` if
    /// these four are coplanar.
    pub(super) fn grown(points: &'a [P3], first: [u32; 4], tolerance: f64) -> Option<Vec<Facet>> {
        let mut surface = Self {
            points,
            tolerance,
            facets: Vec::with_capacity(32),
            waiting: vec![WaitingPoint { height: 0.0, next: NONE }; points.len()],
            searches: 0,
            visible: Vec::with_capacity(16),
            horizon: Vec::with_capacity(16),
            fan: vec![NONE; points.len()],
        };
        surface.start(first)?;
        for point in (0..).take(points.len()).filter(|point| !first.contains(point)) {
            surface.assign(point, 0);
        }
        // Each call of `raise` adds a vertex or finds that a facet has no point to add. The last
        // facet is processed first: its data is in the cache.
        let mut pending: Vec<u32> = Vec::with_capacity(32);
        pending.extend([0, 1, 2, 3]);
        while !pending.is_empty() {
            while let Some(facet) = pending.pop() {
                surface.raise(facet, &mut pending);
            }
            surface.promote(&mut pending);
        }
        Some(surface.compacted())
    }

    /// Builds the first tetrahedron; `None` if the four points are coplanar.
    fn start(&mut self, [a, b, c, d]: [u32; 4]) -> Option<()> {
        let [e, f, g] = [a, b, c].mapped(|corner| &self.points[at(corner)]);
        let height = volume([e, f, g], &self.points[at(d)]);
        if height == 0.0 {
            return None;
        }
        let [a, b] = if height > 0.0 { [b, a] } else { [a, b] };
        // The fourth corner lies behind abc. Facet i lacks corner i of (d, a, b, c).
        for (corners, neighbors) in [
            ([a, b, c], [3, 1, 2]),
            ([b, d, c], [3, 2, 0]),
            ([c, d, a], [1, 3, 0]),
            ([a, d, b], [2, 1, 0]),
        ] {
            self.facets.push(Facet::new(self.points, corners, neighbors));
        }
        Some(())
    }

    /// Puts a point into the list of the facet over which it is highest, among the facets with an
    /// index of at least `first`. A point in front of none of these facets is dropped, since it
    /// stays inside the growing surface.
    ///
    /// A point that is outside, and was in front of a removed facet, is in front of one of the
    /// facets that replaced it.
    #[inline]
    fn assign(&mut self, point: u32, first: u32) {
        let position = self.points[at(point)];
        let (mut best, mut top) = self.highest(first, |facet| facet.rough_height(&position));
        if top.abs() <= DOUBT {
            (best, top) = self.highest(first, |facet| facet.height(self.points, point));
        }
        if top > 0.0 {
            self.wait(point, best, top);
        }
    }

    /// Returns the facet with the largest height among the facets with an index of at least
    /// `first`, and that height.
    #[inline]
    fn highest(&self, first: u32, height: impl Fn(&Facet) -> f64) -> (u32, f64) {
        let (mut best, mut top) = (NONE, f64::NEG_INFINITY);
        for (index, facet) in (first..).zip(&self.facets[at(first)..]) {
            let height = height(facet);
            (best, top) = if height > top { (index, height) } else { (best, top) };
        }
        (best, top)
    }

    fn wait(&mut self, point: u32, facet: u32, height: f64) {
        let next = core::mem::replace(&mut self.facets[at(facet)].waiting, point);
        self.waiting[at(point)] = WaitingPoint { height, next };
    }

    /// Returns the points in a facet's list, with their heights.
    fn waiting_at(&self, facet: u32) -> impl Iterator<Item = (u32, f64)> {
        let listed = |point: u32| (point != NONE).then_some(point);
        let first = listed(self.facets[at(facet)].waiting);
        let next = move |&point: &u32| listed(self.waiting[at(point)].next);
        core::iter::successors(first, next).map(|point| (point, self.waiting[at(point)].height))
    }

    /// Returns the point with the largest height over a facet; `None` if that height is within the
    /// tolerance. Among points within a quarter of the tolerance of the largest height, the last in
    /// order of coordinates wins, and the first of coinciding points.
    fn farthest(&self, facet: u32) -> Option<u32> {
        let top = self.waiting_at(facet).fold(0.0, |top, (_, height)| larger(top, height));
        if top <= self.tolerance {
            return None;
        }
        let tied =
            self.waiting_at(facet).filter(|&(_, height)| height >= top - 0.25 * self.tolerance);
        let later = |best: u32, point: u32| {
            let [b, p] = [best, point].mapped(|index| &self.points[at(index)]);
            if precedes(b, p) || (b == p && point < best) { point } else { best }
        };
        tied.map(|(point, _)| point).reduce(later)
    }

    /// Extends the surface to the point with the largest height over a facet. Appends the new
    /// facets to `pending`. Does nothing for a removed facet, or if no point is higher than the
    /// tolerance.
    fn raise(&mut self, facet: u32, pending: &mut Vec<u32>) {
        if self.facets[at(facet)].visited == GONE {
            return;
        }
        let Some(point) = self.farthest(facet) else { return };
        self.look(point, facet);
        let first = self.replace(point);
        for index in 0..self.visible.len() {
            let facet = &mut self.facets[at(self.visible[index])];
            facet.visited = GONE;
            let mut next = facet.waiting;
            while next != NONE {
                let orphan = next;
                next = self.waiting[at(orphan)].next;
                if orphan != point {
                    self.assign(orphan, first);
                }
            }
        }
        pending.extend(first..index_of(self.facets.len()));
    }

    /// Finds the facets visible from a point, and their border. Writes them to `visible` and
    /// `horizon`. The visible facets are connected, so the search starts from one of them, `first`.
    fn look(&mut self, point: u32, first: u32) {
        self.searches += 1;
        self.visible.clear();
        self.horizon.clear();
        self.facets[at(first)].visited = self.searches;
        self.visible.push(first);
        let mut next = 0;
        while let Some(&facet) = self.visible.get(next) {
            next += 1;
            let Facet { corners, neighbors, .. } = self.facets[at(facet)];
            for side in 0..3 {
                let neighbor = neighbors[side];
                let beyond = &mut self.facets[at(neighbor)];
                if beyond.visited == self.searches {
                    continue;
                }
                if beyond.height(self.points, point) > 0.0 {
                    beyond.visited = self.searches;
                    self.visible.push(neighbor);
                } else {
                    let (from, to) = (corners[side], corners[(side + 1) % 3]);
                    self.horizon.push(HorizonSide { from, to, beyond: neighbor });
                }
            }
        }
    }

    /// Adds a fan of facets from the border to a point; returns the index of the first new facet.
    fn replace(&mut self, point: u32) -> u32 {
        sort_few(&mut self.horizon, |one, other| one.from < other.from);
        let first = index_of(self.facets.len());
        for (created, side) in (first..).zip(&self.horizon) {
            self.fan[at(side.from)] = created;
        }
        for (created, side) in (first..).zip(&self.horizon) {
            let HorizonSide { from, to, beyond } = *side;
            let neighbors = [beyond, self.fan[at(to)], NONE];
            self.facets.push(Facet::new(self.points, [from, to, point], neighbors));
            let beyond = &mut self.facets[at(beyond)];
            let shared = beyond.corners.iter().position(|&corner| corner == to);
            beyond.neighbors[shared.expect("neighbors share a side")] = created;
        }
        for (created, side) in (first..).zip(&self.horizon) {
            self.facets[at(self.fan[at(side.to)])].neighbors[2] = created;
        }
        first
    }

    /// Moves each remaining outside point to the facet over which it is highest. Appends to
    /// `pending` each facet that receives a point farther outside than the tolerance. Other points
    /// stay in their lists: later facets may be below them.
    fn promote(&mut self, pending: &mut Vec<u32>) {
        for facet in 0..index_of(self.facets.len()) {
            if self.facets[at(facet)].visited == GONE {
                continue;
            }
            let mut next = core::mem::replace(&mut self.facets[at(facet)].waiting, NONE);
            while next != NONE {
                let point = next;
                next = self.waiting[at(point)].next;
                let (best, distance) = self.farthest_outside(point, facet);
                self.wait(point, best, distance);
                if distance > self.tolerance {
                    pending.push(best);
                }
            }
        }
    }

    /// Returns the facet over which a point is highest, and how far the point is outside: its
    /// height over this facet or, if that is within the tolerance, the larger of that height and
    /// the distance from the visible facets. Beside the rim of a thin solid, a distant point has
    /// only small heights. The search starts from the facet `first`, which the point must be in
    /// front of.
    fn farthest_outside(&mut self, point: u32, first: u32) -> (u32, f64) {
        self.look(point, first);
        let mut best = (first, 0.0);
        for &facet in &self.visible {
            let height = self.facets[at(facet)].height(self.points, point);
            if height > best.1 {
                best = (facet, height);
            }
        }
        if best.1 > self.tolerance {
            return best;
        }
        let distances = self.visible.iter().map(|&facet| self.distance(facet, point));
        (best.0, larger(best.1, distances.fold(f64::INFINITY, f64::min)))
    }

    /// Returns the distance from a facet to a point in front of it.
    fn distance(&self, facet: u32, point: u32) -> f64 {
        let facet = &self.facets[at(facet)];
        let [a, b, c] = facet.corners.mapped(|corner| &self.points[at(corner)]);
        let position = &self.points[at(point)];
        let sides = [(a, b), (b, c), (c, a)];
        let is_inside = |(from, to): &(&P3, &P3)| {
            facet.normal.cross(&(*to - *from)).dot(&(position - *from)) >= 0.0
        };
        if sides.iter().all(is_inside) {
            return facet.height(self.points, point);
        }
        let distances = sides.mapped(|(from, to)| distance_from_segment(position, from, to));
        distances.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Returns the remaining facets with new indices.
    fn compacted(mut self) -> Vec<Facet> {
        let mut new_indices = vec![NONE; self.facets.len()];
        let mut count = 0;
        for (facet, new_index) in self.facets.iter().zip(&mut new_indices) {
            if facet.visited != GONE {
                *new_index = count;
                count += 1;
            }
        }
        self.facets.retain(|facet| facet.visited != GONE);
        for facet in &mut self.facets {
            facet.neighbors = facet.neighbors.mapped(|neighbor| new_indices[at(neighbor)]);
        }
        self.facets
    }
}
