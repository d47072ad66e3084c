//! Tests of triangles against triangles, boxes and hulls. Results are compared with the general
//! algorithm, and with bounds that depend on no algorithm: a separating plane bounds the distance
//! from below, two points of the solids bound it from above.

use super::triangles::{TiledTriangles, TriangleGap, pair};
use super::{Algorithm, gaps3, general, hulls, separation};
use crate::collide::Pair;
use crate::collide::packet::{LANES, PartPacket};
use crate::convex::Separation;
use crate::math::na::UnitQuaternion;
use crate::math::xorshift::Xorshift;
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::{ConvexHull, Cuboid, Geometry, Kind, Shape, SupportMap, Triangle};

impl Xorshift {
    fn pose<N: Real>(&mut self, away: f64) -> Pose<N, 3> {
        let turn = UnitQuaternion::from_scaled_axis(self.vector::<f64>(3.0));
        let matrix = turn.to_rotation_matrix().into_inner().map(N::lit);
        Pose { rotation: matrix, translation: self.vector(away) }
    }

    /// Draws a triangle. For five of nine values of `round % 9` it is a segment, a sliver, a point,
    /// perpendicular to the y axis, or has a side along the x axis.
    fn triangle<N: Real>(&mut self, round: usize) -> Triangle<N, 3> {
        let mut corner = || Point::from(self.vector::<N>(1.0));
        let [a, mut b, mut c] = [corner(), corner(), corner()];
        match round % 9 {
            0 => c = a + (b - a) * N::lit(0.25),
            1 => c = a + (b - a) * N::HALF + (c - a) * N::lit(1e-5),
            2 => (b, c) = (a, a),
            3 => (b.y, c.y) = (a.y, a.y),
            4 => (b.y, b.z) = (a.y, a.z),
            _ => {}
        }
        Triangle::new(a, b, c)
    }
}

/// Asserts up to `slack` that a separation is right: the supporting planes with its normal have its
/// distance, the vector between its points is the normal times this distance, and each point is
/// within its solid's extents along 26 directions.
fn check_proof<N: Real>(pair: &Pair<'_, N, 3>, found: &Separation<N, 3>, slack: f64, what: &str) {
    let maps = [pair.first, pair.second].map(|kind| match kind {
        Kind::Triangle(triangle) => triangle as &dyn SupportMap<N, 3>,
        Kind::Cuboid(cuboid) => cuboid,
        Kind::Polytope(hull) => hull,
        _ => unreachable!("none of these"),
    });
    let normal = found.normal;
    assert!((normal.norm().as_f64() - 1.0).abs() < 1e-6, "{what}: unit");
    let high = normal.dot(&maps[0].core_support(&normal).coords);
    let local = pair.pose12.inverse_vector(&-normal);
    let low = normal.dot(&pair.pose12.point(&maps[1].core_support(&local)).coords);
    let proof = (low - high - found.distance).as_f64();
    assert!(proof.abs() <= slack, "{what}: the height along the normal is {} more", proof);
    let away = found.point2 - found.point1 - normal * found.distance;
    assert!(away.norm().as_f64() <= slack, "{what}: the points are aside by {away:?}");
    let on = [found.point1, pair.pose12.inverse_point(&found.point2)];
    for (map, point) in maps.iter().zip(on) {
        for along in directions::<N>() {
            let inside_by = along.dot(&(map.core_support(&along) - point)).as_f64();
            assert!(inside_by >= -slack, "{what}: a point is outside by {inside_by}");
        }
    }
}

/// Returns the 26 unit vectors from the centre of a cube to its vertices and to the middles of its
/// faces and edges.
fn directions<N: Real>() -> impl Iterator<Item = Vector<N, 3>> {
    let steps = || [-1.0, 0.0, 1.0].into_iter();
    let all = steps().flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| [x, y, z])));
    let some = all.filter(|v| *v != [0.0; 3]);
    some.map(|v| Vector::<f64, 3>::from(v).normalize().map(N::lit))
}

/// Counts of the cases that occurred in a test.
#[derive(Default)]
struct Tally {
    overlaps: usize,
    /// Results that differ in bits from those of the general algorithm.
    closed: usize,
    rounds: usize,
}

/// Asserts that the separating axis test `own` finds the distance of the general algorithm up to
/// rounding, passes [`check_proof`], returns the same separation if the limit is its distance, and
/// `None` if the limit is smaller by more than rounding. Counts the case in `tally`.
fn check_pair<N: Real>(own: Algorithm<N, 3>, pair: &Pair<'_, N, 3>, size: f64, tally: &mut Tally) {
    let slack = 256.0 * N::EPSILON.as_f64() * size;
    let found = own(pair, N::INFINITY).expect("within infinity");
    let general = general::of_flat_cores(pair, N::INFINITY).expect("within infinity");
    let triangle = match pair.first {
        Kind::Triangle(triangle) => triangle,
        _ => unreachable!("a triangle comes first"),
    };
    let what = format!("round {}: {triangle:?} {found:?} {general:?}", tally.rounds);
    let off = (found.distance - general.distance).as_f64();
    assert!(off.abs() <= slack, "off by {off}: {what}");
    check_proof(pair, &found, slack, &what);
    tally.rounds += 1;
    tally.overlaps += usize::from(found.distance < N::ZERO);
    tally.closed += usize::from(found != general);
    assert_eq!(own(pair, found.distance), Some(found), "the limit is its distance: {what}");
    let less = found.distance - N::lit(slack);
    assert_eq!(own(pair, less), None, "beyond the limit: {what}");
}

