//! The convex solids of the reference.

use super::pose::Pose;
use super::vector::{add, axis, dot, negate, norm, scale, sub, unit};

/// A convex solid in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid<const D: usize> {
    /// All points within `radius` of the convex hull of `vertices`.
    ///
    /// Vertices may be coincident, collinear, coplanar or inside the hull.
    Rounded {
        /// The vertices; at least one.
        vertices: Vec<[f64; D]>,
        /// The radius, zero or more; zero for a polytope.
        radius: f64,
    },
    /// All points with `normal · x <= 0`.
    HalfSpace {
        /// The outward unit normal.
        normal: [f64; D],
    },
    /// All points with `|y| <= half_height` within `radius` of the y axis; 3D only.
    Cylinder {
        /// Half the length along the axis.
        half_height: f64,
        /// The radius of the disks.
        radius: f64,
    },
    /// The hull of the apex at `y = half_height` and the disk at `y = -half_height`; 3D only.
    Cone {
        /// Half the length along the axis.
        half_height: f64,
        /// The radius of the disk.
        radius: f64,
    },
}

impl<const D: usize> Solid<D> {
    /// A ball about the local origin.
    #[must_use]
    pub fn ball(radius: f64) -> Self {
        Self::Rounded { vertices: vec![[0.0; D]], radius }
    }

    /// A segment without thickness.
    #[must_use]
    pub fn segment(a: [f64; D], b: [f64; D]) -> Self {
        Self::capsule(a, b, 0.0)
    }

    /// All points within `radius` of a segment.
    #[must_use]
    pub fn capsule(a: [f64; D], b: [f64; D], radius: f64) -> Self {
        Self::Rounded { vertices: vec![a, b], radius }
    }

    /// A filled triangle; flat in 3D.
    #[must_use]
    pub fn triangle(a: [f64; D], b: [f64; D], c: [f64; D]) -> Self {
        Self::polytope(vec![a, b, c])
    }

    /// The box with corners at plus and minus `half_extents`.
    #[must_use]
    pub fn cuboid(half_extents: [f64; D]) -> Self {
        Self::round_cuboid(half_extents, 0.0)
    }

    /// All points within `radius` of a box.
    #[must_use]
    pub fn round_cuboid(half_extents: [f64; D], radius: f64) -> Self {
        let corner = |index: usize| {
            std::array::from_fn(|i| half_extents[i] * if index >> i & 1 == 1 { 1.0 } else { -1.0 })
        };
        Self::Rounded { vertices: (0..1 << D).map(corner).collect(), radius }
    }

    /// The convex hull of some points.
    #[must_use]
    pub fn polytope(vertices: Vec<[f64; D]>) -> Self {
        Self::Rounded { vertices, radius: 0.0 }
    }

    /// All points behind the plane through the local origin with this normal, of any length.
    ///
    /// # Panics
    /// If the normal is zero.
    #[must_use]
    pub fn half_space(normal: [f64; D]) -> Self {
        Self::HalfSpace { normal: unit(&normal).expect("the normal is not zero") }
    }

    /// Returns the extent of the solid along `direction`: the maximum of `direction · x` over its
    /// world points.
    ///
    /// Infinite for a half-space, unless `direction` is its normal to within 1e-12.
    #[must_use]
    pub fn extent(&self, pose: &Pose<D>, direction: &[f64; D]) -> f64 {
        let local = pose.inverse_rotate(direction);
        match self {
            Self::HalfSpace { normal } if norm(&sub(normal, &local)) > 1e-12 => f64::INFINITY,
            Self::HalfSpace { .. } => dot(direction, &pose.translation),
            _ => {
                self.core_extent(&local)
                    + self.radius() * norm(&local)
                    + dot(direction, &pose.translation)
            }
        }
    }

    /// Returns the least and the greatest corner of the smallest axis-aligned box around the solid.
    /// The box of a half-space is bounded only on the side of its normal, and unbounded on all
    /// sides if the normal is not along an axis.
    #[must_use]
    pub fn aabb(&self, pose: &Pose<D>) -> ([f64; D], [f64; D]) {
        (
            std::array::from_fn(|i| -self.extent(pose, &negate(&axis(i)))),
            std::array::from_fn(|i| self.extent(pose, &axis(i))),
        )
    }

