//! Compares the contacts between solid meshes and solids that do not touch the surface of the mesh
//! with a scan of all triangles: whether there is a contact, and its depth. Also tests impacts of
//! solids that start inside, points, rays, and a manifold.

use super::{P3, V3, at, ball, cuboid, inverted, joined, skin, solid};
use crate::support::query_support;
use crate::support::samples::samples;

use impinge::math::{Isometry3, Point, Space, Vector};
use impinge::query::{
    ConstantVelocities, ImpactOptions, ImpactStatus, Moving, PointQuery, Ray, RayCast, contact,
    distance, impact, nonlinear_time_of_impact, time_of_impact,
};
use impinge::shape::{Ball, Compound, Cuboid, Shape, ShapeHandle, TriMesh};
use query_support::random::Random;
use query_support::samples::{SPACE, sample3};

/// Returns the distance between the solid and the nearest triangle, and the distance by which the
/// solid must move along the normal there to lie entirely beyond the nearest point of that
/// triangle.
fn brute<N: Space<3>>(mesh: &TriMesh<N, 3>, m2: &Isometry3<N>, solid: &dyn Shape<N, 3>) -> (N, N) {
    let here = Isometry3::identity();
    let mut nearest = N::INFINITY;
    let mut depth = N::ZERO;
    for part in 0..u32::try_from(mesh.num_triangles()).expect("few") {
        let triangle = mesh.triangle(part);
        let found = contact(m2, solid, &here, &triangle, N::INFINITY).expect("finite");
        if -found.depth < nearest {
            nearest = -found.depth;
            let way = found.normal.into_inner();
            let map = solid.geometry().as_support_map().expect("convex");
            let far = m2 * map.support_point(&m2.rotation.inverse_transform_vector(&-way));
            depth = (found.world2 - far).dot(&way);
        }
    }
    (nearest, depth)
}

fn against_brute_force<N: Space<3>>() {
    let random = &mut Random(23, false);
    let hollow =
        joined(&[ball::<N>(3.0, 12), inverted(cuboid([0.5, 0.75, 1.0], [0.25, 0.0, 0.0]))]);
    let star = {
        let (corners, triangles) = ball::<N>(2.0, 8);
        let bumpy = corners
            .iter()
            .enumerate()
            .map(|(at, corner)| corner * N::lit(if at % 3 == 0 { 1.25 } else { 0.8 }));
        (bumpy.collect(), triangles)
    };
    let mut inside = 0;
    for mesh in [solid(hollow), solid(star)] {
        for at in 0..samples(260) {
            let solid = sample3::<N>(SPACE[at % (SPACE.len() - 1)], random, N::lit(0.25));
            let way = random.vector::<N, 3>() * N::lit(2.5);
            let m2 = Isometry3::from_parts(way.into(), random.turn3());
            let (nearest, depth) = brute(&mesh, &m2, &*solid);
            let middle = Point::from(m2.translation.vector);
            let holds =
                mesh.encloses(&(m2 * solid.geometry().as_support_map().expect("convex").center()));
            let found = contact(&Isometry3::identity(), &mesh, &m2, &*solid, N::ZERO);
            let noise = N::EPSILON * N::lit(4096.0);
            if nearest <= noise {
                continue;
            }
            assert_eq!(found.is_some(), holds == Some(true), "{m2:?} {middle:?}");
            if let Some(found) = found {
                // Normals are not compared: triangles at equal distances may have different
                // normals.
                let gap = distance(
                    &Isometry3::identity(),
                    &skin((mesh.vertices().to_vec(), mesh.triangles().to_vec())),
                    &m2,
                    &*solid,
                );
                assert!((gap - nearest).abs() <= noise, "{gap:?} {nearest:?}");
                assert!(
                    (found.depth - depth).abs() <= noise * N::lit(16.0),
                    "{found:?} {depth:?} {nearest:?} {m2:?}"
                );
                inside += 1;
            }
        }
    }
    assert!(inside > 80, "{inside}");
}

