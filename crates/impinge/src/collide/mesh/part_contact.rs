//! The contact of each pair of parts, by the normals that the surfaces have.

use crate::tables::ByDimension;

use super::Query;
use super::normal_filter::{BEHIND, Case, FilteredNormal, faces, filter_normal};
use super::patch::Piece;
use super::scene::{PlacedPair, Scene};
use crate::collide::manifold::{Along, build_along, build_between, build_on_face};
use crate::collide::{ManifoldRequest, Pair, RawManifold, RawPoint, RawPoints};
use crate::convex::Separation;
use crate::math::{Point, Real, Space, Vector, min};
use crate::shape::{FeatureId, Kind, SurfaceAccess};

/// Whether a contact of two parts is one of the two shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PartStatus {
    /// It is one.
    Own,
    /// It is one with the face of a part, whose seams the parts alone would touch at.
    Snapped,
    /// The same, beyond a ridge: it is one if nothing else explains that the parts overlap.
    Beyond,
    /// It is none, as long as there is another.
    Left,
}

/// The contact of two parts that are within reach of each other.
#[derive(Clone, Debug)]
pub(crate) struct PartContact<N: Real, const D: usize> {
    /// How far the two are apart, each taken alone, and along which normal, from the first shape to
    /// the second in the frame of the first; zero where several say so.
    pub(super) distance: N,
    pub(super) normal: Vector<N, D>,
    /// What they say of the contact of the shapes, in the frame of the first. Without points where
    /// that is no contact of the shapes: few are asked for it, see [`nearest_points`].
    pub(super) piece: Piece<N, D>,
    /// The least distance of the piece's points.
    pub(super) lowest: N,
    pub(super) status: PartStatus,
    /// The normal of the face of the second shape's part that touches, in the second's frame; `None`
    /// if it touches otherwise.
    pub(super) face: Option<Vector<N, D>>,
    /// Lengths below this are rounding errors.
    pub(super) tolerance: N,
}

/// The memory of one update: the points of all contacts, and the manifold that is being made.
#[derive(Default)]
pub(crate) struct Arena<N: Real, const D: usize> {
    /// The points of all pieces.
    pub(super) points: RawPoints<N, D>,
    /// What counts as rounding of parts that were passed over.
    pub(super) rounding: N,
    /// All faces that are touched are fronts of a surface that has its fronts on one side: none hides another, since the
    /// solid is in front of all.
    pub(super) are_fronts: bool,
    raw: RawManifold<N, D>,
}

impl<N: Real, const D: usize> Arena<N, D> {
    /// An empty manifold to be made.
    pub(super) fn blank(&mut self) -> &mut RawManifold<N, D> {
        self.raw.points.clear();
        &mut self.raw
    }
}

impl<N: Real, const D: usize> PartContact<N, D> {
    pub(super) const fn parts(&self) -> [u32; 2] {
        self.piece.parts
    }

    /// It holds, but what it said along a face's normal does not: its nearest points are still to be found.
    pub(super) fn is_owing(&self) -> bool {
        self.status != PartStatus::Left && self.piece.points.is_empty()
    }

    /// Replaces the points.
    pub(super) fn set_piece(&mut self, piece: Piece<N, D>, lowest: N) {
        (self.piece, self.lowest) = (piece, lowest);
    }
}

/// Appends the manifold of two parts to the points; answers the piece and its least distance.
fn appended<N: Space<D>, const D: usize>(
    placed: &PlacedPair<'_, N, D>,
    parts: [u32; 2],
    arena: &mut Arena<N, D>,
) -> (Piece<N, D>, N) {
    let lowest = arena.raw.points.iter().fold(N::INFINITY, |low, point| min(low, point.distance));
    (placed.piece(&arena.raw, parts, &mut arena.points), lowest)
}

/// Where the solid that meets a surface comes from, where it is not just its middle.
pub(super) type Reference<N, const D: usize> = Option<Point<N, D>>;

