//! Compares the numbers of contact points of solids at rest, and for some of them positions,
//! features and distances, with values determined by hand.

use super::scene::{Scene, fact, manifold, request};
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Point, Real, Unit, Vector};
use crate::shape::{
    Ball, Capsule, ConvexHull, Cuboid, Cylinder, Ellipsoid, FeatureId, Plane, Rounded, Shape,
    TaperedCapsule, Tetrahedron,
};

/// A solid at rest on a surface whose top is at height zero: the height of its origin, and its
/// rotation vector.
struct Rest<'a, const D: usize> {
    solid: &'a dyn Shape<f32, D>,
    height: f32,
    turn: [f64; 3],
}

impl<const D: usize> Rest<'_, D>
where
    f32: Scene<D>,
{
    fn up() -> Vector<f32, D> {
        Vector::<f32, D>::from_fn(|axis, _| if axis == 1 { 1.0 } else { 0.0 })
    }

    fn on(
        &self,
        terrain: &dyn Shape<f32, D>,
        top: f32,
        wish: &ManifoldRequest<f32>,
    ) -> RawManifold<f32, D> {
        let pose1 = f32::pose(Self::up() * self.height, self.turn);
        let pose2 = f32::pose(Self::up() * -top, [0.0; 3]);
        let pose12 = crate::math::Pose::relative(&pose1, &pose2);
        let pair = Pair { first: self.solid.geometry().0, second: terrain.geometry().0, pose12 };
        manifold(&pair, wish).1
    }

    /// Returns the numbers of points on a half-space and on a large box.
    fn counts(&self, wish: &ManifoldRequest<f32>) -> [usize; 2] {
        let plane = Plane::new(Unit::new_normalize(Self::up()));
        let mut half_extents = Vector::<f32, D>::repeat(5.0);
        half_extents[1] = 1.0;
        let cuboid = Cuboid::new(half_extents);
        [self.on(&plane, 0.0, wish).points.len(), self.on(&cuboid, 1.0, wish).points.len()]
    }
}

/// Components x and z of rotation vectors, in radians: zero, or about the rounding error of `f32`.
const TILTS: [f64; 5] = [0.0, 3e-8, -1e-7, 1.5e-7, -2e-7];

fn box_rests<const D: usize>(expected: usize)
where
    f32: Scene<D>,
{
    let solid = Cuboid::new(Vector::<f32, D>::from_fn(|axis, _| [0.5, 0.25, 1.0][axis]));
    for tilt in TILTS {
        for sunk in [0.0, 1e-8, 1e-3] {
            let rest = Rest { solid: &solid, height: 0.25 - sunk, turn: [tilt, 0.0, tilt] };
            let [on_plane, on_box] = rest.counts(&request(0.0, 0.0));
            // Within rounding of touching there may be no contact; otherwise all corners are
            // contacts.
            let is_right = |count| count == expected || sunk < 1e-7 && count == 0;
            assert!(is_right(on_plane), "{on_plane} points on a plane: {tilt} {sunk}");
            assert!(is_right(on_box), "{on_box} points on a box: {tilt} {sunk}");
        }
    }
    let spun = Rest { solid: &solid, height: 0.26, turn: [0.0, 0.7 * f64::from(D == 3), 0.0] };
    assert_eq!(spun.counts(&request(0.02, 0.0)), [expected; 2], "above the terrain, spun");
    assert_eq!(spun.counts(&request(0.005, 0.0)), [0; 2], "out of reach");
}

#[test]
fn a_box_rests_on_two_or_four_points() {
    box_rests::<2>(2);
    box_rests::<3>(4);
}

#[test]
fn a_tilted_box_keeps_its_points_within_the_angular_prediction() {
    let solid = Cuboid::new(Vector::<f32, 3>::new(0.5, 0.5, 0.5));
    for tilt in [0.02_f32, 0.05, 0.08] {
        let height = 0.5 * (tilt.cos() + tilt.sin());
        let rest = Rest { solid: &solid, height, turn: [0.0, 0.0, f64::from(tilt)] };
        assert_eq!(rest.counts(&request(1e-6, 0.09_f64.sin())), [4; 2], "{tilt} with the angle");
        assert_eq!(rest.counts(&request(1e-6, 0.0)), [2; 2], "{tilt} without");
    }
    let rest = Rest {
        solid: &solid,
        height: 0.5 * (0.2_f32.cos() + 0.2_f32.sin()),
        turn: [0.0, 0.0, 0.2],
    };
    assert_eq!(rest.counts(&request(1e-6, 0.09_f64.sin())), [2; 2], "tilted by more");
}

