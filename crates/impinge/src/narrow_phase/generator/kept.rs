//! Copies of a generator's shapes. The generator compares them with its arguments to detect changed
//! shapes, and readers need them to build manifolds after the call.
//!
//! Small solids are copied and compared. A hull is recognised by its [`twin`](Polytope::twin), a
//! copy that all later clones of the hull share, and a composite by its [`Revision`]; the composite
//! itself is not kept.

use std::sync::Arc;

use crate::collide::Solid;
use crate::math::{Mapped, Pose, Real, Space};
use crate::query::composite::Touched;
use crate::shape::{
    Cone, Cylinder, Ellipsoid, Geometry, Kind, Plane, Polytope, Revision, Rounded, TaperedCapsule,
    Triangle,
};
use crate::tables::ByDimension;

/// A copy of a shape that an update received, or a key that identifies the shape, to detect a
/// change of the shape at the next update.
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

/// A copy of a solid of revolution, which exists in 3D only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Revolved<N: Real> {
    Cylinder(Cylinder<N>),
    Cone(Cone<N>),
}

impl<N: Real, const D: usize> KeptShape<N, D> {
    /// Returns a copy or key of a shape. `None` for a convex shape of a user's type, which may
    /// change without notice, and for a composite without a revision.
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

    /// Returns `true` if `shape` equals the kept shape; all queries of the two then have the same
    /// results.
    pub(super) fn is(&self, shape: Geometry<'_, N, D>) -> bool {
        match (self, shape.0) {
            (Self::Solid(kept), _) => kept.is(shape),
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

    /// Returns the copy of a small solid; `None` for other shapes.
    pub(super) const fn solid(&self) -> Option<&Solid<N, D>> {
        match self {
            Self::Solid(solid) => Some(solid),
            _ => None,
        }
    }

    /// Returns the geometry of the kept shape; `None` for a composite, which is not copied.
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

/// Copies of the two solids on which a contact of a composite lies. From these copies a reader
/// builds the manifold of the contact when the shapes are no longer accessible.
#[derive(Clone, Debug)]
pub(super) struct KeptTouch<N: Real, const D: usize> {
    /// By solid: the touched part and its pose. `None` for a convex shape, which the generator
    /// keeps as a whole.
    parts: [Option<(KeptShape<N, D>, Pose<N, D>)>; 2],
    turns_with_second: Option<bool>,
}

impl<N: Space<D>, const D: usize> KeptTouch<N, D> {
    /// Copies the solids on which a contact lies; `None` if a part is a custom solid.
    /// `are_whole[i]` is `true` if shape `i` is not a composite and kept as a whole.
    pub(super) fn of(touched: &Touched<'_, N, D>, are_whole: [bool; 2]) -> Option<Self> {
        let Touched { solids, poses, turns_with_second, .. } = touched;
        let mut parts = [None, None];
        for which in 0..2 {
            if !are_whole[which] {
                parts[which] = Some((KeptShape::of(Geometry(solids[which]))?, poses[which]));
            }
        }
        Some(Self { parts, turns_with_second: *turns_with_second })
    }

    /// Returns the solids on which the contact lies. `wholes[i]` is shape `i` if it is kept as a
    /// whole. `None` if shape `i` has no part here and `wholes[i]` is `None`.
    pub(super) fn touched<'a>(
        &'a self,
        wholes: [Option<Geometry<'a, N, D>>; 2],
    ) -> Option<Touched<'a, N, D>> {
        let [one, other] =
            [(&self.parts[0], wholes[0]), (&self.parts[1], wholes[1])].mapped(|(part, whole)| {
                match part {
                    Some((solid, pose)) => Some((solid.geometry()?, *pose, true)),
                    None => whole.map(|shape| (shape, Pose::identity(), shape.turns())),
                }
            });
        let ((solid1, pose1, turns1), (solid2, pose2, turns2)) = (one?, other?);
        Some(Touched {
            solids: [solid1.0, solid2.0],
            poses: [pose1, pose2],
            turns: [turns1, turns2],
            turns_with_second: self.turns_with_second,
        })
    }
}
