//! Contact kernels for pairs of boxes.
//!
//! The contact points of two boxes are corners of the overlap area of two facing faces (in 2D: ends
//! of the overlap of two sides), projected along the separating axis. Case distinctions of a pair
//! become masks over the lanes. Each possible corner has its own slot, filled or not ([`admit`]): 4
//! slots in 2D ([`plane`]), 24 in 3D ([`space`]). Only the choice of the points ([`choose`]) runs
//! pair by pair. Flat boxes, and pairs whose nearest points do not lie on the two faces, fall back
//! to the builder for one pair.
//!
//! The kernels read these fields of [`Inputs`]: both poses, the half extents in `ends[0][0]` and
//! `ends[1][0]`, `prediction` and `sine`: the sine of the angle by which the boxes may rotate, for
//! the test of each corner.

mod admit;
mod choose;
mod plane;
mod space;

pub(super) use self::plane::Boxes2;
pub(super) use self::space::Boxes3;
use super::gather::Inputs;
use super::{PairQuestion, Solid, masks};
use crate::collide::manifold::frame::ROUNDING_ERRORS;
use crate::math::lanes::{either, lit, norm, rotated_into};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};

impl<N: Real, const D: usize, const L: usize> Inputs<N, D, L> {
    /// Copies two boxes and their poses into a lane; returns `false` for other kinds.
    #[inline(always)]
    fn put_boxes(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool {
        let [Solid::Cuboid(box1), Solid::Cuboid(box2)] = pair.solids else { return false };
        self.put_poses(lane, pair);
        self.put_sine(lane, pair.request.sine);
        self.put_end(lane, 0, 0, box1.half_extents());
        self.put_end(lane, 1, 0, box2.half_extents());
        true
    }

    /// Loads the boxes, the second of each pair in the frame of the first.
    #[inline(always)]
    fn boxes<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> Boxes<V, D> {
        let (pose12, half1, half2) =
            (self.pose12::<S, V>(simd), self.end(simd, 0, 0), self.end(simd, 1, 0));
        Boxes { rotation: pose12.rotation, translation: pose12.translation, half1, half2 }
    }
}

/// Pairs of boxes, the second of each in the frame of the first.
pub(super) struct Boxes<V, const D: usize> {
    /// Columns of the rotation: the axes of the second box.
    pub(super) rotation: [[V; D]; D],
    /// Centre of the second box in the frame of the first.
    pub(super) translation: [V; D],
    /// Half extents of the first box, along its own axes.
    pub(super) half1: [V; D],
    /// Half extents of the second box, along its own axes.
    pub(super) half2: [V; D],
}

/// Returns the axes and the centre of the other box in the frame of one box: of the second box in
/// the frame of the first or, in the lanes of `is_second`, of the first box in the frame of the
/// second. The centre of the first box is rounded as by `Pose::inverse`.
#[inline(always)]
pub(super) fn other<S: Simd, V: Wide<S>, const D: usize>(
    boxes: &Boxes<V, D>,
    is_second: V::Mask,
) -> ([[V; D]; D], [V; D]) {
    let (r, t) = (&boxes.rotation, &boxes.translation);
    let inverse = rotated_into(r, t);
    let rotation = filled(
        #[inline(always)]
        |j| {
            let row = filled(
                #[inline(always)]
                |axis| r[axis][j],
            );
            either(is_second, &row, &r[j])
        },
    );
    let shift = filled(
        #[inline(always)]
        |axis| is_second.select(-inverse[axis], t[axis]),
    );
    (rotation, shift)
}

/// Returns the length up to which differences are rounding errors, by the formula of the builder
/// for one pair.
#[inline(always)]
pub(super) fn tolerance<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    boxes: &Boxes<V, D>,
) -> V {
    let size = norm(&boxes.half1) + norm(&boxes.half2) + norm(&boxes.translation);
    lit::<S, N, V>(simd, ROUNDING_ERRORS) * V::all(simd, N::EPSILON) * size
}

/// Returns the length scale of each pair: half the diagonal of the smaller box.
#[inline(always)]
pub(super) fn smaller_size<S: Simd, V: Wide<S>, const D: usize>(boxes: &Boxes<V, D>) -> V {
    norm(&boxes.half1).smaller(norm(&boxes.half2))
}

/// Returns the lanes where every entry of the pose is finite and the sum of their absolute values
/// does not overflow.
#[inline(always)]
pub(super) fn is_finite<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    boxes: &Boxes<V, D>,
) -> V::Mask {
    let mut all = size(&boxes.translation);
    for axis in &boxes.rotation {
        all += size(axis);
    }
    all.simd_lt(V::all(simd, N::INFINITY))
}

/// Returns the sum of the absolute values of the components.
#[inline(always)]
fn size<S: Simd, V: Wide<S>, const D: usize>(v: &[V; D]) -> V {
    let mut sum = v[0].abs();
    for x in &v[1..] {
        sum += x.abs();
    }
    sum
}
