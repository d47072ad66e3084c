//! Segments and capsules against each other in 3D.

use super::nearest::{core, gap_along, nearest_of_segments};
use crate::collide::Pair;
use crate::collide::separation::projection::{
    first_axis, made_perpendicular, perpendicular_to, rounding_error,
};
use crate::convex::Separation;
use crate::math::{Mapped, Point, Real, Vector, cross, max, unit};

/// Returns the separation of two segments or capsules in 3D; `None` above `limit`.
///
/// Crossing cores have distance zero, and their common perpendicular is the normal. Overlapping
/// cores on one line get a fixed perpendicular of the line; two coinciding points get the first
/// axis.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let ((ends1, rounding1), (local2, rounding2)) =
        (core(pair, &pair.first), core(pair, &pair.second));
    let ends2 = local2.mapped(|end| pair.pose12.point(&end));
    let points = nearest_of_segments(&ends1, &ends2);
    of_points(&[ends1, ends2], &points, [rounding1, rounding2], limit)
}

/// Returns the separation of two segments with radii, from the nearest points of the segments;
/// `None` above `limit`.
#[inline]
pub(in crate::collide) fn of_points<N: Real>(
    [ends1, ends2]: &[[Point<N, 3>; 2]; 2],
    &(point1, point2): &(Point<N, 3>, Point<N, 3>),
    [radius1, radius2]: [N; 2],
    limit: N,
) -> Option<Separation<N, 3>> {
    let distance = (point2 - point1).norm();
    (distance - radius1 - radius2 <= limit).then(|| {
        let normal = best_normal(ends1, ends2, &(point2 - point1));
        Separation { distance, normal, point1, point2 }.rounded(radius1, radius2)
    })
}

/// Returns the distance of [`separation`], without computing the normal.
pub(in crate::collide::separation) fn distance<N: Real>(pair: &Pair<'_, N, 3>) -> N {
    let ((ends1, rounding1), (local2, rounding2)) =
        (core(pair, &pair.first), core(pair, &pair.second));
    let (point1, point2) =
        nearest_of_segments(&ends1, &local2.mapped(|end| pair.pose12.point(&end)));
    (point2 - point1).norm() - rounding1 - rounding2
}

/// Returns the unit vector along which the gap between the segments is largest.
///
/// In exact arithmetic it is the direction from one nearest point to the other. If these points are
/// close to each other, the direction is mostly rounding error, and a direction computed from the
/// segments themselves has a larger gap. The candidate with the largest gap is returned; among gaps
/// that are equal up to rounding, the first candidate wins.
fn best_normal<N: Real>(
    ends1: &[Point<N, 3>; 2],
    ends2: &[Point<N, 3>; 2],
    offset: &Vector<N, 3>,
) -> Vector<N, 3> {
    let reach = ends1.iter().chain(ends2).fold(N::ZERO, |most, p| max(p.coords.norm(), most));
    let mut widest = Widest { ends1, ends2, rounding_error: rounding_error(reach), best: None };
    let direct = unit(offset).map(|(along, _)| along);
    widest.consider(direct);
    // The gap cannot exceed the distance by more than rounding.
    let is_best = widest
        .best
        .is_some_and(|(gap, _)| gap + widest.rounding_error / N::lit(4.0) >= offset.norm());
    if let Some(normal) = direct.filter(|_| is_best) {
        return normal;
    }
    let axes = [ends1, ends2].map(|ends| unit(&(ends[1] - ends[0])).map(|(axis, _)| axis));
    let across = match axes {
        [Some(axis1), Some(axis2)] => unit(&cross(&axis1, &axis2)).map(|(across, _)| across),
        _ => None,
    };
    for axis in axes {
        widest.consider(axis.and_then(|axis| made_perpendicular(offset, &axis)));
    }
    widest.consider_both(across);
    for axis in axes {
        widest.consider_both(axis.map(|axis| perpendicular_to(&axis)));
    }
    widest.best.map_or_else(first_axis, |(_, normal)| normal)
}