/// Runs [`check_pair`] for a random triangle and a random box, hull and triangle, in `rounds`
/// random poses. Sizes are about 0.1 to 1; every seventh box is flat. Asserts that more than a
/// quarter of the results differ in bits from those of the general algorithm, so that the tested
/// algorithm does not always fall back to it, and that more than a sixteenth are overlaps.
fn at_random<N: Real>(rounds: usize) {
    let (mut random, mut tallies) = (Xorshift(7), [(); 4].map(|()| Tally::default()));
    for round in 0..rounds {
        let triangle = random.triangle::<N>(round);
        let mut half = random.vector::<N>(0.5).abs() + Vector::<N, 3>::repeat(N::lit(0.05));
        if round % 7 == 0 {
            half.y = N::ZERO;
        }
        let cuboid = Cuboid::new(half);
        let points: Vec<_> = (0..9).map(|_| Point::from(random.vector::<N>(0.6))).collect();
        let hull = ConvexHull::from_points(&points);
        let mut pose12 = random.pose::<N>(if round % 3 == 0 { 1.5 } else { 0.5 });
        if round % 5 == 0 {
            pose12 = Pose::from_translation(pose12.translation);
        }
        let first = triangle.geometry().0;
        let other = random.triangle::<N>(round / 2);
        let kinds = [cuboid.geometry().0, hull.geometry().0, other.geometry().0];
        let [with_kinds @ .., with_pairs] = &mut tallies;
        for (second, tally) in kinds.into_iter().zip(with_kinds) {
            check_pair(hulls::separation, &Pair { first, second, pose12 }, 4.0, tally);
        }
        let pair = Pair { first, second: kinds[2], pose12 };
        check_pair(pair::separation, &pair, 4.0, with_pairs);
    }
    for Tally { overlaps, closed, rounds } in &tallies {
        assert!(
            closed * 4 > *rounds,
            "{closed} of {rounds} are not those of the general algorithm"
        );
        assert!(overlaps * 16 > *rounds, "{overlaps} of {rounds} overlap");
    }
}

#[test]
fn boxes_hulls_and_triangles_at_random() {
    at_random::<f32>(4000);
    at_random::<f64>(4000);
}

#[test]
fn scaling_by_powers_of_two_is_exact() {
    let mut random = Xorshift(3);
    for round in 0..300 {
        let triangle = random.triangle::<f32>(round);
        let half = random.vector::<f32>(0.5).abs();
        let points: Vec<_> = (0..9).map(|_| Point::from(random.vector::<f32>(0.6))).collect();
        let pose12 = random.pose::<f32>(0.7);
        let at = |factor: f32| {
            let corners = triangle.corners().map(|corner| corner * factor);
            let triangle = Triangle::new(corners[0], corners[1], corners[2]);
            let points: Vec<_> = points.iter().map(|point| point * factor).collect();
            let (cuboid, hull) = (Cuboid::new(half * factor), ConvexHull::from_points(&points));
            let pose12 = Pose { translation: pose12.translation * factor, ..pose12 };
            [cuboid.geometry().0, hull.geometry().0].map(|second| {
                let pair = Pair { first: triangle.geometry().0, second, pose12 };
                let found = separation(&pair, f32::INFINITY).expect("within infinity");
                (found.distance / factor, found.normal, found.point1 / factor)
            })
        };
        for factor in [2.0_f32.powi(-30), 2.0_f32.powi(30)] {
            assert_eq!(at(1.0)[0], at(factor)[0], "a box, {factor}");
            assert_eq!(at(1.0)[1], at(factor)[1], "a hull, {factor}");
        }
    }
}

#[test]
fn a_box_on_a_face_has_its_normal() {
    let p = |x, y, z| Point::<f64, 3>::new(x, y, z);
    let triangle = Triangle::new(p(-4.0, 0.0, -4.0), p(0.0, 0.0, 8.0), p(4.0, 0.0, -4.0));
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(1.0, 0.5, 1.0));
    for (height, distance) in [(0.75, 0.25), (0.5, 0.0), (0.375, -0.125), (-0.25, -0.25)] {
        let pose12 = Pose::from_translation(Vector::<f64, 3>::new(0.0, height, 0.0));
        let pair = Pair { first: triangle.geometry().0, second: cuboid.geometry().0, pose12 };
        let found = separation(&pair, 1.0).expect("within the limit");
        assert_eq!((found.distance, found.normal.y), (distance, height.signum()), "at {height}");
        let is_below = [found.point1.x, found.point1.z].iter().all(|x| x.abs() <= 1.0);
        assert!(is_below && found.point1.y == 0.0, "on the triangle, below the box");
    }
}

