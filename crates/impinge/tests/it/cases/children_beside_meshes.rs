//! Found by fuzzing: a convex child of a compound must have the same contacts whether or not
//! another child is a mesh.

use impinge::math::{Isometry, Isometry2, Isometry3, Point, Vector};
use impinge::query::contact;
use impinge::shape::{Compound, Cuboid, Segment, Shape, ShapeHandle, TriMesh, Triangle};

/// Bug: the vector from the child to the other solid selected the child's normal, and was even used
/// as the normal without normalisation. The depth was 8.7 instead of 3.
#[test]
fn contacts_of_a_child_beside_a_mesh_in_the_plane() {
    let mesh = TriMesh::new(far_corners::<2>(), vec![[0, 1, 2]]);
    let segment = Segment::new(Point::origin(), Point::<f32, 2>::new(0.0, 7.0));
    let child = (Isometry2::new(Vector::<f32, 2>::new(0.75, 0.0), 3.0), ShapeHandle::new(segment));
    let others = [
        child.clone(),
        (Isometry2::identity(), ShapeHandle::new(Cuboid::new(Vector::<f32, 2>::new(1.0, 2.0)))),
    ];
    let beside = (Isometry2::identity(), ShapeHandle::new(mesh));
    for other in others {
        let (alone, both) =
            (Compound::new(vec![other.clone()]), Compound::new(vec![beside.clone(), other]));
        for x in [-2.0, -0.5, 0.75, 2.5] {
            for y in [-6.5, -1.25, 0.0, 1.5] {
                let solid = Cuboid::new(Vector::<f32, 2>::new(2.0, 1.5));
                let place = Isometry2::new(Vector::<f32, 2>::new(x, y), 0.25);
                same_contact(&alone, &both, &place, &solid);
            }
        }
    }
}

/// Tests a triangle whose centre lies above the centre of a bar, although the shortest translation
/// out of the bar points down.
#[test]
fn contacts_away_from_the_middle_of_the_other() {
    let mesh = TriMesh::new(far_corners::<2>(), vec![[0, 1, 2]]);
    let bar = ShapeHandle::new(Cuboid::new(Vector::<f32, 2>::new(50.0, 10.0)));
    let (child, beside) =
        ((Isometry2::identity(), bar), (Isometry2::identity(), ShapeHandle::new(mesh)));
    let (alone, both) = (Compound::new(vec![child.clone()]), Compound::new(vec![beside, child]));
    let corners = [[30.0, 9.0], [40.0, 9.0], [35.0, -10.0]];
    let [a, b, c] = corners.map(|[x, y]| Point::<f32, 2>::new(x, y));
    same_contact(&alone, &both, &Isometry2::identity(), &Triangle::new(a, b, c));
}

#[test]
fn contacts_of_a_child_beside_a_mesh_in_space() {
    let mesh = TriMesh::new(far_corners::<3>(), vec![[0, 1, 2]]);
    let cuboid = ShapeHandle::new(Cuboid::new(Vector::<f32, 3>::new(1.0, 2.0, 3.0)));
    let child =
        (Isometry3::new(Vector::<f32, 3>::new(0.75, 0.0, 0.0), Vector::<f32, 3>::z()), cuboid);
    let beside = (Isometry3::identity(), ShapeHandle::new(mesh));
    let (alone, both) = (Compound::new(vec![child.clone()]), Compound::new(vec![beside, child]));
    for x in [-2.0, -0.5, 0.75, 2.5] {
        for y in [-4.0, -1.25, 0.0, 1.5] {
            let solid = Cuboid::new(Vector::<f32, 3>::new(2.0, 1.5, 1.0));
            let place = Isometry3::new(Vector::<f32, 3>::new(x, y, 0.5), Vector::<f32, 3>::x());
            same_contact(&alone, &both, &place, &solid);
        }
    }
}

/// Returns the corners of a triangle far away from all other shapes.
fn far_corners<const D: usize>() -> Vec<Point<f32, D>> {
    let corner = |number: usize| {
        Point::from(Vector::<f32, D>::from_fn(|axis, _| if axis == number { 101.0 } else { 100.0 }))
    };
    (0..3).map(|number| if number < D { corner(number) } else { corner(D) }).collect()
}

fn same_contact<R, const D: usize>(
    alone: &dyn Shape<f32, D>,
    both: &dyn Shape<f32, D>,
    place: &Isometry<f32, R, D>,
    solid: &dyn Shape<f32, D>,
) where
    R: impinge::math::AbstractRotation<f32, D>,
    f32: impinge::math::Space<D>,
{
    let here = Isometry::identity();
    let [expected, found] = [alone, both].map(|shape| contact(&here, shape, place, solid, 10.0));
    let (expected, found) = (expected.expect("near"), found.expect("near"));
    assert!((found.normal.norm() - 1.0).abs() < 1e-5, "a unit vector: {found:?}");
    let (depths, lean) = (found.depth - expected.depth, found.normal.dot(&expected.normal));
    assert!(depths.abs() < 1e-4 && lean > 0.999, "{found:?} is not {expected:?}");
}
