//! Solid meshes in 3D: the volume that their surface encloses belongs to the shape.

use super::TriMesh;
use crate::math::{Mapped, Point, Real, max, max_component};
use crate::shape::composite::body::{check_fronts, pieces, samples_of};
use crate::shape::composite::joints::Joints;
use crate::shape::composite::mesh_error::{MeshError, or_panic};

impl<N: Real, const D: usize> TriMesh<N, D> {
    /// Returns whether the enclosed volume belongs to the shape: `solid` was called, and no joined
    /// vertices are apart after a move. Always false in 2D, where triangles are filled.
    #[must_use]
    pub const fn is_solid(&self) -> bool {
        self.is_solid && self.is_cycle
    }

    /// Returns for each triangle the first triangle of its piece; triangles that share corners
    /// belong to one piece.
    pub(super) fn pieces(&self) -> &[u32] {
        self.pieces.get_or_init(|| {
            let (joints, own) = (&self.topology.joints, self.triangles());
            let are_together = !self.topology.is_moved || joints.are_together(&self.vertices, own);
            let number = |vertex| if are_together { joints.of(vertex) } else { vertex };
            pieces(own, self.vertices.len(), number)
        })
    }
}

impl<N: Real> TriMesh<N, 3> {
    /// Makes the volume inside a closed mesh part of the shape; see [`Self::try_solid`].
    ///
    /// # Panics
    /// If [`Self::try_solid`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn solid(self) -> Self {
        or_panic(self.try_solid())
    }

    /// Makes the mesh solid: the volume that it [encloses](Self::encloses) belongs to the shape.
    ///
    /// Another solid wholly inside touches the mesh: the distance is zero, the time of impact is
    /// zero, and the contact leads out through the nearest part of the surface. The depth is
    /// measured from the plane through the nearest point of the surface, perpendicular to the
    /// normal, to the deepest point of the other solid. Points inside belong to the mesh. A ray
    /// that starts inside hits it at time 0 if the ray test treats shapes as solid. Contacts on the
    /// outside arise as for a [one-sided](Self::one_sided) mesh, but a solid that overlaps the
    /// surface has contacts wherever its centre is. An inner surface whose front faces its inside
    /// bounds a cavity; points in a cavity are outside the mesh.
    ///
    /// Later calls of [`Self::set_vertices`] are not checked: while joined vertices are apart, the
    /// mesh is a one-sided surface without an inside. [`Self::flipped`] makes it hollow
    /// permanently.
    ///
    /// The cost is O(n), plus a search of the mesh for each inner surface; more searches for one that
    /// touches other pieces.
    ///
    /// # Errors
    /// - [`MeshError::NotClosed`] or [`MeshError::NotOriented`] if the mesh does not [bound a
    ///   volume](Self::is_volume), with the first edge at fault.
    /// - [`MeshError::InsideOut`] if a closed piece has its front inside and lies in no other
    ///   piece, with the first triangle of that piece.
    ///
    /// A piece without volume has no inside and causes no error.
    /// ```
    /// use impinge::dim3::math::{Isometry, Vector};
    /// use impinge::dim3::procedural;
    /// use impinge::dim3::query::{contact, distance};
    /// use impinge::dim3::shape::{Ball, Cuboid, MeshError, TriMesh};
    ///
    /// let surface = procedural::cuboid(&Cuboid::new(Vector::new(2.0_f64, 3.0, 4.0)));
    /// let skin = TriMesh::new(surface.vertices, surface.triangles);
    /// let (here, ball, there) = (Isometry::identity(), Ball::new(0.25), Isometry::translation(1.0, 0.0, 0.0));
    /// assert_eq!(distance(&here, &skin, &there, &ball), 0.75, "a ball in a room");
    ///
    /// let block = skin.clone().solid();
    /// assert_eq!(distance(&here, &block, &there, &ball), 0.0, "a ball in a block");
    /// let way_out = contact(&here, &block, &there, &ball, 0.0).expect("it is inside");
    /// assert_eq!((way_out.depth, *way_out.normal), (1.25, Vector::x()));
    ///
    /// let open = TriMesh::new(skin.vertices().to_vec(), skin.triangles()[1..].to_vec());
    /// assert!(matches!(open.try_solid(), Err(MeshError::NotClosed { .. })));
    /// assert!(matches!(skin.flipped().try_solid(), Err(MeshError::InsideOut { part: 0 })));
    /// ```
    pub fn try_solid(mut self) -> Result<Self, MeshError> {
        if !self.is_cycle {
            return Err(self.opening());
        }
        let (pieces, scale) = (self.pieces(), self.scale());
        let cone = |part: u32| {
            let apex = self.corners(pieces[part as usize])[0];
            let arms =
                self.corners(part).mapped(|corner| (corner - apex).map(|x| x.as_f64() / scale));
            arms[0].dot(&arms[1].cross(&arms[2]))
        };
        let winding = |part: u32| {
            let is_other = |other: u32| pieces[other as usize] != pieces[part as usize];
            samples_of(self.corners(part)).find_map(|point| self.winding_beside(&point, is_other))
        };
        check_fronts(pieces, cone, winding)?;
        (self.is_solid, self.is_one_sided) = (true, true);
        Ok(self)
    }

    /// Returns a power of two near the largest magnitude of a coordinate. Coordinates are divided
    /// by it so that volumes neither overflow nor underflow.
    fn scale(&self) -> f64 {
        let corners = self.tree.bounds().map(|bounds| [*bounds.mins(), *bounds.maxs()]);
        let largest = |corner: &Point<N, 3>| max_component(&corner.coords);
        let size = corners.map_or(N::ONE, |[low, high]| max(largest(&low), largest(&high)));
        size.power_of_two_below().as_f64()
    }

    /// Returns the error for the first edge that is not traversed equally often in both directions.
    fn opening(&self) -> MeshError {
        let joints = Joints::new(&self.vertices, self.triangles());
        let ends = |part: u32, side: usize| {
            let corners = self.triangles[part as usize];
            [corners[side], corners[(side + 1) % 3]]
        };
        // Counts the traversals of an edge: in the direction from `from` to `to`, and in the
        // opposite direction.
        let counts = |[from, to]: [u32; 2]| {
            let mut counts = [0; 2];
            for &part in joints.parts(from) {
                for side in 0..3 {
                    let own = ends(part, side).mapped(|end| joints.of(end));
                    counts[0] += usize::from(own == [from, to]);
                    counts[1] += usize::from(own == [to, from]);
                }
            }
            counts
        };
        for (part, side) in self.each_side() {
            let (index, edge) = (part as usize, ends(part, side));
            let [from, to] = edge.mapped(|end| joints.of(end));
            match counts([from, to]) {
                _ if from == to => {}
                [1, 0] => return MeshError::NotClosed { part: index, edge },
                [one, other] if one != other => {
                    return MeshError::NotOriented { part: index, edge };
                }
                _ => {}
            }
        }
        // The sides balance by position, but not by the joints of construction: vertices that were
        // moved to one position do not join.
        MeshError::NotClosed { part: 0, edge: ends(0, 0) }
    }
}
