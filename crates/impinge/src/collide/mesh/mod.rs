//! Contacts of composites: those of the parts, as the whole has them.
//!
//! 1. [`gather`] finds the parts within the prediction: among those in [`part_cache`], where they serve still,
//!    less those that a lower bound rejects ([`cull`]).
//! 2. [`part_contact`] computes the contact of every two parts and asks the surfaces, if there are any, whether
//!    the normal is one that the whole has there ([`normal_filter`]): if it is that of a seam, only contacts with
//!    the face of the part count.
//! 3. [`hidden`] drops contacts from behind a face that is touched from its front, [`resolve`] those that another
//!    contact explains. Solids that overlap always keep a contact.
//! 4. [`inside`] adds the contacts of what lies wholly inside a body and so touches no part.
//! 5. [`patch`] merges what is left into flat patches.
//!
//! Boxes and hulls take step 2 in [`faces`], eight triangles of a surface at a time. [`chain`] does all of this for a
//! chain in 2D, [`ball`] for a ball in 3D.
//!
//! The classes of normals at a seam are those of Catto's chain shapes (Box2D, 2023), whose edges know
//! their neighbours.
//!
//! The contact of a query with a composite is the deepest of the manifolds that a world would have; with a
//! half-space it is that of the nearest part.

mod ball;
#[cfg(test)]
mod ball_tests;
mod chain;
#[cfg(test)]
mod chain_tests;
mod cull;
mod faces;
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
mod resolve;
mod scene;
mod within;

use crate::tables::ByDimension;
use crate::tables::entries;
use core::cell::OnceCell;

use smallvec::SmallVec;

pub(crate) use self::ball::update_on_surface;
pub(crate) use self::chain::update_chain;
pub(crate) use self::faces::face_contacts;
pub(crate) use self::gather::CulledParts;
use self::hidden::are_alike;
pub(crate) use self::over::{over2, over3};
use self::part_cache::PartCache;
pub(crate) use self::part_contact::Arena;
use self::part_contact::{PartContact, PartStatus, Reference};
use self::patch::{Merging, Piece, merge};
pub(crate) use self::patch::{Patch, PatchPoint};
pub(crate) use self::scene::Scene;
use self::within::deepest_within;
pub(crate) use self::within::each_contact_within;
use super::parts::between::Between;
use super::parts::bounds::aabb_of;
use crate::bounding_volume::Ray;
use crate::collide::pair::{Ordered, Placed};
use crate::collide::separation::{of_ordered, placed, touching_of_ordered};
use crate::collide::{ManifoldRequest, Pair, PairIds};
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Space, Vector, max, min};
use crate::shape::{Geometry, Kind, PartSolid, SupportMap};

/// So many points of two parts are kept before they are merged with those of others: all that two
/// facets of usual solids have.
const PART_POINTS: usize = 16;

/// Parts that are farther than the nearest by no more than this part of its distance are looked at
/// too.
const NEARLY: f64 = 1.0 / 64.0;

/// Lengths up to this part of a solid's size are small beside it.
const SMALL: f64 = 1.0 / 4.0;

/// The contacts of two shapes of which one at least is a composite, kept from update to update; in
/// the frame of the first.
#[derive(Clone, Debug)]
pub(crate) struct CompositeContacts<N: Real, const D: usize> {
    patches: Vec<Patch<N, D>>,
    ids: PairIds,
    /// In the frame of the second shape, where the middle of the first was when it was last seen on
    /// the side of the surface that it came from: a solid that was pushed halfway through a surface
    /// with two sides, or jumped there, is still on its old side.
    reference: Reference<N, D>,
    /// The second shape in the frame of the first when the points were found.
    pose12: Pose<N, D>,
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
    /// Forgets what was found of shapes that may be others now; the contacts and their names stay.
    pub(crate) fn forget_shapes(&mut self) {
        self.around = PartCache::default();
    }

    /// A number of each place in memory that an update reads first, of no meaning.
    #[inline]
    pub(crate) fn prefetch(&self) -> N {
        let patch = self.patches.first();
        let point = patch.and_then(|patch| patch.points.first());
        let normal = patch.map_or(N::ZERO, |patch| patch.normal[0]);
        max(max(normal, point.map_or(N::ZERO, |point| point.raw.distance)), self.around.prefetch())
    }

    /// The manifolds.
    pub(crate) fn patches(&self) -> &[Patch<N, D>] {
        &self.patches
    }

    /// How many contact points there are.
    pub(crate) fn len(&self) -> usize {
        self.patches.iter().map(|patch| patch.points.len()).sum()
    }

    /// Calls with the normal, the distance and the first point of each contact.
    pub(crate) fn each_point(&mut self, mut each: impl FnMut(&Vector<N, D>, &mut N, &Point<N, D>)) {
        for Patch { normal, points } in &mut self.patches {
            points.iter_mut().for_each(|point| {
                each(normal, &mut point.raw.distance, &point.raw.point1);
            });
        }
    }

