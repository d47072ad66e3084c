//! `impinge render`: draws scenes and steps of recordings.

use std::path::Path;

use impinge::debug_render::{DebugOptions, DebugRender};
use impinge::dim3::math::Vector;
use impinge::math::Real;
use impinge::world::CollisionWorld;
use impinge_view::{Camera, PngPicture, world_drawing};

use crate::args::{LayerName, RenderArgs};
use crate::convert::direction;
use crate::error::CliError;
use crate::input::Input;
use crate::log::Log;
use crate::output::{self, Outcome};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &RenderArgs) -> Result<Outcome, CliError> {
    let format = PictureFormat::of(&args.output.path)?;
    let bytes = match Input::open(&args.scene)? {
        Input::Recording(log) => run_in(log.kind, DrawStep { log: &log, args, format })?,
        Input::Scene(loaded) => {
            if let Some(step) = args.step {
                return Err(CliError::argument("--step", step, "only recordings have steps"));
            }
            run_in(loaded.kind, DrawScene { loaded: &loaded, args, format })?
        }
    };
    output::write(&args.output.path, &bytes)?;
    Ok(Outcome::Clear)
}

/// The format of a picture, which determines how shapes are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PictureFormat {
    /// A raster image, which shows surfaces.
    Png,
    /// A vector image, which shows lines.
    Svg,
}

impl PictureFormat {
    /// Returns the format for the extension of a file; an error for other extensions.
    fn of(path: &Path) -> Result<Self, CliError> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if extension == "png" {
            Ok(Self::Png)
        } else if extension == "svg" {
            Ok(Self::Svg)
        } else {
            let reason = "the name of a picture ends in .png or .svg";
            Err(CliError::argument("--output", path.display(), reason))
        }
    }
}

/// The task that draws a scene after its first update.
struct DrawScene<'a> {
    loaded: &'a Loaded,
    args: &'a RenderArgs,
    format: PictureFormat,
}

/// The task that draws a recorded world after a step.
struct DrawStep<'a> {
    log: &'a Log,
    args: &'a RenderArgs,
    format: PictureFormat,
}

impl Task for DrawScene<'_> {
    type Answer = Vec<u8>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Vec<u8>, CliError> {
        let Self { loaded, args, format } = self;
        let mut world = loaded.world::<N, D>()?;
        loaded.check_pairs(&world)?;
        world.update();
        PictureStyle { args, format, up: loaded.up(), title: loaded.name() }.picture(&world)
    }
}

impl Task for DrawStep<'_> {
    type Answer = Vec<u8>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Vec<u8>, CliError> {
        let Self { log, args, format } = self;
        let replay = log.replay_to::<N, D>(args.step)?;
        let title = format!("{}, step {}", log.name(), replay.step());
        PictureStyle { args, format, up: Vector::y(), title }.picture(replay.world())
    }
}

/// The arguments, format and title of a picture.
struct PictureStyle<'a> {
    args: &'a RenderArgs,
    format: PictureFormat,
    /// The upward direction of the picture, unless `--up` is given.
    up: Vector<f64>,
    title: String,
}

impl PictureStyle<'_> {
    /// Returns the bytes of a picture of a world.
    fn picture<N: Stage<D>, const D: usize, T>(
        &self,
        world: &CollisionWorld<N, D, T>,
    ) -> Result<Vec<u8>, CliError> {
        let camera = N::camera(self.camera()?);
        let mut drawing = world_drawing(world, options(&self.args.layers));
        // The two formats are different types with this trait in common.
        let mut draw = |picture: &mut dyn DebugRender<N, D>| drawing.world(world, picture);
        let size @ [width, _] = self.args.size.0;
        Ok(match self.format {
            PictureFormat::Png => {
                let mut picture = PngPicture::new(camera, size);
                draw(&mut picture);
                picture.to_png()
            }
            PictureFormat::Svg => {
                let description = format!("{} objects", world.len());
                let mut picture = N::lines(camera, width).with_title(&self.title, &description);
                draw(&mut picture);
                picture.to_svg().into_bytes()
            }
        })
    }

    /// Returns the camera for a 3D scene.
    fn camera(&self) -> Result<Camera, CliError> {
        let look = direction::<f64, 3>("--look", &self.args.look)?;
        let up = self.args.up.as_ref().map(|up| direction::<f64, 3>("--up", up)).transpose()?;
        let camera = Camera::look_along(&look, &up.unwrap_or(self.up));
        let angle = self.args.angle.0;
        Ok(if angle > 0.0 { camera.perspective(angle.to_radians()) } else { camera })
    }
}

/// Returns drawing options in which only these layers have a style. Sizes of styles are for objects
/// of about length 1.
fn options<N: Real>(layers: &[LayerName]) -> DebugOptions<N> {
    let (all, mut options) = (DebugOptions::all(), DebugOptions::none());
    for layer in layers {
        match layer {
            LayerName::Object => options.object = all.object,
            LayerName::Contacts => {
                options.contact_point = all.contact_point;
                options.contact_normal = all.contact_normal;
            }
            LayerName::Manifolds => options.manifold = all.manifold,
            LayerName::Proximities => options.proximity = all.proximity,
            LayerName::TightBoxes => options.tight_box = all.tight_box,
            LayerName::LoosenedBoxes => options.loosened_box = all.loosened_box,
            LayerName::TreeNodes => options.tree_node = all.tree_node,
        }
    }
    options
}
