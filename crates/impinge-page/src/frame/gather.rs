//! A back end of debug drawing that fills the buffers of a frame. The buffers are structures of
//! arrays, which the page uploads unchanged.

use core::marker::PhantomData;

use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::math::{Point, Vector};
use serde::Serialize;

use crate::frame::color::{ASKED, LAYERS, layer_of, word};
use crate::frame::framing::FAR;
use crate::frame::mesh::{MeshTable, single};
use crate::frame::payload::{Payload, Section};
use crate::frame::unit_shapes::UNSCALED;
use crate::space::{Viewed, coordinates};

/// The object index of an instance that is not an object of the world.
const NO_OBJECT: u32 = u32::MAX;

/// The maximum number of texts in a frame; more would not be legible.
const MAX_LABELS: usize = 200;

/// A text in a frame.
#[derive(Debug, Serialize)]
struct Label {
    at: [f32; 3],
    text: String,
    color: u32,
    layer: u32,
}

/// Lines, triangles or points: their coordinates, and a colour and a layer for each element.
#[derive(Debug, Default)]
struct Things {
    numbers: Vec<f32>,
    /// The sizes of points; empty for lines and triangles.
    sizes: Vec<f32>,
    colors: Vec<u32>,
    layers: Vec<u32>,
}

impl Things {
    fn push(&mut self, numbers: &[f32], color: Color, layer: u32) {
        self.numbers.extend(numbers);
        self.colors.push(word(color));
        self.layers.push(layer);
    }
}

/// The instances of a frame, as a structure of arrays.
#[derive(Debug, Default)]
struct Instances {
    mesh: Vec<u32>,
    object: Vec<u32>,
    color: Vec<u32>,
    pose: Vec<f32>,
    scale: Vec<f32>,
    flags: Vec<u32>,
}

/// An instance of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instance {
    pub(crate) mesh: u32,
    /// The scale factors along the axes of the mesh, applied before the pose.
    pub(crate) scale: [f32; 3],
    pub(crate) object: u32,
    pub(crate) color: u32,
    pub(crate) flags: u32,
}

/// The content of a frame; positions are relative to its origin.
#[derive(Debug, Default)]
pub(crate) struct Buffers {
    instances: Instances,
    lines: Things,
    triangles: Things,
    points: Things,
    labels: Vec<Label>,
}

/// The back end. It fills the buffers with the elements of visible layers.
#[derive(Debug)]
pub(crate) struct Gather<'a, N, const D: usize> {
    pub(crate) buffers: Buffers,
    pub(crate) meshes: &'a mut MeshTable,
    pub(crate) is_shown: [bool; LAYERS.len()],
    pub(crate) origin: [f64; 3],
    pub(crate) scalar: PhantomData<N>,
}

impl<N: Viewed<D>, const D: usize> Gather<'_, N, D> {
    /// Returns the index of a layer; `None` if the layer is invisible.
    fn layer(&self, what: Drawn) -> Option<u32> {
        let layer = layer_of(what);
        self.is_shown[layer].then(|| u32::try_from(layer).unwrap_or(0))
    }

    /// Returns a point relative to the origin. The difference is computed in `f64`, so that a scene
    /// far from 0 loses no precision.
    fn relative(&self, point: [f64; 3]) -> [f32; 3] {
        [0, 1, 2].map(|axis| single(point[axis] - self.origin[axis]))
    }

    fn at(&self, point: &Point<N, D>) -> [f32; 3] {
        self.relative(coordinates(&point.coords))
    }

    /// Reserves space for `count` more instances, so that adding them does not reallocate.
    pub(crate) fn reserve(&mut self, count: usize) {
        let Instances { mesh, object, color, pose, scale, flags } = &mut self.buffers.instances;
        for words in [mesh, object, color, flags] {
            words.reserve(count);
        }
        pose.reserve(7 * count);
        scale.reserve(3 * count);
    }

    /// Adds an instance of a mesh at a position. Adds nothing if the mesh was dropped.
    pub(crate) fn instance(&mut self, instance: Instance, position: &N::Isometry) {
        let Some(center) = self.meshes.keep(instance.mesh) else { return };
        let mut translation = coordinates(&N::translation(position));
        // Only unscaled meshes have a centre other than the origin of the shape.
        if center != [0.0; 3] {
            // The centre is rotated with the shape, then added to its translation.
            let center =
                N::pose(position).vector(&Vector::<N, D>::from_fn(|axis, _| N::lit(center[axis])));
            let turned = coordinates(&center);
            translation = [0, 1, 2].map(|axis| translation[axis] + turned[axis]);
        }
        let (at, turn) = (self.relative(translation), N::quaternion(position).map(single));
        let Instances { mesh, object, color, pose, scale, flags } = &mut self.buffers.instances;
        mesh.push(instance.mesh);
        object.push(instance.object);
        color.push(instance.color);
        flags.push(instance.flags);
        scale.extend_from_slice(&instance.scale);
        pose.extend_from_slice(&at);
        pose.extend_from_slice(&turn);
    }
}

