//! Table of the algorithm for each pair of kinds in 2D.

use super::balls::{
    ball_ball, ball_cuboid, ball_ellipsoid, ball_polygon, ball_segment, ball_tapered,
    ball_triangle2,
};
use super::polygons::polygon_polygon;
use super::{Algorithm, Table, flipped, general, look_up, plane_any, rounded};
use crate::collide::Pair;
use crate::collide::parts;
use crate::convex::Separation;
use crate::math::Real;

/// Type whose associated constant is the 2D table for the scalar type `N`, because a static item
/// cannot be generic.
struct Table2<N>(core::marker::PhantomData<N>);

impl<N: Real> Table2<N> {
    const TABLE: Table<N, 2> = {
        let bb: Algorithm<N, 2> = ball_ball::separation;
        let bs: Algorithm<N, 2> = ball_segment::separation;
        let b3: Algorithm<N, 2> = ball_triangle2::separation;
        let bc: Algorithm<N, 2> = ball_cuboid::separation;
        let bh: Algorithm<N, 2> = ball_polygon::separation;
        let oo: Algorithm<N, 2> = polygon_polygon::separation;
        let be: Algorithm<N, 2> = ball_ellipsoid::separation;
        let bt: Algorithm<N, 2> = ball_tapered::separation;
        let rr: Algorithm<N, 2> = rounded::separation;
        let gg: Algorithm<N, 2> = general::separation;
        let gp: Algorithm<N, 2> = plane_any::separation;
        let pp: Algorithm<N, 2> = plane_any::plane_plane;
        let gx: Algorithm<N, 2> = parts::separation;
        let __: Algorithm<N, 2> = flipped;
        // Rows and columns: ball, segment, capsule, triangle, cuboid, polytope, cylinder, cone
        // (neither occurs in 2D), ellipsoid, tapered capsule, rounded, support map, plane,
        // composite.
        [
            [bb, bs, bs, b3, bc, bh, gg, gg, be, bt, rr, gg, gp, gx],
            [__, oo, oo, oo, oo, oo, gg, gg, gg, gg, rr, gg, gp, gx],
            [__, __, oo, oo, oo, oo, gg, gg, gg, gg, rr, gg, gp, gx],
            [__, __, __, oo, oo, oo, gg, gg, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, oo, oo, gg, gg, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, oo, gg, gg, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, gg, gg, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, gg, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, __, gg, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, __, __, gg, rr, gg, gp, gx],
            [__, __, __, __, __, __, __, __, __, __, rr, rr, rr, gx],
            [__, __, __, __, __, __, __, __, __, __, __, gg, gp, gx],
            [__, __, __, __, __, __, __, __, __, __, __, __, pp, gx],
            [__, __, __, __, __, __, __, __, __, __, __, __, __, gx],
        ]
    };
}

/// Returns the separation of a pair of any two kinds in 2D, in either order; `None` above `limit`.
pub(crate) fn separation<N: Real>(pair: &Pair<'_, N, 2>, limit: N) -> Option<Separation<N, 2>> {
    look_up(&Table2::<N>::TABLE, pair)(pair, limit)
}
