//! glTF, text and binary, by `gltf`: each mesh of a node becomes a part, in the frame of the scene.
//!
//! The crate checks the JSON. What it trusts is checked before: the tree of nodes, the lengths of buffers, the
//! accessors of positions, and in `accessor.rs` the ranges of accessors.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Gltf, Node, Primitive, Semantic};
use impinge::math::na::{Matrix4, Point3};
use percent_encoding::percent_decode_str;

use super::RawPart;
use super::accessor::{Layout, check};
use super::raw::FormatError;
use crate::Problem;

/// The bytes of the header of a binary file.
const HEADER: u32 = 12;

/// The meshes of the nodes of the default scene, or of all nodes.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Vec<RawPart>, FormatError> {
    let length = bytes.get(8..12).and_then(|length| length.try_into().ok());
    let is_short = length.is_none_or(|length| u32::from_le_bytes(length) < HEADER);
    if bytes.starts_with(b"glTF") && is_short {
        return Err(FormatError::syntax(None, "the length in the header is too small"));
    }
    check_positions(bytes)?;
    let document = Gltf::from_slice(bytes).map_err(|error| syntax_error(&error))?;
    let buffers = buffers(&document, path)?;
    let mut parts = Vec::new();
    let mut seen = BTreeSet::new();
    let mut open: Vec<Placed<'_>> = roots(&document);
    // Ends: no node is visited twice.
    while let Some(Placed { node, frame }) = open.pop() {
        if !seen.insert(node.index()) {
            let message = format!("node {} has two parents, or is its own", node.index());
            return Err(FormatError::syntax(None, message));
        }
        let frame = frame * matrix(&node);
        if let Some(mesh) = node.mesh() {
            let name = node.name().or(mesh.name()).unwrap_or_default();
            let mut part = RawPart::new(name);
            for primitive in mesh.primitives() {
                add(&primitive, &buffers, &frame, &mut part)?;
            }
            parts.push(part);
        }
        // The last is visited first: so they come in the order of the file.
        let children: Vec<_> = node.children().map(|node| Placed { node, frame }).collect();
        open.extend(children.into_iter().rev());
    }
    Ok(parts)
}

/// The positions of all primitives have an accessor: the crate's own checks index with theirs.
fn check_positions(bytes: &[u8]) -> Result<(), FormatError> {
    let document = Gltf::from_slice_without_validation(bytes);
    let document = document.map_err(|error| syntax_error(&error))?;
    let root = document.as_json();
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut indices = primitives.flat_map(|primitive| primitive.attributes.values());
    match indices.find(|index| index.value() >= root.accessors.len()) {
        None => Ok(()),
        Some(index) => {
            let message = format!("there is no accessor {}", index.value());
            Err(FormatError::syntax(None, message))
        }
    }
}

/// A node in the frame of its parent, which has this one.
struct Placed<'a> {
    node: Node<'a>,
    frame: Matrix4<f64>,
}

fn roots(document: &Gltf) -> Vec<Placed<'_>> {
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let frame = Matrix4::identity();
    let nodes: Vec<Node<'_>> = match scene {
        Some(scene) => scene.nodes().collect(),
        None => {
            let children = document.nodes().flat_map(|node| node.children().collect::<Vec<_>>());
            let children: BTreeSet<usize> = children.map(|node| node.index()).collect();
            document.nodes().filter(|node| !children.contains(&node.index())).collect()
        }
    };
    nodes.into_iter().rev().map(|node| Placed { node, frame }).collect()
}

fn matrix(node: &Node<'_>) -> Matrix4<f64> {
    let columns = node.transform().matrix();
    Matrix4::from_fn(|row, column| f64::from(columns[column][row]))
}

/// The error with the line, where the text of the JSON has one.
fn syntax_error(error: &gltf::Error) -> FormatError {
    let line = match error {
        gltf::Error::Deserialize(error) => Some(error.line()).filter(|line| *line > 0),
        _ => None,
    };
    FormatError::syntax(line, error.to_string())
}

