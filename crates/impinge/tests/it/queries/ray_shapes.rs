//! Compares ray casts with a slow oracle, which searches along the ray for the zeros of the convex
//! level function of each solid.

use crate::support::solids;

use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::query::{PointQuery, Ray, RayCast, RayIntersection};
use solids::{
    Flat, Rng, Solid, local, narrow, plane_solids, random_segment, random_triangle, space_solids,
    turned_back, wide,
};

/// A ray in world coordinates, and in the local frame in `f64`.
struct Shot<N: Real, const D: usize> {
    ray: Ray<N, D>,
    origin: Vector<f64, D>,
    dir: Vector<f64, D>,
}

impl<N: Real, const D: usize> Shot<N, D> {
    fn at(&self, t: f64) -> Vector<f64, D> {
        self.origin + self.dir * t
    }
}

/// Returns a random ray that starts up to two sizes from the local origin, with a direction of any
/// length. Some rays aim near the centre, more of them in 3D.
fn shoot<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    rng: &mut Rng,
    m: &Isometry<N, R, D>,
    solid: &Solid<N, D>,
) -> Shot<N, D> {
    let endless = solid.name == "plane";
    let above = if endless { solid.center * -2.0 } else { Vector::<f64, D>::zeros() };
    let origin = above + rng.vector::<D>(2.0 * solid.size);
    let aim = if !endless && (rng.bits() % 8) < 2 * (D as u64 - 1) { 0.25 } else { 3.0 };
    let dir = if endless {
        rng.vector::<D>(1.0)
    } else {
        solid.center + rng.vector::<D>(aim * solid.size) - origin
    };
    let length = 10_f64.powi((rng.bits() % 7) as i32 - 3);
    let world = m.transform_point(&Point::from(narrow(&origin)));
    let turned = m.rotation.transform_vector(&narrow(&(dir * length)));
    let ray = Ray::new(world, turned);
    let tip = local(m, &wide(&(world.coords)));
    let toward = turned_back(m, &turned);
    Shot { ray, origin: tip, dir: toward }
}

/// Returns the time and level at which the line is deepest in the solid, by ternary search: a
/// convex function has one minimum.
fn deepest<N: Real, const D: usize>(solid: &Solid<N, D>, shot: &Shot<N, D>) -> (f64, f64) {
    let speed = shot.dir.norm();
    let (mut low, mut high) = (0.0, 12.0 * solid.size / speed);
    for _ in 0..200 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if solid.at(&shot.at(a)) < solid.at(&shot.at(b)) { high = b } else { low = a }
    }
    (low, solid.at(&shot.at(low)))
}

/// Returns the time, between two times, at which the sign of the level changes, by bisection.
fn crossing<N: Real, const D: usize>(
    solid: &Solid<N, D>,
    shot: &Shot<N, D>,
    mut times: (f64, f64),
) -> f64 {
    let inside = solid.at(&shot.at(times.0)) <= 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (times.0 + times.1);
        let same = (solid.at(&shot.at(middle)) <= 0.0) == inside;
        *(if same { &mut times.0 } else { &mut times.1 }) = middle;
    }
    times.1
}

struct Expected {
    hit: bool,
    solid: f64,
    /// Time of the hit of the hollow shape; `None` if the ray misses the shape, or starts inside
    /// and never leaves.
    hollow: Option<f64>,
}

/// Returns the expected hit or miss; `None` if rounding might decide: if the ray starts near the
/// boundary, grazes the solid, meets it far away, or is nearly parallel to the half-space it
/// misses.
fn expected<N: Real, const D: usize>(solid: &Solid<N, D>, shot: &Shot<N, D>) -> Option<Expected> {
    let unclear = 0.02 * solid.size;
    let start = solid.at(&shot.origin);
    let (time, depth) = deepest(solid, shot);
    if start.abs() < unclear || depth.abs() < unclear {
        return None;
    }
    let far = 1e6 * solid.size / shot.dir.norm();
    let near = |t: f64| t * shot.dir.norm() < 12.0 * solid.size;
    if start < 0.0 {
        let leaves = solid.at(&shot.at(far)) > 0.0;
        let hollow = leaves.then(|| crossing(solid, shot, (0.0, far)));
        let clear = hollow.is_none_or(near);
        return clear.then_some(Expected { hit: true, solid: 0.0, hollow });
    }
    if depth > 0.0 {
        // Not certain for a ray nearly parallel to a half-space.
        let clear = solid.at(&shot.at(far)) > start + solid.size;
        return clear.then_some(Expected { hit: false, solid: f64::NAN, hollow: None });
    }
    let t = crossing(solid, shot, (0.0, time));
    near(t).then_some(Expected { hit: true, solid: t, hollow: Some(t) })
}

