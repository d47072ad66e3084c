//! Compares parts, paths and searches of nested compounds with flat lists.

use crate::support::part_search;
use crate::support::query_support;
use crate::support::samples::samples;

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::dim2::shape::Compound as Compound2;
use impinge::dim3::shape::Compound as Compound3;
use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{
    AbstractRotation, Isometry, Isometry2, Isometry3, Point, Pose, Real, Space, Unit, Vector,
};
use impinge::query::{ClosestPoints, Proximity, closest_points, contact, distance, proximity};
use impinge::shape::{
    Ball, Capsule, CompositeShape, Compound, Cuboid, FeatureId, HeightField, PartPath, Plane,
    Segment, Shape, ShapeError, ShapeHandle, Triangle,
};
use impinge_reference::random::Random;
use part_search::{Boxes, check_points, coarse_vector};
use query_support::random::Random as Poses;

type Child<N> = (Isometry3<N>, ShapeHandle<N, 3>);

fn position<N: Real>(random: &mut Poses, reach: f64) -> Isometry3<N> {
    let at: Vector<N, 3> = random.vector::<N, 3>() * N::lit(reach);
    Isometry3::from_parts(at.into(), random.turn3())
}

fn hills<N: Real>(seed: u64) -> HeightField<N, 3> {
    let mut random = Random::new(seed);
    let heights = (0..20).map(|_| N::lit(part_search::coarse(&mut random))).collect();
    HeightField::<N, 3>::new(4, 5, heights, Vector::<N, 3>::new(N::TWO, N::ONE, N::TWO))
}

/// Returns convex solids, a height field, and compounds of such children up to a nesting depth.
fn children<N: Real>(random: &mut Poses, depth: usize) -> Vec<Child<N>> {
    let [a, b, c] = [0, 1, 2].map(|_| Point::from(random.vector::<N, 3>()));
    let mut children: Vec<Child<N>> = vec![
        (position(random, 4.0), ShapeHandle::new(Ball::new(N::HALF))),
        (position(random, 4.0), ShapeHandle::new(Triangle::new(a, b, c))),
        (position(random, 4.0), ShapeHandle::new(hills::<N>(depth as u64))),
        (position(random, 4.0), ShapeHandle::new(Cuboid::new(random.vector::<N, 3>().abs()))),
    ];
    if depth > 0 {
        for _ in 0..2 {
            let inner = Compound3::<N>::new(self::children(random, depth - 1));
            children.insert(1, (position(random, 6.0), ShapeHandle::new(inner)));
        }
    }
    children
}

/// Returns the solids of all children with their poses and paths.
fn flattened<N: Real>(
    children: &[Child<N>],
    outer: &Isometry3<N>,
    path: &[u32],
) -> Vec<(Isometry3<N>, ShapeHandle<N, 3>, Vec<u32>)> {
    let mut list = Vec::new();
    for (index, (position, shape)) in (0_u32..).zip(children) {
        let (placed, path) = (outer * position, [path, &[index]].concat());
        if let Some(compound) = shape.as_shape::<Compound3<N>>() {
            list.extend(flattened(compound.children(), &placed, &path));
        } else if let Some(field) = shape.as_shape::<HeightField<N, 3>>() {
            for part in 0..field.num_parts() {
                let triangle =
                    *field.part(part).solid.as_shape().as_shape::<Triangle<N, 3>>().expect("one");
                list.push((placed, ShapeHandle::new(triangle), [&path[..], &[part]].concat()));
            }
        } else {
            list.push((placed, shape.clone(), path));
        }
    }
    list
}

fn check_parts<N: Real>() {
    let mut random = Poses(31, false);
    let children = children::<N>(&mut random, 2);
    let list = flattened(&children, &Isometry3::identity(), &[]);
    let compound = Compound3::<N>::new(children);
    assert_eq!(compound.num_parts() as usize, list.len(), "as many");
    assert!(list.len() > 100 && list.iter().any(|(_, _, path)| path.len() == 4), "and deep");
    for (number, (position, shape, path)) in (0..).zip(&list) {
        let part = compound.part(number);
        let found = (&compound as &dyn Shape<N, 3>).path_to_part(number);
        assert_eq!(found.as_slice(), path.as_slice(), "the way to part {number}");
        let own = part.solid.as_shape();
        assert_eq!(own.geometry().kind(), shape.geometry().kind(), "part {number}");
        for _ in 0..3 {
            let direction = random.direction::<N, 3>();
            let local = shape.geometry().as_support_map().expect("convex").core_support(&direction);
            let same = own.geometry().as_support_map().expect("convex").core_support(&direction);
            let apart = (part.pose.point(&same) - position * local).norm();
            assert!(apart <= N::lit(200.0) * N::EPSILON, "part {number} is off by {apart}");
        }
    }
}