    /// The same contacts with the second shape first.
    pub(crate) fn flip(&mut self) {
        self.reference = None;
        self.forget_shapes();
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
    /// Computes the contacts for new poses, of two shapes or of one with itself; points that
    /// moved keep their ids. Other shapes than before have to be announced
    /// by [`Self::forget_shapes`].
    pub(crate) fn update(
        &mut self,
        between: &Between<'_, N, D>,
        is_self: bool,
        request: &ManifoldRequest<N>,
    ) {
        // What is inside of a body touches no part: that is asked in one way.
        if between.has_bodies() || !<N::Algorithms>::update_quickly(self, between, request) {
            self.update_in_general(between, is_self, request);
        }
    }

    /// [`Self::update`] of any two shapes.
    fn update_in_general(
        &mut self,
        between: &Between<'_, N, D>,
        is_self: bool,
        request: &ManifoldRequest<N>,
    ) {
        let of_parts = of_parts(between, request);
        let around = &mut self.around;
        let culled = gather::culled(between, is_self, of_parts.prediction, around);
        let center = middle_of_first(between);
        // A body knows by itself on which side its inside is.
        let old = self.reference.filter(|_| !between.has_bodies());
        let travelled = Travelled { old, clearance: culled.clearance };
        let reference = center.map(|center| advanced(between, &travelled, center));
        let around = &self.around;
        let query = Query { between, is_self, around, reference: &reference, request: &of_parts };
        let mut arena = Arena::default();
        let contacts = query.part_contacts(request.prediction, &culled, &mut arena);
        self.conclude(&between.pair, request, [reference, center], &contacts, &arena);
    }

    /// Keeps what is found as contacts, and the middle of the first shape: where it counts as being if the
    /// shapes overlap, else where it is.
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
            // Most pairs never have more than one: what lies close together is read faster.
            self.patches.reserve_exact(1);
        }
        let (pieces, points) = (pieces.as_slice(), arena.points.as_slice());
        let size = OnceCell::new();
        let merging = Merging { pair, request, tolerance, pieces, points, size };
        merge(&merging, &self.pose12, &mut self.patches, &mut self.ids);
        self.pose12 = pair.pose12;
    }
}

/// Settling would change nothing: all hold, with faces of about one normal, and as near as the nearest.
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

/// The middle of a convex first shape, in the frame of the second.
fn middle_of_first<N: Real, const D: usize>(between: &Between<'_, N, D>) -> Option<Point<N, D>> {
    let map = Geometry(between.pair.first).as_support_map()?;
    Some(between.pose21.point(&map.center()))
}

/// Where the middle of the first shape was.
struct Travelled<N: Real, const D: usize> {
    old: Reference<N, D>,
    /// No part of the second shape is nearer to where it is.
    clearance: N,
}

/// Where the middle of the first shape counts as being: where it is, unless the straight way there
/// from where it was leads through the surface and is no longer than the shape is.
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
    // Half of what is known to be free leaves room for rounding.
    let is_free = length < clearance * N::HALF;
    if is_free || shift == Vector::<N, D>::zeros() || length > N::TWO * size(map) {
        return center;
    }
    let is_hit = entries::is_crossed(composite, &Ray::new(old, shift), N::ONE);
    if is_hit { old } else { center }
}

/// What is asked of a pair.
pub(crate) struct Query<'a, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    /// The two are one shape.
    is_self: bool,
    /// What is kept of the parts of the second shape.
    around: &'a PartCache<N, D>,
    reference: &'a Reference<N, D>,
    /// What is asked of two parts.
    request: &'a ManifoldRequest<N>,
}

pub(crate) type PartContacts<N, const D: usize> = SmallVec<[PartContact<N, D>; 8]>;

/// Beside more parts than these room is made for all that may be found, so many points at each.
const MANY_PARTS: usize = 32;
const POINTS_AT_A_PART: usize = 4;

impl<N: Space<D>, const D: usize> Query<'_, N, D> {
    /// What some pairs of parts say; which of it holds is settled. Contacts within the `prediction` are asked for,
    /// of parts perhaps more.
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

    /// Settles which of the contacts hold.
    fn resolve_contacts(
        &self,
        scene: &Scene<'_, N, D>,
        found: &mut [PartContact<N, D>],
        arena: &mut Arena<N, D>,
    ) {
        resolve::resolve(scene, found, arena);
        for contact in found.iter_mut().filter(|contact| contact.is_owing()) {
            let (piece, lowest) =
                part_contact::nearest_points(scene, contact.parts(), self.request, arena);
            contact.set_piece(piece, lowest);
        }
    }
}

