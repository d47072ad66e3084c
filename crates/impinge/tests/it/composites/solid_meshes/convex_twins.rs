//! Compares a solid mesh of a convex solid with the hull of its vertices, which has the same
//! distances.

use super::{Soup, ball, cuboid, solid};
use crate::support::query_support;
use crate::support::samples::samples;

use impinge::math::{Isometry3, Point, Real, Space, Vector};
use impinge::query::{
    ClosestPoints, Proximity, closest_points, contact, distance, proximity, time_of_impact, witness,
};
use impinge::shape::{Ball, ConvexHull, Cuboid, Shape, TriMesh};
use query_support::random::Random;
use query_support::samples::{SPACE, sample3};

struct Twins<N: Real> {
    hull: ConvexHull<N>,
    mesh: TriMesh<N, 3>,
}

fn twins<N: Space<3>>(soup: Soup<N>) -> Twins<N> {
    Twins { hull: ConvexHull::try_from_points(&soup.0).expect("a volume"), mesh: solid(soup) }
}

/// Asserts that a solid has the same distance from both twins, and that all queries of the mesh
/// agree, in both orders, on whether the solid touches the mesh. Returns `true` for a solid that
/// touches the mesh.
fn compare<N: Space<3>>(
    twins: &Twins<N>,
    m1: &Isometry3<N>,
    m2: &Isometry3<N>,
    other: &dyn Shape<N, 3>,
    noise: N,
) -> bool {
    let Twins { hull, mesh } = twins;
    let (of_hull, of_mesh) = (distance(m1, hull, m2, other), distance(m1, mesh, m2, other));
    let what = || format!("{of_hull:?} {of_mesh:?} {m1:?} {m2:?}");
    assert!((of_hull - of_mesh).abs() <= noise, "{}", what());
    assert_eq!(of_mesh, distance(m2, other, m1, mesh), "{}", what());
    let margin = N::lit(0.25);
    let near = proximity(m1, mesh, m2, other, margin);
    assert_eq!(near, proximity(m2, other, m1, mesh, margin), "{}", what());
    assert_eq!(near == Proximity::Intersecting, of_mesh == N::ZERO, "{}", what());
    let is_plain = (of_hull - margin).abs() > noise && !(of_hull > N::ZERO && of_hull <= noise);
    if is_plain {
        assert_eq!(near, proximity(m1, hull, m2, other, margin), "{}", what());
    }
    let points = closest_points(m1, mesh, m2, other, margin);
    assert_eq!(points == ClosestPoints::Intersecting, of_mesh == N::ZERO, "{}", what());
    let found = contact(m1, mesh, m2, other, N::ZERO);
    assert_eq!(found.is_some(), of_mesh == N::ZERO, "{}", what());
    let seen = witness(m1, mesh, m2, other, N::INFINITY).expect("finite");
    assert!(
        seen.distance <= of_mesh && (seen.distance - of_mesh).abs() <= noise || of_mesh == N::ZERO,
        "{}",
        what()
    );
    if let Some(found) = found {
        assert!(found.depth >= N::ZERO, "{found:?}");
        check_way_out(twins, m1, m2, other, &found, noise);
    }
    of_mesh == N::ZERO
}

/// Asserts that both orders give the same contact. A solid that does not cross the surface must be
/// separated from the mesh by a motion along the normal by the depth; if convex, its depth must be
/// at least that of the hull.
fn check_way_out<N: Space<3>>(
    Twins { mesh, hull }: &Twins<N>,
    m1: &Isometry3<N>,
    m2: &Isometry3<N>,
    other: &dyn Shape<N, 3>,
    found: &impinge::query::Contact<N, 3>,
    noise: N,
) {
    let back = contact(m2, other, m1, mesh, N::ZERO).expect("in contact").flipped();
    assert_eq!(back, *found, "in both roles");
    let off = found.world1 - found.normal.into_inner() * found.depth - found.world2;
    assert!(off.norm() <= noise, "{found:?}");
    // For a solid that is entirely inside, the depth is at least the exact depth of the hull.
    let exact = contact(m1, hull, m2, other, N::ZERO).map_or(N::ZERO, |exact| exact.depth);
    let is_convex = other.geometry().as_composite().is_none();
    assert!(
        !is_convex || found.depth >= exact - noise || crosses(mesh, m1, m2, other),
        "{found:?} {exact:?}"
    );
    if !crosses(mesh, m1, m2, other) {
        let mut moved = *m2;
        moved.translation.vector += found.normal.into_inner() * (found.depth + noise);
        assert!(distance(m1, mesh, &moved, other) > N::ZERO, "{found:?} {m1:?} {m2:?}");
    }
}

