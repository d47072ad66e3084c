//! Contacts of every pair of kinds of solids.

use crate::prelude::*;

/// The distance between the centres of adjacent cells.
const CELL: f32 = 3.0;

/// A grid with a cell for each pair of kinds. One solid of a cell is at rest. The other solid
/// rotates and is moved into contact.
#[derive(Debug, Default)]
pub(crate) struct Grid {
    /// The resting and the rotating solid of each cell.
    pairs: Vec<[CollisionObjectHandle; 2]>,
    /// The angle of all second solids, in radians from x to y.
    angle: f32,
}

impl Grid {
    /// Returns the position of the second solid of a pair. The solid is moved from the upper right
    /// until it touches the first solid, and then by `depth` against the normal, or away from the
    /// first solid if `depth` is negative. If the solids should overlap but cannot, as parallel
    /// segments, the second stays where they touch. `None` if the cast does not hit.
    fn touching<const D: usize>(
        &self,
        world: &World<D>,
        [first, second]: [CollisionObjectHandle; 2],
        depth: f32,
    ) -> Option<Isometry<D>>
    where
        f32: Dimension<D>,
    {
        let shape1 = &**world.collision_object(first)?.shape();
        let shape2 = &**world.collision_object(second)?.shape();
        let pose1 = pose_of(world, first);
        let mut pose2 = Pose {
            rotation: turn([0, 1], self.angle),
            translation: pose1.translation + vector([CELL, CELL, 0.0]),
        };
        let velocity = vector([-1.0, -1.0, 0.0]);
        // A cast of two shapes needs no world, only their poses and velocities.
        let still = Moving::still(&isometry(&pose1), shape1);
        let moving = Moving::new(&isometry(&pose2), &velocity, shape2);
        let hit = impact(&still, &moving, &ImpactOptions::new())?;
        // The normal of the impact points from the first solid to the second.
        pose2.translation += velocity * hit.toi;
        let deeper = Pose { translation: pose2.translation - *hit.normal * depth, ..pose2 };
        let gap = distance(&isometry(&pose1), shape1, &isometry(&deeper), shape2);
        let has_depth = depth < 0.0 || gap <= 0.0;
        Some(f32::isometry(if has_depth { &deeper } else { &pose2 }))
    }

    /// Moves the second solids of all pairs in one call.
    fn place<const D: usize>(&self, world: &mut World<D>, depth: f32) -> Result<(), SampleError>
    where
        f32: Dimension<D>,
    {
        // A solid whose cast does not hit keeps its position.
        let moved = self
            .pairs
            .iter()
            .filter_map(|pair| Some((pair[1], self.touching(world, *pair, depth)?)));
        let moved: Vec<_> = moved.collect();
        Ok(world.set_positions(&moved)?)
    }
}

impl<const D: usize> Sample<D> for Grid
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("depth", "Depth", 0.05, [-0.1, 0.3, 0.01]).number(
            "speed",
            "Turns per minute",
            2.0,
            [0.0, 20.0, 0.5],
        )
    }

    /// Adds the cells of a triangle, since a pair and its reverse need only one cell.
    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
        let kinds: Vec<_> = f32::BOUNDED.iter().collect();
        for (row, first) in kinds.iter().enumerate() {
            for (column, second) in kinds.iter().enumerate().take(row + 1) {
                let center = at([CELL * number(column), -CELL * number(row), 0.0]);
                let label = format!("{first} and {second}");
                let shapes = [solid(first, 0.7), solid(second, 0.7)];
                let [shape1, shape2] = shapes;
                self.pairs.push([
                    world.add(center, shape1, groups, query, label.clone())?,
                    world.add(center, shape2, groups, query, label)?,
                ]);
            }
        }
        self.place(world, panel.value("depth"))
    }

    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.place(world, panel.value("depth"))
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        self.angle += panel.value("speed") * TAU / 3600.0;
        self.place(world, panel.value("depth"))
    }

    /// Returns the numbers of pairs and of pairs with contacts, and the largest number of points of
    /// a manifold. `contact_pair` takes the handles of a pair in either order.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let touching = self.pairs.iter().filter(|[a, b]| {
            world.contact_pair(*a, *b).is_some_and(|pair| pair.num_contacts() > 0)
        });
        let most = world.contact_views().map(|(_, _, manifold)| manifold.len()).max();
        vec![
            Readout::new("Pairs of kinds", self.pairs.len()),
            Readout::new("Pairs with contacts", touching.count()),
            Readout::new("Most points of a manifold", most.unwrap_or(0)),
        ]
    }
}