    /// Returns the radius by which the core is inflated; zero for half-spaces, cylinders and cones.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match self {
            Self::Rounded { radius, .. } => *radius,
            _ => 0.0,
        }
    }

    /// Returns the radius of a ball about the local origin that contains the solid.
    #[must_use]
    pub fn bounding_radius(&self) -> f64 {
        match self {
            Self::Rounded { vertices, radius } => {
                vertices.iter().map(norm).fold(0.0, f64::max) + radius
            }
            Self::HalfSpace { .. } => f64::INFINITY,
            Self::Cylinder { half_height, radius } | Self::Cone { half_height, radius } => {
                half_height.hypot(*radius)
            }
        }
    }

    /// Returns the maximum of `direction · x` over the core (the solid without its radius), in the
    /// local frame.
    pub(super) fn core_extent(&self, direction: &[f64; D]) -> f64 {
        dot(&self.core_support(direction), direction)
    }

    /// Returns a support point of the core (the solid without its radius) along `direction`, in the
    /// local frame.
    ///
    /// # Panics
    /// For a half-space, which has no support point.
    pub(super) fn core_support(&self, direction: &[f64; D]) -> [f64; D] {
        match self {
            Self::Rounded { vertices, .. } => *vertices
                .iter()
                .max_by(|a, b| dot(a, direction).total_cmp(&dot(b, direction)))
                .expect("a solid has at least one vertex"),
            Self::HalfSpace { .. } => panic!("a half-space has no support point"),
            Self::Cylinder { half_height, radius } => {
                let height = half_height.copysign(direction[1]);
                add(&rim(direction, *radius), &scale(&axis(1), height))
            }
            Self::Cone { half_height, radius } => {
                let apex = scale(&axis(1), *half_height);
                let base = sub(&rim(direction, *radius), &apex);
                if dot(&apex, direction) > dot(&base, direction) { apex } else { base }
            }
        }
    }
}

/// Returns the point of the circle about the y axis that is farthest along `direction`; its centre
/// if `direction` is parallel to the axis.
fn rim<const D: usize>(direction: &[f64; D], radius: f64) -> [f64; D] {
    let flat = std::array::from_fn(|i| if i == 1 { 0.0 } else { direction[i] });
    unit(&flat).map_or([0.0; D], |outward| scale(&outward, radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_by_hand() {
        let capsule = Solid::capsule([0.0, -1.0], [0.0, 1.0], 0.5);
        let lying = Pose::from_complex([10.0, 0.0], [0.0, 1.0]);
        assert_eq!(capsule.aabb(&lying), ([8.5, -0.5], [11.5, 0.5]));
        let cone = Solid::<3>::Cone { half_height: 2.0, radius: 1.0 };
        assert_eq!(cone.aabb(&Pose::identity()), ([-1.0, -2.0, -1.0], [1.0, 2.0, 1.0]));
        let ground = Solid::half_space([0.0, 2.0]);
        let infinity = f64::INFINITY;
        assert_eq!(ground.aabb(&Pose::at([0.0, 3.0])), ([-infinity; 2], [infinity, 3.0]));
    }

    #[test]
    fn extents_of_a_cylinder_by_hand() {
        let cylinder = Solid::<3>::Cylinder { half_height: 2.0, radius: 3.0 };
        let pose = Pose::at([1.0, 0.0, 0.0]);
        assert_eq!(cylinder.extent(&pose, &[0.0, -1.0, 0.0]), 2.0);
        assert_eq!(cylinder.extent(&pose, &[0.6, 0.8, 0.0]), 0.6 + 0.8 * 2.0 + 0.6 * 3.0);
        assert_eq!(cylinder.bounding_radius(), 13f64.sqrt());
    }

    #[test]
    fn corners_of_a_box() {
        let Solid::Rounded { vertices, .. } = Solid::cuboid([1.0, 2.0]) else { unreachable!() };
        assert_eq!(vertices, [[-1.0, -2.0], [1.0, -2.0], [-1.0, 2.0], [1.0, 2.0]]);
    }
}
