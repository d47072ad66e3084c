//! The contacts of a box or hull and a surface of triangles in space: the general way, which defines them,
//! with what all triangles have in common worked out once, and no more made of each than is asked of it.

use core::cell::Cell;

use smallvec::SmallVec;

use super::super::between::Between;
use super::super::bounds::enclosing;
use super::around::Around;
use super::candidates::{depth_in, search_box};
use super::facts::{self, Finding, Notes, Standing, overlooks};
use super::judge::{Case, Verdict, faces, judge};
use super::scene::{Scene, lying_of};
use super::{
    CompositeContacts, Findings, Query, Way, advanced, is_settled, middle_of_first, of_parts,
};
use crate::bounding_volume::Aabb;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Vector, min};
use crate::query::manifold_build::{Piece, build3, merge, on_shown_face};
use crate::query::separation::{Flat, FlatQuestion, Told, Touched};
use crate::query::tiles::{LANES, Tiles};
use crate::query::{ManifoldRequest, OnFace, Pair, witness_feature3};
use crate::shape::{CompositeShape, FaceRing, FeatureId, Kind, SupportMap, Surface, Triangle};

/// Lengths below this many rounding units of all sizes are rounding errors.
const ROUNDING: f64 = 16.0;

/// Brings the contacts of a box or hull and a surface up to date; answers false where that is left to the
/// general way, as of all other solids.
pub(super) fn update_flat<N: Real>(
    contacts: &mut CompositeContacts<N, 3>,
    between: &Between<'_, N, 3>,
    request: &ManifoldRequest<N>,
) -> bool {
    let Some(mut resting) = Resting::new(between, request) else { return false };
    let mut account = Account { findings: Findings::new(), notes: Notes::default(), ring: None };
    let Some(()) = resting.find(contacts, &mut account) else { return false };
    let Account { findings, notes, .. } = &mut account;
    let (reference, center) = (Some(resting.from), Some(resting.center));
    if !is_settled(findings) {
        let around = Some(&contacts.around);
        let query = Query { between, around, reference: &reference, request: &resting.request };
        query.settle(&Scene::new(between, around), findings, notes);
    }
    contacts.conclude((request, merge), [reference, center], (findings, N::ZERO), notes);
    true
}

/// A solid with flat faces and the surface that it may touch.
struct Resting<'b, 'a, N: Real> {
    between: &'b Between<'a, N, 3>,
    /// What is asked of a triangle.
    request: ManifoldRequest<N>,
    parts: &'a dyn CompositeShape<N, 3>,
    surface: &'a dyn Surface<N, 3>,
    question: FlatQuestion<'a, N>,
    /// The surface's frame in that of the solid, put through its origin.
    turn: Pose<N, 3>,
    /// The same as the frame of the triangles.
    frame: Pose<N, 3>,
    /// How far the solid reaches from its origin, and how far that is from where triangles are seen from.
    lengths: [N; 2],
    /// The middle of the solid, and where it comes from, in the surface's frame.
    center: Point<N, 3>,
    from: Point<N, 3>,
}

/// Triangles near the solid, side by side.
struct Near<N> {
    tiles: Tiles<N, 3>,
    parts: [u32; LANES],
    count: usize,
}

/// One of the triangles.
struct Seen<N: Real> {
    part: u32,
    triangle: Triangle<N, 3>,
    tolerance: N,
}

/// What is found, the points of it, and the face that the solid last showed.
struct Account<N: Real> {
    findings: Findings<N, 3>,
    notes: Notes<N, 3>,
    ring: Option<FaceRing<N>>,
}

/// Finds the separation of a triangle.
type Exact<'f, N> = &'f dyn Fn() -> Option<Separation<N, 3>>;

impl<'b, 'a, N: Real> Resting<'b, 'a, N> {
    /// `None` of other solids, and of what is no surface.
    fn new(between: &'b Between<'a, N, 3>, request: &ManifoldRequest<N>) -> Option<Self> {
        let solid = Flat::new(between.pair.first)?;
        let [_, parts] = between.composites();
        let (parts, request) = (parts?, of_parts(between, request));
        let surface = parts.surface()?;
        let center = middle_of_first(between)?;
        let turn = Pose { rotation: between.pair.pose12.rotation, ..Pose::identity() };
        let (frame, pose12) = lying_of(turn);
        let origin = between.pose21.translation;
        let question = FlatQuestion { solid, pose12, limit: request.prediction, origin };
        let lengths = [solid.reach(), pose12.translation.norm()];
        let from = center;
        pose12.is_finite().then_some(Self {
            between,
            request,
            parts,
            surface,
            question,
            turn,
            frame,
            lengths,
            center,
            from,
        })
    }

