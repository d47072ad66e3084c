//! Pairs of boxes, balls, segments and capsules, eight at a time; a lone pair is a batch of one.
//!
//! Each lane of a vector is another pair, and never looks at its neighbours: the bits of a pair do not depend on
//! the batch. The numbers of some pairs are gathered ([`gather`]), a kernel finds what it can of all of them
//! ([`Batch`]), then manifold by manifold is replaced. A batch has `L` lanes: eight where the machine has vectors that
//! pay, else one, computed by [`OneLane`]. A pair that is asked about alone is a batch of one lane on every machine. Degenerate pairs (a centre in a box, cores that cross, solids
//! too small or too large to be squared, NaN) fall back to the builder for one pair.
//!
//! The idea of lanes across pairs is that of bepuphysics (R. Nordby).

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

/// How many pairs are treated at once where there are vectors.
const LANES: usize = 8;

/// A pair of solids in canonical order and what is asked of it.
pub(crate) struct PairQuestion<'a, N: Real, const D: usize> {
    pub(crate) poses: [&'a Pose<N, D>; 2],
    pub(crate) solids: [&'a Solid<N, D>; 2],
    pub(crate) request: &'a ManifoldRequest<N>,
}

impl<N: Space<D>, const D: usize> PairQuestion<'_, N, D> {
    /// The manifold of a pair that is declined.
    #[inline(never)]
    fn fall_back(&self, raw: &mut RawManifold<N, D>) {
        let pair = Pair::new(self.solids.mapped(|solid| Geometry(solid.kind())), self.poses);
        <N::Algorithms>::contacts_of_separation(&pair, self.request, raw);
    }
}

/// Pairs of the same kinds whose manifolds are kept somewhere.
pub(crate) trait KeptPairs<N: Real, const D: usize> {
    /// How many there are.
    fn len(&self) -> usize;

    /// Begins the update of a pair.
    fn begin(&mut self, index: usize) -> PairQuestion<'_, N, D>;

    /// What [`Self::begin`] answered, and the manifold of the last update, which is to be replaced.
    fn parts(&mut self, index: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>);

    /// The manifold alone.
    fn raw(&mut self, index: usize) -> &mut RawManifold<N, D>;

    /// The manifold of a pair is as it will be.
    fn end(&mut self, index: usize);
}

/// An algorithm for pairs of two kinds, `L` at a time.
trait Batch<N: Real, const D: usize> {
    /// What is known of the pairs before their manifolds are replaced.
    type Found<const L: usize>;

    /// Nothing yet.
    fn blank<const L: usize>() -> Self::Found<L>;

    /// Puts the numbers of a pair into a lane; answers whether the pair is one for this algorithm.
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, D, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, D>,
    ) -> bool;

    /// Everything that goes for all pairs at once.
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, D, L>,
        found: &mut Self::Found<L>,
    );

    /// Replaces the manifold of one pair by at most `max_points` points; answers whether the pair is not declined.
    fn settle<const L: usize>(
        found: &Self::Found<L>,
        lane: usize,
        max_points: usize,
        raw: &mut RawManifold<N, D>,
    ) -> bool;
}

/// What is done with the algorithm for two kinds, once it is known; answers whether it is done.
trait Task<N: Space<D>, const D: usize> {
    fn run<B: Batch<N, D>>(self) -> bool;
}

/// Brings pairs of the plane up to date, of which these are the solids of the first; `false` if there
/// are no lanes for pairs of their kinds.
pub(crate) fn update_pairs2<N: Space<2>>(
    solids: [&Solid<N, 2>; 2],
    pairs: &mut impl KeptPairs<N, 2>,
) -> bool {
    run2(solids, Many { level: Level::new(), pairs })
}

/// Brings pairs of space up to date, as [`update_pairs2`].
pub(crate) fn update_pairs3<N: Space<3>>(
    solids: [&Solid<N, 3>; 2],
    pairs: &mut impl KeptPairs<N, 3>,
) -> bool {
    run3(solids, Many { level: Level::new(), pairs })
}