/// The contact of two parts, of which the separation may be known; `None` if they are beyond
/// reach or cannot touch.
pub(super) fn compute<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    placed: &PlacedPair<'_, N, D>,
    parts: [u32; 2],
    query: &Query<'_, N, D>,
    known: Option<&Separation<N, D>>,
    arena: &mut Arena<N, D>,
) -> Option<PartContact<N, D>> {
    let (reference, request) = (query.reference, query.request);
    let has_surface = scene.surfaces.iter().any(Option::is_some);
    if !(has_surface && placed.has_centers()) {
        // A half-space has the same normal everywhere: there are no seams to slide over.
        return contact_of_solids(placed, parts, request, arena);
    }
    let centers = match scene.surfaces[0] {
        // Of a convex first shape nothing is asked.
        None => placed.centers_in_second(reference).map(|[other, own]| [[other; 2], [own; 2]])?,
        Some(_) => placed.centers()?,
    };
    let configuration = PartConfiguration { placed, parts, centers, reference };
    let found = match known {
        Some(known) => *known,
        None => <N::Algorithms>::separation(&placed.pair(), request.prediction)?,
    };
    of_surfaces(scene, &configuration, &found, request, arena)
}

/// Solids side by side: their contacts are those of the whole.
pub(super) fn contact_of_solids<N: Space<D>, const D: usize>(
    placed: &PlacedPair<'_, N, D>,
    parts: [u32; 2],
    request: &ManifoldRequest<N>,
    arena: &mut Arena<N, D>,
) -> Option<PartContact<N, D>> {
    <N::Algorithms>::contacts(&placed.pair(), request, arena.blank());
    if arena.raw.points.is_empty() {
        return None;
    }
    let (piece, lowest) = appended(placed, parts, arena);
    let (status, tolerance, face) = (PartStatus::Own, placed.tolerance(), None);
    let normal = Vector::<N, D>::zeros();
    Some(PartContact { distance: lowest, normal, piece, lowest, status, face, tolerance })
}

/// Two parts, of which one at least belongs to a surface.
struct PartConfiguration<'a, N: Real, const D: usize> {
    placed: &'a PlacedPair<'a, N, D>,
    parts: [u32; 2],
    /// Of the part of the first shape and of that of the second, as seen by both shapes.
    centers: [[Point<N, D>; 2]; 2],
    /// Of the first shape, as seen by the second.
    reference: &'a Reference<N, D>,
}

impl<N: Space<D>, const D: usize> PartConfiguration<'_, N, D> {
    /// What the two surfaces say of how near the two parts are. `over` is the feature of the second part that
    /// a ball is over, if that is known.
    fn filtered_normals(
        &self,
        scene: &Scene<'_, N, D>,
        gap: &Separation<N, D>,
        tolerance: N,
        over: Option<FeatureId>,
    ) -> [FilteredNormal<N, D>; 2] {
        // Where the other solid comes from, and the part itself, as the shape of the part sees it.
        let ([own1, other2], [other1, own2]) = (self.centers[0], self.centers[1]);
        let other2 = self.reference.unwrap_or(other2);
        let [surface1, surface2] = scene.surfaces;
        let touches = |surface: Option<SurfaceAccess<'_, N, D>>, part, center| {
            let overlaps =
                || gap.distance <= N::ZERO && surface.is_some_and(|own| own.is_body(part));
            faces(surface, part, center) || overlaps()
        };
        let can_touch =
            touches(surface1, self.parts[0], &other1) && touches(surface2, self.parts[1], &other2);
        if !can_touch {
            return [FilteredNormal::Nothing; 2];
        }
        let [is_second1, is_second2] = self.placed.swapped([false, true]);
        let pair = self.placed.pair();
        let feature =
            |is_second| <N::Algorithms>::witness_feature(&pair, gap, tolerance, is_second);
        let (feature1, feature2) =
            (|| feature(is_second1), || over.unwrap_or_else(|| feature(is_second2)));
        let normal = self.placed.outward(&gap.normal);
        let (part, toward) = (self.parts[0], other1 - own1);
        let case1 = Case { part, feature: &feature1, is_beside: false, outward: normal, toward };
        let (part, toward) = (self.parts[1], other2 - own2);
        let (outward, is_beside) = (-self.placed.in_second_frame(&normal), is_beside(over));
        let case2 = Case { part, feature: &feature2, is_beside, outward, toward };
        [filter_normal(surface1, &case1), filter_normal(surface2, &case2)]
    }
}

