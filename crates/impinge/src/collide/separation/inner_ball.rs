//! Proves overlaps by balls inside the solids: if the balls overlap, so do the solids.

use super::shared_corner::rounding;
use crate::collide::Pair;
use crate::math::{Point, Real, Vector, max, min};
use crate::shape::{Cone, Kind, SupportMap};

/// Fraction of the sum of both radii below which the distance of the centres proves an overlap.
const SHARE: f64 = 1023.0 / 1024.0;

/// Returns whether balls inside the two solids overlap by more than rounding. `false` proves
/// nothing.
pub(super) fn inner_balls_meet<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> bool {
    let (Some((center1, radius1)), Some((center2, radius2))) = (of(pair.first), of(pair.second))
    else {
        return false;
    };
    let between = (pair.pose12.point(&center2) - center1).norm_squared();
    let is_within = |distance: N| between < distance * distance;
    let max_distance = (radius1 + radius2) * N::lit(SHARE);
    // Solids far from the origins of their own frames, such as parts of a level, have errors beyond
    // their radii. This bound is needed rarely, so it is computed last.
    is_within(max_distance) && is_within(max(max_distance - rounding(pair), N::ZERO))
}

/// Returns centre and radius of a ball inside a solid, in the frame of the solid. `None` for the
/// kinds that are not listed below: balls themselves, triangles, tapered capsules, support maps,
/// half-spaces and composites. The ball of a segment has radius zero.
fn of<N: Real, const D: usize>(kind: Kind<'_, N, D>) -> Option<(Point<N, D>, N)> {
    let least = |sizes: &Vector<N, D>| sizes.iter().fold(N::MAX, |least, &size| min(size, least));
    Some(match kind {
        Kind::Segment(segment) => (segment.center(), N::ZERO),
        Kind::Capsule(capsule) => (capsule.center(), capsule.radius()),
        Kind::Cuboid(cuboid) => (Point::origin(), least(cuboid.half_extents())),
        Kind::Polytope(polytope) => (polytope.center(), polytope.inner_radius()),
        Kind::Cylinder(cylinder, _) => {
            (Point::origin(), min(cylinder.half_height(), cylinder.radius()))
        }
        Kind::Cone(cone, _) => of_cone(cone),
        Kind::Ellipsoid(ellipsoid) => (Point::origin(), least(ellipsoid.half_axes())),
        Kind::Rounded(solid) => {
            let (center, radius) = of(solid.inner().0)?;
            (center, radius + solid.radius())
        }
        _ => return None,
    })
}

/// Returns centre and radius of a cone's inscribed ball, which touches base and side: the axial
/// section of the ball is the incircle of the axial section of the cone.
fn of_cone<N: Real, const D: usize>(cone: &Cone<N>) -> (Point<N, D>, N) {
    let (height, radius) = (cone.half_height() * N::TWO, cone.radius());
    let side = (height * height + radius * radius).sqrt();
    let inner = if side > N::ZERO { height * (radius / (radius + side)) } else { N::ZERO };
    let mut center = Point::origin();
    center[1] = inner - cone.half_height();
    (center, inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Pose;
    use crate::shape::{
        Capsule, ConvexHull, Cuboid, Cylinder, Ellipsoid, Rounded, Segment, Shape, Triangle,
    };

    #[test]
    fn balls_touch_the_surface() {
        let corners = [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
        let corners = corners.map(Point::<f64, 3>::from);
        let solids: [(Box<dyn Shape<f64, 3>>, f64); 7] = [
            (Box::new(Cuboid::new(Vector::<f64, 3>::new(3.0, 2.0, 4.0))), 2.0),
            (Box::new(Cylinder::new(3.0, 4.0)), 3.0),
            (Box::new(Cone::new(2.0, 3.0)), 1.5),
            (Box::new(Ellipsoid::new(Vector::<f64, 3>::new(3.0, 2.0, 4.0))), 2.0),
            (Box::new(Capsule::new(1.0, 0.5)), 0.5),
            (Box::new(Rounded::new(Cylinder::new(3.0, 4.0), 0.25)), 3.25),
            (Box::new(ConvexHull::from_points(&corners)), 0.75_f64.sqrt()),
        ];
        // The centre of the hull is the mean of its corners, not the centre of the largest ball.
        for (solid, expected) in solids {
            let (_, radius) = of(solid.geometry().0).expect("a ball is known");
            assert!((radius - expected).abs() < 1e-14, "{radius} in {solid:?}");
        }
    }

    #[test]
    fn balls_that_are_apart_say_nothing() {
        let (long, cone) = (Cuboid::new(Vector::<f64, 3>::new(9.0, 1.0, 1.0)), Cone::new(2.0, 3.0));
        let at = |x| Pair {
            first: long.geometry().0,
            second: cone.geometry().0,
            pose12: Pose::from_translation(Vector::<f64, 3>::new(x, 0.5, 0.0)),
        };
        assert!(inner_balls_meet(&at(2.49)), "1 and 1.5 exceed the distance");
        assert!(!inner_balls_meet(&at(2.51)), "though the solids overlap");
        assert!(!inner_balls_meet(&at(f64::NAN)), "nowhere");
    }

    #[test]
    fn what_lies_beside_its_origin_has_its_ball_there() {
        let at = |x: f64| Point::<f64, 3>::new(x, 0.0, 0.0);
        let (far, ball) = (Segment::new(at(5.0), at(7.0)), Capsule::<f64, 3>::new(1.0, 1.0));
        let (first, second) = (far.geometry().0, ball.geometry().0);
        let pose_at = |x: f64| Pose::from_translation(Vector::<f64, 3>::new(x, 0.0, 0.0));
        assert!(!inner_balls_meet(&Pair { first, second, pose12: pose_at(0.0) }), "it begins at 5");
        assert!(inner_balls_meet(&Pair { first, second, pose12: pose_at(6.0) }), "in its middle");
        let tip = Triangle::new(at(5.0), at(6.0), at(7.0));
        let first = tip.geometry().0;
        assert!(!inner_balls_meet(&Pair { first, second, pose12: pose_at(0.0) }), "none is known");
    }
}
