//! Tests that the manifolds of two placed shapes without a world equal those of a new world and of
//! a new generator.

use crate::support::query_support::random::Random;
use crate::support::samples::stride;
use crate::support::shape_table::{self, Shapes};

use impinge::math::{
    AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Unit, Vector,
};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, ContactQuery, DefaultContactDispatcher,
    DefaultNarrowPhase, DefaultProximityDispatcher, IdAllocator, PairManifoldGenerator,
    contact_manifolds,
};
use impinge::query::{ContactId, ContactManifold, contact};
use impinge::shape::{Ball, Cuboid, Plane, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};

/// Two placed shapes and the query.
struct Setting<'a, N: Space<D>, const D: usize> {
    places: [N::Isometry; 2],
    shapes: [&'a ShapeHandle<N, D>; 2],
    /// Contact query that both objects have; the prediction of the pair is the sum of both.
    query: ContactQuery<N>,
    max_points: Option<usize>,
}

type Manifolds<N, const D: usize> = Vec<ContactManifold<N, D>>;

impl<N: Space<D>, const D: usize> Setting<'_, N, D> {
    fn prediction(&self) -> ContactPrediction<N> {
        let ContactQuery { prediction, angular_prediction, .. } = self.query;
        ContactPrediction::new(prediction + prediction, angular_prediction, angular_prediction)
    }

    /// Returns the manifolds that a new world computes.
    fn by_world(&self) -> Manifolds<N, D> {
        let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.25));
        if let Some(max_points) = self.max_points {
            let contacts = Box::new(DefaultContactDispatcher::<D>::with_max_points(max_points));
            let proximities = Box::new(DefaultProximityDispatcher::<D>::new());
            let narrow_phase = DefaultNarrowPhase::with_dispatchers(contacts, proximities);
            world.set_narrow_phase(Box::new(narrow_phase));
        }
        for (place, shape) in self.places.iter().zip(self.shapes) {
            world.add(*place, shape.clone(), CollisionGroups::new(), self.query, ());
        }
        world.update();
        world.contact_manifolds().map(|(_, _, manifold)| manifold.clone()).collect()
    }

    /// Returns the manifolds that a new generator computes.
    fn by_generator(&self) -> Manifolds<N, D> {
        let mut generator =
            self.max_points.map_or_else(PairManifoldGenerator::default, PairManifoldGenerator::new);
        let ([m1, m2], [g1, g2]) = (&self.places, self.shapes);
        let (dispatcher, ids) = (DefaultContactDispatcher::<D>::new(), &mut IdAllocator::new());
        let prediction = self.prediction();
        generator.update(&dispatcher, m1, &**g1, m2, &**g2, &prediction, ids);
        let mut manifolds = Vec::new();
        generator.contacts(&mut manifolds);
        manifolds.into_iter().cloned().collect()
    }
}

/// Asserts that the manifolds are equal except for the ids.
fn assert_same<N: Real, const D: usize>(
    found: &[ContactManifold<N, D>],
    expected: &[ContactManifold<N, D>],
    what: &str,
) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (one, other) in found.iter().zip(expected) {
        assert_eq!(one.len(), other.len(), "{what}");
        for (one, other) in one.contacts().iter().zip(other.contacts()) {
            let with_id = impinge::query::TrackedContact { id: other.id, ..*one };
            assert_eq!(with_id, *other, "{what}");
        }
    }
}

/// Compares the manifolds of every pair of shapes without a world, at random poses, with those of a
/// new world and of a new generator. Swapping the shapes must flip every contact. By default every
/// fifth case is tested. There are 64 cases for each first shape in 2D and 84 in 3D, so the tested
/// predictions and second shapes differ from one first shape to the next.
fn every_pair<N, R, const D: usize>(shapes: &Shapes<N, D>, turn: fn(&mut Random) -> R)
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy,
{
    let (random, mut touching, mut tried) = (&mut Random(1, false), 0, 0);
    let mut case = 0_usize;
    for ((name1, shape1), (name2, shape2)) in
        shapes.iter().flat_map(|one| shapes.iter().map(move |other| (one, other)))
    {
        for (prediction, angular, max_points) in [
            (0.0, 0.0, None),
            (0.25, 0.125, None),
            (0.125, 0.0, Some(1 << D)),
            (0.25, 0.0, Some(1)),
        ] {
            let mut place = || {
                Isometry::from_parts((random.vector::<N, D>() * N::lit(1.5)).into(), turn(random))
            };
            let query =
                ContactQuery::new(N::lit(prediction)).with_angular_prediction(N::lit(angular));
            let (places, shapes) = ([place(), place()], [shape1, shape2]);
            case += 1;
            if !case.is_multiple_of(stride(5)) {
                continue;
            }
            let setting = Setting { places, shapes, query, max_points };
            let [m1, m2] = &setting.places;
            let asked = &setting.prediction();
            let found = contact_manifolds(m1, &**shape1, m2, &**shape2, asked, max_points);
            let what = format!("{name1} and {name2}, {prediction} {angular} {max_points:?}");
            assert_same(&found, &setting.by_world(), &what);
            assert_eq!(found, setting.by_generator(), "{what}");
            let swapped = contact_manifolds(m2, &**shape2, m1, &**shape1, asked, max_points);
            assert_eq!(found.len(), swapped.len(), "{what}");
            let pairs = found.iter().zip(&swapped);
            for (one, other) in pairs.flat_map(|(a, b)| a.contacts().iter().zip(b.contacts())) {
                assert_eq!(one.contact, other.contact.flipped(), "{what}");
                assert_eq!((one.part1, one.part2), (other.part2, other.part1), "{what}");
                assert!(!one.id.is_null(), "{what}");
            }
            tried += 1;
            touching += usize::from(!found.is_empty());
            let most = max_points.unwrap_or(1 << (D - 1));
            assert!(found.iter().all(|m| !m.is_empty() && m.len() <= most), "{what}");
        }
    }
    assert!(touching * 4 > tried && touching < tried, "{touching} of {tried} touch");
}

