//! Ball against box, in closed form, in any dimension.

use crate::collide::Pair;
use crate::collide::separation::projection::{Projection, center_in_second};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, max, min, unit};
use crate::shape::Kind;

/// Returns the separation of a ball from a box; `None` above `limit`.
///
/// If the centre is inside the box, the ball is pushed out through the nearest face. In a tie, the
/// axis with the smaller index and its positive side win.
pub(in crate::collide::separation) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Kind::Ball(ball), Kind::Cuboid(cuboid)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(cuboid.half_extents(), &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// Projects a point onto a box.
#[inline]
pub(in crate::collide::separation) fn project<N: Real, const D: usize>(
    half_extents: &Vector<N, D>,
    center: &Point<N, D>,
) -> Projection<N, D> {
    let clamped = center.coords.zip_map(half_extents, |x, h| max(min(x, h), -h));
    match unit(&(center.coords - clamped)) {
        Some((outward, distance)) => Projection { distance, outward, point: Point::from(clamped) },
        None => project_inside(half_extents, center),
    }
}

/// Projects a point inside the box or on its surface.
fn project_inside<N: Real, const D: usize>(
    half_extents: &Vector<N, D>,
    center: &Point<N, D>,
) -> Projection<N, D> {
    let depth = |axis: usize| center[axis].abs() - half_extents[axis];
    let nearest = (1..D).fold(0, |best, axis| if depth(axis) > depth(best) { axis } else { best });
    let sign = if center[nearest] < N::ZERO { -N::ONE } else { N::ONE };
    let (mut outward, mut point) = (Vector::<N, D>::zeros(), *center);
    outward[nearest] = sign;
    point[nearest] = sign * half_extents[nearest];
    Projection { distance: depth(nearest), outward, point }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_inside_and_in_the_middle() {
        let half = Vector::<f64, 3>::new(1.0, 2.0, 3.0);
        let corner = project(&half, &Point::<f64, 3>::new(2.0, 4.0, -5.0));
        assert_eq!(corner.distance, 3.0, "from the corner (1, 2, -3) by (1, 2, -2)");
        assert_eq!(corner.point, Point::<f64, 3>::new(1.0, 2.0, -3.0), "the corner");
        let inside = project(&half, &Point::<f64, 3>::new(0.0, -1.75, 0.0));
        assert_eq!(inside.distance, -0.25, "to the face below");
        assert_eq!(inside.outward.y, -1.0, "out through the face below");
        let middle = project(&Vector::<f64, 2>::new(1.0, 1.0), &Point::origin());
        assert_eq!(middle.outward, Vector::<f64, 2>::new(1.0, 0.0), "the tie goes to +x");
    }
}