#[test]
fn round_solids_rest() {
    let cylinder = Cylinder::new(0.5_f32, 0.25);
    let capsule = Capsule::<f32, 3>::new(0.5, 0.25);
    let flat_capsule = Capsule::<f32, 2>::new(0.5, 0.25);
    let ball = Ball::new(0.5_f32);
    let lying = [0.0, 0.0, std::f64::consts::FRAC_PI_2];
    for sunk in [0.0, 1e-3] {
        let wish = request(1e-6, 0.0);
        let standing = Rest { solid: &cylinder, height: 0.5 - sunk, turn: [0.0; 3] };
        assert_eq!(standing.counts(&wish), [4; 2], "a standing cylinder");
        let rolling = Rest { solid: &cylinder, height: 0.25 - sunk, turn: lying };
        assert_eq!(rolling.counts(&wish), [2; 2], "a lying cylinder");
        let capsule = Rest { solid: &capsule, height: 0.25 - sunk, turn: lying };
        assert_eq!(capsule.counts(&wish), [2; 2], "a lying capsule");
        let flat = Rest { solid: &flat_capsule, height: 0.25 - sunk, turn: lying };
        assert_eq!(flat.counts(&wish), [2; 2], "a lying capsule in 2D");
        let ball3 = Rest::<3> { solid: &ball, height: 0.5 - sunk, turn: [0.0; 3] };
        assert_eq!(ball3.counts(&wish), [1; 2], "a ball");
        let ball2 = Rest::<2> { solid: &ball, height: 0.5 - sunk, turn: [0.0; 3] };
        assert_eq!(ball2.counts(&wish), [1; 2], "a disk");
    }
}

#[test]
fn ellipsoids_tapered_capsules_and_rounded_boxes_rest() {
    let wish = request(1e-6, 0.0);
    let pebble = Ellipsoid::new(Vector::<f32, 3>::new(1.0, 0.25, 0.5));
    let (die, tile) = (
        Rounded::<f32, 3>::new(Cuboid::new(Vector::<f32, 3>::new(0.5, 0.125, 0.25)), 0.125),
        Rounded::<f32, 2>::new(Cuboid::new(Vector::<f32, 2>::new(0.5, 0.125)), 0.125),
    );
    // The side of the tapered capsule has an angle of sine 0.6 to its axis, so the axis of the
    // lying solid has this slope. The centre of the small end is at height 0.25.
    let club = TaperedCapsule::<f32, 3>::new(0.625, 0.25, 1.0);
    let flat_club = TaperedCapsule::<f32, 2>::new(0.625, 0.25, 1.0);
    let lying = [0.0, 0.0, -(0.8_f64.atan2(0.6))];
    let middle = 0.25 + 0.625 * 0.6;
    for sunk in [1e-5, 1e-3] {
        let pebble = Rest { solid: &pebble, height: 0.25 - sunk, turn: [0.0; 3] };
        assert_eq!(pebble.counts(&wish), [1; 2], "a pebble");
        let die = Rest { solid: &die, height: 0.25 - sunk, turn: [0.0; 3] };
        assert_eq!(die.counts(&wish), [4; 2], "a die");
        let tile = Rest { solid: &tile, height: 0.25 - sunk, turn: [0.0; 3] };
        assert_eq!(tile.counts(&wish), [2; 2], "a tile");
        let club = Rest { solid: &club, height: middle - sunk, turn: lying };
        assert_eq!(club.counts(&wish), [2; 2], "a club");
        let flat = Rest { solid: &flat_club, height: middle - sunk, turn: lying };
        assert_eq!(flat.counts(&wish), [2; 2], "a club in 2D");
    }
}

#[test]
fn tetrahedra_with_and_without_volume_rest() {
    let p = |x: f32, y: f32, z: f32| Point::<f32, 3>::new(x, y, z);
    let solid = Tetrahedron::new([
        p(-1.0, 0.0, -1.0),
        p(1.0, 0.0, -1.0),
        p(0.0, 0.0, 1.0),
        p(0.0, 1.0, 0.0),
    ]);
    let flat = Tetrahedron::new([
        p(-1.0, 0.0, -1.0),
        p(1.0, 0.0, 1.0),
        p(1.0, 0.0, -1.0),
        p(-1.0, 0.0, 1.0),
    ]);
    for sunk in [0.0, 1e-3] {
        let wish = request(1e-6, 0.0);
        let on_a_face = Rest { solid: &solid, height: -sunk, turn: [0.0; 3] };
        assert_eq!(on_a_face.counts(&wish), [3; 2], "on its face");
        let on_a_side = Rest { solid: &flat, height: -sunk, turn: [0.0; 3] };
        assert_eq!(on_a_side.counts(&wish), [4; 2], "a flat one");
    }
}

