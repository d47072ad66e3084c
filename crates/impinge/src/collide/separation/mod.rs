//! The separation of two convex solids: how far apart or how deep, at which points and along which normal.
//!
//! Distance, closest points, proximity, contact and time of impact are all derived from the
//! [`Separation`] that the functions here compute, so that they cannot contradict each other. A table per
//! dimension says which function serves which pair; a pair with a closed form has a file of its own, named in
//! the order of [`ShapeKind`]:
//!
//! - [`balls`], [`segments`], [`boxes`] and [`polygons`] hold closed forms and separating axis tests;
//! - [`apart`] searches the nearest points of triangles, boxes and hulls in 3D that are well apart, of one pair or eight;
//! - [`hulls`] is the separating axis test of triangles, boxes and hulls in 3D, `triangles` and `chain` test eight
//!   parts of a surface at once;
//! - `revolved` serves cylinders and cones by the signed distance of a point, `ridges` their deep overlaps, `revolved::coaxial`
//!   those about one axis;
//! - `shared_corner` settles the distance of solids that are apart by rounding alone;
//! - `plane_any` serves half-spaces, `rounded` inflated solids, and `general` the rest, by GJK and EPA, smooth ones `eroded`.
//!
//! Every function is given a pair and a limit and answers in the frame of the first solid; `None`
//! exactly if the signed distance is above the limit (or not a number). The limit never changes the
//! answer.

pub(crate) mod apart;
pub(crate) mod balls;
pub(crate) mod boxes;
mod chain;
mod eroded;
mod flat_core;
mod general;
pub(crate) mod hulls;
mod inner_ball;
mod overlap;
mod plane_any;
pub(crate) mod polygons;
pub(crate) mod projection;
mod revolved;
mod ridges;
mod rounded;
mod seen;
pub(crate) mod segments;
mod shared_corner;
mod table2;
mod table3;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod triangle_tests;
mod triangles;
mod world;

use crate::collide::Pair;
use crate::convex::Separation;
use crate::math::{Real, Space};
use crate::shape::{Geometry, ShapeKind};
use crate::tables::ByDimension;

pub(crate) use balls::ball_triangle::separation as ball_triangle;
pub(crate) use chain::{ChainQuestion, Links, links};
pub(crate) use overlap::{distance_in_plane, distance_in_space};
pub(crate) use projection::Projection;
pub(crate) use rounded::bare;
pub(crate) use seen::{seen_in_plane, seen_in_space};
pub(crate) use segments::segment_lanes::{SegmentGap, is_usual, nearest_on_segment};
pub(crate) use table2::separation as separation_in_plane;
pub(crate) use table3::separation as separation_in_space;
pub(crate) use triangles::{
    BallQuestion, NearTriangles, TiledTriangles, TriangleGap, gaps3, near_triangles,
};
pub(crate) use world::{
    AtIsometry, distance_in_world, in_world, of_ordered, placed, touching_in_world,
    touching_of_ordered,
};

/// An algorithm for one pair of kinds.
pub(crate) type Algorithm<N, const D: usize> = fn(&Pair<'_, N, D>, N) -> Option<Separation<N, D>>;

/// One algorithm for each pair of kinds, by row and column in the order of [`ShapeKind`].
type Table<N, const D: usize> = [[Algorithm<N, D>; ShapeKind::COUNT]; ShapeKind::COUNT];

/// The separation of any pair, in either order of kinds.
#[inline]
pub(crate) fn separation<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    <N::Algorithms>::separation(pair, limit)
}

/// The algorithm of a table for a pair.
#[inline]
fn look_up<N: Real, const D: usize>(table: &Table<N, D>, pair: &Pair<'_, N, D>) -> Algorithm<N, D> {
    table[Geometry(pair.first).kind() as usize][Geometry(pair.second).kind() as usize]
}

/// The entry below the diagonal: the pair in its fixed order, turned round.
fn flipped<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let pose12 = pair.pose12.inverse();
    let ordered = Pair { first: pair.second, second: pair.first, pose12 };
    separation(&ordered, limit).map(|found| found.flipped(&pose12))
}

/// An algorithm was given kinds that it is not for: the table is wrong.
fn wrong_kinds<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> ! {
    let (first, second) = (Geometry(pair.first).kind(), Geometry(pair.second).kind());
    unreachable!("the pair table sent {first:?} and {second:?} to the wrong algorithm")
}