/// Returns the least error that rounding explains: a few units in the last place of the greatest
/// length. Shapes found by iteration stop at 2⁻⁴⁰ of that length.
fn rounding<N: Real, const D: usize>(solid: &Solid<N, D>, shot: &Shot<N, D>, far: f64) -> f64 {
    let iterated = ["ellipsoid", "round box"].contains(&solid.name);
    let unit = N::EPSILON.as_f64().max(if iterated { 1e-12 } else { 0.0 });
    200.0 * unit * (solid.size + shot.origin.norm() + far)
}

fn check_hit<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solid: &Solid<N, D>,
    m: &Isometry<N, R, D>,
    shot: &Shot<N, D>,
    (found, t, leaving): (RayIntersection<N, D>, f64, bool),
) {
    let what = format!("{} {:?} expected {t}, found {found:?}", solid.name, shot.ray);
    let far = wide(&m.translation.vector).norm();
    let close = rounding(solid, shot, far);
    let off = (found.toi.as_f64() - t).abs() * shot.dir.norm();
    assert!(off <= 60.0 * close, "time is off by {off}: {what}");
    let place = shot.at(found.toi.as_f64());
    assert!(solid.at(&place).abs() <= 4.0 * close, "off the boundary: {what}");
    let distance = solid.shape.distance_to_point(m, &shot.ray.point_at(found.toi), false);
    assert!(distance.as_f64().abs() <= 4.0 * close, "{distance} from the boundary: {what}");
    let normal = turned_back(m, &found.normal);
    assert!((normal.norm() - 1.0).abs() <= 100.0 * N::EPSILON.as_f64(), "not unit: {what}");
    let along = normal.dot(&shot.dir.normalize());
    assert!(if leaving { along > -1e-3 } else { along < 1e-3 }, "wrong side: {what}");
    let mut rng = Rng::new(7);
    for _ in 0..40 {
        if let Some(other) = solid.boundary(&rng.vector::<D>(1.0)) {
            let above = normal.dot(&(other - place));
            let blunt = N::EPSILON.as_f64().sqrt().max(1e-6) * 4.0 * solid.size;
            assert!(above <= blunt, "the normal leaves {above} outside: {what}");
        }
    }
}

fn check_solid<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    rng: &mut Rng,
    m: &Isometry<N, R, D>,
    solid: &Solid<N, D>,
) -> (u32, u32) {
    let shot = shoot(rng, m, solid);
    let Some(expected) = expected(solid, &shot) else { return (0, 0) };
    let found = solid.shape.toi_and_normal_with_ray(m, &shot.ray, true);
    let what = format!("{} {:?} at {}: {found:?}", solid.name, shot.ray, m.translation);
    assert_eq!(found.is_some(), expected.hit, "{what}");
    assert_eq!(solid.shape.intersects_ray(m, &shot.ray), expected.hit, "{what}");
    assert_eq!(solid.shape.toi_with_ray(m, &shot.ray, true), found.map(|hit| hit.toi), "{what}");
    let hollow = solid.shape.toi_and_normal_with_ray(m, &shot.ray, false);
    let Some(found) = found else {
        assert_eq!(hollow, None, "{what}");
        return (1, 0);
    };
    let starts_inside = expected.solid == 0.0;
    if starts_inside {
        assert_eq!(found.toi, N::ZERO, "{what}");
        assert_eq!(found.normal, Vector::<N, D>::zeros(), "{what}");
        assert_eq!(hollow.is_some(), expected.hollow.is_some(), "{what}");
        if let (Some(hollow), Some(t)) = (hollow, expected.hollow) {
            check_hit(solid, m, &shot, (hollow, t, true));
        }
    } else {
        assert_eq!(hollow, Some(found), "{what}");
        check_hit(solid, m, &shot, (found, expected.solid, false));
    }
    (1, 1)
}