#[test]
fn every_two_shapes_as_in_a_world() {
    every_pair::<f32, _, 2>(&shape_table::plane(1.0), Random::turn2);
    every_pair::<f64, _, 2>(&shape_table::plane(1.0), Random::turn2);
    every_pair::<f32, _, 3>(&shape_table::space(1.0), Random::turn3);
    every_pair::<f64, _, 3>(&shape_table::space(1.0), Random::turn3);
}

#[test]
fn what_is_nowhere_has_no_manifold() {
    let (ball, cube) = (Ball::new(1.0), Cuboid::new(Vector::<f64, 3>::repeat(1.0)));
    let (here, far) = (Isometry3::identity(), ContactPrediction::new(f64::INFINITY, 0.0, 0.0));
    for bad in [f64::NAN, f64::INFINITY] {
        let there = Isometry3::translation(0.0, bad, 0.0);
        assert!(contact_manifolds(&here, &ball, &there, &cube, &far, None).is_empty(), "at {bad}");
        assert!(contact_manifolds(&there, &cube, &here, &cube, &far, None).is_empty(), "at {bad}");
        let near = ContactPrediction::new(-bad, 0.0, 0.0);
        assert!(contact_manifolds(&here, &ball, &here, &cube, &near, None).is_empty(), "to {bad}");
    }
    let there = Isometry3::translation(0.0, 3.0, 0.0);
    assert_eq!(contact_manifolds(&here, &ball, &there, &cube, &far, Some(0)).len(), 1, "one point");
    let ground = |y: f64| Plane::<f64, 2>::new(Unit::new_unchecked(Vector::<f64, 2>::new(0.0, y)));
    let (here, none) = (Isometry2::identity(), ContactPrediction::new(0.0, 0.0, 0.0));
    let same = contact_manifolds(&here, &ground(1.0), &here, &ground(1.0), &none, None);
    assert!(same.is_empty(), "they overlap without bound");
}

#[test]
fn no_contact_has_the_null_id() {
    assert!(ContactId::NULL.is_null() && ContactId::default().is_null(), "it is the default");
    for (pair, number) in [(0, 0), (u64::MAX, 0), (0, u32::MAX)] {
        let id = ContactId::new(pair, number);
        assert!(!id.is_null() && id < ContactId::NULL, "{id:?}");
    }
}

/// Asserts that a box that overlaps a surface has contacts for an infinite prediction, too, and that
/// a query finds the triangle of a one-sided surface whose front the box faces, without a limit.
#[test]
fn surfaces_are_met_at_any_distance() {
    let corners: [[f64; 3]; 6] = [
        [-5.0, 0.0, -5.0],
        [5.0, 0.0, -5.0],
        [0.0, 0.0, 5.0],
        [-5.0, -10.0, -5.0],
        [5.0, -10.0, -5.0],
        [0.0, -10.0, 5.0],
    ];
    let mesh =
        TriMesh::<f64, 3>::new(corners.map(Point::from).to_vec(), vec![[0, 2, 1], [3, 5, 4]]);
    let (here, cube) = (Isometry3::identity(), Cuboid::new(Vector::<f64, 3>::repeat(0.5)));
    let at = Isometry3::translation(0.0, 0.4, 0.0);
    for prediction in [0.0, 1e3, f64::INFINITY] {
        let near = ContactPrediction::new(prediction, 0.0, 0.0);
        let found = contact_manifolds(&here, &mesh, &at, &cube, &near, None);
        assert!(!found.is_empty(), "within {prediction}");
    }
    let (mesh, under) = (mesh.one_sided(), Isometry3::translation(0.0, -2.0, 0.0));
    for limit in [1e3, f64::INFINITY] {
        let found = contact(&here, &mesh, &under, &cube, limit);
        assert!(found.is_some(), "within {limit}");
    }
}
