//! Queries about one shape: rays and points.

use impinge::math::{Point, Pose, Real, Space};
use impinge::query::{PointQuery, Ray, RayCast};

use crate::place::Dimension;
use crate::shapes::{anatomy, parts_of, reach, shape};
use crate::{Bytes, Task, dispatch};

struct Rays;
struct Points;

/// Fuzzes [`RayCast`].
pub fn ray(data: &[u8]) {
    dispatch(Rays, data);
}

/// Fuzzes [`PointQuery`].
pub fn point(data: &[u8]) {
    dispatch(Points, data);
}

impl Task for Rays {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let (shape, m) = (shape::<N, M, D>(bytes), M::position(bytes));
        let ray = Ray::new(Point::from(bytes.vector::<N, D>()), bytes.vector());
        let (solid, max_time) = (bytes.coin(), bytes.number::<N>());
        let context = || format!("{ray:?} until {max_time}, {solid}, {m:?}\n{}", anatomy(&*shape));
        let first = shape.toi_and_normal_with_ray(&m, &ray, solid);
        assert_eq!(first.map(|hit| hit.toi), shape.toi_with_ray(&m, &ray, solid), "{}", context());
        let solid_hit = shape.toi_with_ray(&m, &ray, true);
        assert_eq!(solid_hit.is_some(), shape.intersects_ray(&m, &ray), "{}", context());
        let until = shape.first_hit_with_ray(&m, &ray, max_time, solid);
        if bytes.is_moderate() {
            assert_eq!(until, first.filter(|hit| hit.toi <= max_time), "{}", context());
        }
        let all = shape.all_hits_with_ray(&m, &ray, max_time, solid);
        if bytes.is_moderate() {
            assert_eq!(all.first().copied(), until, "{}", context());
        }
        assert!(
            all.is_sorted_by(|a, b| (a.toi, a.part) < (b.toi, b.part)),
            "{all:?} {}",
            context()
        );
        for hit in all {
            assert!(hit.toi >= N::ZERO && hit.toi.is_finite_number(), "{hit:?} {}", context());
            assert!(hit.part < parts_of(&*shape).unwrap_or(1), "{hit:?} {}", context());
            let length = hit.normal.norm();
            let is_unit = (length - N::ONE).abs() <= N::EPSILON * N::lit(64.0);
            let is_turned = Pose::from_isometry(&m).is_finite();
            assert!(
                (is_unit && is_turned) || !bytes.is_moderate() || length == N::ZERO,
                "{hit:?} {}",
                context()
            );
        }
        let numbers = ray.origin.iter().chain(ray.dir.iter());
        if !numbers.chain(m.translation.vector.iter()).all(|x| x.is_finite_number()) {
            assert_eq!(first, None, "{}", context());
        }
    }
}

impl Task for Points {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let (shape, m) = (shape::<N, M, D>(bytes), M::position(bytes));
        let point = Point::from(bytes.vector::<N, D>());
        let context = || format!("{point:?} {m:?} {}", anatomy(&*shape));
        let (own, near) =
            (shape.project_point(&m, &point, true), shape.project_point(&m, &point, false));
        let contains = shape.contains_point(&m, &point);
        let distance = shape.distance_to_point(&m, &point, true);
        let signed = shape.distance_to_point(&m, &point, false);
        let (with_feature, _) = shape.project_point_with_feature(&m, &point);
        let (located, location) = shape.project_point_with_location(&m, &point, true);
        let is_placed = Pose::from_isometry(&m).is_finite();
        if !is_placed || !point.iter().all(|x| x.is_finite_number()) {
            assert!(!contains && !own.is_inside, "{}", context());
            return;
        }
        if !bytes.is_moderate() {
            return;
        }
        assert_eq!((own.is_inside, near.is_inside), (contains, contains), "{}", context());
        assert!((distance == N::ZERO) == contains, "{distance} {contains} {}", context());
        assert!(signed <= N::ZERO || !contains, "{signed} {}", context());
        assert!(same_or_nan(&with_feature.point, &near.point), "{}", context());
        assert!(same_or_nan(&located.point, &own.point), "{}", context());
        assert!(
            location.part < parts_of(&*shape).unwrap_or(1).max(1),
            "{location:?} {}",
            context()
        );
        if contains {
            assert_eq!(own.point, point, "{}", context());
        }
        let is_nothing = distance == N::INFINITY;
        if !is_nothing {
            let places = m.translation.vector.iter().chain(point.iter());
            let scale = places.fold(reach(&*shape), |sum, x| sum + x.abs());
            let error = ((near.point - point).norm() - signed.abs()).abs();
            assert!(error <= N::EPSILON * N::lit(64.0) * scale, "{near:?} {signed} {}", context());
        }
    }
}

fn same_or_nan<N: Real, const D: usize>(one: &Point<N, D>, other: &Point<N, D>) -> bool {
    crate::pair::same(one, other)
}
