//! Decides whether the normal of a contact with one part of a surface is a normal of the whole
//! surface. At a seam, an edge or corner where parts meet, it may not be.

use crate::math::{Point, Real, Space, Vector, unit};
use crate::shape::{FeatureId, SurfaceAccess};

/// Largest length of the difference between a contact's normal and the face's normal, in epsilons,
/// at which the two normals count as equal.
const ROUNDING: f64 = 4096.0;
/// Largest length of the difference between a contact's normal and the face's normal at which the
/// two normals count as equal if the contact is inside the face.
const ON_FACE: f64 = 1.0 / 64.0;
/// A contact's normal whose component along the face's normal is below this belongs to the back of
/// the face.
const BEHIND: f64 = -0.5;

/// To detect a ridge, the normal of the face is moved towards the contact's normal by this fraction
/// of their difference.
const A_LITTLE: f64 = 1.0 / 32.0;

/// Result of [`filter_normal`] for one contact. Normals point away from the part, in the frame of
/// the composite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FilteredNormal<N: Real, const D: usize> {
    /// The part cannot be touched from the position of the other solid.
    Nothing,
    /// The surface admits the contact's normal at the feature.
    Admitted,
    /// The contact's normal is the face's normal, up to rounding or, inside a face, up to
    /// `ON_FACE`. The exact normal of the face is given here.
    Face(Vector<N, D>),
    /// The seam does not admit the contact's normal. A contact with the face, whose normal is given
    /// here, replaces the contact.
    Snapped(Vector<N, D>),
    /// The face of this part ends at a ridge (a convex seam), and the contact's normal lies beyond
    /// all normals that the ridge admits, on the side of the adjacent part. The contact with this
    /// part's face, whose normal is given here, holds only if no other contact explains the
    /// overlap.
    Beyond(Vector<N, D>),
    /// The seam does not admit the contact's normal, and the part has no face.
    Refused,
}

impl<N: Real, const D: usize> FilteredNormal<N, D> {
    /// Returns whether the normal of a face replaces the contact's normal.
    pub(super) const fn is_forced(&self) -> bool {
        matches!(self, Self::Snapped(_) | Self::Beyond(_))
    }

    /// Returns the normal of the face in contact; `None` if there is none.
    pub(super) const fn face(&self) -> Option<Vector<N, D>> {
        match self {
            Self::Face(face) | Self::Snapped(face) | Self::Beyond(face) => Some(*face),
            Self::Nothing | Self::Admitted | Self::Refused => None,
        }
    }
}

/// A contact of a part with the other solid, in the frame of the composite.
pub(super) struct Case<'a, N: Real, const D: usize> {
    pub(super) part: u32,
    /// Computes the feature of the part at the contact; most cases are decided without it.
    pub(super) feature: &'a dyn Fn() -> FeatureId,
    /// Whether the other solid is a ball whose centre is known not to project into the part's face.
    /// `Snapped` and `Beyond` both drop such a contact, so they are not distinguished.
    pub(super) is_beside: bool,
    /// Whether two parts of surfaces overlap. Then the centre of the other part may be inside this
    /// shape.
    pub(super) is_crossed: bool,
    /// Unit normal of the contact, away from the part.
    pub(super) outward: Vector<N, D>,
    /// Vector from the centre of the part to the reference point of the other solid.
    pub(super) toward: Vector<N, D>,
}

/// Returns whether a solid with the reference point `center` can touch the part; true without a
/// surface.
pub(super) fn faces<N: Space<D>, const D: usize>(
    surface: Option<SurfaceAccess<'_, N, D>>,
    part: u32,
    center: &Point<N, D>,
) -> bool {
    surface.is_none_or(|surface| surface.faces(part, center))
}

/// Filters the normal of a contact by the surface of the part's shape; without a surface every
/// normal is admitted.
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
    let tilt = (case.outward - face).norm();
    if tilt <= N::lit(ROUNDING) * N::EPSILON {
        return FilteredNormal::Face(face);
    }
    if is_behind(&case.outward, &face) {
        let is_free = is_touched_from_behind(surface, case, &face);
        return if is_free { FilteredNormal::Admitted } else { FilteredNormal::Snapped(face) };
    }
    let feature = (case.feature)();
    if is_face(feature) && tilt <= N::lit(ON_FACE) {
        return FilteredNormal::Face(face);
    }
    let tilted = if case.is_beside { None } else { tilted(case, &face) };
    let [is_own, is_beyond] = match tilted {
        Some(tilted) => surface.admits_in_turn(case.part, feature, [&case.outward, &tilted]),
        None => [is_admitted(feature), false],
    };
    match (is_own, is_beyond) {
        (true, _) => FilteredNormal::Admitted,
        (false, true) => FilteredNormal::Beyond(face),
        (false, false) => FilteredNormal::Snapped(face),
    }
}

/// Returns whether a normal, taken away from a part, belongs to the back of a face of the part.
pub(super) fn is_behind<N: Space<D>, const D: usize>(
    normal: &Vector<N, D>,
    face: &Vector<N, D>,
) -> bool {
    normal.dot(face) < N::lit(BEHIND)
}

/// Returns whether a contact whose normal belongs to the back of the face holds, although the
/// centre of the other solid is in front of it.
///
/// A solid beside a surface may touch a border from behind:
///
/// ```text
///     surface       ╱       the centre · is above the plane of the surface, the normal of the
///   ──────────────╱    ·    contact points to the right and down
///               ╱
/// ```
///
/// A border admits each normal away from its face, also the normal within the plane of the face,
/// which blunt ridges do not admit. If two parts of surfaces overlap, the centre of the other part
/// proves nothing, and any side or corner that admits the normal is touched.
fn is_touched_from_behind<N: Space<D>, const D: usize>(
    surface: SurfaceAccess<'_, N, D>,
    case: &Case<'_, N, D>,
    face: &Vector<N, D>,
) -> bool {
    let along = case.outward - face * case.outward.dot(face);
    let Some((within, length)) = unit(&along) else { return false };
    if length <= N::lit(ON_FACE) {
        return false;
    }
    let feature = (case.feature)();
    !is_face(feature)
        && (case.is_crossed || surface.admits(case.part, feature, &within))
        && surface.admits(case.part, feature, &case.outward)
}

/// Returns the unit normal of the face, tilted slightly towards the normal of the contact; `None`
/// if the tilted vector has no length. If the seam admits the tilted normal but not the contact's,
/// the part ends at a ridge, and the contact's normal lies beyond all normals of the ridge.
fn tilted<N: Space<D>, const D: usize>(
    case: &Case<'_, N, D>,
    face: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let tilted = face + (case.outward - face) * N::lit(A_LITTLE);
    unit(&tilted).map(|(tilted, _)| tilted)
}

/// Returns whether a feature is a flat face. A segment of a surface in 2D has the feature `Edge`,
/// for which the result is `false`.
fn is_face(feature: FeatureId) -> bool {
    matches!(feature, FeatureId::Face(_))
}
