//! Point sets that are hard for hulls.

use impinge::math::{Isometry3, Point, Vector};

pub(crate) type P3 = Point<f64, 3>;

/// A small generator of numbers in [-1, 1): a permuted congruential generator (O'Neill, 2014).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let word = u32::try_from(self.0 >> 33).expect("31 bits");
        f64::from((word ^ (word >> 14)) & 0x00ff_ffff) / f64::from(1_u32 << 23) - 1.0
    }

    pub(crate) fn vector(&mut self) -> Vector<f64, 3> {
        Vector::<f64, 3>::from_fn(|_, _| self.next())
    }
}

pub(crate) fn ball(count: usize) -> Vec<P3> {
    let mut numbers = Numbers::new(7);
    let inside = core::iter::repeat_with(|| numbers.vector()).filter(|v| v.norm() < 1.0);
    inside.take(count).map(P3::from).collect()
}

pub(crate) fn sphere(count: usize) -> Vec<P3> {
    let mut numbers = Numbers::new(11);
    let inside =
        core::iter::repeat_with(|| numbers.vector()).filter(|v| (0.1..1.0).contains(&v.norm()));
    inside.take(count).map(|v| P3::from(v.normalize())).collect()
}

/// Returns the points with whole coordinates from 0 to `count - 1`.
pub(crate) fn grid(count: u32) -> Vec<P3> {
    let axis = move || (0..count).map(f64::from);
    axis().flat_map(|x| axis().flat_map(move |y| axis().map(move |z| P3::new(x, y, z)))).collect()
}

pub(crate) fn cube() -> Vec<P3> {
    grid(2)
}

pub(crate) fn octahedron() -> Vec<P3> {
    let axis = |i: usize| Vector::<f64, 3>::ith(i, 1.0);
    (0..3).flat_map(|i| [P3::from(axis(i)), P3::from(-axis(i))]).collect()
}

/// Returns a regular prism of height 2 with corners on the unit circle.
pub(crate) fn prism(sides: u32) -> Vec<P3> {
    let corner = |i: u32, z: f64| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(sides);
        P3::new(angle.cos(), angle.sin(), z)
    };
    (0..sides).flat_map(|i| [corner(i, -1.0), corner(i, 1.0)]).collect()
}

/// Returns the points rotated, scaled and moved; rounding bends planes that were exactly flat.
pub(crate) fn turned(points: &[P3], scale: f64, offset: f64) -> Vec<P3> {
    let turn = Isometry3::rotation(Vector::<f64, 3>::new(0.3, -0.9, 1.7));
    points.iter().map(|p| turn * p * scale + Vector::<f64, 3>::repeat(offset)).collect()
}

/// Returns points on the two large faces of a flat box of the given thickness, displaced inwards by
/// small amounts.
pub(crate) fn slab(thickness: f64) -> Vec<P3> {
    let mut numbers = Numbers::new(3);
    (0..500)
        .map(|_| {
            let v = numbers.vector();
            P3::new(v.x, v.y, thickness * v.z.signum() * (1.0 - 1e-3 * v.z * v.z))
        })
        .collect()
}
