//! Contacts of a box or a hull with the triangles of a surface in 3D.
//!
//! ```text
//!   near triangles ──> separating axes ──> normal filter ───────> points along the normal
//!                      `gaps3`,            one by one, from the   `FaceSolid::each_clip`,
//!                      eight lanes         cached `FaceSeams`     eight lanes
//! ```
//!
//! A triangle whose gap is not plain, or that a kernel leaves undecided, falls back to
//! [`part_contact`], the path of any two parts.

use smallvec::SmallVec;

use super::gather::Nearby;
use super::normal_filter::{Case, FilteredNormal, faces, filter_normal};
use super::part_cache::PartCache;
use super::part_contact::{self, Arena, PartContact, PartStatus, overlooks};
use super::patch::Piece;
use super::scene::{PlacedPair, Scene};
use super::{PartContacts, Query};
use crate::collide::manifold::face_lanes::{FaceClip, FaceSolid, TriangleAsked};
use crate::collide::manifold::frame::ROUNDING_ERRORS;
use crate::collide::packet::{LANES, PartPacket};
use crate::collide::separation::{TiledTriangles, TriangleGap, gaps3};
use crate::math::ones::Ones;
use crate::math::{Mapped, Matrix, Point, Pose, Real, Vector, max};
use crate::shape::{FaceSeams, FeatureId, Geometry, Kind, SurfaceAccess};
use core::cell::Cell;

/// Appends the contacts of a box or a hull with the nearby triangles of a surface. Returns `false`
/// for other solids and composites. `prediction` is that of the whole shapes; the request for parts
/// in `query` may have a larger one.
pub(crate) fn face_contacts<N: Real>(
    query: &Query<'_, N, 3>,
    scene: &Scene<'_, N, 3>,
    nearby: &Nearby<N>,
    prediction: N,
    contacts: &mut PartContacts<N, 3>,
    arena: &mut Arena<N, 3>,
) -> bool {
    let Some(meeting) = FaceMeeting::new(query, scene, nearby) else { return false };
    arena.are_fronts = true;
    let (tiles, near, origin) = (meeting.around.tiles(), nearby.near.as_slice(), meeting.origin);
    let parts = TiledTriangles { tiles, near, origin };
    let pose12 = Pose { rotation: meeting.turn, translation: Vector::<N, 3>::zeros() };
    let limit = query.request.prediction;
    let (slot, due, clip) = (None, Due::default(), FaceClip::blank());
    let mut found =
        FaceContacts { meeting: &meeting, contacts, arena, slot, due, clip, missing: 0 };
    let is_served = gaps3(&parts, meeting.solid, &pose12, prediction, limit, &mut |index, gap| {
        found.add(meeting.places[index], gap);
    });
    found.clip();
    found.drop_missing();
    is_served
}

/// A box or hull and the nearby triangles of a surface.
struct FaceMeeting<'a, N: Real> {
    query: &'a Query<'a, N, 3>,
    scene: &'a Scene<'a, N, 3>,
    surface: SurfaceAccess<'a, N, 3>,
    around: &'a PartCache<N, 3>,
    solid: Kind<'a, N, 3>,
    /// The rotation from the frame of the solid to that of the surface, whose columns are the axes
    /// of the solid, and the origin of the solid in the frame of the surface.
    turn: Matrix<N, 3>,
    origin: Vector<N, 3>,
    /// The reference point of the solid, which decides sides, in the frame of the surface.
    from: Point<N, 3>,
    reach: N,
    /// The index in the cache of each near triangle, in the order in which `gaps3` counts them.
    places: SmallVec<[usize; 24]>,
}

/// A cached triangle, in the frame of its surface.
struct KeptTriangle<'a, N: Real> {
    part: u32,
    corners: [Point<N, 3>; 3],
    seams: &'a FaceSeams<N>,
    /// Bound of the rounding errors of lengths of the triangle and the solid.
    tolerance: N,
}