/// The bytes of all buffers: within the file, in data URIs, and in files beside it.
fn buffers(document: &Gltf, path: &Path) -> Result<Vec<Vec<u8>>, FormatError> {
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let read = |buffer: gltf::Buffer<'_>| -> Result<Vec<u8>, FormatError> {
        let bytes = match buffer.source() {
            Source::Bin => document.blob.clone().unwrap_or_default(),
            Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => inline(data)?,
                None => {
                    let name = percent_decode_str(uri).decode_utf8_lossy();
                    fs::read(folder.join(&*name)).map_err(|error| Problem::Io {
                        kind: error.kind(),
                        message: format!("the buffer {uri:?}: {error}"),
                    })?
                }
            },
        };
        if bytes.len() < buffer.length() {
            let (given, needed) = (bytes.len(), buffer.length());
            let message = format!("buffer {} has {given} bytes of {needed}", buffer.index());
            return Err(FormatError::syntax(None, message));
        }
        Ok(bytes)
    };
    document.buffers().map(read).collect()
}

fn inline(data: &str) -> Result<Vec<u8>, FormatError> {
    let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
    let encoded = encoded.ok_or_else(|| FormatError::syntax(None, "a data URI is not base64"))?;
    let decoded = STANDARD.decode(encoded);
    decoded.map_err(|error| FormatError::syntax(None, format!("a data URI: {error}")))
}

/// Adds the triangles of a primitive; lines and points have none.
fn add(
    primitive: &Primitive<'_>,
    buffers: &[Vec<u8>],
    frame: &Matrix4<f64>,
    part: &mut RawPart,
) -> Result<(), FormatError> {
    if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        return Ok(());
    }
    let first = u32::try_from(part.vertices.len()).unwrap_or(u32::MAX);
    let positions = positions(primitive, buffers)?;
    let corners = corners(primitive, buffers, positions.len())?;
    part.vertices.extend(positions.into_iter().map(|vertex| {
        let point = frame.transform_point(&Point3::from(vertex.map(f64::from)));
        [point.x, point.y, point.z]
    }));
    // An index beyond the vertices of the primitive must not become one of the next.
    let count = part.vertices.len();
    let corner = |corner: u32| {
        let corner = first.saturating_add(corner);
        if (corner as usize) < count { corner } else { u32::MAX }
    };
    let corners: Vec<u32> = corners.into_iter().map(corner).collect();
    // A mirrored frame turns triangles over.
    let is_mirrored = frame.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
    for [a, b, c] in triangles(&corners, primitive.mode()) {
        part.face(if is_mirrored { [a, c, b] } else { [a, b, c] });
    }
    Ok(())
}

/// The positions of a primitive, in the frame of its node.
fn positions(primitive: &Primitive<'_>, buffers: &[Vec<u8>]) -> Result<Vec<[f32; 3]>, FormatError> {
    let missing = || FormatError::syntax(None, "a primitive has no positions");
    let accessor = primitive.get(&Semantic::Positions).ok_or_else(missing)?;
    check(&accessor, buffers, Layout { types: &[DataType::F32], dimensions: Dimensions::Vec3 })?;
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    Ok(reader.read_positions().ok_or_else(missing)?.collect())
}

/// The indices of a primitive; without an accessor of its own each of its `count` vertices in turn.
fn corners(
    primitive: &Primitive<'_>,
    buffers: &[Vec<u8>],
    count: usize,
) -> Result<Vec<u32>, FormatError> {
    let types = &[DataType::U8, DataType::U16, DataType::U32];
    if let Some(accessor) = primitive.indices() {
        check(&accessor, buffers, Layout { types, dimensions: Dimensions::Scalar })?;
    }
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    Ok(match reader.read_indices() {
        Some(indices) => indices.into_u32().collect(),
        None => (0..u32::MAX).take(count).collect(),
    })
}

/// The corners of each triangle; those of strips turn every other time.
fn triangles(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    let windows = corners.windows(3).enumerate();
    match mode {
        Mode::TriangleStrip => {
            let turned = windows.map(|(index, abc)| match index % 2 {
                0 => [abc[0], abc[1], abc[2]],
                _ => [abc[1], abc[0], abc[2]],
            });
            turned.collect()
        }
        Mode::TriangleFan => {
            let rest = corners.get(1..).unwrap_or_default();
            rest.windows(2).map(|bc| [corners[0], bc[0], bc[1]]).collect()
        }
        _ => corners.chunks_exact(3).map(|abc| [abc[0], abc[1], abc[2]]).collect(),
    }
}
