//! Signed distances of points from one solid.

use super::features::Features;
use super::polytope;
use super::pose::Pose;
use super::solid::Solid;
use super::vector::{dot, norm, scale};

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
    /// A solid of revolution about the y axis, given by its section with a plane through the axis.
    /// The closest point lies in the half-plane of the axis and the query point, so a 2D query
    /// suffices.
    Revolved(Features<2>),
}

impl<const D: usize> PointMeter<D> {
    /// Computes the features of the solid once, for many points.
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

    /// Returns the signed distance of a local point, negative inside, and a unit direction.
    /// Outside, it leads from the solid to the point; inside, along the shortest way out. If the
    /// point is on an edge or vertex, or several ways out are equally short, one of the possible
    /// directions is returned.
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

/// Computes the signed distance and direction from a solid of revolution, in the plane through the
/// axis and the point.
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

/// Returns the signed distance of a world point from a solid: negative inside.
#[must_use]
pub fn point_signed_distance<const D: usize>(
    solid: &Solid<D>,
    pose: &Pose<D>,
    point: &[f64; D],
) -> f64 {
    PointMeter::new(solid).measure(&pose.inverse_apply(point)).0
}

/// Whether a world point lies in the solid or on its surface, up to rounding.
#[must_use]
pub fn contains_point<const D: usize>(solid: &Solid<D>, pose: &Pose<D>, point: &[f64; D]) -> bool {
    point_signed_distance(solid, pose, point) <= 0.0
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
        // The lateral surface of this cone has the slope 4 / 3, so its normal is (0.8, 0.6).
        let cone = Solid::Cone { half_height: 2.0, radius: 3.0 };
        let beside_mantle = [1.5 + 0.8, 0.6, 0.0];
        assert!((point_signed_distance(&cone, &pose, &beside_mantle) - 1.0).abs() < 1e-15);
        assert_eq!(point_signed_distance(&cone, &pose, &[0.0, 3.0, 0.0]), 1.0);
    }
}
