//! Code that differs by dimension: rotations, and the shapes that exist in one dimension only.

use std::fmt::Debug;

use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Point, Real, Space, Vector};
use impinge::query::RigidMotion;
use impinge::shape::{Diagonals, ShapeHandle};
use impinge::world::{CollisionObject, CollisionWorld};
use impinge::{dim2, dim3};

use crate::Bytes;
use crate::shapes::made;

/// The code for one dimension.
pub(crate) trait Dimension<N: Space<D>, const D: usize> {
    /// The number of kinds of shapes that exist in this dimension only.
    const OWN_KINDS: usize;

    /// The type of rotations.
    type Turn: AbstractRotation<N, D> + Copy + Debug;

    /// Returns a position; if numbers may be wild, its coordinates may be infinite or NaN.
    fn position(bytes: &mut Bytes<'_>) -> Isometry<N, Self::Turn, D>;
    /// Converts a position to the type that worlds use.
    fn stored(position: Isometry<N, Self::Turn, D>) -> N::Isometry;
    /// Converts a position from the type that worlds use.
    fn loose(position: N::Isometry) -> Isometry<N, Self::Turn, D>;
    /// Returns a shape that exists in this dimension only; `None` if a constructor rejects the
    /// numbers.
    fn own_shape(kind: usize, bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, D>>;
    /// Returns whether the shape is a tetrahedron, whose kind changes if scaling makes it flat.
    fn is_tetrahedron(shape: &ShapeHandle<N, D>) -> bool;
    /// Returns a motion from `position` at a constant velocity and angular velocity.
    fn motion(
        position: Isometry<N, Self::Turn, D>,
        bytes: &mut Bytes<'_>,
    ) -> Box<dyn RigidMotion<N, D>>;
    /// Returns a copy of a height field with another height, hole or (in 3D) diagonal, or with all
    /// heights replaced. `None` for other shapes, and if the library rejects a height.
    fn dig(shape: &ShapeHandle<N, D>, bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, D>>;
    /// Registers a filter that accepts a pair only if [`may_meet`] returns `true`.
    fn filter(world: &mut CollisionWorld<N, D, u8>);
    /// Computes the convex hull of random points and, for some kinds of shapes, the outline (in 2D)
    /// or the surface of `shape`. Checks that the hull has enough vertices, and that no coordinate
    /// of the outline or surface is NaN.
    fn transform(shape: &ShapeHandle<N, D>, bytes: &mut Bytes<'_>);
}

/// Returns whether objects with these data may have a pair: only if the lowest bits of the data are
/// equal.
pub(crate) const fn may_meet(one: u8, two: u8) -> bool {
    (one ^ two) & 1 == 0
}

/// The code for 2D.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane;

impl<N: Real> Dimension<N, 2> for Plane {
    const OWN_KINDS: usize = 2;

    type Turn = UnitComplex<N>;

    fn position(bytes: &mut Bytes<'_>) -> dim2::math::Isometry<N> {
        let turn = match bytes.choice(3) {
            0 => N::ZERO,
            1 => N::frac_pi_2(),
            _ => bytes.number(),
        };
        dim2::math::Isometry::new(bytes.vector(), turn)
    }

    fn stored(position: dim2::math::Isometry<N>) -> dim2::math::Isometry<N> {
        position
    }

    fn loose(position: dim2::math::Isometry<N>) -> dim2::math::Isometry<N> {
        position
    }

    fn own_shape(kind: usize, bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, 2>> {
        if kind == 0 {
            let points = bytes.points();
            return if bytes.coin() {
                made(dim2::shape::ConvexPolygon::try_new(&points))
            } else {
                made(dim2::shape::ConvexPolygon::try_from_points(&points))
            };
        }
        let count = bytes.choice(9);
        let heights = (0..count).map(|_| bytes.number()).collect();
        let holes = bytes.byte();
        let field = dim2::shape::HeightField::try_new(heights, bytes.sizes());
        made(field.map(|field| field.with_holes(|cell| holes >> (cell % 8) & 1 == 1)))
    }

    fn is_tetrahedron(_: &ShapeHandle<N, 2>) -> bool {
        false
    }

    fn motion(
        position: dim2::math::Isometry<N>,
        bytes: &mut Bytes<'_>,
    ) -> Box<dyn RigidMotion<N, 2>> {
        let (linear, angular) = (bytes.vector(), bytes.number());
        let motion = dim2::query::ConstantVelocities::new(position, linear, angular);
        let center = bytes.coin().then(|| bytes.point());
        Box::new(center.map_or(motion, |center| motion.with_local_center(center)))
    }

    fn dig(shape: &ShapeHandle<N, 2>, bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, 2>> {
        let mut field = shape.as_shape::<dim2::shape::HeightField<N>>()?.clone();
        let index = bytes.choice(field.heights().len());
        match bytes.choice(3) {
            0 => field.set_height(index, bytes.number()).ok()?,
            1 => field.set_hole(index.min(field.num_cells() - 1), bytes.coin()),
            _ => {
                let heights = field.heights().iter().map(|_| bytes.number()).collect();
                field.set_heights(heights).ok()?;
            }
        }
        assert!(field.height_at(bytes.number()).is_none_or(|y| !y.as_f64().is_nan()), "{field:?}");
        Some(ShapeHandle::new(field))
    }

    fn filter(world: &mut CollisionWorld<N, 2, u8>) {
        let both = |one: &CollisionObject<N, 2, u8>, two: &CollisionObject<N, 2, u8>| {
            may_meet(*one.data(), *two.data())
        };
        world.register_broad_phase_pair_filter("data", both);
    }

    fn transform(shape: &ShapeHandle<N, 2>, bytes: &mut Bytes<'_>) {
        use dim2::procedural;
        let (points, subdivisions) = (bytes.points::<N, 2>(), u32::from(bytes.byte()));
        if let Ok(ring) = dim2::transformation::convex_hull(&points) {
            assert!(ring.len() >= 3 && ring.iter().all(|&index| index < points.len()), "{ring:?}");
        }
        if let Some(ball) = shape.as_shape() {
            check_finite(&procedural::ball(ball, subdivisions).points);
        } else if let Some(capsule) = shape.as_shape() {
            check_finite(&procedural::capsule(capsule, subdivisions).points);
        } else if let Some(ellipse) = shape.as_shape() {
            check_finite(&procedural::ellipse(ellipse, subdivisions).points);
        } else if let Some(capsule) = shape.as_shape() {
            check_finite(&procedural::tapered_capsule(capsule, subdivisions).points);
        } else if let Some(triangle) = shape.as_shape() {
            check_finite(&procedural::triangle(triangle).points);
        }
    }
}

/// The code for 3D.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room;

impl<N: Real> Dimension<N, 3> for Room {
    const OWN_KINDS: usize = 5;

    type Turn = UnitQuaternion<N>;

    fn position(bytes: &mut Bytes<'_>) -> dim3::math::Isometry<N> {
        let turn = match bytes.choice(4) {
            0 => Vector::<N, 3>::zeros(),
            1 => Vector::<N, 3>::y() * N::frac_pi_2(),
            2 => Vector::<N, 3>::z() * N::frac_pi_2(),
            _ => bytes.vector::<N, 3>(),
        };
        dim3::math::Isometry::new(bytes.vector(), turn)
    }

    fn stored(position: dim3::math::Isometry<N>) -> dim3::math::Isometry<N> {
        position
    }

    fn loose(position: dim3::math::Isometry<N>) -> dim3::math::Isometry<N> {
        position
    }

    fn own_shape(kind: usize, bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, 3>> {
        match kind {
            0 => made(dim3::shape::ConvexHull::try_from_points(&bytes.points())),
            1 => made(dim3::shape::Cylinder::try_new(bytes.size(), bytes.size())),
            2 => made(dim3::shape::Cone::try_new(bytes.size(), bytes.size())),
            3 => made(dim3::shape::Tetrahedron::try_new(std::array::from_fn(|_| bytes.point()))),
            _ => field3(bytes),
        }
    }

    fn is_tetrahedron(shape: &ShapeHandle<N, 3>) -> bool {
        shape.as_shape::<dim3::shape::Tetrahedron<N>>().is_some()
    }

    fn motion(
        position: dim3::math::Isometry<N>,
        bytes: &mut Bytes<'_>,
    ) -> Box<dyn RigidMotion<N, 3>> {
        let (linear, angular) = (bytes.vector(), bytes.vector());
        let motion = dim3::query::ConstantVelocities::new(position, linear, angular);
        let center = bytes.coin().then(|| bytes.point());
        Box::new(center.map_or(motion, |center| motion.with_local_center(center)))
    }

    fn dig(shape: &ShapeHandle<N, 3>, bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, 3>> {
        let mut field = shape.as_shape::<dim3::shape::HeightField<N>>()?.clone();
        let part = bytes.choice(2 * field.num_cells()) as u32;
        match bytes.choice(4) {
            0 => field.set_height(0, 1, bytes.number()).ok()?,
            1 => field.set_part_hole(part, bytes.coin()),
            2 => field.set_diagonal(0, 0, dim3::shape::Diagonal::Backward),
            _ => {
                let heights = field.heights().iter().map(|_| bytes.number()).collect();
                field.set_heights(heights).ok()?;
            }
        }
        let height = field.height_at(bytes.number(), bytes.number());
        assert!(height.is_none_or(|y| !y.as_f64().is_nan()), "{field:?}");
        Some(ShapeHandle::new(field))
    }

    fn filter(world: &mut CollisionWorld<N, 3, u8>) {
        let both = |one: &CollisionObject<N, 3, u8>, two: &CollisionObject<N, 3, u8>| {
            may_meet(*one.data(), *two.data())
        };
        world.register_broad_phase_pair_filter("data", both);
    }

    fn transform(shape: &ShapeHandle<N, 3>, bytes: &mut Bytes<'_>) {
        use dim3::procedural;
        let (points, subdivisions) = (bytes.points::<N, 3>(), u32::from(bytes.byte() % 64));
        if let Ok(hull) = dim3::transformation::convex_hull(&points) {
            assert!(hull.vertices.len() >= 4 && hull.faces.len() >= 4, "{hull:?}");
        }
        if let Some(ball) = shape.as_shape() {
            check_finite(&procedural::ball(ball, subdivisions).vertices);
        } else if let Some(capsule) = shape.as_shape() {
            check_finite(&procedural::capsule(capsule, subdivisions).vertices);
        } else if let Some(cylinder) = shape.as_shape() {
            check_finite(&procedural::cylinder(cylinder, subdivisions).vertices);
        } else if let Some(cone) = shape.as_shape() {
            check_finite(&procedural::cone(cone, subdivisions).vertices);
        } else if let Some(hull) = shape.as_shape() {
            check_finite(&procedural::convex_hull(hull).vertices);
        } else if let Some(triangle) = shape.as_shape() {
            check_finite(&procedural::triangle(triangle).vertices);
        }
    }
}

fn field3<N: Real>(bytes: &mut Bytes<'_>) -> Option<ShapeHandle<N, 3>> {
    let (rows, columns) = (bytes.choice(5), bytes.choice(5));
    let heights = (0..rows * columns).map(|_| bytes.number()).collect();
    let (holes, diagonals) = (bytes.byte(), bytes.choice(3));
    let field = dim3::shape::HeightField::try_new(rows, columns, heights, bytes.sizes()).ok()?;
    let field = field.with_holes(|row, column| holes >> ((row * 3 + column) % 8) & 1 == 1);
    let diagonals = [Diagonals::Forward, Diagonals::Backward, Diagonals::Zigzag][diagonals];
    Some(ShapeHandle::new(field.with_diagonals(diagonals)))
}

/// Checks that no coordinate of the points is NaN.
fn check_finite<N: Real, const D: usize>(points: &[Point<N, D>]) {
    let mut numbers = points.iter().flat_map(|point| point.iter());
    assert!(numbers.all(|x| !x.as_f64().is_nan()), "{points:?}");
}
