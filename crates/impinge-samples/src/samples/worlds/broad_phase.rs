//! The boxes and the tree of the broad phase.

use impinge::debug_render::{DebugDrawing, DebugOptions};
use impinge_scenes::few_moving;

use crate::prelude::*;
use crate::scene::Play;

/// Boxes, one in a hundred of which moves.
#[derive(Debug, Default)]
pub(crate) struct BroadPhase<const D: usize> {
    /// The scene with the boxes.
    play: Play<D>,
}

impl<const D: usize> Sample<D> for BroadPhase<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .number("count", "Objects", 200.0, [10.0, 1000.0, 10.0])
            .flag("tree", "Nodes of the tree", true)
            .flag("loosened", "Loosened boxes", true)
    }

    /// Returns a margin that is large enough to be visible. The loosened box (the fat AABB) of an
    /// object stays while it contains the object.
    fn margin(&self) -> f32 {
        0.15
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.play = Play::start(few_moving(panel.count("count")), world)?;
        Ok(())
    }

    /// Rebuilds the scene if the count has changed. The flags are read in `draw`.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        if world.len() == panel.count("count") {
            return Ok(());
        }
        self.rebuild(world, panel)
    }

    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.play.advance(world)
    }

    /// Draws the loosened boxes of the objects and the boxes of the tree nodes, as the flags say.
    fn draw(&self, world: &World<D>, panel: &Panel, canvas: &mut Canvas<'_, D>) {
        let DebugOptions { tree_node, loosened_box, .. } = DebugOptions::all();
        let options = DebugOptions {
            tree_node: tree_node.filter(|_| panel.is_set("tree")),
            loosened_box: loosened_box.filter(|_| panel.is_set("loosened")),
            ..DebugOptions::none()
        };
        DebugDrawing::new(options).world(world, canvas.renderer);
    }

    /// Returns the number of all pairs of objects, and the number of pairs that the broad phase
    /// passes to the narrow phase.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let all = world.len() * world.len().saturating_sub(1) / 2;
        vec![
            Readout::new("Pairs of objects", all),
            Readout::new("Pairs whose boxes overlap", world.contact_pairs().count()),
        ]
    }
}
