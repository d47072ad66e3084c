//! Small pictures for notebooks: SVG in 2D, PNG in 3D.

use impinge::debug_render::{DebugOptions, DebugRender};
use impinge::dim3::math::Vector as Vector3;
use impinge::math::{Real, Space};
use impinge::narrow_phase::GeometricQueryType;
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_view::{Camera, PngPicture, SvgPicture, world_drawing};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::shapes::kind_of;
use crate::side::SideArgument;
use crate::space::{Kind, Numeric, Task, run_in};

/// The view of a picture.
#[derive(FromPyObject)]
pub(crate) struct PictureView {
    /// Width and height in pixels; in 2D the height follows from the content.
    size: [u32; 2],
    /// The direction of view in 3D, and the upward direction.
    look: [f64; 3],
    up: [f64; 3],
    title: String,
}

/// A scalar and a dimension that support pictures.
pub(crate) trait Pictured<const D: usize>: Space<D> {
    /// The format of pictures, as a file extension.
    const FORMAT: &'static str;

    /// Returns the bytes of a picture of everything that `draw` draws.
    fn bytes(view: &PictureView, draw: &mut dyn FnMut(&mut dyn DebugRender<Self, D>)) -> Vec<u8>;
}

impl<N: Real> Pictured<2> for N {
    const FORMAT: &'static str = "svg";

    fn bytes(view: &PictureView, draw: &mut dyn FnMut(&mut dyn DebugRender<N, 2>)) -> Vec<u8> {
        let picture = SvgPicture::plane(view.size[0]).with_title(&view.title, "");
        let mut picture = picture.without_legend();
        draw(&mut picture);
        picture.to_svg().into_bytes()
    }
}

impl<N: Real> Pictured<3> for N {
    const FORMAT: &'static str = "png";

    fn bytes(view: &PictureView, draw: &mut dyn FnMut(&mut dyn DebugRender<N, 3>)) -> Vec<u8> {
        let camera = Camera::look_along(&Vector3::from(view.look), &Vector3::from(view.up));
        let mut picture = PngPicture::new(camera.perspective(0.5), view.size).without_texts();
        draw(&mut picture);
        picture.to_png()
    }
}

/// Returns a picture of the objects of a world, with contacts and proximities of the last update: its
/// format and its bytes.
pub(crate) fn picture<N: Numeric<D>, const D: usize>(
    world: &CollisionWorld<N, D, ()>,
    view: &PictureView,
) -> (&'static str, Vec<u8>) {
    let mut drawing = world_drawing(world, DebugOptions::default());
    let bytes = N::bytes(view, &mut |picture| drawing.world(world, picture));
    (<N as Pictured<D>>::FORMAT, bytes)
}

/// Returns a picture of shapes at poses.
#[pyfunction]
pub(crate) fn picture_of<'py>(
    shapes: &Bound<'py, PyAny>,
    poses: &Bound<'py, PyAny>,
    view: PictureView,
) -> PyResult<(&'static str, Bound<'py, PyBytes>)> {
    let kind = kind_of(shapes, "shapes")?;
    let side = SideArgument { shapes, poses, names: &["shapes", "poses"] };
    run_in(kind, Draw { side, kind, view })
}

struct Draw<'a, 'py> {
    side: SideArgument<'a, 'py>,
    kind: Kind,
    view: PictureView,
}

impl<'py> Task for Draw<'_, 'py> {
    type Answer = (&'static str, Bound<'py, PyBytes>);

    fn run<N: Numeric<D>, const D: usize>(self) -> PyResult<Self::Answer> {
        let given = self.side.read::<N, D>(self.kind)?;
        let poses = given.poses()?;
        let mut world = CollisionWorld::<N, D, ()>::new(N::ZERO);
        // The world is not updated: only shapes are drawn, and no pair is computed.
        let query = GeometricQueryType::Proximity(N::ZERO);
        for element in 0..given.side(&*poses)?.len() {
            let position = N::isometry(&poses.pose(if poses.len() == 1 { 0 } else { element }));
            let shape = given.shape(element).clone();
            let added = world.try_add(position, shape, CollisionGroups::new(), query, ());
            added.map_err(|refused| crate::error::of_row(&refused.into(), "poses", element))?;
        }
        let py = self.side.shapes.py();
        let (format, bytes) = py.detach(|| picture(&world, &self.view));
        Ok((format, PyBytes::new(py, &bytes)))
    }
}