    /// Finds what is to be said of all triangles; `None` where that is left to the general way.
    fn find(
        &mut self,
        contacts: &mut CompositeContacts<N, 3>,
        account: &mut Account<N>,
    ) -> Option<()> {
        let reference = contacts.reference;
        let around = &mut contacts.around;
        let aabb = self.box_within(around);
        if !(around.reaches(self.parts, &aabb) && around.has_triangles_alone()) {
            return None;
        }
        let (mut clearance, mut eights) =
            (depth_in(&aabb, &self.center), SmallVec::<[u8; LANES]>::new());
        let count = around.parts().len();
        for (block, tiles) in around.tiles().iter().enumerate() {
            let sifted = self.question.sifted(tiles);
            clearance = min(clearance, sifted.from_middle);
            eights.push(sifted.near & (u8::MAX >> (LANES - (count - block * LANES).min(LANES))));
        }
        self.from = advanced(self.between, &Way { old: reference, clearance }, self.center);
        let around = &contacts.around;
        let mut near = Near { tiles: Tiles::blank(), parts: [0; LANES], count: 0 };
        for (block, tiles) in around.tiles().iter().enumerate() {
            let mut left = eights[block];
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                near.push(around.parts()[block * LANES + lane], tiles, lane);
                if near.count == LANES {
                    self.ask(&near, account)?;
                    near.count = 0;
                }
            }
        }
        self.ask(&near, account)
    }

    /// A box around all that is within reach of the solid: around the box about its middle that holds it.
    fn box_within(&self, around: &mut Around<N, 3>) -> Aabb<N, 3> {
        let Flat::Polytope(hull) = self.question.solid else {
            return search_box(self.between, self.request.prediction);
        };
        let (half, turn) = (around.half(hull), &self.between.pose21.rotation);
        let mut extents = Vector::<N, 3>::repeat(hull.rounding() + self.request.prediction);
        for row in 0..3 {
            for axis in 0..3 {
                extents[row] += turn[(row, axis)].abs() * half[axis];
            }
        }
        enclosing(&Aabb::around(self.center, extents), &self.between.pose21)
    }

    /// Adds what is to be said of some triangles.
    fn ask(&self, near: &Near<N>, account: &mut Account<N>) -> Option<()> {
        if near.count == 0 {
            return Some(());
        }
        let eight = self.question.eight(&near.tiles);
        if !eight.is_sound() {
            return None;
        }
        let within = |lane: &usize| !eight.is_beyond(*lane);
        for lane in (0..near.count).filter(within) {
            self.surface.expect(near.parts[lane]);
        }
        for lane in (0..near.count).filter(within) {
            let seen = self.seen(near, lane)?;
            let told = eight.told(lane, &seen.triangle, seen.tolerance);
            let Some(told) = told else { continue };
            let exact = || match &told.touched {
                Touched::Unclear(found) => Some(*found),
                _ => eight.separation(lane, &seen.triangle),
            };
            let found = self
                .plainly(&seen, &told, (&exact, &mut *account))
                .unwrap_or_else(|| self.in_general(&seen, exact()?, &mut account.notes));
            if let Some(found) = found {
                account.findings.push(found);
            }
        }
        Some(())
    }

    /// One of the triangles; `None` where the numbers end.
    fn seen(&self, near: &Near<N>, lane: usize) -> Option<Seen<N>> {
        let [a, b, c] = near.tiles.corners(lane).map(|corner| corner - self.question.origin);
        let triangle = Triangle::try_new(a, b, c).ok()?;
        let [reach, away] = self.lengths;
        let tolerance = N::lit(ROUNDING) * N::EPSILON * (triangle.reach() + reach + away);
        Some(Seen { part: near.parts[lane], triangle, tolerance })
    }

    /// What is to be said of a triangle, by the general way.
    fn in_general(
        &self,
        seen: &Seen<N>,
        found: Separation<N, 3>,
        notes: &mut Notes<N, 3>,
    ) -> Option<Finding<N, 3>> {
        let scene = Scene::new(self.between, None);
        let parts = [0, seen.part];
        let asked = (&Some(self.from), &self.request);
        facts::finding((&scene, &scene.pair(parts)), parts, asked, Some(found), notes)
    }

    /// The triangle and the solid.
    fn pair<'s>(&'s self, seen: &'s Seen<N>) -> Pair<'s, N, 3> {
        let (first, second) = (Kind::Triangle(&seen.triangle), self.question.solid.kind());
        Pair { first, second, pose12: self.question.pose12 }
    }

    /// What is to be said of a triangle of which it is told how it meets the solid; `None` where that is not
    /// enough.
    #[expect(clippy::option_option, reason = "no answer is not the answer that there is none")]
    fn plainly(
        &self,
        seen: &Seen<N>,
        told: &Told<N>,
        (exact, account): (Exact<'_, N>, &mut Account<N>),
    ) -> Option<Option<Finding<N, 3>>> {
        let (distance, tolerance) = (told.distance, seen.tolerance);
        if !distance.is_finite_number() || !faces(Some(self.surface), seen.part, &self.from) {
            return Some(None);
        }
        let normal = -self.frame.vector(&told.normal);
        let verdict = self.verdict(seen, told, &normal)?;
        let mut standing = match &verdict {
            Verdict::Nothing => return Some(None),
            Verdict::Refused => Standing::Left,
            Verdict::Admitted | Verdict::Face(_) => Standing::Own,
            Verdict::Snapped(_) => Standing::Snapped,
            Verdict::Beyond(_) => Standing::Beyond,
        };
        account.notes.blank();
        if standing != Standing::Left {
            self.build(seen, (&verdict, &normal, distance), (exact, &mut *account))?;
        }
        let raw = account.notes.raw_mut();
        if overlooks(raw, distance, tolerance) {
            standing = Standing::Left;
            raw.points.clear();
        }
        let (piece, lowest) = self.noted(seen, &mut account.notes);
        let face = verdict.face().filter(|_| standing != Standing::Left);
        Some(Some(Finding { distance, normal, piece, lowest, standing, face, tolerance }))
    }

    /// Builds the manifold that a verdict asks for; `None` where that is left to the general way.
    fn build(
        &self,
        seen: &Seen<N>,
        (verdict, normal, distance): (&Verdict<N, 3>, &Vector<N, 3>, N),
        (exact, account): (Exact<'_, N>, &mut Account<N>),
    ) -> Option<()> {
        let along = verdict.face().map_or(*normal, |face| -self.turn.vector(&face));
        let inward = -self.frame.inverse_vector(&along);
        let is_forced = matches!(verdict, Verdict::Snapped(_) | Verdict::Beyond(_));
        let asked = OnFace {
            normal: inward,
            least: if is_forced && distance > N::ZERO { distance } else { -N::INFINITY },
            nearest: if is_forced { None } else { Some(distance) },
            prediction: self.request.prediction,
            tolerance: seen.tolerance,
        };
        let (pair, Account { notes, ring, .. }) = (self.pair(seen), account);
        let witness = match verdict {
            Verdict::Admitted => Some(exact().filter(|exact| exact.distance == distance)?),
            _ => None,
        };
        let raw = notes.raw_mut();
        if on_shown_face(&pair, &asked, ring, raw) {
            return Some(());
        }
        let witness = Separation { normal: inward, ..witness? };
        build3(&pair, &witness, &self.request, raw);
        Some(())
    }

    /// What the surface says of the way from the solid to a triangle; `None` where it asks for what is not
    /// told.
    fn verdict(
        &self,
        seen: &Seen<N>,
        told: &Told<N>,
        normal: &Vector<N, 3>,
    ) -> Option<Verdict<N, 3>> {
        let is_missed = Cell::new(false);
        let feature = || match &told.touched {
            Touched::Seam(feature) => *feature,
            Touched::Unclear(found) => {
                witness_feature3(&self.pair(seen), (found, seen.tolerance), false)
            }
            Touched::Face => {
                is_missed.set(true);
                FeatureId::Face(0)
            }
        };
        let middle = seen.triangle.center() + self.question.origin;
        let case = Case {
            part: seen.part,
            feature: &feature,
            is_beside: false,
            outward: -self.turn.inverse_vector(normal),
            toward: self.from - middle,
        };
        let verdict = judge(Some(self.surface), &case);
        let is_told = match &verdict {
            Verdict::Face(_) | Verdict::Nothing => true,
            _ => !matches!(told.touched, Touched::Face),
        };
        (is_told && !is_missed.get()).then_some(verdict)
    }

    /// The manifold in the notes as a piece, whose points are appended to those before, and its least
    /// distance; as [`PartPair::piece`](super::scene::PartPair::piece).
    fn noted(&self, seen: &Seen<N>, notes: &mut Notes<N, 3>) -> (Piece<N, 3>, N) {
        let (start, parts) = (notes.points.len(), [0, seen.part]);
        let mut lowest = N::INFINITY;
        let (points, raw) = notes.parted();
        for point in &raw.points {
            lowest = min(lowest, point.distance);
            let mut placed = *point;
            let foot = self.frame.point(&(point.point1 + raw.normal * point.distance));
            placed.point1 = Point::origin() + foot.coords;
            (placed.feature1, placed.feature2) = (point.feature2, point.feature1);
            points.push(placed);
        }
        let normal = -self.frame.vector(&raw.normal);
        (Piece { normal, parts, points: start..points.len() }, lowest)
    }
}

impl<N: Real> Near<N> {
    /// Adds one of eight triangles.
    #[inline]
    fn push(&mut self, part: u32, tiles: &Tiles<N, 3>, lane: usize) {
        let at = self.count & (LANES - 1);
        for (rows, given) in self.tiles.corners.iter_mut().zip(&tiles.corners) {
            for (row, given) in rows.iter_mut().zip(given) {
                row[at] = given[lane];
            }
        }
        self.parts[at] = part;
        self.count += 1;
    }
}
