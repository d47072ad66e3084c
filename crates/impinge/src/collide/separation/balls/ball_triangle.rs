//! Ball against triangle in 3D, where a triangle has no thickness.

use super::ball_segment::Foot;
use crate::collide::Pair;
use crate::collide::separation::projection::{
    Projection, center_in_second, made_perpendicular, rounding_error,
};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, cross, max, unit};
use crate::shape::Kind;

/// Returns the separation of a ball from a triangle in 3D; `None` above `limit`.
///
/// If the centre lies on the triangle, the ball is pushed out to the side from which the corners
/// run counter-clockwise. A triangle without area is handled as the segment of its longest side.
pub(crate) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (Kind::Ball(ball), Kind::Triangle(triangle)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(triangle.corners(), &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// Projects a point onto a triangle; the distance is never negative.
pub(in crate::collide::separation) fn project<N: Real>(
    corners: &[Point<N, 3>; 3],
    center: &Point<N, 3>,
) -> Projection<N, 3> {
    let Some(front) = front(corners) else {
        return on_longest_side(corners, center).projection();
    };
    if let Some((distance, outward)) = height_over(corners, &front, center) {
        return Projection { distance, outward, point: center - outward * distance };
    }
    let mut projected = on_nearest_side(corners, center).projection();
    // Close to a side the offset is mostly rounding error. The normal of the triangle replaces it
    // if the height along this normal is larger by more than rounding.
    let normal = toward(&front, &(center - corners[0]));
    if height(&normal, corners, center)
        > height(&projected.outward, corners, center) + rounding_error(reach(corners, center))
    {
        projected.outward = normal;
    }
    projected
}

/// Returns the distance of [`project`], without computing a direction.
pub(in crate::collide::separation) fn distance_from<N: Real>(
    corners: &[Point<N, 3>; 3],
    center: &Point<N, 3>,
) -> N {
    let Some(front) = front(corners) else { return on_longest_side(corners, center).distance };
    let over = height_over(corners, &front, center);
    over.map_or_else(|| on_nearest_side(corners, center).distance, |(distance, _)| distance)
}

/// Returns the distance of a point that projects into the triangle, and the unit normal of the
/// triangle on the side of the point. `front` is the triangle's front normal. `None` if the point
/// projects elsewhere.
fn height_over<N: Real>(
    corners: &[Point<N, 3>; 3],
    front: &Vector<N, 3>,
    center: &Point<N, 3>,
) -> Option<(N, Vector<N, 3>)> {
    let normal = toward(front, &(center - corners[0]));
    let is_over = lies_over(corners, front, center);
    is_over.then(|| (max((center - corners[0]).dot(&normal), N::ZERO), normal))
}

/// Returns the point of the longest side nearest to `center`. Used for triangles that are segments
/// up to rounding, whose longest side contains the other two sides.
fn on_longest_side<N: Real>(corners: &[Point<N, 3>; 3], center: &Point<N, 3>) -> Foot<N, 3> {
    let side = longest_side(corners);
    Foot::new([corners[side], corners[(side + 1) % 3]], center)
}

/// Returns the unit normal on the side from which the corners run counter-clockwise; `None` for a
/// triangle that is a segment up to rounding.
///
/// It is computed from the longest side and the perpendicular to it, so that rounding can tilt the
/// normal of a thin triangle only about the longest side.
fn front<N: Real>(corners: &[Point<N, 3>; 3]) -> Option<Vector<N, 3>> {
    let side = |at: usize| corners[(at + 1) % 3] - corners[at % 3];
    let longest = longest_side(corners);
    let (along, length) = unit(&side(longest))?;
    let next = side(longest + 1);
    let inward = made_perpendicular(&next, &along)?;
    let thin = next.dot(&inward) <= N::lit(16.0) * N::EPSILON * length;
    unit(&cross(&along, &inward)).filter(|_| !thin).map(|(front, _)| front)
}

/// Returns the index of the longest side; the first side wins a tie.
fn longest_side<N: Real>(corners: &[Point<N, 3>; 3]) -> usize {
    let squared = |at: usize| (corners[(at + 1) % 3] - corners[at]).norm_squared();
    let longer = |a: usize, b: usize| if squared(b) > squared(a) { b } else { a };
    longer(longer(0, 1), 2)
}

/// Returns the point of the three sides nearest to `center`; the first side wins a tie.
fn on_nearest_side<N: Real>(corners: &[Point<N, 3>; 3], center: &Point<N, 3>) -> Foot<N, 3> {
    let [a, b, c] = *corners;
    let mut best = Foot::new([a, b], center);
    for side in [[b, c], [c, a]] {
        let foot = Foot::new(side, center);
        if foot.distance < best.distance {
            best = foot;
        }
    }
    best
}

/// Returns `normal`, negated if its dot product with `direction` is negative.
fn toward<N: Real>(normal: &Vector<N, 3>, direction: &Vector<N, 3>) -> Vector<N, 3> {
    if normal.dot(direction) < N::ZERO { -normal } else { *normal }
}

/// Returns whether `p` projects into the triangle with the front normal `front`.
fn lies_over<N: Real>(corners: &[Point<N, 3>; 3], front: &Vector<N, 3>, p: &Point<N, 3>) -> bool {
    (0..3).all(|side| {
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        cross(&(to - from), &(p - from)).dot(front) >= N::ZERO
    })
}

/// Returns the largest distance of the corners and `p` from the origin.
fn reach<N: Real>(corners: &[Point<N, 3>; 3], p: &Point<N, 3>) -> N {
    corners.iter().fold(p.coords.norm(), |most, corner| max(corner.coords.norm(), most))
}

/// Returns the smallest signed height of `p` above the corners, along `direction`.
fn height<N: Real>(direction: &Vector<N, 3>, corners: &[Point<N, 3>; 3], p: &Point<N, 3>) -> N {
    corners.iter().fold(N::INFINITY, |least, corner| {
        let above = direction.dot(&(p - corner));
        if above < least { above } else { least }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    #[test]
    fn over_the_face_a_side_and_a_corner() {
        let corners = CORNERS.map(Point::from);
        let p = Point::<f64, 3>::new;
        let below = project(&corners, &p(1.0, 1.0, -2.0));
        assert_eq!((below.distance, below.outward.z), (2.0, -1.0), "below the face");
        let side = project(&corners, &p(2.0, -3.0, 4.0));
        assert_eq!((side.distance, side.point), (5.0, p(2.0, 0.0, 0.0)), "beside a side");
        let corner = project(&corners, &p(6.0, -1.0, 2.0));
        assert_eq!((corner.distance, corner.point), (3.0, p(4.0, 0.0, 0.0)), "beyond a corner");
        let on = project(&corners, &p(1.0, 1.0, 0.0));
        assert_eq!((on.distance, on.outward.z), (0.0, 1.0), "on the face, to its first side");
    }

    #[test]
    fn without_area_it_is_a_segment() {
        let line = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]].map(Point::from);
        let projected = project(&line, &Point::<f64, 3>::new(1.0, 3.0, 0.0));
        assert_eq!((projected.distance, projected.outward.y), (3.0, 1.0), "above the segment");
        let on = project(&line, &Point::<f64, 3>::new(1.0, 0.0, 0.0));
        assert_eq!((on.distance, on.outward.x), (0.0, 0.0), "leaves sideways");
        let doubled = [[2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [-2.0, 0.0, 0.0]].map(Point::from);
        let on = project(&doubled, &Point::<f64, 3>::new(1.0, 0.0, 0.0));
        assert_eq!((on.distance, on.outward.x), (0.0, 0.0), "one side is a point");
    }
}
