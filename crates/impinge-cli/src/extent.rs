//! How large a world and its objects are.

use impinge::math::Point;
use impinge::world::CollisionWorld;

use crate::space::Stage;

/// Lengths of a world, for the sizes of what is drawn and printed; 1 where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    /// The median of the objects' longest sides.
    pub(crate) typical: f64,
    /// The distance from the origin within which all bounded objects are.
    pub(crate) whole: f64,
}

/// The lengths of a world. Objects without bounds count nothing.
pub(crate) fn extent<N: Stage<D>, const D: usize, T>(world: &CollisionWorld<N, D, T>) -> Extent {
    let boxes =
        world.collision_objects().map(|object| object.shape().aabb(&N::pose(object.position())));
    let boxes: Vec<_> = boxes.filter(impinge::bounding_volume::Aabb::is_bounded).collect();
    let longest = |half: impinge::math::Vector<N, D>| (half.amax() * N::TWO).as_f64();
    let mut sides: Vec<f64> = boxes.iter().map(|aabb| longest(aabb.half_extents())).collect();
    sides.sort_by(f64::total_cmp);
    let farthest = |corner: &Point<N, D>| corner.coords.amax().as_f64();
    let corners = boxes.iter().flat_map(|aabb| [farthest(aabb.mins()), farthest(aabb.maxs())]);
    let whole = corners.fold(0.0, f64::max);
    let or_one = |length: f64| if length > 0.0 && length.is_finite() { length } else { 1.0 };
    let typical = sides.get(sides.len() / 2).copied().unwrap_or_default();
    Extent { typical: or_one(typical), whole: or_one(whole) }
}