impl<N: Space<D>, const D: usize> PartConfiguration<'_, N, D> {
    /// A normal, from the first shape to the second in the frame of the first, pushes what touches a body into it: as
    /// the face of a surface does that lies in a wall of the body, and has the inside on its back as well.
    fn leads_into_body(&self, scene: &Scene<'_, N, D>, normal: &Vector<N, D>) -> bool {
        if !scene.are_bodies(self.parts) {
            return false;
        }
        let outward = [*normal, -self.placed.in_second_frame(normal)];
        scene.surfaces.iter().zip(self.parts).zip(outward).any(|((surface, part), outward)| {
            let surface = surface.filter(|surface| surface.is_body(part));
            let front = surface.and_then(|surface| surface.snapped(part, &outward));
            front.is_some_and(|front| front.dot(&outward) < N::lit(BEHIND))
        })
    }
}

/// A ball over a side or a corner has no point over the face.
pub(super) fn is_beside(over: Option<FeatureId>) -> bool {
    over.is_some_and(|over| !matches!(over, FeatureId::Face(_)))
}

/// The contact of two parts, of which one at least belongs to a surface.
fn of_surfaces<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    configuration: &PartConfiguration<'_, N, D>,
    gap: &Separation<N, D>,
    request: &ManifoldRequest<N>,
    arena: &mut Arena<N, D>,
) -> Option<PartContact<N, D>> {
    let (placed, parts, distance) = (configuration.placed, configuration.parts, gap.distance);
    if !distance.is_finite_number() {
        return None;
    }
    let (pair, tolerance) = (placed.pair(), placed.tolerance());
    let over = over(&pair, tolerance);
    let filtered = configuration.filtered_normals(scene, gap, tolerance, over);
    let normal = placed.outward(&gap.normal);
    let raw = arena.blank();
    let mut status = match combined_normal(placed, &filtered, &normal) {
        CombinedNormal::Nothing => return None,
        CombinedNormal::Refused => PartStatus::Left,
        CombinedNormal::Found(normal) | CombinedNormal::Forced(normal, _)
            if configuration.leads_into_body(scene, &normal) =>
        {
            PartStatus::Left
        }
        CombinedNormal::Forced(..) if is_beside(over) => PartStatus::Left,
        CombinedNormal::Found(normal) => {
            let witness = Separation { normal: placed.inward(&normal), ..*gap };
            let over = over.filter(|over| is_certain(*over, &filtered[1]));
            build_touching(&pair, &witness, over, (tolerance, request), raw);
            PartStatus::Own
        }
        CombinedNormal::Forced(face, status) => {
            // What touches but for rounding does not reach below the face, unless it does from inside of a body.
            let is_below = || {
                distance <= N::ZERO && normal.dot(&face) < N::lit(BEHIND) && scene.are_bodies(parts)
            };
            let touches = distance > -tolerance && !is_below();
            let least = if touches { distance } else { -N::INFINITY };
            let along = Along { normal: placed.inward(&face), least, tolerance };
            build_along(&pair, &along, request, raw);
            status
        }
    };
    if overlooks(&raw.points, distance, tolerance) {
        status = PartStatus::Left;
        raw.points.clear();
    }
    let (piece, lowest) = appended(placed, parts, arena);
    let face = filtered[1].face().filter(|_| status != PartStatus::Left);
    Some(PartContact { distance, normal, piece, lowest, status, face, tolerance })
}

/// Builds the manifold of two parts that touch at their nearest points, with a normal that the surface has there, `over`
/// being the feature that a ball is over if that is certain.
fn build_touching<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    witness: &Separation<N, D>,
    over: Option<FeatureId>,
    (tolerance, request): (N, &ManifoldRequest<N>),
    raw: &mut RawManifold<N, D>,
) {
    let Separation { normal, distance, .. } = witness;
    if let Some(over) = over {
        raw.normal = *normal;
        raw.points.push(of_ball(witness, over));
    } else if !build_on_face(pair, normal, *distance, tolerance, request, raw) {
        build_between(pair, witness, request, raw);
    }
}

