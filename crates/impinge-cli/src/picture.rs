//! What all pictures have in common: sizes that suit the world, and colours for a light background.

use impinge::bounding_volume::Aabb;
use impinge::debug_render::{Color, DebugDrawing, DebugOptions};
use impinge::math::{Point, Vector};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;

use crate::space::Stage;

/// A drawing of a world, whose options have sizes for objects of length 1.
pub(crate) fn drawing<N: Stage<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    options: DebugOptions<N>,
) -> DebugDrawing<N, D> {
    let Extent { typical, whole } = extent(world);
    let mut options = options.scaled(N::lit(typical));
    options.mesh.half_space_extent = N::lit(whole);
    if let Some(normal) = &mut options.contact_normal {
        normal.color = NORMAL;
    }
    DebugDrawing::new(options).with_object_color(object_color)
}

/// Lengths of a world; 1 where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extent {
    /// The median of the objects' longest sides.
    typical: f64,
    /// The distance from the origin, along an axis, within which all bounded objects are.
    whole: f64,
}

/// The lengths of a world. Objects without bounds, such as half-spaces, count nothing.
fn extent<N: Stage<D>, const D: usize, T>(world: &CollisionWorld<N, D, T>) -> Extent {
    let boxes =
        world.collision_objects().map(|object| object.shape().aabb(&N::pose(object.position())));
    let boxes: Vec<_> = boxes.filter(Aabb::is_bounded).collect();
    let longest = |half: Vector<N, D>| (half.amax() * N::TWO).as_f64();
    let mut sides: Vec<f64> = boxes.iter().map(|aabb| longest(aabb.half_extents())).collect();
    sides.sort_by(f64::total_cmp);
    let farthest = |corner: &Point<N, D>| corner.coords.amax().as_f64();
    let corners = boxes.iter().flat_map(|aabb| [farthest(aabb.mins()), farthest(aabb.maxs())]);
    let whole = corners.fold(0.0, f64::max);
    let or_one = |length: f64| if length > 0.0 && length.is_finite() { length } else { 1.0 };
    let typical = sides.get(sides.len() / 2).copied().unwrap_or_default();
    Extent { typical: or_one(typical), whole: or_one(whole) }
}

/// Contact normals.
const NORMAL: Color = Color::rgb(190, 110, 20);

/// The colour of an object.
fn object_color(handle: CollisionObjectHandle) -> Option<Color> {
    Some(COLORS[handle.uid() % COLORS.len()])
}

/// Objects, in turn.
const COLORS: [Color; 6] = [
    Color::rgb(124, 146, 176),
    Color::rgb(204, 128, 104),
    Color::rgb(150, 178, 146),
    Color::rgb(212, 176, 106),
    Color::rgb(160, 136, 170),
    Color::rgb(120, 170, 172),
];
