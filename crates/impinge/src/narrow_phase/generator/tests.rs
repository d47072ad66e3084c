//! Tests that a generator keeps contacts and ids if nothing changed, detects changed shapes, and
//! can be read when the shapes are gone.

use super::*;
use crate::math::Isometry2;
use crate::math::{Point, Vector};
use crate::narrow_phase::contact_manifolds;
use crate::shape::{
    Ball, Capsule, ConvexPolygon, Cuboid, HeightField, Polyline, Rounded, Triangle,
};

struct PairFixture {
    generator: PairManifoldGenerator<f64, 2>,
    ids: IdAllocator,
}

impl PairFixture {
    fn new() -> Self {
        Self { generator: PairManifoldGenerator::default(), ids: IdAllocator::new() }
    }

    /// Returns the manifolds of two solids, the first at the origin, the second at `(x, 0)`.
    fn manifolds(
        &mut self,
        first: &dyn Shape<f64, 2>,
        second: &dyn Shape<f64, 2>,
        x: f64,
    ) -> Vec<ContactManifold<f64, 2>> {
        self.update(first, second, x);
        self.read()
    }

    fn update(&mut self, first: &dyn Shape<f64, 2>, second: &dyn Shape<f64, 2>, x: f64) {
        let dispatcher = DefaultContactDispatcher::<2>::new();
        let prediction = ContactPrediction::new(0.25, 0.0, 0.0);
        let (here, there) = (Isometry2::identity(), Isometry2::translation(x, 0.0));
        let able = self.generator.update(
            &dispatcher,
            &here,
            first,
            &there,
            second,
            &prediction,
            &mut self.ids,
        );
        assert!(able, "the library's own solids");
    }

    fn read(&self) -> Vec<ContactManifold<f64, 2>> {
        let mut manifolds = Vec::new();
        self.generator.contacts(&mut manifolds);
        manifolds.into_iter().cloned().collect()
    }

    /// Returns the depths of the contacts of [`Self::manifolds`].
    fn depths(
        &mut self,
        first: &dyn Shape<f64, 2>,
        second: &dyn Shape<f64, 2>,
        x: f64,
    ) -> Vec<f64> {
        let manifolds = self.manifolds(first, second, x);
        let contacts = manifolds.iter().flat_map(ContactManifold::contacts);
        contacts.map(|tracked| tracked.contact.depth).collect()
    }
}

/// Returns a square with half side `size`.
fn square(size: f64) -> ConvexPolygon<f64> {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    ConvexPolygon::new(&corners.map(|(x, y)| Point::<f64, 2>::new(x, y) * size))
}

#[test]
fn an_update_without_motion_keeps_contacts_and_ids() {
    let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0));
    let (ball, square) = (Ball::new(1.0), square(1.0));
    let wall = [-2.0, 0.0, 2.0].map(|y| Point::<f64, 2>::new(-0.75, y));
    let wall = Polyline::new(wall.to_vec(), vec![[0, 1], [1, 2]]);
    let others: [&dyn Shape<f64, 2>; 4] = [&cuboid, &ball, &square, &wall];
    for (index, other) in others.into_iter().enumerate() {
        let mut fixture = PairFixture::new();
        let before = fixture.manifolds(&cuboid, other, 1.5);
        assert!(!before.is_empty(), "shape {index} overlaps the cuboid");
        assert_eq!(fixture.manifolds(&cuboid, other, 1.5), before, "shape {index}");
    }
}

/// Returns a vertical polyline of two segments, at abscissa `x` in its local frame.
fn wall(x: f64) -> Polyline<f64, 2> {
    Polyline::open([-2.0, 0.0, 2.0].map(|y| Point::<f64, 2>::new(x, y)).to_vec())
}

#[test]
fn contacts_are_read_when_the_solids_are_gone() {
    let mut fixture = PairFixture::new();
    let shapes: [Box<dyn Shape<f64, 2>>; 7] = [
        Box::new(Ball::new(1.0)),
        Box::new(Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0))),
        Box::new(Capsule::<f64, 2>::new(0.5, 1.0)),
        Box::new(Triangle::new([-1.0, -1.0].into(), [1.0, 0.0].into(), [-1.0, 1.0].into())),
        Box::new(square(1.0)),
        Box::new(Rounded::new(square(0.5), 0.5)),
        Box::new(wall(-1.0)),
    ];
    for shape in shapes {
        let name = format!("{shape:?}");
        let pose = Isometry2::translation(1.5, 0.0);
        let prediction = ContactPrediction::new(0.25, 0.0, 0.0);
        let ball = Ball::new(1.0);
        let once =
            contact_manifolds(&Isometry2::identity(), &ball, &pose, &*shape, &prediction, None);
        fixture.update(&ball, &*shape, 1.5);
        drop(shape);
        let read = fixture.read();
        let contacts = |manifolds: &[ContactManifold<f64, 2>]| -> Vec<_> {
            let all = manifolds.iter().flat_map(ContactManifold::contacts);
            all.map(|tracked| (tracked.contact, tracked.kinematic)).collect()
        };
        assert!(!once.is_empty(), "{name} overlaps the ball");
        assert_eq!(contacts(&read), contacts(&once), "{name}");
    }
}

