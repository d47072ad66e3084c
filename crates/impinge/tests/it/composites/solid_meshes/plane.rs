//! Tests that closed lines made solid have the distances of polygons, and that point queries, rays
//! and casts treat their inside as part of the solid.

use crate::support::query_support;
use crate::support::samples::samples;

use impinge::math::{Isometry2, Point, Real, Space, Vector};
use impinge::query::{PointQuery, Ray, RayCast, contact, distance, proximity, time_of_impact};
use impinge::shape::{Ball, Compound, ConvexPolygon, Cuboid, Polyline, ShapeHandle, TriMesh};
use query_support::random::Random;
use query_support::samples::{PLANE, sample2};

fn outline<N: Real>(corners: &[[f64; 2]]) -> Vec<Point<N, 2>> {
    corners.iter().map(|corner| Point::from(corner.map(N::lit))).collect()
}

fn ring(corners: u32) -> Vec<[f64; 2]> {
    let angle = |at: u32| f64::from(at) * std::f64::consts::TAU / f64::from(corners);
    (0..corners).map(|at| [2.0 * angle(at).cos(), 2.0 * angle(at).sin()]).collect()
}

fn against_polygons<N: Space<2>>() {
    let random = &mut Random(3, false);
    let (mut inside, mut apart) = (0, 0);
    for corners in [ring(4), ring(7), ring(30)] {
        let corners = outline::<N>(&corners);
        let (hull, line) =
            (ConvexPolygon::from_points(&corners), Polyline::closed(corners).solid());
        for at in 0..samples(120) {
            let other = sample2::<N>(
                PLANE[at % PLANE.len()],
                random,
                N::lit(if at % 2 == 0 { 0.2 } else { 0.7 }),
            );
            let m1 = Isometry2::from_parts(random.vector::<N, 2>().into(), random.turn2());
            let way = random.vector::<N, 2>() * N::lit(if at % 3 == 0 { 1.0 } else { 5.0 });
            let m2 = Isometry2::from_parts((m1.translation.vector + way).into(), random.turn2());
            let (exact, found) =
                (distance(&m1, &hull, &m2, &*other), distance(&m1, &line, &m2, &*other));
            let noise = N::EPSILON * N::lit(1024.0);
            assert!((exact - found).abs() <= noise, "{exact:?} {found:?} {m1:?} {m2:?}");
            assert_eq!(found, distance(&m2, &*other, &m1, &line), "in both roles");
            assert_eq!(
                proximity(&m1, &line, &m2, &*other, N::ONE),
                proximity(&m2, &*other, &m1, &line, N::ONE),
                "in both roles"
            );
            let touch = contact(&m1, &line, &m2, &*other, N::ZERO);
            assert_eq!(touch.is_some(), found == N::ZERO, "{found:?}");
            if let Some(touch) = touch {
                let depth =
                    contact(&m1, &hull, &m2, &*other, N::ZERO).map_or(N::ZERO, |exact| exact.depth);
                let skin = Polyline::closed(line.vertices().to_vec());
                let is_inside = distance(&m1, &skin, &m2, &*other) > N::ZERO;
                assert!(!is_inside || touch.depth >= depth - noise, "{touch:?} {depth:?}");
                let mut moved = m2;
                moved.translation.vector += touch.normal.into_inner() * (touch.depth + noise);
                let rest = distance(&m1, &line, &moved, &*other);
                assert!(
                    !is_inside || (rest > N::ZERO && rest <= touch.depth),
                    "{touch:?} {rest:?}"
                );
            }
            (inside, apart) =
                if found == N::ZERO { (inside + 1, apart) } else { (inside, apart + 1) };
        }
    }
    assert!(inside > 60 && apart > 60, "{inside} {apart}");
}

#[test]
fn a_line_is_as_far_as_its_polygon() {
    against_polygons::<f32>();
    against_polygons::<f64>();
}

#[test]
fn holes_pieces_and_parts() {
    // A square with a square hole, and another square beside it.
    let outer = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
    let hole = [[2.0, 2.0], [2.0, 6.0], [6.0, 6.0], [6.0, 2.0]];
    let beside = [[20.0, 0.0], [24.0, 0.0], [24.0, 4.0], [20.0, 4.0]];
    let corners = outline::<f64>(&[outer, hole, beside].concat());
    let loops = (0..12).map(|at| [at, if at % 4 == 3 { at - 3 } else { at + 1 }]).collect();
    let body = Polyline::new(corners, loops).solid();
    let (here, small) = (Isometry2::identity(), Ball::new(0.25));
    let place = |x, y| Isometry2::translation(x, y);
    let depth = |x, y| {
        contact(&here, &body, &place(x, y), &small, 0.0).map(|found| (found.depth, *found.normal))
    };
    assert_eq!(distance(&here, &body, &place(4.0, 4.0), &small), 1.75, "in the hole");
    assert_eq!(depth(1.5, 4.0), Some((0.75, Vector::x())), "into the hole");
    assert_eq!(depth(0.5, 4.0), Some((0.75, -Vector::x())), "outwards");
    assert_eq!(depth(23.0, 2.0), Some((1.25, Vector::x())));
    assert_eq!(depth(0.125, 4.0), Some((0.375, -Vector::x())), "across the wall");
    let far = ShapeHandle::new(Ball::new(0.25));
    let pair = Compound::new(vec![(place(0.0, 0.0), far.clone()), (place(50.0, 0.0), far)]);
    assert_eq!(distance(&here, &body, &place(22.0, 2.0), &pair), 0.0);
    let mesh = TriMesh::new(outline(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), vec![[0, 1, 2]]);
    assert_eq!(distance(&here, &body, &place(21.0, 1.0), &mesh), 0.0);
    let group = Compound::new(vec![(place(1.0, 0.0), ShapeHandle::new(body.clone()))]);
    assert_eq!(distance(&here, &group, &place(23.0, 2.0), &small), 0.0);
    assert_eq!(distance(&here, &group, &place(5.0, 4.0), &small), 1.75);
}

#[test]
fn points_rays_and_casts() {
    let body =
        Polyline::closed(outline::<f64>(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])).solid();
    let here = Isometry2::identity();
    let inside = Point::<f64, 2>::new(3.0, 2.0);
    assert!(
        body.contains_point(&here, &inside)
            && !body.contains_point(&here, &Point::<f64, 2>::new(5.0, 2.0))
    );
    assert_eq!(body.distance_to_point(&here, &inside, true), 0.0);
    assert_eq!(body.distance_to_point(&here, &inside, false), -1.0);
    let ray = Ray::new(inside, Vector::x());
    assert_eq!(body.toi_with_ray(&here, &ray, true), Some(0.0));
    assert_eq!(body.toi_with_ray(&here, &ray, false), Some(1.0));
    let small = Cuboid::new(Vector::<f64, 2>::new(0.25, 0.25));
    let cast = |x: f64, speed: f64| {
        let (still, moving) = (Vector::zeros(), Vector::<f64, 2>::new(speed, 0.0));
        time_of_impact(&here, &still, &body, &Isometry2::translation(x, 2.0), &moving, &small)
    };
    assert_eq!(cast(3.0, -1.0), Some(0.0), "inwards");
    assert_eq!(cast(3.0, 1.0), None, "out");
    assert_eq!(cast(6.0, -1.0), Some(1.75), "from outside");
}
