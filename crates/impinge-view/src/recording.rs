//! A drawing, in the order of its calls.

use crate::kept_mesh::KeptMesh;
use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::dim3::math::{Matrix, Point, Vector};
use impinge::math::{self, Real, Space};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// The elements of a drawing in `f64` and 3D. Elements of a 2D drawing have `z = 0`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recording {
    pub(crate) meshes: BTreeMap<u64, KeptMesh>,
    pub(crate) placed: Vec<PlacedMesh>,
    pub(crate) strokes: Vec<Stroke>,
    pub(crate) triangles: Vec<ColoredTriangle>,
    pub(crate) dots: Vec<Dot>,
    pub(crate) labels: Vec<Label>,
    /// The number of omitted lines, triangles, points, texts and meshes.
    pub(crate) left_out: u64,
}

/// The id of a kept mesh, and the pose, colour and layer with which it is drawn.
#[derive(Clone, Debug)]
pub(crate) struct PlacedMesh {
    pub(crate) id: u64,
    pub(crate) rotation: Matrix<f64>,
    pub(crate) translation: Vector<f64>,
    pub(crate) color: Color,
    pub(crate) what: Drawn,
}

/// A line segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    pub(crate) ends: [Point<f64>; 2],
    pub(crate) color: Color,
    pub(crate) what: Drawn,
}

/// A filled triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColoredTriangle {
    pub(crate) corners: [Point<f64>; 3],
    pub(crate) color: Color,
    pub(crate) what: Drawn,
}

/// A point, drawn as a disc of diameter `size`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dot {
    pub(crate) at: Point<f64>,
    pub(crate) size: f64,
    pub(crate) color: Color,
    pub(crate) what: Drawn,
}

/// A text beside a point.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub(crate) at: Point<f64>,
    pub(crate) text: String,
    pub(crate) color: Color,
    pub(crate) what: Drawn,
}

/// The largest magnitude of a coordinate. The cube of this number is far below the largest `f64`.
/// In metres it is more than the diameter of the orbit of Neptune.
pub(crate) const MAX_COORDINATE: f64 = 1e13;

/// Converts a point to 3D; `None` if a coordinate is NaN or exceeds [`MAX_COORDINATE`].
pub(crate) fn embed<N: Real, const D: usize>(point: &math::Point<N, D>) -> Option<Point<f64>> {
    let embedded = Point::from(embed_vector(&point.coords));
    let is_good = embedded.iter().all(|x| x.abs() <= MAX_COORDINATE);
    is_good.then_some(embedded)
}

fn embed_vector<N: Real, const D: usize>(v: &math::Vector<N, D>) -> Vector<f64> {
    let mut embedded = Vector::zeros();
    for (to, from) in embedded.iter_mut().zip(v.iter()) {
        *to = from.as_f64();
    }
    embedded
}

fn embed_all<N: Real, const D: usize, const K: usize>(
    points: &[math::Point<N, D>; K],
) -> Option<[Point<f64>; K]> {
    let mut embedded = [Point::origin(); K];
    for (to, from) in embedded.iter_mut().zip(points) {
        *to = embed(from)?;
    }
    Some(embedded)
}

impl Recording {
    /// Removes all elements and resets the counter, but keeps the meshes.
    pub(crate) fn clear(&mut self) {
        *self = Self { meshes: std::mem::take(&mut self.meshes), ..Self::default() };
    }

    /// Returns all points that a camera frames by default.
    pub(crate) fn points(&self) -> Vec<Point<f64>> {
        let mut points: Vec<_> = self.strokes.iter().flat_map(|stroke| stroke.ends).collect();
        points.extend(self.triangles.iter().flat_map(|triangle| triangle.corners));
        points.extend(self.labels.iter().map(|label| label.at));
        points.extend(self.dots.iter().map(|dot| dot.at));
        for placed in &self.placed {
            let Some(kept) = self.meshes.get(&placed.id) else { continue };
            let vertices = placed.vertices(kept);
            let lines = kept.lines.iter().flatten();
            let used = lines.chain(kept.triangles.iter().flatten());
            points.extend(used.map(|index| vertices[*index]));
        }
        points
    }

