//! glTF, text and binary, by `gltf`: each mesh of a node becomes a part, in the frame of the scene.
//!
//! The crate checks the JSON and trusts the ranges of accessors, which are checked here.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use impinge::math::na::{Matrix4, Point3};
use percent_encoding::percent_decode_str;

use super::RawPart;
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
    let wrong = || FormatError::syntax(None, "a primitive has no positions that can be read");
    let positions = primitive.get(&Semantic::Positions).ok_or_else(wrong)?;
    check(&positions, buffers, |kind| kind == DataType::F32, Dimensions::Vec3)?;
    if let Some(indices) = primitive.indices() {
        let is_index = |kind| matches!(kind, DataType::U8 | DataType::U16 | DataType::U32);
        check(&indices, buffers, is_index, Dimensions::Scalar)?;
    }
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let first = u32::try_from(part.vertices.len()).unwrap_or(u32::MAX);
    let vertices = reader.read_positions().ok_or_else(wrong)?;
    let placed = |vertex: [f32; 3]| {
        let point = frame.transform_point(&Point3::from(vertex.map(f64::from)));
        [point.x, point.y, point.z]
    };
    part.vertices.extend(vertices.map(placed));
    let count = u32::try_from(positions.count()).unwrap_or(u32::MAX);
    let corners: Vec<u32> = match reader.read_indices() {
        Some(indices) => indices.into_u32().collect(),
        None => (0..count).collect(),
    };
    // An index beyond the vertices of the primitive must not become one of the next.
    let corner = |corner: u32| if corner < count { first.saturating_add(corner) } else { u32::MAX };
    let corners: Vec<u32> = corners.into_iter().map(corner).collect();
    // A mirrored frame turns triangles over.
    let is_mirrored = frame.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
    for [a, b, c] in triangles(&corners, primitive.mode()) {
        part.face(if is_mirrored { [a, c, b] } else { [a, b, c] });
    }
    Ok(())
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

/// The numbers of an accessor are of its type and lie within their buffer.
fn check(
    accessor: &Accessor<'_>,
    buffers: &[Vec<u8>],
    is_usable: impl Fn(DataType) -> bool,
    dimensions: Dimensions,
) -> Result<(), FormatError> {
    let name = accessor.index();
    let wrong = |what: &str| FormatError::syntax(None, format!("accessor {name}: {what}"));
    if !is_usable(accessor.data_type()) || accessor.dimensions() != dimensions {
        return Err(wrong("numbers of another type are needed"));
    }
    if accessor.sparse().is_some() {
        return Err(wrong("sparse accessors cannot be read"));
    }
    let view = accessor.view().ok_or_else(|| wrong("there is no view of a buffer"))?;
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size);
    let steps = accessor.count().checked_sub(1).ok_or_else(|| wrong("it is empty"))?;
    if stride < size {
        return Err(wrong("its numbers overlap"));
    }
    let end = stride.checked_mul(steps).and_then(|end| end.checked_add(size));
    let end = end.and_then(|end| end.checked_add(accessor.offset()));
    let is_in_view = end.is_some_and(|end| end <= view.length());
    let view_end = view.offset().checked_add(view.length());
    let length = buffers.get(view.buffer().index()).map_or(0, Vec::len);
    if is_in_view && view_end.is_some_and(|end| end <= length) {
        return Ok(());
    }
    Err(wrong("it reaches beyond its buffer"))
}
