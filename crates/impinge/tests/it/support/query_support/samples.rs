//! Random solids of each kind.

use impinge::math::{Point, Real, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Plane, Rounded, Segment, Shape, ShapeKind,
    TaperedCapsule, Triangle,
};

use super::corpus::{hull, polygon};
use super::random::Random;
use super::solids::RoundHull;

/// The kinds of convex shapes that exist in 2D.
pub const PLANE: [ShapeKind; 11] = [
    ShapeKind::Ball,
    ShapeKind::Segment,
    ShapeKind::Capsule,
    ShapeKind::Triangle,
    ShapeKind::Cuboid,
    ShapeKind::Polytope,
    ShapeKind::Ellipsoid,
    ShapeKind::TaperedCapsule,
    ShapeKind::Rounded,
    ShapeKind::SupportMap,
    ShapeKind::Plane,
];

/// The kinds of convex shapes that exist in 3D.
pub const SPACE: [ShapeKind; 13] = [
    ShapeKind::Ball,
    ShapeKind::Segment,
    ShapeKind::Capsule,
    ShapeKind::Triangle,
    ShapeKind::Cuboid,
    ShapeKind::Polytope,
    ShapeKind::Cylinder,
    ShapeKind::Cone,
    ShapeKind::Ellipsoid,
    ShapeKind::TaperedCapsule,
    ShapeKind::Rounded,
    ShapeKind::SupportMap,
    ShapeKind::Plane,
];

/// Makes a random solid of a kind, about `scale` large.
pub type Sample<N, const D: usize> = fn(ShapeKind, &mut Random, N) -> Box<dyn Shape<N, D>>;

/// Returns a random point up to `scale` away from the origin.
fn point<N: Real, const D: usize>(random: &mut Random, scale: N) -> Point<N, D> {
    let v = random.vector::<N, D>() * scale;
    Point::from(v.map(|x| x * N::lit(random.size_or_zero())))
}

/// Returns a random size between a fifth of `scale` and all of it. With the flag of [`Random`], it
/// is zero in half of the calls.
fn size<N: Real>(random: &mut Random, scale: N) -> N {
    N::lit(random.within(0.2, 1.0) * random.size_or_zero()) * scale
}

/// Returns a solid of a kind that exists in both dimensions. Panics for other kinds.
fn common<N: Real, const D: usize>(
    kind: ShapeKind,
    random: &mut Random,
    scale: N,
) -> Box<dyn Shape<N, D>> {
    match kind {
        ShapeKind::Ball => Box::new(Ball::new(size(random, scale))),
        ShapeKind::Segment => Box::new(Segment::new(point(random, scale), point(random, scale))),
        ShapeKind::Capsule => {
            let (a, b) = (point(random, scale), point(random, scale));
            Box::new(Capsule::<N, D>::try_from_ends(a, b, size(random, scale)).expect("finite"))
        }
        ShapeKind::Triangle => {
            let mut corner = || point(random, scale);
            Box::new(Triangle::<N, D>::new(corner(), corner(), corner()))
        }
        ShapeKind::Cuboid => {
            Box::new(Cuboid::new(Vector::<N, D>::from_fn(|_, _| size(random, scale))))
        }
        ShapeKind::Ellipsoid => {
            Box::new(Ellipsoid::new(Vector::<N, D>::from_fn(|_, _| size(random, scale))))
        }
        ShapeKind::TaperedCapsule => {
            let (a, b) = (point(random, scale), point(random, scale));
            let radii = [size(random, scale), size(random, scale)];
            Box::new(TaperedCapsule::<N, D>::try_from_ends(a, b, radii).expect("finite"))
        }
        ShapeKind::Rounded => rounded(random, scale),
        ShapeKind::SupportMap => {
            let points = (0..7).map(|_| point::<N, D>(random, scale)).collect();
            Box::new(RoundHull { points, rounding: size(random, scale) })
        }
        ShapeKind::Plane => Box::new(Plane::new(Unit::new_unchecked(random.direction::<N, D>()))),
        other => unreachable!("{other:?} has no sample"),
    }
}

/// Returns a rounded solid of a random kind of both dimensions.
fn rounded<N: Real, const D: usize>(random: &mut Random, scale: N) -> Box<dyn Shape<N, D>> {
    let radius = size(random, scale);
    let extents = Vector::<N, D>::from_fn(|_, _| size(random, scale));
    let [a, b, c] = [0; 3].map(|_| point(random, scale));
    match random.bits() % 5 {
        0 => Box::new(Rounded::new(Cuboid::new(extents), radius)),
        1 => Box::new(Rounded::new(Segment::new(a, b), radius)),
        2 => Box::new(Rounded::new(Triangle::new(a, b, c), radius)),
        3 => Box::new(Rounded::new(Ellipsoid::new(extents), radius)),
        _ => Box::new(Rounded::new(RoundHull { points: vec![a, b, c], rounding: radius }, radius)),
    }
}

pub fn sample2<N: Real>(kind: ShapeKind, random: &mut Random, scale: N) -> Box<dyn Shape<N, 2>> {
    match kind {
        ShapeKind::Polytope => polygon(&octagon(random, scale)),
        other => common(other, random, scale),
    }
}

/// Returns a convex octagon, counter-clockwise.
fn octagon<N: Real>(random: &mut Random, scale: N) -> Vec<Point<N, 2>> {
    let stretch = [random.within(0.4, 1.0), random.within(0.4, 1.0)];
    (0..8)
        .map(|corner| {
            let angle =
                (f64::from(corner) + random.within(0.0, 0.8)) * core::f64::consts::FRAC_PI_4;
            let (x, y) = (angle.cos() * stretch[0], angle.sin() * stretch[1]);
            Point::<N, 2>::new(N::lit(x) * scale, N::lit(y) * scale)
        })
        .collect()
}

pub fn sample3<N: Real>(kind: ShapeKind, random: &mut Random, scale: N) -> Box<dyn Shape<N, 3>> {
    match kind {
        ShapeKind::Polytope => {
            let points = (0..12).map(|_| Point::from(random.direction::<N, 3>() * scale));
            hull(&points.collect::<Vec<_>>())
        }
        ShapeKind::Cylinder => Box::new(Cylinder::new(size(random, scale), size(random, scale))),
        ShapeKind::Cone => Box::new(Cone::new(size(random, scale), size(random, scale))),
        other => common(other, random, scale),
    }
}
