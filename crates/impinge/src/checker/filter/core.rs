//! Distances of points from an obstacle, for 8 points at a time.

use crate::math::lanes::{dot, lit, minus, norm, rotated_into, times};
use crate::math::simd::Simd;
use crate::math::{Mapped, Matrix, Point, Pose, Real, Vector, Wide, filled};
use crate::shape::{Kind, Shape};

/// The core of an obstacle, without its rounding radius, in `f32`.
#[derive(Clone, Debug)]
pub(super) enum Core<const D: usize> {
    Point([f32; D]),
    Segment {
        start: [f32; D],
        axis: [f32; D],
        /// The reciprocal of the squared length of `axis`; zero if that square is not above the
        /// smallest normal number.
        inverse_squared: f32,
    },
    Cuboid {
        axes: [[f32; D]; D],
        center: [f32; D],
        half: [f32; D],
    },
    /// A cylinder about its second axis.
    Cylinder {
        axes: [[f32; D]; D],
        center: [f32; D],
        half_height: f32,
        radius: f32,
    },
    HalfSpace {
        normal: [f32; D],
        origin: [f32; D],
    },
    /// An unknown core: the distance of every point is treated as zero.
    Unknown,
}

/// A core with its rounding radius: the points within `radius` of `core`.
#[derive(Clone, Debug)]
pub(super) struct RoundedCore<const D: usize> {
    pub(super) core: Core<D>,
    pub(super) radius: f32,
    /// Whether the solid equals the rounded core; if false, the solid is only contained in it.
    pub(super) is_exact: bool,
}

impl<const D: usize> RoundedCore<D> {
    /// Returns the rounded core of a shape at a pose. For a shape without a closed form the core is
    /// its box, or unknown if the box is unbounded.
    pub(super) fn new<N: Real>(shape: &dyn Shape<N, D>, pose: &Pose<N, D>) -> Self {
        let exact = |core, radius: N| Self { core, radius: radius.as_f32(), is_exact: true };
        match shape.geometry().0 {
            Kind::Ball(ball) => exact(Core::Point(numbers(&pose.translation)), ball.radius()),
            Kind::Segment(segment) => exact(between(pose, [segment.a(), segment.b()]), N::ZERO),
            Kind::Capsule(capsule) => {
                let segment = capsule.segment();
                exact(between(pose, [segment.a(), segment.b()]), capsule.radius())
            }
            Kind::Cuboid(cuboid) => {
                exact(cuboid_at(pose, &pose.translation, cuboid.half_extents()), N::ZERO)
            }
            Kind::Cylinder(cylinder, _) => {
                let core = Core::Cylinder {
                    axes: columns(&pose.rotation),
                    center: numbers(&pose.translation),
                    half_height: cylinder.half_height().as_f32(),
                    radius: cylinder.radius().as_f32(),
                };
                exact(core, N::ZERO)
            }
            Kind::Plane(plane) => {
                let normal = numbers(&pose.vector(plane.normal()));
                exact(Core::HalfSpace { normal, origin: numbers(&pose.translation) }, N::ZERO)
            }
            _ => Self { core: boxed(shape, pose), radius: 0.0, is_exact: false },
        }
    }

    /// Returns an unknown core.
    pub(super) const fn unknown() -> Self {
        Self { core: Core::Unknown, radius: 0.0, is_exact: false }
    }
}

/// Returns the box of a shape as a core; an unknown core if the box is unbounded.
fn boxed<N: Real, const D: usize>(shape: &dyn Shape<N, D>, pose: &Pose<N, D>) -> Core<D> {
    let aabb = shape.local_aabb();
    if !aabb.holds_finite_point() || !aabb.is_bounded() {
        return Core::Unknown;
    }
    cuboid_at(pose, &pose.point(&aabb.center()).coords, &aabb.half_extents())
}

fn cuboid_at<N: Real, const D: usize>(
    pose: &Pose<N, D>,
    center: &Vector<N, D>,
    half: &Vector<N, D>,
) -> Core<D> {
    Core::Cuboid { axes: columns(&pose.rotation), center: numbers(center), half: numbers(half) }
}

/// Returns the segment between two local points, in the outer frame, as a core.
fn between<N: Real, const D: usize>(pose: &Pose<N, D>, ends: [&Point<N, D>; 2]) -> Core<D> {
    let [start, end] = ends.mapped(|end| pose.point(end).coords);
    let axis = (end - start).map(N::as_f32);
    let squared = axis.norm_squared();
    let inverse_squared = if squared > f32::MIN_POSITIVE { 1.0 / squared } else { 0.0 };
    Core::Segment { start: numbers(&start), axis: axis.into(), inverse_squared }
}

pub(super) fn numbers<N: Real, const D: usize>(vector: &Vector<N, D>) -> [f32; D] {
    vector.map(N::as_f32).into()
}

fn columns<N: Real, const D: usize>(matrix: &Matrix<N, D>) -> [[f32; D]; D] {
    matrix.map(N::as_f32).into()
}

impl<const D: usize> Core<D> {
    /// Returns the squared distances of 8 points from the core, zero inside. All coordinates must
    /// be below 10¹⁵.
    #[inline(always)]
    pub(super) fn squared<S: Simd, V: Wide<S, Scalar = f32>>(&self, simd: S, points: &[V; D]) -> V {
        let zero = V::all(simd, 0.0);
        match self {
            Self::Point(center) => {
                let away = minus(points, &all(simd, center));
                dot(&away, &away)
            }
            Self::Segment { start, axis, inverse_squared } => {
                let (away, axis): ([V; D], [V; D]) =
                    (minus(points, &all(simd, start)), all(simd, axis));
                let along = dot(&away, &axis) * V::all(simd, *inverse_squared);
                let along = along.larger(zero).smaller(lit(simd, 1.0));
                let away = minus(&away, &times(&axis, along));
                dot(&away, &away)
            }
            Self::Cuboid { axes, center, half } => {
                let local = local(simd, axes, center, points);
                let over: [V; D] = filled(
                    #[inline(always)]
                    |axis| (local[axis].abs() - V::all(simd, half[axis])).larger(zero),
                );
                dot(&over, &over)
            }
            Self::Cylinder { axes, center, half_height, radius } => {
                let mut across = local(simd, axes, center, points);
                let cap = (across[1].abs() - V::all(simd, *half_height)).larger(zero);
                across[1] = zero;
                let side = (norm(&across) - V::all(simd, *radius)).larger(zero);
                side * side + cap * cap
            }
            Self::HalfSpace { normal, origin } => {
                let away = minus(points, &all(simd, origin));
                let above = dot(&away, &all(simd, normal)).larger(zero);
                above * above
            }
            Self::Unknown => zero,
        }
    }
}

#[inline(always)]
fn all<S: Simd, V: Wide<S, Scalar = f32>, const D: usize>(simd: S, numbers: &[f32; D]) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| V::all(simd, numbers[axis]),
    )
}

/// Converts points to the frame with the given axes and centre.
#[inline(always)]
fn local<S: Simd, V: Wide<S, Scalar = f32>, const D: usize>(
    simd: S,
    axes: &[[f32; D]; D],
    center: &[f32; D],
    points: &[V; D],
) -> [V; D] {
    let axes: [[V; D]; D] = filled(
        #[inline(always)]
        |axis| all(simd, &axes[axis]),
    );
    rotated_into(&axes, &minus(points, &all(simd, center)))
}
