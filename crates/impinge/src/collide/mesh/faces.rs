//! Contacts of a box or a hull with the triangles of a surface in 3D.
//!
//! ```text
//!   near triangles ──> separating axes ──> normal filter ───────> points along the normal
//!                      `gaps3`,            one by one, from the   `FaceClip::each_clip`,
//!                      8 lanes             cached `FaceSeams`     8 lanes
//! ```
//!
//! `FaceSeams` holds the front normals of a triangle and of its neighbours. Where rounding may
//! decide, a kernel leaves the gap or the points undecided. The contact of that triangle then falls
//! back to [`part_contact`], the path of any two parts.

use smallvec::SmallVec;

use super::forced::{least_along, overlooks};
use super::gather::CulledParts;
use super::normal_filter::{Case, FilteredNormal, faces, filter_normal};
use super::part_cache::PartCache;
use super::part_contact::{self, Arena, PartContact, PartStatus};
use super::patch::Piece;
use super::scene::{PlacedPair, Scene};
use super::{PartContacts, Query};
use crate::collide::manifold::face_lanes::{ClipRequest, FaceClip, FaceSolid};
use crate::collide::manifold::frame::ROUNDING_ERRORS;
use crate::collide::packet::{LANES, PartPacket};
use crate::collide::separation::{TiledTriangles, TriangleGap, gaps3};
use crate::math::ones::Ones;
use crate::math::{Mapped, Matrix, Point, Pose, Real, Vector, max};
use crate::shape::{FaceSeams, FeatureId, Geometry, Kind, SurfaceAccess};
use core::cell::Cell;

/// Appends the contacts of a box or a hull with the nearby triangles of a surface. Returns `false`,
/// and appends nothing, for other solids, for hulls with fewer than 4 faces, for shapes with
/// bodies, and unless the parts are cached triangles of a surface. `prediction` is that of the
/// whole shapes; the request for pairs of parts in `query` may have a larger prediction.
pub(crate) fn face_contacts<N: Real>(
    query: &Query<'_, N, 3>,
    scene: &Scene<'_, N, 3>,
    culled: &CulledParts<N>,
    prediction: N,
    contacts: &mut PartContacts<N, 3>,
    arena: &mut Arena<N, 3>,
) -> bool {
    let Some(configuration) = FaceConfiguration::new(query, scene, culled) else { return false };
    arena.are_fronts = true;
    let (tiles, masks, origin) =
        (configuration.around.tiles(), culled.masks.as_slice(), configuration.origin);
    let parts = TiledTriangles { tiles, masks, origin };
    let pose12 = Pose { rotation: configuration.turn, translation: Vector::<N, 3>::zeros() };
    let limit = query.request.prediction;
    let (slot, pending, clip) = (None, PendingClips::default(), FaceClip::blank());
    let mut found = FaceContacts {
        configuration: &configuration,
        contacts,
        arena,
        slot,
        pending,
        clip,
        missing: 0,
    };
    let is_served =
        gaps3(&parts, configuration.solid, &pose12, prediction, limit, &mut |index, gap| {
            found.add(configuration.cache_indices[index], gap);
        });
    found.clip();
    found.drop_missing();
    // If the lanes served nothing, the generic path computes the contacts. It does not check on
    // which side a face is touched, so the flag must be cleared.
    arena.are_fronts &= is_served;
    is_served
}

/// A box or hull and the nearby triangles of a surface.
struct FaceConfiguration<'a, N: Real> {
    query: &'a Query<'a, N, 3>,
    scene: &'a Scene<'a, N, 3>,
    surface: SurfaceAccess<'a, N, 3>,
    around: &'a PartCache<N, 3>,
    solid: Kind<'a, N, 3>,
    /// Rotation from the frame of the solid to that of the surface; its columns are the solid's
    /// axes.
    turn: Matrix<N, 3>,
    /// Origin of the solid in the frame of the surface.
    origin: Vector<N, 3>,
    /// Reference point of the solid, which decides on which side of a triangle the solid is, in the
    /// frame of the surface.
    from: Point<N, 3>,
    /// Bounding radius of the solid's core around its origin.
    reach: N,
    /// Index in the cache of each near triangle, in the order in which `gaps3` numbers the
    /// triangles.
    cache_indices: SmallVec<[usize; 24]>,
}

