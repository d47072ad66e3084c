//! Found by fuzzing: the box of a placed shape must be the unbounded box if its coordinates
//! overflow.

use impinge::bounding_volume::Aabb;
use impinge::dim3::math::{Isometry, Point, Vector};
use impinge::dim3::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, IdAllocator,
    PairManifoldGenerator,
};
use impinge::dim3::shape::{
    Capsule, Cone, HeightField, Plane, Segment, Shape, TaperedCapsule, TriMesh, Triangle,
};
use impinge::math::{Pose, Unit};

fn corners() -> [Point<f32>; 3] {
    [Point::new(3e38, -3e38, 0.0), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 0.0, 1.0)]
}

fn shapes() -> Vec<Box<dyn Shape<f32, 3>>> {
    let [a, b, c] = corners();
    vec![
        Box::new(Segment::new(a, b)),
        Box::new(Capsule::try_from_ends(a, b, 1.0).expect("finite")),
        Box::new(TaperedCapsule::try_from_ends(a, b, [1.0, 2.0]).expect("finite")),
        Box::new(Triangle::new(a, b, c)),
        Box::new(Cone::new(1.0, 1.0)),
        Box::new(Plane::new(Unit::new_unchecked(Vector::x()))),
    ]
}

/// Bug: a NaN coordinate in the box of a placed shape caused a panic.
#[test]
fn boxes_at_no_place_are_those_of_everything() {
    let nowhere = Pose::from_isometry(&Isometry::translation(f32::NAN, 0.0, 0.0));
    for shape in shapes() {
        assert_eq!(shape.aabb(&nowhere), Aabb::unbounded(), "{shape:?}");
    }
}

/// Asserts that no box is inverted or NaN at a position near the limit of `f32`. With this
/// rotation, sums such as 3e38 - 3e38 - 3e38 overflow before they reach a representable number.
#[test]
fn boxes_of_corners_at_the_end_of_all_numbers_are_boxes() {
    let far = Isometry::new(Vector::new(3e38, 3e38, 3e38), Vector::new(0.0, 1.0, 2.0));
    for shape in shapes() {
        let aabb = shape.aabb(&Pose::from_isometry(&far));
        assert!((0..3).all(|axis| aabb.mins()[axis] <= aabb.maxs()[axis]), "{aabb:?} {shape:?}");
    }
}

/// Asserts that two composites have no contacts, and no panic occurs, at poses that are not finite
/// or overflow. The search for pairs of parts needs the boxes of parts at such poses, too.
#[test]
fn manifolds_of_composites_at_poses_beyond_all_numbers() {
    let mesh = TriMesh::new(corners().to_vec(), vec![[0, 1, 2]]);
    let field = HeightField::new(2, 2, vec![0.0, 1.0, 2.0, 3e38], Vector::new(1.0, 1.0, 1.0));
    let (dispatcher, prediction) =
        (DefaultContactDispatcher::new(), ContactPrediction::new(1.0, 0.0, 0.0));
    for place in [[f32::NAN, 0.0, 0.0], [3e38, 3e38, 3e38], [f32::INFINITY, 0.0, 0.0]] {
        let turn = Vector::new(1.0, 2.0, 3.0);
        let place = Isometry::new(Vector::from(place), turn);
        let mut generator = PairManifoldGenerator::default();
        let ids = &mut IdAllocator::new();
        let origin = Isometry::identity();
        generator.update(&dispatcher, &origin, &mesh, &place, &field, &prediction, ids);
        assert_eq!(generator.num_contacts(), 0, "nothing is near {place:?}");
    }
}
