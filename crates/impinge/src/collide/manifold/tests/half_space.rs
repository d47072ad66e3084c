//! Tests that the corners of a solid near a half-space are its contacts.

use super::super::build3;
use super::scene::{Random, Scene, describe, fact, request};
use crate::collide::{Pair, RawManifold};
use crate::math::{Point, Pose, Real, Space, Unit, Vector, orthonormal_basis};
use crate::shape::{
    Capsule, ConvexHull, Cuboid, FeatureId, Kind, Plane, Rounded, Segment, Shape, Triangle,
};

/// A solid and its expected corners: vertices or, for a capsule, the ends of its axis; then the
/// radius around these corners.
type Cornered<N> = (Box<dyn Shape<N, 3>>, Vec<Point<N, 3>>, N);

fn solid<N: Real>(kind: usize, scale: f64, random: &mut Random) -> Cornered<N> {
    let point =
        |random: &mut Random| Point::from(random.vector::<f64, 3>(1.0).map(|x| N::lit(x * scale)));
    let length = |random: &mut Random| N::lit(random.between(0.2, 1.0) * scale);
    match kind {
        0 | 1 => {
            let mut half = Vector::<N, 3>::from_fn(|_, _| length(random));
            half[1] = if kind == 1 { N::ZERO } else { half[1] };
            let corner = |at: usize| {
                let toward =
                    |axis: usize| if at >> axis & 1 == 1 { half[axis] } else { -half[axis] };
                Point::<N, 3>::new(toward(0), toward(1), toward(2))
            };
            let is_first = |at: &usize| kind == 0 || at >> 1 & 1 == 0;
            let corners = (0..8).filter(is_first).map(corner).collect();
            (Box::new(Cuboid::new(half)), corners, N::ZERO)
        }
        2 | 3 => {
            let points: Vec<_> = (0..[12, 40][kind - 2]).map(|_| point(random)).collect();
            let hull = ConvexHull::from_points(&points);
            let Kind::Polytope(polytope) = hull.geometry().0 else { panic!("a polytope") };
            let vertices = polytope.vertices().to_vec();
            (Box::new(hull), vertices, N::ZERO)
        }
        4 => {
            let corners = [point(random), point(random), point(random)];
            let [a, b, c] = corners;
            (Box::new(Triangle::new(a, b, c)), corners.to_vec(), N::ZERO)
        }
        5 => {
            let ends = [point(random), point(random)];
            (Box::new(Segment::new(ends[0], ends[1])), ends.to_vec(), N::ZERO)
        }
        _ => {
            let (ends, radius) = ([point(random), point(random)], length(random));
            let capsule = Capsule::try_from_ends(ends[0], ends[1], radius).expect("finite");
            (Box::new(capsule), ends.to_vec(), radius)
        }
    }
}

