//! Compares the internal edges of height fields with results computed by hand, and with meshes and
//! polylines of the same parts.

use crate::support::part_search;
use crate::support::samples::samples;

use impinge::math::{Point, Real, Vector};
use impinge::shape::{
    CompositeShape, Diagonal, Diagonals, FeatureId, HeightField, Polyline, Surface, TriMesh,
    Triangle,
};
use impinge_reference::random::Random;
use part_search::{coarse, coarse_vector};

type Field = HeightField<f64, 3>;

fn v(x: f64, y: f64, z: f64) -> Vector<f64, 3> {
    Vector::<f64, 3>::new(x, y, z).normalize()
}

/// Returns a field of three rows and columns of points, whose height depends on the row only.
fn folded(rows: [f64; 3]) -> Field {
    let heights = rows.iter().flat_map(|&height| [height; 3]).collect();
    Field::new(3, 3, heights, Vector::<f64, 3>::new(2.0, 1.0, 2.0))
}

/// Returns the parts, except holes, of which a side connects the two points, each with that side.
fn sides(field: &Field, a: Point<f64, 3>, b: Point<f64, 3>) -> Vec<(u32, FeatureId)> {
    let mut found = Vec::new();
    for part in (0..field.num_parts()).filter(|part| !field.is_hole(*part)) {
        let corners = corners(field, part);
        for side in 0..3_u8 {
            let at = usize::from(side);
            let ends = [corners[at], corners[(at + 1) % 3]];
            if ends == [a, b] || ends == [b, a] {
                found.push((part, FeatureId::Edge(u32::from(side))));
            }
        }
    }
    found
}

fn corners<N: Real>(field: &HeightField<N, 3>, part: u32) -> [Point<N, 3>; 3] {
    let part = field.part(part);
    *part.solid.as_shape().as_shape::<Triangle<N, 3>>().expect("a triangle").corners()
}

/// Returns whether the parts at a side admit a normal there; asserts that all of them agree.
fn admitted(field: &Field, ends: [[usize; 2]; 2], normal: Vector<f64, 3>) -> bool {
    let [a, b] = ends.map(|[row, column]| field.point(row, column));
    let sides = sides(field, a, b);
    assert!(!sides.is_empty(), "no side from {a} to {b}");
    let surface = field.surface().expect("of every field");
    let answers: Vec<_> =
        sides.iter().map(|(part, side)| surface.admits(*part, *side, &normal)).collect();
    assert!(answers.windows(2).all(|two| two[0] == two[1]), "parts disagree on {normal}");
    answers[0]
}

#[test]
fn a_flat_field_has_only_its_two_normals_inside() {
    for diagonals in [Diagonals::Forward, Diagonals::Backward, Diagonals::Zigzag] {
        let field = folded([1.0; 3]).with_diagonals(diagonals);
        let middle = [[1, 1], [1, 2]];
        assert!(admitted(&field, middle, v(0.0, 1.0, 0.0)), "up");
        assert!(admitted(&field, middle, v(0.0, -1.0, 0.0)), "down");
        for normal in [v(0.0, 1.0, 0.1), v(0.1, 1.0, 0.0), v(0.0, 0.0, 1.0), v(0.0, -1.0, 0.3)] {
            assert!(!admitted(&field, middle, normal), "{normal} in a flat field");
        }
        let ends = match field.diagonal(0, 0) {
            Diagonal::Forward => [[0, 0], [1, 1]],
            Diagonal::Backward => [[0, 1], [1, 0]],
        };
        assert!(!admitted(&field, ends, v(1.0, 2.0, -1.0)), "nor at a diagonal");
        // At the border of the field, the normals within a half circle are admitted.
        let border = [[0, 0], [0, 1]];
        for normal in [v(0.0, 1.0, 0.0), v(0.0, 1.0, -1.0), v(0.0, 0.0, -1.0), v(0.0, -1.0, -1.0)] {
            assert!(admitted(&field, border, normal), "{normal} at the border");
        }
        assert!(!admitted(&field, border, v(0.0, 1.0, 1.0)), "towards the inside");
        let one_sided = field.one_sided();
        assert!(admitted(&one_sided, border, v(0.0, 1.0, -1.0)), "in front");
        assert!(!admitted(&one_sided, border, v(0.0, -1.0, -1.0)), "from behind");
        assert!(!admitted(&one_sided, middle, v(0.0, -1.0, 0.0)), "it has no back");
    }
}

