//! Scenes of `impinge-scenes`, such as rain, asteroids, terrain or thousands of boxes.

use impinge::narrow_phase::ContactEvent;
use impinge_scenes::Scene;

use crate::prelude::*;
use crate::scene::Play;

/// A function that creates a scene with a number of objects.
type MakeScene<const D: usize> = fn(usize) -> Scene<D>;

/// A scene whose positions are functions of the step.
#[derive(Debug)]
pub(crate) struct Scenery<const D: usize> {
    /// Creates the scene with a number of objects.
    make: MakeScene<D>,
    /// The initial and the maximum number of objects.
    counts: [u32; 2],
    /// The scene with its objects in the world.
    play: Play<D>,
    /// The number of times since the start that a pair began to touch.
    started: usize,
    /// The number of times since the start that a pair stopped touching.
    stopped: usize,
}

impl<const D: usize> Scenery<D> {
    /// Creates a sample with the initial and the maximum number of objects.
    pub(crate) fn new(make: MakeScene<D>, counts: [u32; 2]) -> Self {
        Self { make, counts, play: Play::default(), started: 0, stopped: 0 }
    }
}

impl<const D: usize> Sample<D> for Scenery<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        let [first, most] = self.counts.map(f64::from);
        Panel::new().number("count", "Objects", first, [10.0, most, 10.0])
    }

    /// Returns a margin for objects of size 1 that move by a few percent of their size in a step.
    fn margin(&self) -> f32 {
        0.04
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        (self.started, self.stopped) = (0, 0);
        self.play = Play::start((self.make)(panel.count("count")), world)?;
        Ok(())
    }

    /// Rebuilds the scene with the current count.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.rebuild(world, panel)
    }

    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.play.advance(world)
    }

    /// Counts the pairs that began or stopped touching, by events of contacts and of proximities.
    fn updated(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        let contacts =
            world.contact_events().iter().map(|event| matches!(event, ContactEvent::Started(..)));
        let proximities = world.proximity_events().iter().filter_map(|event| {
            let [before, after] = [event.prev_status, event.new_status]
                .map(|status| status == Proximity::Intersecting);
            (before != after).then_some(after)
        });
        for began in contacts.chain(proximities) {
            *(if began { &mut self.started } else { &mut self.stopped }) += 1;
        }
        Ok(())
    }

    /// Returns the numbers of pairs, and how often pairs began and stopped touching since the
    /// start. A pair exists while the fat AABBs overlap, with contacts or without.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        vec![
            Readout::new("Pairs with contacts kept", world.contact_pairs().count()),
            Readout::new("Pairs with proximity kept", world.proximity_pairs().count()),
            Readout::new("Came to touch", self.started),
            Readout::new("Parted", self.stopped),
        ]
    }
}
