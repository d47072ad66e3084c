//! Contact kernels for pairs of balls, segments, capsules and boxes: 8 pairs at a time, or a single
//! pair.
//!
//! ```text
//!   kept pairs i .. i + L      gather      find (kernel)      write_manifold, lane by lane
//!    [q][q][q][q]...  ------>  Inputs  ------->  Found  ---+--> raw manifold of pair i + lane
//!                             rows of L         rows,   |
//!                                               masks   +--> unsupported: `fall_back`, one pair
//!
//!   kinds, in canonical order            2D             3D
//!   ball, ball                           `BallBall`     `BallBall`
//!   ball, segment or capsule             `BallSegment`  `BallSegment`
//!   ball, box                            `BallCuboid`   `BallCuboid`
//!   two segments or capsules             `Segments2`    `Segments3`
//!   box, box                             `Boxes2`       `Boxes3`
//! ```
//!
//! Each lane of a vector holds one pair and never depends on other lanes, so the result of a pair
//! is bit-identical in any batch. [`gather`] copies the numbers of `L` pairs into rows, a kernel
//! ([`Batch`]) computes everything that needs no branches, then the manifolds are replaced one by
//! one. `L` is 8 if [`Level::vectors`] returns vectors; else it is 1, and [`OneLane`] computes with
//! scalars. A query of a single pair is a batch of one lane on every machine. Pairs that a kernel
//! does not support fall back to the builder for one pair ([`PairQuestion::fall_back`]): for
//! example a ball with its centre inside a box, segments that cross, sizes whose squares underflow
//! or overflow, and NaN.
//!
//! Each mask is a byte whose bit `lane` belongs to the pair in that lane. [`masks`] transposes 8
//! masks into one byte per pair. `boxes/` defines the slots of box pairs (one slot for each
//! possible contact point) and the codes of their contact points.
//!
//! The idea of one pair per lane comes from bepuphysics (R. Nordby).

mod ball_ball;
mod ball_cuboid;
mod ball_segment;
mod boxes;
mod closed_form;
mod convex;
mod gather;
mod masks;
mod nearest;
mod segments2;
mod segments3;
mod solid;
#[cfg(test)]
mod tests;
mod vectors;

use self::ball_ball::BallBall;
use self::ball_cuboid::BallCuboid;
use self::ball_segment::BallSegment;
use self::boxes::{Boxes2, Boxes3};
use self::closed_form::ClosedForm;
pub(crate) use self::convex::{ConvexPair, distances2, distances3, separations2, separations3};
use self::gather::Inputs;
use self::segments2::Segments2;
use self::segments3::Segments3;
pub(crate) use self::solid::Solid;
use super::Pair;
use crate::collide::{ManifoldRequest, RawManifold};
use crate::math::lanes::with_vectors;
use crate::math::lone::OneLane;
use crate::math::simd::{Level, Simd, Vectors};
use crate::math::{Mapped, Pose, Real, Space, Wide};
use crate::shape::Geometry;
use crate::tables::ByDimension;

/// Number of pairs in one batch if the kernels use SIMD vectors; also the number of bits in a mask.
const LANES: usize = 8;

/// A pair of solids in canonical order and the request for its manifold.
pub(crate) struct PairQuestion<'a, N: Real, const D: usize> {
    /// Poses of both solids in a common frame, usually the world.
    pub(crate) poses: [&'a Pose<N, D>; 2],
    /// Copies of both solids, in canonical order.
    pub(crate) solids: [&'a Solid<N, D>; 2],
    pub(crate) request: &'a ManifoldRequest<N>,
}

impl<N: Space<D>, const D: usize> PairQuestion<'_, N, D> {
    /// Builds the manifold of an unsupported pair from its separation, by the builder for one pair.
    #[inline(never)]
    fn fall_back(&self, raw: &mut RawManifold<N, D>) {
        let pair = Pair::new(self.solids.mapped(|solid| Geometry(solid.kind())), self.poses);
        <N::Algorithms>::contacts_of_separation(&pair, self.request, raw);
    }
}

/// Pairs of the same kinds whose manifolds the caller keeps.
///
/// For each index in order, [`update`] calls `begin` while it gathers, then `raw`, then `parts` if
/// the pair falls back, and last `end`. The next batch begins before the pairs of this batch end.
pub(crate) trait KeptPairs<N: Real, const D: usize> {
    /// Returns the number of pairs.
    fn len(&self) -> usize;

    /// Begins the update of the pair at `index` and returns its inputs. Called once for each pair.
    fn begin(&mut self, index: usize) -> PairQuestion<'_, N, D>;

    /// Returns the inputs of the pair at `index`, whose update has begun, and the manifold of its
    /// last update, which [`update`] overwrites.
    fn parts(&mut self, index: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>);

