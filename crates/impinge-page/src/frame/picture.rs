//! Draws the frames of a stage, and keeps state between them: meshes, the shapes of objects, the
//! origin.

use core::marker::PhantomData;

use impinge::bounding_volume::Aabb;
use impinge::debug_render::{DebugDrawing, DebugRender, Drawn, MeshOptions};
use impinge::math::{Point, Real, Vector};
use impinge::query::Proximity;
use impinge::shape::{ShapeHandle, ShapeKind};
use impinge::world::{CollisionObject, CollisionWorld};
use serde::Serialize;

use crate::EngineError;
use crate::answer::Frame;
use crate::ask::is_sensor;
use crate::frame::color::{LAYERS, Look, SELECTED, SENSOR, TOUCHES, options};
use crate::frame::framing::{Framing, bounds};
use crate::frame::gather::{Buffers, Gather, Instance, Sections};
use crate::frame::mesh::{MeshSections, MeshTable};
use crate::frame::payload::Payload;
use crate::frame::unit_shapes::UnitShapes;
use crate::request::FrameRequest;
use crate::space::{Viewed, coordinates};

/// The shape of an object in the last frame, and its mesh.
#[derive(Clone, Debug)]
struct KnownShape<N: Real, const D: usize> {
    shape: ShapeHandle<N, D>,
    kind: ShapeKind,
    mesh: u32,
    /// The scale of the instance; see [`Instance::scale`].
    scale: [f32; 3],
}

/// Draws the frames of one stage.
///
/// A frame contains every pose, since a comparison with the poses of the previous frame would cost
/// as much as writing all poses. Meshes are looked up only for objects with a new shape. The set of
/// touching objects is computed again only after a change of the world.
#[derive(Debug)]
pub(crate) struct Picture<N: Viewed<D>, const D: usize> {
    drawing: DebugDrawing<N, D>,
    units: UnitShapes<N, D>,
    meshes: MeshTable,
    /// The last shape for each index of a handle. The slot of a removed object keeps its shape
    /// until the index is reused.
    shapes: Vec<Option<KnownShape<N, D>>>,
    /// The origin and the size of the stage; `None` before the first object.
    framing: Option<Framing>,
    /// For each index of a handle, whether the object touches another object; `None` after a change
    /// of the world, until the next frame.
    touching: Option<Vec<bool>>,
}

/// The JSON text of a frame.
#[derive(Debug, Serialize)]
struct FrameText {
    origin: [f64; 3],
    meshes: Vec<MeshSections>,
    dropped: Vec<u32>,
    #[serde(flatten)]
    sections: Sections,
    layers: [&'static str; LAYERS.len()],
}

impl<N: Viewed<D>, const D: usize> Picture<N, D> {
    pub(crate) fn new() -> Self {
        Self {
            drawing: DebugDrawing::default(),
            units: UnitShapes::new(),
            meshes: MeshTable::default(),
            shapes: Vec::new(),
            framing: None,
            touching: None,
        }
    }

    /// Invalidates the state that depends on the contacts of the world.
    pub(crate) fn note_change(&mut self) {
        self.touching = None;
    }

    /// Draws a world, then calls `beside` with the drawing and the renderer, for additional
    /// elements such as queries.
    pub(crate) fn frame<T>(
        &mut self,
        world: &CollisionWorld<N, D, T>,
        asked: &FrameRequest,
        beside: impl FnOnce(&mut DebugDrawing<N, D>, &mut dyn DebugRender<N, D>),
    ) -> Result<Frame, EngineError> {
        // The mesh of half-spaces and the sizes of styles depend on the framing.
        let framing = self.framing(world);
        let is_shown = LAYERS.map(|(name, _)| asked.layers.iter().any(|layer| layer == name));
        self.set_options(&framing, &is_shown);
        let dropped = self.begin();
        let touching = self.touching.take().unwrap_or_else(|| touching(world));
        let Self { drawing, units, meshes, shapes, .. } = self;
        let mut gather = Gather {
            buffers: Buffers::default(),
            meshes,
            is_shown,
            origin: framing.origin,
            scalar: PhantomData,
        };
        // Objects become instances of meshes directly. The drawing has no style for them; it draws
        // all other layers.
        if is_shown[0] {
            let mut objects = Objects { drawing, units, shapes, touching: &touching, asked };
            objects.draw(world, &mut gather);
        }
        drawing.world(world, &mut gather);
        draw_selected(drawing, world, asked, &framing, &mut gather);
        beside(drawing, &mut gather);
        let buffers = gather.buffers;
        self.touching = Some(touching);

        // The meshes are written after all drawing, which may add new meshes.
        let mut payload = Payload::default();
        let text = FrameText {
            origin: framing.origin,
            meshes: self.meshes.write(asked.known, &mut payload),
            dropped,
            sections: buffers.write(&mut payload),
            layers: LAYERS.map(|(name, _)| name),
        };
        Ok(Frame { text: serde_json::to_string(&text)?, payload: payload.0 })
    }

