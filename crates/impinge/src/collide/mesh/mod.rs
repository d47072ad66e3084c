//! Contacts of composites: the contacts of their parts that are also contacts of the whole shapes.
//!
//! 1. [`gather`] finds the pairs of parts that may be within the prediction. For a convex solid,
//!    these are the cached parts of the composite ([`part_cache`]) that no lower bound rejects
//!    ([`cull`]). The cache is refilled when the solid leaves its box.
//! 2. [`part_contact`] computes the contact of each pair of parts. If a surface does not admit its
//!    normal at a seam (an edge or corner where parts meet), [`normal_filter`] takes the normal of
//!    the face ([`forced`] finds its points), or drops the contact.
//! 3. [`hidden`] drops contacts with faces that a neighbour hides; [`resolve`] drops contacts whose
//!    overlap ends if another contact is resolved, and finds those of solids that are wide below a
//!    face ([`forced`]) or that a border or ridge holds at its corner ([`at_side`]). Solids that
//!    overlap keep at least one contact, except beside a ghost (a part that stands for a part of a
//!    neighbouring shape).
//! 4. [`inside`] adds contacts of pieces wholly inside a body (a solid with a closed surface).
//! 5. [`patch`] merges the remaining contacts into flat patches.
//!
//! For boxes and hulls, [`faces`] does step 2 for 8 triangles of a surface at a time. [`chain`] (a
//! solid and a chain in 2D) and [`ball`] (a ball and triangles in 3D) do steps 1 and 2.
//!
//! The classes of normals at a seam follow Catto's chain shapes (Box2D, 2023), whose edges store
//! their neighbours.
//!
//! A query for the contact with a composite returns the deepest of the contacts that a world would
//! have. For a half-space and a composite, the query returns the contact of the nearest part.

mod at_side;
mod ball;
#[cfg(test)]
mod ball_tests;
mod chain;
#[cfg(test)]
mod chain_tests;
mod cull;
mod faces;
mod forced;
mod gather;
mod hidden;
mod inside;
mod normal_filter;
mod over;
mod part_cache;
mod part_contact;
mod patch;
mod patch_groups;
mod patch_points;
mod request;
mod resolve;
#[cfg(feature = "serde")]
pub(crate) mod saved;
mod scene;
mod within;

use crate::tables::ByDimension;
use crate::tables::entries;
use core::cell::OnceCell;

use smallvec::SmallVec;

pub(crate) use self::ball::ball_contacts;
pub(crate) use self::chain::chain_contacts;
pub(crate) use self::faces::face_contacts;
pub(crate) use self::gather::CulledParts;
use self::hidden::are_alike;
pub(crate) use self::over::{over2, over3};
use self::part_cache::PartCache;
pub(crate) use self::part_contact::Arena;
use self::part_contact::{PartContact, PartStatus, Reference};
use self::patch::{Merging, Piece, merge};
pub(crate) use self::patch::{Patch, PatchPoint};
use self::request::of_parts;
pub(crate) use self::scene::Scene;
use self::within::deepest_within;
pub(crate) use self::within::{each_contact_within, own_distance};
use super::parts::between::Between;
use super::parts::bounds::aabb_of;
use crate::bounding_volume::Ray;
use crate::collide::pair::{Ordered, Placed};
use crate::collide::separation::{of_ordered, placed, touching_of_ordered};
use crate::collide::{ManifoldRequest, Pair, PairIds};
use crate::convex::Separation;
use crate::math::{Mapped, Point, Pose, Real, Space, Vector, max, min};
use crate::shape::{Geometry, Kind, PartSolid, SupportMap};

/// Points kept for each pair of parts before merging; enough for two facets of common solids.
const PART_POINTS: usize = 16;

/// A query also searches parts farther than the nearest part by up to this fraction of its
/// distance.
const NEARLY: f64 = 1.0 / 64.0;

/// Largest limit, as a fraction of a solid's bounding radius, for which [`is_within_solid`] returns
/// `true`.
const SMALL: f64 = 1.0 / 4.0;

