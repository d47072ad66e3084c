//! Pieces of one shape that lie wholly inside a body of the other shape.
//!
//! A body is bounded by a closed surface; searches of parts find only this surface. A connected
//! piece that touches no part of the surface is inside or outside as a whole, so one point of the
//! piece decides. The exit direction points from the piece to the nearest point of the boundary.
//! The exit plane runs through that point, perpendicular to the exit direction; the depth is the
//! extent of the piece below this plane.
//!
//! ```text
//!   ═════════●═════════  boundary        ┬
//!            ↑ outward                   │
//!         ╭──┴──╮                        │ depth
//!         │piece│                        │
//!         ╰──○──╯                        ┴
//! ```

use core::ops::Range;

use smallvec::SmallVec;

use super::between::Between;
use super::bounds::loosened;
use super::nearest::Wanted;
use super::separation::{PairVisitor, PartSeparation, visit_near_pairs};
use crate::collide::separation::separation as of_convex;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component};
use crate::shape::{EnclosedBody, Geometry, Kind};

/// A connected piece of one shape, a point of which lies in a body of the other shape.
#[derive(Clone, Debug)]
pub(crate) struct InsidePiece<N: Real, const D: usize> {
    /// Index of the shape that the piece belongs to: the first (0) or the second (1).
    pub(crate) inner: usize,
    /// Index of the piece, as returned by
    /// [`CompositeShape::piece_of`](crate::shape::CompositeShape::piece_of); 0 for a convex solid.
    piece: u32,
    /// Index range of the parts of the other shape that bound the body.
    boundary: Range<u32>,
    /// Nearest pair of a part of the piece and a part of the boundary for which [`Self::leads_out`]
    /// returns `true`; `None` before such a pair is found.
    nearest: Option<PartSeparation<N, D>>,
    /// Nearest pair for which [`Self::leads_out`] returns `false`: the body continues behind the
    /// boundary. Used only if `nearest` is `None`, and meaningless otherwise: farther pairs than
    /// `nearest` are stored here without a call of [`Self::leads_out`].
    blocked: Option<PartSeparation<N, D>>,
}

/// Distance behind the boundary, relative to the separation, of the point that is tested to decide
/// whether the body ends there. The rounding error is added to this distance.
const BEYOND: f64 = 1.0 / 64.0;
/// Rounding error of lengths, in units of epsilon times the largest coordinate.
const ROUNDING: f64 = 64.0;

/// Pieces of both shapes, each with a point inside a body of the other shape.
pub(crate) type InsidePieces<N, const D: usize> = SmallVec<[InsidePiece<N, D>; 1]>;

/// Exit plane, in the frame of the first shape: through the nearest point of the boundary,
/// perpendicular to the exit direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exit<N: Real, const D: usize> {
    pub(crate) point: Point<N, D>,
    /// Unit normal out of the body.
    pub(crate) outward: Vector<N, D>,
    /// Indices of the parts of the first and second shape whose separation defines the exit.
    pub(crate) parts: [u32; 2],
}

/// Returns the pieces of both shapes whose test point, the centre of one of their parts, lies in a
/// body of the other shape. Such a piece is inside the body or crosses its boundary. A piece occurs
/// once for each such body.
///
/// Cost: one winding number for each pair of a body and a piece of the other shape with parts in
/// the box of the body's shape.
pub(crate) fn held_pieces<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
) -> InsidePieces<N, D> {
    let mut pieces = InsidePieces::new();
    for inner in [0, 1] {
        let outer = between.composites()[1 - inner].filter(|outer| outer.has_bodies());
        let Some(outer) = outer else { continue };
        let points = points_of_pieces(between, inner);
        outer.each_body(&mut |body| add_held(body, inner, &points, &mut pieces));
    }
    pieces
}

/// Finds the exits of the pieces from their bodies, and drops the pieces without an exit, which
/// cross the boundary by more than rounding.
///
/// Cost: one search for nearest parts, shared by all pieces; each pair of parts is compared with
/// each piece, so many pieces take quadratic time.
pub(crate) fn find_exits<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    pieces: &mut InsidePieces<N, D>,
) {
    if !pieces.is_empty() {
        visit_near_pairs(between, &mut NearestBoundary { between, pieces });
        pieces.retain(|piece| piece.exit().is_some());
    }
}

/// Appends the pieces of shape `inner` whose test point lies in the body; `points` holds the piece
/// index and the test point.
fn add_held<N: Space<D>, const D: usize>(
    body: &EnclosedBody<'_, N, D>,
    inner: usize,
    points: &[(u32, Point<N, D>)],
    pieces: &mut InsidePieces<N, D>,
) {
    for (piece, _) in points.iter().filter(|(_, point)| body.holds(point)) {
        let boundary = body.parts();
        pieces.push(InsidePiece { inner, piece: *piece, boundary, nearest: None, blocked: None });
    }
}

