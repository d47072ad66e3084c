//! Converts kept meshes to lines and faces in the world frame.

use crate::kept_mesh::{KeptMesh, unit};
use crate::lens::Lens;
use crate::recording::{ColoredTriangle, PlacedMesh, Recording, Stroke};
use crate::shade::edge_tone;
use impinge::debug_render::{Color, Drawn};
use impinge::dim3::math::{Point, Vector};

/// The lines and faces of a drawing, in the world frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Flat {
    pub(crate) strokes: Vec<Stroke>,
    pub(crate) faces: Vec<Face>,
}

/// A triangle in the world frame, with normals in the camera's frame that point to the visible
/// side.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(crate) corners: [Point<f64>; 3],
    pub(crate) normals: [Vector<f64>; 3],
    pub(crate) color: Color,
    pub(crate) what: Drawn,
    /// Whether the face is a single triangle and not a part of a mesh. The sides of single
    /// triangles are not in [`Flat::strokes`].
    pub(crate) is_alone: bool,
}

/// Returns the lines and faces of a recording. The lines include the edges of meshes in a darker
/// tone, and the silhouettes of their surfaces as seen through `lens`.
pub(crate) fn flatten(recording: &Recording, lens: &Lens) -> Flat {
    let mut flat = Flat::default();
    for placed in &recording.placed {
        if let Some(kept) = recording.meshes.get(&placed.id) {
            flatten_mesh(kept, placed, lens, &mut flat);
        }
    }
    flat.strokes.extend(&recording.strokes);
    flat.faces.extend(recording.triangles.iter().map(|triangle| face_of(triangle, lens)));
    flat
}

fn flatten_mesh(kept: &KeptMesh, placed: &PlacedMesh, lens: &Lens, flat: &mut Flat) {
    let vertices = placed.vertices(kept);
    let edge = edge_color(placed.color);
    let stroke = |ends: &[usize; 2]| Stroke {
        ends: ends.map(|index| vertices[index]),
        color: edge,
        what: placed.what,
    };
    flat.strokes.extend(kept.lines.iter().map(stroke));
    let mut is_front = Vec::with_capacity(kept.triangles.len());
    for (index, indices) in kept.triangles.iter().enumerate() {
        let corners = indices.map(|index| vertices[index]);
        let normal = placed.rotation * kept.normal(index);
        let front = lens.faces(&normal, &corners[0]);
        let side = if front { 1.0 } else { -1.0 };
        let normals = kept.normals[index].map(|n| lens.turned(&(placed.rotation * n)) * side);
        is_front.push(front);
        let (color, what) = (placed.color, placed.what);
        flat.faces.push(Face { corners, normals, color, what, is_alone: false });
    }
    let outline = kept.hinges.iter().filter(|hinge| {
        let [first, second] = hinge.triangles;
        is_front[first] != is_front[second]
    });
    flat.strokes.extend(outline.map(|hinge| stroke(&hinge.ends)));
}

fn face_of(triangle: &ColoredTriangle, lens: &Lens) -> Face {
    let [a, b, c] = triangle.corners;
    let normal = (b - a).cross(&(c - a));
    let side = if lens.faces(&normal, &a) { 1.0 } else { -1.0 };
    let normals = [lens.turned(&unit(&normal)) * side; 3];
    let (corners, color, what) = (triangle.corners, triangle.color, triangle.what);
    Face { corners, normals, color, what, is_alone: true }
}

/// Returns the colour of the edges of a face of this colour: a darker tone, and more opaque unless
/// the face is invisible.
pub(crate) fn edge_color(color: Color) -> Color {
    let alpha = if color.alpha == 0 { 0 } else { color.alpha / 2 + 128 };
    Color { rgb: edge_tone(color.rgb), alpha }
}