/// Contacts of two shapes, at least one of them a composite, cached between updates. Points and
/// normals are in the frame of the first shape.
#[derive(Clone, Debug)]
pub(crate) struct CompositeContacts<N: Real, const D: usize> {
    patches: Vec<Patch<N, D>>,
    ids: PairIds,
    /// Point, in the frame of the second shape, that decides on which side of the surface the first
    /// shape is: its centre. If the centre crosses the surface in a step of at most twice the
    /// bounding radius, the old point stays while the shapes overlap, so the solid is pushed back.
    /// `None` before an update, after [`Self::flip`], and unless the first shape is convex.
    reference: Reference<N, D>,
    /// Pose of the second shape in the frame of the first at the last update.
    pose12: Pose<N, D>,
    /// Cached parts of the second shape.
    around: PartCache<N, D>,
}

impl<N: Real, const D: usize> Default for CompositeContacts<N, D> {
    fn default() -> Self {
        Self {
            patches: Vec::new(),
            ids: PairIds::default(),
            reference: None,
            pose12: Pose::identity(),
            around: PartCache::default(),
        }
    }
}

impl<N: Real, const D: usize> CompositeContacts<N, D> {
    /// Clears the cached parts, after a shape has changed. The contacts and their ids stay. If a
    /// composite has changed, also clears the reference point: it may be on the other side of the
    /// new surface.
    pub(crate) fn forget_shapes(&mut self, has_composite_changed: bool) {
        self.around = PartCache::default();
        self.reference = self.reference.filter(|_| !has_composite_changed);
    }

    /// Reads the cache lines that the next update needs first, so that they are loaded early; the
    /// returned value is meaningless.
    #[inline]
    pub(crate) fn prefetch(&self) -> N {
        let patch = self.patches.first();
        let point = patch.and_then(|patch| patch.points.first());
        let normal = patch.map_or(N::ZERO, |patch| patch.normal[0]);
        max(max(normal, point.map_or(N::ZERO, |point| point.raw.distance)), self.around.prefetch())
    }

    /// Returns the manifolds, sorted by the smallest pair of parts in each of them.
    pub(crate) fn patches(&self) -> &[Patch<N, D>] {
        &self.patches
    }

    /// Returns the number of contact points in all manifolds.
    pub(crate) fn len(&self) -> usize {
        self.patches.iter().map(|patch| patch.points.len()).sum()
    }

    /// Calls `each` with the normal, the distance and the point on the first shape of each contact
    /// point; `each` may change the distance.
    pub(crate) fn each_point(&mut self, mut each: impl FnMut(&Vector<N, D>, &mut N, &Point<N, D>)) {
        for Patch { normal, points } in &mut self.patches {
            points.iter_mut().for_each(|point| {
                each(normal, &mut point.raw.distance, &point.raw.point1);
            });
        }
    }

    /// Exchanges the two shapes; points and normals are then in the frame of the new first shape.
    /// Clears the reference point and the cache of parts.
    pub(crate) fn flip(&mut self) {
        self.forget_shapes(true);
        let pose21 = self.pose12.inverse();
        for Patch { normal, points } in &mut self.patches {
            for PatchPoint { raw, parts } in points {
                raw.flip(&pose21, normal);
                parts.reverse();
            }
            *normal = -pose21.vector(normal);
        }
        self.pose12 = pose21;
    }
}

impl<N: Space<D>, const D: usize> CompositeContacts<N, D> {
    /// Computes the contacts of two shapes (or of one shape with itself, if `is_self`) for new
    /// poses; contact points that persist keep their ids. If a shape has changed,
    /// [`Self::forget_shapes`] must be called first.
    pub(crate) fn update(
        &mut self,
        between: &Between<'_, N, D>,
        is_self: bool,
        request: &ManifoldRequest<N>,
    ) {
        // Only the generic path handles bodies and ghosts: a solid inside a body touches no part,
        // and a solid that touches only a ghost has its contact with the neighbouring shape that
        // the ghost represents.
        let has_rules = between.has_bodies() || between.has_ghosts();
        if has_rules || !self.update_quickly(between, request) {
            self.update_in_general(between, is_self, request);
        }
    }

    /// Computes the contacts by the specialised path of the pair. Returns `false`, with nothing
    /// changed but the part cache, if the pair needs the generic path.
    fn update_quickly(
        &mut self,
        between: &Between<'_, N, D>,
        request: &ManifoldRequest<N>,
    ) -> bool {
        let (mut contacts, mut arena) = (PartContacts::new(), Arena::default());
        let out = (&mut contacts, &mut arena);
        let points = <N::Algorithms>::quick_contacts(self, between, request, out);
        let Some(points) = points else { return false };
        self.conclude(&between.pair, request, points.mapped(Some), &contacts, &arena);
        true
    }

