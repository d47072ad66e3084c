//! Fast rejection tests for rays that certainly miss a ball or a box, and for points that a solid
//! certainly does not contain. They save most exact tests of rays that hit the bounding box of a
//! solid but miss the solid.

use crate::bounding_volume::Ray;
use crate::math::{Point, Real, Vector, max, max_component, min};
use crate::shape::{Geometry, Kind, Triangle};

/// The margin by which a ray must miss a solid, in epsilon times products of coordinates and
/// direction components: several times the margin of the exact test.
const SLACK: f64 = 64.0;

/// Returns whether a ray certainly misses a ball or a box: a cast then finds nothing with any
/// options. Always false for other shapes, and near overflow or underflow.
#[inline(always)]
pub(crate) fn surely_misses<N: Real, const D: usize>(
    shape: Geometry<'_, N, D>,
    ray: &Ray<N, D>,
) -> bool {
    match shape.0 {
        Kind::Ball(ball) => passes_ball(ball.radius(), ray),
        Kind::Cuboid(cuboid) => passes_box(cuboid.half_extents(), ray),
        _ => false,
    }
}

/// Returns the absolute margin that covers terms lost to underflow.
fn lost<N: Real>() -> N {
    N::MIN_POSITIVE / N::EPSILON
}

/// Returns whether the first number is larger than the second by more than `slack`, and is finite.
#[inline(always)]
fn exceeds<N: Real>(first: N, second: N, slack: N) -> bool {
    first > second + slack && first < N::INFINITY
}

/// Returns whether the ball is behind the ray, or the line of the ray passes the centre at more
/// than the radius.
#[inline(always)]
fn passes_ball<N: Real, const D: usize>(radius: N, ray: &Ray<N, D>) -> bool {
    let unit = N::lit(SLACK) * N::EPSILON;
    let (origin, dir) = (&ray.origin.coords, &ray.dir);
    let (squared, distance) = (dir.norm_squared(), origin.norm_squared());
    let (radius_squared, away) = (radius * radius, origin.dot(dir));
    let is_outside = exceeds(distance, radius_squared, unit * distance + lost());
    if !is_outside {
        return false;
    }
    if exceeds(away, N::ZERO, lost()) {
        return true;
    }
    let apart = distance * squared;
    exceeds(apart - away * away, radius_squared * squared, unit * apart + lost())
}

/// Returns whether a separating axis shows that the line misses the box, or that the box is behind
/// the ray (Gottschalk, Lin and Manocha, "`OBBTree`", 1996).
#[inline(always)]
fn passes_box<N: Real, const D: usize>(half: &Vector<N, D>, ray: &Ray<N, D>) -> bool {
    let unit = N::lit(SLACK) * N::EPSILON;
    let Ray { origin, dir } = ray;
    (0..D).any(|axis| {
        let next = (axis + 1) % D;
        is_behind(half, ray, axis, unit) || {
            let moment = (origin[axis] * dir[next] - origin[next] * dir[axis]).abs();
            let (one, two) = (half[axis] * dir[next].abs(), half[next] * dir[axis].abs());
            let sizes = one + two + product_magnitudes(origin, dir, axis, next);
            exceeds(moment, one + two, unit * sizes + lost())
        }
    })
}

/// Returns the sum of the magnitudes of the two products in one component of the cross product of
/// origin and direction.
#[inline(always)]
fn product_magnitudes<N: Real, const D: usize>(
    origin: &Point<N, D>,
    dir: &Vector<N, D>,
    axis: usize,
    next: usize,
) -> N {
    (origin[axis] * dir[next]).abs() + (origin[next] * dir[axis]).abs()
}

/// Returns whether the ray starts outside the box on an axis and does not approach it along that
/// axis.
#[inline(always)]
fn is_behind<N: Real, const D: usize>(
    half: &Vector<N, D>,
    ray: &Ray<N, D>,
    axis: usize,
    unit: N,
) -> bool {
    let (origin, speed) = (ray.origin[axis], ray.dir[axis]);
    let goes_away = if origin < N::ZERO { speed <= N::ZERO } else { speed >= N::ZERO };
    let distance = origin.abs();
    goes_away && exceeds(distance, half[axis], unit * distance + lost())
}

