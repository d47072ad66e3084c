//! Triangle against convex hull in space.

use smallvec::SmallVec;

use super::triangle_axes::{Axis, AxisKind, Best, Edging, Fin, least_sine, noise, parted};
use super::{general, wrong_kinds};
use crate::convex::Separation;
use crate::math::{Pose, Real, Vector, cross, min};
use crate::query::Pair;
use crate::shape::{Kind, Polytope, SupportMap, Triangle};

/// Hulls with more edges are left to the general algorithm, which looks at few of them.
const MOST_EDGES: usize = 96;

/// The separation of a triangle from a convex hull.
///
/// As that of a [box](super::triangle_cuboid). An edge of the hull and a side of the triangle decide
/// along a direction only where the one is its highest and the other its lowest: where the side climbs
/// over the plane of one face beside the edge and sinks below the other's, and the triangle lies on
/// the outer side (Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013, prunes
/// pairs of edges by their arcs of normals).
///
/// Cost: linear in the number of edges.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (Kind::Triangle(triangle), Kind::Polytope(hull)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let Some(fin) = fin(triangle, hull, &pair.pose12) else {
        return general::of_flat_cores(pair, limit);
    };
    let best = best_axis(&fin, hull, |gap| fin.is_beyond(gap, limit));
    settled(&fin, hull, &best, limit)
}

/// What the direction that leaves the largest gap says, which is not yet held against the limit if it is
/// that of two edges.
pub(super) fn answer<N: Real>(
    fin: &Fin<'_, N>,
    hull: &Polytope<N, 3>,
    axis: Axis<N>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let best = match axis.kind {
        AxisKind::Edges(..) if !is_sound(fin, hull, &axis) => Best::Unclear,
        AxisKind::Edges(..) if fin.is_beyond(axis.gap, limit) => Best::Beyond,
        _ => Best::Axis(axis),
    };
    settled(fin, hull, &best, limit)
}

fn settled<N: Real>(
    fin: &Fin<'_, N>,
    hull: &Polytope<N, 3>,
    best: &Best<N>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let fall_back = || general::of_flat_cores(&fin.pair(Kind::Polytope(hull)), limit);
    best.settled(fin, hull, limit, fall_back)
}

/// Whether a triangle and a hull are farther apart than a limit of less than zero; `None` where this
/// does not tell.
pub(super) fn is_beyond<N: Real>(
    triangle: &Triangle<N, 3>,
    hull: &Polytope<N, 3>,
    pose12: &Pose<N, 3>,
    limit: N,
) -> Option<bool> {
    let fin = fin(triangle, hull, pose12)?;
    match best_axis(&fin, hull, |gap| fin.grown(gap) > limit) {
        Best::Beyond => Some(true),
        Best::Axis(_) => Some(false),
        Best::Unclear => None,
    }
}

fn fin<'a, N: Real>(
    triangle: &'a Triangle<N, 3>,
    hull: &Polytope<N, 3>,
    pose12: &'a Pose<N, 3>,
) -> Option<Fin<'a, N>> {
    is_usual(hull).then(|| Fin::new(triangle, pose12, hull.reach()))?
}

/// The hull is a solid of few edges. One without edges, or with faces back to back alone, is no solid.
pub(super) fn is_usual<N: Real>(hull: &Polytope<N, 3>) -> bool {
    hull.edges().len() <= MOST_EDGES && hull.faces().len() > 2
}

fn best_axis<N: Real>(
    fin: &Fin<'_, N>,
    hull: &Polytope<N, 3>,
    is_beyond: impl Fn(N) -> bool,
) -> Best<N> {
    let (face, climbs) = best_of_hull(fin, hull);
    if is_beyond(face.gap) {
        return Best::Beyond;
    }
    let edging = fin.edging();
    let face = best_face(fin, hull, &edging.front, face);
    if is_beyond(face.gap) {
        return Best::Beyond;
    }
    match best_edges(fin, hull, &climbs, &edging, face.gap + noise()) {
        None => Best::Axis(face),
        Some(edges) if !is_sound(fin, hull, &edges) => Best::Unclear,
        Some(edges) if is_beyond(edges.gap) => Best::Beyond,
        Some(edges) => Best::Axis(edges),
    }
}

