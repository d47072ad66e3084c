//! Nearest points of segments: the arithmetic that several pairs share.

use super::wrong_kinds;
use crate::math::{Point, Real, Vector, cross, max, max_component, min};
use crate::query::Pair;
use crate::shape::Kind;

/// The ends and the radius of a segment or capsule.
pub(super) fn core<N: Real, const D: usize>(
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

/// The point of a segment nearest to `point`, and whether it lies between the ends.
///
/// Measured from the nearer end, so that long segments lose nothing.
#[inline]
pub(super) fn nearest_on_segment<N: Real, const D: usize>(
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

/// The nearest points of two segments in space.
///
/// The candidates are each end against the other segment and, unless the segments are parallel, the
/// common perpendicular of their lines; the first of equals is taken.
pub(super) fn nearest_of_segments<N: Real>(
    ends1: &[Point<N, 3>; 2],
    ends2: &[Point<N, 3>; 2],
) -> (Point<N, 3>, Point<N, 3>) {
    let crossing = common_perpendicular(ends1, ends2);
    match crossing {
        Some(Crossing { points, is_certain: true }) => points,
        Some(Crossing { points, .. }) => nearer(nearest_of_ends(ends1, ends2), points),
        None => nearest_of_ends(ends1, ends2),
    }
}

/// The second of two pairs of points if that is nearer, else the first.
fn nearer<N: Real>(
    first: (Point<N, 3>, Point<N, 3>),
    second: (Point<N, 3>, Point<N, 3>),
) -> (Point<N, 3>, Point<N, 3>) {
    let squared = |(a, b): &(Point<N, 3>, Point<N, 3>)| (b - a).norm_squared();
    if squared(&second) < squared(&first) { second } else { first }
}

/// Where the common perpendicular of two lines meets two segments.
struct Crossing<N: Real> {
    points: (Point<N, 3>, Point<N, 3>),
    /// All ends are farther by more than rounding.
    is_certain: bool,
}

/// The nearest points of two segments if at least one of them is an end, in any dimension.
///
/// In the plane these are the nearest points of any two segments that do not cross.
pub(super) fn nearest_of_ends<N: Real, const D: usize>(
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

/// Where the common perpendicular of two lines meets them, if it meets both segments.
///
/// The solution by cross products is off by rounding over the sine of the angle between the lines;
/// each of two Newton steps from the residual reduces that by the same factor.
fn common_perpendicular<N: Real>(
    ends1: &[Point<N, 3>; 2],
    ends2: &[Point<N, 3>; 2],
) -> Option<Crossing<N>> {
    let (along1, along2) = (ends1[1] - ends1[0], ends2[1] - ends2[0]);
    // Directions of length about 1, so that fourth powers stay numbers of the type.
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
    if !(inside(s) && inside(t)) {
        return None;
    }
    let points = (ends1[0] + along1 * s, ends2[0] + along2 * t);
    let is_inner = [s, t].iter().all(|&u| u > N::lit(INNER) && u < N::lit(1.0 - INNER));
    // The square of the sine of the angle times that of the shorter length.
    let across = min(squared / squared1 * size2 * size2, squared / squared2 * size1 * size1);
    let is_certain = is_inner
        && squared > N::lit(WIDE) * squared1 * squared2
        && across > N::lit(CERTAIN) * N::EPSILON * farthest_squared([ends1, ends2]);
    Some(Crossing { points, is_certain })
}

/// Lines at an angle with a larger squared sine meet at a place that rounding leaves alone.
const WIDE: f64 = 1.0 / 64.0;
/// So far from the ends, as a share of the lengths, a place is in the middle.
const INNER: f64 = 1.0 / 16.0;
/// Seen from the place where the perpendicular meets it, an end is farther from the other line by at least
/// [`INNER`] of its side times the sine of the angle. The square of that must exceed so many rounding units
/// of the square of all coordinates, of which squared distances may be off by a few hundred.
const CERTAIN: f64 = 1024.0 / (INNER * INNER);

/// The square of the largest coordinate.
fn farthest_squared<N: Real>(segments: [&[Point<N, 3>; 2]; 2]) -> N {
    let mut most = N::ZERO;
    for end in segments.into_iter().flatten() {
        most = max(max_component(&end.coords), most);
    }
    most * most
}

/// How far apart two sets of points are along a unit vector from the first to the second.
pub(super) fn gap_along<N: Real, const D: usize>(
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

    /// Where the ends are not looked at they are farther, also as computed.
    fn certain_places_are_the_nearest<N: Real>() {
        let (mut state, mut certain) = (7_u64, 0);
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for round in 0..20_000 {
            // Some touch, some are short for where they are, some are nearly parallel.
            let gap = [0.0, 1e-7, 1e-3, 1.0][round % 4];
            let (size, turn) = ([1.0, 0.1, 1e-3][round % 3], [1.0, 0.2, 1e-2][round / 4 % 3]);
            let mut vector = |size: f64| [size * next(), size * next(), size * next()];
            let (place, along, lean) = (vector(1.0), vector(size), vector(size * turn));
            let (share1, share2, across) = (vector(0.6), vector(0.6), vector(gap));
            let point = |share: f64, along: [f64; 3], at: [f64; 3]| {
                let axis = |axis: usize| N::lit(at[axis] + share * along[axis]);
                Point::<N, 3>::new(axis(0), axis(1), axis(2))
            };
            let other = [0, 1, 2].map(|axis| along[axis] + lean[axis]);
            let beside = [0, 1, 2].map(|axis| place[axis] + across[axis]);
            let ends1 =
                [point(share1[0] - 0.5, along, place), point(share1[0] + 0.5, along, place)];
            let ends2 =
                [point(share2[0] - 0.5, other, beside), point(share2[0] + 0.5, other, beside)];
            let Some(crossing) = common_perpendicular(&ends1, &ends2) else { continue };
            if crossing.is_certain {
                let slowly = nearer(nearest_of_ends(&ends1, &ends2), crossing.points);
                assert_eq!(slowly, crossing.points, "round {round}: {ends1:?} {ends2:?}");
                certain += 1;
            }
        }
        assert!(certain > 1000, "{certain} are certain");
    }

    #[test]
    fn ends_are_left_out_only_where_they_are_farther() {
        certain_places_are_the_nearest::<f32>();
        certain_places_are_the_nearest::<f64>();
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
