//! Computes the contact of each pair of parts, with a normal that the surfaces admit.
//!
//! ```text
//!   separation ──> filter_normal ──> combined_normal ──> Nothing   no contact
//!   of the pair    per surface                           Refused   `Left`, without points
//!                                                        Found     points at the nearest points
//!                                                        Forced    points along a face's normal
//! ```

use crate::tables::ByDimension;

use super::Query;
use super::forced::overlooks;
use super::normal_filter::{Case, FilteredNormal, faces, filter_normal, is_behind};
use super::patch::Piece;
use super::scene::{PlacedPair, Scene};
use crate::collide::manifold::{build_between, build_on_face};
use crate::collide::{ManifoldRequest, Pair, RawManifold, RawPoint, RawPoints};
use crate::convex::Separation;
use crate::math::{Point, Real, Space, Vector, min};
use crate::shape::{FeatureId, Kind, SurfaceAccess};

/// Whether a contact of two parts is a contact of the shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PartStatus {
    /// The contact holds, with the normal of the two parts. If this normal is about that of a face,
    /// the exact normal of the face replaces it.
    Own,
    /// The contact is along the normal of a face, because the seam does not admit the normal of the
    /// parts. [`resolve`](super::resolve) drops it if a shallower contact explains the overlap.
    Snapped,
    /// The contact is along the normal of a face that ends at a ridge, and the normal of the parts
    /// lies beyond the ridge. It is dropped if another contact explains the overlap, even one along
    /// the same normal.
    Beyond,
    /// The parts overlap, but no point of the solid that is deepest along the normal of the face is
    /// above the face. [`resolve`](super::resolve) computes the contact with the rest of the solid
    /// if no other contact explains the overlap.
    Missed,
    /// The contact is dropped, unless its parts are the nearest and no remaining contact is as
    /// near.
    Left,
}

/// Contact of two parts that are within the prediction of each other.
#[derive(Clone, Debug)]
pub(crate) struct PartContact<N: Real, const D: usize> {
    /// Signed distance of the two parts alone. [`contact_of_solids`] stores the smallest distance
    /// of the points instead.
    pub(super) distance: N,
    /// Unit vector along which `distance` is measured, from the first shape to the second, in the
    /// frame of the first; zero for a contact that [`contact_of_solids`] computed.
    pub(super) normal: Vector<N, D>,
    /// Manifold of the pair, in the frame of the first shape. It has no points if the filter drops
    /// the contact, nor while [`Self::is_owing`] returns `true`: [`nearest_points`] computes these
    /// points later.
    pub(super) piece: Piece<N, D>,
    /// Smallest distance of the points in `piece`, or minus the overlap of the parts along the front
    /// of a body that is touched from inside; infinite without points. `distance` for a contact with
    /// [`PartStatus::Missed`].
    pub(super) lowest: N,
    pub(super) status: PartStatus,
    /// Normal of the face of the second shape's part in contact, in the frame of the second shape;
    /// `None` for a contact with another feature.
    pub(super) face: Option<Vector<N, D>>,
    /// Bound of the rounding errors of lengths computed for the two parts.
    pub(super) tolerance: N,
}

/// Buffers of one update.
#[derive(Default)]
pub(crate) struct Arena<N: Real, const D: usize> {
    /// Points of all pieces.
    pub(super) points: RawPoints<N, D>,
    /// Largest bound of the rounding errors of lengths computed for parts that were skipped.
    pub(super) rounding: N,
    /// Whether the solid touches every face in contact on its front, and all neighbours of these
    /// faces have their fronts on the same side. Then no face hides another, because the solid is
    /// in front of all these faces.
    pub(super) are_fronts: bool,
    raw: RawManifold<N, D>,
}

impl<N: Real, const D: usize> Arena<N, D> {
    /// Returns the manifold buffer, emptied.
    pub(super) fn blank(&mut self) -> &mut RawManifold<N, D> {
        self.raw.points.clear();
        &mut self.raw
    }
}

impl<N: Real, const D: usize> PartContact<N, D> {
    pub(super) const fn parts(&self) -> [u32; 2] {
        self.piece.parts
    }

    /// Returns whether the contact holds but has no points yet: [`resolve`](super::resolve)
    /// restored it as the contact of the nearest parts.
    pub(super) fn is_owing(&self) -> bool {
        self.status != PartStatus::Left && self.piece.points.is_empty()
    }

    /// Removes the points of a contact along the normal of a face, which miss the contact
    /// ([`overlooks`]), and the face.
    pub(super) fn miss(&mut self) {
        (self.piece.points, self.face) = (0..0, None);
        if self.distance < -self.tolerance {
            (self.status, self.lowest) = (PartStatus::Missed, self.distance);
        } else {
            (self.status, self.lowest) = (PartStatus::Left, N::INFINITY);
        }
    }

    /// Replaces the manifold, and sets `lowest` to the smallest distance of its points.
    pub(super) fn set_piece(&mut self, piece: Piece<N, D>, lowest: N) {
        (self.piece, self.lowest) = (piece, lowest);
    }
}

