//! Additional methods of the library's own surfaces. Most of them only make contacts faster to
//! compute; the others report which parts enclose a solid region or lie beside a
//! ghost.

use core::fmt;

use crate::math::{Point, Real, Vector};
use crate::shape::{FaceSeams, FeatureId, Sidedness, Surface};

/// A surface of this library. Only [`Self::is_body`] and [`Self::each_ghost_beside`] change which
/// contacts are found; the other methods change only the cost.
pub(crate) trait OwnSurface<N: Real, const D: usize>: Surface<N, D> {
    /// Calls [`Surface::admits`] for two normals, for the second only if the first is rejected
    /// (else the second result is false). An implementation may evaluate the neighbourhood of the
    /// feature once for both.
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        [first, second]: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        let is_first = self.admits(part, feature, first);
        [is_first, !is_first && self.admits(part, feature, second)]
    }

    /// Runs [`Self::admits_in_turn`] at a corner of a triangle, for normals other than the normal
    /// of the triangle; `known` has the seams of the triangle.
    fn corner_admits_in_turn(
        &self,
        part: u32,
        corner: usize,
        known: &FaceSeams<N>,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        let _ = known;
        self.admits_in_turn(part, FeatureId::Vertex([0, 1, 2][corner]), normals)
    }

    /// Returns the seams of a triangle in 3D; `None` for other parts, for a triangle without area,
    /// and for a surface that keeps its internal edges.
    fn face_seams(&self, part: u32) -> Option<FaceSeams<N>> {
        let _ = part;
        None
    }

    /// Returns the sidedness of all segments of a chain in 2D; `None` for other surfaces.
    fn sidedness(&self) -> Option<Sidedness> {
        None
    }

    /// Returns whether the part belongs to a surface that encloses a solid region. A solid that
    /// overlaps such a part has contacts on the front of the part, on whichever side of the surface
    /// the centre of the solid lies.
    fn is_body(&self, part: u32) -> bool {
        let _ = part;
        false
    }

    /// Calls `visit` with each ghost that is adjacent to the part, some of them more than once. A
    /// solid that is nearer to such a ghost than to the part has its contact with the neighbouring
    /// surface that the ghost represents.
    fn each_ghost_beside(&self, part: u32, visit: &mut dyn FnMut(u32)) {
        let _ = (part, visit);
    }

    /// Returns whether a surface in 3D has two properties: parts are adjacent exactly where they
    /// have coincident corners, and at a seam every direction into an adjacent part has a component
    /// of at most zero along each admitted normal. Then the contact of a ball with a triangle can
    /// be skipped if an adjacent triangle hides it; see `collide/separation/triangles/ball.rs`.
    fn has_regular_seams(&self) -> bool {
        false
    }
}

/// The surface of a composite for the algorithms of the library. A surface of the library also has
/// the methods of `OwnSurface`; a user's surface has only the methods of [`Surface`].
///
/// Public only because a hidden method returns this type; users can neither construct nor use it.
#[derive(Clone, Copy)]
pub struct SurfaceAccess<'a, N: Real, const D: usize> {
    surface: &'a dyn Surface<N, D>,
    own: Option<&'a dyn OwnSurface<N, D>>,
}

impl<N: Real, const D: usize> fmt::Debug for SurfaceAccess<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SurfaceAccess").field("is_own", &self.own.is_some()).finish()
    }
}

impl<'a, N: Real, const D: usize> SurfaceAccess<'a, N, D> {
    /// Wraps any surface, also a user's.
    pub(crate) fn of_any(surface: &'a dyn Surface<N, D>) -> Self {
        Self { surface, own: None }
    }

    /// Wraps a surface of the library.
    pub(crate) fn of_own<S: OwnSurface<N, D>>(surface: &'a S) -> Self {
        Self { surface, own: Some(surface) }
    }

    /// Calls [`Surface::admits`].
    #[inline]
    pub(crate) fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool {
        self.surface.admits(part, feature, normal)
    }

    /// Runs [`OwnSurface::admits_in_turn`]; for a user's surface, calls [`Surface::admits`] for
    /// each normal.
    pub(crate) fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        if let Some(own) = self.own {
            return own.admits_in_turn(part, feature, normals);
        }
        let is_first = self.admits(part, feature, normals[0]);
        [is_first, !is_first && self.admits(part, feature, normals[1])]
    }

    /// Runs [`OwnSurface::corner_admits_in_turn`]; for a user's surface, calls [`Surface::admits`]
    /// for each normal.
    pub(crate) fn corner_admits_in_turn(
        &self,
        part: u32,
        corner: usize,
        known: &FaceSeams<N>,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        match self.own {
            Some(own) => own.corner_admits_in_turn(part, corner, known, normals),
            None => self.admits_in_turn(part, FeatureId::Vertex([0, 1, 2][corner]), normals),
        }
    }

    /// Returns the result of [`OwnSurface::face_seams`]; `None` for a user's surface.
    pub(crate) fn face_seams(&self, part: u32) -> Option<FaceSeams<N>> {
        self.own?.face_seams(part)
    }

    /// Calls [`Surface::snapped`].
    #[inline]
    pub(crate) fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>> {
        self.surface.snapped(part, normal)
    }

    /// Calls [`Surface::faces`].
    #[inline]
    pub(crate) fn faces(&self, part: u32, center: &Point<N, D>) -> bool {
        self.surface.faces(part, center)
    }

    /// Returns the result of [`OwnSurface::is_body`]; false for a user's surface.
    pub(crate) fn is_body(&self, part: u32) -> bool {
        self.own.is_some_and(|own| own.is_body(part))
    }

    /// Runs [`OwnSurface::each_ghost_beside`]; a user's surface has no ghosts.
    pub(crate) fn each_ghost_beside(&self, part: u32, visit: &mut dyn FnMut(u32)) {
        if let Some(own) = self.own {
            own.each_ghost_beside(part, visit);
        }
    }

    /// Returns the result of [`OwnSurface::sidedness`]; `None` for a user's surface.
    pub(crate) fn sidedness(&self) -> Option<Sidedness> {
        self.own?.sidedness()
    }

    /// Returns the result of [`OwnSurface::has_regular_seams`]; false for a user's surface.
    pub(crate) fn has_regular_seams(&self) -> bool {
        self.own.is_some_and(OwnSurface::has_regular_seams)
    }
}
