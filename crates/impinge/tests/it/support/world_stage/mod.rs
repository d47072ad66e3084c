//! Shared by the tests of worlds: positions and shapes for any scalar and dimension.

#![allow(dead_code, reason = "each test uses a part")]

use impinge::math::{Isometry2, Isometry3, Real, Space, Unit, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, GeometricQueryType};
use impinge::shape::{Ball, Cuboid, Plane, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld};

/// A scalar and dimension in which tests can place objects.
pub(crate) trait Stage<const D: usize>: Space<D> {
    /// Returns the pose without rotation at these coordinates.
    fn at(coordinates: [f64; D]) -> Self::Isometry;

    /// Returns the pose without rotation at `x` on the first axis.
    fn on_x(x: f64) -> Self::Isometry {
        let mut coordinates = [0.0; D];
        coordinates[0] = x;
        Self::at(coordinates)
    }
}

impl<N: Real> Stage<2> for N {
    fn at([x, y]: [f64; 2]) -> Isometry2<N> {
        Isometry2::translation(N::lit(x), N::lit(y))
    }
}

impl<N: Real> Stage<3> for N {
    fn at([x, y, z]: [f64; 3]) -> Isometry3<N> {
        Isometry3::translation(N::lit(x), N::lit(y), N::lit(z))
    }
}

pub(crate) fn vector<N: Real, const D: usize>(coordinates: [f64; D]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(coordinates[axis]))
}

pub(crate) fn ball<N: Real, const D: usize>(radius: f64) -> ShapeHandle<N, D> {
    ShapeHandle::new(Ball::new(N::lit(radius)))
}

pub(crate) fn cube<N: Real, const D: usize>(half: f64) -> ShapeHandle<N, D> {
    ShapeHandle::new(Cuboid::new(vector([half; D])))
}

/// Returns the half-space whose surface goes through the origin, with its normal along an axis
/// times `sign`.
pub(crate) fn half_space<N: Real, const D: usize>(axis: usize, sign: f64) -> ShapeHandle<N, D> {
    let mut normal = [0.0; D];
    normal[axis] = sign;
    ShapeHandle::new(Plane::new(Unit::new_normalize(vector(normal))))
}

pub(crate) fn contacts<N: Real>(prediction: f64) -> GeometricQueryType<N> {
    GeometricQueryType::Contacts(N::lit(prediction), N::ZERO)
}

pub(crate) fn near<N: Real>(margin: f64) -> GeometricQueryType<N> {
    GeometricQueryType::Proximity(N::lit(margin))
}

/// Adds an object at `x` on the first axis, which may interact with every object.
pub(crate) fn add<N: Stage<D>, const D: usize>(
    world: &mut CollisionWorld<N, D, ()>,
    x: f64,
    shape: &ShapeHandle<N, D>,
    query: GeometricQueryType<N>,
) -> CollisionObjectHandle {
    world.add(N::on_x(x), shape.clone(), CollisionGroups::new(), query, ())
}

/// Updates the world, validates it, and returns the contact events. Asserts that each started pair
/// has a contact.
pub(crate) fn step<N: Space<D>, const D: usize, T>(
    world: &mut CollisionWorld<N, D, T>,
) -> Vec<ContactEvent> {
    world.update();
    world.validate().expect("the world's parts agree");
    for event in world.contact_events() {
        if let ContactEvent::Started(handle1, handle2) = *event {
            let pair = world.contact_pair(handle1, handle2).expect("the pair has started");
            assert!(pair.num_contacts() > 0, "and holds a contact");
        }
    }
    world.contact_events().to_vec()
}

/// Defines for each check a test that runs it with both scalars and in both dimensions.
#[allow(unused_macros, reason = "each test uses a part")]
macro_rules! in_tests {
    ($($check:ident),* $(,)?) => {
        mod both_scalars_and_dimensions {
            $(
                #[test]
                fn $check() {
                    super::$check::<f32, 2>();
                    super::$check::<f64, 2>();
                    super::$check::<f32, 3>();
                    super::$check::<f64, 3>();
                }
            )*
        }
    };
}
