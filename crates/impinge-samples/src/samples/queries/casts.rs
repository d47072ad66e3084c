//! A shape cast, and the objects that it hits.

use impinge_record::{CastQuestion, Detail, PlacedShape, Query, Question};

use crate::prelude::*;

/// The length of the path of a cast.
const LENGTH: f32 = 9.0;

/// Posts around the origin, and a solid that is cast from the origin in a rotating direction.
#[derive(Debug, Default)]
pub(crate) struct Casts<const D: usize> {
    /// The direction of the cast, in radians from x to y.
    angle: f32,
    /// The impacts of the last cast, sorted by time.
    hits: Vec<Impact<f32, D>>,
}

impl<const D: usize> Casts<D>
where
    f32: Dimension<D>,
{
    /// Returns the cast of the rotated solid from the origin. The velocity is the vector from the
    /// start to the end of the path.
    fn question(&self, panel: &Panel) -> CastQuestion<f32, D> {
        let velocity = turn::<D>([0, 1], self.angle) * vector::<D>([LENGTH, 0.0, 0.0]);
        let shape = solid(panel.chosen("solid"), panel.value("size"));
        CastQuestion {
            start: PlacedShape { position: turned([0.0; 3], 3.0 * self.angle), shape },
            velocity,
            // The solid reaches the end of the path at time 1.
            options: ImpactOptions::new()
                .with_max_time(1.0)
                .with_target_distance(panel.value("gap")),
        }
    }
}

impl<const D: usize> Sample<D> for Casts<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .choice("solid", "Solid", "box", f32::BOUNDED)
            .number("size", "Its size", 0.5, [0.05, 1.0, 0.05])
            .number("gap", "Distance at which it stops", 0.0, [0.0, 0.5, 0.01])
            .flag("all", "All it would hit", false)
    }

    /// Adds solids of all kinds around the origin, at different distances.
    fn build(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        for n in 0..14 {
            let direction = turn::<D>([0, 1], TAU * number(n) / 14.0);
            let place = direction * vector::<D>([3.5 + 4.0 * scattered(n, 0), 0.0, 0.0]);
            let kind = f32::BOUNDED[n % f32::BOUNDED.len()];
            let position = f32::isometry(&Pose { rotation: direction, translation: place });
            let shape = solid(kind, 0.5 + 0.4 * scattered(n, 1));
            world.add(position, shape, groups, query, kind.to_owned())?;
        }
        Ok(())
    }

    /// Rotates the direction of the cast. A cast is a query, which changes no object.
    fn advance(&mut self, _: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.angle += TAU / 720.0;
        Ok(())
    }

    /// Runs the cast. Finding only the first impact is faster than finding all impacts.
    fn updated(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let cast = self.question(panel);
        let question = if panel.is_set("all") {
            Question::CastShapeAll(cast)
        } else {
            Question::CastShape(cast)
        };
        let answer = world.ask(&Query::new(question))?;
        let impacts = answer.into_iter().filter_map(|found| match found.detail {
            Detail::Impact(hit) => Some(hit),
            _ => None,
        });
        self.hits = impacts.collect();
        Ok(())
    }

    /// Draws the solid at the start, at the impacts and at the end of the path.
    fn draw(&self, _: &World<D>, panel: &Panel, canvas: &mut Canvas<'_, D>) {
        let CastQuestion { start, velocity, .. } = self.question(panel);
        let (shape, position) = (&start.shape, start.position);
        let sweep = SweptShape { shape, position, velocity, max_time: 1.0 };
        // The drawing of an impact includes the whole path. Without impacts, the path is drawn
        // alone.
        if self.hits.is_empty() {
            canvas.drawing.cast(&sweep, None, canvas.renderer);
        }
        for hit in &self.hits {
            canvas.drawing.cast(&sweep, Some(hit), canvas.renderer);
        }
    }

    fn readouts(&self, _: &World<D>, _: &Panel) -> Vec<Readout> {
        let first = self.hits.first().map(|hit| hit.toi * LENGTH);
        vec![
            Readout::new("Objects hit", self.hits.len()),
            Readout::optional("Way to the first", first),
        ]
    }
}
