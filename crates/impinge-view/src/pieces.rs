//! Converts a drawing to triangles on the screen, and draws the triangles.

use crate::flatten::{Face, Flat};
use crate::layer::Layer;
use crate::lens::{OnScreen, View, larger};
use crate::raster::{Ink, Raster, ribbon};
use crate::recording::{Dot, Stroke};
use crate::shade::shaded;
use impinge::debug_render::{Color, Drawn};
use impinge::dim3::math::{Real, Vector};

/// Triangles on the screen with one colour, shaded if they have normals.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    triangles: Vec<[OnScreen; 3]>,
    /// The normals at the corners, in the camera's frame; `None` for an unshaded piece.
    normals: Option<[Vector<f64>; 3]>,
    color: Color,
    shows_through: bool,
    /// The mean depth of the corners, by which transparent pieces are sorted.
    depth: f64,
}

/// The bias for lines: they are moved towards the viewer by this many pixels, so that the faces on
/// which they lie do not hide them.
pub(crate) const LINE_BIAS: f64 = 2.0;
/// The bias for faces of layers other than objects, in pixels.
const FACE_BIAS: f64 = 1.0;
/// The bias for points, in pixels.
const DOT_BIAS: f64 = 4.0;
/// The colour of the rim that separates points from the background.
const RIM: Color = Color::rgb(255, 255, 255);
/// The number of corners of the disc of a point.
const DOT_CORNERS: u8 = 24;

/// The minimum radius of points, in pixels.
pub(crate) const MIN_DOT_RADIUS: f64 = 2.5;

/// Returns the pieces of faces, then of lines, then of points. Widths and biases in pixels are
/// multiplied by `samples`, the number of samples per pixel along a side.
pub(crate) fn pieces(flat: &Flat, dots: &[Dot], view: &View, samples: f64) -> Vec<Piece> {
    let faces = flat.faces.iter().filter_map(|face| face_piece(face, view, samples));
    let strokes = flat.strokes.iter().filter_map(|stroke| stroke_piece(stroke, view, samples));
    let dots = dots.iter().flat_map(|dot| dot_pieces(dot, view, samples));
    faces.chain(strokes).chain(dots).collect()
}

/// Draws the opaque pieces in their order, then the transparent pieces from far to near. Finally,
/// draws the hidden parts of pieces that show through, with a third of their alpha.
pub(crate) fn draw(pieces: &[Piece], raster: &mut Raster) {
    let (opaque, mut transparent): (Vec<_>, Vec<_>) =
        pieces.iter().partition(|piece| piece.color.alpha == u8::MAX);
    transparent.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    for piece in opaque {
        piece.draw(raster, Ink::Solid);
    }
    for piece in transparent {
        piece.draw(raster, Ink::Blend(piece.color.alpha));
    }
    for piece in pieces.iter().filter(|piece| piece.shows_through) {
        piece.draw(raster, Ink::Ghost(piece.color.alpha / 3));
    }
}

impl Piece {
    fn draw(&self, raster: &mut Raster, ink: Ink) {
        for triangle in &self.triangles {
            match &self.normals {
                Some(normals) => {
                    raster
                        .fill(triangle, ink, |weights| shade_at(self.color.rgb, normals, weights));
                }
                None => raster.fill(triangle, ink, |_| self.color.rgb),
            }
        }
    }
}

fn shade_at(rgb: [u8; 3], normals: &[Vector<f64>; 3], weights: &[f64; 3]) -> [u8; 3] {
    let [a, b, c] = normals;
    let sum = a * weights[0] + b * weights[1] + c * weights[2];
    let norm = sum.norm();
    shaded(rgb, &(if norm > 0.0 { sum / norm } else { sum }))
}

fn face_piece(face: &Face, view: &View, samples: f64) -> Option<Piece> {
    let bias = if face.what == Drawn::Object { 0.0 } else { FACE_BIAS * samples };
    let corners = view.triangle(&face.corners, bias);
    let (triangles, normals) = match corners[..] {
        [a, b, c] if is_whole(face, view) => (vec![[a, b, c]], face.normals),
        [a, b, c] => (vec![[a, b, c]], mean_normals(face)),
        [a, b, c, d] => (vec![[a, b, c], [a, c, d]], mean_normals(face)),
        _ => return None,
    };
    let depth = corners.iter().map(|corner| corner.depth).sum::<f64>() / corners.len() as f64;
    let shows_through = face.color.alpha < u8::MAX && Layer::of(face.what).shows_through;
    Some(Piece { triangles, normals: Some(normals), color: face.color, shows_through, depth })
}

/// Returns `true` if the near plane does not clip a face. The projected polygon then has the
/// corners of the face.
fn is_whole(face: &Face, view: &View) -> bool {
    face.corners.iter().all(|corner| view.point(corner, 0.0).is_some())
}

fn mean_normals(face: &Face) -> [Vector<f64>; 3] {
    let [a, b, c] = face.normals;
    [(a + b + c) / 3.0; 3]
}

fn stroke_piece(stroke: &Stroke, view: &View, samples: f64) -> Option<Piece> {
    let layer = Layer::of(stroke.what);
    let ends = view.line(&stroke.ends, LINE_BIAS * samples)?;
    let triangles = ribbon(&ends, layer.width * samples).to_vec();
    let depth = (ends[0].depth + ends[1].depth) * 0.5;
    let (color, shows_through) = (stroke.color, layer.shows_through);
    Some(Piece { triangles, normals: None, color, shows_through, depth })
}

/// Returns the pieces of a point: its rim and its disc. Empty if the point is nearer than the near
/// plane.
fn dot_pieces(dot: &Dot, view: &View, samples: f64) -> Vec<Piece> {
    let Some(center) = view.point(&dot.at, DOT_BIAS * samples) else { return Vec::new() };
    let radius = larger(view.pixels(dot.size, &dot.at) * 0.5, MIN_DOT_RADIUS * samples);
    let disc = |radius: f64, color: Color, shows_through: bool| Piece {
        triangles: disc(center, radius),
        normals: None,
        color,
        shows_through,
        depth: center.depth,
    };
    let rim = disc(radius + 0.8 * samples, RIM.with_alpha(dot.color.alpha), false);
    vec![rim, disc(radius, dot.color, Layer::of(dot.what).shows_through)]
}

fn disc(center: OnScreen, radius: f64) -> Vec<[OnScreen; 3]> {
    let corner = |index: u8| {
        let angle =
            f64::from(index % DOT_CORNERS) * (std::f64::consts::TAU / f64::from(DOT_CORNERS));
        let (sine, cosine) = angle.sine_cosine();
        OnScreen { x: center.x + radius * cosine, y: center.y + radius * sine, ..center }
    };
    (0..DOT_CORNERS).map(|index| [center, corner(index), corner(index + 1)]).collect()
}
