//! Tests `guide/coming-from.md`: asserts that each name in the impinge column of its tables occurs
//! in the code of this file, so that the name exists. Also asserts that the two READMEs have equal
//! programs.

use impinge::dim2;
use impinge::dim3;
use impinge::dim3::bounding_volume::{Aabb, aabb, bounding_sphere};
use impinge::dim3::broad_phase::{BroadPhase, DBVTBroadPhase};
use impinge::dim3::math::{Isometry, Point, Unit, Vector};
use impinge::dim3::na;
use impinge::dim3::narrow_phase::{
    ContactDispatcher, ContactManifoldGenerator, DefaultContactDispatcher, DefaultNarrowPhase,
    ProximityDetector,
};
use impinge::dim3::partitioning::BoxTree;
use impinge::dim3::procedural;
use impinge::dim3::query::{
    ConstantVelocities, Contact, ContactId, ContactManifold, ContactPrediction, ImpactOptions,
    ImpactStatus, MassProperties, Moving, PointQuery, Proximity, Ray, RayCast, RigidMotion,
    TrackedContact, closest_points, contact, contact_manifolds, distance, impact, mass_properties,
    mass_properties_with, nonlinear_time_of_impact, proximity, time_of_impact,
};
use impinge::dim3::shape::{
    Ball, Capsule, CompositeShape, Compound, Cone, ConvexHull, Cuboid, Cylinder, Diagonal,
    FeatureId, HeightField, Plane, Polyline, Rounded, Segment, Shape, ShapeHandle, Tetrahedron,
    TriMesh, Triangle,
};
use impinge::dim3::transformation;
use impinge::dim3::world::{
    BroadPhasePairFilter, CollisionGroups, CollisionObject, CollisionObjectHandle, CollisionWorld,
    GeometricQueryType, QueryFilter,
};

type World = CollisionWorld<f64, &'static str>;

/// A filter that accepts only pairs of objects whose data differ.
struct OtherNames;

impl BroadPhasePairFilter<f64, &'static str> for OtherNames {
    fn is_pair_valid(
        &self,
        a: &CollisionObject<f64, &'static str>,
        b: &CollisionObject<f64, &'static str>,
    ) -> bool {
        a.data() != b.data()
    }
}

fn at(x: f64) -> Isometry<f64> {
    Isometry::translation(x, 0.0, 0.0)
}

/// Returns a world of two balls that overlap by 0.5 (radius 1, centres 1.5 apart) and a sensor
/// around both, with the three handles.
fn world() -> (World, [CollisionObjectHandle; 3]) {
    let mut world = CollisionWorld::new(0.02);
    let ball = ShapeHandle::new(Ball::new(1.0));
    let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
    let left = world.add(at(0.0), ball.clone(), groups, contacts, "left");
    let right = world.add(at(1.5), ball, groups, contacts, "right");
    let area = ShapeHandle::new(Cuboid::new(Vector::repeat(4.0)));
    let sensor = world.add(at(0.0), area, groups, GeometricQueryType::Proximity(0.0), "sensor");
    (world, [left, right, sensor])
}

