//! Nearest points of segments, used by the algorithms for several pairs of kinds.

use crate::collide::Pair;
use crate::collide::separation::wrong_kinds;
use crate::math::{Point, Real, Vector, cross, max, max_component, min};
use crate::shape::Kind;

/// Returns the ends and the radius of a segment or capsule, in its own frame.
pub(in crate::collide) fn core<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    kind: &Kind<'_, N, D>,
) -> ([Point<N, D>; 2], N) {
    match kind {
        Kind::Segment(segment) => ([*segment.a(), *segment.b()], N::ZERO),
        Kind::Capsule(capsule) => {
            ([*capsule.segment().a(), *capsule.segment().b()], capsule.radius())
        }
        _ => wrong_kinds(pair),
    }
}

/// Returns the point of a segment nearest to `point`, and whether it lies strictly between the
/// ends.
///
/// The point is computed from the nearer end, which keeps the rounding error small on long
/// segments.
#[inline]
pub(in crate::collide::separation) fn nearest_on_segment<N: Real, const D: usize>(
    ends: &[Point<N, D>; 2],
    point: &Point<N, D>,
) -> (Point<N, D>, bool) {
    let along = ends[1] - ends[0];
    let (from_a, to_b) = ((point - ends[0]).dot(&along), (ends[1] - point).dot(&along));
    if from_a > N::ZERO && to_b > N::ZERO {
        let whole = from_a + to_b;
        let nearest = if from_a < to_b {
            ends[0] + along * (from_a / whole)
        } else {
            ends[1] - along * (to_b / whole)
        };
        return (nearest, true);
    }
    (if from_a > N::ZERO { ends[1] } else { ends[0] }, false)
}

/// Returns the nearest points of two segments in 3D.
///
/// The candidates are each end with the nearest point of the other segment and, unless the segments
/// are parallel, the feet of their common perpendicular; in a tie, the first candidate is taken.
pub(in crate::collide::separation) fn nearest_of_segments<N: Real>(
    ends1: &[Point<N, 3>; 2],
    ends2: &[Point<N, 3>; 2],
) -> (Point<N, 3>, Point<N, 3>) {
    let perpendicular = common_perpendicular(ends1, ends2);
    if let Some(found) = &perpendicular
        && found.is_well_inside
    {
        return found.points;
    }
    let mut best = nearest_of_ends(ends1, ends2);
    if let Some(Perpendicular { points: (point1, point2), .. }) = perpendicular
        && (point2 - point1).norm_squared() < (best.1 - best.0).norm_squared()
    {
        best = (point1, point2);
    }
    best
}

/// Points where the common perpendicular of two lines meets both segments.
struct Perpendicular<N: Real> {
    points: (Point<N, 3>, Point<N, 3>),
    /// Whether both points are so far from all ends that no end can be as near, even with rounding
    /// errors.
    is_well_inside: bool,
}

/// Returns the nearest two points, one of each segment, of which at least one is an end of its
/// segment; in any dimension.
///
/// In 2D these are the nearest points of the segments, unless the segments cross.
pub(in crate::collide::separation) fn nearest_of_ends<N: Real, const D: usize>(
    ends1: &[Point<N, D>; 2],
    ends2: &[Point<N, D>; 2],
) -> (Point<N, D>, Point<N, D>) {
    let mut best = (ends1[0], nearest_on_segment(ends2, &ends1[0]).0);
    let others = [
        (ends1[1], nearest_on_segment(ends2, &ends1[1]).0),
        (nearest_on_segment(ends1, &ends2[0]).0, ends2[0]),
        (nearest_on_segment(ends1, &ends2[1]).0, ends2[1]),
    ];
    for (point1, point2) in others {
        if (point2 - point1).norm_squared() < (best.1 - best.0).norm_squared() {
            best = (point1, point2);
        }
    }
    best
}