/// Counts hits and misses by name, and asserts that each kind of solid is both hit and missed.
fn run<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solids: impl Fn(&mut Rng) -> Vec<Solid<N, D>>,
    pose: impl Fn(&mut Rng) -> Isometry<N, R, D>,
    kinds: usize,
) {
    let mut rng = Rng::new(42);
    let mut counts = std::collections::BTreeMap::new();
    for _ in 0..40 {
        let m = pose(&mut rng);
        for solid in solids(&mut rng) {
            let count: &mut (u32, u32) = counts.entry(solid.name).or_default();
            for _ in 0..12 {
                let (clear, hit) = check_solid(&mut rng, &m, &solid);
                *count = (count.0 + clear, count.1 + hit);
            }
        }
    }
    assert_eq!(counts.len(), kinds, "every kind was there");
    for (name, (clear, hits)) in counts {
        let rate = f64::from(hits) / f64::from(clear);
        assert!(clear > 200 && (0.3..=0.7).contains(&rate), "{name}: {hits} of {clear} hit");
    }
}

fn pose2<N: Real>(rng: &mut Rng, far: f64) -> Isometry2<N> {
    Isometry2::new(narrow(&rng.vector::<2>(far)), N::lit(rng.between(-3.0, 3.0)))
}

fn pose3<N: Real>(rng: &mut Rng, far: f64) -> Isometry3<N> {
    Isometry3::new(narrow(&rng.vector::<3>(far)), narrow(&rng.vector::<3>(2.0)))
}

#[test]
fn solids_of_the_plane_agree_with_the_oracle() {
    run(plane_solids::<f64>, |rng| pose2(rng, 2.0), 11);
    run(plane_solids::<f32>, |rng| pose2(rng, 2.0), 11);
}

#[test]
fn solids_of_space_agree_with_the_oracle() {
    run(space_solids::<f64>, |rng| pose3(rng, 2.0), 13);
    run(space_solids::<f32>, |rng| pose3(rng, 2.0), 13);
}

#[test]
fn solids_far_from_the_world_origin_agree_with_the_oracle() {
    run(plane_solids::<f32>, |rng| pose2(rng, 1e3), 11);
    run(space_solids::<f64>, |rng| pose3(rng, 1e6), 13);
}

/// Asserts that a ray from far away, aimed at the centre of a solid, finds the boundary as
/// precisely as its own coordinates are.
fn far_rays<N: Space<D>, const D: usize>(solids: Vec<Solid<N, D>>, away: f64) {
    let mut rng = Rng::new(5);
    for solid in solids.iter().filter(|solid| solid.name != "plane") {
        for _ in 0..20 {
            let toward = rng.vector::<D>(1.0);
            let origin = toward.map(f64::signum) * away + rng.vector::<D>(1.0);
            let origin = wide::<N, D>(&narrow(&origin));
            let dir = wide::<N, D>(&narrow(&((solid.center - origin) * 0.125)));
            let ray = Ray::new(Point::from(narrow(&origin)), narrow(&dir));
            let what = format!("{} {ray:?}", solid.name);
            let hit = solid.shape.cast_local_ray(&ray, true).expect(&what);
            let place = origin + dir * hit.toi.as_f64();
            let close = 16.0 * N::EPSILON.as_f64().max(1e-12) * away;
            assert!(solid.at(&place).abs() <= close, "{} off: {what}", solid.at(&place));
        }
    }
}

#[test]
fn rays_from_afar_find_the_boundary() {
    for away in [1e3, 1e6] {
        far_rays(plane_solids::<f64>(&mut Rng::new(1)), away);
        far_rays(space_solids::<f64>(&mut Rng::new(2)), away);
    }
    far_rays(plane_solids::<f32>(&mut Rng::new(3)), 1e3);
    far_rays(space_solids::<f32>(&mut Rng::new(4)), 1e3);
}

