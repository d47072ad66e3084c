//! Tests of the features of boxes, triangles, segments, capsules, cylinders and cones.

use crate::math::{Point, Real, Vector, cross, max, perp, unit};
use crate::shape::{
    Capsule, Cone, ConvexPolyhedron, Cuboid, Cylinder, Feature, FeatureId, Segment, SupportMap,
    Triangle,
};

/// A generator of pseudo-random numbers in [-1, 1) (Marsaglia, "Xorshift RNGs", 2003).
pub(super) struct Numbers(u64);

impl Numbers {
    pub(super) fn new() -> Self {
        Self(0x2545_f491_4f6c_dd1d)
    }

    pub(super) fn next<N: Real>(&mut self) -> N {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        let bits = u32::try_from(self.0 >> 40).expect("24 bits");
        N::lit(f64::from(bits) / f64::from(1_u32 << 23) - 1.0)
    }

    pub(super) fn vector<N: Real, const D: usize>(&mut self) -> Vector<N, D> {
        Vector::<N, D>::from_fn(|_, _| self.next())
    }

    pub(super) fn direction<N: Real, const D: usize>(&mut self) -> Vector<N, D> {
        loop {
            let v = self.vector();
            if let Some((direction, length)) = unit(&v)
                && length < N::ONE
            {
                return direction;
            }
        }
    }
}

fn tolerance<N: Real, const D: usize, S: SupportMap<N, D> + ?Sized>(solid: &S) -> N {
    N::lit(16.0) * N::EPSILON * max(solid.reach(), N::MIN_POSITIVE)
}

/// Returns the core feature for `direction`. Checks that its lists have matching lengths, and that
/// its farthest vertex is as far along `direction` as the support point, within the tolerance.
fn faces<N: Real, const D: usize>(
    solid: &dyn SupportMap<N, D>,
    direction: &Vector<N, D>,
) -> Feature<N, D> {
    let mut feature = Feature::default();
    solid.core_feature(direction, &mut feature);
    let count = feature.vertices.len();
    assert_eq!(feature.vertex_ids.len(), count, "an id for each: {feature:?}");
    assert_eq!(
        feature.side_ids.len(),
        [0, 0, 1][..].get(count).copied().unwrap_or(count),
        "{feature:?}"
    );
    let support = solid.core_support(direction);
    let top = feature.vertices.iter().fold(-N::MAX, |top, v| max(top, v.coords.dot(direction)));
    assert!(
        (support.coords.dot(direction) - top).abs() <= tolerance(solid),
        "along {direction} the solid reaches {support}, but the feature is {feature:?}"
    );
    feature
}

/// Checks that the supporting feature contains each vertex on the supporting plane.
fn holds_what_touches<N: Real, const D: usize>(
    vertices: &[Point<N, D>],
    solid: &dyn SupportMap<N, D>,
    direction: &Vector<N, D>,
) {
    let feature = faces(solid, direction);
    let top = solid.core_support(direction).coords.dot(direction);
    for vertex in vertices {
        let touches = top - vertex.coords.dot(direction) <= tolerance(solid);
        assert!(!touches || feature.vertices.contains(vertex), "{vertex} touches: {feature:?}");
    }
}

