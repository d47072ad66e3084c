//! Converts the collision elements of links to shapes.

use impinge::math::na::{Isometry3, UnitQuaternion, Vector3};
use impinge::shape::ShapeError;
use urdf_rs::{Collision, Geometry, Link, Pose};

use super::LinkSolid;
use super::packages::Packages;
use crate::Problem;
use crate::format::{
    ChildFile, MeshKind, MeshSource, PoseFile, RotationFile, ScaleFile, ShapeFile, ShapeRef,
};
use crate::scene::about;

/// Returns the collision elements of a link as one shape; `None` if the link has none.
///
/// A single element becomes a shape around its own origin, at the origin of the element in the
/// frame of the link, so that a box stays a cuboid. Several elements become a compound in the frame
/// of the link.
pub(super) fn solid(
    link: &Link,
    kind: MeshKind,
    packages: &Packages,
) -> Result<Option<LinkSolid>, Problem> {
    let solids = link.collision.iter().map(|element| element_solid(element, kind, packages));
    let mut solids: Vec<LinkSolid> = solids.collect::<Result<_, _>>()?;
    if solids.len() < 2 {
        return Ok(solids.pop());
    }
    let children = solids.into_iter().map(|LinkSolid { shape, frame }| ChildFile {
        shape: ShapeRef::Inline(Box::new(shape)),
        position: pose_file(&frame),
    });
    let shape = ShapeFile::Compound { children: children.collect() };
    Ok(Some(LinkSolid { shape, frame: Isometry3::identity() }))
}

/// Converts a collision element to a shape. URDF gives full lengths, whereas the shapes of the
/// library have half lengths.
fn element_solid(
    element: &Collision,
    kind: MeshKind,
    packages: &Packages,
) -> Result<LinkSolid, Problem> {
    let origin = isometry(&element.origin)?;
    // The axis of cylinders and capsules is z in URDF, and y in the library.
    let upright = origin * about(Vector3::x(), core::f64::consts::FRAC_PI_2);
    Ok(match &element.geometry {
        Geometry::Box { size } => {
            let half_extents = size.iter().map(|size| half("a half extent", *size));
            let half_extents = half_extents.collect::<Result<_, _>>()?;
            LinkSolid { shape: ShapeFile::Cuboid { half_extents }, frame: origin }
        }
        Geometry::Sphere { radius } => {
            let radius = checked("the radius", *radius)?;
            LinkSolid { shape: ShapeFile::Ball { radius }, frame: origin }
        }
        Geometry::Cylinder { radius, length } => {
            let radius = checked("the radius", *radius)?;
            let half_height = half("the half height", *length)?;
            LinkSolid { shape: ShapeFile::Cylinder { half_height, radius }, frame: upright }
        }
        Geometry::Capsule { radius, length } => {
            let radius = checked("the radius", *radius)?;
            let half_height = Some(half("the half height", *length)?);
            let shape = ShapeFile::Capsule { radius, half_height, ends: None };
            LinkSolid { shape, frame: upright }
        }
        Geometry::Mesh { filename, scale } => {
            let path = packages.find(filename)?;
            let scale = scale.map_or_else(ScaleFile::default, |scale| ScaleFile::Axes(scale.0));
            let source = MeshSource { path, part: None, scale, kind };
            LinkSolid { shape: ShapeFile::MeshFile(source), frame: origin }
        }
    })
}

/// Returns a size; an error if it is negative or not finite. Sizes are checked here and not when
/// the shape is built, since the line of the link is known here.
fn checked(what: &'static str, value: f64) -> Result<f64, Problem> {
    if !value.is_finite() {
        return Err(ShapeError::NotFinite { what, value }.into());
    }
    if value < 0.0 {
        return Err(ShapeError::Negative { what, value }.into());
    }
    Ok(value)
}

/// Returns half of a size; an error if it is negative or not finite.
fn half(what: &'static str, size: f64) -> Result<f64, Problem> {
    checked(what, 0.5 * size)
}

/// Converts an origin of URDF to an isometry. Roll, pitch and yaw are rotations about the fixed
/// axes x, y and z, in this order.
pub(super) fn isometry(origin: &Pose) -> Result<Isometry3<f64>, Problem> {
    let numbers = origin.xyz.iter().chain(origin.rpy.iter());
    if let Some(value) = numbers.copied().find(|number| !number.is_finite()) {
        return Err(Problem::BadValue { what: "the numbers of an origin must be finite", value });
    }
    let turn = |axis: usize| about(Vector3::ith(axis, 1.0), origin.rpy[axis]);
    let rotation: UnitQuaternion<f64> = turn(2) * turn(1) * turn(0);
    Ok(Isometry3::from_parts(Vector3::from(origin.xyz.0).into(), rotation))
}

/// Converts an isometry to a position of a scene file. The quaternion has length 1 up to rounding,
/// and is normalized again when it is read.
fn pose_file(frame: &Isometry3<f64>) -> PoseFile {
    let turn = frame.rotation.coords;
    PoseFile {
        translation: Some(frame.translation.vector.as_slice().to_vec()),
        rotation: Some(RotationFile::Quaternion([turn.x, turn.y, turn.z, turn.w])),
    }
}
