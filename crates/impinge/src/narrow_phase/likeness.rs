//! Knowing again what a pair was asked last.

use std::sync::Arc;

use smallvec::SmallVec;

use crate::math::{Point, Real, Vector};
use crate::query::ManifoldRequest;
use crate::shape::{Geometry, Kind, ShapeKind};

/// The numbers that make a solid what it is: nine of a triangle in space at most.
type Numbers<N> = SmallVec<[N; 9]>;

/// What a solid is known again by, whatever its address.
#[derive(Clone, Debug)]
enum Likeness<N: Real> {
    Numbers(ShapeKind, Numbers<N>),
    /// A polygon or hull, by what its copies share. As long as it is held here it is no other's.
    Hull(Arc<()>),
}

/// Two placed solids and what was asked about them.
#[derive(Clone, Debug)]
pub(super) struct Asked<N: Real> {
    positions: [[N; 7]; 2],
    solids: [Likeness<N>; 2],
    request: ManifoldRequest<N>,
}

impl<N: Real> Likeness<N> {
    /// `None` for what cannot be known again: support maps of users, composites, and what is rounded of
    /// these or of hulls.
    fn of<const D: usize>(shape: Geometry<'_, N, D>) -> Option<Self> {
        if let Kind::Polytope(polytope) = shape.0 {
            return Some(Self::Hull(Arc::clone(polytope.identity())));
        }
        numbers(shape).map(|numbers| Self::Numbers(shape.kind(), numbers))
    }

    /// The solid is the same, bit for bit.
    fn is<const D: usize>(&self, shape: Geometry<'_, N, D>) -> bool {
        match (self, shape.0) {
            (Self::Hull(known), Kind::Polytope(polytope)) => {
                Arc::ptr_eq(known, polytope.identity())
            }
            (Self::Hull(_), _) => false,
            (Self::Numbers(kind, known), _) => {
                *kind == shape.kind() && numbers(shape).is_some_and(|found| are_same(known, &found))
            }
        }
    }
}

/// Zeros of two signs are two numbers.
fn are_same<N: Real>(known: &[N], found: &[N]) -> bool {
    known.len() == found.len() && known.iter().zip(found).all(|(a, b)| a.bits() == b.bits())
}

/// `None` for what is not made of a few numbers.
fn numbers<N: Real, const D: usize>(shape: Geometry<'_, N, D>) -> Option<Numbers<N>> {
    let mut numbers = Numbers::new();
    let vector =
        |numbers: &mut Numbers<N>, v: &Vector<N, D>| numbers.extend_from_slice(v.as_slice());
    let point = |numbers: &mut Numbers<N>, p: &Point<N, D>| vector(numbers, &p.coords);
    match shape.0 {
        Kind::Ball(ball) => numbers.push(ball.radius()),
        Kind::Segment(segment) => {
            point(&mut numbers, segment.a());
            point(&mut numbers, segment.b());
        }
        Kind::Capsule(capsule) => {
            point(&mut numbers, capsule.segment().a());
            point(&mut numbers, capsule.segment().b());
            numbers.push(capsule.radius());
        }
        Kind::TaperedCapsule(capsule) => {
            point(&mut numbers, capsule.segment().a());
            point(&mut numbers, capsule.segment().b());
            numbers.extend_from_slice(&capsule.radii());
        }
        Kind::Triangle(triangle) => {
            triangle.corners().iter().for_each(|corner| point(&mut numbers, corner));
        }
        Kind::Cuboid(cuboid) => vector(&mut numbers, cuboid.half_extents()),
        Kind::Ellipsoid(ellipsoid) => vector(&mut numbers, ellipsoid.half_axes()),
        Kind::Plane(plane) => vector(&mut numbers, plane.normal()),
        Kind::Cylinder(cylinder, _) => {
            numbers.extend_from_slice(&[cylinder.half_height(), cylinder.radius()]);
        }
        Kind::Cone(cone, _) => numbers.extend_from_slice(&[cone.half_height(), cone.radius()]),
        Kind::Polytope(_) | Kind::Rounded(_) | Kind::SupportMap(_) | Kind::Composite(_) => {
            return None;
        }
    }
    Some(numbers)
}

/// What is asked about two placed solids.
#[derive(Clone, Copy)]
pub(super) struct Question<'a, N: Real, const D: usize> {
    /// The numbers of their positions.
    pub(super) positions: [[N; 7]; 2],
    pub(super) shapes: [Geometry<'a, N, D>; 2],
    pub(super) request: ManifoldRequest<N>,
}

impl<N: Real> Asked<N> {
    /// `None` for solids that cannot be known again.
    fn new<const D: usize>(question: &Question<'_, N, D>) -> Option<Self> {
        let [shape1, shape2] = question.shapes;
        let solids = [Likeness::of(shape1)?, Likeness::of(shape2)?];
        Some(Self { positions: question.positions, solids, request: question.request })
    }

    /// Notes a question; answers whether the one noted before is the same.
    pub(super) fn note<const D: usize>(
        noted: &mut Option<Self>,
        question: &Question<'_, N, D>,
    ) -> bool {
        let [shape1, shape2] = question.shapes;
        if let Some(asked) = noted
            && asked.solids[0].is(shape1)
            && asked.solids[1].is(shape2)
        {
            let (before, now) = (asked.positions.as_flattened(), question.positions.as_flattened());
            let is_same = asked.request == question.request && are_same(before, now);
            (asked.positions, asked.request) = (question.positions, question.request);
            return is_same;
        }
        *noted = Self::new(question);
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Ball, ConvexPolygon, Cuboid, Rounded, Shape, Triangle};

    fn like(shape: &dyn Shape<f64, 2>) -> Option<Likeness<f64>> {
        Likeness::of(shape.geometry())
    }

    #[test]
    fn solids_are_known_again_by_what_they_are() {
        let p = |x: f64, y: f64| Point::<f64, 2>::new(x, y);
        let triangle = |y: f64| Triangle::new(p(0.0, y), p(1.0, 0.0), p(0.0, 1.0));
        let known = like(&triangle(0.0)).expect("six numbers");
        assert!(known.is(triangle(0.0).geometry()), "the same numbers elsewhere in memory");
        assert!(!known.is(triangle(-0.0).geometry()), "another zero");
        let ball = like(&Ball::new(1.0)).expect("a number");
        assert!(!ball.is(Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0)).geometry()), "another kind");
        assert!(like(&Rounded::new(Ball::new(1.0), 1.0)).is_none(), "not looked into");
    }

    #[test]
    fn hulls_are_known_again_by_their_copies() {
        let p = |x: f64, y: f64| Point::<f64, 2>::new(x, y);
        let make = || ConvexPolygon::new(&[p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)]);
        let polygon = make();
        let known = like(&polygon).expect("a polygon");
        assert!(known.is(polygon.clone().geometry()), "a copy");
        assert!(!known.is(make().geometry()), "another one: no number is compared");
        drop(polygon);
        assert!(!known.is(make().geometry()), "not even in its place");
    }
}
