//! Segments and capsules among themselves, in space.

use super::projection::{first_axis, made_perpendicular, noise, perpendicular_to};
use super::segments::{core, gap_along, nearest_of_segments};
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, cross, max, unit};
use crate::query::Pair;

/// The separation of two segments or capsules in space.
///
/// Segments that meet are parted along their common perpendicular with depth zero; those on one
/// line along a fixed perpendicular of it; two points at one place along the first axis.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let ((ends1, rounding1), (local2, rounding2)) =
        (core(pair, &pair.first), core(pair, &pair.second));
    let ends2 = local2.map(|end| pair.pose12.point(&end));
    let (point1, point2) = nearest_of_segments(&ends1, &ends2);
    let distance = (point2 - point1).norm();
    if !(distance - rounding1 - rounding2 <= limit) {
        return None;
    }
    let normal = best_normal(&ends1, &ends2, &(point2 - point1));
    Some(Separation { distance, normal, point1, point2 }.rounded(rounding1, rounding2))
}

/// The unit vector along which the segments are farthest apart.
///
/// Right is the direction between the nearest points. Where these are close that is mostly
/// rounding, and a direction made from the segments themselves separates better: each candidate is
/// judged by the gap that it really leaves, the first of equals (up to rounding) is taken.
fn best_normal<N: Real>(
    ends1: &[Point<N, 3>; 2],
    ends2: &[Point<N, 3>; 2],
    offset: &Vector<N, 3>,
) -> Vector<N, 3> {
    let axes = [ends1, ends2].map(|ends| unit(&(ends[1] - ends[0])).map(|(axis, _)| axis));
    let across = match axes {
        [Some(axis1), Some(axis2)] => unit(&cross(&axis1, &axis2)).map(|(across, _)| across),
        _ => None,
    };
    let reach = ends1.iter().chain(ends2).fold(N::ZERO, |most, p| max(p.coords.norm(), most));
    let mut best: Option<(N, Vector<N, 3>)> = None;
    let candidates = [
        unit(offset).map(|(along, _)| along),
        axes[0].and_then(|axis| made_perpendicular(offset, &axis)),
        axes[1].and_then(|axis| made_perpendicular(offset, &axis)),
        across,
        across.map(|across| -across),
        axes[0].map(|axis| perpendicular_to(&axis)),
        axes[0].map(|axis| -perpendicular_to(&axis)),
        axes[1].map(|axis| perpendicular_to(&axis)),
        axes[1].map(|axis| -perpendicular_to(&axis)),
    ];
    for normal in candidates.into_iter().flatten() {
        let gap = gap_along(&normal, ends1, ends2);
        if best.is_none_or(|(widest, _)| gap > widest + noise(reach)) {
            best = Some((gap, normal));
        }
    }
    best.map_or_else(first_axis, |(_, normal)| normal)
}