#[test]
fn a_ridge_has_the_normals_between_its_faces_and_a_valley_none() {
    let (seam, side) = ([[1, 0], [1, 1]], v(0.0, 1.0, 1.0));
    let ridge = folded([0.0, 1.0, 0.0]);
    assert!(admitted(&ridge, seam, v(0.0, 1.0, 0.0)), "between the two");
    assert!(admitted(&ridge, seam, v(0.0, 1.0, -0.9)), "almost that of a face");
    assert!(!admitted(&ridge, seam, v(0.0, 1.0, 1.2)), "beyond");
    assert!(!admitted(&ridge, seam, v(0.0, -1.0, 0.0)), "from below it is a valley");
    let valley = folded([1.0, 0.0, 1.0]);
    assert!(!admitted(&valley, seam, v(0.0, 1.0, 0.0)), "a valley has none");
    assert!(admitted(&valley, seam, v(0.0, -1.0, 0.0)), "from below it is a ridge");
    let surface = ridge.surface().expect("of every field");
    let near = sides(&ridge, ridge.point(1, 0), ridge.point(1, 1));
    for (part, edge) in near {
        let own = surface.snapped(part, &v(0.0, 1.0, 0.0)).expect("a face");
        assert!((own.z.abs() - side.z).abs() < 1e-15 && own.y > 0.0, "{own} is that of a slope");
        assert!(surface.admits(part, edge, &own), "a face's own normal at its edge");
        assert!(surface.admits(part, FeatureId::Face(0), &own), "and on the face");
        assert!(!surface.admits(part, FeatureId::Face(0), &v(0.0, 1.0, 0.0)), "no other");
    }
}

#[test]
fn the_sides_of_a_hole_are_borders() {
    let mut field = folded([0.0; 3]);
    let seam = [[1, 0], [1, 1]];
    let outward = v(0.0, 1.0, 2.0);
    assert!(!admitted(&field, seam, outward), "inside");
    field.set_hole(1, 0, true);
    assert!(admitted(&field, seam, outward), "beside a hole");
    let corner = |field: &Field, part: u32| {
        let at = corners(field, part).iter().position(|corner| *corner == field.point(1, 1));
        let at = u32::try_from(at.expect("a corner")).expect("small");
        field.surface().expect("of every field").admits(
            part,
            FeatureId::Vertex(at),
            &v(-1.0, 1.0, 1.0),
        )
    };
    assert!(!corner(&field, 0), "the corner still has three cells around");
    field.set_hole(0, 0, true);
    field.set_part_hole(1, false);
    field.set_hole(1, 1, true);
    assert!(field.is_hole(0) && !field.is_hole(1), "one triangle is back");
    field.set_hole(0, 1, true);
    assert!(corner(&field, 1), "now it sticks out");
}

#[test]
fn internal_edges_may_be_kept() {
    let field = folded([0.0; 3]).with_internal_edges_kept();
    assert!(field.surface().is_none(), "there is nothing to know");
    let field = field.one_sided();
    let surface = field.surface().expect("the front");
    assert!(surface.admits(0, FeatureId::Edge(0), &v(1.0, 1.0, 1.0)), "every edge counts");
    assert!(!surface.admits(0, FeatureId::Edge(0), &v(1.0, -1.0, 1.0)), "in front only");
}

/// Returns a mesh of the parts that are not holes, and their indices in the field.
fn mesh_of<N: Real>(field: &HeightField<N, 3>) -> (TriMesh<N, 3>, Vec<u32>) {
    let numbers: Vec<_> = (0..field.num_parts()).filter(|part| !field.is_hole(*part)).collect();
    let vertices: Vec<_> = numbers.iter().flat_map(|&part| corners(field, part)).collect();
    let triangles =
        (0_u32..).take(numbers.len()).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]);
    let mesh = TriMesh::<N, 3>::new(vertices, triangles.collect());
    (if field.is_one_sided() { mesh.one_sided() } else { mesh }, numbers)
}

