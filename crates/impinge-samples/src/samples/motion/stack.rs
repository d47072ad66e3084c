//! A stack of boxes.

use crate::bodies::Bodies;
use crate::prelude::*;

/// A stack of boxes of size 1. At the start there is a gap of 0.005 below each box.
#[derive(Debug, Default)]
pub(crate) struct Stack<const D: usize> {
    /// The bodies of the boxes.
    bodies: Bodies<D>,
    /// The top box, which the button pushes.
    top: Option<CollisionObjectHandle>,
}

impl<const D: usize> Sample<D> for Stack<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .number("count", "Boxes", 8.0, [1.0, 20.0, 1.0])
            .number("shift", "Shift of each to the side", 0.02, [0.0, 0.2, 0.005])
            .button("push", "Push the top box")
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
        // The floor is a half-space, so it has no edge from which boxes could fall.
        let floor = ShapeHandle::new(Plane::new(up()));
        world.add(at([0.0; 3]), floor, groups, query, "floor".to_owned())?;
        // All boxes share one shape: clones of a handle are reference-counted.
        let cube = ShapeHandle::new(Cuboid::new(vector([0.5; 3])));
        for n in 0..panel.count("count") {
            // Boxes are shifted to the right and to the left in turn.
            let side = if n % 2 == 0 { 1.0 } else { -1.0 };
            let position = at([side * panel.value("shift"), 0.505 + 1.005 * number(n), 0.0]);
            let cube = world.add(position, cube.clone(), groups, query, format!("box {n}"))?;
            self.bodies.add(cube, 0.5);
            self.top = Some(cube);
        }
        Ok(())
    }

    /// Clears the world and builds it again. Handles of the removed objects are then stale.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.rebuild(world, panel)
    }

    /// Sets the velocity of the top box if the button was pressed. Contacts and friction move the
    /// other boxes.
    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        if panel.take_press("push")
            && let Some(top) = self.top
        {
            self.bodies.push(top, vector([4.0, 0.0, 0.0]));
        }
        self.bodies.advance(world)
    }

    /// Returns the number of contact points and the largest speed of the boxes. The points are
    /// counted without copying the manifolds.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let points = world.contact_views().map(|(_, _, manifold)| manifold.len()).sum::<usize>();
        vec![
            Readout::new("Contact points", points),
            Readout::number("Fastest box", self.bodies.speed()),
        ]
    }
}
