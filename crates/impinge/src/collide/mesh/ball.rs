//! Contacts of a ball and a surface of triangles in 3D, bit for bit equal to the contacts of the
//! generic path (`update_in_general`), which defines the results. Quantities that all triangles
//! share are computed once, and triangles that other triangles hide ([`CandidateTriangles::masks`])
//! are skipped.

use super::normal_filter::{Case, FilteredNormal, faces, filter_normal};
use super::over::over3;
use super::part_cache::PartCache;
use super::part_contact::{self, Arena, PartContact, PartStatus, is_beside, is_certain, of_ball};
use super::patch::Piece;
use super::scene::Scene;
use super::{
    CompositeContacts, PartContacts, Query, Travelled, advanced, is_resolved, middle_of_first,
    of_parts,
};
use crate::bounding_volume::Aabb;
use crate::collide::packet::LANES;
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::enclosing;
use crate::collide::separation::{
    BallQuestion, CandidateTriangles, ball_triangle, candidate_triangles,
};
use crate::collide::{ManifoldRequest, Pair};
use crate::convex::Separation;
use crate::math::{Mapped, Point, Pose, Real, Vector, max, min};
use crate::shape::{Ball, CompositeShape, FeatureId, Kind, SupportMap, SurfaceAccess, Triangle};

/// Rounding error of lengths, in units of epsilon times the sum of the bounding radii of the ball
/// and the triangle around the ball's centre.
const ROUNDING: f64 = 16.0;
/// Largest number of parts that the cache holds with its large margin. It is high because a part
/// outside the ball's box costs only a box test.
const MAX_ROOMY: usize = 5 * LANES;

/// Appends the contacts of a ball and the triangles of a surface to `part_contacts`, and their
/// points to `arena`. Returns the reference point and the centre of the ball, in the frame of the
/// surface; `None` if the pair needs the generic path: always for solids other than balls. Of
/// `contacts`, only the part cache changes.
pub(crate) fn ball_contacts<N: Real>(
    contacts: &mut CompositeContacts<N, 3>,
    between: &Between<'_, N, 3>,
    request: &ManifoldRequest<N>,
    (part_contacts, arena): (&mut PartContacts<N, 3>, &mut Arena<N, 3>),
) -> Option<[Point<N, 3>; 2]> {
    let mut rolling = Rolling::new(between, request)?;
    arena.rounding = rolling.find(contacts, part_contacts, arena)?;
    if !is_resolved(part_contacts) {
        let around = &contacts.around;
        let (reference, request) = (&Some(rolling.from), &rolling.request);
        let query = Query { between, is_self: false, around, reference, request };
        query.resolve_contacts(&Scene::new(between, around), part_contacts, arena);
    }
    Some([rolling.from, rolling.center])
}

/// A ball and the surface that it may touch.
struct Rolling<'b, 'a, N: Real> {
    between: &'b Between<'a, N, 3>,
    /// Request for the contact with each triangle; see [`of_parts`].
    request: ManifoldRequest<N>,
    ball: &'a Ball<N>,
    parts: &'a dyn CompositeShape<N, 3>,
    surface: SurfaceAccess<'a, N, 3>,
    /// Rotation from the frame of the surface to the frame of the ball; its translation is zero.
    turn: Pose<N, 3>,
    /// Centre of the ball, in the frame of the surface.
    center: Point<N, 3>,
    /// Reference point of the ball, which decides on which side of a triangle the ball is, in the
    /// frame of the surface.
    from: Point<N, 3>,
}

/// A triangle relative to the centre of the ball, in the axes of the surface.
struct CenteredTriangle<N: Real> {
    part: u32,
    /// The triangle, with the centre of the ball as the origin.
    triangle: Triangle<N, 3>,
    /// Bound of the rounding errors of lengths computed for the triangle and the ball.
    tolerance: N,
}

impl<'b, 'a, N: Real> Rolling<'b, 'a, N> {
    /// Prepares the search for a ball and a surface; `None` if the first shape is not a ball, or
    /// the second is not a composite with a surface.
    fn new(between: &'b Between<'a, N, 3>, request: &ManifoldRequest<N>) -> Option<Self> {
        let Kind::Ball(ball) = between.pair.first else { return None };
        let [_, parts] = between.composites();
        let parts = parts?;
        let surface = parts.surface_access()?;
        let center = middle_of_first(between)?;
        let request = of_parts(between, request);
        let turn = Pose { rotation: between.pair.pose12.rotation, ..Pose::identity() };
        Some(Self { between, request, ball, parts, surface, turn, center, from: center })
    }