/// Appends the points of the arena's manifold to the arena's points. Returns the piece and the
/// smallest distance of its points, infinite without points.
pub(super) fn appended<N: Space<D>, const D: usize>(
    placed: &PlacedPair<'_, N, D>,
    parts: [u32; 2],
    arena: &mut Arena<N, D>,
) -> (Piece<N, D>, N) {
    let lowest = arena.raw.points.iter().fold(N::INFINITY, |low, point| min(low, point.distance));
    (placed.piece(&arena.raw, parts, &mut arena.points), lowest)
}

/// Reference point of the first shape in the frame of the second. It decides on which side of a
/// surface the shape is; `None` stands for the centre of the first shape's part.
pub(super) type Reference<N, const D: usize> = Option<Point<N, D>>;

/// Computes the contact of two parts; `known` is their separation, if it is already known. `None`
/// if the parts are beyond the prediction, if their distance is NaN or infinite, or if one is on a
/// side of the other's surface from which it cannot be touched.
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
        // The normal of a half-space is the same everywhere, so seams do not matter.
        return contact_of_solids(placed, parts, request, arena);
    }
    let centers = match scene.surfaces[0] {
        // If the first shape has no surface, centres in its frame are not needed.
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

/// Computes the contact of two parts without a normal filter; `None` if they are beyond the
/// prediction.
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

/// Two parts, at least one of which belongs to a surface.
pub(super) struct PartConfiguration<'a, N: Real, const D: usize> {
    pub(super) placed: &'a PlacedPair<'a, N, D>,
    pub(super) parts: [u32; 2],
    /// Centre of part `i` in the frame of shape `j`, as `centers[i][j]`. If the first shape has no
    /// surface, all are in the frame of the second.
    pub(super) centers: [[Point<N, D>; 2]; 2],
    /// Replaces the centre of the first part in the frame of the second shape, if it is `Some`.
    reference: &'a Reference<N, D>,
}

impl<N: Space<D>, const D: usize> PartConfiguration<'_, N, D> {
    /// Filters the normal of a separation by the surface of each shape. `over` is the feature of
    /// the second part nearest to the centre of a ball, if known.
    fn filtered_normals(
        &self,
        scene: &Scene<'_, N, D>,
        gap: &Separation<N, D>,
        tolerance: N,
        over: Option<FeatureId>,
    ) -> [FilteredNormal<N, D>; 2] {
        // In the frame of each shape: the centre of its own part, and the centre or reference point
        // of the other solid.
        let ([own1, other2], [other1, own2]) = (self.centers[0], self.centers[1]);
        let other2 = self.reference.unwrap_or(other2);
        let [surface1, surface2] = scene.surfaces;
        let normal = self.placed.outward(&gap.normal);
        let outward = [normal, -self.placed.in_second_frame(&normal)];
        let overlaps = gap.distance <= N::ZERO;
        let is_crossed = overlaps && surface1.is_some() && surface2.is_some();
        let touches = |surface: Option<SurfaceAccess<'_, N, D>>, part, center, outward| {
            let is_before = |own: SurfaceAccess<'_, N, D>| {
                let front = own.snapped(part, outward).filter(|_| is_crossed);
                own.is_body(part) || front.is_some_and(|front| !is_behind(outward, &front))
            };
            faces(surface, part, center) || overlaps && surface.is_some_and(is_before)
        };
        let can_touch = touches(surface1, self.parts[0], &other1, &outward[0])
            && touches(surface2, self.parts[1], &other2, &outward[1]);
        if !can_touch {
            return [FilteredNormal::Nothing; 2];
        }
        let [is_second1, is_second2] = self.placed.swapped([false, true]);
        let pair = self.placed.pair();
        let feature =
            |is_second| <N::Algorithms>::witness_feature(&pair, gap, tolerance, is_second);
        let (feature1, feature2) =
            (|| feature(is_second1), || over.unwrap_or_else(|| feature(is_second2)));
        let ([part1, part2], [outward1, outward2]) = (self.parts, outward);
        let (toward1, toward2) = (other1 - own1, other2 - own2);
        let case1 = Case {
            part: part1,
            feature: &feature1,
            is_beside: false,
            is_crossed,
            outward: outward1,
            toward: toward1,
        };
        let case2 = Case {
            part: part2,
            feature: &feature2,
            is_beside: is_beside(over),
            is_crossed,
            outward: outward2,
            toward: toward2,
        };
        let filtered = [filter_normal(surface1, &case1), filter_normal(surface2, &case2)];
        // A side of a crate that is nearest to a flat edge of a floor does not touch this edge: the
        // parts beside both have the contacts.
        let are_forced = filtered.iter().all(FilteredNormal::is_forced);
        let is_apart = gap.distance > tolerance;
        if is_apart && are_forced { [FilteredNormal::Refused; 2] } else { filtered }
    }
}