#[test]
fn the_world() {
    let (mut world, [left, right, sensor]) = world();
    world.update();
    assert_eq!((world.contact_events().len(), world.proximity_events().len()), (1, 2), "all begin");
    assert_eq!((world.contact_manifolds().count(), world.contact_pairs().count()), (1, 1), "one");
    let mut manifolds: Vec<&ContactManifold<f64>> = Vec::new();
    world.contact_pair(left, right).expect("a pair").contacts(&mut manifolds);
    let deepest: &TrackedContact<f64> = manifolds[0].deepest_contact().expect("one");
    assert_eq!(deepest.contact.depth, 0.5, "of both");
    assert_eq!(deepest.kinematic.contact(&at(0.0), &at(1.75)).depth, 0.25, "moved");
    let normals: Vec<_> = world.contacts_with(right).map(|(_, p)| p.contact.normal.x).collect();
    assert_eq!(normals, [-1.0], "away from the right one");
    assert_eq!(world.proximities_with(sensor).count(), 2, "both");
    world.set_positions(&[(left, at(-9.0)), (sensor, at(20.0))]);
    world.set_position(right, at(9.0));
    world.set_shape(right, ShapeHandle::new(Ball::new(2.0)));
    world.set_query_type(right, GeometricQueryType::Contacts(0.1, 0.0));
    world.set_collision_groups(right, CollisionGroups::new());
    world.deform(right, |ball: &mut Ball<f64>| *ball = Ball::new(1.0));
    *world.collision_object_mut(right).expect("there").data_mut() = "other";
    world.register_broad_phase_pair_filter("names", OtherNames);
    world.update();
    assert_eq!(world.contact_events().len(), 1, "it has stopped");
    assert_eq!(world.collision_object(right).map(|object| object.handle().uid()), Some(1), "named");
    world.set_fixed(sensor, true);
    world.set_skin(right, 0.5);
    world.set_position_with_prediction(right, at(9.0), at(20.0));
    assert_eq!(world.predicted_position(right), Some(&at(20.0)), "through the sensor");
    world.keep_events();
    world.update_with(&mut |_, _| true);
    assert_eq!(world.contact_events().len(), 1, "kept");
    assert!(world.pairs_with(right).map(CollisionObject::handle).eq([sensor]), "on the way");
    assert!(world.update_pair(sensor, right), "a pair");
    world.remove(&[left]);
    world.retain(|object| *object.data() != "sensor");
    assert_eq!(world.len(), 1, "one is left");
    world.clear();
    assert!(World::default().is_empty() && world.is_empty(), "none");
}

#[test]
fn groups_and_queries_of_the_world() {
    let one =
        CollisionGroups::new().with_membership(&[1]).with_whitelist(&[2]).with_blacklist(&[3]);
    let same = CollisionGroups::new()
        .with_membership_by_mask(1 << 1)
        .with_whitelist_by_mask(1 << 2)
        .with_blacklist_by_mask(1 << 3);
    let mut empty = CollisionGroups::empty();
    empty.enable_self_collision();
    assert_eq!((one, empty.whitelist_mask()), (same, 0), "in either way");
    let all = CollisionGroups::new().with_whitelist_by_mask(CollisionGroups::ALL);
    let (world, [left, ..]) = world();
    let ray = Ray::new(Point::new(-5.0, 0.0, 0.0), Vector::x());
    assert_eq!(world.interferences_with_ray(&ray, &all).count(), 3, "all");
    let is_ball = |object: &CollisionObject<f64, &str>| *object.data() != "sensor";
    let filter = QueryFilter::new().groups(all).exclude(left).predicate(&is_ball);
    let first = world.first_ray_hit(&ray, 9.0, true, &filter).expect("the right one");
    assert_eq!((first.0.data(), first.1.toi), (&"right", 5.5), "its near side");
    assert_eq!(world.ray_hits(&ray, 9.0, true, &QueryFilter::new()).len(), 3, "all");
    let (start, ball, options) = (at(-9.0), Ball::new(0.25), ImpactOptions::new());
    let any = QueryFilter::new();
    assert!(world.cast_shape(&start, &Vector::x(), &ball, &options, &filter).is_some(), "a hit");
    assert_eq!(world.cast_shape_all(&start, &Vector::x(), &ball, &options, &any).len(), 3, "all");
    assert!(world.project_point(&Point::origin(), 1.0, true, &any).is_some(), "in it");
    assert_eq!(world.objects_containing(&Point::origin(), &any).count(), 2, "left and sensor");
    assert_eq!(world.objects_overlapping(&at(0.0), &ball, &any).count(), 2, "the same");
}