    /// Fills the cache with all parts near the ball, and returns a box around all points within the
    /// prediction of the ball. `None` if the box is unbounded or a cached part is not a triangle
    /// with corners.
    fn box_within(&self, around: &mut PartCache<N, 3>) -> Option<Aabb<N, 3>> {
        let half_extents = Vector::<N, 3>::repeat(self.ball.radius() + self.request.prediction);
        let aabb = enclosing(&Aabb::around(self.center, half_extents), &self.between.pose21);
        let is_kept = around.covers_with(self.parts, &aabb, MAX_ROOMY);
        (is_kept && around.has_triangles_alone()).then_some(aabb)
    }

    /// Finds the contacts of the triangles that are not hidden, and updates the reference point
    /// `from`. Returns the result of [`Self::rounding_of_hidden`]; `None` if the pair needs the
    /// generic path.
    fn find(
        &mut self,
        contacts: &mut CompositeContacts<N, 3>,
        part_contacts: &mut PartContacts<N, 3>,
        arena: &mut Arena<N, 3>,
    ) -> Option<N> {
        let within = self.box_within(&mut contacts.around)?;
        let question = BallQuestion {
            tiles: contacts.around.tiles(),
            count: contacts.around.parts().len(),
            center: self.center.coords,
            radius: self.ball.radius(),
            limit: self.request.prediction,
            within,
        };
        let candidates = candidate_triangles(&question, self.surface.has_regular_seams());
        // Triangles outside the box are not among the candidates; they are beyond `max_distance`.
        let max_distance = self.ball.radius() + self.request.prediction;
        let clearance = min(max_distance, candidates.from_middle);
        let travelled = Travelled { old: contacts.reference, clearance };
        self.from = advanced(self.between, &travelled, self.center);
        let around = &contacts.around;
        each_lane(
            &candidates,
            |[near, hidden]| near & !hidden,
            |index| {
                let one = self.centered_triangle(around, index)?;
                self.add(&one, around, part_contacts, arena);
                Some(())
            },
        )?;
        self.rounding_of_hidden(&candidates, around, part_contacts)
    }

    /// Returns the largest `tolerance` of the hidden triangles that can be touched from the
    /// reference point. The generic path, which does not skip them, merges points within the
    /// largest tolerance of all parts, and the result must be the same. Zero with at most one
    /// contact, because nothing is merged then. `None` if a hidden triangle may be nearer than all
    /// contacts, or if its coordinates overflow; the generic path is then used.
    fn rounding_of_hidden(
        &self,
        candidates: &CandidateTriangles<N>,
        around: &PartCache<N, 3>,
        part_contacts: &[PartContact<N, 3>],
    ) -> Option<N> {
        let least =
            part_contacts.iter().fold(N::INFINITY, |least, found| min(least, found.distance));
        let from_middle = max(least + self.ball.radius(), N::ZERO);
        let is_nearer = from_middle * from_middle < candidates.hidden_from;
        if !is_nearer && candidates.hidden_from < N::INFINITY {
            return None;
        }
        let mut most = N::ZERO;
        if part_contacts.len() > 1 {
            each_lane(
                candidates,
                |[_, hidden]| hidden,
                |index| {
                    let hidden = self.centered_triangle(around, index)?;
                    if faces(Some(self.surface), hidden.part, &self.from) {
                        most = max(most, hidden.tolerance);
                    }
                    Some(())
                },
            )?;
        }
        Some(most)
    }

    /// Returns the triangle at `index` in the cache; `None` if its coordinates overflow.
    fn centered_triangle(
        &self,
        around: &PartCache<N, 3>,
        index: usize,
    ) -> Option<CenteredTriangle<N>> {
        let corners = around.tiles()[index / LANES].corners(index % LANES);
        let [a, b, c] = corners.mapped(|corner| corner - self.between.pose21.translation);
        let triangle = Triangle::try_new(a, b, c).ok()?;
        let size = self.ball.radius() + triangle.reach();
        let tolerance = N::lit(ROUNDING) * N::EPSILON * size;
        Some(CenteredTriangle { part: around.parts()[index], triangle, tolerance })
    }