/// Checks that the normal of the face is unit and equals the normal for its id, that its vertices
/// run counter-clockwise about it, that the ids give the same vertices and sides, and that the
/// solid lies behind the face. Returns false for a face without a normal.
fn face3<N: Real>(solid: &dyn ConvexPolyhedron<N, 3>, id: FeatureId) -> bool {
    let mut face = Feature::default();
    solid.face(id, &mut face);
    let Some(normal) = face.normal else { return false };
    assert!((normal.norm() - N::ONE).abs() <= N::lit(4.0) * N::EPSILON, "unit: {face:?}");
    let by_id = solid.feature_normal(id);
    assert!((normal - by_id).norm() <= N::lit(8.0) * N::EPSILON, "one normal: {face:?}, {by_id}");
    let count = face.vertices.len();
    for at in 0..count {
        let (a, b) = (face.vertices[at], face.vertices[(at + 1) % count]);
        let c = face.vertices[(at + 2) % count];
        assert!(cross(&(b - a), &(c - b)).dot(&normal) > N::ZERO, "counter-clockwise: {face:?}");
        let ends = solid.edge(face.side_ids[at]).map(|(_, end)| end);
        assert!(ends.contains(&a) && ends.contains(&b), "side {at} of {face:?} is {ends:?}");
        assert_eq!(solid.vertex(face.vertex_ids[at]), a, "vertex {at} of {face:?}");
    }
    let behind =
        face.vertices[0].coords.dot(&normal) - solid.core_support(&normal).coords.dot(&normal);
    assert!(behind.abs() <= tolerance(solid), "the solid lies behind: {face:?}");
    true
}

/// Checks that the normal of the side is on its right, that the solid lies behind the side, and
/// that the ids of its ends give the same vertices in the same order.
fn face2<N: Real>(solid: &dyn ConvexPolyhedron<N, 2>, id: FeatureId) {
    let mut face = Feature::default();
    solid.face(id, &mut face);
    let normal = face.normal.expect("a side has a normal");
    let (a, b) = (face.vertices[0], face.vertices[1]);
    let along = unit(&(b - a)).expect("the side has a length").0;
    assert!((perp(&along) + normal).norm() <= N::lit(8.0) * N::EPSILON, "outward: {face:?}");
    let behind = a.coords.dot(&normal) - solid.core_support(&normal).coords.dot(&normal);
    assert!(behind.abs() <= tolerance(solid), "the solid lies behind: {face:?}");
    let ends = solid.edge(id).map(|(id, end)| (id, solid.vertex(id), end));
    assert!(ends.iter().all(|(_, vertex, end)| vertex == end), "ids of the ends: {ends:?}");
    assert_eq!(ends.map(|(id, ..)| id).as_slice(), face.vertex_ids.as_slice(), "one order");
}

/// Checks that the normal of a feature is unit, and that the feature lies in the supporting plane
/// of that normal.
fn points_out<N: Real, const D: usize>(
    solid: &dyn ConvexPolyhedron<N, D>,
    id: FeatureId,
    at: &Point<N, D>,
) {
    let normal = solid.feature_normal(id);
    assert!((normal.norm() - N::ONE).abs() <= N::lit(4.0) * N::EPSILON, "unit: {id:?} {normal}");
    let below = (solid.core_support(&normal) - at).dot(&normal);
    assert!(below <= tolerance(solid), "{id:?} lies {below} below the top along {normal}");
}

fn cuboids<N: Real>() {
    let mut numbers = Numbers::new();
    let sizes = [[1.0, 2.0, 3.0], [1.0, 1e-3, 2.0], [1e-20, 2e-20, 1e-20], [1e6, 1e4, 1e5]];
    for size in sizes.map(|size| size.map(N::lit)) {
        let solid = Cuboid::<N, 3>::new(Vector::<N, 3>::from(size));
        let vertices: Vec<_> = (0..8).map(|i| solid.vertex(FeatureId::Vertex(i))).collect();
        for index in 0..6 {
            assert!(face3(&solid, FeatureId::Face(index)), "a face has a normal");
        }
        for index in 0..12 {
            for (id, end) in solid.edge(FeatureId::Edge(index)) {
                points_out(&solid, FeatureId::Edge(index), &end);
                points_out(&solid, id, &end);
            }
        }
        for _ in 0..200 {
            holds_what_touches(&vertices, &solid, &numbers.direction());
        }
        let flat = Cuboid::<N, 2>::new(Vector::<N, 2>::new(size[0], size[1]));
        let vertices: Vec<_> = (0..4).map(|i| flat.vertex(FeatureId::Vertex(i))).collect();
        (0..4).for_each(|index| face2(&flat, FeatureId::Face(index)));
        for _ in 0..200 {
            holds_what_touches(&vertices, &flat, &numbers.direction());
        }
    }
}

