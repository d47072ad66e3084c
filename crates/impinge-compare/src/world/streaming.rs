//! impinge, read through a stream of contacts.

use impinge::math::Space;
use impinge::narrow_phase::ContactStream;

use super::contender::{Change, Contender, Reading};
use super::ours::Impinge;

/// A world of impinge whose contacts are read through a [`ContactStream`]. For each contact, the
/// stream also stores the index that the contact had at the previous reading, if it existed then.
pub struct Streaming<const D: usize>
where
    f32: Space<D>,
{
    inner: Impinge<D>,
    stream: ContactStream<f32, D>,
}

impl<const D: usize> Streaming<D>
where
    f32: Space<D>,
{
    /// Creates the contender from a world, with an empty stream.
    pub fn new(inner: Impinge<D>) -> Self {
        Self { inner, stream: ContactStream::new() }
    }
}

impl<const D: usize> Contender<D> for Streaming<D>
where
    f32: Space<D>,
{
    fn prepare(&mut self, change: &Change<D>) {
        self.inner.prepare(change);
    }

    fn step(&mut self) {
        self.inner.step();
    }

    fn read(&mut self) -> Reading {
        self.inner.world().read_contacts(&mut self.stream);
        let points = self.stream.points();
        let depth = points.iter().map(|point| f64::from(std::hint::black_box(point).depth)).sum();
        Reading { points: points.len(), depth }
    }

    fn touching(&self) -> Vec<(usize, usize)> {
        self.inner.touching()
    }
}
