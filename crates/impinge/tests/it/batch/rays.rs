//! Compares ray casts of batches with single calls.

use impinge::batch::{Control, HitColumns, NO_FEATURE, OnePose, RayColumns, Shapes, Side};
use impinge::math::{AbstractRotation, Point, Space, Vector};
use impinge::query::{Ray, RayCast};

use super::scene::{Scene, assert_number, assert_point, on_threads, scene2, scene3};
use crate::support::query_support::random::Random;

fn check<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(scene: &Scene<N, R, D>) {
    let (random, count) = (&mut Random(5, false), scene.len());
    let (mut origins, mut directions) = (Vec::new(), Vec::new());
    for pose in &scene.poses[0] {
        let offset = random.vector::<N, D>() * N::lit(4.0);
        let aside = random.vector::<N, D>() * N::HALF;
        origins.push((pose.translation.vector + offset).into());
        directions.push((aside - offset * N::HALF).into());
    }
    origins[64] = [N::INFINITY; D];
    directions[65] = [N::lit(f64::NAN); D];
    directions[66] = [N::ZERO; D];
    let (mut time, mut normal) = (vec![N::ZERO; count], vec![[N::ZERO; D]; count]);
    let (mut part, mut feature) = (vec![0; count], vec![NO_FEATURE; count]);
    let side = scene.side(0, &scene.poses[0]);
    for (threads, until, solid) in [(1, f64::INFINITY, true), (4, 1.5, false), (4, -1.0, true)] {
        let rays = RayColumns::try_new(side, &origins, &directions).expect("as many");
        let rays = rays.until(N::lit(until));
        let rays = if solid { rays } else { rays.hollow() };
        let (time, normal) = (&mut time[..], &mut normal[..]);
        let (part, feature) = (&mut part[..], &mut feature[..]);
        on_threads(threads, || {
            let out = HitColumns {
                time: &mut *time,
                normal: &mut *normal,
                part: &mut *part,
                feature: &mut *feature,
            };
            rays.cast(&Control::new(), out).expect("good");
        });
        for index in 0..count {
            let (shape, m) = (&**scene.shape(0, index), &scene.poses[0][index]);
            let origin = Point::from(origins[index]);
            let ray = Ray::new(origin, Vector::<N, D>::from(directions[index]));
            let hit = shape.first_hit_with_ray(m, &ray, N::lit(until), solid);
            let what = format!("ray {index} until {until}");
            assert_number(time[index], hit.map_or(N::INFINITY, |hit| hit.toi), &what);
            assert_point(&normal[index], hit.map(|hit| Point::from(hit.normal)), &what);
            let facts = hit.map_or((u32::MAX, NO_FEATURE), |hit| (hit.part, hit.feature));
            assert_eq!((part[index], feature[index]), facts, "{what}");
        }
        let hits = time.iter().filter(|time| time.is_finite_number()).count();
        assert!(until < 0.0 || hits * 4 > count && hits < count, "{hits} of {count} hit");
    }
}

#[test]
fn hits_are_those_of_single_calls() {
    check(&scene2::<f32>(0.0));
    check(&scene2::<f64>(1e6));
    check(&scene3::<f32>(0.0));
    check(&scene3::<f64>(0.0));
}

/// Compares a batch of 200 rays from one origin with single casts, for each shape in turn.
#[test]
fn a_fan_from_one_origin() {
    let scene = scene3::<f64>(0.0);
    let pose = scene.poses[1][3];
    let (random, here) = (&mut Random(6, false), OnePose(pose));
    let directions: Vec<[f64; 3]> = (0..200).map(|_| random.vector::<f64, 3>().into()).collect();
    let origins = [[0.25, 3.0, 0.5]];
    for shape in &scene.shapes {
        let side = Side::try_new(Shapes::One(&**shape), &here).expect("one");
        let rays = RayColumns::try_new(side, &origins, &directions).expect("one origin");
        assert_eq!((rays.len(), rays.is_empty()), (200, false), "a ray for each direction");
        let mut time = vec![0.0; 200];
        let out = HitColumns { time: &mut time, ..Default::default() };
        rays.cast(&Control::new(), out).expect("good");
        for (direction, &time) in directions.iter().zip(&time) {
            let ray = Ray::new(Point::from(origins[0]), Vector::<f64, 3>::from(*direction));
            let hit = shape.first_hit_with_ray(&pose, &ray, f64::INFINITY, true);
            assert_number(time, hit.map_or(f64::INFINITY, |hit| hit.toi), "of the fan");
        }
    }
}