#[test]
fn equal_boxes_touch_corner_to_corner() {
    let solid = Cuboid::new(Vector::<f32, 3>::new(0.5, 0.5, 0.5));
    let rest = Rest { solid: &solid, height: 0.5, turn: [0.0; 3] };
    let raw = rest.on(&solid, 0.5, &request(0.0, 0.0));
    assert_eq!(raw.points.len(), 4, "{raw:?}");
    for point in &raw.points {
        let (FeatureId::Vertex(low), FeatureId::Vertex(high)) = (point.feature1, point.feature2)
        else {
            panic!("a corner on a corner: {point:?}")
        };
        assert_eq!(low | 2, high, "the corner above has the other sign on y");
        assert_eq!(point.distance, 0.0, "touching");
    }
}

#[test]
fn crossed_boxes_touch_where_their_edges_cross() {
    let plank = Cuboid::new(Vector::<f64, 3>::new(2.0, 0.25, 0.5));
    let pose12 = f64::pose(Vector::<f64, 3>::new(0.0, 0.5, 0.0), [0.0, 1.0, 0.0]);
    let pair = Pair { first: plank.geometry().0, second: plank.geometry().0, pose12 };
    let (separation, raw) = manifold(&pair, &request(0.0, 0.0));
    assert!((separation.normal.y - 1.0).abs() < 1e-12, "{separation:?}");
    assert_eq!(raw.points.len(), 4, "{raw:?}");
    for point in &raw.points {
        let features = (point.feature1, point.feature2);
        assert!(matches!(features, (FeatureId::Edge(_), FeatureId::Edge(_))), "{point:?}");
        assert!((point.point1.z.abs() - 0.5).abs() < 1e-12, "on a long edge of the lower");
        let other = pair.pose12.inverse_point(&point.point1);
        assert!((other.z.abs() - 0.5).abs() < 1e-12, "on a long edge of the upper");
    }
}

#[test]
fn capsules_that_the_angle_makes_parallel_touch_twice() {
    let capsule = Capsule::<f64, 3>::new(1.0, 0.25);
    for (angle, sine, expected) in [(0.05, 0.09, 2), (0.05, 0.0, 1), (0.5, 0.09, 1), (0.0, 0.0, 2)]
    {
        let pose12 = f64::pose(Vector::<f64, 3>::new(0.5, 0.25, 0.0), [angle, 0.0, 0.0]);
        let pair = Pair { first: capsule.geometry().0, second: capsule.geometry().0, pose12 };
        let (_, raw) = manifold(&pair, &request(1e-3, sine));
        assert_eq!(raw.points.len(), expected, "{angle} within {sine}: {raw:?}");
    }
}

#[test]
fn an_octagon_keeps_its_deepest_point_and_a_wide_area() {
    let solid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
    let pose12 = f64::pose(Vector::<f64, 3>::new(0.0, 0.99, 0.0), [1e-3, 0.7, 2e-3]);
    let pair = Pair { first: solid.geometry().0, second: solid.geometry().0, pose12 };
    let mut wish = request(0.1, 0.0);
    wish.max_points = 16;
    let (separation, all) = manifold(&pair, &wish);
    assert_eq!(all.points.len(), 8, "two squares across: {all:?}");
    wish.max_points = 4;
    let (_, few) = manifold(&pair, &wish);
    assert_eq!(few.points.len(), 4, "reduced");
    assert_eq!(few.points[few.deepest()].distance, separation.distance, "the deepest is kept");
    assert!(area(&few) > 0.6 * area(&all), "{} of {}", area(&few), area(&all));
}

/// Returns the area of points in convex position around the y axis, projected along that axis.
fn area(raw: &RawManifold<f64, 3>) -> f64 {
    let mut points: Vec<Point<f64, 3>> = raw.points.iter().map(|point| point.point1).collect();
    points.sort_by(|a, b| a.z.atan2(a.x).total_cmp(&b.z.atan2(b.x)));
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| (a.x * b.z - a.z * b.x) / 2.0).sum()
}

