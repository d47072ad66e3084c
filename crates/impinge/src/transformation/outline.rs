//! Convex outlines in 2D, and polygons from points.

use super::hull2::convex_hull2;
use super::lattice::area;
use super::span::{Scaled, distance_from_segment, first_three};
use crate::math::{Point, Real};
use crate::shape::{ConvexPolygon, ShapeError};

type P2 = Point<f64, 2>;

/// Removes points of a ring that lie, within `tolerance`, on the segment between their neighbours.
pub(super) fn thinned(points: &[P2], ring: Vec<usize>, tolerance: f64) -> Vec<usize> {
    let adds_nothing = |before: usize, at: usize, after: usize| {
        distance_from_segment(&points[at], &points[before], &points[after]) <= tolerance
    };
    let mut kept: Vec<usize> = Vec::with_capacity(ring.len());
    for index in ring {
        while let [.., before, last] = kept[..]
            && adds_nothing(before, last, index)
        {
            kept.pop();
        }
        kept.push(index);
    }
    // At the ends of the list, each iteration removes a point or ends the loop.
    while let [first, second, .., before, last] = kept[..] {
        if adds_nothing(before, last, first) {
            kept.pop();
        } else if adds_nothing(last, first, second) {
            kept.remove(0);
        } else {
            break;
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