/// Asserts that both surfaces give equal results; returns whether they admit the normal.
fn compare<N: Real, const D: usize>(
    (surface1, part1): (&dyn Surface<N, D>, u32),
    (surface2, part2): (&dyn Surface<N, D>, u32),
    (feature1, feature2): (FeatureId, FeatureId),
    normal: &Vector<N, D>,
) -> bool {
    let what = format!("part {part1}, {feature1:?}, {normal}");
    let admits = surface1.admits(part1, feature1, normal);
    assert_eq!(admits, surface2.admits(part2, feature2, normal), "{what}");
    assert_eq!(surface1.snapped(part1, normal), surface2.snapped(part2, normal), "{what}");
    let center = Point::from(*normal);
    assert_eq!(surface1.faces(part1, &center), surface2.faces(part2, &center), "{what}");
    admits
}

/// A surface and the index of one of its parts.
type PartOf<'a, N, const D: usize> = (&'a dyn Surface<N, D>, u32);

/// Compares all features of a triangle. Returns how many admit the normal, and how many do not.
fn compare_features<N: Real>(
    (side1, side2): (PartOf<'_, N, 3>, PartOf<'_, N, 3>),
    normal: &Vector<N, 3>,
) -> (usize, usize) {
    let features =
        (0..3).flat_map(|k| [FeatureId::Vertex(k), FeatureId::Edge(k), FeatureId::Face(0)]);
    let answers: Vec<_> =
        features.map(|feature| compare(side1, side2, (feature, feature), normal)).collect();
    let yes = answers.iter().filter(|admits| **admits).count();
    (yes, answers.len() - yes)
}

fn check_against_meshes<N: Real>() {
    let mut random = Random::new(81);
    // The first six rounds have each pattern with one side and with two.
    let (mut admitted, mut refused, rounds) = (0, 0, samples(3).max(6));
    for round in 0..rounds {
        let scale = Vector::<N, 3>::from_fn(|_, _| N::lit([1.0, -1.0, 3.0][random.below(3)]));
        // Only a few different heights, so that there are flat regions, ridges and valleys.
        let heights = (0..16).map(|_| N::lit((2.0 * coarse(&mut random)).round() * 0.5)).collect();
        let pattern = [Diagonals::Forward, Diagonals::Backward, Diagonals::Zigzag][round % 3];
        let mut field = HeightField::<N, 3>::new(4, 4, heights, scale).with_diagonals(pattern);
        for part in 1..field.num_parts() {
            field.set_part_hole(part, random.below(6) == 0);
        }
        let field = if round % 2 == 0 { field.one_sided() } else { field };
        let (mesh, numbers) = mesh_of(&field);
        let (surface1, surface2) = (field.surface().expect("one"), mesh.surface().expect("one"));
        for (index, &part) in (0..).zip(&numbers) {
            for _ in 0..30 {
                let Some(normal) = coarse_vector::<N, 3>(&mut random).try_normalize(N::lit(1e-3))
                else {
                    continue;
                };
                let snapped = surface1.snapped(part, &normal).expect("an area");
                // Also tests the normal of another face, and the normalised sum of both normals.
                let other = numbers[random.below(numbers.len())];
                let other = surface1.snapped(other, &snapped).expect("an area");
                let between = (snapped + other).try_normalize(N::lit(1e-3)).unwrap_or(normal);
                for normal in [normal, snapped, other, between] {
                    let sides = ((surface1, part), (surface2, index));
                    let (yes, no) = compare_features(sides, &normal);
                    admitted += yes;
                    refused += no;
                }
            }
        }
    }
    let few = 400 * rounds;
    assert!(admitted > few && refused > few, "{admitted} and {refused} of {rounds} rounds");
}

#[test]
fn seams_are_those_of_a_mesh_of_the_same_triangles() {
    check_against_meshes::<f32>();
    check_against_meshes::<f64>();
}

