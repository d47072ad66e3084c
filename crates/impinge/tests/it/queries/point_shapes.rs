//! Compares queries of points with a slow oracle: samples of each boundary, found along rays from
//! the middle.

use crate::support::solids;

use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::query::PointQuery;
use solids::{
    Flat, Rng, Solid, local, narrow, plane_solids, random_segment, random_triangle, space_solids,
    wide,
};

fn rounding<N: Real, const D: usize>(solid: &Solid<N, D>, far: f64) -> f64 {
    let iterated = ["ellipsoid", "round box"].contains(&solid.name);
    let unit = N::EPSILON.as_f64().max(if iterated { 1e-11 } else { 0.0 });
    50.0 * unit * (solid.size + far)
}

/// Asserts that the result lies on the boundary, and that no sample is nearer, neither all around
/// nor close to the result.
fn check_nearest<N: Real, const D: usize>(
    rng: &mut Rng,
    solid: &Solid<N, D>,
    (asked, found): (&Vector<f64, D>, &Vector<f64, D>),
    close: f64,
) {
    let what = format!("{} at {asked}: {found}", solid.name);
    assert!(solid.at(found).abs() <= close, "{} off the boundary: {what}", solid.at(found));
    let distance = (asked - found).norm();
    let toward = found - solid.center;
    for sample in 0..150 {
        let direction = match sample % 3 {
            0 => rng.vector::<D>(1.0),
            1 => toward + rng.vector::<D>(1.0) * (0.1 * toward.norm()),
            _ => toward + rng.vector::<D>(1.0) * (0.01 * toward.norm()),
        };
        if let Some(other) = solid.boundary(&direction) {
            let nearer = distance - (asked - other).norm();
            // On a flat side the nearest point may move by the rounding error, on a curved side by
            // its square root.
            assert!(nearer <= 4.0 * close, "{other} is nearer by {nearer}: {what}");
        }
    }
}

fn check_point<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    rng: &mut Rng,
    m: &Isometry<N, R, D>,
    solid: &Solid<N, D>,
) -> (u32, u32) {
    // Points near the boundary or anywhere, so that about half of them are inside.
    let place = match solid.boundary(&rng.vector::<D>(1.0)) {
        Some(surface) => solid.center + (surface - solid.center) * rng.between(0.0, 2.0),
        None => rng.vector::<D>(2.0 * solid.size),
    };
    let point = m.transform_point(&Point::from(narrow(&place)));
    let asked = local(m, &wide(&point.coords));
    let close = rounding(solid, asked.norm() + wide(&m.translation.vector).norm());
    let (hollow, feature) = solid.shape.project_point_with_feature(m, &point);
    let found = local(m, &wide(&hollow.point.coords));
    let level = solid.at(&asked);
    let what = format!("{} at {asked} (level {level}): {hollow:?} {feature:?}", solid.name);
    if level.abs() > 4.0 * close {
        assert_eq!(hollow.is_inside, level < 0.0, "{what}");
    }
    check_nearest(rng, solid, (&asked, &found), close);
    consistent(solid, m, &point);
    let signed = solid.shape.distance_to_point(m, &point, false).as_f64();
    let expected = (asked - found).norm() * if hollow.is_inside { -1.0 } else { 1.0 };
    assert!((signed - expected).abs() <= close, "{signed} and {expected}: {what}");
    (1, u32::from(hollow.is_inside))
}

/// Asserts that all queries agree on whether the point is inside, and that all projections agree.
fn consistent<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solid: &Solid<N, D>,
    m: &Isometry<N, R, D>,
    point: &Point<N, D>,
) {
    let shape = &solid.shape;
    let (full, hollow) =
        (shape.project_point(m, point, true), shape.project_point(m, point, false));
    let distance = shape.distance_to_point(m, point, true);
    let what = format!("{} at {point}: {full:?}", solid.name);
    assert_eq!(shape.contains_point(m, point), full.is_inside, "{what}");
    assert_eq!(distance == N::ZERO, full.is_inside, "{distance}: {what}");
    assert_eq!(hollow.is_inside, full.is_inside, "{what}");
    assert_eq!(shape.project_point_with_feature(m, point).0, hollow, "{what}");
    let expected = if full.is_inside { *point } else { hollow.point };
    assert_eq!(full.point, expected, "{what}");
    assert!(distance >= N::ZERO, "{what}");
}

