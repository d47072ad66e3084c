//! Arguments of the verb that draws pictures.

use clap::{Args, ValueEnum};

use super::{NonNegative, Numbers, OutputFile, SceneArgs, Size};

/// Draw a scene or a step of a recording.
///
/// The extension of the output file selects the format: .png shows surfaces, .svg shows lines. 2D
/// scenes are drawn to scale with y upwards. The view of 3D scenes is from the front, above and
/// right, or along `--look`; the camera frames all objects. No GPU is used, so equal inputs give
/// equal bytes.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge render boxes.json -o boxes.png
  impinge render boxes.json -o boxes.svg --size 900x600 --look -1,-1,-2
  impinge render boxes.json -o layers.png --layers object,contacts,tight-boxes
  impinge render balls.implog -o step.png --step 20")]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) output: OutputFile,
    /// Width and height in pixels, at most 8192; the height of an SVG follows from the scene
    #[arg(long, value_name = "WxH", default_value = "1200x900")]
    pub(crate) size: Size,
    /// The direction of view of a 3D scene
    #[arg(long, value_name = "VECTOR", allow_hyphen_values = true, default_value = "-2,-1.5,-3")]
    pub(crate) look: Numbers,
    /// The upward direction of a picture of a 3D scene; by default the axis that the scene names
    #[arg(long, value_name = "VECTOR", allow_hyphen_values = true)]
    pub(crate) up: Option<Numbers>,
    /// The angle of view of a 3D scene in degrees, clamped to 143; 0 is without perspective
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, default_value = "30")]
    pub(crate) angle: NonNegative,
    /// The step of a recording; by default the last
    #[arg(long, value_name = "N")]
    pub(crate) step: Option<usize>,
    /// The layers to draw
    #[arg(long, value_enum, value_delimiter = ',', default_value = "object,contacts")]
    pub(crate) layers: Vec<LayerName>,
}

/// The layers of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LayerName {
    /// The shapes of objects
    Object,
    /// Contact points and normals
    Contacts,
    /// Areas between contact points
    Manifolds,
    /// Lines between objects that are near each other
    Proximities,
    /// Bounding boxes of objects
    TightBoxes,
    /// Boxes of the broad phase
    LoosenedBoxes,
    /// Boxes of the nodes of the trees of the broad phase
    TreeNodes,
}
