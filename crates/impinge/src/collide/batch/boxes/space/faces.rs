//! The two faces that meet, of eight pairs side by side: a rectangle of one box, and a face of the other seen along
//! the normal as a parallelogram.

use super::super::{Boxes, other, tolerance};
use super::axis::{BestAxis, of_three, which};
use super::shown::ShownFaces;
use crate::math::lanes::{dot, either, lit, negated, norm, seen_from};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};

/// A face of a box, and the face of the other above it, in the frame of the first of these.
pub(super) struct FacesInLanes<V, M> {
    /// The rectangle is the second box's.
    pub(super) is_second: M,
    /// It is, and the normal is not its own.
    is_leaning: M,
    /// The axis across the rectangle is the first, the second.
    pub(super) is_w: [M; 3],
    /// The normal away from the rectangle's box, by its axes in turn.
    toward: [V; 3],
    pub(super) is_upward: M,
    /// Half of the rectangle's box across, and of its sides.
    pub(super) half: V,
    pub(super) across: [V; 2],
    /// What leans along these sides, of the normal.
    leans: [V; 2],
    /// The axis across the parallelogram, in its own box; its normal is on the positive side.
    pub(super) is_m: [M; 3],
    pub(super) is_positive: M,
    leans_above: [V; 2],
    /// Neither face leans too far: all of both is shown.
    pub(super) is_whole: M,
    pub(super) center: [V; 2],
    pub(super) arms: [[V; 2]; 2],
    pub(super) height: V,
    pub(super) climbs: [V; 2],
    pub(super) area: V,
    pub(super) widths: [V; 2],
    pub(super) tolerance: V,
    /// Neither face is too narrow.
    pub(super) is_fit: M,
}

/// The component on the axis that each lane names, on the next and on the one after.
#[inline(always)]
fn in_turn<S: Simd, V: Wide<S>>(is: &[V::Mask; 3], v: &[V; 3]) -> [V; 3] {
    filled(
        #[inline(always)]
        |turn| is[0].select(v[turn], is[1].select(v[(turn + 1) % 3], v[(turn + 2) % 3])),
    )
}

/// The lanes whose first, second or third component is the largest, the first of equals.
#[inline(always)]
fn largest<S: Simd, V: Wide<S>>(v: &[V; 3]) -> [V::Mask; 3] {
    let (first, second, third) = (v[0].abs(), v[1].abs(), v[2].abs());
    let is_second = second.simd_gt(first);
    let is_third = third.simd_gt(is_second.select(second, first));
    [!(is_second | is_third), is_second & !is_third, is_third]
}

/// One with the sign of a mask.
#[inline(always)]
fn sign<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, is_positive: V::Mask) -> V {
    is_positive.select(V::all(simd, N::ONE), V::all(simd, -N::ONE))
}

/// The rectangle's side of the two.
struct Below<V, M> {
    is_second: M,
    is_w: [M; 3],
    /// By the axes of the box.
    toward: [V; 3],
    /// The same in turn.
    in_turn: [V; 3],
    is_upward: M,
    half: [V; 3],
}

#[inline(always)]
fn below<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>, M: SimdMask<S>>(
    simd: S,
    boxes: &Boxes<V, 3>,
    axis: &BestAxis<V, M>,
) -> Below<V, M> {
    let (zero, normal) = (V::all(simd, N::ZERO), &axis.normal);
    let is_face = which(simd, axis.face);
    let along1 = in_turn(&is_face, normal)[0];
    let along2 = -dot(normal, &of_three(&is_face, boxes.rotation.each_ref()));
    let straight = sign(simd, !axis.is_second.select(along2, along1).simd_lt(zero));
    let (leaning, is_second) = between_edges(simd, boxes, axis);
    let most = largest(&leaning);
    let is_w = filled(
        #[inline(always)]
        |a| (axis.is_edges & most[a]) | (!axis.is_edges & is_face[a]),
    );
    let toward = filled(
        #[inline(always)]
        |a| axis.is_edges.select(leaning[a], is_face[a].select(straight, zero)),
    );
    let in_turn_w = in_turn(&is_w, &toward);
    Below {
        is_second,
        is_w,
        toward,
        in_turn: in_turn_w,
        is_upward: !in_turn_w[0].simd_lt(zero),
        half: in_turn(&is_w, &either(is_second, &boxes.half2, &boxes.half1)),
    }
}

/// The normal away from the box whose face is to be the rectangle where edges decide, and whether that
/// is the second box, there and elsewhere.
#[inline(always)]
fn between_edges<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>, M: SimdMask<S>>(
    simd: S,
    boxes: &Boxes<V, 3>,
    axis: &BestAxis<V, M>,
) -> ([V; 3], M) {
    let leans_too_far = axis.is_edges & !is_shown(simd, &axis.normal);
    if !leans_too_far.any_true() {
        return (axis.normal, axis.is_second);
    }
    let toward2 = negated(&seen_from(&boxes.rotation, &axis.normal));
    let is_second = leans_too_far & is_shown(simd, &toward2);
    (either(is_second, &toward2, &axis.normal), axis.is_second | is_second)
}

/// The face of a box that is most aligned with a unit vector does not lean too far.
#[inline(always)]
fn is_shown<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>, M: SimdMask<S>>(
    simd: S,
    toward: &[V; 3],
) -> M {
    let [_, u, v] = in_turn(&largest(toward), toward);
    ShownFaces::is_all(simd, [u, v])
}