/// Runs [`check_together`] for 1 to 19 random triangles and a box or hull: it compares gaps that
/// are computed in packets with separations that are computed one by one.
fn together<N: Real>(rounds: usize) {
    let (mut random, mut touching) = (Xorshift(5), 0);
    for round in 0..rounds {
        let half = random.vector::<N>(1.0).map(|x| if round % 5 == 0 { N::ZERO } else { x.abs() });
        let points: Vec<_> = (0..4 + round % 9).map(|_| Point::from(random.vector(1.0))).collect();
        let (cuboid, hull) = (Cuboid::new(half), ConvexHull::from_points(&points));
        let mut pose12 = random.pose::<N>(1.5);
        if round % 7 == 0 {
            pose12.rotation = Pose::identity().rotation;
        }
        let count = 1 + round % 19;
        let mut triangles: Vec<_> = (0..count).map(|at| random.triangle::<N>(round + at)).collect();
        if round % 11 == 0 {
            let huge = |point: &Point<N, 3>| point * N::MAX.sqrt();
            let [a, b, c] = triangles[0].corners();
            triangles[0] = Triangle::new(huge(a), huge(b), huge(c));
        }
        for limit in [N::ZERO, N::lit(0.3), N::MAX] {
            for solid in [Kind::Cuboid(&cuboid), hull.geometry().0] {
                touching += check_together(&triangles, solid, &pose12, limit, round);
            }
        }
    }
    assert!(touching > rounds, "{touching} touch");
}

/// Asserts that [`gaps3`] visits each triangle whose separation is within `limit`, and checks the
/// gaps. Returns the number of triangles within `limit` for which it passed a gap.
fn check_together<N: Real>(
    triangles: &[Triangle<N, 3>],
    solid: Kind<'_, N, 3>,
    pose12: &Pose<N, 3>,
    limit: N,
    round: usize,
) -> usize {
    let count = triangles.len();
    let mut tiles = vec![PartPacket::blank(); count.div_ceil(LANES)];
    for lane in 0..tiles.len() * LANES {
        tiles[lane / LANES].put(lane % LANES, triangles[lane.min(count - 1)].corners());
    }
    let mut masks = vec![u8::MAX; tiles.len()];
    *masks.last_mut().expect("one") >>= tiles.len() * LANES - count;
    let parts = TiledTriangles { tiles: &tiles, masks: &masks, origin: Vector::<N, 3>::zeros() };
    let (mut touching, mut certain) = (0, vec![false; count]);
    let mut is_met = vec![false; count];
    let is_known = gaps3(&parts, solid, pose12, limit, limit, &mut |at, gap| {
        is_met[at] = true;
        if let Some(gap) = gap {
            certain[at] = true;
            check_gap(gap, &triangles[at], solid, pose12, round);
        }
    });
    assert!(is_known, "round {round}");
    for (at, triangle) in triangles.iter().enumerate() {
        let pair = Pair { first: Kind::Triangle(triangle), second: solid, pose12: *pose12 };
        let is_near = separation(&pair, limit).is_some();
        assert!(is_met[at] || !is_near, "round {round}: {triangle:?} is within the limit");
        touching += usize::from(is_near && certain[at]);
    }
    touching
}

/// Asserts up to rounding that the gap of a triangle in a packet is at most the distance of its
/// separation. If the gap has a feature, asserts that it equals the distance, and that the
/// separation touches this feature, unless another direction has nearly the same gap.
fn check_gap<N: Real>(
    gap: &TriangleGap<N>,
    triangle: &Triangle<N, 3>,
    solid: Kind<'_, N, 3>,
    pose12: &Pose<N, 3>,
    round: usize,
) {
    let pair = Pair { first: Kind::Triangle(triangle), second: solid, pose12: *pose12 };
    let found = separation(&pair, N::INFINITY).expect("within infinity");
    let reach = Geometry(solid).as_support_map().expect("it is convex").reach();
    let sizes = triangle.reach() + reach + pose12.translation.norm();
    let tolerance = N::lit(16.0) * N::EPSILON * sizes;
    let off = found.distance - gap.distance;
    assert!(off >= -N::lit(16.0) * tolerance, "round {round}: not less than {found:?}");
    let Some(feature) = gap.touched else { return };
    assert!(off <= N::lit(16.0) * tolerance, "round {round}: not more than {found:?}");
    let part = triangle.part_at(&found.point1, &found.normal, tolerance);
    let is_tie = (found.normal - gap.normal).norm() > N::lit(1e-3);
    assert!(part == Some(feature) || is_tie, "round {round}: {part:?} {feature:?}");
}

#[test]
fn many_triangles_together_are_as_near_as_each_alone() {
    together::<f32>(1000);
    together::<f64>(1000);
}
