//! The time of impact of two rotating solids.

use impinge::query::{RigidMotion, nonlinear_time_of_impact};

use crate::prelude::*;

/// The maximum time of the impact, in seconds.
const SECONDS: f32 = 4.0;
/// The time after the impact before the motion starts again, in seconds.
const PAUSE: f32 = 1.0;

/// Two rotating bars that fly towards each other. Their first contact is computed at the start, and
/// they stop at its time.
#[derive(Debug, Default)]
pub(crate) struct Spinning<const D: usize> {
    /// The left bar, then the right one.
    bars: Vec<CollisionObjectHandle>,
    /// The first contact of the bars; `None` if there is none within the maximum time.
    hit: Option<Impact<f32, D>>,
    /// The time since the start, in seconds.
    time: f32,
}

impl<const D: usize> Spinning<D>
where
    f32: Dimension<D>,
{
    /// Returns the motions of both bars as functions of time, from which their positions and the
    /// impact are computed.
    fn motions(panel: &Panel) -> [Box<dyn RigidMotion<f32, D>>; 2] {
        let linear = vector([0.6, 0.0, 0.0]);
        let offset = panel.value("offset");
        let left = turned([-2.0, -0.5 * offset, 0.0], 0.3);
        let right = turned([2.0, 0.5 * offset, 0.0], 1.9);
        [
            f32::spinning(left, linear, panel.value("spin")),
            f32::spinning(right, -linear, panel.value("spin2")),
        ]
    }

    /// Returns the time of the impact, or the maximum time if there is none.
    fn end(&self) -> f32 {
        self.hit.map_or(SECONDS, |hit| hit.toi)
    }
}

/// Returns the shape of both bars: 2.4 long and 0.08 thick.
fn bar<const D: usize>() -> Cuboid<f32, D> {
    Cuboid::new(vector([1.2, 0.04, 0.3]))
}

impl<const D: usize> Sample<D> for Spinning<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .number("spin", "Turn of the left, radians per second", 4.0, [-30.0, 30.0, 0.1])
            .number("spin2", "Turn of the right", -7.0, [-30.0, 30.0, 0.1])
            .number("offset", "How far they pass each other", 0.8, [-3.0, 3.0, 0.05])
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
        let (shape, motions) = (ShapeHandle::new(bar()), Self::motions(panel));
        self.bars.clear();
        for (motion, label) in motions.iter().zip(["left", "right"]) {
            let start = motion.position_at(0.0);
            self.bars.push(world.add(start, shape.clone(), groups, query, label.to_owned())?);
        }
        self.changed(world, panel)
    }

    /// Computes the impact without stepping, so no contact is missed, however thin or fast the bars
    /// are.
    fn changed(&mut self, _: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let (bar, [left, right]) = (bar(), Self::motions(panel));
        let options = ImpactOptions::new().with_max_time(SECONDS);
        self.hit = nonlinear_time_of_impact(&*left, &bar, &*right, &bar, &options);
        self.time = 0.0;
        Ok(())
    }

    /// Moves the bars until the impact, and starts again after a pause.
    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        self.time += TIME_STEP;
        if self.time > self.end() + PAUSE {
            self.time = 0.0;
        }
        let (motions, time) = (Self::motions(panel), min(self.time, self.end()));
        for (bar, motion) in self.bars.iter().zip(&motions) {
            world.set_position(*bar, motion.position_at(time))?;
        }
        Ok(())
    }

    /// Draws the point and the normal of the impact, even before it happens.
    fn draw(&self, _: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        if let Some(hit) = &self.hit {
            canvas.point(&hit.world1, 0.15, RED);
            canvas.line([hit.world1, hit.world1 + hit.normal.into_inner()], RED);
        }
    }

    /// Returns the time of impact, the current time and the distance, which is zero at the time of
    /// impact and positive before.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let &[left, right] = self.bars.as_slice() else { return Vec::new() };
        let poses = [left, right].map(|object| isometry(&pose_of(world, object)));
        vec![
            Readout::optional("Time of impact", self.hit.map(|hit| hit.toi)),
            Readout::number("Time", min(self.time, self.end())),
            Readout::number("Distance", distance(&poses[0], &bar(), &poses[1], &bar())),
        ]
    }
}