/// A contact that the surface admits, in the frame of the surface.
struct FaceContact<N: Real> {
    /// Unit, from the triangle to the solid.
    normal: Vector<N, 3>,
    status: PartStatus,
    /// The normal of the face in contact; `None` for a side or corner, and for a dropped contact.
    face: Option<Vector<N, 3>>,
}

/// The result of the normal filter for one triangle.
enum SurfaceAnswer<N: Real> {
    Nothing,
    Contact(FaceContact<N>),
    /// The filter needs the touched feature, which the gap does not name.
    Unclear,
}

impl<'a, N: Real> FaceMeeting<'a, N> {
    /// `None` unless a box or hull meets a surface whose cached parts are all triangles. Also
    /// `None` for bodies: a solid inside them has contacts too.
    fn new(
        query: &'a Query<'a, N, 3>,
        scene: &'a Scene<'a, N, 3>,
        nearby: &Nearby<N>,
    ) -> Option<Self> {
        let (between, around, surface) = (query.between, query.around, scene.surfaces[1]?);
        let solid = between.pair.first;
        let is_served = has_faces(solid)
            && nearby.near.len() == around.tiles().len()
            && around.has_triangles_alone()
            && !between.has_bodies();
        let map = Geometry(solid).as_support_map().filter(|_| is_served)?;
        let from = query.reference.unwrap_or_else(|| between.pose21.point(&map.center()));
        let near = nearby.near.iter().enumerate();
        let places = near.flat_map(|(block, near)| {
            Ones::<LANES>((*near).into()).map(move |lane| block * LANES + lane)
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
            places: places.collect(),
        })
    }

    /// Returns a cached triangle; `None` if its seams are unknown.
    fn triangle(&self, place: usize) -> Option<KeptTriangle<'a, N>> {
        let seams = self.around.seams(place)?;
        let corners = self.around.tiles()[place / LANES].corners(place % LANES);
        let squared =
            corners.each_ref().mapped(|corner| (corner.coords - self.origin).norm_squared());
        let size = self.reach + max(squared[0], max(squared[1], squared[2])).sqrt();
        let tolerance = N::lit(ROUNDING_ERRORS) * N::EPSILON * size;
        Some(KeptTriangle { part: self.around.parts()[place], corners, seams, tolerance })
    }

    /// Filters the normal of a gap by the surface.
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

    /// Returns the input of the clip for a contact. `None` for a flat box, and for an `Own` contact
    /// beyond the prediction of the parts: both fall back to the generic path.
    fn asked(
        &self,
        contact: &FaceContact<N>,
        distance: N,
        tolerance: N,
    ) -> Option<TriangleAsked<N>> {
        let is_own = contact.status == PartStatus::Own;
        if is_own && distance > self.query.request.prediction {
            return None;
        }
        // If the parts overlap by no more than rounding, no point is deeper than that.
        let least = if !is_own && distance > -tolerance { distance } else { -N::INFINITY };
        let normal = self.query.between.pair.pose12.vector(&contact.normal);
        TriangleAsked::new(self.solid, normal, is_own.then_some(distance), least)
    }
}

/// Whether the faces of a solid are clipped in lanes.
pub(super) const fn has_faces<N: Real, const D: usize>(solid: Kind<'_, N, D>) -> bool {
    matches!(solid, Kind::Cuboid(_) | Kind::Polytope(_))
}

/// Triangles waiting for the clip, up to eight, each with the index of its contact and its index in
/// the cache.
struct Due<N: Real> {
    triangles: PartPacket<N, 3>,
    asked: SmallVec<[TriangleAsked<N>; LANES]>,
    contacts: SmallVec<[(usize, usize); LANES]>,
}

impl<N: Real> Default for Due<N> {
    fn default() -> Self {
        let triangles = PartPacket::blank();
        Self { triangles, asked: SmallVec::new(), contacts: SmallVec::new() }
    }
}