    /// Computes the contacts by the generic path.
    fn update_in_general(
        &mut self,
        between: &Between<'_, N, D>,
        is_self: bool,
        request: &ManifoldRequest<N>,
    ) {
        let mut of_parts = of_parts(between, request);
        if is_self {
            // The parts of one shape do not rotate against each other.
            of_parts.prediction = request.prediction;
        }
        let around = &mut self.around;
        let culled = gather::culled(between, is_self, of_parts.prediction, around);
        let center = middle_of_first(between);
        // A composite with bodies has an inside, so the old reference point is not used.
        let old = self.reference.filter(|_| !between.has_bodies());
        let travelled = Travelled { old, clearance: culled.clearance };
        let reference = center.map(|center| advanced(between, &travelled, center));
        let around = &self.around;
        let query = Query { between, is_self, around, reference: &reference, request: &of_parts };
        let mut arena = Arena::default();
        let contacts = query.part_contacts(request.prediction, &culled, &mut arena);
        self.conclude(&between.pair, request, [reference, center], &contacts, &arena);
    }

    /// Merges the contacts into patches, and stores the reference point for the next update:
    /// `reference` while the shapes overlap, else `center`.
    fn conclude(
        &mut self,
        pair: &Pair<'_, N, D>,
        request: &ManifoldRequest<N>,
        [reference, center]: [Reference<N, D>; 2],
        contacts: &[PartContact<N, D>],
        arena: &Arena<N, D>,
    ) {
        let overlaps = contacts.iter().any(|contact| contact.distance <= N::ZERO);
        self.reference = if overlaps { reference } else { center };
        let tolerances = contacts.iter().map(|found| found.tolerance);
        let tolerance = tolerances.fold(arena.rounding, max);
        let mut pieces = SmallVec::<[Piece<N, D>; 8]>::with_capacity(contacts.len());
        for found in contacts.iter().filter(|found| found.status != PartStatus::Left) {
            pieces.push(found.piece.clone());
        }
        if !pieces.is_empty() && self.patches.capacity() == 0 {
            // Most pairs never have more than one patch; an exact capacity saves memory.
            self.patches.reserve_exact(1);
        }
        let (pieces, points) = (pieces.as_slice(), arena.points.as_slice());
        let size = OnceCell::new();
        let merging = Merging { pair, request, tolerance, pieces, points, size };
        merge(&merging, &self.pose12, &mut self.patches, &mut self.ids);
        self.pose12 = pair.pose12;
    }
}

/// Returns whether [`Query::resolve_contacts`] would change nothing: all contacts are
/// [`PartStatus::Own`], successive faces have similar normals ([`are_alike`]), and the smallest
/// distance of a point is at most that of the nearest parts (at most zero if these overlap).
fn is_resolved<N: Real, const D: usize>(contacts: &[PartContact<N, D>]) -> bool {
    let (mut distance, mut lowest) = (N::INFINITY, N::INFINITY);
    let mut face: Option<Vector<N, D>> = None;
    for contact in contacts {
        let is_alike = match (face, contact.face) {
            (Some(before), Some(own)) => are_alike(&before, &own),
            _ => true,
        };
        if !(is_alike && contact.status == PartStatus::Own) {
            return false;
        }
        face = contact.face.or(face);
        (distance, lowest) = (min(distance, contact.distance), min(lowest, contact.lowest));
    }
    contacts.is_empty() || lowest <= max(distance, N::ZERO)
}

/// Returns the centre of a convex first shape, in the frame of the second; `None` for a composite
/// and a half-space, which have no centre.
fn middle_of_first<N: Real, const D: usize>(between: &Between<'_, N, D>) -> Option<Point<N, D>> {
    let map = Geometry(between.pair.first).as_support_map()?;
    Some(between.pose21.point(&map.center()))
}

/// Reference point of the last update, and the free space around the new centre.
struct Travelled<N: Real, const D: usize> {
    old: Reference<N, D>,
    /// Lower bound of the distance from the centre of the first shape to the second; zero if
    /// unknown.
    clearance: N,
}

