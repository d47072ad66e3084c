//! The two reference faces of `L` pairs. The rectangle is a face of one box. The parallelogram is a
//! face of the other box, projected along the normal onto the rectangle's plane.
//!
//! ```text
//!    rectangle                          parallelogram
//!      +-------^ v-----+                     .-----^------.
//!      |       |       |                    /   arms[1]  /       c: `center`, in (u, v)
//!      |       o-----> u                   /      c---> arms[0]
//!      |               |                  /            /
//!      +---------------+                 '------------'
//! ```
//!
//! `w` is the axis of the box perpendicular to the rectangle; `u` and `v` are its next two axes in
//! cyclic order ("in turn"), along the sides. `across` are half the lengths of these sides.
//! `height` is the height of `c` above the rectangle, along the normal; `climbs` is the height of
//! each arm's end above `c`, and `widths` are the distances of `c` from the sides at the ends of
//! the arms. A face is "tilted too far" if the angle between its normal and the separating axis
//! exceeds atan(1/2) ≈ 26.6° ([`SupportingParts::is_all`]).

use super::super::{Boxes, other, tolerance};
use super::axis::{BestAxis, of_three, which};
use super::supporting::SupportingParts;
use crate::math::lanes::{dot, either, lit, negated, norm, rotated_into};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};

/// The rectangle and the parallelogram of each pair, in the frame of the rectangle's box.
pub(super) struct FacesInLanes<V, M> {
    /// Lanes where the rectangle belongs to the second box.
    pub(super) is_second: M,
    /// Lanes where the rectangle belongs to the second box and the separating axis is perpendicular
    /// to two edges. There the normal is tilted against the rectangle.
    is_tilted: M,
    /// For each axis of the rectangle's box, the lanes where it is perpendicular to the rectangle.
    pub(super) is_w: [M; 3],
    /// Components of the unit normal away from the rectangle's box, along `w`, `u` and `v`.
    toward: [V; 3],
    /// Lanes where the rectangle is at the positive end of the axis `w`.
    pub(super) is_upward: M,
    /// Half extent of the rectangle's box along `w`.
    pub(super) half: V,
    /// Half extents of the rectangle along `u` and `v`.
    pub(super) across: [V; 2],
    /// Components of the normal along `u` and `v`: its tilt.
    tilt: [V; 2],
    /// For each axis of the parallelogram's box, the lanes where it is perpendicular to the
    /// parallelogram's face.
    pub(super) is_m: [M; 3],
    /// Lanes where the parallelogram's face is at the positive end of the axis that it is
    /// perpendicular to.
    pub(super) is_positive: M,
    /// Components, along the sides of the parallelogram's face, of the unit normal from its box
    /// towards the rectangle.
    tilt_above: [V; 2],
    /// Lanes where neither face is tilted too far. There both whole faces are clipped.
    pub(super) is_whole: M,
    /// Centre of the parallelogram in the coordinates `u`, `v` of the rectangle.
    pub(super) center: [V; 2],
    /// Vectors from the centre to the middles of two sides of the parallelogram.
    pub(super) arms: [[V; 2]; 2],
    /// Height of the centre above the rectangle, along the normal.
    pub(super) height: V,
    /// Height of the end of each arm above the centre, along the normal.
    pub(super) climbs: [V; 2],
    /// Cross product of the arms: a quarter of the area, with a sign.
    pub(super) area: V,
    /// Distances of the centre from the sides at the ends of the arms.
    pub(super) widths: [V; 2],
    /// Largest length that counts as a rounding error.
    pub(super) tolerance: V,
    /// Lanes where the half widths of both faces exceed four tolerances.
    pub(super) is_fit: M,
}

/// Returns the components along the selected axis and along the next two axes in cyclic order.
#[inline(always)]
fn in_turn<S: Simd, V: Wide<S>>(is: &[V::Mask; 3], v: &[V; 3]) -> [V; 3] {
    filled(
        #[inline(always)]
        |turn| is[0].select(v[turn], is[1].select(v[(turn + 1) % 3], v[(turn + 2) % 3])),
    )
}

/// Returns, for each axis, the lanes where its component has the largest magnitude; the first axis
/// wins a tie.
#[inline(always)]
fn largest<S: Simd, V: Wide<S>>(v: &[V; 3]) -> [V::Mask; 3] {
    let (first, second, third) = (v[0].abs(), v[1].abs(), v[2].abs());
    let is_second = second.simd_gt(first);
    let is_third = third.simd_gt(is_second.select(second, first));
    [!(is_second | is_third), is_second & !is_third, is_third]
}

/// Returns 1 in the lanes of `is_positive`, else -1.
#[inline(always)]
fn sign<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, is_positive: V::Mask) -> V {
    is_positive.select(V::all(simd, N::ONE), V::all(simd, -N::ONE))
}

/// The rectangle of each pair.
struct Below<V, M> {
    /// Lanes where the rectangle is a face of the second box.
    is_second: M,
    /// For each axis of the rectangle's box, the lanes where it is perpendicular to the rectangle.
    is_w: [M; 3],
    /// Unit normal away from the rectangle's box, in the frame of that box.
    toward: [V; 3],
    /// The components of `toward` along `w`, `u`, `v`.
    in_turn: [V; 3],
    is_upward: M,
    /// Half extents of the rectangle's box along `w`, `u`, `v`.
    half: [V; 3],
}

