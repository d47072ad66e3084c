//! Bodies of revolution, integrated in slices across the axis.
//!
//! A slice at z is a ball of D − 1 dimensions with the radius of the profile: a disk in 3D, a
//! segment in 2D. The profile consists of lines and arcs. The integrands are polynomials on lines
//! and trigonometric polynomials on arcs; Gauss-Legendre quadrature with 16 nodes integrates both
//! up to rounding.

use super::integrals::LocalUnits;
use super::solids::{UNIT_BALL, round_box};
use crate::math::{Matrix, Point, Real, Vector, max};
use crate::shape::Moments;

const QUARTER: f64 = core::f64::consts::FRAC_PI_2;

/// The positive nodes of the 16-point Gauss-Legendre rule on [−1, 1], each with its weight.
pub(super) const NODES: [[f64; 2]; 8] = [
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_096],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_894],
    [0.865_631_202_387_831_8, 0.095_158_511_682_492_79],
    [0.755_404_408_355_003, 0.124_628_971_255_533_88],
    [0.617_876_244_402_643_8, 0.149_595_988_816_576_74],
    [0.458_016_777_657_227_37, 0.169_156_519_395_002_54],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_58],
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
];

/// Sums over slices along z: the integrals of their measure times 1, z and z², and of their second
/// moment along one transverse axis.
#[derive(Clone, Copy, Debug, Default)]
struct Slices<const D: usize> {
    mass: f64,
    first: f64,
    along: f64,
    across: f64,
}

impl<const D: usize> Slices<D> {
    /// Adds the slices on a piece of the profile. `at(t)` returns the position z, the radius, and
    /// the derivative of z, for a parameter t from `from` to `to`.
    fn add(&mut self, [from, to]: [f64; 2], at: impl Fn(f64) -> [f64; 3]) {
        let (middle, half) = (from * 0.5 + to * 0.5, to * 0.5 - from * 0.5);
        for [node, weight] in NODES {
            for parameter in [middle - half * node, middle + half * node] {
                let [z, radius, slope] = at(parameter);
                let slice = (1..D).fold(UNIT_BALL[D - 1], |measure, _| measure * radius);
                let measure = slice * slope * weight * half;
                self.mass += measure;
                self.first += measure * z;
                self.along += measure * z * z;
                self.across += measure * radius * radius / (D as f64 + 1.0);
            }
        }
    }

    /// Adds the slices between two points of the profile, each given as a position along the axis
    /// and a radius.
    fn add_line(&mut self, [z0, r0]: [f64; 2], [z1, r1]: [f64; 2]) {
        self.add([0.0, 1.0], |t| [z0 + (z1 - z0) * t, r0 + (r1 - r0) * t, z1 - z0]);
    }

    /// Adds the slices under an arc of the profile with the centre `[z, aside]`, between two angles
    /// measured from the transverse direction.
    fn add_arc(&mut self, [z, aside]: [f64; 2], radius: f64, angles: [f64; 2]) {
        self.add(angles, |angle| {
            let (sine, cosine) = libm::sincos(angle);
            [z + radius * sine, aside + radius * cosine, radius * cosine]
        });
    }

    /// Returns the moments of the body whose axis of revolution is the line along `axis`, a unit
    /// vector, through the origin.
    fn moments(&self, axis: &Vector<f64, D>) -> Moments<D> {
        if self.mass <= 0.0 {
            return Moments::massless(Vector::<f64, D>::zeros());
        }
        let center = self.first / self.mass;
        let mut seconds = Vector::<f64, D>::repeat(self.across);
        seconds[1] = self.along - self.first * center;
        Moments::along_axes(self.mass, axis * center, rotation_to(axis), &seconds)
    }
}

