//! Compares ellipsoids and tapered capsules, including needles and thin disks, with searches
//! written for this test. The iterations of the general algorithm alone do not converge for these
//! solids.

use crate::support::query_support;

use impinge::math::na::{
    Isometry2, Isometry3, Matrix3, Quaternion, SymmetricEigen, UnitQuaternion, Vector2, Vector3,
};
use impinge::math::{Point, Real, Vector};
use impinge::query::{PointQuery, contact};
use impinge::shape::{Ellipsoid, Segment, Shape, TaperedCapsule};
use query_support::random::Random;

/// Returns the separation of two ellipsoids along a unit normal, its gradient and its Hessian. The
/// ellipsoids lie at the origin and at `away`, and are represented by the matrices of their squared
/// support functions.
fn height(
    normal: &Vector3<f64>,
    solids: &[Matrix3<f64>; 2],
    away: &Vector3<f64>,
) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let (mut height, mut gradient, mut hessian) = (normal.dot(away), *away, Matrix3::zeros());
    for solid in solids {
        let reach = normal.dot(&(solid * normal)).sqrt();
        let support = solid * normal / reach;
        height -= reach;
        gradient -= support;
        hessian -= (solid - support * support.transpose()) / reach;
    }
    (height, gradient, hessian)
}

/// Returns the largest separation that Newton's method with a line search reaches from a start
/// normal. Each step is uphill along every principal direction.
fn climbed(mut normal: Vector3<f64>, solids: &[Matrix3<f64>; 2], away: &Vector3<f64>) -> f64 {
    let (mut best, mut gradient, mut hessian) = height(&normal, solids, away);
    for _ in 0..200 {
        let across = Matrix3::identity() - normal * normal.transpose();
        let slope = across * gradient;
        let eigen = SymmetricEigen::new(across * hessian * across - across * best);
        let step = (0..3).fold(Vector3::zeros(), |step, index| {
            let along = eigen.eigenvectors.column(index).into_owned();
            let is_normal = along.dot(&normal).abs() > 0.5;
            let curvature = eigen.eigenvalues[index].abs().max(1e-12);
            if is_normal { step } else { step + along * (along.dot(&slope) / curvature) }
        });
        let shares = (0..50).map(|halvings| 0.5_f64.powi(halvings));
        let trials = shares.map(|share| (normal + step * share).normalize());
        let found = trials.map(|normal| (normal, height(&normal, solids, away)));
        let Some((next, raised)) = found.into_iter().find(|(_, found)| found.0 > best) else {
            break;
        };
        (normal, (best, gradient, hessian)) = (next, raised);
    }
    best
}

fn turn(random: &mut Random) -> UnitQuaternion<f64> {
    let q = Quaternion::new(random.signed(), random.signed(), random.signed(), random.signed());
    UnitQuaternion::new_normalize(q)
}

/// Returns the matrix whose quadratic form is the squared support function.
fn squared_support(turn: &UnitQuaternion<f64>, half_axes: &Vector3<f64>) -> Matrix3<f64> {
    let turn = turn.to_rotation_matrix().into_inner();
    turn * Matrix3::from_diagonal(&half_axes.component_mul(half_axes)) * turn.transpose()
}

#[test]
fn ellipsoids_are_as_far_apart_as_the_best_normal_says() {
    let (mut random, mut deep, mut apart) = (Random(1, false), 0, 0);
    for case in 0..1200_usize {
        let aspect: f64 = [1.5, 10.0, 1e2, 1e4][case % 4];
        let place = [2.0, 1.0, 0.5, 0.1, 0.01][case % 5];
        let half_axes = [0, 1].map(|_| {
            let mut shorter = || aspect.powf(-random.within(0.0, 1.0));
            Vector3::new(1.0, shorter(), shorter())
        });
        let turns = [turn(&mut random), turn(&mut random)];
        let away = random.direction::<f64, 3>() * place;
        let [solid1, solid2] = half_axes.map(Ellipsoid::<f64, 3>::new);
        let (m1, m2) = (
            Isometry3::from_parts(Vector3::zeros().into(), turns[0]),
            Isometry3::from_parts(away.into(), turns[1]),
        );
        let found = contact(&m1, &solid1, &m2, &solid2, f64::INFINITY).expect("they are finite");
        let solids = [0, 1].map(|i| squared_support(&turns[i], &half_axes[i]));
        let local = climbed(*found.normal, &solids, &away);
        let starts = (0..8).map(|_| random.direction::<f64, 3>());
        let best = starts.map(|start| climbed(start, &solids, &away)).fold(local, f64::max);
        // The square roots of this test lose half of the digits of the aspect ratio.
        let close = if aspect > 1e3 { 2e-12 } else { 2e-13 };
        assert!((best + found.depth).abs() <= close, "{best}, not {}: case {case}", -found.depth);
        let gap = found.world2 - found.world1 + *found.normal * found.depth;
        assert!(gap.norm() <= 1e-12, "across from each other, but for {gap}: case {case}");
        deep += u32::from(found.depth > 0.0);
        apart += u32::from(found.depth < 0.0);
    }
    assert!(deep > 400 && apart > 200, "{deep} overlap, {apart} do not");
}