#[test]
fn shapes() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let [a, b, c, d] = points.map(Point::from);
    let (ball, capsule) = (Ball::new(1.0), Capsule::<f64>::new(2.0, 0.5));
    assert_eq!((ball.radius(), capsule.half_height()), (1.0, 2.0), "methods");
    assert_eq!(
        (Cone::new(2.0, 1.0).half_height(), Cylinder::new(3.0, 1.0).half_height()),
        (2.0, 3.0)
    );
    assert_eq!(Cuboid::new(Vector::repeat(1.0)).half_extents(), &Vector::repeat(1.0), "a method");
    assert_eq!(Plane::new(Unit::new_normalize(Vector::<f64>::y())).normal().y, 1.0, "a method");
    let (segment, triangle) = (Segment::new(a, b), Triangle::new(a, b, c));
    assert_eq!((segment.a(), segment.b(), triangle.corners()), (&a, &b, &[a, b, c]), "methods");
    assert_eq!(Tetrahedron::new([a, b, c, d]).corners(), &[a, b, c, d], "an array");
    let compound = Compound::new(vec![(at(1.0), ShapeHandle::new(ball))]);
    assert_eq!(compound.children().len(), compound.num_parts() as usize, "one");
    assert_eq!(compound.part(0).pose.translation.x, 1.0, "of the child");
    let mesh: TriMesh<f64> = TriMesh::new(vec![a, b, c], vec![[0, 1, 2]]);
    assert_eq!(
        (mesh.vertices().len(), mesh.triangles(), mesh.triangle(0)),
        (3, &[[0, 1, 2]][..], triangle)
    );
    assert!(mesh.try_scaled(&Vector::new(1.0, 2.0, 3.0)).is_ok(), "scaled");
    let mesh = mesh.with_internal_edges_kept().one_sided();
    assert!(mesh.encloses(&a).is_none() && mesh.signed_distance(&a).is_none(), "open");
    let lines = [Polyline::open(vec![a, b, c]), Polyline::closed(vec![a, b, c])];
    let line = Polyline::new(vec![a, b], vec![[0, 1]]);
    assert_eq!(
        (lines.map(|line| line.num_segments()), line.vertices().len()),
        ([2, 3], 2),
        "lines"
    );
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let hull = ConvexHull::try_new(&[a, b, c, d], &faces).expect("convex");
    assert_eq!(Ok(hull), ConvexHull::try_from_points(&[a, b, c, d]), "the same");
    let flat = transformation::convex_shape(&[a, b, c]).expect("finite");
    assert_eq!(flat.as_shape::<Triangle<f64>>(), Some(&triangle), "a triangle");
    assert_eq!(
        transformation::convex_hull(&[a, b, c, d]).expect("a solid").vertices.len(),
        4,
        "all"
    );
    let mut field = HeightField::new(2, 2, vec![0.0; 4], Vector::repeat(1.0));
    field.set_hole(0, 0, true);
    field.set_diagonal(0, 0, Diagonal::Backward);
    assert!(field.is_hole(0), "a hole");
    let rounded = Rounded::new(Cuboid::new(Vector::repeat(1.0)), 0.25);
    assert!(ShapeHandle::new(rounded).scaled(&Vector::repeat(2.0)).is_ok(), "scaled");
    let outline = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(dim2::math::Point::<f64>::from);
    assert!(dim2::shape::ConvexPolygon::try_new(&outline).is_ok(), "a slice");
    assert_eq!(
        procedural::ball(&ball, 8).corners().len(),
        procedural::ball(&ball, 8).triangles.len()
    );
}