#[test]
fn cuboids_have_consistent_features() {
    cuboids::<f32>();
    cuboids::<f64>();
}

#[test]
fn cuboid_numbers_are_the_documented_ones() {
    let solid = Cuboid::<f64, 3>::new(Vector::<f64, 3>::new(1.0, 2.0, 3.0));
    assert_eq!(
        solid.vertex(FeatureId::Vertex(5)),
        Point::<f64, 3>::new(1.0, -2.0, 3.0),
        "bits 101"
    );
    assert_eq!(
        solid.feature_normal(FeatureId::Face(3)),
        -Vector::<f64, 3>::y(),
        "axis 1, negative"
    );
    let mut face = Feature::default();
    solid.face(FeatureId::Face(4), &mut face);
    assert_eq!(
        face.vertex_ids.as_slice(),
        [4, 5, 7, 6].map(FeatureId::Vertex),
        "counter-clockwise about +z"
    );
    // Edge 6 = 4 · 1 + 2 runs along y. The sign bits are 2: z is negative, x is positive.
    let ends = solid.edge(FeatureId::Edge(6)).map(|(_, end)| end);
    assert_eq!(ends[0], Point::<f64, 3>::new(1.0, -2.0, -3.0), "one end");
    assert_eq!(ends[1], Point::<f64, 3>::new(1.0, 2.0, -3.0), "the other");
    let flat = Cuboid::<f64, 2>::new(Vector::<f64, 2>::new(1.0, 2.0));
    let mut face = Feature::default();
    let mut outline = Vec::new();
    for side in [0, 2, 1, 3] {
        flat.face(FeatureId::Face(side), &mut face);
        outline.push(face.vertex_ids[0]);
    }
    assert_eq!(outline, [1, 3, 2, 0].map(FeatureId::Vertex), "counter-clockwise");
}

#[test]
fn the_facing_feature_of_a_cube_follows_the_angle() {
    let solid = Cuboid::<f32, 3>::new(Vector::<f32, 3>::repeat(1.0));
    let mut feature = Feature::default();
    let cases = [
        ([1.0, 0.0, 0.0], FeatureId::Face(0)),
        ([1.0, 0.3, -0.3], FeatureId::Face(0)),
        ([0.0, 1.0, 1.0], FeatureId::Edge(3)),
        ([0.3, -1.0, 1.0], FeatureId::Edge(2)),
        ([1.0, 1.0, 1.0], FeatureId::Vertex(7)),
    ];
    for (direction, expected) in cases {
        let direction = Vector::<f32, 3>::from(direction).normalize();
        solid.core_feature(&direction, &mut feature);
        assert_eq!(feature.id, expected, "along {direction}");
    }
    let tilted = Vector::<f32, 3>::new(1.0, 1e-3, 0.0).normalize();
    assert_eq!(
        solid.support_feature_id_toward(&tilted),
        FeatureId::Edge(11),
        "exactly: an edge along z"
    );
    solid.support_feature_toward(&tilted, 2e-3, &mut feature);
    assert_eq!(feature.id, FeatureId::Face(0), "rotated slightly: a face");
}