/// The axis that each lane names, of three, times a length.
#[inline(always)]
fn arm<S: Simd, V: Wide<S>>(is: &[V::Mask; 3], axes: [&[V; 3]; 3], length: V) -> [V; 3] {
    let [x, y, z] = of_three(is, axes);
    [x * length, y * length, z * length]
}

/// Where a vector, by the axes in turn, ends when seen along the normal, and how far along.
#[inline(always)]
fn seen<S: Simd, V: Wide<S>>([w, u, v]: [V; 3], toward: &[V; 3]) -> ([V; 2], V) {
    let height = w / toward[0];
    ([u - toward[1] * height, v - toward[2] * height], height)
}

#[inline(always)]
pub(super) fn cross<S: Simd, V: Wide<S>>(a: &[V; 2], b: &[V; 2]) -> V {
    a[0] * b[1] - a[1] * b[0]
}

impl<V, M> FacesInLanes<V, M> {
    /// The faces that meet along the axes.
    #[inline(always)]
    pub(super) fn meeting<S: Simd, N: Real>(
        simd: S,
        boxes: &Boxes<V, 3>,
        axis: &BestAxis<V, M>,
    ) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let below = below(simd, boxes, axis);
        let (rotation, shift) = other(boxes, below.is_second);
        let toward = below.in_turn;
        let facing = negated(&seen_from(&rotation, &below.toward));
        let is_m = largest(&facing);
        let [f0, f1, f2] = in_turn(&is_m, &facing);
        let is_positive = f0.simd_gt(V::all(simd, N::ZERO));
        let half = in_turn(&is_m, &either(below.is_second, &boxes.half1, &boxes.half2));
        let [x, y, z] = &rotation;
        let up = arm(&is_m, [x, y, z], half[0]);
        let outward: V = sign(simd, is_positive);
        let from_plane =
            [shift[0] + up[0] * outward, shift[1] + up[1] * outward, shift[2] + up[2] * outward];
        let [w, u, v] = in_turn(&below.is_w, &from_plane);
        let upward: V = sign(simd, below.is_upward);
        let level = upward * below.half[0];
        let (center, height) = seen([w - level, u, v], &toward);
        let arm1 = in_turn(&below.is_w, &arm(&is_m, [y, z, x], half[1]));
        let arm2 = in_turn(&below.is_w, &arm(&is_m, [z, x, y], half[2]));
        let ((arm1, climb1), (arm2, climb2)) = (seen(arm1, &toward), seen(arm2, &toward));
        let area = cross(&arm1, &arm2);
        let widths = [area.abs() / norm(&arm2), area.abs() / norm(&arm1)];
        let across = [below.half[1], below.half[2]];
        let tolerance = tolerance(simd, boxes);
        let narrow = lit::<S, N, V>(simd, 4.0) * tolerance;
        let is_fit = across[0].smaller(across[1]).simd_gt(narrow)
            & widths[0].smaller(widths[1]).simd_gt(narrow);
        Self {
            is_second: below.is_second,
            is_leaning: below.is_second & axis.is_edges,
            is_w: below.is_w,
            toward,
            is_upward: below.is_upward,
            half: below.half[0],
            across,
            leans: [toward[1], toward[2]],
            is_m,
            is_positive,
            leans_above: [f1, f2],
            is_whole: ShownFaces::is_all(simd, [toward[1], toward[2]])
                & ShownFaces::is_all(simd, [f1, f2]),
            center,
            arms: [arm1, arm2],
            height,
            climbs: [climb1, climb2],
            area,
            widths,
            tolerance,
            is_fit,
        }
    }

    /// What the rectangle shows of itself, and the parallelogram.
    #[inline(always)]
    pub(super) fn shown<S: Simd, N: Real>(&self, simd: S) -> [ShownFaces<M>; 2]
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let below = ShownFaces::of(simd, self.is_w[1], self.leans);
        [below, ShownFaces::of(simd, self.is_m[1], self.leans_above)]
    }

    /// Where a place that is seen at `flat` and so high is on the first box, in its frame: as
    /// `Pose::point` has it for a rectangle of the second box, above which the first one is. That
    /// rectangle does not lean unless `is_partial`, when a face may lean too far.
    #[inline(always)]
    pub(super) fn point1<S: Simd, N: Real>(
        &self,
        simd: S,
        boxes: &Boxes<V, 3>,
        ([mut u, mut v], height): ([V; 2], V),
        is_partial: bool,
    ) -> [V; 3]
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let is_second = self.is_second;
        let level = self.half + is_second.select(height, V::all(simd, N::ZERO));
        let mut w = self.is_upward.select(level, -level);
        if is_partial {
            let (is_leaning, toward) = (self.is_leaning, &self.toward);
            let ground = self.is_upward.select(self.half, -self.half);
            w = is_leaning.select(ground + toward[0] * height, w);
            u = is_leaning.select(u + toward[1] * height, u);
            v = is_leaning.select(v + toward[2] * height, v);
        }
        let [w0, w1, _] = self.is_w;
        let own = [
            w0.select(w, w1.select(v, u)),
            w0.select(u, w1.select(w, v)),
            w0.select(v, w1.select(u, w)),
        ];
        let ([x, y, z], shift) = (&boxes.rotation, &boxes.translation);
        filled(
            #[inline(always)]
            |axis| {
                let there = x[axis] * own[0] + y[axis] * own[1] + z[axis] * own[2] + shift[axis];
                is_second.select(there, own[axis])
            },
        )
    }
}
