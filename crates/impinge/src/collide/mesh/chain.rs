//! Contacts of a convex solid and a chain of segments in 2D, bit for bit equal to the contacts of
//! the generic path (`update_in_general`), which defines the results. Quantities that all segments
//! share are computed once, and segments beyond the prediction are skipped.

use super::cull::relative_slack;
use super::forced::{least_along, overlooks};
use super::gather::{depth_in, search_box};
use super::normal_filter::{Case, FilteredNormal, filter_normal};
use super::part_cache::PartCache;
use super::part_contact::{Arena, PartContact, PartStatus};
use super::patch::Piece;
use super::scene::Scene;
use super::{
    CompositeContacts, PartContacts, Query, Travelled, advanced, is_resolved, middle_of_first,
    of_parts,
};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::manifold::{Along, SegmentPair};
use crate::collide::packet::{LANES, PartPacket};
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::enclosing;
use crate::collide::separation::{ChainQuestion, Links, links};
use crate::collide::{ManifoldRequest, Pair, RawPoint};
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Vector, centroid, max, min};
use crate::shape::{
    CompositeShape, FeatureId, Geometry, Kind, KnownSegment, KnownSegments, Segment, Sidedness,
    SupportMap, Surface, SurfaceAccess,
};

/// Rounding error of lengths, in units of epsilon times the sum of the bounding radii of the solid
/// and the segment around the solid's origin.
const ROUNDING: f64 = 16.0;
/// Largest number of cached packets that are searched for the segments at a point; for more
/// packets, the surface of the chain is called instead.
const MAX_SEARCHED: usize = 8;

/// Appends the contacts of a convex solid and the segments of a chain to `part_contacts`, and their
/// points to `arena`. Returns the reference point and the centre of the solid, in the frame of the
/// chain; `None` if the pair needs the generic path. Of `contacts`, only the part cache changes.
pub(crate) fn chain_contacts<N: Real>(
    contacts: &mut CompositeContacts<N, 2>,
    between: &Between<'_, N, 2>,
    request: &ManifoldRequest<N>,
    (part_contacts, arena): (&mut PartContacts<N, 2>, &mut Arena<N, 2>),
) -> Option<[Point<N, 2>; 2]> {
    let mut chain = Chain::new(between, request)?;
    chain.find(contacts, part_contacts, arena)?;
    let query = Query {
        between,
        is_self: false,
        around: &contacts.around,
        reference: &Some(chain.from),
        request: &chain.request,
    };
    if !is_resolved(part_contacts) {
        query.resolve_contacts(&Scene::new(between, query.around), part_contacts, arena);
    }
    Some([chain.from, chain.center])
}

/// A convex solid and the chain that it may touch.
struct Chain<'b, 'a, N: Real> {
    between: &'b Between<'a, N, 2>,
    /// Request for the contact with each segment; see [`of_parts`].
    request: ManifoldRequest<N>,
    solid: Kind<'a, N, 2>,
    parts: &'a dyn CompositeShape<N, 2>,
    surface: SurfaceAccess<'a, N, 2>,
    /// Properties that all segments of the chain share; `None` if the surface must be called for
    /// each segment.
    sidedness: Option<Sidedness>,
    /// Rotation from the frame of the chain to the frame of the solid; its translation is zero.
    turn: Pose<N, 2>,
    /// Relative pose of a segment and the solid, in the order of kinds: the pose of the second of
    /// these two in the frame of the first.
    pose12: Pose<N, 2>,
    /// Whether the solid comes before a segment of the chain in the order of kinds. True for balls,
    /// and for segments, because the solid is the first shape.
    comes_first: bool,
    /// Origin of the solid in the frame of the chain. Segments are translated so that this point is
    /// their origin.
    origin: Point<N, 2>,
    /// Centre of the solid, in the frame of the chain.
    center: Point<N, 2>,
    /// Reference point of the solid, which decides on which side of a segment the solid is, in the
    /// frame of the chain.
    from: Point<N, 2>,
    /// Bounding radius of the solid around its origin.
    size: N,
}

/// The cached segments, which include all segments of the chain that overlap the box `within`.
struct KeptLinks<'t, N: Real> {
    tiles: &'t [PartPacket<N, 2>],
    parts: &'t [u32],
    within: Aabb<N, 2>,
}

