//! Tests that Bevy's meshes become surfaces and hulls, and that meshes without triangles give
//! errors.

use bevy_asset::RenderAssetUsages;
use bevy_impinge::ColliderError;
use bevy_impinge::d3::Collider;
use bevy_math::primitives::{Cuboid, Sphere};
use bevy_mesh::{Indices, Mesh, MeshBuilder, Meshable, PrimitiveTopology};

fn mesh(topology: PrimitiveTopology, positions: Vec<[f32; 3]>) -> Mesh {
    let mesh = Mesh::new(topology, RenderAssetUsages::default());
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}

#[test]
fn meshes_become_surfaces_and_hulls() {
    let cube = Cuboid::new(1.0, 2.0, 3.0).mesh().build();
    let surface = Collider::trimesh_from_mesh(&cube);
    let aabb = surface.shape().expect("good").local_aabb();
    assert_eq!((aabb.maxs().x, aabb.maxs().y, aabb.maxs().z), (0.5, 1.0, 1.5));
    assert_eq!(Collider::convex_hull_from_mesh(&cube).error(), None);
    let sphere = Sphere::new(1.0).mesh().uv(16, 8);
    assert_eq!(Collider::convex_hull_from_mesh(&sphere).error(), None);
    assert_eq!(Collider::trimesh_from_mesh(&sphere).error(), None);

    let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let strip = mesh(PrimitiveTopology::TriangleStrip, square.clone());
    assert_eq!(Collider::trimesh_from_mesh(&strip).error(), None, "without indices");
    let list = mesh(PrimitiveTopology::TriangleList, square);
    let list = list.with_inserted_indices(Indices::U16(vec![0, 1, 2, 1, 3, 2]));
    assert_eq!(Collider::trimesh_from_mesh(&list).error(), None);
}

#[test]
fn meshes_without_triangles_have_errors() {
    let lines = mesh(PrimitiveTopology::LineList, vec![[0.0; 3], [1.0; 3]]);
    let error = Collider::trimesh_from_mesh(&lines).error();
    assert!(matches!(error, Some(ColliderError::NoTriangles(_))), "{error:?}");
    let empty = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    for collider in [Collider::trimesh_from_mesh(&empty), Collider::convex_hull_from_mesh(&empty)] {
        assert!(matches!(collider.error(), Some(ColliderError::NoTriangles(_))));
    }
    let beyond = mesh(PrimitiveTopology::TriangleList, vec![[0.0; 3]]);
    let beyond = beyond.with_inserted_indices(Indices::U32(vec![0, 1, 2]));
    assert!(matches!(Collider::trimesh_from_mesh(&beyond).error(), Some(ColliderError::Mesh(_))));
}
