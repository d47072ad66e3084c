//! Determines the origin of coordinates and the size of typical objects in a stage.

use impinge::bounding_volume::Aabb;
use impinge::math::{Real, Space};
use impinge::world::CollisionWorld;

use crate::space::coordinates;

/// The largest magnitude of a drawn coordinate. Objects whose AABBs extend beyond it count as
/// unbounded, and elements with larger coordinates are not drawn. The square of this number is
/// within the range of `f32`.
pub(crate) const FAR: f64 = 1e18;

/// A box in `f64` and three dimensions; flat in 2D.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) mins: [f64; 3],
    pub(crate) maxs: [f64; 3],
}

impl Bounds {
    /// Converts a box; `None` if it is unbounded or has a coordinate beyond [`FAR`].
    pub(crate) fn of<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> Option<Self> {
        let [mins, maxs] = [aabb.mins(), aabb.maxs()].map(|point| coordinates(&point.coords));
        let is_near = mins.iter().chain(&maxs).all(|x| x.abs() <= FAR);
        is_near.then_some(Self { mins, maxs })
    }

    /// Returns the box around both boxes.
    fn joined(self, other: Self) -> Self {
        let mut both = self;
        for axis in 0..3 {
            both.mins[axis] = self.mins[axis].min(other.mins[axis]);
            both.maxs[axis] = self.maxs[axis].max(other.maxs[axis]);
        }
        both
    }

    pub(crate) fn center(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| f64::midpoint(self.mins[axis], self.maxs[axis]))
    }

    /// Returns half the length of the diagonal.
    pub(crate) fn radius(&self) -> f64 {
        let halves = [0, 1, 2].map(|axis| (self.maxs[axis] - self.mins[axis]) / 2.0);
        halves.iter().map(|half| half * half).sum::<f64>().sqrt()
    }
}

/// The origin of coordinates in frames, and the size of a typical object. The origin is 0 if the
/// world is near 0 in relation to its size, otherwise the centre of the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Framing {
    pub(crate) origin: [f64; 3],
    /// The median, over all bounded objects, of half the diagonal of the AABB. If the median is 0,
    /// an eighth of half the diagonal of the box around all objects; if that is 0 too, 1.
    pub(crate) size: f64,
    /// The distance from its origin up to which a half-space is drawn.
    pub(crate) patch: f64,
}

impl Framing {
    /// The framing of a world without bounded objects.
    pub(crate) const UNKNOWN: Self = Self { origin: [0.0; 3], size: 1.0, patch: 10.0 };

    /// Returns the framing of a world; `None` if the world has no objects.
    pub(crate) fn of<N: Space<D>, const D: usize, T>(
        world: &CollisionWorld<N, D, T>,
    ) -> Option<Self> {
        if world.is_empty() {
            return None;
        }
        let Some(bounds) = bounds(world) else { return Some(Self::UNKNOWN) };
        let mut sizes: Vec<f64> = boxes(world).map(|own| own.radius()).collect();
        sizes.sort_by(f64::total_cmp);
        let (center, radius) = (bounds.center(), bounds.radius());
        let middle = sizes[sizes.len() / 2];
        // Points have size zero, and a world with a single point has radius zero.
        let size = [middle, radius / 8.0].into_iter().find(|size| *size > 0.0).unwrap_or(1.0);
        let distance = center.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
        let is_near = distance <= 64.0 * radius.max(size);
        let origin = if is_near { [0.0; 3] } else { center };
        // A half-space is drawn larger than the objects that lie on it.
        Some(Self { origin, size, patch: (1.5 * radius).max(8.0 * size) })
    }
}

/// Returns the AABBs of the bounded objects.
fn boxes<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
) -> impl Iterator<Item = Bounds> {
    world
        .collision_objects()
        .filter_map(|object| Bounds::of(&object.shape().aabb(&N::pose(object.position()))))
}

/// Returns the box around all bounded objects; `None` if no object is bounded. Computes the AABBs
/// of all objects.
pub(crate) fn bounds<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
) -> Option<Bounds> {
    boxes(world).reduce(Bounds::joined)
}
