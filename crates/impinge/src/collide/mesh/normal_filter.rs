//! Whether a contact with one part of a surface is one of the whole.

use crate::math::{Point, Real, Space, Vector, unit};
use crate::shape::{FeatureId, SurfaceAccess};

/// Normals this many rounding units from a face's own are that one.
const ROUNDING: f64 = 4096.0;
/// On a face there is no other normal than its own: what differs by less is that one.
const ON_FACE: f64 = 1.0 / 64.0;
/// A normal that points this far to the other side of a face is one of the other side.
pub(super) const BEHIND: f64 = -0.5;

/// To look for a ridge a face's normal is leaned by this part of the way to another: by more than
/// what counts as flat.
const A_LITTLE: f64 = 1.0 / 32.0;

/// What a surface says of a contact of one of its parts. Normals are away from the part, in the
/// frame of the composite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FilteredNormal<N: Real, const D: usize> {
    /// The part cannot be touched from where the other solid is.
    Nothing,
    /// The surface has this normal there.
    Admitted,
    /// The normal is that of the face, but for rounding.
    Face(Vector<N, D>),
    /// The normal is that of a seam. Contacts with the face itself have this one.
    Snapped(Vector<N, D>),
    /// The normal lies beyond those of a ridge, at whose other side another part has a face: this
    /// one's counts only if no other contact explains the overlap.
    Beyond(Vector<N, D>),
    /// The normal is that of a seam, and there is no face.
    Refused,
}

impl<N: Real, const D: usize> FilteredNormal<N, D> {
    /// The normal of the face that a contact would be with.
    pub(super) const fn face(&self) -> Option<Vector<N, D>> {
        match self {
            Self::Face(face) | Self::Snapped(face) | Self::Beyond(face) => Some(*face),
            Self::Nothing | Self::Admitted | Self::Refused => None,
        }
    }
}

/// The contact of a part with the other solid, as seen by the composite.
pub(super) struct Case<'a, N: Real, const D: usize> {
    pub(super) part: u32,
    /// Where on the part; most cases are settled without it.
    pub(super) feature: &'a dyn Fn() -> FeatureId,
    /// The other solid is beside the part, so that [`FilteredNormal::Snapped`] says as much as
    /// [`FilteredNormal::Beyond`].
    pub(super) is_beside: bool,
    /// Unit, away from the part.
    pub(super) outward: Vector<N, D>,
    /// From the part to where the other solid comes from.
    pub(super) toward: Vector<N, D>,
}

/// The solid at `center` can touch the part.
pub(super) fn faces<N: Space<D>, const D: usize>(
    surface: Option<SurfaceAccess<'_, N, D>>,
    part: u32,
    center: &Point<N, D>,
) -> bool {
    surface.is_none_or(|surface| surface.faces(part, center))
}

/// What the surface of a shape, if it has one, says of a contact.
pub(super) fn filter_normal<N: Space<D>, const D: usize>(
    surface: Option<SurfaceAccess<'_, N, D>>,
    case: &Case<'_, N, D>,
) -> FilteredNormal<N, D> {
    let Some(surface) = surface else { return FilteredNormal::Admitted };
    let is_admitted = |feature| surface.admits(case.part, feature, &case.outward);
    let Some(face) = surface.snapped(case.part, &case.toward) else {
        return if is_admitted((case.feature)()) {
            FilteredNormal::Admitted
        } else {
            FilteredNormal::Refused
        };
    };
    let lean = (case.outward - face).norm();
    if lean <= N::lit(ROUNDING) * N::EPSILON {
        return FilteredNormal::Face(face);
    }
    if case.outward.dot(&face) < N::lit(BEHIND) {
        return FilteredNormal::Snapped(face);
    }
    let feature = (case.feature)();
    if is_face(feature) && lean <= N::lit(ON_FACE) {
        return FilteredNormal::Face(face);
    }
    let leaning = if case.is_beside { None } else { leaning(case, &face) };
    let [is_own, is_beyond] = match leaning {
        Some(leaning) => surface.admits_in_turn(case.part, feature, [&case.outward, &leaning]),
        None => [is_admitted(feature), false],
    };
    match (is_own, is_beyond) {
        (true, _) => FilteredNormal::Admitted,
        (false, true) => FilteredNormal::Beyond(face),
        (false, false) => FilteredNormal::Snapped(face),
    }
}

/// What tells that the part ends at a ridge, and that the normal, which is not one of the ridge's, lies
/// beyond all that are: seen from the face, normals that lean a little the same way are the ridge's.
fn leaning<N: Space<D>, const D: usize>(
    case: &Case<'_, N, D>,
    face: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let leaning = face + (case.outward - face) * N::lit(A_LITTLE);
    unit(&leaning).map(|(leaning, _)| leaning)
}

/// A flat piece; for the segments of a surface in 2D that is an edge.
fn is_face(feature: FeatureId) -> bool {
    matches!(feature, FeatureId::Face(_))
}