/// What is asked of two parts: of points that turning brings near, the nearest point may lie on
/// another part, so that is looked at when all are known.
fn of_parts<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    request: &ManifoldRequest<N>,
) -> ManifoldRequest<N> {
    let ManifoldRequest { prediction, sine, .. } = *request;
    let map = Geometry(between.pair.first).as_support_map().filter(|_| sine > N::ZERO);
    let margin = map.map_or(N::ZERO, |map| sine * (N::TWO * size(map)));
    ManifoldRequest { prediction: prediction + margin, sine: N::ZERO, max_points: PART_POINTS }
}

/// No point of a solid is farther from its origin.
fn size<N: Real, const D: usize>(map: &dyn SupportMap<N, D>) -> N {
    map.reach() + map.rounding()
}

/// The contact of two placed shapes in the world frame, `None` beyond `limit`: of composites the
/// deepest of what their manifolds are made of.
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
        // Points that differ by rounding alone are all there, whatever the limit.
        let rounding = rounding(&between);
        let mut found = deepest_within(&between, max(limit, rounding))?;
        let is_close = found.distance > N::ZERO && found.distance <= rounding;
        if is_close && of_ordered(&ordered, N::ZERO).is_some() {
            found = touching(&found);
        }
        return Some(found).filter(|found| found.distance <= limit).map(in_world);
    }
    // The deepest contact of two composites is looked for among all that they have.
    let nearest = match between.composites() {
        [Some(_), Some(_)] => touching_of_ordered(&ordered, limit)?,
        _ => of_ordered(&ordered, limit)?,
    };
    // A half-space has one normal, whatever part it meets: the deepest part has the deepest contact.
    if between.is_half_space_first() && nearest.distance.is_finite_number() {
        return Some(nearest);
    }
    deepest(&between, nearest.distance, limit).map(in_world)
}

/// A length is small beside a convex first shape: to look for the nearest part before those within it is
/// dearer than to look at all of these.
fn is_within_solid<N: Space<D>, const D: usize>(between: &Between<'_, N, D>, limit: N) -> bool {
    let map = Geometry(between.pair.first).as_support_map();
    limit >= N::ZERO && map.is_some_and(|map| limit <= size(map) * N::lit(SMALL))
}

/// Contacts mostly have a kernel of their own: of balls and surfaces, and of chains.
fn has_own_path<N: Space<D>, const D: usize>(between: &Between<'_, N, D>) -> bool {
    let [None, Some(parts)] = between.composites() else { return false };
    if parts.has_bodies() {
        return false;
    }
    let is_chain = || parts.num_parts() > 0 && matches!(parts.part(0).solid, PartSolid::Segment(_));
    matches!(between.pair.first, Kind::Ball(_)) || is_chain()
}

/// The deepest contact of shapes whose distance is known. Of shapes that are apart only the parts as
/// near as the nearest are looked at, unless that is one that cannot be touched.
///
/// A contact that differs from the distance by rounding alone has that: it exists where the shapes touch, and is
/// no overlap where they are apart. One of [`has_own_path`] of shapes that are apart is as it is found without the
/// distance.
fn deepest<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    distance: N,
    limit: N,
) -> Option<Separation<N, D>> {
    let (near, rounding) = (max(distance, N::ZERO), rounding(between));
    // Along the normal of its face a part may be a little farther than it is.
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

/// A contact of shapes that touch, which rounding has left apart.
fn touching<N: Real, const D: usize>(found: &Separation<N, D>) -> Separation<N, D> {
    Separation { distance: N::ZERO, point2: found.point1, ..*found }
}

/// Lengths below this are rounding errors of the pair.
fn rounding<N: Space<D>, const D: usize>(between: &Between<'_, N, D>) -> N {
    let size = |kind: Kind<'_, N, D>| {
        let aabb = aabb_of(kind, &Pose::identity());
        // What is far from its origin has large numbers, too.
        let far = || aabb.half_extents().norm() + aabb.center().coords.norm();
        if aabb.is_bounded() { far() } else { N::ZERO }
    };
    let sizes = size(between.pair.first) + size(between.pair.second);
    N::lit(64.0) * N::EPSILON * (sizes + between.pair.pose12.translation.norm())
}

/// How far those parts of one composite are apart that do not hang together; negative where they
/// overlap, `None` beyond `limit`. The pair is that of the shape with itself.
pub(crate) fn own_distance<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<N> {
    let between = Between::of_pair(pair);
    let candidates = gather::candidates(&between, true, max(limit, N::ZERO));
    let around = PartCache::for_once();
    let scene = Scene::new(&between, &around);
    let one = |&parts| <N::Algorithms>::separation(&scene.pair(parts).pair(), limit);
    let distances = candidates.iter().filter_map(one).map(|found| found.distance);
    distances.reduce(min)
}
