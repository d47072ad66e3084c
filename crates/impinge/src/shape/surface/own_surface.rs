//! Methods of the library's own surfaces beyond [`Surface`]: shortcuts to the same contacts.

use core::fmt;

use crate::math::{Point, Real, Vector};
use crate::shape::{FaceSeams, FeatureId, Sidedness, Surface};

/// A surface of this library. Its methods change the cost of contacts, never the contacts.
pub(crate) trait OwnSurface<N: Real, const D: usize>: Surface<N, D> {
    /// Calls [`Surface::admits`] for two normals, for the second only if the first is rejected
    /// (else the second result is false). The neighbourhood of the feature is evaluated once.
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        [first, second]: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        let is_first = self.admits(part, feature, first);
        [is_first, !is_first && self.admits(part, feature, second)]
    }

    /// [`Self::admits_in_turn`] at a corner of a triangle, for normals other than its own; `known`
    /// are the seams of the triangle.
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

    /// The seams of a triangle in 3D; `None` for other parts, for a triangle without area, and for
    /// a surface that keeps its internal edges.
    fn face_seams(&self, part: u32) -> Option<FaceSeams<N>> {
        let _ = part;
        None
    }

    /// The sides that all segments of a chain in 2D have; `None` for other surfaces.
    fn sidedness(&self) -> Option<Sidedness> {
        None
    }

    /// Whether the part bounds a body: a solid that overlaps it touches its front, whichever side
    /// of the surface the centre of the solid is on.
    fn is_body(&self, part: u32) -> bool {
        let _ = part;
        false
    }

    /// Whether, in 3D, parts are adjacent exactly where they have corners at one position, and a
    /// seam admits no normal along which a direction into an adjacent part rises.
    fn has_plain_seams(&self) -> bool {
        false
    }
}

/// The surface of a composite for the algorithms of the library: a user's, or one of the library's
/// own with shortcuts to the same contacts.
///
/// Public only as the return type of a hidden method; users can neither make nor read one.
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
    /// Wraps a surface that may be a user's.
    pub(crate) fn of_any(surface: &'a dyn Surface<N, D>) -> Self {
        Self { surface, own: None }
    }

    /// Wraps a surface of the library.
    pub(crate) fn of_own<S: OwnSurface<N, D>>(surface: &'a S) -> Self {
        Self { surface, own: Some(surface) }
    }

    /// See [`Surface::admits`].
    #[inline]
    pub(crate) fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool {
        self.surface.admits(part, feature, normal)
    }

    /// See [`OwnSurface::admits_in_turn`].
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

    /// See [`OwnSurface::corner_admits_in_turn`].
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

    /// See [`OwnSurface::face_seams`].
    pub(crate) fn face_seams(&self, part: u32) -> Option<FaceSeams<N>> {
        self.own?.face_seams(part)
    }

    /// See [`Surface::snapped`].
    #[inline]
    pub(crate) fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>> {
        self.surface.snapped(part, normal)
    }

    /// See [`Surface::faces`].
    #[inline]
    pub(crate) fn faces(&self, part: u32, center: &Point<N, D>) -> bool {
        self.surface.faces(part, center)
    }

    /// See [`OwnSurface::is_body`].
    pub(crate) fn is_body(&self, part: u32) -> bool {
        self.own.is_some_and(|own| own.is_body(part))
    }

    /// See [`OwnSurface::sidedness`].
    pub(crate) fn sidedness(&self) -> Option<Sidedness> {
        self.own?.sidedness()
    }

    /// See [`OwnSurface::has_plain_seams`].
    pub(crate) fn has_plain_seams(&self) -> bool {
        self.own.is_some_and(OwnSurface::has_plain_seams)
    }
}
