//! Ball against triangle in 2D: by the side or corner nearest to the centre.

use crate::collide::Pair;
use crate::collide::separation::polygons::polygon_polygon;
use crate::collide::separation::projection::{Projection, center_in_second, rounding_error};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, cross2, max, max_component, perp, unit};
use crate::shape::Kind;

/// Returns the separation of a ball from a triangle in 2D; `None` above `limit`. A triangle that is
/// a segment up to rounding is passed to [`polygon_polygon`].
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 2>,
    limit: N,
) -> Option<Separation<N, 2>> {
    let (Kind::Ball(ball), Kind::Triangle(triangle)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    match project(triangle.corners(), &center_in_second(&pair.pose12)) {
        Some(projected) => projected.of_ball(ball.radius(), &pair.pose12, limit),
        None => polygon_polygon::separation(pair, limit),
    }
}

/// A directed side of a triangle, with the inside of the triangle on its left, and the height of
/// the projected point above it.
#[derive(Clone, Copy)]
struct DirectedEdge<N: Real> {
    /// Start of the side.
    from: Point<N, 2>,
    /// Unit direction from the start to the end of the side.
    along: Vector<N, 2>,
    /// Length of the side.
    length: N,
    /// Signed height of the projected point above the line of the side, positive outside.
    height: N,
}

impl<N: Real> DirectedEdge<N> {
    fn new([from, to]: [Point<N, 2>; 2], center: &Point<N, 2>) -> Option<Self> {
        let (along, length) = unit(&(to - from))?;
        let height = -perp(&along).dot(&(center - from));
        Some(Self { from, along, length, height })
    }

    fn outward(&self) -> Vector<N, 2> {
        -perp(&self.along)
    }

    /// Returns whether `center` is outside this side and projects between its ends.
    fn is_below(&self, center: &Point<N, 2>) -> bool {
        let coordinate = self.along.dot(&(center - self.from));
        self.height > N::ZERO && coordinate > N::ZERO && coordinate < self.length
    }

    /// Projects `center` onto the line of the side.
    fn projection(&self, center: &Point<N, 2>) -> Projection<N, 2> {
        let (distance, outward) = (self.height, self.outward());
        Projection { distance, outward, point: center - outward * distance }
    }
}

/// Projects a point onto a triangle, whose corners may be in either order; `None` for a triangle
/// that is a segment up to rounding, and for NaN.
///
/// A point inside is projected onto the nearest side. In a tie, the first side of the
/// counter-clockwise outline wins, which begins at the first corner.
pub(in crate::collide::separation) fn project<N: Real>(
    &[a, b, c]: &[Point<N, 2>; 3],
    center: &Point<N, 2>,
) -> Option<Projection<N, 2>> {
    // Scaled by a power of two, so that the product neither overflows nor underflows.
    let size = max(max_component(&(b - a)), max_component(&(c - a))).power_of_two_below();
    let turns_left = cross2(&((b - a) / size), &((c - a) / size)) >= N::ZERO;
    let [a, b, c] = if turns_left { [a, b, c] } else { [a, c, b] };
    let sides = [
        DirectedEdge::new([a, b], center)?,
        DirectedEdge::new([b, c], center)?,
        DirectedEdge::new([c, a], center)?,
    ];
    if !has_area(&sides) {
        return None;
    }
    if let Some(below) = sides.iter().find(|side| side.is_below(center)) {
        return Some(below.projection(center));
    }
    let higher = |one: DirectedEdge<N>, other: DirectedEdge<N>| {
        if other.height > one.height { other } else { one }
    };
    let highest = higher(higher(sides[0], sides[1]), sides[2]);
    if highest.height > N::ZERO {
        return Some(from_corner(&[a, b, c], center, &highest));
    }
    // A NaN height gives `None`.
    (highest.height <= N::ZERO).then(|| highest.projection(center))
}

/// Returns whether a corner lies off the longest side by more than rounding; `false` for NaN.
fn has_area<N: Real>(sides: &[DirectedEdge<N>; 3]) -> bool {
    let [side, next, last] = sides;
    let longest = max(max(side.length, next.length), last.length);
    let sine = cross2(&side.along, &next.along);
    let area = sine * (side.length / longest) * (next.length / longest);
    area > N::lit(64.0) * N::EPSILON
}

/// Projects the point onto the nearest corner; the first corner wins a tie. If that corner is so
/// close that the direction from it is mostly rounding error, the normal of the side `highest` is
/// used.
fn from_corner<N: Real>(
    corners: &[Point<N, 2>; 3],
    center: &Point<N, 2>,
    highest: &DirectedEdge<N>,
) -> Projection<N, 2> {
    let far = corners.iter().fold(N::ZERO, |far, p| max(max_component(&(center - p)), far));
    let size = far.power_of_two_below();
    let squared = |corner: &Point<N, 2>| ((center - corner) / size).norm_squared();
    let [a, b, c] = corners;
    let nearer = |one, other| if squared(other) < squared(one) { other } else { one };
    let point = *nearer(nearer(a, b), c);
    let offset = center - point;
    let reach = max(max_component(&center.coords), max_component(&point.coords));
    match unit(&offset) {
        Some((outward, distance)) if distance > rounding_error(reach) => {
            Projection { distance, outward, point }
        }
        _ => Projection { distance: offset.norm(), outward: highest.outward(), point },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Pose;
    use crate::shape::{Ball, Shape, Triangle};

    fn p(x: f64, y: f64) -> Point<f64, 2> {
        Point::<f64, 2>::new(x, y)
    }

    #[test]
    fn over_a_side_a_corner_and_inside() {
        for corners in
            [[p(0.0, 0.0), p(4.0, 0.0), p(0.0, 3.0)], [p(0.0, 0.0), p(0.0, 3.0), p(4.0, 0.0)]]
        {
            let projected = |x, y| project(&corners, &p(x, y)).expect("it has an area");
            assert_eq!(
                (projected(1.0, -2.0).distance, projected(1.0, -2.0).point),
                (2.0, p(1.0, 0.0))
            );
            assert_eq!(
                (projected(7.0, -4.0).distance, projected(7.0, -4.0).point),
                (5.0, p(4.0, 0.0))
            );
            let inside = projected(0.5, 1.0);
            assert_eq!((inside.distance, inside.outward.x), (-0.5, -1.0), "out to the left");
        }
    }

    #[test]
    fn without_area_it_is_left_to_others() {
        let line = [p(0.0, 0.0), p(2.0, 0.0), p(1.0, 0.0)];
        assert_eq!(project(&line, &p(1.0, 1.0)), None, "a segment");
        assert_eq!(project(&[p(1.0, 1.0); 3], &p(1.0, 2.0)), None, "a point");
        let corners = [p(0.0, 0.0), p(4.0, 0.0), p(0.0, 3.0)];
        assert_eq!(project(&corners, &p(f64::NAN, 1.0)), None, "nowhere");
    }

    /// Asserts, for random triangles and points, that [`project`] returns the distance, normal and
    /// point that [`polygon_polygon::separation`] computes, up to rounding.
    #[test]
    fn as_outlines_have_it() {
        let (mut inside, mut tried) = (0, 0);
        for n in 0..4000_u32 {
            let number = |k: u32| {
                let rounding_error = (f64::from(n * 8 + k) * 12.9898).sin() * 43758.5453;
                4.0 * (rounding_error - rounding_error.floor()) - 2.0
            };
            let corners = [0, 2, 4].map(|k| p(number(k), number(k + 1)));
            let center = Vector::<f64, 2>::new(number(6), number(7));
            let Some(projected) = project(&corners, &Point::from(center)) else { continue };
            let (ball, triangle) =
                (Ball::new(0.0), Triangle::new(corners[0], corners[1], corners[2]));
            let pose12 = Pose::from_translation(-center);
            let first = Shape::<f64, 2>::geometry(&ball).0;
            let pair = Pair { first, second: triangle.geometry().0, pose12 };
            let expected = polygon_polygon::separation(&pair, f64::INFINITY);
            let expected = expected.expect("nothing is beyond infinity");
            assert!((projected.distance - expected.distance).abs() < 1e-13, "{corners:?} {center}");
            assert!((projected.outward + expected.normal).norm() < 1e-9, "{corners:?} {center}");
            let point = projected.point - center - expected.point2;
            assert!(point.norm() < 1e-9, "{corners:?} {center}");
            inside += u32::from(projected.distance < 0.0);
            tried += 1;
        }
        assert!(tried > 3900 && inside * 20 > tried, "{inside} of {tried} are inside");
    }
}