/// Returns the parameters of the crossing on the ray and on a segment in 2D, by Cramer's rule. The
/// ray hits if the first is not negative and the second lies in 0..=1.
fn segment_by_cramer<const D: usize>(
    flat: &[Vector<f64, 2>],
    origin: &Vector<f64, 2>,
    dir: &Vector<f64, 2>,
) -> (f64, f64) {
    let along = flat[1] - flat[0];
    let determinant = dir.perp(&along);
    let to_a = flat[0] - origin;
    (to_a.perp(&along) / determinant, to_a.perp(dir) / determinant)
}

#[test]
fn segments_of_the_plane_agree_with_cramer() {
    let (mut rng, mut hits, mut clear) = (Rng::new(9), 0, 0);
    for _ in 0..4000 {
        let Flat { shape, corners } = random_segment::<f64, 2>(&mut rng);
        let origin = rng.vector::<2>(4.0);
        let middle = (corners[0] + corners[1]) * 0.5;
        let dir = middle + rng.vector::<2>(1.5) - origin;
        let (t, u) = segment_by_cramer::<2>(&corners, &origin, &dir);
        if t.abs() < 1e-3 || u.abs() < 1e-3 || (u - 1.0).abs() < 1e-3 {
            continue;
        }
        clear += 1;
        let found =
            shape.cast_local_ray(&Ray::new(Point::from(origin), dir), rng.bits().is_multiple_of(2));
        let expected = t > 0.0 && (0.0..=1.0).contains(&u);
        assert_eq!(found.is_some(), expected, "{corners:?} {origin} {dir}: {found:?}");
        if let Some(found) = found {
            hits += 1;
            assert!((found.toi - t).abs() < 1e-9 * (1.0 + t), "{t}: {found:?}");
            assert!(found.normal.dot(&(corners[1] - corners[0])).abs() < 1e-12, "{found:?}");
            assert!(found.normal.dot(&dir) < 0.0, "it faces the ray: {found:?}");
        }
    }
    let rate = f64::from(hits) / f64::from(clear);
    assert!((0.3..=0.7).contains(&rate), "{hits} of {clear}");
}

/// Returns the parameters of `origin + t · dir = a + u · (b − a) + v · (c − a)` by Cramer's rule.
fn triangle_by_cramer(
    corners: &[Vector<f64, 3>],
    origin: &Vector<f64, 3>,
    dir: &Vector<f64, 3>,
) -> [f64; 3] {
    let (to_b, to_c, to_ray) =
        (corners[1] - corners[0], corners[2] - corners[0], origin - corners[0]);
    let volume = |a: &Vector<f64, 3>, b: &Vector<f64, 3>, c: &Vector<f64, 3>| a.dot(&b.cross(c));
    let whole = volume(&to_b, &to_c, &-dir);
    [
        volume(&to_b, &to_c, &to_ray) / whole,
        volume(&to_ray, &to_c, &-dir) / whole,
        volume(&to_b, &to_ray, &-dir) / whole,
    ]
}

fn triangles_of_space<N: Real>() {
    let (mut rng, mut hits, mut clear) = (Rng::new(11), 0, 0);
    for _ in 0..4000 {
        let Flat { shape, corners } = random_triangle::<N>(&mut rng);
        let origin = rng.vector::<3>(4.0);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let dir = middle + rng.vector::<3>(0.75) - origin;
        let [t, u, v] = triangle_by_cramer(&corners, &origin, &dir);
        let near = [t, u, v, 1.0 - u - v].iter().fold(f64::INFINITY, |low, x| low.min(x.abs()));
        let size = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
        if near < 1e-2 || size < 0.5 || t > 10.0 {
            continue;
        }
        clear += 1;
        let ray = Ray::new(Point::from(narrow(&origin)), narrow(&dir));
        let found = shape.cast_local_ray(&ray, rng.bits().is_multiple_of(2));
        let expected = t > 0.0 && u > 0.0 && v > 0.0 && u + v < 1.0;
        assert_eq!(found.is_some(), expected, "{corners:?} {origin} {dir}: {found:?}");
        if let Some(found) = found {
            hits += 1;
            let off = (found.toi.as_f64() - t).abs();
            assert!(off < 2000.0 * N::EPSILON.as_f64() * (1.0 + t), "{t}: {found:?}");
            let normal = wide(&found.normal);
            assert!(normal.dot(&dir) < 0.0, "it faces the ray: {found:?}");
            let lean = normal.dot(&(corners[1] - corners[0]).normalize());
            assert!(lean.abs() < 100.0 * N::EPSILON.as_f64(), "{found:?}");
        }
    }
    let rate = f64::from(hits) / f64::from(clear);
    assert!((0.3..=0.7).contains(&rate), "{hits} of {clear}");
}