/// Returns the reference point of the first shape. It is the centre, unless the segment from the
/// old reference point to the centre crosses the surface and is at most twice the bounding radius
/// long; then it is the old reference point.
fn advanced<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    travelled: &Travelled<N, D>,
    center: Point<N, D>,
) -> Point<N, D> {
    let Travelled { old, clearance } = *travelled;
    let [_, composite] = between.composites();
    let composite = composite.filter(|composite| composite.surface().is_some());
    let map = Geometry(between.pair.first).as_support_map();
    let (Some(old), Some(composite), Some(map)) = (old, composite, map) else { return center };
    let shift = center - old;
    let length = shift.norm();
    // Half the clearance leaves a margin for rounding.
    let is_free = length < clearance * N::HALF;
    if is_free || shift == Vector::<N, D>::zeros() || length > N::TWO * size(map) {
        return center;
    }
    let is_hit = entries::is_crossed(composite, &Ray::new(old, shift), N::ONE);
    if is_hit { old } else { center }
}

/// The shapes, cached parts and request for which contacts are computed.
pub(crate) struct Query<'a, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    /// Whether both shapes are one composite, whose parts may touch each other.
    is_self: bool,
    /// The cached parts of the second shape.
    around: &'a PartCache<N, D>,
    reference: &'a Reference<N, D>,
    /// The request for each pair of parts.
    request: &'a ManifoldRequest<N>,
}

pub(crate) type PartContacts<N, const D: usize> = SmallVec<[PartContact<N, D>; 8]>;

/// Above this number of pairs of parts, memory is reserved for one contact per pair, with
/// `POINTS_AT_A_PART` points each.
const MANY_PARTS: usize = 32;
const POINTS_AT_A_PART: usize = 4;

impl<N: Space<D>, const D: usize> Query<'_, N, D> {
    /// Computes the contacts of the pairs of parts in `culled`, and decides which of these contacts
    /// hold. `prediction` is that of the whole shapes; `self.request` may have a larger one for the
    /// parts.
    fn part_contacts(
        &self,
        prediction: N,
        culled: &CulledParts<N>,
        arena: &mut Arena<N, D>,
    ) -> PartContacts<N, D> {
        let scene = Scene::new(self.between, self.around);
        let mut contacts = PartContacts::new();
        if culled.parts.len() > MANY_PARTS {
            contacts.reserve(culled.parts.len());
            arena.points.reserve(POINTS_AT_A_PART * culled.parts.len());
        }
        if !<N::Algorithms>::face_contacts(self, &scene, culled, prediction, &mut contacts, arena) {
            let mut slot = None;
            for &parts in &culled.parts {
                let placed = scene.pair_in(&mut slot, parts);
                contacts.extend(part_contact::compute(&scene, placed, parts, self, None, arena));
            }
        }
        let inside = self.take_inside(&mut contacts);
        self.resolve_contacts(&scene, &mut contacts, arena);
        for piece in &inside {
            self.add_inside(&scene, piece, &mut contacts, arena);
        }
        contacts
    }

    /// Decides which contacts hold, and computes the points of the contacts for which
    /// [`PartContact::is_owing`] returns `true`.
    fn resolve_contacts(
        &self,
        scene: &Scene<'_, N, D>,
        found: &mut [PartContact<N, D>],
        arena: &mut Arena<N, D>,
    ) {
        resolve::resolve(scene, self.request, found, arena);
        for contact in found.iter_mut().filter(|contact| contact.is_owing()) {
            let (piece, lowest) =
                part_contact::nearest_points(scene, contact.parts(), self.request, arena);
            contact.set_piece(piece, lowest);
        }
    }
}

/// Returns the bounding radius of a solid around its origin, including its rounding radius.
fn size<N: Real, const D: usize>(map: &dyn SupportMap<N, D>) -> N {
    map.reach() + map.rounding()
}

