//! Asserts the distance of one arrangement for each pair of kinds, in both orders. A kind that has
//! no solid here fails to compile, and a pair without an algorithm fails the test.

use crate::collide::Pair;
use crate::collide::separation::separation;
use crate::math::{Point, Pose, Real, Space, Unit, Vector};
use crate::partitioning::BoxTree;
use crate::shape::{
    Ball, Capsule, CompositeShape, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid,
    Geometry, Kind, Part, PartSearch, PartSolid, Plane, Rounded, Segment, Shape, ShapeKind,
    TaperedCapsule, Triangle,
};

/// Returns all kinds in order. The match is exhaustive, so that a new kind fails to compile here.
fn all_kinds() -> Vec<ShapeKind> {
    let mut kinds = vec![ShapeKind::Ball];
    while let Some(next) = kinds.last().and_then(|kind| match kind {
        ShapeKind::Ball => Some(ShapeKind::Segment),
        ShapeKind::Segment => Some(ShapeKind::Capsule),
        ShapeKind::Capsule => Some(ShapeKind::Triangle),
        ShapeKind::Triangle => Some(ShapeKind::Cuboid),
        ShapeKind::Cuboid => Some(ShapeKind::Polytope),
        ShapeKind::Polytope => Some(ShapeKind::Cylinder),
        ShapeKind::Cylinder => Some(ShapeKind::Cone),
        ShapeKind::Cone => Some(ShapeKind::Ellipsoid),
        ShapeKind::Ellipsoid => Some(ShapeKind::TaperedCapsule),
        ShapeKind::TaperedCapsule => Some(ShapeKind::Rounded),
        ShapeKind::Rounded => Some(ShapeKind::SupportMap),
        ShapeKind::SupportMap => Some(ShapeKind::Plane),
        ShapeKind::Plane => Some(ShapeKind::Composite),
        ShapeKind::Composite => None,
    }) {
        kinds.push(next);
    }
    kinds
}

/// A solid of each kind that exists in 2D and in 3D; the bounded solids extend from -1 to 1 along
/// y.
struct Solids<N: Real, const D: usize> {
    ball: Ball<N>,
    segment: Segment<N, D>,
    capsule: Capsule<N, D>,
    triangle: Triangle<N, D>,
    cuboid: Cuboid<N, D>,
    polytope: Box<dyn Shape<N, D>>,
    ellipsoid: Ellipsoid<N, D>,
    tapered: TaperedCapsule<N, D>,
    rounded: Rounded<N, D>,
    plane: Plane<N, D>,
    composite: One<N, D>,
}

/// A composite of one part, which is a box.
struct One<N: Real, const D: usize> {
    cuboid: Cuboid<N, D>,
    search: BoxTree<N, D>,
}

impl<N: Space<D>, const D: usize> CompositeShape<N, D> for One<N, D> {
    fn num_parts(&self) -> u32 {
        1
    }

    fn part(&self, _: u32) -> Part<'_, N, D> {
        Part { pose: Pose::identity(), solid: PartSolid::Shape(&self.cuboid) }
    }

    fn search(&self) -> &dyn PartSearch<N, D> {
        &self.search
    }
}

impl<N: Space<D>, const D: usize> Solids<N, D> {
    fn new(polytope: Box<dyn Shape<N, D>>) -> Self {
        let y = |y: f64| axis::<N, D>(1) * N::lit(y);
        let (low, high) = (Point::from(y(-1.0)), Point::from(y(1.0)));
        let cuboid = Cuboid::new(Vector::<N, D>::repeat(N::ONE));
        let search = BoxTree::from_boxes(&[cuboid.local_aabb()]);
        Self {
            composite: One { cuboid, search },
            ball: Ball::new(N::ONE),
            segment: Segment::new(low, high),
            capsule: Capsule::<N, D>::new(N::HALF, N::HALF),
            triangle: Triangle::new(low, high, Point::from(axis::<N, D>(0))),
            cuboid: Cuboid::new(Vector::<N, D>::repeat(N::ONE)),
            polytope,
            ellipsoid: Ellipsoid::new(Vector::<N, D>::from_fn(|axis, _| {
                if axis == 1 { N::ONE } else { N::HALF }
            })),
            tapered: TaperedCapsule::new(N::HALF, N::HALF, N::HALF),
            rounded: Rounded::new(Cuboid::new(Vector::<N, D>::repeat(N::HALF)), N::HALF),
            plane: Plane::new(Unit::new_unchecked(axis::<N, D>(1))),
        }
    }