#[test]
fn triangles_of_space_agree_with_cramer() {
    triangles_of_space::<f64>();
    triangles_of_space::<f32>();
}

/// Asserts that a ray at the common side or the common corner of triangles around a point hits at
/// least one of them.
fn no_gap<N: Real>() {
    let mut rng = Rng::new(13);
    for _ in 0..300 {
        let hub = rng.vector::<3>(0.5);
        let rim: Vec<_> = [(1.0, 0.0), (0.3, 0.9), (-0.8, 0.6), (-0.9, -0.7), (0.4, -1.0)]
            .map(|(x, y)| Vector::<f64, 3>::new(x, y, 0.0) * 3.0 + rng.vector::<3>(0.25))
            .to_vec();
        let point = |v: &Vector<f64, 3>| Point::from(narrow::<N, 3>(v));
        let fan: Vec<_> = (0..5)
            .map(|i| {
                impinge::shape::Triangle::new(point(&hub), point(&rim[i]), point(&rim[(i + 1) % 5]))
            })
            .collect();
        let origin = Vector::<f64, 3>::new(0.0, 0.0, 7.0) + rng.vector::<3>(1.0);
        for spoke in &rim {
            let at = hub + (spoke - hub) * (rng.between(0.0, 7.0).floor() / 8.0);
            let from = point(&origin);
            let ray = Ray::new(from, point(&at) - from);
            let hits = fan.iter().filter(|triangle| triangle.cast_local_ray(&ray, true).is_some());
            assert!(hits.count() >= 1, "{ray:?} slips through at {at}");
        }
    }
}

#[test]
fn rays_do_not_slip_between_triangles() {
    no_gap::<f32>();
    no_gap::<f64>();
}

/// Asserts that scaling all lengths by a power of two scales the results exactly.
fn scaling<N: Space<D>, const D: usize>(solids: impl Fn(&mut Rng) -> Vec<Solid<N, D>>, power: i32) {
    let factor = N::lit(2_f64.powi(power));
    let plain = solids(&mut Rng::new(3));
    let scaled = solids(&mut Rng::scaled(3, 2_f64.powi(power)));
    let mut rng = Rng::new(17);
    for (one, other) in plain.iter().zip(&scaled) {
        for _ in 0..50 {
            let origin: Vector<N, D> = narrow(&rng.vector::<D>(3.0));
            let dir: Vector<N, D> = narrow(&(rng.vector::<D>(1.0)));
            let solid = rng.bits().is_multiple_of(2);
            let ray = Ray::new(Point::from(origin), dir);
            let grown = Ray::new(Point::from(origin * factor), dir);
            let hit = one.shape.cast_local_ray(&ray, solid);
            let expected = hit.map(|hit| RayIntersection { toi: hit.toi * factor, ..hit });
            let found = other.shape.cast_local_ray(&grown, solid);
            assert_eq!(found, expected, "{} {ray:?} by 2^{power}", one.name);
            let point = Point::from(origin);
            let (near, feature) = one.shape.project_local_point(&point);
            let (grown, same) = other.shape.project_local_point(&Point::from(origin * factor));
            let expected = Point::from(near.point.coords * factor);
            assert_eq!(grown.point, expected, "{} {point} by 2^{power}", one.name);
            assert_eq!((grown.is_inside, same), (near.is_inside, feature), "{}", one.name);
        }
    }
}

#[test]
fn powers_of_two_scale_every_answer() {
    for power in [-20, -3, 7, 20] {
        scaling(plane_solids::<f32>, power);
        scaling(space_solids::<f32>, power);
        scaling(plane_solids::<f64>, 4 * power);
        scaling(space_solids::<f64>, 4 * power);
    }
}