/// Search for the normal with the largest gap between two segments. Keeps the first of several
/// normals whose gaps differ by at most `rounding_error`.
struct Widest<'a, N: Real> {
    ends1: &'a [Point<N, 3>; 2],
    ends2: &'a [Point<N, 3>; 2],
    /// Gaps that differ by less count as equal.
    rounding_error: N,
    /// Largest gap so far and its normal.
    best: Option<(N, Vector<N, 3>)>,
}

impl<N: Real> Widest<'_, N> {
    /// Replaces the best normal if the gap of `normal` is larger by more than `rounding_error`.
    fn consider(&mut self, normal: Option<Vector<N, 3>>) {
        let Some(normal) = normal else { return };
        let gap = gap_along(&normal, self.ends1, self.ends2);
        if self.best.is_none_or(|(widest, _)| gap > widest + self.rounding_error) {
            self.best = Some((gap, normal));
        }
    }

    fn consider_both(&mut self, normal: Option<Vector<N, 3>>) {
        self.consider(normal);
        self.consider(normal.map(|normal| -normal));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Pose;
    use crate::shape::{Capsule, Segment, Shape};

    fn p(x: f64, y: f64, z: f64) -> Point<f64, 3> {
        Point::<f64, 3>::new(x, y, z)
    }

    fn of(shape1: &dyn Shape<f64, 3>, shape2: &dyn Shape<f64, 3>) -> Separation<f64, 3> {
        let (first, second) = (shape1.geometry().0, shape2.geometry().0);
        let pair = Pair { first, second, pose12: Pose::identity() };
        separation(&pair, f64::INFINITY).expect("nothing is beyond infinity")
    }

    #[test]
    fn one_above_the_other() {
        let low = Segment::new(p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0));
        let high = Capsule::try_from_ends(p(0.5, -1.0, 2.0), p(0.5, 1.0, 2.0), 0.25);
        let found = of(&low, &high.expect("finite"));
        assert_eq!((found.distance, found.normal.z), (1.75, 1.0), "straight up");
        assert_eq!(found.point1, p(0.5, 0.0, 0.0), "below the crossing");
        assert_eq!(found.point2, p(0.5, 0.0, 1.75), "the bottom of the capsule");
    }

    #[test]
    fn crossing_segments_have_no_depth_but_a_normal() {
        let along_x = Segment::new(p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0));
        let along_y = Segment::new(p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0));
        let found = of(&along_x, &along_y);
        assert_eq!((found.distance, found.normal.z.abs()), (0.0, 1.0), "out of their plane");
        let thick = |a, b| Capsule::try_from_ends(a, b, 0.5).expect("finite");
        let found = of(&thick(*along_x.a(), *along_x.b()), &thick(*along_y.a(), *along_y.b()));
        assert_eq!((found.distance, found.normal.z.abs()), (-1.0, 1.0), "both radii deep");
    }

    #[test]
    fn on_one_line() {
        let near = Segment::new(p(0.0, 0.0, 0.0), p(2.0, 0.0, 0.0));
        let beyond = Segment::new(p(5.0, 0.0, 0.0), p(9.0, 0.0, 0.0));
        let found = of(&near, &beyond);
        assert_eq!((found.distance, found.normal.x), (3.0, 1.0), "end to end");
        let over = Segment::new(p(1.0, 0.0, 0.0), p(9.0, 0.0, 0.0));
        let found = of(&near, &over);
        assert_eq!((found.distance, found.normal.x), (0.0, 0.0), "they leave sideways");
        let point = Segment::new(p(1.0, 0.0, 0.0), p(1.0, 0.0, 0.0));
        assert_eq!(of(&point, &point).normal, Vector::<f64, 3>::x(), "two points at one position");
    }

    #[test]
    fn side_by_side() {
        let left = Segment::new(p(0.0, 0.0, 0.0), p(0.0, 4.0, 0.0));
        let right = Segment::new(p(3.0, 1.0, 4.0), p(3.0, 9.0, 4.0));
        let found = of(&left, &right);
        assert_eq!(found.distance, 5.0, "3 across and 4 up");
        assert!((found.normal - Vector::<f64, 3>::new(0.6, 0.0, 0.8)).norm() < 1e-15, "across");
    }
}
