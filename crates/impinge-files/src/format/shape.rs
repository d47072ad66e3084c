//! Shapes in a scene file: objects with one member, whose name is the kind of the shape.

use core::fmt;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::PoseFile;
use super::numbers::OneOrThree;

/// A shape: the name of one in `shapes`, or an inline shape.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ShapeRef {
    /// The name of a shape in `shapes`.
    Name(String),
    /// An inline shape.
    Inline(Box<ShapeFile>),
}

/// Deserialized by hand, since an untagged enum loses the position of an error.
impl<'de> Deserialize<'de> for ShapeRef {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RefVisitor)
    }
}

struct RefVisitor;

impl<'de> Visitor<'de> for RefVisitor {
    type Value = ShapeRef;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the name of a shape, or a shape such as {{\"ball\": {{\"radius\": 1}}}}")
    }

    fn visit_str<E>(self, name: &str) -> Result<ShapeRef, E> {
        Ok(ShapeRef::Name(name.to_owned()))
    }

    fn visit_map<M: MapAccess<'de>>(self, members: M) -> Result<ShapeRef, M::Error> {
        let shape = ShapeFile::deserialize(MapAccessDeserializer::new(members))?;
        Ok(ShapeRef::Inline(Box::new(shape)))
    }
}

/// A shape: an object with one member, whose name is the kind of the shape. Lengths and coordinates are in the frame
/// of the shape. Points and vectors have as many numbers as the scene has dimensions.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeFile {
    /// The points within a radius of the origin.
    Ball {
        /// The radius, 0 or more.
        radius: f64,
    },
    /// A box around the origin.
    Cuboid {
        /// Half the extent along each axis, 0 or more.
        half_extents: Vec<f64>,
    },
    /// The points within a radius of a segment, given by its ends or by half its height along the y axis.
    Capsule {
        /// The radius, 0 or more.
        radius: f64,
        /// Half the length of the segment, which lies on the y axis around the origin.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        half_height: Option<f64>,
        /// The ends of the segment.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ends: Option<[Vec<f64>; 2]>,
    },
    /// The hull of two balls, given by their centers or by half their distance along the y axis.
    TaperedCapsule {
        /// The radii at the lower (first) and the upper (second) end, 0 or more.
        radii: [f64; 2],
        /// Half the distance of the centers, which lie on the y axis around the origin.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        half_height: Option<f64>,
        /// The centers.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ends: Option<[Vec<f64>; 2]>,
    },
    /// The straight line between two points.
    Segment {
        /// The ends.
        ends: [Vec<f64>; 2],
    },
    /// A filled triangle.
    Triangle {
        /// The corners.
        corners: [Vec<f64>; 3],
    },
    /// A ball around the origin, scaled along the axes.
    Ellipsoid {
        /// Half the extent along each axis, 0 or more.
        half_axes: Vec<f64>,
    },
    /// All points behind the plane (in 2D, the line) through the origin.
    HalfSpace {
        /// The outward normal; any length but 0.
        normal: Vec<f64>,
    },
    /// The points within a radius of another convex shape.
    Rounded {
        /// The shape.
        shape: ShapeRef,
        /// The radius, 0 or more.
        radius: f64,
    },
    /// 3D only: a cylinder along the y axis, around the origin.
    Cylinder {
        /// Half the height, 0 or more.
        half_height: f64,
        /// The radius, 0 or more.
        radius: f64,
    },
    /// 3D only: a cone along the y axis, around the origin, with its apex at half the height.
    Cone {
        /// Half the height, 0 or more.
        half_height: f64,
        /// The radius of the base, 0 or more.
        radius: f64,
    },
    /// 3D only: a tetrahedron, in any order of its corners.
    Tetrahedron {
        /// The corners.
        corners: [Vec<f64>; 4],
    },
    /// The convex hull of points.
    ConvexHull {
        /// The points, in any order.
        points: Vec<Vec<f64>>,
    },
    /// 2D only: a convex polygon.
    ConvexPolygon {
        /// The corners, counter-clockwise.
        points: Vec<Vec<f64>>,
    },
    /// A chain of segments from vertex to vertex, or segments between given vertices.
    Polyline {
        /// The vertices.
        vertices: Vec<Vec<f64>>,
        /// The two vertices of each segment, counted from 0; without, from each vertex to the next.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        segments: Option<Vec<[u32; 2]>>,
        /// Whether a last segment goes from the last vertex to the first; not together with `segments`.
        #[serde(default)]
        closed: bool,
        /// 2D only: no contacts from behind, which is the left side of each segment.
        #[serde(default)]
        one_sided: bool,
    },
    /// A mesh of given triangles.
    Mesh {
        /// The vertices.
        vertices: Vec<Vec<f64>>,
        /// The three vertices of each triangle, counted from 0; counter-clockwise seen from the front.
        triangles: Vec<[u32; 3]>,
        /// 3D only: no contacts from behind.
        #[serde(default)]
        one_sided: bool,
    },
    /// A surface (in 2D, a polyline) given by its heights over a grid, around the y axis.
    HeightField(HeightFieldFile),
    /// Several shapes, as one.
    Compound {
        /// The shapes.
        children: Vec<ChildFile>,
    },
    /// 3D only: the triangles of a file.
    MeshFile(MeshSource),
}

