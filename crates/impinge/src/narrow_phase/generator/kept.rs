//! Shapes that a pair knows again from call to call, and keeps for whoever reads its contacts.
//!
//! Solids of a few numbers are copied and compared, hulls are known by a [twin](Polytope::twin) that is shared, and
//! composites, of which nothing is kept, by their [`Revision`].

use std::sync::Arc;

use crate::collide::Solid;
use crate::math::{Real, Space};
use crate::shape::{
    Cone, Cylinder, Ellipsoid, Geometry, Kind, Plane, Polytope, Revision, Rounded, TaperedCapsule,
    Triangle,
};
use crate::tables::ByDimension;

/// A shape as it was at the last call.
#[derive(Clone, Debug)]
pub(super) enum KeptShape<N: Real, const D: usize> {
    Solid(Solid<N, D>),
    Triangle(Triangle<N, D>),
    Polytope(Arc<Polytope<N, D>>),
    Revolved(Revolved<N>),
    Ellipsoid(Ellipsoid<N, D>),
    TaperedCapsule(TaperedCapsule<N, D>),
    Rounded(Rounded<N, D>),
    Plane(Plane<N, D>),
    Composite(Revision),
}

/// A solid of revolution, of space alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Revolved<N: Real> {
    Cylinder(Cylinder<N>),
    Cone(Cone<N>),
}

impl<N: Real, const D: usize> KeptShape<N, D> {
    /// `None` for shapes of the user's own, which may change unnoticed.
    pub(super) fn of(shape: Geometry<'_, N, D>) -> Option<Self> {
        Some(match shape.0 {
            Kind::Ball(_) | Kind::Segment(_) | Kind::Capsule(_) | Kind::Cuboid(_) => {
                Self::Solid(Solid::of(shape)?)
            }
            Kind::Triangle(triangle) => Self::Triangle(*triangle),
            Kind::Polytope(polytope) => Self::Polytope(Arc::clone(polytope.twin())),
            Kind::Cylinder(cylinder, _) => Self::Revolved(Revolved::Cylinder(*cylinder)),
            Kind::Cone(cone, _) => Self::Revolved(Revolved::Cone(*cone)),
            Kind::Ellipsoid(ellipsoid) => Self::Ellipsoid(*ellipsoid),
            Kind::TaperedCapsule(capsule) => Self::TaperedCapsule(*capsule),
            Kind::Rounded(solid) => Self::Rounded(solid.clone()),
            Kind::Plane(plane) => Self::Plane(*plane),
            Kind::Composite(composite) => Self::Composite(composite.revision()?),
            Kind::SupportMap(_) => return None,
        })
    }

    /// A shape answers all questions as the kept one does.
    pub(super) fn is(&self, shape: Geometry<'_, N, D>) -> bool {
        match (self, shape.0) {
            (Self::Solid(kept), _) => Solid::of(shape).as_ref() == Some(kept),
            (Self::Triangle(kept), Kind::Triangle(triangle)) => kept == triangle,
            (Self::Polytope(kept), Kind::Polytope(polytope)) => Arc::ptr_eq(kept, polytope.twin()),
            (Self::Revolved(Revolved::Cylinder(kept)), Kind::Cylinder(cylinder, _)) => {
                kept == cylinder
            }
            (Self::Revolved(Revolved::Cone(kept)), Kind::Cone(cone, _)) => kept == cone,
            (Self::Ellipsoid(kept), Kind::Ellipsoid(ellipsoid)) => kept == ellipsoid,
            (Self::TaperedCapsule(kept), Kind::TaperedCapsule(capsule)) => kept == capsule,
            (Self::Rounded(kept), Kind::Rounded(solid)) => kept.is_same(solid),
            (Self::Plane(kept), Kind::Plane(plane)) => kept == plane,
            (Self::Composite(kept), Kind::Composite(composite)) => {
                composite.revision() == Some(*kept)
            }
            _ => false,
        }
    }

    /// The shape as queries see it; `None` for a composite.
    pub(super) fn geometry(&self) -> Option<Geometry<'_, N, D>>
    where
        N: Space<D>,
    {
        Some(Geometry(match self {
            Self::Solid(solid) => solid.kind(),
            Self::Triangle(triangle) => Kind::Triangle(triangle),
            Self::Polytope(polytope) => Kind::Polytope(polytope),
            Self::Revolved(solid) => <N::Algorithms>::revolved(solid),
            Self::Ellipsoid(ellipsoid) => Kind::Ellipsoid(ellipsoid),
            Self::TaperedCapsule(capsule) => Kind::TaperedCapsule(capsule),
            Self::Rounded(solid) => Kind::Rounded(solid),
            Self::Plane(plane) => Kind::Plane(plane),
            Self::Composite(_) => return None,
        }))
    }
}
