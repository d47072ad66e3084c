//! A one-sided surface, which has contacts from above and none from below.

use crate::prelude::*;

/// A hill, and a ball that moves up through the hill and down again.
#[derive(Debug, Default)]
pub(crate) struct OneSided {
    /// The objects of the hill and the ball.
    objects: Vec<CollisionObjectHandle>,
    /// The number of steps since the start.
    step: usize,
}

/// Returns the mesh of the hill, one-sided or two-sided.
fn hill<const D: usize>(panel: &Panel) -> ShapeHandle<f32, D>
where
    f32: Dimension<D>,
{
    let kind =
        if panel.is_set("one sided") { SurfaceKind::OneSidedMesh } else { SurfaceKind::Mesh };
    f32::surface(8, kind, &|x, z| 1.0 - 0.06 * (x * x + z * z))
}

impl OneSided {
    /// Returns the current position of the ball, which moves up through the hill and down again.
    fn position<const D: usize>(&self) -> Isometry<D>
    where
        f32: Dimension<D>,
    {
        let phase = number(self.step) / 240.0;
        at([1.0, -2.0 + 5.0 * to_and_fro(phase), 0.5])
    }
}

impl<const D: usize> Sample<D> for OneSided
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().flag("one sided", "One side", true)
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        let ball = ShapeHandle::new(Ball::new(0.5));
        self.objects = vec![
            world.add(at([0.0; 3]), hill(panel), groups, query, "hill".to_owned())?,
            world.add(self.position(), ball, groups, query, "ball".to_owned())?,
        ];
        Ok(())
    }

    /// Replaces the shape of the hill while the ball moves on.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let &[surface, _] = self.objects.as_slice() else { return Ok(()) };
        Ok(world.set_shape(surface, hill(panel))?)
    }

    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        let &[_, ball] = self.objects.as_slice() else { return Ok(()) };
        Ok(world.set_position(ball, self.position())?)
    }

    /// Returns the depth and the normal of the deepest contact of the first manifold. The normal
    /// points from the hill to the ball, since the hill was added first.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let deepest = world.contact_views().map(|(_, _, manifold)| manifold.deepest_contact());
        let deepest = deepest.map(|point| point.contact).next();
        vec![Readout::new(
            "Contact",
            deepest.map_or_else(
                || "none".to_owned(),
                |contact| {
                    format!("{:.4} deep, normal {:.2?}", contact.depth, contact.normal.as_slice())
                },
            ),
        )]
    }
}