impl<N: Real> KeptLinks<'_, N> {
    /// Returns the ends of the segment at `index` in `parts`, in the frame of the chain.
    fn ends(&self, index: usize) -> [Point<N, 2>; 2] {
        let [a, b, _] = self.tiles[index / LANES].corners(index % LANES);
        [a, b]
    }
}

impl<N: Real> KnownSegments<N> for KeptLinks<'_, N> {
    fn are_all_at(&self, point: &Point<N, 2>) -> bool {
        self.tiles.len() <= MAX_SEARCHED && self.within.contains_point(point)
    }

    fn each_ending_at(&self, point: &Point<N, 2>, visit: &mut dyn FnMut(u32, [Point<N, 2>; 2])) {
        for (block, tiles) in self.tiles.iter().enumerate() {
            let [[from_x, from_y], [to_x, to_y], _] = &tiles.corners;
            let mut ending = 0_u8;
            for lane in 0..LANES {
                let is_start = (from_x[lane] == point.x) & (from_y[lane] == point.y);
                let is_end = (to_x[lane] == point.x) & (to_y[lane] == point.y);
                ending |= u8::from(is_start | is_end) << lane;
            }
            while ending != 0 {
                let index = block * LANES + ending.trailing_zeros() as usize;
                ending &= ending - 1;
                // Lanes after the last part hold copies of that part.
                if let Some(&part) = self.parts.get(index) {
                    visit(part, self.ends(index));
                }
            }
        }
    }
}

/// A segment of the chain within the prediction of the solid.
struct ChainLink<'c, 'b, 'a, N: Real> {
    chain: &'c Chain<'b, 'a, N>,
    /// Part indices of the solid, always 0, and of the segment.
    parts: [u32; 2],
    /// The segment relative to the origin of the solid.
    segment: Segment<N, 2>,
    /// The segment and its neighbours, to filter the normals of its contacts.
    known: KnownSegment<'c, N>,
    /// Separation of the segment and the solid, in the order of kinds and in the frame of the first
    /// of them.
    found: Separation<N, 2>,
    /// Bound of the rounding errors of lengths computed for the segment and the solid.
    tolerance: N,
}

impl<'b, 'a, N: Real> Chain<'b, 'a, N> {
    /// Prepares the search for a solid and a chain. `None` for solids other than balls, segments,
    /// capsules, triangles, boxes and polygons, and if the second shape has no surface.
    fn new(between: &'b Between<'a, N, 2>, request: &ManifoldRequest<N>) -> Option<Self> {
        let solid = between.pair.first;
        let comes_first = matches!(solid, Kind::Ball(_) | Kind::Segment(_));
        let is_polygon = matches!(
            solid,
            Kind::Capsule(_) | Kind::Triangle(_) | Kind::Cuboid(_) | Kind::Polytope(_)
        );
        if !(comes_first || is_polygon) {
            return None;
        }
        let [_, parts] = between.composites();
        let (parts, map) = (parts?, Geometry(solid).as_support_map()?);
        let surface = parts.surface_access()?;
        let turn = Pose { rotation: between.pair.pose12.rotation, ..Pose::identity() };
        let pose12 = if comes_first { turn } else { Pose::relative(&turn, &Pose::identity()) };
        let center = middle_of_first(between)?;
        Some(Self {
            between,
            request: of_parts(between, request),
            solid,
            parts,
            surface,
            sidedness: surface.sidedness(),
            turn,
            pose12,
            comes_first,
            origin: Point::from(between.pose21.translation),
            center,
            from: center,
            size: map.reach() + map.rounding(),
        })
    }

    /// Fills the cache with all parts near the solid, and returns a box around all points within
    /// the prediction of the solid. This is the box of the solid's bounding ball, which a rotation
    /// does not change, if its parts are cached or its half extent is at most twice the largest
    /// half extent of the solid's own box. Otherwise it is the solid's own box. `None` if the box
    /// is unbounded or a cached part is not a segment with corners.
    fn box_within(&self, around: &mut PartCache<N, 2>) -> Option<Aabb<N, 2>> {
        let max_distance = self.size + self.request.prediction;
        let whole = Aabb::around(self.origin, Vector::<N, 2>::repeat(max_distance));
        let whole = enclosing(&whole, &self.between.pose21);
        if around.holds(&whole) {
            return around.has_segments_alone().then_some(whole);
        }
        let exact = search_box(self.between, self.request.prediction);
        let most = exact.half_extents().iter().fold(N::ZERO, |most, &half| max(most, half));
        let aabb = if max_distance <= N::TWO * most { whole } else { exact };
        (around.covers(self.parts, &aabb) && around.has_segments_alone()).then_some(aabb)
    }

