//! Covers of bodies by balls, which the filter tests in place of the bodies, and bounding balls of
//! sets of balls.

use crate::math::{Point, Pose, Real, Vector, max};
use crate::shape::{Kind, Shape};

/// The maximum number of balls that cover a body.
const MAX_BALLS: usize = 8;

/// The number of steps towards the smallest bounding ball. After k steps the relative error of the
/// radius is about 1 / √k at most.
const STEPS: usize = 256;

/// A ball in the frame of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct CoverBall<N: Real, const D: usize> {
    pub(super) center: Vector<N, D>,
    pub(super) radius: N,
}

/// Returns balls that cover a shape at a pose, and whether the shape equals the single ball
/// returned.
///
/// The balls are in a row along the longest side of the shape's box and cover the box. A ball of
/// infinite radius covers an unbounded shape.
pub(super) fn cover<N: Real, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Pose<N, D>,
) -> (Vec<CoverBall<N, D>>, bool) {
    if let Kind::Ball(ball) = shape.geometry().0 {
        return (vec![CoverBall { center: pose.translation, radius: ball.radius() }], true);
    }
    let aabb = shape.local_aabb();
    if !aabb.holds_finite_point() || !aabb.is_bounded() {
        return (vec![CoverBall { center: pose.translation, radius: N::INFINITY }], false);
    }
    let half = aabb.half_extents();
    let longest = (1..D).fold(0, |best, axis| if half[axis] > half[best] { axis } else { best });
    let mut across = half;
    across[longest] = N::ZERO;
    let count = (1..MAX_BALLS)
        .find(|&count| half[longest] <= across.norm() * N::lit(small(count)))
        .unwrap_or(MAX_BALLS);
    let step = half[longest] / N::lit(small(count));
    let radius = (across.norm_squared() + step * step).sqrt();
    let ball = |index: usize| {
        let mut center = aabb.center();
        center[longest] += step * (N::lit(small(2 * index + 1)) - N::lit(small(count)));
        CoverBall { center: pose.point(&center).coords, radius }
    };
    ((0..count).map(ball).collect(), false)
}

/// Converts a small count to `f64`.
fn small(count: usize) -> f64 {
    f64::from(u32::try_from(count).expect("a small number"))
}

/// Returns a bounding ball of the balls that is close to the smallest one. There must be at least
/// one ball.
///
/// M. Bădoiu and K. L. Clarkson, "Smaller core-sets for balls" (2003): each step moves the centre
/// towards the farthest ball.
pub(super) fn around<N: Real, const D: usize>(balls: &[CoverBall<N, D>]) -> CoverBall<N, D> {
    let radius_around =
        |center: &Vector<N, D>, ball: &CoverBall<N, D>| (ball.center - center).norm() + ball.radius;
    let radius = |center: &Vector<N, D>| {
        balls.iter().fold(N::ZERO, |r, ball| max(radius_around(center, ball), r))
    };
    let points: Vec<_> = balls.iter().map(|ball| Point::from(ball.center)).collect();
    let mut center = crate::math::centroid(&points).coords;
    let mut best = CoverBall { center, radius: radius(&center) };
    for step in 1..STEPS {
        let farthest = balls.iter().fold(&balls[0], |best, ball| {
            if radius_around(&center, ball) > radius_around(&center, best) { ball } else { best }
        });
        let away = farthest.center - center;
        let length = away.norm();
        // Moves the centre towards the farthest point of that ball.
        let shift = if length > N::ZERO {
            away * (radius_around(&center, farthest) / length)
        } else {
            away
        };
        center += shift / N::lit(small(step + 1));
        let found = radius(&center);
        if found < best.radius {
            best = CoverBall { center, radius: found };
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Ball, Cuboid};

    #[test]
    fn boxes_are_held_by_a_row() {
        let long = Cuboid::new(Vector::<f64, 3>::new(0.3, 4.0, 0.4));
        let (balls, is_ball) = cover(&long, &Pose::identity());
        assert!(!is_ball && balls.len() == 8, "{} balls", balls.len());
        for corner in [[0.3, 4.0, 0.4], [-0.3, 0.5, 0.4], [0.3, -3.3, -0.4], [0.3, -4.0, 0.4]] {
            let corner = Vector::<f64, 3>::from(corner);
            let is_held = |ball: &CoverBall<f64, 3>| {
                (ball.center - corner).norm() <= ball.radius * (1.0 + 1e-12)
            };
            assert!(balls.iter().any(is_held), "{corner}");
        }
        let ball = cover(&Ball::new(2.0_f64), &Pose::<f64, 2>::identity());
        assert!(ball.1 && ball.0[0].radius == 2.0, "itself");
    }

    #[test]
    fn two_balls_have_a_ball_around() {
        let ball = |x, radius| CoverBall { center: Vector::<f64, 2>::new(x, 0.0), radius };
        let around = around(&[ball(-1.0, 1.0), ball(3.0, 2.0), ball(0.0, 0.5)]);
        assert!((around.radius - 3.5).abs() < 0.05, "from -2 to 5: {}", around.radius);
    }
}