/// Returns the number of features that admit the normal; asserts that both surfaces agree on each.
fn admitted_alike<N: Real>(
    ((surface1, part1), (surface2, part2)): (PartOf<'_, N, 2>, PartOf<'_, N, 2>),
    features: &[(FeatureId, FeatureId)],
    normal: &Vector<N, 2>,
) -> usize {
    let admits = |&(own, other): &(FeatureId, FeatureId)| {
        let admits = surface1.admits(part1, own, normal);
        let same = surface2.admits(part2, other, normal);
        assert_eq!(admits, same, "part {part1}, {own:?}, {normal}");
        admits
    };
    features.iter().filter(|pair| admits(pair)).count()
}

fn check_against_polylines<N: Real>() {
    let mut random = Random::new(82);
    let (mut admitted, mut refused) = (0_usize, 0_usize);
    for round in 0..40 {
        let signs = [N::ONE, -N::ONE];
        let scale = Vector::<N, 2>::new(N::lit(8.0) * signs[round / 2 % 2], signs[round / 4 % 2]);
        let heights = (0..9).map(|_| N::lit((2.0 * coarse(&mut random)).round() * 0.5)).collect();
        let mut field = HeightField::<N, 2>::new(heights, scale);
        for cell in 1..8 {
            field.set_hole(cell, random.below(5) == 0);
        }
        let field = if round % 2 == 0 { field.one_sided() } else { field };
        let points: Vec<_> = (0..9).map(|index| field.point(index)).collect();
        let numbers: Vec<_> = (0..8_u32).filter(|&part| !field.is_hole(part)).collect();
        // The front of a polyline is on its right.
        let is_turned = scale.x * scale.y > N::ZERO;
        let ends = |&part: &u32| if is_turned { [part + 1, part] } else { [part, part + 1] };
        let ends_turned = if is_turned { [1, 0] } else { [0, 1] };
        let features = [
            (FeatureId::Vertex(0), FeatureId::Vertex(ends_turned[0])),
            (FeatureId::Vertex(1), FeatureId::Vertex(ends_turned[1])),
            (FeatureId::Edge(0), FeatureId::Edge(0)),
        ];
        let line = Polyline::<N, 2>::new(points, numbers.iter().map(ends).collect());
        let line = if field.is_one_sided() { line.one_sided() } else { line };
        let (surface1, surface2) = (field.surface().expect("one"), line.surface().expect("one"));
        for (index, &part) in (0..).zip(&numbers) {
            for _ in 0..20 {
                let Some(normal) = coarse_vector::<N, 2>(&mut random).try_normalize(N::lit(1e-3))
                else {
                    continue;
                };
                let snapped = surface1.snapped(part, &normal).expect("a length");
                for normal in [normal, snapped] {
                    let sides = ((surface1, part), (surface2, index));
                    let yes = admitted_alike(sides, &features, &normal);
                    admitted += yes;
                    refused += features.len() - yes;
                    let (own, other) =
                        (surface1.snapped(part, &normal), surface2.snapped(index, &normal));
                    let rounding = N::lit(4.0) * N::EPSILON;
                    let is_same =
                        own.zip(other).is_some_and(|(own, other)| (own - other).norm() <= rounding);
                    // For a normal along the segment itself, only the field prefers one of its
                    // sides.
                    let along =
                        own.is_some_and(|own| own.dot(&normal).abs() <= N::lit(16.0) * N::EPSILON);
                    assert!(is_same || along, "part {part}, {normal}: {own:?} and {other:?}");
                    let center = Point::from(normal * N::lit(5.0));
                    assert_eq!(
                        surface1.faces(part, &center),
                        surface2.faces(index, &center),
                        "part {part}, {normal}"
                    );
                }
            }
        }
    }
    assert!(admitted > 1000 && refused > 1000, "{admitted} and {refused}");
}

#[test]
fn seams_are_those_of_a_polyline_of_the_same_segments() {
    check_against_polylines::<f32>();
    check_against_polylines::<f64>();
}