    /// Appends the contact of a triangle, if there is one, to `part_contacts`.
    fn add(
        &self,
        centered: &CenteredTriangle<N>,
        around: &PartCache<N, 3>,
        part_contacts: &mut PartContacts<N, 3>,
        arena: &mut Arena<N, 3>,
    ) {
        let kind = Kind::Triangle(&centered.triangle);
        let pair = Pair { first: Kind::Ball(self.ball), second: kind, pose12: self.turn };
        let Some(found) = ball_triangle(&pair, self.request.prediction) else { return };
        let found = self.certain_contact(centered, &found, arena).unwrap_or_else(|| {
            let scene = Scene::new(self.between, around);
            let parts = [0, centered.part];
            let query = Query {
                is_self: false,
                between: self.between,
                around,
                reference: &Some(self.from),
                request: &self.request,
            };
            part_contact::compute(&scene, &scene.pair(parts), parts, &query, Some(&found), arena)
        });
        part_contacts.extend(found);
    }

    /// Computes the contact of a triangle without the generic path. `Some(None)` if there is no
    /// contact. `None` if the result depends on rounding or needs points along a face's normal;
    /// then the generic path must compute it.
    #[expect(clippy::option_option, reason = "no answer is not the answer that there is none")]
    fn certain_contact(
        &self,
        centered: &CenteredTriangle<N>,
        found: &Separation<N, 3>,
        arena: &mut Arena<N, 3>,
    ) -> Option<Option<PartContact<N, 3>>> {
        let over = over3(&centered.triangle, &Point::origin(), centered.tolerance)?;
        if !found.distance.is_finite_number()
            || !faces(Some(self.surface), centered.part, &self.from)
        {
            return Some(None);
        }
        let filtered = self.filtered_normal(centered, found, over);
        let (normal, status) = match &filtered {
            FilteredNormal::Face(face) => (-self.turn.vector(face), PartStatus::Own),
            FilteredNormal::Admitted => (found.normal, PartStatus::Own),
            FilteredNormal::Refused => (found.normal, PartStatus::Left),
            FilteredNormal::Snapped(_) | FilteredNormal::Beyond(_) if is_beside(Some(over)) => {
                (found.normal, PartStatus::Left)
            }
            _ => return None,
        };
        let start = arena.points.len();
        let mut lowest = N::INFINITY;
        if status == PartStatus::Own {
            if !is_certain(over, &filtered) {
                return None;
            }
            let mut point = of_ball(&Separation { normal, ..*found }, over);
            point.point1 = Point::origin() + point.point1.coords;
            lowest = point.distance;
            arena.points.push(point);
        }
        let piece = Piece { normal, parts: [0, centered.part], points: start..arena.points.len() };
        let face = filtered.face().filter(|_| status != PartStatus::Left);
        let (distance, normal, tolerance) = (found.distance, found.normal, centered.tolerance);
        Some(Some(PartContact { distance, normal, piece, lowest, status, face, tolerance }))
    }

    /// Applies the normal filter of the surface to `found`, the separation of the ball and a
    /// triangle.
    fn filtered_normal(
        &self,
        centered: &CenteredTriangle<N>,
        found: &Separation<N, 3>,
        over: FeatureId,
    ) -> FilteredNormal<N, 3> {
        let middle = centered.triangle.center() + self.between.pose21.translation;
        let case = Case {
            part: centered.part,
            feature: &|| over,
            is_beside: is_beside(Some(over)),
            is_crossed: false,
            outward: -self.turn.inverse_vector(&found.normal),
            toward: self.from - middle,
        };
        filter_normal(Some(self.surface), &case)
    }
}

/// Calls `visit` with the index of each selected triangle, in ascending order. For each packet,
/// `bits` receives the masks of the near and of the hidden triangles, and returns the mask of the
/// selected triangles. Returns `None`, without further calls, as soon as `visit` returns `None`.
fn each_lane<N>(
    candidates: &CandidateTriangles<N>,
    bits: impl Fn([u8; 2]) -> u8,
    mut visit: impl FnMut(usize) -> Option<()>,
) -> Option<()> {
    for &(block, near) in &candidates.masks {
        let mut left = bits(near);
        while left != 0 {
            visit(block * LANES + left.trailing_zeros() as usize)?;
            left &= left - 1;
        }
    }
    Some(())
}
