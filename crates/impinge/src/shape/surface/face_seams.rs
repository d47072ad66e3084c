//! The front normals of a triangle of a 3D surface and of its three neighbours, cached with the
//! triangle's corners.
//!
//! ```text
//!            c
//!           ╱ ╲
//!    across╱   ╲across      front: the unit normal of the triangle
//!         ╱front╲           across: the unit normals of the neighbours
//!        a───────b          bends: the shape of each side's edge, where known
//!          across
//! ```

use crate::math::{Point, Real, Vector};
use crate::shape::surface::bend::{Bend, BendShape};
use crate::shape::surface::own_surface::OwnSurface;
use crate::shape::{FeatureId, Surface, SurfaceAccess};

/// The front normal of a triangle with an area, and the shapes of its edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceSeams<N: Real> {
    /// The unit normal on the front, in the frame of the surface.
    pub(in crate::shape) front: Vector<N, 3>,
    pub(in crate::shape) across: [Vector<N, 3>; 3],
    /// The shape of each edge; `None` at a rim, and if [`Bend`] does not decide.
    pub(in crate::shape) bends: [Option<BendShape>; 3],
    pub(in crate::shape) is_one_sided: bool,
    /// Whether each neighbour is known to have its front on the same side of the surface as this
    /// triangle.
    is_oriented: bool,
}

impl<N: Real> FaceSeams<N> {
    /// Computes the seams of a triangle from its front normal. `bend(side)` returns the edge at a
    /// side; its `fronts` are the front normal of this triangle, then that of the neighbour. If
    /// `bend` returns `None`, `is_rim(side)` is called: it returns whether the side has no
    /// neighbour, or a neighbour with its front on the same side of the surface.
    pub(in crate::shape) fn new(
        front: Vector<N, 3>,
        is_one_sided: bool,
        bend: impl Fn(usize) -> Option<Bend<N>>,
        is_rim: impl Fn(usize) -> bool,
    ) -> Self {
        let (mut across, mut bends, mut is_oriented) = ([front; 3], [None; 3], true);
        for side in 0..3 {
            match bend(side) {
                Some(bend) => (across[side], bends[side]) = (bend.fronts()[1], Some(bend.shape())),
                None => is_oriented &= is_rim(side),
            }
        }
        Self { front, across, bends, is_one_sided, is_oriented }
    }

    /// Returns whether `face` is the normal on the front and all neighbours have their fronts on
    /// the same side. If this holds for all faces in contact, no face hides another.
    pub(crate) fn is_front(&self, face: &Vector<N, 3>) -> bool {
        self.is_oriented && self.front.dot(face) > N::ZERO
    }

    /// Returns this triangle as a surface that uses these seams and falls back to `surface`;
    /// `corner` is a corner of the triangle.
    pub(crate) fn in_surface<'a>(
        &'a self,
        surface: SurfaceAccess<'a, N, 3>,
        corner: &'a Point<N, 3>,
    ) -> KnownFace<'a, N> {
        KnownFace { seams: self, surface, corner }
    }

    /// Returns whether a neighbour across one of the two sides at a corner is known not to be
    /// coplanar with this triangle.
    pub(in crate::shape) fn is_bent_at(&self, corner: usize) -> bool {
        let is_bent = |bend: Option<BendShape>| bend.is_some_and(|bend| bend != BendShape::Flat);
        is_bent(self.bends[corner]) || is_bent(self.bends[(corner + 2) % 3])
    }

    /// Returns whether a side admits a unit vector other than the normal of the face; `None` if
    /// only the surface can decide.
    fn side_admits(&self, side: usize, normal: &Vector<N, 3>) -> Option<bool> {
        let bend = Bend::of(self.bends[side]?, [self.front, self.across[side]]);
        bend.admits(normal, self.is_one_sided)
    }
}

/// One triangle of a surface. Its cached seams decide if they can, else the surface decides.
///
/// Queried normals must differ from the face's own normal by more than rounding.
pub(crate) struct KnownFace<'a, N: Real> {
    seams: &'a FaceSeams<N>,
    surface: SurfaceAccess<'a, N, 3>,
    corner: &'a Point<N, 3>,
}

impl<N: Real> Surface<N, 3> for KnownFace<'_, N> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, 3>) -> bool {
        let known = match feature {
            FeatureId::Edge(side) => self.seams.side_admits(side as usize % 3, normal),
            _ => None,
        };
        known.unwrap_or_else(|| self.surface.admits(part, feature, normal))
    }

    fn snapped(&self, _: u32, normal: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let FaceSeams { front, is_one_sided, .. } = *self.seams;
        let is_front = is_one_sided || front.dot(normal) >= N::ZERO;
        Some(if is_front { front } else { -front })
    }

    fn faces(&self, _: u32, center: &Point<N, 3>) -> bool {
        let FaceSeams { front, is_one_sided, .. } = self.seams;
        !(*is_one_sided && front.dot(&(center - self.corner)) < N::ZERO)
    }
}