/// For each face a bit for each side of the triangle that climbs over its plane.
type Climbs = SmallVec<[u8; 64]>;

/// The face normal of the hull that leaves the largest gap.
#[inline]
fn best_of_hull<N: Real>(fin: &Fin<'_, N>, hull: &Polytope<N, 3>) -> (Axis<N>, Climbs) {
    let (mut best, mut lowest, mut climbs) = (0, -N::INFINITY, Climbs::new());
    let [a, b, c] = &fin.corners;
    for (index, face) in (0_u32..).zip(hull.faces()) {
        let normal = &face.normal;
        let (a, b, c) = (normal.dot(a), normal.dot(b), normal.dot(c));
        let gap = min(min(a, b), c) - face.offset * fin.shrink;
        climbs.push(u8::from(b > a) | u8::from(c > b) << 1 | u8::from(a > c) << 2);
        if gap > lowest {
            (best, lowest) = (index, gap);
        }
    }
    let normal = -hull.faces()[best as usize].normal;
    (Axis { kind: AxisKind::Face(best), normal, gap: lowest }, climbs)
}

/// The triangle's own normal, unless that of a face of the hull leaves a gap that is larger by more
/// than rounding: it is the one that a surface has.
fn best_face<N: Real>(
    fin: &Fin<'_, N>,
    hull: &Polytope<N, 3>,
    front: &Option<Vector<N, 3>>,
    of_hull: Axis<N>,
) -> Axis<N> {
    let Some(front) = front else { return of_hull };
    let height = |toward: &Vector<N, 3>| front.dot(&hull.core_support(toward).coords) * fin.shrink;
    let (gap, is_above) = parted(fin.range(front), [height(&-front), height(front)]);
    let normal = if is_above { -front } else { *front };
    let is_less = of_hull.gap > gap + noise();
    if is_less { of_hull } else { Axis { kind: AxisKind::Triangle, normal, gap } }
}

/// An edge of the hull and a side of the triangle that leave a larger gap than `least`.
fn best_edges<N: Real>(
    fin: &Fin<'_, N>,
    hull: &Polytope<N, 3>,
    climbs: &Climbs,
    edging: &Edging<N>,
    least: N,
) -> Option<Axis<N>> {
    let (mut best, mut bound) = (None, least);
    for (index, edge) in (0_u32..).zip(hull.edges()) {
        let [first, second] = edge.faces.map(|face| climbs[face as usize]);
        if first == second {
            continue;
        }
        let [from, to] = edge.vertices.map(|end| hull.vertices()[end as usize].coords);
        let along = (to - from) * fin.shrink;
        // The edge runs around the first face, so its product with a side that climbs over that face
        // leads out of the hull; and the triangle lies beyond the side if the edge runs forward.
        let outer = edging
            .front
            .map_or(0b111, |front| if front.dot(&along) >= N::ZERO { first } else { !first });
        let mut sides = (first ^ second) & outer & 0b111;
        while sides != 0 {
            let side = sides.trailing_zeros() as usize;
            sides &= sides - 1;
            let across = cross(&along, &edging.sides[side]);
            let across = if first >> side & 1 == 1 { across } else { -across };
            let slack = across.dot(&(fin.corners[side] - from * fin.shrink));
            let squared = across.norm_squared();
            let is_more = bound < N::ZERO || slack > N::ZERO;
            let is_steep = squared > least_sine::<N>() * least_sine() * along.norm_squared();
            if !is_more || !is_steep {
                continue;
            }
            let length = squared.sqrt();
            if slack > bound * length {
                bound = slack / length;
                best = Some((index, side, across / -length));
            }
        }
    }
    best.map(|(edge, side, normal)| Axis { kind: AxisKind::Edges(edge, side), normal, gap: bound })
}

/// The gap along an axis is there, held against the farthest points of both.
pub(super) fn is_sound<N: Real>(fin: &Fin<'_, N>, hull: &Polytope<N, 3>, axis: &Axis<N>) -> bool {
    let top = -axis.normal.dot(&hull.core_support(&-axis.normal).coords) * fin.shrink;
    let [_, high] = fin.range(&axis.normal);
    -high - top >= axis.gap - N::lit(4.0) * noise::<N>()
}