/// A cached triangle, in the frame of its surface.
struct KeptTriangle<'a, N: Real> {
    part: u32,
    corners: [Point<N, 3>; 3],
    seams: &'a FaceSeams<N>,
    /// Bound of the rounding errors of lengths computed for the triangle and the solid.
    tolerance: N,
}

/// Contact of a triangle after the normal filter, in the frame of the surface.
struct FaceContact<N: Real> {
    /// Unit normal from the triangle to the solid.
    normal: Vector<N, 3>,
    status: PartStatus,
    /// Normal of the face in contact; `None` for a contact with a side or corner, and for a dropped
    /// contact.
    face: Option<Vector<N, 3>>,
}

/// Result of the normal filter for one triangle.
enum SurfaceAnswer<N: Real> {
    Nothing,
    Contact(FaceContact<N>),
    /// The filter needs the touched feature of the triangle, which the gap does not provide.
    Unclear,
}

impl<'a, N: Real> FaceConfiguration<'a, N> {
    /// Returns `None` unless the solid is a box or hull and the cache holds the corners of all
    /// parts, which must be triangles. Also `None` if the second shape has no surface, if one shape
    /// has bodies, because a solid inside a body has contacts too, and if the parts were not culled
    /// by the cache, as for an infinite prediction.
    fn new(
        query: &'a Query<'a, N, 3>,
        scene: &'a Scene<'a, N, 3>,
        culled: &CulledParts<N>,
    ) -> Option<Self> {
        let (between, around, surface) = (query.between, query.around, scene.surfaces[1]?);
        let solid = between.pair.first;
        let is_served = has_faces(solid)
            && culled.masks.len() == around.tiles().len()
            && (culled.parts.is_empty() || !culled.masks.is_empty())
            && around.has_triangles_alone()
            && !between.has_bodies();
        let map = Geometry(solid).as_support_map().filter(|_| is_served)?;
        let from = query.reference.unwrap_or_else(|| between.pose21.point(&map.center()));
        let masks = culled.masks.iter().enumerate();
        let cache_indices = masks.flat_map(|(block, mask)| {
            Ones::<LANES>((*mask).into()).map(move |lane| block * LANES + lane)
        });
        Some(Self {
            query,
            scene,
            surface,
            around,
            solid,
            turn: between.pair.pose12.rotation.transpose(),
            origin: between.pose21.translation,
            from,
            reach: map.reach(),
            cache_indices: cache_indices.collect(),
        })
    }

