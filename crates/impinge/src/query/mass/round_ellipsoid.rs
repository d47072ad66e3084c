//! The set of points within a radius of an ellipsoid, which has no closed form: a quadrature over
//! directions.
//!
//! The support point of the direction u is `y = A² u / h + r u` with `h = |A u|`. A surface element
//! has the area of its directions times the product of the principal radii there, each larger by r
//! than that of the ellipsoid. Mass and moments follow from the surface by the divergence theorem.
//! Directions are sampled as `A^(−1/2) v`, between those of the normals and of the points, and v by
//! angles from the axes with evenly spaced logarithms: the curvature of needles and plates is
//! concentrated near the axes.

use super::integrals::LocalUnits;
use crate::math::{Mapped, Matrix, Real, Vector, max, max_component};
use crate::shape::Moments;

/// The step of the logarithms of angles, and the number of steps to both sides.
const STEP: f64 = 0.4;
const STEPS: i32 = 80;

/// Half axes are raised to this fraction of the radius.
const THIN: f64 = 1e-9;

/// The sine and the cosine of an angle up to 90°, and its weight.
type AngleNode = [f64; 3];

/// The angles and weights of the quadrature, from near zero to near 90°.
fn nodes() -> Vec<AngleNode> {
    let node = |step: i32| {
        let growth = libm::exp(STEP * f64::from(step));
        // Each is exact near its own end, where the other is 90° up to rounding.
        let [from_zero, from_quarter] =
            [growth, 1.0 / growth].mapped(|x| core::f64::consts::FRAC_PI_2 * x / (1.0 + x));
        let weight = STEP * from_zero * from_quarter * core::f64::consts::FRAC_2_PI;
        [libm::sin(from_zero), libm::sin(from_quarter), weight]
    };
    (-STEPS..=STEPS).map(node).collect()
}

/// Sums of the volume and the second moments over directions of the surface.
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

    /// Adds the directions about the unit vector v. `radii` returns the product of the principal
    /// radii from the length h, the inner support point, and the product of the half axes.
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

    /// The body, after the directions between the positive axes were added.
    fn moments(&self) -> Moments<D> {
        let parts = f64::from(1_u8 << D);
        let (mass, seconds) =
            (self.mass * (parts / D as f64), self.seconds * (parts / (D as f64 + 2.0)));
        let (center, axes) = (Vector::<f64, D>::zeros(), Matrix::<f64, D>::identity());
        Moments::along_axes(mass, center, axes, &seconds)
    }
}

/// The set of points within a positive `radius` of an ellipse.
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

/// The set of points within a positive `radius` of an ellipsoid.
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
