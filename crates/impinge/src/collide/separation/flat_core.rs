//! Solids whose cores are hulls of points, as one type, so that the general algorithm compiled for
//! this type makes no indirect calls.

use crate::math::{Point, Real, Vector};
use crate::shape::{Capsule, Cuboid, Kind, Polytope, Segment, SupportMap, Triangle};

/// A solid whose core is the convex hull of points.
#[derive(Clone, Copy)]
pub(super) enum FlatCore<'a, N: Real, const D: usize> {
    Segment(&'a Segment<N, D>),
    Capsule(&'a Capsule<N, D>),
    Triangle(&'a Triangle<N, D>),
    Cuboid(&'a Cuboid<N, D>),
    Polytope(&'a Polytope<N, D>),
}

impl<'a, N: Real, const D: usize> FlatCore<'a, N, D> {
    /// Makes the variant of a solid; `None` if its core is not a hull of points.
    pub(super) fn of(kind: Kind<'a, N, D>) -> Option<Self> {
        Some(match kind {
            Kind::Segment(segment) => Self::Segment(segment),
            Kind::Capsule(capsule) => Self::Capsule(capsule),
            Kind::Triangle(triangle) => Self::Triangle(triangle),
            Kind::Cuboid(cuboid) => Self::Cuboid(cuboid),
            Kind::Polytope(polytope) => Self::Polytope(polytope),
            _ => return None,
        })
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for FlatCore<'_, N, D> {
    #[inline]
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        match self {
            Self::Segment(segment) => segment.core_support(direction),
            Self::Capsule(capsule) => capsule.core_support(direction),
            Self::Triangle(triangle) => triangle.core_support(direction),
            Self::Cuboid(cuboid) => cuboid.core_support(direction),
            Self::Polytope(polytope) => polytope.core_support(direction),
        }
    }

    fn rounding(&self) -> N {
        if let Self::Capsule(capsule) = self { capsule.radius() } else { N::ZERO }
    }

    fn center(&self) -> Point<N, D> {
        match self {
            Self::Segment(segment) => segment.center(),
            Self::Capsule(capsule) => capsule.center(),
            Self::Triangle(triangle) => triangle.center(),
            Self::Cuboid(cuboid) => cuboid.center(),
            Self::Polytope(polytope) => polytope.center(),
        }
    }

    fn reach(&self) -> N {
        match self {
            Self::Segment(segment) => segment.reach(),
            Self::Capsule(capsule) => capsule.reach(),
            Self::Triangle(triangle) => triangle.reach(),
            Self::Cuboid(cuboid) => cuboid.reach(),
            Self::Polytope(polytope) => polytope.reach(),
        }
    }
}
