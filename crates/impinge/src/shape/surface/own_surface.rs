//! What the library's own surfaces answer beyond [`Surface`]: quicker ways to the same contacts.

use core::fmt;

use crate::math::{Point, Real, Vector};
use crate::shape::{FaceSeams, FeatureId, Sidedness, Surface};

/// A surface of this library. No answer of it changes a contact, only what finding it costs.
pub(crate) trait OwnSurface<N: Real, const D: usize>: Surface<N, D> {
    /// [`Surface::admits`] of two normals, of the second only where the first is not admitted: what is
    /// around the feature is looked up once.
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        [first, second]: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        let is_first = self.admits(part, feature, first);
        [is_first, !is_first && self.admits(part, feature, second)]
    }

    /// [`Self::admits_in_turn`] at a corner of a triangle, of normals that are not its own; what is known of the
    /// triangle is given.
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

    /// What a triangle in 3D and those around it say of its normals; `None` of others, of one without area, and where
    /// that does not decide.
    fn face_seams(&self, part: u32) -> Option<FaceSeams<N>> {
        let _ = part;
        None
    }

    /// Which sides all segments of a chain in 2D have; `None` of surfaces in 3D.
    fn sidedness(&self) -> Option<Sidedness> {
        None
    }

    /// The part bounds a body: a solid that overlaps it touches its front wherever the middle of the solid is.
    fn is_body(&self, part: u32) -> bool {
        let _ = part;
        false
    }

    /// In 3D, parts hang together where they have corners at one position, and there alone; and a normal
    /// along which a direction into a part at the seam rises is none there.
    fn has_plain_seams(&self) -> bool {
        false
    }
}

/// The surface of a composite as the library's algorithms see it: any, with the quicker ways of its own.
///
/// Public only as the answer of a hidden method; users can neither make nor read one.
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
    /// A surface that may be a user's.
    pub(crate) fn of_any(surface: &'a dyn Surface<N, D>) -> Self {
        Self { surface, own: None }
    }

    /// A surface of the library.
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