    /// Returns the manifold of the last update of the pair at `index`, which [`update`] overwrites.
    fn raw(&mut self, index: usize) -> &mut RawManifold<N, D>;

    /// Ends the update of the pair at `index`: its manifold is complete.
    fn end(&mut self, index: usize);
}

/// Algorithm for all pairs with one combination of kinds, `L` pairs at a time.
trait Batch<N: Real, const D: usize> {
    /// Results of the kernel, from which [`Self::write_manifold`] builds each manifold.
    type Found<const L: usize>;

    /// Returns initial results, in which no lane has a manifold.
    fn blank<const L: usize>() -> Self::Found<L>;

    /// Copies the inputs of a pair into a lane; returns whether this algorithm supports the pair.
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, D, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, D>,
    ) -> bool;

    /// Computes, for all lanes at once, everything that needs no branches, and stores it in
    /// `found`.
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, D, L>,
        found: &mut Self::Found<L>,
    );

    /// Replaces the points of the pair in `lane` by at most `max_points` points, or clears them if
    /// the solids are beyond the prediction. Returns `false`, without a change, if the pair has to
    /// fall back to the builder for one pair.
    fn write_manifold<const L: usize>(
        found: &Self::Found<L>,
        lane: usize,
        max_points: usize,
        raw: &mut RawManifold<N, D>,
    ) -> bool;
}

/// An operation that is generic over the algorithm for two kinds of solids.
trait Task<N: Space<D>, const D: usize> {
    /// Runs the operation with the algorithm `B`; returns whether it succeeded.
    fn run<B: Batch<N, D>>(self) -> bool;
}

/// Updates pairs in 2D that all have the kinds of `solids`, the solids of the first pair. Returns
/// `false`, with nothing changed, if these kinds have no kernel.
pub(crate) fn update_pairs2<N: Space<2>>(
    solids: [&Solid<N, 2>; 2],
    pairs: &mut impl KeptPairs<N, 2>,
) -> bool {
    run2(solids, Many { level: Level::new(), pairs })
}

/// Updates pairs in 3D that all have the kinds of `solids`, the solids of the first pair. Returns
/// `false`, with nothing changed, if these kinds have no kernel.
pub(crate) fn update_pairs3<N: Space<3>>(
    solids: [&Solid<N, 3>; 2],
    pairs: &mut impl KeptPairs<N, 3>,
) -> bool {
    run3(solids, Many { level: Level::new(), pairs })
}

/// Updates the manifold of one pair in 2D; returns `false`, with nothing changed, if its kinds have
/// no kernel or the kernel does not support the pair.
pub(crate) fn update_pair2<N: Space<2>>(
    question: &PairQuestion<'_, N, 2>,
    raw: &mut RawManifold<N, 2>,
) -> bool {
    run2(question.solids, One { question, raw })
}

/// Updates the manifold of one pair in 3D; returns `false`, with nothing changed, if its kinds have
/// no kernel or the kernel does not support the pair.
pub(crate) fn update_pair3<N: Space<3>>(
    question: &PairQuestion<'_, N, 3>,
    raw: &mut RawManifold<N, 3>,
) -> bool {
    run3(question.solids, One { question, raw })
}

/// Computes the contact points of a pair in canonical order, as a batch of one. Returns `false`,
/// with `raw` unchanged, if its kinds have no kernel or the kernel does not support the pair.
pub(crate) fn contacts_in_lanes<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    request: &ManifoldRequest<N>,
    raw: &mut RawManifold<N, D>,
) -> bool {
    let [one, other] = [Solid::of(Geometry(pair.first)), Solid::of(Geometry(pair.second))];
    let (Some(one), Some(other)) = (one, other) else { return false };
    let poses = [&Pose::identity(), &pair.pose12];
    let question = PairQuestion { poses, solids: [&one, &other], request };
    <N::Algorithms>::update_pair(&question, raw)
}

/// Runs a task with the algorithm for two solids in 2D; returns `false` if their kinds have no
/// algorithm or the task fails.
fn run2<N: Space<2>>([one, other]: [&Solid<N, 2>; 2], task: impl Task<N, 2>) -> bool {
    match (one, other) {
        (Solid::Cuboid(_), Solid::Cuboid(_)) => task.run::<Boxes2>(),
        _ if one.is_segment() && other.is_segment() => task.run::<ClosedForm<Segments2>>(),
        _ => run_with_ball([one, other], task),
    }
}

/// Runs a task with the algorithm for two solids in 3D; returns `false` if their kinds have no
/// algorithm or the task fails.
fn run3<N: Space<3>>([one, other]: [&Solid<N, 3>; 2], task: impl Task<N, 3>) -> bool {
    match (one, other) {
        (Solid::Cuboid(_), Solid::Cuboid(_)) => task.run::<Boxes3>(),
        _ if one.is_segment() && other.is_segment() => task.run::<ClosedForm<Segments3>>(),
        _ => run_with_ball([one, other], task),
    }
}