#[test]
fn the_nearest_surface_is_the_way_out() {
    against_brute_force::<f32>();
    against_brute_force::<f64>();
}

#[test]
fn impacts_at_the_start() {
    let body = solid(cuboid::<f64>([4.0; 3], [0.0; 3]));
    let probe = Ball::new(0.25);
    let group = Compound::new(vec![
        (at([0.0; 3]), ShapeHandle::new(probe)),
        (at([0.0, 0.5, 0.0]), ShapeHandle::new(probe)),
    ]);
    let (room, block) = (skin(cuboid([0.25; 3], [0.0; 3])), solid(cuboid([0.25; 3], [0.0; 3])));
    let shapes: [(&str, &dyn Shape<f64, 3>); 4] =
        [("ball", &probe), ("two", &group), ("skin", &room), ("solid", &block)];
    for (name, shape) in shapes {
        let (here, there, still) = (at([0.0; 3]), at([3.0, 0.0, 0.0]), V3::zeros());
        let cast = |velocity: [f64; 3]| {
            let velocity = V3::from(velocity);
            let one = time_of_impact(&here, &still, &body, &there, &velocity, shape);
            let other = time_of_impact(&there, &velocity, shape, &here, &still, &body);
            let relative = time_of_impact(&here, &-velocity, &body, &there, &still, shape);
            assert_eq!((one, one), (other, relative), "{name}: {velocity}");
            one
        };
        assert_eq!(cast([-1.0, 0.0, 0.0]), Some(0.0), "{name}: deeper");
        assert_eq!(cast([0.0, 1.0, 0.0]), Some(0.0), "{name}: along the wall, deep");
        assert_eq!(cast([1.0, 0.0, 0.0]), None, "{name}: out, and through the wall");
        assert_eq!(cast([1.0, 8.0, 0.0]), None, "{name}: out");
        let turning =
            |velocity: [f64; 3]| nonlinear(&here, &body, &there, shape, V3::from(velocity));
        assert_eq!(turning([-1.0, 0.0, 0.0]), Some(0.0));
        assert_eq!(turning([1.0, 0.0, 0.0]), None);
        let moving = Moving::new(&there, &still, shape);
        let resting = Moving::new(&here, &still, &body);
        let options = ImpactOptions::new().with_contact_at_start(true);
        let found = impact(&resting, &moving, &options).expect("in contact");
        assert_eq!((found.toi, found.status), (0.0, ImpactStatus::PenetratingAtStart));
        assert_eq!(found.normal.into_inner(), V3::x());
    }
}

fn nonlinear(
    m1: &Isometry3<f64>,
    body: &TriMesh<f64, 3>,
    m2: &Isometry3<f64>,
    shape: &dyn Shape<f64, 3>,
    linear: Vector<f64, 3>,
) -> Option<f64> {
    let (one, two) = (ConstantVelocities::still(*m1), ConstantVelocities::straight(*m2, linear));
    let options = ImpactOptions::new().with_max_time(100.0);
    nonlinear_time_of_impact(&one, body, &two, shape, &options).map(|found| found.toi)
}

#[test]
fn a_way_out_of_a_cavity_ends_at_its_wall() {
    let hollow =
        solid(joined(&[cuboid::<f64>([4.0; 3], [0.0; 3]), inverted(cuboid([2.0; 3], [0.0; 3]))]));
    let (here, still, small) = (at([0.0; 3]), V3::zeros(), Ball::new(0.25));
    let cast = |x, speed| {
        time_of_impact(
            &here,
            &still,
            &hollow,
            &at([x, 0.0, 0.0]),
            &V3::new(speed, 0.0, 0.0),
            &small,
        )
    };
    assert_eq!(cast(0.0, 1.0), Some(1.75));
    assert_eq!(cast(2.5, -1.0), Some(4.25), "out of the wall into the cavity, to the wall beyond");
    assert_eq!(cast(2.5, 1.0), Some(0.0), "deeper into the wall");
    assert_eq!(cast(3.5, 1.0), None);
    assert_eq!(cast(-6.0, 1.0), Some(1.75));
}

