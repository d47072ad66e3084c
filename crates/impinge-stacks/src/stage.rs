//! Converts scenes to bodies of the solver and shapes of the library.

use impinge::math::na::{Quaternion, Translation2, Translation3, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Matrix, Point, Real, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, Compound, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, HeightField, Plane,
    Polyline, ShapeHandle, TriMesh,
};
use impinge_scenes::{Placement, SceneShape};

use crate::mass::Weighed;
use crate::{Body, Item, Mass, Solid, Stack, Turn};

/// A scalar and a dimension in which scenes can be simulated.
pub trait Stage<const D: usize>: Turn<D> {
    /// Converts a placement to a pose.
    fn pose_of(placement: &Placement<D>) -> Self::Isometry;
    /// Converts a shape whose type in the library differs between 2D and 3D, or exists in one
    /// dimension only; `None` for all other shapes.
    fn own_shape(shape: &SceneShape<D>) -> Option<ShapeHandle<Self, D>>;
    /// Returns the mass properties of a shape; see [`Weighed`].
    fn mass_of(solid: &Solid<D>) -> Mass<D>;
    /// Returns the inverse of an inertia tensor.
    fn inverse_inertia(inertia: &[[f64; 3]; 3]) -> Self::Inertia;
    /// Returns the inverse inertia of a fixed body, zero.
    fn no_inertia() -> Self::Inertia;
}

impl<N: Real> Stage<2> for N {
    fn pose_of(placement: &Placement<2>) -> Isometry2<N> {
        let [x, y] = placement.translation.map(N::lit);
        let [cosine, sine] = placement.complex().map(N::lit);
        let turn = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(Translation2::new(x, y), turn)
    }

    fn own_shape(shape: &SceneShape<2>) -> Option<ShapeHandle<N, 2>> {
        Some(match shape {
            SceneShape::Convex { points } => {
                ShapeHandle::new(ConvexPolygon::from_points(&points_of(points)))
            }
            SceneShape::Polyline { vertices } => {
                ShapeHandle::new(Polyline::open(points_of(vertices)))
            }
            SceneShape::HeightField { heights, extents, .. } => {
                ShapeHandle::new(HeightField::<N, 2>::new(scalars(heights), vector(extents)))
            }
            _ => return None,
        })
    }

    fn mass_of(solid: &Solid<2>) -> Mass<2> {
        solid.mass()
    }

    fn inverse_inertia(inertia: &[[f64; 3]; 3]) -> N {
        N::lit(1.0 / inertia[2][2])
    }

    fn no_inertia() -> N {
        N::ZERO
    }
}

impl<N: Real> Stage<3> for N {
    fn pose_of(placement: &Placement<3>) -> Isometry3<N> {
        let [x, y, z] = placement.translation.map(N::lit);
        let [i, j, k, w] = placement.quaternion().map(N::lit);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation3::new(x, y, z), turn)
    }

    fn own_shape(shape: &SceneShape<3>) -> Option<ShapeHandle<N, 3>> {
        Some(match shape {
            SceneShape::Convex { points } => {
                ShapeHandle::new(ConvexHull::from_points(&points_of(points)))
            }
            SceneShape::Cylinder { half_height, radius } => {
                ShapeHandle::new(Cylinder::new(N::lit(*half_height), N::lit(*radius)))
            }
            SceneShape::Cone { half_height, radius } => {
                ShapeHandle::new(Cone::new(N::lit(*half_height), N::lit(*radius)))
            }
            SceneShape::TriMesh { vertices, triangles } => {
                ShapeHandle::new(TriMesh::new(points_of(vertices), triangles.clone()))
            }
            SceneShape::HeightField { counts: [rows, columns], heights, extents } => {
                let heights = scalars(heights);
                ShapeHandle::new(HeightField::<N, 3>::new(
                    *rows,
                    *columns,
                    heights,
                    vector(extents),
                ))
            }
            _ => return None,
        })
    }

    fn mass_of(solid: &Solid<3>) -> Mass<3> {
        solid.mass()
    }

    fn inverse_inertia(inertia: &[[f64; 3]; 3]) -> Matrix<N, 3> {
        let tensor: Matrix<f64, 3> = (*inertia).into();
        tensor.try_inverse().expect("a solid has inertia about every axis").map(N::lit)
    }

    fn no_inertia() -> Matrix<N, 3> {
        Matrix::<N, 3>::zeros()
    }
}

/// Returns the shape of an object.
#[must_use]
pub fn shape_of<N: Stage<D>, const D: usize>(solid: &Solid<D>) -> ShapeHandle<N, D> {
    match solid {
        Solid::One(shape) => part_of(shape),
        Solid::Compound(parts) => {
            let parts = parts.iter().map(|(at, shape)| (N::pose_of(at), part_of(shape)));
            ShapeHandle::new(Compound::new(parts.collect()))
        }
    }
}

fn part_of<N: Stage<D>, const D: usize>(shape: &SceneShape<D>) -> ShapeHandle<N, D> {
    if let Some(shape) = N::own_shape(shape) {
        return shape;
    }
    match shape {
        SceneShape::Ball { radius } => ShapeHandle::new(Ball::new(N::lit(*radius))),
        SceneShape::Cuboid { half_extents } => ShapeHandle::new(Cuboid::new(vector(half_extents))),
        SceneShape::Plane { normal } => {
            ShapeHandle::new(Plane::new(Unit::new_unchecked(vector(normal))))
        }
        SceneShape::Capsule { half_height, radius } => {
            ShapeHandle::new(Capsule::new(N::lit(*half_height), N::lit(*radius)))
        }
        other => unreachable!("{other:?} is in no scene of stacks"),
    }
}

/// Returns the bodies of a scene at their initial poses.
#[must_use]
pub fn bodies_of<N: Stage<D>, const D: usize>(stack: &Stack<D>) -> Vec<Body<N, D>> {
    stack.items.iter().map(body_of).collect()
}

fn body_of<N: Stage<D>, const D: usize>(item: &Item<D>) -> Body<N, D> {
    let fixed = Body {
        pose: N::pose_of(&item.placement),
        center: Vector::<N, D>::zeros(),
        velocity: vector(&item.velocity),
        spin: N::Spin::default(),
        inverse_mass: N::ZERO,
        inverse_inertia: N::no_inertia(),
    };
    if item.density == 0.0 {
        return fixed;
    }
    let Mass { mass, center, inertia } = N::mass_of(&item.solid);
    let inertia = inertia.map(|row| row.map(|x| x * item.density));
    Body {
        center: vector(&center),
        inverse_mass: N::lit(1.0 / (mass * item.density)),
        inverse_inertia: N::inverse_inertia(&inertia),
        ..fixed
    }
}

fn vector<N: Real, const D: usize>(coordinates: &[f64; D]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(coordinates[axis]))
}

fn points_of<N: Real, const D: usize>(points: &[[f64; D]]) -> Vec<Point<N, D>> {
    points.iter().map(|point| Point::from(vector(point))).collect()
}

fn scalars<N: Real>(numbers: &[f64]) -> Vec<N> {
    numbers.iter().map(|x| N::lit(*x)).collect()
}
