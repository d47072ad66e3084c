//! Bullets between walls that are thinner than the distance that a bullet moves in a step.

use crate::prelude::*;

/// The radius of a bullet.
const RADIUS: f32 = 0.05;
/// Half the thickness of a wall.
const HALF: f32 = 0.01;
/// Half the width of the room.
const ROOM: f32 = 5.0;
/// The maximum number of reflections of a bullet in a step. After them the bullet stops until the
/// next step.
const MAX_BOUNCES: usize = 64;

/// A bullet, with the path of its last step.
#[derive(Debug)]
struct Bullet<const D: usize> {
    /// The object of the bullet, at the end of its path.
    object: CollisionObjectHandle,
    /// The direction of motion, a unit vector.
    direction: Vector<f32, D>,
    /// The corners of the path in the last step.
    path: Vec<Point<f32, D>>,
}

/// Bullets in a room with a dividing wall. In each step casts find the walls that the bullets hit.
#[derive(Debug, Default)]
pub(crate) struct Bullets<const D: usize> {
    bullets: Vec<Bullet<D>>,
    bounces: usize,
}

impl<const D: usize> Bullet<D>
where
    f32: Dimension<D>,
{
    /// Computes the path of a step, with a reflection at each hit, and the direction at its end.
    /// The path has the length `length`, or less if it ends after [`MAX_BOUNCES`] reflections.
    /// Returns the number of reflections.
    fn fly(&mut self, world: &World<D>, mut length: f32) -> usize {
        let mut pose = pose_of(world, self.object);
        let (ball, walls) = (Ball::new(RADIUS), wall_groups());
        let filter = QueryFilter::new().groups(walls).exclude(self.object);
        self.path = vec![Point::from(pose.translation)];
        for bounces in 0..MAX_BOUNCES {
            let options = ImpactOptions::new().with_max_time(length);
            let from = f32::isometry(&pose);
            // The direction is a unit vector, so the time of impact is a length.
            let hit = world.cast_shape(&from, &self.direction, &ball, &options, &filter);
            let way = hit.as_ref().map_or(length, |(_, hit)| hit.toi);
            pose.translation += self.direction * way;
            self.path.push(Point::from(pose.translation));
            let Some((_, hit)) = hit else { return bounces };
            let normal = hit.normal.into_inner();
            // The next cast starts in contact with the wall. It has no impact there, since the
            // reflected ball moves away.
            let direction = self.direction - normal * (2.0 * self.direction.dot(&normal));
            self.direction = unit_or(&direction, direction);
            length -= way;
        }
        MAX_BOUNCES
    }
}

/// Returns groups that interact only with walls, which are in group 1. Bullets are in group 2, so
/// they do not collide with each other.
fn wall_groups() -> CollisionGroups {
    let mut groups = CollisionGroups::new();
    groups.set_whitelist(&[1]);
    groups
}

impl<const D: usize> Bullets<D>
where
    f32: Dimension<D>,
{
    /// Adds two outer walls for each axis, and a wall in the middle that is perpendicular to the
    /// first axis.
    fn add_walls(world: &mut World<D>) -> Result<(), SampleError> {
        let mut groups = CollisionGroups::new();
        groups.set_membership(&[1]);
        let sides = (0..D).flat_map(|axis| [(axis, -ROOM), (axis, ROOM)]);
        for (axis, place) in sides.chain([(0, 0.0)]) {
            let (mut half, mut at) = (Vector::<f32, D>::repeat(ROOM + HALF), vector([0.0; 3]));
            // Each wall is as wide as the room, and very thin along its axis.
            (half[axis], at[axis]) = (HALF, place);
            let position = f32::isometry(&Pose::from_translation(at));
            let wall = ShapeHandle::new(Cuboid::new(half));
            world.add(position, wall, groups, ContactQuery::default(), "wall".to_owned())?;
        }
        Ok(())
    }
}

impl<const D: usize> Sample<D> for Bullets<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("speed", "Speed, lengths per second", 200.0, [1.0, 3000.0, 1.0])
    }

    fn build(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        Self::add_walls(world)?;
        let mut groups = wall_groups();
        groups.set_membership(&[2]);
        let ball = ShapeHandle::new(Ball::new(RADIUS));
        for n in 0..12 {
            let side = if n % 2 == 0 { -0.5 } else { 0.5 };
            let position = at([side * ROOM, 4.0 * scattered(n, 1) - 2.0, 0.0]);
            let query = ContactQuery::default();
            let object = world.add(position, ball.clone(), groups, query, format!("bullet {n}"))?;
            // A quasirandom direction: a rotation from x towards y, and a rotation from x towards
            // the last axis.
            let direction = turn::<D>([0, 1], TAU * scattered(n, 2))
                * turn::<D>([0, D - 1], TAU * scattered(n, 3))
                * vector::<D>([1.0, 0.0, 0.0]);
            self.bullets.push(Bullet { object, direction, path: Vec::new() });
        }
        Ok(())
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        let length = panel.value("speed") * TIME_STEP;
        for bullet in &mut self.bullets {
            self.bounces += bullet.fly(world, length);
            let end = bullet.path.last().map_or_else(Vector::<f32, D>::zeros, |end| end.coords);
            world.set_position(bullet.object, f32::isometry(&Pose::from_translation(end)))?;
        }
        Ok(())
    }

    /// Draws the paths of the last step with all their corners.
    fn draw(&self, _: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        self.bullets.iter().for_each(|bullet| canvas.path(&bullet.path, RED));
    }

    fn readouts(&self, _: &World<D>, panel: &Panel) -> Vec<Readout> {
        vec![
            Readout::new("Reflections", self.bounces),
            Readout::number("Way of a step", panel.value("speed") * TIME_STEP),
            Readout::number("Thickness of a wall", 2.0 * HALF),
        ]
    }
}