/// Returns, for each piece that may be inside the other shape, its index and the centre of one of
/// its parts, in the frame of the other shape. Empty for half-spaces.
fn points_of_pieces<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    inner: usize,
) -> SmallVec<[(u32, Point<N, D>); 1]> {
    let (kind, pose) = between.in_frame_of_other(inner);
    let mut points = SmallVec::new();
    let mut last = None;
    for (piece, part) in parts_near_other(between, inner) {
        if last == Some(piece) {
            continue;
        }
        last = Some(piece);
        each_solid(kind, part, |kind, own| {
            if let Some(map) = Geometry(kind).as_support_map() {
                points.push((piece, pose.point(&own.point(&map.center()))));
            }
        });
    }
    points
}

/// Returns the parts of a shape whose boxes overlap the box of the other shape, as sorted pairs
/// (piece, part); (0, 0) for a convex solid. The pairs include all parts of each piece that is
/// inside the other shape.
fn parts_near_other<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    inner: usize,
) -> SmallVec<[(u32, u32); 1]> {
    let mut parts = SmallVec::new();
    let Some(composite) = between.composites()[inner] else {
        parts.push((0, 0));
        return parts;
    };
    composite.search().overlapping(&between.whole_in_other(1 - inner), &mut |part| {
        parts.push((composite.piece_of(part), part));
    });
    parts.sort_unstable();
    parts
}

