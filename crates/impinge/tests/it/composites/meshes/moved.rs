//! Tests that deformed meshes equal new meshes.

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Real, Space, Vector};
use impinge::partitioning::{BoxTree, BoxTreeError};
use impinge::shape::{CompositeShape, FeatureId, MeshError, Polyline, Shape, TriMesh};
use impinge_reference::random::Random;

use super::{grid, points, surface, vector};

fn probe<N: Real, const D: usize>(random: &mut Random) -> Aabb<N, D> {
    let corner = Point::from(vector::<N, D>(random.vector(20.0)));
    let size = Vector::<N, D>::from_fn(|_, _| N::lit(random.range(0.0, 6.0)));
    Aabb::new(corner, corner + size)
}

/// Compares the searches of a refitted tree with those of a new tree, which other tests compare
/// with a scan of all boxes.
fn check_search<N: Space<D>, const D: usize>(tree: &BoxTree<N, D>, random: &mut Random) {
    tree.validate().expect("sound");
    let anew = BoxTree::from_boxes(tree.boxes());
    assert_eq!(tree.bounds(), anew.bounds(), "around all");
    for _ in 0..20 {
        let probe = probe(random);
        assert_eq!(tree.overlapping(&probe), anew.overlapping(&probe), "{probe:?}");
    }
}

#[test]
fn moved_meshes_are_like_new_ones() {
    let mut random = Random::new(3);
    let (mut vertices, triangles) = grid(20, |x, y| [x - 10.0, y - 10.0, 0.0]);
    let mut cloth = TriMesh::<f32, 3>::new(points(&vertices), triangles.clone()).one_sided();
    for step in 0..24 {
        // First small moves, then large ones, after which neighbours in the tree are no longer
        // close to each other.
        let reach = if step < 8 { 0.3 } else { 12.0 };
        for vertex in &mut vertices {
            vertex.iter_mut().for_each(|x| *x = (*x + random.range(-reach, reach)) * 0.9);
        }
        cloth.set_vertices(&points(&vertices));
        let anew = TriMesh::new(points(&vertices), triangles.clone());
        assert_eq!(cloth.vertices(), anew.vertices(), "moved");
        assert_eq!(cloth.tree().boxes(), anew.tree().boxes(), "their boxes");
        assert_eq!(cloth.local_aabb(), anew.local_aabb(), "around all");
        check_search(cloth.tree(), &mut random);
        for part in 0..cloth.num_parts() {
            assert_eq!(cloth.normal(part), anew.normal(part), "{part}");
            assert_eq!(cloth.triangle(part), anew.triangle(part), "{part}");
        }
    }
    assert!(cloth.is_one_sided() && cloth.is_oriented(), "as before");
}

#[test]
fn moved_lines_are_like_new_ones() {
    let mut random = Random::new(4);
    let mut vertices: Vec<[f64; 2]> = (0..300).map(|i| [f64::from(i) / 10.0, 0.0]).collect();
    let mut rope = Polyline::<f64, 2>::open(points(&vertices));
    for _ in 0..12 {
        for vertex in &mut vertices {
            vertex.iter_mut().for_each(|x| *x += random.range(-0.5, 0.5));
        }
        rope.set_vertices(&points(&vertices));
        assert_eq!(rope.vertices(), Polyline::open(points(&vertices)).vertices(), "moved");
        check_search(rope.tree(), &mut random);
    }
}

#[test]
fn bad_moves_change_nothing() {
    let (vertices, triangles) = grid(4, |x, y| [x, y, 0.0]);
    let mut mesh = TriMesh::<f64, 3>::new(points(&vertices), triangles);
    let before = mesh.clone();
    let mut moved: Vec<_> = points::<f64, 3>(&vertices).iter().map(|p| p * 2.0).collect();
    moved[7].y = f64::NAN;
    let refused = mesh.try_set_vertices(&moved).expect_err("not finite");
    assert_eq!(refused, MeshError::VertexNotFinite { vertex: 7 }, "the eighth");
    let refused = mesh.try_set_vertices(&moved[..24]).expect_err("too few");
    assert_eq!(refused, MeshError::WrongCount { given: 24, needed: 25 }, "by name");
    assert_eq!(mesh.vertices(), before.vertices(), "unchanged");
    assert_eq!(mesh.tree().boxes(), before.tree().boxes(), "unchanged");
    let mut rope = Polyline::<f32, 3>::open(points(&vertices));
    let refused = rope.try_set_vertices(&[]).expect_err("none");
    assert_eq!(refused, MeshError::WrongCount { given: 0, needed: 25 }, "by name");
}