/// Moves a solid for three steps. Asserts that each corner within the prediction is a contact, at
/// the corner's position; for a solid with a radius, only that there is a contact. A corner need
/// not be a contact if it is inside the outline of the contacts, or if the previous manifold has at
/// least four points, because these may be kept instead. The corners of steep segments and capsules
/// are not checked. A solid without a radius must not have more contacts than near corners. A
/// feature in contact in two successive steps must keep its id.
fn corners_count<N: Scene<3> + Space<3>>(seed: u64, scale: f64) {
    let (random, mut points) = (&mut Random(seed), 0);
    for round in 0..700_usize {
        let (solid, corners, radius) = solid::<N>(round % 7, scale, random);
        let plane = Plane::new(Unit::new_normalize(random.vector::<N, 3>(1.0)));
        let pose12 = <N as Scene<3>>::pose(Vector::<N, 3>::zeros(), random.turn());
        let mut pair = Pair { first: solid.geometry().0, second: Kind::Plane(&plane), pose12 };
        let normal = -pair.pose12.vector(plane.normal());
        let deep = N::lit(random.between(-1.0, 0.02) * scale);
        pair.pose12.translation = normal * (deep - fact(&pair).distance);
        let mut wanted = request::<N>(0.05 * scale, 0.0);
        wanted.max_points = 64;
        let (mut raw, tolerance) = (RawManifold::default(), N::lit(256.0 * scale) * N::EPSILON);
        for _ in 0..3 {
            let found = fact(&pair);
            let before = raw.clone();
            build3(&pair, &found, &wanted, &mut raw);
            let what = format!("round {round}, {}: {raw:?}", describe(&pair));
            for point in &raw.points {
                let old = before.points.iter().find(|old| old.feature1 == point.feature1);
                assert!(old.is_none_or(|old| old.id == point.id), "{what}\n{before:?}");
            }
            if found.distance > wanted.prediction {
                assert!(raw.points.is_empty(), "{what}");
                continue;
            }
            assert_eq!(raw.points[raw.deepest()].distance, found.distance, "{what}");
            points += raw.points.len();
            let flatness =
                (corners[1] - corners[0]).cross(&normal).norm() / (corners[1] - corners[0]).norm();
            if corners.len() == 2 && flatness < N::lit(0.55) {
                continue;
            }
            let mut expected = 0;
            for corner in &corners {
                let height = normal.dot(&(corner.coords - pair.pose12.translation));
                let distance = -height - radius;
                // Below the raised end of a tilted capsule, the surface is slightly nearer than the
                // ball around that end. So an end of a capsule is required only if its distance is
                // below the prediction by 0.05 of the scale.
                let max_distance = wanted.prediction
                    + if radius > N::ZERO { N::lit(-0.05 * scale) } else { tolerance };
                let is_near =
                    |at: Point<N, 3>| radius > N::ZERO || (at - corner).norm() <= tolerance;
                let has_it = raw.points.iter().any(|point| is_near(point.point1));
                // A corner need not be a contact if it is inside the outline of the contacts, or if
                // the last manifold had at least four points, because these may be kept instead.
                let is_inner = before.points.len() >= 4 || is_among(corner, &raw, &normal);
                let is_far = distance > max_distance - tolerance - tolerance;
                assert!(has_it || is_far || is_inner, "{corner} at {distance}, {what}");
                expected += usize::from(distance <= wanted.prediction + tolerance);
            }
            assert!(raw.points.len() <= expected.max(1) || radius > N::ZERO, "{what}");
            pair.pose12.translation += random.vector::<N, 3>(0.02).map(|x| x * N::lit(scale));
        }
    }
    assert!(points > 1000, "{points} points");
}

/// Returns whether a point, projected along the normal, is inside the outline of a manifold's
/// points; tested in 288 directions, with a slack of at most 0.01.
fn is_among<N: Real>(
    position: &Point<N, 3>,
    raw: &RawManifold<N, 3>,
    normal: &Vector<N, 3>,
) -> bool {
    let (u, v) = orthonormal_basis(normal);
    let mut directions = (-8..=8).flat_map(|x| (-8..=8).map(move |y| [x, y].map(f64::from)));
    directions.all(|[x, y]| {
        let along = |at: &Point<N, 3>| (u * N::lit(x) + v * N::lit(y)).dot(&at.coords).as_f64();
        raw.points.iter().any(|point| along(&point.point1) >= along(position) - 1e-2)
    })
}

#[test]
fn corners_near_a_half_space_are_its_contacts() {
    for (seed, scale) in [(1, 1.0), (2, 2.0_f64.powi(20)), (3, 2.0_f64.powi(-30))] {
        corners_count::<f32>(seed, scale);
        corners_count::<f64>(seed + 10, scale);
    }
}

