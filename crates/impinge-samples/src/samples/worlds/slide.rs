//! A box that slides over a floor of triangles.

use crate::prelude::*;

/// The maximum number of tilted normals that are drawn; older normals are dropped.
const SHOWN: usize = 100;

/// A box that moves back and forth over a floor with a small penetration, like a body under
/// gravity.
#[derive(Debug, Default)]
pub(crate) struct Slide<const D: usize> {
    /// The object of the box.
    slider: Option<CollisionObjectHandle>,
    /// The object of the floor.
    floor: Option<CollisionObjectHandle>,
    step: usize,
    /// The number of normals since the start that were not vertical.
    count: usize,
    /// The last contacts with tilted normals: the contact point, and the point at distance 1 along
    /// the normal.
    bumps: Vec<[Point<f32, D>; 2]>,
}

/// Returns the flat floor. The control `contacts` selects whether contacts are computed for the
/// whole surface, or for each triangle (in 2D each segment) by itself.
fn floor<const D: usize>(panel: &Panel) -> ShapeHandle<f32, D>
where
    f32: Dimension<D>,
{
    let kind = match panel.chosen("contacts") {
        "of each triangle" => SurfaceKind::MeshWithEdges,
        _ => SurfaceKind::Mesh,
    };
    f32::surface(12, kind, &|_, _| 0.0)
}

impl<const D: usize> Slide<D>
where
    f32: Dimension<D>,
{
    /// Returns the position of the box. In 3D its path is parallel to no edge of the triangles.
    fn position(&self, panel: &Panel) -> Isometry<D> {
        let way = 8.0 * to_and_fro(number(self.step) / 600.0) - 4.0;
        turned([way, 0.4 - panel.value("sunk"), 0.37 * way], 0.0)
    }
}

impl<const D: usize> Sample<D> for Slide<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .choice(
                "contacts",
                "Contacts",
                "of the surface",
                &["of the surface", "of each triangle"],
            )
            .number("sunk", "How far it is sunk in", 0.02, [0.0, 0.1, 0.005])
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.02));
        let slider = ShapeHandle::new(Cuboid::new(vector([0.7, 0.4, 0.6])));
        let floor = world.add(at([0.0; 3]), floor(panel), groups, query, "floor".to_owned())?;
        let slider = world.add(self.position(panel), slider, groups, query, "box".to_owned())?;
        (self.floor, self.slider) = (Some(floor), Some(slider));
        Ok(())
    }

    /// Replaces the floor below the box, and resets the count of tilted normals.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.bumps.clear();
        self.count = 0;
        let Some(object) = self.floor else { return Ok(()) };
        Ok(world.set_shape(object, floor(panel))?)
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        let Some(slider) = self.slider else { return Ok(()) };
        Ok(world.set_position(slider, self.position(panel))?)
    }

    /// Collects tilted normals. Such a normal would stop a body as if it had hit a bump (a ghost
    /// collision).
    fn updated(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        let points = world.contact_views().flat_map(|(_, _, manifold)| manifold.contacts());
        let leaning =
            points.map(|point| point.contact).filter(|contact| contact.normal[1].abs() < 0.999);
        let bumps: Vec<_> = leaning
            .map(|contact| [contact.world1, contact.world1 + contact.normal.into_inner()])
            .collect();
        self.count += bumps.len();
        self.bumps.extend(bumps);
        let old = self.bumps.len().saturating_sub(SHOWN);
        self.bumps.drain(..old);
        Ok(())
    }

    /// Draws the current contacts, and in red the last tilted normals.
    fn draw(&self, world: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        let points = world.contact_views().flat_map(|(_, _, manifold)| manifold.contacts());
        let contacts: Vec<_> = points.map(|point| point.contact).collect();
        canvas.drawing.contacts(contacts, canvas.renderer);
        for bump in &self.bumps {
            canvas.line(*bump, RED);
        }
    }

    /// Returns the numbers of contact points and of tilted normals. Normals are tilted only if
    /// contacts are computed for each triangle by itself.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let points = world.contact_views().map(|(_, _, manifold)| manifold.len()).sum::<usize>();
        vec![
            Readout::new("Contact points", points),
            Readout::new("Normals that were not vertical", self.count),
        ]
    }
}
