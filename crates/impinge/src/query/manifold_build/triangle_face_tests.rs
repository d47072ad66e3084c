//! The fused algorithm for faces of triangles against the general builder.

use super::along::{Along, build_between, build_in_general};
use super::frame::rounding;
use super::triangle_face::{OnFace, on_face3};
use crate::convex::Separation;
use crate::math::noise::Noise;
use crate::math::{Point, Pose, Real, Vector, cross, orthonormal_basis, unit};
use crate::query::separation::separation_in_space;
use crate::query::{ManifoldRequest, Pair, RawManifold, RawPoint};
use crate::shape::{Capsule, ConvexHull, Cuboid, Kind, Segment, Shape, Triangle};

/// A triangle about one large; every fourth one lies along the axes.
fn any_triangle<N: Real>(noise: &mut Noise, round: usize) -> Triangle<N, 3> {
    let mut corner = || Point::from(noise.vector::<N>(1.0));
    let [mut a, mut b, mut c] = [corner(), corner(), corner()];
    if round.is_multiple_of(4) {
        (a.y, b.y, c.y) = (N::ZERO, N::ZERO, N::ZERO);
    }
    Triangle::new(a, b, c)
}

/// A solid that lies on the triangle by about `depth`, leaning by up to a fifth of a radian.
fn leaning<N: Real>(noise: &mut Noise, normal: &Vector<N, 3>, middle: &Point<N, 3>) -> Pose<N, 3> {
    let lean: Vector<N, 3> = noise.vector(0.2);
    let up = unit(&(normal + lean)).map_or(*normal, |(up, _)| up);
    let (u, v): (Vector<N, 3>, Vector<N, 3>) = orthonormal_basis(&up);
    let mut pose = Pose::<N, 3>::identity();
    for (axis, column) in [(0, u), (1, up), (2, -v)] {
        pose.rotation.set_column(axis, &column);
    }
    let aside: Vector<N, 3> = noise.vector(0.4);
    pose.translation = middle.coords + normal * N::lit(0.45 + 0.1 * noise.next()) + aside;
    pose
}

fn normal_of<N: Real>(triangle: &Triangle<N, 3>) -> Vector<N, 3> {
    let [a, b, c] = triangle.corners();
    unit(&cross(&(b - a), &(c - a))).map_or(Vector::<N, 3>::y(), |(normal, _)| normal)
}

/// Both hold the same points by their names, up to rounding.
fn same<N: Real>(found: &[RawPoint<N, 3>], expected: &[RawPoint<N, 3>], slack: N, what: &str) {
    let name = |point: &RawPoint<N, 3>| (point.feature1, point.feature2);
    assert_eq!(found.len(), expected.len(), "{what}: {found:?} {expected:?}");
    for point in expected {
        let twin = found.iter().find(|other| name(other) == name(point));
        let twin = twin.unwrap_or_else(|| panic!("{what}: no {point:?} in {found:?}"));
        let off = (twin.point1 - point.point1).norm() + (twin.distance - point.distance).abs();
        assert!(off <= slack, "{what}: {twin:?} instead of {point:?}");
    }
}

/// The contacts along the normal of the face, and those of a separation that has it.
fn check_pair<N: Real>(pair: &Pair<'_, N, 3>, normal: &Vector<N, 3>, what: &str) -> [bool; 2] {
    let slack = N::lit(2048.0) * N::EPSILON;
    let prediction = N::lit(0.05);
    let request = ManifoldRequest { prediction, sine: N::ZERO, max_points: 16 };
    let (mut found, mut expected) = (RawManifold::default(), RawManifold::default());
    let (least, tolerance) = (N::lit(-0.2), rounding(pair));
    let on_face = OnFace { normal: *normal, least, nearest: None, prediction, tolerance };
    let is_made = on_face3(pair, &on_face, &mut found);
    build_in_general(pair, &Along { normal: *normal, least, tolerance }, &request, &mut expected);
    if is_made {
        same(&found.points, &expected.points, slack, what);
    }
    let witness = separation_in_space(pair, prediction);
    let Some(witness) = witness.filter(|w| (w.normal - normal).norm() < N::lit(1e-6)) else {
        return [is_made && !found.points.is_empty(), false];
    };
    let witness = Separation { normal: *normal, ..witness };
    let (least, nearest) = (-N::INFINITY, Some(witness.distance));
    let on_face = OnFace { normal: *normal, least, nearest, prediction, tolerance };
    let is_found = on_face3(pair, &on_face, &mut found);
    build_between(pair, &witness, &request, &mut expected);
    if is_found {
        same(&found.points, &expected.points, slack, &format!("{what}, from a separation"));
        assert_eq!(found.points.iter().map(|p| p.distance).reduce(crate::math::min), nearest);
    }
    [is_made && !found.points.is_empty(), is_found]
}