/// A surface (in 2D, a polyline) given by its heights over a grid, around the y axis.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeightFieldFile {
    /// The heights, row by row: columns along x, rows along z.
    pub heights: Vec<f64>,
    /// 3D only, and required there: the number of heights in a row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub columns: Option<usize>,
    /// The extents of the whole field; the y component is the factor of the heights.
    pub scale: Vec<f64>,
    /// Cells without surface, counted from 0, row by row.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holes: Vec<usize>,
    /// Ghost cells, counted from 0, row by row: the border that a tile of a terrain shares with its neighbours.
    /// Nothing touches them, and their edges to other cells count as internal edges of the surface.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ghosts: Vec<usize>,
    /// 3D only: the diagonals along which cells are cut into two triangles.
    #[serde(default)]
    pub diagonals: DiagonalsFile,
    /// No contacts from behind: from below, if the factor of the heights is positive.
    #[serde(default)]
    pub one_sided: bool,
}

/// The diagonals along which the cells of a height field are cut into triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DiagonalsFile {
    /// From the corner of the lower row and column.
    #[default]
    Forward,
    /// From the corner of the lower row and the higher column.
    Backward,
    /// Alternating, forward where row and column are both even or both odd.
    Alternating,
}

/// A shape within a compound.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChildFile {
    /// The shape.
    pub shape: ShapeRef,
    /// The position in the frame of the compound.
    #[serde(default)]
    pub position: PoseFile,
}

/// The triangles of a mesh file, as a shape.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSource {
    /// The file: .obj, .stl, .ply, .gltf or .glb, relative to the folder of the scene.
    pub path: PathBuf,
    /// The name of one part of the file; without, all parts together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// A factor for all coordinates, or one for each axis; not 0.
    #[serde(default)]
    pub scale: ScaleFile,
    /// The kind of shape that is made of the triangles.
    #[serde(default, rename = "as")]
    pub kind: MeshKind,
}

/// The kind of shape that is made of the triangles of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MeshKind {
    /// A two-sided surface.
    #[default]
    Surface,
    /// A one-sided surface, without contacts from behind.
    OneSided,
    /// The boundary of a solid body, which contains its interior: an error if the surface is not closed or its
    /// triangles do not agree about the outside. If all of them point inwards, they are reversed.
    Solid,
    /// The convex hull of all vertices.
    ConvexHull,
    /// The convex hull of each part, as a compound.
    ConvexParts,
}

/// A factor for all axes, or one for each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ScaleFile {
    /// The factor of all axes.
    Uniform(f64),
    /// The factor of each axis.
    Axes([f64; 3]),
}

impl Default for ScaleFile {
    fn default() -> Self {
        Self::Uniform(1.0)
    }
}

impl ScaleFile {
    /// Returns the scale factors along x, y and z.
    #[must_use]
    pub const fn factors(&self) -> [f64; 3] {
        match self {
            Self::Uniform(factor) => [*factor; 3],
            Self::Axes(factors) => *factors,
        }
    }
}

impl<'de> Deserialize<'de> for ScaleFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match OneOrThree::deserialize(deserializer)? {
            OneOrThree::One(factor) => Self::Uniform(factor),
            OneOrThree::Three(factors) => Self::Axes(factors),
        })
    }
}