#[test]
fn flat_and_empty_boxes_are_ordinary() {
    for extents in [[0.5, 0.0, 0.5], [0.5, 0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0]] {
        let solid = Cuboid::new(Vector::<f32, 3>::from(extents));
        let rest = Rest { solid: &solid, height: extents[1], turn: [0.0; 3] };
        let expected = 1 << (usize::from(extents[0] > 0.0) + usize::from(extents[2] > 0.0));
        let counts = rest.counts(&request(1e-6, 0.0));
        assert_eq!(counts, [expected; 2], "{extents:?}");
    }
}

#[test]
fn the_fact_is_the_one_assumed() {
    let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0));
    let plane = Plane::new(Unit::new_normalize(Vector::<f64, 2>::new(0.0, 1.0)));
    let pose12 = f64::pose(Vector::<f64, 2>::new(0.0, -1.5), [0.0; 3]);
    let pair = Pair { first: cuboid.geometry().0, second: plane.geometry().0, pose12 };
    let separation = fact(&pair);
    assert_eq!(separation.distance, 0.5, "half a unit above the half-plane");
    assert_eq!(separation.normal, Vector::<f64, 2>::new(0.0, -1.0), "down to the half-plane");
}

#[test]
fn half_spaces_back_to_back_touch_in_one_point() {
    let plane = Plane::new(Unit::new_normalize(Vector::<f64, 3>::new(0.0, 1.0, 0.0)));
    let pose12 = f64::pose(Vector::<f64, 3>::new(0.0, -0.5, 0.0), [0.0, 0.0, std::f64::consts::PI]);
    let pair = Pair { first: plane.geometry().0, second: plane.geometry().0, pose12 };
    let (normal, point1) = (Vector::<f64, 3>::new(0.0, 1.0, 0.0), Point::<f64, 3>::origin());
    let mut separation =
        Separation { distance: -0.5, normal, point1, point2: point1 - normal * 0.5 };
    let mut raw = RawManifold::default();
    f64::build(&pair, &separation, &request(0.0, 0.0), &mut raw);
    assert_eq!(raw.points.len(), 1, "{raw:?}");
    assert_eq!(raw.points[0].distance, -0.5, "a finite depth");
    separation.distance = -f64::INFINITY;
    f64::build(&pair, &separation, &request(0.0, 0.0), &mut raw);
    assert!(raw.points.is_empty(), "no contact where the overlap has no bound");
}

/// Returns a prism with regular polygons of twenty sides as ends, of radius 1, from y = 0 to y = 1.
fn prism() -> ConvexHull<f32> {
    let angles = (0_u8..20).map(|i| f64::from(i) * std::f64::consts::TAU / 20.0);
    let points: Vec<Point<f32, 3>> = angles
        .flat_map(|angle| {
            let (sine, cosine) = angle.sine_cosine();
            [0.0, 1.0].map(|y| Point::from(Vector::<f64, 3>::new(cosine, y, sine).map(f32::lit)))
        })
        .collect();
    ConvexHull::from_points(&points)
}

#[test]
fn a_prism_of_many_sides_stands_on_four_points() {
    let solid = prism();
    let standing = Rest { solid: &solid, height: 0.0, turn: [0.0; 3] };
    assert_eq!(standing.counts(&request(1e-5, 0.0)), [4; 2], "few of twenty");
    let mut wish = request(1e-5, 0.0);
    wish.max_points = 32;
    assert_eq!(standing.counts(&wish), [20; 2], "all of them, if requested");
}

/// A hull whose bottom is a flat V, with the ridge nearest to the half-space: asserts that vertices
/// of both faces are contacts if they are within the prediction, or may come within it by rotation.
#[test]
fn near_vertices_of_several_faces_count_above_a_half_space() {
    let corners = [[-1.0, 0.01, 0.0], [1.0, 0.01, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
    let mut points: Vec<_> = corners.map(|c| Point::from(Vector::<f32, 3>::from(c))).to_vec();
    points.push(Point::<f32, 3>::new(0.0, 1.0, 0.0));
    let solid = ConvexHull::from_points(&points);
    let plane = Plane::new(Unit::new_normalize(Vector::<f32, 3>::new(0.0, 1.0, 0.0)));
    let rest = Rest { solid: &solid, height: 0.0, turn: [0.0; 3] };
    assert_eq!(rest.on(&plane, 0.0, &request(0.02, 0.0)).points.len(), 4, "both faces");
    assert_eq!(rest.on(&plane, 0.0, &request(0.005, 0.0)).points.len(), 2, "the ridge");
    assert_eq!(rest.on(&plane, 0.0, &request(0.0, 0.05)).points.len(), 4, "by the angle");
}