#[test]
fn parts_are_those_of_the_children_in_a_row() {
    check_parts::<f32>();
    check_parts::<f64>();
}

/// Returns the centre and three support points of each part, with the index of the part, in the
/// frame of the compound.
fn points_of<N: Real>(compound: &Compound3<N>, random: &mut Poses) -> Vec<(u32, Point<N, 3>)> {
    let mut points = Vec::new();
    for number in 0..compound.num_parts() {
        let part = compound.part(number);
        let geometry = part.solid.geometry();
        let map = geometry.as_support_map().expect("convex");
        points.push((number, part.pose.point(&map.center())));
        for _ in 0..3 {
            let farthest = map.support_point(&random.direction::<N, 3>());
            points.push((number, part.pose.point(&farthest)));
        }
    }
    points
}

fn check_searches<N: Real>(away: f64) {
    let mut random = Poses(32, false);
    let mut hits = 0;
    for depth in [0, 1, 2] {
        let mut children = children::<N>(&mut random, depth);
        for (position, _) in &mut children {
            position.translation.vector += Vector::<N, 3>::repeat(N::lit(away));
        }
        let compound = Compound3::<N>::new(children);
        let points = points_of(&compound, &mut random);
        hits += check_points(compound.search(), &points, &mut Random::new(5), 60);
        let (around, sphere) = (compound.local_aabb(), compound.local_bounding_sphere());
        let slack = N::lit(8.0 * away) * N::EPSILON;
        for (part, point) in &points {
            assert!(around.loosened(slack).contains_point(point), "part {part} leaves the box");
            assert!(sphere.loosened(slack).contains_point(point), "part {part} leaves the sphere");
        }
    }
    assert!(hits > 100, "{hits} points were in probes");
}

#[test]
fn searches_of_nested_compounds_miss_nothing() {
    check_searches::<f32>(0.0);
    check_searches::<f64>(0.0);
    check_searches::<f64>(1e6);
}

/// Asserts that a search of a compound finds exactly the children that a scan of all children
/// finds, if no child is a composite.
#[test]
fn searches_of_flat_compounds_find_what_looking_at_all_children_finds() {
    let mut random = Random::new(33);
    for count in [1, 2, 20, 300] {
        let child = |_| {
            let at = coarse_vector::<f64, 2>(&mut random) * 9.0;
            (
                Isometry2::translation(at.x, at.y),
                ShapeHandle::new(Cuboid::new(coarse_vector::<f64, 2>(&mut random).abs())),
            )
        };
        let compound = Compound2::<f64>::new((0..count).map(child).collect());
        let boxes = Boxes::new(&compound, |_| true);
        assert_eq!(compound.local_aabb(), boxes.around, "around all");
        for _ in 0..30 {
            let aabb = part_search::probe(&mut random, &boxes.around);
            let meets = boxes
                .of_parts
                .iter()
                .filter(|(_, own)| own.intersects(&aabb))
                .map(|(part, _)| *part);
            assert_eq!(
                part_search::overlapping(compound.search(), &aabb),
                meets.collect::<Vec<_>>(),
                "{aabb:?}"
            );
        }
    }
}

#[test]
fn bad_children_are_refused() {
    let ball = ShapeHandle::new(Ball::new(1.0_f32));
    let none: Vec<(Isometry2<f32>, ShapeHandle<f32, 2>)> = Vec::new();
    assert_eq!(Compound2::try_new(none).expect_err("empty"), ShapeError::NoChildren, "none");
    let nowhere = Isometry2::translation(f32::NAN, 0.0);
    let error = Compound2::try_new(vec![(Isometry2::identity(), ball.clone()), (nowhere, ball)]);
    let error = error.expect_err("NaN");
    assert_eq!(error, ShapeError::ChildPoseNotFinite { index: 1 }, "named");
    assert_eq!(error.to_string(), "the position of child 1 is not finite", "in words");
    // A line of two cells, doubled 30 times, gives 2^31 parts. Doubled again, it exceeds the limit
    // of indices.
    let line =
        ShapeHandle::new(HeightField::<f32, 2>::new(vec![0.0; 3], Vector::<f32, 2>::new(1.0, 1.0)));
    let mut nested = Compound2::<f32>::new(vec![(Isometry2::identity(), line)]);
    for _ in 0..30 {
        let shared = ShapeHandle::new(nested);
        nested = Compound2::new(vec![
            (Isometry2::identity(), shared.clone()),
            (Isometry2::identity(), shared),
        ]);
    }
    assert_eq!(nested.num_parts(), 1 << 31, "doubled thirty times");
    let shared = ShapeHandle::new(nested);
    let twice = vec![(Isometry2::identity(), shared.clone()), (Isometry2::identity(), shared)];
    let error = Compound2::try_new(twice).expect_err("too many");
    assert_eq!(error, ShapeError::TooManyParts { needed: 1 << 32 }, "as many");
}

