//! The broad phase of ncollide, whose interface is the model of that of impinge.

use super::ncollide::bounding_volume::{AABB, BoundingVolume};
use super::ncollide::math::Point;
use super::ncollide::pipeline::broad_phase::{
    BroadPhase, BroadPhaseInterferenceHandler, BroadPhaseProxyHandle, DBVTBroadPhase,
};

use super::D;
use crate::broad::contender::{Contender, Event, Held, MARGIN};
use crate::broad::swarm::{Cell, Change};

/// A broad phase of ncollide.
pub struct Ncollide {
    phase: DBVTBroadPhase<f32, AABB<f32>, u32>,
    handles: Vec<BroadPhaseProxyHandle>,
    events: Events,
    held: Held,
}

/// The events of a step, collected by the callback of ncollide.
struct Events(Vec<Event>);

impl BroadPhaseInterferenceHandler<u32> for Events {
    fn is_interference_allowed(&mut self, _: &u32, _: &u32) -> bool {
        true
    }

    fn interference_started(&mut self, a: &u32, b: &u32) {
        self.0.push((*a, *b, true));
    }

    fn interference_stopped(&mut self, a: &u32, b: &u32) {
        self.0.push((*a, *b, false));
    }
}

impl Ncollide {
    /// Creates a broad phase that contains the boxes.
    pub fn new(cells: &[Cell<D>]) -> Self {
        let mut phase = DBVTBroadPhase::new(MARGIN);
        // ncollide enlarges boxes when they change, but not when they are created.
        let create = |(n, cell)| phase.create_proxy(aabb(cell).loosened(MARGIN), n);
        let handles = (0..).zip(cells).map(create).collect();
        Self { phase, handles, events: Events(Vec::new()), held: Held::default() }
    }
}

fn aabb(cell: &Cell<D>) -> AABB<f32> {
    AABB::new(Point::from(cell.mins()), Point::from(cell.maxs()))
}

impl Contender<D> for Ncollide {
    fn name(&self) -> &'static str {
        "ncollide"
    }

    fn step(&mut self, change: &Change<D>) {
        let Self { phase, handles, events, .. } = self;
        events.0.clear();
        if !change.replaced.is_empty() {
            let gone: Vec<_> = change.replaced.iter().map(|(n, _)| handles[*n as usize]).collect();
            phase.remove(&gone, &mut |a, b| events.0.push((*a, *b, false)));
        }
        for (n, cell) in &change.replaced {
            handles[*n as usize] = phase.create_proxy(aabb(cell).loosened(MARGIN), *n);
        }
        for (n, cell) in &change.moved {
            phase.deferred_set_bounding_volume(handles[*n as usize], aabb(cell));
        }
        phase.update(events);
    }

    fn settle(&mut self, _change: &Change<D>) {
        self.held.apply(self.events.0.drain(..));
    }

    fn pairs(&mut self) -> Vec<u64> {
        self.held.pairs()
    }
}
