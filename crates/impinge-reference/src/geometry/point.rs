//! Points and rays against one solid.

use super::features::Features;
use super::polytope;
use super::pose::Pose;
use super::solid::Solid;
use super::vector::{add, dot, norm, scale};

/// Measures the signed distance of many points from one solid, in its local frame.
#[derive(Clone, Debug)]
pub struct PointMeter<const D: usize> {
    core: Core<D>,
    radius: f64,
}

#[derive(Clone, Debug)]
enum Core<const D: usize> {
    Plane([f64; D]),
    Polytope(Features<D>),
    /// A solid of revolution about the y axis, by its section with a half-plane through the axis and the mirror image
    /// of that. The closest points lie in the half-plane of the point, so the question is one of the plane.
    Revolved(Features<2>),
}

impl<const D: usize> PointMeter<D> {
    /// Prepares the features of the solid.
    #[must_use]
    pub fn new(solid: &Solid<D>) -> Self {
        let core = match solid {
            Solid::HalfSpace { normal } => Core::Plane(*normal),
            Solid::Rounded { vertices, .. } => Core::Polytope(Features::new(vertices)),
            Solid::Cylinder { half_height: h, radius: r } => {
                Core::Revolved(Features::new(&[[*r, *h], [-r, *h], [-r, -h], [*r, -h]]))
            }
            Solid::Cone { half_height: h, radius: r } => {
                Core::Revolved(Features::new(&[[0.0, *h], [-r, -h], [*r, -h]]))
            }
        };
        Self { core, radius: solid.radius() }
    }

    /// The signed distance of a local point, and a unit direction from the solid to the point: the shortest way out if
    /// the point lies inside. On an edge or a corner, or in the middle, it is one of several.
    #[must_use]
    pub fn measure(&self, point: &[f64; D]) -> (f64, [f64; D]) {
        let (distance, normal) = match &self.core {
            Core::Plane(normal) => (dot(normal, point), *normal),
            Core::Polytope(features) => polytope::distance(features, &Features::new(&[*point])),
            Core::Revolved(section) => measure_revolved(section, point),
        };
        (distance - self.radius, normal)
    }
}

/// The distance from a solid of revolution, in the plane through the axis and the point.
fn measure_revolved<const D: usize>(section: &Features<2>, point: &[f64; D]) -> (f64, [f64; D]) {
    let mut outward: [f64; D] = std::array::from_fn(|i| if i == 1 { 0.0 } else { point[i] });
    let from_axis = norm(&outward);
    if from_axis > 0.0 {
        outward = scale(&outward, 1.0 / from_axis);
    } else {
        outward[0] = 1.0;
    }
    let (distance, flat) = polytope::distance(section, &Features::new(&[[from_axis, point[1]]]));
    let mut normal = scale(&outward, flat[0]);
    normal[1] = flat[1];
    (distance, normal)
}

/// The signed distance of a world point from a solid: negative inside.
#[must_use]
pub fn point_signed_distance<const D: usize>(
    solid: &Solid<D>,
    pose: &Pose<D>,
    point: &[f64; D],
) -> f64 {
    PointMeter::new(solid).measure(&pose.inverse_apply(point)).0
}

/// Whether a world point lies in the solid or on its surface, as far as rounding lets one tell.
#[must_use]
pub fn contains_point<const D: usize>(solid: &Solid<D>, pose: &Pose<D>, point: &[f64; D]) -> bool {
    point_signed_distance(solid, pose, point) <= 0.0
}

/// The least `t >= 0` at which `origin + t * direction` is in the solid; zero if the origin is. `direction` may have any
/// length; at length zero only the origin is asked.
///
/// The signed distance from a convex solid is convex along the ray. Its minimum is found by shrinking an
/// interval, and the first zero before that by bisection. The answer is good to about 1e-14 of the distances
/// involved. Flat solids count as 1e-12 (of these distances) thick, and so does a ray that only grazes.
#[must_use]
pub fn ray_cast<const D: usize>(
    solid: &Solid<D>,
    pose: &Pose<D>,
    origin: &[f64; D],
    direction: &[f64; D],
) -> Option<f64> {
    let start = pose.inverse_apply(origin);
    let meter = PointMeter::new(solid);
    if meter.measure(&start).0 <= 0.0 {
        return Some(0.0);
    }
    let speed = norm(direction);
    if speed <= 0.0 {
        return None;
    }
    let along = scale(&pose.inverse_rotate(direction), 1.0 / speed);
    let height = |t: f64| meter.measure(&add(&start, &scale(&along, t))).0;
    // Behind this the ray has left the ball around the solid; the plane of a half-space is met once, far or near.
    let end = match solid {
        Solid::HalfSpace { normal } => {
            return (dot(normal, &along) < 0.0).then(|| -height(0.0) / dot(normal, &along) / speed);
        }
        _ => norm(&start) + solid.bounding_radius(),
    };
    let thickness = 1e-12 * end;
    let lowest = lowest_of_convex(&height, end);
    let level = if height(lowest) < -thickness { 0.0 } else { thickness };
    (height(lowest) <= level).then(|| first_below(&height, level, lowest) / speed)
}