/// Returns the contact of two placed shapes in the world frame; `None` beyond `limit`. For
/// composites, the last paragraph of the module's description says which contact it is.
pub(crate) fn contact_in_world<N: Space<D>, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let ordered = Ordered::new(placed1, placed2);
    if !ordered.has_composite() {
        return of_ordered(&ordered, limit);
    }
    let between = Between::of_ordered(&ordered);
    let in_world = |found| placed(&found, ordered.first, ordered.swapped);
    if between.pair.pose12.is_finite() && is_within_solid(&between, limit) && has_own_path(&between)
    {
        // Searches at least as far as `rounding`, because touching shapes may seem that far apart.
        let rounding = rounding(&between);
        let mut found = deepest_within(&between, max(limit, rounding))?;
        let is_close = found.distance > N::ZERO && found.distance <= rounding;
        if is_close && of_ordered(&ordered, N::ZERO).is_some() {
            found = touching(&found);
        }
        return Some(found).filter(|found| found.distance <= limit).map(in_world);
    }
    // Two composites need only some touching pair here: `deepest` finds their deepest contact.
    let nearest = match between.composites() {
        [Some(_), Some(_)] => touching_of_ordered(&ordered, limit)?,
        _ => of_ordered(&ordered, limit)?,
    };
    // A half-space has one normal, so the deepest part has the deepest contact.
    if between.is_half_space_first() && nearest.distance.is_finite_number() {
        return Some(nearest);
    }
    deepest(&between, nearest.distance, limit).map(in_world)
}

/// Returns whether `limit` is small relative to a convex first shape. Then a visit of all parts
/// within `limit` costs less than a search for the nearest part first.
fn is_within_solid<N: Space<D>, const D: usize>(between: &Between<'_, N, D>, limit: N) -> bool {
    let map = Geometry(between.pair.first).as_support_map();
    limit >= N::ZERO && map.is_some_and(|map| limit <= size(map) * N::lit(SMALL))
}

/// Returns whether a specialised path computes most pairs of these kinds: a ball with a composite,
/// or any solid with a chain. `false` for composites with bodies or ghosts.
fn has_own_path<N: Space<D>, const D: usize>(between: &Between<'_, N, D>) -> bool {
    let [None, Some(parts)] = between.composites() else { return false };
    if parts.has_bodies() || parts.has_ghosts() {
        return false;
    }
    let is_chain = || parts.num_parts() > 0 && matches!(parts.part(0).solid, PartSolid::Segment(_));
    matches!(between.pair.first, Kind::Ball(_)) || is_chain()
}

/// Returns the deepest contact of shapes whose distance is known; `None` beyond `limit`. Searches
/// only the parts that are about as near as the nearest part. If the surface admits no contact with
/// any of them, searches all parts within `limit`.
///
/// The distance of the contact is corrected if the correction is not larger than rounding. If the
/// shapes touch or overlap but the contact is apart, the distance becomes zero. If the shapes are
/// apart, the distance becomes `distance`, except for pairs for which [`has_own_path`] returns
/// `true`.
fn deepest<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    distance: N,
    limit: N,
) -> Option<Separation<N, D>> {
    let (near, rounding) = (max(distance, N::ZERO), rounding(between));
    // Along the normal of its face, a part may be slightly farther than its distance.
    let max_distance = near + near * N::lit(NEARLY) + rounding;
    let mut found = deepest_within(between, max_distance)
        .or_else(|| deepest_within(between, max(limit, N::ZERO)))?;
    let farther = found.distance - near;
    let is_off = farther > N::ZERO || distance > N::ZERO;
    let touches = distance <= N::ZERO && farther > N::ZERO;
    if is_off && farther.abs() <= rounding && (touches || !has_own_path(between)) {
        found.distance = near;
        found.point2 = found.point1 + found.normal * near;
    }
    (found.distance <= limit).then_some(found)
}

/// Returns the contact `found` with distance zero, for shapes that touch although `found` has a
/// positive distance within rounding error.
fn touching<N: Real, const D: usize>(found: &Separation<N, D>) -> Separation<N, D> {
    Separation { distance: N::ZERO, point2: found.point1, ..*found }
}

/// Returns a bound of the rounding errors of lengths computed for the two shapes.
fn rounding<N: Space<D>, const D: usize>(between: &Between<'_, N, D>) -> N {
    let size = |kind: Kind<'_, N, D>| {
        let aabb = aabb_of(kind, &Pose::identity());
        // Rounding errors grow with the coordinates, so the distance from the origin counts.
        let far = || aabb.half_extents().norm() + aabb.center().coords.norm();
        if aabb.is_bounded() { far() } else { N::ZERO }
    };
    let sizes = size(between.pair.first) + size(between.pair.second);
    N::lit(64.0) * N::EPSILON * (sizes + between.pair.pose12.translation.norm())
}