/// The contacts found so far.
struct FaceContacts<'s, 'a, N: Real> {
    meeting: &'s FaceMeeting<'a, N>,
    contacts: &'s mut PartContacts<N, 3>,
    arena: &'s mut Arena<N, 3>,
    slot: Option<PlacedPair<'a, N, 3>>,
    due: Due<N>,
    clip: FaceClip<N>,
    /// Number of contacts that the generic path did not confirm; their distance is infinite.
    missing: usize,
}

impl<N: Real> FaceContacts<'_, '_, N> {
    /// Adds the contact of a triangle, if it has one. Without a gap it falls back to the generic
    /// path.
    fn add(&mut self, place: usize, gap: Option<&TriangleGap<N>>) {
        if gap.is_none_or(|gap| self.add_plain(place, gap).is_none()) {
            let found = self.in_general(place);
            self.contacts.extend(found);
        }
        if self.due.asked.len() == LANES {
            self.clip();
        }
    }

    /// Adds the contact of a triangle with a plain gap, if it has one. `None` if the generic path
    /// has to decide.
    fn add_plain(&mut self, place: usize, gap: &TriangleGap<N>) -> Option<()> {
        let triangle = self.meeting.triangle(place)?;
        let contact = match self.meeting.answer(&triangle, gap) {
            SurfaceAnswer::Nothing => return Some(()),
            SurfaceAnswer::Contact(contact) => contact,
            SurfaceAnswer::Unclear => return None,
        };
        if contact.status != PartStatus::Left {
            let asked = self.meeting.asked(&contact, gap.distance, triangle.tolerance)?;
            self.due.triangles.put(self.due.asked.len(), &triangle.corners);
            self.due.asked.push(asked);
            self.due.contacts.push((self.contacts.len(), place));
        }
        self.note_face(place, contact.face.as_ref());
        let (to_first, parts) = (&self.meeting.query.between.pair.pose12, [0, triangle.part]);
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

    /// Clears `are_fronts` if a face in contact is not a front.
    fn note_face(&mut self, place: usize, face: Option<&Vector<N, 3>>) {
        let seams = self.meeting.around.seams(place);
        let is_front = |face| seams.is_some_and(|seams: &FaceSeams<N>| seams.is_front(face));
        self.arena.are_fronts &= face.is_none_or(is_front);
    }

    /// Clips the waiting triangles. Those that the lanes leave undecided are computed by the
    /// generic path.
    fn clip(&mut self) {
        let (Due { triangles, asked, contacts }, meeting) =
            (core::mem::take(&mut self.due), self.meeting);
        if asked.is_empty() {
            return;
        }
        let solid = FaceSolid {
            solid: meeting.solid,
            turn: &meeting.turn,
            origin: meeting.origin,
            prediction: meeting.query.request.prediction,
        };
        let (mut start, mut left) = (self.arena.points.len(), 0_u8);
        let all = &mut *self.contacts;
        let (clip, points) = (&mut self.clip, &mut self.arena.points);
        solid.each_clip(&triangles, &asked, clip, points, |lane, lowest, points| {
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
        // Contacts keep their positions, which are sorted by part.
        for lane in Ones::<LANES>(left.into()) {
            let (contact, place) = &contacts[lane];
            match self.in_general(*place) {
                Some(found) => self.contacts[*contact] = found,
                None => {
                    self.contacts[*contact].distance = N::INFINITY;
                    self.missing += 1;
                }
            }
        }
    }

    /// Computes the contact of a triangle by the generic path.
    fn in_general(&mut self, place: usize) -> Option<PartContact<N, 3>> {
        let FaceMeeting { query, scene, around, .. } = *self.meeting;
        let parts = [0, around.parts()[place]];
        let placed = scene.pair_in(&mut self.slot, parts);
        let found = part_contact::compute(scene, placed, parts, query, None, self.arena)?;
        self.note_face(place, found.face.as_ref());
        Some(found)
    }

    /// Removes the contacts that the generic path did not confirm.
    fn drop_missing(&mut self) {
        if self.missing > 0 {
            self.contacts.retain(|contact| contact.distance.is_finite_number());
        }
    }
}