#[test]
fn what_hung_together_still_does() {
    let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    let mut line = Polyline::<f64, 2>::new(points(&vertices), vec![[0, 1], [2, 3]]);
    line.set_vertices(&points(&[[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [2.0, 0.0]]));
    let top = vector([0.0, 1.0]);
    assert!(surface(&line).admits(0, FeatureId::Vertex(1), &top), "a bend by now");
    assert!(line.are_adjacent(0, 1), "one joint");
}

/// Returns two cubes that share the corner (1, 1, 1) but no vertex, with the second moved by `x`.
fn two_cubes(x: f64) -> Vec<[f64; 3]> {
    let corner = |at: u32, low: f64| [0, 1, 2].map(|axis| low + f64::from((at >> axis) & 1));
    let second =
        (0..8).map(|at| corner(at, 1.0)).map(|corner| [corner[0] + x, corner[1], corner[2]]);
    (0..8).map(|at| corner(at, 0.0)).chain(second).collect()
}

/// Asserts that meshes made of a moved mesh have its joints: cubes that were built with a common
/// corner are no solid while they are apart, and a solid when they meet there again.
#[test]
fn meshes_made_of_a_moved_mesh_keep_its_joints() {
    let cube = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4]];
    let rest = [[2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]];
    let first = [cube, rest].concat();
    let second = first.iter().map(|corners| corners.map(|corner| corner + 8));
    let triangles = first.iter().copied().chain(second).collect();
    let mut cubes = TriMesh::<f64, 3>::new(points(&two_cubes(0.0)), triangles).solid();
    cubes.set_vertices(&points(&two_cubes(1.0)));
    assert!(!cubes.is_volume() && cubes.are_adjacent(11, 12), "apart");
    let again = [
        cubes.try_scaled(&vector([1.0; 3])).expect("no zero"),
        cubes.clone().flipped().flipped(),
        cubes.clone().with_vertices_merged(),
        cubes.clone().with_ghosts(&[[0, 1, 15]]),
        cubes.clone().with_vertices_merged().try_scaled(&vector([1.0; 3])).expect("no zero"),
    ];
    for (index, mut mesh) in again.into_iter().enumerate() {
        assert_eq!(mesh.vertices().len(), 16, "{index}: all are apart");
        assert!(!mesh.is_volume() && !mesh.is_solid(), "{index}: apart");
        assert!((0..12).any(|part| mesh.are_adjacent(part, 12)), "{index}: joined");
        mesh.set_vertices(&points(&two_cubes(0.0)));
        assert!(mesh.is_volume(), "{index}: together");
    }
}

#[test]
fn lines_scaled_from_a_moved_line_keep_its_joints() {
    let at = |x: f64| {
        let low = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let high = low.map(|[u, v]| [u + 1.0 + x, v + 1.0]);
        points::<f64, 2>(&[low, high].concat())
    };
    let segments = (0..8).map(|at| [at, if at % 4 == 3 { at - 3 } else { at + 1 }]).collect();
    let mut squares = Polyline::new(at(0.0), segments).solid();
    squares.set_vertices(&at(1.0));
    for factors in [[1.0, 1.0], [-1.0, 1.0]] {
        let scaled = squares.try_scaled(&vector(factors)).expect("no zero");
        assert!(!squares.is_solid() && !scaled.is_solid(), "{factors:?}: apart");
        assert!(scaled.are_adjacent(1, 4), "{factors:?}: joined at (1, 1)");
    }
}

#[test]
fn trees_are_refitted_in_and_out_of_bounds() {
    let mut random = Random::new(9);
    let probe_at = |random: &mut Random| probe::<f64, 2>(random);
    let mut boxes: Vec<Aabb<f64, 2>> = (0..200).map(|_| probe_at(&mut random)).collect();
    let mut tree = BoxTree::from_boxes(&boxes);
    for step in 0..12 {
        for (index, aabb) in boxes.iter_mut().enumerate() {
            let is_far = (index + step) % 7 == 0;
            *aabb = if is_far { Aabb::unbounded() } else { probe_at(&mut random) };
        }
        tree.refit(&boxes);
        assert_eq!(tree.boxes(), boxes, "as given");
        check_search(&tree, &mut random);
    }
    let refused = tree.try_refit(&boxes[1..]).expect_err("one is missing");
    assert_eq!(refused, BoxTreeError::WrongCount { given: 199, needed: 200 }, "by name");
    assert_eq!(tree.boxes(), boxes, "unchanged");
    BoxTree::<f32, 3>::from_boxes(&[]).refit(&[]);
}