    /// Begins a frame. Drops the meshes that were not used for a while and the entries of
    /// `shapes` that refer to them, and returns the ids of these meshes.
    fn begin(&mut self) -> Vec<u32> {
        let dropped = self.meshes.begin();
        if !dropped.is_empty() {
            for known in &mut self.shapes {
                let _ = known.take_if(|known| dropped.contains(&known.mesh));
            }
        }
        dropped
    }

    /// Returns the framing of the first frame with an object, since later frames must not change
    /// the origin of their coordinates. Before that, returns [`Framing::UNKNOWN`].
    fn framing<T>(&mut self, world: &CollisionWorld<N, D, T>) -> Framing {
        self.framing = self.framing.or_else(|| Framing::of(world));
        self.framing.unwrap_or(Framing::UNKNOWN)
    }

    fn set_options(&mut self, framing: &Framing, is_shown: &[bool; LAYERS.len()]) {
        let mesh =
            MeshOptions { half_space_extent: N::lit(framing.patch), ..MeshOptions::default() };
        self.drawing.set_options(options(mesh, N::lit(framing.size), is_shown));
    }

    /// Returns a box for the camera: the box around the bounded objects. If there are none, the box
    /// is centred at 0, and its edges are half as long as those of the squares (in 2D the lines) by
    /// which half-spaces are drawn.
    pub(crate) fn bounds<T>(&self, world: &CollisionWorld<N, D, T>) -> [[f64; 3]; 2] {
        if let Some(bounds) = bounds(world) {
            return [bounds.mins, bounds.maxs];
        }
        let half = self.framing.unwrap_or(Framing::UNKNOWN).patch / 2.0;
        let corner = coordinates(&Vector::<N, D>::repeat(N::lit(half)));
        [corner.map(|x| -x), corner]
    }
}

/// The data that drawing all objects needs.
struct Objects<'a, N: Viewed<D>, const D: usize> {
    drawing: &'a mut DebugDrawing<N, D>,
    units: &'a UnitShapes<N, D>,
    shapes: &'a mut Vec<Option<KnownShape<N, D>>>,
    touching: &'a [bool],
    asked: &'a FrameRequest,
}

impl<N: Viewed<D>, const D: usize> Objects<'_, N, D> {
    /// Adds an instance for each object.
    fn draw<T>(&mut self, world: &CollisionWorld<N, D, T>, gather: &mut Gather<'_, N, D>) {
        gather.reserve(world.len());
        for object in world.collision_objects() {
            let index = object.handle().uid();
            let flags = self.flags(index, object);
            let &KnownShape { mesh, scale, kind, .. } =
                self.known(index, object.shape(), gather.meshes);
            let color = Look { kind, object: index, flags }.color();
            let object_number = u32::try_from(index).unwrap_or(u32::MAX);
            let instance = Instance { mesh, scale, object: object_number, color, flags };
            gather.instance(instance, object.position());
        }
    }

    /// Returns the kind and the mesh of the shape of the object with this index. Both are computed
    /// only if the object has another shape than in the last frame.
    fn known(
        &mut self,
        index: usize,
        shape: &ShapeHandle<N, D>,
        meshes: &mut MeshTable,
    ) -> &KnownShape<N, D> {
        if self.shapes.len() <= index {
            self.shapes.resize(index + 1, None);
        }
        let Self { drawing, units, shapes, .. } = self;
        let slot = &mut shapes[index];
        // Shapes are compared by their addresses. For an equal shape at another address, the
        // look-up finds the same mesh.
        let _ = slot.take_if(|known| !known.shape.is_same(shape));
        slot.get_or_insert_with(|| {
            let (drawn, scale) = units.scaled(shape);
            let mesh = meshes.number(drawing.mesh(drawn));
            KnownShape { shape: shape.clone(), kind: shape.geometry().kind(), mesh, scale }
        })
    }

    fn flags<T>(&self, index: usize, object: &CollisionObject<N, D, T>) -> u32 {
        let touches = self.touching.get(index) == Some(&true);
        let is_selected = self.asked.selected.iter().any(|number| *number as usize == index);
        let flag = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
        flag(touches, TOUCHES) | flag(is_sensor(object), SENSOR) | flag(is_selected, SELECTED)
    }
}

