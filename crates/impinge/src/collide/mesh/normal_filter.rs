//! Decides whether a contact with one part of a surface is a contact of the whole.

use crate::math::{Point, Real, Space, Vector, unit};
use crate::shape::{FeatureId, SurfaceAccess};

/// A normal within this many rounding units of the face's own counts as that.
const ROUNDING: f64 = 4096.0;
/// On a face the only normal is its own: a normal that differs by less counts as that.
const ON_FACE: f64 = 1.0 / 64.0;
/// A normal with a smaller component along the face's own belongs to the other side of the face.
pub(super) const BEHIND: f64 = -0.5;

/// To find a ridge, the normal of the face is tilted by this share towards another: by more than
/// the limit of flatness.
const A_LITTLE: f64 = 1.0 / 32.0;

/// The result of the filter for one contact. Normals are away from the part, in the frame of the
/// composite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FilteredNormal<N: Real, const D: usize> {
    /// The part cannot be touched from the position of the other solid.
    Nothing,
    /// The surface admits the normal at the feature.
    Admitted,
    /// The normal is that of the face, within rounding.
    Face(Vector<N, D>),
    /// The seam does not admit the normal. A contact with the face itself has the normal given
    /// here.
    Snapped(Vector<N, D>),
    /// The normal lies beyond those of a ridge, on whose other side another part has a face. The
    /// contact with this part's face counts only if no other contact explains the overlap.
    Beyond(Vector<N, D>),
    /// The seam does not admit the normal, and the part has no face.
    Refused,
}

impl<N: Real, const D: usize> FilteredNormal<N, D> {
    /// The normal of the face that the contact is with.
    pub(super) const fn face(&self) -> Option<Vector<N, D>> {
        match self {
            Self::Face(face) | Self::Snapped(face) | Self::Beyond(face) => Some(*face),
            Self::Nothing | Self::Admitted | Self::Refused => None,
        }
    }
}

/// The contact of a part with the other solid, in the frame of the composite.
pub(super) struct Case<'a, N: Real, const D: usize> {
    pub(super) part: u32,
    /// The feature of the part at the contact; most cases are decided without it.
    pub(super) feature: &'a dyn Fn() -> FeatureId,
    /// Whether the other solid is beside the part, so that `Snapped` and `Beyond` have the same
    /// effect and need no distinction.
    pub(super) is_beside: bool,
    /// Unit, away from the part.
    pub(super) outward: Vector<N, D>,
    /// From the part to the reference point of the other solid.
    pub(super) toward: Vector<N, D>,
}

/// Whether a solid whose reference point is `center` can touch the part; true without a surface.
pub(super) fn faces<N: Space<D>, const D: usize>(
    surface: Option<SurfaceAccess<'_, N, D>>,
    part: u32,
    center: &Point<N, D>,
) -> bool {
    surface.is_none_or(|surface| surface.faces(part, center))
}

/// Filters the normal of a contact by the surface of a shape; without a surface every normal is
/// admitted.
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

/// Returns the normal of the face tilted slightly towards the normal of the contact. If the seam
/// admits it but not the contact's, the part ends at a ridge, and the contact's normal lies beyond
/// all that the ridge has.
fn leaning<N: Space<D>, const D: usize>(
    case: &Case<'_, N, D>,
    face: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let leaning = face + (case.outward - face) * N::lit(A_LITTLE);
    unit(&leaning).map(|(leaning, _)| leaning)
}

/// Whether a feature is a flat face; a segment of a surface in 2D is an edge instead.
fn is_face(feature: FeatureId) -> bool {
    matches!(feature, FeatureId::Face(_))
}
