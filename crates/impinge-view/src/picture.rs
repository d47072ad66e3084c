//! The part that pictures of all formats share.

use crate::camera::Camera;
use crate::layer::Layer;
use crate::lens::Lens;
use crate::recording::Recording;
use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::math::{Point, Space};

/// A picture: a back end that collects a drawing until its bytes are requested.
///
/// [`SvgPicture`](crate::SvgPicture) and [`PngPicture`](crate::PngPicture) are pictures in the two
/// formats. A mesh is stored by its id at the first call. Later meshes with the same id are drawn
/// with the stored content. A point is a disc whose diameter is the size of the point, but at least
/// 5 pixels.
///
/// ```
/// use impinge::debug_render::{Color, DebugRender, Drawn};
/// use impinge::dim2::math::Point;
/// use impinge_view::SvgPicture;
///
/// let mut picture = SvgPicture::plane(200);
/// let far = Point::new(f32::NAN, 0.0);
/// picture.line([Point::origin(), far], Color::rgb(0, 0, 0), Drawn::Query);
/// assert_eq!(picture.left_out(), 1);
/// ```
#[derive(Clone, Debug)]
pub struct Picture<F> {
    pub(crate) recording: Recording,
    pub(crate) camera: Camera,
    pub(crate) format: F,
}

impl<F> Picture<F> {
    pub(crate) fn with_format(camera: Camera, format: F) -> Self {
        Self { recording: Recording::default(), camera, format }
    }

    /// Returns the number of omitted lines, triangles, points, texts and meshes. An element is
    /// omitted if a coordinate is NaN, infinite or above 1e13 in magnitude, or if a size is
    /// negative, NaN or above 1e13. A line or triangle of a mesh is also omitted if one of its
    /// indices has no vertex.
    #[must_use]
    pub fn left_out(&self) -> u64 {
        self.recording.left_out
    }

    /// Removes all drawn elements and resets the number of omitted ones, for the next picture.
    /// Stored meshes are kept.
    pub fn clear(&mut self) {
        self.recording.clear();
    }

    /// Replaces the camera; the drawing stays.
    pub fn set_camera(&mut self, camera: Camera) {
        self.camera = camera;
    }

    /// Returns the layers of the drawing, each with the colour that represents it in the legend.
    pub(crate) fn layers(&self) -> Vec<(Layer, Color)> {
        let layers = self.recording.layers().into_iter();
        let colors = |layer| Some((Layer::of(layer), self.recording.color_of(layer)?));
        layers.filter_map(colors).collect()
    }

    /// Returns the camera at its position for this drawing.
    pub(crate) fn lens(&self) -> Lens {
        Lens::new(&self.camera, &self.recording.points())
    }
}

impl<N: Space<D>, const D: usize, F> DebugRender<N, D> for Picture<F> {
    fn line(&mut self, ends: [Point<N, D>; 2], color: Color, what: Drawn) {
        self.recording.line(ends, color, what);
    }

    fn point(&mut self, at: &Point<N, D>, size: N, color: Color, what: Drawn) {
        self.recording.point(at, size, color, what);
    }

    fn text(&mut self, at: &Point<N, D>, text: &str, color: Color, what: Drawn) {
        DebugRender::<N, D>::text(&mut self.recording, at, text, color, what);
    }

    fn triangle(&mut self, corners: [Point<N, D>; 3], color: Color, what: Drawn) {
        self.recording.triangle(corners, color, what);
    }

    fn mesh(&mut self, mesh: &ShapeMesh<N, D>, pose: &N::Isometry, color: Color, what: Drawn) {
        self.recording.mesh(mesh, pose, color, what);
    }
}