/// Returns the rotation that maps the y axis to the unit vector `axis` or to its opposite, the
/// nearer of the two.
fn rotation_to<const D: usize>(axis: &Vector<f64, D>) -> Matrix<f64, D> {
    let mut y = Vector::<f64, D>::zeros();
    y[1] = 1.0;
    let axis = if axis[1] < 0.0 { -axis } else { *axis };
    let both = y + axis;
    let mirrored = both * both.transpose() / (1.0 + axis[1]);
    Matrix::<f64, D>::identity() - mirrored + axis * y.transpose() * 2.0
}

/// Returns the moments of the convex hull of two balls, which is a capsule if their radii are
/// equal.
pub(super) fn two_balls<N: Real, const D: usize>(
    ends: [&Point<N, D>; 2],
    radii: [N; 2],
) -> Moments<D> {
    let larger = usize::from(radii[1] > radii[0]);
    let units = LocalUnits::around(ends, radii[larger]);
    let [a, b] = ends.map(|end| units.point(end));
    let [r1, r2] = radii.map(|radius| units.length(radius));
    let length = (b - a).norm();
    if (r1 - r2).abs() >= length {
        let ball = round_box(&Vector::<N, D>::zeros(), radii[larger]);
        return Moments { center: ends[larger].coords.map(N::as_f64), ..ball };
    }
    // The component along the axis of the side's unit normal.
    let sine = (r1 - r2) / length;
    let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
    let (half, tilt) = (length * 0.5, libm::atan2(sine, cosine));
    let mut slices = Slices::<D>::default();
    slices.add_arc([-half, 0.0], r1, [-QUARTER, tilt]);
    slices.add_line([r1 * sine - half, r1 * cosine], [r2 * sine + half, r2 * cosine]);
    slices.add_arc([half, 0.0], r2, [tilt, QUARTER]);
    let body = slices.moments(&((b - a) / length));
    units.grown(&Moments { center: body.center + (a + b) * 0.5, ..body })
}

/// Returns the moments of the set of points within `rounding` of a cylinder about the y axis.
pub(super) fn round_cylinder<N: Real, const D: usize>(
    [half_height, radius]: [N; 2],
    rounding: N,
) -> Moments<D> {
    let units = LocalUnits::about_origin(max(max(half_height, radius), rounding).as_f64());
    let [h, aside, r] = [half_height, radius, rounding].map(|length| units.length(length));
    let mut slices = Slices::<D>::default();
    slices.add_arc([-h, aside], r, [-QUARTER, 0.0]);
    slices.add_line([-h, aside + r], [h, aside + r]);
    slices.add_arc([h, aside], r, [0.0, QUARTER]);
    units.grown(&slices.moments(&y_axis()))
}

/// Returns the moments of the set of points within `rounding` of a cone about the y axis, with its
/// apex at positive y.
pub(super) fn round_cone<N: Real, const D: usize>(
    [half_height, radius]: [N; 2],
    rounding: N,
) -> Moments<D> {
    let units = LocalUnits::about_origin(max(max(half_height, radius), rounding).as_f64());
    let [h, aside, r] = [half_height, radius, rounding].map(|length| units.length(length));
    // The components of the side's unit normal across and along the axis; arbitrary if the cone is
    // a point.
    let side = [2.0 * h, aside];
    let length = (side[0] * side[0] + side[1] * side[1]).sqrt();
    let [cosine, sine] = if length > 0.0 { side.map(|x| x / length) } else { [1.0, 0.0] };
    let tilt = libm::atan2(sine, cosine);
    let mut slices = Slices::<D>::default();
    slices.add_arc([-h, aside], r, [-QUARTER, tilt]);
    slices.add_line([r * sine - h, aside + r * cosine], [h + r * sine, r * cosine]);
    slices.add_arc([h, 0.0], r, [tilt, QUARTER]);
    units.grown(&slices.moments(&y_axis()))
}

fn y_axis<const D: usize>() -> Vector<f64, D> {
    Vector::<f64, D>::from_fn(|axis, _| if axis == 1 { 1.0 } else { 0.0 })
}
