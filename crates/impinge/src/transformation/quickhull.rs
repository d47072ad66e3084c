//! Quickhull in 3D, with exact decisions and a tolerance on what is worth a vertex.
//!
//! Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls" (1996). Who sees which
//! facet is decided by exact orientation, so the facets a point sees are always connected and their
//! border is always one loop: the surface stays closed and weakly convex whatever the input. Points
//! that are outside by no more than the tolerance are left there.

use super::span::{distance_from_segment, larger, precedes};
use crate::math::exact::{area_vector, volume};
use crate::math::{Point, Vector};

type P3 = Point<f64, 3>;

const NONE: u32 = u32::MAX;

/// A triangle of the surface, counter-clockwise from outside.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    pub(super) corners: [u32; 3],
    /// The facet beyond the side from each corner to the next.
    pub(super) neighbors: [u32; 3],
    /// Twice the area: volumes over it are heights.
    doubled_area: f64,
    /// Points in front of it and how far, each on the list of one facet only.
    outside: Vec<(u32, f64)>,
    is_alive: bool,
    /// The number of the last search that came by.
    seen: u32,
}

/// The surface while it grows.
pub(super) struct HullSurface<'a> {
    points: &'a [P3],
    facets: Vec<Facet>,
    /// Points no higher than this above every facet are left outside.
    tolerance: f64,
    searches: u32,
}

/// A side of a visible facet beyond which lies an invisible one.
#[derive(Clone, Copy)]
struct HorizonSide {
    from: u32,
    to: u32,
    beyond: u32,
}

fn at(index: u32) -> usize {
    index as usize
}

fn index_of(position: usize) -> u32 {
    // `convex_hull3` refuses more points than this holds, and facets are at most four per point.
    u32::try_from(position).expect("counts fit 32 bits")
}

fn area_vector_of(points: &[P3], [a, b, c]: [u32; 3]) -> Vector<f64, 3> {
    area_vector(&points[at(a)], &points[at(b)], &points[at(c)])
}

fn volume_over(points: &[P3], [a, b, c]: [u32; 3], point: u32) -> f64 {
    volume(&points[at(a)], &points[at(b)], &points[at(c)], &points[at(point)])
}

impl Facet {
    /// The outward unit normal.
    pub(super) fn normal(&self, points: &[P3]) -> Vector<f64, 3> {
        area_vector_of(points, self.corners) / larger(self.doubled_area, f64::MIN_POSITIVE)
    }

    /// Twice the area.
    pub(super) const fn doubled_area(&self) -> f64 {
        self.doubled_area
    }

    /// How far a point lies in front of it; the sign is exact.
    pub(super) fn height(&self, points: &[P3], point: u32) -> f64 {
        volume_over(points, self.corners, point) / larger(self.doubled_area, f64::MIN_POSITIVE)
    }
}

impl<'a> HullSurface<'a> {
    /// The facets of the hull, grown from a tetrahedron of four of the points; `None` if these lie in
    /// a plane.
    pub(super) fn grown(points: &'a [P3], first: [u32; 4], tolerance: f64) -> Option<Vec<Facet>> {
        let mut surface = Self { points, facets: Vec::new(), tolerance, searches: 0 };
        surface.start(first)?;
        surface.distribute((0..).take(points.len()), &[0, 1, 2, 3]);
        // Each call adds a vertex, gives a point up, or finds that a facet has nothing to add. The
        // last facet first: that stays where the memory is warm.
        let mut pending: Vec<u32> = vec![0, 1, 2, 3];
        while !pending.is_empty() {
            while let Some(facet) = pending.pop() {
                surface.raise(facet, &mut pending);
            }
            surface.promote(&mut pending);
        }
        Some(surface.compacted())
    }

