//! Triangle against box in space.

use super::triangle_axes::{Axis, AxisKind, Edging, Fin, least_sine, noise, parted};
use super::{general, wrong_kinds};
use crate::convex::Separation;
use crate::math::{Pose, Real, Vector, max, min};
use crate::query::Pair;
use crate::shape::{Cuboid, Kind, SupportMap, Triangle};

/// The separation of a triangle from a box.
///
/// Where they overlap the separating axis test is exact. Where they are apart it gives a bound, and
/// the distance if the nearest points lie on a face or between edges; in the other cases (a corner and
/// a corner or an edge) the general algorithm decides.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (Kind::Triangle(triangle), Kind::Cuboid(cuboid)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let Some(fin) = Fin::new(triangle, &pair.pose12, cuboid.reach()) else {
        return general::of_flat_cores(pair, limit);
    };
    let best = best_axis(&fin, cuboid, |gap| fin.is_beyond(gap, limit))?;
    answer(&fin, cuboid, &best, limit)
}

/// What the direction that leaves the largest gap says.
pub(super) fn answer<N: Real>(
    fin: &Fin<'_, N>,
    cuboid: &Cuboid<N, 3>,
    best: &Axis<N>,
    limit: N,
) -> Option<Separation<N, 3>> {
    match fin.answer(cuboid, best) {
        Some(found) => (found.distance <= limit).then_some(found),
        None => general::of_flat_cores(&fin.pair(Kind::Cuboid(cuboid)), limit),
    }
}

/// Whether a triangle and a box are farther apart than a limit of less than zero; `None` where the
/// numbers end.
pub(super) fn is_beyond<N: Real>(
    triangle: &Triangle<N, 3>,
    cuboid: &Cuboid<N, 3>,
    pose12: &Pose<N, 3>,
    limit: N,
) -> Option<bool> {
    let fin = Fin::new(triangle, pose12, cuboid.reach())?;
    Some(best_axis(&fin, cuboid, |gap| fin.grown(gap) > limit).is_none())
}

/// The direction that leaves the largest gap; `None` as soon as one is met that leaves one that is
/// beyond.
fn best_axis<N: Real>(
    fin: &Fin<'_, N>,
    cuboid: &Cuboid<N, 3>,
    is_beyond: impl Fn(N) -> bool,
) -> Option<Axis<N>> {
    let half = cuboid.half_extents() * fin.shrink;
    let face = best_of_box(fin, &half);
    if is_beyond(face.gap) {
        return None;
    }
    let Edging { sides, front } = fin.edging();
    let face = best_face(fin, &half, &front, face);
    if is_beyond(face.gap) {
        return None;
    }
    let best = best_edges(fin, &half, &sides, face.gap + noise()).unwrap_or(face);
    (!is_beyond(best.gap)).then_some(best)
}

/// The face normal of the box that leaves the largest gap.
#[inline]
fn best_of_box<N: Real>(fin: &Fin<'_, N>, half: &Vector<N, 3>) -> Axis<N> {
    let (mut best, mut face, mut toward) = (-N::INFINITY, 0, N::ONE);
    let [a, b, c] = &fin.corners;
    for axis in 0..3 {
        let range = [min(min(a[axis], b[axis]), c[axis]), max(max(a[axis], b[axis]), c[axis])];
        let (gap, is_above) = parted(range, [-half[axis], half[axis]]);
        if gap > best {
            // The positive side comes first; see `Cuboid`.
            (best, face) = (gap, [0, 2, 4][axis] + u32::from(!is_above));
            toward = if is_above { -N::ONE } else { N::ONE };
        }
    }
    let normal = Vector::<N, 3>::ith((face / 2) as usize, toward);
    Axis { kind: AxisKind::Face(face), normal, gap: best }
}

/// The triangle's own normal, unless that of a face of the box leaves a gap that is larger by more
/// than rounding: it is the one that a surface has.
#[inline]
fn best_face<N: Real>(
    fin: &Fin<'_, N>,
    half: &Vector<N, 3>,
    front: &Option<Vector<N, 3>>,
    of_box: Axis<N>,
) -> Axis<N> {
    let Some(front) = front else { return of_box };
    let reach = front.x.abs() * half.x + front.y.abs() * half.y + front.z.abs() * half.z;
    let (gap, is_above) = parted(fin.range(front), [-reach, reach]);
    let normal = if is_above { -front } else { *front };
    let is_less = of_box.gap > gap + noise();
    if is_less { of_box } else { Axis { kind: AxisKind::Triangle, normal, gap } }
}

/// An edge of the box and a side of the triangle that leave a larger gap than `least`.
///
/// The cross product of two unit vectors has the sine of their angle for its length. Where the gap
/// along it is negative, dividing by that can only make it smaller, so most pairs need no root.
fn best_edges<N: Real>(
    fin: &Fin<'_, N>,
    half: &Vector<N, 3>,
    sides: &[Vector<N, 3>; 3],
    least: N,
) -> Option<Axis<N>> {
    let (mut best, mut bound) = (None, least);
    for (at, side) in sides.iter().enumerate() {
        let on = &fin.corners[at];
        let off = &fin.corners[if at == 0 { 2 } else { at - 1 }];
        for (axis, (i1, i2)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
            // The axis of the box times the side.
            let (x, y) = (-side[i2], side[i1]);
            let (p, q) = (x * on[i1] + y * on[i2], x * off[i1] + y * off[i2]);
            let reach = x.abs() * half[i1] + y.abs() * half[i2];
            let (slack, is_above) = parted([min(p, q), max(p, q)], [-reach, reach]);
            if slack <= min(bound, N::ZERO) {
                continue;
            }
            let sine = (x * x + y * y).sqrt();
            // Of parallel edges nothing new is learnt: the faces suffice.
            if sine > least_sine() && slack > bound * sine {
                bound = slack / sine;
                let sine = if is_above { -sine } else { sine };
                best = Some((at, axis, [x / sine, y / sine]));
            }
        }
    }
    best.map(|(side, axis, [x, y])| {
        let mut normal = Vector::<N, 3>::zeros();
        (normal[(axis + 1) % 3], normal[(axis + 2) % 3]) = (x, y);
        Axis { kind: AxisKind::Edges(edge_toward(axis, &-normal), side), normal, gap: bound }
    })
}

/// The number of the edge of a box along an axis that lies farthest in a direction; see [`Cuboid`].
pub(super) fn edge_toward<N: Real>(axis: usize, direction: &Vector<N, 3>) -> u32 {
    let is_positive = |axis: usize| u32::from(direction[axis % 3] >= N::ZERO);
    [0, 4, 8][axis] + is_positive(axis + 1) + 2 * is_positive(axis + 2)
}
