//! Arguments of the verbs that query a pair of objects, a shape or a ray.

use core::fmt;
use core::str::FromStr;

use clap::Args;

use super::{Format, NonNegative, NumberError, Numbers, SceneArgs};

/// Print the distance of two objects, and their nearest points.
///
/// Groups are ignored. If the objects overlap, the depth is the length of the shortest translation
/// that separates them, and the normal is the direction of this translation for the second object.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge distance balls.json left right
  impinge distance balls.json left right --json

Fields of --json: file, dimension, scalar, first, second, state (\"touch\", \"near\" or \"apart\"), distance, depth,
point1, point2, normal (from the first to the second), part1, part2. Exit code 1 if they touch.")]
pub(crate) struct DistanceArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The name of the first object
    pub(crate) first: String,
    /// The name of the second object
    pub(crate) second: String,
    /// The largest distance at which objects are called near
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true, default_value = "0")]
    pub(crate) margin: NonNegative,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Print the first hit of a moving shape or object.
///
/// The shape moves along a straight line and does not rotate. An object of the scene hits the
/// objects with which its groups interact; a shape hits every object. Time is 0 at the start of the
/// path and 1 at its end.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge cast balls.json --shape ball:0.25 --from -5,0,0 --to 5,0,0
  impinge cast balls.json --object left --by 2,0,0
  impinge cast boxes.json --shape box:1,1,1 --from 0,9,0 --to 0,0,0 --all
  impinge cast boxes.json --shape box --from 0,9,0 --to 0,0,0

Shapes: ball:RADIUS, box:HALF_EXTENTS, capsule:HALF_HEIGHT,RADIUS, the name of a shape of the scene, or a shape
in JSON as a scene file has it.

Fields of --json: file, dimension, scalar, hits with object, time, moved (the length of the path), position, point (on the moving
shape), normal (from it to the object), part. Exit code 1 if something is hit.")]
pub(crate) struct CastArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The shape to move
    #[arg(
        long,
        value_name = "SHAPE",
        requires = "from",
        requires = "to",
        required_unless_present = "object"
    )]
    pub(crate) shape: Option<ShapeSpec>,
    /// The start of the path
    #[arg(long, value_name = "POINT", allow_hyphen_values = true, requires = "shape")]
    pub(crate) from: Option<Numbers>,
    /// The end of the path
    #[arg(long, value_name = "POINT", allow_hyphen_values = true, requires = "shape")]
    pub(crate) to: Option<Numbers>,
    /// The name of an object of the scene to move
    #[arg(long, value_name = "NAME", conflicts_with = "shape", requires = "by")]
    pub(crate) object: Option<String>,
    /// The translation of the object, from start to end
    #[arg(long, value_name = "VECTOR", allow_hyphen_values = true, requires = "object")]
    pub(crate) by: Option<Numbers>,
    /// The distance at which objects count as hit
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true, default_value = "0")]
    pub(crate) distance: NonNegative,
    /// Print all hits on the path, not only the first
    #[arg(long)]
    pub(crate) all: bool,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Print the first hit of a ray, or all hits.
///
/// A ray that starts inside a solid hits it at time zero, unless `--hollow` is given.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge ray balls.json --from -5,0,0 --to 5,0,0
  impinge ray balls.json --from -5,0,0 --direction 1,0,0 --all

Fields of --json: file, dimension, scalar, hits with object, time (in units of the direction), length, point, normal (out of the
object), part. Exit code 1 if something is hit.")]
pub(crate) struct RayArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The start of the ray
    #[arg(long, value_name = "POINT", allow_hyphen_values = true)]
    pub(crate) from: Numbers,
    /// The end of the ray
    #[arg(
        long,
        value_name = "POINT",
        allow_hyphen_values = true,
        required_unless_present = "direction"
    )]
    pub(crate) to: Option<Numbers>,
    /// The direction of a ray without an end
    #[arg(long, value_name = "VECTOR", allow_hyphen_values = true, conflicts_with = "to")]
    pub(crate) direction: Option<Numbers>,
    /// Treat solids as hollow: a ray that starts inside hits where it leaves
    #[arg(long)]
    pub(crate) hollow: bool,
    /// Print all hits, not only the first
    #[arg(long)]
    pub(crate) all: bool,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// A shape given on the command line: `ball:0.5`, `box:1,2,3`, `capsule:1,0.5`, the name of a shape
/// in the scene, or a shape in JSON.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ShapeSpec {
    /// A kind of shape with its sizes.
    Short(ShortShape),
    /// The name of a shape in the scene, or JSON as in a scene file.
    Scene(String),
}

/// A kind of shape with its sizes. The number of sizes is checked when the shape is created.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShortShape {
    /// The kind, which is named before the colon.
    pub(crate) kind: ShapeKind,
    /// The numbers after the colon.
    pub(crate) sizes: Numbers,
}

/// The kinds of shapes that have a short form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShapeKind {
    /// A ball, with its radius.
    Ball,
    /// A box, with its half extents along the axes.
    Cuboid,
    /// A capsule along y, with half the length of its segment and its radius.
    Capsule,
}

impl ShapeKind {
    const ALL: [Self; 3] = [Self::Ball, Self::Cuboid, Self::Capsule];

    /// Returns the name before the colon.
    const fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Cuboid => "box",
            Self::Capsule => "capsule",
        }
    }
}

/// Writes the shape in the syntax of the argument.
impl fmt::Display for ShortShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.kind.name(), self.sizes)
    }
}

impl FromStr for ShapeSpec {
    type Err = NumberError;

    fn from_str(text: &str) -> Result<Self, NumberError> {
        let short = text.split_once(':').and_then(|(name, sizes)| {
            let kind = ShapeKind::ALL.into_iter().find(|kind| kind.name() == name)?;
            Some((kind, sizes))
        });
        // JSON contains colons too, but no name of a kind before its first colon.
        let Some((kind, sizes)) = short else { return Ok(Self::Scene(text.to_owned())) };
        Ok(Self::Short(ShortShape { kind, sizes: sizes.parse()? }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_by_hand() {
        let cuboid = ShortShape { kind: ShapeKind::Cuboid, sizes: Numbers(vec![1.0, 2.0, 3.0]) };
        assert_eq!(cuboid.to_string(), "box:1,2,3");
        assert_eq!("box:1,2,3".parse(), Ok(ShapeSpec::Short(cuboid)));
        for text in ["wheel", "cube:1", "{\"ball\": {\"radius\": 1}}"] {
            assert_eq!(text.parse(), Ok(ShapeSpec::Scene(text.into())));
        }
        let infinite = NumberError::NotFinite("inf".into());
        assert_eq!("ball:inf".parse::<ShapeSpec>(), Err(infinite));
    }
}
