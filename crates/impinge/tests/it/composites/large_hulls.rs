//! Tests that the contacts of a hull with a surface do not depend on features that are far from it.
//!
//! Two prisms touch a surface with equal faces; the second has a dome of many vertices at the
//! opposite end. The contacts of the first are computed with SIMD; the second has too many features
//! for that.

use impinge::dim3::math::{Isometry, Point, Vector};
use impinge::dim3::query::{ContactManifold, ContactPrediction, contact_manifolds};
use impinge::dim3::shape::{ConvexHull, TriMesh};
use impinge::math::Real;

use crate::support::samples::samples;
use crate::support::slides::Random;

/// Returns a prism with eight sides between the heights -1 and 0, under a frustum up to the height
/// 1. `is_domed` adds a dome of 300 vertices around the frustum, within the same bounding box.
fn prism(is_domed: bool) -> ConvexHull<f64> {
    let ring = |count: u32, radius: f64, height: f64| {
        (0..count).map(move |k| {
            let angle = f64::from(k) * std::f64::consts::TAU / f64::from(count);
            let (sine, cosine) = angle.sine_cosine();
            Point::new(radius * cosine, height, radius * sine)
        })
    };
    let ends = ring(8, 1.0, -1.0).chain(ring(8, 1.0, 0.0)).chain(ring(8, 0.25, 1.0));
    let mut points: Vec<_> = ends.collect();
    if is_domed {
        for level in 1..=12_u32 {
            let (sine, cosine) = (f64::from(level) * 0.11).sine_cosine();
            points.extend(ring(25, 0.9 * cosine, 0.99 * sine));
        }
    }
    ConvexHull::from_points(&points)
}

/// Returns a two-sided surface of terraces: flat steps at the heights -0.3 and -0.1, and steep walls
/// between them.
fn terraces() -> TriMesh<f64> {
    let (columns, rows) = (14_u32, 8_u32);
    let mut vertices = Vec::new();
    let mut x = -3.5;
    for column in 0..columns {
        // After every second column the next one is only 0.02 away, so that the step in height
        // becomes a wall.
        x += if column % 2 == 0 { 0.5 } else { 0.02 };
        for row in 0..rows {
            let height = 0.2 * f64::from(column / 2 % 2);
            vertices.push(Point::new(x, height - 0.3, f64::from(row) * 0.6 - 2.1));
        }
    }
    let cell = |c: u32, r: u32| {
        let [a, b] = [c * rows + r, (c + 1) * rows + r];
        [[a, a + 1, b + 1], [a, b + 1, b]]
    };
    let cells = (0..columns - 1).flat_map(|c| (0..rows - 1).flat_map(move |r| cell(c, r)));
    TriMesh::new(vertices, cells.collect())
}

/// Returns the normal, depth and number of points of each manifold, in order.
fn summary(manifolds: &[ContactManifold<f64>]) -> Vec<(Vector<f64>, f64, usize)> {
    let of = |manifold: &ContactManifold<f64>| {
        let deepest = manifold.deepest_contact().expect("not empty").contact;
        (deepest.normal.into_inner(), deepest.depth, manifold.len())
    };
    manifolds.iter().map(of).collect()
}

#[test]
fn contacts_depend_on_near_features_only() {
    let (small, large) = (prism(false), prism(true));
    let (mut random, mut several) = (Random::new(7), 0);
    let (here, near) = (Isometry::identity(), ContactPrediction::new(0.01, 0.0, 0.0));
    let surface = terraces();
    for case in 0..samples(60) {
        // Upright on the upper steps, a little deep in them.
        let depth = 0.01 + 0.03 * random.unit().abs();
        let position = Vector::new(random.unit() * 2.0, 0.9 - depth, random.unit());
        let there = Isometry::new(position, Vector::y() * (3.0 * random.unit()));
        let [one, other] = [&small, &large]
            .map(|hull| summary(&contact_manifolds(&here, &surface, &there, hull, &near, None)));
        assert_eq!(one.len(), other.len(), "case {case}: the number of manifolds");
        for (one, other) in one.iter().zip(&other) {
            let difference = [(one.0 - other.0).norm(), (one.1 - other.1).abs()];
            let are_equal = difference.iter().all(|length| *length < 1e-9) && one.2 == other.2;
            assert!(are_equal, "case {case}: {one:?}, with a dome {other:?}");
        }
        several += usize::from(one.len() > 1);
    }
    assert!(several > 10, "{several} poses with several manifolds");
}
