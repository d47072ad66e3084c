//! Triangle against triangle in space.

use super::triangle_axes::{Axis, AxisKind, Best, Edging, Faces, Fin, least_sine, noise, parted};
use super::{general, wrong_kinds};
use crate::convex::Separation;
use crate::math::{Matrix, Point, Real, Vector, cross, max, min};
use crate::query::Pair;
use crate::shape::{FaceRing, FeatureId, Kind, SupportMap, Triangle};

/// The separation of two triangles.
///
/// As that of a triangle and a [box](super::triangle_cuboid): exact where the two pierce each other, and where
/// they are apart if a corner is over the inside of the other, or two sides cross; all else, and triangles
/// without an area, is left to the general algorithm.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (Kind::Triangle(triangle), Kind::Triangle(other)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let fall_back = || general::of_flat_cores(pair, limit);
    let Some(fin) = Fin::new(triangle, &pair.pose12, other.reach()) else { return fall_back() };
    let best = best_axis(&fin, other, |gap| fin.is_beyond(gap, limit));
    best.settled(&fin, *other, limit, fall_back)
}

/// The direction that leaves the largest gap: the first triangle's own normal unless another one leaves more
/// but for rounding.
fn best_axis<N: Real>(
    fin: &Fin<'_, N>,
    other: &Triangle<N, 3>,
    is_beyond: impl Fn(N) -> bool,
) -> Best<N> {
    let corners = other.corners().map(|corner| corner.coords * fin.shrink);
    let (own, lain) = (fin.edging(), Edging::of(other, fin.shrink, &Matrix::<N, 3>::identity()));
    let (Some(front), Some(base)) = (own.front, lain.front) else { return Best::Unclear };
    let (gap, is_above) = parted(fin.range(&front), range(&corners, &front));
    let normal = if is_above { -front } else { front };
    let mut best = Axis { kind: AxisKind::Triangle, normal, gap };
    let (gap, is_above) = parted(fin.range(&base), range(&corners, &base));
    if gap > best.gap + noise() {
        let normal = if is_above { -base } else { base };
        best = Axis { kind: AxisKind::Face(u32::from(!is_above)), normal, gap };
    }
    if is_beyond(best.gap) {
        return Best::Beyond;
    }
    let best = best_edges(fin, &own, &lain, &corners, best.gap + noise()).unwrap_or(best);
    if is_beyond(best.gap) { Best::Beyond } else { Best::Axis(best) }
}

/// How low and how high the corners lie along a direction.
fn range<N: Real>(corners: &[Vector<N, 3>; 3], along: &Vector<N, 3>) -> [N; 2] {
    let [a, b, c] = corners.each_ref().map(|corner| corner.dot(along));
    [min(min(a, b), c), max(max(a, b), c)]
}

/// A side of each that leave a larger gap than `least`.
fn best_edges<N: Real>(
    fin: &Fin<'_, N>,
    own: &Edging<N>,
    lain: &Edging<N>,
    corners: &[Vector<N, 3>; 3],
    least: N,
) -> Option<Axis<N>> {
    let (mut best, mut bound) = (None, least);
    for (side, (along, from)) in own.sides.iter().zip(&fin.corners).enumerate() {
        let off = &fin.corners[(side + 2) % 3];
        for (edge, (other, start)) in (0_u32..).zip(lain.sides.iter().zip(corners)) {
            let across = cross(other, along);
            let squared = across.norm_squared();
            // Of parallel sides nothing new is learnt.
            let is_steep = squared > least_sine::<N>() * least_sine();
            let [a, b] = [from.dot(&across), off.dot(&across)];
            let [c, d] = [start, &corners[(edge as usize + 2) % 3]].map(|end| end.dot(&across));
            let (slack, is_above) = parted([min(a, b), max(a, b)], [min(c, d), max(c, d)]);
            if !is_steep || slack <= min(bound, N::ZERO) {
                continue;
            }
            let sine = squared.sqrt();
            if slack > bound * sine {
                bound = slack / sine;
                let normal = across / if is_above { -sine } else { sine };
                best = Some(Axis { kind: AxisKind::Edges(edge, side), normal, gap: bound });
            }
        }
    }
    best
}

impl<N: Real> Faces<N> for Triangle<N, 3> {
    /// The whole triangle, however much it leans: what counts of it is the lowest place.
    fn ring_toward(&self, _: &Vector<N, 3>) -> Option<FaceRing<N>> {
        self.ring_at(0)
    }

    fn ring_at(&self, face: u32) -> Option<FaceRing<N>> {
        let [a, b, c]: &[Point<N, 3>; 3] = self.corners();
        let mut ring = FaceRing::blank();
        ring.id = FeatureId::Face(face);
        for corner in if face == 0 { [a, b, c] } else { [a, c, b] } {
            ring.push(corner, [ring.id; 2]);
        }
        Some(ring)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::noise::Noise;
    use crate::math::{Isometry3, Pose};

    /// The general algorithm is the slow twin.
    #[test]
    fn triangles_are_parted_as_in_general() {
        let (mut noise, mut counts) = (Noise(9), [0; 4]);
        for round in 0..6000 {
            let mut corner = || Point::from(noise.vector::<f64>(1.0));
            let first = Triangle::new(corner(), corner(), corner());
            let second = Triangle::new(corner(), corner(), corner());
            let far = [0.0, 0.6, 1.2, 2.5][round % 4];
            let pose12 = Pose::from_isometry(&Isometry3::new(noise.vector(far), noise.vector(3.0)));
            let (first, second) = (Kind::Triangle(&first), Kind::Triangle(&second));
            let pair = Pair { first, second, pose12 };
            let limit = [f64::INFINITY, 0.3][round / 4 % 2];
            let (found, expected) =
                (separation(&pair, limit), general::of_flat_cores(&pair, limit));
            let [distance, general] = [&found, &expected].map(|said| said.map(|it| it.distance));
            let is_same = match (distance, general) {
                (Some(one), Some(other)) => (one - other).abs() < 1e-9,
                (one, other) => one.is_none() == other.is_none(),
            };
            assert!(is_same, "in round {round}: {distance:?}, in general {general:?}");
            let Some(found) = found else { continue };
            let way = found.point2 - found.point1 - found.normal * found.distance;
            assert!(way.norm() < 1e-9, "in round {round}: {found:?}");
            counts[2 * usize::from(found.distance > 0.0) + round / 4 % 2] += 1;
        }
        assert!(counts.iter().all(|&count| count > 300), "all of it is met: {counts:?}");
    }
}
