//! `impinge render`: pictures of scenes and of steps of recordings.

use std::path::Path;

use impinge::debug_render::{Color, DebugDrawing, DebugOptions, DebugRender};
use impinge::dim3::math::Vector;
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;
use impinge_record::{Registry, Replay};
use impinge_view::{Camera, PngPicture};

use crate::args::{LayerName, RenderArgs};
use crate::convert::vector;
use crate::error::CliError;
use crate::extent::{Extent, extent};
use crate::input::Input;
use crate::output::{self, Outcome};
use crate::recording::{Label, Log, in_file};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &RenderArgs) -> Result<Outcome, CliError> {
    let format = PictureFormat::of(&args.output)?;
    let bytes = match Input::open(&args.scene)? {
        Input::Recording(log) => run_in(log.kind, DrawStep { log: &log, args, format })?,
        Input::Scene(loaded) => {
            if let Some(step) = args.step {
                return Err(CliError::argument("--step", step, "only recordings have steps"));
            }
            run_in(loaded.kind, DrawScene { loaded: &loaded, args, format })?
        }
    };
    output::write(&args.output, &bytes)?;
    Ok(Outcome::Clear)
}

/// What a picture is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PictureFormat {
    /// Surfaces.
    Png,
    /// Lines.
    Svg,
}

impl PictureFormat {
    /// By the end of a file's name.
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

/// Draws a scene after one update.
struct DrawScene<'a> {
    loaded: &'a Loaded,
    args: &'a RenderArgs,
    format: PictureFormat,
}

/// Draws a recorded world after a step.
struct DrawStep<'a> {
    log: &'a Log,
    args: &'a RenderArgs,
    format: PictureFormat,
}

impl Task for DrawScene<'_> {
    type Answer = Vec<u8>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Vec<u8>, CliError> {
        let mut world = self.loaded.world::<N, D>()?;
        world.update();
        let up = self.loaded.up();
        let sheet = Sheet { args: self.args, format: self.format, up, title: self.loaded.name() };
        sheet.picture(&world)
    }
}

impl Task for DrawStep<'_> {
    type Answer = Vec<u8>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Vec<u8>, CliError> {
        let log = self.log;
        let registry = Registry::<N, D, Label>::new();
        let failed = in_file(&log.path);
        let mut replay =
            Replay::<N, D, Label>::open(log.bytes.as_slice(), &registry).map_err(&failed)?;
        let last = replay.len();
        let step = self.args.step.unwrap_or(last);
        if step > last {
            return Err(CliError::NoStep { path: log.path.clone(), step, last });
        }
        replay.seek(step).map_err(failed)?;
        let title = format!("{}, step {step}", log.name());
        let sheet = Sheet { args: self.args, format: self.format, up: Vector::y(), title };
        sheet.picture(replay.world())
    }
}

/// How a world is drawn.
struct Sheet<'a> {
    args: &'a RenderArgs,
    format: PictureFormat,
    /// The upper side of the picture, unless the user says otherwise.
    up: Vector<f64>,
    title: String,
}

impl Sheet<'_> {
    /// The bytes of a picture of a world.
    fn picture<N: Stage<D>, const D: usize, T>(
        &self,
        world: &CollisionWorld<N, D, T>,
    ) -> Result<Vec<u8>, CliError> {
        let camera = N::camera(self.camera()?);
        let mut drawing =
            DebugDrawing::new(self.options(&extent(world))).with_object_color(object_color);
        let mut draw = |picture: &mut dyn DebugRender<N, D>| drawing.world(world, picture);
        let [width, _] = self.args.size.0;
        Ok(match self.format {
            PictureFormat::Png => {
                let mut picture = PngPicture::new(camera, self.args.size.0);
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

    /// The camera of a 3D scene.
    fn camera(&self) -> Result<Camera, CliError> {
        let look = vector::<f64, 3>("--look", &self.args.look)?;
        let up = self.args.up.as_ref().map(|up| vector::<f64, 3>("--up", up)).transpose()?;
        let camera = Camera::look_along(&look, &up.unwrap_or(self.up));
        let angle = self.args.angle;
        Ok(if angle > 0.0 { camera.perspective(angle.to_radians()) } else { camera })
    }

    /// The layers that are asked for, in sizes that suit the objects.
    fn options<N: Stage<D>, const D: usize>(&self, extent: &Extent) -> DebugOptions<N> {
        let all = DebugOptions::<N>::all().scaled(N::lit(extent.typical));
        let mut options = DebugOptions::none();
        for layer in &self.args.layers {
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
        if let Some(normal) = &mut options.contact_normal {
            normal.color = NORMAL;
        }
        options.mesh.half_space_extent = N::lit(extent.whole);
        options
    }
}

/// Contact normals on a light page.
const NORMAL: Color = Color::rgb(190, 110, 20);

/// The colour of an object in a picture.
pub(crate) fn object_color(handle: CollisionObjectHandle) -> Option<Color> {
    Some(COLORS[handle.uid() % COLORS.len()])
}

/// Objects, in turn.
const COLORS: [Color; 6] = [
    Color::rgb(124, 146, 176),
    Color::rgb(204, 128, 104),
    Color::rgb(150, 178, 146),
    Color::rgb(212, 176, 106),
    Color::rgb(160, 136, 170),
    Color::rgb(120, 170, 172),
];