/// Returns the feet of the common perpendicular of two lines; `None` for parallel lines, and unless
/// both feet lie on the segments.
///
/// The solution by cross products has an error of about the rounding error divided by the sine of
/// the angle between the lines. Two Newton steps from the residual each multiply the error by about
/// that quotient again.
fn common_perpendicular<N: Real>(
    ends1: &[Point<N, 3>; 2],
    ends2: &[Point<N, 3>; 2],
) -> Option<Perpendicular<N>> {
    let (along1, along2) = (ends1[1] - ends1[0], ends2[1] - ends2[0]);
    // Directions scaled to length about 1, so that fourth powers neither overflow nor underflow.
    let (size1, size2) =
        (max_component(&along1).power_of_two_below(), max_component(&along2).power_of_two_below());
    let (toward1, toward2) = (along1 / size1, along2 / size2);
    let across = cross(&toward1, &toward2);
    let squared = across.norm_squared();
    let tiny = N::lit(64.0) * N::EPSILON * N::EPSILON;
    let (squared1, squared2) = (toward1.norm_squared(), toward2.norm_squared());
    if squared <= tiny * squared1 * squared2 {
        return None;
    }
    let (mut s, mut t) = (N::ZERO, N::ZERO);
    let mut between = ends2[0] - ends1[0];
    for _ in 0..3 {
        s += cross(&between, &toward2).dot(&across) / squared / size1;
        t += cross(&between, &toward1).dot(&across) / squared / size2;
        between = (ends2[0] + along2 * t) - (ends1[0] + along1 * s);
    }
    let inside = |u: N| u >= N::ZERO && u <= N::ONE;
    (inside(s) && inside(t)).then(|| {
        // Let one point move by a length along its line. Wherever the other point is, the squared
        // distance grows by at least the square of that length times the sine of the angle between
        // the lines.
        let far1 = min(s, N::ONE - s) * size1;
        let far2 = min(t, N::ONE - t) * size2;
        let growth = min(far1 * far1 / squared2, far2 * far2 / squared1) * squared;
        let size = ends1
            .iter()
            .chain(ends2)
            .fold(N::ZERO, |size, end| max(max_component(&end.coords), size));
        let rounding = N::lit(1024.0) * N::EPSILON * size * size;
        let is_well_inside = growth > rounding && rounding > N::MIN_POSITIVE;
        Perpendicular { points: (ends1[0] + along1 * s, ends2[0] + along2 * t), is_well_inside }
    })
}

/// Returns the signed gap between two point sets along `normal`, a unit vector from the first to
/// the second.
pub(in crate::collide::separation) fn gap_along<N: Real, const D: usize>(
    normal: &Vector<N, D>,
    points1: &[Point<N, D>],
    points2: &[Point<N, D>],
) -> N {
    let high = points1.iter().fold(-N::INFINITY, |high, p| max(normal.dot(&p.coords), high));
    let low = points2.iter().fold(N::INFINITY, |low, p| min(normal.dot(&p.coords), low));
    low - high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossing_lines_meet_at_their_perpendicular() {
        let p = Point::<f64, 3>::new;
        let (point1, point2) = nearest_of_segments(
            &[p(-1.0, 0.0, 0.0), p(3.0, 0.0, 0.0)],
            &[p(1.0, -1.0, 2.0), p(1.0, 1.0, 2.0)],
        );
        assert_eq!((point1, point2), (p(1.0, 0.0, 0.0), p(1.0, 0.0, 2.0)), "one above the other");
    }

    #[test]
    fn nearly_parallel_lines_are_exact() {
        // The lines cross at (0, 0, ±0.005), at an angle whose tangent is 1e-3.
        let p = Point::<f32, 3>::new;
        let (point1, point2) = nearest_of_segments(
            &[p(-1.0, 0.0, -0.005), p(1.0, 0.0, -0.005)],
            &[p(-1.0, -1e-3, 0.005), p(1.0, 1e-3, 0.005)],
        );
        assert!(((point2 - point1).norm() - 0.01).abs() < 1e-8, "{point1} {point2}");
    }
}
