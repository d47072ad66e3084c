//! Colliders from render meshes.

use bevy_math::Vec3;
use bevy_mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};

use crate::ColliderError;
use crate::d3::Collider;

impl Collider {
    /// Creates a triangle mesh collider: a surface without an interior. Vertices at one position are merged, so
    /// the surface has no seams where the mesh has different normals or texture coordinates.
    ///
    /// The collider has an [error](Self::error) if the mesh has no readable positions or is not a list or strip
    /// of triangles.
    #[must_use]
    pub fn trimesh_from_mesh(mesh: &Mesh) -> Self {
        let (vertices, triangles) = match read(mesh) {
            Ok(read) => read,
            Err(error) => return Self::from_shape(Err(error)),
        };
        let points = crate::collider::points::<3>(vertices);
        let mesh = impinge::dim3::shape::TriMesh::try_new(points, triangles);
        Self::made(mesh.map(|mesh| mesh.with_vertices_merged()))
    }

    /// Creates the convex hull of the vertices of a mesh.
    ///
    /// The collider has an [error](Self::error) if the mesh has no readable positions, or no points.
    #[must_use]
    pub fn convex_hull_from_mesh(mesh: &Mesh) -> Self {
        match positions(mesh) {
            Ok(positions) => Self::convex_hull(positions),
            Err(error) => Self::from_shape(Err(error)),
        }
    }
}

type Triangles = (Vec<Vec3>, Vec<[u32; 3]>);

fn read(mesh: &Mesh) -> Result<Triangles, ColliderError> {
    let vertices = positions(mesh)?;
    let indices: Vec<u32> = match mesh.try_indices_option() {
        Ok(Some(Indices::U16(indices))) => indices.iter().map(|&index| index.into()).collect(),
        Ok(Some(Indices::U32(indices))) => indices.clone(),
        // Without indices each vertex is used once, in order.
        Ok(None) => (0..).take(vertices.len()).collect(),
        Err(_) => return Err(ColliderError::NoTriangles("its data is on the GPU alone")),
    };
    let triangles = match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => list(&indices),
        PrimitiveTopology::TriangleStrip => strip(&indices),
        _ => return Err(ColliderError::NoTriangles("it is no list or strip of triangles")),
    };
    Ok((vertices, triangles))
}

fn positions(mesh: &Mesh) -> Result<Vec<Vec3>, ColliderError> {
    match mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION) {
        Ok(Some(VertexAttributeValues::Float32x3(positions))) => {
            Ok(positions.iter().map(|&position| position.into()).collect())
        }
        Ok(Some(_)) => Err(ColliderError::NoTriangles("its positions are not Float32x3")),
        Ok(None) => Err(ColliderError::NoTriangles("it has no positions")),
        Err(_) => Err(ColliderError::NoTriangles("its data is on the GPU alone")),
    }
}

fn list(indices: &[u32]) -> Vec<[u32; 3]> {
    indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect()
}

/// Returns the triangles of a strip. In a strip, every second triangle has the opposite
/// orientation. Two of its corners are exchanged to reverse it.
fn strip(indices: &[u32]) -> Vec<[u32; 3]> {
    let corners = indices.windows(3).enumerate();
    corners.map(|(n, c)| if n % 2 == 0 { [c[0], c[1], c[2]] } else { [c[1], c[0], c[2]] }).collect()
}
