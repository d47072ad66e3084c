//! Capsules that avoid each other.

use crate::prelude::*;

/// The distance up to which a person avoids other people.
const SIGHT: f32 = 1.2;
/// The maximum number of people whom a person avoids, the nearest first.
const NEIGHBORS: usize = 4;

/// A person who walks to the opposite point of a circle and back.
#[derive(Debug)]
struct Person<const D: usize> {
    object: CollisionObjectHandle,
    goal: Vector<f32, D>,
}

/// People on a circle, each with a goal at the opposite point.
#[derive(Debug, Default)]
pub(crate) struct Crowd<const D: usize> {
    people: Vec<Person<D>>,
    touching: usize,
}

impl<const D: usize> Person<D>
where
    f32: Dimension<D>,
{
    /// Returns the velocity as a share of the full speed, of length 1 or less. It is the sum of the
    /// direction to the goal and of vectors away from the nearest people and to their side, which
    /// are longer for nearer people. Zero if the person was removed.
    fn velocity(&self, world: &World<D>) -> Vector<f32, D> {
        let none = Vector::<f32, D>::zeros();
        let Some(own) = world.collision_object(self.object) else { return none };
        let here = f32::pose(own.position()).translation;
        let others = QueryFilter::new().exclude(self.object);
        // Distances are between the capsules, not between their centres.
        let near = world.nearest_objects(own.position(), &**own.shape(), NEIGHBORS, SIGHT, &others);
        let ahead = unit_or(&(self.goal - here), none);
        let steered = near.iter().fold(ahead, |velocity, near| {
            let place = f32::pose(near.object.position()).translation;
            let away = unit_or(&(here - place), none);
            // A component to the side lets two people who meet head-on pass each other.
            let side = turn::<D>([0, 1], TAU / 4.0) * away;
            // The weight grows from 0 at distance `SIGHT` to 1 in contact. Its square makes the
            // influence of near people dominate.
            let weight = 1.0 - near.distance / SIGHT;
            velocity + (away * 1.5 + side * 0.5) * (weight * weight)
        });
        // A sum longer than 1 is shortened to length 1.
        let speed = max(steered.norm(), 1.0);
        steered / speed
    }
}

impl<const D: usize> Sample<D> for Crowd<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("count", "People", 24.0, [2.0, 60.0, 1.0]).number(
            "speed",
            "Speed",
            1.5,
            [0.0, 5.0, 0.1],
        )
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let capsule = ShapeHandle::new(Capsule::new(0.12, 0.18));
        let (groups, query, count) =
            (CollisionGroups::new(), ContactQuery::default(), panel.count("count"));
        for n in 0..count {
            let angle = TAU * number(n) / number(count);
            // People start at equal distances on the circle, with the goal at the opposite point.
            let place = turn::<D>([0, 1], angle) * vector::<D>([6.0, 0.0, 0.0]);
            let position = f32::isometry(&Pose::from_translation(place));
            let label = format!("person {n}");
            let object = world.add(position, capsule.clone(), groups, query, label)?;
            self.people.push(Person { object, goal: -place });
        }
        Ok(())
    }

    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        if panel.count("count") == self.people.len() {
            return Ok(());
        }
        self.rebuild(world, panel)
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        let length = panel.value("speed") * TIME_STEP;
        // All velocities are computed from the positions of the previous step; then all people move
        // at once.
        let mut moved = Vec::with_capacity(self.people.len());
        for person in &mut self.people {
            let mut pose = pose_of(world, person.object);
            pose.translation += person.velocity(world) * length;
            // A person who is near the goal turns back.
            if (person.goal - pose.translation).norm() < 0.5 {
                person.goal = -person.goal;
            }
            moved.push((person.object, f32::isometry(&pose)));
        }
        Ok(world.set_positions(&moved)?)
    }

    fn updated(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        self.touching = world.contact_views().count();
        Ok(())
    }

    /// Draws the velocity of each person. A line of length 1 is the full speed.
    fn draw(&self, world: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        for person in &self.people {
            let here = Point::from(pose_of(world, person.object).translation);
            canvas.line([here, here + person.velocity(world)], GREEN);
        }
    }

    fn readouts(&self, _: &World<D>, _: &Panel) -> Vec<Readout> {
        vec![Readout::new("Pairs that bump into each other", self.touching)]
    }
}
