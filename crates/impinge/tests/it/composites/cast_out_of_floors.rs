//! Tests that a solid that has sunk a little into a floor of many parts can be cast out of the
//! floor, whatever is below the surface.

use crate::support::samples::stride;
use crate::support::{query_support, slides};

use impinge::math::na::{Translation3, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::{ImpactOptions, ImpactStatus, Moving, impact};
use impinge::shape::{
    Ball, Capsule, ConvexPolygon, Cuboid, HeightField, Polyline, Segment, Shape, ShapeHandle,
    TriMesh, Triangle,
};
use impinge::world::{CollisionGroups, CollisionWorld, QueryFilter};
use query_support::random::Random;
use slides::{PATTERNS, field, grid, lowest, solids3};

fn v<N: Real>(x: f64, y: f64, z: f64) -> Vector<N, 3> {
    Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

/// Directions out of the floor: steep, oblique and almost parallel to it.
const OUT: [[f64; 3]; 4] = [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [-0.7, 0.2, 0.9], [3.0, 0.05, -2.0]];
/// Directions into the floor.
const INTO: [[f64; 3]; 3] = [[0.0, -1.0, 0.0], [2.0, -0.1, 1.0], [-0.3, -0.4, 0.2]];

/// Asserts that every solid can be cast out of a floor at y = 0 without a hit, and hits it when
/// cast into it. By default every ninth round is tested. The first round differs from solid to
/// solid and from seed to seed, so each depth and each kind of rotation occurs.
fn leave<N: Space<3, Isometry = Isometry3<N>>>(floor: &dyn Shape<N, 3>, label: &str, seed: u64) {
    let random = &mut Random(seed, false);
    let still = Moving::still(&Isometry3::identity(), floor);
    for (index, (name, solid)) in solids3::<N>().into_iter().enumerate() {
        for round in 0..12 {
            let turn = match round % 3 {
                0 => UnitQuaternion::identity(),
                1 => UnitQuaternion::new(v(0.0, random.signed(), 0.0)),
                _ => random.turn3(),
            };
            let depth = [0.001, 0.02, 0.1, 0.05][round / 3];
            let turned = Isometry3::from_parts(Translation3::identity(), turn);
            let height = N::lit(-depth) - lowest(&*solid, &turned);
            let at = v::<N>(random.within(-2.0, 2.0), 0.0, random.within(-2.0, 2.0));
            let number = seed + (index + round) as u64;
            if !number.is_multiple_of(stride(9) as u64) {
                continue;
            }
            let pose = Isometry3::from_parts(Translation3::new(at.x, height, at.z), turn);
            let cast = |way: [f64; 3], at_start: bool| {
                let options = ImpactOptions::new().with_contact_at_start(at_start);
                let velocity = v(way[0], way[1], way[2]);
                impact(&still, &Moving::new(&pose, &velocity, &*solid), &options)
            };
            let what = format!("{label}: {name} sunk by {depth} at {pose:?}");
            for way in OUT {
                assert_eq!(cast(way, false), None, "{what} leaves along {way:?}");
            }
            for (way, at_start) in
                INTO.map(|way| (way, false)).into_iter().chain(OUT.map(|way| (way, true)))
            {
                let hit = cast(way, at_start).unwrap_or_else(|| panic!("{what} along {way:?}"));
                assert_eq!(hit.toi, N::ZERO, "{what}");
                assert_eq!(hit.status, ImpactStatus::PenetratingAtStart, "{what}");
                assert!(hit.normal.y > N::lit(1.0 - 1e-5), "{what}: {:?}", hit.normal);
                // The distance between both points is the depth up to 1 %: clipping at an inner
                // edge may omit the deepest vertex, which is beyond that edge.
                let reach = (hit.world2 - hit.world1).norm().as_f64();
                assert!((reach - depth).abs() < 0.01 * depth + 1e-5, "{what}: {reach} deep");
            }
        }
    }
}

#[test]
fn solids_leave_meshes() {
    for (seed, pattern) in (0..).zip(PATTERNS) {
        let label = format!("{pattern:?}");
        leave::<f32>(&grid::<f32>(10, 1.0, [0.0; 3], pattern, |_, _| 0.0), &label, seed);
        leave::<f64>(&grid::<f64>(10, 1.0, [0.0; 3], pattern, |_, _| 0.0), &label, seed);
    }
    let fine = grid::<f64>(24, 0.35, [0.0; 3], PATTERNS[3], |_, _| 0.0);
    leave::<f64>(&fine, "fine", 9);
}

#[test]
fn solids_leave_height_fields() {
    leave::<f32>(&field::<f32>(16, 0.5), "field", 7);
    leave::<f64>(&field::<f64>(16, 0.5), "field", 8);
}

/// Casts solids that have sunk into a floor in 2D: first with the numbers of a bug report, then at
/// random positions. Asserts that they leave the floor without an impact, and that casts into the
/// floor hit it at once, with a normal up to rounding.
fn leave_line<N: Space<2, Isometry = Isometry2<N>>>(floor: &dyn Shape<N, 2>) {
    let w = |x: f64, y: f64| Vector::<N, 2>::new(N::lit(x), N::lit(y));
    let still = Moving::still(&Isometry2::identity(), floor);
    let random = &mut Random(31, false);
    let cuboid = Cuboid::new(w(0.5, 0.5));
    let ball = Ball::new(N::HALF);
    for round in 0..200 {
        let solid: &dyn Shape<N, 2> = if round % 2 == 0 { &cuboid } else { &ball };
        let depth = [0.02, 0.001, 0.1][round % 3];
        let x = if round == 0 { 0.0 } else { random.within(-3.0, 3.0) };
        let pose = Isometry2::new(w(x, 0.5 - depth), N::ZERO);
        let cast = |x: f64, y: f64, at_start: bool| {
            let options = ImpactOptions::new().with_contact_at_start(at_start);
            impact(&still, &Moving::new(&pose, &w(x, y), solid), &options)
        };
        for (x, y) in [(0.0, 1.0), (1.0, 0.5), (-3.0, 0.1)] {
            assert_eq!(cast(x, y, false), None, "along {x} {y} from {pose:?}");
            let hit = cast(x, y, true).expect("in contact at the start");
            assert!(hit.toi == N::ZERO && hit.normal.y > N::lit(0.99999), "{hit:?}");
        }
        let hit = cast(0.3, -0.1, false).expect("into the floor");
        assert!(hit.toi == N::ZERO && hit.normal.y > N::lit(0.99999), "{hit:?}");
    }
}

#[test]
fn solids_leave_lines() {
    fn check<N: Space<2, Isometry = Isometry2<N>>>() {
        let p = |x: f64| Point::<N, 2>::new(N::lit(x), N::ZERO);
        leave_line::<N>(&Polyline::<N, 2>::open([-5.0, 0.49, 5.0].map(p).to_vec()));
        leave_line::<N>(&Polyline::<N, 2>::open([5.0, 0.7, 0.6, 0.1, -1.0, -5.0].map(p).to_vec()));
        let scale = Vector::<N, 2>::new(N::lit(10.0), N::ONE);
        leave_line::<N>(&HeightField::<N, 2>::new(vec![N::ZERO; 21], scale));
    }
    check::<f32>();
    check::<f64>();
}

/// Asserts that a body that leaves the floor still hits the wall, even a wall that it touches at
/// the start.
#[test]
fn what_leaves_the_floor_meets_the_wall() {
    let p = |x: f64, y: f64| Point::<f64, 2>::new(x, y);
    let room = Polyline::<f64, 2>::open(vec![p(-5.0, 0.0), p(0.4, 0.0), p(3.0, 0.0), p(3.0, 9.0)]);
    let still = Moving::still(&Isometry2::identity(), &room);
    let cuboid = Cuboid::new(Vector::<f64, 2>::new(0.5, 0.5));
    let cast = |x: f64, way: [f64; 2]| {
        let pose = Isometry2::translation(x, 0.48);
        impact(&still, &Moving::new(&pose, &way.into(), &cuboid), &ImpactOptions::new())
    };
    let hit = cast(0.5, [1.0, 0.25]).expect("the wall");
    assert_eq!((hit.toi, hit.normal.x, hit.status), (2.0, -1.0, ImpactStatus::Reached));
    let hit = cast(2.5, [1.0, 0.25]).expect("the wall, from the start");
    assert_eq!((hit.toi, hit.normal.x, hit.status), (0.0, -1.0, ImpactStatus::TouchingAtStart));
    assert_eq!(cast(2.5, [-1.0, 0.25]), None, "away from both");
    let hit = cast(2.51, [0.0, 1.0]).expect("sunk into the wall it slides along");
    assert_eq!((hit.toi, hit.normal.x), (0.0, -1.0));
}

/// Slopes of ramps: steeper and gentler than 1/1024, the least difference of two normals at which
/// contacts are in two manifolds.
const SLOPES: [f64; 4] = [0.01, 0.002, 0.0005, -0.0005];

/// Asserts that a solid that slides along x over a floor hits the `ramp` at the time `expected` if
/// it rises. The floor ends and the ramp begins at x = 10.
fn slides_to_ramp<N: Space<D>, R, const D: usize>(
    ramp: (&Isometry<N, R, D>, &dyn Shape<N, D>),
    solid: (&Isometry<N, R, D>, &dyn Shape<N, D>),
    slope: f64,
    expected: f64,
) where
    R: AbstractRotation<N, D>,
{
    let mut velocity = Vector::<N, D>::zeros();
    velocity[0] = N::ONE;
    let (still, moving) = (Moving::still(ramp.0, ramp.1), Moving::new(solid.0, &velocity, solid.1));
    let found = impact(&still, &moving, &ImpactOptions::new());
    let what = format!("{:?} on {:?}, slope {slope}: {found:?}", solid.1, ramp.1);
    assert_eq!(found.is_some(), slope > 0.0, "{what}");
    if let Some(hit) = found {
        assert!((hit.toi.as_f64() - expected).abs() < 1e-3, "{what}");
        assert!((hit.normal[0].as_f64() + slope).abs() < 0.01 * slope, "{what}");
    }
}

/// A solid whose lowest point is at y = -0.5, the time at which this point reaches the ramp, and its
/// radius there: a round solid touches the ramp a little earlier.
type Slider<'a, N, const D: usize> = (&'a dyn Shape<N, D>, f64, f64);

fn over_lines<N: Space<2, Isometry = Isometry2<N>>>((solid, time, radius): Slider<'_, N, 2>) {
    let w = |x: f64, y: f64| Vector::<N, 2>::new(N::lit(x), N::lit(y));
    let [here, middle, at] =
        [(0.0, 0.0), (10.0, 0.0), (8.0, 0.5)].map(|(x, y)| Isometry2::new(w(x, y), N::ZERO));
    for slope in SLOPES {
        let points = [(0.0, 0.0), (10.0, 0.0), (20.0, 10.0 * slope)];
        let line = Polyline::open(points.map(|(x, y)| Point::from(w(x, y))).to_vec());
        let heights = points.map(|(_, y)| N::lit(y)).to_vec();
        let field = HeightField::<N, 2>::new(heights, w(20.0, 1.0));
        let expected = time - radius * (slope.atan() / 2.0).tan();
        slides_to_ramp((&here, &line), (&at, solid), slope, expected);
        slides_to_ramp((&middle, &field), (&at, solid), slope, expected);
    }
}

fn over_triangles<N: Space<3, Isometry = Isometry3<N>>>((solid, time, radius): Slider<'_, N, 3>) {
    let [here, at] =
        [v(0.0, 0.0, 0.0), v(8.0, 0.5, 0.3)].map(|at| Isometry3::new(at, v(0.0, 0.0, 0.0)));
    for slope in SLOPES {
        let row = |(x, y): (f64, f64)| [-5.0, 5.0].map(|z| Point::from(v::<N>(x, y, z)));
        let corners = [(0.0, 0.0), (10.0, 0.0), (20.0, 10.0 * slope)].map(row).concat();
        let faces = vec![[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]];
        let mesh = TriMesh::<N, 3>::new(corners, faces);
        let expected = time - radius * (slope.atan() / 2.0).tan();
        slides_to_ramp((&here, &mesh), (&at, solid), slope, expected);
    }
}

fn sharp_solids_meet_ramps<N>()
where
    N: Space<2, Isometry = Isometry2<N>> + Space<3, Isometry = Isometry3<N>>,
{
    let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x), N::lit(y));
    let [a, b, c, d] = [p(-0.5, -0.5), p(0.5, -0.5), p(0.5, 0.5), p(-0.5, 0.5)];
    let square = ConvexPolygon::try_from_points(&[a, b, c, d]).expect("a square");
    over_lines((&Cuboid::new(Vector::<N, 2>::repeat(N::HALF)), 1.5, 0.0));
    over_lines((&Triangle::new(a, b, c), 1.5, 0.0));
    over_lines((&Segment::new(b, d), 1.5, 0.0));
    over_lines((&square, 1.5, 0.0));
    over_triangles((&Cuboid::new(Vector::<N, 3>::repeat(N::HALF)), 1.5, 0.0));
}