/// Returns, for each index of a handle, whether the object has a contact or intersects another
/// object. The loop over all manifolds is slow, so the caller keeps the result until the world
/// changes.
fn touching<N: Viewed<D>, const D: usize, T>(world: &CollisionWorld<N, D, T>) -> Vec<bool> {
    let last = world.collision_objects().map(|object| object.handle().uid()).max();
    let mut touching = vec![false; last.map_or(0, |last| last + 1)];
    let mut mark = |object: &CollisionObject<N, D, T>| touching[object.handle().uid()] = true;
    for (one, two, _) in world.contact_views() {
        [one, two].into_iter().for_each(&mut mark);
    }
    for (one, two, pair) in world.proximity_pairs() {
        if pair.proximity() == Proximity::Intersecting {
            [one, two].into_iter().for_each(&mut mark);
        }
    }
    touching
}

/// Draws those boxes and contacts of the selected objects whose layers are invisible; the frame
/// contains the others already. Meanwhile the visibility of all layers is inverted, and the drawing
/// has the styles of all layers.
fn draw_selected<N: Viewed<D>, const D: usize, T>(
    drawing: &mut DebugDrawing<N, D>,
    world: &CollisionWorld<N, D, T>,
    asked: &FrameRequest,
    framing: &Framing,
    gather: &mut Gather<'_, N, D>,
) {
    if asked.selected.is_empty() {
        return;
    }
    let (before, own) = (gather.is_shown, *drawing.options());
    // The mesh options stay equal, since otherwise the drawing would discard its meshes.
    let all = options(own.mesh, N::lit(framing.size), &[true; LAYERS.len()]);
    gather.is_shown = before.map(|is_shown| !is_shown);
    drawing.set_options(all);
    let is_selected = |object: &&CollisionObject<N, D, T>| {
        asked.selected.iter().any(|number| *number as usize == object.handle().uid())
    };
    for object in world.collision_objects().filter(is_selected) {
        let tight = object.shape().aabb(&N::pose(object.position()));
        let boxes = [
            (Some(tight), Drawn::TightBox),
            (world.loosened_aabb(object.handle()), Drawn::LoosenedBox),
        ];
        for (aabb, what) in boxes {
            let style = if what == Drawn::TightBox { all.tight_box } else { all.loosened_box };
            if let (Some(aabb), Some(style)) = (aabb, style) {
                edges(&aabb).for_each(|ends| gather.line(ends, style.color, what));
            }
        }
        let contacts = world.contacts_with(object.handle()).map(|(_, point)| point.contact);
        drawing.contacts(contacts, gather);
    }
    drawing.set_options(own);
    gather.is_shown = before;
}

/// Returns the edges of a box as pairs of corners: for each axis the edges parallel to it, which
/// begin at the corners with the smaller coordinate.
fn edges<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> impl Iterator<Item = [Point<N, D>; 2]> {
    let [mins, maxs] = [*aabb.mins(), *aabb.maxs()];
    let corner = move |number: usize| {
        let at = |axis, _| if number >> axis & 1 == 0 { mins[axis] } else { maxs[axis] };
        Point::from(Vector::<N, D>::from_fn(at))
    };
    let starts = |axis: usize| (0..1_usize << D).filter(move |start| start >> axis & 1 == 0);
    (0..D).flat_map(move |axis| {
        starts(axis).map(move |start| [corner(start), corner(start | 1 << axis)])
    })
}
