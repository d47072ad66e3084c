//! Moments of the set of points within a radius of an ellipsoid. They have no closed form, so the
//! module integrates numerically over directions.
//!
//! The support point in the direction u is `y = A² u / h + r u` with `h = |A u|`, where A is the
//! diagonal matrix of the half axes and r the radius. A surface element has the area of its solid
//! angle times the product of the principal radii of curvature there, each larger by r than the
//! ellipsoid's radius of curvature. Mass and moments follow from the surface by the divergence
//! theorem. Directions are sampled as `A^(−1/2) v`, between the directions of the normals and of
//! the points. The angles of v from the axes have evenly spaced logarithms: the curvature of
//! needles and plates is concentrated near the axes.

use super::integrals::LocalUnits;
use crate::math::{Mapped, Matrix, Real, Vector, max, max_component};
use crate::shape::Moments;

/// The step of the logarithms of the angles, and the number of steps on each side of the middle.
const STEP: f64 = 0.4;
const STEPS: i32 = 80;

/// Half axes shorter than this fraction of the radius are raised to that length.
const THIN: f64 = 1e-9;

/// The sine and the cosine of an angle up to 90°, and its quadrature weight.
type AngleNode = [f64; 3];

/// Returns the angles and weights of the quadrature, from near 0 to near 90°.
fn nodes() -> Vec<AngleNode> {
    let node = |step: i32| {
        let growth = libm::exp(STEP * f64::from(step));
        // The angles measured from 0 and from 90°. Each is accurate near its own zero, where the
        // other is 90° up to rounding.
        let [from_zero, from_quarter] =
            [growth, 1.0 / growth].mapped(|x| core::f64::consts::FRAC_PI_2 * x / (1.0 + x));
        let weight = STEP * from_zero * from_quarter * core::f64::consts::FRAC_2_PI;
        [libm::sin(from_zero), libm::sin(from_quarter), weight]
    };
    (-STEPS..=STEPS).map(node).collect()
}

/// The volume and the second moments of the body, summed over directions.
struct Shell<const D: usize> {
    half_axes: Vector<f64, D>,
    radius: f64,
    mass: f64,
    seconds: Vector<f64, D>,
}

impl<const D: usize> Shell<D> {
    fn new<N: Real>(half_axes: &Vector<N, D>, radius: N) -> (Self, LocalUnits<D>) {
        let units = LocalUnits::about_origin(max(max_component(half_axes), radius).as_f64());
        let radius = units.length(radius);
        let least = radius * THIN;
        let half_axes = units.vector(half_axes).map(|axis| if axis > least { axis } else { least });
        (Self { half_axes, radius, mass: 0.0, seconds: Vector::<f64, D>::zeros() }, units)
    }

    /// Adds the solid angle around the unit vector v. `radii(h, p, a)` returns the product of the
    /// principal radii from `h` (see the module docs), the ellipsoid's support point p, and the
    /// product a of the half axes.
    fn add(
        &mut self,
        v: &Vector<f64, D>,
        weight: f64,
        radii: impl Fn(f64, &Vector<f64, D>, f64) -> f64,
    ) {
        let spread = v.component_div(&self.half_axes.map(f64::sqrt));
        let length = spread.norm();
        let direction = spread / length;
        let product = self.half_axes.iter().product::<f64>();
        let directions = (0..D).fold(weight / product.sqrt(), |share, _| share / length);
        let stretched = self.half_axes.component_mul(&direction);
        let height = stretched.norm();
        let inner = self.half_axes.component_mul(&stretched) / height;
        let outer = inner + direction * self.radius;
        let measure = (height + self.radius) * radii(height, &inner, product) * directions;
        self.mass += measure;
        self.seconds += outer.component_mul(&outer) * measure;
    }

    /// Returns the moments of the body, after the directions between the positive axes were added.
    fn moments(&self) -> Moments<D> {
        let parts = f64::from(1_u8 << D);
        let (mass, seconds) =
            (self.mass * (parts / D as f64), self.seconds * (parts / (D as f64 + 2.0)));
        let (center, axes) = (Vector::<f64, D>::zeros(), Matrix::<f64, D>::identity());
        Moments::along_axes(mass, center, axes, &seconds)
    }
}

/// Returns the moments of the set of points within a positive `radius` of an ellipse.
pub(super) fn round_ellipse<N: Real>(half_axes: &Vector<N, 2>, radius: N) -> Moments<2> {
    let (mut shell, units) = Shell::new(half_axes, radius);
    let radius = shell.radius;
    for [sine, cosine, weight] in nodes() {
        shell.add(&Vector::<f64, 2>::new(sine, cosine), weight, |height, _, product| {
            product * product / (height * height * height) + radius
        });
    }
    units.grown(&shell.moments())
}

/// Returns the moments of the set of points within a positive `radius` of an ellipsoid.
pub(super) fn round_ellipsoid<N: Real>(half_axes: &Vector<N, 3>, radius: N) -> Moments<3> {
    let (mut shell, units) = Shell::new(half_axes, radius);
    let (radius, squared, nodes) = (shell.radius, shell.half_axes.norm_squared(), nodes());
    let radii = |height: f64, inner: &Vector<f64, 3>, product: f64| {
        let curved = product / (height * height);
        let sum = (squared - inner.norm_squared()) / height;
        curved * curved + radius * sum + radius * radius
    };
    for [sine, cosine, weight] in &nodes {
        for [sine2, cosine2, weight2] in &nodes {
            let v = Vector::<f64, 3>::new(sine * cosine2, *cosine, sine * sine2);
            shell.add(&v, weight * weight2 * sine, radii);
        }
    }
    units.grown(&shell.moments())
}
