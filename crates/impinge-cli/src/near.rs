//! Finds the pairs of objects that may be near each other, without storing the pairs.

use core::cell::Cell;
use core::cmp::Ordering;

use impinge::batch::{BatchError, Control, Shapes, Side, boxes};
use impinge::bounding_volume::{Aabb, BoundingVolume as _};
use impinge::partitioning::BoxTree;
use impinge::world::{CollisionObject, CollisionWorld};

use crate::error::CliError;
use crate::itself;
use crate::space::Stage;

/// The relative enlargement of distances against rounding errors, in units of the machine epsilon.
const ROUNDING_ERRORS: f64 = 1024.0;

/// The objects of a world, and a tree of their bounding boxes.
pub(crate) struct Boxed<'a, N: Stage<D>, const D: usize, T> {
    objects: Vec<&'a CollisionObject<N, D, T>>,
    tree: BoxTree<N, D>,
    /// For each box of the tree, the index of its object. Composites without parts have no box and
    /// are not in the tree.
    owners: Vec<usize>,
}

impl<'a, N: Stage<D>, const D: usize, T> Boxed<'a, N, D, T> {
    /// Computes the boxes of all objects of a world. O(n log n).
    pub(crate) fn new(world: &'a CollisionWorld<N, D, T>) -> Result<Self, CliError> {
        let objects: Vec<_> = world.collision_objects().collect();
        let shapes: Vec<_> = objects.iter().map(|object| object.shape().clone()).collect();
        let poses: Vec<_> = objects.iter().map(|object| N::pose(object.position())).collect();
        let refused = |error: BatchError| CliError::Objects(error.to_string());
        let side = Side::try_new(Shapes::Each(&shapes), &poses).map_err(refused)?;
        let found = boxes(&side, &Control::new()).map_err(refused)?;
        let (owners, found): (Vec<_>, Vec<_>) =
            found.into_iter().enumerate().filter_map(|(index, aabb)| Some((index, aabb?))).unzip();
        let tree = BoxTree::try_from_boxes(&found);
        let tree = tree.map_err(|error| CliError::Objects(error.to_string()))?;
        Ok(Self { objects, tree, owners })
    }

    /// Returns the object with this index, in the order of the world.
    pub(crate) fn object(&self, index: u32) -> &'a CollisionObject<N, D, T> {
        self.objects[index as usize]
    }

    /// Returns the number of objects.
    pub(crate) fn len(&self) -> usize {
        self.objects.len()
    }

    /// Calls `visit` with the indices of two objects, the lower index first, for each pair that may
    /// interact by its groups and whose boxes are near each other. The boxes of a pair are near if
    /// they overlap after the first is enlarged on all sides by `reach` of its object. An object
    /// that is tested against itself is a pair with itself. `goes_on` is called before each object,
    /// and ends the search if it returns `false`.
    pub(crate) fn each(
        &self,
        reach: impl Fn(&CollisionObject<N, D, T>) -> N,
        mut visit: impl FnMut([u32; 2]),
        goes_on: impl Fn() -> bool,
    ) {
        for (place, (owner, aabb)) in self.owners.iter().zip(self.tree.boxes()).enumerate() {
            if !goes_on() {
                return;
            }
            let own = self.objects[*owner];
            let searched = grown(aabb, reach(own));
            self.tree.visit_overlapping(&searched, |found| {
                let other = self.objects[self.owners[found]];
                let groups = own.collision_groups();
                let may = match place.cmp(&found) {
                    Ordering::Less => groups.can_interact_with_groups(other.collision_groups()),
                    Ordering::Equal => itself::is_tested(own),
                    Ordering::Greater => false,
                };
                if may {
                    visit([*owner, self.owners[found]].map(number));
                }
            });
        }
    }
}

/// Converts the index of an object to the 32 bits that a tree uses.
fn number(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}

/// Returns a box enlarged by `reach` on all sides, with an allowance for rounding errors.
fn grown<N: Stage<D>, const D: usize>(aabb: &Aabb<N, D>, reach: N) -> Aabb<N, D> {
    let reach = reach * (N::ONE + N::EPSILON * N::lit(ROUNDING_ERRORS));
    aabb.loosened(reach)
}

/// Returns an error if the next update of a world could store more than `limit` pairs. The counted
/// pairs are those whose boxes overlap after they are enlarged by `margin`, by the query limit of
/// one object and by the largest query limit of all objects.
///
/// If there are so few objects that all their pairs are within the limit, nothing is computed.
/// Otherwise the search takes O(n log n) for n objects, plus a constant time for each pair up to
/// the limit.
pub(crate) fn check_pairs<N: Stage<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    margin: f64,
    limit: usize,
) -> Result<(), CliError> {
    let objects = world.len();
    if objects.saturating_mul(objects.saturating_sub(1)) / 2 <= limit {
        return Ok(());
    }
    let reach = |object: &CollisionObject<N, D, T>| object.query_type().query_limit();
    let longest = world.collision_objects().map(reach).fold(N::ZERO, impinge::math::max);
    let others = N::lit(2.0 * margin) + longest;
    let count = Cell::new(0_usize);
    let visit = |_| count.set(count.get() + 1);
    Boxed::new(world)?.each(|object| others + reach(object), visit, || count.get() <= limit);
    if count.get() > limit { Err(CliError::TooManyPairs { limit }) } else { Ok(()) }
}
