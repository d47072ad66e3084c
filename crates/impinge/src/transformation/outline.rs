//! Convex outlines in 2D, and polygons from points.

use super::hull2::convex_hull2;
use super::lattice::area;
use super::span::{Scaled, distance_from_segment, first_three};
use crate::math::{Point, Real, Vector};
use crate::shape::{ConvexPolygon, ShapeError};

type P2 = Point<f64, 2>;

/// The directions from a point that lead past other points within a tolerance (K. Reumann and
/// A. P. M. Witkam's strip, narrowed by each point as by H. Imai and M. Iri, 1986).
///
/// ```text
///          · · high          each point narrows the sides to the
///   from ·──────(p)──── ·    tangents of the circle around it
///          · · low
/// ```
#[derive(Default)]
struct Corridor {
    /// Unit vectors along the right and the left side; `None` if every direction is allowed.
    sides: Option<[Vector<f64, 2>; 2]>,
    /// Distance of the farthest point.
    reach: f64,
}

impl Corridor {
    /// Returns whether all points added lie, within `tolerance`, on the segment from the tip to
    /// `end`, which is relative to the tip.
    fn leads_to(&self, end: &Vector<f64, 2>, tolerance: f64) -> bool {
        let is_between =
            |[right, left]: [Vector<f64, 2>; 2]| right.perp(end) >= 0.0 && end.perp(&left) >= 0.0;
        self.sides.is_none_or(is_between) && end.norm() + tolerance >= self.reach
    }

    /// Narrows the corridor to the directions that lead past `point`, which is relative to the tip.
    fn add(&mut self, point: &Vector<f64, 2>, tolerance: f64) {
        let length = point.norm();
        self.reach = self.reach.max(length);
        if length <= tolerance {
            return;
        }
        let sine = tolerance / length;
        let (along, aside) = ((1.0 - sine * sine).sqrt() / length, sine / length);
        let across = Vector::<f64, 2>::new(-point.y, point.x) * aside;
        let [right, left] = [point * along - across, point * along + across];
        let [old_right, old_left] = self.sides.unwrap_or([right, left]);
        let is_inside = [old_right.perp(&right) > 0.0, left.perp(&old_left) > 0.0];
        self.sides = Some([
            if is_inside[0] { right } else { old_right },
            if is_inside[1] { left } else { old_left },
        ]);
    }
}

/// Removes points of a ring that lie, within twice `tolerance`, on a side of what is left.
pub(super) fn thinned(points: &[P2], ring: Vec<usize>, tolerance: f64) -> Vec<usize> {
    let mut kept = vec![ring[0]];
    let (mut from, mut last, mut corridor) = (ring[0], None, Corridor::default());
    for index in ring[1..].iter().copied().chain([ring[0]]) {
        if let Some(corner) = last
            && !corridor.leads_to(&(points[index] - points[from]), tolerance)
        {
            kept.push(corner);
            (from, corridor) = (corner, Corridor::default());
        }
        corridor.add(&(points[index] - points[from]), tolerance);
        last = Some(index);
    }
    without_flat_corners(points, &kept, tolerance)
}

/// Removes corners of a ring that lie, within `tolerance`, on the segment between their neighbours;
/// of two neighbours at most one, and never more than leave three. [`thinned`] may keep such a
/// corner, where another point would be too far from the segment.
fn without_flat_corners(points: &[P2], ring: &[usize], tolerance: f64) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::with_capacity(ring.len());
    let (mut removable, mut was_removed) = (ring.len().saturating_sub(3), false);
    for (at, &index) in ring.iter().enumerate() {
        let [before, after] = [at + ring.len() - 1, at + 1].map(|other| ring[other % ring.len()]);
        let height = distance_from_segment(&points[index], &points[before], &points[after]);
        // The last corner is a neighbour of the first.
        let is_beside_first = at + 1 == ring.len() && kept.first() != ring.first();
        was_removed = removable > 0 && !was_removed && !is_beside_first && height <= tolerance;
        if was_removed {
            removable -= 1;
        } else {
            kept.push(index);
        }
    }
    kept
}

/// Returns the indices of the corners of a convex outline, counter-clockwise. The points are given
/// in order along the outline, in either direction.
///
/// Checks that every corner turns left and the outline goes around once: its upward sides form one
/// unbroken run.
fn outline(points: &[P2], tolerance: f64) -> Result<Vec<usize>, ShapeError> {
    let mut ring = thinned(points, (0..points.len()).collect(), tolerance);
    let doubled: f64 = (0..ring.len())
        .map(|at| (points[ring[at]], points[ring[(at + 1) % ring.len()]]))
        .map(|(a, b)| {
            (a.x - points[0].x) * (b.y - points[0].y) - (b.x - points[0].x) * (a.y - points[0].y)
        })
        .sum();
    if doubled < 0.0 {
        ring.reverse();
    }
    let is_upward = |from: usize, to: usize| {
        let side = points[to] - points[from];
        side.y > 0.0 || (side.y == 0.0 && side.x > 0.0)
    };
    let mut runs = 0;
    for at in 0..ring.len() {
        let corner = ring[at];
        let (before, after) =
            (ring[(at + ring.len() - 1) % ring.len()], ring[(at + 1) % ring.len()]);
        runs += u32::from(is_upward(corner, after) && !is_upward(before, corner));
        if runs > 1 || area(&points[before], &points[corner], &points[after]) <= 0.0 {
            return Err(ShapeError::NotConvex { index: corner });
        }
    }
    Ok(ring)
}

impl<N: Real> ConvexPolygon<N> {
    /// Builds the polygon with a given convex outline, counter-clockwise or clockwise. A clockwise
    /// outline is reversed, so its vertices get the opposite order.
    ///
    /// Points that coincide with a neighbour or lie, within 4 rounding units of the largest
    /// coordinate, on the segment between their neighbours are left out.
    ///
    /// # Errors
    /// If there are fewer than three points, a coordinate is not finite, the points span no area
    /// ([`ShapeError::Degenerate`]), or the outline is not convex or goes around twice
    /// ([`ShapeError::NotConvex`], with the index of the point at which this is detected).
    pub fn try_new(points: &[Point<N, 2>]) -> Result<Self, ShapeError> {
        let scaled = Scaled::of(points, 3)?;
        first_three(&scaled)?;
        let ring = outline(&scaled.points, scaled.flat())?;
        if ring.len() < 3 {
            return Err(ShapeError::Degenerate { dimension: 1 });
        }
        Ok(Self::from_corners(ring.into_iter().map(|index| points[index]).collect()))
    }

    /// Returns the convex hull of points in any order; see [`convex_hull2`].
    ///
    /// # Errors
    /// If there are fewer than three points, a coordinate is not finite, or the points span no
    /// area.
    pub fn try_from_points(points: &[Point<N, 2>]) -> Result<Self, ShapeError> {
        let ring = convex_hull2(points)?;
        Ok(Self::from_corners(ring.into_iter().map(|index| points[index]).collect()))
    }
}