#[test]
fn questions() {
    let (ball, here, there) = (Ball::new(1.0_f64), at(0.0), at(1.5));
    assert_eq!(distance(&here, &ball, &at(5.0), &ball), 3.0, "apart");
    assert_eq!(proximity(&here, &ball, &there, &ball, 0.0), Proximity::Intersecting, "not apart");
    assert_eq!(
        closest_points(&here, &ball, &there, &ball, 9.0),
        dim3::query::ClosestPoints::Intersecting
    );
    let found: Contact<f64> = contact(&here, &ball, &there, &ball, 0.0).expect("they overlap");
    assert_eq!((found.depth, found.normal.x), (0.5, 1.0), "from the first to the second");
    assert_eq!((found.world1.x, found.world2.x), (1.0, 0.5), "in the world");
    let (away, rest) = (Vector::x(), Vector::zeros());
    assert_eq!(time_of_impact(&here, &rest, &ball, &there, &away, &ball), None, "they part");
    let options = ImpactOptions::new().with_max_time(9.0).with_target_distance(0.0);
    let counting = options.with_contact_at_start(true);
    let (one, two) = (Moving::still(&here, &ball), Moving::new(&there, &away, &ball));
    assert_eq!(impact(&one, &two, &options), None, "they part");
    let hit = impact(&one, &two, &counting).expect("they overlap");
    assert_eq!((hit.toi, hit.status), (0.0, ImpactStatus::PenetratingAtStart), "at the start");
    let flies = ConstantVelocities::<f64>::new(at(9.0), -Vector::x(), Vector::zeros());
    let motions: [&dyn RigidMotion<f64, 3>; 2] = [&ConstantVelocities::<f64>::still(here), &flies];
    let [one, two] = motions;
    let met = nonlinear_time_of_impact(one, &ball, two, &ball, &options).expect("head on");
    assert!((met.toi - 7.0).abs() < 1e-12, "{met:?}");
    let ray = Ray::new(Point::new(-5.0, 0.0, 0.0), Vector::x());
    assert_eq!(ball.toi_with_ray(&here, &ray, true), Some(4.0), "the near side");
    assert!(ball.toi_and_normal_with_ray(&here, &ray, true).is_some(), "the same");
    assert!(ball.first_hit_with_ray(&here, &ray, 3.0, true).is_none(), "too short");
    let front = |feature| feature != FeatureId::Face(1);
    assert!(ball.first_hit_where(&here, &ray, 9.0, true, |hit| front(hit.feature)).is_some(), "it");
    assert!(ball.intersects_ray(&here, &ray) && !ball.intersects_local_ray(&ray, 3.0), "the same");
    let (outside, shape) = (Point::new(0.0, 3.0, 0.0), &ball as &dyn Shape<f64, 3>);
    assert_eq!(shape.project_point(&here, &outside, true).point.y, 1.0, "its top");
    assert_eq!(shape.distance_to_point(&here, &outside, true), 2.0, "above it");
    assert!(!shape.contains_point(&here, &outside), "above it");
    assert_eq!(shape.project_point_with_location(&here, &outside, true).1.part, 0, "one part");
}

#[test]
fn questions_of_engines() {
    let (ball, here, there) = (Ball::new(1.0), at(0.0), at(1.5));
    let near = ContactPrediction::new(0.0, 0.0, 0.0);
    let manifolds = contact_manifolds(&here, &ball, &there, &ball, &near, None);
    let id = manifolds[0].contacts()[0].id;
    assert_ne!(id, ContactId::NULL, "a contact");
    let status = |x: f64| {
        let (one, two) = (Moving::still(&here, &ball), at(x));
        impact(&one, &Moving::new(&two, &-Vector::x(), &ball), &ImpactOptions::new())
            .map(|hit| hit.status)
    };
    assert_eq!(status(3.0), Some(ImpactStatus::Reached), "apart at first");
    assert_eq!(status(2.0), Some(ImpactStatus::TouchingAtStart), "it touches");
    assert_eq!(status(1.5), Some(ImpactStatus::PenetratingAtStart), "it overlaps");
    assert_ne!(status(9.0), Some(ImpactStatus::StepsSpent), "a few steps will do");
    let (center, spin) = (Point::new(1.0, 0.0, 0.0), Vector::y());
    let turns = ConstantVelocities::<f64>::new(here, Vector::x(), spin)
        .with_start_time(2.0)
        .with_local_center(center)
        .append_transformation(&at(1.0))
        .prepend_transformation(&at(-1.0));
    assert_eq!((turns.start(), turns.start_time()), (&here, 2.0), "there and back");
    assert_eq!((turns.linear_velocity(), turns.angular_velocity()), (&Vector::x(), spin), "given");
    let body: MassProperties<f64> = mass_properties(&ball, 3.0).expect("a ball");
    let same: MassProperties<f64> = mass_properties_with(&ball, &mut |_| 3.0).expect("a ball");
    assert_eq!((body.inverse_mass(), body.inertia()), (1.0 / same.mass(), same.inertia()), "same");
    let moved = body.transformed(&there);
    assert_eq!(moved.center_of_mass().x, 1.5, "placed");
    assert_eq!(moved.principal_moments()[0], body.inertia()[(0, 0)], "turned or not");
    let inverse = moved.inverse_inertia_at(&there) * body.inertia();
    assert!((inverse[(1, 1)] - 1.0).abs() < 1e-15, "the inverse");
}

