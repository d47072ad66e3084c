//! The objects nearest to a probe.

use impinge_record::{Detail, PlacedShape, Query, Question};
use impinge_scenes::asteroids;

use crate::prelude::*;
use crate::scene::Play;

/// An object that the query found, apart from the probe, and its distance.
#[derive(Debug)]
struct Near<const D: usize> {
    /// The closest points: the first on the probe, the second on the object.
    ends: [Point<f32, D>; 2],
    /// The distance between the closest points.
    distance: f32,
}

/// A ball, which the user can drag, in a field of asteroids.
#[derive(Debug, Default)]
pub(crate) struct Nearest<const D: usize> {
    /// The scene with the asteroids.
    play: Play<D>,
    /// The ball from which distances are measured.
    probe: Option<CollisionObjectHandle>,
    /// The found objects that do not overlap the probe, the nearest first.
    near: Vec<Near<D>>,
    step: usize,
    /// `true` after the user has dragged the probe.
    is_held: bool,
}

impl<const D: usize> Sample<D> for Nearest<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("count", "So many", 5.0, [1.0, 30.0, 1.0]).number(
            "reach",
            "Up to a distance of",
            20.0,
            [0.5, 50.0, 0.5],
        )
    }

    fn build(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        self.play = Play::start(asteroids(40), world)?;
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        let ball = ShapeHandle::new(Ball::new(0.4));
        let start = at([2.0, 8.0, 8.0]);
        self.probe = Some(world.add(start, ball, groups, query, "probe".to_owned())?);
        Ok(())
    }

    /// Moves the probe back and forth until the user drags it.
    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        if let Some(probe) = self.probe.filter(|_| !self.is_held) {
            let x = 2.0 + 14.0 * to_and_fro(number(self.step) / 900.0);
            world.set_position(probe, at([x, 8.0, 8.0]))?;
        }
        self.play.advance(world)
    }

    fn dragged(
        &mut self,
        world: &mut World<D>,
        object: CollisionObjectHandle,
        to: &Isometry<D>,
    ) -> Result<(), SampleError> {
        world.set_position(object, *to)?;
        self.is_held |= self.probe == Some(object);
        Ok(())
    }

    /// Finds the objects nearest to the probe, by the distances between the shapes. The probe
    /// itself is excluded, and objects that overlap it are dropped, since they have no closest
    /// points.
    fn updated(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let found = self.probe.and_then(|probe| world.collision_object(probe));
        let Some(probe) = found else { return Ok(()) };
        let from = PlacedShape { position: *probe.position(), shape: probe.shape().clone() };
        let count = u32::try_from(panel.count("count")).unwrap_or(u32::MAX);
        let question = Question::Nearest { from, count, max_distance: panel.value("reach") };
        let mut query = Query::new(question);
        query.excluded = vec![probe.handle()];
        let near = world.ask(&query)?.into_iter().filter_map(|found| match found.detail {
            Detail::Near { distance, points: ClosestPoints::WithinMargin(a, b) } => {
                Some(Near { ends: [a, b], distance })
            }
            _ => None,
        });
        self.near = near.collect();
        Ok(())
    }

    /// Draws a line to each found object: red to the nearest, blue to the others.
    fn draw(&self, _: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        for (rank, near) in self.near.iter().enumerate() {
            canvas.line(near.ends, if rank == 0 { RED } else { BLUE });
            canvas.point(&near.ends[1], 0.2, BLUE);
            canvas.text(&near.ends[1], &format!("{:.2}", near.distance), BLUE);
        }
    }

    fn readouts(&self, _: &World<D>, _: &Panel) -> Vec<Readout> {
        let distances = self.near.iter().map(|near| format!("{:.3}", near.distance));
        vec![Readout::new("Distances", distances.collect::<Vec<_>>().join(", "))]
    }
}