    /// Returns the triangle at `cache_index` in the cache; `None` if the cache does not hold its
    /// seams.
    fn triangle(&self, cache_index: usize) -> Option<KeptTriangle<'a, N>> {
        let seams = self.around.seams(cache_index)?;
        let corners = self.around.tiles()[cache_index / LANES].corners(cache_index % LANES);
        let squared =
            corners.each_ref().mapped(|corner| (corner.coords - self.origin).norm_squared());
        let size = self.reach + max(squared[0], max(squared[1], squared[2])).sqrt();
        let tolerance = N::lit(ROUNDING_ERRORS) * N::EPSILON * size;
        Some(KeptTriangle { part: self.around.parts()[cache_index], corners, seams, tolerance })
    }

    /// Applies the normal filter of the surface to the gap between a triangle and the solid.
    fn answer(&self, triangle: &KeptTriangle<'_, N>, gap: &TriangleGap<N>) -> SurfaceAnswer<N> {
        let known = triangle.seams.in_surface(self.surface, &triangle.corners[0]);
        let surface = Some(SurfaceAccess::of_own(&known));
        if !gap.distance.is_finite_number() || !faces(surface, triangle.part, &self.from) {
            return SurfaceAnswer::Nothing;
        }
        let [a, b, c] = triangle.corners.each_ref().mapped(|corner| &corner.coords);
        let (middle, is_owing) = ((a + b + c) * N::lit(1.0 / 3.0), Cell::new(false));
        let feature = || {
            is_owing.set(gap.touched.is_none());
            gap.touched.unwrap_or(FeatureId::Face(0))
        };
        let case = Case {
            part: triangle.part,
            feature: &feature,
            is_beside: false,
            is_crossed: false,
            outward: gap.normal,
            toward: self.from.coords - middle,
        };
        let filtered = filter_normal(surface, &case);
        let (normal, status) = match filtered {
            _ if is_owing.get() => return SurfaceAnswer::Unclear,
            FilteredNormal::Nothing => return SurfaceAnswer::Nothing,
            FilteredNormal::Refused => (gap.normal, PartStatus::Left),
            FilteredNormal::Admitted => (gap.normal, PartStatus::Own),
            FilteredNormal::Face(face) => (face, PartStatus::Own),
            FilteredNormal::Snapped(face) => (face, PartStatus::Snapped),
            FilteredNormal::Beyond(face) => (face, PartStatus::Beyond),
        };
        let face = filtered.face().filter(|_| status != PartStatus::Left);
        SurfaceAnswer::Contact(FaceContact { normal, status, face })
    }

    /// Returns the clip request of a contact. `None` for a flat box, and for a contact with
    /// [`PartStatus::Own`] beyond the prediction of the parts. Both fall back to the generic path.
    fn clip_request(
        &self,
        contact: &FaceContact<N>,
        gap: &TriangleGap<N>,
        tolerance: N,
    ) -> Option<ClipRequest<N>> {
        let is_own = contact.status == PartStatus::Own;
        if is_own && gap.distance > self.query.request.prediction {
            return None;
        }
        let least = if is_own {
            -N::INFINITY
        } else {
            least_along(&contact.normal, &gap.normal, gap.distance, tolerance)
        };
        let normal = self.query.between.pair.pose12.vector(&contact.normal);
        ClipRequest::new(self.solid, normal, is_own.then_some(gap.distance), least)
    }
}

/// Returns whether the solid is a box or a hull: the kinds whose features are clipped against
/// triangles in SIMD lanes.
pub(super) const fn has_faces<N: Real, const D: usize>(solid: Kind<'_, N, D>) -> bool {
    matches!(solid, Kind::Cuboid(_) | Kind::Polytope(_))
}

/// Up to 8 triangles that wait to be clipped together. For each triangle, `contacts` holds the
/// index of its contact and its index in the cache.
struct PendingClips<N: Real> {
    triangles: PartPacket<N, 3>,
    requests: SmallVec<[ClipRequest<N>; LANES]>,
    contacts: SmallVec<[(usize, usize); LANES]>,
}

impl<N: Real> Default for PendingClips<N> {
    fn default() -> Self {
        let triangles = PartPacket::blank();
        Self { triangles, requests: SmallVec::new(), contacts: SmallVec::new() }
    }
}

/// The contacts found so far, and the triangles whose contact points are still to be clipped.
struct FaceContacts<'s, 'a, N: Real> {
    configuration: &'s FaceConfiguration<'a, N>,
    contacts: &'s mut PartContacts<N, 3>,
    arena: &'s mut Arena<N, 3>,
    slot: Option<PlacedPair<'a, N, 3>>,
    pending: PendingClips<N>,
    clip: FaceClip<N>,
    /// Number of contacts that the generic path did not confirm; their distance is set to infinity.
    missing: usize,
}

impl<N: Real> FaceContacts<'_, '_, N> {
    /// Appends the contact of a triangle, if it has one. If `gap` is `None`, or
    /// [`Self::add_certain`] returns `None`, the generic path computes the contact.
    fn add(&mut self, cache_index: usize, gap: Option<&TriangleGap<N>>) {
        if gap.is_none_or(|gap| self.add_certain(cache_index, gap).is_none()) {
            let found = self.in_general(cache_index);
            self.contacts.extend(found);
        }
        if self.pending.requests.len() == LANES {
            self.clip();
        }
    }

