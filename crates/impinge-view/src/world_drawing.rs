//! Drawings of worlds: sizes follow from the objects of the world, and the colours suit a light
//! background.

use impinge::bounding_volume::Aabb;
use impinge::debug_render::{Color, DebugDrawing, DebugOptions};
use impinge::math::{Point, Space, Vector};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;

/// Returns a drawing for a world. `options` has sizes that suit objects of length 1.
///
/// The sizes are scaled by the median of the longest sides of the objects' AABBs. Half-spaces are
/// drawn up to the largest coordinate of the bounded objects. Objects get six muted colours in
/// turn, and contact normals, if they are drawn, a brown colour. Costs O(n log n) for n objects.
///
/// ```
/// use impinge::debug_render::DebugOptions;
/// use impinge::dim2::prelude::*;
/// use impinge_view::{SvgPicture, world_drawing};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let (ball, contacts) = (ShapeHandle::new(Ball::new(50.0)), GeometricQueryType::Contacts(0.0, 0.0));
/// for x in [0.0, 80.0] {
///     world.add(Isometry::translation(x, 0.0), ball.clone(), CollisionGroups::new(), contacts, ());
/// }
/// world.update();
/// let mut picture = SvgPicture::plane(300);
/// world_drawing(&world, DebugOptions::default()).world(&world, &mut picture);
/// assert!(picture.to_svg().contains("class=\"contact-point\""));
/// ```
#[must_use]
pub fn world_drawing<N: Space<D>, const D: usize, T>(
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

/// The lengths by which the drawing of a world is scaled. A length that would be zero is 1 instead,
/// for instance if the world has no bounded object.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extent {
    /// The lower median of the longest sides of the AABBs of all bounded objects. For a box on a
    /// larger floor, it is the side of the box.
    typical: f64,
    /// The largest magnitude of a coordinate of the AABBs of all bounded objects.
    whole: f64,
}

/// Computes the lengths for a world. Unbounded objects, such as half-spaces, are ignored.
fn extent<N: Space<D>, const D: usize, T>(world: &CollisionWorld<N, D, T>) -> Extent {
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
    let typical = sides.get(sides.len().saturating_sub(1) / 2).copied().unwrap_or_default();
    Extent { typical: or_one(typical), whole: or_one(whole) }
}

/// The colour of contact normals.
const NORMAL: Color = Color::rgb(190, 110, 20);

/// Returns the colour of an object.
fn object_color(handle: CollisionObjectHandle) -> Option<Color> {
    Some(COLORS[handle.uid() % COLORS.len()])
}

/// The colours of objects, which get them in turn by the indices of their handles.
const COLORS: [Color; 6] = [
    Color::rgb(124, 146, 176),
    Color::rgb(204, 128, 104),
    Color::rgb(150, 178, 146),
    Color::rgb(212, 176, 106),
    Color::rgb(160, 136, 170),
    Color::rgb(120, 170, 172),
];

#[cfg(test)]
mod tests {
    use impinge::dim3::math::{Isometry, Vector};
    use impinge::dim3::shape::{Cuboid, HalfSpace, ShapeHandle};
    use impinge::dim3::world::{CollisionGroups, CollisionWorld, GeometricQueryType};

    use super::{Extent, extent};

    #[test]
    fn extents_by_hand() {
        let mut world = CollisionWorld::new(0.02);
        let mut add = |x, shape: ShapeHandle<f64>| {
            let query = GeometricQueryType::Proximity(0.0);
            let at = Isometry::translation(x, 0.0, 0.0);
            world.add(at, shape, CollisionGroups::new(), query, ());
            extent(&world)
        };
        let half_space = ShapeHandle::new(HalfSpace::new(Vector::y_axis()));
        assert_eq!(add(0.0, half_space), Extent { typical: 1.0, whole: 1.0 }, "without bounds");
        let floor = ShapeHandle::new(Cuboid::new(Vector::new(5.0, 0.5, 5.0)));
        assert_eq!(add(0.0, floor), Extent { typical: 10.0, whole: 5.0 });
        let cube = ShapeHandle::new(Cuboid::new(Vector::repeat(1.0)));
        assert_eq!(add(7.0, cube), Extent { typical: 2.0, whole: 8.0 }, "the cube, not the floor");
    }
}
