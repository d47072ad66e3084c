//! The nearest point of a triangle, in 2D and 3D, however thin the triangle is.

use super::SurfacePoint;
use super::segment::{self, feature_at};
use crate::math::{Mapped, Point, Real, max, max_component};
use crate::shape::FeatureId;

/// A point of a triangle near a query point.
#[derive(Clone, Copy)]
pub(super) struct OnTriangle<N: Real, const D: usize> {
    pub(super) found: SurfacePoint<N, D>,
    /// The weights of the corners. None is negative, and the sum is one up to rounding. The weights
    /// of corners outside the point's feature are exactly zero.
    pub(super) weights: [N; 3],
}

impl<N: Real, const D: usize> OnTriangle<N, D> {
    /// Returns the nearer of two points to `query`; `self` if they are equally near.
    fn nearer(self, other: Self, query: &Point<N, D>) -> Self {
        if self.found.is_beaten_by(&other.found, query) { other } else { self }
    }
}

/// Returns the nearest point of the filled triangle, with `Face(0)` for its interior.
///
/// The result is the nearest of four candidates: one on each side and one on the [chord](on_chord)
/// below `point`. Each is a weighted mean of corners, so that it lies on the triangle up to
/// rounding. One of them is the nearest point up to a few epsilon times the largest coordinate or
/// distance, whatever the shape of the triangle. If the point were computed from a normal, or from
/// barycentric coordinates that are quotients of areas, its error would grow with l/h for a
/// triangle of length l and height h.
pub(super) fn nearest<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
    point: &Point<N, D>,
) -> OnTriangle<N, D> {
    let sides = [0, 1, 2].mapped(|side| on_side(corners, side, point));
    let [first, second, third] = sides;
    let best = first.nearer(second, point).nearer(third, point);
    match on_chord(corners, &sides, point) {
        Some(inner) => best.nearer(inner, point),
        None => best,
    }
}

/// Returns the nearest point of the side that leads from corner `side` to the next.
pub(super) fn on_side<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
    side: u32,
    point: &Point<N, D>,
) -> OnTriangle<N, D> {
    let next = (side + 1) % 3;
    let [from, to] = [side, next].mapped(|corner| corner as usize);
    let (nearest, fraction) = segment::nearest([&corners[from], &corners[to]], point);
    let mut weights = [N::ZERO; 3];
    (weights[from], weights[to]) = (N::ONE - fraction, fraction);
    let feature = feature_at(fraction, [side, next], FeatureId::flat::<D>(1, side));
    OnTriangle { found: SurfacePoint::on(nearest, feature), weights }
}

/// Returns the nearest point of the chord that crosses the triangle perpendicular to its longest
/// side, at the projection of `point` on that side. `None` if the nearest point is an end of the
/// chord, which lies on a side.
///
/// If the perpendicular from `point` falls into the triangle, its foot lies on that chord. The
/// position of the chord along the longest side has a rounding error d. The angles at the longest
/// side are acute, so the other two sides rise to the opposite corner and fall again. The point
/// found is therefore within d of the foot: it lies on the chord or, where the chord ends too low,
/// on the side at the chord's end, however steep that side is.
fn on_chord<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
    sides: &[OnTriangle<N, D>; 3],
    point: &Point<N, D>,
) -> Option<OnTriangle<N, D>> {
    let from = longest_side(corners);
    let (to, top) = ((from + 1) % 3, (from + 2) % 3);
    let base = &sides[from];
    let base_share = base.weights[to];
    let (_, peak) = segment::nearest([&corners[from], &corners[to]], &corners[top]);
    // For the side at which the chord ends: the index of its base corner, and the fraction of the
    // side below the chord's end.
    let (start, share) = if base_share <= peak {
        (from, base_share / peak)
    } else {
        (to, (N::ONE - base_share) / (N::ONE - peak))
    };
    let end = corners[start] + (corners[top] - corners[start]) * share;
    let (inner, fraction) = segment::nearest([&base.found.point, &end], point);
    let is_inner = [base_share, fraction].iter().all(|&share| share > N::ZERO && share < N::ONE);
    is_inner.then(|| {
        let mut weights = base.weights.mapped(|weight| weight * (N::ONE - fraction));
        weights[start] += fraction * (N::ONE - share);
        weights[top] = fraction * share;
        OnTriangle { found: SurfacePoint::on(inner, FeatureId::Face(0)), weights }
    })
}

/// Returns the index of the longest side, the first if there are several.
fn longest_side<N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> usize {
    let sides = [0, 1, 2].mapped(|side| corners[(side + 1) % 3] - corners[side]);
    // The squares of very large and very small lengths overflow and underflow.
    let scale = sides.iter().map(max_component).fold(N::ZERO, max).power_of_two_below();
    let squares = sides.mapped(|side| (side / scale).norm_squared());
    let longer = |a: usize, b: usize| if squares[b] > squares[a] { b } else { a };
    longer(longer(0, 1), 2)
}