#[test]
fn what_changes_in_place_is_noticed() {
    let (mut fixture, ball, mut line) = (PairFixture::new(), Ball::new(1.0), wall(-0.75));
    assert_eq!(fixture.depths(&ball, &line, 1.5), [0.25]);
    line.set_vertices(wall(-1.0).vertices());
    assert_eq!(fixture.depths(&ball, &line, 1.5), [0.5], "the line was moved");
    let mut field = HeightField::<f64, 2>::new(vec![0.0; 3], Vector::<f64, 2>::new(4.0, 1.0));
    let mut rise = |field: &_| {
        let near = ContactPrediction::new(0.25, 0.0, 0.0);
        let (here, there) = (Isometry2::translation(0.0, 1.125), Isometry2::identity());
        let (generator, ids) = (&mut fixture.generator, &mut fixture.ids);
        let dispatcher = DefaultContactDispatcher::<2>::new();
        generator.update(&dispatcher, &here, &ball, &there, field, &near, ids);
        let depths = generator.manifolds().iter().filter_map(ContactManifold::deepest_contact);
        depths.map(|tracked| tracked.contact.depth).fold(-1.0, f64::max)
    };
    assert_eq!(rise(&field), -0.125, "above the field");
    field.set_heights(vec![0.0625; 3]).expect("three");
    assert_eq!(rise(&field), -0.0625, "a higher field");
    field.set_hole(0, true);
    field.set_hole(1, true);
    assert_eq!(rise(&field), -1.0, "nothing is left of it");
}

#[test]
fn a_copy_goes_on_by_itself() {
    let (mut fixture, ball, line) = (PairFixture::new(), Ball::new(1.0), wall(-0.75));
    let before = fixture.manifolds(&ball, &line, 1.5);
    let copy = fixture.generator.clone();
    assert_ne!(fixture.manifolds(&ball, &line, 1.25), before);
    fixture.generator = copy;
    assert_eq!(fixture.read(), before, "what was read of the original");
    assert_eq!(fixture.manifolds(&ball, &line, 1.5), before, "and computed again");
}

#[test]
fn a_composite_leaves_nothing_to_solids_that_are_far_apart() {
    let (mut fixture, ball, line) = (PairFixture::new(), Ball::new(1.0), wall(-0.75));
    assert_eq!(fixture.depths(&ball, &line, 1.5), [0.25]);
    assert!(fixture.depths(&ball, &ball, 9.0).is_empty(), "two balls instead");
    assert_eq!(fixture.generator.num_contacts(), 0);
    assert_eq!(fixture.depths(&ball, &line, 1.5), [0.25], "the line again");
}

#[test]
fn no_two_contacts_share_an_id_whatever_the_shapes_were() {
    let (mut fixture, ball, line) = (PairFixture::new(), Ball::new(1.0), wall(-0.75));
    let ids = |fixture: &mut PairFixture, shape: &dyn Shape<f64, 2>| -> Vec<_> {
        let manifolds = fixture.manifolds(&ball, shape, 1.5);
        let contacts = manifolds.iter().flat_map(ContactManifold::contacts);
        contacts.map(|tracked| tracked.id).collect()
    };
    let (of_ball, of_line) = (ids(&mut fixture, &ball), ids(&mut fixture, &line));
    let again = ids(&mut fixture, &ball);
    assert!(of_ball != of_line && of_line != again && again != of_ball, "three contacts");
}

#[test]
fn each_update_may_be_given_other_solids() {
    let mut fixture = PairFixture::new();
    let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0));
    let mut ball = Ball::new(1.0);
    assert_eq!(fixture.depths(&cuboid, &ball, 1.5), [0.5]);
    ball = Ball::new(0.75);
    assert_eq!(fixture.depths(&cuboid, &ball, 1.5), [0.25], "another ball at its address");
    assert!(fixture.depths(&cuboid, &ball, 9.0).is_empty(), "far away");
    assert_eq!(fixture.depths(&cuboid, &ball, 1.5), [0.25], "back again");
    for (size, depth) in [(1.0, 0.5), (0.75, 0.25)] {
        let found = fixture.depths(&cuboid, &square(size), 1.5);
        assert_eq!(found, [depth; 2], "a square of {size}");
    }
}
