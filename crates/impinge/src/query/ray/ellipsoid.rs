//! Ray casts against an ellipsoid, in any dimension: the span of time during which the ray's line
//! is inside.

use super::ball::roots;
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::collide::separation::balls::ball_ellipsoid::project;
use crate::math::{Real, Vector, max, max_component, min, unit_or};
use crate::shape::{Ellipsoid, FeatureId};

/// Returns the span, computed in units of the half axes, in which the ellipsoid is a unit ball;
/// `None` if the line misses the ellipsoid. An ellipsoid with a zero half axis is hit in one point,
/// unless the line lies in its plane.
pub(super) fn span<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let across = ellipsoid
        .half_axes()
        .zip_map(&ray.dir, |half, along| if half == N::ZERO { along } else { N::ZERO });
    let is_flat = ellipsoid.half_axes().iter().any(|&half| half == N::ZERO);
    let steepest = across.iamax();
    let is_crossed = across[steepest].abs() > N::lit(4.0) * N::EPSILON * max_component(&ray.dir);
    match (is_flat, is_crossed) {
        (false, _) => inside(ellipsoid, ray),
        (true, true) => through(ellipsoid, ray, steepest),
        (true, false) => lengthwise(ellipsoid, ray),
    }
}

/// Returns the origin and direction of the line in units of the half axes; zero on axes whose half
/// axis is zero.
///
/// The direction is divided by a power of two near its length, which is also returned.
fn squeezed<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    ray: &Ray<N, D>,
) -> (Vector<N, D>, Vector<N, D>, N) {
    let in_units = |v: &Vector<N, D>| {
        v.zip_map(ellipsoid.half_axes(), |x, half| if half > N::ZERO { x / half } else { N::ZERO })
    };
    let dir = in_units(&ray.dir);
    let speed = max_component(&dir).power_of_two_below();
    (in_units(&ray.origin.coords), dir / speed, speed)
}

/// Returns the span in the ellipsoid, computed only from the axes whose half axis is not zero;
/// `None` if the line misses the ellipsoid in the space of these axes.
fn inside<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let (origin, dir, speed) = squeezed(ellipsoid, ray);
    let found = roots(&origin, &dir, N::ONE)?;
    let halves = ellipsoid.half_axes();
    let long = |least, &half: &N| if half > N::ZERO { min(half, least) } else { least };
    let least = halves.iter().fold(N::INFINITY, long);
    let against = unit_or(&-ray.dir, Vector::<N, D>::zeros());
    let crossing = |t: N, point: &Vector<N, D>, fallback| {
        let slope = point
            .zip_map(halves, |x, half| if half > N::ZERO { x * (least / half) } else { N::ZERO });
        Crossing::new(t / speed, unit_or(&slope, fallback), FeatureId::Face(0))
    };
    let [entry, exit] = found.points();
    let enter = crossing(found.enter, &entry, against);
    let leave = crossing(found.leave, &exit, -against);
    Some(Span { enter, leave, thin: false })
}

/// Returns the crossing of a line with a flat ellipsoid, whose half axis `axis` is zero; `None` if
/// the line crosses the plane beside the ellipsoid.
fn through<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    ray: &Ray<N, D>,
    axis: usize,
) -> Option<Span<N, D>> {
    let t = -ray.origin[axis] / ray.dir[axis];
    let run = ray.dir * t;
    let mut point = ray.origin + run;
    point[axis] = N::ZERO;
    let size = max(max_component(&ray.origin.coords), max_component(&run));
    if project(ellipsoid, &point).distance > rounding(size) {
        return None;
    }
    let against = unit_or(&-ray.dir, Vector::<N, D>::zeros());
    let upright =
        against.zip_map(ellipsoid.half_axes(), |x, half| if half > N::ZERO { N::ZERO } else { x });
    let crossing = Crossing::new(t, unit_or(&upright, against), FeatureId::Face(0));
    Some(Span::thin(crossing, crossing))
}

/// Returns the span of a line that lies in the plane of a flat ellipsoid; `None` if the line lies
/// beside that plane or misses the ellipsoid.
fn lengthwise<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let off = ray
        .origin
        .coords
        .zip_map(ellipsoid.half_axes(), |x, half| if half > N::ZERO { N::ZERO } else { x });
    let on_it = max_component(&off) <= rounding(max_component(&ray.origin.coords));
    let span = inside(ellipsoid, ray).filter(|_| on_it)?;
    Some(Span { thin: true, ..span })
}

/// Returns the rounding error of positions at the distance `size` from the origin.
fn rounding<N: Real>(size: N) -> N {
    N::lit(8.0) * N::EPSILON * size
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;

    type P = Point<f64, 3>;
    type V = Vector<f64, 3>;

    #[test]
    fn through_the_poles_and_aslant() {
        let solid = Ellipsoid::new(V::new(1.0, 2.0, 4.0));
        let found = span(&solid, &Ray::new(P::new(0.0, 0.0, 10.0), -V::z())).expect("a hit");
        assert_eq!((found.enter.t, found.leave.t), (6.0, 14.0), "4 to both sides");
        assert_eq!(found.enter.normal, V::z(), "at the pole");
        let slanted = Ray::new(P::new(-1.0, -2.0, 0.0), V::new(1.0, 2.0, 0.0));
        let found = span(&solid, &slanted).expect("through the middle");
        let half = 0.5_f64.sqrt();
        assert!((found.enter.t - (1.0 - half)).abs() < 1e-15, "{found:?}");
        let normal = V::new(-2.0, -1.0, 0.0) / 5.0_f64.sqrt();
        assert!((found.enter.normal - normal).norm() < 1e-15, "{found:?}");
    }

    #[test]
    fn disks_segments_and_points() {
        let down = |x: f64, y: f64| Ray::new(P::new(x, y, 3.0), V::new(0.0, 0.0, -1.5));
        let disk = Ellipsoid::new(V::new(1.0, 2.0, 0.0));
        let found = span(&disk, &down(0.0, 1.75)).expect("inside the ellipse");
        assert_eq!((found.enter.t, found.enter.normal, found.thin), (2.0, V::z(), true), "a disk");
        assert_eq!(span(&disk, &down(1.75, 0.0)), None, "outside of it");
        let along = Ray::new(P::new(-4.0, 0.0, 0.0), V::x());
        let found = span(&disk, &along).expect("in its plane");
        assert_eq!((found.enter.t, found.leave.t, found.thin), (3.0, 5.0, true), "from rim to rim");
        let needle = Ellipsoid::new(V::new(0.0, 2.0, 0.0));
        assert!(span(&needle, &down(0.0, 1.75)).is_some(), "on the segment");
        assert_eq!(span(&needle, &down(1e-9, 1.75)), None, "beside it");
        let point = Ellipsoid::new(V::zeros());
        assert!(span(&point, &down(0.0, 0.0)).is_some(), "the point");
        assert_eq!(span(&point, &down(0.0, 1e-9)), None, "beside it");
    }
}