    /// Returns the layers that the drawing uses, in the order of [`Drawn`] and without duplicates.
    pub(crate) fn layers(&self) -> Vec<Drawn> {
        let strokes = self.strokes.iter().map(|stroke| stroke.what);
        let triangles = self.triangles.iter().map(|triangle| triangle.what);
        let dots = self.dots.iter().map(|dot| dot.what);
        let labels = self.labels.iter().map(|label| label.what);
        let placed = self.placed.iter().map(|placed| placed.what);
        let all = strokes.chain(triangles).chain(dots).chain(labels).chain(placed);
        let unique: std::collections::BTreeSet<_> = all.collect();
        unique.into_iter().collect()
    }

    /// Returns the colour of a layer's first mesh; if it has none, of its first point, triangle,
    /// line or text, in this order. `None` if the layer is empty.
    pub(crate) fn color_of(&self, layer: Drawn) -> Option<Color> {
        let placed = self.placed.iter().map(|placed| (placed.what, placed.color));
        let dots = self.dots.iter().map(|dot| (dot.what, dot.color));
        let triangles = self.triangles.iter().map(|triangle| (triangle.what, triangle.color));
        let strokes = self.strokes.iter().map(|stroke| (stroke.what, stroke.color));
        let labels = self.labels.iter().map(|label| (label.what, label.color));
        let mut all = placed.chain(dots).chain(triangles).chain(strokes).chain(labels);
        all.find(|(what, _)| *what == layer).map(|(_, color)| color)
    }

    /// Stores a mesh unless one with the same id is stored, and returns the stored mesh.
    fn keep<N: Real, const D: usize>(&mut self, mesh: &ShapeMesh<N, D>) -> &KeptMesh {
        match self.meshes.entry(mesh.id) {
            Entry::Occupied(kept) => kept.into_mut(),
            Entry::Vacant(none) => none.insert(KeptMesh::new(mesh)),
        }
    }
}

impl PlacedMesh {
    /// Returns the vertices of the mesh in the world frame.
    pub(crate) fn vertices(&self, kept: &KeptMesh) -> Vec<Point<f64>> {
        kept.vertices.iter().map(|vertex| self.rotation * vertex + self.translation).collect()
    }
}

impl<N: Space<D>, const D: usize> DebugRender<N, D> for Recording {
    fn line(&mut self, ends: [math::Point<N, D>; 2], color: Color, what: Drawn) {
        match embed_all(&ends) {
            Some(ends) => self.strokes.push(Stroke { ends, color, what }),
            None => self.left_out += 1,
        }
    }

    fn point(&mut self, at: &math::Point<N, D>, size: N, color: Color, what: Drawn) {
        let size = size.as_f64();
        match embed(at) {
            Some(at) if (0.0..=MAX_COORDINATE).contains(&size) => {
                self.dots.push(Dot { at, size, color, what });
            }
            _ => self.left_out += 1,
        }
    }

    fn text(&mut self, at: &math::Point<N, D>, text: &str, color: Color, what: Drawn) {
        match embed(at) {
            Some(at) => self.labels.push(Label { at, text: text.to_owned(), color, what }),
            None => self.left_out += 1,
        }
    }

    fn triangle(&mut self, corners: [math::Point<N, D>; 3], color: Color, what: Drawn) {
        match embed_all(&corners) {
            Some(corners) => self.triangles.push(ColoredTriangle { corners, color, what }),
            None => self.left_out += 1,
        }
    }

    fn mesh(&mut self, mesh: &ShapeMesh<N, D>, pose: &N::Isometry, color: Color, what: Drawn) {
        let left_out = self.keep(mesh).left_out;
        let pose = N::pose(pose);
        let translation = embed_vector(&pose.translation);
        let mut rotation = Matrix::identity();
        for axis in 0..D {
            let column = pose.rotation.column(axis).into_owned();
            rotation.set_column(axis, &embed_vector(&column));
        }
        let numbers = rotation.iter().chain(&translation);
        if numbers.into_iter().all(|x| x.abs() <= MAX_COORDINATE) {
            self.left_out += left_out;
            self.placed.push(PlacedMesh { id: mesh.id, rotation, translation, color, what });
        } else {
            self.left_out += 1;
        }
    }
}
