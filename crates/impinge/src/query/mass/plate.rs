//! Flat polygons in 3D, and the set of points within a radius of a triangle.

use super::integrals::{Integrals, LocalUnits};
use super::outline::{Wedge, sides};
use crate::math::{Matrix, Point, Real, Vector};
use crate::shape::Moments;

type V3 = Vector<f64, 3>;
type M3 = Matrix<f64, 3>;

/// The integrals over the area of a flat polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plate {
    pub(super) area: f64,
    pub(super) center: V3,
    /// The matrix of second moments about the centre.
    second: M3,
    /// The unit normal on the side from which the corners run counter-clockwise; `None` for a
    /// polygon without area.
    pub(super) normal: Option<V3>,
}

impl Plate {
    /// Returns the integrals over the polygon with the given corners; an empty plate if there are
    /// no corners.
    pub(super) fn new(corners: &[V3]) -> Self {
        let start = corners.first().copied().unwrap_or_else(V3::zeros);
        let (mut area_vector, mut first, mut second) = (V3::zeros(), V3::zeros(), M3::zeros());
        for pair in corners.windows(2).skip(1) {
            let [a, b] = [pair[0] - start, pair[1] - start];
            let across = a.cross(&b) * 0.5;
            area_vector += across;
            let (area, sum) = (across.norm(), a + b);
            first += sum * (area / 3.0);
            let products = a * a.transpose() + b * b.transpose() + sum * sum.transpose();
            second += products * (area / 12.0);
        }
        let area = area_vector.norm();
        if area <= 0.0 {
            return Self { area: 0.0, center: start, second: M3::zeros(), normal: None };
        }
        let center = first / area;
        second -= center * center.transpose() * area;
        Self { area, center: start + center, second, normal: Some(area_vector / area) }
    }

    /// Adds a prism with the plate as its base, or a share of the prism.
    ///
    /// The prism has the height `height`. `share` is the fraction of its mass that is added, with
    /// the centre at the height `altitude` above the plate.
    pub(super) fn add_prism(
        &self,
        [height, share, altitude]: [f64; 3],
        normal: &V3,
        sum: &mut Integrals<3>,
    ) {
        let across = normal * normal.transpose() * (self.area * height * height / 12.0);
        let mass = self.area * height * share;
        sum.add(
            mass,
            &(self.center + normal * altitude),
            &((self.second + across) * (height * share)),
        );
    }
}

/// A sector of a cylinder along an edge, between two normals at the angle `angle`.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeWedge {
    pub(super) ends: [V3; 2],
    /// The unit vector of the bisector of the two normals.
    pub(super) middle: V3,
    pub(super) angle: f64,
}

impl EdgeWedge {
    /// Adds the sector with the given radius; adds nothing for an edge without length.
    pub(super) fn add(&self, radius: f64, sum: &mut Integrals<3>) {
        let [a, b] = &self.ends;
        let (edge, wedge) = (b - a, Wedge::new(radius, self.angle));
        let length = edge.norm();
        if length <= 0.0 {
            return;
        }
        let along = edge / length;
        let across = along.cross(&self.middle);
        let second = self.middle * self.middle.transpose() * wedge.along
            + across * across.transpose() * wedge.across
            + edge * edge.transpose() * (wedge.area / 12.0);
        let first = self.middle * (wedge.first * length);
        let piece = Integrals { mass: wedge.area * length, first, second: second * length };
        sum.add_about(&((a + b) * 0.5), &piece);
    }
}

/// Returns the moments of the set of points within `radius` of a flat triangle, which may have no
/// area or extent.
pub(super) fn round_triangle<N: Real>(corners: &[Point<N, 3>; 3], radius: N) -> Moments<3> {
    let units = LocalUnits::around(corners, radius);
    let mut ring = corners.each_ref().map(|corner| units.point(corner)).to_vec();
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let plate = Plate::new(&ring);
    let normal = across_all(&ring, plate.normal);
    let (radius, mut sum) = (units.length(radius), Integrals::none());
    plate.add_prism([2.0 * radius, 1.0, 0.0], &normal, &mut sum);
    add_rim(&ring, &normal, radius, &mut sum);
    units.grown(&sum.moments())
}

/// Returns the normal of a flat ring. For collinear points, whose `normal` may be a rounding error
/// in any direction, returns a unit vector perpendicular to their line; any unit vector if they
/// coincide.
fn across_all(ring: &[V3], normal: Option<V3>) -> V3 {
    let mut longest = V3::zeros();
    for (a, b) in sides(ring) {
        let side = b - a;
        longest = if side.norm_squared() > longest.norm_squared() { side } else { longest };
    }
    let along = longest.try_normalize(0.0).unwrap_or_default();
    let upright = normal.map(|normal| normal - along * normal.dot(&along));
    // Less than half of the length is left if the normal is mostly a rounding error.
    upright.and_then(|upright| upright.try_normalize(0.5)).unwrap_or_else(|| across(&longest))
}

/// Returns a unit vector perpendicular to a vector of any length.
fn across(v: &V3) -> V3 {
    let mut least = V3::zeros();
    least[v.iamin()] = 1.0;
    v.cross(&least).try_normalize(0.0).unwrap_or(least)
}

/// Adds the border of a flat ring of distinct points: half a cylinder along each side, and at each
/// corner a lune of a ball with the angle by which the outline turns there.
fn add_rim(ring: &[V3], normal: &V3, radius: f64, sum: &mut Integrals<3>) {
    let [.., last] = ring else { return };
    if ring.len() == 1 {
        return add_lune(last, [normal, &across(normal)], core::f64::consts::TAU, radius, sum);
    }
    let outward = |a: &V3, b: &V3| (b - a).cross(normal).normalize();
    let mut before = outward(last, &ring[0]);
    for (a, b) in sides(ring) {
        let beside = outward(&a, &b);
        let turn = libm::atan2(before.cross(&beside).dot(normal), before.dot(&beside)).abs();
        add_lune(&a, [normal, &before], turn, radius, sum);
        EdgeWedge { ends: [a, b], middle: beside, angle: core::f64::consts::PI }.add(radius, sum);
        before = beside;
    }
}

/// Adds a lune of a ball: the region swept by a half-disk that rotates by `angle` about `axis`,
/// counter-clockwise, starting at the unit vector `from`.
fn add_lune(corner: &V3, [axis, from]: [&V3; 2], angle: f64, radius: f64, sum: &mut Integrals<3>) {
    let (sine, cosine) = libm::sincos(angle * 0.5);
    let middle = from * cosine + axis.cross(from) * sine;
    let across = axis.cross(&middle);
    let whole = libm::sin(angle);
    // The integrals over the directions u of the lune: ∫ u = π sin(angle / 2) along the middle, and
    // ∫ u uᵀ in the axes `middle`, `across` and `axis`.
    let second = middle * middle.transpose() * ((angle + whole) * (2.0 / 3.0))
        + across * across.transpose() * ((angle - whole) * (2.0 / 3.0))
        + axis * axis.transpose() * (angle * (2.0 / 3.0));
    let [third, fourth, fifth] = radial(radius);
    sum.add_about(
        corner,
        &Integrals {
            mass: 2.0 * angle * third,
            first: middle * (core::f64::consts::PI * sine * fourth),
            second: second * fifth,
        },
    );
}

/// Returns the integrals of r², r³ and r⁴ from zero to the radius.
pub(super) fn radial(radius: f64) -> [f64; 3] {
    let cubed = radius * radius * radius;
    [cubed / 3.0, cubed * radius / 4.0, cubed * radius * radius / 5.0]
}