#[test]
fn unbounded_children_are_found_everywhere() {
    let up = Unit::new_unchecked(Vector::<f64, 2>::new(0.0, 1.0));
    let tilted = Isometry2::new(Vector::<f64, 2>::new(0.0, -5.0), 0.3);
    let compound = Compound2::new(vec![
        (Isometry2::translation(10.0, 3.0), ShapeHandle::new(Ball::new(1.0))),
        (tilted, ShapeHandle::new(Plane::new(up))),
    ]);
    let point = |x, y| Aabb::new(Point::<f64, 2>::new(x, y), Point::<f64, 2>::new(x, y));
    assert_eq!(part_search::overlapping(compound.search(), &point(10.0, 3.0)), [0, 1], "both");
    assert_eq!(part_search::overlapping(compound.search(), &point(-1e9, -40.0)), [1], "far away");
    assert_eq!(compound.local_aabb(), Aabb::unbounded(), "the box of all");
    assert!(compound.local_bounding_sphere().radius().is_infinite(), "the sphere of all");
    assert_eq!(compound.aabb(&Pose::identity()), Aabb::unbounded(), "placed");
}

/// Asserts that the box of a rotated compound is the union of the boxes of its rotated children,
/// which is smaller than the box around its rotated local box.
#[test]
fn placed_boxes_are_tight() {
    let capsule = ShapeHandle::new(Capsule::<f64, 2>::new(2.0, 0.5));
    let compound = Compound2::new(vec![
        (Isometry2::translation(3.0, 0.0), capsule.clone()),
        (Isometry2::translation(-3.0, 0.0), capsule),
    ]);
    let quarter = Isometry2::rotation(std::f64::consts::FRAC_PI_4);
    let aabb = compound.aabb(&Pose::from_isometry(&quarter));
    let reach = (3.0 + 2.0) * std::f64::consts::FRAC_1_SQRT_2 + 0.5;
    assert!((aabb.maxs() - Point::<f64, 2>::new(reach, reach)).norm() < 1e-12, "{aabb:?}");
}

#[test]
fn surfaces_and_neighbours_are_those_of_the_child() {
    let floor =
        HeightField::<f64, 3>::new(2, 3, vec![0.0; 6], Vector::<f64, 3>::new(4.0, 1.0, 2.0))
            .one_sided();
    let turned = Isometry3::rotation(Vector::<f64, 3>::new(0.0, 0.0, std::f64::consts::PI));
    let ball = ShapeHandle::new(Ball::new(1.0));
    let only_balls = Compound3::<f64>::new(vec![(turned, ball.clone())]);
    assert!(only_balls.surface().is_none(), "no child has one");
    let floor = ShapeHandle::new(floor);
    let compound = Compound3::new(vec![(turned, ball), (turned, floor.clone()), (turned, floor)]);
    let surface = compound.surface().expect("of the floors");

    let (down, oblique) = (-Vector::<f64, 3>::y(), Vector::<f64, 3>::new(0.6, -0.8, 0.0));
    for part in 1..9 {
        assert!(surface.admits(part, FeatureId::Face(0), &down), "the front is down now");
        assert!(!surface.admits(part, FeatureId::Face(1), &-down), "it has no back");
        let snapped = surface.snapped(part, &oblique).expect("a face");
        assert!((snapped - down).norm() < 1e-15, "{snapped}");
        assert!(surface.faces(part, &Point::<f64, 3>::new(0.0, -1.0, 0.0)), "in front");
        assert!(!surface.faces(part, &Point::<f64, 3>::new(0.0, 1.0, 0.0)), "behind");
    }
    assert!(surface.admits(0, FeatureId::Face(0), &oblique), "a ball has all normals");
    assert_eq!(surface.snapped(0, &oblique), None, "and none stands for another");
    assert!(compound.are_adjacent(1, 2) && !compound.are_adjacent(1, 5), "within one floor only");
    assert!(!compound.are_adjacent(0, 1), "a ball hangs on nothing");
    let mut path = PartPath::new();
    compound.extend_path(6, &mut path);
    assert_eq!(path.as_slice(), [2, 1], "the second part of the second floor");
    assert_eq!(compound.child_of_part(6), (2, 1), "the same");
}