/// Returns `true` if a coordinate is NaN or beyond [`FAR`].
fn is_nowhere<const COUNT: usize>(numbers: &[[f32; 3]; COUNT]) -> bool {
    !numbers.as_flattened().iter().all(|x| f64::from(x.abs()) <= FAR)
}

impl<N: Viewed<D>, const D: usize> DebugRender<N, D> for Gather<'_, N, D> {
    fn line(&mut self, ends: [Point<N, D>; 2], color: Color, what: Drawn) {
        // The lines of an invisible layer are not even converted.
        let Some(layer) = self.layer(what) else { return };
        let ends = ends.map(|end| self.at(&end));
        if !is_nowhere(&ends) {
            self.buffers.lines.push(ends.as_flattened(), color, layer);
        }
    }

    fn point(&mut self, at: &Point<N, D>, size: N, color: Color, what: Drawn) {
        let Some(layer) = self.layer(what) else { return };
        let at = self.at(at);
        if !is_nowhere(&[at]) {
            self.buffers.points.push(&at, color, layer);
            self.buffers.points.sizes.push(single(size.as_f64()));
        }
    }

    fn text(&mut self, at: &Point<N, D>, text: &str, color: Color, what: Drawn) {
        let Some(layer) = self.layer(what) else { return };
        let at = self.at(at);
        if !is_nowhere(&[at]) && self.buffers.labels.len() < MAX_LABELS {
            let (text, color) = (text.to_owned(), word(color));
            self.buffers.labels.push(Label { at, text, color, layer });
        }
    }

    fn triangle(&mut self, corners: [Point<N, D>; 3], color: Color, what: Drawn) {
        let Some(layer) = self.layer(what) else { return };
        let corners = corners.map(|corner| self.at(&corner));
        if !is_nowhere(&corners) {
            self.buffers.triangles.push(corners.as_flattened(), color, layer);
        }
    }

    fn mesh(&mut self, mesh: &ShapeMesh<N, D>, pose: &N::Isometry, color: Color, what: Drawn) {
        if self.layer(what).is_none() {
            return;
        }
        let mesh = self.meshes.number(mesh);
        // The shape of a query is transparent, so that it hides no object.
        let color = word(color.with_alpha(color.alpha.min(96)));
        let (scale, object, flags) = (UNSCALED, NO_OBJECT, ASKED);
        self.instance(Instance { mesh, scale, object, color, flags }, pose);
    }
}

/// The sections of the instances in a payload.
#[derive(Debug, Serialize)]
struct InstanceSections {
    count: usize,
    mesh: Section,
    object: Section,
    color: Section,
    pose: Section,
    scale: Section,
    flags: Section,
}

#[derive(Debug, Serialize)]
struct LineSections {
    count: usize,
    ends: Section,
    color: Section,
    layer: Section,
}

#[derive(Debug, Serialize)]
struct TriangleSections {
    count: usize,
    corners: Section,
    color: Section,
    layer: Section,
}

#[derive(Debug, Serialize)]
struct PointSections {
    count: usize,
    at: Section,
    size: Section,
    color: Section,
    layer: Section,
}

/// The sections of all buffers in a payload, and the texts of a frame.
#[derive(Debug, Serialize)]
pub(crate) struct Sections {
    instances: InstanceSections,
    lines: LineSections,
    triangles: TriangleSections,
    points: PointSections,
    labels: Vec<Label>,
}

impl Buffers {
    /// Writes all buffers to the payload and returns their sections.
    pub(crate) fn write(self, payload: &mut Payload) -> Sections {
        let Self { instances, lines, triangles, points, labels } = self;
        Sections {
            instances: InstanceSections {
                count: instances.mesh.len(),
                mesh: payload.words(&instances.mesh),
                object: payload.words(&instances.object),
                color: payload.words(&instances.color),
                pose: payload.floats(&instances.pose),
                scale: payload.floats(&instances.scale),
                flags: payload.words(&instances.flags),
            },
            lines: LineSections {
                count: lines.colors.len(),
                ends: payload.floats(&lines.numbers),
                color: payload.words(&lines.colors),
                layer: payload.words(&lines.layers),
            },
            triangles: TriangleSections {
                count: triangles.colors.len(),
                corners: payload.floats(&triangles.numbers),
                color: payload.words(&triangles.colors),
                layer: payload.words(&triangles.layers),
            },
            points: PointSections {
                count: points.colors.len(),
                at: payload.floats(&points.numbers),
                size: payload.floats(&points.sizes),
                color: payload.words(&points.colors),
                layer: payload.words(&points.layers),
            },
            labels,
        }
    }
}