#[test]
fn volumes_trees_and_algorithms() {
    let (center, half) = (Point::new(1.0, 0.0, 0.0), Vector::repeat(1.0));
    let volume = Aabb::from_half_extents(center, half);
    assert_eq!(volume, Aabb::new(*volume.mins(), *volume.maxs()), "by its corners");
    assert_eq!(
        Aabb::from_points(&[*volume.mins(), *volume.maxs()]),
        Some(volume),
        "and around them"
    );
    let negative = Aabb::try_from_half_extents(center, -half).expect_err("inverted");
    assert_eq!(negative.to_string(), "the box is inverted on axis 0: from 2 to 0", "in words");
    assert!(Aabb::try_from_half_extents(center, half * f64::NAN).is_err(), "not a number");
    assert_eq!(aabb(&Ball::new(1.0), &at(1.0)), volume, "of a ball");
    assert!(bounding_sphere(&Ball::new(1.0), &at(1.0)).radius() >= 1.0, "of a ball");
    let mut broad_phase = DBVTBroadPhase::new(0.1_f64);
    broad_phase.create_proxy(volume, ());
    broad_phase.update(&mut |(), ()| true, &mut |(), (), _| ());
    let (tree, mut count) = (BoxTree::from_boxes(&[volume]), 0);
    tree.visit_overlapping(&volume, |_| count += 1);
    tree.visit_ray(&Ray::new(Point::origin(), Vector::x()), 9.0, |_, time| {
        count += 1;
        time
    });
    tree.visit_nearest(&Point::origin(), 9.0, |_, distance| {
        count += 1;
        distance
    });
    tree.visit_cast(&volume, &Vector::x(), 9.0, |_, time| {
        count += 1;
        time
    });
    assert_eq!(count, 4, "in each way");
    let dispatcher = DefaultContactDispatcher::new();
    let algorithm = dispatcher.get_contact_algorithm(&Ball::new(1.0_f64), &Ball::new(1.0_f64));
    let algorithm: Box<dyn ContactManifoldGenerator<f64, 3>> = algorithm.expect("of any pair");
    assert_eq!(algorithm.num_contacts(), 0, "so far");
    let detector = dim3::narrow_phase::PairProximityDetector::new();
    assert_eq!(ProximityDetector::<f64, 3>::proximity(&detector), Proximity::Disjoint, "so far");
    let mut world = World::new(0.02);
    world.set_narrow_phase(Box::new(DefaultNarrowPhase::reusing(DefaultNarrowPhase::new(), 0.001)));
    assert_eq!(na::one::<f64>(), 1.0, "nalgebra");
}

/// Returns the identifiers in the column for impinge, each with its row of the table.
fn names_of_the_page(page: &str) -> Vec<(String, String)> {
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.contains('`'));
    let column = |row: &str| row.split(" | ").nth(1).expect("three columns").to_owned();
    let mut names = Vec::new();
    for row in rows {
        for code in column(row).split('`').skip(1).step_by(2) {
            let words = code.split(|c: char| !(c.is_alphanumeric() || c == '_'));
            let words = words.filter(|word| !word.is_empty());
            names.extend(words.map(|word| (word.to_owned(), row.to_owned())));
        }
    }
    names
}

#[test]
fn what_the_page_names_is_compiled() {
    let page = include_str!("../../../../../guide/coming-from.md");
    let program = include_str!("coming_from.rs");
    let code: Vec<&str> =
        program.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let used =
        |name: &str| code.iter().any(|line| line.split(|c| !is_word(c)).any(|word| word == name));
    let names = names_of_the_page(page);
    assert!(names.len() > 150, "the tables were found: {}", names.len());
    let missing: Vec<_> = names.iter().filter(|(name, _)| !used(name)).collect();
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn the_readmes_hold_the_same_programs() {
    let programs = |page: &'static str| -> Vec<&str> {
        page.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next()).collect()
    };
    let of_the_crate = programs(include_str!("../../../README.md"));
    assert_eq!(of_the_crate.len(), 2, "the plane and space");
    assert_eq!(
        programs(include_str!("../../../../../README.md")),
        of_the_crate,
        "which are run as tests"
    );
}