    /// Returns the solid of a kind; `None` for cylinders and cones, which exist in 3D only.
    fn kind(&self, kind: ShapeKind) -> Option<Kind<'_, N, D>> {
        Some(match kind {
            ShapeKind::Ball => Kind::Ball(&self.ball),
            ShapeKind::Segment => Kind::Segment(&self.segment),
            ShapeKind::Capsule => Kind::Capsule(&self.capsule),
            ShapeKind::Triangle => Kind::Triangle(&self.triangle),
            ShapeKind::Cuboid => Kind::Cuboid(&self.cuboid),
            ShapeKind::Polytope => self.polytope.geometry().0,
            ShapeKind::Ellipsoid => Kind::Ellipsoid(&self.ellipsoid),
            ShapeKind::TaperedCapsule => Kind::TaperedCapsule(&self.tapered),
            ShapeKind::Rounded => Kind::Rounded(&self.rounded),
            ShapeKind::SupportMap => Kind::SupportMap(&self.capsule),
            ShapeKind::Plane => Kind::Plane(&self.plane),
            ShapeKind::Composite => Kind::Composite(&self.composite),
            _ => return None,
        })
    }
}

fn axis<N: Real, const D: usize>(at: usize) -> Vector<N, D> {
    let mut axis = Vector::<N, D>::zeros();
    axis[at] = N::ONE;
    axis
}

/// Asserts the distance if the second solid is five units above the first: 3 for two bounded
/// solids, 4 if only the first is a half-space, -6 if only the second is a half-space, and minus
/// infinity for two half-spaces.
fn check<N: Space<D>, const D: usize>(first: Kind<'_, N, D>, second: Kind<'_, N, D>) {
    let pose12 = Pose::from_translation(axis::<N, D>(1) * N::lit(5.0));
    let kinds = [first, second].map(|kind| Geometry(kind).kind());
    let found = separation(&Pair { first, second, pose12 }, N::INFINITY);
    let distance = found.map(|found| found.distance.as_f64());
    let expected = match kinds {
        [ShapeKind::Plane, ShapeKind::Plane] => -f64::INFINITY,
        [_, ShapeKind::Plane] => -6.0,
        [ShapeKind::Plane, _] => 4.0,
        _ => 3.0,
    };
    let right = distance.is_some_and(|d| d == expected || (d - expected).abs() < 1e-5);
    assert!(right, "{kinds:?}: {distance:?} instead of {expected}");
}

fn plane<N: Real>() {
    let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x), N::lit(y));
    let polygon = ConvexPolygon::from_points(&[p(0.0, -1.0), p(1.0, 0.0), p(0.0, 1.0)]);
    let solids = Solids::<N, 2>::new(Box::new(polygon));
    let kinds: Vec<_> = all_kinds().iter().filter_map(|&kind| solids.kind(kind)).collect();
    assert_eq!(kinds.len(), ShapeKind::COUNT - 2, "cylinders and cones are of space");
    for (first, second) in kinds.iter().flat_map(|k1| kinds.iter().map(move |k2| (*k1, *k2))) {
        check(first, second);
    }
}

fn space<N: Real>() {
    let p = |x: f64, y: f64, z: f64| Point::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z));
    let corners = [p(0.0, -1.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0), p(0.0, 0.0, 1.0)];
    let hull = ConvexHull::from_points(&corners);
    let (cylinder, cone) = (Cylinder::new(N::ONE, N::ONE), Cone::new(N::ONE, N::ONE));
    let solids = Solids::<N, 3>::new(Box::new(hull));
    let of = |kind| match kind {
        ShapeKind::Cylinder => Kind::Cylinder(&cylinder, &cylinder),
        ShapeKind::Cone => Kind::Cone(&cone, &cone),
        other => solids.kind(other).expect("a kind of both dimensions"),
    };
    let kinds: Vec<_> = all_kinds().into_iter().map(of).collect();
    assert_eq!(kinds.len(), ShapeKind::COUNT, "all kinds");
    for (first, second) in kinds.iter().flat_map(|k1| kinds.iter().map(move |k2| (*k1, *k2))) {
        check(first, second);
    }
}

#[test]
fn every_pair_of_kinds_2d() {
    plane::<f32>();
    plane::<f64>();
}

#[test]
fn every_pair_of_kinds_3d() {
    space::<f32>();
    space::<f64>();
}