    fn start(&mut self, [a, b, c, d]: [u32; 4]) -> Option<()> {
        let height = volume_over(self.points, [a, b, c], d);
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
            self.push(corners, neighbors);
        }
        Some(())
    }

    fn push(&mut self, corners: [u32; 3], neighbors: [u32; 3]) -> u32 {
        let doubled_area = area_vector_of(self.points, corners).norm();
        let outside = Vec::new();
        self.facets.push(Facet {
            corners,
            neighbors,
            doubled_area,
            outside,
            is_alive: true,
            seen: 0,
        });
        index_of(self.facets.len() - 1)
    }

    fn height(&self, facet: u32, point: u32) -> f64 {
        self.facets[at(facet)].height(self.points, point)
    }

    /// Puts each point on the list of the facet that it lies farthest in front of; drops those in
    /// front of none: they are inside for good.
    ///
    /// A point in front of a facet that was taken away, and outside, is in front of one of those put
    /// in its place.
    fn distribute(&mut self, points: impl Iterator<Item = u32>, facets: &[u32]) {
        for point in points {
            let (mut best, mut top) = (NONE, 0.0);
            for &facet in facets {
                let height = self.height(facet, point);
                if height > top {
                    (best, top) = (facet, height);
                }
            }
            if best != NONE {
                self.facets[at(best)].outside.push((point, top));
            }
        }
    }

    /// The point farthest in front of a facet, if any is above the tolerance.
    fn farthest(&self, facet: u32) -> Option<u32> {
        let outside = &self.facets[at(facet)].outside;
        let top = outside.iter().fold(0.0, |top, &(_, height)| larger(top, height));
        let mut best = None;
        for &(point, height) in outside {
            let precedes = |best: u32| precedes(&self.points[at(best)], &self.points[at(point)]);
            if height >= top - 0.25 * self.tolerance && best.is_none_or(precedes) {
                best = Some(point);
            }
        }
        best.filter(|_| top > self.tolerance)
    }

    /// Draws the surface out to the point farthest in front of a facet.
    fn raise(&mut self, facet: u32, pending: &mut Vec<u32>) {
        if !self.facets[at(facet)].is_alive {
            return;
        }
        let Some(point) = self.farthest(facet) else { return };
        let visible = self.visible_from(point, facet);
        let Some(horizon) = self.horizon(&visible) else {
            // Only products below the range of doubles lead here: the point is given up.
            self.facets[at(facet)].outside.retain(|&(other, _)| other != point);
            pending.push(facet);
            return;
        };
        let created = self.replace(point, &horizon);
        let mut orphans = Vec::new();
        for facet in visible {
            let facet = &mut self.facets[at(facet)];
            facet.is_alive = false;
            orphans.append(&mut facet.outside);
        }
        let orphans = orphans.into_iter().map(|(orphan, _)| orphan);
        self.distribute(orphans.filter(|&orphan| orphan != point), &created);
        pending.extend(created);
    }

    /// The facets that a point is in front of, found from one of them: they are connected.
    fn visible_from(&mut self, point: u32, first: u32) -> Vec<u32> {
        self.searches += 1;
        let search = self.searches;
        self.facets[at(first)].seen = search;
        let mut visible = vec![first];
        let mut next = 0;
        while let Some(&facet) = visible.get(next) {
            next += 1;
            for neighbor in self.facets[at(facet)].neighbors {
                if self.facets[at(neighbor)].seen != search && self.height(neighbor, point) > 0.0 {
                    self.facets[at(neighbor)].seen = search;
                    visible.push(neighbor);
                }
            }
        }
        visible
    }

    /// The border of the facets just found visible, in order of its vertices; `None` if it is not
    /// one loop.
    fn horizon(&self, visible: &[u32]) -> Option<Vec<HorizonSide>> {
        let mut sides = Vec::new();
        for &facet in visible {
            let Facet { corners, neighbors, .. } = &self.facets[at(facet)];
            for side in 0..3 {
                let beyond = neighbors[side];
                if self.facets[at(beyond)].seen != self.searches {
                    sides.push(HorizonSide {
                        from: corners[side],
                        to: corners[(side + 1) % 3],
                        beyond,
                    });
                }
            }
        }
        sides.sort_unstable_by_key(|side| side.from);
        let is_distinct = sides.windows(2).all(|pair| pair[0].from < pair[1].from);
        (is_distinct && sides.len() >= 3 && loop_length(&sides)? == sides.len()).then_some(sides)
    }

    /// Puts a fan of facets from the horizon to a point.
    fn replace(&mut self, point: u32, horizon: &[HorizonSide]) -> Vec<u32> {
        let first = index_of(self.facets.len());
        let facet_from = |vertex: u32| {
            let position = horizon.binary_search_by_key(&vertex, |side| side.from);
            first + index_of(position.expect("the horizon is one loop"))
        };
        let mut before = vec![NONE; horizon.len()];
        for (position, side) in horizon.iter().enumerate() {
            before[at(facet_from(side.to) - first)] = first + index_of(position);
        }
        for (side, before) in horizon.iter().zip(before) {
            let neighbors = [side.beyond, facet_from(side.to), before];
            let created = self.push([side.from, side.to, point], neighbors);
            let beyond = &mut self.facets[at(side.beyond)];
            let shared = beyond.corners.iter().position(|&corner| corner == side.to);
            beyond.neighbors[shared.expect("neighbors share a side")] = created;
        }
        (first..index_of(self.facets.len())).collect()
    }

    /// Moves each point left outside to the facet that it is highest over, and names those facets
    /// for which it is farther outside than the tolerance. The others stay: the surface may yet turn below
    /// them.
    fn promote(&mut self, pending: &mut Vec<u32>) {
        for facet in 0..index_of(self.facets.len()) {
            if !self.facets[at(facet)].is_alive {
                continue;
            }
            for (point, _) in core::mem::take(&mut self.facets[at(facet)].outside) {
                let (best, distance) = self.farthest_outside(point, facet);
                self.facets[at(best)].outside.push((point, distance));
                if distance > self.tolerance {
                    pending.push(best);
                }
            }
        }
    }

    /// The facet over which a point is highest, found from one that it is in front of, and how far it is
    /// outside: by that height, or from the surface. Beside the rim of something thin no facet has it in
    /// front by much.
    fn farthest_outside(&mut self, point: u32, first: u32) -> (u32, f64) {
        let mut best = (first, 0.0);
        let visible = self.visible_from(point, first);
        for &facet in &visible {
            let height = self.height(facet, point);
            if height > best.1 {
                best = (facet, height);
            }
        }
        if best.1 > self.tolerance {
            return best;
        }
        let distances = visible.iter().map(|&facet| self.distance(facet, point));
        (best.0, larger(best.1, distances.fold(f64::INFINITY, f64::min)))
    }

    /// How far a point in front of a facet is from it.
    fn distance(&self, facet: u32, point: u32) -> f64 {
        let facet = &self.facets[at(facet)];
        let [a, b, c] = facet.corners.map(|corner| &self.points[at(corner)]);
        let (place, normal) = (&self.points[at(point)], facet.normal(self.points));
        let sides = [(a, b), (b, c), (c, a)];
        let is_inside =
            |(from, to): &(&P3, &P3)| normal.cross(&(*to - *from)).dot(&(place - *from)) >= 0.0;
        if sides.iter().all(is_inside) {
            return facet.height(self.points, point);
        }
        let distances = sides.map(|(from, to)| distance_from_segment(place, from, to));
        distances.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The facets that are left, numbered anew.
    fn compacted(mut self) -> Vec<Facet> {
        let mut renamed = vec![NONE; self.facets.len()];
        let mut count = 0;
        for (facet, name) in self.facets.iter().zip(&mut renamed) {
            if facet.is_alive {
                *name = count;
                count += 1;
            }
        }
        self.facets.retain(|facet| facet.is_alive);
        for facet in &mut self.facets {
            facet.neighbors = facet.neighbors.map(|neighbor| renamed[at(neighbor)]);
        }
        self.facets
    }
}

/// How many sides it takes to come back to the first, the sides sorted by their start.
fn loop_length(sides: &[HorizonSide]) -> Option<usize> {
    let first = sides.first()?.from;
    let (mut vertex, mut length) = (first, 0);
    while length <= sides.len() {
        let position = sides.binary_search_by_key(&vertex, |side| side.from).ok()?;
        vertex = sides[position].to;
        length += 1;
        if vertex == first {
            break;
        }
    }
    Some(length)
}
