//! Tests that solids that slide over flat floors of many parts have only the normal of the floor,
//! and no contact at an internal edge.

use crate::support::samples::stride;
use crate::support::slides;

use impinge::math::na::{Translation3, UnitQuaternion};
use impinge::math::{Isometry3, Real, Space, Vector};
use impinge::shape::Shape;
use slides::{Expected, PATTERNS, Random, field, grid, lowest, slide, solids3};

/// Returns two poses of the floor in the world: the identity, and an oblique one away from the
/// origin.
fn frames<N: Real>() -> Vec<Isometry3<N>> {
    let lit = |x: f64| N::lit(x);
    let axis = |x: f64, y: f64, z: f64| Vector::<N, 3>::new(lit(x), lit(y), lit(z));
    vec![
        Isometry3::identity(),
        Isometry3::from_parts(
            Translation3::from(axis(3.0, -40.0, 11.0)),
            UnitQuaternion::from_scaled_axis(axis(0.7, -1.3, 0.4)),
        ),
    ]
}

/// Returns orientations of a solid on the floor: resting on a face, rotated about the vertical,
/// slightly tilted, arbitrary.
fn turns<N: Real>() -> Vec<UnitQuaternion<N>> {
    let axes = [
        [0.0, 0.0, 0.0],
        [0.0, 0.7, 0.0],
        [std::f64::consts::FRAC_PI_2, 0.0, 0.0],
        [0.02, 0.3, -0.01],
        [0.4, 1.0, 0.3],
        [1.0, -2.0, 0.5],
    ];
    let turn = |axis: [f64; 3]| UnitQuaternion::from_scaled_axis(Vector::from(axis.map(N::lit)));
    axes.into_iter().map(turn).collect()
}

/// Slides all solids over a flat floor around `center`, in many directions. Asserts that each
/// contact has the floor's normal and the depth `depth`, in a single manifold. By default every
/// seventh way is tested, beginning with a way that depends on the seed. These twelve ways have all
/// solids, and each of the twelve pairs of a rotation and a frame occurs once.
fn slide_all<N: Real + Space<3, Isometry = Isometry3<N>>>(
    floor: &dyn Shape<N, 3>,
    center: [f64; 3],
    (depth, seed): (f64, u64),
    label: &str,
) {
    let mut random = Random::new(seed);
    let mut number = seed;
    for (name, solid) in solids3::<N>() {
        for (at, turn) in turns::<N>().into_iter().enumerate() {
            for frame in frames::<N>() {
                let angle = N::lit(random.unit() * 3.2);
                let (sine, cosine) = angle.sine_cosine();
                let direction = Vector::<N, 3>::new(cosine, N::ZERO, sine);
                let start = [random.unit() * 0.3, random.unit() * 0.3];
                number += 1;
                if !number.is_multiple_of(stride(7) as u64) {
                    continue;
                }
                let turned = Isometry3::from_parts(Translation3::identity(), turn);
                let height = -lowest(solid.as_ref(), &turned) - N::lit(depth);
                let way = (0..15).map(|step| {
                    let along = direction * N::lit(f64::from(step) * 0.167 - 1.2);
                    let base = Vector::<N, 3>::new(
                        N::lit(center[0] + start[0]),
                        height + N::lit(center[1]),
                        N::lit(center[2] + start[1]),
                    );
                    frame * Isometry3::from_parts(Translation3::from(base + along), turn)
                });
                let up = frame.rotation * Vector::<N, 3>::new(N::ZERO, N::ONE, N::ZERO);
                let size = N::lit(64.0 + center.iter().fold(0.0, |most: f64, x| most.max(x.abs())));
                let expected = Expected {
                    normal: up,
                    normal_tolerance: N::lit(1e-6),
                    depth: N::lit(depth),
                    // Distances of curved solids are accurate to 2⁻⁴⁰ of the size.
                    depth_tolerance: N::lit(1e-11) + N::lit(16.0) * N::EPSILON * size,
                    manifolds: 1,
                };
                let name = format!("{label}: {name}, turn {at}, depth {depth}");
                slide(&name, (&frame, floor), solid.as_ref(), way, &expected);
            }
        }
    }
}

fn over_meshes<N: Real + Space<3, Isometry = Isometry3<N>>>(depth: f64) {
    for (at, pattern) in PATTERNS.into_iter().enumerate() {
        let floor = grid::<N>(24, 0.5, [0.0; 3], pattern, |_, _| 0.0);
        slide_all::<N>(&floor, [0.0; 3], (depth, at as u64), &format!("{pattern:?}"));
    }
}

#[test]
fn solids_slide_over_meshes_in_single_precision() {
    over_meshes::<f32>(0.01);
}

#[test]
fn solids_slide_over_meshes_in_double_precision() {
    over_meshes::<f64>(0.01);
}

#[test]
fn solids_hover_over_meshes() {
    over_meshes::<f64>(-0.01);
    over_meshes::<f32>(-0.01);
}

#[test]
fn solids_touch_meshes() {
    over_meshes::<f64>(0.0);
    over_meshes::<f32>(0.0);
}

#[test]
fn solids_slide_far_from_the_meshes_origin() {
    let center = [1000.0, 50.0, -3000.0];
    for pattern in PATTERNS {
        let floor = grid::<f32>(24, 0.5, center, pattern, |_, _| 0.0);
        slide_all::<f32>(&floor, center, (0.01, 5), &format!("far {pattern:?}"));
        let floor = grid::<f64>(24, 0.5, center, pattern, |_, _| 0.0);
        slide_all::<f64>(&floor, center, (0.01, 5), &format!("far {pattern:?}"));
    }
}

#[test]
fn solids_slide_over_height_fields() {
    slide_all::<f32>(&field::<f32>(24, 0.5), [0.0; 3], (0.01, 8), "field");
    slide_all::<f64>(&field::<f64>(24, 0.5), [0.0; 3], (0.01, 8), "field");
    slide_all::<f32>(&field::<f32>(24, 0.5), [0.0; 3], (-0.01, 8), "field");
}