#[test]
fn points_and_rays_see_a_body() {
    let hollow =
        solid(joined(&[cuboid::<f64>([4.0; 3], [0.0; 3]), inverted(cuboid([2.0; 3], [0.0; 3]))]));
    let twin = skin((hollow.vertices().to_vec(), hollow.triangles().to_vec()));
    let group = Compound::new(vec![(at([1.0, 0.0, 0.0]), ShapeHandle::new(hollow.clone()))]);
    let here = at([0.0; 3]);
    let random = &mut Random(9, false);
    let mut inside = 0;
    for _ in 0..samples(400) {
        let point = P3::from(random.vector::<f64, 3>() * 6.0);
        let signed = twin.signed_distance(&point).expect("closed");
        assert_eq!(
            (hollow.signed_distance(&point), hollow.encloses(&point)),
            (Some(signed), Some(signed <= 0.0))
        );
        assert_eq!(hollow.contains_point(&here, &point), signed <= 0.0);
        assert_eq!(hollow.distance_to_point(&here, &point, false), signed);
        assert_eq!(hollow.distance_to_point(&here, &point, true), signed.max(0.0));
        let projected = hollow.project_point(&here, &point, false);
        assert_eq!(
            (projected.is_inside, projected.point),
            (signed <= 0.0, twin.project_point(&here, &point, false).point)
        );
        let moved = point + V3::x();
        assert_eq!(group.contains_point(&here, &moved), signed <= 0.0);
        let ray = Ray::new(point, random.vector::<f64, 3>());
        let (first, of_skin) =
            (hollow.toi_with_ray(&here, &ray, true), twin.toi_with_ray(&here, &ray, true));
        assert_eq!(first, if signed <= 0.0 { Some(0.0) } else { of_skin });
        assert_eq!(hollow.toi_with_ray(&here, &ray, false), of_skin);
        let hits = hollow.all_hits_with_ray(&here, &ray, f64::INFINITY, true);
        let parts: std::collections::BTreeSet<_> = hits.iter().map(|hit| hit.part).collect();
        assert_eq!(parts.len(), hits.len(), "each part once");
        inside += usize::from(signed <= 0.0);
    }
    assert!(inside > 50, "{inside}");
}

#[test]
fn a_box_inside_has_its_face_as_manifold() {
    let body = solid(cuboid::<f64>([4.0; 3], [0.0; 3]));
    let inner = Cuboid::new(V3::new(0.5_f64, 0.25, 0.75));
    let found = contact(&at([0.0; 3]), &body, &at([0.0, 3.0, 0.0]), &inner, 0.0).expect("inside");
    assert_eq!((found.depth, found.normal.y), (1.25, 1.0));
    assert_eq!((found.world1.y, found.world2.y), (4.0, 2.75));
}

#[test]
fn a_solid_that_starts_inside_hits_when_it_gets_deeper() {
    let (block, ball) = (solid(cuboid::<f64>([10.0; 3], [0.0; 3])), Ball::new(1.0));
    let still = ConstantVelocities::<f64, 3>::still(Isometry3::identity());
    // The depth is 3 - a sin t: first the ball rises, after half a turn it is as deep as at first.
    for (arm, end) in [(0.05, 7.0), (0.05, f64::INFINITY), (0.5, 4.0)] {
        let circles = ConstantVelocities::<f64, 3>::new(at([8.0, 0.0, 0.0]), V3::zeros(), V3::z())
            .with_local_center(P3::new(0.0, arm, 0.0));
        let options = ImpactOptions::new().with_max_time(end);
        let hit = nonlinear_time_of_impact(&circles, &ball, &still, &block, &options);
        let toi = hit.expect("deeper than at the start").toi;
        assert!((toi - std::f64::consts::PI).abs() < 1e-6, "{toi} with the arm {arm}");
    }
}
