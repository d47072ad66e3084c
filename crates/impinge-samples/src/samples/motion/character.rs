//! A character that slides along walls.

use crate::prelude::*;

/// The distance that the character keeps from obstacles, so that no cast starts in contact.
const SKIN: f32 = 0.02;
/// The radius of the capsule.
const RADIUS: f32 = 0.3;

/// The maximum number of stored positions of the trail.
const TRAIL: usize = 300;

/// A capsule in a yard with posts. Its heading rotates slowly. Casts find the obstacles that limit
/// its motion.
#[derive(Debug, Default)]
pub(crate) struct Character<const D: usize> {
    /// The object of the capsule.
    body: Option<CollisionObjectHandle>,
    /// The angle of the heading from x to y, in radians.
    heading: f32,
    /// The positions of the capsule after the last [`TRAIL`] steps.
    trail: Vec<Point<f32, D>>,
    /// The number of casts that hit an obstacle.
    slides: usize,
}

impl<const D: usize> Character<D>
where
    f32: Dimension<D>,
{
    /// Returns the pose of the capsule after a motion from `pose`. The capsule moves until its
    /// distance from an obstacle is [`SKIN`], and then along that obstacle. Makes at most four
    /// casts; the motion that remains after them is dropped.
    fn slide(
        &mut self,
        world: &World<D>,
        mut pose: Pose<f32, D>,
        mut motion: Vector<f32, D>,
    ) -> Pose<f32, D> {
        let capsule = Capsule::new(0.3, RADIUS);
        // The capsule is an object of the world too, and is excluded from the casts.
        let mut others = QueryFilter::new();
        if let Some(body) = self.body {
            others = others.exclude(body);
        }
        let options = ImpactOptions::new().with_max_time(1.0).with_target_distance(SKIN);
        for _ in 0..4 {
            // A hit before the end of the motion is at distance `SKIN`. The rest of the motion
            // continues along the obstacle.
            let from = f32::isometry(&pose);
            let Some((_, hit)) = world.cast_shape(&from, &motion, &capsule, &options, &others)
            else {
                pose.translation += motion;
                return pose;
            };
            self.slides += 1;
            pose.translation += motion * hit.toi;
            // The component along the normal is removed from the rest of the motion. The sign of
            // the normal does not matter.
            motion *= 1.0 - hit.toi;
            let normal = hit.normal.into_inner();
            motion -= normal * motion.dot(&normal);
        }
        pose
    }
}

impl<const D: usize> Sample<D> for Character<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("speed", "Speed", 3.0, [0.0, 60.0, 0.5]).number(
            "turn",
            "Turn of the heading, radians per second",
            0.5,
            [-3.0, 3.0, 0.1],
        )
    }

    fn build(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        // Four walls meet in common corners. The posts are of different kinds.
        for n in 0..4_u8 {
            let rotation = turn::<D>([0, 1], TAU / 4.0 * f32::from(n));
            let translation = rotation * vector::<D>([5.0, 0.0, 0.0]);
            let wall = ShapeHandle::new(Cuboid::new(vector([0.25, 5.25, 1.0])));
            let position = f32::isometry(&Pose { rotation, translation });
            world.add(position, wall, groups, query, format!("wall {n}"))?;
        }
        for n in 0..8 {
            let place = turn::<D>([0, 1], TAU / 8.0 * number(n)) * vector::<D>([3.0, 0.0, 0.0]);
            let position =
                f32::isometry(&Pose { rotation: turn([0, 1], number(n)), translation: place });
            let post = solid(f32::SOLIDS[n % 5], 0.5);
            world.add(position, post, groups, query, format!("post {n}"))?;
        }
        let capsule = ShapeHandle::new(Capsule::new(0.3, RADIUS));
        let body = world.add(at([0.0; 3]), capsule, groups, query, "character".to_owned())?;
        self.body = Some(body);
        Ok(())
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        let Some(body) = self.body else { return Ok(()) };
        self.heading += panel.value("turn") * TIME_STEP;
        // The motion of a step along x, if no obstacle is in the way; the heading rotates it.
        let ahead = vector([panel.value("speed") * TIME_STEP, 0.0, 0.0]);
        let pose = pose_of(world, body);
        let pose = self.slide(world, pose, turn::<D>([0, 1], self.heading) * ahead);
        self.trail.push(Point::from(pose.translation));
        let old = self.trail.len().saturating_sub(TRAIL);
        self.trail.drain(..old);
        Ok(world.set_position(body, f32::isometry(&pose))?)
    }

    /// Draws the trail of the last five seconds, and the heading.
    fn draw(&self, _: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        canvas.path(&self.trail, BLUE);
        if let Some(here) = self.trail.last() {
            let ahead = turn::<D>([0, 1], self.heading) * vector::<D>([1.0, 0.0, 0.0]);
            canvas.line([*here, here + ahead], GREEN);
        }
    }

    /// Returns the distance to the nearest object within 100, and the number of hits. A predicate
    /// excludes the character itself.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let pose = self.body.map(|body| f32::isometry(&pose_of(world, body)));
        let capsule = Capsule::new(0.3, RADIUS);
        let is_other = |object: &impinge::world::CollisionObject<f32, D, String>| {
            Some(object.handle()) != self.body
        };
        let others = QueryFilter::new().predicate(&is_other);
        let near = pose.and_then(|pose| {
            world.closest_object(&pose, &capsule, 100.0, &others).map(|near| near.distance)
        });
        vec![
            Readout::number("Distance from the nearest", near.unwrap_or(100.0)),
            Readout::new("Slides", self.slides),
        ]
    }
}