    /// Finds the contacts of the segments within the prediction, and updates the reference point
    /// `from`. `None` if the generic path must find them.
    fn find(
        &mut self,
        contacts: &mut CompositeContacts<N, 2>,
        part_contacts: &mut PartContacts<N, 2>,
        arena: &mut Arena<N, 2>,
    ) -> Option<()> {
        let limit = self.request.prediction;
        let around = &mut contacts.around;
        let aabb = self.box_within(around)?;
        let question = ChainQuestion {
            tiles: around.tiles(),
            count: around.parts().len(),
            origin: self.origin.coords,
            solid: self.solid,
            pose12: self.pose12,
            center: self.center,
            limit,
        };
        let mut near = Links::new(depth_in(&aabb, &self.center));
        links(&question, &mut near)?;
        let slack = relative_slack::<N>() * (near.from_middle + self.size + limit);
        let travelled = Travelled { old: contacts.reference, clearance: near.from_middle - slack };
        self.from = advanced(self.between, &travelled, self.center);
        let kept = KeptLinks { tiles: around.tiles(), parts: around.parts(), within: aabb };
        for (index, found) in &near.found {
            if let Some(link) = self.link(&kept, *index, found) {
                link.find(part_contacts, &mut arena.points)?;
            }
        }
        Some(())
    }

    /// Returns the segment at `index` in the cache, with its separation `found`. `None` if it
    /// cannot be touched from the reference point, or if its distance is not finite.
    fn link<'c>(
        &'c self,
        kept: &'c KeptLinks<'_, N>,
        index: usize,
        found: &Separation<N, 2>,
    ) -> Option<ChainLink<'c, 'b, 'a, N>> {
        if !found.distance.is_finite_number() {
            return None;
        }
        let (parts, ends) = ([0, kept.parts[index]], kept.ends(index));
        let known = KnownSegment::new(self.surface, self.sidedness, kept, ends);
        if !known.faces(parts[1], &self.from) {
            return None;
        }
        let [a, b] = ends.map(|end| end - self.origin.coords);
        let segment = Segment::of_finite(a, b);
        let size = segment.reach() + self.size;
        let tolerance = N::lit(ROUNDING) * N::EPSILON * size;
        Some(ChainLink { chain: self, parts, segment, known, found: *found, tolerance })
    }

    /// Takes a normal of [`ChainLink::pair`], which points from the first solid of this pair to the
    /// second, in the frame of the first. Returns it as a vector from the solid to the chain, in
    /// the frame of the solid.
    fn outward(&self, normal: &Vector<N, 2>) -> Vector<N, 2> {
        if self.comes_first { *normal } else { -self.turn.vector(normal) }
    }

    /// Takes a normal that points from the solid to the chain, in the frame of the solid. Returns
    /// it as a normal of [`ChainLink::pair`]: from the first solid of this pair to the second, in
    /// the frame of the first.
    fn inward(&self, normal: &Vector<N, 2>) -> Vector<N, 2> {
        if self.comes_first { *normal } else { -self.turn.inverse_vector(normal) }
    }

    /// Takes a contact point of [`ChainLink::pair`], in a manifold with this `normal`. Returns it
    /// in the frame of the solid, with the solid as the first shape and the chain as the second.
    fn placed(&self, point: RawPoint<N, 2>, normal: &Vector<N, 2>) -> RawPoint<N, 2> {
        if self.comes_first {
            return point;
        }
        let point1 = self.turn.point(&(point.point1 + normal * point.distance));
        let (feature1, feature2) = (point.feature2, point.feature1);
        RawPoint { point1, feature1, feature2, ..point }
    }
}

