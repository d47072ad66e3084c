//! Tests every built-in shape, and custom composites and convex solids, with every other in every
//! query. No pair may lack a result, whatever the order, dimension, scalar, size and position.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::support::shape_table::{Shapes, plane, space};
use impinge::math::{AbstractRotation, Isometry, Point, Real, Space, Vector};
use impinge::query::{
    ClosestPoints, ConstantVelocities, ImpactOptions, Moving, PointQuery, Proximity, Ray, RayCast,
    RigidMotion, closest_points, contact, distance, impact, nonlinear_time_of_impact, proximity,
    time_of_impact, witness,
};
use impinge::shape::{Shape, ShapeKind};

/// Relative position of two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Regime {
    Far,
    /// The boxes touch.
    Touching,
    Deep,
    Coincident,
}

#[derive(Clone, Copy, Debug)]
struct Setting {
    regime: Regime,
    scale: f64,
    /// Distance from the world's origin, in units of `scale`.
    away: f64,
    turned: bool,
}

/// A function that returns the motion which starts at a pose and rotates with an angular speed.
type Spin<N, R, const D: usize> = fn(&Isometry<N, R, D>, N) -> Box<dyn RigidMotion<N, D>>;

/// The shapes, the rotation and the motion of one dimension.
struct Stage<N: Real, R, const D: usize> {
    shapes: fn(N) -> Shapes<N, D>,
    turn: R,
    spin: Spin<N, R, D>,
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize> Stage<N, R, D> {
    /// Tests all pairs of shapes and each shape alone; returns how many of these tests fail.
    fn all_pairs(&self, setting: &Setting) -> usize {
        let shapes = (self.shapes)(N::lit(setting.scale));
        let mut wrong = Vec::new();
        for (name1, shape1) in &shapes {
            self.guarded(&mut wrong, &format!("{name1} alone"), || self.alone(setting, &**shape1));
            for (name2, shape2) in &shapes {
                let same = name1 == name2 && setting.regime == Regime::Coincident;
                self.guarded(&mut wrong, &format!("{name1} {name2}"), || {
                    self.together(setting, [&**shape1, &**shape2], same);
                });
            }
        }
        if wrong.is_empty() {
            return 0;
        }
        eprintln!("{setting:?}: {wrong:#?}");
        wrong.len()
    }

    /// Asserts that all queries of two shapes have results that agree with each other, in both
    /// orders.
    fn together(&self, setting: &Setting, [g1, g2]: [&dyn Shape<N, D>; 2], same: bool) {
        let (m1, m2) = self.places(setting, g1, g2);
        check(&Two { m1: &m1, g1, m2: &m2, g2, same }, setting);
        if setting.scale == 1.0 && setting.away == 0.0 && !setting.turned {
            self.turning((&m1, g1), (&m2, g2), same);
        }
    }

    fn guarded(&self, wrong: &mut Vec<String>, name: &str, run: impl FnOnce()) {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(run)) {
            let text = panic.downcast_ref::<String>().cloned();
            wrong.push(format!("{name}: {}", text.unwrap_or_else(|| "?".to_owned())));
        }
    }

    fn places(
        &self,
        setting: &Setting,
        shape1: &dyn Shape<N, D>,
        shape2: &dyn Shape<N, D>,
    ) -> (Isometry<N, R, D>, Isometry<N, R, D>) {
        let scale = N::lit(setting.scale);
        let origin = Vector::<N, D>::repeat(N::lit(setting.away) * scale);
        let finite = |x: N| if x.is_finite_number() { x } else { scale };
        let (box1, box2) = (shape1.local_aabb(), shape2.local_aabb());
        let mut by = Vector::<N, D>::zeros();
        match setting.regime {
            Regime::Far => by = Vector::<N, D>::repeat(scale * N::lit(100.0)),
            Regime::Touching => by[0] = finite(box1.maxs()[0] - box2.mins()[0]),
            Regime::Deep => by[0] = scale * N::lit(0.125),
            Regime::Coincident => (),
        }
        let turn = if setting.turned { self.turn.clone() } else { R::identity() };
        let second =
            if setting.regime == Regime::Coincident { turn.clone() } else { R::identity() };
        let m1 = Isometry::from_parts(origin.into(), turn);
        (m1, Isometry::from_parts((origin + by).into(), second))
    }

