//! Table of the algorithm for each pair of kinds in 3D.

use super::balls::{
    ball_ball, ball_cone, ball_cuboid, ball_cylinder, ball_ellipsoid, ball_polytope, ball_segment,
    ball_tapered, ball_triangle,
};
use super::boxes::segment_cuboid;
use super::revolved::cylinder_cylinder;
use super::segments::segment_segment;
use super::{
    Algorithm, Table, apart, flipped, general, hulls, look_up, plane_any, revolved, rounded,
};
use crate::collide::Pair;
use crate::collide::parts;
use crate::convex::Separation;
use crate::math::Real;

/// Type whose associated constant is the 3D table for the scalar type `N`, because a static item
/// cannot be generic.
struct Table3<N>(core::marker::PhantomData<N>);

impl<N: Real> Table3<N> {
    const TABLE: Table<N, 3> = {
        let bb: Algorithm<N, 3> = ball_ball::separation;
        let bs: Algorithm<N, 3> = ball_segment::separation;
        let b3: Algorithm<N, 3> = ball_triangle::separation;
        let bc: Algorithm<N, 3> = ball_cuboid::separation;
        let bh: Algorithm<N, 3> = ball_polytope::separation;
        let by: Algorithm<N, 3> = ball_cylinder::separation;
        let bo: Algorithm<N, 3> = ball_cone::separation;
        let ss: Algorithm<N, 3> = segment_segment::separation;
        let be: Algorithm<N, 3> = ball_ellipsoid::separation;
        let bt: Algorithm<N, 3> = ball_tapered::separation;
        let rr: Algorithm<N, 3> = rounded::separation;
        let gg: Algorithm<N, 3> = general::separation;
        let sc: Algorithm<N, 3> = segment_cuboid::separation;
        let sf: Algorithm<N, 3> = hulls::segment::separation;
        let ff: Algorithm<N, 3> = apart::separation;
        let yy: Algorithm<N, 3> = cylinder_cylinder::separation;
        let re: Algorithm<N, 3> = revolved::separation;
        let gp: Algorithm<N, 3> = plane_any::separation;
        let pp: Algorithm<N, 3> = plane_any::plane_plane;
        let gx: Algorithm<N, 3> = parts::separation;
        let __: Algorithm<N, 3> = flipped;
        // Rows and columns: ball, segment, capsule, triangle, cuboid, polytope, cylinder, cone,
        // ellipsoid, tapered capsule, rounded, support map, plane, composite.
        [
            [bb, bs, bs, b3, bc, bh, by, bo, be, bt, rr, gg, gp, gx],
            [__, ss, ss, sf, sc, sf, re, re, gg, gg, rr, gg, gp, gx],
            [__, __, ss, sf, sc, sf, re, re, gg, gg, rr, gg, gp, gx],
            [__, __, __, ff, ff, ff, re, re, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, ff, ff, re, re, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, ff, re, re, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, yy, re, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, re, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, __, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, __, __, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, __, __, __, rr, rr, rr, gx],
            [__, __, __, __, __, __, __, __, __, __, __, gg, gp, gx],
            [__, __, __, __, __, __, __, __, __, __, __, __, pp, gx],
            [__, __, __, __, __, __, __, __, __, __, __, __, __, gx],
        ]
    };
}

/// Returns the separation of a pair of any two kinds in 3D, in either order; `None` above `limit`.
pub(crate) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    look_up(&Table3::<N>::TABLE, pair)(pair, limit)
}
