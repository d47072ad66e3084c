//! Convex hulls in 2D.

use super::lattice::area;
use super::outline::thinned;
use super::span::{Scaled, first_three, precedes};
use crate::math::{Point, Real};
use crate::shape::ShapeError;

/// Returns the convex hull of some points: the indices of its corners, counter-clockwise, starting
/// at the corner with the smallest x, and of several such corners at the corner with the smallest
/// y.
///
/// Uses the first of coinciding points; points on a side are left out. A corner within `4 ·
/// N::EPSILON · max |coordinate|` of the line between its neighbours is treated as a point on a
/// side. So every given point is inside the polygon or within twice that distance of the polygon.
/// The time is O(n log n).
///
/// # Errors
/// If there are fewer than three points, a coordinate is not finite, or the points span no area
/// beyond rounding: [`ShapeError::Degenerate`] with the dimension 0 (a point) or 1 (a line).
///
/// ```
/// use impinge::math::Point;
/// use impinge::transformation::convex_hull2;
///
/// let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [0.0, 2.0]].map(Point::<f32, 2>::from);
/// assert_eq!(convex_hull2(&points), Ok(vec![0, 2, 3]));
/// ```
pub fn convex_hull2<N: Real>(points: &[Point<N, 2>]) -> Result<Vec<usize>, ShapeError> {
    let scaled = Scaled::of(points, 3)?;
    first_three(&scaled)?;
    let order = distinct(&scaled.points);
    let mut ring = chain(&scaled.points, order.iter().copied());
    let upper = chain(&scaled.points, order.iter().rev().copied());
    // The last point of each chain is the first point of the other chain.
    ring.pop();
    ring.extend_from_slice(&upper[..upper.len() - 1]);
    let ring = thinned(&scaled.points, ring, scaled.flat());
    if ring.len() < 3 {
        return Err(ShapeError::Degenerate { dimension: 1 });
    }
    Ok(from_first(&scaled.points, ring))
}

/// Rotates a ring so that it starts at its first corner by coordinates: thinning may have removed
/// the corner at which it started.
fn from_first(points: &[Point<f64, 2>], mut ring: Vec<usize>) -> Vec<usize> {
    let is_before = |at: usize, other: usize| precedes(&points[ring[at]], &points[ring[other]]);
    let first = (1..ring.len()).fold(0, |first, at| if is_before(at, first) { at } else { first });
    ring.rotate_left(first);
    ring
}

/// Returns the indices sorted by coordinates; of equal points only the first.
fn distinct(points: &[Point<f64, 2>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    // The coordinates are finite, and `precedes` orders them by value: a total order.
    order.sort_by(|&i, &j| {
        let (a, b) = (&points[i], &points[j]);
        let is_before = precedes(a, b);
        if is_before { core::cmp::Ordering::Less } else { precedes(b, a).cmp(&false) }
    });
    order.dedup_by(|later, earlier| points[*later] == points[*earlier]);
    order
}

/// Returns one chain of the hull, from the first point of `order` to the last: the lower chain if
/// `order` ascends, the upper chain if it descends. Every corner turns left.
///
/// Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions" (1979).
fn chain(points: &[Point<f64, 2>], order: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut chain: Vec<usize> = Vec::new();
    for index in order {
        while let [.., before, last] = chain[..]
            && area(&points[before], &points[last], &points[index]) <= 0.0
        {
            chain.pop();
        }
        chain.push(index);
    }
    chain
}