/// A minimum of a convex function on `[0, end]`: the interval shrinks by a third at each step.
fn lowest_of_convex(height: &impl Fn(f64) -> f64, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    for _ in 0..100 {
        let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if height(left) <= height(right) {
            high = right;
        } else {
            low = left;
        }
    }
    0.5 * (low + high)
}

/// The first t at which a function that falls on `[0, inside]` is at most `level`.
fn first_below(height: &impl Fn(f64) -> f64, level: f64, inside: f64) -> f64 {
    let (mut outside, mut inside) = (0.0, inside);
    for _ in 0..100 {
        let middle = 0.5 * (outside + inside);
        if height(middle) <= level {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_from_a_box_by_hand() {
        let (solid, pose) = (Solid::cuboid([1.0, 2.0, 3.0]), Pose::at([10.0, 0.0, 0.0]));
        let off_an_edge = point_signed_distance(&solid, &pose, &[14.0, 6.0, 0.0]);
        assert!((off_an_edge - 5.0).abs() < 1e-14, "3 and 4 make 5: {off_an_edge}");
        assert_eq!(point_signed_distance(&solid, &pose, &[10.5, 1.0, 0.0]), -0.5);
        assert_eq!(point_signed_distance(&solid, &pose, &[11.0, 2.0, 3.0]), 0.0);
        assert!(contains_point(&solid, &pose, &[11.0, 2.0, 3.0]), "the corner belongs to the box");
    }

    #[test]
    fn distances_from_curved_solids_by_hand() {
        let pose = Pose::identity();
        let cylinder = Solid::Cylinder { half_height: 2.0, radius: 3.0 };
        assert_eq!(point_signed_distance(&cylinder, &pose, &[0.0, 0.0, 0.0]), -2.0);
        assert_eq!(point_signed_distance(&cylinder, &pose, &[0.0, 0.0, 2.5]), -0.5);
        assert_eq!(point_signed_distance(&cylinder, &pose, &[6.0, 6.0, 0.0]), 5.0);
        // The mantle of this cone has the slope 4 / 3: its normal is (0.8, 0.6).
        let cone = Solid::Cone { half_height: 2.0, radius: 3.0 };
        let beside_mantle = [1.5 + 0.8, 0.6, 0.0];
        assert!((point_signed_distance(&cone, &pose, &beside_mantle) - 1.0).abs() < 1e-15);
        assert_eq!(point_signed_distance(&cone, &pose, &[0.0, 3.0, 0.0]), 1.0);
    }

    #[test]
    fn rays_by_hand() {
        let pose = Pose::identity();
        let ball = Solid::ball(1.0);
        let t = ray_cast(&ball, &pose, &[-3.0, 0.0, 0.0], &[2.0, 0.0, 0.0]).expect("hits");
        assert!((t - 1.0).abs() < 1e-14, "t {t}");
        assert_eq!(ray_cast(&ball, &pose, &[-3.0, 0.0, 0.0], &[-2.0, 0.0, 0.0]), None);
        assert_eq!(ray_cast(&ball, &pose, &[-3.0, 1.01, 0.0], &[2.0, 0.0, 0.0]), None);
        assert_eq!(ray_cast(&ball, &pose, &[0.5, 0.0, 0.0], &[0.0; 3]), Some(0.0));
        assert_eq!(ray_cast(&ball, &pose, &[1.5, 0.0, 0.0], &[0.0; 3]), None);
    }

    #[test]
    fn rays_on_flat_solids_by_hand() {
        let pose = Pose::identity();
        let triangle = Solid::triangle([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]);
        let t = ray_cast(&triangle, &pose, &[0.25, 0.25, 5.0], &[0.0, 0.0, -1.0]).expect("hits");
        assert!((t - 5.0).abs() < 1e-11, "t {t}");
        assert_eq!(ray_cast(&triangle, &pose, &[0.75, 0.75, 5.0], &[0.0, 0.0, -1.0]), None);
        let segment = Solid::segment([10.0, 1.0], [10.0, -1.0]);
        let t = ray_cast(&segment, &Pose::identity(), &[0.0, 0.0], &[4.0, 0.0]).expect("hits");
        assert!((t - 2.5).abs() < 1e-11, "t {t}");
        let t = ray_cast(&segment, &Pose::identity(), &[10.0, 4.0], &[0.0, -1.0]).expect("end on");
        assert!((t - 3.0).abs() < 1e-10, "t {t}");
    }

    #[test]
    fn rays_on_half_spaces_by_hand() {
        let ground = Solid::half_space([0.0, 1.0]);
        let pose = Pose::at([0.0, 2.0]);
        assert_eq!(ray_cast(&ground, &pose, &[0.0, 6.0], &[1.0, -2.0]), Some(2.0));
        assert_eq!(ray_cast(&ground, &pose, &[0.0, 6.0], &[1.0, 0.0]), None);
        assert_eq!(ray_cast(&ground, &pose, &[0.0, 1.0], &[1.0, 0.0]), Some(0.0));
    }
}