/// Chooses the rectangle. A separating axis perpendicular to a face selects this face. An axis
/// perpendicular to an edge of each box selects the most aligned face of the first box; but it
/// selects the most aligned face of the second box if only the face of the first is tilted too far.
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
    let (edge_normal, is_second) = between_edges(simd, boxes, axis);
    let most = largest(&edge_normal);
    let is_w = filled(
        #[inline(always)]
        |a| (axis.is_edges & most[a]) | (!axis.is_edges & is_face[a]),
    );
    let toward = filled(
        #[inline(always)]
        |a| axis.is_edges.select(edge_normal[a], is_face[a].select(straight, zero)),
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

/// For lanes whose separating axis is perpendicular to two edges, returns the normal away from the
/// box whose face becomes the rectangle, in the frame of that box. The mask has all lanes where the
/// rectangle belongs to the second box, also for other separating axes.
#[inline(always)]
fn between_edges<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>, M: SimdMask<S>>(
    simd: S,
    boxes: &Boxes<V, 3>,
    axis: &BestAxis<V, M>,
) -> ([V; 3], M) {
    let is_tilted_too_far = axis.is_edges & !is_supporting(simd, &axis.normal);
    if !is_tilted_too_far.any_true() {
        return (axis.normal, axis.is_second);
    }
    let toward2 = negated(&rotated_into(&boxes.rotation, &axis.normal));
    let is_second = is_tilted_too_far & is_supporting(simd, &toward2);
    (either(is_second, &toward2, &axis.normal), axis.is_second | is_second)
}

/// Returns the lanes where the face of a box most aligned with the unit vector `toward`, in the
/// frame of that box, is not tilted too far.
#[inline(always)]
fn is_supporting<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>, M: SimdMask<S>>(
    simd: S,
    toward: &[V; 3],
) -> M {
    let [_, u, v] = in_turn(&largest(toward), toward);
    SupportingParts::is_all(simd, [u, v])
}

/// Returns, in each lane, the axis selected by `is`, times `length`.
#[inline(always)]
fn arm<S: Simd, V: Wide<S>>(is: &[V::Mask; 3], axes: [&[V; 3]; 3], length: V) -> [V; 3] {
    let [x, y, z] = of_three(is, axes);
    [x * length, y * length, z * length]
}

/// Projects a vector with the components `w`, `u`, `v` along the normal onto the rectangle's plane.
/// Returns its coordinates `u`, `v` there, and its height along the normal.
#[inline(always)]
fn projected<S: Simd, V: Wide<S>>([w, u, v]: [V; 3], toward: &[V; 3]) -> ([V; 2], V) {
    let height = w / toward[0];
    ([u - toward[1] * height, v - toward[2] * height], height)
}

#[inline(always)]
pub(super) fn cross<S: Simd, V: Wide<S>>(a: &[V; 2], b: &[V; 2]) -> V {
    a[0] * b[1] - a[1] * b[0]
}

impl<V, M> FacesInLanes<V, M> {
    /// Finds the rectangle from the separating axis, and the parallelogram from the other box.
    #[inline(always)]
    pub(super) fn of_axis<S: Simd, N: Real>(
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
        let facing = negated(&rotated_into(&rotation, &below.toward));
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
        let (center, height) = projected([w - level, u, v], &toward);
        let arm1 = in_turn(&below.is_w, &arm(&is_m, [y, z, x], half[1]));
        let arm2 = in_turn(&below.is_w, &arm(&is_m, [z, x, y], half[2]));
        let ((arm1, climb1), (arm2, climb2)) = (projected(arm1, &toward), projected(arm2, &toward));
        let area = cross(&arm1, &arm2);
        let widths = [area.abs() / norm(&arm2), area.abs() / norm(&arm1)];
        let across = [below.half[1], below.half[2]];
        let tolerance = tolerance(simd, boxes);
        let narrow = lit::<S, N, V>(simd, 4.0) * tolerance;
        let is_fit = across[0].smaller(across[1]).simd_gt(narrow)
            & widths[0].smaller(widths[1]).simd_gt(narrow);
        Self {
            is_second: below.is_second,
            is_tilted: below.is_second & axis.is_edges,
            is_w: below.is_w,
            toward,
            is_upward: below.is_upward,
            half: below.half[0],
            across,
            tilt: [toward[1], toward[2]],
            is_m,
            is_positive,
            tilt_above: [f1, f2],
            is_whole: SupportingParts::is_all(simd, [toward[1], toward[2]])
                & SupportingParts::is_all(simd, [f1, f2]),
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

    /// Returns the supporting parts of the rectangle and of the parallelogram.
    #[inline(always)]
    pub(super) fn supporting<S: Simd, N: Real>(&self, simd: S) -> [SupportingParts<M>; 2]
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let below = SupportingParts::of(simd, self.is_w[1], self.tilt);
        [below, SupportingParts::of(simd, self.is_m[1], self.tilt_above)]
    }

    /// Returns the point on the first box, in that box's frame, from the coordinates `u`, `v` and
    /// the height. If the rectangle belongs to the second box, the point lies at `height` above it,
    /// along the normal, and is transformed with the rounding of `Pose::point`. Such a rectangle
    /// may be tilted against the normal only if `is_partial`.
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
            let (is_tilted, toward) = (self.is_tilted, &self.toward);
            let base = self.is_upward.select(self.half, -self.half);
            w = is_tilted.select(base + toward[0] * height, w);
            u = is_tilted.select(u + toward[1] * height, u);
            v = is_tilted.select(v + toward[2] * height, v);
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