impl<N: Real> OwnSurface<N, 3> for KnownFace<'_, N> {
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, 3>; 2],
    ) -> [bool; 2] {
        match feature {
            FeatureId::Vertex(corner) => {
                let (corner, seams) = (corner as usize % 3, self.seams);
                self.surface.corner_admits_in_turn(part, corner, seams, normals)
            }
            _ => {
                let is_first = self.admits(part, feature, normals[0]);
                [is_first, !is_first && self.admits(part, feature, normals[1])]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::xorshift::Xorshift;
    use crate::shape::{CompositeShape, Diagonals, HeightField, PartSolid, TriMesh};

    /// Returns random heights of a grid, some of them zero.
    fn heights(random: &mut Xorshift) -> Vec<f64> {
        (0..36).map(|at| if at % 5 < 2 { 0.0 } else { 0.5 * random.next() }).collect()
    }

    fn mesh(random: &mut Xorshift) -> TriMesh<f64, 3> {
        let position = |(at, height): (usize, &f64)| {
            Point::<f64, 3>::new((at % 6) as f64, *height, (at / 6) as f64)
        };
        let vertices = heights(random).iter().enumerate().map(position).collect();
        let cells = (0..30).filter(|at| at % 6 < 5);
        let triangles = cells.flat_map(|at| [[at, at + 6, at + 7], [at, at + 7, at + 1]]);
        TriMesh::new(vertices, triangles.collect())
    }

    fn field(random: &mut Xorshift) -> HeightField<f64, 3> {
        let size = Vector::<f64, 3>::new(5.0, 1.0, 5.0);
        let mut field = HeightField::<f64, 3>::new(6, 6, heights(random), size);
        field.set_hole(2, 3, true);
        field
    }

    /// Checks that cached seams and the surface give equal results, for normals other than the
    /// normal of the triangle; adds the results to `counts`.
    fn check(parts: &dyn CompositeShape<f64, 3>, random: &mut Xorshift, counts: &mut [usize; 3]) {
        let surface = parts.surface_access().expect("a surface");
        for part in 0..parts.num_parts() {
            let Some(seams) = surface.face_seams(part) else { continue };
            let PartSolid::Triangle(triangle) = parts.part(part).solid else { panic!("triangles") };
            let corner = triangle.corners()[0];
            let known = seams.in_surface(surface, &corner);
            for at in 0..180_u32 {
                let aside: Vector<f64, 3> = random.vector([1.0, 0.3, 0.02][at as usize % 3]);
                let side = if at % 7 == 0 { -1.0 } else { 1.0 };
                let far = (seams.front * side + aside).normalize();
                let near = (seams.front * side + aside * 0.03).normalize();
                let normals = [&far, &near];
                let feature = match at / 3 % 2 {
                    0 => FeatureId::Edge(at / 6 % 3),
                    _ => FeatureId::Vertex(at / 6 % 3),
                };
                let (own, other) = (
                    known.admits_in_turn(part, feature, normals),
                    surface.admits_in_turn(part, feature, normals),
                );
                assert_eq!(own, other, "part {part}, {feature:?}, {far} {near}");
                counts[if own[0] { 0 } else { 1 + usize::from(own[1]) }] += 1;
                assert_eq!(known.snapped(part, &far), surface.snapped(part, &far), "part {part}");
                let center = corner + far;
                assert_eq!(known.faces(part, &center), surface.faces(part, &center), "{part}");
            }
        }
    }

    #[test]
    fn what_a_triangle_keeps_is_what_its_surface_says() {
        let (mut random, mut counts) = (Xorshift(3), [0; 3]);
        for _ in 0..4 {
            let (mesh, field) = (mesh(&mut random), field(&mut random));
            let zigzag = field.clone().with_diagonals(Diagonals::Zigzag);
            let mirrored = field.try_scaled(&Vector::<f64, 3>::new(-1.0, 2.0, 1.0));
            let mirrored = mirrored.expect("finite");
            let all: [Box<dyn CompositeShape<f64, 3>>; 6] = [
                Box::new(mesh.clone()),
                Box::new(mesh.one_sided()),
                Box::new(field.clone()),
                Box::new(field.one_sided()),
                Box::new(zigzag),
                Box::new(mirrored),
            ];
            for parts in &all {
                check(parts.as_ref(), &mut random, &mut counts);
            }
        }
        assert!(counts.iter().all(|&count| count > 1000), "all cases occur: {counts:?}");
    }

    #[test]
    fn seams_that_decide_nothing_are_not_kept() {
        let mut random = Xorshift(4);
        let kept = mesh(&mut random).with_internal_edges_kept().one_sided();
        let surface = kept.surface_access().expect("a one-sided surface");
        assert!(surface.face_seams(0).is_none(), "all edges count");
        let [a, b] = [[0.0; 3], [1.0, 0.0, 0.0]].map(Point::<f64, 3>::from);
        let thin = TriMesh::new(vec![a, b, a + (b - a) * 0.5], vec![[0, 1, 2]]);
        let surface = thin.surface_access().expect("a surface");
        assert!(surface.face_seams(0).is_none(), "without area there is no front");
    }
}