    /// Appends the contact of a triangle from its gap, if it has one. `None` if the generic path
    /// has to decide.
    fn add_certain(&mut self, cache_index: usize, gap: &TriangleGap<N>) -> Option<()> {
        let triangle = self.configuration.triangle(cache_index)?;
        let contact = match self.configuration.answer(&triangle, gap) {
            SurfaceAnswer::Nothing => return Some(()),
            SurfaceAnswer::Contact(contact) => contact,
            SurfaceAnswer::Unclear => return None,
        };
        if contact.status != PartStatus::Left {
            let request = self.configuration.clip_request(&contact, gap, triangle.tolerance)?;
            self.pending.triangles.put(self.pending.requests.len(), &triangle.corners);
            self.pending.requests.push(request);
            self.pending.contacts.push((self.contacts.len(), cache_index));
        }
        self.note_face(cache_index, contact.face.as_ref());
        let (to_first, parts) = (&self.configuration.query.between.pair.pose12, [0, triangle.part]);
        let normal = -to_first.vector(&contact.normal);
        self.contacts.push(PartContact {
            distance: gap.distance,
            normal: -to_first.vector(&gap.normal),
            piece: Piece { normal, parts, points: 0..0 },
            lowest: N::INFINITY,
            status: contact.status,
            face: contact.face,
            tolerance: triangle.tolerance,
        });
        Some(())
    }

    /// Clears [`Arena::are_fronts`] if the contact is with a face for which [`FaceSeams::is_front`]
    /// does not return `true`.
    fn note_face(&mut self, cache_index: usize, face: Option<&Vector<N, 3>>) {
        let seams = self.configuration.around.seams(cache_index);
        let is_front = |face| seams.is_some_and(|seams: &FaceSeams<N>| seams.is_front(face));
        self.arena.are_fronts &= face.is_none_or(is_front);
    }

    /// Clips the waiting triangles and appends the points of their contacts. The generic path
    /// computes the contacts that the lanes leave undecided.
    fn clip(&mut self) {
        let (PendingClips { triangles, requests, contacts }, configuration) =
            (core::mem::take(&mut self.pending), self.configuration);
        if requests.is_empty() {
            return;
        }
        let solid = FaceSolid {
            solid: configuration.solid,
            turn: &configuration.turn,
            origin: configuration.origin,
            prediction: configuration.query.request.prediction,
        };
        let (mut start, mut left) = (self.arena.points.len(), 0_u8);
        let all = &mut *self.contacts;
        let (clip, points) = (&mut self.clip, &mut self.arena.points);
        solid.each_clip(&triangles, &requests, clip, points, |lane, lowest, points| {
            let contact = &mut all[contacts[lane].0];
            match lowest {
                Some(lowest) => {
                    let range = core::mem::replace(&mut start, points.len())..points.len();
                    if overlooks(&points[range.clone()], contact.distance, contact.tolerance) {
                        contact.miss();
                    } else {
                        (contact.piece.points, contact.lowest) = (range, lowest);
                    }
                }
                None => left |= 1 << lane,
            }
        });
        // Undecided contacts are replaced in place, so `contacts` stays sorted by part.
        for lane in Ones::<LANES>(left.into()) {
            let (contact, cache_index) = &contacts[lane];
            match self.in_general(*cache_index) {
                Some(found) => self.contacts[*contact] = found,
                None => {
                    self.contacts[*contact].distance = N::INFINITY;
                    self.missing += 1;
                }
            }
        }
    }

    /// Computes the contact of a triangle by the generic path; `None` if there is no contact.
    fn in_general(&mut self, cache_index: usize) -> Option<PartContact<N, 3>> {
        let FaceConfiguration { query, scene, around, .. } = *self.configuration;
        let parts = [0, around.parts()[cache_index]];
        let placed = scene.pair_in(&mut self.slot, parts);
        let found = part_contact::compute(scene, placed, parts, query, None, self.arena)?;
        self.note_face(cache_index, found.face.as_ref());
        Some(found)
    }

    /// Removes the contacts that the generic path did not confirm.
    fn drop_missing(&mut self) {
        if self.missing > 0 {
            self.contacts.retain(|contact| contact.distance.is_finite_number());
        }
    }
}
