//! A user-defined convex shape, given by its support map: the Reuleaux triangle. It is bounded by
//! three arcs around the corners of an equilateral triangle. Like a ball it has the same width in
//! every direction. So the sum of the distances of the triangle from two parallel walls is the same
//! at every angle. Distances, point queries and worlds need only the support map.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::math::Matrix;
use impinge::dim2::prelude::*;
use impinge::dim2::shape::{CurvedSupport, Geometry, SupportMap};

/// The points at a distance of at most `width` from each of the three corners, which are `width`
/// apart.
#[derive(Debug)]
struct Reuleaux {
    width: f64,
    corners: [Point<f64>; 3],
}

impl Reuleaux {
    fn new(width: f64) -> Self {
        let top = Vector::y() * (width / 3.0_f64.sqrt());
        let third = std::f64::consts::TAU / 3.0;
        Self {
            width,
            corners: [0.0, 1.0, 2.0].map(|n| Rotation::new(third * n) * Point::from(top)),
        }
    }

    /// Returns the center of the arc whose normals include a direction; `None` if a corner is the
    /// support point. The center is the corner within 30° of the opposite direction. Corners are
    /// width / √3 from the middle, and cos 30° is √3 / 2.
    fn arc(&self, direction: &Vector<f64>) -> Option<&Point<f64>> {
        self.corners.iter().find(|corner| corner.coords.dot(direction) <= -self.width / 2.0)
    }
}

impl SupportMap<f64, 2> for Reuleaux {
    fn core_support(&self, direction: &Vector<f64>) -> Point<f64> {
        let Some(toward) = direction.try_normalize(0.0) else { return Point::origin() };
        if let Some(corner) = self.arc(&toward) {
            return corner + toward * self.width;
        }
        let height = |corner: &Point<f64>| corner.coords.dot(&toward);
        let [a, b, c] = self.corners;
        let higher = |a, b| if height(&a) < height(&b) { b } else { a };
        higher(higher(a, b), c)
    }

    // Optional: on an arc the support point moves on a circle around the corner. With this method
    // normals are accurate up to rounding.
    fn curved_support(
        &self,
        _: &Point<f64>,
        direction: &Vector<f64>,
    ) -> Option<CurvedSupport<f64>> {
        self.arc(direction).map(|corner| CurvedSupport {
            point: corner + direction * self.width,
            bend: (Matrix::identity() - direction * direction.transpose()) * self.width,
        })
    }
}

impl Shape<f64, 2> for Reuleaux {
    fn geometry(&self) -> Geometry<'_, f64> {
        Geometry::support_map(self)
    }

    // The bounding box of the unrotated shape, from the support points along the axes.
    fn local_aabb(&self) -> Aabb<f64> {
        let reach = |direction: Vector<f64>| self.core_support(&direction);
        let (x, y) = (Vector::x(), Vector::y());
        let mins = Point::new(reach(-x).x, reach(-y).y);
        Aabb::new(mins, Point::new(reach(x).x, reach(y).y))
    }
}

fn main() {
    let (roller, here) = (Reuleaux::new(2.0), Isometry::identity());
    let at = |n: u32, count: u32| (f64::from(n) + 0.5) / f64::from(count) * 2.5 - 1.25;
    let mut filled = 0;
    for row in (0..20).rev() {
        let is_inside =
            |column| roller.contains_point(&here, &Point::new(at(column, 40), at(row, 20)));
        let line: String =
            (0..40).map(|column| if is_inside(column) { '#' } else { ' ' }).collect();
        filled += line.matches('#').count();
        println!("{line}");
    }
    // The area is (π − √3) / 2 · width². A cell of the picture is 1/16 wide and 1/8 high.
    let (area, counted) = (2.0 * (std::f64::consts::PI - 3.0_f64.sqrt()), filled as f64 / 128.0);
    println!("area {area:.3}, of the cells {counted:.3}");
    assert!((area - counted).abs() < 0.1, "the picture shows the shape");

    // A floor at y = −2 and a ceiling at y = 2, both half-planes. Both gaps together are 4 − 2 at
    // every angle.
    let floor = Plane::new(Vector::y_axis());
    let ceiling = Plane::new(-Vector::y_axis());
    let (low, high) = (Isometry::translation(0.0, -2.0), Isometry::translation(0.0, 2.0));
    for degrees in 0..360_u16 {
        let turned = Isometry::new(Vector::zeros(), f64::from(degrees).to_radians());
        let below = distance(&low, &floor, &turned, &roller);
        let above = distance(&high, &ceiling, &turned, &roller);
        assert!((below + above - 2.0).abs() < 1e-12, "{below} and {above} at {degrees}°");
    }

    // A world handles the roller like any other shape. Here the lower corner, 2/√3 below the
    // middle, penetrates the floor by 0.1.
    let mut world = CollisionWorld::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
    world.add(here, ShapeHandle::new(floor), groups, query, "floor");
    let height = 2.0 / 3.0_f64.sqrt() - 0.1;
    let upside_down = Isometry::new(Vector::new(0.0, height), std::f64::consts::PI);
    world.add(upside_down, ShapeHandle::new(roller), groups, query, "roller");
    world.update();
    let (_, _, manifold) = world.contact_manifolds().next().expect("they overlap");
    let depth = manifold.deepest_contact().expect("manifolds hold contacts").contact.depth;
    assert!((depth - 0.1).abs() < 1e-12, "{depth}");
}