/// Calls `visit` with a part and its pose in the frame of its shape; a convex solid counts as its
/// only part.
fn each_solid<N: Space<D>, const D: usize>(
    shape: Kind<'_, N, D>,
    part: u32,
    visit: impl FnOnce(Kind<'_, N, D>, &Pose<N, D>),
) {
    match Geometry(shape).as_composite().map(|composite| composite.part(part)) {
        Some(part) => visit(part.solid.geometry().0, &part.pose),
        None => visit(shape, &Pose::identity()),
    }
}

/// Search that finds, for each piece, the nearest pair of a part of the piece and a part of the
/// boundary of the body that the piece is in.
struct NearestBoundary<'p, 'a, N: Real, const D: usize> {
    between: &'p Between<'a, N, D>,
    pieces: &'p mut InsidePieces<N, D>,
}

impl<N: Space<D>, const D: usize> PairVisitor<N, D> for NearestBoundary<'_, '_, N, D> {
    /// Returns the largest of the known distances of the pieces from the boundaries of their
    /// bodies; infinite while the distance of a piece is unknown.
    fn limit(&self) -> N {
        self.pieces.iter().fold(-N::INFINITY, |most, piece| max(most, piece.distance()))
    }

    /// Returns a negative bound, which ends the search, once every piece touches the boundary of
    /// its body: a piece that crosses the boundary is dropped, whatever its depth.
    fn bound(&self) -> N {
        let limit = self.limit();
        if limit <= N::ZERO { -N::ONE } else { loosened(limit) }
    }

    fn visit(&mut self, parts: [u32; 2]) {
        let mut placed = None;
        for piece in self.pieces.iter_mut() {
            if !piece.has(self.between, parts) {
                continue;
            }
            let placed = placed.get_or_insert_with(|| self.between.parts(parts));
            let Some(local) = of_convex(&placed.pair(), piece.distance()) else { continue };
            let found = PartSeparation { separation: placed.in_first(&local), local, parts };
            let is_nearer = piece.nearest.is_none_or(|nearest| found.is_before(&nearest));
            if is_nearer && piece.leads_out(self.between, &found) {
                piece.nearest = Some(found);
            } else if piece.blocked.is_none_or(|blocked| found.is_before(&blocked)) {
                piece.blocked = Some(found);
            }
        }
    }
}

impl<N: Space<D>, const D: usize> InsidePiece<N, D> {
    /// Returns whether `parts` consists of a part of the piece and a part of the boundary of the
    /// body.
    pub(crate) fn has(&self, between: &Between<'_, N, D>, parts: [u32; 2]) -> bool {
        self.boundary.contains(&parts[1 - self.inner]) && self.is_own(between, parts[self.inner])
    }

    /// Returns whether a part of the inner shape belongs to the piece.
    fn is_own(&self, between: &Between<'_, N, D>, part: u32) -> bool {
        let composite = between.composites()[self.inner];
        composite.is_none_or(|composite| composite.piece_of(part) == self.piece)
    }

    /// Calls `visit` with each part of the piece whose box overlaps the box of the other shape.
    /// These are all parts of the piece if the piece is inside the body.
    pub(crate) fn each_part(&self, between: &Between<'_, N, D>, mut visit: impl FnMut(u32)) {
        let near = parts_near_other(between, self.inner);
        near.iter().filter(|(piece, _)| *piece == self.piece).for_each(|(_, part)| visit(*part));
    }

    /// Returns the distance of the piece from the nearest part of the boundary found so far;
    /// infinite if `nearest` is `None`.
    fn distance(&self) -> N {
        self.nearest.map_or(N::INFINITY, |nearest| nearest.separation.distance)
    }

    /// Returns whether the body ends behind the point of the boundary in `found`. The body
    /// continues there if closed surfaces of one composite overlap. Also returns `true` if the two
    /// parts overlap by more than rounding, because then there is no exit to test.
    fn leads_out(&self, between: &Between<'_, N, D>, found: &PartSeparation<N, D>) -> bool {
        let Some(Exit { point, outward, .. }) = self.exit_at(found) else { return true };
        let outer = 1 - self.inner;
        let Some(composite) = between.composites()[outer] else { return true };
        let (point, outward) = match outer {
            0 => (point, outward),
            _ => (between.pose21.point(&point), between.pose21.vector(&outward)),
        };
        let distance =
            max(found.separation.distance, N::ZERO) * N::lit(BEYOND) + rounding([&point; 2]);
        let beyond = point + outward * distance;
        let mut is_held = false;
        composite.each_body(&mut |body| {
            is_held |= body.parts() == self.boundary && body.holds(&beyond);
        });
        !is_held
    }

    /// Returns the exit from the body. `None` if no pair with the boundary was found, or if the
    /// piece crosses the boundary by more than rounding; then the contacts of its parts with the
    /// boundary are valid.
    pub(crate) fn exit(&self) -> Option<Exit<N, D>> {
        self.exit_at(&self.nearest.or(self.blocked)?)
    }

    /// Returns the exit through the part of the boundary in `found`; `None` if the two parts
    /// overlap by more than rounding.
    fn exit_at(&self, found: &PartSeparation<N, D>) -> Option<Exit<N, D>> {
        let PartSeparation { separation, parts, .. } = *found;
        let Separation { normal, point1, point2, distance } = separation;
        let (point, outward) = if self.inner == 0 { (point2, normal) } else { (point1, -normal) };
        // An overlap within rounding error still has an exit, because another algorithm may find a
        // gap there.
        (distance > -rounding([&point1, &point2])).then_some(Exit { point, outward, parts })
    }

    /// Returns the depth of the piece as a negative separation; `None` if [`Self::exit`] returns
    /// `None` or the depth is not finite.
    fn separation(&self, between: &Between<'_, N, D>) -> Option<PartSeparation<N, D>> {
        let Exit { point, outward, parts } = self.exit()?;
        let pose12 = &between.pair.pose12;
        let to_inner_frame = |vector: Vector<N, D>| {
            if self.inner == 0 { vector } else { pose12.inverse_vector(&vector) }
        };
        let origin = if self.inner == 0 { point } else { pose12.inverse_point(&point) };
        let (kind, _) = between.in_frame_of_other(self.inner);
        let inward = to_inner_frame(-outward);
        let (mut depth, mut lowest, mut deepest) = (-N::INFINITY, Vector::<N, D>::zeros(), 0);
        self.each_part(between, |part| {
            each_solid(kind, part, |kind, pose| {
                let Some(map) = Geometry(kind).as_support_map() else { return };
                let core = map.core_support(&pose.inverse_vector(&inward));
                let arm = pose.point(&core) - origin + inward * map.rounding();
                let own = arm.dot(&inward);
                if own > depth {
                    (depth, lowest, deepest) = (own, arm, part);
                }
            });
        });
        let low = if self.inner == 0 { lowest } else { pose12.vector(&lowest) };
        let low = point + low;
        let high = low + outward * depth;
        let (normal, points) =
            if self.inner == 0 { (-outward, [low, high]) } else { (outward, [high, low]) };
        let [point1, point2] = points;
        let separation = Separation { distance: -depth, normal, point1, point2 };
        let mut deepest_parts = parts;
        deepest_parts[self.inner] = deepest;
        let local = between.parts(deepest_parts).in_first_part(&separation);
        depth.is_finite_number().then_some(PartSeparation {
            separation,
            local,
            parts: deepest_parts,
        })
    }
}

/// Returns an upper bound of the rounding error of lengths that are computed from two points.
fn rounding<N: Real, const D: usize>(points: [&Point<N, D>; 2]) -> N {
    let size = max(max_component(&points[0].coords), max_component(&points[1].coords));
    N::lit(ROUNDING) * N::EPSILON * size
}

/// Returns the pair of parts that `wanted` selects if bodies are solid inside; `best` is the result
/// for the surfaces alone. `None` if no pair is within `limit`.
pub(super) fn with_inside<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    limit: N,
    wanted: Wanted,
    best: Option<PartSeparation<N, D>>,
) -> Option<PartSeparation<N, D>> {
    let touches = best.is_some_and(|best| best.separation.distance <= N::ZERO);
    if touches && wanted == Wanted::Touching {
        return best;
    }
    let (mut best, mut pieces) = (best, held_pieces(between));
    pieces.retain(|piece| !(touches && best.is_some_and(|best| piece.has(between, best.parts))));
    find_exits(between, &mut pieces);
    for found in pieces.iter().filter_map(|piece| piece.separation(between)) {
        let is_within = found.separation.distance <= limit;
        if is_within && best.is_none_or(|best| found.is_before(&best)) {
            best = Some(found);
        }
    }
    best
}