#[test]
fn flat_cuboids_answer_what_they_are() {
    let mut feature = Feature::default();
    let flat_box = Cuboid::<f32, 3>::new(Vector::<f32, 3>::new(1.0, 2.0, 0.0));
    flat_box.core_feature(&Vector::<f32, 3>::z(), &mut feature);
    assert_eq!((feature.vertices.len(), feature.id), (4, FeatureId::Face(4)), "a rectangle");
    flat_box.core_feature(&Vector::<f32, 3>::x(), &mut feature);
    assert_eq!(feature.vertices.len(), 2, "its side is a segment: {feature:?}");
    let ends = flat_box.edge(feature.id).map(|(_, end)| end);
    assert!(
        feature.vertices.iter().all(|v| ends.contains(v)),
        "{feature:?} is that edge: {ends:?}"
    );
    let point = Cuboid::<f32, 3>::new(Vector::<f32, 3>::zeros());
    point.core_feature(&Vector::<f32, 3>::x(), &mut feature);
    assert_eq!(feature.vertices.len(), 1, "a point: {feature:?}");
    let line = Cuboid::<f32, 2>::new(Vector::<f32, 2>::new(0.0, 2.0));
    let mut feature = Feature::default();
    line.core_feature(&Vector::<f32, 2>::y(), &mut feature);
    assert_eq!(feature.vertices.len(), 1, "the end of a line: {feature:?}");
}

fn triangles<N: Real>(scale: f64) {
    let mut numbers = Numbers::new();
    let (mut polygons, mut left) = (0, 0);
    for _ in 0..200 {
        let corners = [0; 3].map(|_| Point::from(numbers.vector::<N, 3>() * N::lit(scale)));
        let solid = Triangle::<N, 3>::new(corners[0], corners[1], corners[2]);
        for index in 0..2 {
            assert!(face3(&solid, FeatureId::Face(index)), "random corners span a face");
        }
        for index in 0..3 {
            let ends = solid.edge(FeatureId::Edge(index));
            points_out(&solid, FeatureId::Edge(index), &ends[0].1);
            points_out(&solid, ends[0].0, &ends[0].1);
        }
        let direction = numbers.direction();
        holds_what_touches(&corners, &solid, &direction);
        polygons += u32::from(faces(&solid, &direction).vertices.len() == 3);
        let corners = [0; 3].map(|_| Point::from(numbers.vector::<N, 2>() * N::lit(scale)));
        let solid = Triangle::<N, 2>::new(corners[0], corners[1], corners[2]);
        left += u32::from(solid.edge(FeatureId::Face(0))[0].1 == corners[0]);
        for index in 0..3 {
            face2(&solid, FeatureId::Face(index));
            points_out(&solid, FeatureId::Vertex(index), &corners[index as usize]);
        }
        holds_what_touches(&corners, &solid, &numbers.direction());
    }
    assert!((10..60).contains(&polygons), "{polygons} directions near the normal of 200");
    assert!((60..140).contains(&left), "{left} counter-clockwise of 200");
}

#[test]
fn triangles_have_consistent_features() {
    triangles::<f32>(1.0);
    triangles::<f32>(1e-20);
    triangles::<f64>(1e6);
}

#[test]
fn triangles_without_area_are_segments_and_points() {
    let p = |x: f32| Point::<f32, 3>::new(x, 2.0 * x, 0.5 * x);
    let across = Vector::<f32, 3>::new(2.0, -1.0, 0.0).normalize();
    for corners in [[-1.0, 0.3, 2.0], [0.3, 2.0, -1.0], [-1.0, -1.0, 2.0]] {
        let [a, b, c] = corners.map(p);
        let feature = faces(&Triangle::<f32, 3>::new(a, b, c), &across);
        assert_eq!(feature.vertices.len(), 2, "{feature:?}");
        assert!(feature.vertices.contains(&p(-1.0)) && feature.vertices.contains(&p(2.0)), "whole");
    }
    let point = Triangle::<f32, 3>::new(p(1.0), p(1.0), p(1.0));
    assert_eq!(faces(&point, &across).id, FeatureId::Vertex(0), "a point");
    for id in [FeatureId::Vertex(1), FeatureId::Edge(2), FeatureId::Face(1)] {
        points_out(&point, id, &p(1.0));
    }
    let flat = Point::<f64, 2>::origin();
    let line = Triangle::<f64, 2>::new(
        flat,
        Point::<f64, 2>::new(1.0, 1.0),
        Point::<f64, 2>::new(3.0, 3.0),
    );
    let feature = faces(&line, &Vector::<f64, 2>::new(-1.0, 1.0).normalize());
    let normal = feature.normal.expect("a side in 2D");
    assert!(normal.x < 0.0 && normal.y > 0.0, "towards the direction: {feature:?}");
}

