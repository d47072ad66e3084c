//! A cube in every mesh format, written by hand.

use std::path::PathBuf;

/// The corners of the cube, whose coordinates are 0 or 2.
pub(crate) const CORNERS: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [2.0, 0.0, 0.0],
    [2.0, 2.0, 0.0],
    [0.0, 2.0, 0.0],
    [0.0, 0.0, 2.0],
    [2.0, 0.0, 2.0],
    [2.0, 2.0, 2.0],
    [0.0, 2.0, 2.0],
];

/// The sides of the cube, counter-clockwise seen from outside.
pub(crate) const QUADS: [[u32; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// Returns the sides of the cube as triangles.
pub(crate) fn triangles() -> Vec<[u32; 3]> {
    QUADS.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect()
}

/// A mesh file in memory.
pub(crate) struct Sample {
    pub(crate) name: &'static str,
    pub(crate) bytes: Vec<u8>,
}

impl Sample {
    pub(crate) fn path(&self) -> PathBuf {
        PathBuf::from(self.name)
    }
}

/// Returns the cube in every mesh format.
pub(crate) fn samples() -> Vec<Sample> {
    let sample = |name, bytes| Sample { name, bytes };
    vec![
        sample("quads.obj", obj().into_bytes()),
        sample("ascii.stl", stl_text().into_bytes()),
        sample("binary.stl", stl_binary(b"a cube")),
        // The header of a binary file may also begin with `solid`.
        sample("misleading.stl", stl_binary(b"solid cube")),
        sample("ascii.ply", ply_text().into_bytes()),
        sample("little.ply", ply_binary(true)),
        sample("big.ply", ply_binary(false)),
        sample("inline.gltf", gltf_text().into_bytes()),
        sample("sparse.gltf", gltf_sparse().into_bytes()),
        sample("binary.glb", glb()),
    ]
}

pub(crate) fn obj() -> String {
    let mut text = String::from("# a cube\no cube\n");
    for [x, y, z] in CORNERS {
        text += &format!("v {x} {y} {z}\n");
    }
    for quad in QUADS {
        let [a, b, c, d] = quad.map(|corner| corner + 1);
        text += &format!("f {a}/1/1 {b}/1/1 {c}//1 {d}\n");
    }
    text
}

/// Returns the cube as OBJ with its fronts inside, like the walls of a room.
pub(crate) fn obj_inside_out() -> String {
    let lines = obj();
    let turned = lines.lines().map(|line| match line.strip_prefix("f ") {
        Some(corners) => {
            let reversed: Vec<&str> = corners.split(' ').rev().collect();
            format!("f {}\n", reversed.join(" "))
        }
        None => format!("{line}\n"),
    });
    turned.collect()
}

pub(crate) fn stl_text() -> String {
    let mut text = String::from("solid cube\n");
    for corners in triangles() {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for [x, y, z] in corners.map(|corner| CORNERS[corner as usize]) {
            text += &format!("      vertex {x} {y} {z}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid cube\n"
}

pub(crate) fn stl_binary(header: &[u8]) -> Vec<u8> {
    let triangles = triangles();
    let mut bytes = vec![b' '; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend(word(triangles.len()));
    for corners in triangles {
        bytes.extend([0; 12]);
        let corners = corners.map(|corner| CORNERS[corner as usize]);
        bytes.extend(corners.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn ply_header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty float y\n\
         property float z\nproperty uchar red\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

pub(crate) fn ply_text() -> String {
    let mut text = ply_header("ascii");
    for [x, y, z] in CORNERS {
        text += &format!("{x} {y} {z} 255\n");
    }
    for [a, b, c, d] in QUADS {
        text += &format!("4 {a} {b} {c} {d}\n");
    }
    text
}

pub(crate) fn ply_binary(is_little: bool) -> Vec<u8> {
    let format = if is_little { "binary_little_endian" } else { "binary_big_endian" };
    let mut bytes = ply_header(format).into_bytes();
    for corner in CORNERS {
        let numbers = corner.map(|x| if is_little { x.to_le_bytes() } else { x.to_be_bytes() });
        bytes.extend(numbers.concat());
        bytes.push(255);
    }
    for quad in QUADS {
        bytes.push(4);
        let numbers = quad.map(|x| if is_little { x.to_le_bytes() } else { x.to_be_bytes() });
        bytes.extend(numbers.concat());
    }
    bytes
}

/// Returns the binary data of the glTF files: the corners as `f32`, followed by the indices of the
/// triangles as `u16`.
pub(crate) fn gltf_buffer() -> Vec<u8> {
    let mut bytes: Vec<u8> = CORNERS.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let indices = triangles().into_iter().flatten();
    bytes.extend(indices.flat_map(|index| u16::try_from(index).expect("below 8").to_le_bytes()));
    bytes
}

/// Returns the JSON of a file in which a mirroring node contains a translating node with the cube.
/// The reader must reverse the triangles.
fn gltf_json(buffer: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"scale": [-1, 1, 1], "children": [1]}}, {{"name": "cube", "mesh": 0, "translation": [-2, 0, 0]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
"buffers": [{{{buffer}"byteLength": 168}}],
"bufferViews": [{{"buffer": 0, "byteLength": 96}}, {{"buffer": 0, "byteOffset": 96, "byteLength": 72}}],
"accessors": [
  {{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [2, 2, 2]}},
  {{"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}}]}}"#
    )
}

pub(crate) fn gltf_text() -> String {
    gltf_with("")
}

/// Returns a glTF file of the cube, with additional buffers after its own.
pub(crate) fn gltf_with(more: &str) -> String {
    let data = base64(&gltf_buffer());
    let text = gltf_json(&format!("\"uri\": \"data:application/octet-stream;base64,{data}\", "));
    text.replace("\"byteLength\": 168}", &format!("\"byteLength\": 168}}{more}"))
}

/// Returns a glTF file of the cube, with its buffer at a URI.
pub(crate) fn gltf_with_uri(uri: &str) -> String {
    gltf_json(&format!("\"uri\": \"{uri}\", "))
}

/// Returns a glTF file of the cube with sparse positions. Their accessor has no view, so elements
/// that it does not store are 0. It stores seven sparse elements with the indices 1 to 7, but not
/// the first corner, which is the origin.
pub(crate) fn gltf_sparse() -> String {
    let sparse = "\"sparse\": {\"count\": 7, \"indices\": {\"bufferView\": 2, \"componentType\": 5121}, \
                  \"values\": {\"bufferView\": 0, \"byteOffset\": 12}}, \"componentType\": 5126";
    let views = "\"byteLength\": 72}, {\"buffer\": 0, \"byteOffset\": 168, \"byteLength\": 7}]";
    let indices = base64(&[1, 2, 3, 4, 5, 6, 7, 0, 0]);
    gltf_text()
        .replace("\", \"byteLength\": 168", &format!("{indices}\", \"byteLength\": 177"))
        .replace("\"byteLength\": 72}]", views)
        .replace("\"bufferView\": 0, \"componentType\": 5126", sparse)
}

fn base64(bytes: &[u8]) -> String {
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    // All inputs have a length that is a multiple of 3, so base64 needs no padding.
    let groups = bytes.chunks_exact(3).flat_map(|group| {
        let [a, b, c] = [group[0], group[1], group[2]].map(usize::from);
        [a >> 2, (a & 3) << 4 | b >> 4, (b & 15) << 2 | c >> 6, c & 63]
    });
    groups.map(|digit| char::from(digits[digit])).collect()
}

pub(crate) fn glb() -> Vec<u8> {
    glb_with("{\"byteLength\": 168}", 168)
}

/// Returns a binary file of the cube with these buffers, and a binary chunk of `bytes` bytes.
pub(crate) fn glb_with(buffers: &str, bytes: usize) -> Vec<u8> {
    let mut json = gltf_json("").replace("{\"byteLength\": 168}", buffers).into_bytes();
    while !json.len().is_multiple_of(4) {
        json.push(b' ');
    }
    let mut buffer = gltf_buffer();
    buffer.resize(bytes, 0);
    let mut bytes = b"glTF".to_vec();
    let length = 12 + 8 + json.len() + 8 + buffer.len();
    for number in [2, length, json.len()] {
        bytes.extend(word(number));
    }
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend(word(buffer.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(buffer);
    bytes
}

/// Returns a number as four bytes, little-endian.
fn word(number: usize) -> [u8; 4] {
    u32::try_from(number).expect("a small file").to_le_bytes()
}
