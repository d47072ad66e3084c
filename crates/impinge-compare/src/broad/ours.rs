//! The broad phase of impinge.

use impinge::bounding_volume::Aabb;
use impinge::broad_phase::{BroadPhase, DBVTBroadPhase, ProxyHandle};
use impinge::math::{Point, Space};

use super::contender::{Contender, Event, Held, MARGIN};
use super::swarm::{Cell, Change};

/// A broad phase of impinge.
pub struct Impinge<const D: usize>
where
    f32: Space<D>,
{
    phase: DBVTBroadPhase<f32, Aabb<f32, D>, u32>,
    handles: Vec<ProxyHandle>,
    events: Vec<Event>,
    held: Held,
}

impl<const D: usize> Impinge<D>
where
    f32: Space<D>,
{
    /// Creates a broad phase that contains the boxes.
    pub fn new(cells: &[Cell<D>]) -> Self {
        let mut phase = DBVTBroadPhase::new(MARGIN);
        let create = |(n, cell)| phase.create_proxy(aabb(cell), n);
        let handles = (0..).zip(cells).map(create).collect();
        Self { phase, handles, events: Vec::new(), held: Held::default() }
    }
}

/// Converts a box to an AABB of impinge.
pub fn aabb<const D: usize>(cell: &Cell<D>) -> Aabb<f32, D>
where
    f32: Space<D>,
{
    Aabb::new(Point::from(cell.mins()), Point::from(cell.maxs()))
}

impl<const D: usize> Contender<D> for Impinge<D>
where
    f32: Space<D>,
{
    fn name(&self) -> &'static str {
        "impinge"
    }

    fn step(&mut self, change: &Change<D>) {
        let Self { phase, handles, events, .. } = self;
        events.clear();
        if !change.replaced.is_empty() {
            let gone: Vec<_> = change.replaced.iter().map(|(n, _)| handles[*n as usize]).collect();
            phase.remove(&gone, &mut |a, b| events.push((*a, *b, false)));
        }
        for (n, cell) in &change.replaced {
            handles[*n as usize] = phase.create_proxy(aabb(cell), *n);
        }
        for (n, cell) in &change.moved {
            phase.deferred_set_bounding_volume(handles[*n as usize], aabb(cell));
        }
        phase.update(&mut |_, _| true, &mut |a, b, started| events.push((*a, *b, started)));
    }

    fn settle(&mut self, _change: &Change<D>) {
        self.held.apply(self.events.drain(..));
    }

    fn pairs(&mut self) -> Vec<u64> {
        assert_eq!(self.held.pairs().len(), self.phase.num_interferences(), "events and pairs");
        self.held.pairs()
    }
}
