//! Bug: two thin strips with corners kilometres from the origin of their frames had a distance of
//! zero but no contact. The proof of overlaps by inner balls did not count the rounding errors of
//! the centres.

use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space};
use impinge::query::{Proximity, contact, distance, proximity};
use impinge::shape::{ConvexHull, ConvexPolygon, Shape};

use crate::support::samples::samples;

/// Asserts that distance, proximity and contact agree about touching, and returns whether the
/// strips touch.
fn agree<R, const D: usize>(here: &Isometry<f32, R, D>, [a, b]: [&dyn Shape<f32, D>; 2]) -> bool
where
    f32: Space<D>,
    R: AbstractRotation<f32, D> + Copy,
    Isometry<f32, R, D>: Into<<f32 as Space<D>>::Isometry>,
{
    let touches = contact(here, a, here, b, 0.0).is_some();
    assert_eq!(distance(here, a, here, b) == 0.0, touches, "distance of {a:?} and {b:?}");
    let near = proximity(here, a, here, b, 0.0);
    assert_eq!(near == Proximity::Intersecting, touches, "proximity of {a:?} and {b:?}");
    touches
}

#[test]
fn strips_side_by_side() {
    let a: [[f64; 2]; 4] = [
        [8_046.660_644_531_25, 5_643.538_085_937_5],
        [8_044.835_449_218_75, 5_644.355_957_031_25],
        [8_044.819_335_937_5, 5_644.319_824_218_75],
        [8_046.644_042_968_75, 5_643.501_464_843_75],
    ];
    let b: [[f64; 2]; 4] = [
        [8_046.644_042_968_75, 5_643.500_488_281_25],
        [8_044.818_847_656_25, 5_644.318_847_656_25],
        [8_044.802_246_093_75, 5_644.282_226_562_5],
        [8_046.627_441_406_25, 5_643.463_867_187_5],
    ];
    let point = |corner: [f64; 2]| Point::<f32, 2>::from(corner.map(f32::lit));
    let [a, b] = [a, b].map(|corners| ConvexPolygon::new(&corners.map(point)));
    assert!(!agree(&Isometry2::identity(), [&a, &b]), "they are a millimetre apart");
}

#[test]
fn strips_at_random() {
    let mut state = 5_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let mut touching = 0;
    let count = samples(6000);
    for _ in 0..count {
        let (x, y, angle) = (8000.0 * random(), 8000.0 * random(), 6.3 * random());
        let (half, thick, gap) = (1.0_f32, 0.04_f32, 0.004 * random());
        let corner = |along: f32, across: f32| {
            let (sine, cosine) = (angle.sin(), angle.cos());
            [x + along * cosine - across * sine, y + along * sine + across * cosine]
        };
        let strip = |low: f32| {
            [
                corner(-half, low),
                corner(half, low),
                corner(half, low + thick),
                corner(-half, low + thick),
            ]
        };
        let strips = [strip(0.0), strip(thick + gap)];
        let [a, b] = strips.map(|strip| ConvexPolygon::new(&strip.map(Point::<f32, 2>::from)));
        touching += usize::from(agree(&Isometry2::identity(), [&a, &b]));
        let [a, b] = strips.map(|strip| {
            let corners = strip.iter().flat_map(|[x, y]| [[*x, *y, -1.0], [*x, *y, 1.0]]);
            ConvexHull::from_points(&corners.map(Point::<f32, 3>::from).collect::<Vec<_>>())
        });
        agree(&Isometry3::identity(), [&a, &b]);
    }
    assert!(touching > count / 20 && touching < count, "{touching} of {count} touch");
}