/// Returns a solid and one of its corners; for a ball, a point of its surface. Coordinates are
/// multiples of 1 or of 1/1024.
fn cornered<N: Real, const D: usize>(random: &mut Poses) -> (ShapeHandle<N, D>, Vector<N, D>) {
    let grid = N::lit([1.0, 1.0 / 1024.0][usize::from(random.bits() & 1 == 0)]);
    let mut corner = || random.vector::<N, D>().map(|x| (x * N::lit(4.0) / grid).round() * grid);
    let (a, b) = (corner(), corner());
    let axis = Vector::<N, D>::from_fn(|row, _| if row == 0 { N::ONE } else { N::ZERO });
    match random.bits() % 4 {
        0 => (ShapeHandle::new(Segment::new(Point::from(a), Point::from(b))), a),
        1 => (ShapeHandle::new(Triangle::new(Point::from(b), Point::from(a), Point::origin())), a),
        2 => (ShapeHandle::new(Ball::new(a[0].abs())), axis * a[0]),
        _ => (ShapeHandle::new(Cuboid::new(a.abs())), a),
    }
}

/// Returns a compound of one rotated child, nested in `depth` further compounds, such that a corner
/// of the child is at the origin up to rounding.
fn with_corner_at_origin<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    random: &mut Poses,
    turn: fn(&mut Poses) -> R,
    depth: usize,
) -> ShapeHandle<N, D> {
    let (shape, corner) = cornered::<N, D>(random);
    let rotation = turn(random);
    let at = -rotation.transform_vector(&corner);
    let pose = Pose::from_isometry(&Isometry::from_parts(at.into(), rotation));
    let inner = ShapeHandle::new(Compound::new(vec![(N::isometry(&pose), shape)]));
    (0..depth).fold(inner, |shape, _| {
        let at = random.vector::<N, D>() * N::lit(8.0);
        let there = Pose::from_isometry(&Isometry::from_parts(at.into(), turn(random)));
        let shape = ShapeHandle::new(Compound::new(vec![(N::isometry(&there), shape)]));
        ShapeHandle::new(Compound::new(vec![(N::isometry(&there.inverse()), shape)]))
    })
}

/// Asserts that a distance of zero, an intersection, and a contact occur together, in either order
/// of the shapes. Returns whether the shapes touch.
fn check_one_fact<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    g2: &dyn Shape<N, D>,
) -> bool {
    let touches = distance(m, g1, m, g2) == N::ZERO;
    for (g1, g2) in [(g1, g2), (g2, g1)] {
        let found = [
            distance(m, g1, m, g2) == N::ZERO,
            proximity(m, g1, m, g2, N::ZERO) == Proximity::Intersecting,
            closest_points(m, g1, m, g2, N::ZERO) == ClosestPoints::Intersecting,
            contact(m, g1, m, g2, N::ZERO).is_some(),
        ];
        let parts = [g1, g2].map(|g| g.geometry().as_composite().map(|all| all.part(0)));
        assert_eq!(found, [touches; 4], "{parts:?} at {:?}", Pose::from_isometry(m));
    }
    touches
}

fn check_corners<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    turn: fn(&mut Poses) -> R,
) {
    let random = &mut Poses(7, false);
    let (mut touching, rounds) = (0, samples(300));
    for round in 0..rounds {
        let compound = with_corner_at_origin(random, turn, round % 3);
        let at = random.vector::<N, D>() * N::lit([0.0, 4.0, 1e6][round / 3 % 3]);
        let m = Isometry::from_parts(at.into(), turn(random));
        let other: ShapeHandle<N, D> = match round / 9 % 3 {
            0 => ShapeHandle::new(Ball::new(N::ZERO)),
            1 => {
                let end = Point::from(random.vector::<N, D>());
                ShapeHandle::new(Segment::new(Point::origin(), end))
            }
            _ => with_corner_at_origin(random, turn, 0),
        };
        touching += usize::from(check_one_fact(&m, &*compound, &*other));
    }
    let some = rounds / 5..rounds * 9 / 10;
    assert!(some.contains(&touching), "{touching} of {rounds} touch");
}

/// Asserts that all queries agree on touching for a rotated child and another solid that have a
/// common corner, at the origin up to rounding.
#[test]
fn touching_a_turned_child_is_one_fact() {
    check_corners::<f32, _, 2>(quarter_or_any2);
    check_corners::<f64, _, 2>(quarter_or_any2);
    check_corners::<f32, _, 3>(quarter_or_any3);
    check_corners::<f64, _, 3>(quarter_or_any3);
}

fn quarter_or_any2<N: Real>(random: &mut Poses) -> UnitComplex<N> {
    match random.bits() % 4 {
        0 => UnitComplex::identity(),
        1 => UnitComplex::new(N::frac_pi_2()),
        _ => random.turn2(),
    }
}

fn quarter_or_any3<N: Real>(random: &mut Poses) -> UnitQuaternion<N> {
    match random.bits() % 4 {
        0 => UnitQuaternion::identity(),
        1 => UnitQuaternion::from_axis_angle(&Vector::<N, 3>::z_axis(), N::frac_pi_2()),
        _ => random.turn3(),
    }
}
