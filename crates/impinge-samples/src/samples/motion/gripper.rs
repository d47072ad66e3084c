//! A gripper that closes on an object and stops at the first contact.

use crate::prelude::*;

/// The distance of an open finger's centre from the middle.
const OPEN: f32 = 2.0;
/// The distance that a finger moves in a step.
const SPEED: f32 = 0.02;
/// The number of steps of a cycle, in which the fingers close, hold and open.
const STEPS: usize = 320;

/// Two fingers that close along x until a cast hits the object.
#[derive(Debug, Default)]
pub(crate) struct Gripper<const D: usize> {
    /// The gripped object.
    object: Option<CollisionObjectHandle>,
    /// The left finger, then the right one.
    fingers: Vec<CollisionObjectHandle>,
    /// The hits of the casts in the last step.
    hits: Vec<Impact<f32, D>>,
    step: usize,
}

/// Returns the shape of both fingers.
fn finger<const D: usize>() -> Cuboid<f32, D> {
    Cuboid::new(vector([0.15, 0.8, 0.4]))
}

impl<const D: usize> Gripper<D>
where
    f32: Dimension<D>,
{
    /// Returns the pose of a finger after a step inwards, which is shorter if the finger would
    /// penetrate the object.
    fn close(&mut self, world: &World<D>, mut pose: Pose<f32, D>) -> Pose<f32, D> {
        let inward = vector([-SPEED.copysign(pose.translation[0]), 0.0, 0.0]);
        // The casts ignore both fingers, so only the object can stop a finger.
        let mut others = QueryFilter::new();
        for finger in &self.fingers {
            others = others.exclude(*finger);
        }
        // The velocity is the motion of a step, so time 1 is the end of the step.
        let options = ImpactOptions::new().with_max_time(1.0);
        let hit = world.cast_shape(&f32::isometry(&pose), &inward, &finger(), &options, &others);
        let hit = hit.map(|(_, hit)| hit);
        // Fingers with no object between them stop before they meet.
        let is_free = pose.translation[0].abs() > 0.15 + SPEED;
        let way = hit.map_or(if is_free { 1.0 } else { 0.0 }, |hit| hit.toi);
        self.hits.extend(hit);
        pose.translation += inward * way;
        pose
    }
}

impl<const D: usize> Sample<D> for Gripper<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().choice("object", "Object", "ball", f32::BOUNDED).number(
            "angle",
            "Its angle",
            0.5,
            [-3.2, 3.2, 0.05],
        )
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
        let (shape, label) = (solid(panel.chosen("object"), 0.6), "object".to_owned());
        let position = turned([0.0; 3], panel.value("angle"));
        self.object = Some(world.add(position, shape, groups, query, label)?);
        let shape = ShapeHandle::new(finger());
        for (x, name) in [(-OPEN, "left finger"), (OPEN, "right finger")] {
            let position = at([x, 0.0, 0.0]);
            self.fingers.push(world.add(
                position,
                shape.clone(),
                groups,
                query,
                name.to_owned(),
            )?);
        }
        Ok(())
    }

    /// Replaces the object. The fingers start open again.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.rebuild(world, panel)
    }

    /// Closes the fingers and holds the object in the first two thirds of a cycle, and opens the
    /// fingers in the last third.
    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        self.hits.clear();
        let is_opening = self.step % STEPS > STEPS * 2 / 3;
        for finger in self.fingers.clone() {
            // A finger in contact is cast again in each step, and hits at time zero.
            let mut pose = pose_of(world, finger);
            if is_opening {
                let out = pose.translation[0];
                pose.translation[0] = min(out.abs() + SPEED, OPEN).copysign(out);
            } else {
                pose = self.close(world, pose);
            }
            world.set_position(finger, f32::isometry(&pose))?;
        }
        Ok(())
    }

    fn draw(&self, _: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        for hit in &self.hits {
            canvas.point(&hit.world1, 0.1, RED);
            canvas.line([hit.world1, hit.world1 + hit.normal.into_inner() * 0.5], RED);
        }
    }

    /// Returns the distance between the inner sides of the fingers, and the number of fingers that
    /// hit the object in the last step. The distance of the centres is larger by 0.3.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let xs = self.fingers.iter().map(|finger| pose_of(world, *finger).translation[0].abs());
        vec![
            Readout::number("Between the fingers", xs.sum::<f32>() - 0.3),
            Readout::new("Fingers that touch", self.hits.len()),
        ]
    }
}
