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