fn at_random<N: Real>(rounds: usize) {
    let (mut noise, mut made, mut of_witness) = (Noise(11), 0, 0);
    for round in 0..rounds {
        let triangle = any_triangle::<N>(&mut noise, round);
        let [a, b, c] = triangle.corners().map(|corner| corner.coords);
        let normal = normal_of(&triangle) * if round % 2 == 0 { N::ONE } else { -N::ONE };
        let middle = Point::from((a + b + c) / N::lit(3.0));
        let mut pose12 = leaning(&mut noise, &normal, &middle);
        if round % 8 == 0 {
            pose12.rotation.fill_with_identity();
        }
        let half = noise.vector::<N>(0.2).abs() + Vector::<N, 3>::repeat(N::lit(0.3));
        let cuboid = Cuboid::new(half);
        let corners: Vec<_> = (0..8)
            .map(|corner: usize| {
                let sign = |axis: usize| if corner >> axis & 1 == 0 { -N::HALF } else { N::HALF };
                Point::<N, 3>::new(sign(0), sign(1), sign(2)) + noise.vector::<N>(0.1)
            })
            .collect();
        let hull = ConvexHull::from_points(&corners);
        for second in [cuboid.geometry().0, hull.geometry().0] {
            let pair = Pair { first: triangle.geometry().0, second, pose12 };
            let is_box = matches!(second, Kind::Cuboid(_));
            let [is_made, is_found] =
                check_pair(&pair, &normal, &format!("round {round}, a box: {is_box}"));
            made += usize::from(is_made);
            of_witness += usize::from(is_found);
        }
    }
    assert!(made > rounds / 2 && of_witness > rounds / 8, "{made} {of_witness} of {rounds}");
}

/// A capsule, the first solid, over a triangle, lying or standing; every third one is a segment.
fn capsules_at_random<N: Real>(rounds: usize) {
    let (mut noise, mut made, mut of_witness) = (Noise(12), 0, 0);
    for round in 0..rounds {
        let triangle = any_triangle::<N>(&mut noise, round);
        let [a, b, c] = triangle.corners().map(|corner| corner.coords);
        let normal = normal_of(&triangle) * if round % 2 == 0 { N::ONE } else { -N::ONE };
        let middle = Point::from((a + b + c) / N::lit(3.0));
        let mut pose21 = leaning(&mut noise, &normal, &middle);
        let is_standing = round % 5 == 0;
        let is_segment = round % 3 == 0;
        let half = N::lit(0.35 + 0.3 * noise.next());
        let radius = if is_segment { N::ZERO } else { N::lit(0.2) };
        // By so much lower than a box is.
        let reach = radius + if is_standing { half } else { N::ZERO };
        pose21.translation += normal * (reach - N::lit(0.45));
        let along =
            Point::from(if is_standing { Vector::<N, 3>::y() } else { Vector::<N, 3>::x() } * half);
        let capsule = Capsule::try_from_ends(-along, along, N::lit(0.2)).expect("it is finite");
        let segment = Segment::new(-along, along);
        let first = if is_segment { segment.geometry().0 } else { capsule.geometry().0 };
        let pair = Pair { first, second: triangle.geometry().0, pose12: pose21.inverse() };
        let down = pair.pose12.vector(&-normal);
        let what = format!("round {round}, standing: {is_standing}, a segment: {is_segment}");
        let [is_made, is_found] = check_pair(&pair, &down, &what);
        made += usize::from(is_made);
        of_witness += usize::from(is_found);
    }
    assert!(made > rounds / 5 && of_witness > rounds / 16, "{made} {of_witness} of {rounds}");
}

#[test]
fn faces_of_triangles_below_capsules_as_in_general() {
    capsules_at_random::<f32>(2000);
    capsules_at_random::<f64>(2000);
}

#[test]
fn faces_of_triangles_as_in_general() {
    at_random::<f32>(2000);
    at_random::<f64>(2000);
}