/// Asserts that a solid that slides over a floor hits a ramp, however gentle it is. In `f32` rounding
/// hides a ramp of slope 0.002 from a round solid that touches the end of the floor.
#[test]
fn what_slides_over_the_floor_meets_a_gentle_ramp() {
    sharp_solids_meet_ramps::<f32>();
    sharp_solids_meet_ramps::<f64>();
    over_lines::<f64>((&Ball::new(0.5), 2.0, 0.5));
    over_lines::<f64>((&Capsule::<f64, 2>::new(0.25, 0.25), 2.0, 0.25));
    over_triangles::<f64>((&Ball::new(0.5), 2.0, 0.5));
}

/// Asserts that solids cast in a world leave the floor without a hit, and hit it at time zero if
/// they are cast into it.
#[test]
fn worlds_cast_out_of_floors() {
    let mut world = CollisionWorld::<f32, 3, ()>::new(0.02);
    let floor = ShapeHandle::new(grid::<f32>(16, 1.0, [0.0; 3], PATTERNS[0], |_, _| 0.0));
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    world.add(Isometry3::identity(), floor, CollisionGroups::new(), query, ());
    world.update();
    let cuboid = Cuboid::new(v::<f32>(0.5, 0.5, 0.5));
    let random = &mut Random(32, false);
    for round in 0..200 {
        let depth = [0.001, 0.02, 0.1][round % 3];
        let at = v::<f32>(random.within(-4.0, 4.0), 0.5 - depth, random.within(-4.0, 4.0));
        let pose = Isometry3::new(at, v(0.0, random.signed(), 0.0));
        let cast = |way: [f64; 3]| {
            let (options, filter) = (ImpactOptions::new(), QueryFilter::new());
            world.cast_shape(&pose, &v(way[0], way[1], way[2]), &cuboid, &options, &filter)
        };
        for way in OUT {
            assert!(cast(way).is_none(), "held at {pose:?} along {way:?}");
        }
        assert!(cast(INTO[0]).is_some_and(|(_, hit)| hit.toi == 0.0), "the floor holds");
    }
}