/// Returns the least value of a convex function on the interval from 0 to 1, by ternary search.
fn least(distance: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..120 {
        let third = (high - low) / 3.0;
        if distance(low + third) < distance(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    distance(0.0).min(distance(1.0)).min(distance(0.5 * (low + high)))
}

#[test]
fn segments_are_as_far_as_their_nearest_point() {
    let (mut random, mut apart) = (Random(5, false), 0);
    for case in 0..3000_usize {
        let ratio = [1.0, 30.0, 1000.0][case % 3];
        let mut place = |size: f64| Point::from(random.vector::<f64, 3>() * size);
        let [a, b] = [place(1.0), place(1.0)];
        let [c, d] = [place(ratio), place(ratio)];
        let radii = [random.within(0.0, ratio), random.within(0.0, ratio)];
        let away = random.direction::<f64, 3>() * (1.5 * ratio);
        let (a, b, identity) = (a + away, b + away, Isometry3::identity());
        let segment = Segment::<f64, 3>::new(a, b);
        let club = TaperedCapsule::<f64, 3>::try_from_ends(c, d, radii).expect("finite");
        let pebble = Ellipsoid::<f64, 3>::new(c.coords.abs());
        for solid in [&club as &dyn Shape<f64, 3>, &pebble] {
            let found = contact(&identity, &segment, &identity, solid, f64::INFINITY);
            let found = found.expect("they are finite");
            if found.depth > -1e-6 {
                continue;
            }
            let best =
                least(|share| solid.distance_to_point(&identity, &(a + (b - a) * share), false));
            let off = (best + found.depth).abs() / ratio;
            assert!(off <= 1e-10, "{best}, not {}: case {case} {solid:?}", -found.depth);
            apart += 1;
        }
    }
    assert!(apart > 2000, "{apart} of 6000 are apart");
}

/// Returns the distance from an ellipse of a point with coordinates of at least zero: the least
/// over many angles of the first quadrant, refined by ternary search.
fn nearest_by_angle(half_axes: &Vector2<f64>, point: &Vector2<f64>) -> f64 {
    const PARTS: i32 = 720;
    let step = core::f64::consts::FRAC_PI_2 / f64::from(PARTS);
    let distance = |angle: f64| {
        Vector2::new(half_axes.x * angle.cos() - point.x, half_axes.y * angle.sin() - point.y)
            .norm()
    };
    let angles = (0..=PARTS).map(|part| f64::from(part) * step);
    let best =
        angles.fold(0.0, |best, angle| if distance(angle) < distance(best) { angle } else { best });
    let (mut low, mut high) = (best - step, best + step);
    for _ in 0..200 {
        let third = (high - low) / 3.0;
        if distance(low + third) < distance(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    distance(0.5 * (low + high)).min(distance(best))
}

fn points_of_ellipses<N: Real>() {
    let (mut random, mut inside) = (Random(9, false), 0);
    for case in 0..600_usize {
        let ratio: f64 = [1.0, 0.3, 1e-2, 1e-4][case % 4];
        let half_axes = Vector2::new(1.0, ratio).map(|x| N::lit(x).as_f64());
        let near = [2.0, 1.0, ratio, ratio * 0.1][case / 4 % 4];
        let place = Vector2::new(random.within(0.0, 1.5), random.within(0.0, 1.0) * near);
        // Some positions lie on an axis or at the centre of the ellipse.
        let place = match case % 7 {
            0 => Vector2::new(0.0, place.y),
            1 => Vector2::new(place.x, 0.0),
            2 => Vector2::zeros(),
            _ => place,
        };
        let point = Point::<N, 2>::from(place.map(N::lit));
        let solid = Ellipsoid::<N, 2>::new(half_axes.map(N::lit));
        let expected = nearest_by_angle(&half_axes, &point.coords.map(N::as_f64));
        let found = solid.distance_to_point(&Isometry2::identity(), &point, false).as_f64();
        let off = (found.abs() - expected).abs();
        assert!(off <= 16.0 * N::EPSILON.as_f64(), "{found}, not {expected}: case {case}");
        let level = Vector::<f64, 2>::new(place.x, place.y / ratio).norm();
        assert!(found <= 0.0 || level >= 1.0 - 1e-5, "outside: case {case}");
        inside += u32::from(found < 0.0);
    }
    assert!((100..500).contains(&inside), "{inside} of 600 are inside");
}

#[test]
fn points_of_ellipses_from_disks_to_needles() {
    points_of_ellipses::<f32>();
    points_of_ellipses::<f64>();
}