/// Asserts that a rounded box touches with four corners of its face, on the rounded surface.
#[test]
fn a_rounded_box_lies_on_four_corners() {
    let solid = Rounded::new(Cuboid::new(Vector::<f64, 3>::new(1.0, 0.5, 2.0)), 0.25);
    let plane = Plane::new(Unit::new_unchecked(Vector::<f64, 3>::y()));
    let pose12 = Pose::from_translation(Vector::<f64, 3>::new(0.0, -0.74, 0.0));
    let pair = Pair { first: solid.geometry().0, second: Kind::Plane(&plane), pose12 };
    let mut raw = RawManifold::default();
    build3(&pair, &fact(&pair), &request(0.1, 0.0), &mut raw);
    let positions = raw.points.iter().map(|point| point.point1).collect::<Vec<_>>();
    assert_eq!(positions.len(), 4, "{raw:?}");
    let is_corner = |p: &Point<f64, 3>| p.x.abs() == 1.0 && p.y == -0.75 && p.z.abs() == 2.0;
    assert!(positions.iter().all(is_corner), "{raw:?}");
    assert!(
        raw.points.iter().all(|point| matches!(point.feature1, FeatureId::Vertex(_))),
        "{raw:?}"
    );
}

/// Returns the contacts of a plate that lies on a half-space with the side `down` along `axis`,
/// tilted by `tilt`: their distances, and whether each is a corner of that side.
fn contacts_of_plate<N: Scene<3> + Space<3>>(
    (axis, down): (usize, f64),
    tilt: f64,
    depth: f64,
    [prediction, sine]: [f64; 2],
) -> Vec<(f64, bool)> {
    let along = |index: usize| if index == axis { 0.05 } else { 1.0 };
    let plate = Cuboid::new(Vector::<N, 3>::from_fn(|index, _| N::lit(along(index))));
    let mut out = Vector::<N, 3>::zeros();
    (out[axis], out[(axis + 1) % 3]) = (N::lit(-down), N::lit(tilt));
    let plane = Plane::new(Unit::new_normalize(out));
    let pose12 = Pose::from_translation(Vector::<N, 3>::zeros());
    let mut pair = Pair { first: plate.geometry().0, second: Kind::Plane(&plane), pose12 };
    pair.pose12.translation = plane.normal().into_inner() * (fact(&pair).distance + N::lit(depth));
    let mut raw = RawManifold::default();
    let mut found = Vec::new();
    // The second manifold has old points among its candidates.
    for _ in 0..2 {
        build3(&pair, &fact(&pair), &request::<N>(prediction, sine), &mut raw);
        let is_low = |p: &Point<N, 3>| p[axis] == N::lit(0.05 * down);
        found = raw.points.iter().map(|p| (p.distance.as_f64(), is_low(&p.point1))).collect();
    }
    found
}

/// Asserts that a plate touches with the four corners of the side on which it lies, although the
/// corners of its upper side are within the prediction, too.
fn plates_lie_on_their_lower_side<N: Scene<3> + Space<3>>() {
    for side in [0, 1, 2].into_iter().flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        for tilt in [0.0, 1e-6, 1e-4, 1e-2] {
            for (depth, request) in [(0.0, [0.2, 0.0]), (0.0, [0.02, 0.09]), (0.12, [0.0, 0.0])] {
                let found = contacts_of_plate::<N>(side, tilt, depth, request);
                let what = format!("{side:?} {tilt} {depth} {request:?}: {found:?}");
                assert_eq!(found.len(), 4, "{what}");
                assert!(found.iter().all(|&(_, is_low)| is_low), "{what}");
                assert!(found.iter().all(|(at, _)| (at + depth).abs() < 0.03), "{what}");
            }
        }
    }
}

/// Asserts that a tilted plate also has the corners of its raised edge if its rotation may bring
/// them near, however large that is.
fn raised_edges_count<N: Scene<3> + Space<3>>() {
    for (tilt, sine) in [(0.1, 0.12), (0.28, 0.3), (0.6, 0.65)] {
        let found = contacts_of_plate::<N>((1, -1.0), tilt, 0.0, [0.002, sine]);
        assert_eq!(found.len(), 4, "{tilt}: {found:?}");
        assert!(found.iter().all(|&(_, is_low)| is_low), "{tilt}: {found:?}");
    }
}

#[test]
fn plates_lie_on_the_corners_of_their_lower_side() {
    plates_lie_on_their_lower_side::<f32>();
    plates_lie_on_their_lower_side::<f64>();
    raised_edges_count::<f32>();
    raised_edges_count::<f64>();
}
