//! Contacts of a box or a hull with the triangles of a surface in 3D.
//!
//! ```text
//!   near triangles ──> separating axes ──> what the surface says ──> points along the normal
//!                      eight lanes         one by one, from what     eight lanes
//!                                          the pair keeps
//! ```
//!
//! Triangles whose separation is not plain, and those that the lanes leave, go through
//! [`part_contact`] like those of any solid.

use smallvec::SmallVec;

use super::gather::CulledParts;
use super::normal_filter::{Case, FilteredNormal, faces, filter_normal};
use super::part_cache::PartCache;
use super::part_contact::{self, Arena, PartContact, PartStatus, overlooks};
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

/// Appends the contacts of a box or a hull and the triangles of a surface that are kept and near; answers false of
/// others. Contacts within the `prediction` are asked for, of parts perhaps more.
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
    is_served
}

/// A solid among the triangles of a surface.
struct FaceConfiguration<'a, N: Real> {
    query: &'a Query<'a, N, 3>,
    scene: &'a Scene<'a, N, 3>,
    surface: SurfaceAccess<'a, N, 3>,
    around: &'a PartCache<N, 3>,
    solid: Kind<'a, N, 3>,
    /// The solid's axes in the frame of the surface, as columns, and its origin there.
    turn: Matrix<N, 3>,
    origin: Vector<N, 3>,
    /// Where the solid comes from, in the frame of the surface.
    from: Point<N, 3>,
    reach: N,
    /// Of each near triangle its place among those that are kept.
    cache_indices: SmallVec<[usize; 24]>,
}

/// A triangle in the frame of its surface.
struct KeptTriangle<'a, N: Real> {
    part: u32,
    corners: [Point<N, 3>; 3],
    seams: &'a FaceSeams<N>,
    /// Lengths below this are rounding errors of it and the solid.
    tolerance: N,
}

/// A contact that the surface has, in the frame of the surface.
struct FaceContact<N: Real> {
    /// Unit, from the triangle to the solid.
    normal: Vector<N, 3>,
    status: PartStatus,
    /// The normal of the face, if that is touched.
    face: Option<Vector<N, 3>>,
}

/// What a surface says of a triangle.
enum SurfaceAnswer<N: Real> {
    Nothing,
    Contact(FaceContact<N>),
    /// The nearest points are needed.
    Unclear,
}

impl<'a, N: Real> FaceConfiguration<'a, N> {
    /// `None` of other solids and composites, and of bodies, whose insides count as well.
    fn new(
        query: &'a Query<'a, N, 3>,
        scene: &'a Scene<'a, N, 3>,
        culled: &CulledParts<N>,
    ) -> Option<Self> {
        let (between, around, surface) = (query.between, query.around, scene.surfaces[1]?);
        let solid = between.pair.first;
        let is_served = has_faces(solid)
            && culled.masks.len() == around.tiles().len()
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

    /// One of the triangles that are kept; `None` where nothing is known of its seams.
    fn triangle(&self, cache_index: usize) -> Option<KeptTriangle<'a, N>> {
        let seams = self.around.seams(cache_index)?;
        let corners = self.around.tiles()[cache_index / LANES].corners(cache_index % LANES);
        let squared =
            corners.each_ref().mapped(|corner| (corner.coords - self.origin).norm_squared());
        let size = self.reach + max(squared[0], max(squared[1], squared[2])).sqrt();
        let tolerance = N::lit(ROUNDING_ERRORS) * N::EPSILON * size;
        Some(KeptTriangle { part: self.around.parts()[cache_index], corners, seams, tolerance })
    }

    /// What the surface says of a triangle, given how near the solid is.
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

    /// What is asked of the clip for a contact; `None` where the nearest points are needed, or the solid shows no face.
    fn clip_request(
        &self,
        contact: &FaceContact<N>,
        distance: N,
        tolerance: N,
    ) -> Option<ClipRequest<N>> {
        let is_own = contact.status == PartStatus::Own;
        if is_own && distance > self.query.request.prediction {
            return None;
        }
        // What touches but for rounding does not reach below the face.
        let least = if !is_own && distance > -tolerance { distance } else { -N::INFINITY };
        let normal = self.query.between.pair.pose12.vector(&contact.normal);
        ClipRequest::new(self.solid, normal, is_own.then_some(distance), least)
    }
}

/// A solid whose faces are clipped in lanes.
pub(super) const fn has_faces<N: Real, const D: usize>(solid: Kind<'_, N, D>) -> bool {
    matches!(solid, Kind::Cuboid(_) | Kind::Polytope(_))
}

/// Triangles that are to be clipped together, each with the number of its contact and its place.
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

/// The contacts as they are found.
struct FaceContacts<'s, 'a, N: Real> {
    configuration: &'s FaceConfiguration<'a, N>,
    contacts: &'s mut PartContacts<N, 3>,
    arena: &'s mut Arena<N, 3>,
    slot: Option<PlacedPair<'a, N, 3>>,
    pending: PendingClips<N>,
    clip: FaceClip<N>,
    /// So many contacts turned out to be none; they have no distance.
    missing: usize,
}

impl<N: Real> FaceContacts<'_, '_, N> {
    /// Adds the contact of a triangle, of which it may be known how near it is.
    fn add(&mut self, cache_index: usize, gap: Option<&TriangleGap<N>>) {
        if gap.is_none_or(|gap| self.add_certain(cache_index, gap).is_none()) {
            let found = self.in_general(cache_index);
            self.contacts.extend(found);
        }
        if self.pending.requests.len() == LANES {
            self.clip();
        }
    }

    /// Adds the contact of a triangle with a plain gap, if there is one; `None` where the general way finds it.
    fn add_certain(&mut self, cache_index: usize, gap: &TriangleGap<N>) -> Option<()> {
        let triangle = self.configuration.triangle(cache_index)?;
        let contact = match self.configuration.answer(&triangle, gap) {
            SurfaceAnswer::Nothing => return Some(()),
            SurfaceAnswer::Contact(contact) => contact,
            SurfaceAnswer::Unclear => return None,
        };
        if contact.status != PartStatus::Left {
            let request =
                self.configuration.clip_request(&contact, gap.distance, triangle.tolerance)?;
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

    /// Notes whether a face that is touched is a front.
    fn note_face(&mut self, cache_index: usize, face: Option<&Vector<N, 3>>) {
        let seams = self.configuration.around.seams(cache_index);
        let is_front = |face| seams.is_some_and(|seams: &FaceSeams<N>| seams.is_front(face));
        self.arena.are_fronts &= face.is_none_or(is_front);
    }

    /// Finds the points of the triangles that are due.
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
                        (contact.status, contact.face) = (PartStatus::Left, None);
                    } else {
                        (contact.piece.points, contact.lowest) = (range, lowest);
                    }
                }
                None => left |= 1 << lane,
            }
        });
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

    /// The contact of a triangle as of any two parts.
    fn in_general(&mut self, cache_index: usize) -> Option<PartContact<N, 3>> {
        let FaceConfiguration { query, scene, around, .. } = *self.configuration;
        let parts = [0, around.parts()[cache_index]];
        let placed = scene.pair_in(&mut self.slot, parts);
        let found = part_contact::compute(scene, placed, parts, query, None, self.arena)?;
        self.note_face(cache_index, found.face.as_ref());
        Some(found)
    }

    fn drop_missing(&mut self) {
        if self.missing > 0 {
            self.contacts.retain(|contact| contact.distance.is_finite_number());
        }
    }
}