/// The feature of a triangle that a ball is over, where that is certain.
fn over<N: Space<D>, const D: usize>(pair: &Pair<'_, N, D>, tolerance: N) -> Option<FeatureId> {
    let (Kind::Ball(_), Kind::Triangle(triangle)) = (&pair.first, &pair.second) else {
        return None;
    };
    let center = pair.pose12.inverse_point(&Point::origin());
    <N::Algorithms>::over(triangle, &center, tolerance)
}

/// The name of a contact is the feature that the ball is over: close to a side a ball may yet have
/// the normal of the face.
pub(super) fn is_certain<N: Real, const D: usize>(
    over: FeatureId,
    filtered: &FilteredNormal<N, D>,
) -> bool {
    matches!(over, FeatureId::Face(_)) == matches!(filtered, FilteredNormal::Face(_))
}

/// The contact of a ball with a known feature.
pub(super) fn of_ball<N: Real, const D: usize>(
    witness: &Separation<N, D>,
    over: FeatureId,
) -> RawPoint<N, D> {
    let (point1, distance) = (witness.point1, witness.distance);
    let (feature1, feature2, id) = (FeatureId::Face(0), over, 0);
    RawPoint { point1, distance, feature1, feature2, id, code: 0 }
}

/// What two parts within reach say on their own of how near they are.
pub(super) fn nearest_points<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    parts: [u32; 2],
    request: &ManifoldRequest<N>,
    arena: &mut Arena<N, D>,
) -> (Piece<N, D>, N) {
    let placed = scene.pair(parts);
    let (pair, raw) = (placed.pair(), arena.blank());
    if let Some(found) = <N::Algorithms>::separation(&pair, request.prediction) {
        build_between(&pair, &found, request, raw);
    }
    appended(&placed, parts, arena)
}

/// The contacts along a face's normal are none, or say that parts that overlap are apart: the face,
/// cut to where the other part is above it, may end beside the overlap.
pub(super) fn overlooks<N: Real, const D: usize>(
    points: &[RawPoint<N, D>],
    distance: N,
    tolerance: N,
) -> bool {
    let highest = if distance <= N::ZERO { tolerance } else { N::INFINITY };
    !points.iter().any(|point| point.distance <= highest)
}

/// What both surfaces together say.
enum CombinedNormal<N: Real, const D: usize> {
    Nothing,
    Refused,
    /// A contact with this normal at the witness.
    Found(Vector<N, D>),
    /// Contacts with a face along this normal, where there are some.
    Forced(Vector<N, D>, PartStatus),
}

/// Combines the results of both surfaces; `normal` is the one that they are about. All in the frame of
/// the first shape.
fn combined_normal<N: Space<D>, const D: usize>(
    placed: &PlacedPair<'_, N, D>,
    filtered: &[FilteredNormal<N, D>; 2],
    normal: &Vector<N, D>,
) -> CombinedNormal<N, D> {
    use FilteredNormal::{Admitted, Beyond, Face, Nothing, Refused, Snapped};
    let of_second = |face: &Vector<N, D>| -placed.in_first_frame(face);
    let status = if filtered.iter().any(|filtered| matches!(filtered, Beyond(_))) {
        PartStatus::Beyond
    } else {
        PartStatus::Snapped
    };
    match filtered {
        [Nothing, _] | [_, Nothing] => CombinedNormal::Nothing,
        [Snapped(face1) | Beyond(face1), Snapped(face2) | Beyond(face2)] => {
            let face2 = of_second(face2);
            let is_first_nearer = face1.dot(normal) > face2.dot(normal);
            CombinedNormal::Forced(if is_first_nearer { *face1 } else { face2 }, status)
        }
        [_, Snapped(face) | Beyond(face)] => CombinedNormal::Forced(of_second(face), status),
        [Snapped(face) | Beyond(face), _] => CombinedNormal::Forced(*face, status),
        [Refused, _] | [_, Refused] => CombinedNormal::Refused,
        [_, Face(face)] => CombinedNormal::Found(of_second(face)),
        [Face(face), _] => CombinedNormal::Found(*face),
        [Admitted, Admitted] => CombinedNormal::Found(*normal),
    }
}