impl<N: Space<D>, const D: usize> PartConfiguration<'_, N, D> {
    /// Returns whether a contact along `normal` would push one shape into a body of the other:
    /// whether `normal`, taken outward from a part of the body's boundary, makes an angle of more
    /// than 120° with the front normal of this part.
    ///
    /// `normal` is from the first shape to the second, in the frame of the first.
    fn leads_into_body(&self, scene: &Scene<'_, N, D>, normal: &Vector<N, D>) -> bool {
        if !scene.are_bodies(self.parts) {
            return false;
        }
        let outward = [*normal, -self.placed.in_second_frame(normal)];
        scene.surfaces.iter().zip(self.parts).zip(outward).any(|((surface, part), outward)| {
            let surface = surface.filter(|surface| surface.is_body(part));
            let front = surface.and_then(|surface| surface.snapped(part, &outward));
            front.is_some_and(|front| is_behind(&outward, &front))
        })
    }
}

/// Returns whether `over` is a side or corner of a triangle: then the ball's centre does not
/// project into the face. False if the feature is unknown.
pub(super) fn is_beside(over: Option<FeatureId>) -> bool {
    over.is_some_and(|over| !matches!(over, FeatureId::Face(_)))
}

/// Computes the contact of two parts with the separation `gap`, at least one of which belongs to a
/// surface. `None` if the distance is NaN or infinite, or if a surface cannot be touched from the
/// position of the other part.
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
    let mut overlap = -N::INFINITY;
    let status = match combined_normal(placed, &filtered, &normal) {
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
            overlap = configuration.build_forced(scene, gap, face, tolerance, request, raw);
            status
        }
    };
    let is_missed = status != PartStatus::Left && overlooks(&raw.points, distance, tolerance);
    if is_missed {
        raw.points.clear();
    }
    let (piece, lowest) = appended(placed, parts, arena);
    let lowest = if piece.points.is_empty() { lowest } else { min(lowest, -overlap) };
    let face = filtered[1].face().filter(|_| status != PartStatus::Left);
    let mut contact = PartContact { distance, normal, piece, lowest, status, face, tolerance };
    if is_missed {
        contact.miss();
    }
    Some(contact)
}

/// Builds the manifold of two parts at their nearest points, along a normal that the surface
/// admits. `over` is the feature of a triangle whose Voronoi region contains the centre of a ball,
/// if it is certain.
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

/// Returns the feature of a triangle nearest to the centre of a ball; `None` for other pairs and if
/// it is not certain.
fn over<N: Space<D>, const D: usize>(pair: &Pair<'_, N, D>, tolerance: N) -> Option<FeatureId> {
    let (Kind::Ball(_), Kind::Triangle(triangle)) = (&pair.first, &pair.second) else {
        return None;
    };
    let center = pair.pose12.inverse_point(&Point::origin());
    <N::Algorithms>::over(triangle, &center, tolerance)
}

/// Returns whether the filter returned the face's normal if and only if `over` is the face. Then
/// the contact gets the feature `over`. Otherwise the feature is uncertain: a ball close to a side
/// may still have the normal of the face.
pub(super) fn is_certain<N: Real, const D: usize>(
    over: FeatureId,
    filtered: &FilteredNormal<N, D>,
) -> bool {
    matches!(over, FeatureId::Face(_)) == matches!(filtered, FilteredNormal::Face(_))
}

/// Makes the contact point of a ball and a known feature of the second part.
pub(super) fn of_ball<N: Real, const D: usize>(
    witness: &Separation<N, D>,
    over: FeatureId,
) -> RawPoint<N, D> {
    let (point1, distance) = (witness.point1, witness.distance);
    let (feature1, feature2, id) = (FeatureId::Face(0), over, 0);
    RawPoint { point1, distance, feature1, feature2, id, code: 0 }
}

/// Appends the manifold of two parts at their nearest points, without a normal filter. Returns the
/// piece and the smallest distance of its points, infinite without points.
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

/// Combined result of the normal filters of both surfaces. Normals are from the first shape to the
/// second, in the frame of the first.
enum CombinedNormal<N: Real, const D: usize> {
    Nothing,
    Refused,
    /// A contact at the nearest points, with this normal.
    Found(Vector<N, D>),
    /// Contact points along this normal of a face, if there are any.
    Forced(Vector<N, D>, PartStatus),
}

/// Combines the results of both surfaces for `normal`. `normal` and the result are in the frame of
/// the first shape. If both filters force the normal of a face, the face whose normal is closer to
/// `normal` is used. If only one forces it, at a ridge, and `normal` is that of a face of the other
/// surface, this face is used, unless it pushes the shapes into each other: where a side of a crate
/// that is slightly tilted meets a floor, the ridge below the side ends just before the floor's
/// normal.
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
        [Face(own), Beyond(face)] if !is_behind(own, &of_second(face)) => {
            CombinedNormal::Found(*own)
        }
        [Beyond(face), Face(own)] if !is_behind(&of_second(own), face) => {
            CombinedNormal::Found(of_second(own))
        }
        [_, Snapped(face) | Beyond(face)] => CombinedNormal::Forced(of_second(face), status),
        [Snapped(face) | Beyond(face), _] => CombinedNormal::Forced(*face, status),
        [Refused, _] | [_, Refused] => CombinedNormal::Refused,
        [_, Face(face)] => CombinedNormal::Found(of_second(face)),
        [Face(face), _] => CombinedNormal::Found(*face),
        [Admitted, Admitted] => CombinedNormal::Found(*normal),
    }
}
