//! Unit shapes: balls, boxes, ellipsoids, cylinders and cones share the mesh of a unit shape, which
//! is scaled along the axes.

use impinge::math::{Space, Vector};
use impinge::shape::{Ball, Cuboid, Ellipsoid, ShapeHandle, ShapeKind};
use impinge_record::{Recordable, ShapeData};

use crate::frame::mesh::single;

/// The scale of an unscaled mesh.
pub(crate) const UNSCALED: [f32; 3] = [1.0; 3];

/// The unit shapes, with radii, half extents and half heights of 1. The ball also serves for
/// ellipsoids.
#[derive(Debug)]
pub(crate) struct UnitShapes<N: Space<D>, const D: usize> {
    ball: ShapeHandle<N, D>,
    cuboid: ShapeHandle<N, D>,
    /// The cylinder; `None` in 2D.
    cylinder: Option<ShapeHandle<N, D>>,
    /// The cone; `None` in 2D.
    cone: Option<ShapeHandle<N, D>>,
}

impl<N: Recordable<D>, const D: usize> UnitShapes<N, D> {
    pub(crate) fn new() -> Self {
        // Generic code cannot name the shapes that exist in 3D only, but can create them from their
        // data.
        let sizes = [N::ONE; 2];
        Self {
            ball: ShapeHandle::new(Ball::new(N::ONE)),
            cuboid: ShapeHandle::new(Cuboid::new(Vector::<N, D>::repeat(N::ONE))),
            cylinder: N::own_shape(&ShapeData::Cylinder(sizes)).ok(),
            cone: N::own_shape(&ShapeData::Cone(sizes)).ok(),
        }
    }

    /// Returns a unit shape and the scale factors that make its mesh the mesh of `shape`, up to
    /// rounding. Returns `shape` itself, unscaled, if its kind has no unit shape or a factor is not
    /// a normal `f32`. With a factor of 0, edges of length zero would remain, which the mesh of a
    /// flat shape omits.
    pub(crate) fn scaled<'a>(
        &'a self,
        shape: &'a ShapeHandle<N, D>,
    ) -> (&'a ShapeHandle<N, D>, [f32; 3]) {
        let found = self.unit_of(shape).map(|(unit, lengths)| {
            let mut scale = UNSCALED;
            for (factor, length) in scale.iter_mut().zip(lengths.iter()) {
                *factor = single(length.as_f64());
            }
            (unit, scale)
        });
        let usable = found.filter(|(_, scale)| scale.iter().all(|factor| factor.is_normal()));
        usable.unwrap_or((shape, UNSCALED))
    }

    /// Returns the unit shape for the kind of `shape`, and the half extents of `shape` along the
    /// axes; `None` if the kind has no unit shape.
    fn unit_of(&self, shape: &ShapeHandle<N, D>) -> Option<(&ShapeHandle<N, D>, Vector<N, D>)> {
        match shape.geometry().kind() {
            ShapeKind::Ball => {
                let radius = shape.as_shape::<Ball<N>>()?.radius();
                Some((&self.ball, Vector::<N, D>::repeat(radius)))
            }
            ShapeKind::Ellipsoid => {
                Some((&self.ball, *shape.as_shape::<Ellipsoid<N, D>>()?.half_axes()))
            }
            ShapeKind::Cuboid => {
                Some((&self.cuboid, *shape.as_shape::<Cuboid<N, D>>()?.half_extents()))
            }
            ShapeKind::Cylinder | ShapeKind::Cone => {
                let (unit, [half_height, radius]) = match N::own_data(&**shape)? {
                    ShapeData::Cylinder(sizes) => (self.cylinder.as_ref()?, sizes),
                    ShapeData::Cone(sizes) => (self.cone.as_ref()?, sizes),
                    _ => return None,
                };
                // Cylinders and cones have their axis along y.
                let along = |axis, _| if axis == 1 { half_height } else { radius };
                Some((unit, Vector::<N, D>::from_fn(along)))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use impinge::debug_render::{MeshOptions, ShapeMesh};
    use impinge::dim2;
    use impinge::dim3::math::Vector as Vector3;
    use impinge::dim3::shape::{Cone, Cylinder};
    use impinge::shape::Capsule;

    use super::*;
    use crate::space::coordinates;

    fn mesh<N: Recordable<D>, const D: usize>(shape: &ShapeHandle<N, D>) -> ShapeMesh<N, D> {
        ShapeMesh::of(&**shape, &MeshOptions::default())
    }

    /// Asserts that the scaled mesh of the unit shape has the lines and triangles of the shape's
    /// mesh, and its vertices up to 1e-5.
    fn assert_scaled<N: Recordable<D>, const D: usize>(shape: ShapeHandle<N, D>) {
        let units = UnitShapes::<N, D>::new();
        let (unit, scale) = units.scaled(&shape);
        assert!(!unit.is_same(&shape) && scale != UNSCALED, "{shape:?} has a unit shape");
        let [own, unit] = [&shape, unit].map(mesh);
        assert_eq!((&own.lines, &own.triangles), (&unit.lines, &unit.triangles), "{shape:?}");
        for (own, unit) in own.vertices.iter().zip(&unit.vertices) {
            let [own, unit] = [own, unit].map(|vertex| coordinates(&vertex.coords));
            for axis in 0..3 {
                let scaled = unit[axis] * f64::from(scale[axis]);
                assert!((scaled - own[axis]).abs() < 1e-5, "{shape:?}: {scaled} for {}", own[axis]);
            }
        }
        assert_eq!(own.vertices.len(), unit.vertices.len(), "{shape:?}");
    }

    #[test]
    fn meshes_of_five_kinds_are_scaled_ones() {
        let lengths = Vector3::new(0.5_f64, 2.0, 3.0);
        assert_scaled(ShapeHandle::new(Ball::new(0.3_f32)) as ShapeHandle<f32, 3>);
        assert_scaled(ShapeHandle::new(Cuboid::new(lengths)));
        assert_scaled(ShapeHandle::new(Ellipsoid::new(lengths)));
        assert_scaled(ShapeHandle::new(Cylinder::new(0.5_f64, 2.0)));
        assert_scaled(ShapeHandle::new(Cone::new(0.5_f32, 2.0)));
        let lengths = dim2::math::Vector::new(0.5_f32, 2.0);
        assert_scaled(ShapeHandle::new(Ball::new(3.0_f64)) as ShapeHandle<f64, 2>);
        assert_scaled(ShapeHandle::new(Cuboid::new(lengths)));
        assert_scaled(ShapeHandle::new(Ellipsoid::new(lengths)));
    }

    #[test]
    fn flat_boxes_and_other_kinds_keep_their_meshes() {
        let units = UnitShapes::<f64, 3>::new();
        let flat = ShapeHandle::new(Cuboid::new(Vector3::new(1.0, 0.0, 1.0)));
        let capsule = ShapeHandle::new(Capsule::new(1.0, 0.5));
        for shape in [flat, capsule] {
            let (own, scale) = units.scaled(&shape);
            assert!(own.is_same(&shape) && scale == UNSCALED, "{shape:?}");
        }
    }
}
