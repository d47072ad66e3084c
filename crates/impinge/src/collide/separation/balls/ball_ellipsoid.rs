//! Ball against ellipsoid, in any dimension: the nearest point of the surface.

use crate::collide::Pair;
use crate::collide::separation::projection::{Projection, center_in_second, first_axis};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, max, max_component, min, unit};
use crate::shape::{Ellipsoid, Kind, SupportMap};

/// Largest number of Newton steps. They converge from one side, finally quadratically. Usually
/// about six are taken; close to the centre of a flat ellipsoid up to twenty.
const STEPS: usize = 64;

/// Returns the separation of a ball from an ellipsoid; `None` above `limit`.
///
/// If the two centres coincide, the ball is pushed out along the shortest half axis, towards its
/// positive side; the first of several shortest axes wins a tie.
pub(in crate::collide::separation) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Kind::Ball(ball), Kind::Ellipsoid(ellipsoid)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(ellipsoid, &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// Projects a point onto an ellipsoid.
///
/// After D. Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid"
/// (2013): the point `x` of the surface nearest to `y` has `x = e² y / (e² + s)` in each
/// coordinate, where `e` is the half axis and `s` the root of one convex function. The unknown here
/// is `t = s + least²`, where `least` is the shortest half axis, so that flat and needle-like
/// ellipsoids are as accurate as round ones. Newton's method runs on the reciprocal of the
/// function's square root, which is nearly straight (J. Moré and D. Sorensen, "Computing a Trust
/// Region Step", 1983).
pub(crate) fn project<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    point: &Point<N, D>,
) -> Projection<N, D> {
    let largest = max_component(ellipsoid.half_axes());
    let far = max_component(&point.coords) * N::EPSILON > largest / N::EPSILON;
    if far || largest == N::ZERO {
        return from_afar(ellipsoid, point);
    }
    let scale = largest.power_of_two_below();
    let scaled = ScaledEllipsoid::new(&(ellipsoid.half_axes() / scale), &(point.coords / scale));
    let found = scaled.project();
    Projection {
        distance: found.distance * scale,
        outward: found.outward,
        point: Point::from(found.point.coords * scale),
    }
}

/// Projects a point that is so far away that only its direction matters, or any point onto an
/// ellipsoid of size zero.
fn from_afar<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    point: &Point<N, D>,
) -> Projection<N, D> {
    let nearest = ellipsoid.core_support(&point.coords);
    let (outward, distance) = unit(&(point - nearest)).unwrap_or_else(|| (first_axis(), N::ZERO));
    Projection { distance, outward, point: nearest }
}

/// An ellipsoid scaled by a power of two, so that its longest half axis is at least 1 and less than
/// 2, and a point scaled by the same factor.
struct ScaledEllipsoid<N: Real, const D: usize> {
    half_axes: Vector<N, D>,
    /// The shortest half axis.
    least: N,
    /// Square of each half axis minus the square of the shortest.
    excess: Vector<N, D>,
    point: Vector<N, D>,
}

impl<N: Real, const D: usize> ScaledEllipsoid<N, D> {
    fn new(half_axes: &Vector<N, D>, point: &Vector<N, D>) -> Self {
        let least = half_axes.iter().fold(N::INFINITY, |least, &half| min(half, least));
        let excess = half_axes.map(|half| (half - least) * (half + least));
        Self { half_axes: *half_axes, least, excess, point: *point }
    }

    /// Projects the point by the positive root of f(t) = 1 (see [`Self::level`]), or by
    /// [`Self::across`] if there is none.
    fn project(&self) -> Projection<N, D> {
        let low = (0..D).fold(N::ZERO, |low, axis| {
            let alone = self.half_axes[axis] * self.point[axis].abs() - self.excess[axis];
            max(low, alone)
        });
        if low == N::ZERO && self.level(N::ZERO).0 <= N::ONE {
            return self.across();
        }
        let root = self.root(low);
        // The normal is this vector, not a difference of points, so it is exact on the surface as
        // well.
        let normal =
            Vector::<N, D>::from_fn(|axis, _| quotient(self.point[axis], root + self.excess[axis]));
        let (outward, length) = unit(&normal).unwrap_or_else(|| (first_axis(), N::ZERO));
        Projection {
            distance: (root - self.least * self.least) * length,
            outward,
            point: self.at(&normal),
        }
    }

    /// Returns the point of the surface at which `normal` is a normal. The length of `normal` must
    /// satisfy Σ (eᵢ nᵢ)² = 1, where e are the half axes.
    fn at(&self, normal: &Vector<N, D>) -> Point<N, D> {
        Point::from(normal.zip_map(&self.half_axes, |n, half| half * (half * n)))
    }

    /// Returns f(t) = Σ (eᵢ pᵢ / (t + excessᵢ))² and −f′(t) / 2, where e are the half axes and p
    /// the point. The candidate for the nearest point that belongs to `t` lies on the surface if
    /// f(t) = 1, and outside the ellipsoid if f(t) > 1.
    fn level(&self, t: N) -> (N, N) {
        let (mut level, mut fall) = (N::ZERO, N::ZERO);
        for axis in 0..D {
            let below = t + self.excess[axis];
            let part = quotient(self.half_axes[axis] * self.point[axis], below);
            level += part * part;
            fall += quotient(part * part, below);
        }
        (level, fall)
    }

    /// Finds the root of f(t) = 1 by Newton's method from below; at the start `t`, f is 1 or more.
    fn root(&self, mut t: N) -> N {
        for _ in 0..STEPS {
            let (level, fall) = self.level(t);
            let next = t + level * (level.sqrt() - N::ONE) / fall;
            let goes_on = next > t && next.is_finite_number();
            if !goes_on {
                break;
            }
            t = next;
        }
        t
    }

    /// Projects the point if f(t) = 1 has no positive root: the point lies in the symmetry plane
    /// perpendicular to the shortest half axis and close enough to the centre, or the shortest half
    /// axis is zero.
    fn across(&self) -> Projection<N, D> {
        let shortest = |axis: &usize| self.excess[*axis] == N::ZERO;
        let first = (0..D).find(shortest).unwrap_or(0);
        let inner =
            Vector::<N, D>::from_fn(|axis, _| quotient(self.point[axis], self.excess[axis]));
        let rest = (N::ONE - self.level(N::ZERO).0).sqrt();
        let mut point = self.at(&inner);
        let mut axis = Vector::<N, D>::zeros();
        axis[first] = if self.point[first] < N::ZERO { -N::ONE } else { N::ONE };
        point[first] = axis[first] * self.least * rest;
        if self.least == N::ZERO {
            let aside = self
                .point
                .zip_map(&self.excess, |x, excess| if excess == N::ZERO { x } else { N::ZERO });
            let (outward, distance) = unit(&aside).unwrap_or((axis, N::ZERO));
            return Projection { distance, outward, point };
        }
        let normal = inner * self.least + axis * rest;
        let (outward, length) = unit(&normal).unwrap_or((axis, N::ONE));
        Projection { distance: -self.least * length, outward, point }
    }
}

/// Returns the quotient, or zero if either number is zero.
fn quotient<N: Real>(numerator: N, denominator: N) -> N {
    if numerator == N::ZERO || denominator == N::ZERO { N::ZERO } else { numerator / denominator }
}