/// Brings one pair of the plane up to date; `false` if there are no lanes for its kinds or the pair is declined.
pub(crate) fn update_pair2<N: Space<2>>(
    question: &PairQuestion<'_, N, 2>,
    raw: &mut RawManifold<N, 2>,
) -> bool {
    run2(question.solids, One { question, raw })
}

/// Brings one pair of space up to date, as [`update_pair2`].
pub(crate) fn update_pair3<N: Space<3>>(
    question: &PairQuestion<'_, N, 3>,
    raw: &mut RawManifold<N, 3>,
) -> bool {
    run3(question.solids, One { question, raw })
}

/// The contact points of a pair in canonical order as a batch of one; `false` as in [`update_pair2`].
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

/// Runs a task with the algorithm for two solids of the plane; `false` also if there is none.
fn run2<N: Space<2>>([one, other]: [&Solid<N, 2>; 2], task: impl Task<N, 2>) -> bool {
    match (one, other) {
        (Solid::Cuboid(_), Solid::Cuboid(_)) => task.run::<Boxes2>(),
        _ if one.is_segment() && other.is_segment() => task.run::<ClosedForm<Segments2>>(),
        _ => run_with_ball([one, other], task),
    }
}

/// Runs a task with the algorithm for two solids of space; `false` also if there is none.
fn run3<N: Space<3>>([one, other]: [&Solid<N, 3>; 2], task: impl Task<N, 3>) -> bool {
    match (one, other) {
        (Solid::Cuboid(_), Solid::Cuboid(_)) => task.run::<Boxes3>(),
        _ if one.is_segment() && other.is_segment() => task.run::<ClosedForm<Segments3>>(),
        _ => run_with_ball([one, other], task),
    }
}

/// Runs a task with the algorithm for a ball and another solid; `false` also if there is none.
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

/// One pair is brought up to date.
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
        B::settle(&found, 0, question.request.max_points, raw)
    }
}

/// Many pairs are brought up to date.
struct Many<'a, P> {
    level: Level,
    pairs: &'a mut P,
}

impl<N: Space<D>, P: KeptPairs<N, D>, const D: usize> Task<N, D> for Many<'_, P> {
    fn run<B: Batch<N, D>>(self) -> bool {
        match self.level {
            Level::Wide(vectors) => update::<B, _, _, D, LANES>(VectorLanes(vectors), self.pairs),
            _ => update::<B, _, _, D, 1>(LonePair, self.pairs),
        }
        true
    }
}

/// What computes `L` lanes.
trait BatchLanes<const L: usize>: Copy {
    /// Runs [`Batch::find`], which is compiled once for all that keep pairs.
    fn find<B: Batch<N, D>, N: Real, const D: usize>(
        self,
        inputs: &Inputs<N, D, L>,
        found: &mut B::Found<L>,
    );
}

/// Eight lanes in vectors.
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

/// One lane.
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

/// [`Batch`] for all pairs, `L` by `L`. The numbers of the next pairs are gathered before those gathered last
/// are used, which gives the memory time to put them together.
fn update<B: Batch<N, D>, P: KeptPairs<N, D>, N: Space<D>, const D: usize, const L: usize>(
    lanes: impl BatchLanes<L>,
    pairs: &mut P,
) {
    let (mut now, mut next) = (&mut Inputs::<N, D, L>::new(), &mut Inputs::new());
    let mut found = B::blank::<L>();
    now.gather::<B, P>(pairs, 0);
    while now.count > 0 {
        next.gather::<B, P>(pairs, now.first + now.count);
        lanes.find::<B, N, D>(now, &mut found);
        for lane in 0..now.count {
            let index = now.first + lane;
            if !B::settle(&found, lane, now.max_points[lane & (L - 1)], pairs.raw(index)) {
                let (question, raw) = pairs.parts(index);
                question.fall_back(raw);
            }
            pairs.end(index);
        }
        core::mem::swap(&mut now, &mut next);
    }
}