/// Returns whether a solid may contain a point; false only if it certainly does not. A fast test
/// for the most frequent kinds, since most rays that come near a solid miss it.
pub(super) fn may_hold<N: Real, const D: usize>(kind: Kind<'_, N, D>, point: &Point<N, D>) -> bool {
    match kind {
        Kind::Triangle(triangle) => may_lie_on(triangle, point),
        Kind::Cuboid(cuboid) => {
            let is_beside = |axis: usize| point[axis].abs() > cuboid.half_extents()[axis];
            !(0..D).any(is_beside)
        }
        Kind::Ball(ball) => {
            let radius_squared = ball.radius() * ball.radius();
            let slack = N::lit(16.0) * N::EPSILON * radius_squared + N::MIN_POSITIVE;
            let is_beyond = point.coords.norm_squared() > radius_squared + slack;
            !is_beyond
        }
        _ => true,
    }
}

/// Returns whether the box of a triangle, loosened by the rounding error of a thin set, contains a
/// point.
fn may_lie_on<N: Real, const D: usize>(triangle: &Triangle<N, D>, point: &Point<N, D>) -> bool {
    let [a, b, c] = triangle.corners();
    let largest = |corner: &Point<N, D>| max_component(&corner.coords);
    let scale = max(max(largest(a), largest(b)), max(largest(c), largest(point)));
    // Twice the distance within which a point is treated as on a thin set.
    let slack = N::lit(16.0) * N::EPSILON * scale * N::TWO;
    (0..D).all(|axis| {
        let low = min(min(a[axis], b[axis]), c[axis]);
        let high = max(max(a[axis], b[axis]), c[axis]);
        let is_beside = point[axis] < low - slack || point[axis] > high + slack;
        !is_beside
    })
}

#[cfg(test)]
mod tests {
    use super::super::RayCast;
    use super::*;
    use crate::math::Space;
    use crate::shape::{Ball, Cuboid, Shape};

    fn bits(state: &mut u64) -> u64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        *state >> 33
    }

    /// Returns a small integer, so that rays touch faces and edges; or a number close to a small
    /// integer, so that they barely touch or miss; or an arbitrary number.
    fn number<N: Real>(state: &mut u64) -> N {
        let small = bits(state) as f64 % 9.0 - 4.0;
        let any = bits(state) as f64 / f64::from(1_u32 << 30) - 1.0;
        match bits(state) % 4 {
            0 => N::lit(4.0 * any),
            1 => N::lit(small * (1.0 + any * 1e-7)),
            _ => N::lit(small),
        }
    }

    fn vector<N: Real, const D: usize>(state: &mut u64, scale: f64) -> Vector<N, D> {
        Vector::<N, D>::from_fn(|_, _| number::<N>(state) * N::lit(scale))
    }

    /// Checks that a reported miss is a miss, and that most misses are reported at ordinary sizes.
    fn agrees_with_the_cast<N: Space<D>, const D: usize>(scale: f64, speed: f64) {
        let (mut state, mut missed, mut known) = (11, 0, 0);
        for _ in 0..20_000 {
            let state = &mut state;
            let ball = Ball::new(number::<N>(state).abs() * N::lit(scale));
            let cuboid = Cuboid::new(vector::<N, D>(state, scale).abs());
            let far = if bits(state).is_multiple_of(2) { 1.0 } else { 30.0 };
            let origin = Point::from(vector::<N, D>(state, scale * far));
            let ray = Ray::new(origin, vector::<N, D>(state, speed));
            for shape in [&ball as &dyn Shape<N, D>, &cuboid] {
                let solid = bits(state).is_multiple_of(2);
                let is_hit = shape.cast_local_ray_until(&ray, N::INFINITY, solid).is_some();
                let is_missed = surely_misses(shape.geometry(), &ray);
                assert!(!(is_hit && is_missed), "{shape:?} {ray:?}, solid: {solid}");
                missed += u32::from(!is_hit);
                known += u32::from(is_missed);
            }
        }
        let is_ordinary = scale == 1.0 && speed == 1.0;
        assert!(!is_ordinary || known * 10 > missed * 7, "{known} of {missed}");
    }

    #[test]
    fn what_is_missed_is_not_hit() {
        for (scale, speed) in [(1.0, 1.0), (1e18, 1.0), (1e-18, 1.0), (1.0, 1e-30), (1e12, 1e12)] {
            agrees_with_the_cast::<f32, 2>(scale, speed);
            agrees_with_the_cast::<f32, 3>(scale, speed);
            agrees_with_the_cast::<f64, 3>(scale, speed);
        }
        agrees_with_the_cast::<f32, 3>(1e-36, 1.0);
        agrees_with_the_cast::<f32, 3>(1e-20, 1e-20);
        agrees_with_the_cast::<f64, 3>(1e-160, 1e-150);
        agrees_with_the_cast::<f64, 2>(1e150, 1e150);
    }
}
