//! Copies of the solids that a few numbers describe.
//!
//! A copy is made when a pair begins or a shape is exchanged, and kept with the pair.

use crate::math::Real;
use crate::shape::{Ball, Capsule, Cuboid, Geometry, Kind, Segment};

/// A solid that closed forms treat, by value: what is kept with a pair so that its update need not
/// look for the shapes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Solid<N: Real, const D: usize> {
    Ball(Ball<N>),
    Segment(Segment<N, D>),
    Capsule(Capsule<N, D>),
    Cuboid(Cuboid<N, D>),
}

impl<N: Real, const D: usize> Solid<N, D> {
    /// The same solid; `None` for other kinds.
    pub(crate) fn of(geometry: Geometry<'_, N, D>) -> Option<Self> {
        Some(match geometry.0 {
            Kind::Ball(ball) => Self::Ball(*ball),
            Kind::Segment(segment) => Self::Segment(*segment),
            Kind::Capsule(capsule) => Self::Capsule(*capsule),
            Kind::Cuboid(cuboid) => Self::Cuboid(*cuboid),
            _ => return None,
        })
    }

    /// It has the kind and the numbers of a shape.
    #[inline]
    pub(crate) fn is(&self, geometry: Geometry<'_, N, D>) -> bool {
        match (self, geometry.0) {
            (Self::Ball(own), Kind::Ball(ball)) => own == ball,
            (Self::Segment(own), Kind::Segment(segment)) => own == segment,
            (Self::Capsule(own), Kind::Capsule(capsule)) => own == capsule,
            (Self::Cuboid(own), Kind::Cuboid(cuboid)) => own == cuboid,
            _ => false,
        }
    }

    /// It is a segment, perhaps inflated.
    pub(super) const fn is_segment(&self) -> bool {
        matches!(self, Self::Segment(_) | Self::Capsule(_))
    }

    /// As queries see it.
    #[inline]
    pub(crate) const fn kind(&self) -> Kind<'_, N, D> {
        match self {
            Self::Ball(ball) => Kind::Ball(ball),
            Self::Segment(segment) => Kind::Segment(segment),
            Self::Capsule(capsule) => Kind::Capsule(capsule),
            Self::Cuboid(cuboid) => Kind::Cuboid(cuboid),
        }
    }
}
