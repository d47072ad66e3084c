//! Copies of the solids that the batch kernels support.
//!
//! The narrow phase copies the solids of a pair when the pair begins or a shape is replaced, and
//! keeps the copies with the pair. Queries of a single pair copy the solids for the call.

use crate::math::Real;
use crate::shape::{Ball, Capsule, Cuboid, Geometry, Kind, Segment};

/// A ball, segment, capsule or box, by value. With a copy, the update of a pair does not read the
/// shapes of its objects.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Solid<N: Real, const D: usize> {
    Ball(Ball<N>),
    Segment(Segment<N, D>),
    Capsule(Capsule<N, D>),
    Cuboid(Cuboid<N, D>),
}

impl<N: Real, const D: usize> Solid<N, D> {
    /// Copies a ball, segment, capsule or box; returns `None` for other kinds.
    pub(crate) fn of(geometry: Geometry<'_, N, D>) -> Option<Self> {
        Some(match geometry.0 {
            Kind::Ball(ball) => Self::Ball(*ball),
            Kind::Segment(segment) => Self::Segment(*segment),
            Kind::Capsule(capsule) => Self::Capsule(*capsule),
            Kind::Cuboid(cuboid) => Self::Cuboid(*cuboid),
            _ => return None,
        })
    }

    /// Returns whether a shape has the kind and dimensions of this copy.
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

    /// Returns whether this is a segment or a capsule.
    pub(super) const fn is_segment(&self) -> bool {
        matches!(self, Self::Segment(_) | Self::Capsule(_))
    }

    /// Returns the solid as a [`Kind`], without copying it.
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
