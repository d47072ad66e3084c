//! A back end of debug drawing that fills buffers.

use core::marker::PhantomData;

use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::math::{Point, Vector};
use serde::Serialize;

use crate::color::{ASKED, LAYERS, layer_of, word};
use crate::explain::short;
use crate::mesh::{MeshTable, single};
use crate::payload::{Payload, Section};
use crate::space::{Viewed, coordinates};

/// The number of an instance that is no object.
const NO_OBJECT: u32 = u32::MAX;

/// Lines that go farther are left out.
const FAR: f32 = 1e18;

/// So many texts at most are legible.
const MAX_LABELS: usize = 200;

/// A text in a frame.
#[derive(Debug, Serialize)]
struct Label {
    at: [f32; 3],
    text: String,
    color: u32,
    layer: u32,
}

/// Numbers, one after another for each thing that is drawn.
#[derive(Debug, Default)]
struct Things {
    numbers: Vec<f32>,
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

/// Shapes by mesh and pose.
#[derive(Debug, Default)]
struct Instances {
    mesh: Vec<u32>,
    object: Vec<u32>,
    color: Vec<u32>,
    pose: Vec<f32>,
    flags: Vec<u32>,
}

/// An instance of a mesh that is to be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instance {
    pub(crate) mesh: u32,
    pub(crate) object: u32,
    pub(crate) color: u32,
    pub(crate) flags: u32,
}

/// All that a frame draws, relative to an origin.
#[derive(Debug, Default)]
pub(crate) struct Buffers {
    instances: Instances,
    lines: Things,
    triangles: Things,
    points: Things,
    labels: Vec<Label>,
}

/// The back end: fills buffers with what belongs to a layer that is shown.
#[derive(Debug)]
pub(crate) struct Gather<'a, N, const D: usize> {
    pub(crate) buffers: Buffers,
    pub(crate) meshes: &'a mut MeshTable,
    pub(crate) is_shown: [bool; LAYERS.len()],
    pub(crate) origin: [f64; 3],
    pub(crate) scalar: PhantomData<N>,
}

impl<N: Viewed<D>, const D: usize> Gather<'_, N, D> {
    /// The layer, if it is shown.
    fn layer(&self, what: Drawn) -> Option<u32> {
        let layer = layer_of(what);
        self.is_shown[layer].then(|| u32::try_from(layer).unwrap_or(0))
    }

    /// Relative to the origin.
    fn relative(&self, point: [f64; 3]) -> [f32; 3] {
        [0, 1, 2].map(|axis| single(point[axis] - self.origin[axis]))
    }

    fn at(&self, point: &Point<N, D>) -> [f32; 3] {
        self.relative(coordinates(&point.coords))
    }

    /// Puts a mesh at a position.
    pub(crate) fn instance(&mut self, instance: Instance, position: &N::Isometry) {
        let Some(center) = self.meshes.place(instance.mesh) else { return };
        let mut translation = coordinates(&N::translation(position));
        if center != [0.0; 3] {
            let center =
                N::pose(position).vector(&Vector::<N, D>::from_fn(|axis, _| N::lit(center[axis])));
            let turned = coordinates(&center);
            translation = [0, 1, 2].map(|axis| translation[axis] + turned[axis]);
        }
        let (at, turn) = (self.relative(translation), N::quaternion(position).map(single));
        let Instances { mesh, object, color, pose, flags } = &mut self.buffers.instances;
        mesh.push(instance.mesh);
        object.push(instance.object);
        color.push(instance.color);
        flags.push(instance.flags);
        pose.extend_from_slice(&at);
        pose.extend_from_slice(&turn);
    }
}

/// Some coordinate is NaN, or so large that nothing can be computed with it.
fn is_nowhere<const COUNT: usize>(numbers: &[[f32; 3]; COUNT]) -> bool {
    !numbers.as_flattened().iter().all(|x| x.abs() <= FAR)
}

impl<N: Viewed<D>, const D: usize> DebugRender<N, D> for Gather<'_, N, D> {
    fn line(&mut self, ends: [Point<N, D>; 2], color: Color, what: Drawn) {
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
            // Numbers come with all their digits.
            let text = text.parse().map_or_else(|_| text.to_owned(), short);
            self.buffers.labels.push(Label { at, text, color: word(color), layer });
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
        // What a query asks about hides nothing.
        let color = word(color.with_alpha(color.alpha.min(96)));
        self.instance(Instance { mesh, object: NO_OBJECT, color, flags: ASKED }, pose);
    }
}

/// Sections of instances.
#[derive(Debug, Serialize)]
struct InstanceSections {
    count: usize,
    mesh: Section,
    object: Section,
    color: Section,
    pose: Section,
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

/// Where everything is in a payload, and the texts.
#[derive(Debug, Serialize)]
pub(crate) struct Sections {
    instances: InstanceSections,
    lines: LineSections,
    triangles: TriangleSections,
    points: PointSections,
    labels: Vec<Label>,
}

impl Buffers {
    /// Writes everything.
    pub(crate) fn write(self, payload: &mut Payload) -> Sections {
        let Self { instances, lines, triangles, points, labels } = self;
        Sections {
            instances: InstanceSections {
                count: instances.mesh.len(),
                mesh: payload.words(&instances.mesh),
                object: payload.words(&instances.object),
                color: payload.words(&instances.color),
                pose: payload.floats(&instances.pose),
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
