//! Solids that fall and come to rest.

use crate::bodies::Bodies;
use crate::prelude::*;

/// Solids that fall between walls on a floor.
#[derive(Debug, Default)]
pub(crate) struct Pile<const D: usize> {
    /// The bodies of all objects except the floor and the walls.
    bodies: Bodies<D>,
    /// The number of solids dropped so far, which is the index of the next solid.
    dropped: usize,
}

/// The kinds of falling solids.
const KINDS: [&str; 4] = ["box", "ball", "capsule", "rounded box"];
/// Half the width of the room.
const WALL: f32 = 3.0;

impl<const D: usize> Pile<D>
where
    f32: Dimension<D>,
{
    /// Adds a solid at `height` above the floor. Its horizontal position, angle, kind and size
    /// depend on its index.
    fn drop_one(&mut self, world: &mut World<D>, height: f32) -> Result<(), SampleError> {
        let n = self.dropped;
        self.dropped += 1;
        let spread = |stream| (WALL - 1.0) * (2.0 * scattered(n, stream) - 1.0);
        let position = turned([spread(0), height, spread(1)], TAU * scattered(n, 2));
        let (kind, size) = (KINDS[n % KINDS.len()], 0.4 + 0.2 * scattered(n, 3));
        // Contacts begin at a gap of 0.02, the sum of both predictions: the solver gets them before
        // objects touch.
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
        let body = world.add(position, solid(kind, size), groups, query, format!("{kind} {n}"))?;
        self.bodies.add(body, size);
        Ok(())
    }
}

impl<const D: usize> Sample<D> for Pile<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .number("count", "Solids", 24.0, [1.0, 120.0, 1.0])
            .button("drop", "Drop one more")
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
        let floor = ShapeHandle::new(Plane::new(up()));
        world.add(at([0.0; 3]), floor, groups, query, "floor".to_owned())?;
        // There are two walls for each horizontal axis.
        for axis in (0..D).filter(|axis| *axis != 1) {
            for side in [-1.0, 1.0] {
                let mut half = Vector::<f32, D>::repeat(WALL);
                let mut place = vector([0.0, WALL, 0.0]);
                (half[axis], place[axis]) = (0.25, side * (WALL + 0.25));
                let position = f32::isometry(&Pose::from_translation(place));
                let wall = ShapeHandle::new(Cuboid::new(half));
                world.add(position, wall, groups, query, "wall".to_owned())?;
            }
        }
        for n in 0..panel.count("count") {
            self.drop_one(world, 1.0 + 0.6 * number(n))?;
        }
        Ok(())
    }

    /// Rebuilds the pile with the changed number of solids. The button is not applied here but in
    /// `advance`.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.rebuild(world, panel)
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        if panel.take_press("drop") {
            self.drop_one(world, 8.0)?;
        }
        self.bodies.advance(world)
    }

    /// Returns the number of manifolds, the depth of the deepest contact and the largest speed. At
    /// rest, the deepest contact is about as deep as the solver tolerates.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let deepest = world.contact_views().map(|(_, _, manifold)| manifold.deepest_contact());
        let depth = deepest.map(|point| point.contact.depth).reduce(max);
        vec![
            Readout::new("Manifolds", world.contact_views().count()),
            Readout::number("Deepest contact", depth.unwrap_or(0.0)),
            Readout::number("Fastest body", self.bodies.speed()),
        ]
    }
}