/// Returns `true` if the solid intersects the surface of the mesh.
fn crosses<N: Space<3>>(
    mesh: &TriMesh<N, 3>,
    m1: &Isometry3<N>,
    m2: &Isometry3<N>,
    other: &dyn Shape<N, 3>,
) -> bool {
    let skin = TriMesh::<N, 3>::new(mesh.vertices().to_vec(), mesh.triangles().to_vec());
    distance(m1, &skin, m2, other) == N::ZERO
}

fn against_all_kinds<N: Space<3>>() {
    let random = &mut Random(11, false);
    let (mut inside, mut apart) = (0, 0);
    for soup in [
        cuboid::<N>([1.0, 1.5, 2.0], [0.0; 3]),
        ball(1.5, 8),
        cuboid([2.0, 0.125, 2.0], [0.5, 0.0, 0.0]),
    ] {
        let twins = twins(soup);
        for at in 0..samples(140) {
            let size = N::lit(if at % 2 == 0 { 0.1 } else { 0.6 });
            let other = sample3::<N>(SPACE[at % SPACE.len()], random, size);
            let m1 =
                Isometry3::from_parts((random.vector::<N, 3>() * N::TWO).into(), random.turn3());
            let way = random.vector::<N, 3>() * N::lit(if at % 3 == 0 { 0.75 } else { 3.0 });
            let turn = if at % 5 == 0 { m1.rotation } else { random.turn3() };
            let m2 = Isometry3::from_parts((m1.translation.vector + way).into(), turn);
            let noise = N::EPSILON * N::lit(4096.0);
            let touches = compare(&twins, &m1, &m2, &*other, noise);
            (inside, apart) = if touches { (inside + 1, apart) } else { (inside, apart + 1) };
        }
    }
    assert!(inside > 60 && apart > 60, "{inside} {apart}");
}

#[test]
fn random_poses() {
    against_all_kinds::<f32>();
    against_all_kinds::<f64>();
}

fn resting<N: Space<3>>() {
    let twins = twins(cuboid::<N>([2.0, 2.0, 2.0], [0.0; 3]));
    let small = Cuboid::new(Vector::<N, 3>::repeat(N::lit(0.5)));
    let ball = Ball::new(N::HALF);
    let tiny = Ball::new(N::lit(1e-6));
    let half = N::HALF;
    for step in -16..=16 {
        for axis in 0..3 {
            let mut place = Vector::<N, 3>::zeros();
            place[axis] = N::lit(f64::from(step)) * N::lit(0.25);
            let m2 = Isometry3::translation(place.x, place.y, place.z);
            for (other, size) in
                [(&small as &dyn Shape<N, 3>, half), (&ball, half), (&tiny, N::lit(1e-6))]
            {
                let here = Isometry3::identity();
                let expected = place[axis].abs() - size - N::TWO;
                let found = distance(&here, &twins.mesh, &m2, other);
                let right = if expected > N::ZERO { expected } else { N::ZERO };
                assert!(
                    (found - right).abs() <= N::EPSILON * N::lit(8.0),
                    "{found:?} at {place:?}"
                );
                assert_eq!(found == N::ZERO, expected <= N::ZERO, "{found:?} at {place:?}");
                // The nearest wall of the mesh is the wall in the direction of `place`, or all
                // walls are equally near.
                let depth =
                    contact(&here, &twins.mesh, &m2, other, N::ZERO).map(|found| found.depth);
                let depth = depth.unwrap_or(-found);
                assert!(
                    (depth + expected).abs() <= N::EPSILON * N::lit(16.0),
                    "{depth:?} at {place:?}"
                );
                compare(&twins, &here, &m2, other, N::EPSILON * N::lit(256.0));
            }
        }
    }
}

