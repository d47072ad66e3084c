//! The depth of a solid that moves through another solid.

use crate::prelude::*;

/// The number of steps of the path: four seconds.
const STEPS: usize = 240;

/// Two solids, and a graph of their depth at each step of the path.
#[derive(Debug, Default)]
pub(crate) struct Through {
    /// The resting solid, then the moving one.
    objects: Vec<CollisionObjectHandle>,
    /// The number of steps since the start.
    step: usize,
    /// The depth at each step of the path; negative while the solids are apart.
    depths: Vec<f32>,
}

impl Through {
    /// Returns the contact of the two solids, whose depth is negative if the solids are apart;
    /// `None` if their distance exceeds 100.
    fn contact<const D: usize>(&self, world: &World<D>) -> Option<Contact<f32, D>>
    where
        f32: Dimension<D>,
    {
        let &[first, second] = self.objects.as_slice() else { return None };
        let poses = [first, second].map(|object| isometry(&pose_of(world, object)));
        let shape1 = world.collision_object(first)?.shape();
        let shape2 = world.collision_object(second)?.shape();
        contact(&poses[0], &**shape1, &poses[1], &**shape2, 100.0)
    }

    /// Returns the x coordinate of the moving solid, which runs from −3 to 3 repeatedly.
    fn x(&self) -> f32 {
        6.0 * number(self.step % STEPS) / number(STEPS) - 3.0
    }
}

impl<const D: usize> Sample<D> for Through
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .choice("first", "Solid that stands", "box", f32::SOLIDS)
            .choice("second", "Solid that moves", "ball", f32::SOLIDS)
            .number("height", "Height of the way", 0.2, [-2.0, 2.0, 0.05])
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        for name in ["first", "second"] {
            let shape = solid::<D>(panel.chosen(name), 0.8);
            let position = if name == "first" { at([0.0; 3]) } else { at([-3.0, 0.2, 0.0]) };
            self.objects.push(world.add(position, shape, groups, query, name.to_owned())?);
        }
        Ok(())
    }

    /// Replaces the shapes of the solids, clears the graph, and starts the path again.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        for (object, name) in self.objects.iter().zip(["first", "second"]) {
            world.set_shape(*object, solid(panel.chosen(name), 0.8))?;
        }
        self.depths.clear();
        self.step = 0;
        Ok(())
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        // The graph is cleared when the path starts again.
        if self.step.is_multiple_of(STEPS) {
            self.depths.clear();
        }
        let &[_, second] = self.objects.as_slice() else { return Ok(()) };
        Ok(world.set_position(second, at([self.x(), panel.value("height"), 0.0]))?)
    }

    /// Adds the current depth to the graph, unless the graph already has all steps of the path.
    fn updated(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        self.depths.extend(self.contact(world).map(|contact| contact.depth));
        self.depths.truncate(STEPS);
        Ok(())
    }

    fn draw(&self, world: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        let found = self.contact(world);
        canvas.drawing.contacts(found, canvas.renderer);
        // The graph shows time to the right and depth upwards. The solids touch where the curve
        // crosses the line of depth zero.
        let width = 6.0 / number(STEPS);
        let spot = |(n, depth): (usize, &f32)| point([width * number(n) - 3.0, 3.0 + depth, 0.0]);
        let graph: Vec<_> = self.depths.iter().enumerate().map(spot).collect();
        canvas.path(&graph, RED);
        canvas.line([point([-3.0, 3.0, 0.0]), point([3.0, 3.0, 0.0])], BLUE);
    }

    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let Some(found) = self.contact(world) else { return Vec::new() };
        vec![
            Readout::number("Depth", found.depth),
            Readout::new("Normal", format!("{:.3?}", found.normal.as_slice())),
        ]
    }
}