    /// Asserts that the point and ray queries of one shape agree with each other.
    fn alone(&self, setting: &Setting, shape: &dyn Shape<N, D>) {
        let (m, _) = self.places(setting, shape, shape);
        let scale = N::lit(setting.scale);
        let noise = scale * N::lit(1.0 + setting.away) * N::EPSILON * N::lit(256.0);
        for step in 0..9 {
            let offset = Vector::<N, D>::from_fn(|axis, _| {
                scale * N::lit([0.0, 0.25, -1.5][(step / [1, 3, 2][axis]) % 3])
            });
            let point = Point::from(m.translation.vector + offset);
            let (projected, location) = shape.project_point_with_location(&m, &point, true);
            let apart = shape.distance_to_point(&m, &point, true);
            assert_eq!(projected.is_inside, apart == N::ZERO, "{point} {projected:?} {apart:?}");
            assert_eq!(shape.contains_point(&m, &point), projected.is_inside, "{point}");
            assert!(((projected.point - point).norm() - apart).abs() <= noise, "{point} {apart:?}");
            let (_, feature) = shape.project_point_with_feature(&m, &point);
            assert_eq!(location.feature, feature, "{point}");
            let signed = shape.distance_to_point(&m, &point, false);
            assert_eq!(signed > N::ZERO, apart > N::ZERO, "{signed:?}");
            let dir = Vector::<N, D>::repeat(scale) - offset;
            let ray = Ray::new(point, dir);
            let hit = shape.toi_and_normal_with_ray(&m, &ray, true);
            assert_eq!(hit.is_some(), shape.intersects_ray(&m, &ray), "{ray:?}");
            assert_eq!(hit.map(|hit| hit.toi), shape.toi_with_ray(&m, &ray, true), "{ray:?}");
            let hits = shape.all_hits_with_ray(&m, &ray, N::INFINITY, true);
            assert_eq!(hits.first().copied(), hit, "{ray:?}");
            let toi = hit.map_or(N::INFINITY, |hit| hit.toi);
            let hollow = shape.toi_with_ray(&m, &ray, false).unwrap_or(N::INFINITY);
            assert!(toi >= N::ZERO && hollow >= toi, "{toi:?} {hollow:?}");
        }
    }

    /// Asserts that exchanging two rotating bodies flips their impact.
    fn turning(
        &self,
        (m1, g1): (&Isometry<N, R, D>, &dyn Shape<N, D>),
        (m2, g2): (&Isometry<N, R, D>, &dyn Shape<N, D>),
        same: bool,
    ) {
        let (motion1, motion2) = ((self.spin)(m1, N::HALF), (self.spin)(m2, -N::ONE));
        let options = ImpactOptions::new().with_max_time(N::HALF * N::HALF);
        let found = nonlinear_time_of_impact(&*motion1, g1, &*motion2, g2, &options);
        let swapped = nonlinear_time_of_impact(&*motion2, g2, &*motion1, g1, &options);
        if !same {
            assert_eq!(found, swapped.map(|found| found.flipped()), "turning");
        }
        assert!(found.is_none_or(|found| found.toi >= N::ZERO), "{found:?}");
    }
}

/// Two placed shapes.
struct Two<'a, N: Real, R, const D: usize> {
    m1: &'a Isometry<N, R, D>,
    g1: &'a dyn Shape<N, D>,
    m2: &'a Isometry<N, R, D>,
    g2: &'a dyn Shape<N, D>,
    /// Whether both shapes and both poses are equal, so that their order is undefined.
    same: bool,
}

fn check<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    two: &Two<'_, N, R, D>,
    setting: &Setting,
) {
    let Two { m1, g1, m2, g2, same } = *two;
    let apart = distance(m1, g1, m2, g2);
    assert!(apart >= N::ZERO && apart.is_finite_number(), "the distance is {apart:?}");
    assert_eq!(apart, distance(m2, g2, m1, g1), "swapped");
    let near = proximity(m1, g1, m2, g2, apart);
    assert_eq!(near, proximity(m2, g2, m1, g1, apart), "swapped");
    let expected = if apart > N::ZERO { Proximity::WithinMargin } else { Proximity::Intersecting };
    assert_eq!(near, expected, "{apart:?}");
    let points = closest_points(m1, g1, m2, g2, N::INFINITY);
    if !same {
        assert_eq!(points.flipped(), closest_points(m2, g2, m1, g1, N::INFINITY), "swapped");
    }
    assert_eq!(points == ClosestPoints::Intersecting, apart == N::ZERO, "{points:?} {apart:?}");

    let found = witness(m1, g1, m2, g2, N::INFINITY);
    let touch = contact(m1, g1, m2, g2, N::INFINITY);
    let planes = [g1, g2].iter().all(|shape| shape.geometry().kind() == ShapeKind::Plane);
    assert!(planes || (found.is_some() && touch.is_some()), "{found:?} {touch:?}");
    if let (Some(found), Some(touch)) = (found, touch) {
        assert!((found.normal.norm() - N::ONE).abs() < N::lit(1e-4), "{found:?}");
        assert!((touch.normal.norm() - N::ONE).abs() < N::lit(1e-4), "{touch:?}");
        assert_eq!(found.distance > N::ZERO, apart > N::ZERO, "{found:?} {apart:?}");
        assert!(apart == N::ZERO || found.distance == apart, "{found:?} {apart:?}");
        if !same {
            let swapped = witness(m2, g2, m1, g1, N::INFINITY).map(|other| other.flipped());
            assert_eq!(swapped, Some(found), "swapped");
            let swapped = contact(m2, g2, m1, g1, N::INFINITY).map(|other| other.flipped());
            assert_eq!(swapped, Some(touch), "swapped");
        }
    }
    moving(two, N::lit(setting.scale));
}

