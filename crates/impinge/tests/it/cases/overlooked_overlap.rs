//! Found by fuzzing: a solid overlapped a surface without a contact.

use impinge::dim3::math::{Isometry, Vector};
use impinge::dim3::shape::{HeightField, Shape, Tetrahedron, TriMesh};
use impinge::dim3::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
use impinge::query::{Proximity, contact, distance, proximity};
use impinge::shape::{Diagonals, ShapeHandle};

const QUARTER: f32 = std::f32::consts::FRAC_PI_2;

fn tetrahedron() -> Tetrahedron<f32> {
    let corners =
        [[-19.006836, -6.0625, -6.0], [0.0; 3], [1.7216797, -22.25, 0.375], [4.5, 0.0, 0.0]];
    Tetrahedron::new(corners.map(Into::into))
}

/// Returns a field with a steep sliver, which the tetrahedron pierces.
fn field() -> HeightField<f32> {
    let mut heights = vec![0.0; 8];
    (heights[0], heights[4]) = (-26.777527, 440.34155);
    let field = HeightField::new(2, 4, heights, Vector::new(5.0, 1.0, 5.8447266));
    field.with_diagonals(Diagonals::Backward)
}

fn sliver() -> TriMesh<f32> {
    let [sliver, _] = field().triangles(0, 0);
    let corners = *sliver.expect("no hole").corners();
    TriMesh::new(corners.to_vec(), vec![[0, 1, 2]])
}

fn places() -> [Isometry<f32>; 2] {
    let turn = Vector::z() * QUARTER;
    [
        Isometry::new(Vector::new(-1.5625, -5.0625, 0.3125), turn),
        Isometry::new(Vector::zeros(), turn),
    ]
}

/// Bug: along the normal of the tetrahedron's face, the part of the sliver's plane below the face
/// lies beside the overlap. The test of that face therefore reported a gap, and there was no
/// contact.
#[test]
fn what_overlaps_a_sliver_touches_it() {
    let ([place, origin], solid) = (places(), tetrahedron());
    let shapes: [Box<dyn Shape<f32, 3>>; 2] = [Box::new(field()), Box::new(sliver())];
    for shape in shapes {
        assert_eq!(distance(&place, &*shape, &origin, &solid), 0.0, "they overlap");
        let near = proximity(&place, &*shape, &origin, &solid, 0.0);
        assert_eq!(near, Proximity::Intersecting, "the same");
        for prediction in [0.0, 100.0] {
            let found = contact(&place, &*shape, &origin, &solid, prediction);
            let found = found.expect("overlapping shapes have a contact");
            // The depth of the tetrahedron in the sliver without the other triangles of the field.
            assert!((found.depth - 0.6468).abs() < 1e-3, "{found:?} within {prediction}");
        }
    }
}

#[test]
fn what_overlaps_a_sliver_touches_it_in_a_world() {
    let mut world = CollisionWorld::new(0.02_f32);
    let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    let shapes = [ShapeHandle::new(field()), ShapeHandle::new(tetrahedron())];
    for (place, shape) in places().into_iter().zip(shapes) {
        world.add(place, shape, CollisionGroups::new(), contacts, ());
    }
    world.update();
    assert_eq!(world.contact_events().len(), 1, "they overlap");
}
