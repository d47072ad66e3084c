//! Reads glTF, text and binary, with the crate `gltf`. Each mesh of a node becomes a part, in the
//! frame of the scene.
//!
//! The crate `gltf` checks the JSON document. This file checks the tree of nodes and the indices of
//! accessors, `buffers.rs` the lengths of buffers, and `accessor.rs` the types and ranges of
//! accessors.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use impinge::math::na::{Matrix4, Point3};

use super::RawPart;
use super::accessor::{Layout, check};
use super::buffers::Buffers;
use super::raw::FormatError;
use crate::files::Files;

/// The size of the header of a binary file, in bytes.
const HEADER: u32 = 12;

/// Reads the meshes of the nodes of the default scene; without one, of the first scene; without any
/// scene, of all nodes.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    files: &mut Files,
) -> Result<Vec<RawPart>, FormatError> {
    let length = bytes.get(8..12).and_then(|length| length.try_into().ok());
    let is_short = length.is_none_or(|length| u32::from_le_bytes(length) < HEADER);
    if bytes.starts_with(b"glTF") && is_short {
        return Err(FormatError::syntax(None, "the length in the header is too small"));
    }
    check_positions(bytes)?;
    let document = Gltf::from_slice(bytes).map_err(|error| syntax_error(&error))?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let buffers = Buffers::read(&document, folder, files)?;
    let buffers = &buffers.slices(&document);
    parts(&document, &mut Loader { buffers, files, checked: BTreeSet::new() })
}

/// Returns a part for each node with a mesh, among the nodes that [`roots`] returns and their
/// descendants.
fn parts(document: &Gltf, loader: &mut Loader<'_>) -> Result<Vec<RawPart>, FormatError> {
    let mut parts = Vec::new();
    let mut seen = BTreeSet::new();
    let mut open: Vec<Placed<'_>> = roots(document);
    // Terminates: a node that is visited twice is an error.
    while let Some(Placed { node, frame }) = open.pop() {
        if !seen.insert(node.index()) {
            let message = format!("node {} has two parents, or is its own", node.index());
            return Err(FormatError::syntax(None, message));
        }
        let frame = frame * matrix(&node);
        if let Some(mesh) = node.mesh() {
            let name = node.name().or(mesh.name()).unwrap_or_default();
            // Many nodes may use one mesh with a long name. Therefore the bytes of the names count
            // as elements.
            loader.files.count_elements(name.len())?;
            let mut part = NodePart { raw: RawPart::new(name), frame, first: BTreeMap::new() };
            for primitive in mesh.primitives() {
                loader.add(&primitive, &mut part)?;
            }
            parts.push(part.raw);
        }
        // The stack returns the last node first. Children are pushed in reverse order, so that they
        // are visited in the order of the file.
        let children: Vec<_> = node.children().map(|node| Placed { node, frame }).collect();
        open.extend(children.into_iter().rev());
    }
    Ok(parts)
}

/// Checks that the accessors of all attributes exist, since the checks of the crate `gltf` index
/// the accessor of positions.
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

/// A node, and the frame of its parent in the scene.
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

/// Returns the error with its line, if the parser of the JSON reports one.
fn syntax_error(error: &gltf::Error) -> FormatError {
    let line = match error {
        gltf::Error::Deserialize(error) => Some(error.line()).filter(|line| *line > 0),
        _ => None,
    };
    FormatError::syntax(line, error)
}

/// A part under construction, which contains the mesh of one node.
struct NodePart {
    raw: RawPart,
    /// Transforms from the frame of the mesh to the frame of the scene.
    frame: Matrix4<f64>,
    /// For each accessor of positions, the index of its first vertex in the part, and the number of
    /// its vertices. Primitives with the same accessor share vertices.
    first: BTreeMap<usize, [u32; 2]>,
}

/// Reads primitives. Checks each accessor at most once as positions and once as indices.
struct Loader<'a> {
    buffers: &'a [&'a [u8]],
    files: &'a mut Files,
    /// The accessors that were checked. The flag is `true` for a check as positions, `false` for a
    /// check as indices.
    checked: BTreeSet<(usize, bool)>,
}

impl Loader<'_> {
    /// Adds the triangles of a primitive. Primitives of lines or points add nothing.
    fn add(&mut self, primitive: &Primitive<'_>, part: &mut NodePart) -> Result<(), FormatError> {
        let mode = primitive.mode();
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let [first, count] = self.vertices(primitive, part)?;
        // An index beyond the vertices of this primitive must not refer to a vertex of the next
        // primitive.
        let corner = |corner: u32| if corner < count { first + corner } else { u32::MAX };
        let corners: Vec<u32> = self.corners(primitive, count)?.into_iter().map(corner).collect();
        // A mirroring frame reverses the orientation of triangles.
        let is_mirrored = part.frame.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        for [a, b, c] in triangles(&corners, mode) {
            part.raw.face(if is_mirrored { [a, c, b] } else { [a, b, c] });
        }
        Ok(())
    }

    /// Returns the index of the first vertex of a primitive in its part, and the number of its
    /// vertices. Adds the vertices unless an earlier primitive of the part has the same accessor.
    fn vertices(
        &mut self,
        primitive: &Primitive<'_>,
        part: &mut NodePart,
    ) -> Result<[u32; 2], FormatError> {
        let missing = || FormatError::syntax(None, "a primitive has no positions");
        let accessor = primitive.get(&Semantic::Positions).ok_or_else(missing)?;
        if let Some(range) = part.first.get(&accessor.index()) {
            return Ok(*range);
        }
        self.check(&accessor, true)?;
        self.files.count_elements(accessor.count())?;
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).copied());
        let positions = reader.read_positions().ok_or_else(missing)?;
        let first = part.raw.vertices.len();
        part.raw.vertices.extend(positions.map(|vertex| {
            let point = part.frame.transform_point(&Point3::from(vertex.map(f64::from)));
            [point.x, point.y, point.z]
        }));
        let range = [first, part.raw.vertices.len() - first];
        let range = range.map(|number| u32::try_from(number).unwrap_or(u32::MAX / 2));
        part.first.insert(accessor.index(), range);
        Ok(range)
    }

    /// Returns the vertex indices of a primitive; without an accessor of indices, the numbers below
    /// `count`.
    fn corners(&mut self, primitive: &Primitive<'_>, count: u32) -> Result<Vec<u32>, FormatError> {
        let accessor = primitive.indices();
        if let Some(accessor) = &accessor {
            self.check(accessor, false)?;
        }
        let number = accessor.map_or(count as usize, |accessor| accessor.count());
        // Each index of a strip or fan may begin a triangle, which has three corners.
        let corners = if primitive.mode() == Mode::Triangles { 1 } else { 3 };
        self.files.count_elements(number.saturating_mul(corners))?;
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).copied());
        Ok(match reader.read_indices() {
            Some(indices) => indices.into_u32().collect(),
            None => (0..count).collect(),
        })
    }

    /// Checks an accessor of positions or of indices, unless it was checked before.
    fn check(&mut self, accessor: &Accessor<'_>, is_position: bool) -> Result<(), FormatError> {
        let layout = if is_position {
            Layout { types: &[DataType::F32], dimensions: Dimensions::Vec3 }
        } else {
            let types = &[DataType::U8, DataType::U16, DataType::U32];
            Layout { types, dimensions: Dimensions::Scalar }
        };
        if self.checked.insert((accessor.index(), is_position)) {
            check(accessor, self.buffers, layout)?;
        }
        Ok(())
    }
}

/// Returns the corners of each triangle of a primitive. Two corners of every second triangle of a
/// strip are exchanged, so that all triangles have the same orientation.
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