impl<N: Real> ChainLink<'_, '_, '_, N> {
    /// Appends the contact of the segment to `part_contacts`, if there is one; `None` if the
    /// generic path must compute it.
    fn find(
        &self,
        part_contacts: &mut PartContacts<N, 2>,
        points: &mut ChainPoints<N>,
    ) -> Option<()> {
        let normal = self.chain.outward(&self.found.normal);
        let filtered = self.filtered_normal(&normal);
        let start = points.len();
        let normal_in_first = |face: &Vector<N, 2>| -self.chain.turn.vector(face);
        let (of_piece, status) = match &filtered {
            FilteredNormal::Nothing => return Some(()),
            FilteredNormal::Refused => (normal, PartStatus::Left),
            FilteredNormal::Admitted => (self.between(&normal, points)?, PartStatus::Own),
            FilteredNormal::Face(face) => {
                (self.between(&normal_in_first(face), points)?, PartStatus::Own)
            }
            FilteredNormal::Snapped(face) => {
                (self.along(&normal_in_first(face), points)?, PartStatus::Snapped)
            }
            FilteredNormal::Beyond(face) => {
                (self.along(&normal_in_first(face), points)?, PartStatus::Beyond)
            }
        };
        let Self { found: Separation { distance, .. }, tolerance, parts, .. } = *self;
        let lowest = points[start..].iter().fold(N::INFINITY, |low, p| min(low, p.distance));
        let piece = Piece { normal: of_piece, parts, points: start..points.len() };
        let face = filtered.face().filter(|_| status != PartStatus::Left);
        let mut contact = PartContact { distance, normal, piece, lowest, status, face, tolerance };
        if status != PartStatus::Left && overlooks(&points[start..], distance, tolerance) {
            points.truncate(start);
            contact.miss();
        }
        part_contacts.push(contact);
        Some(())
    }

    /// Filters the normal of the contact by the surface of the chain. `normal` points from the
    /// solid to the chain, in the frame of the solid.
    fn filtered_normal(&self, normal: &Vector<N, 2>) -> FilteredNormal<N, 2> {
        let chain = self.chain;
        let middle = centroid(&[*self.segment.a(), *self.segment.b()]) + chain.origin.coords;
        let unnamed = FeatureId::Edge(0);
        let feature = || self.pair().touched(&self.found).unwrap_or(unnamed);
        let (part, outward) = (self.parts[1], -chain.turn.inverse_vector(normal));
        let toward = chain.from - middle;
        let case =
            Case { part, feature: &feature, is_beside: false, is_crossed: false, outward, toward };
        filter_normal(Some(SurfaceAccess::of_own(&self.known)), &case)
    }

    /// Returns the segment and the solid, in the order of kinds.
    fn pair(&self) -> SegmentPair<'_, N> {
        let Chain { solid, pose12, comes_first, request, .. } = *self.chain;
        let segment = Kind::Segment(&self.segment);
        let (first, second) = if comes_first { (solid, segment) } else { (segment, solid) };
        let pair = Pair { first, second, pose12 };
        SegmentPair { pair, tolerance: self.tolerance, prediction: request.prediction }
    }

    /// Appends the contact points of the segment for a normal that the chain admits, in the frame
    /// of the solid. Returns the normal, rounded as in a piece of the generic path; `None` if the
    /// generic path must find the points.
    fn between(&self, normal: &Vector<N, 2>, points: &mut ChainPoints<N>) -> Option<Vector<N, 2>> {
        let inward = self.chain.inward(normal);
        let witness = Separation { normal: inward, ..self.found };
        self.pair().between(&witness, |point| points.push(self.chain.placed(point, &inward)))?;
        Some(self.chain.outward(&inward))
    }

    /// Appends the contact points along the normal of a face, in the frame of the solid. Returns
    /// the normal, rounded as in a piece of the generic path; `None` if the generic path must find
    /// the points.
    fn along(&self, normal: &Vector<N, 2>, points: &mut ChainPoints<N>) -> Option<Vector<N, 2>> {
        let inward = self.chain.inward(normal);
        let (found, tolerance) = (&self.found, self.tolerance);
        let least = least_along(&inward, &found.normal, found.distance, tolerance);
        let along = Along { normal: inward, least, tolerance };
        self.pair().along(&along, |point| points.push(self.chain.placed(point, &inward)))?;
        Some(self.chain.outward(&inward))
    }
}

/// Contact points of all pieces, in the frame of the solid.
type ChainPoints<N> = crate::collide::RawPoints<N, 2>;
