//! A scene at many sizes, near the origin and far from it.

use crate::prelude::*;

/// The number of solids, which are in a row.
const COUNT: usize = 6;

/// Solids that move up and down on a slab. All lengths are multiplied by a power of two, so the
/// results scale exactly.
#[derive(Debug, Default)]
pub(crate) struct Scaling {
    /// The objects of the solids on the slab.
    solids: Vec<CollisionObjectHandle>,
    /// The number of steps since the start.
    step: usize,
}

/// Returns the factor of all lengths, a power of two.
fn scale(panel: &Panel) -> f32 {
    let exponent = panel.value("exponent").floor();
    // Products with a power of two are exact, so each length has the same mantissa at every size.
    let factor = if exponent < 0.0 { 0.5 } else { 2.0 };
    (0..).take_while(|n| number(*n) < exponent.abs()).fold(1.0, |scale, _| scale * factor)
}

impl Scaling {
    /// Returns the position of a solid, which moves down to the slab and up again.
    fn position<const D: usize>(&self, index: usize, panel: &Panel) -> Isometry<D>
    where
        f32: Dimension<D>,
    {
        let (scale, far) = (scale(panel), panel.value("far"));
        let phase = number(self.step) / 240.0 + number(index) / number(COUNT);
        let height = 0.4 + 0.5 * to_and_fro(phase);
        let x = far + 1.5 * number(index) - 3.75;
        turned([x * scale, height * scale, 0.0], 0.3 * number(index))
    }

    /// Returns the depth of the deepest contact; `None` if there is no contact.
    fn depth<const D: usize>(world: &World<D>) -> Option<f32>
    where
        f32: Dimension<D>,
    {
        let manifolds = world.contact_views().map(|(_, _, manifold)| manifold);
        manifolds.map(|manifold| manifold.deepest_contact().contact.depth).reduce(max)
    }
}

impl<const D: usize> Sample<D> for Scaling
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("exponent", "Size as a power of 2", 0.0, [-10.0, 20.0, 1.0]).number(
            "far",
            "Distance from the origin in sizes",
            0.0,
            [0.0, 1000.0, 10.0],
        )
    }

    /// Adds the slab and the solids, with scaled shapes and positions. Predictions are zero and
    /// need no scaling.
    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let (scale, groups, query) =
            (scale(panel), CollisionGroups::new(), ContactQuery::default());
        self.step = 0;
        let slab = ShapeHandle::new(Cuboid::new(vector([6.0, 0.25, 2.0]) * scale));
        let below = at([panel.value("far") * scale, -0.25 * scale, 0.0]);
        world.add(below, slab, groups, query, "slab".to_owned())?;
        self.solids.clear();
        for (index, kind) in f32::SOLIDS.iter().take(COUNT).enumerate() {
            let (shape, position) = (solid(kind, 0.5 * scale), self.position(index, panel));
            self.solids.push(world.add(position, shape, groups, query, (*kind).to_owned())?);
        }
        Ok(())
    }

    /// Rebuilds the scene at another size, and continues the motion.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let step = self.step;
        self.rebuild(world, panel)?;
        self.step = step;
        Ok(())
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        for (index, object) in self.solids.iter().enumerate() {
            world.set_position(*object, self.position(index, panel))?;
        }
        Ok(())
    }

    /// Returns the number of contact points, the size, the largest depth, and this depth divided by
    /// the size. If the scene is at the origin, the quotient is exactly equal at all sizes.
    fn readouts(&self, world: &World<D>, panel: &Panel) -> Vec<Readout> {
        let points = world.contact_views().map(|(_, _, manifold)| manifold.len()).sum::<usize>();
        let (depth, scale) = (Self::depth(world).unwrap_or(0.0), scale(panel));
        vec![
            Readout::new("Contact points", points),
            Readout::number("Size", scale),
            Readout::number("Deepest contact", depth),
            Readout::new("The same in sizes", format!("{:.9}", depth / scale)),
        ]
    }
}