fn moving<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    two: &Two<'_, N, R, D>,
    scale: N,
) {
    let Two { m1, g1, m2, g2, same } = *two;
    let v1 = Vector::<N, D>::repeat(scale);
    let v2 = Vector::<N, D>::from_fn(|axis, _| scale * N::lit([-0.5, 0.25, 0.0][axis]));
    let options = ImpactOptions::new().with_target_distance(scale * N::lit(0.125));
    let (one, other) = (Moving::new(m1, &v1, g1), Moving::new(m2, &v2, g2));
    let (found, swapped) = (impact(&one, &other, &options), impact(&other, &one, &options));
    if !same {
        assert_eq!(found, swapped.map(|found| found.flipped()), "swapped");
    }
    let toi = time_of_impact(m1, &v1, g1, m2, &v2, g2);
    assert_eq!(toi, time_of_impact(m2, &v2, g2, m1, &v1, g1), "swapped");
    assert!(toi.is_none_or(|toi| toi >= N::ZERO), "{toi:?}");
}

fn settings(scales: &[f64]) -> Vec<Setting> {
    let regimes = [Regime::Far, Regime::Touching, Regime::Deep, Regime::Coincident];
    let mut all = Vec::new();
    for regime in regimes {
        let (away, turned) = (0.0, false);
        all.extend(scales.iter().map(|&scale| Setting { regime, scale, away, turned }));
        all.push(Setting { regime, scale: 1.0, away, turned: true });
        all.push(Setting { regime, scale: 1.0, away: 1e6, turned: true });
    }
    all
}

fn in_plane<N: Real>(scales: &[f64]) {
    let turn = impinge::math::na::UnitComplex::new(N::lit(0.7));
    let stage = Stage::<N, _, 2> {
        shapes: plane::<N>,
        turn,
        spin: |m, turn| {
            let linear = Vector::<N, 2>::new(turn, N::ONE);
            Box::new(ConstantVelocities::<N, 2>::new(*m, linear, turn))
        },
    };
    let wrong: usize = settings(scales).iter().map(|setting| stage.all_pairs(setting)).sum();
    assert_eq!(wrong, 0, "pairs are wrong, see above");
}

fn in_space<N: Real>(scales: &[f64]) {
    let angles = [0.7, -0.4, 1.9].map(N::lit);
    let stage = Stage::<N, _, 3> {
        shapes: space::<N>,
        turn: impinge::math::na::UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]),
        spin: |m, turn| {
            let linear = Vector::<N, 3>::new(turn, N::ONE, N::ZERO);
            let angular = Vector::<N, 3>::new(turn, N::ZERO, turn);
            Box::new(ConstantVelocities::<N, 3>::new(*m, linear, angular))
        },
    };
    let wrong: usize = settings(scales).iter().map(|setting| stage.all_pairs(setting)).sum();
    assert_eq!(wrong, 0, "pairs are wrong, see above");
}

#[test]
fn in_the_plane_f32() {
    in_plane::<f32>(&[1.0, 1e-10, 1e10]);
}

#[test]
fn in_the_plane_f64() {
    in_plane::<f64>(&[1.0, 1e-60, 1e60]);
}

#[test]
fn in_space_f32() {
    in_space::<f32>(&[1.0, 1e-10, 1e10]);
}

#[test]
fn in_space_f64() {
    in_space::<f64>(&[1.0, 1e-60, 1e60]);
}
