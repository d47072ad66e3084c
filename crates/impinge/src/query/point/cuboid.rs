//! The nearest point of the surface of a box between two corners.

use super::SurfacePoint;
use crate::math::{Point, Real, max, min};
use crate::shape::FeatureId;

/// Returns the nearest point of the surface. A point outside is clamped in every coordinate; a
/// point inside is projected onto the nearest face.
///
/// Corners may be at infinity.
pub(super) fn surface_point<N: Real, const D: usize>(
    corners: [&Point<N, D>; 2],
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let [mins, maxs] = corners;
    let outside = (0..D).any(|axis| point[axis] < mins[axis] || point[axis] > maxs[axis]);
    if !outside {
        return on_nearest_face(corners, point);
    }
    let mut nearest = *point;
    for axis in 0..D {
        nearest[axis] = max(min(point[axis], maxs[axis]), mins[axis]);
    }
    SurfacePoint::on(nearest, feature_beyond(corners, point))
}

/// Returns the nearest point on the nearest face; of several equally near faces, on the one with
/// the lowest index.
fn on_nearest_face<N: Real, const D: usize>(
    corners: [&Point<N, D>; 2],
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let [mins, maxs] = corners;
    let mut best = (0, maxs[0], maxs[0] - point[0]);
    let mut number = 0;
    for axis in 0..D {
        for (side, depth) in
            [(maxs[axis], maxs[axis] - point[axis]), (mins[axis], point[axis] - mins[axis])]
        {
            if depth < best.2 {
                best = (number, side, depth);
            }
            number += 1;
        }
    }
    let (number, side, _) = best;
    let mut nearest = *point;
    nearest[number / 2] = side;
    let number = u32::try_from(number).expect("a box has few faces");
    SurfacePoint { point: nearest, feature: FeatureId::Face(number), is_inside: true }
}

/// Returns the feature that is nearest to a point outside: a face if one coordinate lies beyond the
/// box, a vertex if all do, else an edge.
fn feature_beyond<N: Real, const D: usize>(
    corners: [&Point<N, D>; 2],
    point: &Point<N, D>,
) -> FeatureId {
    let [mins, maxs] = corners;
    let (mut beyond, mut last, mut free, mut positive) = (0, 0, 0, [0_u32; D]);
    for (axis, sign) in (0_u32..).zip(&mut positive) {
        let index = axis as usize;
        *sign = u32::from(point[index] > maxs[index]);
        if point[index] > maxs[index] || point[index] < mins[index] {
            beyond += 1;
            last = axis;
        } else {
            free = axis;
        }
    }
    if beyond == D {
        let bits = positive.iter().rev().fold(0, |bits, sign| 2 * bits + sign);
        return FeatureId::Vertex(bits);
    }
    if beyond == 1 {
        return FeatureId::Face(2 * last + 1 - positive[last as usize]);
    }
    let (next, after) = (positive[(free as usize + 1) % D], positive[(free as usize + 2) % D]);
    FeatureId::Edge(4 * free + next + 2 * after)
}