#[test]
fn aligned_and_touching_poses() {
    resting::<f32>();
    resting::<f64>();
}

fn solids_in_solids<N: Space<3>>() {
    let random = &mut Random(5, false);
    let (outer, inner) =
        (twins(ball::<N>(2.0, 8)), twins(cuboid::<N>([0.25, 0.5, 0.75], [0.0; 3])));
    let mut counts = [0; 2];
    for at in 0..samples(40) {
        let m1 = Isometry3::from_parts(random.vector::<N, 3>().into(), random.turn3());
        let way = random.vector::<N, 3>() * N::lit(if at % 2 == 0 { 1.0 } else { 4.0 });
        let m2 = Isometry3::from_parts((m1.translation.vector + way).into(), random.turn3());
        let noise = N::EPSILON * N::lit(4096.0);
        let touches = compare(&outer, &m1, &m2, &inner.mesh, noise);
        let exact = distance(&m1, &outer.hull, &m2, &inner.hull);
        let found = distance(&m1, &outer.mesh, &m2, &inner.mesh);
        assert!((found - exact).abs() <= noise, "{found:?} {exact:?}");
        compare(&inner, &m2, &m1, &outer.mesh, noise);
        counts[usize::from(touches)] += 1;
    }
    assert!(counts.iter().all(|&count| count > 8), "{counts:?}");
}

#[test]
fn one_solid_mesh_inside_another() {
    solids_in_solids::<f32>();
    solids_in_solids::<f64>();
}

#[test]
fn scales_of_two_are_exact() {
    for exponent in [-60, -20, 20, 60] {
        let unit = f64::powi(2.0, exponent);
        let grown = |x: f64| x * unit;
        let place = |scale: f64| Isometry3::translation(0.3 * scale, 0.4 * scale, -0.1 * scale);
        let of = |scale: f64| {
            let mesh = solid(ball::<f64>(scale, 8));
            contact(&Isometry3::identity(), &mesh, &place(scale), &Ball::new(0.125 * scale), 0.0)
                .expect("inside")
        };
        let (plain, scaled) = (of(1.0), of(unit));
        assert_eq!(
            (grown(plain.depth), plain.normal),
            (scaled.depth, scaled.normal),
            "2^{exponent}"
        );
        assert_eq!(plain.world2.map(grown), scaled.world2);
    }
}

#[test]
fn poses_that_are_not_finite() {
    let mesh = solid(cuboid::<f64>([1.0; 3], [0.0; 3]));
    let (here, small) = (Isometry3::identity(), Ball::new(0.25));
    for bad in [f64::NAN, f64::INFINITY] {
        let nowhere = Isometry3::translation(bad, 0.0, 0.0);
        assert_eq!(distance(&here, &mesh, &nowhere, &small), f64::INFINITY);
        assert_eq!(proximity(&here, &mesh, &nowhere, &small, 1.0), Proximity::Disjoint);
        assert_eq!(contact(&here, &mesh, &nowhere, &small, 1.0), None);
        let still = Vector::<f64, 3>::zeros();
        assert_eq!(time_of_impact(&here, &still, &mesh, &nowhere, &still, &small), None);
    }
    for size in [1e-150, 1e-30, 1e30, 1e150] {
        let mesh = solid(cuboid::<f64>([size; 3], [0.0; 3]));
        let place = Isometry3::translation(0.5 * size, 0.0, 0.0);
        let found = contact(&here, &mesh, &place, &Ball::new(0.25 * size), 0.0).expect("inside");
        assert!((found.depth / size - 0.75).abs() < 1e-12, "{found:?}");
        assert_eq!(Point::from(found.normal.into_inner()), Point::<f64, 3>::new(1.0, 0.0, 0.0));
    }
}