fn run<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solids: impl Fn(&mut Rng) -> Vec<Solid<N, D>>,
    pose: impl Fn(&mut Rng) -> Isometry<N, R, D>,
    kinds: usize,
) {
    let mut rng = Rng::new(43);
    let mut counts = std::collections::BTreeMap::new();
    for _ in 0..25 {
        let m = pose(&mut rng);
        for solid in solids(&mut rng) {
            let count: &mut (u32, u32) = counts.entry(solid.name).or_default();
            for _ in 0..6 {
                let (all, inside) = check_point(&mut rng, &m, &solid);
                *count = (count.0 + all, count.1 + inside);
            }
        }
    }
    assert_eq!(counts.len(), kinds, "every kind was there");
    for (name, (all, inside)) in counts {
        let rate = f64::from(inside) / f64::from(all);
        assert!((0.3..=0.7).contains(&rate), "{name}: {inside} of {all} inside");
    }
}

fn pose2<N: Real>(rng: &mut Rng, far: f64) -> Isometry2<N> {
    Isometry2::new(narrow(&rng.vector::<2>(far)), N::lit(rng.between(-3.0, 3.0)))
}

fn pose3<N: Real>(rng: &mut Rng, far: f64) -> Isometry3<N> {
    Isometry3::new(narrow(&rng.vector::<3>(far)), narrow(&rng.vector::<3>(2.0)))
}

#[test]
fn solids_of_the_plane_agree_with_samples() {
    run(plane_solids::<f64>, |rng| pose2(rng, 2.0), 11);
    run(plane_solids::<f32>, |rng| pose2(rng, 2.0), 11);
}

#[test]
fn solids_of_space_agree_with_samples() {
    run(space_solids::<f64>, |rng| pose3(rng, 2.0), 13);
    run(space_solids::<f32>, |rng| pose3(rng, 2.0), 13);
}

#[test]
fn solids_far_from_the_world_origin_agree_with_samples() {
    run(plane_solids::<f32>, |rng| pose2(rng, 1e3), 11);
    run(space_solids::<f64>, |rng| pose3(rng, 1e6), 13);
}

/// Tests shapes without thickness: the result is a convex combination of the corners, and no
/// combination on a grid is nearer.
fn check_flat<N: Space<D>, const D: usize>(rng: &mut Rng, flat: &Flat<N, D>) {
    let asked = rng.vector::<D>(4.0);
    let (near, feature) = flat.shape.project_local_point(&Point::from(narrow(&asked)));
    let found = wide(&near.point.coords);
    let distance = (asked - found).norm();
    let close = 100.0 * N::EPSILON.as_f64() * 8.0;
    let what = format!("{asked} {:?}: {found} {feature:?}", flat.corners);
    assert!(!near.is_inside, "{what}");
    let (mut best, mut nearest) = (f64::INFINITY, f64::INFINITY);
    let steps = 200;
    let last = flat.corners.len() - 1;
    for i in 0..=steps {
        let rest = if last == 2 { steps - i } else { 0 };
        for j in 0..=rest {
            let (u, v) = (f64::from(i) / f64::from(steps), f64::from(j) / f64::from(steps));
            let mix =
                flat.corners[0] * (1.0 - u - v) + flat.corners[1] * u + flat.corners[last] * v;
            best = best.min((mix - asked).norm());
            nearest = nearest.min((mix - found).norm());
        }
    }
    assert!(distance <= best + close, "{best} is nearer than {distance}: {what}");
    assert!(best - distance <= 0.05 && nearest <= 0.05, "off the set by {nearest}: {what}");
    let (again, _) = flat.shape.project_local_point(&near.point);
    assert!(again.is_inside, "what lies on it is in it: {what}");
}

#[test]
fn sets_without_thickness_agree_with_a_grid() {
    let mut rng = Rng::new(44);
    for _ in 0..60 {
        let segment = random_segment::<f64, 2>(&mut rng);
        check_flat(&mut rng, &segment);
        let segment = random_segment::<f32, 3>(&mut rng);
        check_flat(&mut rng, &segment);
        let triangle = random_triangle::<f64>(&mut rng);
        check_flat(&mut rng, &triangle);
        let triangle = random_triangle::<f32>(&mut rng);
        check_flat(&mut rng, &triangle);
    }
}
