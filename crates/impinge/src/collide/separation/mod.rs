//! Computes the separation of two convex solids: signed distance, normal and nearest points.
//!
//! ```text
//!          solid 1     normal     solid 2        frame: of solid 1 (solid 2 lies at `pose12`)
//!         .-------.               .-----.        normal: unit, from 1 to 2
//!        (        *--------------->      )       distance = normal · (point2 - point1)
//!         '-------' point1  point2'-----'        > 0 apart, 0 touching, < 0 minus the depth
//! ```
//!
//! Distance, closest points, proximity, contact and time of impact are all derived from the
//! [`Separation`] that the functions here compute, so they agree. `table2` and `table3` name the
//! function of each pair of kinds. Most closed forms have a file of their own, named after both
//! kinds in the order of [`ShapeKind`]. The modules:
//!
//! - [`balls`], [`segments`], [`boxes`] and [`polygons`] hold closed forms and separating axis
//!   tests;
//! - [`apart`] searches for the nearest points of triangles, boxes and hulls in 3D that are well
//!   apart, for one pair or for 8;
//! - [`hulls`] is the separating axis test of triangles, boxes and hulls in 3D; `triangles` and
//!   `chain` test 8 triangles of a surface or 8 segments of a chain at a time;
//! - `revolved` handles cylinders and cones by the signed distance of a point from them. If this
//!   proves no result, `ridges` handles overlaps with flat-sided solids, and `revolved::coaxial`
//!   handles pairs with a common axis;
//! - `shared_corner` sets the distance to zero if corners coincide exactly but rounding leaves a
//!   small distance;
//! - `plane_any` handles half-spaces, and `rounded` handles inflated solids. `general` handles all
//!   other pairs by GJK and EPA; before that it replaces ellipsoids by the smaller cores of
//!   `eroded`.
//!
//! Each function takes a pair and a `limit` and returns the separation in the frame of the first
//! solid, or `None` exactly if the signed distance is above `limit` or NaN. `limit` does not change
//! the value of the result.
//!
//! Terms of these files: the *core* of a solid is the solid without its radius. Lengths in *units
//! of the pair* are divided by a power of two near the sum of both bounding radii and the distance
//! of the origins ([`Units`](crate::convex::Units)), so that scaling is exact. A result is *proved*
//! if the vector between its two points is, up to rounding, the normal times the signed distance of
//! the supporting planes (the planes perpendicular to the normal that touch the solids). For
//! overlaps, `revolved` also requires balls inside the solids that exclude a smaller depth.

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
mod project;
pub(crate) mod projection;
mod revolved;
mod ridges;
mod rounded;
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
pub(crate) use overlap::{distance_2d, distance_3d};
pub(crate) use project::{project_on_solid_2d, project_on_solid_3d};
pub(crate) use projection::Projection;
pub(crate) use rounded::bare;
pub(crate) use segments::segment_lanes::{SegmentGap, is_square_in_range, nearest_on_segment};
pub(crate) use table2::separation as separation_2d;
pub(crate) use table3::separation as separation_3d;
pub(crate) use triangles::{
    BallQuestion, CandidateTriangles, TiledTriangles, TriangleGap, candidate_triangles, gaps3,
};
pub(crate) use world::{
    AtIsometry, distance_in_world, in_world, of_ordered, placed, touching_in_world,
    touching_of_ordered,
};

/// Algorithm for one pair of kinds: takes the pair and the largest distance of interest, inclusive.
pub(crate) type Algorithm<N, const D: usize> = fn(&Pair<'_, N, D>, N) -> Option<Separation<N, D>>;

/// One algorithm for each pair of kinds; row and column are the kinds in the order of
/// [`ShapeKind`].
type Table<N, const D: usize> = [[Algorithm<N, D>; ShapeKind::COUNT]; ShapeKind::COUNT];

/// Returns the separation of a pair of any two kinds, in either order; `None` above `limit`.
#[inline]
pub(crate) fn separation<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    <N::Algorithms>::separation(pair, limit)
}

/// Looks up the algorithm of a pair in a table.
#[inline]
fn look_up<N: Real, const D: usize>(table: &Table<N, D>, pair: &Pair<'_, N, D>) -> Algorithm<N, D> {
    table[Geometry(pair.first).kind() as usize][Geometry(pair.second).kind() as usize]
}

/// Entry below the diagonal of a table: exchanges the solids, computes their separation, and flips
/// it back to the frame of `pair.first`. `None` above `limit`.
fn flipped<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let pose12 = pair.pose12.inverse();
    let ordered = Pair { first: pair.second, second: pair.first, pose12 };
    separation(&ordered, limit).map(|found| found.flipped(&pose12))
}

/// Panics because the table sent this pair to an algorithm for other kinds.
fn wrong_kinds<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> ! {
    let (first, second) = (Geometry(pair.first).kind(), Geometry(pair.second).kind());
    unreachable!("the pair table sent {first:?} and {second:?} to the wrong algorithm")
}
