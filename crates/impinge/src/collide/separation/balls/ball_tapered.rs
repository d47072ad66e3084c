//! Ball against tapered capsule, in closed form, in any dimension.

use crate::collide::Pair;
use crate::collide::separation::projection::{
    Projection, center_in_second, first_axis, made_perpendicular, perpendicular_to, rounding_error,
};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, unit};
use crate::shape::{FeatureId, Kind, TaperedCapsule};

/// Returns the separation of a ball from a tapered capsule; `None` above `limit`.
///
/// If the ball's centre lies on the capsule's axis, the ball is pushed out along a normal of the
/// side, in a fixed direction around the axis. If the centre coincides with an end of the axis and
/// rounding puts it beyond the side, the ball is pushed out along the axis, away from the other
/// end. If one end ball contains the other end ball, and the centre coincides with the centre of
/// the larger one, the ball is pushed out along the first axis.
pub(in crate::collide::separation) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Kind::Ball(ball), Kind::TaperedCapsule(capsule)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(capsule, &center).0.of_ball(ball.radius(), &pair.pose12, limit)
}

/// Projects a point onto a tapered capsule. Also returns the feature that the nearest point lies
/// on: `Vertex(0)` or `Vertex(1)` for the ball at that end, `Edge(0)` for the side.
///
/// In the half-plane through axis and point, the side of the capsule is a segment. The
/// perpendiculars at its ends pass through the centres of the balls and bound the region of the
/// side, both inside and outside.
pub(crate) fn project<N: Real, const D: usize>(
    capsule: &TaperedCapsule<N, D>,
    point: &Point<N, D>,
) -> (Projection<N, D>, FeatureId) {
    let Some(taper) = capsule.taper() else {
        return around_end(capsule, capsule.larger_end(), point, &first_axis());
    };
    let from_first = point - capsule.segment().a();
    let away = made_perpendicular(&from_first, &taper.along)
        .unwrap_or_else(|| perpendicular_to(&taper.along));
    let (x, y) = (from_first.dot(&away), from_first.dot(&taper.along));
    let along_side = taper.cosine * y - taper.sine * x;
    if along_side < N::ZERO {
        return around_end(capsule, 0, point, &-taper.along);
    }
    if along_side > taper.cosine * taper.length {
        return around_end(capsule, 1, point, &taper.along);
    }
    let distance = taper.cosine * x + taper.sine * y - capsule.radii()[0];
    let outward = away * taper.cosine + taper.along * taper.sine;
    let nearest = point - outward * distance;
    (Projection { distance, outward, point: nearest }, FeatureId::Edge(0))
}

/// Projects a point onto the ball at one end. `fallback` is the direction used if the offset from
/// the ball's centre is zero or mostly rounding error.
fn around_end<N: Real, const D: usize>(
    capsule: &TaperedCapsule<N, D>,
    end: usize,
    point: &Point<N, D>,
    fallback: &Vector<N, D>,
) -> (Projection<N, D>, FeatureId) {
    let (center, radius) = (capsule.end(end), capsule.radii()[end]);
    let (outward, away) = unit(&(point - center)).unwrap_or((*fallback, N::ZERO));
    let is_certain = away > rounding_error(center.coords.norm());
    let outward = if is_certain { outward } else { *fallback };
    let feature = FeatureId::Vertex(if end == 0 { 0 } else { 1 });
    let nearest = center + outward * radius;
    (Projection { distance: away - radius, outward, point: nearest }, feature)
}

#[cfg(test)]
mod tests {
    use super::*;

    type P = Point<f64, 3>;

    /// Returns a tapered capsule whose radius grows by 3 over an axis of length 5, so that the
    /// normals of the side tilt by an angle with the sine 0.6.
    fn club() -> TaperedCapsule<f64, 3> {
        TaperedCapsule::try_from_ends(P::origin(), P::new(0.0, 5.0, 0.0), [1.0, 4.0])
            .expect("finite")
    }

    #[test]
    fn ends_side_and_inside() {
        let projected = |x: f64, y: f64| project(&club(), &P::new(0.0, y, x));
        let (below, feature) = projected(0.0, -3.0);
        assert_eq!((below.distance, feature), (2.0, FeatureId::Vertex(0)), "below the small end");
        let (above, feature) = projected(6.0, 13.0);
        assert_eq!(
            (above.distance, feature),
            (6.0, FeatureId::Vertex(1)),
            "(6, 8) from its centre"
        );
        let outward = Vector::<f64, 3>::new(0.0, -0.6, 0.8);
        let position = P::new(0.0, 2.5, 0.0) + outward * 12.5;
        let (side, feature) = project(&club(), &position);
        assert!((side.distance - 10.0).abs() < 1e-14 && feature == FeatureId::Edge(0), "{side:?}");
        assert!((side.outward - outward).norm() < 1e-15, "the normal of the side: {side:?}");
        let (inside, feature) = projected(0.0, 2.5);
        assert!(
            (inside.distance + 2.5).abs() < 1e-14 && feature == FeatureId::Edge(0),
            "{inside:?}"
        );
    }

    #[test]
    fn the_centre_of_an_end() {
        // Because of rounding, the centre of an end may seem to lie beyond the side.
        let (a, b) = (P::new(0.3, 0.1, 0.7), P::new(0.1, -0.2, 0.5));
        for radii in [[0.0, 0.0], [0.2, 0.0], [0.0, 0.2], [0.1, 0.3]] {
            let one = TaperedCapsule::try_from_ends(a, b, radii).expect("finite");
            for (point, other, radius) in [(a, b, radii[0]), (b, a, radii[1])] {
                let (projected, _) = project(&one, &point);
                let other = (other - point).dot(&projected.outward) + radii[0] + radii[1] - radius;
                assert!(other <= radius + 1e-15, "{other} beyond {radius}: {projected:?}");
            }
        }
    }

    #[test]
    fn a_ball_in_a_ball() {
        let one = TaperedCapsule::<f64, 2>::new(1.0, 5.0, 0.5);
        let (projected, feature) = project(&one, &Point::<f64, 2>::new(0.0, 7.0));
        assert_eq!((projected.distance, feature), (3.0, FeatureId::Vertex(0)), "around (0, -1)");
        let (middle, _) = project(&one, &Point::<f64, 2>::new(0.0, -1.0));
        assert_eq!((middle.distance, middle.outward.x), (-5.0, 1.0), "the first axis");
    }
}
