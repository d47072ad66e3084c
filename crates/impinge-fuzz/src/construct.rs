//! Constructors of shapes, and queries about single shapes without arguments.

use impinge::bounding_volume::{Aabb, BoundingSphere, Ray};
use impinge::math::{Point, Pose, Real, Space};
use impinge::partitioning::BoxTree;
use impinge::shape::{Compound, Polyline, Shape, ShapeHandle, ShapeKind, TriMesh};

use crate::place::Dimension;
use crate::shapes::{made, shape};
use crate::{Bytes, Task, dispatch};

struct Construct;

impl Task for Construct {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let shape = shape::<N, M, D>(bytes);
        check(&*shape);
        shape.aabb(&Pose::from_isometry(&M::position(bytes)));
        if let Ok(scaled) = shape.scaled(&bytes.vector()) {
            let kinds = [&shape, &scaled].map(|shape| shape.geometry().kind());
            let is_known = !bytes.is_moderate()
                || kinds[0] == kinds[1]
                || kinds == [ShapeKind::Ball, ShapeKind::Ellipsoid]
                || M::is_tetrahedron(&shape)
                || shape.as_shape::<Compound<N, D>>().is_some();
            assert!(is_known, "{kinds:?} {scaled:?}");
            check(&*scaled);
        }
        if let Some(deformed) = deformed::<N, M, D>(&shape, bytes) {
            check(&*deformed);
        }
        M::transform(&shape, bytes);
        boxes::<N, D>(bytes);
    }
}

/// Constructs a shape, scales and deforms it, and computes its boxes and parts. Also computes the
/// hull of random points and, for some kinds of shapes, the surface, and compares trees of boxes
/// with loops over the boxes.
pub fn construct(data: &[u8]) {
    dispatch(Construct, data);
}

fn check<N: Real, const D: usize>(shape: &dyn Shape<N, D>) {
    let local = shape.local_aabb();
    let parts = shape.geometry().as_composite();
    let is_empty = parts.is_some_and(|parts| parts.num_parts() == 0);
    let is_ordered = (0..D).all(|axis| local.mins()[axis] <= local.maxs()[axis]);
    assert!(is_ordered || is_empty, "{local:?} of {shape:?}");
    assert!(shape.local_bounding_sphere().radius() >= N::ZERO, "{shape:?}");
    let Some(parts) = parts else { return };
    for part in 0..parts.num_parts() {
        let found = parts.part(part);
        assert!(found.pose.is_finite(), "{found:?}");
        assert!(found.solid.geometry().as_composite().is_none(), "{found:?}");
        let _ = shape.path_to_part(part);
    }
}

/// Returns the shape with some vertices, heights, holes or diagonals changed; a mesh is also
/// flipped, or its equal vertices are merged. `None` for kinds without vertices and heights, and if
/// the library rejects the values.
pub(crate) fn deformed<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    bytes: &mut Bytes<'_>,
) -> Option<ShapeHandle<N, D>> {
    if let Some(mesh) = shape.as_shape::<TriMesh<N, D>>() {
        let (mut mesh, vertices) = (mesh.clone(), moved(mesh.vertices(), bytes));
        let refused = mesh.try_set_vertices(&vertices).err();
        assert!(refused.is_none() || !bytes.is_moderate(), "{refused:?}");
        let mesh = if bytes.coin() { mesh.with_vertices_merged() } else { mesh.flipped() };
        return Some(ShapeHandle::new(mesh));
    }
    if let Some(line) = shape.as_shape::<Polyline<N, D>>() {
        let (mut line, vertices) = (line.clone(), moved(line.vertices(), bytes));
        return made(line.try_set_vertices(&vertices).map(|()| line));
    }
    M::dig(shape, bytes)
}

/// Returns the vertices, each possibly changed.
pub(crate) fn moved<N: Real, const D: usize>(
    vertices: &[Point<N, D>],
    bytes: &mut Bytes<'_>,
) -> Vec<Point<N, D>> {
    let other = |vertex: &Point<N, D>| if bytes.coin() { bytes.point() } else { *vertex };
    vertices.iter().map(other).collect()
}

/// Returns a box with a random lower corner and random edge lengths; `None` if the constructor
/// rejects the corners.
pub(crate) fn any_box<N: Real, const D: usize>(bytes: &mut Bytes<'_>) -> Option<Aabb<N, D>> {
    let low = bytes.point::<N, D>();
    Aabb::try_new(low, low + bytes.sizes::<N, D>()).ok()
}

/// Compares a tree of random boxes with a loop over all boxes, and constructs a bounding sphere.
fn boxes<N: Space<D>, const D: usize>(bytes: &mut Bytes<'_>) {
    let count = bytes.choice(20);
    let boxes: Vec<Aabb<N, D>> = (0..count).filter_map(|_| any_box(bytes)).collect();
    let Ok(mut tree) = BoxTree::try_from_boxes(&boxes) else { return };
    assert_eq!(tree.validate(), Ok(()));
    let shifted: Vec<Aabb<N, D>> = boxes
        .iter()
        .map(|own| if bytes.coin() { any_box(bytes).unwrap_or(*own) } else { *own })
        .collect();
    if tree.try_refit(&shifted).is_err() {
        return;
    }
    assert_eq!(tree.validate(), Ok(()));
    let ray = Ray::new(Point::from(bytes.vector::<N, D>()), bytes.vector());
    let hit: Vec<usize> =
        (0..shifted.len()).filter(|&index| shifted[index].ray_interval(&ray).is_some()).collect();
    let is_ray = ray.origin.iter().chain(ray.dir.iter()).all(|x| x.is_finite_number());
    let hit = if is_ray { hit } else { Vec::new() };
    assert_eq!(tree.hit_by(&ray), hit, "{ray:?} {shifted:?}");
    let point = Point::from(bytes.vector::<N, D>());
    let _ = tree.containing(&point);
    if !point.iter().all(|x| x.is_finite_number()) {
        return;
    }
    let nearest = tree.nearest(&point, N::INFINITY).map(|(_, distance)| distance);
    let distances = shifted.iter().map(|own| own.distance_to_point(&point));
    let least = distances.filter(|distance| *distance <= N::INFINITY).reduce(impinge::math::min);
    assert_eq!(nearest, least, "{point:?} {shifted:?}");
    let _ = BoundingSphere::try_new(point, bytes.number());
}
