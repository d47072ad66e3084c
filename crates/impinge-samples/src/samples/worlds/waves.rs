//! A surface that changes its shape at each step, and balls on it.

use impinge::math::Real;

use crate::prelude::*;

/// The period of the wave in steps. The shapes of a period are computed at the start, and again for
/// another amplitude.
const PERIOD: usize = 60;
/// The number of cells of the surface along each axis.
const CELLS: usize = 16;

/// A surface with the shapes of one period, and balls that follow it.
#[derive(Debug, Default)]
pub(crate) struct Waves<const D: usize> {
    /// The shape at each step of a period.
    surfaces: Vec<ShapeHandle<f32, D>>,
    /// The object whose shape is replaced in each step.
    surface: Option<CollisionObjectHandle>,
    /// The objects of the balls, from left to right.
    balls: Vec<CollisionObjectHandle>,
    step: usize,
}

/// Returns the height of the wave at a point. `phase` is from 0 to 1.
fn height(x: f32, z: f32, phase: f32, amplitude: f32) -> f32 {
    let along = 0.7 * x + 0.4 * z;
    amplitude * Real::sine_cosine(along - TAU * phase).0
}

impl<const D: usize> Waves<D>
where
    f32: Dimension<D>,
{
    /// Computes a height field for each step of a period.
    fn make_surfaces(&mut self, panel: &Panel) {
        let amplitude = panel.value("amplitude");
        let surface = |n: usize| {
            let phase = number(n) / number(PERIOD);
            f32::surface(CELLS, SurfaceKind::Field, &|x, z| height(x, z, phase, amplitude))
        };
        self.surfaces = (0..PERIOD).map(surface).collect();
    }

    /// Returns the position at which a ball of radius 0.4 lands if it falls vertically. A cast
    /// against the current surface determines this position.
    fn fallen(&self, ball: usize) -> Isometry<D> {
        let above = [2.0 * number(ball) - 6.0, 10.0, scattered(ball, 0) * 8.0 - 4.0];
        let (shape, here) = (Ball::new(0.4), isometry(&Pose::identity()));
        let surface = &self.surfaces[self.step % PERIOD];
        // The world is not used, since it still contains the surface of the previous step.
        let still = Moving::still(&here, &**surface);
        let start = isometry(&Pose::from_translation(vector::<D>(above)));
        let falling = Moving::new(&start, &vector([0.0, -1.0, 0.0]), &shape);
        let hit = impact(&still, &falling, &ImpactOptions::new());
        // The ball penetrates the surface by 0.005, like a body under gravity.
        let fall = hit.map_or(0.0, |hit| hit.toi + 0.005);
        at([above[0], above[1] - fall, above[2]])
    }
}

impl<const D: usize> Sample<D> for Waves<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("amplitude", "Height of the waves", 0.6, [0.0, 1.5, 0.05])
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        self.make_surfaces(panel);
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
        let surface = self.surfaces[0].clone();
        self.surface = Some(world.add(at([0.0; 3]), surface, groups, query, "sea".to_owned())?);
        let shape = ShapeHandle::new(Ball::new(0.4));
        for ball in 0..7 {
            let (position, label) = (self.fallen(ball), format!("ball {ball}"));
            self.balls.push(world.add(position, shape.clone(), groups, query, label)?);
        }
        Ok(())
    }

    /// Computes the surfaces with the new amplitude, which are used from the next step on.
    fn changed(&mut self, _: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.make_surfaces(panel);
        Ok(())
    }

    /// Replaces the surface, then moves the balls. One update of the world handles both.
    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        if let Some(surface) = self.surface {
            world.set_shape(surface, self.surfaces[self.step % PERIOD].clone())?;
        }
        for (index, ball) in self.balls.iter().enumerate() {
            world.set_position(*ball, self.fallen(index))?;
        }
        Ok(())
    }

    /// Returns the number of manifolds, and the maximum of 1 − |y| over the normals, which is 0 on
    /// a horizontal surface.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let deepest = world.contact_views().map(|(_, _, manifold)| manifold.deepest_contact());
        let steepest = deepest.map(|point| 1.0 - point.contact.normal[1].abs()).reduce(max);
        vec![
            Readout::new("Balls on the surface", world.contact_views().count()),
            Readout::number("Steepest normal, 1 − |y|", steepest.unwrap_or(0.0)),
        ]
    }
}