fn round_solids<N: Real>() {
    let mut numbers = Numbers::new();
    for (h, r) in [(1.0, 1.0), (0.1, 2.0), (2.0, 0.1), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)] {
        let (h, r) = (N::lit(h), N::lit(r));
        let solids: [&dyn SupportMap<N, 3>; 3] =
            [&Cylinder::new(h, r), &Cone::new(h, r), &Capsule::<N, 3>::new(h, r)];
        for _ in 0..300 {
            let direction = numbers.direction();
            for solid in &solids[..2] {
                let feature = faces(*solid, &direction);
                for vertex in &feature.vertices {
                    let along = unit(&vertex.coords).map_or(direction, |(along, _)| along);
                    let top = solid.core_support(&along).coords.dot(&along);
                    assert!(
                        vertex.coords.dot(&along) <= top + tolerance(*solid),
                        "{vertex} inside"
                    );
                }
            }
        }
        let mut feature = Feature::default();
        solids[2].core_feature(&numbers.direction(), &mut feature);
        assert_eq!(feature.vertices.len(), 2, "the core of a capsule is a segment");
    }
}

#[test]
fn round_solids_have_consistent_features() {
    round_solids::<f32>();
    round_solids::<f64>();
}

/// Returns the core feature for `direction`; checks that it is an octagon that runs
/// counter-clockwise about its normal.
fn cap<N: Real>(solid: &dyn SupportMap<N, 3>, direction: Vector<N, 3>) -> Feature<N, 3> {
    let feature = faces(solid, &direction);
    assert_eq!(feature.vertices.len(), 8, "{feature:?}");
    let normal = feature.normal.expect("a cap is flat");
    assert!(normal.dot(&direction) > N::ZERO, "it faces the direction");
    for at in 0..8 {
        let [a, b, c] = [0, 1, 2].map(|step| feature.vertices[(at + step) % 8]);
        assert!(cross(&(b - a), &(c - b)).dot(&normal) > N::ZERO, "counter-clockwise: {feature:?}");
    }
    feature
}

#[test]
fn caps_sides_rims_and_apex() {
    let up = Vector::<f64, 3>::new(0.1, 1.0, 0.2).normalize();
    let (cylinder, cone) = (Cylinder::new(1.0, 0.5), Cone::new(1.0, 0.5));
    assert_eq!(cap(&cylinder, up).id, FeatureId::Face(0), "the upper cap");
    assert_eq!(cap(&cylinder, -up).id, FeatureId::Face(1), "the lower cap");
    assert_eq!(cap(&cone, -up).id, FeatureId::Face(0), "the base");
    assert_eq!(cap(&Cone::new(0.0, 0.5), up).id, FeatureId::Face(1), "a disk has two sides");
    assert_eq!(faces(&cone, &up).id, FeatureId::Vertex(0), "the apex");
    let (level, slant) = (Vector::<f64, 3>::x(), Vector::<f64, 3>::new(1.0, -1.0, 0.0).normalize());
    assert_eq!(faces(&cylinder, &level).id, FeatureId::Face(2), "the round side");
    assert_eq!(faces(&cylinder, &level).vertices.len(), 2, "as a segment");
    assert_eq!(faces(&cone, &level).id, FeatureId::Face(1), "the round side");
    assert_eq!(faces(&cylinder, &slant).id, FeatureId::Edge(1), "the lower rim");
    assert_eq!(faces(&cone, &slant).id, FeatureId::Edge(0), "the rim");
    let segment = Segment::new(Point::<f64, 3>::origin(), Point::<f64, 3>::new(1.0, 0.0, 0.0));
    assert_eq!(faces(&segment, &slant).id, FeatureId::Edge(0), "a segment is its one edge");
}