/// Runs a task with the algorithm for a ball and another solid; returns `false` if no solid is a
/// ball or the task fails.
fn run_with_ball<N: Space<D>, const D: usize>(
    solids: [&Solid<N, D>; 2],
    task: impl Task<N, D>,
) -> bool {
    match solids {
        [Solid::Ball(_), Solid::Ball(_)] => task.run::<ClosedForm<BallBall>>(),
        [Solid::Ball(_), Solid::Cuboid(_)] | [Solid::Cuboid(_), Solid::Ball(_)] => {
            task.run::<ClosedForm<BallCuboid>>()
        }
        [Solid::Ball(_), _] | [_, Solid::Ball(_)] => task.run::<ClosedForm<BallSegment>>(),
        _ => false,
    }
}

/// Task that updates one pair.
struct One<'a, 'q, N: Real, const D: usize> {
    question: &'a PairQuestion<'q, N, D>,
    raw: &'a mut RawManifold<N, D>,
}

impl<N: Space<D>, const D: usize> Task<N, D> for One<'_, '_, N, D> {
    #[inline(never)]
    fn run<B: Batch<N, D>>(self) -> bool {
        let Self { question, raw } = self;
        let (mut inputs, mut found) = (Inputs::<N, D, 1>::new(), B::blank::<1>());
        inputs.put::<B>(0, question);
        LonePair.find::<B, N, D>(&inputs, &mut found);
        B::write_manifold(&found, 0, question.request.max_points, raw)
    }
}

/// Task that updates many pairs; it always succeeds.
struct Many<'a, P> {
    level: Level,
    pairs: &'a mut P,
}

impl<N: Space<D>, P: KeptPairs<N, D>, const D: usize> Task<N, D> for Many<'_, P> {
    fn run<B: Batch<N, D>>(self) -> bool {
        match self.level.vectors() {
            Some(vectors) => update::<B, _, _, D, LANES>(VectorLanes(vectors), self.pairs),
            None => update::<B, _, _, D, 1>(LonePair, self.pairs),
        }
        true
    }
}

/// Runs the kernels in `L` lanes, with SIMD vectors or with scalars.
trait BatchLanes<const L: usize>: Copy {
    /// Runs [`Batch::find`]; compiled once for all implementations of [`KeptPairs`].
    fn find<B: Batch<N, D>, N: Real, const D: usize>(
        self,
        inputs: &Inputs<N, D, L>,
        found: &mut B::Found<L>,
    );
}

/// Eight lanes, computed with SIMD vectors.
#[derive(Clone, Copy)]
struct VectorLanes(Vectors);

impl BatchLanes<LANES> for VectorLanes {
    #[inline(never)]
    fn find<B: Batch<N, D>, N: Real, const D: usize>(
        self,
        inputs: &Inputs<N, D, LANES>,
        found: &mut B::Found<LANES>,
    ) {
        let vectors = self.0;
        with_vectors!(vectors, simd => B::find::<_, N::Lanes<_>, LANES>(simd, inputs, found));
    }
}

/// One lane, computed without SIMD vectors.
#[derive(Clone, Copy)]
struct LonePair;

impl BatchLanes<1> for LonePair {
    #[inline(never)]
    fn find<B: Batch<N, D>, N: Real, const D: usize>(
        self,
        inputs: &Inputs<N, D, 1>,
        found: &mut B::Found<1>,
    ) {
        B::find::<_, N::Lanes<_>, 1>(OneLane(0), inputs, found);
    }
}

/// Updates all pairs, `L` at a time, with the algorithm `B`. The inputs of the next batch are
/// gathered before the kernel reads the inputs of this batch, to hide memory latency.
fn update<B: Batch<N, D>, P: KeptPairs<N, D>, N: Space<D>, const D: usize, const L: usize>(
    lanes: impl BatchLanes<L>,
    pairs: &mut P,
) {
    let (mut now, mut next) = (&mut Inputs::<N, D, L>::new(), &mut Inputs::new());
    let mut found = B::blank::<L>();
    // Two buffers: the inputs of the next batch are already in `next` when the kernel reads `now`.
    now.gather::<B, P>(pairs, 0);
    while now.count > 0 {
        next.gather::<B, P>(pairs, now.first + now.count);
        lanes.find::<B, N, D>(now, &mut found);
        for lane in 0..now.count {
            let index = now.first + lane;
            if !B::write_manifold(&found, lane, now.max_points[lane & (L - 1)], pairs.raw(index)) {
                let (question, raw) = pairs.parts(index);
                question.fall_back(raw);
            }
            pairs.end(index);
        }
        core::mem::swap(&mut now, &mut next);
    }
}
